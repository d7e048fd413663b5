"""The true shapes of a map's sets, from the source that the map was made from.

The map knows no coordinate; a source does, and the two share vertex and edge names. So every set of the map has a shape on
the ground, which its relations can be held against.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from ninefold.errors import UnknownName
from ninefold.mapping import Line, Point, Region, wrap

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.mapping import PlaneMap, Set

    from .drawing import Drawing

__all__ = ["Ground", "TrueShapes"]


class Ground(Protocol):
    """What has coordinates for the vertices and edges of a map: a `ninefold.io.Source`, for instance."""

    @property
    def points(self) -> NDArray[np.float64]:
        """(V, 2) coordinates of the vertices."""

    @property
    def edges(self) -> NDArray[np.int32]:
        """(E, 2) rows of `points`."""

    @property
    def vertex_names(self) -> tuple[str, ...]:
        """Names of the vertices."""

    @property
    def edge_names(self) -> tuple[str, ...]:
        """Names of the edges."""

    @property
    def geometry(self) -> NDArray[np.object_]:
        """(E,) shapely LineStrings."""

    def polyline(self, edge: int) -> NDArray[np.float64]:
        """Return the (k, 2) polyline of an edge."""


class TrueShapes:
    """Shapely geometry of sets, found by the names of their vertices and edges.

    Parameters
    ----------
    source
        With the names that the maps use.

    Examples
    --------
    >>> from ninefold.io import samples
    >>> from ninefold.layout.truth import TrueShapes
    >>> source = samples.load("office")
    >>> TrueShapes(source).of(source.to_map().cycle(["lobby", "hall", "archive", "desk"])).area
    100.0
    """

    def __init__(self, source: Ground) -> None:
        self.source = source
        self._vertex = {name: row for row, name in enumerate(source.vertex_names)}
        self._edge = {name: row for row, name in enumerate(source.edge_names)}

    def of(self, item: Set) -> Any:
        """Return the shape of a set.

        A region is what the true polylines of its boundary edges enclose an odd number of times; its faces are not asked.

        Raises
        ------
        UnknownName
            For a vertex or edge that the source does not have.
        """
        import shapely

        match item:
            case Point():
                return shapely.Point(self.source.points[self._row("vertex", item.name)])
            case Line():
                # Trails, not edges: GEOS overlooks boundary points of lines in pieces (see ninefold.mapping.trails).
                return shapely.MultiLineString([self._along(item.plane, trail) for trail in item.trails])
            case Region():
                return _enclosed([self.source.geometry[self._row("edge", name)] for name in item.boundary.edge_names])

    def _along(self, plane: PlaneMap, darts: tuple[int, ...]) -> NDArray[np.float64]:
        pieces = [self._path(plane, d) for d in darts]
        return np.concatenate([pieces[0][:1], *[piece[1:] for piece in pieces]])

    def _path(self, plane: PlaneMap, dart: int) -> NDArray[np.float64]:
        """Return the polyline along a dart of the map, which may have been walked against the source's sense."""
        edge = self._row("edge", plane.edge_names[dart >> 1])
        u, v = self.source.edges[edge].tolist()
        path = self.source.polyline(edge)
        if u != v:
            return path if u == self._row("vertex", plane.vertex_names[int(plane.tail[dart])]) else path[::-1]
        if plane.heading is None:
            return path
        # A loop: the sense in which it leaves as the map says.
        step, back = path[1] - path[0], path[-2] - path[-1]
        miss = [abs(wrap(float(np.arctan2(y, x)) - float(plane.heading[dart]))) for x, y in (step, back)]
        return path if miss[0] <= miss[1] else path[::-1]

    def drawing(self, plane: PlaneMap) -> Drawing:
        """Return the map drawn where it lies: `ninefold.layout.drawing_problems` then checks its rotation and faces.

        Raises
        ------
        UnknownName
            For a vertex or edge that the source does not have.
        """
        from .drawing import Drawing

        points = self.source.points[[self._row("vertex", name) for name in plane.vertex_names]]
        none = np.zeros((0, 2))
        inner = [none if plane.tether[e] else self._path(plane, 2 * e)[1:-1] for e in range(plane.tether.size)]
        start = np.concatenate([[0], np.cumsum([len(bends) for bends in inner])])
        return Drawing.from_points(plane, points, np.concatenate([none, *inner]), start, layout="ground")

    def _row(self, kind: str, name: str) -> int:
        rows = self._vertex if kind == "vertex" else self._edge
        if name not in rows:
            raise UnknownName(kind, name, rows)
        return rows[name]


def _enclosed(lines: list[Any]) -> Any:
    """Return what lines enclose an odd number of times. Coordinates stay as they are: nothing is overlaid."""
    import shapely

    cells = shapely.get_parts(shapely.polygonize(lines))
    coordinates, owner = shapely.get_coordinates(lines, return_index=True)
    joined = owner[1:] == owner[:-1]
    (x0, y0), (x1, y1) = coordinates[:-1][joined].T, coordinates[1:][joined].T
    inside = []
    for cell, (x, y) in zip(cells, shapely.get_coordinates(shapely.point_on_surface(cells)), strict=True):
        upward = (y0 > y) != (y1 > y)  # pieces that a ray to the east may meet
        at = x0[upward] + (y - y0[upward]) * (x1[upward] - x0[upward]) / (y1[upward] - y0[upward])
        if np.count_nonzero(at > x) % 2:
            inside.append(cell)
    return shapely.MultiPolygon(inside)  # two cells inside share no edge, for it would be no boundary
