"""What the headings fix, as classes of legs that a picture can colour, each with the words for its legend.

Legs of the same class look alike: one class for each of the largest parts whose shape the headings fix, one for all
smaller parts, one for legs whose length is only evened out, and one for those that the rest contradicts. A leg that is
contradicted is of that class alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput, DifferentMaps

from .bearing_rigidity import Rigidity, rigidity
from .theme import FIXED

if TYPE_CHECKING:
    from collections.abc import Callable

    from ninefold.mapping import PlaneMap

__all__ = ["LegClass", "LegColouring", "caption_of", "leg_classes", "leg_tip", "rigidity_colouring", "rigidity_of"]

_OWN_COLOUR = len(FIXED["light"]) - 1
"""Parts with a colour of their own; the last colour is for all others."""

_TRUE_TO_HEADINGS = ("compass", "given", "ground")


@dataclass(frozen=True, slots=True)
class LegClass:
    """Legs that look alike.

    Attributes
    ----------
    name
        ``"fixed0"`` and so on, ``"evened"`` or ``"contradicted"``; by health ``"closing0"`` and so on. Also the class of the
        style sheet.
    edges
        Their numbers, rising.
    words
        What the legend says of them.
    """

    name: str
    edges: tuple[int, ...]
    words: str


@dataclass(frozen=True, slots=True)
class LegColouring:
    """How the legs of a map look, and why.

    Attributes
    ----------
    told
        What the colours tell: ``"rigidity"``, what the headings fix, or ``"health"``, how well they agree.
    classes
        Those that have legs, in the order in which they are drawn.
    tip
        What the tool tip of a leg says after its name, given its class and its number.
    caption
        What stands below the picture.
    """

    told: Literal["rigidity", "health"]
    classes: tuple[LegClass, ...]
    tip: Callable[[LegClass, int], str]
    caption: str


def rigidity_colouring(found: Rigidity, layout: str) -> LegColouring:
    """Return how a drawing in a layout shows what the headings fix."""
    return LegColouring("rigidity", leg_classes(found), partial(leg_tip, found), caption_of(found, layout))


def rigidity_of(plane: PlaneMap, given: object) -> Rigidity | None:
    """Return what to colour a map's legs by: None for False, worked out for True, else what is given, if it is of this map.

    Raises
    ------
    BadInput, DifferentMaps
        For something else, a map without headings, the rigidity of another map.
    """
    if given is False or given is None:
        return None
    if given is True:
        return rigidity(plane)
    if not isinstance(given, Rigidity):
        raise BadInput(f"rigidity is True, False or what ninefold.layout.rigidity returns, not {quoted(given)}")
    if not (given.plane is plane or given.plane == plane):
        raise DifferentMaps(
            f"the rigidity is of {given.plane!r}, and this draws another map, {plane!r}; work it out for this one"
        )
    return given


def leg_classes(found: Rigidity) -> tuple[LegClass, ...]:
    """Return the classes that have legs: fixed parts from the largest, then what is evened out, then what is contradicted.

    Examples
    --------
    >>> from ninefold.layout import rigidity
    >>> from ninefold.mapping import PlaneMap
    >>> corners = [(0, 0), (2, 0), (2, 1), (0, 1), (3, 0)]
    >>> braced = PlaneMap.from_geometry(corners, [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (1, 4)])
    >>> for each in leg_classes(rigidity(braced)):
    ...     print(each.name, each.words)
    fixed0 shape fixed by headings: 5 legs
    evened evened out, not measured: 1 leg
    """
    plane, counts = found.plane, found.counts
    wrong = np.zeros(plane.tether.size, np.bool_)
    wrong[[plane.edge_names.row(name) for name in found.contradicted]] = True
    fixed = found.fixed & ~wrong
    classes = []
    for k in range(min(counts["parts"], _OWN_COLOUR)):
        what = "shape fixed by headings" if counts["parts"] == 1 else f"part {k + 1}, shape fixed by headings"
        classes.append((f"fixed{k}", fixed & (found.part == k), what))
    more = counts["parts"] - _OWN_COLOUR
    if more > 0:
        what = f"{counted(more, 'smaller part')}, {'shape' if more == 1 else 'each shape'} fixed by headings"
        classes.append((f"fixed{_OWN_COLOUR}", fixed & (found.part >= _OWN_COLOUR), what))
    evened = ~found.fixed & ~wrong & ~plane.tether
    classes += [
        ("evened", evened, "evened out, not measured"),
        ("contradicted", wrong, "contradicted by other headings"),
    ]
    made = []
    for name, legs, what in classes:
        edges = tuple(np.flatnonzero(legs).tolist())
        if not edges:
            continue
        words = f"{what}: {counted(len(edges), 'leg')}"
        bent = int(np.count_nonzero(found.curved[legs]))
        if bent:
            words += f" ({bent:,} curved)"
        made.append(LegClass(name, edges, words))
    return tuple(made)


def leg_tip(found: Rigidity, kind: LegClass, edge: int) -> str:
    """Return what the tool tip of a leg says after its name: its part, and by how much it misses the other headings."""
    missed = f"{abs(float(np.degrees(found.miss[edge]))):.1f} degrees"
    if kind.name == "contradicted":
        return f"misses what the other headings say by {missed}"
    if kind.name == "evened":
        return "curved, its length evened out" if found.part[edge] < 0 else "length evened out, not measured"
    part = int(found.part[edge])
    text = f"in part {part + 1}, whose shape the headings fix ({counted(int(found.sizes[part]), 'leg')})"
    return f"{text}; its heading misses the others by {missed}" if found.miss[edge] else text


def caption_of(found: Rigidity, layout: str) -> str:
    """Return what the caption says of fixed shapes: how they are in this picture, and what is open."""
    if layout not in _TRUE_TO_HEADINGS and found.counts["parts"]:
        return "what the headings fix is coloured, but this layout does not keep it; the compass layout does"
    n = found.freedom
    if not n:
        return "no proportion is open"
    return f"{counted(n, 'proportion')} {'is' if n == 1 else 'are'} open, chosen by the drawing"
