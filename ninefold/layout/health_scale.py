"""The health of a map as colours of its legs: one scale for every map, with its legend in degrees.

A leg is coloured by the size of its closing residual (`ninefold.mapping.closing`). The steps are the same for all maps, so
that a colour means the same in every picture; each is about twice the one before. The colours grow darker on light ground
and brighter on dark ground, and the legs broader.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput, DifferentMaps
from ninefold.mapping.closing import Health, health

from .leg_classes import LegClass, LegColouring

if TYPE_CHECKING:
    from ninefold.mapping import PlaneMap

__all__ = ["STEPS", "health_colouring", "health_of", "health_scale"]

STEPS = (0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0)
"""Degrees at which one colour ends and the next begins; a residual that is just one of them has the lower colour."""

_WIDEST_STEP = 62.0


def health_of(plane: PlaneMap, given: object) -> Health | None:
    """Return what to colour a map's legs by: None for False, worked out for True, else what is given, if it is of this map.

    Raises
    ------
    BadInput, DifferentMaps
        For something else, a map without headings, the health of another map.
    """
    if given is False or given is None:
        return None
    if given is True:
        return health(plane)
    if not isinstance(given, Health):
        raise BadInput(f"health is True, False or what ninefold.mapping.health returns, not {quoted(given)}")
    if not (given.plane is plane or given.plane == plane):
        raise DifferentMaps(f"the health is of {given.plane!r}, and this draws another map, {plane!r}; ask for its own")
    return given


def health_colouring(found: Health) -> LegColouring:
    """Return the colours of the legs, from those that agree best, which are drawn first, to the worst.

    Examples
    --------
    >>> from ninefold.mapping import PlaneMap, health
    >>> triangle = PlaneMap.from_geometry([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)])
    >>> [(kind.name, kind.words) for kind in health_colouring(health(triangle)).classes]
    [('closing0', 'up to 0.05 degrees: 3 legs')]
    """
    size = np.abs(found.residual)
    step = np.where(np.isnan(size), -1, np.searchsorted(STEPS, size, side="left"))
    classes = []
    for k in range(len(STEPS) + 1):
        edges = tuple(np.flatnonzero(step == k).tolist())
        if edges:
            classes.append(LegClass(f"closing{k}", edges, f"{_range(k)}: {counted(len(edges), 'leg')}"))

    def tip(kind: LegClass, edge: int) -> str:
        return f"headings and turn disagree by {size[edge]:.2g} degrees"

    return LegColouring("health", tuple(classes), tip, str(found))


def health_scale(x: float, y: float, width: float, colouring: LegColouring) -> list[str]:
    """Return the legend as SVG: a bar of all colours from (x, y) down, `width` wide at most and 60 high.

    Above each colour stands how many legs have it, below the degrees where it ends.
    """
    n = len(STEPS) + 1
    wide = min(_WIDEST_STEP, width / n)
    count = {kind.name: len(kind.edges) for kind in colouring.classes}
    size = 13 if width >= 420 else 11
    parts = [f'<text class="ink" x="{x:.1f}" y="{y + 4:.1f}" font-size="{size}">{_TITLE}</text>']
    for k in range(n):
        left = x + k * wide
        name = f"closing{k}"
        text = f"{_range(k)}: {counted(count.get(name, 0), 'leg')}"
        parts.append(
            f'<path class="{name}" fill="none" stroke-width="9" d="M{left:.1f},{y + 33:.1f} {left + wide:.1f},{y + 33:.1f}">'
            f"<title>{text}</title></path>"
        )
        if name in count:
            parts.append(_small("ink", left + wide / 2, y + 24, f"{count[name]:,}"))
        if k < len(STEPS):
            parts.append(_small("faint", left + wide, y + 49, f"{STEPS[k]:g}\N{DEGREE SIGN}"))
    return parts


_TITLE = "Legs by how far their headings and turn disagree"


def _small(look: str, x: float, y: float, text: str) -> str:
    return f'<text class="{look}" x="{x:.1f}" y="{y:.1f}" font-size="11" text-anchor="middle">{text}</text>'


def _range(k: int) -> str:
    if not k:
        return f"up to {STEPS[0]:g} degrees"
    if k == len(STEPS):
        return f"above {STEPS[-1]:g} degrees"
    return f"{STEPS[k - 1]:g} to {STEPS[k]:g} degrees"
