"""Where a robot can be, as a picture shows it: which places are marked, how, and in which words.

Only places are marked that together hold 99.9 % of the belief; the rest would be dots everywhere that mean next to nothing.
The area of a mark grows with how likely its place is, and its colour tells in four steps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import counted, percent
from ninefold.errors import BadInput

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ninefold.mapping import PlaneMap

__all__ = ["Belief", "Spot", "belief_of"]

MASS = 0.999
"""Share of the belief that is shown."""

_STEPS = (0.5, 0.1, 0.01, 0.0)

_NAMED_FROM = 0.1
_SHARES_ADD_UP_TO = 1e-6


@dataclass(frozen=True, slots=True)
class Spot:
    """A marked place.

    Attributes
    ----------
    vertex
        Its number.
    share
        How likely the robot is there.
    step
        0 for at least 50 %, 1 for at least 10 %, 2 for at least 1 %, 3 for less.
    """

    vertex: int
    share: float
    step: int

    @property
    def radius(self) -> float:
        """Pixels, so that the area tells the share, on top of what every dot has."""
        return 1.5 + 11.0 * math.sqrt(self.share)


@dataclass(frozen=True, slots=True)
class Belief:
    """What a picture shows of a belief.

    Attributes
    ----------
    plane
        The map.
    spots
        The marked places, the likeliest first.
    bits
        What is not known: 0 where one place is certain.
    """

    plane: PlaneMap
    spots: tuple[Spot, ...]
    bits: float

    @property
    def entries(self) -> tuple[tuple[int, str], ...]:
        """Each step in use, and its line in the legend."""
        words = ("at least 50 %", "10 to 50 %", "1 to 10 %", "below 1 %")
        counts = np.bincount([spot.step for spot in self.spots], minlength=len(_STEPS)).tolist()
        return tuple((k, f"{words[k]}: {counted(n, 'place')}") for k, n in enumerate(counts) if n)

    @property
    def caption(self) -> str:
        """The line below the picture."""
        top = self.spots[0]
        likeliest = f"{self.plane.vertex_names[top.vertex]}, {percent(top.share)}"
        if len(self.spots) == 1:
            return f"the robot is as good as certainly at {likeliest}"
        where = f"with {percent(MASS)} the robot is at one of the {counted(len(self.spots), 'place')} marked"
        alike = self.spots[0].share < 2 * self.spots[-1].share
        return f"{where}, {'all about as likely' if alike else f'likeliest at {likeliest}'}; {self.bits:.1f} bits are open"

    @property
    def names(self) -> dict[int, str]:
        """The places to be named even where names are not shown, at most ten, and the text."""
        return {spot.vertex: self.text(spot) for spot in self.spots if spot.share >= _NAMED_FROM}

    def text(self, spot: Spot) -> str:
        """Return the name of a marked place and how likely it is."""
        return f"{self.plane.vertex_names[spot.vertex]}: {percent(spot.share)}"


def belief_of(plane: PlaneMap, shares: ArrayLike | None) -> Belief | None:
    """Return what to show of the probabilities of all places, (V,), or None without any.

    Raises
    ------
    BadInput
        For numbers that are no probabilities of the map's places, or do not add up to 1.
    """
    if shares is None:
        return None
    p = _checked(plane, shares)
    order = np.argsort(-p, kind="stable")
    shown = order[: int(np.searchsorted(np.cumsum(p[order]), MASS - 1e-12)) + 1]
    step = np.searchsorted(-np.array(_STEPS), -p[shown])
    some = p[p > 0]
    bits = float(-(some * np.log2(some)).sum()) + 0.0
    spots = [Spot(v, s, k) for v, s, k in zip(shown.tolist(), p[shown].tolist(), step.tolist(), strict=True)]
    return Belief(plane, tuple(spots), bits)


def _checked(plane: PlaneMap, shares: ArrayLike) -> NDArray[np.float64]:
    try:
        p = np.array(shares, np.float64)
    except (TypeError, ValueError):
        raise BadInput("a belief is one probability for each place, as Localizer.probabilities gives them") from None
    if p.shape != (plane.n_vertices,):
        raise BadInput(
            f"a belief has one probability for each of the {counted(plane.n_vertices, 'vertex', 'vertices')}, as "
            f"Localizer.probabilities gives them, not an array of shape {p.shape}"
        )
    if not (np.isfinite(p).all() and (p >= 0).all() and abs(p.sum() - 1) <= _SHARES_ADD_UP_TO):
        raise BadInput("the probabilities of a belief are not negative and add up to 1")
    return p
