"""The localizer on any events at all: it stays a belief or says why not; and on worlds turned round with what is seen."""

from math import pi

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import KINDS, world

from ninefold.errors import EmptyBelief, TooLarge, WalkError
from ninefold.mapping import Follower, Heading, PlaneMap, Samples, Visit, WalkHeader

worlds = st.builds(world, st.integers(0, 2**32 - 1), st.sampled_from(KINDS), st.integers(1, 12))
yaws = st.sampled_from((0.0, 0.5, pi / 2, 2.0, pi, -pi / 2, -1.0))


@st.composite
def events(draw):
    found = []
    for _ in range(draw(st.integers(1, 8))):
        if draw(st.booleans()):
            exits = draw(st.none() | st.lists(yaws, max_size=4))
            found.append(Visit(None, None if exits is None else tuple(map(Heading, exits))))
        else:
            found.append(Samples(tuple(draw(st.lists(yaws, min_size=1, max_size=3)))))
    return found


@settings(max_examples=400, deadline=None)
@given(worlds, events(), st.booleans(), st.sampled_from((0.02, 0.3, 1.0)))
def test_whatever_comes_it_is_a_belief_or_says_why_not(place, given_events, compass, sigma):
    follower = Follower(place.plane, WalkHeader(compass=compass), sigma=sigma)
    for event in given_events:
        before, said = follower.localizer.probabilities, None
        try:
            follower.step(event)
        except (EmptyBelief, WalkError, TooLarge) as error:
            said = str(error)
        if said is not None:
            assert "\n" not in said
            np.testing.assert_array_equal(follower.localizer.probabilities, before)
        p = follower.localizer.probabilities
        assert np.isfinite(p).all()
        assert (p >= 0).all()
        assert abs(p.sum() - 1) < 1e-9
        robot = follower.localizer
        if robot.n_exits:
            forecast = robot.forecast()
            assert sorted(move.exit for move in forecast) == list(range(robot.n_exits))


@settings(max_examples=150, deadline=None)
@given(worlds, st.integers(0, 2**32 - 1), st.booleans())
def test_a_world_turned_round_is_the_same_to_a_robot_turned_round(place, seed, compass):
    """Turned by a right angle, which keeps coordinates whole; without a compass the robot need not turn with it."""
    plane = place.plane
    turned = PlaneMap.from_geometry(
        place.points @ np.array([[0, 1], [-1, 0]]),
        place.edges,
        [path @ np.array([[0, 1], [-1, 0]]) for path in place.paths],
    )
    rng = np.random.default_rng(seed)
    by = pi / 2 if compass else float(rng.uniform(-3, 3))
    one, other = (Follower(p, WalkHeader(compass=compass), sigma=0.1) for p in (plane, turned))
    at = int(rng.integers(plane.n_vertices))
    for _ in range(3):
        ways = [d for d in plane.darts_at(at) if not plane.tether[d >> 1]]
        seen = [float(plane.heading[d] + rng.normal(0, 0.05)) for d in ways]
        for follower, offset in ((one, 0.0), (other, by)):
            follower.step(Visit(None, tuple(Heading(yaw + offset) for yaw in seen)))
        np.testing.assert_allclose(one.localizer.probabilities, other.localizer.probabilities, atol=1e-6)
        if not ways:
            return
        out = ways[int(rng.integers(len(ways)))]
        back = out ^ 1
        start, end = float(plane.heading[out]), float(plane.heading[out] + plane.turn[out >> 1] * (-1 if out & 1 else 1))
        leg = np.linspace(start, end, 2 + int(abs(end - start))) + rng.normal(0, 0.02)
        for follower, offset in ((one, 0.0), (other, by)):
            follower.step(Samples(tuple((leg + offset).tolist())))
        at = int(plane.tail[back])
