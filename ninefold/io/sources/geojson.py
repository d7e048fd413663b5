"""GeoJSON lines as a source: streets, corridors, any polylines that share coordinates where they meet.

Vertices are the ends of lines and every coordinate that occurs twice; all other coordinates are bends. Longitude and
latitude (RFC 7946) are projected to metres about the centre of the file (equirectangular). Coordinates are taken as planar
metres where the file says so: ``"ninefold": {"units": "m"}``, or an old-style ``crs`` member that names a projected system.

References
----------
RFC 7946, The GeoJSON Format, 2016.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._files import shown
from ninefold._wording import quoted
from ninefold.errors import BadInput

from .projection import Projection
from .source import Source

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import NDArray

__all__ = ["parse_geojson", "read_geojson"]

LARGEST_METRES = 1e9
"""Planar coordinates beyond this are taken for a mistake: their small digits would be lost."""

_LON_LAT = re.compile(r"(CRS:?84|EPSG:+(0:)?(4326|4258|4269))$", re.IGNORECASE)
_MAX_NAME = 200


def read_geojson(path: str | PathLike[str]) -> Source:
    """Read a GeoJSON file of lines.

    Parameters
    ----------
    path
        A FeatureCollection, Feature or bare geometry; LineString and MultiLineString count, a Point with a ``name`` that
        lies on a vertex names it, everything else is left out with a note. ``id`` or else ``name`` names an edge; where
        several edges have it they are numbered, as in "Unioninkatu 3".

    Raises
    ------
    BadInput
        For a file that cannot be read, is no GeoJSON, has no line, or a coordinate that is not finite or not on Earth.

    Notes
    -----
    Complexity O(N log N) in the number of coordinates.
    """
    file = Path(path)
    try:
        text = file.read_text(encoding="utf-8-sig")
    except UnicodeDecodeError:
        raise BadInput(f"{file}: not text in UTF-8, so it is no GeoJSON") from None
    except OSError as error:
        raise BadInput(f"{shown(file)}: cannot be read ({error.strerror or error})") from None
    return parse_geojson(text, origin=file.name)


def parse_geojson(text: str, *, origin: str = "GeoJSON") -> Source:
    """Read GeoJSON from a string; see `read_geojson`.

    Examples
    --------
    >>> from ninefold.io.sources.geojson import parse_geojson
    >>> parse_geojson('{"type": "LineString", "coordinates": [[24.94, 60.17], [24.95, 60.17]]}')
    Source(GeoJSON: 2 vertices, 1 edge)
    """
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        if isinstance(error, json.JSONDecodeError):
            reason = f"line {error.lineno}: {error.msg}"
        else:
            reason = "nested too deep" if isinstance(error, RecursionError) else "a number is too long"
        raise BadInput(f"{origin}: not JSON ({reason})") from None
    found = _Found(origin)
    if not isinstance(document, dict):
        raise BadInput(f'{origin}: GeoJSON is an object with a "type", not {_kind(document)}')
    found.add_document(document)
    if not found.lines:
        left = f" ({found.left_out()})" if found.ignored else ""
        raise BadInput(f"{origin}: there is no LineString or MultiLineString in it{left}")
    notes = _notes_on_ignored(found)
    ways, marks, projection = _project(found, _is_planar(document, origin))
    return replace(_split(found, ways, marks, notes), projection=projection)


@dataclass(slots=True)
class _Found:
    """The lines of a file in order, and what names them."""

    origin: str
    lines: list[NDArray[np.float64]] = field(default_factory=list)
    ids: list[str | None] = field(default_factory=list)
    names: list[str | None] = field(default_factory=list)
    marks: list[tuple[str, NDArray[np.float64]]] = field(default_factory=list)
    ignored: Counter[str] = field(default_factory=Counter)

    def left_out(self) -> str:
        return ", ".join(f"{count} {kind}" for kind, count in sorted(self.ignored.items()))

    def add_document(self, document: dict[str, Any]) -> None:
        if document.get("type") != "FeatureCollection":
            self._add_feature(document, "the document")
            return
        features = document.get("features")
        if not isinstance(features, list):
            raise BadInput(f'{self.origin}: a FeatureCollection has a list "features", not {_kind(features)}')
        for number, feature in enumerate(features, 1):
            if not isinstance(feature, dict):
                raise BadInput(f"{self.origin}: feature {number} is {_kind(feature)}, not an object")
            self._add_feature(feature, f"feature {number}")

    def _add_feature(self, feature: dict[str, Any], where: str) -> None:
        if feature.get("type") != "Feature":
            self._add_geometry(feature, where, None, None)
            return
        properties = feature.get("properties")
        properties = properties if isinstance(properties, dict) else {}
        identity = _label(feature.get("id")) or _label(properties.get("id"))
        geometry = feature.get("geometry")
        if geometry is None:
            self.ignored["feature without geometry"] += 1
        elif not isinstance(geometry, dict):
            raise BadInput(f"{self.origin}: the geometry of {where} is {_kind(geometry)}, not an object")
        else:
            self._add_geometry(geometry, where, identity, _label(properties.get("name")))

    def _add_geometry(self, geometry: dict[str, Any], where: str, identity: str | None, name: str | None) -> None:
        kind = geometry.get("type")
        coordinates = geometry.get("coordinates")
        if kind == "LineString":
            self._add_line(coordinates, where, identity, name)
        elif kind == "MultiLineString":
            if not isinstance(coordinates, list):
                raise BadInput(f"{self.origin}: the coordinates of {where} are {_kind(coordinates)}, not a list of lines")
            for line in coordinates:
                self._add_line(line, where, identity, name)
        elif kind == "GeometryCollection":
            parts = geometry.get("geometries")
            if not isinstance(parts, list) or not all(isinstance(part, dict) for part in parts):
                raise BadInput(f'{self.origin}: a GeometryCollection ({where}) has a list "geometries" of objects')
            for part in parts:
                if part.get("type") == "GeometryCollection":
                    raise BadInput(f"{self.origin}: a GeometryCollection ({where}) may not hold another")
                self._add_geometry(part, where, identity, name)
        elif kind == "Point" and name is not None:
            self.marks.append((name, self._positions([coordinates], where)))
        elif isinstance(kind, str):
            self.ignored[kind if kind in _OTHER_TYPES else "object of no GeoJSON type"] += 1
        else:
            raise BadInput(f'{self.origin}: {where} has no "type", so it is no GeoJSON')

    def _add_line(self, coordinates: Any, where: str, identity: str | None, name: str | None) -> None:
        if not isinstance(coordinates, list):
            raise BadInput(f"{self.origin}: the coordinates of {where} are {_kind(coordinates)}, not a list of positions")
        if len(coordinates) < 2:
            self.ignored["line with fewer than two positions"] += 1
            return
        self.lines.append(self._positions(coordinates, where))
        self.ids.append(identity)
        self.names.append(name)

    def _positions(self, positions: list[Any], where: str) -> NDArray[np.float64]:
        try:
            if not all(len(position) >= 2 and not isinstance(position, str | dict) for position in positions):
                raise TypeError
            pairs = [(position[0], position[1]) for position in positions]
            if any(type(value) not in (int, float) for pair in pairs for value in pair):
                raise TypeError
            array = np.array(pairs, dtype=np.float64)
        except (TypeError, ValueError, OverflowError):
            raise BadInput(f"{self.origin}: {where} has a position that is not a list of two or more numbers") from None
        if not np.isfinite(array).all():
            raise BadInput(f"{self.origin}: {where} has a coordinate that is not a finite number")
        return array + 0.0  # -0.0 and 0.0 are one place


_OTHER_TYPES = frozenset({"Point", "MultiPoint", "Polygon", "MultiPolygon"})


def _is_planar(document: dict[str, Any], origin: str) -> bool:
    own = document.get("ninefold")
    if isinstance(own, dict) and "units" in own:
        if own["units"] != "m":
            raise BadInput(f'{origin}: "units" is {quoted(own["units"])}; only "m" (planar metres) is known')
        return True
    crs = document.get("crs")
    if isinstance(crs, dict) and isinstance(crs.get("properties"), dict) and isinstance(crs["properties"].get("name"), str):
        return _LON_LAT.search(crs["properties"]["name"]) is None
    return False


def _project(
    found: _Found,
    planar: bool,  # noqa: FBT001
) -> tuple[list[NDArray[np.float64]], list[tuple[str, NDArray[np.float64]]], Projection | None]:
    """Return lines and named points in planar metres, and how they got there from degrees, if they did."""
    everything = np.concatenate([*found.lines, *(at for _, at in found.marks)])
    if planar:
        if (np.abs(everything) > LARGEST_METRES).any():
            raise BadInput(f"{found.origin}: a coordinate lies more than {LARGEST_METRES:g} m from the origin")
        return found.lines, found.marks, None
    if (np.abs(everything) > (180.0, 90.0)).any():
        x, y = everything[int(np.flatnonzero((np.abs(everything) > (180.0, 90.0)).any(axis=1))[0])].tolist()
        raise BadInput(
            f"{found.origin}: ({x:g}, {y:g}) is no longitude and latitude; for planar metres add the member "
            '"ninefold": {"units": "m"}'
        )
    projection = Projection.about(everything)
    lines = [projection.metres(line) for line in found.lines]
    return lines, [(name, projection.metres(at)) for name, at in found.marks], projection


def _split(
    found: _Found, ways: list[NDArray[np.float64]], marks: list[tuple[str, NDArray[np.float64]]], notes: list[str]
) -> Source:
    """Split lines at shared coordinates into the edges of a source."""
    flat = np.concatenate(ways)
    # Complex numbers sort by x, then y: one key a place.
    _, first, place = np.unique(flat[:, 0] + 1j * flat[:, 1], return_index=True, return_inverse=True)
    offset = np.concatenate([[0], np.cumsum([len(way) for way in ways])]).tolist()
    rows, lines = _distinct_lines(place, offset, notes, found.origin)
    uses = Counter(p for line in lines for p in line)
    vertices = {p for p, count in uses.items() if count > 1}
    for line in lines:
        vertices.update((line[0], line[-1]))
        vertices.update(b for a, b, c in zip(line, line[1:], line[2:], strict=False) if a == c)  # there and back again
    number: dict[int, int] = {}
    ends: list[tuple[int, int]] = []
    ways_of: list[list[int]] = []
    owner: list[int] = []
    seen: set[tuple[int, ...]] = set()
    twice = 0
    for row, line in zip(rows, lines, strict=True):
        start = 0
        for i in range(1, len(line)):
            if line[i] not in vertices:
                continue
            piece = line[start : i + 1]
            start = i
            key = min(tuple(piece), tuple(piece[::-1]))
            if key in seen:
                twice += 1
                continue
            seen.add(key)
            ends.append((number.setdefault(piece[0], len(number)), number.setdefault(piece[-1], len(number))))
            ways_of.append(piece)
            owner.append(row)
    if twice:
        notes.append(f"dropped {_many(twice, 'stretch', 'stretches')} that repeat another")
    at = flat[first]
    points = at[list(number)]
    paths = tuple(None if len(piece) == 2 else at[piece] for piece in ways_of)
    labels = tuple(found.names[row] for row in owner)
    return Source(
        points=points,
        edges=np.array(ends, np.int32),
        paths=paths,
        vertex_names=_vertex_names(points, marks, notes),
        edge_names=_edge_names([found.ids[row] or found.names[row] for row in owner]),
        labels=labels,
        origin=found.origin,
        notes=tuple(notes),
    )


def _distinct_lines(
    place: NDArray[np.int64], offset: list[int], notes: list[str], origin: str
) -> tuple[list[int], list[list[int]]]:
    """Return the lines as lists of places, without repeated positions, lines without length and repeated lines."""
    rows: list[int] = []
    lines: list[list[int]] = []
    seen: set[tuple[int, ...]] = set()
    flat = short = twice = 0
    for row, (begin, end) in enumerate(pairwise(offset)):
        raw = place[begin:end].tolist()
        line = [p for i, p in enumerate(raw) if i == 0 or p != raw[i - 1]]
        flat += len(raw) - len(line)
        key = min(tuple(line), tuple(line[::-1]))
        if len(line) < 2:
            short += 1
            flat -= len(raw) - len(line)
        elif key in seen:
            twice += 1
        else:
            seen.add(key)
            rows.append(row)
            lines.append(line)
    for count, one, many, what in (
        (flat, "position", "positions", "that repeat the one before"),
        (short, "line", "lines", "without length"),
        (twice, "line", "lines", "that repeat another"),
    ):
        if count:
            notes.append(f"dropped {_many(count, one, many)} {what}")
    if not lines:
        raise BadInput(f"{origin}: every line has length zero, so there is no edge")
    return rows, lines


def _vertex_names(
    points: NDArray[np.float64], marks: list[tuple[str, NDArray[np.float64]]], notes: list[str]
) -> tuple[str, ...]:
    row = {tuple(point): v for v, point in enumerate(points.tolist())} if marks else {}
    given: dict[int, str] = {}
    taken: set[str] = set()
    for name, at in marks:
        v = row.get(tuple(at[0].tolist()))
        if v is not None and v not in given and name not in taken:
            given[v] = name
            taken.add(name)
    off = len(marks) - len(given)
    if off:
        notes.append(f"left out {_many(off, 'named point', 'named points')} off the vertices, or with a name already given")
    return tuple(given.get(v) or _free(f"v{v}", taken) for v in range(len(points)))


def _edge_names(given: list[str | None]) -> tuple[str, ...]:
    """Return unique names: the given one, numbered where several edges have it, else e and the row."""
    total = Counter(given)
    taken = {name for name in given if name is not None and total[name] == 1}
    count: Counter[str] = Counter()
    names = []
    for e, name in enumerate(given):
        if name is None:
            names.append(_free(f"e{e}", taken))
        elif total[name] == 1:
            names.append(name)
        else:
            count[name] += 1
            names.append(_free(f"{name} {count[name]}", taken))
    return tuple(names)


def _free(name: str, taken: set[str]) -> str:
    while name in taken:
        name += "'"
    taken.add(name)
    return name


def _label(value: Any) -> str | None:
    """Return printable text without surrounding space, or None if there is none."""
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        return None
    text = " ".join("".join(c if c.isprintable() else " " for c in str(value)[:_MAX_NAME]).split())
    return text or None


def _notes_on_ignored(found: _Found) -> list[str]:
    return [f"left out {found.left_out()}"] if found.ignored else []


def _many(count: int, one: str, many: str) -> str:
    return f"{count} {one if count == 1 else many}"


def _kind(value: Any) -> str:
    names = {dict: "an object", list: "a list", str: "a string", bool: "true or false", int: "a number", float: "a number"}
    return "null" if value is None else names.get(type(value), "something else")
