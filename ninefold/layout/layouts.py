"""Drawing a map by the name of a layout."""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING

from ninefold._wording import quoted
from ninefold.errors import BadInput

from .arguments import require_map
from .methods.compass import compass
from .methods.relax import relax
from .methods.schnyder import schnyder
from .methods.tutte import tutte

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from ninefold.mapping import PlaneMap, Set

    from .drawing import Drawing

__all__ = ["DEFAULT_LAYOUT", "LAYOUTS", "draw"]

DEFAULT_LAYOUT = "auto"
"""The layout of pictures, from Python and from the command line, unless another is asked for."""


def _best(plane: PlaneMap) -> Drawing:
    """Draw a map as the place looks where headings tell, else with every vertex amid its neighbours."""
    return tutte(plane) if plane.heading is None else compass(plane)


def _relaxed(plane: PlaneMap) -> Drawing:
    return relax(tutte(plane))


LAYOUTS: dict[str, Callable[[PlaneMap], Drawing]] = {
    "auto": _best,
    "compass": compass,
    "tutte": tutte,
    "relaxed": _relaxed,
    "schnyder": schnyder,
}
"""Layouts by name. "auto" is the best for people that the map allows: "compass" where it has headings, else "tutte"."""


def draw(
    plane: PlaneMap,
    *,
    layout: str = DEFAULT_LAYOUT,
    highlight: Mapping[str, Set] | Iterable[Set] | Set | None = None,
) -> Drawing:
    """Draw a map; in a notebook the result shows itself, and `Drawing.save` writes it to a file.

    Parameters
    ----------
    plane
        The map.
    layout
        "auto" (the best there is for people: "compass" where the map has headings, else "tutte"), "compass" (as the place
        looks, from headings), "tutte" (every vertex amid its neighbours), "relaxed" (wide angles and even lengths) or
        "schnyder" (integer grid, any size). Where a layout has to fall back to another, the drawing's notes say so.
    highlight
        Sets to colour: a mapping from legend text to set, or sets alone, which the legend calls X, Y, Z, ...

    Raises
    ------
    BadInput, DifferentMaps
        For an unknown layout (the message lists the known ones), something that is no map, sets that cannot be highlighted.

    Examples
    --------
    >>> from ninefold.layout import draw
    >>> from ninefold.mapping import PlaneMap
    >>> edge = PlaneMap.from_rotation({"a": ["b"], "b": ["a"]})
    >>> draw(edge)
    Drawing(tutte, PlaneMap(2 vertices, 1 edge, 1 face))
    >>> draw(edge, layout="schnyder", highlight=[edge.vertex("a")])
    Drawing(schnyder, PlaneMap(2 vertices, 1 edge, 1 face), highlight X)
    """
    require_map(plane, "draw")
    make = LAYOUTS.get(layout) if isinstance(layout, str) else None
    if make is None:
        near = get_close_matches(str(layout), LAYOUTS, n=1, cutoff=0.4)
        hint = f"did you mean {near[0]!r}? " if near else ""
        raise BadInput(f"there is no layout named {quoted(layout)}; {hint}the layouts are {', '.join(sorted(LAYOUTS))}")
    drawing = make(plane)
    return drawing if highlight is None else drawing.highlighting(highlight)
