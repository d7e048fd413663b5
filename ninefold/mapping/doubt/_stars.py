"""The exits of every place, sorted by heading, as arrays that answer for many places at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..heading import TAU, wrap_all

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..plane import PlaneMap

__all__ = ["Stars"]


class Stars:
    """The exits of the places of a map with headings. Tethers are no exits.

    Attributes
    ----------
    heading, tail
        (2E,) yaw in radians on leaving along a dart, and the place it leaves.
    degree
        (V,) number of exits.
    rank
        (2E,) position of a dart among the exits of its place, by rising yaw; nothing for tethers.
    """

    def __init__(self, plane: PlaneMap, heading: NDArray[np.float64]) -> None:
        self.tail = plane.tail.astype(np.int64)
        self.heading = wrap_all(heading)
        self.degree = plane.degree.astype(np.int64)
        exits = np.flatnonzero(~np.repeat(plane.tether, 2))
        self._darts = exits[np.lexsort((self.heading[exits], self.tail[exits]))]
        self._first = np.cumsum(self.degree) - self.degree
        self.rank = np.zeros(self.tail.size, np.int64)
        self._looks: dict[tuple[float, bool], NDArray[np.int64]] = {}
        self.rank[self._darts] = np.arange(exits.size) - self._first[self.tail[self._darts]]

    def darts(self, places: NDArray[np.int64], k: int) -> NDArray[np.int64]:
        """Return the exits of places that all have `k` of them, (n, k), by rising yaw."""
        return np.asarray(self._darts[self._first[places][:, None] + np.arange(k)])

    def looks(self, cell: float, *, compass: bool) -> NDArray[np.int64]:
        """Return a number for each dart, equal where a robot that comes by it sees the same.

        Parameters
        ----------
        cell
            Radians; headings are told apart by the cell of this size that they fall in.
        compass
            Whether headings are seen from east; otherwise from the way back.

        Notes
        -----
        Complexity O(E degree + E log E) at the first call with these arguments; the answer is kept.
        """
        if (cell, compass) not in self._looks:
            self._looks[cell, compass] = self._sorted_looks(cell, compass=compass)
        return self._looks[cell, compass]

    def _sorted_looks(self, cell: float, *, compass: bool) -> NDArray[np.int64]:
        look = np.zeros(self.tail.size, np.int64)
        for k in np.unique(self.degree[self.degree > 0]).tolist():
            darts = self.darts(np.flatnonzero(self.degree == k), k)
            yaw = self.heading[darts]
            for back in range(k):
                seen = yaw if compass else yaw - yaw[:, back : back + 1]
                cells = np.sort(np.floor((seen % TAU) / cell).astype(np.int64), axis=1)
                code = np.full(len(cells), k, np.int64)
                for i in range(k):
                    code = code * 1_000_003 + cells[:, i]  # wraps around; two looks with one code only blur a forecast
                look[darts[:, back]] = code
        return np.asarray(np.unique(look, return_inverse=True)[1], np.int64)
