"""Where a robot can be when it is not known which of several maps is right: a localizer on each, weighed by what it sees.

All maps are equally likely at first. Each has a localizer of its own, and what a robot sees and does weighs the maps by how
likely it is on them: exact, under the noise model of a `Localizer`. Behind an exit that nobody walked anything can lie:
whatever a robot sees there fits as well as anything can, so no map falls for what is not known of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple, TypeAlias, get_args

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput, EmptyBelief

from .following import Follower
from .hypotheses import Hypothesis
from .untravelled import with_ends

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from ..robot.walk import Walk
    from .localizer import Localizer

__all__ = ["Whereabouts", "WhichMap", "locate_among"]

BeganAt: TypeAlias = Literal["anywhere", "end"]


class WhichMap(NamedTuple):
    """A place of a map where the robot can be.

    Attributes
    ----------
    map
        Number of the map, from 0, in the order given.
    vertex
        Name of the place; None where the robot left by an exit that nobody had walked.
    probability
        Of this map and this place.
    """

    map: int
    vertex: str | None
    probability: float


@dataclass(frozen=True, slots=True, eq=False)
class Whereabouts:
    """Which map is right and where on it the robot is; made by `locate_among`.

    Attributes
    ----------
    weights
        (M,) float64, how likely each map is; they add up to 1.
    localizers
        On each map, or None where the walk fits nowhere on it.
    n_places
        Places of each map that were visited; vertices of its localizer's map from there on are unknown, one behind every
        exit that nobody walked.
    """

    weights: NDArray[np.float64]
    localizers: tuple[Localizer | None, ...]
    n_places: tuple[int, ...]

    def candidates(self, mass: float = 0.999) -> tuple[WhichMap, ...]:
        """Return maps and places, the likeliest first: as few as together are this likely."""
        if isinstance(mass, bool) or not isinstance(mass, int | float) or not 0 < mass <= 1:
            raise BadInput(f"mass is a probability above 0 and at most 1, not {quoted(mass)}")
        found: list[WhichMap] = []
        for k, (robot, places) in enumerate(zip(self.localizers, self.n_places, strict=True)):
            if robot is not None:
                share = robot.probabilities * self.weights[k]
                names: list[str | None] = [robot.plane.vertex_names[v] for v in range(places)]
                shares = [*share[:places].tolist(), float(share[places:].sum())]
                found += [WhichMap(k, name, p) for name, p in zip([*names, None], shares, strict=True) if p > 0]
        found.sort(key=lambda one: -one.probability)
        enough = int(np.searchsorted(np.cumsum([one.probability for one in found]), mass - 1e-12)) + 1
        return tuple(found[:enough])

    @property
    def map_entropy(self) -> float:
        """What is not known of the map, in bits."""
        p = self.weights[self.weights > 0]
        return float(-(p * np.log2(p)).sum()) + 0.0

    def __repr__(self) -> str:
        left = int((self.weights > 0).sum())
        return f"Whereabouts({left} of {counted(self.weights.size, 'map')} left, {self.map_entropy:.1f} bits)"


def locate_among(
    maps: Iterable[Hypothesis], walk: Walk, *, sigma: float | None = None, start: BeganAt = "anywhere"
) -> Whereabouts:
    """Weigh the maps that explain one walk by another, and tell where on each the robot is at its end.

    Parameters
    ----------
    maps
        Such as `hypotheses` gives.
    walk
        What the robot saw and did since. Names of places in it are not looked at.
    sigma
        Standard deviation of a heading in radians; left out, what the walk's header declares, or 5 degrees.
    start
        ``"end"`` if the robot went on from the end of the walk that made the maps, ``"anywhere"`` if it was switched on
        again somewhere.

    Raises
    ------
    BadInput
        For no map, or what is none.
    WalkError
        For legs that cannot be read, with the number of the event, counted from 1.
    EmptyBelief
        If the walk fits on none of the maps; with the number of the event that the last of them did not fit.

    Notes
    -----
    All maps are equally likely before. Complexity that of `locate` on every map.
    """
    given = tuple(maps)
    if not given:
        raise BadInput("there is no map to be located on")
    if start not in get_args(BeganAt):
        raise BadInput(f"start is one of {', '.join(map(quoted, get_args(BeganAt)))}, not {quoted(start)}")
    for one in given:
        if not isinstance(one, Hypothesis):
            raise BadInput(f"maps are those of hypotheses(walk), not {quoted(one)}")
    localizers: list[Localizer | None] = []
    n_places: list[int] = []
    evidence = np.full(len(given), -np.inf)
    last: EmptyBelief | None = None
    for k, one in enumerate(given):
        wide = with_ends(one)
        plane = wide.plane
        began = None if start == "anywhere" else plane.vertex(plane.vertex_names[int(one.visits[-1])])
        follower = Follower(plane, walk.header, sigma=sigma, start=began, beyond=wide.unknown)
        n_places.append(wide.n_places)
        try:
            for event in walk.events:
                follower.step(event)
        except EmptyBelief as nowhere:
            if last is None or (nowhere.event or 0) > (last.event or 0):
                last = nowhere
            localizers.append(None)
            continue
        localizers.append(follower.localizer)
        evidence[k] = follower.localizer.log_evidence
    if last is not None and not np.isfinite(evidence).any():
        raise last
    weights = np.exp(evidence - evidence.max())
    return Whereabouts(weights / weights.sum(), tuple(localizers), tuple(n_places))
