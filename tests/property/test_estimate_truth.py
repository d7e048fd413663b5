"""The true map is among the maps an estimate leaves, joint and not place by place; a certain map is the true one.

The chance that one of these walks loses its true map is below one in a million, so a failure is a mistake.
"""

from math import radians

import numpy as np
import pytest
from explored import simulated
from noisy import every_dart, holds, maps_seen, outcome, random_darts, true_seen, walked
from worlds import KINDS, braced

from ninefold.io import samples
from ninefold.mapping import SimulatedWorld


def some_world(rng):
    pick = rng.random()
    if pick < 0.6:
        return simulated(int(rng.integers(2**32)), str(rng.choice(KINDS)), int(rng.integers(1, 9)))
    if pick < 0.8:
        return SimulatedWorld(*scaled(braced(int(rng.integers(6, 30)), 0.4, int(rng.integers(2**32)))))
    across, up = (int(n) for n in rng.integers(2, 6, 2))
    points = [(10.0 * i, 10.0 * j) for i in range(across) for j in range(up)]
    edges = [(i * up + j, (i + 1) * up + j) for i in range(across - 1) for j in range(up)]
    edges += [(i * up + j, i * up + j + 1) for i in range(across) for j in range(up - 1)]
    return SimulatedWorld(points, [edge for edge in edges if rng.random() < 0.8] or edges[:1])


def scaled(world):
    return world[0] * 100, world[1]


def some_darts(world, rng):
    start = int(world.edges[rng.integers(len(world.edges)), rng.integers(2)])
    mode = int(rng.integers(4))
    if mode == 0:
        return random_darts(world, start, int(rng.integers(1, 40)), rng)
    darts = every_dart(world, start, rng)
    if mode == 1:
        return darts + every_dart(world, start, rng)
    return darts[: int(rng.integers(1, len(darts) + 1))] if mode == 2 else darts  # cut short in the middle


def held(truth, *, all_listed):
    """Whether a certain map was found; fails if the truth is lost."""
    found = outcome(truth.walk)
    kept = holds(found, true_seen(truth))
    if kept is False:
        # ways that nothing could tell apart count as one: the documented assumption where no exits are listed
        assert not all_listed, found.doubts
        assert nearly_the_same(truth), found.doubts
        return False
    assert kept is True or found.count is None
    certain = found.count == 1 and not found.doubts
    assert (found.count != 1) == bool(found.doubts)
    if certain:
        assert list(maps_seen(found)) == [true_seen(truth)]
    return certain


def nearly_the_same(truth):
    world, sigma = truth.world, truth.walk.header.sigma + (truth.walk.header.drift or 0)
    ways = sorted({dart >> 1 for dart in truth.darts})
    ends = world.edges.reshape(-1).tolist()

    def near(a, b):
        return abs((world.heading[a] - world.heading[b] + np.pi) % (2 * np.pi) - np.pi) < 20 * sigma

    return any(
        ends[2 * a] == ends[b] and ends[2 * a + 1] == ends[b ^ 1] and near(2 * a, b) and near(2 * a + 1, b ^ 1)
        for n, a in enumerate(ways)
        for way in ways[n + 1 :]
        for b in (2 * way, 2 * way + 1)
    )


@pytest.mark.parametrize("block", range(12))
def test_the_truth_is_among_the_maps(block):
    certain = 0
    for seed in range(1000 * block, 1000 * block + 50):
        rng = np.random.default_rng(seed)
        world = some_world(rng)
        if not len(world.edges):
            continue
        listed = float(rng.choice([1, 1, 0.5]))
        exits = [None, "any-order", "in-order"][rng.integers(3)]
        truth = walked(
            world,
            some_darts(world, rng),
            rng,
            sigma=radians(rng.choice([1, 2, 3, 5, 7, 10, 15])),
            drift=radians(rng.choice([0, 0, 2, 10])),
            kept=float(rng.choice([0, 0.9, 0.99])),
            exits=exits,
            listed=listed,
            step=float(rng.choice([50, 1e9])),
            names=rng.random() < 0.2,
        )
        certain += held(truth, all_listed=exits is not None and listed == 1)
    assert certain >= 8


@pytest.mark.parametrize("block", range(4))
def test_the_truth_is_among_the_maps_of_a_gyro(block):
    certain = 0
    for seed in range(1000 * block, 1000 * block + 60):
        rng = np.random.default_rng(seed)
        world = some_world(rng)
        if not len(world.edges):
            continue
        truth = walked(
            world,
            some_darts(world, rng),
            rng,
            sigma=radians(rng.choice([0.5, 1, 2, 5])),
            drift=radians(rng.choice([1, 3, 10, 30])),
            compass=False,
            exits=["any-order", "in-order"][rng.integers(2)],
        )
        certain += held(truth, all_listed=True)
    assert certain >= 8


@pytest.mark.parametrize("degrees", [2, 5, 10])
def test_the_district(degrees):
    world = samples.load("helsinki_district").to_world()
    for seed in range(3):
        rng = np.random.default_rng([degrees, seed])
        exits = ["any-order", "in-order"][seed % 2]
        held(walked(world, every_dart(world, 0, rng), rng, sigma=radians(degrees), exits=exits), all_listed=True)


@pytest.mark.parametrize("drift", [3, 20])
def test_the_district_with_a_gyro(drift):
    world = samples.load("helsinki_district").to_world()
    rng = np.random.default_rng(drift)
    truth = walked(
        world, every_dart(world, 0, rng), rng, sigma=radians(1), drift=radians(drift), compass=False, exits="in-order"
    )
    held(truth, all_listed=True)
