"""Maps of one walk side by side, with what differs from the first one marked."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput
from ninefold.mapping import Hypothesis
from ninefold.mapping.doubt.untravelled import with_ends

from .difference_marks import differences_of
from .layouts import draw
from .sheet import side_by_side

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["draw_alternatives"]

MOST = 24
"""Maps that one picture can show."""

COLUMNS = 3


def draw_alternatives(
    maps: Iterable[Hypothesis], *, theme: str = "auto", width: int = 400, columns: int | None = None
) -> str:
    """Return an SVG document of maps side by side, the first of them being what the others are held against.

    Places that are the same visits have the same letter in every map; a place that is several of the first map, or a part of
    one, is marked and called ``A=B`` or ``A1``. Exits that nobody walked are short dashed ways.

    Parameters
    ----------
    maps
        Of one walk, the best first, as `hypotheses` gives them; at most 24.
    theme
        ``"auto"`` follows the reader's light or dark preference; ``"light"`` and ``"dark"`` fix it.
    width
        Pixels of one map.
    columns
        Maps in a row; left out, 3 at most, and 2 where there are 4 maps.

    Raises
    ------
    BadInput, DifferentMaps
        For no maps, too many, or maps of different walks.

    Examples
    --------
    >>> from ninefold.layout import draw_alternatives
    >>> from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader, hypotheses
    >>> east, west = Heading.from_bearing(90), Heading.from_bearing(270)
    >>> walk = Walk(WalkHeader(), (Visit(None, (east,)), Samples.of(east), Visit(None, (west, east))))
    >>> draw_alternatives(hypotheses(walk)).count("<svg")
    2
    """
    shown = tuple(maps)
    for one in shown:
        if not isinstance(one, Hypothesis):
            raise BadInput(f"maps are those of hypotheses(walk), not {quoted(one)}")
    if not 0 < len(shown) <= MOST:
        raise BadInput(f"a picture shows 1 to {MOST} maps, not {len(shown)}; slice them, as in maps[:6]")
    pictures = []
    for number, one in enumerate(shown, 1):
        wide = with_ends(one)
        found = differences_of(shown[0], one, wide)
        state = "closed" if one.closed else "open"
        marked = len(found.marked)
        differs = "" if number == 1 else f", {counted(marked, 'place')} {'differs' if marked == 1 else 'differ'}"
        title = f"{number}: {state}{differs}"
        pictures.append(draw(wide.plane).to_svg(title=title, theme=theme, width=width, differences=found))
    in_a_row = (2 if len(pictures) == 4 else COLUMNS) if columns is None else columns
    return side_by_side(*pictures, columns=in_a_row)
