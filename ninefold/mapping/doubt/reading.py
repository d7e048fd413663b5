"""One reading of a walk, settled: its legs shared out among ways, and the maps that are then left.

The ways of a reading are the edges of its maps. Around every place their orders are listed (`orders`), genus and turning
settle what they can (`settling`), and what remains is built into maps when asked for.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from itertools import count, product
from math import log, pi, prod
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._wording import quoted

from ..checks import face_labels, face_permutation
from ..plane import PlaneMap
from ..turning import corner_angles
from .legality import Arrangement
from .noise import LOG_ODDS
from .orders import StarOrder, fitted, star_orders
from .settling import Settled, Star, settle
from .whole_turns import misses_by_outer_face, outer_faces, settled_turns

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from .evidence import Evidence
    from .exit_lists import Directions
    from .noise import NoiseModel
    from .ways import Way

__all__ = ["Found", "Reading", "settled_reading"]

MOST_FACES = 3000
"""Faces up to which the outer one is found by likelihood: a dense matrix of their covariances."""

MOST_LIFTED = 64
"""Orders of one rotation up to which they are weighed against each other, where whole turns are not certain."""


class Found(NamedTuple):
    """A map that explains the walk, and minus the logarithm of its likelihood but for a constant."""

    cost: float
    plane: PlaneMap


@dataclass(slots=True)
class Reading:
    """A walk read in one way.

    Attributes
    ----------
    ways, edge_names
        The edges, numbered as in its maps: dart 2e leaves the tail of way e; and their names.
    orders
        Per place with ways, the orders that its evidence leaves open, the likeliest first.
    darts
        Per place, its darts ascending; an order numbers them.
    settled
        What genus and turning leave.
    failure
        None; or in words why no map is left.
    misses, free
        Sum of squared misses of ways from listed exits, in standard deviations, and its number of free errors.
    crowded
        Places of which more orders are open than can be listed; the reading is then not settled.
    cost
        Of the reading itself: a penalty for every way, so that a likeliest map is not the one with the most ways.
    untold
        Whether maps were left out because their outer face could not be told, among so many.
    """

    evidence: Evidence
    noise: NoiseModel
    ways: tuple[Way, ...]
    edge_names: tuple[str, ...]
    orders: dict[int, list[StarOrder]]
    darts: list[list[int]]
    settled: Settled | None = None
    failure: str | None = None
    misses: float = 0.0
    free: int = 0
    crowded: tuple[int, ...] = ()
    cost: float = 0.0
    untold: bool = False

    @property
    def judged(self) -> int:
        """How often a part of its maps was judged so far."""
        return 0 if self.settled is None else self.settled.judged

    @property
    def variances(self) -> NDArray[np.float64]:
        """Variance of the mean heading of every dart, (2E,)."""
        return np.array([v for way in self.ways for v in (way.var_out, way.var_back)], np.float64)

    @property
    def headings(self) -> NDArray[np.float64]:
        """Mean heading of every dart, (2E,) radians, not wrapped."""
        return np.array([h for way in self.ways for h in (way.out, way.back)], np.float64)

    def found(self) -> Iterator[Found]:
        """Yield the maps, the likeliest first, as they are asked for."""
        if self.settled is None or self.settled.failure is not None:
            return
        factors = self.settled.factors
        number = count()
        first = [factor.get(0) for factor in factors]
        if any(choice is None for choice in first):
            return
        heap = [(sum(choice.cost for choice in first if choice), next(number), (0,) * len(factors))]
        while heap:
            cost, _, picked = heapq.heappop(heap)
            choices = [factor.get(n) for factor, n in zip(factors, picked, strict=True)]
            orders = dict(pair for choice in choices if choice for pair in choice.orders)
            turns = dict(pair for choice in choices if choice for pair in choice.turns)
            for more, plane in self._planes(orders, turns):
                yield Found(self.cost + cost + more, plane)
            last = max((i for i, n in enumerate(picked) if n), default=0)
            for i in range(last, len(factors)):
                following, here = factors[i].get(picked[i] + 1), choices[i]
                if following is not None and here is not None:
                    step = (*picked[:i], picked[i] + 1, *picked[i + 1 :])
                    heapq.heappush(heap, (cost - here.cost + following.cost, next(number), step))

    def _planes(self, numbers: dict[int, int], turns: dict[int, int]) -> Iterator[tuple[float, PlaneMap]]:
        """Yield the map of one order at every place; where whole turns are not certain, one for every outer face."""
        after, heading, moved = self._stars(numbers)
        # the lifts agree with the net rotations up to whole turns at either end, and so does what they are moved to
        turn = np.array([way.turns[turns.get(e, 0)] for e, way in enumerate(self.ways)], np.float64)
        fitted_turn = turn + moved[1::2] - moved[0::2]
        read = np.array([way.read for way in self.ways], np.float64)
        metres = self._metres()
        tail = np.array([v for way in self.ways for v in (way.tail, way.head)], np.int32)

        def plane(turn: NDArray[np.float64]) -> PlaneMap:
            return PlaneMap.from_darts(
                tail,
                after,
                n_vertices=len(self.evidence.places),
                heading=heading,
                turn=turn,
                metres=metres,
                vertex_names=self.evidence.places,
                edge_names=self.edge_names,
            )

        if not self.noise.wanders or not self.ways:
            yield 0.0, plane(np.where(np.abs(fitted_turn - read) < pi / 2, read, fitted_turn))
            return
        for face, (miss, lifted) in self._by_outer_face(numbers).items():
            _, heading, moved = self._stars(lifted)
            fitted_turn = turn + moved[1::2] - moved[0::2]
            yield miss, plane(settled_turns(*self._faces(after, heading), fitted_turn, face))

    def _by_outer_face(self, numbers: Mapping[int, int]) -> dict[int, tuple[float, dict[int, int]]]:
        """Return the outer faces that one rotation can have, the likeliest first: half squared miss, and its orders.

        Orders of one rotation may differ in which corner is the wide one; all are weighed. None is returned where there
        are too many to tell.
        """
        alike = [
            [n for n, order in enumerate(self.orders[place]) if order.ways == self.orders[place][number].ways]
            for place, number in numbers.items()
        ]
        if prod(map(len, alike)) > MOST_LIFTED:
            self.untold = True
            return {}
        found: dict[int, tuple[float, dict[int, int]]] = {}
        for picked in product(*alike):
            lifted = dict(zip(numbers, picked, strict=True))
            after, heading, _ = self._stars(lifted)
            faces = self._faces(after, heading)
            if faces[2] > MOST_FACES:
                self.untold = True
                return {}
            miss = self._misses_by_outer_face(faces)
            for face in outer_faces(miss).tolist():
                if face not in found or miss[face] < found[face][0]:
                    found[face] = float(miss[face]), lifted
        least = min(miss for miss, _ in found.values())
        near = {face: each for face, each in found.items() if each[0] <= least + LOG_ODDS}
        return dict(sorted(near.items(), key=lambda each: each[1][0]))

    def outer_faces(self) -> int:
        """Return the number of faces that can be the outer one of the likeliest map, 0 if they are too many to tell."""
        if self.settled is None or self.settled.failure is not None or not self.ways:
            return 1
        choices = [factor.get(0) for factor in self.settled.factors]
        return len(self._by_outer_face(dict(pair for choice in choices if choice for pair in choice.orders)))

    def _stars(self, numbers: Mapping[int, int]) -> tuple[NDArray[np.int32], NDArray[np.float64], NDArray[np.float64]]:
        """Return the rotation, headings that fit it, and how far those are moved from the means of the legs."""
        n = 2 * len(self.ways)
        after = np.arange(n, dtype=np.int32)
        heading, moved, variance = np.zeros(n), np.zeros(n), self.variances
        for place, number in numbers.items():
            order, darts = self.orders[place][number], self.darts[place]
            around = [darts[i] for i in order.ways]
            heading[around] = fitted(order, [float(variance[dart]) for dart in darts])
            moved[around] = heading[around] - order.lifts
            after[around] = [*around[1:], around[0]]
        return after, heading, moved

    @staticmethod
    def _faces(
        after: NDArray[np.int32], heading: NDArray[np.float64]
    ) -> tuple[NDArray[np.int32], NDArray[np.int32], int, NDArray[np.float64]]:
        next_face = face_permutation(after)
        face_of, n_faces = face_labels(next_face)
        return next_face, face_of, n_faces, corner_angles(after, heading)

    def _misses_by_outer_face(
        self, faces: tuple[NDArray[np.int32], NDArray[np.int32], int, NDArray[np.float64]]
    ) -> NDArray[np.float64]:
        passes = np.array([len(way.legs) for way in self.ways], np.float64)
        variance = self.variances
        var_turn = (2 * self.noise.sigma**2 + self._drift_of_leg()) / passes + variance[0::2] + variance[1::2]
        felt = np.array([way.felt for way in self.ways], np.float64)  # whatever the frame did meanwhile
        return misses_by_outer_face(*faces, felt, var_turn)

    def _drift_of_leg(self) -> float:
        drift = self.noise.drift**2
        return 2 * drift if self.noise.compass else drift

    def _metres(self) -> NDArray[np.float64] | None:
        measured = [self.evidence.metres[way.legs] for way in self.ways]
        if all(np.isnan(each).all() for each in measured):
            return None
        return np.array([float(np.nanmean(each)) if not np.isnan(each).all() else np.nan for each in measured])


def _edge_names(called: Sequence[str | None], ways: Sequence[Way]) -> tuple[str, ...]:
    """Return the names of the edges: as the log calls them, else ``e`` and their number."""
    given = [next((name for leg in way.legs.tolist() if (name := called[leg]) is not None), None) for way in ways]
    taken = {name for name in given if name is not None}
    names = []
    for number, name in enumerate(given):
        if name is None:
            name = f"e{number}"
            while name in taken:
                name += "'"
        names.append(name)
    return tuple(names)


def settled_reading(
    evidence: Evidence,
    noise: NoiseModel,
    ways: Sequence[Way],
    directions: Sequence[Directions | None],
    *,
    effort: int,
    listed: dict[Hashable, tuple[list[StarOrder], float] | None],
) -> Reading:
    """List the orders at every place and settle them.

    Parameters
    ----------
    ways
        In the order of their first legs.
    directions
        (V,) what the lists of a place say, None where there are none.
    effort
        As in `settle`.
    listed
        The orders of places that other readings of the walk have listed; most places are the same in all of them.
    """
    darts: list[list[int]] = [[] for _ in evidence.places]
    for e, way in enumerate(ways):
        darts[way.tail].append(2 * e)
        darts[way.head].append(2 * e + 1)
    penalty = len(ways) * log(max(evidence.n_legs, 2))
    reading = Reading(evidence, noise, tuple(ways), _edge_names(evidence.edges, ways), {}, darts, cost=penalty)
    heading, variance = reading.headings, reading.variances
    crowded = []
    for place, here in enumerate(darts):
        if not here:
            continue
        evidence_here = tuple(heading[here].tolist()), tuple(variance[here].tolist())
        if (place, evidence_here) not in listed:
            listed[place, evidence_here] = star_orders(*evidence_here, directions[place], closes=not noise.useless)
        found = listed[place, evidence_here]
        if found is None:
            crowded.append(place)
            continue
        reading.orders[place], miss = found
        known = directions[place]
        if known is not None and known.lifts and not noise.useless:
            reading.misses += 2 * miss
            reading.free += len(here)
        if not reading.orders[place]:
            reading.failure = f"the ways and the exits listed at {quoted(evidence.places[place])} contradict each other"
            return reading
    if crowded:
        reading.crowded = tuple(crowded)
        return reading
    stars = {place: _alternatives(reading, place) for place in reading.orders}
    tail = np.array([v for way in ways for v in (way.tail, way.head)], np.int64)
    reading.settled = settle(
        stars,
        [way.turns for way in ways],
        lambda: Arrangement(tail, len(evidence.places), turning=not noise.wanders),
        effort=effort,
    )
    return reading


def _alternatives(reading: Reading, place: int) -> list[Star]:
    darts = reading.darts[place]
    return [
        Star(tuple(darts[i] for i in order.ways), order.corners, order.cost, number)
        for number, order in enumerate(reading.orders[place])
    ]
