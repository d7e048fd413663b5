"""Rotation systems written by hand, read into dart arrays."""

from __future__ import annotations

from numbers import Integral
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import AmbiguousDart, BadInput, UnknownName

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

__all__ = ["DartArrays", "read_rotation"]

Entry = tuple[str, str | None]


class DartArrays(NamedTuple):
    """What `PlaneMap.from_darts` makes a map of.

    Attributes
    ----------
    tail, next_ccw
        (2E,) int64: start vertex and next dart counter-clockwise around it.
    outer
        A dart with the outer face on its left, or None.
    vertex_names, edge_names
        Labels; None for edges named by their row.
    """

    tail: NDArray[np.int64]
    next_ccw: NDArray[np.int64]
    outer: int | None
    vertex_names: list[str]
    edge_names: list[str] | None


def read_rotation(
    rotation: Mapping[str | int, Sequence[Any]], *, outer: Sequence[str | int] | int | None = None
) -> DartArrays:
    """Read each vertex's neighbours, counter-clockwise, into dart arrays; see `PlaneMap.from_rotation`.

    Raises
    ------
    BadInput, AmbiguousDart, UnknownName
        For an edge mentioned once or three times, an unnamed parallel edge, an unknown neighbour.
    """
    names = [str(vertex) for vertex in rotation]
    row = {name: at for at, name in enumerate(names)}
    if len(row) != len(names):
        raise BadInput("two vertices have the same name once integers are read as strings")
    ends: dict[tuple[frozenset[int], str | None], list[tuple[int, int]]] = {}
    stars: list[list[int]] = []
    labels: list[str | None] = []
    tail: list[int] = []
    for u, (vertex, entries) in enumerate(rotation.items()):
        if isinstance(entries, str):
            raise BadInput(f"the neighbours of {quoted(vertex)} are a string; give a list of names")
        star: list[int] = []
        for entry in entries:
            other, label = _entry(entry)
            if other not in row:
                raise UnknownName("vertex", other, names)
            key = (frozenset((u, row[other])), label)
            known = ends.setdefault(key, [])
            if len(known) == 2:
                raise BadInput(f"the edge {_show(names[u], other, label)} is mentioned more than twice")
            if known:
                e, source = known[0]
                if source == u and other != names[u]:
                    raise AmbiguousDart(
                        f"{quoted(names[u])} lists {quoted(other)} twice; name parallel edges, as in ({quoted(other)}, 'e1')"
                    )
                dart = 2 * e + 1
            else:
                e, dart = len(labels), 2 * len(labels)
                labels.append(label)
                tail += [u, row[other]]
            known.append((e, u))
            star.append(dart)
        stars.append(star)
    for (_, label), known in ends.items():
        if len(known) == 1:
            a, b = (names[v] for v in tail[2 * known[0][0] : 2 * known[0][0] + 2])
            raise BadInput(f"the edge {_show(a, b, label)} is mentioned at {quoted(a)} but not at {quoted(b)}")
    next_ccw = np.empty(len(tail), np.int64)
    for star in stars:
        for at, dart in enumerate(star):
            next_ccw[dart] = star[(at + 1) % len(star)]
    edge_names = _edge_names(labels)
    start = _outer_dart(outer, row, tail, edge_names)
    return DartArrays(np.array(tail, np.int64), next_ccw, start, names, edge_names)


def _entry(entry: Any) -> Entry:
    if isinstance(entry, str | Integral) and not isinstance(entry, bool):
        return str(entry), None
    if isinstance(entry, tuple | list) and len(entry) == 2:
        return str(entry[0]), str(entry[1])
    raise BadInput(f"{quoted(entry)} is neither a neighbour nor a pair (neighbour, edge name)")


def _show(u: str, v: str, label: str | None) -> str:
    return f"{quoted(u)} - {quoted(v)}" + (f" ({quoted(label)})" if label is not None else "")


def _edge_names(labels: list[str | None]) -> list[str] | None:
    if all(label is None for label in labels):
        return None
    taken = {label for label in labels if label is not None}
    names = []
    for e, label in enumerate(labels):
        if label is None:
            label = str(e)
            if label in taken:
                raise BadInput(f"edge {e} has no name, and its number is the name of another edge; name it")
        names.append(label)
    return names


def _outer_dart(
    outer: Sequence[str | int] | int | None, row: dict[str, int], tail: list[int], edge_names: list[str] | None
) -> int | None:
    if outer is None:
        return None
    if isinstance(outer, Integral) and not isinstance(outer, bool):
        return int(outer)
    if not isinstance(outer, tuple | list) or len(outer) not in (2, 3):
        raise BadInput(f"outer is a dart, (from, to) or (from, to, edge name), not {quoted(outer)}")
    u, v = (str(name) for name in outer[:2])
    for name in (u, v):
        if name not in row:
            raise UnknownName("vertex", name, row)
    found = [
        d
        for d in range(len(tail))
        if tail[d] == row[u]
        and tail[d ^ 1] == row[v]
        and (len(outer) == 2 or (edge_names[d >> 1] if edge_names else str(d >> 1)) == str(outer[2]))
    ]
    if not found:
        raise BadInput(f"outer = {quoted(tuple(outer))}: there is no such edge")
    if len(found) > 1:
        raise AmbiguousDart(
            f"outer = {quoted(tuple(outer))} is one of the darts {found}; add the edge name, or give the dart's number"
        )
    return found[0]
