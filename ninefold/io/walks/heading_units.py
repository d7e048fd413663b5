"""Doubts about the unit of a walk's headings: degrees under a header of radians, or the other way round."""

from __future__ import annotations

from math import degrees, pi
from typing import TYPE_CHECKING

from ninefold.mapping.robot.walk import Samples

if TYPE_CHECKING:
    from ninefold.mapping import Walk

__all__ = ["doubts"]

_SEVERAL_TURNS = 8 * pi
_FEW_DIFFERENT = 3


def doubts(walk: Walk) -> list[str]:
    """Return a sentence if the header's unit of headings seems to be a mistake.

    Radians beyond four turns are doubted, and so are degrees that stay within one turn of radians although some of them
    are no whole numbers. Both can be right, so it is no error.

    Notes
    -----
    Complexity O(samples). Bearings come as yaw, and are turned back.

    Examples
    --------
    >>> from ninefold.mapping import Samples, Visit, Walk, WalkHeader
    >>> doubts(Walk(WalkHeader("yaw-rad"), (Visit("a"), Samples((270.0,)), Visit("b"))))
    ['headings reach 270 and the header says yaw-rad; if they are degrees, write yaw-deg or bearing-deg there']
    """
    unit = walk.header.heading
    yaws = [yaw for event in walk.events if isinstance(event, Samples) for yaw in event.yaw]
    if unit == "yaw-rad":
        largest = max(map(abs, yaws), default=0.0)
        if largest > _SEVERAL_TURNS:
            found = f"headings reach {largest:.6g} and the header says {unit}"
            return [f"{found}; if they are degrees, write yaw-deg or bearing-deg there"]
        return []
    given = {round(degrees(yaw) if unit == "yaw-deg" else 90.0 - degrees(yaw), 6) for yaw in yaws}
    if len(given) < _FEW_DIFFERENT or max(map(abs, given)) > 2 * pi or all(value.is_integer() for value in given):
        return []
    return [f"no heading is beyond 6.29 and the header says {unit}; if they are radians, write yaw-rad there"]
