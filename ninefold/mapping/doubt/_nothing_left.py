"""What to say when no place is left: what was seen, when, and which place came nearest."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import EmptyBelief

from ..heading import wrap_all
from ._outlook import likeliest_shift

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..plane import PlaneMap
    from ..robot.units import Unit
    from ._matching import Look
    from ._stars import Stars

__all__ = ["Before", "empty_belief"]


class Before(NamedTuple):
    """Where the robot could be before, by place, each once; and the observations and moves made until then."""

    places: NDArray[np.int64]
    observations: int
    moves: int


def empty_belief(
    plane: PlaneMap, stars: Stars, before: Before, look: Look, what: str, noise: str, unit: Unit, *, compass: bool
) -> EmptyBelief:
    """Return the error for a belief that became empty.

    Parameters
    ----------
    look
        What was seen.
    what
        The same in words, for where `look` says nothing.
    noise
        The noise model in words.
    """
    seen = []
    if look.exits is not None:
        headings = f" at {unit.sense}{unit.headings(look.exits)} {unit.measure}" if look.exits.size else ""
        seen.append(counted(look.exits.size, "exit") + headings)
    if look.back is not None:
        seen.append(f"{what} at {unit.heading(look.back)}")
    nearest, how_near = _nearest(plane, stars, before.places, look, unit, compass=compass)
    done = f"{counted(before.observations, 'look')} and {counted(before.moves, 'move')}"
    return EmptyBelief(
        f"after {done} no place is left: none of the {counted(before.places.size, 'place')} possible before fits "
        f"{' with '.join(seen) or what}; {how_near}; either the map is wrong or the noise model is ({noise})",
        observation=before.observations + 1,
        moves=before.moves,
        nearest=nearest,
    )


def _nearest(
    plane: PlaneMap, stars: Stars, places: NDArray[np.int64], look: Look, unit: Unit, *, compass: bool
) -> tuple[str | None, str]:
    """Return the place that comes nearest, and in words how near."""
    degree = stars.degree[places]
    if look.exits is not None and look.exits.size:
        k = look.exits.size
        if not (degree == k).any():
            v = int(places[np.abs(degree - k).argmin()])
            name = plane.vertex_names[v]
            return name, f"none has so many, {quoted(name)} has {counted(int(stars.degree[v]), 'exit')}"
        alike = places[degree == k]
        error = _least_errors(stars.heading[stars.darts(alike, k)], look.exits, compass=compass)
    elif look.back is not None and compass and (degree > 0).any():
        ways = [stars.darts(places[degree == k], k).ravel() for k in np.unique(degree[degree > 0]).tolist()]
        darts = np.concatenate(ways)
        alike = stars.tail[darts]
        error = look.back - stars.heading[darts]
        error = wrap_all(error)[:, None]
    else:
        name = plane.vertex_names[int(places[0])]
        return name, f"{quoted(name)} was among them"
    worst = np.abs(error).max(axis=1)
    at = int(worst.argmin())
    name = plane.vertex_names[int(alike[at])]
    return name, f"nearest comes {quoted(name)}, its headings off by {unit.angle(float(worst[at]))}"


def _least_errors(yaw: NDArray[np.float64], exits: NDArray[np.float64], *, compass: bool) -> NDArray[np.float64]:
    """Return the errors of each exit seen against those of each place, (n, k), in the likeliest order."""
    k = exits.size
    shift = likeliest_shift(yaw, exits, compass=compass)
    error = exits - np.take_along_axis(yaw, (np.arange(k) + shift[:, None]) % k, axis=1)
    if not compass:
        error -= error[:, :1]
    error = wrap_all(error)
    return error if compass else error - error.mean(axis=1, keepdims=True)
