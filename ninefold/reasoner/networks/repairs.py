"""Repair: the cheapest statements to drop so that the rest is consistent.

A repair hits every conflict. Conflicts are found one at a time; a weighted MaxSAT solver (RC2) picks the cheapest
statements that hit those found so far, and either the rest is consistent, and nothing cheaper can be, or it holds another
conflict. Exact, with any weights: they are taken as the fractions they are.

Examples
--------
>>> import math
>>> from ninefold.reasoner.networks.network import Network
>>> from ninefold.reasoner.networks.repairs import repair
>>> net = Network("rcc8")
>>> _ = net.add("kitchen", "house", "inside", weight=math.inf)
>>> _ = net.add("house", "garden", "disjoint", label="deed", weight=2)
>>> _ = net.add("kitchen", "garden", "meet", label="hearsay")
>>> found = repair(net)
>>> [str(s) for s in found.drop], found.cost
(['hearsay'], 1.0)

References
----------
E. Moreno-Centeno and R. M. Karp, "The implicit hitting set approach to solve combinatorial optimization problems",
Operations Research 61, 2013. A. Ignatiev, A. Morgado and J. Marques-Silva, "RC2: an efficient MaxSAT solver", JSAT 11, 2019.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING

from ninefold._wording import counted
from ninefold.errors import BadInput

from .conflicts import Conflict, Shrinker
from .consistency import Consistent, Inconsistent, check
from .deciding import undecided
from .network import require_network
from .words import told

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .network import Network
    from .statement import Statement

__all__ = ["Repair", "repair"]


@dataclass(frozen=True, slots=True, repr=False)
class Repair:
    """What to drop.

    Attributes
    ----------
    network
        What was to be repaired.
    drop
        The statements to drop, in order; none if the network is consistent.
    cost
        Sum of their weights; `math.inf` where hard statements contradict each other.
    conflict
        Then the conflict of hard statements, else None.
    optimal
        Whether nothing cheaper repairs it. False only where a budget ended first; the rest is consistent all the same.
    conflicts
        The conflicts that were found on the way, as sets of indices: every repair drops one soft statement of each.
    """

    network: Network
    drop: tuple[Statement, ...]
    cost: float
    conflict: Conflict | None = None
    optimal: bool = True
    conflicts: tuple[frozenset[int], ...] = field(default=(), repr=False)

    @property
    def possible(self) -> bool:
        """Whether dropping statements that are not hard is enough."""
        return self.conflict is None

    def __repr__(self) -> str:
        calculus, n = self.network.calculus, self.network.n_statements
        if self.conflict is not None:
            return f"Repair(none: hard statements contradict each other: {told(calculus, self.conflict.statements)})"
        if not self.drop:
            return "Repair(nothing to drop: the network is consistent)"
        cost = f"cost {self.cost:g}{'' if self.optimal else ', perhaps not the least'}"
        return f"Repair(drop {len(self.drop)} of {counted(n, 'statement')}, {cost}: {told(calculus, self.drop)})"

    def repaired(self) -> Network:
        """Return the network without the dropped statements.

        Raises
        ------
        BadInput
            There is no repair.
        """
        if not self.possible:
            raise BadInput("the hard statements contradict each other, so there is no repair; lower one of their weights")
        gone = {s.index for s in self.drop}
        return self.network.subset(k for k in range(self.network.n_statements) if k not in gone)


def repair(net: Network, *, seed: int = 0, budget: float | None = None) -> Repair | None:
    """Return a cheapest repair.

    Parameters
    ----------
    budget
        Seconds, after which the repair is completed greedily and not `Repair.optimal`; None is returned if even that
        cannot be decided in twice the time.

    Raises
    ------
    Undecided
        Nobody has shown that closure decides the calculus, and it refutes no more: whether the rest is consistent is not
        known.

    Notes
    -----
    Statements of weight 0 cost nothing to drop, yet only those that have to go are dropped.

    Complexity
    ----------
    One conflict for each round; there can be exponentially many rounds.
    """
    require_network(net)
    deadline = None if budget is None else time.perf_counter() + budget
    work = _Work(net, seed, deadline)
    dropped: set[int] = set()
    while True:
        late = deadline is not None and time.perf_counter() > deadline
        found = work.more_conflicts(dropped)
        if found is None:
            return None
        if not found:
            chosen = work.needed(dropped)
            if chosen is None:
                return None
            statements = tuple(net.statements[k] for k in sorted(chosen))
            cost = float(sum(Fraction(s.cost) for s in statements))
            return Repair(net, statements, cost, None, not work.greedy, tuple(work.conflicts))
        for indices in found:
            if all(net.statements[k].hard for k in indices):
                hard = Shrinker(net, seed).conflict(indices, known=True)
                kept = hard[0] if hard else sorted(indices)
                clash = Conflict(net, tuple(net.statements[k] for k in kept))
                return Repair(net, (), math.inf, clash, conflicts=tuple(work.conflicts))
        dropped = work.hit(greedily=late)


class _Work:
    """Conflicts so far, and statements that hit them."""

    def __init__(self, net: Network, seed: int, deadline: float | None) -> None:
        self._net = net
        self._seed = seed
        self._deadline = deadline
        self._hard = {s.index for s in net.statements if s.hard}
        self.conflicts: list[frozenset[int]] = []
        self.greedy = False

    def more_conflicts(self, dropped: Iterable[int]) -> list[frozenset[int]] | None:
        """Return conflicts among what is not dropped, no two with a soft statement in common; None when time is up."""
        gone = set(dropped)
        found: list[frozenset[int]] = []
        while True:
            rest = [k for k in range(self._net.n_statements) if k not in gone]
            verdict = check(self._net.subset(rest), budget=self._left(), seed=self._seed)
            if isinstance(verdict, Consistent):
                return found
            if not isinstance(verdict, Inconsistent):
                if verdict.kind == "theory":
                    raise undecided(self._net.calculus)
                return found or None
            shrinker = Shrinker(self._net, self._seed, soft_only=True)
            shrunk = shrinker.conflict(rest, known=True)
            indices = frozenset(shrunk[0] if shrunk else rest)
            found.append(indices)
            self.conflicts.append(indices)
            if indices <= self._hard:
                return found
            gone |= indices - self._hard

    def hit(self, *, greedily: bool) -> set[int]:
        """Return the cheapest statements that hit every conflict, or quickly some that do."""
        costs = {k: Fraction(self._net.statements[k].cost) for c in self.conflicts for k in c - self._hard}
        if greedily:
            self.greedy = True
            hit: set[int] = set()
            for indices in self.conflicts:
                if not hit & indices:
                    hit.add(min(indices - self._hard, key=lambda k: (costs[k], k)))
            return hit
        return _cheapest_hitting_set([sorted(c - self._hard) for c in self.conflicts], costs)

    def needed(self, dropped: set[int]) -> set[int] | None:
        """Return `dropped` less what can stay, the dearest kept first: free statements are otherwise picked at will."""
        kept = set(dropped)
        free = sorted(dropped, key=lambda k: (-self._net.statements[k].cost, k))
        for k in free if self.greedy else [k for k in free if not self._net.statements[k].cost]:
            gone = kept - {k}
            rest = [x for x in range(self._net.n_statements) if x not in gone]
            if isinstance(check(self._net.subset(rest), budget=self._left(), seed=self._seed), Consistent):
                kept = gone
        return kept

    def _left(self) -> float | None:
        if self._deadline is None:
            return None
        return max(self._deadline - time.perf_counter(), 0.1)


def _cheapest_hitting_set(sets: list[list[int]], costs: dict[int, Fraction]) -> set[int]:
    """Return a set of least cost that meets each of `sets`, by MaxSAT."""
    from pysat.examples.rc2 import RC2
    from pysat.formula import WCNF

    # fractions of a common denominator are whole numbers, whatever floats the weights were
    scale = math.lcm(1, *(cost.denominator for cost in costs.values()))
    variables = {k: v for v, k in enumerate(sorted(costs), start=1)}
    formula = WCNF()
    for members in sets:
        formula.append([variables[k] for k in members])
    for k, variable in variables.items():
        if costs[k]:
            formula.append([-variable], weight=int(costs[k] * scale))
    with RC2(formula) as solver:
        model = set(solver.compute())
    return {k for k, variable in variables.items() if variable in model}
