"""Legs as curves: each leaves and arrives at its measured headings, and turns by its measured rotation.

A piece of a leg from one point to another, with the tangent at both ends and the rotation between them given, is drawn
as a generalised Euler spiral: its tangent angle is a quadratic function of the way along it. The two ends fix the
linear part, and the condition that it ends where it has to fixes the rest. The rotation comes out as given, whole turns
included.

Curves are sampled to polylines. Where one meets another edge, or leaves its vertex in the wrong place of the rotation,
the edges concerned are drawn straight again, until the drawing is plane.

References
----------
E. Bertolazzi and M. Frego, G1 fitting with clothoids, Mathematical Methods in the Applied Sciences 38, 2015.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold.mapping.turning import settle_turns

from ..drawing import Drawing
from ..planarity import crossing_pieces, drawing_problems, wrong_rotations
from .pieces import wrapped

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.mapping import PlaneMap

    from .pieces import Pieces

__all__ = ["curved", "spirals"]

WIDEST_MISS = np.radians(60)
"""Angle between a piece as drawn and its chord, beyond which it is not bent to its headings."""

SHARP = np.radians(100)
"""Net rotation above which a leg is drawn as a curve unasked; straight it would lie against what it goes around."""

_STEP = np.radians(7)
"""Turn of the tangent for which one straight piece of a polyline stands."""

_MOST = 48
_NODES = 257
_ROUNDS = 12
_STRAIGHT = 1e-6


def spirals(
    mean: NDArray[np.float64], turn: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
    """Return curves from (0, 0) to (1, 0) with given tangents.

    Parameters
    ----------
    mean, turn
        (k,) radians: the mean of the tangent angles at both ends, and the rotation from the first to the second.

    Returns
    -------
    xy, bend, found
        (k, 257, 2) points along each curve, evenly spaced in length; (k,) how far its tangent swings in all, radians;
        (k,) whether there is such a curve.

    Examples
    --------
    A quarter turn to the left between two points is an arc of a circle:

    >>> xy, _, found = spirals(np.zeros(1), np.full(1, np.pi / 2))
    >>> bool(found[0]), xy[0, 128].round(4).tolist(), xy[0, -1].round(9).tolist()
    (True, [0.5, -0.2071], [1.0, 0.0])
    """
    s = np.linspace(0.0, 1.0, _NODES)
    weight = np.full(_NODES, 2.0)
    weight[1::2], weight[0], weight[-1] = 4.0, 1.0, 1.0
    weight /= 3 * (_NODES - 1)  # Simpson's rule
    swing = s * s - s
    linear = mean[:, None] + turn[:, None] * (s - 0.5)
    bent = 6.0 * mean
    for _ in range(_ROUNDS):
        angle = linear + bent[:, None] * swing
        miss = (np.sin(angle) * weight).sum(axis=1)
        slope = (np.cos(angle) * swing * weight).sum(axis=1)
        bent = bent - np.clip(miss / np.where(np.abs(slope) < 1e-9, 1e-9, slope), -2.0, 2.0)
    angle = linear + bent[:, None] * swing
    reach = (np.cos(angle) * weight).sum(axis=1)
    found = (np.abs((np.sin(angle) * weight).sum(axis=1)) < 1e-9) & (reach > 0.05)
    middle = (angle[:, 1:] + angle[:, :-1]) / 2
    steps = np.stack([np.cos(middle), np.sin(middle)], axis=2)
    xy = np.zeros((mean.size, _NODES, 2))
    np.cumsum(steps, axis=1, out=xy[:, 1:])
    end = xy[:, -1]
    # what the polyline misses of the end by rounding is shared out along it
    length = np.where(np.abs(end[:, 0]) > 1e-9, end[:, 0], 1.0)
    xy /= length[:, None, None]
    xy[:, :, 1] -= s * xy[:, -1, 1][:, None]
    bend = np.abs(np.diff(angle, axis=1)).sum(axis=1)
    return xy, bend, found


def curved(drawing: Drawing, pieces: Pieces, *, everything: bool) -> Drawing:
    """Return a plane drawing with smooth edges: those that had to be bent anyway or turn sharply, or every one that turns.

    Parameters
    ----------
    drawing
        Plane, with straight pieces.
    everything
        Bend every leg to its headings, not those alone.
    """
    plane = drawing.plane
    nodes = np.concatenate([drawing.points, drawing.bends]).astype(np.float64)
    wanted = np.full(plane.tether.size, everything) | (np.diff(drawing.bend_start) > 0)
    if plane.turn is not None:
        wanted |= np.abs(np.nan_to_num(plane.turn)) > SHARP
    wanted &= ~plane.tether
    paths = _curves(plane, pieces, nodes, wanted)
    while paths:
        smooth = _with_paths(drawing, paths)
        found, lying = crossing_pieces(smooth)
        edge = smooth.pieces[1]
        hit = {int(edge[k]) for pair in found for k in pair} | {int(edge[k]) for _, k in lying}
        around = wrong_rotations(smooth)
        if len(around):
            hit |= set((np.flatnonzero(np.isin(plane.tail, around)) >> 1).tolist())
        if not hit & paths.keys():
            return smooth if not hit and not drawing_problems(smooth) else drawing
        for e in hit:
            paths.pop(e, None)
    return drawing


def _curves(
    plane: PlaneMap, pieces: Pieces, nodes: NDArray[np.float64], wanted: NDArray[np.bool_]
) -> dict[int, NDArray[np.float64]]:
    """Return the inner points of the polylines of edges that can be bent to their headings."""
    if plane.heading is None or plane.turn is None:
        return {}
    turn = settle_turns(plane.heading, plane.turn)
    count = np.bincount(pieces.edge, minlength=plane.tether.size)
    rows = np.flatnonzero(wanted[pieces.edge] & pieces.measured)
    step = nodes[pieces.head[rows]] - nodes[pieces.tail[rows]]
    drawn = np.arctan2(step[:, 1], step[:, 0])
    share = turn[pieces.edge[rows]] / count[pieces.edge[rows]]
    middle = plane.heading[0::2][pieces.edge[rows]] + share * (pieces.place[rows] + 0.5)
    mean = wrapped(middle - drawn)
    xy, bend, found = spirals(mean, share)
    possible = found & (np.abs(mean) <= WIDEST_MISS)
    inner: dict[int, dict[int, NDArray[np.float64]]] = {}
    for at, row in enumerate(rows.tolist()):
        if not possible[at]:
            continue
        n = int(np.clip(np.ceil(bend[at] / _STEP), 1, _MOST)) if bend[at] > _STRAIGHT else 1
        chosen = xy[at, np.linspace(0, _NODES - 1, n + 1).round().astype(np.int64)[1:-1]]
        (cx, cy), (ux, uy) = nodes[pieces.tail[row]], step[at]
        turned = np.stack([cx + ux * chosen[:, 0] - uy * chosen[:, 1], cy + uy * chosen[:, 0] + ux * chosen[:, 1]], axis=1)
        inner.setdefault(int(pieces.edge[row]), {})[int(pieces.place[row])] = turned
    paths: dict[int, NDArray[np.float64]] = {}
    first_bend = plane.n_vertices + pieces.simple.bend_start
    for e, parts in inner.items():
        if len(parts) < count[e]:
            continue
        joined: list[NDArray[np.float64]] = []
        for j in range(int(count[e])):
            if j:
                joined.append(nodes[[int(first_bend[e]) + j - 1]])
            joined.append(parts[j])
        path = np.concatenate(joined)
        if len(path) >= count[e]:  # something was added to the bends that are there
            paths[e] = path
    return paths


def _with_paths(drawing: Drawing, paths: dict[int, NDArray[np.float64]]) -> Drawing:
    """Return the drawing with other inner points for some edges."""
    start = drawing.bend_start
    inner = [paths.get(e, drawing.bends[start[e] : start[e + 1]]) for e in range(start.size - 1)]
    sizes = np.array([len(path) for path in inner], np.int64)
    bends = np.concatenate(inner).astype(np.float64) if inner else np.zeros((0, 2))
    where = np.concatenate([[0], np.cumsum(sizes)])
    return Drawing.from_points(drawing.plane, drawing.points, bends, where, layout=drawing.layout, notes=drawing.notes)
