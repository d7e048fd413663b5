"""Whether coordinates draw a map: no crossing, and the rotation, the faces and the outer face that the map has.

Nothing here trusts a layout. Crossings are searched with shapely's STRtree over the straight pieces; the rotation is
checked with exact signs; and `PlaneMap.from_geometry` builds the map again from the coordinates alone.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold.errors import BadInput
from ninefold.mapping import PlaneMap
from ninefold.mapping.checks import strip_tethers

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .drawing import Drawing

__all__ = ["crossing_pieces", "drawing_problems", "orientation"]

_SHOWN = 3


def drawing_problems(drawing: Drawing) -> tuple[str, ...]:
    """Say in words what is wrong with a drawing of its map; nothing if it is plane and keeps rotation and faces.

    Notes
    -----
    Complexity O(S log S + pairs of pieces with overlapping boxes) for S straight pieces.

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
    pairs, points = crossing_pieces(drawing)
    _, edge = drawing.pieces
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
    """Check with exact signs that the darts at every vertex turn counter-clockwise once around in the map's order."""
    plane = drawing.plane
    real = np.flatnonzero(~np.repeat(plane.tether, 2))
    if not real.size:
        return []
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
    wrong = np.flatnonzero((turns != 1) & (plane.degree > 0))
    return [f"the rotation at vertex {plane.vertex_names[v]!r} is not the map's" for v in wrong[:_SHOWN].tolist()]


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
        for k in np.flatnonzero(np.abs(det) <= 4e-16 * (np.abs(one) + np.abs(two))).tolist():
            ax, ay, bx, by, cx, cy = (Fraction(float(t)) for point in (a[k], b[k], c[k]) for t in point)
            exact = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
            sign[k] = (exact > 0) - (exact < 0)
    return np.asarray(sign, dtype=np.int64)
