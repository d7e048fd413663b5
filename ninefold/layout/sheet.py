"""Several pictures on one sheet, side by side."""

from __future__ import annotations

import re

from ninefold.errors import BadInput

__all__ = ["side_by_side"]

_SIZE = re.compile(r'<svg xmlns="[^"]*" class="([^"]*)" width="(\d+)" height="(\d+)"')


def side_by_side(*pictures: str, gap: int = 16) -> str:
    """Put pictures that `Drawing.to_svg` made next to each other, tops aligned.

    Parameters
    ----------
    pictures
        SVG documents of one theme.
    gap
        Pixels between them.

    Raises
    ------
    BadInput
        For no picture, or a document of another maker.

    Examples
    --------
    >>> from ninefold.layout import draw, side_by_side
    >>> from ninefold.mapping import PlaneMap
    >>> edge = PlaneMap.from_rotation({"a": ["b"], "b": ["a"]})
    >>> sheet = side_by_side(*(draw(edge, layout=name).to_svg(width=300) for name in ("schnyder", "tutte")))
    >>> sheet[:5], sheet.count("<svg")
    ('<svg ', 3)
    """
    parts, x, tallest, look = [], 0, 0, ""
    for text in pictures:
        found = _SIZE.match(text)
        if found is None:
            raise BadInput("side_by_side takes the SVG documents that Drawing.to_svg makes")
        look = found[1]
        parts.append(text.replace("<svg ", f'<svg x="{x}" y="0" ', 1))
        x += int(found[2]) + gap
        tallest = max(tallest, int(found[3]))
    if not parts:
        raise BadInput("there is no picture to put on the sheet")
    size = f'width="{x - gap}" height="{tallest}" viewBox="0 0 {x - gap} {tallest}"'
    return f'<svg xmlns="http://www.w3.org/2000/svg" class="{look}" {size} role="img">\n{"".join(parts)}</svg>\n'
