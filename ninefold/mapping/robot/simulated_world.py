"""A world of plane geometry for a simulated robot: places with coordinates and the ways between them."""

from __future__ import annotations

from math import ceil, pi
from typing import TYPE_CHECKING

import numpy as np

from ninefold.errors import BadInput

from .. import geometry
from ..heading import TAU
from ..names import Names

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import ArrayLike, NDArray

__all__ = ["SimulatedWorld"]


class SimulatedWorld:
    """Places with coordinates and the ways between them. Ways do not cross; that is not checked.

    Parameters
    ----------
    points
        (V, 2) metres in a plane, x east and y north.
    edges
        (E, 2) integers, the rows of `points` a way joins; loops and parallel ways need `paths`.
    paths
        Per edge None for a straight way, or a (k, 2) polyline that includes both ends.
    vertex_names, edge_names
        Labels; row numbers for places if left out, and the robot then names no edge.

    Attributes
    ----------
    heading
        (2E,) float64 yaw on leaving along each dart, radians; dart 2e runs as edge e is given.
    narrowest
        The least angle between two ways at one place, radians.
    metres
        Length of all ways.

    Raises
    ------
    BadInput
        As `PlaneMap.from_geometry` does, crossings apart: two ways that leave a place in the same direction, for instance.

    Examples
    --------
    >>> from ninefold.mapping import SimulatedWorld, explore
    >>> world = SimulatedWorld([(0, 0), (3, 0), (0, 4)], [(0, 1), (1, 2), (2, 0)], vertex_names="abc")
    >>> explore(world).walk.places
    ('a', 'b', 'c', 'a')
    """

    __slots__ = (
        "_darts",
        "_paths",
        "_start",
        "edge_names",
        "edges",
        "heading",
        "metres",
        "narrowest",
        "points",
        "vertex_names",
    )

    def __init__(
        self,
        points: ArrayLike,
        edges: ArrayLike,
        paths: Sequence[ArrayLike | None] | None = None,
        *,
        vertex_names: Iterable[str | int] | None = None,
        edge_names: Iterable[str | int] | None = None,
    ) -> None:
        xy, ends = geometry.checked_points(points), geometry.checked_edges(edges)
        n_vertices, n_edges = len(xy), len(ends)
        if n_edges and (int(ends.min()) < 0 or int(ends.max()) >= n_vertices):
            raise BadInput(f"edges must hold rows of points, 0 to {n_vertices - 1}; found {int(ends.max())}")
        self.points, self.edges = xy, ends
        self.vertex_names = Names("vertex", n_vertices, vertex_names)
        self.edge_names = Names("edge", n_edges, edge_names)
        heading, _, line, start = geometry.bearings(xy, ends, paths, self.edge_names)
        self.heading: NDArray[np.float64] = heading
        self._paths, self._start = line, start
        tail = np.ascontiguousarray(ends.reshape(-1), dtype=np.int32)
        following = geometry.rotation_by_heading(tail, heading, n_vertices, self.vertex_names, self.edge_names)
        gaps = (heading[following] - heading) % TAU
        gaps[following == np.arange(tail.size)] = TAU
        self.narrowest = float(gaps.min()) if gaps.size else TAU
        order = np.lexsort((heading, tail))
        bounds = np.searchsorted(tail[order], np.arange(n_vertices + 1))
        self._darts = (order, bounds)
        self.metres = float(sum(np.hypot(*np.diff(self.path(e), axis=0).T).sum() for e in range(n_edges)))

    def __repr__(self) -> str:
        return f"SimulatedWorld({len(self.points)} places, {len(self.edges)} ways)"

    def darts_at(self, vertex: int) -> list[int]:
        """Return the darts that leave a vertex, counter-clockwise, ascending yaw; dart 2e runs as edge e is given."""
        order, bounds = self._darts
        return [int(d) for d in order[bounds[vertex] : bounds[vertex + 1]]]

    def path(self, edge: int) -> NDArray[np.float64]:
        """Return the polyline of an edge, (k, 2)."""
        if self._paths is None:
            return np.asarray(self.points[self.edges[edge]])
        return self._paths[self._start[edge] : self._start[edge + 1]]

    def sampled(self, dart: int, step: float) -> tuple[NDArray[np.float64], float]:
        """Return the yaw of a robot that goes along a dart, (n,) radians not wrapped, and the metres it goes.

        Sampled at the start, every `step` metres, at every bend and at the end. A robot that turns more than a quarter turn
        on the spot is also sampled half-way through, so that noise cannot flip the sense in which it turned.
        """
        line = self.path(dart >> 1)
        if dart & 1:
            line = line[::-1]
        pieces = np.diff(line, axis=0)
        length = np.hypot(pieces[:, 0], pieces[:, 1])
        yaw = np.arctan2(pieces[:, 1], pieces[:, 0])
        if len(yaw) == 1:
            return np.full(ceil(length[0] / step) + 1, yaw[0]), float(length[0])
        bend = np.diff(yaw)
        bend -= TAU * np.round(bend / TAU)
        yaw = yaw[0] + np.concatenate([[0.0], np.cumsum(bend)])
        reach = np.concatenate([[0.0], np.cumsum(length)])
        # Multiples of step strictly inside each piece, and one sample where it begins.
        inside = np.maximum(np.ceil(reach[1:] / step) - np.floor(reach[:-1] / step) - 1, 0).astype(np.int64)
        samples = np.repeat(yaw, inside + 1)
        sharp = np.flatnonzero(np.abs(bend) > pi / 2)
        if sharp.size:
            samples = np.insert(samples, np.cumsum(inside + 1)[sharp], yaw[sharp] + bend[sharp] / 2)
        return np.append(samples, yaw[-1]), float(reach[-1])

    def components(self) -> list[list[int]]:
        """Return the vertices of each connected component, ascending, the component of the lowest vertex first."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        n = len(self.points)
        links = coo_array((np.ones(len(self.edges), np.int8), (self.edges[:, 0], self.edges[:, 1])), shape=(n, n))
        count, component = connected_components(links, directed=False)
        order = np.argsort(component, kind="stable")
        parts = np.split(order, np.cumsum(np.bincount(component, minlength=count))[:-1])
        return sorted(part.tolist() for part in parts)
