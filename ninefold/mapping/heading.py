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

__all__ = ["LARGEST_ANGLE", "TAU", "Heading", "circular_mean", "too_large_an_angle", "unwrap", "wrap", "wrap_all"]

TAU = 2 * math.pi

LARGEST_ANGLE = 2.0**23
"""Radians (1.3 million turns) beyond which a number is not taken for an angle. Up to here two neighbouring floats differ by
less than 1e-9, the finest difference between headings that anything here looks at; beyond, rounding decides the direction.
"""


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


def wrap_all(angle: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the angles, radians, that differ from those given by whole turns and lie in [-pi, pi].

    Examples
    --------
    >>> wrap_all(np.array([7.0, -7.0])).round(4).tolist()
    [0.7168, -0.7168]
    """
    return np.asarray(angle - TAU * np.round(angle / TAU))


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
        If a sample is not finite or beyond `LARGEST_ANGLE`, or two successive samples differ by half a turn: the way between
        them is unknown.

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
        For no sample, samples that cancel out, or one that is not finite or beyond `LARGEST_ANGLE`.

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
    if not (np.abs(yaw) <= LARGEST_ANGLE).all():
        at = int(np.flatnonzero(~(np.abs(yaw) <= LARGEST_ANGLE))[0])
        raise BadInput(
            f"sample {at + 1} is no finite angle"
            if not np.isfinite(yaw[at])
            else f"sample {at + 1}: {too_large_an_angle(yaw[at])}"
        )
    return yaw


def too_large_an_angle(radians: float) -> str:
    """Say why a number is taken for no angle."""
    return (
        f"{radians:.6g} radians is too large for an angle: beyond {LARGEST_ANGLE:.0f} radians "
        "the direction it gives is mere rounding"
    )


def _radians(value: float, what: str) -> float:
    """Return a number that is an angle in radians, or say why it is none."""
    try:
        finite = not isinstance(value, bool) and math.isfinite(value)
    except (TypeError, OverflowError):
        finite = False
    if not finite:
        raise BadInput(f"{what} is a finite angle, not {quoted(value)}")
    if abs(value) > LARGEST_ANGLE:
        raise BadInput(f"{what} of {too_large_an_angle(value)}")
    return float(value)


def _from_degrees(value: float, what: str) -> float:
    try:
        radians = math.radians(value)
    except (TypeError, OverflowError):
        raise BadInput(f"{what} is a finite angle in degrees, not {quoted(value)}") from None
    return _radians(radians, what)


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
        If the value is not finite, or beyond `LARGEST_ANGLE`.

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
        object.__setattr__(self, "yaw", wrap(_radians(self.yaw, "a heading")))

    @classmethod
    def from_degrees(cls, degrees: float) -> Heading:
        """Make a heading from a yaw in degrees, counter-clockwise from east."""
        return cls(_from_degrees(degrees, "a heading"))

    @classmethod
    def from_bearing(cls, degrees: float) -> Heading:
        """Make a heading from a compass bearing in degrees, clockwise from north."""
        _from_degrees(degrees, "a bearing")
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
