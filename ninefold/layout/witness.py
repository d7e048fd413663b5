"""Pictures of regions: the geometry that `realize` returns, as SVG to look at and to teach with.

Every region has a colour, a hatch direction and a dash pattern of its own up to seven, so that outlines which coincide show
both; beyond that colours repeat and names tell. Larger regions lie below smaller ones. Each region is named in the legend,
and where there are few, also at its largest piece.

Examples
--------
>>> from ninefold.layout.realization import realize
>>> from ninefold.layout.witness import witness_svg
>>> from ninefold.reasoner.networks.network import Network
>>> from ninefold.reasoner.networks.enumeration import scenarios
>>> net = Network("rcc8")
>>> _ = net.add("kitchen", "house", "inside")
>>> witness_svg(realize(next(scenarios(net)))).count("<path class=")
4
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from ninefold._wording import quoted
from ninefold.errors import BadInput

from .theme import ROLES, THEMES, style_sheet

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = ["witness_svg"]

_FONT = "system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif"
_UNFIT = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_PAD, _LINE = 28.0, 24.0
_DASH = ("none", "10 7", "3 5", "14 6", "6 6", "2 4", "12 4 3 4")
_LETTER = 7.4
"""Width of a letter of the legend, in pixels, generously."""


def witness_svg(
    shapes: Mapping[str, Any], *, title: str | None = None, theme: str = "auto", width: int = 720
) -> str:  # fmt: skip
    """Return an SVG picture of named regions.

    Parameters
    ----------
    shapes
        Names to shapely polygons or multipolygons.
    theme
        ``"light"``, ``"dark"``, or ``"auto"`` to follow the reader's preference.
    width
        In pixels.

    Raises
    ------
    BadInput
        No shape, an unknown theme, or a width that is no picture's.
    """
    if not shapes:
        raise BadInput("there is no region to draw")
    if theme not in THEMES:
        raise BadInput(f"theme is one of {', '.join(THEMES)}, not {quoted(theme)}")
    if not 100 <= width <= 20_000:
        raise BadInput(f"width is in pixels, from 100 to 20000, not {width}")
    page = _Page(list(shapes.values()), width, 44.0 if title else 0.0)
    order = sorted(range(len(shapes)), key=lambda k: -list(shapes.values())[k].area)
    names = list(shapes)
    paths = [_path(page, shapes[names[k]]) for k in range(len(names))]
    body = [f'<rect class="paper" width="{width}" height="{{height}}" rx="6"/>']
    if title:
        body.append(f'<text class="ink" x="{_PAD:g}" y="34" font-size="18" font-weight="600">{_escaped(title)}</text>')
    body += [f'<path class="f{k % len(ROLES)}" fill-opacity="0.2" d="{paths[k]}"/>' for k in order]
    body += [_outline(k, paths[k], names[k], page.stroke) for k in order]
    body += _labels(page, shapes)
    legend, height = _legend(names, page.bottom, width)
    text = "\n".join([*body, *legend]).replace("{height}", f"{height:.0f}", 1)
    name = _escaped(title or ", ".join(names[:12]))
    size = f'width="{width}" height="{height:.0f}" viewBox="0 0 {width} {height:.0f}"'
    root = f'xmlns="http://www.w3.org/2000/svg" class="ninefold-{theme}" {size} role="img" aria-label="{name}"'
    style = style_sheet(theme, min(len(names), len(ROLES)))
    return f'<svg {root} font-family="{_FONT}">\n<title>{name}</title>\n<style>{style}</style>\n{text}\n</svg>\n'


class _Page:
    """The way from the regions' coordinates to pixels."""

    def __init__(self, shapes: list[Any], width: int, top: float) -> None:
        bounds = [shape.bounds for shape in shapes]
        self._left, self._top = min(b[0] for b in bounds), max(b[3] for b in bounds)
        wide = max(b[2] for b in bounds) - self._left
        tall = self._top - min(b[1] for b in bounds)
        room = width - 2 * _PAD
        # not larger than a hand's breadth a unit, and never taller than wide
        self.scale = min(room / wide, room / tall, 72.0)
        self._x0 = (width - wide * self.scale) / 2
        self._y0 = top + _PAD
        self.bottom = self._y0 + tall * self.scale + _PAD
        self.stroke = min(max(self.scale / 9, 0.6), 2.6)

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Coordinates to pixels, y downwards."""
        return self._x0 + (x - self._left) * self.scale, self._y0 + (self._top - y) * self.scale


def _parts(shape: Any) -> list[Any]:
    return list(getattr(shape, "geoms", [shape]))


def _path(page: _Page, shape: Any) -> str:
    rings = [ring for part in _parts(shape) for ring in (part.exterior, *part.interiors)]
    drawn = ("M" + " ".join("{:.2f},{:.2f}".format(*page.place(*xy[:2])) for xy in ring.coords[:-1]) + "Z" for ring in rings)
    return "".join(drawn)


def _outline(k: int, path: str, name: str, broad: float) -> str:
    role = k % len(ROLES)
    look = f'fill="none" stroke-width="{broad:.2f}" stroke-dasharray="{_DASH[role]}" stroke-linejoin="round"'
    return f'<path class="s{role}" {look} d="{path}"><title>{_escaped(name)}</title></path>'


def _labels(page: _Page, shapes: Mapping[str, Any]) -> list[str]:
    """Name every region in its largest piece, near the top, a line lower for each name already there."""
    if len(shapes) > 12:
        return []
    size = min(max(page.scale * 0.34, 9.0), 15.0)
    taken: list[tuple[float, float, float]] = []
    found = []
    for name, shape in sorted(shapes.items(), key=lambda item: item[1].area):
        part = max(_parts(shape), key=lambda p: (p.area, p.bounds[3], -p.bounds[0]))
        left, top = page.place(part.bounds[0], part.bounds[3])
        right, bottom = page.place(part.bounds[2], part.bounds[1])
        x, y, half = (left + right) / 2, top + 1.25 * size, 0.31 * size * len(name)
        while any(abs(y - other_y) < 1.1 * size and abs(x - other_x) < half + other for other_x, other_y, other in taken):
            y += 1.15 * size
        if y > bottom - 0.2 * size or 2 * half > right - left:
            continue  # no room: the legend has it
        taken.append((x, y, half))
        found.append(f'<text x="{x:.1f}" y="{y:.1f}">{_escaped(name)}</text>')
    look = 'text-anchor="middle" stroke-width="3" stroke-linejoin="round" paint-order="stroke"'
    return [f'<g class="name" font-size="{size:.1f}" {look}>{"".join(found)}</g>'] if found else []


def _legend(names: list[str], top: float, width: int) -> tuple[list[str], float]:
    parts, x, y = [], _PAD, top + 8
    for k, name in enumerate(names):
        role, text = k % len(ROLES), name if len(name) <= 40 else f"{name[:39]}\N{HORIZONTAL ELLIPSIS}"
        wide = 30 + _LETTER * len(text) + 18
        if x > _PAD and x + wide > width - _PAD:
            x, y = _PAD, y + _LINE
        box = f'x="{x:.1f}" y="{y - 8:.1f}" width="22" height="14" rx="2"'
        parts.append(f'<rect class="f{role}" fill-opacity="0.2" {box}/>')
        parts.append(f'<rect class="s{role}" fill="none" stroke-width="2" stroke-dasharray="{_DASH[role]}" {box}/>')
        parts.append(f'<text class="ink" x="{x + 29:.1f}" y="{y + 4:.1f}" font-size="13">{_escaped(text)}</text>')
        x += wide
    return parts, y + _LINE


def _escaped(text: str) -> str:
    """Return text that is safe in XML; characters XML cannot hold become U+FFFD."""
    kept = _UNFIT.sub("\ufffd", text)
    for plain, entity in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;"), ("'", "&#39;"), ("{", "&#123;")):
        kept = kept.replace(plain, entity)
    return kept
