"""The units in which walk logs give headings: to yaw in radians and back, and in words for messages.

A message about a walk speaks the unit of its log, so that the numbers in it can be found in the file.

Examples
--------
>>> from ninefold.mapping.robot.units import unit_of
>>> unit_of("bearing-deg").heading(0.0), unit_of("yaw-deg").heading(0.0), unit_of("yaw-rad").angle(0.05)
('bearing 90 deg', '0 deg', '0.05 rad')
"""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, fmod, radians
from typing import TYPE_CHECKING

from ..heading import LARGEST_ANGLE, wrap

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from .walk import HeadingUnit

__all__ = ["Unit", "unit_of"]


@dataclass(frozen=True, slots=True)
class Unit:
    """A unit of headings.

    Attributes
    ----------
    to_yaw, from_yaw
        From a number of the log to yaw in radians, and back.
    sense
        What stands before a direction in words, such as ``"bearing "``, or nothing.
    measure
        ``"deg"`` or ``"rad"``.
    """

    to_yaw: Callable[[float], float]
    from_yaw: Callable[[float], float]
    sense: str
    measure: str

    def heading(self, yaw: float) -> str:
        """Write a direction, given in radians."""
        return f"{self.sense}{self._number(yaw)} {self.measure}"

    def headings(self, yaws: Iterable[float]) -> str:
        """Write several directions, given in radians."""
        return ", ".join(map(self._number, yaws)) or "none"

    def angle(self, size: float) -> str:
        """Write an angle that is no direction, such as a turn or a tolerance, given in radians."""
        return f"{(degrees(size) if self.measure == 'deg' else size) + 0.0:.3g} {self.measure}"

    def _number(self, yaw: float) -> str:
        text = f"{self.from_yaw(wrap(yaw)) + 0.0:.4g}"
        return "0" if text == "360" else text


def _yaw(bearing: float) -> float:
    """Turn a bearing into yaw; one too large for an angle stays too large for one."""
    whole = bearing if abs(bearing) > degrees(LARGEST_ANGLE) else fmod(bearing, 360.0)
    return radians(90.0 - whole)


def _bearing(yaw: float) -> float:
    bearing = (90.0 - degrees(yaw)) % 360.0
    return 0.0 if bearing == 360.0 else bearing  # just west of north the remainder rounds up


_UNITS: dict[HeadingUnit, Unit] = {
    "yaw-rad": Unit(float, float, "", "rad"),
    "yaw-deg": Unit(radians, degrees, "", "deg"),
    "bearing-deg": Unit(_yaw, _bearing, "bearing ", "deg"),
}


def unit_of(name: HeadingUnit) -> Unit:
    """Return the unit that a header names."""
    return _UNITS[name]
