"""The map that a walk with headings that err leaves, or every map that it leaves, with the doubt named.

Places are recognised, headings err. See the package's text for the promise that is kept.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field
from functools import cached_property
from math import log2
from typing import TYPE_CHECKING

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput, Undecided

from ..robot.walk import Walk
from .doubts import Again, Doubt, again
from .evidence import read_evidence
from .noise import NoiseModel
from .outcome import Outcome, outcome_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ..plane import PlaneMap
    from .reading import Found

__all__ = ["Estimate", "estimate"]

EFFORT = 20_000
"""Judgements after which a search stops uncounted, if nothing else is asked for."""


@dataclass(frozen=True, eq=False, repr=False)
class Estimate:
    """What a walk with headings that err says about the map; made by `estimate`.

    Attributes
    ----------
    noise
        What was declared.
    places
        Names of the places, in the order first seen.
    count
        Number of maps left; None where they were not counted, because too much is open together.
    doubts
        What is open, in the order of the places. Empty if and only if one map is left.
    scatter
        What the readings seem to err by, radians: the root mean square of their misses from the averages they belong to.
        None where nothing was read twice.
    warnings
        What is unfinished: a leg without end, exits never travelled.

    Examples
    --------
    >>> from math import radians
    >>> from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader, estimate
    >>> def leg(*degrees):
    ...     return Samples.of(*(Heading.from_degrees(d) for d in degrees))
    >>> events = Visit("a"), leg(1, -2), Visit("b"), leg(119, 121), Visit("c"), leg(242, 239), Visit("a")
    >>> found = estimate(Walk(WalkHeader(), events), sigma=radians(2))
    >>> found.certain, found.plane
    (True, PlaneMap(3 vertices, 3 edges, 2 faces))
    """

    noise: NoiseModel
    places: tuple[str, ...]
    count: int | None
    doubts: tuple[Doubt, ...]
    scatter: float | None
    warnings: tuple[str, ...]
    _outcome: Outcome = field(repr=False)

    @property
    def certain(self) -> bool:
        """Whether one map is left."""
        return self.count == 1 and not self.doubts

    @property
    def bits(self) -> float | None:
        """How much is open: the logarithm to base 2 of the number of maps; None where it is not counted, or none is left."""
        return log2(self.count) if self.count else None

    @cached_property
    def plane(self) -> PlaneMap:
        """The map, where it is certain.

        Raises
        ------
        Undecided
            Where it is not; the message names what is in doubt.
        """
        if self.certain:
            return next(self.maps())
        raise Undecided(self._doubt_in_words(), kind="map")

    @cached_property
    def best(self) -> PlaneMap:
        """The likeliest map: a guess, unless it is certain.

        Raises
        ------
        Undecided
            If no map is left, or the orders of a place are too many to be listed.
        """
        found = next(self.maps(), None)
        if found is None:
            raise Undecided(self._doubt_in_words(), kind="map")
        return found

    def maps(self) -> Iterator[PlaneMap]:
        """Yield every map that is left, the likeliest first, as they are asked for.

        How likely is told by the squared misses of the readings, with a penalty for every way. Where `count` is None there
        may be very many, and some map comes first, not the likeliest.
        """
        found: Iterator[Found] = heapq.merge(
            *(reading.found() for reading in self._outcome.readings), key=lambda one: one.cost
        )
        return (one.plane for one in found)

    def more(self, doubt: Doubt | None = None) -> tuple[Again, ...]:
        """Return what to do to settle the doubts, or one of them: which ways to walk again, and how often."""
        if doubt is not None and doubt not in self.doubts:
            raise BadInput(f"a doubt is one of this estimate's doubts, not {quoted(doubt)}")
        asked = self.doubts if doubt is None else (doubt,)
        return tuple(
            one for each in asked if (one := again(each, self._outcome.readings, self._outcome.directions)) is not None
        )

    def _doubt_in_words(self) -> str:
        if self.count == 0:
            return str(self.doubts[0])
        number = "more maps than were counted" if self.count is None else counted(self.count, "map")
        shown = "; ".join(str(doubt) for doubt in self.doubts[:3])
        rest = f"; and {counted(len(self.doubts) - 3, 'doubt')} more" if len(self.doubts) > 3 else ""
        return (
            f"the map is not certain: {number} {'are' if self.count != 1 else 'is'} left; {shown}{rest}; Estimate.more() "
            "tells which walk would settle it, and Estimate.best is the likeliest map"
        )

    def __repr__(self) -> str:
        if self.certain:
            return f"Estimate(certain, {self.plane!r})"
        number = "maps not counted" if self.count is None else counted(self.count, "map")
        return f"Estimate({number}, {counted(len(self.doubts), 'doubt')})"


def estimate(
    walk: Walk,
    *,
    sigma: float | None = None,
    drift: float | None = None,
    effort: int = EFFORT,
) -> Estimate:
    """Tell which map a walk shows whose headings err, or every map that it may show.

    Parameters
    ----------
    walk
        Its places are recognised. Lists of exits, where it has them, count all exits and err as headings do; the header says
        whether they are listed in order.
    sigma
        Standard deviation of every heading, radians; left out, the header's.
    drift
        Standard deviation of an error that all headings of one visit share, radians: the bias of a compass. Left out, the
        header's, or 0. Without a compass (the header's ``compass`` is false), of its change along one leg. With lists of
        exits it is taken out; without, it is counted as noise that averaging does not lessen.
    effort
        Judgements of parts of a map after which what hangs together is left uncounted.

    Returns
    -------
    Estimate
        Errors independent, zero-mean, Gaussian, standard deviation at most sigma; places and exit counts right: then the
        true map is among those returned except with probability at most (alternatives examined) x 1e-9.

    Raises
    ------
    WalkError
        For a sigma or drift that is none, or missing; a place that was not recognised, or whose lists differ in their number
        of exits; a leg that cannot be read.

    Notes
    -----
    Ways between the same two places that leave both in the same direction but for noise count as one where no exits are
    listed at either place: nothing could tell them apart.

    Complexity O(samples + E) and O(E) for every alternative that is judged.
    """
    if not isinstance(walk, Walk):
        raise BadInput(f"an estimate is made from a Walk, such as read_walk gives, not from {quoted(walk)}")
    noise = _declared(walk, sigma, drift)
    outcome = outcome_of(evidence := read_evidence(walk), noise, effort=effort)
    return Estimate(noise, evidence.places, outcome.count, outcome.doubts, outcome.scatter, outcome.warnings, outcome)


def _declared(walk: Walk, sigma: float | None, drift: float | None) -> NoiseModel:
    header = walk.header
    sigma = header.sigma if sigma is None else sigma
    if sigma is None:
        raise BadInput(
            "how much headings err is not declared; give sigma, a standard deviation in radians, or let the walk's header"
        )
    drift = header.drift if drift is None else drift
    return NoiseModel(sigma, drift or 0.0, compass=header.compass, in_order=header.exits == "in-order")
