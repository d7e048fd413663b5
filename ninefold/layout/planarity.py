"""Whether coordinates draw a map: no crossing, and the rotation, the faces and the outer face that the map has.

Nothing here trusts a layout. Crossings of the straight pieces are searched with shapely's STRtree in small drawings, and by
a sweep with exact signs in large ones, where boxes of thin pieces and pieces around one vertex meet by the million; the
rotation is checked with exact signs; and `PlaneMap.from_geometry` builds the map again from the coordinates alone.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cmp_to_key
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold.errors import BadInput
from ninefold.mapping import PlaneMap
from ninefold.mapping.checks import strip_tethers

from ._sweep import NOTHING, PIECES, sweep

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .drawing import Drawing

__all__ = ["crossing_pieces", "drawing_problems", "first_meeting", "orientation", "wrong_rotations"]

_SHOWN = 3

MOST_PIECES, MOST_PAIRS = 5_000, 1_000_000
"""Straight pieces, and pairs of them around common vertices, up to which every crossing is searched for with shapely."""


def drawing_problems(drawing: Drawing) -> tuple[str, ...]:
    """Say in words what is wrong with a drawing of its map; nothing if it is plane and keeps rotation and faces.

    Notes
    -----
    Complexity O(S log S) for S straight pieces, whatever the degrees. Up to three crossings are named in a small drawing,
    one in a large one.

    Examples
    --------
    >>> from ninefold.layout import Drawing, schnyder
    >>> from ninefold.mapping import PlaneMap
    >>> star = PlaneMap.from_rotation({"o": ["a", "b", "c"], "a": ["o"], "b": ["o"], "c": ["o"]})
    >>> drawing_problems(schnyder(star))
    ()
    >>> drawing_problems(Drawing.from_points(star, [(0, 0), (1, 0), (0, -1), (-1, 0)]))
    ("the rotation at vertex 'o' is not the map's",)
    """
    problems = [*_crossings(drawing), *_rotations(drawing)]
    return tuple(problems or _recomputed(drawing))


def _crossings(drawing: Drawing) -> list[str]:
    plane = drawing.plane
    _, edge = drawing.pieces
    if edge.size > MOST_PIECES or int((plane.degree.astype(np.int64) ** 2).sum()) > 2 * MOST_PAIRS:
        pairs, points = first_meeting(drawing)
    else:
        pairs, points = crossing_pieces(drawing)
    names = plane.edge_names
    words = [f"edges {names[int(edge[i])]!r} and {names[int(edge[j])]!r} meet off their ends" for i, j in pairs[:_SHOWN]]
    words += [f"vertex {plane.vertex_names[v]!r} lies on edge {names[int(edge[i])]!r}" for v, i in points[:_SHOWN]]
    lone = drawing.points[plane.degree == 0]
    if len(np.unique(lone, axis=0)) != len(lone):
        words.append("two isolated vertices lie on each other")
    return words


def crossing_pieces(drawing: Drawing) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
    """Find straight pieces that meet elsewhere than at a common end, and isolated vertices on a piece.

    Returns
    -------
    pairs
        Of piece numbers (rows of `Drawing.pieces`), the lower first.
    points
        Of vertex and piece.
    """
    import shapely

    piece, _ = drawing.pieces
    if not len(piece):
        return [], []
    segments = shapely.linestrings(piece.reshape(-1, 2, 2).astype(np.float64))
    tree = shapely.STRtree(segments)
    i, j = tree.query(segments, predicate="intersects")
    keep = i < j
    i, j = i[keep], j[keep]
    ends = _piece_ends(drawing)
    a, b = ends[i], ends[j]
    shared = (a[:, :, None] == b[:, None, :]).reshape(-1, 4)
    count = shared.sum(axis=1)
    bad = count != 1
    # One common end: the pieces must leave it in different directions.
    one = np.flatnonzero(count == 1)
    at = shared[one].argmax(axis=1)
    p, q = piece[i[one]].reshape(-1, 2, 2), piece[j[one]].reshape(-1, 2, 2)
    row = np.arange(one.size)
    apex, p_far, q_far = p[row, at // 2], p[row, 1 - at // 2], q[row, 1 - at % 2]
    level = orientation(apex, p_far, q_far) == 0
    same_way = ((p_far - apex) * (q_far - apex)).sum(axis=1) > 0
    bad[one] = level & same_way
    flat = np.flatnonzero((piece[:, :2] == piece[:, 2:]).all(axis=1))
    pairs = sorted(zip(i[bad].tolist(), j[bad].tolist(), strict=True)) + [(k, k) for k in flat.tolist()]
    lone = np.flatnonzero(drawing.plane.degree == 0)
    v, s = tree.query(shapely.points(drawing.points[lone].astype(np.float64)), predicate="intersects")
    return pairs, list(zip(lone[v].tolist(), s.tolist(), strict=True))


def first_meeting(drawing: Drawing) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
    """Find the westernmost place where straight pieces, or nodes, meet as they must not; like `crossing_pieces`, but one.

    Returns
    -------
    pairs
        The two pieces, the lower number first; or nothing.
    points
        A vertex and the piece it lies on; or nothing.

    Notes
    -----
    Complexity O(S log S) for S pieces. Two vertices at one place are a meeting of two of their pieces; two isolated ones are
    not looked at.
    """
    ends = _piece_ends(drawing)
    piece, _ = drawing.pieces
    flat = np.flatnonzero((piece[:, :2] == piece[:, 2:]).all(axis=1))
    if not len(ends) or flat.size:
        return [(int(k), int(k)) for k in flat[:1]], []
    nodes = np.concatenate([drawing.points, drawing.bends]).astype(np.float64)
    used = np.zeros(len(nodes), np.bool_)
    used[ends] = True
    lone = np.flatnonzero(~used[: drawing.plane.n_vertices])
    there = np.concatenate([np.flatnonzero(used), lone])
    order = there[np.lexsort((nodes[there, 1], nodes[there, 0]))]
    xy = nodes[order]
    place = np.full(len(nodes), -1, np.int64)
    place[order] = np.arange(order.size)
    low, high = np.sort(place[ends], axis=1).T
    same = np.flatnonzero((xy[1:] == xy[:-1]).all(axis=1))
    for u, v in order[same[:, None] + [0, 1]].tolist():
        at = [int(np.flatnonzero((ends == node).any(axis=1))[0]) if used[node] else -1 for node in (u, v)]
        if min(at) >= 0:
            return [(min(at), max(at))], []
        if max(at) >= 0:
            return [], [(v if at[1] < 0 else u, max(at))]
    if same.size:  # isolated vertices on each other: the sweep needs each place once
        keep = np.concatenate([[True], (xy[1:] != xy[:-1]).any(axis=1)])
        number = np.cumsum(keep) - 1
        xy, order, low, high = xy[keep], order[keep], number[low], number[high]
    row = _counter_clockwise(xy, low, high)
    low, high = low[row], high[row]
    arriving = np.argsort(high, kind="stable")
    leave, arrive = (np.searchsorted(sorted_ends, np.arange(len(xy) + 1)) for sorted_ends in (low, high[arriving]))
    kind, i, j = sweep.for_work(64 * len(row))(xy, low, high, leave, arriving, arrive)
    if kind == NOTHING:
        return [], []
    if kind == PIECES:
        a, b = sorted((int(row[i]), int(row[j])))
        return [(a, b)], []
    node, on = int(order[i]), int(row[j])
    if not used[node]:
        return [], [(node, on)]
    a, b = sorted((int(np.flatnonzero((ends == node).any(axis=1))[0]), on))
    return [(a, b)], []


def _counter_clockwise(xy: NDArray[np.float64], low: NDArray[np.int64], high: NDArray[np.int64]) -> NDArray[np.int64]:
    """Sort pieces by their western node and around it from south by the exact sign of the turn."""
    step = xy[high] - xy[low]
    piece = np.lexsort((np.arctan2(step[:, 1], step[:, 0]), low))
    a, b = piece[:-1], piece[1:]
    rows = np.flatnonzero(low[a] == low[b])
    wrong = rows[orientation(xy[low[a[rows]]], xy[high[a[rows]]], xy[high[b[rows]]]) < 0]
    for v in np.unique(low[piece[wrong]]).tolist():  # directions that rounding to an angle has put in the wrong order

        def before(e: int, f: int, v: int = v) -> int:
            return -int(orientation(xy[[v]], xy[high[[e]]], xy[high[[f]]])[0])

        here = np.flatnonzero(low[piece] == v)
        piece[here] = sorted(piece[here].tolist(), key=cmp_to_key(before))
    return piece


def _piece_ends(drawing: Drawing) -> NDArray[np.int64]:
    """The nodes (vertices, then bends) that each straight piece joins, (S, 2)."""
    plane = drawing.plane
    count = np.diff(drawing.bend_start) + 1
    edge = np.repeat(np.arange(count.size), count)
    place = np.arange(edge.size) - np.repeat(np.cumsum(count) - count, count)
    bend = plane.n_vertices + drawing.bend_start[edge] + place
    low = np.where(place == 0, plane.tail[2 * edge], bend - 1)
    high = np.where(place == count[edge] - 1, plane.tail[2 * edge + 1], bend)
    return np.asarray(np.stack([low, high], axis=1)[~plane.tether[edge]], dtype=np.int64)


def _rotations(drawing: Drawing) -> list[str]:
    names = drawing.plane.vertex_names
    return [f"the rotation at vertex {names[v]!r} is not the map's" for v in wrong_rotations(drawing)[:_SHOWN].tolist()]


def wrong_rotations(drawing: Drawing) -> NDArray[np.int64]:
    """Return the vertices at which the darts do not turn counter-clockwise once around in the map's order; exact signs."""
    plane = drawing.plane
    real = np.flatnonzero(~np.repeat(plane.tether, 2))
    if not real.size:
        return np.zeros(0, np.int64)
    after = strip_tethers(plane.next_ccw, plane.tether)[real]
    start = drawing.points[plane.tail]
    towards = start[np.arange(start.shape[0]) ^ 1].copy()
    bent = np.flatnonzero(np.diff(drawing.bend_start))
    towards[2 * bent] = drawing.bends[drawing.bend_start[bent]]
    towards[2 * bent + 1] = drawing.bends[drawing.bend_start[bent + 1] - 1]
    step = towards - start
    lower = (step[:, 1] < 0) | ((step[:, 1] == 0) & (step[:, 0] < 0))
    sign = orientation(start[real], towards[real], towards[after])
    rises = np.where(lower[real] == lower[after], sign > 0, lower[after])
    turns = np.bincount(plane.tail[real][~rises], minlength=plane.n_vertices)
    return np.flatnonzero((turns != 1) & (plane.degree > 0))


def _recomputed(drawing: Drawing) -> list[str]:
    """Build the map again from the coordinates and compare the faces: as sets of darts and of isolated vertices."""
    plane = drawing.plane
    real = np.flatnonzero(~plane.tether)
    straight = not len(drawing.bends)
    paths = None if straight else [drawing.path(e).astype(np.float64) for e in real.tolist()]
    try:
        again = PlaneMap.from_geometry(drawing.points.astype(np.float64), plane.tail.reshape(-1, 2)[real], paths)
    except BadInput as error:
        return [f"no map can be made again from the coordinates: {error}"]
    darts = (2 * real[:, None] + np.array([0, 1])).ravel()
    mine, its = plane.face_of[darts], again.face_of[: darts.size]
    lone = np.flatnonzero(plane.degree == 0)
    if plane.tail.size:
        mine = np.concatenate([mine, plane.face_of[plane.first_dart[lone]]])
        its = np.concatenate([its, again.face_of[again.first_dart[lone]]])
    pairs = np.unique(np.stack([mine, its], axis=1), axis=0)
    if len(pairs) != plane.n_faces or len(np.unique(pairs[:, 1])) != plane.n_faces:
        if plane.tail.size:
            return ["the faces, or the components that they host, are not the map's"]
        return []
    match = dict(pairs.tolist())
    if match[plane.outer_face] != again.outer_face:
        return ["the outer face is not the map's"]
    return []


def orientation(a: NDArray[Any], b: NDArray[Any], c: NDArray[Any]) -> NDArray[np.int64]:
    """Return the exact sign of the turn a -> b -> c, (N,): 1 counter-clockwise, -1 clockwise, 0 level.

    Integers are exact up to coordinates of 2**30; floats are filtered by Shewchuk's bound and settled with fractions.

    References
    ----------
    J. R. Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric predicates, 1997.
    """
    u, v = b - a, c - a
    one, two = u[:, 0] * v[:, 1], u[:, 1] * v[:, 0]
    det = one - two
    sign = np.sign(det).astype(np.int64)
    if det.dtype.kind == "f":
        unsure = (np.abs(det) <= 4e-16 * (np.abs(one) + np.abs(two))) & (b != c).any(axis=1)
        for k in np.flatnonzero(unsure).tolist():
            ax, ay, bx, by, cx, cy = (Fraction(float(t)) for point in (a[k], b[k], c[k]) for t in point)
            exact = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
            sign[k] = (exact > 0) - (exact < 0)
    return np.asarray(sign, dtype=np.int64)
