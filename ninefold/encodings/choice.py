"""The dearest claims that can be kept, by MaxSAT."""

from __future__ import annotations

import math
from fractions import Fraction
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

__all__ = ["cheapest_choice"]


def cheapest_choice(
    scores: Sequence[float], readings: Sequence[Sequence[int]], cores: Iterable[Iterable[int]]
) -> dict[int, int]:
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

    Returns
    -------
    dict
        For every claim kept, what it means.

    References
    ----------
    A. Ignatiev, A. Morgado and J. Marques-Silva, "RC2: an efficient MaxSAT solver", JSAT 11, 2019.
    """
    from pysat.examples.rc2 import RC2Stratified
    from pysat.formula import WCNF

    exact = [
        Fraction(score) for score in scores
    ]  # of a common denominator they are whole numbers, whatever floats they were
    scale = math.lcm(1, *(score.denominator for score in exact))
    first = 1 + sum(map(len, readings))
    formula = WCNF()
    for claim, means in enumerate(readings):
        formula.append([-(first + claim), *(1 + k for k in means)])
        formula.append([first + claim], weight=int(exact[claim] * scale))
    for core in cores:
        formula.append([-(1 + k) for k in core])
    with RC2Stratified(formula) as solver:
        model = set(solver.compute())
    return {
        claim: next(k for k in means if 1 + k in model) for claim, means in enumerate(readings) if first + claim in model
    }
