"""What lists of exits say together: the directions of the exits of a place, and how the compass stood at every visit.

A list tells the directions of all exits of a place, but not which exit leads where. Lists of several visits are laid over
each other by a cyclic shift, and averaged. Where the log does not say that its lists are in order, they are sorted by what
was read, so two exits nearer than the noise may have changed places in one list and not in another: their average would be
too far apart, and such lists are not used.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np

from ..heading import TAU, wrap_all
from .noise import LOG_ODDS, SURE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from .evidence import Evidence
    from .noise import NoiseModel

__all__ = ["Directions", "averaged", "biases"]

RESOLVED = 3 * sqrt(2)
"""Standard deviations of one reading that two exits of averaged sorted lists must lie apart for the lists to be used."""


ROUNDS = 4
"""Times the lists of a walk are gone through at most to tell how the robot stood."""


@dataclass(frozen=True, slots=True)
class Directions:
    """The exits of one place as its lists show them, averaged.

    Attributes
    ----------
    count
        Number of exits, K.
    lifts
        Ways to read them as a full turn: arrays (K,) of radians that rise around the place, the last one less than a turn
        above the first. Empty where the lists say nothing that can be relied on; several only where lists in order leave
        open which corner of two is the wide one.
    variance
        Of every direction, radians squared.
    misses, free
        Sum of squared misses of the readings from their averages in radians squared, and the number of free errors in it.
    contradicts
        Whether lists declared to be in order run round more than once, so that they are not.
    """

    count: int
    lifts: tuple[NDArray[np.float64], ...]
    variance: float
    misses: float
    free: int
    contradicts: bool = False


def averaged(lists: Sequence[NDArray[np.float64]], variance: float, *, in_order: bool) -> Directions:
    """Average the lists of one place.

    Parameters
    ----------
    lists
        One or more arrays (K,) of yaws, radians; counter-clockwise where `in_order`.
    variance
        Of a single reading, radians squared.

    Notes
    -----
    Complexity O(visits times K squared).
    """
    count, visits = lists[0].size, len(lists)
    if count == 0:
        return Directions(0, (np.zeros(0),), variance, 0.0, 0)
    ordered = in_order and count > 2  # two in order are no more than two sorted
    rows = np.array([yaws if ordered else np.sort(yaws) for yaws in lists])
    mean = rows[0].copy()
    for _ in range(3):
        off, sure = _laid_over(rows, mean, variance)
        mean = mean + off.mean(axis=0)
    misses = float(((off - off.mean(axis=0)) ** 2).sum())
    free = (visits - 1) * count
    found = Directions(count, (), variance / visits, misses, free)
    if not ordered:
        rising = np.sort(wrap_all(mean))
        gaps = np.diff(np.append(rising, rising[0] + TAU))
        usable = bool((gaps > RESOLVED * sqrt(variance)).all())
        return Directions(count, (rising,) if usable else (), found.variance, misses, free)
    if not sure:
        return found
    steps = wrap_all(np.roll(mean, -1) - mean)
    missing = 1 - round(float(steps.sum()) / TAU)  # corners wider than half a turn, or ties that noise turned round
    if missing < 0:
        return Directions(count, (), found.variance, misses, free, contradicts=True)
    behind = np.flatnonzero(steps < 0)
    lifts = []
    for wide in combinations(behind.tolist(), missing):
        tied = steps[np.setdiff1d(behind, wide)]
        if (tied**2 <= 4 * found.variance * LOG_ODDS).all():
            corner = steps.copy()
            corner[list(wide)] += TAU
            lifts.append(mean[0] + np.concatenate([[0.0], np.cumsum(corner)[:-1]]))
    return Directions(count, tuple(lifts), found.variance, misses, free, contradicts=not lifts)


def _laid_over(rows: NDArray[np.float64], mean: NDArray[np.float64], variance: float) -> tuple[NDArray[np.float64], bool]:
    """Return how far every list is off `mean` under its best cyclic shift, and whether each shift is beyond doubt."""
    off = wrap_all(_shifted(rows) - mean)
    cost = (off**2).sum(axis=2)
    best = cost.argmin(axis=1)
    sure = True
    if len(rows) > 1 and rows.shape[1] > 1:
        first, second = np.sort(cost, axis=1)[:, :2].T
        sure = bool((second - first > 4 * variance * LOG_ODDS).all())
    return off[np.arange(len(rows)), best], sure


def _shifted(rows: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the (visits, shift, K) cyclic shifts of every row."""
    count = rows.shape[1]
    places = (np.arange(count)[None, :] + np.arange(count)[:, None]) % count
    return rows[:, places]


def biases(
    evidence: Evidence, visits_of: Sequence[Sequence[int]], noise: NoiseModel
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Tell how the frame stood at every visit, from the lists of exits.

    A list is laid over those of earlier visits to the same place; by how much it has to be turned is the bias. With a
    compass the bias is near nought; without one it is near that of the visit before, and a place seen for the first time is
    taken to lie as the frame stood. An exit that was seen to lead to one place is never laid over one that leads to another,
    so that a crossing whose exits look alike from all sides is told apart by where they lead.

    Returns
    -------
    tuple
        (L + 1,) radians to take out of all readings of a visit, relative to the frame of its place and not wrapped; and (V,)
        bool, the places where that could be told at every visit.

    Notes
    -----
    Complexity O(sum of K squared over the visits).
    """
    known = np.array([all(evidence.exits[visit] is not None for visit in visits) for visits in visits_of], np.bool_)
    leads: list[dict[int, int]] = [{} for _ in visits_of]
    unsure: set[int] = set()
    for _ in range(ROUNDS):  # what one visit shows of where exits lead may tell how the robot stood at an earlier one
        before = sum(map(len, leads))
        bias, aligned, unsure = _stood(evidence, noise, known, leads)
        if not unsure or sum(map(len, leads)) == before:
            break
    known[list(unsure)] = False
    for place, visits in enumerate(visits_of):
        if not known[place]:
            bias[list(visits)] = 0.0
            continue
        if len(visits) < 2 or not aligned[visits[0]].size:
            continue
        rows = np.array([aligned[visit] for visit in visits])
        # rows are directions plus bias; a frame lies as the mean of its visits with a compass, else as at the first of them
        of_visit = rows.mean(axis=1)
        bias[list(visits)] = of_visit - (of_visit.mean() if noise.compass else of_visit[0] - bias[visits[0]])
    return bias, known


def _stood(
    evidence: Evidence, noise: NoiseModel, known: NDArray[np.bool_], leads: list[dict[int, int]]
) -> tuple[NDArray[np.float64], list[NDArray[np.float64]], set[int]]:
    """Lay every list over those before it at its place; note in `leads` where the exits of every place lead.

    Returns (bias of every visit, its list turned to lie over the others, places with a visit at which that was not certain).
    """
    bias = np.zeros(len(evidence.at))
    frame: dict[int, tuple[NDArray[np.float64], int]] = {}
    parent = [0]  # how every frame was handed on, as a tree: of a place from the one that the robot came from
    here = 0
    aligned: list[NDArray[np.float64]] = []
    single = noise.sigma**2
    unsure: set[int] = set()
    now = 0.0
    for visit, place in enumerate(evidence.at.tolist()):
        if noise.compass:
            now = 0.0
        yaws = evidence.exits[visit]
        if yaws is None or not yaws.size or not known[place]:
            aligned.append(np.zeros(0))
            here = _handed_on(parent, here)
            continue
        row = yaws if noise.in_order and yaws.size > 2 else np.sort(yaws)
        ends = _ends_of(evidence, visit, row, noise.sigma)
        if place not in frame:
            leads[place].update(ends)
            here = _handed_on(parent, here)
            frame[place] = (row - now, here)
            aligned.append(row)
            bias[visit] = now
            continue
        mean, there = frame[place]
        legs = 1 + _apart(parent, here, there)
        spread = 2 * noise.drift**2 if noise.compass else legs * (noise.drift**2 + 2 * single)
        before, here = here, there
        off = wrap_all(_shifted(row[None])[0] - mean - now)
        off = off[:, :1] + wrap_all(off - off[:, :1])  # misses about half a turn lie on either side of it: one lump
        whole = TAU * np.round(off.mean(axis=1) / TAU)
        off -= whole[:, None]
        turned = off.mean(axis=1)
        cost = ((off - turned[:, None]) ** 2).sum(axis=1) / (4 * single) + turned**2 / (2 * (spread + 2 * single / row.size))
        for shift in range(row.size):
            if any(leads[place].get((i - shift) % row.size, end) != end for i, end in ends.items()):
                cost[shift] = np.inf
        best = int(cost.argmin())
        if np.isinf(cost[best]) or (row.size > 1 and np.sort(cost)[1] - cost[best] <= LOG_ODDS):
            unsure.add(place)
            here = _handed_on(parent, before)
            aligned.append(row)
            continue
        leads[place].update({(i - best) % row.size: end for i, end in ends.items()})
        now += float(turned[best])
        bias[visit] = now
        aligned.append(mean + now + off[best] - turned[best])
    return bias, aligned, unsure


def _ends_of(evidence: Evidence, visit: int, row: NDArray[np.float64], sigma: float) -> dict[int, int]:
    """Return where the exits by which the robot came and left lead, by their numbers in the list of that visit.

    A reading belongs to an exit of the list if no other lies within what both can err by.
    """
    legs = []
    if visit > 0:
        legs.append((evidence.back[visit - 1], int(evidence.at[visit - 1])))
    if visit < evidence.n_legs:
        legs.append((evidence.out[visit], int(evidence.at[visit + 1])))
    found = {}
    for yaw, end in legs:
        near = np.flatnonzero(np.abs(wrap_all(row - yaw)) <= SURE * sqrt(2) * sigma)
        if near.size == 1:
            found[int(near[0])] = end
    return found


def _handed_on(parent: list[int], here: int) -> int:
    """Let a new frame come after this one, and return it. A frame has a higher number than the one it comes after."""
    parent.append(here)
    return len(parent) - 1


def _apart(parent: list[int], a: int, b: int) -> int:
    """Return how many legs lie between two frames: what the frame wandered over all other legs is the same for both."""
    legs = 0
    while a != b:
        if a < b:
            a, b = b, a
        a = parent[a]
        legs += 1
    return legs
