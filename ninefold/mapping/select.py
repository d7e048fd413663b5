"""Naming sets: from vertices, edges and the text form to points, lines and regions."""

from __future__ import annotations

from contextlib import suppress
from numbers import Integral
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import AmbiguousDart, BadInput, EmptySet, NotACycle, UnknownName

from .numbering import Dart, Edge, Vertex
from .sets import Line, Point, Region

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from .plane import PlaneMap
    from .sets import Set

__all__ = ["cycle", "darts_between", "edge", "line", "parse", "path", "region"]


def edge(plane: PlaneMap, names: Sequence[str | int]) -> Line:
    """Return one edge, by its name or by the names of its two ends.

    Raises
    ------
    UnknownName, AmbiguousDart, BadInput
        For no such edge, several between the two vertices, or another number of names.
    """
    if len(names) == 1:
        return Line(plane, (_edge_row(plane, names[0]),))
    if len(names) == 2:
        dart = _dart_between(plane, plane.vertex_names.row(names[0]), plane.vertex_names.row(names[1]))
        return Line(plane, (Edge(dart >> 1),))
    raise BadInput(f"an edge is named by its own name or by its two ends, not by {counted(len(names), 'name')}")


def line(plane: PlaneMap, edges: Iterable[str | int]) -> Line:
    """Return any set of edges, each given by name (with or without ``@``)."""
    rows = sorted({_edge_row(plane, name) for name in _list(edges, "line")})
    if not rows:
        raise EmptySet("a line needs at least one edge")
    return Line(plane, tuple(rows))


def path(plane: PlaneMap, steps: Iterable[str | int]) -> Line:
    """Return the path along the steps, vertices or ``@edge``.

    Raises
    ------
    NotACycle
        If a step does not follow from the one before, or an edge is used twice.
    """
    darts = _walk(plane, _list(steps, "path"), close=False)
    if not darts:
        raise EmptySet("a path needs at least one edge; for a place alone use plane.vertex")
    _no_edge_twice(plane, darts, "path")
    return Line(plane, tuple(Edge(d >> 1) for d in darts), tuple(darts))


def cycle(plane: PlaneMap, steps: Iterable[str | int] | None = None, edges: Iterable[str | int] | None = None) -> Region:
    """Return the interior of a simple cycle.

    Raises
    ------
    NotACycle
        If the steps or edges are not one simple cycle; the message names the vertex where they fail.
    """
    if (steps is None) == (edges is None):
        raise BadInput("give a cycle either by steps or by edges=[...]")
    if edges is not None:
        rows = [_edge_row(plane, name) for name in _list(edges, "cycle")]
    else:
        darts = _walk(plane, [] if steps is None else _list(steps, "cycle"), close=True)
        _no_edge_twice(plane, darts, "cycle")
        rows = [Edge(d >> 1) for d in darts]
    if not rows:
        raise EmptySet("a cycle needs at least one edge")
    if len(set(rows)) != len(rows):
        raise NotACycle("an edge is given twice in the cycle")
    _check_simple(plane, rows)
    numbers = np.array(rows, np.int64)
    return Region.from_ends(plane, plane.containment.inside(numbers), numbers)


def region(plane: PlaneMap, faces: Iterable[int]) -> Region:
    """Return the union of bounded faces."""
    if isinstance(faces, Point | Line | Region):
        raise BadInput(f"{faces!r} is a set already; plane.region takes the numbers of faces, and X | Y joins regions")
    if isinstance(faces, Integral):
        raise BadInput(f"plane.region takes several face numbers, as in plane.region([{faces}]); plane.face({faces}) is one")
    return Region.from_faces(plane, faces)


def parse(plane: PlaneMap, text: str) -> Set:
    """Return the set that a text names.

    The forms: ``vertex:v3``, ``edge:v1,v3``, ``edge:@e7``, ``path:v1,v2,@e9,v3``, ``line:@e1,@e2``, ``cycle:v0,v1,v8,v7``,
    ``face:12``, ``faces:3,4,9``. Names with commas cannot be written so; give those as lists in Python or JSON.

    Raises
    ------
    BadInput
        For an unknown form; the message lists the forms.
    """
    form, colon, rest = text.partition(":")
    make = _FORMS.get(form.strip().lower())
    if not colon or make is None:
        raise BadInput(f"{text!r} is no set; write one of {', '.join(f'{known}:...' for known in _FORMS)}")
    parts = [part.strip() for part in rest.split(",")]
    if not all(parts):
        raise BadInput(f"{text!r} has an empty name; write names with commas between them")
    return make(plane, parts)


def _one_vertex(plane: PlaneMap, parts: list[str]) -> Point:
    if len(parts) != 1:
        raise BadInput(f"vertex: takes one name, not {len(parts)}")
    return plane.vertex(parts[0])


def _one_face(plane: PlaneMap, parts: list[str]) -> Region:
    if len(parts) != 1:
        raise BadInput(f"face: takes one number, not {len(parts)}; use faces: for several")
    return region(plane, _numbers(parts))


def _cycle_of(plane: PlaneMap, parts: list[str]) -> Region:
    if all(part.startswith("@") for part in parts):
        return cycle(plane, edges=parts)
    return cycle(plane, parts)


_FORMS: dict[str, Callable[[PlaneMap, list[str]], Set]] = {
    "vertex": _one_vertex,
    "edge": edge,
    "path": path,
    "line": line,
    "cycle": _cycle_of,
    "face": _one_face,
    "faces": lambda plane, parts: region(plane, _numbers(parts)),
}


def _numbers(parts: list[str]) -> list[int]:
    for part in parts:
        if not (part.isascii() and part.isdecimal() and len(part) < 10):
            raise BadInput(f"{part!r} is no face number")
    return [int(part) for part in parts]


def _list(names: Iterable[str | int], what: str) -> list[str | int]:
    if isinstance(names, str):
        raise BadInput(f"a {what} takes a list of names, not the string {quoted(names)}; plane.parse reads text")
    if isinstance(names, Point | Line | Region):
        raise BadInput(f"a {what} takes a list of names, and {names!r} is a set already")
    if not hasattr(names, "__iter__"):
        raise BadInput(f"a {what} takes a list of names, not {quoted(names)}")
    return list(names)


def _edge_row(plane: PlaneMap, name: str | int) -> Edge:
    text = str(name)
    row = plane.edge_names.row(text[1:] if text.startswith("@") else text)
    if plane.tether[row]:
        raise UnknownName("edge", text)
    return Edge(row)


def darts_between(plane: PlaneMap, u: int, v: int) -> list[Dart]:
    """Return the darts from vertex u to vertex v (numbers), tethers left out; O(smaller degree)."""
    at_u = plane.spokes[u] <= plane.spokes[v]
    darts = plane.darts_at(Vertex(u)) if at_u else [Dart(d ^ 1) for d in plane.darts_at(Vertex(v))]
    return [d for d in darts if plane.tail[d] == u and plane.tail[d ^ 1] == v and not plane.tether[d >> 1]]


def _dart_between(plane: PlaneMap, u: int, v: int) -> Dart:
    found = darts_between(plane, u, v)
    edges = sorted({d >> 1 for d in found})
    if not edges:
        raise UnknownName("edge", f"{plane.vertex_names[u]} - {plane.vertex_names[v]}")
    if len(edges) > 1:
        names = ", ".join(f"@{plane.edge_names[e]}" for e in edges)
        raise AmbiguousDart(
            f"{len(edges)} edges join {plane.vertex_names[u]!r} and {plane.vertex_names[v]!r}: say which of {names}"
        )
    return min(found)


def _walk(plane: PlaneMap, steps: list[str | int], *, close: bool) -> list[Dart]:
    """Turn steps into darts. After an ``@edge`` its own end may be named again; `close` goes back to the start."""
    if not steps:
        return []
    edges = [_edge_row(plane, step) if str(step).startswith("@") else -1 for step in steps]
    first, *others = _starts(plane, steps, edges)
    try:
        return _walk_from(plane, first, steps, edges, close=close)
    except (NotACycle, UnknownName):
        for other in others:
            with suppress(NotACycle, UnknownName):
                return _walk_from(plane, other, steps, edges, close=close)
        raise


def _walk_from(plane: PlaneMap, start: int, steps: list[str | int], edges: list[int], *, close: bool) -> list[Dart]:
    tail = plane.tail
    at, darts = start, list[Dart]()
    after_edge = True  # the first vertex of the list is where the walk stands
    for step, e in zip(steps, edges, strict=True):
        if e >= 0:
            dart = Dart(2 * e if tail[2 * e] == at else 2 * e + 1)
            if tail[dart] != at:
                raise NotACycle(f"edge {step!r} does not leave {plane.vertex_names[at]!r}, where the way has come to")
        else:
            to = plane.vertex_names.row(step)
            if after_edge and to == at:
                after_edge = False
                continue
            dart = _dart_between(plane, at, to)
        after_edge = e >= 0
        darts.append(dart)
        at = int(tail[dart ^ 1])
    if close and (at != start or not darts):
        darts.append(_dart_between(plane, at, start))
    return darts


def _starts(plane: PlaneMap, steps: list[str | int], edges: list[int]) -> list[int]:
    """Return the vertex a walk starts at; where it begins with an edge, the ends from which the next step follows."""
    if edges[0] < 0:
        return [plane.vertex_names.row(steps[0])]
    u, v = int(plane.tail[2 * edges[0]]), int(plane.tail[2 * edges[0] + 1])
    if len(steps) == 1 or u == v:
        return [u]
    if edges[1] >= 0:
        ends = {int(plane.tail[2 * edges[1]]), int(plane.tail[2 * edges[1] + 1])}
    else:
        to = plane.vertex_names.row(steps[1])
        ends = {to} if to in (u, v) else {int(plane.tail[d ^ 1]) for d in plane.darts_at(Vertex(to))}
    return [at for at, far in ((u, v), (v, u)) if far in ends] or [v]


def _no_edge_twice(plane: PlaneMap, darts: Sequence[int], what: str) -> None:
    seen: set[int] = set()
    for d in darts:
        if d >> 1 in seen:
            raise NotACycle(f"edge {plane.edge_names[d >> 1]!r} is used twice; a {what} uses no edge twice")
        seen.add(d >> 1)


def _check_simple(plane: PlaneMap, rows: Sequence[int]) -> None:
    """Check that the edges form one simple cycle: degree 2 at every vertex, and connected."""
    incident: dict[int, list[int]] = {}
    for e in rows:
        for v in (int(plane.tail[2 * e]), int(plane.tail[2 * e + 1])):
            incident.setdefault(v, []).append(e)
    for v, at in incident.items():
        if len(at) != 2:
            raise NotACycle(
                f"the edges are not a simple cycle: {len(at)} of them meet at {plane.vertex_names[v]!r}, and it takes 2"
            )
    e = rows[0]
    v = int(plane.tail[2 * e + 1])
    count = 1
    while count < len(rows) + 1:
        first, second = incident[v]
        e = second if first == e else first
        if e == rows[0]:
            break
        v = int(plane.tail[2 * e + 1]) if plane.tail[2 * e] == v else int(plane.tail[2 * e])
        count += 1
    if count != len(rows):
        raise NotACycle(f"the edges are {len(rows)} in several cycles, not one; make regions of each and join them with |")
