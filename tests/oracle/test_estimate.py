"""The maps an estimate leaves are those that trying everything leaves: orders, lifts, net rotations, all places jointly."""

from math import radians

import numpy as np
import pytest
from explored import simulated
from noisy import every_dart, maps_seen, outcome, random_darts, walked
from worlds import KINDS

from ninefold.mapping import SimulatedWorld
from ninefold.mapping.doubt.orders import star_orders
from tests.oracle.estimate_reference import TAU, legal_maps, orders_by_legs, rising_cost


@pytest.mark.parametrize("seed", range(8))
def test_orders_that_legs_leave_open(seed):
    rng = np.random.default_rng(seed)
    for _ in range(12):
        k = int(rng.integers(1, 5))
        heading = rng.uniform(-4, 4, k)
        if k > 1 and rng.random() < 0.6:  # near ties
            heading[1] = heading[0] + rng.normal(0, 0.1)
        variance = np.radians(rng.uniform(2, 15, k)) ** 2
        found = star_orders(heading.tolist(), variance.tolist())
        assert found is not None
        around = (heading - heading[0]) % TAU + heading[0]
        got = {(o.ways, tuple(round((x - around[i]) / TAU) for i, x in zip(o.ways, o.lifts, strict=True))) for o in found[0]}
        assert len(got) == len(found[0])
        assert got == set(orders_by_legs(heading.tolist(), variance.tolist()))
        for order in found[0]:
            assert order.cost == pytest.approx(rising_cost(order.lifts, [variance[i] for i in order.ways]), abs=1e-9)


def judged(walk):
    """How many readings of a walk were compared, and how many maps they have."""
    found = outcome(walk)
    if found.count is None or any(reading.noise.wanders for reading in found.readings):
        return 0, 0
    every = [legal_maps(reading) for reading in found.readings]
    if any(maps is None for maps in every):
        return 0, 0
    plain = set().union(*every) if every else set()
    shown = list(maps_seen(found))
    assert len(shown) == len(set(shown)) == found.count
    assert set(shown) == plain
    assert bool(found.doubts) == (found.count != 1)
    return len(every), len(plain)


@pytest.mark.parametrize("block", range(10))
def test_joint_maps_of_random_worlds(block):
    readings = several = 0
    for seed in range(60 * block, 60 * block + 60):
        rng = np.random.default_rng(seed)
        world = simulated(seed, str(rng.choice(KINDS)), int(rng.integers(1, 5)))
        if not len(world.edges):
            continue
        start = int(world.edges[rng.integers(len(world.edges)), 0])
        darts = every_dart(world, start, rng) if rng.random() < 0.6 else random_darts(world, start, 12, rng)
        exits = [None, "any-order", "in-order"][rng.integers(3)]
        sigma = radians(rng.uniform(2, 15))
        one, maps = judged(walked(world, darts, rng, sigma=sigma, exits=exits).walk)
        readings, several = readings + one, several + (maps > 1)
    assert readings > 15
    assert several > 3


WORLDS = {
    "leaves between core ways": (
        [(0, 0), (9, 0), (9, 9), (0, 9), (5, 1.5), (5, 2.6)],
        [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2), (0, 4), (0, 5)],
    ),
    "two rings and a bridge": (
        [(0, 0), (4, 1), (3, 4), (9, 1), (14, 0), (13, 4)],
        [(0, 1), (1, 2), (2, 0), (1, 3), (3, 4), (4, 5), (5, 3)],
    ),
    "a cut vertex": (
        [(0, 0), (5, 1), (5, 2.2), (-5, 1), (-4, -3)],
        [(0, 1), (1, 2), (2, 0), (0, 3), (3, 4), (4, 0)],
    ),
    "a flat triangle": ([(0, 0), (10, 0), (5, 1)], [(0, 1), (1, 2), (2, 0)]),
    "two dead ends in one face": (
        [(0, 0), (6, 0), (6, 6), (0, 6), (2.6, 3), (3.4, 3)],
        [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5)],
    ),
}


@pytest.mark.parametrize("name", WORLDS)
def test_joint_maps_of_awkward_worlds(name):
    points, edges = WORLDS[name]
    world = SimulatedWorld(points, edges)
    compared = several = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        darts = every_dart(world, 0, rng)
        exits = [None, "any-order", "in-order"][seed % 3]
        one, maps = judged(walked(world, darts, rng, sigma=radians([2, 5, 8, 12][seed % 4]), exits=exits).walk)
        compared, several = compared + one, several + (maps > 1)
    assert compared > 10
    assert several > 3


def test_whole_turns_sampled_too_coarsely():
    """A bend of 150 degrees between two samples at 8 degrees of noise may have been turned the other way round."""
    several = 0
    path = [(0, 0), (6, 0), (1, 2)]
    for seed in range(30):
        world = SimulatedWorld([(0, 0), (1, 2), (-3, 4)], [(0, 1), (1, 2), (2, 0)], [path, None, None])
        rng = np.random.default_rng(seed)
        truth = walked(world, every_dart(world, 0, rng), rng, sigma=radians(8), exits=[None, "in-order"][seed % 2])
        truth = thinned(truth.walk)
        found = outcome(truth)
        several += any(len(way.turns) > 1 for reading in found.readings for way in reading.ways)
        judged(truth)
    assert several > 10


def thinned(walk):
    """The walk with the first and last sample of every leg alone."""
    from dataclasses import replace

    from ninefold.mapping import Samples

    return replace(
        walk,
        events=tuple(Samples((e.yaw[0], e.yaw[-1])) if isinstance(e, Samples) else e for e in walk.events),
    )
