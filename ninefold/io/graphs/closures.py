"""Which loop closures of a pose graph cannot be right.

A pose graph tells of places neither exits nor names. So what `ninefold.mapping.claims` uses of a walk is not there: two
passes by one place need not look alike, and the path may cross itself where nobody noticed. What a pose graph has are
measurements, each with a declared error. A **loop** of odometry and one or two closures must come back to where it began,
and face as it did; put one after another, its measurements miss that by an amount whose covariance follows from the
declared ones. A miss that is less likely than `ODDS` convicts: a closure by itself where the rest of its loop is odometry,
two closures together where the loop has both. As few closures are rejected as can be, so that no convicted one and no two
convicted ones are left (MaxSAT).

Assumed: errors are independent, Gaussian, and no larger than the information matrices say. Loops over which the heading is
lost (standard deviation above `LOST`) say nothing. Nothing else is assumed of the place; where a robot keeps to streets or
corridors and lists their exits, a walk says more.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import degrees, pi
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._wording import counted
from ninefold.encodings.choice import cheapest_choice, quick_choice

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .g2o import PoseGraph

    Floats = NDArray[np.float64]

__all__ = ["LOST", "ODDS", "JudgedClosures", "RejectedClosure", "judge_closures", "judge_of"]

ODDS = 1e-9
"""Misses less likely than this convict."""

BUDGET = 60.0
"""Seconds for choosing the fewest, if nothing else is asked for."""

LOST = 0.5
"""Standard deviation of the heading around a loop, radians, beyond which first-order error propagation means nothing."""


SINGULAR = 1e-12
"""Least eigenvalue of the correlation of a miss below which rounding says more than the measurements."""


@dataclass(frozen=True, slots=True)
class RejectedClosure:
    """A closure that is rejected.

    Attributes
    ----------
    edge
        Its number in the graph.
    a, b
        The numbers of its poses.
    score
        What rejecting it costs: 1, since a graph tells no score.
    reason
        In words.
    against
        The other closure of the loop that shows it, as numbers of poses; None for a loop of odometry alone.
    """

    edge: int
    a: int
    b: int
    score: float
    reason: str
    against: tuple[int, int] | None


@dataclass(frozen=True, slots=True, eq=False)
class JudgedClosures:
    """The closures of a graph, judged; made by `judge_closures`.

    Attributes
    ----------
    graph
        The graph.
    rejected
        Closures rejected, in the order of the file.
    silent
        Closures that no loop says anything about.
    exact
        Whether no fewer could be rejected. False where the budget was spent.
    """

    graph: PoseGraph = field(repr=False)
    rejected: tuple[RejectedClosure, ...]
    silent: int
    exact: bool


class _Frames(NamedTuple):
    """Motions in the plane: (n,) complex shift, metres, and (n,) rotation, radians."""

    shift: NDArray[np.complex128]
    turn: Floats

    def at(self, which: NDArray[np.int64]) -> _Frames:
        return _Frames(self.shift[which], self.turn[which])


class _Closures(NamedTuple):
    """Closures from pose `a` to pose `b`: (C,) each, measurement, covariance (C, 3, 3)."""

    a: NDArray[np.int64]
    b: NDArray[np.int64]
    closure: _Frames
    covariance: Floats


class _Loops(NamedTuple):
    """By how much loops miss, (n, 3) along x, y and in yaw; its covariance, (n, 3, 3); the squared ratio of both, (n,)."""

    miss: Floats
    covariance: Floats
    ratio: Floats


def judge_closures(graph: PoseGraph, *, headings_only: bool = False, budget: float | None = None) -> JudgedClosures:
    """Judge the loop closures of a pose graph.

    Parameters
    ----------
    headings_only
        Whether loops are judged by headings alone, for graphs whose lengths are not to be trusted.
    budget
        Seconds for choosing as few to reject as can be, 60 if left out. After that some are chosen that need not be the
        fewest; so it is where errors are far larger than declared, and closures clash at random.

    Notes
    -----
    Complexity O(V + C squared) for C closures, array code, and the choice of the fewest to reject, exponential at worst.
    """
    chosen = graph.closures
    limit = _limit(1 if headings_only else 3)
    judged = judge_of(graph, headings_only=headings_only)
    every = judged.alone()
    singles = every.ratio > limit
    heard = np.isfinite(every.ratio)
    cores: list[tuple[int, ...]] = [(int(k),) for k in np.flatnonzero(singles)]
    clashes: list[list[int]] = [[] for _ in range(chosen.size)]
    for k in range(chosen.size - 1):
        others = np.arange(k + 1, chosen.size)
        ratio = judged.with_another(k, others).ratio
        heard[k] |= bool(np.isfinite(ratio).any())
        heard[others[np.isfinite(ratio)]] = True
        if singles[k]:
            continue
        for other in others[(ratio > limit) & ~singles[others]].tolist():
            cores.append((k, other))
            clashes[k].append(other)
            clashes[other].append(k)
    scores, readings = [1.0] * chosen.size, [[k] for k in range(chosen.size)]
    fewest = cheapest_choice(scores, readings, cores, seconds=BUDGET if budget is None else budget)
    kept = quick_choice(scores, readings, cores) if fewest is None else fewest
    rejected = []
    for k in range(chosen.size):
        if k in kept:
            continue
        edge = int(chosen[k])
        first, second = (int(graph.poses[end[edge]]) for end in (graph.first, graph.second))
        reason, other = _reason(graph, judged, k, [j for j in clashes[k] if j in kept])
        rejected.append(RejectedClosure(edge, first, second, 1.0, reason, other))
    return JudgedClosures(graph, tuple(rejected), int(np.count_nonzero(~heard)), exact=fewest is not None)


def judge_of(graph: PoseGraph, *, headings_only: bool = False) -> Judge:
    """Return what measures the loops of a graph."""
    world, spread, chain = _dead_reckoning(graph)
    return Judge(world, spread, chain, _closures(graph, graph.closures), headings_only=headings_only)


def _reason(graph: PoseGraph, judged: Judge, k: int, clashing: list[int]) -> tuple[str, tuple[int, int] | None]:
    """Say why a closure is rejected, and name the one it contradicts most among those kept that it clashes with."""
    if not clashing:
        return f"the odometry between its poses says otherwise: {judged.told(judged.alone(), k)}", None
    loops = judged.with_another(k, np.array(clashing))
    worst = int(loops.ratio.argmax())
    edge = int(graph.closures[clashing[worst]])
    other = int(graph.poses[graph.first[edge]]), int(graph.poses[graph.second[edge]])
    many = f"{counted(len(clashing), 'closure')} that {'is' if len(clashing) == 1 else 'are'} kept"
    return (
        f"it contradicts {many}: with {other[0]} - {other[1]} and the odometry between, {judged.told(loops, worst)}",
        other,
    )


def _limit(freedom: int) -> float:
    """Return the squared miss, in standard deviations, that is exceeded with a probability of `ODDS`."""
    from scipy.special import gammainccinv

    return 2.0 * float(gammainccinv(freedom / 2.0, ODDS))


class Judge:
    """Loops of closures, numbered as `PoseGraph.closures`, and of odometry. Loops that say nothing have NaN for a ratio."""

    def __init__(
        self, world: _Frames, spread: Floats, chain: NDArray[np.int64], closures: _Closures, *, headings_only: bool
    ) -> None:
        self._world, self._spread, self._chain = world, spread, chain
        self._a, self._b, self._closure, self._covariance = closures
        self._headings_only = headings_only

    def alone(self) -> _Loops:
        """Return the loops of every closure with the odometry between its poses, (n,)."""
        there = _after(_back(self._world.at(self._a)), self._world.at(self._b))
        home = _after(there, _back(self._closure))
        covariance = _seen(_back(self._world.at(self._a)), self._between(self._a, self._b)) + _seen(there, self._covariance)
        return self._loops(home, covariance, self._chain[self._a] == self._chain[self._b])

    def with_another(self, k: int, others: NDArray[np.int64]) -> _Loops:
        """Return the loops of a closure with others: there by odometry and the other, back by odometry and the one."""
        a, b = np.full(others.size, self._a[k]), np.full(others.size, self._b[k])
        c, d = self._a[others], self._b[others]
        begin = _back(self._world.at(a))
        there = _after(begin, self._world.at(c))
        across = _after(there, self._closure.at(others))
        frame = _after(across, _back(self._world.at(d)))
        at_end = _after(frame, self._world.at(b))
        home = _after(at_end, _back(self._closure.at(np.full(others.size, k))))
        stretches = _seen(begin, self._between(a, c)) + _seen(frame, self._between(d, b))
        low, high = np.maximum(np.minimum(a, c), np.minimum(b, d)), np.minimum(np.maximum(a, c), np.maximum(b, d))
        stretches[low < high] *= 2.0  # odometry in both: its errors may add up, and no sum has more than twice the variance
        measured = _seen(across, self._covariance[others]) + _seen(at_end, self._covariance[np.full(others.size, k)])
        return self._loops(
            home, stretches + measured, (self._chain[a] == self._chain[c]) & (self._chain[b] == self._chain[d])
        )

    def told(self, loops: _Loops, k: int) -> str:
        """Say in words by how much a loop misses."""
        x, y, yaw = loops.miss[k].tolist()
        variance = np.diagonal(loops.covariance[k])
        turned, expected = f"{abs(degrees(yaw)):.3g} deg", f"{degrees(float(variance[2]) ** 0.5):.2g} deg"
        if self._headings_only:
            return f"the loop comes back turned by {turned}, and the standard deviation of that is {expected}"
        return (
            f"the loop comes back {np.hypot(x, y):.3g} m off and turned by {turned}; standard deviations are "
            f"{float(variance[0] + variance[1]) ** 0.5:.2g} m and {expected}"
        )

    def _between(self, a: NDArray[np.int64], b: NDArray[np.int64]) -> Floats:
        """Return the covariance of the odometry between poses, seen from the frame where odometry begins."""
        return self._spread[np.maximum(a, b)] - self._spread[np.minimum(a, b)]

    def _loops(self, home: _Frames, covariance: Floats, joined: NDArray[np.bool_]) -> _Loops:
        miss = np.stack([home.shift.real, home.shift.imag, (home.turn + pi) % (2 * pi) - pi], axis=1)
        if self._headings_only:
            variance = covariance[:, 2, 2]
            ratio = np.divide(miss[:, 2] ** 2, variance, out=np.full(variance.size, np.nan), where=variance > 0)
        else:
            variance = np.diagonal(covariance, axis1=1, axis2=2)
            fit: NDArray[np.bool_] = np.asarray((variance > 0).all(axis=1))
            sigma = np.sqrt(np.where(fit[:, None], variance, 1.0))
            alike = covariance / (sigma[:, :, None] * sigma[:, None, :])
            fit &= np.linalg.eigvalsh(alike)[:, 0] > SINGULAR
            alike[~fit] = np.eye(3)
            size = miss / sigma
            ratio = np.where(fit, np.einsum("ni,ni->n", size, np.linalg.solve(alike, size[:, :, None])[:, :, 0]), np.nan)
        heard = joined & (covariance[:, 2, 2] <= LOST**2)
        return _Loops(miss, covariance, np.where(heard, ratio, np.nan))


def _after(a: _Frames, b: _Frames) -> _Frames:
    return _Frames(a.shift + np.exp(1j * a.turn) * b.shift, a.turn + b.turn)


def _back(a: _Frames) -> _Frames:
    return _Frames(-np.exp(-1j * a.turn) * a.shift, -a.turn)


def _seen(frame: _Frames, covariance: Floats) -> Floats:
    """Return covariances of small motions in a frame as they are seen from outside it (the adjoint on both sides)."""
    cos, sin = np.cos(frame.turn), np.sin(frame.turn)
    adjoint = np.zeros((frame.turn.size, 3, 3))
    adjoint[:, 0, 0] = adjoint[:, 1, 1] = cos
    adjoint[:, 0, 1], adjoint[:, 1, 0] = -sin, sin
    adjoint[:, 0, 2], adjoint[:, 1, 2] = frame.shift.imag, -frame.shift.real
    adjoint[:, 2, 2] = 1.0
    return np.asarray(adjoint @ covariance @ adjoint.transpose(0, 2, 1))


def _dead_reckoning(graph: PoseGraph) -> tuple[_Frames, Floats, NDArray[np.int64]]:
    """Return every pose by odometry alone, the sum of the covariances up to it, and which unbroken chain it is in."""
    count = graph.poses.size
    step, noise = np.zeros((count, 3)), np.zeros((count, 3, 3))
    joined = np.zeros(count, np.bool_)
    edges = np.flatnonzero(graph.odometry)
    forward = graph.second[edges] > graph.first[edges]
    to = np.maximum(graph.first[edges], graph.second[edges])
    measured = _Frames(graph.measured[edges, 0] + 1j * graph.measured[edges, 1], graph.measured[edges, 2])
    turned, seen = _back(measured), _seen(measured, graph.covariance[edges])
    shift = np.where(forward, measured.shift, turned.shift)
    step[to] = np.stack([shift.real, shift.imag, np.where(forward, measured.turn, turned.turn)], axis=1)
    noise[to] = np.where(forward[:, None, None], graph.covariance[edges], seen)
    joined[to] = True
    yaw = np.cumsum(step[:, 2])
    before = np.concatenate([[0.0], yaw[:-1]])
    world = _Frames(np.cumsum(np.exp(1j * before) * (step[:, 0] + 1j * step[:, 1])), yaw)
    return world, np.cumsum(_seen(world, noise), axis=0), np.cumsum(~joined)


def _closures(graph: PoseGraph, chosen: NDArray[np.int64]) -> _Closures:
    """Return the closures from the earlier pose to the later."""
    a, b = graph.first[chosen], graph.second[chosen]
    measured = _Frames(graph.measured[chosen, 0] + 1j * graph.measured[chosen, 1], graph.measured[chosen, 2])
    back, seen = _back(measured), _seen(measured, graph.covariance[chosen])
    turned = a > b
    closure = _Frames(np.where(turned, back.shift, measured.shift), np.where(turned, back.turn, measured.turn))
    covariance = np.where(turned[:, None, None], seen, graph.covariance[chosen])
    return _Closures(np.minimum(a, b), np.maximum(a, b), closure, covariance)
