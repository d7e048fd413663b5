"""Every scenario of a network, one after another, and how many there are.

Pairs get base relations one at a time, with closure after each. Pairs whose labels closure cannot be trusted with come
first, and `decide` confirms every step among them; from then on no step leads into a dead end, so that the next scenario
is never far.

Examples
--------
>>> from ninefold.reasoner.networks.network import Network
>>> from ninefold.reasoner.networks.enumeration import count, scenarios
>>> net = Network("rcc8")
>>> _ = net.add("kitchen", "house", "inside | coveredBy")
>>> _ = net.add("house", "garden", "disjoint")
>>> [scenario.relation("kitchen", "house") for scenario in scenarios(net)]
['TPP', 'NTPP']
>>> count(net, limit=1)
Count(count=1, exact=False)
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, islice
from typing import TYPE_CHECKING

from ninefold.encodings.theory import theory_of
from ninefold.errors import BadInput, Undecided

from .deciding import decide, undecided
from .derivation import RecordedClosure
from .network import Network, require_network
from .scenario import Scenario

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["Count", "count", "scenarios", "some_scenario"]


@dataclass(frozen=True, slots=True)
class Count:
    """How many scenarios there are.

    Attributes
    ----------
    count
        Scenarios found.
    exact
        False if there are more, or perhaps are: of a calculus that nobody has shown how to decide none is known for sure.
    """

    count: int
    exact: bool


def count(net: Network, limit: int = 10_000, *, seed: int = 0) -> Count:
    """Count the scenarios of a network, up to a limit.

    Raises
    ------
    BadInput
        A limit below 0.
    """
    require_network(net)
    if limit < 0:
        raise BadInput(f"a limit is a number of scenarios, not {limit}")
    try:
        found = sum(1 for _ in islice(scenarios(net, seed=seed), limit + 1))
    except Undecided:
        return Count(0, exact=False)
    return Count(min(found, limit), found <= limit)


def some_scenario(net: Network, *, seed: int = 0) -> Scenario | None:
    """Return one scenario of a network, the one that ``check`` finds, or None if it is inconsistent.

    Raises
    ------
    Undecided
        Nobody has shown that closure decides the calculus, and it refutes nothing.
    """
    require_network(net)
    decision = decide(net, seed=seed)
    if decision.consistent is None:
        raise undecided(net.calculus)
    return decision.scenario


def closed(net: Network) -> RecordedClosure | None:
    """Return the closure of all statements, or None if it refutes them."""
    closure = RecordedClosure(net.calculus, net.n_entities)
    for s in net.statements:
        if s.a != s.b and not closure.state(net.index(s.a), net.index(s.b), s.mask, s.index):
            return None
    return closure if closure.close() else None


def scenarios(net: Network, *, seed: int = 0) -> Iterator[Scenario]:
    """Yield every scenario of a network, each once; none if it is inconsistent.

    Raises
    ------
    Undecided
        When the first one is asked for: nobody has shown that closure decides the calculus, and it refutes nothing, so
        that a closed network of base relations is perhaps no scenario.

    Parameters
    ----------
    seed
        For the search. The order of the scenarios does not depend on it.

    Complexity
    ----------
    Between two scenarios O(n^2) closures, and as many checks where labels are outside a tractable class.
    """
    require_network(net)
    closure = closed(net)
    if closure is None:
        return
    decision = decide(net, seed=seed)
    if decision.consistent is None:
        raise undecided(net.calculus)
    if decision.consistent:
        yield from _Enumerator(net, closure, seed).run()


@dataclass(frozen=True, slots=True)
class _Level:
    """One choice: the state to come back to, the pair, bases to try, pairs settled, and whether closure decides here."""

    mark: int
    pair: tuple[int, int]
    bases: Iterator[int]
    done: int
    free: bool


class _Enumerator:
    def __init__(self, net: Network, closure: RecordedClosure, seed: int) -> None:
        self._net = net
        self._theory = theory_of(net.calculus)
        self._closure = closure
        self._seed = seed
        self._pairs = list(combinations(range(net.n_entities), 2))

    def run(self) -> Iterator[Scenario]:
        """Yield the scenarios of what is stated; it is consistent."""
        calculus, closure = self._net.calculus, self._closure
        levels: list[_Level] = []
        done, free = 0, False
        while True:
            pair, done, free = self._next(done, free)
            if pair is None:
                yield Scenario.from_labels(calculus, self._net.entities, closure.labels)
            else:
                label = closure.relation(*pair)
                bases = iter([1 << k for k in range(calculus.n_bases) if label >> k & 1])
                levels.append(_Level(closure.mark(), pair, bases, done, free))
            while levels:
                level = levels[-1]
                closure.undo(level.mark)
                base = next(level.bases, None)
                if base is None:
                    levels.pop()
                elif closure.state(*level.pair, base, 0) and closure.close() and (level.free or self._consistent()):
                    done, free = level.done, level.free
                    break
            else:
                return

    def _next(self, done: int, free: bool) -> tuple[tuple[int, int] | None, int, bool]:  # noqa: FBT001 - with `done`
        """Return the pair to settle next, or None; how many pairs are settled; whether closure decides from here on."""
        calculus, closure, pairs = self._net.calculus, self._closure, self._pairs
        while done < len(pairs) and calculus.is_atomic(closure.relation(*pairs[done])):
            done += 1
        if done == len(pairs):
            return None, done, True
        hard = None if free else next(self._undecided(), None)
        return hard or pairs[done], done, hard is None

    def _undecided(self) -> Iterator[tuple[int, int]]:
        return (pair for pair in self._stated() if not self._theory.decides(self._closure.relation(*pair)))

    def _stated(self) -> Iterator[tuple[int, int]]:
        constraints = self._net.constraints()
        return zip(constraints.i.tolist(), constraints.j.tolist(), strict=True)

    def _consistent(self) -> bool:
        """Tell whether the closed network has a scenario; closure says so where it decides."""
        if next(self._undecided(), None) is None:
            return True
        calculus, closure = self._net.calculus, self._closure
        present = [
            (i, j, closure.relation(i, j)) for i, j in self._pairs if closure.relation(i, j) != calculus.universal
        ]  # fmt: skip
        net = Network.from_constraints(calculus, self._net.n_entities, present)
        return decide(net, seed=self._seed).consistent is not False
