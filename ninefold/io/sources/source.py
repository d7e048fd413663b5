"""A source with geometry: vertices with coordinates and the polylines between them, before they become a plane map.

A `Source` is what a simulated robot walks in, what `PlaneMap.from_geometry` is fed with, and what the oracle checks
against. Whatever was left out or looks odd is in `Source.notes` and never silent. Crossings without a vertex (bridges,
tunnels, sloppy digitising) are searched for here, with shapely, because no symbolic check can see all of them.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput
from ninefold.immutable import Immutable, freeze, frozen_copy

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.mapping import PlaneMap
    from ninefold.mapping.robot.simulated_world import SimulatedWorld

    from .projection import Projection

__all__ = ["Crossing", "Source"]


@dataclass(frozen=True, slots=True)
class Crossing:
    """Two edges that meet where there is no vertex, or one edge that meets itself.

    Attributes
    ----------
    edges
        Rows of the two edges, ascending; the same row twice for an edge that crosses itself.
    at
        Planar coordinates of the first place they meet, metres.
    places
        Number of places where they meet; a shared stretch counts one.
    overlap
        Whether they share a stretch.
    """

    edges: tuple[int, int]
    at: tuple[float, float]
    places: int
    overlap: bool


@dataclass(frozen=True, eq=False)
class Source(Immutable):
    """A street network, a floor plan, any set of polylines that meet at vertices. Immutable: arrays are copied in.

    Attributes
    ----------
    points
        (V, 2) float64 planar metres, x east and y north.
    edges
        (E, 2) int32 rows of `points`.
    paths
        Per edge None for a straight edge or a (k, 2) float64 polyline that includes both ends.
    vertex_names, edge_names
        Unique labels.
    labels
        Per edge the name its feature has in the file, which many edges may share (a street), or None.
    origin
        Where it was read from, for messages.
    notes
        What the reader left out or changed, a sentence each.
    projection
        From the longitudes and latitudes of the file to `points`, or None where the file was in planar metres. Messages give
        places in the coordinates of the file.

    Examples
    --------
    >>> from ninefold.io import samples
    >>> paper = samples.load("figure8")
    >>> paper
    Source(figure8: 9 vertices, 13 edges)
    >>> paper.to_map()
    PlaneMap(9 vertices, 13 edges, 6 faces)
    """

    points: NDArray[np.float64]
    edges: NDArray[np.int32]
    paths: tuple[NDArray[np.float64] | None, ...]
    vertex_names: tuple[str, ...]
    edge_names: tuple[str, ...]
    labels: tuple[str | None, ...]
    origin: str = ""
    notes: tuple[str, ...] = ()
    projection: Projection | None = None

    def __post_init__(self) -> None:
        kept: dict[str, Any] = {
            "points": frozen_copy(np.asarray(self.points, np.float64)),
            "edges": frozen_copy(np.asarray(self.edges, np.int32)),
            "paths": tuple(None if path is None else frozen_copy(np.asarray(path, np.float64)) for path in self.paths),
            "vertex_names": tuple(self.vertex_names),
            "edge_names": tuple(self.edge_names),
            "labels": tuple(self.labels),
            "notes": tuple(self.notes),
        }
        for name, value in kept.items():
            object.__setattr__(self, name, value)

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return len(self.points)

    @property
    def n_edges(self) -> int:
        """Number of edges."""
        return len(self.edges)

    def polyline(self, edge: int) -> NDArray[np.float64]:
        """Return the (k, 2) polyline of an edge, both ends included."""
        path = self.paths[edge]
        return self.points[self.edges[edge]] if path is None else path

    @cached_property
    def geometry(self) -> NDArray[np.object_]:
        """(E,) shapely LineStrings, the true geometry of the edges."""
        import shapely

        lines = [self.polyline(e) for e in range(self.n_edges)]
        rows = np.repeat(np.arange(self.n_edges), [len(line) for line in lines])
        shapes = np.asarray(shapely.linestrings(np.concatenate(lines), indices=rows)) if lines else np.empty(0, object)
        freeze(shapes)
        return shapes

    @property
    def streets(self) -> dict[str, tuple[int, ...]]:
        """Each label with the rows of its edges, in the order of first mention."""
        rows: dict[str, list[int]] = {}
        for e, label in enumerate(self.labels):
            if label is not None:
                rows.setdefault(label, []).append(e)
        return {label: tuple(found) for label, found in rows.items()}

    @cached_property
    def crossings(self) -> tuple[Crossing, ...]:
        """Where edges meet without a vertex, by edge rows; found with shapely.

        Notes
        -----
        Complexity O(E log E + pairs of edges whose bounding boxes meet).
        """
        return _crossings(self)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notes, and a sentence on crossings if there are any."""
        return (*self.notes, *([self._crossing_sentence()] if self.crossings else []))

    def to_map(self) -> PlaneMap:
        """Make the plane map, after a search for crossings.

        Raises
        ------
        BadInput
            If edges meet without a vertex; the message counts them and shows the first.
        NotPlane
            As `PlaneMap.from_geometry`.
        """
        from ninefold.mapping import PlaneMap

        self._refuse_crossings()
        return PlaneMap.from_geometry(
            self.points, self.edges, self.paths, vertex_names=self.vertex_names, edge_names=self.edge_names
        )

    def to_world(self) -> SimulatedWorld:
        """Make the world that a simulated robot explores; see `ninefold.mapping.robot.simulated`.

        Raises
        ------
        BadInput
            If edges meet without a vertex.
        """
        from ninefold.mapping.robot.simulated_world import SimulatedWorld

        self._refuse_crossings()
        return SimulatedWorld(
            self.points, self.edges, self.paths, vertex_names=self.vertex_names, edge_names=self.edge_names
        )

    def _refuse_crossings(self) -> None:
        if self.crossings:
            raise BadInput(
                f"{self._crossing_sentence()}; add vertices, or drop edges with --drop-crossing (Source.without_crossings)"
            )

    def without_crossings(self) -> Source:
        """Drop edges until none meets another without a vertex, those with the most crossings first.

        Returns
        -------
        Source
            Without the dropped edges and the vertices that only they touched, and with a note that names them; itself
            if there was nothing to drop. Greedy, so not always the fewest.
        """
        if not self.crossings:
            return self
        partners: dict[int, set[int]] = {}
        for crossing in self.crossings:
            a, b = crossing.edges
            partners.setdefault(a, set()).add(b)
            partners.setdefault(b, set()).add(a)
        dropped: list[int] = []
        while any(partners.values()):
            # An edge that crosses itself has to go anyhow; among equals the later edge goes.
            worst = max(partners, key=lambda e: (e in partners[e], len(partners[e]), e))
            for other in partners.pop(worst) - {worst}:
                partners[other].discard(worst)
            dropped.append(worst)
        shown = ", ".join(repr(self.edge_names[e]) for e in sorted(dropped)[:8]) + (", ..." if len(dropped) > 8 else "")
        kept = self.select(np.setdiff1d(np.arange(self.n_edges), dropped))
        note = f"dropped {len(dropped)} of {self.n_edges} edges that meet others without a vertex: {shown}"
        return replace(kept, notes=(*kept.notes, note))

    def select(self, rows: NDArray[np.int64]) -> Source:
        """Return the source with only these edges (rows, ascending) and the vertices they touch.

        Raises
        ------
        BadInput
            If no edge is left.
        """
        if not len(rows):
            raise BadInput(f"no edge of {self.origin or 'the source'} is left")
        used = np.unique(self.edges[rows])
        renumber = np.full(self.n_vertices, -1, np.int32)
        renumber[used] = np.arange(used.size, dtype=np.int32)
        return replace(
            self,
            points=self.points[used],
            edges=renumber[self.edges[rows]],
            paths=tuple(self.paths[e] for e in rows),
            vertex_names=tuple(self.vertex_names[v] for v in used),
            edge_names=tuple(self.edge_names[e] for e in rows),
            labels=tuple(self.labels[e] for e in rows),
        )

    def _crossing_sentence(self) -> str:
        first = self.crossings[0]
        a, b = (self.edge_names[e] for e in first.edges)
        where = f"({first.at[0]:.1f}, {first.at[1]:.1f}) metres"
        if self.projection is not None:
            longitude, latitude = self.projection.degrees(first.at)
            where = f"longitude {longitude:.6f}, latitude {latitude:.6f}"
        what = f"{quoted(a)} meets itself"
        if a != b:
            what = f"{quoted(a)} and {quoted(b)} {'overlap' if first.overlap else 'meet'}"
        count = sum(crossing.places for crossing in self.crossings)
        return f"edges meet at {counted(count, 'place')} without a vertex: first, {what} near {where}"

    def __repr__(self) -> str:
        return f"Source({self.origin}: {counted(self.n_vertices, 'vertex', 'vertices')}, {counted(self.n_edges, 'edge')})"


def _crossings(source: Source) -> tuple[Crossing, ...]:
    import shapely

    if not source.n_edges:
        return ()
    lines, owner = _open_lines(source)
    simple = shapely.is_simple(source.geometry)
    found = [_self_crossing(source, int(e)) for e in np.flatnonzero(~simple)]
    first, second = _suspects(source, lines, owner)
    # Open lines that share nothing but ends have no interior meeting an interior or a boundary: exact, no tolerance.
    relations = shapely.relate(lines[first], lines[second]).tolist()
    odd = [k for k, text in enumerate(relations) if not text[0] == text[1] == text[3] == "F"]
    pairs = sorted({(int(min(owner[first[k]], owner[second[k]])), int(max(owner[first[k]], owner[second[k]]))) for k in odd})
    found += [_crossing(source, a, b) for a, b in pairs if a != b or simple[a]]
    return tuple(sorted(found, key=lambda crossing: crossing.edges))


def _open_lines(source: Source) -> tuple[NDArray[np.object_], NDArray[np.int64]]:
    """Return lines with two different ends and the edge of each: a loop gives its two halves."""
    import shapely

    lines = list(source.geometry)
    owner = list(range(source.n_edges))
    for e in np.flatnonzero(source.edges[:, 0] == source.edges[:, 1]).tolist():
        path = source.polyline(e)
        middle = len(path) // 2
        lines[e] = shapely.LineString(path[: middle + 1])
        lines.append(shapely.LineString(path[middle:]))
        owner.append(e)
    return np.array(lines, dtype=object), np.array(owner, np.int64)


def _suspects(source: Source, lines: NDArray[np.object_], owner: NDArray[np.int64]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the pairs of lines (rows) that touch and may do so elsewhere than at common ends."""
    import shapely

    first, second = shapely.STRtree(lines).query(lines, predicate="intersects")
    keep = first < second
    first, second = first[keep], second[keep]
    # Two straight edges with one common end meet nowhere else, unless they leave it in one direction.
    straight = shapely.get_num_points(lines) == 2
    a, b = source.edges[owner[first]], source.edges[owner[second]]
    common = np.full(len(a), -1)
    count = np.zeros(len(a), np.int64)
    for i in (0, 1):
        for j in (0, 1):
            same = a[:, i] == b[:, j]
            count += same
            common[same] = a[same, i]
    easy = straight[first] & straight[second] & (count == 1)
    hub = source.points[np.where(easy, common, 0)]
    u = source.points[np.where(a[:, 0] == common, a[:, 1], a[:, 0])] - hub
    v = source.points[np.where(b[:, 0] == common, b[:, 1], b[:, 0])] - hub
    apart = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) > 1e-9 * np.hypot(*u.T) * np.hypot(*v.T)
    hard = ~(easy & (apart | ((u * v).sum(axis=1) < 0)))
    return first[hard], second[hard]


def _crossing(source: Source, a: int, b: int) -> Crossing:
    import shapely

    meeting = shapely.intersection(source.geometry[a], source.geometry[b])
    ends = {tuple(point) for point in source.points[np.intersect1d(source.edges[a], source.edges[b])].tolist()}
    parts = [part for part in shapely.get_parts(meeting).tolist() if part.geom_type != "Point" or part.coords[0] not in ends]
    if not parts:  # the meeting is so close to a common end that it rounds to it
        parts = shapely.get_parts(meeting).tolist()
    place = parts[0].coords[0]
    overlap = any(part.geom_type != "Point" for part in parts)
    return Crossing((a, b), (float(place[0]), float(place[1])), len(parts), overlap)


def _self_crossing(source: Source, edge: int) -> Crossing:
    import shapely

    path = source.polyline(edge)
    closed = bool(source.edges[edge, 0] == source.edges[edge, 1])
    pieces = Counter(
        point
        for part in shapely.get_parts(shapely.node(source.geometry[edge])).tolist()
        for point in (part.coords[0], part.coords[-1])
    )
    ends = {tuple(path[0].tolist()), tuple(path[-1].tolist())}
    places = [point for point, count in pieces.items() if point not in ends or count > (2 if closed else 1)]
    place = places[0] if places else (float(path[0, 0]), float(path[0, 1]))
    return Crossing((edge, edge), (float(place[0]), float(place[1])), max(1, len(places)), overlap=False)
