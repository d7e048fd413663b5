"""Conflicts: statements that cannot hold together, none of which can be left out.

Where closure refutes a network, its record says which statements were used, often a handful of thousands; so does a
proof by cases where that is short. What is left is then shrunk by leaving statements out, first in blocks and in the end
one by one, every time asking closure and, where closure finds nothing, `decide`. The last round proves that each
statement is necessary.

Examples
--------
>>> from ninefold.reasoner.networks.conflicts import conflict
>>> from ninefold.reasoner.networks.network import Network
>>> net = Network("rcc8")
>>> for a, b, words in [("kitchen", "house", "inside"), ("attic", "house", "coveredBy"), ("house", "garden", "disjoint"),
...                     ("kitchen", "garden", "meet")]:
...     _ = net.add(a, b, words)
>>> found = conflict(net)
>>> [str(statement) for statement in found]
['statement 1', 'statement 3', 'statement 4']

References
----------
R. R. Bakker et al., "Diagnosing and solving over-determined constraint satisfaction problems", IJCAI 1993 (deletion).
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ._sparse_trace import pairs_behind_refutation
from .deciding import decide
from .derivation import RecordedClosure
from .refutation import refute

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from .network import Network, Statement

__all__ = ["Conflict", "conflict"]

_DENSE = 400
"""Entities above which closure keeps a chordal completion of the stated pairs instead of all."""

_CASES = 30
"""Cases up to which a proof by cases is tried for what it says about the statements used."""


@dataclass(frozen=True, slots=True)
class Conflict:
    """Statements of a network that are inconsistent together.

    Attributes
    ----------
    network
        The whole network.
    statements
        In the network's order.
    minimal
        Whether each is known to be necessary; false only where a budget ended first.
    """

    network: Network
    statements: tuple[Statement, ...]
    minimal: bool = True

    @property
    def indices(self) -> tuple[int, ...]:
        """Indices of the statements in the network."""
        return tuple(s.index for s in self.statements)

    def triples(self) -> list[tuple[str, str, tuple[str, ...]]]:
        """Return the statements as (a, b, names of relations)."""
        names = self.network.calculus.names
        return [(s.a, s.b, names(s.mask)) for s in self.statements]

    def to_network(self) -> Network:
        """Return the network of the statements alone, over the entities they speak of."""
        return part_of(self.network, self.indices)

    def __iter__(self) -> Iterator[Statement]:
        return iter(self.statements)

    def __len__(self) -> int:
        return len(self.statements)

    def __str__(self) -> str:
        text = self.network.calculus.text
        return "\n".join(f"{s}: {s.a} {text(s.mask)} {s.b}" for s in self.statements)


def conflict(net: Network, *, seed: int = 0, budget: float | None = None) -> Conflict | None:
    """Return a minimal conflict of a network, or None if it is consistent.

    Parameters
    ----------
    seed
        For the search; the same seed gives the same conflict.
    budget
        Seconds after which statements are no longer left out; what is left then is a conflict, perhaps not minimal.
        Whether there is a conflict at all is decided without regard to it.

    Notes
    -----
    Statements of finite weight are left out before hard ones, so that a conflict of mapped facts with what was said
    names as little as possible of what was said. There may be smaller conflicts: this one only has none inside it.

    Complexity
    ----------
    A closure, and one check for each statement that closure uses.
    """
    deadline = None if budget is None else time.perf_counter() + budget
    found = Shrinker(net, seed, deadline).conflict(range(net.n_statements))
    if found is None:
        return None
    indices, minimal = found
    return Conflict(net, tuple(net.statements[k] for k in indices), minimal)


def part_of(net: Network, indices: Iterable[int]) -> Network:
    """Return the network of some statements over the entities they speak of, in the order they first come."""
    from .network import Network

    part = Network(net.calculus)
    for k in sorted(indices):
        s = net.statements[k]
        part.add(s.a, s.b, s.mask, s.label, s.weight)
    return part


class Shrinker:
    """Finds minimal conflicts inside given statements of one network.

    Parameters
    ----------
    soft_only
        Leave hard statements where they are: a hitting set has no use for them.
    """

    def __init__(self, net: Network, seed: int = 0, deadline: float | None = None, *, soft_only: bool = False) -> None:
        self._net = net
        self._seed = seed
        self._deadline = deadline
        self._soft_only = soft_only
        self._late = False
        self._too_long = 2 * net.n_statements + 1

    def conflict(self, indices: Iterable[int], *, known: bool = False) -> tuple[list[int], bool] | None:
        """Return a conflict among statements `indices`, and whether it is minimal; None if they are consistent.

        Parameters
        ----------
        known
            That they are inconsistent has been decided already.
        """
        kept = sorted(indices)
        used = self._used(kept)
        if used is None:
            if not known and decide(part_of(self._net, kept), seed=self._seed).consistent is not False:
                return None
            used = self._used_by_cases(kept)
        minimal = True
        size = max(1, len(used) // 4)
        while True:
            used, done = self._pass(used, size)
            if not done or size == 1:
                minimal = done
                break
            size = min(size // 2, max(1, len(used) // 4)) or 1
        return sorted(used), minimal

    def _pass(self, used: list[int], size: int) -> tuple[list[int], bool]:
        """Try to leave out each block of `size` statements; also return whether the budget lasted."""
        statements = self._net.statements
        # what comes first is left out first: soft before hard, late before early
        order = sorted(used, key=lambda k: (statements[k].hard, -k))
        if self._soft_only:
            order = [k for k in order if not statements[k].hard]
        necessary: set[int] = set()
        while order:
            block = set(order[:size])
            rest = [k for k in used if k not in block]
            smaller = self._refuted(rest)
            if smaller is None:
                if self._late:
                    return used, False
                necessary |= block
            else:
                used = smaller
            order = [k for k in order if k in set(used) and k not in necessary and k not in block]
        return used, True

    def _refuted(self, rest: list[int]) -> list[int] | None:
        """Return the part of `rest` that refutes it, or None if it is consistent (or time is up)."""
        left = None if self._deadline is None else self._deadline - time.perf_counter()
        if left is not None and left <= 0:
            self._late = True
            return None
        # most often the rest is consistent, which the search sees faster on few statements than a closure over all pairs
        consistent = decide(part_of(self._net, rest), budget=left, seed=self._seed).consistent
        if consistent is not False:
            self._late = not consistent
            return None
        return self._used(rest) or self._used_by_cases(rest)

    def _used(self, kept: Sequence[int]) -> list[int] | None:
        """Return the statements closure needs to refute `kept`, fewer at every round; None if it does not."""
        used: list[int] | None = None
        while (part := part_of(self._net, kept)).n_entities > _DENSE:
            pairs = part.constraints()
            behind = pairs_behind_refutation(part.calculus, pairs)
            if behind is None:
                return used
            found = self._with_hard(kept, {sorted(kept)[k] for pair in behind for k in pairs.statements(pair)})
            if len(found) == len(kept):
                return found
            used = kept = found
        while True:
            closure = self._refuting_closure(kept)
            if closure is None:
                return used
            found = self._with_hard(kept, closure.refutation().sources)
            if used is not None and len(found) == len(used):
                return found
            used = kept = found

    def _refuting_closure(self, kept: Sequence[int]) -> RecordedClosure | None:
        """Return the closure of some statements if it refutes them; hard ones are stated and closed first."""
        statements = [self._net.statements[k] for k in kept if self._net.statements[k].a != self._net.statements[k].b]
        index: dict[str, int] = {}
        for s in statements:
            index.setdefault(s.a, len(index))
            index.setdefault(s.b, len(index))
        closure = RecordedClosure(self._net.calculus, len(index))
        for hard in (True, False):
            for s in statements:
                if s.hard == hard and not closure.state(index[s.a], index[s.b], s.mask, s.index):
                    return closure
            if not closure.close():
                return closure
        return None

    def _used_by_cases(self, kept: Sequence[int]) -> list[int]:
        """Return the statements that a proof by cases needs, or all of them where it would be long.

        After a long one the next is sought when half of the statements are gone.
        """
        if 2 * len(kept) > self._too_long:
            return list(kept)
        part = part_of(self._net, kept)
        about = [k for k in kept if self._net.statements[k].a != self._net.statements[k].b]
        triples = [(part.index(s.a), part.index(s.b), s.mask) for s in (self._net.statements[k] for k in about)]
        found = refute(self._net.calculus, part.n_entities, triples, most=_CASES)
        if found is None:
            self._too_long = len(kept)
            return list(kept)
        return self._with_hard(kept, {about[k] for k in found.sources if k < len(about)})

    def _with_hard(self, kept: Sequence[int], sources: Iterable[int]) -> list[int]:
        used = set(sources)
        if self._soft_only:
            used |= {k for k in kept if self._net.statements[k].hard}
        return sorted(used)
