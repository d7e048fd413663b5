"""Plain references for maps from headings that err: everything tried, nothing pruned."""

from __future__ import annotations

from itertools import permutations, product
from math import pi
from typing import TYPE_CHECKING

from ninefold.mapping.doubt.noise import LOG_ODDS, threshold

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from noisy import Seen

    from ninefold.mapping.doubt.reading import Reading

TAU = 2 * pi


def rising_cost(lifts: Sequence[float], variance: Sequence[float]) -> float:
    """Half the squared misses of the nearest headings that rise around a place, by trying which neighbours coincide."""
    k = len(lifts)
    best = float("inf")
    for tied in product((False, True), repeat=k):  # whether each way coincides with the next, the last with the first
        if all(tied):
            continue
        start = tied.index(False) + 1
        around = [(start + i) % k for i in range(k)]
        line = [lifts[i] + (TAU if start + n >= k else 0) for n, i in enumerate(around)]
        fit: list[float] = []
        block: list[int] = []
        for n, i in enumerate(around):
            block.append(n)
            if not tied[i] or n == k - 1:
                heavy = sum(1 / variance[around[m]] for m in block)
                mean = sum(line[m] / variance[around[m]] for m in block) / heavy
                fit += [mean] * len(block)
                block = []
        rises = all(a <= b + 1e-12 for a, b in zip(fit, [*fit[1:], fit[0] + TAU], strict=True))
        if rises:
            best = min(best, sum((a - b) ** 2 / (2 * variance[i]) for a, b, i in zip(line, fit, around, strict=True)))
    return best


def orders_by_legs(heading: Sequence[float], variance: Sequence[float]) -> Iterator[tuple[tuple[int, ...], tuple[int, ...]]]:
    """Every lifted order that legs leave open: ways from 0 on, and how many turns each is lifted."""
    k = len(heading)
    base = [heading[0] + (yaw - heading[0]) % TAU for yaw in heading]
    for rest in permutations(range(1, k)):
        ways = (0, *rest)
        for turns in product((-1, 0, 1), repeat=k - 1):
            whole = dict(zip(rest, turns, strict=True)) | {0: 0}
            lifts = [base[i] + TAU * whole[i] for i in ways]
            spread = [variance[i] for i in ways]
            pairs = all(
                max(0.0, lifts[a] - lifts[b], lifts[b] - lifts[a] - TAU) ** 2 <= 2 * LOG_ODDS * (spread[a] + spread[b])
                for a in range(k)
                for b in range(a + 1, k)
            )
            if pairs and (k == 1 or rising_cost(lifts, spread) <= threshold(k - 1)):
                yield ways, tuple(whole[i] for i in ways)


def legal_maps(reading: Reading, most: int = 20_000) -> set[Seen] | None:
    """Every map of a reading: all orders of all places and all net rotations together, each judged as a whole map."""
    places = sorted(reading.orders)
    number = 1
    for each in [*reading.orders.values(), *[way.turns for way in reading.ways]]:
        number *= len(each)
    if number > most:
        return None
    ways = [way.legs.tolist() for way in reading.ways]
    found = set()
    for orders in product(*(reading.orders[place] for place in places)):
        for turns in product(*(way.turns for way in reading.ways)):
            outer = plain_legality(reading, dict(zip(places, orders, strict=True)), turns)
            if outer is None:
                continue
            label = [(min(legs), side) for legs in ways for side in (0, 1)]
            rings = []
            for place, order in zip(places, orders, strict=True):
                ring = [label[reading.darts[place][i]] for i in order.ways]
                low = min(range(len(ring)), key=lambda i, ring=ring: repr(ring[i]))
                rings.append((*ring[low:], *ring[:low]))
            shares = frozenset(frozenset(map(int, legs)) for legs in ways)
            found.add((shares, frozenset(rings), frozenset(label[d] for d in outer)))
    return found


def plain_legality(reading: Reading, orders: dict[int, object], turns: Sequence[float]) -> frozenset[int] | None:
    """The darts on the outer face, or None: Euler by counting orbits, every face turning once, one of them backwards."""
    n = 2 * len(reading.ways)
    before, corner = [0] * n, [0.0] * n
    for place, order in orders.items():
        darts = [reading.darts[place][i] for i in order.ways]  # type: ignore[attr-defined]
        for i, dart in enumerate(darts):
            before[darts[(i + 1) % len(darts)]] = dart
            corner[dart] = order.corners[i]  # type: ignore[attr-defined]
    left = set(range(n))
    faces = []
    while left:
        dart = min(left)
        ring, total = [], 0.0
        while dart in left:
            left.remove(dart)
            ring.append(dart)
            total += turns[dart >> 1] * (-1 if dart & 1 else 1)
            dart = before[dart ^ 1]
            total += pi - corner[dart]
        faces.append((round(total / TAU), frozenset(ring)))
    if len(orders) - len(reading.ways) + len(faces) != 2:
        return None
    if sorted(turn for turn, _ in faces) != [-1] + [1] * (len(faces) - 1):
        return None
    return next(ring for turn, ring in faces if turn == -1)
