"""Looking further ahead, where no single move tells the candidates apart."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..heading import wrap_all

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._stars import Stars

__all__ = ["Outlook", "expected_left", "towards_a_difference"]

MOST_CANDIDATES = 64
"""Candidates up to which more than one move is looked ahead; more are told apart by one."""

MOST_TRIED = 100
"""Sequences of moves that are tried."""


class Outlook(NamedTuple):
    """Where the candidates would come.

    Attributes
    ----------
    exits
        (m,) yaw of the exits seen, ascending.
    arrived
        (n, m) the dart by which each candidate would have come if it left by each exit; -1 where it has no exit.
    share
        (n,) how likely each candidate is.
    looks
        (2E,) a number for each dart, equal where the same is seen by who comes by it.
    """

    exits: NDArray[np.float64]
    arrived: NDArray[np.int64]
    share: NDArray[np.float64]
    looks: NDArray[np.int64]


def expected_left(back: NDArray[np.int64], outlook: Outlook) -> float:
    """Return how many candidates are expected to be left once they came back by these darts, (n,), and looked around."""
    known = back >= 0
    likely = np.bincount(back[known], weights=outlook.share[known], minlength=outlook.looks.size)
    there = np.flatnonzero(likely)
    if not there.size:
        return 0.0
    group = outlook.looks[there]
    weight = np.bincount(group, weights=likely[there])
    return float(np.dot(np.bincount(group), weight)) / float(weight.sum())


def towards_a_difference(stars: Stars, outlook: Outlook, *, compass: bool) -> int | None:
    """Return the exit that begins a shortest sequence of moves after which fewer candidates are left; None if none is found.

    For an outlook of which no single exit tells any two candidates apart.

    Notes
    -----
    Breadth first over what all candidates do alike, at most `MOST_TRIED` sequences: O(candidates x degree^2) each.
    """
    arrived = outlook.arrived
    n = len(arrived)
    if not 1 < n <= MOST_CANDIDATES or (arrived < 0).any():
        return None
    queue = deque((arrived[:, i], i) for i in range(arrived.shape[1]))
    seen = {arrived[:, i].tobytes() for i in range(arrived.shape[1])}
    for _ in range(MOST_TRIED):
        if not queue:
            return None
        back, first = queue.popleft()
        for after in _moves_alike(stars, back, compass=compass).T:
            key = after.tobytes()
            if key in seen:
                continue
            seen.add(key)
            if expected_left(after, outlook) < n - 1e-9:
                return first
            queue.append((after, first))
    return None


def _moves_alike(stars: Stars, back: NDArray[np.int64], *, compass: bool) -> NDArray[np.int64]:
    """Return the darts come back by after each move that robots at places that look alike can all make, (n, k)."""
    places = stars.tail[back]
    k = int(stars.degree[places[0]])
    darts = stars.darts(places, k)
    yaw = stars.heading[darts]
    if not compass:
        yaw = yaw - stars.heading[back][:, None]
    error = yaw[0][None, :, None] - yaw[:, None, :]  # candidate, exit of the first, its own exit
    way = np.abs(wrap_all(error)).argmin(axis=2)
    return np.ascontiguousarray(np.take_along_axis(darts, way, axis=1) ^ 1)
