"""Sets as JSON that outlives the map they were made on: vertex and edge names, never face numbers.

A region is the edges of its boundary: with the outer face outside, they determine it, also after new edges have split its
faces.
"""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import AtlasError, BadInput, NinefoldError
from ninefold.mapping import Line, PlaneMap, Point, Region, Set
from ninefold.mapping.select import line, path

from ._schema import one_line

__all__ = ["KINDS", "definition_of", "set_of"]

KINDS = {Point: "point", Line: "line", Region: "region"}


def definition_of(item: Set) -> str:
    """Return the definition of a set as JSON."""
    names = item.plane.edge_names
    definition: dict[str, Any]
    match item:
        case Point():
            definition = {"vertex": item.name}
        case Line(darts=None):
            definition = {"edges": list(item.edge_names)}
        case Line(darts=darts):
            start = item.plane.vertex_names[int(item.plane.tail[darts[0]])] if darts else ""
            definition = {"start": start, "edges": list(item.edge_names)}
        case Region():
            definition = {"boundary": [names[e] for e in item.boundary.edges]}
    return json.dumps(definition, ensure_ascii=False)


def set_of(plane: PlaneMap, kind: str, definition: str) -> Set:
    """Return the set that a definition means on a map.

    Raises
    ------
    AtlasError
        If the text is no definition, or does not fit the map.
    """
    try:
        found = json.loads(definition)
        match kind, found:
            case "point", {"vertex": str(vertex)}:
                return plane.vertex(vertex)
            case "line", {"start": str(start), "edges": [*edges]}:
                return path(plane, [{"vertex": start}, *({"edge": edge} for edge in edges)])
            case "line", {"edges": [*edges]}:
                return line(plane, [{"edge": edge} for edge in edges])
            case "region", {"boundary": [*edges]}:
                return _inside(plane, edges)
            case _:
                raise BadInput("it is neither a point, a line nor a region")
    except (NinefoldError, ValueError, TypeError, RecursionError) as error:
        reason = one_line(error) if isinstance(error, NinefoldError) else "it is no JSON of the right kind"
        raise AtlasError(f"damaged: the definition of a {one_line(kind)} does not fit the map ({reason})") from None


def _inside(plane: PlaneMap, edges: list[Any]) -> Region:
    rim = line(plane, [{"edge": edge} for edge in edges])
    if rim.boundary:
        raise BadInput(f"its boundary is not closed at {quoted(plane.vertex_names[min(rim.boundary)])}")
    rows = np.array(rim.edges, np.int64)
    # Any edge set of even degrees is a sum of cycles, and its inside the sum of theirs.
    return Region.from_ends(plane, plane.containment.inside(rows), rows)
