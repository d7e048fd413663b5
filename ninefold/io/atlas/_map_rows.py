"""A plane map as rows of an atlas, and back."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold.errors import AtlasError, NinefoldError
from ninefold.mapping import Names, PlaneMap

from ._schema import keep_metres, keeps_metres, one_line

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterator

__all__ = ["load_map", "store_map"]

_COLUMNS = ("id", "name", "tail", "head", "next_out", "next_back", "heading_out", "heading_back", "turn", "tether")
_MARKS = ", ".join("?" * len(_COLUMNS))
_LARGEST_TURN = 1e9  # radians: beyond, a float64 no longer tells directions apart


def store_map(connection: sqlite3.Connection, plane: PlaneMap) -> None:
    """Replace the stored map, inside the caller's transaction. O(E)."""
    connection.execute("DELETE FROM vertex")
    connection.execute("DELETE FROM edge")
    connection.executemany("INSERT INTO vertex VALUES (?, ?)", enumerate(_labels(plane.vertex_names)))
    connection.executemany(f"INSERT INTO edge ({', '.join(_COLUMNS)}) VALUES ({_MARKS})", _edge_rows(plane))  # noqa: S608
    if plane.metres is not None:
        keep_metres(connection)
        measured = [(metres, e) for e, metres in enumerate(_nulls(plane.metres)) if metres is not None]
        connection.executemany("UPDATE edge SET metres = ? WHERE id = ?", measured)
    values = {
        "outer": plane.outer,
        "vertices": plane.n_vertices,
        "edges": int(plane.tether.size),
        "headings": int(plane.heading is not None),
    }
    connection.executemany("INSERT OR REPLACE INTO meta VALUES (?, ?)", values.items())


def load_map(connection: sqlite3.Connection) -> PlaneMap:
    """Read the stored map and check it as every constructor does.

    Raises
    ------
    AtlasError
        If the rows are no plane map. O(E).
    """
    facts = dict(connection.execute("SELECT key, value FROM meta WHERE key IN ('outer', 'vertices', 'edges', 'headings')"))
    vertices = connection.execute("SELECT id, name FROM vertex ORDER BY id").fetchall()
    metres = "metres" if keeps_metres(connection) else "NULL"
    edges = connection.execute(f"SELECT {', '.join(_COLUMNS)}, {metres} FROM edge ORDER BY id").fetchall()  # noqa: S608
    if (facts.get("vertices"), facts.get("edges")) != (len(vertices), len(edges)):
        raise AtlasError(
            f"damaged: {len(vertices)} vertices and {len(edges)} edges are stored, and there should be "
            f"{facts.get('vertices')!a:.20} and {facts.get('edges')!a:.20}"
        )
    try:
        return _assemble(facts, vertices, edges)
    except (ValueError, TypeError, OverflowError, LookupError) as error:
        reason = one_line(error) if isinstance(error, NinefoldError) else "a value is of the wrong kind"
        raise AtlasError(f"damaged: the stored map is no plane map ({reason})") from None


def _labels(names: Names) -> Iterator[str | None]:
    return (None for _ in range(names.size)) if names.are_rows else iter(names)


def _edge_rows(plane: PlaneMap) -> Iterator[tuple[Any, ...]]:
    count = plane.tether.size
    ends = plane.tail.reshape(-1, 2)
    after = plane.next_ccw.reshape(-1, 2)
    nothing: list[None] = [None] * count
    if plane.heading is None or plane.turn is None:
        out = back = turn = nothing
    else:
        out, back, turn = (_nulls(values) for values in (plane.heading[0::2], plane.heading[1::2], plane.turn))
    return zip(
        range(count),
        _labels(plane.edge_names),
        ends[:, 0].tolist(),
        ends[:, 1].tolist(),
        after[:, 0].tolist(),
        after[:, 1].tolist(),
        out,
        back,
        turn,
        plane.tether.astype(int).tolist(),
        strict=True,
    )


def _nulls(values: Any) -> list[Any]:
    return [None if math.isnan(value) else value for value in values.tolist()]


def _assemble(facts: dict[str, Any], vertices: list[tuple[Any, ...]], edges: list[tuple[Any, ...]]) -> PlaneMap:
    ids, labels = zip(*vertices, strict=True) if vertices else ((), ())
    vertex_names = _names("vertex", ids, labels)
    outer = facts["outer"]
    if not isinstance(outer, int):
        raise TypeError("outer")
    if not edges:
        none = np.zeros(0) if facts["headings"] else None
        return PlaneMap.from_darts([], [], n_vertices=len(vertices), heading=none, turn=none, vertex_names=vertex_names)
    ids, labels, tail, head, next_out, next_back, out, back, turns, tether, metres = zip(*edges, strict=True)
    edge_names = _names("edge", ids, labels)
    heading = turn = None
    if facts["headings"]:
        heading = _pairs(np.array(out, dtype=np.float64), np.array(back, dtype=np.float64))  # NULL becomes NaN
        turn = np.array(turns, dtype=np.float64)
        if (np.abs(turn) > _LARGEST_TURN).any():
            raise ValueError("turn")
    return PlaneMap.from_darts(
        _pairs(_ints(tail), _ints(head)),
        _pairs(_ints(next_out), _ints(next_back)),
        outer,
        n_vertices=len(vertices),
        tether=_ints(tether) != 0,
        heading=heading,
        turn=turn,
        metres=np.array(metres, dtype=np.float64),
        vertex_names=vertex_names,
        edge_names=edge_names,
    )


def _names(kind: str, ids: tuple[Any, ...], labels: tuple[Any, ...]) -> Names:
    if ids != tuple(range(len(ids))):
        raise ValueError("ids")
    if all(label is None for label in labels):
        return Names(kind, len(ids))
    return Names(kind, len(ids), [str(row) if label is None else label for row, label in enumerate(labels)])


def _ints(column: tuple[Any, ...]) -> Any:
    array = np.array(column)
    if array.dtype.kind != "i":
        raise TypeError("integers")
    return array


def _pairs(first: Any, second: Any) -> Any:
    return np.stack([first, second], axis=1).reshape(-1)
