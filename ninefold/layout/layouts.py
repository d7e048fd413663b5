"""Drawing a map by the name of a layout."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

from ninefold._wording import quoted
from ninefold.errors import BadInput

from .methods.schnyder import schnyder
from .methods.tutte import tutte

if TYPE_CHECKING:
    from collections.abc import Callable

    from ninefold.mapping import PlaneMap

    from .drawing import Drawing

__all__ = ["LAYOUTS", "draw"]

LAYOUTS: dict[str, Callable[[PlaneMap], Drawing]] = {"schnyder": schnyder, "tutte": tutte}
"""Layouts by name."""


def draw(plane: PlaneMap, *, layout: str = "schnyder") -> Drawing:
    """Draw a map; in a notebook the result shows itself.

    Parameters
    ----------
    layout
        "schnyder" (integer grid, any size) or "tutte" (rounder, for people).

    Raises
    ------
    BadInput
        For an unknown layout; the message lists the known ones.

    Examples
    --------
    >>> from ninefold.layout import draw
    >>> from ninefold.mapping import PlaneMap
    >>> draw(PlaneMap.from_rotation({"a": ["b"], "b": ["a"]}))
    Drawing(schnyder, PlaneMap(2 vertices, 1 edge, 1 face))
    """
    make = LAYOUTS.get(layout)
    if make is None:
        near = get_close_matches(str(layout), LAYOUTS, n=1, cutoff=0.4)
        hint = f"did you mean {near[0]!r}? " if near else ""
        raise BadInput(f"there is no layout named {quoted(layout)}; {hint}the layouts are {', '.join(sorted(LAYOUTS))}")
    return make(plane)
