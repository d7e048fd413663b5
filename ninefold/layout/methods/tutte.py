"""The Tutte drawing: every vertex at the mean of its neighbours, the outer face on a circle. Rounder than the grid.

The map itself is tried first, its outer cycle on a regular polygon: where the map is 3-connected all bounded faces come out
convex. Other maps get scaffolding that makes a triangulated disc of them: a hub in each bounded face of more than three
sides, and, where a face comes back to a vertex and around the whole map, a ring with one vertex for every side of the face.
The scaffolding is simple and its rim has no chord, so the barycentric drawing is plane for any positive weights (Floater
2003), in exact arithmetic. A few rounds that give longer edges more weight even it out, which keeps dead ends from
shrinking. In floating point parts nested many deep can shrink below what can be told apart; the drawing is therefore
checked, and the Schnyder drawing is given with a note where the check fails.

References
----------
W. T. Tutte, How to draw a graph, 1963. M. S. Floater, One-to-one piecewise linear mappings over triangulations, 2003.
P. R. Amestoy, T. A. Davis and I. S. Duff, An approximate minimum degree ordering algorithm, 1996.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold.mapping.checks import face_labels, face_permutation, first_darts

from ..drawing import Drawing
from ..planarity import drawing_problems
from .schnyder import schnyder
from .subdivide import make_simple

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.mapping import PlaneMap

    from .subdivide import SimpleMap

__all__ = ["tutte"]

MOST_VERTICES = 100_000
"""Vertices, bends included, above which floating point cannot hold a barycentric drawing and none is tried."""

SCAFFOLD_WEIGHT, BRIDGE_WEIGHT = 0.35, 0.3
"""Pull of a scaffolding edge and of a bridge, where an edge of the map pulls with 1: less, and the rest shapes the map."""

LONG_ROW = 10.0
"""Entries of a row, over the square root of the number of rows, from which it is eliminated last."""

ROUNDS, LIGHTEST, HEAVIEST = 3, 0.1, 10.0
"""Rounds of evening out, and the bounds of an edge's weight in them, relative to its first."""


def tutte(plane: PlaneMap) -> Drawing:
    """Draw a plane map with every vertex amid its neighbours; plane, checked, and said so in the notes if not possible.

    Parameters
    ----------
    plane
        Any map.

    Returns
    -------
    Drawing
        With float64 coordinates in the unit disc, and bends for loops and parallel edges. If no barycentric drawing that
        passes `drawing_problems` can be had, the Schnyder drawing, with ``layout == "schnyder"`` and a note.

    Raises
    ------
    TooLarge
        As `schnyder`.

    Notes
    -----
    Complexity: a few sparse factorisations, about O(V^1.5), and the check, O(V log V), whatever the degrees.

    Examples
    --------
    >>> from ninefold.mapping import PlaneMap
    >>> from ninefold.layout import tutte
    >>> square = PlaneMap.from_rotation(
    ...     {"a": ["b", "d"], "b": ["c", "a"], "c": ["d", "b"], "d": ["a", "c"]}, outer=("b", "a"))
    >>> tutte(square).points.round(6).tolist()
    [[-0.707107, -0.707107], [0.707107, -0.707107], [0.707107, 0.707107], [-0.707107, 0.707107]]
    """
    simple = make_simple(plane.tail, plane.next_ccw, plane.outer, plane.n_vertices)
    n = simple.n_vertices
    if n < 3:
        points = np.array([[0.0, 0.0], [1.0, 0.0]])[:n]
        return Drawing.from_points(plane, points, None, simple.bend_start, layout="tutte")
    if n > MOST_VERTICES:
        return _fallen_back(plane, f"{n} vertices are too many for a barycentric drawing in floating point")
    faces = _Faces(simple)
    problems: tuple[str, ...] = ()
    for solve in (_convex, partial(_scaffolded, rounds=ROUNDS), _scaffolded):
        xy = solve(simple, faces)
        if xy is None:
            continue
        drawing = Drawing.from_points(
            plane, xy[: plane.n_vertices], xy[plane.n_vertices :], simple.bend_start, layout="tutte"
        )
        problems = drawing_problems(drawing)
        if not problems:
            return drawing
    return _fallen_back(plane, f"the barycentric drawing is too fine for floating point ({problems[0]})")


def _fallen_back(plane: PlaneMap, why: str) -> Drawing:
    return replace(schnyder(plane), notes=(f"{why}; this is the Schnyder drawing",))


class _Faces:
    """The faces of a simple map: which darts go around each, and which are simple cycles."""

    def __init__(self, simple: SimpleMap) -> None:
        self.next_face = face_permutation(simple.next_ccw)
        self.of, self.count = face_labels(self.next_face)
        self.size = np.bincount(self.of, minlength=self.count)
        corners = self.of.astype(np.int64) * simple.n_vertices + simple.tail
        distinct = np.bincount(np.unique(corners) // simple.n_vertices, minlength=self.count)
        self.is_cycle = distinct == self.size
        self.outer = int(self.of[simple.outer])
        self.first = first_darts(self.of, self.count)

    def outer_walk(self, start: int) -> NDArray[np.int64]:
        """Return the darts around the outer face from `start`, clockwise around the map."""
        walk = np.empty(int(self.size[self.outer]), np.int64)
        d = start
        for i in range(walk.size):
            walk[i] = d
            d = int(self.next_face[d])
        return walk


def _convex(simple: SimpleMap, faces: _Faces) -> NDArray[np.float64] | None:
    """Solve on the map itself, or return None where a face is no simple cycle: then no drawing has convex faces."""
    if not faces.is_cycle.all():
        return None
    rim = simple.tail[faces.outer_walk(simple.outer)].astype(np.int64)
    ends = simple.tail.reshape(-1, 2).astype(np.int64)
    return _barycentric(simple.n_vertices, ends, np.ones(len(ends)), rim)


def _scaffolded(simple: SimpleMap, faces: _Faces, *, rounds: int = 0) -> NDArray[np.float64]:
    """Solve on the map with hubs and rings, and return the points of the map alone."""
    n, tail = simple.n_vertices, simple.tail.astype(np.int64)
    head = tail.reshape(-1, 2)[:, ::-1].ravel()
    ringed = ~faces.is_cycle
    ringed[faces.outer] = True
    hubbed = ringed | (faces.size > 3)
    hubbed[faces.outer] = False
    dart = np.flatnonzero(ringed[faces.of])
    ring = np.full(tail.size, -1, np.int64)
    ring[dart] = n + np.arange(dart.size)
    hub = np.full(faces.count, -1, np.int64)
    hub[hubbed] = n + dart.size + np.arange(int(hubbed.sum()))
    spoke_ends = np.where(ring >= 0, ring, tail)
    spoke = np.flatnonzero(hubbed[faces.of])
    extra = np.concatenate(
        [
            np.stack([ring[dart], tail[dart]], axis=1),
            np.stack([ring[dart], head[dart]], axis=1),
            np.stack([ring[dart], ring[faces.next_face[dart]]], axis=1),
            np.stack([hub[faces.of[spoke]], spoke_ends[spoke]], axis=1),
        ]
    )
    ends = np.concatenate([tail.reshape(-1, 2), extra])
    weight = np.full(len(ends), SCAFFOLD_WEIGHT)
    weight[: tail.size // 2] = np.where(faces.of[0::2] == faces.of[1::2], BRIDGE_WEIGHT, 1.0)
    total = n + dart.size + int(hubbed.sum())
    rim = ring[faces.outer_walk(simple.outer)]
    xy = _barycentric(total, ends, weight, rim)
    for _ in range(rounds):
        length = np.hypot(*(xy[ends[:, 0]] - xy[ends[:, 1]]).T)
        xy = _barycentric(total, ends, weight * np.clip(length / length.mean(), LIGHTEST, HEAVIEST), rim)
    return xy[:n]


def _barycentric(
    n: int, ends: NDArray[np.int64], weight: NDArray[np.float64], rim: NDArray[np.int64]
) -> NDArray[np.float64]:
    """Put `rim` clockwise on the unit circle, level edge first, and every other vertex at the mean of its neighbours."""
    from scipy.sparse import coo_array

    angle = -np.pi / 2 + np.pi / rim.size - 2 * np.pi * np.arange(rim.size) / rim.size
    xy = np.zeros((n, 2))
    xy[rim] = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    free = np.ones(n, np.bool_)
    free[rim] = False
    if not free.any():
        return xy
    both = np.concatenate([ends, ends[:, ::-1]])
    pull = np.concatenate([weight, weight])
    matrix = coo_array((pull, (both[:, 0], both[:, 1])), shape=(n, n)).tocsr()
    degree = np.asarray(matrix.sum(axis=1)).ravel()
    inner = np.flatnonzero(free)
    links = matrix[inner]
    laplacian = (coo_array((degree[inner], (np.arange(inner.size),) * 2)) - links[:, inner]).tocsc()
    xy[inner] = _solved(laplacian, links[:, rim] @ xy[rim])
    return xy


def _solved(matrix: Any, right: NDArray[np.float64]) -> NDArray[np.float64]:
    """Solve a sparse symmetric system with a dominant diagonal: (n, n) csc and (n, 2).

    The minimum-degree ordering of SuperLU takes a time quadratic in the length of a row, so rows much longer than the rest
    are kept out of it and eliminated last, as AMD does (Amestoy, Davis and Duff 1996).
    """
    from scipy.sparse.linalg import splu

    factor = partial(splu, diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    length = np.diff(matrix.indptr)
    long = length > LONG_ROW * np.sqrt(length.size)
    if not long.any():
        return np.asarray(factor(matrix, permc_spec="MMD_AT_PLUS_A").solve(right))
    rest = np.flatnonzero(~long)
    place = factor(matrix[rest][:, rest], permc_spec="MMD_AT_PLUS_A").perm_c if rest.size else rest
    order = np.concatenate([rest[np.argsort(place)], np.flatnonzero(long)])
    solution = np.empty_like(right)
    solution[order] = factor(matrix[order][:, order].tocsc(), permc_spec="NATURAL").solve(right[order])
    return solution
