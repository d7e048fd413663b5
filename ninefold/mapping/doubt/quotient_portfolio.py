"""Every closed map of a folded walk: the search by faces and the SAT solver, in turn, until one has come to its end.

Grids, where everything looks alike, yield to the search and not to SAT; long walks in irregular worlds the reverse, and
which it will be is not known before. The search begins with one node after another, with growing shares of work, as the
node it begins with decides how long it takes. The solver starts once the search has taken as long as laying out its
clauses will take, then both have equal time, and the solver a quarter after `EQUAL` seconds. Both find all maps, so the
answer does not depend on which is first; where more maps are found than are kept, those with the fewest places are, and then
by the numbers of their places.
"""

from __future__ import annotations

from time import monotonic
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ._node_pairs import node_pairs, triples
from .quotient_sat import QuotientSat
from .quotients import QuotientSearch, spread_roots

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from .likeness import Likeness
    from .walk_tree import WalkTree

__all__ = ["ClosedMaps", "closed_maps"]

ROOTS = 8
"""Nodes that the search begins with in turn."""

FIRST_WORK = 1_000_000
"""Work of each search of the first round, in ends of ways looked at; every round has `GROWTH` times as much."""

GROWTH = 4

FIRST_SLICE = 16
"""Decisions before the first look at the clock."""

SLICE = 0.1
"""Seconds that the search or the solver has at once, about."""

EQUAL = 3.0
"""Seconds that the solver may take as fast as the search does; afterwards it has a quarter of the time."""

CLAUSE_SECONDS = 1e-6
"""What one clause of the model takes to lay out."""

MOST_CLAUSES = 20_000_000
"""Clauses beyond which there is no model."""


class ClosedMaps(NamedTuple):
    """What was found.

    Attributes
    ----------
    maps
        Place and shift of every node, (N, 2) each: those kept.
    found
        How many were found.
    exact
        Whether these are all.
    """

    maps: list[NDArray[np.int64]]
    found: int
    exact: bool


def closed_maps(
    tree: WalkTree,
    alike: Likeness,
    *,
    until: float,
    most: int,
    most_places: int | None = None,
    report: Callable[[int], object] | None = None,
) -> ClosedMaps:
    """Find the closed maps of a walk.

    Parameters
    ----------
    until
        The time, of the monotonic clock, at which to stop; then what both have found is returned, as not exact.
    most
        Maps to keep.
    most_places
        Places of a map at most.
    report
        Called with the number of maps found so far, now and then.
    """
    search = _Search(tree, alike, most, most_places)
    cost = triples(node_pairs(tree, alike)) * CLAUSE_SECONDS if tree.compass else np.inf
    may_ask = cost <= MOST_CLAUSES * CLAUSE_SECONDS
    sat: _Sat | None = None
    try:
        while not search.done and (left := until - monotonic()) > 0:
            if may_ask and sat is None and search.seconds >= cost and left > cost:
                sat = _Sat(tree, alike, most, most_places)
            if sat is not None and sat.seconds <= max(min(search.seconds, EQUAL), search.seconds / 4):
                sat.step(min(SLICE, left))
                if sat.done:
                    return ClosedMaps(sat.kept.maps(), sat.kept.count, exact=True)
            else:
                search.step()
            if report is not None:
                report(max(search.best().count, 0 if sat is None else sat.kept.count))
    finally:
        if sat is not None:
            sat.close()
    if search.done:
        return ClosedMaps(search.kept.maps(), search.kept.count, exact=True)
    best = search.best()
    if sat is not None and max(best.count, sat.kept.count) <= most:
        best.add(sat.kept.maps())
    elif sat is not None:
        best = max(best, sat.kept, key=lambda kept: kept.count)
    return ClosedMaps(best.maps(), best.count, exact=False)


class _Kept:
    """The first maps of those found, by their number of places, then by the places of the nodes in order."""

    def __init__(self, tree: WalkTree, most: int) -> None:
        self.tree, self.most = tree, most
        self.count = 0
        self._maps: dict[tuple[int, bytes], NDArray[np.int64]] = {}

    def add(self, maps: Iterable[NDArray[np.int64]]) -> None:
        for one in maps:
            key = _rank(self.tree, one)
            self.count += key not in self._maps
            self._maps[key] = one.copy()
        if len(self._maps) > 2 * self.most + 1000:
            self._shorten()

    def maps(self) -> list[NDArray[np.int64]]:
        self._shorten()
        return list(self._maps.values())

    def _shorten(self) -> None:
        self._maps = dict(sorted(self._maps.items(), key=lambda item: item[0])[: self.most])


def _rank(tree: WalkTree, quotient: NDArray[np.int64]) -> tuple[int, bytes]:
    """Return what orders maps: number of places, then the places, numbered as they come, then the shifts of the nodes."""
    _, first, place = np.unique(quotient[:, 0], return_index=True, return_inverse=True)
    rank = np.empty(first.size, np.int64)
    rank[np.argsort(first)] = np.arange(first.size)
    shift = (quotient[:, 1] - quotient[first[place], 1]) % np.maximum(tree.degree, 1)
    return first.size, np.concatenate([rank[place], shift]).astype(">i8").tobytes()


class _Search:
    """The search by faces, begun with one node after another."""

    def __init__(self, tree: WalkTree, alike: Likeness, most: int, most_places: int | None) -> None:
        self.tree, self.alike, self.most, self.most_places = tree, alike, most, most_places
        spread = spread_roots(tree, ROOTS)
        self.roots = spread[::-1]  # at the end of a walk most is known: there the search is quicker, and often quickest
        self.work = FIRST_WORK
        self.seconds = 0.0
        self.done = False
        self.turn = 0
        self.fails: NDArray[np.int64] | None = None
        self.most_found = _Kept(tree, most)
        self._at_once = FIRST_SLICE
        self._begin()

    def _begin(self) -> None:
        root = self.roots[self.turn % len(self.roots)]
        self.search = QuotientSearch(
            self.tree, self.alike, root=root, closed=True, most_places=self.most_places, fails=self.fails
        )
        self.kept = _Kept(self.tree, self.most)
        self.done = self.search.done

    def step(self) -> None:
        begun = monotonic()
        if self.search.work >= self.work:
            self.fails = self.search.fails
            self.most_found = self.best()
            self.turn += 1
            if self.turn % len(self.roots) == 0:
                self.work *= GROWTH
            self._begin()
        if not self.done:
            self.kept.add(self.search.more(self._at_once))
            self.done = self.search.done
        took = monotonic() - begun
        self.seconds += took
        self._at_once = max(1, min(2 * self._at_once, int(self._at_once * SLICE / max(took, 1e-6))))

    def best(self) -> _Kept:
        """Return what the root that found most has found."""
        return max(self.most_found, self.kept, key=lambda kept: kept.count)


class _Sat:
    """The solver."""

    def __init__(self, tree: WalkTree, alike: Likeness, most: int, most_places: int | None) -> None:
        begun = monotonic()
        self.kept = _Kept(tree, most)
        self._sat = QuotientSat(tree, alike, closed=True, most_places=most_places)
        self.seconds = monotonic() - begun

    @property
    def done(self) -> bool:
        return self._sat.done

    def step(self, seconds: float) -> None:
        begun = monotonic()
        self.kept.add(self._sat.more(seconds))
        self.seconds += monotonic() - begun

    def close(self) -> None:
        self._sat.close()
