"""Why statements contradict each other, in words.

The text is a replay of the closure's record: each line composes two things known before. Conflicts that closure alone
does not see are proved by cases. A proof of more than `most` cases is not printed; the explanation then says so.

Examples
--------
>>> from ninefold.reasoner.networks.explanation import explain
>>> from ninefold.reasoner.networks.network import Network
>>> net = Network("rcc8")
>>> for a, words, b in [("kitchen", "inside", "house"), ("house", "disjoint", "garden"), ("kitchen", "meet", "garden")]:
...     _ = net.add(a, b, words)
>>> print(explain(net))
kitchen inside house, house disjoint garden, so kitchen disjoint garden; but kitchen meets garden
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ninefold._wording import counted, shortened
from ninefold.errors import BadInput

from .conflicts import Conflict, conflict
from .refutation import refute
from .words import phrase, spoken

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .derivation import Derivation, Fact
    from .network import Network
    from .refutation import Refutation
    from .statement import Statement

__all__ = ["Explanation", "explain"]

MOST_CASES = 24
"""Cases a proof is printed with unless asked otherwise."""

_SEARCHED = 8
"""Closures tried for each case that may be printed."""


@dataclass(frozen=True, slots=True, repr=False)
class Explanation:
    """A derivation in words; ``str`` gives all of it.

    Attributes
    ----------
    conflict
        The statements that contradict each other.
    lines
        The text, indented where cases are split.
    cases
        Number of cases, 1 for a conflict that closure finds; 0 where the proof was too long to be printed.
    """

    conflict: Conflict
    lines: tuple[str, ...]
    cases: int

    @property
    def complete(self) -> bool:
        """Whether the lines are a whole proof."""
        return self.cases > 0

    def __str__(self) -> str:
        return "\n".join(self.lines)

    def __repr__(self) -> str:
        size = counted(self.cases, "case") if self.complete else "too long to print"
        return f"Explanation({size}, {counted(len(self.lines), 'line')}: {shortened(self.lines[0])})"


def explain(given: Network | Conflict, *, most: int = MOST_CASES, seed: int = 0) -> Explanation:
    """Explain why a network, or a conflict found in one, is inconsistent.

    Parameters
    ----------
    given
        A network, whose conflict is then sought first, or a conflict.
    most
        Cases above which a proof by cases is not printed.

    Raises
    ------
    BadInput
        The network is consistent.
    """
    found = given if isinstance(given, Conflict) else conflict(given, seed=seed)
    if found is None:
        raise BadInput("the network is consistent, so there is no conflict to explain; ask what it entails with infer")
    net = found.to_network()
    statements = [s for s in found.statements if s.a != s.b]
    triples = [(net.index(s.a), net.index(s.b), s.mask) for s in statements]
    refutation = refute(net.calculus, net.n_entities, triples, most=_SEARCHED * most)
    if refutation is None or refutation.n_leaves > most:
        return Explanation(found, tuple(_listed(found, refutation, most)), 0)
    writer = _Writer(net, statements)
    writer.refutation(refutation)
    return Explanation(found, tuple(writer.lines), refutation.n_leaves)


def _listed(found: Conflict, refutation: Refutation | None, most: int) -> list[str]:
    calculus = found.network.calculus
    if refutation is None:
        end = f"No proof of up to {counted(most, 'case')} was found, so none is printed; check confirms the contradiction."
    else:
        cases = counted(refutation.n_leaves, "case")
        end = f"The proof takes {cases} and is not printed; check confirms the contradiction."
    shown = [f"  {spoken(calculus, s)}" for s in found.statements]
    head = f"These {counted(len(shown), 'statement')} contradict each other"
    necessary = ", and none of them can be left out" if found.minimal else ""
    return [f"{head}{necessary}:", *shown, end]


def _said(s: Statement) -> str:
    return f" ({s.label})" if s.label else ""


class _Writer:
    """Writes refutations of statements as lines."""

    def __init__(self, net: Network, statements: Sequence[Statement]) -> None:
        self._net = net
        self._calculus = net.calculus
        self._entities = net.entities
        self._statements = statements
        self._assumed: list[tuple[int, int, int]] = []
        self.lines: list[str] = []

    def refutation(self, refutation: Refutation) -> None:
        """Write a refutation under the present assumptions."""
        indent = "  " * len(self._assumed)
        if refutation.derivation is not None:
            self._derivation(refutation.derivation, indent)
            return
        i, j = refutation.pair or (0, 0)
        if refutation.ground is not None and len(refutation.ground.facts) > 1:
            self._derivation(refutation.ground, indent)
        left = self._phrase(i, j, refutation.label)
        self.lines.append(f"{indent}{counted(len(refutation.cases), 'case')}, since {left}:")
        for number, (part, case) in enumerate(refutation.cases):
            self.lines.append(f"{indent}case {number + 1}, {self._phrase(i, j, part)}:")
            self._assumed.append((i, j, part))
            self.refutation(case)
            self._assumed.pop()

    def _derivation(self, derivation: Derivation, indent: str) -> None:
        """Write a proof, a line a derived fact; the last line ends in the contradiction, if it is one."""
        facts = derivation.facts
        shown = {k: line for k, fact in enumerate(facts) if (line := self._derived(fact, facts))}
        if not shown:
            # statements about one pair that leave nothing of it
            said = [self._premise(facts, k) for k, fact in enumerate(facts) if fact.source >= 0]
            self.lines.append(f"{indent}{'; but '.join(said)}")
            return
        # the same step can be needed for two purposes; a reader needs it once
        self.lines.extend(indent + line for line in dict.fromkeys(shown.values()))
        last = facts[-1]
        if last.mask == 0 and last.source >= 0:
            self.lines[-1] += f"; but {self._premise(facts, len(facts) - 1)}"

    def _derived(self, fact: Fact, facts: Sequence[Fact]) -> str | None:
        """Return the line of a derived fact, or None for a statement."""
        if fact.source >= 0:
            if fact.kept < 0 or fact.mask == 0:
                return None
            earlier = self._phrase(fact.i, fact.j, self._seen(facts, fact.kept, fact.i))
            return f"{earlier}, {self._statement(fact.source, fact.i, fact.j)}, so {self._phrase_of(fact)}"
        if fact.mask == 0 and min(fact.left, fact.right, fact.kept) >= 0:
            return self._contradiction(fact, facts)
        premises = [self._premise(facts, k) for k in (fact.left, fact.right) if k >= 0]
        left = facts[fact.left].mask if fact.left >= 0 else self._calculus.universal
        right = facts[fact.right].mask if fact.right >= 0 else self._calculus.universal
        follows = self._calculus.compose(left, right)
        text = f"{', '.join(premises)}, so {self._phrase(fact.i, fact.j, follows)}"
        if fact.kept < 0 or self._seen(facts, fact.kept, fact.i) & follows == follows:
            return text
        return f"{text}; with {self._premise(facts, fact.kept)}, {self._phrase_of(fact)}"

    def _contradiction(self, fact: Fact, facts: Sequence[Fact]) -> str:
        """Return the line of the last triangle, from whichever side two of its facts say most about the third."""
        i, j, via = fact.i, fact.j, fact.via
        third = {(i, via): fact.left, (via, j): fact.right, (i, j): fact.kept}
        side = {**third, **{(b, a): k for (a, b), k in third.items()}}
        best: tuple[int, int, str] | None = None
        for a, b, c in ((i, via, j), (via, i, j), (i, j, via), (j, via, i), (j, i, via), (via, j, i)):
            first, second, against = side[a, b], side[b, c], side[a, c]
            follows = self._calculus.compose(self._seen(facts, first, a), self._seen(facts, second, b))
            if follows & self._seen(facts, against, a):
                continue
            turned = sum(self._is_turned(facts[k], x) for k, x in ((first, a), (second, b), (against, a)))
            if best is None or (follows.bit_count(), turned) < best[:2]:
                premises = f"{self._premise(facts, first, a)}, {self._premise(facts, second, b)}"
                text = f"{premises}, so {self._phrase(a, c, follows)}; but {self._premise(facts, against, a)}"
                best = (follows.bit_count(), turned, text)
        return best[2] if best else ""

    def _is_turned(self, fact: Fact, first: int) -> bool:
        """Tell whether a statement would be read against the way it was said."""
        return 0 <= fact.source < len(self._statements) and self._net.index(self._statements[fact.source].a) != first

    def _seen(self, facts: Sequence[Fact], k: int, first: int) -> int:
        """Return the mask of a fact, seen from one of its entities."""
        return facts[k].mask if facts[k].i == first else self._calculus.converse_of(facts[k].mask)

    def _premise(self, facts: Sequence[Fact], k: int, first: int | None = None) -> str:
        """Return a fact as a premise, with `first` before the other entity; a statement as it was said, with its label."""
        fact = facts[k]
        i, j = (fact.j, fact.i) if fact.j == first else (fact.i, fact.j)
        said = fact.source >= 0 and (fact.kept < 0 or fact.mask == 0)
        return self._statement(fact.source, i, j) if said else self._phrase(i, j, self._seen(facts, k, i))

    def _statement(self, source: int, i: int, j: int) -> str:
        """Return a statement seen from i, with its label; an assumption says of itself that it is one."""
        if source >= len(self._statements):
            assumed_i, _, mask = self._assumed[source - len(self._statements)]
            mask = mask if assumed_i == i else self._calculus.converse_of(mask)
            return self._phrase(i, j, mask)
        s = self._statements[source]
        mask = s.mask if self._net.index(s.a) == i else self._calculus.converse_of(s.mask)
        return f"{self._phrase(i, j, mask)}{_said(s)}"

    def _phrase_of(self, fact: Fact) -> str:
        return self._phrase(fact.i, fact.j, fact.mask)

    def _phrase(self, i: int, j: int, mask: int) -> str:
        return phrase(self._calculus, self._entities[i], mask, self._entities[j])
