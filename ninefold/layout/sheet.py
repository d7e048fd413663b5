"""Several pictures on one sheet, side by side."""

from __future__ import annotations

import re

from ninefold.errors import BadInput

__all__ = ["side_by_side"]

_SIZE = re.compile(r'<svg xmlns="[^"]*" class="([^"]*)" width="(\d+)" height="(\d+)"')


def side_by_side(*pictures: str, gap: int = 16, columns: int | None = None) -> str:
    """Put pictures that `Drawing.to_svg` made next to each other, tops aligned.

    Parameters
    ----------
    pictures
        SVG documents of one theme.
    gap
        Pixels between them.
    columns
        Pictures in a row at most; left out, all are in one.

    Raises
    ------
    BadInput
        For no picture, a document of another maker, or columns that are none.

    Examples
    --------
    >>> from ninefold.layout import draw, side_by_side
    >>> from ninefold.mapping import PlaneMap
    >>> edge = PlaneMap.from_rotation({"a": ["b"], "b": ["a"]})
    >>> sheet = side_by_side(*(draw(edge, layout=name).to_svg(width=300) for name in ("schnyder", "tutte")))
    >>> sheet[:5], sheet.count("<svg")
    ('<svg ', 3)
    """
    if columns is not None and columns < 1:
        raise BadInput(f"a sheet has at least one column, not {columns}")
    parts, x, y, wide, tallest, look = [], 0, 0, 0, 0, ""
    for number, text in enumerate(pictures):
        found = _SIZE.match(text)
        if found is None:
            raise BadInput("side_by_side takes the SVG documents that Drawing.to_svg makes")
        look = found[1]
        if columns is not None and number and number % columns == 0:
            x, y, tallest = 0, y + tallest + gap, 0
        parts.append(text.replace("<svg ", f'<svg x="{x}" y="{y}" ', 1))
        x += int(found[2]) + gap
        wide = max(wide, x - gap)
        tallest = max(tallest, int(found[3]))
    if not parts:
        raise BadInput("there is no picture to put on the sheet")
    size = f'width="{wide}" height="{y + tallest}" viewBox="0 0 {wide} {y + tallest}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" class="{look}" {size} role="img">\n{"".join(parts)}</svg>\n'
