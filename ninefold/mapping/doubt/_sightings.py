"""What a robot is said to have seen, checked and put in order."""

from __future__ import annotations

from collections.abc import Iterable
from math import isfinite
from numbers import Integral

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput

from ..heading import Heading
from ._matching import Look

__all__ = ["finite", "look_of", "probability"]


def look_of(exits: Iterable[Heading] | None, came_by: Heading | int | None) -> tuple[Look, tuple[int, ...]]:
    """Return what was seen, exits by rising yaw, and where each exit given is in it."""
    given: tuple[int, ...] = ()
    yaw = None
    if exits is not None:
        if isinstance(exits, Heading | str) or not isinstance(exits, Iterable):
            raise BadInput(f"exits are a list of headings, such as [Heading.from_degrees(90)], not {quoted(exits)}")
        listed = list(exits)
        wrong = next((x for x in listed if not isinstance(x, Heading)), None)
        if wrong is not None:
            raise BadInput(f"an exit is a Heading, such as Heading.from_degrees(90), not {quoted(wrong)}")
        found = np.array([x.yaw for x in listed], np.float64)
        order = np.argsort(found, kind="stable")
        yaw = found[order]
        given = tuple(np.argsort(order, kind="stable").tolist())
    if came_by is None:
        if yaw is None:
            raise BadInput("nothing was seen: give exits, came_by or both")
        return Look(yaw), given
    if isinstance(came_by, Heading):
        return Look(yaw, back=came_by.yaw), given
    if isinstance(came_by, bool) or not isinstance(came_by, Integral):
        raise BadInput(f"came_by is the position of an exit, or a Heading, not {quoted(came_by)}")
    if not 0 <= came_by < len(given):
        raise BadInput(f"came_by is a position in the {counted(len(given), 'exit')} given, from 0 on, not {came_by}")
    return Look(yaw, back_exit=given[int(came_by)]), given


def finite(what: str, value: float) -> float:
    """Return a finite number of radians, or say that it is none."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not isfinite(value):
        raise BadInput(f"{what} is a finite number of radians, not {quoted(value)}")
    return float(value)


def probability(name: str, value: float) -> float:
    """Return a probability below 1, or say that it is none."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < 1:
        raise BadInput(f"{name} is a probability from 0 to below 1, not {quoted(value)}")
    return float(value)
