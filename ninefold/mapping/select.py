"""Naming sets: from vertices, edges and the text form to points, lines and regions."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import suppress
from numbers import Integral
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ninefold._wording import counted, quoted, shortened
from ninefold.errors import AmbiguousDart, BadInput, EmptySet, NotACycle, UnknownName

from .numbering import Dart, Edge, Vertex
from .sets import Line, Point, Region

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from .plane import PlaneMap
    from .sets import Set

Step: TypeAlias = str | int | Mapping[str, str | int]
"""A vertex by name, an edge as ``@name``, or exactly ``{"vertex": name}`` or ``{"edge": name}``."""

__all__ = ["Step", "cycle", "darts_between", "edge", "line", "parse", "path", "region"]


def edge(plane: PlaneMap, names: Sequence[Step]) -> Line:
    """Return one edge, by its name or by the names of its two ends.

    Raises
    ------
    UnknownName, AmbiguousDart, BadInput
        For no such edge, several between the two vertices, or another number of names.
    """
    if len(names) == 1:
        return Line(plane, (_edge_row(plane, names[0]),))
    if len(names) == 2:
        dart = _dart_between(plane, _vertex_row(plane, names[0]), _vertex_row(plane, names[1]))
        return Line(plane, (Edge(dart >> 1),))
    raise BadInput(f"an edge is named by its own name or by its two ends, not by {counted(len(names), 'name')}")


def line(plane: PlaneMap, edges: Iterable[Step]) -> Line:
    """Return any set of edges, each given by name (with or without ``@``)."""
    rows = sorted({_edge_row(plane, name) for name in _list(edges, "line")})
    if not rows:
        raise EmptySet("a line needs at least one edge")
    return Line(plane, tuple(rows))


def path(plane: PlaneMap, steps: Iterable[Step]) -> Line:
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


def cycle(plane: PlaneMap, steps: Iterable[Step] | None = None, edges: Iterable[Step] | None = None) -> Region:
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
        raise BadInput(f"{quoted(faces)} is a set already; plane.region takes the numbers of faces, and X | Y joins regions")
    if isinstance(faces, Integral):
        raise BadInput(f"plane.region takes several face numbers, as in plane.region([{faces}]); plane.face({faces}) is one")
    return Region.from_faces(plane, faces)


def parse(plane: PlaneMap, text: str) -> Set:
    """Return the set that a text names.

    The forms: ``vertex:v3``, ``edge:v1,v3``, ``edge:@e7``, ``path:v1,v2,@e9,v3``, ``line:@e1,@e2``, ``cycle:v0,v1,v8,v7``,
    ``face:12``, ``faces:3,4,9``. The same as a JSON list, for names with commas or spaces around them:
    ``["cycle", "a, north", "b", "c"]``.

    A step ``@name`` is the edge of that name. Where there is no such edge it is the place called ``@name``; where there are
    both, the JSON list says which: ``{"edge": "name"}`` or ``{"vertex": "@name"}``.

    Raises
    ------
    BadInput
        For an unknown form; the message lists the forms.
    """
    if text.lstrip().startswith("["):
        form, parts = _listed(text)
        return _FORMS[form](plane, parts)
    form, colon, rest = text.partition(":")
    form = form.strip().lower()
    if not colon or form not in _FORMS:
        forms = ", ".join(f"{known}:..." for known in _FORMS)
        raise BadInput(
            f'{quoted(text)} is no set; write one of {forms}, or a JSON list such as ["cycle", "a, north", "b", "c"]'
        )
    parts = [part.strip() for part in rest.split(",")]
    if not all(parts):
        raise BadInput(f"{quoted(text)} has an empty name; write names with commas between them")
    try:
        return _FORMS[form](plane, parts)
    except UnknownName as error:
        cut = next((name for name in (*plane.vertex_names, *plane.edge_names) if "," in name and name in rest), None)
        if cut is not None:
            error.message += f'; as {quoted(cut)} has a comma, write a JSON list: ["{form}", {json.dumps(cut)[:100]}, ...]'
        raise


def _listed(text: str) -> tuple[str, list[Step]]:
    """Return the form and the names of a set written as a JSON list."""
    try:
        found = json.loads(text)
    except (ValueError, RecursionError):
        raise BadInput(f'{quoted(text)} is no JSON list, such as ["edge", "v1", "v3"]') from None
    form = found[0] if isinstance(found, list) and len(found) > 1 else None
    if not isinstance(form, str) or form.lower() not in _FORMS:
        raise BadInput(f"a set as a JSON list is one of {', '.join(_FORMS)}, then its names; not {quoted(text)}")
    for part in found[1:]:
        if isinstance(part, bool) or not isinstance(part, str | int | dict):
            raise BadInput(f"the names in a JSON list are strings, not {quoted(part)} as in {quoted(text)}")
    return form.lower(), found[1:]


def _one_vertex(plane: PlaneMap, parts: list[Step]) -> Point:
    if len(parts) != 1:
        raise BadInput(f"vertex: takes one name, not {len(parts)}")
    return Point(plane, Vertex(_vertex_row(plane, parts[0])))


def _one_face(plane: PlaneMap, parts: list[Step]) -> Region:
    if len(parts) != 1:
        raise BadInput(f"face: takes one number, not {len(parts)}; use faces: for several")
    return region(plane, _numbers(parts))


def _cycle_of(plane: PlaneMap, parts: list[Step]) -> Region:
    if all(_edge_of_step(plane, part) >= 0 for part in parts):
        return cycle(plane, edges=parts)
    return cycle(plane, parts)


_FORMS: dict[str, Callable[[PlaneMap, list[Step]], Set]] = {
    "vertex": _one_vertex,
    "edge": edge,
    "path": path,
    "line": line,
    "cycle": _cycle_of,
    "face": _one_face,
    "faces": lambda plane, parts: region(plane, _numbers(parts)),
}


def _numbers(parts: list[Step]) -> list[int]:
    texts = [str(part) for part in parts]
    for text in texts:
        if not (text.isascii() and text.isdecimal() and len(text) < 10):
            raise BadInput(f"{quoted(text)} is no face number")
    return [int(text) for text in texts]


def _list(names: Iterable[Step], what: str) -> list[Step]:
    if isinstance(names, str):
        raise BadInput(f"a {what} takes a list of names, not the string {quoted(names)}; plane.parse reads text")
    if isinstance(names, Point | Line | Region):
        raise BadInput(f"a {what} takes a list of names, and {quoted(names)} is a set already")
    if not hasattr(names, "__iter__"):
        raise BadInput(f"a {what} takes a list of names, not {quoted(names)}")
    return list(names)


def _exactly(step: Step) -> tuple[str, str | int] | None:
    """Return what a step written as ``{"vertex": name}`` or ``{"edge": name}`` is, and the name; None for a plain name."""
    if not isinstance(step, Mapping):
        return None
    for kind, name in step.items():
        if len(step) == 1 and kind in ("vertex", "edge") and isinstance(name, str | int) and not isinstance(name, bool):
            return kind, name
    raise BadInput(f'a step is a name, {{"vertex": name}} or {{"edge": name}}, not {quoted(dict(step))}')


def _vertex_row(plane: PlaneMap, step: Step) -> int:
    exact = _exactly(step)
    if exact is None:
        return plane.vertex_names.row(step)  # type: ignore[arg-type]
    kind, name = exact
    if kind != "vertex":
        raise BadInput(f"the edge {quoted(name)} stands where a place is needed")
    return plane.vertex_names.row(name)


def _edge_row(plane: PlaneMap, step: Step) -> Edge:
    """Return an edge given by name with or without ``@``; by an exact name, as it is."""
    exact, names = _exactly(step), plane.edge_names
    if exact is not None:
        kind, name = exact
        if kind != "edge":
            raise BadInput(f"the place {quoted(name)} stands where an edge is needed")
        row = names.row(name)
    else:
        text = str(step)
        short = text.removeprefix("@")
        row = names.row(text if text in names and short not in names else short)
    if plane.tether[row]:
        raise UnknownName("edge", names[row])
    return Edge(row)


def _edge_of_step(plane: PlaneMap, step: Step) -> int:
    """Return the edge that a step of a path or cycle is, or -1 for a place; see `parse` for the rule."""
    exact = _exactly(step)
    if exact is not None:
        return _edge_row(plane, step) if exact[0] == "edge" else -1
    text = str(step)
    if not text.startswith("@"):
        return -1
    if text not in plane.vertex_names:
        return _edge_row(plane, text)
    if text[1:] in plane.edge_names or text in plane.edge_names:
        raise AmbiguousDart(
            f"{quoted(text)} is an edge and also the name of a place; in a JSON list, "
            f'{{"edge": {quoted(text[1:])}}} or {{"vertex": {quoted(text)}}} says which'
        )
    return -1


def darts_between(plane: PlaneMap, u: int, v: int) -> list[Dart]:
    """Return the darts from vertex u to vertex v (numbers), tethers left out; O(smaller degree)."""
    at_u = plane.spokes[u] <= plane.spokes[v]
    darts = plane.darts_at(Vertex(u)) if at_u else [Dart(d ^ 1) for d in plane.darts_at(Vertex(v))]
    return [d for d in darts if plane.tail[d] == u and plane.tail[d ^ 1] == v and not plane.tether[d >> 1]]


def _dart_between(plane: PlaneMap, u: int, v: int) -> Dart:
    found = darts_between(plane, u, v)
    edges = sorted({d >> 1 for d in found})
    if not edges:
        error = UnknownName("edge", f"{plane.vertex_names[u]} - {plane.vertex_names[v]}")
        error.message = f"no edge joins {quoted(plane.vertex_names[u])} and {quoted(plane.vertex_names[v])}"
        raise error
    if len(edges) > 1:
        names = ", ".join(f"@{plane.edge_names[e]}" for e in edges)
        raise AmbiguousDart(
            f"{len(edges)} edges join {quoted(plane.vertex_names[u])} and {quoted(plane.vertex_names[v])}: say which of "
            f"{shortened(names, 300)}"
        )
    return min(found)


def _walk(plane: PlaneMap, steps: list[Step], *, close: bool) -> list[Dart]:
    """Turn steps into darts. After an ``@edge`` its own end may be named again; `close` goes back to the start."""
    if not steps:
        return []
    edges = [_edge_of_step(plane, step) for step in steps]
    first, *others = _starts(plane, steps, edges)
    try:
        return _walk_from(plane, first, steps, edges, close=close)
    except (NotACycle, UnknownName):
        for other in others:
            with suppress(NotACycle, UnknownName):
                return _walk_from(plane, other, steps, edges, close=close)
        raise


def _walk_from(plane: PlaneMap, start: int, steps: list[Step], edges: list[int], *, close: bool) -> list[Dart]:
    tail = plane.tail
    at, darts = start, list[Dart]()
    after_edge = True  # the first vertex of the list is where the walk stands
    for step, e in zip(steps, edges, strict=True):
        if e >= 0:
            dart = Dart(2 * e if tail[2 * e] == at else 2 * e + 1)
            if tail[dart] != at:
                raise NotACycle(
                    f"edge {quoted(plane.edge_names[e])} does not leave {quoted(plane.vertex_names[at])}, where the way "
                    "has come to"
                )
        else:
            to = _vertex_row(plane, step)
            if after_edge and to == at:
                after_edge = False
                continue
            dart = _dart_between(plane, at, to)
        after_edge = e >= 0
        darts.append(dart)
        at = int(tail[dart ^ 1])
    if close and (at != start or not darts):
        try:
            darts.append(_dart_between(plane, at, start))
        except UnknownName as error:
            last, first = quoted(plane.vertex_names[at]), quoted(plane.vertex_names[start])
            error.message = f"the cycle closes from {last} to {first}, and no edge joins them"
            raise
    return darts


def _starts(plane: PlaneMap, steps: list[Step], edges: list[int]) -> list[int]:
    """Return the vertex a walk starts at; where it begins with an edge, the ends from which the next step follows."""
    if edges[0] < 0:
        return [_vertex_row(plane, steps[0])]
    u, v = int(plane.tail[2 * edges[0]]), int(plane.tail[2 * edges[0] + 1])
    if len(steps) == 1 or u == v:
        return [u]
    if edges[1] >= 0:
        ends = {int(plane.tail[2 * edges[1]]), int(plane.tail[2 * edges[1] + 1])}
    else:
        to = _vertex_row(plane, steps[1])
        ends = {to} if to in (u, v) else {int(plane.tail[d ^ 1]) for d in plane.darts_at(Vertex(to))}
    return [at for at, far in ((u, v), (v, u)) if far in ends] or [v]


def _no_edge_twice(plane: PlaneMap, darts: Sequence[int], what: str) -> None:
    seen: set[int] = set()
    for d in darts:
        if d >> 1 in seen:
            raise NotACycle(f"edge {quoted(plane.edge_names[d >> 1])} is used twice; a {what} uses no edge twice")
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
                f"the edges are not a simple cycle: {len(at)} of them meet at {quoted(plane.vertex_names[v])}, and it "
                "takes 2"
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
