"""What layouts are given: the wrong kind of object says what to call instead."""

from __future__ import annotations

from ninefold._wording import quoted
from ninefold.errors import BadInput
from ninefold.mapping import Line, PlaneMap, Point, Region

__all__ = ["require_map"]


def require_map(given: object, call: str) -> None:
    """Raise `BadInput` unless `given` is a map, saying what `call` would take."""
    if isinstance(given, PlaneMap):
        return
    if isinstance(given, Point | Line | Region):
        what = f"{call} takes a map, and {quoted(given)} is a set of one: draw(X.plane, highlight=[X]) shows X on its map"
    elif isinstance(getattr(type(given), "plane", None), property):  # a mapper, an atlas
        what = f"{call} takes a map, not the {type(given).__name__} that holds one: {call}(X.plane)"
    elif hasattr(type(given), "to_map"):
        what = f"{call} takes a map, and a {type(given).__name__} makes one: {call}(X.to_map())"
    else:
        what = f"{call} takes a PlaneMap, not {quoted(given)}; nf.read_map reads one from a file"
    raise BadInput(what)
