"""How likely a place shows the exits that were seen: all ways are added up in which the one can be the other.

A robot lists exits as it sees them, each heading with an error. Which exit of the list is which dart of the place is not
known: two exits close together may come in the wrong order. So the likelihood of a place is the sum, over all one-to-one
assignments of the listed exits to its darts, of the product of the errors' densities: a permanent. It is added up over
sets of darts, for all places of one degree at once, and sets that no plausible error leads to are never looked at.

Without a compass all headings seen at a place share one unknown offset, over which the likelihood is integrated. For few
exits this is a closed form for each assignment; for more, a sum over offsets so close together that the error is below
1e-8.

Errors are independent, Gaussian and small against a turn; one beyond `GATE` standard deviations counts as impossible.
Weights here are natural logarithms, up to a constant that is the same for all places.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import permutations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._wording import counted
from ninefold.errors import TooLarge

from ..heading import TAU, wrap_all

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float64]

__all__ = ["GATE", "Look", "Noise", "weights"]

GATE = 6.0
"""Standard deviations beyond which an error counts as impossible: once in 500 million headings."""

DIRECT_UP_TO = 6
"""Exits up to which every assignment is looked at by itself when there is no compass."""

_MOST_SETS = 20_000
_MOST_NUMBERS = 4_000_000
_LOWEST = -np.inf


class Noise(NamedTuple):
    """What errors are expected: the standard deviation of a heading, radians, and how often an exit is missed or made up."""

    sigma: float
    missed: float = 0.0
    extra: float = 0.0


class Look(NamedTuple):
    """What was seen at a place.

    Attributes
    ----------
    exits
        (m,) yaw in radians, ascending, or None if they were not looked for.
    back
        Yaw of the way back, measured by itself, or None.
    back_exit
        Position in `exits` of the way back, if known.
    """

    exits: Floats | None = None
    back: float | None = None
    back_exit: int | None = None

    @property
    def tells_the_way_back(self) -> bool:
        """Whether it says along which dart the robot came."""
        return self.back is not None or self.back_exit is not None


class Leaving(NamedTuple):
    """How the robot left: along a heading measured by itself, or by a position in the exits seen."""

    yaw: float | None = None
    exit: int | None = None


def weights(
    yaw: Floats,
    back: NDArray[np.int64] | None,
    look: Look,
    noise: Noise,
    *,
    compass: bool,
    leaving: tuple[float | None, int | None] = (None, None),
) -> Floats:
    """Return the log weight of places of one degree, given what was seen there.

    Parameters
    ----------
    yaw
        (n, k) yaw of the exits of each place, ascending.
    back
        (n,) which of them is the way back; None where it is not known, and then `look` must not tell it either.
    leaving
        The heading on leaving, or the position in ``look.exits`` of the way taken: then (n, k) weights are returned, one
        for each dart that the robot can have left by.

    Raises
    ------
    TooLarge
        For so many exits so close together that the assignments cannot be counted.

    Notes
    -----
    Complexity O(n k 2^k) at worst, less where errors are small against the angles between exits.
    """
    left = Leaving(*leaving)
    n, k = yaw.shape
    if n == 0 or not _fits(k, look, noise):
        return np.full((n, k) if left != Leaving() else n, _LOWEST)
    if compass:
        return _with_compass(yaw, back, look, left, noise)
    if look.exits is None or not k:
        return _two_headings(yaw, back, look, left, noise)
    integrated = _each_assignment if k <= DIRECT_UP_TO else _over_offsets
    at_once = max(1, _MOST_NUMBERS // (len(_orders(k, None)) if k <= DIRECT_UP_TO else 1))
    parts = [slice(i, i + at_once) for i in range(0, n, at_once)]
    found = [integrated(yaw[s], look.exits, None if back is None else back[s], look, left, noise) for s in parts]
    return found[0] if len(found) == 1 else np.concatenate(found)


def _fits(k: int, look: Look, noise: Noise) -> bool:
    """Whether a place of k exits can be seen as so many."""
    if look.exits is None:
        return True
    m = look.exits.size
    if m < k and not noise.missed:
        return False
    return m <= k or (m == k + 1 and noise.extra > 0)


def _log_density(error: Floats, sigma: float) -> Floats:
    """Return the log density of errors, wrapped here, up to a constant."""
    size = np.abs(wrap_all(error)) / sigma
    return np.where(size <= GATE, -0.5 * size * size, _LOWEST)


# -- with a compass --------------------------------------------------------------------------------------------------------


def _with_compass(yaw: Floats, back: NDArray[np.int64] | None, look: Look, left: Leaving, noise: Noise) -> Floats:
    total = np.zeros(len(yaw))
    if look.back is not None:
        total += _log_density(look.back - yaw[np.arange(len(yaw)), back], noise.sigma)
    if look.exits is not None:
        pin = None if look.back_exit is None or back is None else (look.back_exit, back)
        found = _assignments(yaw, look.exits, noise, pin=pin, last=left.exit)
        total = found + (total if found.ndim == 1 else total[:, None])
    if left.yaw is not None:
        return total[:, None] + _log_density(left.yaw - yaw, noise.sigma)
    return total


def _assignments(
    yaw: Floats, exits: Floats, noise: Noise, *, pin: tuple[int, NDArray[np.int64]] | None, last: int | None
) -> Floats:
    """Return the log of the sum over assignments of exits to darts, (n,); or (n, k), by the dart that exit `last` is.

    Parameters
    ----------
    pin
        An exit, and for each place the one dart it is known to be.
    """
    n, k = yaw.shape
    m = exits.size
    log = _log_density(exits[:, None, None] - yaw.T, noise.sigma)  # exit, dart, place
    if noise.extra:  # a dart that is none: an exit there has any direction
        odds = noise.extra / (1 - noise.extra) * noise.sigma / TAU**0.5
        log = np.concatenate([log, np.full((m, 1, n), np.log(odds))], axis=1)
    if pin is not None:
        log[pin[0]] = np.where(np.arange(log.shape[1])[:, None] == pin[1], log[pin[0]], _LOWEST)
    if not m:
        return np.full(n, k * np.log(noise.missed) if k else 0.0)
    best = log.max(axis=1)
    best[best == _LOWEST] = 0.0
    weight = np.exp(log - best[:, None])
    order = [i for i in range(m) if i != last] + ([] if last is None else [last])
    possible = [np.flatnonzero(weight[i].any(axis=1)).tolist() for i in range(m)]
    sums: dict[int, Floats] = {0: np.ones(n)}
    for i in order if last is None else order[:-1]:
        sums = _one_exit_more(sums, weight[i], possible[i], k)
    if last is None:
        total = sum((value * _share_seen(used, k, noise) for used, value in sums.items()), np.zeros(n))
    else:
        total = np.zeros((n, k))
        for used, value in sums.items():
            for j in possible[last]:
                if j < k and not used >> j & 1:  # nobody leaves by an exit that is none
                    total[:, j] += value * weight[last, j] * _share_seen(used | 1 << j, k, noise)
    with np.errstate(divide="ignore"):
        scale = best.sum(axis=0)
        return np.asarray(np.log(total) + (scale if last is None else scale[:, None]))


def _one_exit_more(sums: dict[int, Floats], weight: Floats, possible: list[int], k: int) -> dict[int, Floats]:
    """Return the sums by set of darts taken, once one exit more has been given each of its possible darts."""
    after: dict[int, Floats] = {}
    for used, value in sums.items():
        for j in possible:
            taken = used | 1 << j
            if taken == used:
                continue
            term = value * weight[j]
            if taken in after:
                after[taken] += term
            else:
                after[taken] = term
    if len(after) > _MOST_SETS:
        raise TooLarge(
            f"{counted(k, 'exit')} of one place lie so close together that which is which has too many answers to add up; "
            "leave its exits out, or give a smaller sigma if headings are that good"
        )
    return after


def _share_seen(used: int, k: int, noise: Noise) -> float:
    """How likely exactly these of k darts are seen."""
    if not noise.missed:
        return 1.0 if (used & (1 << k) - 1).bit_count() == k else 0.0
    seen = (used & (1 << k) - 1).bit_count()
    return float(noise.missed ** (k - seen) * (1 - noise.missed) ** seen)


# -- without a compass -----------------------------------------------------------------------------------------------------


def _two_headings(yaw: Floats, back: NDArray[np.int64] | None, look: Look, left: Leaving, noise: Noise) -> Floats:
    """Weigh by the angle between the way back and the way out, which is all that headings alone tell."""
    n, k = yaw.shape
    if left.yaw is None:
        return np.zeros(n)
    if look.back is None or back is None:
        return np.zeros((n, k))
    turned = (left.yaw - look.back) - (yaw - yaw[np.arange(n), back][:, None])
    size = np.abs(wrap_all(turned)) / noise.sigma
    return np.where(size <= 2 * GATE, -0.25 * size * size, _LOWEST)


@lru_cache(maxsize=32)
def _orders(k: int, fixed: int | None) -> NDArray[np.int64]:
    """Return all assignments of k exits to k darts, (N, k); with `fixed`, those that give this exit dart 0."""
    found = np.array(list(permutations(range(k))), np.int64).reshape(-1, k)
    return found if fixed is None else found[found[:, fixed] == 0]


def _each_assignment(
    yaw: Floats, exits: Floats, back: NDArray[np.int64] | None, look: Look, left: Leaving, noise: Noise
) -> Floats:
    """Integrate over the offset in closed form, for each assignment by itself.

    With errors d_i against any one reference, M in number, the integral is exp(-(sum d^2 - (sum d)^2 / M) / (2 sigma^2)).
    """
    n, k = yaw.shape
    rows = np.arange(n)
    pinned = look.back_exit is not None and back is not None
    start = back if pinned and back is not None else np.zeros(n, np.int64)
    around = (start[:, None] + np.arange(k)) % k
    turned = yaw[rows[:, None], around]  # the way back first, where it is known which exit it is
    order = _orders(k, look.back_exit if pinned else None)
    error = exits[None, :, None] - turned[:, None, :]  # place, exit, dart
    if look.back is not None and back is not None:
        zero = (look.back - yaw[rows, back])[:, None]
        sums = _Spread(np.zeros((n, len(order))))
    else:
        zero = error[:, 0, order[:, 0]]
        sums = _Spread(np.zeros((n, len(order))), seen=0)
    for i in range(k):
        sums.add(error[:, i, order[:, i]] - zero)
    if left.yaw is not None:
        by_dart = [sums.copy().add(left.yaw - yaw[:, j : j + 1] - zero).log_weight(noise.sigma) for j in range(k)]
        return np.stack([_log_sum(w) for w in by_dart], axis=1)
    weight = sums.log_weight(noise.sigma)
    if left.exit is None:
        return _log_sum(weight)
    out = np.full((n, k), _LOWEST)
    for j in range(k):
        chosen = np.flatnonzero(order[:, left.exit] == j)
        if chosen.size:
            out[rows, (start + j) % k] = _log_sum(weight[:, chosen])
    return out


class _Spread:
    """Adds up errors against a reference that is one of them, to weigh how far they lie apart."""

    def __init__(self, zero: Floats, *, seen: int = 1) -> None:
        self.count = seen
        self.total, self.squares, self.low, self.high = zero.copy(), zero.copy(), zero.copy(), zero.copy()

    def add(self, error: Floats) -> _Spread:
        """Take one error more."""
        wrapped = wrap_all(error)
        self.count += 1
        self.total = self.total + wrapped
        self.squares = self.squares + wrapped * wrapped
        self.low = np.minimum(self.low, wrapped)
        self.high = np.maximum(self.high, wrapped)
        return self

    def copy(self) -> _Spread:
        """Return the same sums, to go on from."""
        other = _Spread(self.total, seen=self.count)
        other.squares, other.low, other.high = self.squares, self.low, self.high
        return other

    def log_weight(self, sigma: float) -> Floats:
        """Return the log weight of the errors once the reference is integrated over."""
        mean = self.total / self.count
        weight = (self.total * mean - self.squares) / (2 * sigma * sigma)
        return np.where(self.high - self.low <= 2 * GATE * sigma, weight, _LOWEST)


def _over_offsets(
    yaw: Floats, exits: Floats, back: NDArray[np.int64] | None, look: Look, left: Leaving, noise: Noise
) -> Floats:
    """Integrate over the offset by a sum over close offsets, around those that one of the headings tells."""
    n, k = yaw.shape
    rows = np.arange(n)
    if look.back is not None and back is not None:
        return _around(yaw, look.back - yaw[rows, back], back, look, left, noise)
    if look.back_exit is not None and back is not None:
        return _around(yaw, exits[look.back_exit] - yaw[rows, back], back, look, left, noise)
    first = look._replace(back_exit=0)
    parts = [_around(yaw, exits[0] - yaw[:, j], np.full(n, j, np.int64), first, left, noise) for j in range(k)]
    return _log_sum(np.stack(parts, axis=-1))


def _around(yaw: Floats, offset: Floats, back: NDArray[np.int64], look: Look, left: Leaving, noise: Noise) -> Floats:
    """Integrate over the offsets within the gate around one for each place."""
    count = yaw.shape[1] + (look.back is not None) + (left.yaw is not None)
    step = noise.sigma / count**0.5  # the integrand is a Gaussian of this width, summed to 1e-8 at this spacing
    most = int(np.ceil(GATE * count**0.5))
    offsets = np.arange(-most, most + 1) * step
    at_once = max(1, _MOST_NUMBERS // (offsets.size * yaw.shape[1] * 8))
    parts = []
    for i in range(0, len(yaw), at_once):
        some = slice(i, i + at_once)
        moved = yaw[some, None, :] + offset[some, None, None] + offsets[:, None]
        flat = moved.reshape(-1, yaw.shape[1])
        found = _with_compass(flat, np.repeat(back[some], offsets.size), look, left, noise)
        parts.append(_log_sum(np.moveaxis(found.reshape(moved.shape[0], offsets.size, *found.shape[1:]), 1, -1)))
    return np.concatenate(parts)


def _log_sum(log: Floats) -> Floats:
    """Return the log of the sum of what these are the logs of, over the last axis."""
    top = log.max(axis=-1)
    safe = np.where(top == _LOWEST, 0.0, top)
    with np.errstate(divide="ignore"):
        return np.asarray(np.log(np.exp(log - safe[..., None]).sum(axis=-1)) + safe)
