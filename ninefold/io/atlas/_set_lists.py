"""Sets as JSON lists, ``["cycle", "a, north", "b", "c"]``: the text forms for names that have commas."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from ninefold.errors import BadInput

if TYPE_CHECKING:
    from ninefold.mapping import PlaneMap, Set

__all__ = ["set_of_list"]

_FORMS = ("vertex", "edge", "path", "line", "cycle", "face", "faces")


def set_of_list(plane: PlaneMap, text: str) -> Set:
    """Return the set that a JSON list names: a form as in `PlaneMap.parse`, then its names.

    Raises
    ------
    BadInput
        If the text is no such list.

    Examples
    --------
    >>> from ninefold.io import samples
    >>> set_of_list(samples.load("figure8").to_map(), '["edge", "v1", "v3"]')
    Line(@v1-v3)
    """
    try:
        found = json.loads(text)
    except (ValueError, RecursionError):
        raise BadInput(f'{text[:60]!r} is no JSON list, such as ["edge", "v1", "v3"]') from None
    if not isinstance(found, list) or len(found) < 2 or found[0] not in _FORMS:
        raise BadInput(f"a set as a JSON list is one of {', '.join(_FORMS)}, then its names; not {text[:60]!r}")
    form, *parts = found
    if not all(isinstance(part, str | int) and not isinstance(part, bool) for part in parts):
        raise BadInput(f"the names in a JSON list are strings, not as in {text[:60]!r}")
    if form in ("vertex", "face") and len(parts) != 1:
        raise BadInput(f"{form} takes one name, not {len(parts)}")
    match form:
        case "vertex":
            return plane.vertex(parts[0])
        case "edge":
            return plane.edge(*parts)
        case "path":
            return plane.path(parts)
        case "line":
            return plane.line(parts)
        case "cycle" if all(str(part).startswith("@") for part in parts):
            return plane.cycle(edges=parts)
        case "cycle":
            return plane.cycle(parts)
        case _:
            return plane.region([_face(part) for part in parts])


def _face(part: str | int) -> int:
    text = str(part)
    if not (text.isascii() and text.isdecimal() and len(text) < 10):
        raise BadInput(f"{part!r} is no face number")
    return int(text)
