"""Headings and circular arithmetic.

One sense everywhere: counter-clockwise, yaw in radians from east (ROS REP-103), wrapped to (-pi, pi]. Compass bearings,
in degrees clockwise from north, enter and leave only here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

__all__ = ["TAU", "Heading", "circular_mean", "unwrap", "wrap"]

TAU = 2 * math.pi


def wrap(angle: float) -> float:
    """Return the angle, in radians, that differs from `angle` by whole turns and lies in (-pi, pi].

    Examples
    --------
    >>> from math import pi
    >>> wrap(-pi) == pi, round(wrap(7.0), 4)
    (True, 0.7168)
    """
    wrapped = math.remainder(angle, TAU)
    return math.pi if wrapped <= -math.pi else wrapped


def unwrap(samples: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
    """Remove the jumps of a sampled yaw: each step becomes the shorter way round.

    Parameters
    ----------
    samples
        (k,) yaw in radians, in the order sampled.

    Returns
    -------
    ndarray
        (k,) float64; the last minus the first value is the net rotation, counter-clockwise positive.

    Raises
    ------
    BadInput
        If a sample is not finite, or two successive samples differ by half a turn: the way between them is unknown.

    Examples
    --------
    >>> float(round(np.diff(unwrap([3.0, -3.0]))[0], 4))
    0.2832
    """
    yaw = _finite(samples)
    steps = np.diff(yaw)
    steps -= TAU * np.round(steps / TAU)
    if steps.size and float(np.abs(steps).max()) > math.pi - 1e-9:
        at = int(np.abs(steps).argmax())
        raise BadInput(
            f"samples {at + 1} and {at + 2} differ by half a turn, so the way between them is unknown; sample more often"
        )
    return np.concatenate([yaw[:1], yaw[:1] + np.cumsum(steps)])


def circular_mean(samples: Sequence[float] | NDArray[np.float64]) -> float:
    """Return the direction of the mean unit vector of the yaws, in radians.

    Raises
    ------
    BadInput
        For no sample, samples that cancel out, or one that is not finite.

    Examples
    --------
    >>> from math import pi
    >>> round(abs(circular_mean([pi - 0.1, -pi + 0.1])), 6) == round(pi, 6)
    True
    """
    yaw = _finite(samples)
    east, north = float(np.cos(yaw).sum()), float(np.sin(yaw).sum())
    if math.hypot(east, north) < 1e-12 * max(1, yaw.size):
        raise BadInput("the mean of headings that cancel out, or of none, is no direction")
    return wrap(math.atan2(north, east))


def _finite(samples: Sequence[float] | NDArray[np.float64]) -> NDArray[np.float64]:
    yaw = np.asarray(samples, dtype=np.float64)
    if not np.isfinite(yaw).all():
        raise BadInput(f"sample {int(np.flatnonzero(~np.isfinite(yaw))[0]) + 1} is no finite angle")
    return yaw


@dataclass(frozen=True, slots=True, order=False)
class Heading:
    """A direction in the plane.

    Attributes
    ----------
    yaw
        Radians counter-clockwise from east, in (-pi, pi].

    Raises
    ------
    BadInput
        If the value is not finite.

    Examples
    --------
    >>> Heading.from_bearing(90).yaw                  # east
    0.0
    >>> round(Heading.from_degrees(90).bearing, 9)    # north
    0.0
    >>> Heading.from_bearing(0).turn_to(Heading.from_bearing(90)) < 0   # a right turn is clockwise
    True
    """

    yaw: float

    def __post_init__(self) -> None:
        if not math.isfinite(self.yaw):
            raise BadInput(f"a heading is a finite angle, not {quoted(self.yaw)}")
        object.__setattr__(self, "yaw", wrap(self.yaw))

    @classmethod
    def from_degrees(cls, degrees: float) -> Heading:
        """Make a heading from a yaw in degrees, counter-clockwise from east."""
        return cls(math.radians(degrees))

    @classmethod
    def from_bearing(cls, degrees: float) -> Heading:
        """Make a heading from a compass bearing in degrees, clockwise from north."""
        if not math.isfinite(degrees):
            raise BadInput(f"a bearing is a finite angle, not {quoted(degrees)}")
        return cls(math.radians(90.0 - math.fmod(degrees, 360.0)))

    @property
    def degrees(self) -> float:
        """Yaw in degrees, counter-clockwise from east, in (-180, 180]."""
        return math.degrees(self.yaw)

    @property
    def bearing(self) -> float:
        """Compass bearing in degrees, clockwise from north, in [0, 360)."""
        bearing = (90.0 - math.degrees(self.yaw)) % 360.0
        return 0.0 if bearing == 360.0 else bearing  # just west of north the remainder rounds up

    @property
    def opposite(self) -> Heading:
        """The heading that looks the other way."""
        return Heading(self.yaw + math.pi)

    def turn_to(self, other: Heading) -> float:
        """Return the rotation from this heading to `other`, radians in (-pi, pi], counter-clockwise positive."""
        return wrap(other.yaw - self.yaw)

    def __str__(self) -> str:
        return f"{self.degrees:.1f} deg"
