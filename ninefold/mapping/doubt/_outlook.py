"""The likeliest way in which the exits seen are those of a place, for forecasts."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..heading import wrap_all

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._matching import Look

__all__ = ["likeliest_exits", "likeliest_shift"]


def likeliest_exits(
    yaw: NDArray[np.float64],
    exits: NDArray[np.float64],
    back: NDArray[np.int64] | None,
    look: Look,
    *,
    compass: bool,
) -> NDArray[np.int64]:
    """Return which exit of each place each exit seen is, (n, m): the likeliest, or where some were missed the nearest.

    Parameters are those of `likeliest_shift`, but that a place may have more or fewer exits than were seen.
    """
    k = yaw.shape[1]
    if exits.size == k:
        shift = likeliest_shift(yaw, exits, back, look, compass=compass)
        return np.asarray((np.arange(k) + shift[:, None]) % k)
    error = exits[None, :, None] - yaw[:, None, :]
    return np.asarray(np.abs(wrap_all(error)).argmin(axis=2))


def likeliest_shift(
    yaw: NDArray[np.float64],
    exits: NDArray[np.float64],
    back: NDArray[np.int64] | None = None,
    look: Look | None = None,
    *,
    compass: bool,
) -> NDArray[np.int64]:
    """Return by how many exits those seen are turned against those of each place, (n,): the assignment with least squares.

    Of all assignments one that keeps the cyclic order has the least squares, so only these are tried.

    Parameters
    ----------
    yaw
        (n, k) yaw of the exits of places that have as many as were seen, ascending.
    exits
        (k,) yaw of those seen, ascending.
    back, look
        (n,) which exit of each place is the way back, and what was seen, if known; the way back is then what `look` says.

    Notes
    -----
    Complexity O(n k^2).
    """
    n, k = yaw.shape
    zero = None
    if look is not None and back is not None:
        if look.back_exit is not None:
            return np.asarray((back - look.back_exit) % k)
        if look.back is not None:
            zero = (look.back - yaw[np.arange(n), back])[:, None]
    cost = np.empty((n, k))
    for shift in range(k):
        error = exits - yaw[:, (np.arange(k) + shift) % k]
        if not compass:
            error -= error[:, :1] if zero is None else zero
        error = wrap_all(error)
        if not compass and zero is None:
            error -= error.mean(axis=1, keepdims=True)
        cost[:, shift] = (error * error).sum(axis=1)
    return np.asarray(cost.argmin(axis=1))
