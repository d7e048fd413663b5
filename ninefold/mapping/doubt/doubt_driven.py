"""Exploring to find out which map is the right one, where places look alike.

The robot recognises no place. What it knows is a tree, and the maps that explain it, with no more places than there are said
to be. It walks out the smallest map: to the nearest exit that is open in it, of several the one where the maps are left
fewest in expectation. Once the smallest map is closed it compares what the maps foretell: behind an exit that one says leads
to a dead end and another to a crossing, one of the two falls. It goes where fewest are left, over ways of which all maps
foretell the same. Comparing first and walking out later takes longer: see ``benchmarks/exploration.py``.
"""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

from ..robot.open_map import OPEN, OpenMap
from ..robot.walk import DEFAULT_TOLERANCE, checked_tolerance
from .likeness import likeness
from .quotients import QuotientSearch
from .walk_tree import WalkTree

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from .likeness import Likeness

__all__ = ["DoubtDriven"]

MAPS = 64
"""Maps compared at most, if nothing else is asked for."""

DECISIONS = 200_000
"""Decisions of a search for these maps at most, if nothing else is asked for."""

AHEAD = 2_000
"""Places looked at ahead, all maps together, at most, if nothing else is asked for."""


class _Map(NamedTuple):
    """One map: exit x of place w is ``w * K + x``."""

    mate: list[int]
    """Of every exit, the exit at the other end, or OPEN."""
    sight: list[int]
    """Of every exit, what a robot sees that arrives by it: two that look alike have one number."""
    degree: list[int]
    here: int
    """The robot's place, and by how much its exits are shifted against those of the robot's node."""
    shift: int
    n_places: int

    @property
    def closed(self) -> bool:
        """Whether no exit is open."""
        return len(self.mate) - self.mate.count(OPEN) == sum(self.degree)


class DoubtDriven:
    """A strategy that stops when one map is left, without recognising any place.

    Parameters
    ----------
    max_places
        How many places the world has at most: without a bound no walk excludes that every place is a new one.
    tolerance
        Radians within which two headings may be of one exit.
    maps
        How many maps are compared at most, the first that are found.
    decisions
        Of the search for them, at most.
    ahead
        Places looked at ahead, all maps together, at most. 0 compares nothing: always to the nearest open exit of the
        smallest map that has one.
    eager
        Compare the maps before the smallest is walked out: always the leg that leaves fewest.

    Attributes
    ----------
    left
        Number of maps that explain what was walked, as far as they are known: none if there are more places than said, or
        the search for them was given up.
    exact
        Whether that is all of them.

    Notes
    -----
    The expectation takes the maps compared for equally likely; a map in which an exit is open foretells nothing behind it
    and is counted as left whatever is seen there. Explore with ``places=False``.

    Examples
    --------
    >>> from ninefold.mapping import SimulatedWorld, explore
    >>> world = SimulatedWorld([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    >>> strategy = DoubtDriven(4)
    >>> explore(world, tour=strategy, places=False).walk.n_legs, strategy.left, strategy.exact
    (4, 1, True)
    """

    def __init__(
        self,
        max_places: int,
        *,
        tolerance: float = DEFAULT_TOLERANCE,
        maps: int = MAPS,
        decisions: int = DECISIONS,
        ahead: int = AHEAD,
        eager: bool = False,
    ) -> None:
        for what, value in (("max_places", max_places), ("maps", maps), ("decisions", decisions)):
            if isinstance(value, bool) or not isinstance(value, int) or value < 1:
                raise BadInput(f"{what} is a whole number, 1 or more, not {quoted(value)}")
        if isinstance(ahead, bool) or not isinstance(ahead, int) or ahead < 0:
            raise BadInput(f"ahead is a whole number, 0 or more, not {quoted(ahead)}")
        self.max_places, self.tolerance, self.maps, self.decisions = (
            max_places,
            checked_tolerance(tolerance),
            maps,
            decisions,
        )
        self._ahead, self._eager = ahead, eager
        self.left, self.exact = 1, False
        self._found: list[_Map] = []
        self._places = 0
        self._plan: list[int] = []

    def __call__(self, known: OpenMap) -> int | None:
        """Return the exit to take, or None when one map is left or none, or nothing can be told any more."""
        if known.n_places != self._places:  # walking where the tree leads anyway tells nothing
            self._places = known.n_places
            self._look(known)
            self._plan = []
        if not self.left or (self.exact and self.left == 1 and self._found[0].closed):
            return None
        if not self._plan:
            self._plan = self._planned(known)
        if not self._plan:
            return None
        step = self._plan.pop()
        exits = known.exits(known.at)
        return exits[step % len(exits)] if known.came < 0 else exits[(known.came - exits.start + step) % len(exits)]

    def _look(self, known: OpenMap) -> None:
        """Find the maps that explain what was walked."""
        tree = _tree_of(known, self.tolerance)
        alike = likeness(tree)
        search = QuotientSearch(tree, alike, most_places=self.max_places)
        rows: list[NDArray[np.int64]] = []
        while not search.done and search.decisions < self.decisions and len(rows) < self.maps:
            rows.extend(search.more(min(512, self.decisions), most=self.maps - len(rows)))
        self.left, self.exact = len(rows), search.done
        self._found = sorted((_map_of(tree, alike, row, known.at) for row in rows), key=lambda one: one.n_places)

    def _planned(self, known: OpenMap) -> list[int]:
        """Return the steps to take, in reverse: by how many exits to turn counter-clockwise from the way back."""
        maps = self._found
        behind = known.came - known.first[known.at] if known.came >= 0 else 0
        start = [
            one.here * _width(one) + (behind + one.shift) % one.degree[one.here] for one in maps if one.degree[one.here]
        ]
        if not start:
            return []
        compares = self._ahead > 0 and len(maps) > 1
        if compares and self._eager and (plan := _telling(maps, start, self._ahead)):
            return plan
        if nearest := _to_open_exits(maps[0], start[0]):
            if compares:
                nearest.sort(key=lambda steps: _worth(maps, start, steps))
            return list(nearest[0])[::-1]
        if compares and (plan := _telling(maps, start, self._ahead)):
            return plan
        for one, at in zip(maps, start, strict=True):
            if nearest := _to_open_exits(one, at):
                return list(nearest[0])[::-1]
        return []


def _width(one: _Map) -> int:
    return len(one.mate) // len(one.degree)


def _turned(one: _Map, behind: int, step: int) -> int:
    """Return the exit so many counter-clockwise from another of its place."""
    place, exit_number = divmod(behind, _width(one))
    return place * _width(one) + (exit_number + step) % one.degree[place]


def _telling(maps: Sequence[_Map], start: list[int], ahead: int) -> list[int]:
    """Return the steps, in reverse, of a shortest way to where maps foretell different things; of several the best one."""
    ring: list[tuple[tuple[int, ...], tuple[int, ...]]] = [(tuple(start), ())]
    seen = {tuple(start)}
    looked = 0
    while ring and looked < ahead:
        best: tuple[float, tuple[int, ...]] | None = None
        further: list[tuple[tuple[int, ...], tuple[int, ...]]] = []
        for behind, steps in ring:
            for step in range(maps[0].degree[behind[0] // _width(maps[0])]):
                looked += len(maps)
                backs = tuple(one.mate[_turned(one, at, step)] for one, at in zip(maps, behind, strict=True))
                left = _expected([None if back == OPEN else one.sight[back] for one, back in zip(maps, backs, strict=True)])
                if left < len(maps) - 1e-9:
                    best = min(best or (left, (*steps, step)), (left, (*steps, step)))
                elif OPEN not in backs and backs not in seen:
                    seen.add(backs)
                    further.append((backs, (*steps, step)))
        if best is not None:
            return list(best[1])[::-1]
        ring = further
    return []


def _expected(seen: Sequence[object]) -> float:
    """Return how many maps are left in expectation; `seen` is what each foretells, None where it foretells nothing."""
    groups = Counter(one for one in seen if one is not None)
    unknown = len(seen) - groups.total()
    return (sum(size * (size + unknown) for size in groups.values()) + unknown * unknown) / len(seen)


def _worth(maps: Sequence[_Map], start: list[int], steps: tuple[int, ...]) -> tuple[int, float]:
    """Return how good steps are, less being better: minus the maps that foretell nothing there, and how many are left."""
    seen: list[object] = []
    for one, begin in zip(maps, start, strict=True):
        back, sights = begin, []
        for step in steps:
            back = one.mate[_turned(one, back, step)]
            if back == OPEN:
                break
            sights.append(one.sight[back])
        seen.append(None if back == OPEN else tuple(sights))
    return -seen.count(None), _expected(seen)


def _to_open_exits(one: _Map, start: int) -> list[tuple[int, ...]]:
    """Return the steps to each of the nearest open exits of a map; none if there is none."""
    ring: list[tuple[int, tuple[int, ...]]] = [(start, ())]
    seen = {start // _width(one)}
    while ring:
        found, further = [], []
        for behind, steps in ring:
            for step in range(one.degree[behind // _width(one)]):
                back = one.mate[_turned(one, behind, step)]
                if back == OPEN:
                    found.append((*steps, step))
                elif back // _width(one) not in seen:
                    seen.add(back // _width(one))
                    further.append((back, (*steps, step)))
        if found:
            return found
        ring = further
    return []


def _tree_of(known: OpenMap, tolerance: float) -> WalkTree:
    """Return what a robot knows that recognises no place, as the tree of a walk that ends where the robot is."""
    count = known.n_places
    bounds = np.array(known.first, np.int64)
    degree = bounds[1:] - bounds[:-1]
    width = max(1, int(degree.max()))
    place = np.array(known.place, np.int64)
    number = np.arange(place.size) - bounds[place]
    heading = np.full((count, width), np.nan)
    other, back = np.full((count, width), OPEN, np.int64), np.full((count, width), OPEN, np.int64)
    turn = np.zeros((count, width))
    heading[place, number] = known.heading
    mate = np.array(known.mate, np.int64)
    walked = mate != OPEN
    other[place[walked], number[walked]] = place[mate[walked]]
    back[place[walked], number[walked]] = number[mate[walked]]
    turn[place, number] = known.turn
    visits = np.arange(count, dtype=np.int64)
    nothing = np.zeros(count, np.int64)
    return WalkTree(
        degree, heading, other, back, turn, visits, nothing, nothing[1:], tuple(known.names), known.compass, tolerance
    )


def _map_of(tree: WalkTree, alike: Likeness, row: NDArray[np.int64], here: int) -> _Map:
    """Return a quotient as what its ways and places look like; exits of a place are those of the search."""
    width = tree.heading.shape[1]
    places, place = np.unique(row[:, 0], return_inverse=True)
    n, x = np.nonzero(np.arange(width)[None, :] < tree.degree[:, None])
    exits = place[n] * width + (x + row[n, 1]) % tree.degree[n]
    sight = np.full(places.size * width, OPEN, np.int64)
    sight[exits] = alike.kind[n, x]
    mate = np.full(places.size * width, OPEN, np.int64)
    walked = tree.other[n, x] >= 0
    m, y = tree.other[n, x][walked], tree.back[n, x][walked]
    mate[exits[walked]] = place[m] * width + (y + row[m, 1]) % tree.degree[m]
    degree = np.zeros(places.size, np.int64)
    degree[place] = tree.degree
    return _Map(mate.tolist(), sight.tolist(), degree.tolist(), int(place[here]), int(row[here, 1]), places.size)
