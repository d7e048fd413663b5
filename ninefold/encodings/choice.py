"""The dearest claims that can be kept, by MaxSAT."""

from __future__ import annotations

import math
from collections import Counter
from fractions import Fraction
from threading import Timer
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

__all__ = ["cheapest_choice", "quick_choice"]


def cheapest_choice(
    scores: Sequence[float],
    readings: Sequence[Sequence[int]],
    cores: Iterable[Iterable[int]],
    *,
    seconds: float | None = None,
) -> dict[int, int] | None:
    """Choose the claims to keep so that the scores of the others sum to the least.

    Parameters
    ----------
    scores
        Of every claim, above 0.
    readings
        Of every claim, the numbers of the assertions that it may mean, counted from 0 over all claims; a claim that is kept
        means one of them.
    cores
        Sets of assertions that cannot hold together.
    seconds
        After which to give up.

    Returns
    -------
    dict or None
        For every claim kept, what it means; None if the time was not enough.

    References
    ----------
    A. Ignatiev, A. Morgado and J. Marques-Silva, "RC2: an efficient MaxSAT solver", JSAT 11, 2019.
    """
    from pysat.examples.rc2 import RC2Stratified
    from pysat.formula import WCNF

    # fractions of a common denominator are whole numbers, whatever floats the scores were
    exact = [Fraction(score) for score in scores]
    scale = math.lcm(1, *(score.denominator for score in exact))
    first = 1 + sum(map(len, readings))
    formula = WCNF()
    for claim, means in enumerate(readings):
        formula.append([-(first + claim), *(1 + k for k in means)])
        formula.append([first + claim], weight=int(exact[claim] * scale))
    for core in cores:
        formula.append([-(1 + k) for k in core])
    with RC2Stratified(formula) as solver:
        timer = None if seconds is None else Timer(max(seconds, 0.05), solver.interrupt)
        if timer is not None:
            timer.start()
        found = solver.compute(expect_interrupt=timer is not None)
        if timer is not None:
            timer.cancel()
            timer.join()
        solver.clear_interrupt()
    if found is None or solver.interrupted:
        return None
    model = set(found)
    return {
        claim: next(k for k in means if 1 + k in model) for claim, means in enumerate(readings) if first + claim in model
    }


def quick_choice(
    scores: Sequence[float], readings: Sequence[Sequence[int]], cores: Iterable[Iterable[int]]
) -> dict[int, int]:
    """Choose claims to keep without a search, as `cheapest_choice` does with one; others may be cheaper to reject.

    Rejects what meets most of the cores left for its score, one after another. Complexity O(rejected times size of cores).
    """
    owner = {k: claim for claim, means in enumerate(readings) for k in means}
    left = [set(core) for core in cores]
    gone: set[int] = set()
    while left:
        met = Counter(k for core in left for k in core)
        worst = max(met, key=lambda k: (met[k] / scores[owner[k]], k))
        gone.add(worst)
        left = [core for core in left if worst not in core]
    return {claim: open_to[0] for claim, means in enumerate(readings) if (open_to := [k for k in means if k not in gone])}
