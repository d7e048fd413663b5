"""Longitude and latitude to planar metres and back: equirectangular, about the middle of a file."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["EARTH_RADIUS", "Projection"]

EARTH_RADIUS = 6_371_008.8
"""Mean radius in metres (IUGG)."""


@dataclass(frozen=True, slots=True)
class Projection:
    """An equirectangular projection.

    Attributes
    ----------
    longitude, latitude
        Degrees of the middle, which is at (0, 0) metres.
    wraps
        Whether the file lies on both sides of the antimeridian: longitudes below 0 then count from 180.

    Examples
    --------
    >>> import numpy as np
    >>> helsinki = Projection(24.94, 60.17)
    >>> helsinki.metres(np.array([[24.95, 60.17]])).round(1)
    array([[553.1,   0. ]])
    >>> helsinki.degrees((553.1, 0.0))
    (24.9499997, 60.17)
    """

    longitude: float
    latitude: float
    wraps: bool = False

    @classmethod
    def about(cls, at: NDArray[np.float64]) -> Projection:
        """Return the projection about the middle of (n, 2) longitudes and latitudes."""
        wraps = float(np.ptp(at[:, 0])) > 180.0
        lon = np.where(wraps & (at[:, 0] < 0), at[:, 0] + 360.0, at[:, 0])
        middle = (float(lon.min() + lon.max()) / 2, float(at[:, 1].min() + at[:, 1].max()) / 2)
        return cls(*middle, wraps=wraps)

    def metres(self, at: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return (n, 2) planar metres, east and north, of (n, 2) longitudes and latitudes."""
        east = np.where(self.wraps & (at[:, 0] < 0), at[:, 0] + 360.0, at[:, 0])
        middle = np.array([self.longitude, self.latitude])
        return np.asarray((np.stack([east, at[:, 1]], axis=1) - middle) * np.array(self._scale) + 0.0)

    def degrees(self, at: tuple[float, float]) -> tuple[float, float]:
        """Return longitude and latitude of a place in planar metres, rounded to 1e-7 degrees (a centimetre)."""
        east, north = self._scale
        longitude = math.remainder(at[0] / east + self.longitude, 360.0)
        return round(longitude, 7), round(at[1] / north + self.latitude, 7)

    @property
    def _scale(self) -> tuple[float, float]:
        north = math.radians(1.0) * EARTH_RADIUS
        return north * math.cos(math.radians(self.latitude)), north
