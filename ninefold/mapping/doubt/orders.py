"""The orders of the ways around one place that its evidence leaves open.

An order says more than which way comes after which: two ways alone have one cyclic order, and still either of the corners
between them may be the narrow one. So an order here is *lifted*: every way has a heading on a line, not on a circle, they
rise along the order, and the last lies less than a full turn above the first. Which corner is wide then needs no rule.

Two tests close an order. **Legs**: the least squared miss of rising headings from the mean headings of the legs (isotonic
regression; for two ways, how far noise must have turned them round). **Lists**: the least squared miss of an assignment of
the ways to the listed exits, in this order. Each test gives up the truth with a chance of 1e-9 for each alternative.

References
----------
R. E. Barlow, D. J. Bartholomew, J. M. Bremner and H. D. Brunk, Statistical Inference under Order Restrictions (1972): pool
adjacent violators, and the distribution of the misses, which half a chi-squared variable with one degree less than there are
headings bounds.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import inf
from typing import TYPE_CHECKING

from ..heading import TAU
from .noise import LOG_ODDS, threshold

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from .exit_lists import Directions

__all__ = ["StarOrder", "fitted", "star_orders"]

MOST_ORDERS = 5000
"""Orders of one place up to which they are listed."""

MOST_TRIES = 8 * MOST_ORDERS
"""Beginnings of an order up to which they are tried."""

THINNEST = 1e-4
"""Radians that two ways of a finished map lie apart at least: an order cannot be told from equal headings."""


@dataclass(frozen=True, slots=True)
class StarOrder:
    """One order of the k ways around a place.

    Attributes
    ----------
    ways
        Numbers 0 to k - 1, counter-clockwise, the lowest first.
    lifts
        Mean heading of each, in this order, radians on a line: they rise but for noise.
    best
        The likeliest headings in this order, radians on a line, from legs and lists together.
    cost
        Half squared misses in standard deviations: minus the logarithm of the likelihood, but for a constant.
    """

    ways: tuple[int, ...]
    lifts: tuple[float, ...]
    best: tuple[float, ...]
    cost: float

    @property
    def corners(self) -> tuple[float, ...]:
        """Angle from each way to the next, counter-clockwise; a near tie may be a little below nought. They sum to 2 pi."""
        after = (*self.lifts[1:], self.lifts[0] + TAU)
        return tuple(b - a for a, b in zip(self.lifts, after, strict=True))


def star_orders(
    heading: Sequence[float], variance: Sequence[float], directions: Directions | None = None, *, closes: bool = True
) -> tuple[list[StarOrder], float] | None:
    """Return the orders of k ways that legs and lists leave open, the likeliest first.

    Parameters
    ----------
    heading, variance
        Of the mean heading of each way, radians and radians squared.
    directions
        The exits as the place's lists show them, at least k.
    closes
        False for noise so large that an error may be half a turn: then no order is closed.

    Returns
    -------
    tuple or None
        The orders, and the least squared miss of ways from listed exits in standard deviations (0 where lists say nothing);
        no order at all where legs and lists contradict each other. None where more than `MOST_ORDERS` are open, or it
        takes more than `MOST_TRIES` beginnings to tell.

    Notes
    -----
    Complexity O(k log k) where all ways lie well apart; otherwise it grows with the number of open orders.
    """
    k = len(heading)
    found = []
    for tries, order in enumerate(_by_legs(heading, variance, closes=closes)):
        if order is not None:
            found.append(order)
        if len(found) > MOST_ORDERS or tries > MOST_TRIES:
            return None
    if directions is None or not directions.lifts or not closes:
        return sorted((StarOrder(w, x, x, cost) for w, x, cost in found), key=lambda order: order.cost), 0.0
    fits = [(_by_lists(lifts, [variance[i] for i in ways], directions), ways, lifts, cost) for ways, lifts, cost in found]
    least = min(miss for (miss, _), *_ in fits)
    if least > threshold(k):
        return [], least
    limit = min(threshold(k), least + threshold(max(k - 1, 1)))
    orders = [StarOrder(w, x, best, cost + miss) for (miss, best), w, x, cost in fits if miss <= limit]
    return sorted(orders, key=lambda order: order.cost), least


def _by_legs(
    heading: Sequence[float], variance: Sequence[float], *, closes: bool
) -> Iterator[tuple[tuple[int, ...], tuple[float, ...], float] | None]:
    """Yield (ways, lifts, cost) of every order that the legs leave open, depth first, and None after any other try."""
    k, first = len(heading), heading[0]
    around = [(yaw - first) % TAU for yaw in heading]
    if k == 1:
        yield (0,), (first,), 0.0
        return
    weight = [1 / v for v in variance]
    total = threshold(k - 1) if closes else inf
    pair = [[2 * LOG_ODDS * (variance[i] + variance[j]) if closes else inf for j in range(k)] for i in range(k)]
    room = max(pair[0][1:]) ** 0.5 if closes else TAU
    choices = [
        [x for x in (around[i] - TAU, around[i], around[i] + TAU) if -room <= x <= TAU + room] if i else [0.0]
        for i in range(k)
    ]

    def may_follow(i: int, x: float, j: int, y: float) -> bool:
        """Whether way j with lift y can come after way i with lift x and before it comes round again."""
        behind = x - y if x > y else y - x - TAU
        return behind <= 0 or behind * behind <= pair[i][j]

    stack: list[tuple[tuple[int, ...], tuple[float, ...]]] = [((0,), (0.0,))]
    while stack:
        ways, lifts = stack.pop()
        if len(ways) == k:
            cost = _rising_cost(ways, lifts, weight)
            yield (ways, tuple(first + x for x in lifts), cost) if cost <= total else None
            continue
        yield None
        rest = [i for i in range(1, k) if i not in ways]
        for i in reversed(rest):
            for x in choices[i]:
                if not all(may_follow(a, b, i, x) for a, b in zip(ways, lifts, strict=True)):
                    continue
                if not all(any(may_follow(i, x, j, y) for y in choices[j]) for j in rest if j != i):
                    continue
                stack.append(((*ways, i), (*lifts, x)))


def _rising_cost(ways: Sequence[int], lifts: Sequence[float], weight: Sequence[float]) -> float:
    """Return half the squared misses of the nearest headings that rise around the place: the largest over where one begins.

    Beginning somewhere leaves one condition out, so each value is at most the true one.
    """
    if all(a <= b for a, b in pairwise(lifts)) and lifts[-1] <= lifts[0] + TAU:
        return 0.0
    cost = 0.0
    w = [weight[i] for i in ways]
    for r in range(len(ways)):
        line = [*lifts[r:], *(x + TAU for x in lifts[:r])]
        cost = max(cost, _pooled(line, [*w[r:], *w[:r]])[1])
    return cost


def _pooled(values: Sequence[float], weights: Sequence[float]) -> tuple[list[float], float]:
    """Return the nearest values that do not fall, by pooling adjacent violators, and half their weighted squared misses."""
    blocks: list[tuple[float, float, float, int]] = []
    for value, weight in zip(values, weights, strict=True):
        mean, heavy, miss, size = value, weight, 0.0, 1
        while blocks and blocks[-1][0] > mean:
            other, load, before, more = blocks.pop()
            both = heavy + load
            miss += before + heavy * load / both * (mean - other) ** 2
            mean, heavy, size = (mean * heavy + other * load) / both, both, size + more
        blocks.append((mean, heavy, miss, size))
    return [mean for mean, _, _, size in blocks for _ in range(size)], sum(block[2] for block in blocks) / 2


def _by_lists(lifts: Sequence[float], variance: Sequence[float], directions: Directions) -> tuple[float, tuple[float, ...]]:
    """Return the least half squared miss of ways, in order, from listed exits, and the headings that legs and lists give."""
    best_miss, best = inf, tuple(lifts)
    for exits in directions.lifts:
        base = TAU * round((lifts[0] - float(exits[0])) / TAU)
        line = [float(x) + base + whole for whole in (-TAU, 0.0, TAU, 2 * TAU) for x in exits]
        for begin in range(2 * directions.count):
            miss, chosen = _matched(lifts, variance, line[begin : begin + directions.count], directions.variance)
            if miss < best_miss:
                best_miss = miss
                best = tuple(
                    (x * directions.variance + s * v) / (directions.variance + v)
                    for x, v, s in zip(lifts, variance, chosen, strict=True)
                )
    return best_miss, best


def _matched(
    lifts: Sequence[float], variance: Sequence[float], exits: Sequence[float], own: float
) -> tuple[float, list[float]]:
    """Match ways in order to some of the exits in order, the first to the first: least half squared miss, exits chosen."""
    k, count = len(lifts), len(exits)
    first = (lifts[0] - exits[0]) ** 2 / (2 * (variance[0] + own))
    if first > 2 * threshold(k):
        return inf, []
    if k == count:
        return sum((x - s) ** 2 / (2 * (v + own)) for x, v, s in zip(lifts, variance, exits, strict=True)), list(exits)
    cost = [first] + [inf] * (count - 1)  # least cost of the ways so far, the last of them matched to this exit
    came: list[list[int]] = []
    for i in range(1, k):
        least, at, after, origin = inf, -1, [inf] * count, [-1] * count
        for j in range(1, count):
            if cost[j - 1] < least:
                least, at = cost[j - 1], j - 1
            after[j] = least + (lifts[i] - exits[j]) ** 2 / (2 * (variance[i] + own))
            origin[j] = at
        came.append(origin)
        cost = after
    miss = min(cost)
    if miss == inf:
        return inf, []
    j = cost.index(miss)
    chosen = [j]
    for origin in reversed(came):
        j = origin[j]
        chosen.append(j)
    return miss, [exits[j] for j in reversed(chosen)]


def fitted(order: StarOrder, variance: Sequence[float]) -> tuple[float, ...]:
    """Return headings of a finished map: the likeliest that rise along the order and lie `THINNEST` apart, on a line."""
    k = len(order.ways)
    corners = [b - a for a, b in zip(order.best, (*order.best[1:], order.best[0] + TAU), strict=True)]
    start = (corners.index(max(corners)) + 1) % k  # the widest corner comes last
    line = [*order.best[start:], *(x + TAU for x in order.best[:start])]
    weights = [1 / variance[i] for i in (*order.ways[start:], *order.ways[:start])]
    rising, _ = _pooled([x - THINNEST * i for i, x in enumerate(line)], weights)
    found = [x + THINNEST * i for i, x in enumerate(rising)]
    return (*(x - TAU for x in found[k - start :]), *found[: k - start]) if start else tuple(found)
