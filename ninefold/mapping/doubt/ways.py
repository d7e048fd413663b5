"""Which legs went the same way: legs between the same two places, gathered by their headings at both ends.

Legs of one way are never parted: two of them differ by more than the gate of `noise.LOG_ODDS` with a chance of 1e-9. Legs of
two ways may well be gathered together, where two ways join the same places in nearly the same directions. The number of
exits listed at both ends says whether there is room for another way; where there is, every parting that the scatter of the
legs allows is a reading of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from ..heading import TAU, wrap, wrap_all
from .noise import LOG_ODDS, threshold

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from .evidence import Evidence

__all__ = ["Bundle", "Way", "bundles", "partings", "way_of"]

MOST_PARTINGS = 512
"""Readings of one bundle as several ways up to which they are listed."""


_SAME = 1e-9
"""Radians within which a heading is one that was read, whole turns apart."""


@dataclass(frozen=True, slots=True)
class Bundle:
    """Legs that may have gone the same way, seen along the way in the direction of the first of them.

    Attributes
    ----------
    tail, head
        The places it leads from and to.
    legs
        (n,) int64, ascending.
    out, back, turn, felt
        (n,) float64 radians, as in `Evidence` but for legs that went the other way turned round; `out` and `back` are within
        half a turn of those of the first leg.
    weight
        (n,) float64, 1 or, for a leg read from one sample, 1/2: the share of an error that both ends have in common.
    """

    tail: int
    head: int
    legs: NDArray[np.int64]
    out: NDArray[np.float64]
    back: NDArray[np.float64]
    turn: NDArray[np.float64]
    felt: NDArray[np.float64]
    weight: NDArray[np.float64]

    def part(self, which: NDArray[np.bool_] | NDArray[np.int64]) -> Bundle:
        """Return some of the legs as a bundle."""
        out, back = self.out[which], self.back[which]
        return Bundle(
            self.tail,
            self.head,
            self.legs[which],
            out[0] + wrap_all(out - out[0]),  # ways far apart may lie on either side of half a turn from the first leg
            back[0] + wrap_all(back - back[0]),
            self.turn[which],
            self.felt[which],
            self.weight[which],
        )

    def along_first(self, evidence: Evidence) -> Bundle:
        """Return the bundle seen in the direction of its own first leg; a part may be seen in that of another way's."""
        first = int(self.legs[0])
        if self.tail == self.head:
            along = abs(wrap(float(self.out[0] - evidence.out[first]))) < _SAME
            along &= abs(float(self.turn[0] - evidence.turn[first])) < _SAME
        else:
            along = int(evidence.at[first]) == self.tail
        if along:
            return self
        return Bundle(self.head, self.tail, self.legs, self.back, self.out, -self.turn, -self.felt, self.weight)

    def scatter(self, variance: NDArray[np.float64]) -> float:
        """Return half the squared misses of the legs from their mean, in standard deviations of one reading."""
        total = 0.0
        for end, place in ((self.out, self.tail), (self.back, self.head)):
            total += float((self.weight * (end - end.mean()) ** 2).sum() / (2 * variance[place]))
        return total


@dataclass(frozen=True, slots=True)
class Way:
    """An edge of the map: one or more legs that went the same way.

    Attributes
    ----------
    tail, head
        Places, in the direction of the first leg.
    legs
        (n,) int64, ascending.
    out, back
        Mean headings on leaving either end, radians.
    var_out, var_back
        Their variances.
    turns
        Net rotations the edge may have, radians: one, or several a whole turn apart where every leg was sampled too coarsely
        for its noise. Each agrees with `out` and `back`.
    read, felt
        Net rotation as the first leg read it; and the mean of what all legs read, whatever bias was taken out of headings.
    """

    tail: int
    head: int
    legs: NDArray[np.int64]
    out: float
    back: float
    var_out: float
    var_back: float
    turns: tuple[float, ...]
    read: float
    felt: float


def bundles(evidence: Evidence, variance: NDArray[np.float64]) -> list[Bundle]:
    """Gather the legs of a walk.

    Parameters
    ----------
    variance
        (V,) of a single reading at every place, radians squared, what its readings share included.

    Returns
    -------
    list
        In the order of their first legs.

    Notes
    -----
    Complexity O(L) for ways passed a bounded number of times, quadratic in the passes of one pair of places at worst.
    """
    start, end = evidence.at[:-1], evidence.at[1:]
    pairs: dict[tuple[int, int], list[int]] = {}
    for leg, (p, q) in enumerate(zip(start.tolist(), end.tolist(), strict=True)):
        pairs.setdefault((p, q) if p <= q else (q, p), []).append(leg)
    found: list[Bundle] = []
    for legs in pairs.values():
        found += _gathered(evidence, np.array(legs, np.int64), variance)
    return sorted(found, key=lambda bundle: int(bundle.legs[0]))


def _gathered(evidence: Evidence, legs: NDArray[np.int64], variance: NDArray[np.float64]) -> Iterator[Bundle]:
    """Yield the bundles among the legs between two places: those near each other, and near those, and so on."""
    tail, head = int(evidence.at[legs[0]]), int(evidence.at[legs[0] + 1])
    turned = evidence.at[legs] != tail
    out = np.where(turned, evidence.back[legs], evidence.out[legs])
    back = np.where(turned, evidence.out[legs], evidence.back[legs])
    turn = np.where(turned, -evidence.turn[legs], evidence.turn[legs])
    felt = np.where(turned, -evidence.felt[legs], evidence.felt[legs])
    weight = np.where(evidence.single[legs], 0.5, 1.0)
    name = np.array([evidence.edges[leg] or "" for leg in legs.tolist()], dtype=object)
    left = np.ones(legs.size, np.bool_)
    while left.any():
        first = int(left.argmax())
        left[first] = False
        members, next_one = [first], 0
        while next_one < len(members):
            i = members[next_one]
            next_one += 1
            others = np.flatnonzero(left)
            if not others.size:
                break
            near = _near(out[others] - out[i], back[others] - back[i], tail, head, variance, weight[others], weight[i])
            if tail == head:  # a loop has no first end: it may have been walked the other way round
                around = _near(back[others] - out[i], out[others] - back[i], tail, head, variance, weight[others], weight[i])
                other_way = around & (~near | (np.abs(turn[others] - turn[i]) > np.abs(turn[others] + turn[i])))
                swap = others[other_way]
                out[swap], back[swap], turn[swap], felt[swap] = back[swap], out[swap], -turn[swap], -felt[swap]
                near |= around
            near |= (name[others] == name[i]) & (name[i] != "")
            members += others[near].tolist()
            left[others[near]] = False
        these = np.sort(np.array(members, np.int64))
        yield Bundle(
            tail,
            head,
            legs[these],
            out[these[0]] + wrap_all(out[these] - out[these[0]]),
            back[these[0]] + wrap_all(back[these] - back[these[0]]),
            turn[these],
            felt[these],
            weight[these],
        )


def _near(
    out: NDArray[np.float64],
    back: NDArray[np.float64],
    tail: int,
    head: int,
    variance: NDArray[np.float64],
    weight: NDArray[np.float64],
    own: float,
) -> NDArray[np.bool_]:
    """Whether differences of headings at both ends are those of one way, but for a chance of 1e-9."""
    miss = wrap_all(out) ** 2 / (4 * variance[tail]) + wrap_all(back) ** 2 / (4 * variance[head])
    return np.asarray(miss * np.minimum(weight, own) <= LOG_ODDS)


def partings(
    bundle: Bundle, most: int, variance: NDArray[np.float64], names: tuple[str | None, ...]
) -> list[tuple[Bundle, ...]] | None:
    """Return the readings of a bundle as one way or several, those that its scatter and the names in the log allow.

    Parameters
    ----------
    most
        Number of ways it can be at most.
    names
        Of all legs: the name that the log gives to its way, or None. Legs of one name went one way, of two names two.

    Returns
    -------
    list or None
        None if there are more than `MOST_PARTINGS`; empty if every one of them scatters more than is declared.

    Notes
    -----
    Complexity O(partings tried times legs).
    """
    called = [names[leg] for leg in bundle.legs.tolist()]
    found: list[tuple[Bundle, ...]] = []
    n, most = len(called), min(most, len(called))
    if most == 1 or n == 1:
        fits = len({name for name in called if name is not None}) < 2
        free = 2 * (n - 1)
        return [(bundle,)] if fits and (not free or bundle.scatter(variance) <= threshold(free)) else []
    stack: list[list[int]] = [[0]]
    tried = 0
    while stack:
        group = stack.pop()
        tried += 1
        if tried > 8 * MOST_PARTINGS:
            return None
        if len(group) == n:
            labels = np.array(group)
            parts = tuple(bundle.part(labels == k) for k in range(max(group) + 1))
            free = 2 * (n - len(parts))
            if not free or sum(part.scatter(variance) for part in parts) <= threshold(free):
                found.append(parts)
                if len(found) > MOST_PARTINGS:
                    return None
            continue
        i = len(group)
        for k in range(min(max(group) + 2, most) - 1, -1, -1):
            alike = [called[j] for j in range(i) if group[j] == k and called[j] is not None]
            elsewhere = called[i] is not None and any(called[j] == called[i] and group[j] != k for j in range(i))
            if elsewhere or (called[i] is not None and alike and alike[0] != called[i]):
                continue
            trial = [*group, k]
            labels = np.array(trial)
            members = np.flatnonzero(labels == k)
            if len(members) > 1 and not _all_near(bundle, members[:-1], i, variance):
                continue
            parts = tuple(bundle.part(np.flatnonzero(labels == one)) for one in range(max(trial) + 1))
            free = 2 * (len(trial) - len(parts))
            if not free or sum(part.scatter(variance) for part in parts) <= threshold(free):
                stack.append(trial)
    return found


def _all_near(bundle: Bundle, members: NDArray[np.int64], leg: int, variance: NDArray[np.float64]) -> bool:
    """Whether a leg of a bundle is near each of some others, as two legs of one way are but for a chance of 1e-9."""
    out, back = bundle.out[members] - bundle.out[leg], bundle.back[members] - bundle.back[leg]
    own = float(bundle.weight[leg])
    return bool(_near(out, back, bundle.tail, bundle.head, variance, bundle.weight[members], own).all())


def way_of(
    bundle: Bundle,
    evidence: Evidence,
    variance: NDArray[np.float64],
    floor: NDArray[np.float64],
    coarsest: float,
) -> Way:
    """Average the legs of one way.

    Parameters
    ----------
    variance, floor
        (V,) radians squared: what the mean of n readings has divided by n, and what it has in any case.
    coarsest
        Rotation between two samples up to which noise cannot have turned its sense, radians.
    """
    bundle = bundle.along_first(evidence)
    n = len(bundle.legs)
    out, back = float(bundle.out.mean()), float(bundle.back.mean())
    whole = np.rint((bundle.back - pi - bundle.out - bundle.turn) / TAU).astype(np.int64)
    sure = evidence.sharpest[bundle.legs] <= coarsest
    if sure.any():
        kept = sorted(set(whole[sure].tolist()))
    else:
        kept = sorted({k + more for k in whole.tolist() for more in (-1, 0, 1)}, key=lambda k: abs(k - int(whole[0])))
    return Way(
        bundle.tail,
        bundle.head,
        bundle.legs,
        out,
        back,
        float(variance[bundle.tail]) / n + float(floor[bundle.tail]),
        float(variance[bundle.head]) / n + float(floor[bundle.head]),
        tuple(back - pi - out - TAU * k for k in kept),
        float(bundle.turn[0]),
        float(bundle.felt.mean()),
    )
