"""What to say when no place is left: what was seen, when, and which place came nearest."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import EmptyBelief

from ..heading import TAU
from ._outlook import likeliest_shift

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..plane import PlaneMap
    from ._matching import Look
    from ._stars import Stars

__all__ = ["empty_belief"]


def empty_belief(
    plane: PlaneMap,
    stars: Stars,
    places: NDArray[np.int64],
    look: Look,
    what: str,
    done: tuple[int, int],
    sigma: float,
    *,
    compass: bool,
) -> EmptyBelief:
    """Return the error for a belief that became empty.

    Parameters
    ----------
    places
        Those that were possible before.
    what
        What was seen, in words for where `look` says nothing.
    done
        Observations and moves made before.
    """
    observations, moves = done
    seen = what
    if look.exits is not None:
        seen = counted(look.exits.size, "exit") + (f" at {_degrees(look.exits)} deg" if look.exits.size else "")
        if look.back is not None:
            seen += f" and the way back at {degrees(look.back):.0f} deg"
    elif look.back is not None:
        seen = f"a way at {degrees(look.back):.0f} deg"
    nearest, text = _nearest(plane, stars, places, look, compass=compass)
    frame = "" if compass else " without a compass"
    return EmptyBelief(
        f"no place fits what was seen after {counted(observations, 'look')} and {counted(moves, 'move')}: {seen}; {text}; "
        f"the map must be wrong, or the noise model (sigma {degrees(sigma):.3g} degrees{frame})",
        observation=observations + 1,
        moves=moves,
        nearest=nearest,
    )


def _nearest(plane: PlaneMap, stars: Stars, places: NDArray[np.int64], look: Look, *, compass: bool) -> tuple[str, str]:
    """Return the place that comes nearest, and in words how near."""
    possible = f"of {counted(places.size, 'place')} possible before"
    degree = stars.degree[places]
    if look.exits is not None and look.exits.size:
        k = look.exits.size
        alike = places[degree == k]
        if not alike.size:
            v = int(places[np.abs(degree - k).argmin()])
            name = plane.vertex_names[v]
            return name, f"none {possible} has so many, {quoted(name)} has {counted(int(stars.degree[v]), 'exit')}"
        yaw = stars.heading[stars.darts(alike, k)]
        shift = likeliest_shift(yaw, look.exits, compass=compass)
        error = look.exits - np.take_along_axis(yaw, (np.arange(k) + shift[:, None]) % k, axis=1)
        if not compass:
            error -= error[:, :1]
        error -= TAU * np.round(error / TAU)
        if not compass:
            error -= error.mean(axis=1, keepdims=True)
    else:
        alike = places[degree > 0]
        if look.back is None or not alike.size:
            name = plane.vertex_names[int(places[0])]
            return name, f"{counted(places.size, 'place')} were possible before, {quoted(name)} among them"
        darts = np.concatenate(
            [stars.darts(alike[stars.degree[alike] == d], d).ravel() for d in np.unique(degree[degree > 0])]
        )
        error = look.back - stars.heading[darts]
        error -= TAU * np.round(error / TAU)
        alike, error = stars.tail[darts], error[:, None]
    worst = np.abs(error).max(axis=1)
    at = int(worst.argmin())
    name, off = plane.vertex_names[int(alike[at])], degrees(float(worst[at]))
    return name, f"nearest {possible} comes {quoted(name)}, off by {off:.0f} degrees"


def _degrees(yaw: NDArray[np.float64]) -> str:
    return ", ".join(f"{degrees(x):.0f}" for x in yaw.tolist())
