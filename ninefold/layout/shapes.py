"""Shapely geometries of points, lines and regions in a drawing, valid by construction wherever the drawing is plane.

**Lines** are cut into trails, so that no end of a part is an even vertex (see `ninefold.mapping.trails`).

**Regions.** The boundary darts, region on the left, are joined wedge by wedge: arriving at a vertex, turn clockwise through
the region until the next boundary dart. Each closed walk so found bounds one end of one connected part of the interior; cut
where it comes back to a vertex it gives simple rings, counter-clockwise ones the shells and clockwise ones the holes. A
connected part of the interior has exactly one shell, and rings of one part meet in single points at most: a valid polygon.
No overlay, hence no rounding: every coordinate is a coordinate of the drawing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput
from ninefold.mapping import Line, Point, Region

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ninefold.mapping import PlaneMap, Set

    from .drawing import Drawing

__all__ = ["geometry", "region_rings"]


def geometry(drawing: Drawing, X: Set) -> Any:
    """Return the shapely geometry of a set of the drawing's map."""
    import shapely

    match X:
        case Point():
            return shapely.Point(drawing.points[X.index])
        case Line():
            parts = [_along(drawing, trail) for trail in X.trails]
            return shapely.LineString(parts[0]) if len(parts) == 1 else shapely.MultiLineString(parts)
        case Region():
            polygons = [
                shapely.Polygon(rings[0], [r for r in rings[1:] if len(r) > 2]) for rings in region_rings(drawing, X)
            ]
            return polygons[0] if len(polygons) == 1 else shapely.MultiPolygon(polygons)


def region_rings(drawing: Drawing, region: Region) -> list[list[NDArray[Any]]]:
    """Return the rings of a region, part by part: the shell first, then the holes, each (k, 2) and not closed.

    Raises
    ------
    BadInput
        If a part has not exactly one shell, which a plane drawing cannot show.
    """
    rings = [ring for walk in _wedge_walks(region) for ring in _simple_rings(region.plane, walk)]
    outlines = [_along(drawing, ring)[:-1] for ring in rings]
    shells = [i for i, outline in enumerate(outlines) if _twice_area(outline) > 0]
    part_of = [0] * len(rings)
    if len(shells) > 1:
        label = _parts(region)
        part_of = label[region.plane.face_of[[ring[0] for ring in rings]]].tolist()
    parts: dict[int, list[NDArray[Any]]] = {}
    for i in shells:
        if parts.setdefault(part_of[i], [outlines[i]])[0] is not outlines[i]:
            raise _not_plane(region)
    holes = [i for i in range(len(rings)) if i not in set(shells)]
    for i in holes:
        if part_of[i] not in parts:
            raise _not_plane(region)
        parts[part_of[i]].append(outlines[i])
    return list(parts.values())


def _not_plane(region: Region) -> BadInput:
    return BadInput(f"{quoted(region)} has no outline in this drawing: its points do not draw the map; check it with verify")


def _wedge_walks(region: Region) -> list[list[int]]:
    """Join the boundary darts into closed walks, turning through the region's own wedge at every vertex."""
    next_face = region.plane.next_face
    left = set(region.darts.tolist())
    walks = []
    for start in region.darts.tolist():
        if start not in left:
            continue
        walk = []
        d = start
        while d in left:
            left.remove(d)
            walk.append(d)
            d = int(next_face[d])
            while d not in left and d != start:
                d = int(next_face[d ^ 1])
        walks.append(walk)
    return walks


def _simple_rings(plane: PlaneMap, walk: Sequence[int]) -> list[list[int]]:
    """Cut a closed walk into simple rings where it comes back to a vertex."""
    rings: list[list[int]] = []
    open_darts: list[int] = []
    place: dict[int, int] = {}
    for d, v in zip(walk, plane.tail[np.array(walk)].tolist(), strict=True):
        if v in place:
            ring = open_darts[place[v] :]
            del open_darts[place[v] :]
            for x in plane.tail[np.array(ring)].tolist():
                del place[x]
            rings.append(ring)
        place[v] = len(open_darts)
        open_darts.append(d)
    return [*rings, open_darts]


def _parts(region: Region) -> NDArray[np.int32]:
    """Label the faces of the region by connected part of its interior, (F,)."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    plane = region.plane
    inside = np.zeros(plane.n_faces, np.bool_)
    inside[list(region.faces)] = True
    left, right = plane.face_of[0::2], plane.face_of[1::2]
    both = inside[left] & inside[right]
    links = coo_array((np.ones(int(both.sum()), np.int8), (left[both], right[both])), shape=(plane.n_faces, plane.n_faces))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int32)


def _along(drawing: Drawing, darts: Sequence[int]) -> NDArray[Any]:
    """Return the polyline along darts that follow each other, both ends included."""
    tail, points = drawing.plane.tail, drawing.points
    chosen = np.array(darts, np.int64)
    ends = points[tail[np.append(chosen, chosen[-1] ^ 1)]]
    if not len(drawing.bends) or not np.diff(drawing.bend_start)[chosen >> 1].any():
        return np.asarray(ends)
    pieces = []
    for d, start in zip(darts, ends, strict=False):
        inner = drawing.bends[drawing.bend_start[d >> 1] : drawing.bend_start[(d >> 1) + 1]]
        pieces += [start[None], inner[::-1] if d & 1 else inner]
    return np.concatenate([*pieces, ends[-1:]])


def _twice_area(ring: NDArray[Any]) -> float:
    x, y = (ring - ring[0]).T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
