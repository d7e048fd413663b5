"""The cheapest claims to reject, against enumeration."""

import math
import random
from itertools import combinations

import pytest

from ninefold.encodings.choice import cheapest_choice, quick_choice


def cost(scores, kept):
    return math.fsum(score for k, score in enumerate(scores) if k not in kept)


def fits(readings, cores, kept):
    chosen = set(kept.values())
    return all(k in readings[claim] for claim, k in kept.items()) and not any(chosen.issuperset(core) for core in cores)


@pytest.mark.parametrize("seed", range(20))
def test_nothing_is_cheaper(seed):
    rng = random.Random(seed)
    sizes = [rng.randrange(4) for _ in range(5)]
    starts = [sum(sizes[:k]) for k in range(6)]
    readings = [list(range(starts[k], starts[k + 1])) for k in range(5)]
    count = starts[-1]
    scores = [rng.choice([0.1, 0.3, 0.7, 1 / 3]) for _ in range(5)]
    cores = [rng.sample(range(count), rng.randint(1, min(3, count))) for _ in range(6)] if count else []
    best = math.inf
    for number in range(count + 1):
        for chosen in combinations(range(count), number):
            kept = {claim: k for claim, means in enumerate(readings) for k in means if k in chosen}
            if len(kept) == number and fits(readings, cores, kept):
                best = min(best, cost(scores, kept))
    found = cheapest_choice(scores, readings, cores)
    assert fits(readings, cores, found)
    assert cost(scores, found) == pytest.approx(best)
    quick = quick_choice(scores, readings, cores)
    assert fits(readings, cores, quick)
    assert cost(scores, quick) >= best - 1e-12


def test_a_choice_that_takes_too_long_is_none():
    rng = random.Random(0)
    cores = [pair for pair in combinations(range(150), 2) if rng.random() < 0.5]
    assert cheapest_choice([1.0] * 150, [[k] for k in range(150)], cores, seconds=0.2) is None
