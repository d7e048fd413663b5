"""What a compass is declared to err by, and when a reading speaks against an order of the ways at a place.

Every test here has one shape. Readings are true angles plus independent Gaussian errors of standard deviation sigma, so
half the sum of their squared misses from the truth, in sigmas, is half a chi-squared variable. What is farther off than such
a sum is with a chance of 1e-9 is given up; everything else stays an alternative.

>>> round(LOG_ODDS, 2), round(threshold(2), 2), round(threshold(5), 2)
(20.72, 20.72, 25.35)
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import log, pi, radians
from typing import TYPE_CHECKING

from ..robot.walk import checked_drift, checked_sigma

if TYPE_CHECKING:
    from ..robot.walk import WalkHeader

__all__ = ["CHANCE", "DEFAULT_SIGMA", "LOG_ODDS", "SURE", "NoiseModel", "sigma_of", "threshold"]

CHANCE = 1e-9
"""Chance at which an alternative that is the truth is given up."""

LOG_ODDS = -log(CHANCE)
"""Half squared misses above which one alternative is given up against another, and for one or two free angles outright."""


SURE = 6.5
"""Standard deviations that an error stays within but with a chance below 1e-10."""

DEFAULT_SIGMA = radians(5)
"""Standard deviation of a heading where a robot is looked for and neither the caller nor the walk declares one."""


def sigma_of(header: WalkHeader) -> float:
    """Return the standard deviation of a heading that a walk declares, radians, or `DEFAULT_SIGMA`."""
    return DEFAULT_SIGMA if header.sigma is None else header.sigma


@cache
def threshold(free: int, chance: float = CHANCE) -> float:
    """Return the half squared miss that the truth exceeds with a chance, fitted or not.

    Parameters
    ----------
    free
        Number of independent errors in the sum, at least 1. For one the threshold for two is returned: the promise is made
        with ln 1e9.
    chance
        The chance, 1e-9 if left out.
    """
    from scipy.special import gammainccinv

    return max(-log(chance), float(gammainccinv(free / 2, chance)))


@dataclass(frozen=True, slots=True)
class NoiseModel:
    """What the headings of a walk are declared to err by.

    Attributes
    ----------
    sigma
        Standard deviation of every single reading, radians: independent, Gaussian, zero mean.
    drift
        Standard deviation of an error that all readings of one visit share, radians. Without a compass, of its change along
        one leg: a gyro's frame wanders without bound.
    compass
        Whether headings are held against a direction that stays the same.
    in_order
        Whether exits are listed in their true counter-clockwise order.

    Raises
    ------
    WalkError
        For angles that are none.
    """

    sigma: float
    drift: float = 0.0
    compass: bool = True
    in_order: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "sigma", checked_sigma(self.sigma))
        object.__setattr__(self, "drift", checked_drift(self.drift))

    @property
    def wanders(self) -> bool:
        """Whether the frame may turn by more than can be told from one visit to the next, as a gyro's does."""
        return self.drift > 0 and (not self.compass or self.drift > _LARGEST_BIAS)

    @property
    def useless(self) -> bool:
        """Whether a single error may be half a turn, so that headings close no alternative at all."""
        return self.sigma > _LARGEST_USEFUL


_LARGEST_USEFUL = pi / SURE

_LARGEST_BIAS = pi / SURE
