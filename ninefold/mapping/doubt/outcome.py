"""From the evidence of a walk to the maps it leaves: lists averaged, legs gathered to ways, every reading settled."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import product
from math import degrees, pi, prod, sqrt
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import counted, quoted

from .doubts import Doubt, doubts_of
from .exit_lists import averaged, biases
from .noise import CHANCE, SURE, threshold
from .orders import star_orders
from .reading import settled_reading
from .ways import bundles, partings, way_of

if TYPE_CHECKING:
    from collections.abc import Hashable, Iterator, Sequence

    from numpy.typing import NDArray

    from .evidence import Evidence
    from .exit_lists import Directions
    from .noise import NoiseModel
    from .orders import StarOrder
    from .reading import Reading
    from .ways import Bundle

__all__ = ["Outcome", "outcome_of"]

MOST_READINGS = 64
"""Readings of a walk, legs shared out among ways, up to which all are settled."""


ODD = 1e-4
"""Chance of a scatter among the legs of one way that makes two ways worth a reading, where no exits are listed."""


@dataclass(frozen=True, slots=True)
class Outcome:
    """What a walk leaves; the attributes are those of `Estimate`, with the readings that have a map."""

    count: int | None
    doubts: tuple[Doubt, ...]
    scatter: float | None
    warnings: tuple[str, ...]
    readings: tuple[Reading, ...]
    directions: tuple[Directions | None, ...] = field(default=())


def outcome_of(evidence: Evidence, noise: NoiseModel, *, effort: int) -> Outcome:
    """Return the maps that explain the evidence, or why there is none.

    Parameters
    ----------
    effort
        As in `estimate`.
    """
    visits_of = evidence.visits_of()
    variance = np.full(len(evidence.places), noise.sigma**2)
    floor = np.zeros(len(evidence.places))
    if noise.drift:
        bias, known = biases(evidence, visits_of, noise)
        if not noise.compass and not known.all():
            return _standing_unknown(evidence, known)
        evidence = evidence.without(bias)
        variance = np.where(known, 2 * noise.sigma**2, noise.sigma**2)
        floor = np.where(known, 0.0, noise.drift**2)
    directions = tuple(
        _directions_at(evidence, visits, float(variance[place]), float(floor[place]), noise)
        for place, visits in enumerate(visits_of)
    )
    found = _Gathering(noise, evidence, variance, floor, directions, effort).run()
    return replace(found, directions=directions)


def _directions_at(
    evidence: Evidence, visits: Sequence[int], variance: float, floor: float, noise: NoiseModel
) -> Directions | None:
    lists = [exits for visit in visits if (exits := evidence.exits[visit]) is not None]
    if not lists:
        return None
    found = averaged(lists, variance + floor, in_order=noise.in_order)
    if floor:  # the bias of a visit is in all its readings, and how it stood was not told: its lists count, no more
        return replace(found, lifts=(), free=0, contradicts=False)
    return found


class _Gathering:
    """Gathers legs to ways, and settles every reading."""

    def __init__(
        self,
        noise: NoiseModel,
        evidence: Evidence,
        variance: NDArray[np.float64],
        floor: NDArray[np.float64],
        directions: tuple[Directions | None, ...],
        effort: int,
    ) -> None:
        self.noise, self.evidence, self.variance, self.floor = noise, evidence, variance, floor
        self.directions, self.effort = directions, effort
        self.misses, self.free = 0.0, 0
        self.listed: dict[Hashable, tuple[list[StarOrder], float] | None] = {}
        for found in directions:
            if found is not None and found.free:
                self.misses += found.misses / noise.sigma**2
                self.free += found.free

    def run(self) -> Outcome:
        for place, found in enumerate(self.directions):
            if found is not None and found.contradicts:
                return self._none_left(f"the exits of {self._name(place)}, declared to be in order, are not", ())
        total = self.variance + self.floor
        gathered = bundles(self.evidence, total)
        room = self._room(gathered)
        for place, listed in enumerate(self.directions):
            if listed is not None and room[place] < 0:
                ways = counted(int(listed.count - room[place]), "way")
                return self._none_left(
                    f"{ways} leave {self._name(place)}, which lists {counted(listed.count, 'exit')}",
                    (self.evidence.places[place],),
                )
        options: list[list[tuple[Bundle, ...]]] = []
        open_bundles: list[Bundle] = []
        uncounted: list[Bundle] = []
        for bundle in gathered:
            most = 1 + self._spare(bundle, room)
            readings = partings(bundle, most, total, self.evidence.edges)
            if readings is None:
                uncounted.append(bundle)
                readings = [(bundle,)]
            else:
                readings = [parts for parts in readings if self._fit_exits(parts)] if len(readings) > 1 else readings
            if not readings:
                ends = tuple(dict.fromkeys((bundle.tail, bundle.head)))
                names = tuple(self.evidence.places[end] for end in ends)
                between = " and ".join(map(quoted, names))
                return self._none_left(f"the headings of the legs between {between} scatter too widely for one way", names)
            if len(readings) == 1 and len(readings[0]) == 1 and not (uncounted and uncounted[-1] is bundle):
                self.misses += 2 * bundle.scatter(total)
                self.free += 2 * (len(bundle.legs) - 1)
            if len(readings) > 1:
                open_bundles.append(bundle)
            options.append(readings)
        number = prod(map(len, options))
        settled: list[Reading] = []
        for parts in product(*options) if number <= MOST_READINGS else [tuple(each[0] for each in options)]:
            settled.append(self._settled([bundle for group in parts for bundle in group]))
            self.effort -= settled[-1].judged
            if settled[-1].crowded or self.effort <= 0:  # not counted in any case, and the others would take as long
                break
        return self._estimated(settled, open_bundles, uncounted, counted_all=len(settled) == number)

    def _name(self, place: int) -> str:
        return quoted(self.evidence.places[place])

    def _room(self, found: Sequence[Bundle]) -> NDArray[np.float64]:
        """Return how many exits of every place are left over, infinity where none are listed."""
        room = np.array([np.inf if one is None else one.count for one in self.directions])
        for bundle in found:
            room[bundle.tail] -= 1
            room[bundle.head] -= 1
        return room

    def _spare(self, bundle: Bundle, room: NDArray[np.float64]) -> int:
        """Return how many more ways than one a bundle may hold."""
        spare = min(room[bundle.tail], room[bundle.head])
        if np.isinf(spare):  # nothing is listed: one way, unless the legs scatter oddly or are named otherwise
            names = {name for leg in bundle.legs.tolist() if (name := self.evidence.edges[leg]) is not None}
            free = 2 * (len(bundle.legs) - 1)
            odd = free and bundle.scatter(self.variance + self.floor) > threshold(free, ODD)
            return max(len(names) - 1, 1 if odd else 0)
        return int(spare) // 2 if bundle.tail == bundle.head else int(spare)

    def _fit_exits(self, parts: tuple[Bundle, ...]) -> bool:
        """Whether the ways of a reading can be matched with listed exits at either end, whatever the other ways are."""
        for place in dict.fromkeys((parts[0].tail, parts[0].head)):
            found = self.directions[place]
            if found is None or not found.lifts or self.noise.useless:
                continue
            ends = [end for part in parts for end in self._ends(part, place)]
            orders = star_orders([yaw for yaw, _ in ends], [var for _, var in ends], found)
            if orders is not None and not orders[0]:
                return False
        return True

    def _ends(self, part: Bundle, place: int) -> Iterator[tuple[float, float]]:
        for end, at in ((part.out, part.tail), (part.back, part.head)):
            if at == place:
                yield float(end.mean()), float(self.variance[place]) / len(part.legs) + float(self.floor[place])

    def _settled(self, parts: Sequence[Bundle]) -> Reading:
        coarsest = pi - SURE * sqrt(2) * self.noise.sigma
        ways = [
            way_of(part, self.evidence, self.variance, self.floor, coarsest)
            for part in sorted(parts, key=lambda part: int(part.legs[0]))
        ]
        effort = max(self.effort, 0)
        return settled_reading(self.evidence, self.noise, ways, self.directions, effort=effort, listed=self.listed)

    # -- the answer ----------------------------------------------------------------------------------------------------

    def _estimated(
        self,
        settled: Sequence[Reading],
        open_bundles: Sequence[Bundle],
        uncounted: Sequence[Bundle],
        *,
        counted_all: bool,
    ) -> Outcome:
        from scipy.special import gammaincc

        left = [one for one in settled if one.failure is None and (one.settled is None or one.settled.failure is None)]
        if not left:
            if not counted_all or uncounted:
                return self._uncounted(settled, open_bundles, uncounted)
            return self._none_left(*_failure(settled[0]))
        misses, free = self.misses, self.free
        if counted_all and not uncounted:  # else no reading that is settled need be the true one
            nearest = min(left, key=lambda one: one.misses)
            misses, free = misses + nearest.misses, free + nearest.free
        scatter = self.noise.sigma * sqrt(misses / free) if free else None
        if free and float(gammaincc(free / 2, misses / 2)) < CHANCE:
            return self._none_left("the readings scatter more than that", (), scatter)
        doubts, count = doubts_of(left, open_bundles, uncounted, counted_all=counted_all)
        return Outcome(count, doubts, scatter, self._warnings(left[0]), tuple(left))

    def _uncounted(self, settled: Sequence[Reading], open_bundles: Sequence[Bundle], uncounted: Sequence[Bundle]) -> Outcome:
        doubts, _ = doubts_of(settled, open_bundles, uncounted, counted_all=False)
        return Outcome(None, doubts, None, (), ())

    def _none_left(self, why: str, places: tuple[str, ...], scatter: float | None = None) -> Outcome:
        if scatter is None and self.free:
            scatter = self.noise.sigma * sqrt(self.misses / self.free)
        seen = f"; the readings seem to err by {degrees(scatter):.2g} degrees" if scatter else ""
        text = (
            f"no map is left with headings that err by {degrees(self.noise.sigma):.3g} degrees: {why}{seen}; there is more "
            "noise than declared, or a place or a number of exits is wrong"
        )
        return Outcome(0, (Doubt("noise", places, (), text),), scatter, (), ())

    def _warnings(self, reading: Reading) -> tuple[str, ...]:
        found = []
        if self.evidence.unfinished:
            place = self._name(int(self.evidence.at[-1]))
            found.append(f"the walk ends on a leg from {place}, which is left out")
        untaken = [
            (place, known.count - len(reading.darts[place]))
            for place, known in enumerate(self.directions)
            if known is not None and known.count > len(reading.darts[place])
        ]
        if untaken:
            total = sum(number for _, number in untaken)
            verb = "was" if total == 1 else "were"
            found.append(f"{counted(total, 'exit')} {verb} never travelled, the first at {self._name(untaken[0][0])}")
        return tuple(found)


def _failure(reading: Reading) -> tuple[str, tuple[str, ...]]:
    """Return in words why a reading leaves no map, and where."""
    places = reading.evidence.places
    if reading.failure is not None:
        return reading.failure, ()
    where = reading.settled.failure if reading.settled is not None else None
    names = tuple(places[place] for place in where or ())
    if not names:
        return "what is certain of the orders around the places cannot be drawn in the plane", ()
    shown = ", ".join(map(quoted, names[:4])) + (" and others" if len(names) > 4 else "")
    return f"no order of the ways at {shown} can be drawn in the plane", names


def _standing_unknown(evidence: Evidence, known: NDArray[np.bool_]) -> Outcome:
    places = tuple(evidence.places[place] for place in np.flatnonzero(~known).tolist())
    shown = ", ".join(map(quoted, places[:3])) + (f" and {len(places) - 3} more" if len(places) > 3 else "")
    text = (
        "without a compass the lists of exits have to tell how the robot stands at every visit, and they do not at "
        f"{shown}; list all exits at every visit, in order"
    )
    return Outcome(None, (Doubt("uncounted", places, (), text),), None, (), ())
