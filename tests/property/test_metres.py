"""Metres are evidence beside headings: whatever was measured, the map is the same, and its lengths are means over passes."""

import math
from collections import defaultdict
from dataclasses import replace

import numpy as np
import pytest
from explored import simulated
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import KINDS

from ninefold.io import Atlas
from ninefold.io.walks.json_lines import read_walk, write_walk
from ninefold.mapping import PlaneMap, Samples, Visit, Walk, build, explore
from ninefold.mapping.robot.legs import read_legs

worlds = st.builds(simulated, st.integers(0, 2**32 - 1), st.sampled_from(KINDS), st.integers(1, 30))
seeds = st.integers(0, 2**32 - 1)


def measured(walk, seed):
    """The walk with an odometer that errs and sometimes says nothing, its legs cut into several events."""
    rng = np.random.default_rng(seed)
    events = []
    for event in walk.events:
        if isinstance(event, Visit):
            events.append(event)
            continue
        cuts = np.flatnonzero(rng.random(len(event.yaw) - 1) < 0.2) + 1
        bounds = [0, *cuts.tolist(), len(event.yaw)]
        shares = rng.dirichlet(np.ones(len(bounds) - 1)) * event.metres * rng.uniform(0.8, 1.2)
        silent = rng.random(len(shares)) < rng.choice([0.0, 0.0, 0.1, 1.0])
        events += [
            Samples(event.yaw[a:b], metres=None if mute else float(share))
            for a, b, share, mute in zip(bounds, bounds[1:], shares, silent, strict=False)
        ]
    return Walk(walk.header, tuple(events))


def without_metres(plane):
    return PlaneMap.from_darts(
        plane.tail,
        plane.next_ccw,
        plane.outer if plane.outer >= 0 else None,
        n_vertices=plane.n_vertices,
        heading=plane.heading,
        turn=plane.turn,
        vertex_names=plane.vertex_names,
        edge_names=plane.edge_names,
    )


@settings(max_examples=150, deadline=None)
@given(worlds, seeds, st.floats(5, 200), st.booleans())
def test_a_walk_with_metres_makes_the_same_map_as_without(world, seed, step, noisy):
    noise = min(0.02, world.narrowest / 3) / 15 if noisy else 0.0
    options = {"start": seed % len(world.points), "seed": seed, "step": step, "noise": noise}
    walk = measured(explore(world, metres=True, **options).walk, seed)
    plane = build(walk)
    plane.validate()
    assert without_metres(plane) == build(explore(world, **options).walk)


@settings(max_examples=150, deadline=None)
@given(worlds, seeds)
def test_lengths_are_means_over_the_passes_that_measured_the_whole_way(world, seed):
    walk = measured(explore(world, seed=seed, metres=True, step=20.0).walk, seed)
    plane = build(walk)
    names = [event.edge for event in walk.events if isinstance(event, Visit)][1:]
    told = defaultdict(list)
    for name, leg in zip(names, read_legs(walk.events), strict=True):
        if leg.metres is not None:
            told[name].append(leg.metres)
    assert (plane.metres is None) == (not told)
    for e, name in enumerate(plane.edge_names):
        if plane.metres is not None:
            length = float(plane.metres[e])
            assert math.isnan(length) if name not in told else length == pytest.approx(np.mean(told[name]))


@settings(max_examples=40, deadline=None)
@given(worlds, seeds)
def test_files_keep_every_metre(tmp_path_factory, world, seed):
    folder = tmp_path_factory.mktemp("metres")
    walk = measured(explore(world, seed=seed, metres=True, step=20.0).walk, seed)
    write_walk(walk, folder / "walk.jsonl")
    assert read_walk(folder / "walk.jsonl") == walk
    with Atlas.from_walk(walk, folder / "walk.atlas") as atlas:
        assert (atlas.walk, atlas.plane) == (walk, build(walk))
    with Atlas.from_map(build(walk), folder / "map.atlas") as atlas:
        assert atlas.plane == build(walk)


@settings(max_examples=60, deadline=None)
@given(worlds, seeds)
def test_a_log_without_metres_has_none(world, seed):
    walk = explore(world, seed=seed, metres=True, step=20.0).walk
    bare = [replace(event, metres=None) if isinstance(event, Samples) else event for event in walk.events]
    assert Walk(walk.header, tuple(bare)) == explore(world, seed=seed, step=20.0).walk
    assert build(Walk(walk.header, tuple(bare))).metres is None
