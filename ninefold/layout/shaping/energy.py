"""The energy of a triangulated picture, and one damped step towards less of it.

Two things are summed. *Pulls* on pieces say what the picture should look like: `KeepPicture` (as it was), `EvenLengths`, or
`FollowHeadings` of `ninefold.layout.shaping.directions`. The *shape* of every triangle says that none may be flat or the
wrong way round: the sum of its squared sides over its area (1 for an equilateral triangle, growing without bound as it gets
flat), with the area replaced by a positive one where it is not, so that a folded triangle has a way out.

References
----------
V. Garanzha, I. Kaporin, L. Kudryavtseva, F. Protais, N. Ray and D. Sokolov, Foldover-free maps in 50 lines of code, ACM
Transactions on Graphics 40, 2021. K. Hormann and G. Greiner, MIPS: an efficient global parametrization method, 2000.
"""

from __future__ import annotations

from itertools import count
from typing import TYPE_CHECKING, Protocol

import numpy as np

from .equations import System, scattered
from .mesh import doubled_areas, squared_sides, too_flat

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .mesh import Mesh
    from .pieces import Pieces

__all__ = ["EvenLengths", "KeepPicture", "Pull", "damped", "newton_step"]

_SIDES = np.array([[2.0, -1.0, -1.0], [-1.0, 2.0, -1.0], [-1.0, -1.0, 2.0]])
_PLANE_SIDES = np.kron(2 * _SIDES, np.eye(2))
EQUILATERAL = 2 * np.sqrt(3.0)
"""Sum of squared sides over twice the area of an equilateral triangle."""

_TINY = 1e-300
_POINT = 1e-24
GROW = 2.0


class Pull(Protocol):
    """What pieces are drawn to: for each piece A (2, 2), g (2,), and the energy D' A D / 2 - g' D of its difference D."""

    def terms(self, points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return A (M, 2, 2) and g (M, 2) for a picture."""


class KeepPicture:
    """Every piece back to what it was in a given picture: its direction most, its length less, relative to its size."""

    def __init__(self, pieces: Pieces, points: NDArray[np.float64], *, smallest: float = 0.02) -> None:
        step = points[pieces.head] - points[pieces.tail]
        length = np.hypot(*step.T)
        t = step / np.maximum(length, 1e-12)[:, None]
        n = np.stack([-t[:, 1], t[:, 0]], axis=1)
        weight = np.where(pieces.real, 1.0, 0.01) / np.maximum(length, smallest) ** 2
        self._blocks = weight[:, None, None] * (9 * n[:, :, None] * n[:, None, :] + 0.25 * t[:, :, None] * t[:, None, :])
        self._wanted = np.einsum("kij,kj->ki", self._blocks, step)

    def terms(self, points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return A and g; they do not depend on the picture."""
        return self._blocks, self._wanted


class EvenLengths:
    """Every piece to length 1, in whatever direction it has."""

    def __init__(self, pieces: Pieces) -> None:
        self._pieces = pieces

    def terms(self, points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return A and g at a picture."""
        step = points[self._pieces.head] - points[self._pieces.tail]
        length = np.maximum(np.hypot(*step.T), 1e-9)
        t = step / length[:, None]
        wanted = np.clip(1.0, 0.5 * length, GROW * length)
        weight = np.where(self._pieces.real, 0.5 / length**2, 0.0)
        blocks = weight[:, None, None] * t[:, :, None] * t[:, None, :] + 1e-4 * np.eye(2)
        return blocks, (weight * wanted)[:, None] * t + 1e-4 * step


def newton_step(
    mesh: Mesh,
    pieces: Pieces,
    pull: Pull,
    free: NDArray[np.bool_],
    *,
    shape: float,
    rest: NDArray[np.float64] | None = None,
    fold: float = 1e-9,
    ridge: float = 1e-6,
) -> NDArray[np.float64] | None:
    """Return a step for every point, (n + FRAME, 2), towards less energy; None where the system cannot be solved.

    Parameters
    ----------
    free
        The points that may move.
    shape
        Weight of the triangles' shape against the pull of the pieces.
    rest
        A picture; triangles that are thin in it may stay thin.
    fold
        How large an area a folded triangle is taken to have, relative to its squared sides.
    ridge
        Holds every point where it is, a little.
    """
    points = mesh.points
    touched = np.flatnonzero(free[pieces.tail] | free[pieces.head])
    u, v = pieces.tail[touched], pieces.head[touched]
    blocks, wanted = (part[touched] for part in pull.terms(points))
    force = np.einsum("kij,kj->ki", blocks, points[v] - points[u]) - wanted
    gradient = scattered(len(points), np.concatenate([v, u]), np.concatenate([force, -force]))
    system = System(free)
    system.add_differences(u, v, blocks)
    triangles = mesh.triangles[free[mesh.triangles].any(axis=1)]
    weight = np.full(len(triangles), shape)
    if rest is not None:
        good = EQUILATERAL * doubled_areas(rest, triangles) / np.maximum(squared_sides(rest, triangles), _TINY)
        weight *= np.where(good > 0, np.clip(good, 0.02, 1.0), 0.1)
    slope, curvature = _shape_terms(points, triangles, weight, fold)
    gradient += scattered(len(points), triangles.ravel(), slope.reshape(-1, 2))
    system.add(triangles, curvature)
    return system.solve(-gradient, ridge=ridge)


def _shape_terms(
    points: NDArray[np.float64], triangles: NDArray[np.int64], weight: NDArray[np.float64], fold: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Slope (k, 3, 2) and convex curvature (k, 6, 6) of weight x squared sides / (2 sqrt 3 x positive area)."""
    corner = points[triangles]
    sides = squared_sides(points, triangles)
    sides = np.maximum(sides, _POINT * sides.max(initial=0.0))  # three points on one spot have no shape
    area = doubled_areas(points, triangles)
    opposite = np.roll(corner, -2, 1) - np.roll(corner, -1, 1)
    area_slope = np.stack([-opposite[:, :, 1], opposite[:, :, 0]], axis=2)
    floor2 = (fold * sides) ** 2 + 0.04 * np.minimum(area, 0.0) ** 2
    root = np.maximum(np.sqrt(area * area + floor2), _TINY)
    positive = np.where(area > 0, (area + root) / 2, floor2 / np.maximum(2 * (root - area), _TINY))
    positive = np.maximum(positive, _TINY)
    first = -1 / (positive * root)
    second = 2 / np.maximum(np.where(area > 1e3 * np.sqrt(floor2), area, root), 1e-100) ** 3
    side_slope = 2 * np.einsum("ij,kjd->kid", _SIDES, corner)
    scale = weight / EQUILATERAL
    slope = scale[:, None, None] * (side_slope / positive[:, None, None] + (sides * first)[:, None, None] * area_slope)
    flat = area_slope.reshape(-1, 6)
    curvature = (scale / positive)[:, None, None] * _PLANE_SIDES
    curvature = curvature + (scale * sides * second)[:, None, None] * flat[:, :, None] * flat[:, None, :]
    return slope, curvature


def damped(mesh: Mesh, step: NDArray[np.float64], *, keep: float, rounds: int = 24) -> NDArray[np.float64]:
    """Return the points after a step that is shortened, point by point, until no good triangle is lost.

    Parameters
    ----------
    keep
        Share of its area that a good triangle keeps at least.

    Notes
    -----
    After some rounds of halving, points that would still fold a triangle stand still, so triangles that were turned
    right stay so: with a frame that stands still, a plane picture stays plane.
    """
    good = ~mesh.bad()
    triangles, floor = mesh.triangles[good], keep * mesh.areas()[good]
    scale = np.ones(len(step))
    asked, least = triangles, floor  # those with a corner whose step was shortened since they were looked at
    for k in count():
        moved = mesh.points + scale[:, None] * step
        lost = too_flat(moved, asked)
        if k < rounds:
            lost |= doubled_areas(moved, asked) < least
        shortened = np.zeros(len(step), np.bool_)
        shortened[asked[lost]] = True
        shortened &= scale > 0
        if not shortened.any():
            return moved
        scale[shortened] *= 0.5 if k < rounds else 0.0
        again = shortened[triangles].any(axis=1)
        asked, least = triangles[again], floor[again]
    raise AssertionError("every round stops a point or returns")
