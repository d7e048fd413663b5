"""The Schnyder drawing: straight edges on an integer grid, from the rotation system and the outer face alone.

Loops and parallel edges get bends, edges are added inside faces until all are triangles, a canonical ordering gives three
trees that share the inner edges out among them, and counting vertices in the regions between a vertex's three tree paths
gives its coordinates. The additions are dropped. Every step keeps the rotation, and the outer triangle is a piece of the old
outer face, so the drawing has the rotation and the outer face of the map. Tethers are edges of the map here, hence every
component lands in the face that hosts it.

References
----------
W. Schnyder, Embedding planar graphs on the grid, SODA 1990.
H. de Fraysseix et al., How to draw a planar graph on a grid, Combinatorica 10 (1990), for the ordering.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..drawing import Drawing
from ._realizer import grid_coordinates, shell
from .subdivide import make_simple
from .triangulate import check_size, triangulate

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.mapping import PlaneMap

    from .subdivide import SimpleMap

__all__ = ["grid_points", "schnyder"]


def schnyder(plane: PlaneMap) -> Drawing:
    """Draw a plane map with straight edges on an integer grid.

    Parameters
    ----------
    plane
        Any map: dead ends, cut vertices, tethered components, loops and parallel edges.

    Returns
    -------
    Drawing
        With int64 coordinates from 0 to n - 2, n counting the vertices and the bends of loops and parallel edges (two a
        loop, one for each parallel edge but one); a map without those has straight edges only. With n below 3 the
        coordinates are (0, 0) and (1, 0).

    Raises
    ------
    TooLarge
        If the triangulated map would have 2**31 darts or more.

    Notes
    -----
    Complexity O(V + E log E), the logarithm for finding parallel edges alone.

    Examples
    --------
    >>> from ninefold.mapping import PlaneMap
    >>> from ninefold.layout import schnyder
    >>> square = PlaneMap.from_rotation(
    ...     {"a": ["b", "d"], "b": ["c", "a"], "c": ["d", "b"], "d": ["a", "c"]}, outer=("b", "a"))
    >>> schnyder(square).points.tolist()
    [[1, 0], [2, 1], [1, 1], [0, 2]]
    """
    simple = make_simple(plane.tail, plane.next_ccw, plane.outer, plane.n_vertices)
    xy = grid_points(simple)
    return Drawing.from_points(plane, xy[: plane.n_vertices], xy[plane.n_vertices :], simple.bend_start, layout="schnyder")


def grid_points(simple: SimpleMap) -> NDArray[np.int64]:
    """Place a simple connected plane map on the grid: (n, 2) int64, column and row. O(n)."""
    n = simple.n_vertices
    check_size(n)
    if n < 3:
        return np.array([[0, 0], [1, 0]][:n], np.int64)
    tail, after, before = triangulate(simple.tail, simple.next_ccw, n)
    order, parent = shell.for_work(tail.size)(tail, after, before, simple.outer, n)
    left, right, top = tail[simple.outer ^ 1], tail[simple.outer], order[0]
    xy = grid_coordinates.for_work(tail.size)(order, parent, left, right, top)
    return np.asarray(xy, dtype=np.int64)
