"""Boolean questions to a network: whether a formula is entailed, possible or impossible.

A SAT solver picks truth values for the formula's atoms, and `check` says whether the statements allow them; where not,
a minimal conflict tells the solver which of those values never go together. So the answer is exact for any formula, and
comes with scenarios, or with the statements that force it.

Examples
--------
>>> from ninefold.reasoner.networks.questions import ask
>>> from ninefold.reasoner.networks.network import Network
>>> net = Network("rcc8")
>>> _ = net.add("kitchen", "house", "inside")
>>> _ = net.add("house", "garden", "meet", label="deed")
>>> answer = ask(net, "inside(kitchen, house) & ~meet(kitchen, garden)")
>>> answer.answer, [str(s) for s in answer.statements]
('entailed', ['statement 1', 'deed'])
>>> ask(net, "overlap(kitchen, garden) | meet(garden, kitchen)").answer
'impossible'

References
----------
R. Nieuwenhuis, A. Oliveras and C. Tinelli, "Solving SAT and SAT modulo theories", Journal of the ACM 53, 2006.
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from ninefold.encodings.sat import open_solver

from .conflicts import Shrinker
from .consistency import Consistent, Inconsistent, check
from .formula import Formula, parse
from .network import require_network

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .formula import Atom
    from .network import Network
    from .scenario import Scenario
    from .statement import Statement

__all__ = ["Answer", "ask"]

Value = Literal["entailed", "possible", "impossible", "unknown"]


@dataclass(frozen=True, slots=True, repr=False)
class Answer:
    """An answer with evidence.

    Attributes
    ----------
    answer
        ``entailed``: the formula holds in every scenario; ``impossible``: in none; ``possible``: in some and not in
        others; ``unknown``: the budget ended first, or nobody has shown that closure decides the calculus. Of an
        inconsistent network, nothing is possible.
    satisfied, falsified
        A scenario in which the formula holds, and one in which it does not; None where there is none (or none was found
        in time).
    """

    answer: Value
    satisfied: Scenario | None
    falsified: Scenario | None
    formula: Formula
    network: Network = field(repr=False)
    _used: tuple[int, ...] = field(default=(), repr=False)
    _seed: int = field(default=0, repr=False)

    def __repr__(self) -> str:
        return f"Answer({self.answer}: {_short(self.formula.text)})"

    @property
    def statements(self) -> tuple[Statement, ...]:
        """The statements that force an answer of entailed or impossible, none of which can be left out; else none.

        Found anew at each use: one question for each statement that the answer used.
        """
        if self.answer not in ("entailed", "impossible"):
            return ()
        kept = list(self._used)
        for k in self._used:
            rest = [x for x in kept if x != k]
            part = self.network.subset(rest)
            question = _Question(part, self.formula, negated=self.answer == "entailed", seed=self._seed)
            if question.scenario() is None and not question.late:
                kept = rest
        return tuple(self.network.statements[k] for k in kept)


def _short(text: str, most: int = 80) -> str:
    return text if len(text) <= most else f"{text[: most - 3]}..."


def ask(net: Network, formula: str | Formula, *, seed: int = 0, budget: float | None = None) -> Answer:
    """Answer whether a formula is entailed by a network, possible or impossible.

    Parameters
    ----------
    formula
        Text in the grammar of `ninefold.reasoner.networks.formula`, or a parsed formula about this network.
    budget
        Seconds; the answer is then perhaps ``unknown``.

    Raises
    ------
    BadInput, UnknownName
        The text is no formula about this network.

    Complexity
    ----------
    At most one check for each combination of truth values of the atoms; as a rule far fewer.
    """
    require_network(net)
    asked = formula if isinstance(formula, Formula) else parse(formula, net)
    deadline = None if budget is None else time.perf_counter() + budget
    kept = net.copy()
    questions = [_Question(kept, asked, negated=negated, seed=seed, deadline=deadline) for negated in (False, True)]
    satisfied, falsified = (question.scenario() for question in questions)
    late = [question.late for question in questions]
    value: Value
    if satisfied is None and not late[0]:
        value, used = "impossible", questions[0].used
    elif falsified is None and not late[1]:
        value, used = "entailed", questions[1].used
        if satisfied is None:
            value = "unknown"  # perhaps there is no scenario at all
    else:
        value, used = "unknown" if any(late) else "possible", set()
    return Answer(value, satisfied, falsified, asked, kept, tuple(sorted(used)), seed)


class _Question:
    """Whether there is a scenario in which a formula (or its negation) holds.

    Attributes
    ----------
    used
        Statements that took part in the conflicts met.
    late
        Whether it was left undecided: the deadline came before the answer, or nobody knows how to decide the calculus.
    """

    def __init__(
        self, net: Network, formula: Formula, *, negated: bool, seed: int, deadline: float | None = None
    ) -> None:  # fmt: skip
        self._net = net
        self._seed = seed
        self._deadline = deadline
        self._clauses, self._variables, self._n_vars = formula.clauses(negated=negated)
        self.used: set[int] = set()
        self.late = False

    def scenario(self) -> Scenario | None:
        """Return such a scenario, or None."""
        with open_solver(clauses=[*self._clauses, *self._one_relation_a_pair()]) as solver:
            while True:
                answer = solver.solve(budget=self._left())
                if answer is None:
                    self.late = True
                if not answer:
                    return None
                model = set(solver.model())
                chosen = [(atom, variable if variable in model else -variable) for atom, variable in self._variables.items()]
                found = self._scenario_with(chosen)
                if not isinstance(found, list):
                    return found
                solver.add_clause([-literal for literal in found])

    def _one_relation_a_pair(self) -> list[list[int]]:
        """Return clauses that let the atoms of each pair be true as one base relation makes them."""
        clauses: list[list[int]] = []
        bases = range(self._net.calculus.n_bases)
        for pair in sorted({(atom.i, atom.j) for atom in self._variables}):
            first = self._n_vars + 1
            self._n_vars += len(bases)
            clauses.append([first + k for k in bases])
            clauses.extend([-first - k, -first - l] for k in bases for l in bases if l < k)
            for atom, variable in self._variables.items():
                if (atom.i, atom.j) == pair:
                    clauses.extend([-first - k, variable if atom.mask >> k & 1 else -variable] for k in bases)
        return clauses

    def _scenario_with(self, chosen: Iterable[tuple[Atom, int]]) -> Scenario | list[int] | None:
        """Return a scenario with these truth values; literals that exclude each other; or None when time is up."""
        net, full = self._net.copy(), self._net.calculus.universal
        literals: dict[int, int] = {}
        for atom, literal in chosen:
            mask = atom.mask if literal > 0 else full & ~atom.mask
            literals[net.add(net.entities[atom.i], net.entities[atom.j], mask).index] = literal
        verdict = check(net, budget=self._left(), seed=self._seed)
        if isinstance(verdict, Consistent):
            return verdict.scenario
        if not isinstance(verdict, Inconsistent):
            self.late = True
            return None
        found = Shrinker(net, self._seed, self._deadline).conflict(range(net.n_statements), known=True)
        indices = found[0] if found else range(net.n_statements)
        self.used |= {k for k in indices if k not in literals}
        return [literals[k] for k in indices if k in literals]

    def _left(self) -> float | None:
        return None if self._deadline is None else max(self._deadline - time.perf_counter(), 1e-3)
