"""Dart arrays from coordinates: the one place in `ninefold.mapping` that sees them.

Coordinates give three things and are then dropped: the heading at both ends of every edge and its net rotation, hence the
rotation system and the outer face; and, where the source has several components, which face hosts which component, found by
looking west from each component's westernmost point. A component is tied to its host face by a tether.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

from . import _orbits, checks
from .heading import TAU
from .names import Names
from .tethers import tie_components

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import ArrayLike, NDArray

__all__ = ["GeometricDarts", "bearings", "checked_edges", "checked_points", "darts_of_geometry", "rotation_by_heading"]

_CLOSEST = 1e-12

LARGEST_COORDINATE = 1e150
"""Beyond it the product of two differences of coordinates, which says how two edges turn, overflows."""


class GeometricDarts(NamedTuple):
    """What coordinates say of a map, before it is checked.

    Attributes
    ----------
    tail, next_ccw
        (2E,) int32, tethers included.
    tether
        (E,) bool.
    heading, turn
        (2E,) and (E,) float64 radians, NaN on tethers.
    vertex_names, edge_names
        Labels.
    derived
        Orbits found on the way, or None where tethers were added after that.
    """

    tail: NDArray[np.int32]
    next_ccw: NDArray[np.int32]
    tether: NDArray[np.bool_]
    heading: NDArray[np.float64]
    turn: NDArray[np.float64]
    vertex_names: Names
    edge_names: Names
    derived: checks.Derived | None


_TOO_FAR = (
    f"lies so far out that differences of coordinates cannot be computed with; coordinates go up to {LARGEST_COORDINATE:g}"
)


def darts_of_geometry(
    points: ArrayLike,
    edges: ArrayLike,
    paths: Sequence[ArrayLike | None] | None = None,
    *,
    vertex_names: Iterable[str | int] | None = None,
    edge_names: Iterable[str | int] | None = None,
) -> GeometricDarts:
    """Read vertices with coordinates, and edges that do not cross, into dart arrays; see `PlaneMap.from_geometry`.

    Raises
    ------
    BadInput
        For coordinates that are not finite or beyond `LARGEST_COORDINATE`, edges without length, two edges that leave a
        vertex in one direction.
    """
    xy, ends = checked_points(points), checked_edges(edges)
    n_vertices, n_edges = len(xy), len(ends)
    if n_edges and (int(ends.min()) < 0 or int(ends.max()) >= n_vertices):
        wrong = int(ends.min()) if int(ends.min()) < 0 else int(ends.max())
        raise BadInput(f"edges must hold rows of points, 0 to {n_vertices - 1}; found {wrong}")
    v_names = Names("vertex", n_vertices, vertex_names)
    e_names = Names("edge", n_edges, edge_names)
    heading, turn, line, start = bearings(xy, ends, paths, e_names)
    tail = np.ascontiguousarray(ends.reshape(-1), dtype=np.int32)
    next_ccw = rotation_by_heading(tail, heading, n_vertices, v_names, e_names)
    tether = np.zeros(n_edges, np.bool_)
    derived: checks.Derived | None = checks.derive(tail, next_ccw, v_names, e_names)
    if derived is not None and derived.n_components > 1:
        segments = _segments(xy, ends, line, start)
        tail, next_ccw = tie_components(tail, next_ccw, heading, turn, derived, xy, segments, e_names)
        extra = tail.size // 2 - n_edges
        tether = np.concatenate([tether, np.ones(extra, np.bool_)])
        heading = np.concatenate([heading, np.full(2 * extra, np.nan)])
        turn = np.concatenate([turn, np.full(extra, np.nan)])
        e_names = _with_tether_names(e_names, extra)
        derived = None
    return GeometricDarts(tail, next_ccw, tether, heading, turn, v_names, e_names, derived)


def checked_points(points: ArrayLike) -> NDArray[np.float64]:
    """Return (V, 2) finite coordinates, or say why they are none."""
    try:
        xy = np.asarray(points, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise BadInput("points must be a (V, 2) array of numbers") from None
    if xy.ndim != 2 or xy.shape[1] != 2 or not len(xy):
        raise BadInput(f"points must have shape (V, 2) with V at least 1, not {xy.shape}")
    if not np.isfinite(xy).all():
        raise BadInput(f"point {int(np.flatnonzero(~np.isfinite(xy).all(axis=1))[0])} is not finite")
    if float(np.abs(xy).max()) > LARGEST_COORDINATE:
        at = int(np.flatnonzero((np.abs(xy) > LARGEST_COORDINATE).any(axis=1))[0])
        raise BadInput(f"point {at}, ({xy[at, 0]:g}, {xy[at, 1]:g}), {_TOO_FAR}")
    return xy


def checked_edges(edges: ArrayLike) -> NDArray[np.int64]:
    """Return (E, 2) int64 rows of points, or say why they are none; their range is not looked at."""
    try:
        array = np.asarray(edges)
    except ValueError:
        raise BadInput("edges must be integers of shape (E, 2), and the rows given differ in length") from None
    if array.size == 0:
        return np.zeros((0, 2), np.int64)
    if array.ndim != 2 or array.shape[1] != 2 or array.dtype.kind not in "iu":
        raise BadInput(f"edges must be integers of shape (E, 2), not {array.dtype} of shape {array.shape}")
    return array.astype(np.int64)


def bearings(
    xy: NDArray[np.float64],
    ends: NDArray[np.int64],
    paths: Sequence[ArrayLike | None] | None,
    names: Names,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64] | None, NDArray[np.int64]]:
    """Headings (2E,), turns (E,), and all polylines (straight ones too) as one (N, 2) array with offsets (E + 1,)."""
    n_edges = len(ends)
    if paths is not None and len(paths) != n_edges:
        raise BadInput(f"{len(paths)} paths for {n_edges} edges; give one each, or None for a straight edge")
    if paths is None or all(path is None for path in paths):
        step = xy[ends[:, 1]] - xy[ends[:, 0]]
        flat = np.flatnonzero((step == 0).all(axis=1))
        if flat.size:
            raise _no_length(names[int(flat[0])])
        out = np.arctan2(step[:, 1], step[:, 0])
        heading = np.empty(2 * n_edges)
        heading[0::2] = out
        heading[1::2] = np.where(out > 0, out - np.pi, out + np.pi)
        return heading, np.zeros(n_edges), None, np.zeros(0, np.int64)
    lines = [_polyline(xy, ends, e, path, names) for e, path in enumerate(paths)]
    start = np.concatenate([[0], np.cumsum([len(line) for line in lines])]).astype(np.int64)
    line = np.concatenate(lines)
    step = np.diff(line, axis=0)
    yaw = np.arctan2(step[:, 1], step[:, 0])
    bend = np.diff(yaw)
    bend -= TAU * np.round(bend / TAU)
    # Segment i of the whole array joins points i and i + 1; those between two edges do not count.
    first, last = start[:-1], start[1:] - 2
    heading = np.empty(2 * n_edges)
    heading[0::2] = yaw[first]
    heading[1::2] = np.where(yaw[last] > 0, yaw[last] - np.pi, yaw[last] + np.pi)
    reach = np.concatenate([[0.0], np.cumsum(np.where(_inner_bends(start, len(bend)), bend, 0.0))])
    turn = reach[last] - reach[first]
    spike = np.flatnonzero(_inner_bends(start, len(bend)) & (np.abs(bend) > np.pi - 1e-12))
    if spike.size:
        e = int(np.searchsorted(start, spike[0], side="right")) - 1
        raise BadInput(f"the path of edge {quoted(names[e])} turns back on itself; a path may not retrace its way")
    return heading, turn, line, start


def _inner_bends(start: NDArray[np.int64], count: int) -> NDArray[np.bool_]:
    """Mark the bends (between segments i and i + 1) that lie inside one edge."""
    inner = np.ones(count, np.bool_)
    joints = start[1:-1]
    for shift in (-2, -1):  # the segment between two edges is joints - 1; it takes part in the bends before and after
        at = joints + shift
        inner[at[(at >= 0) & (at < count)]] = False
    return inner


def _polyline(
    xy: NDArray[np.float64], ends: NDArray[np.int64], e: int, path: ArrayLike | None, names: Names
) -> NDArray[np.float64]:
    a, b = xy[ends[e, 0]], xy[ends[e, 1]]
    if path is None:
        line = np.stack([a, b])
    else:
        try:
            line = np.asarray(path, dtype=np.float64)
        except (TypeError, ValueError, OverflowError):
            raise BadInput(f"the path of edge {quoted(names[e])} must be a (k, 2) array of numbers") from None
        if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2 or not np.isfinite(line).all():
            raise BadInput(f"the path of edge {quoted(names[e])} must be finite points of shape (k, 2), k at least 2")
        if float(np.abs(line).max()) > LARGEST_COORDINATE:
            raise BadInput(f"the path of edge {quoted(names[e])} {_TOO_FAR}")
        if not (np.array_equal(line[0], a) and np.array_equal(line[-1], b)):
            raise BadInput(f"the path of edge {quoted(names[e])} does not begin and end at the points it joins")
        line = line[np.concatenate([[True], (np.diff(line, axis=0) != 0).any(axis=1)])]
    if len(line) < 2 or (len(line) == 2 and np.array_equal(line[0], line[1])):
        raise _no_length(names[e])
    return line


def _no_length(name: str) -> BadInput:
    return BadInput(f"edge {quoted(name)} has no length; drop it, merge its ends, or give a loop its path")


def rotation_by_heading(
    tail: NDArray[np.int32], heading: NDArray[np.float64], n_vertices: int, v_names: Names, e_names: Names
) -> NDArray[np.int32]:
    """Return (2E,) int32, the next dart counter-clockwise by heading; two darts in one direction are an error."""
    next_ccw, closest, at = _orbits.sort_rotation.for_work(tail.size)(tail, heading, n_vertices)
    if closest < _CLOSEST:
        other = int(next_ccw[at])
        first, second, vertex = e_names[int(at) >> 1], e_names[other >> 1], v_names[int(tail[at])]
        raise BadInput(
            f"edges {quoted(first)} and {quoted(second)} leave vertex {quoted(vertex)} in the "
            "same direction; merge them, or give the path of one a first piece of its own"
        )
    return np.asarray(next_ccw, dtype=np.int32)


def _segments(
    xy: NDArray[np.float64], ends: NDArray[np.int64], line: NDArray[np.float64] | None, start: NDArray[np.int64]
) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """Every straight piece, (S, 4) as x0 y0 x1 y1 along dart 2e, and its edge (S,)."""
    if line is None:
        return np.concatenate([xy[ends[:, 0]], xy[ends[:, 1]]], axis=1), np.arange(len(ends), dtype=np.int32)
    pieces = np.concatenate([line[:-1], line[1:]], axis=1)
    keep = np.ones(len(pieces), np.bool_)
    keep[start[1:-1] - 1] = False
    edge = np.repeat(np.arange(len(ends), dtype=np.int32), np.diff(start))[:-1]
    return pieces[keep], edge[keep]


def _with_tether_names(names: Names, extra: int) -> Names:
    if names.are_rows:
        return Names("edge", names.size + extra)
    taken = set(names)
    fresh = (f"tether{i}" for i in range(extra + len(taken)))
    return Names("edge", names.size + extra, [*names, *[n for n in fresh if n not in taken][:extra]])
