"""The localizer held against a slow filter that enumerates places, ways back, assignments and offsets, on small worlds."""

from math import radians

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import KINDS, world

from ninefold.io import samples
from ninefold.mapping import Follower, Heading, Localizer, Visit, WalkHeader, explore
from ninefold.mapping.doubt import _matching
from ninefold.mapping.doubt._matching import Look, Noise, weights
from tests.oracle.belief_reference import Belief

MOST_EXITS = 4


def held_equal(robot: Localizer, belief: Belief) -> None:
    found = {(robot.plane.vertex_names.row(c.vertex), c.dart): c.probability for c in robot.candidates(1)}
    assert sum(found.values()) == pytest.approx(1)
    for state in found.keys() | belief.p.keys():
        assert found.get(state, 0.0) == pytest.approx(belief.p.get(state, 0.0), abs=2e-6), (state, found, belief.p)


class Truth:
    """The robot itself: where it is, and what it senses."""

    def __init__(self, plane, rng, sigma, offset, missed, extra):
        self.plane, self.rng, self.sigma, self.offset = plane, rng, sigma, offset
        self.missed, self.extra = missed, extra
        self.at, self.back = int(rng.integers(plane.n_vertices)), None

    def error(self):
        return float(np.clip(self.rng.normal(0, self.sigma), -4 * self.sigma, 4 * self.sigma))

    def sensed(self, dart):
        return float(self.plane.heading[dart]) + self.error() + self.offset

    def ways(self):
        ways = [d for d in self.plane.darts_at(self.at) if not self.plane.tether[d >> 1]]
        return [d for d in ways if not self.missed or self.rng.random() > 0.2]

    def go(self, dart):
        turn = float(self.plane.turn[dart >> 1]) * (-1 if dart & 1 else 1)
        self.back = dart ^ 1
        self.at = int(self.plane.tail[self.back])
        return turn


@settings(max_examples=250, deadline=None)
@given(
    st.integers(0, 2**32 - 1),
    st.sampled_from(KINDS),
    st.integers(1, 9),
    st.sampled_from((2.0, 6.0, 12.0)),
    st.booleans(),
    st.sampled_from(((0.0, 0.0), (0.1, 0.0), (0.0, 0.1), (0.05, 0.05))),
)
def test_every_step_agrees_with_enumeration(seed, kind, size, degrees, compass, faults):
    plane = world(seed, kind, size).plane
    if plane.degree.max() > MOST_EXITS:
        return
    rng = np.random.default_rng(seed)
    missed, extra = faults if compass else (0.0, 0.0)
    sigma = radians(degrees)
    robot = Localizer(plane, sigma=sigma, compass=compass, missed=missed, extra=extra)
    belief = Belief(plane, sigma, compass=compass, missed=missed, extra=extra)
    truth = Truth(plane, rng, sigma, 0.0 if compass else 1.234, missed, extra)
    for _ in range(4):
        ways = truth.ways()
        exits, came_by = [truth.sensed(d) for d in ways], None
        if extra and rng.random() < 0.2:
            exits.append(float(rng.uniform(-3, 3)))
        order = rng.permutation(len(exits))
        exits = [exits[i] for i in order]
        looked = rng.random() < 0.8
        if truth.back is not None and rng.random() < 0.7:
            if looked and truth.back in ways and rng.random() < 0.5:
                came_by = int(np.flatnonzero(order == ways.index(truth.back))[0])
            else:
                came_by = truth.sensed(truth.back)
        if looked or came_by is not None:
            told = Heading(came_by) if isinstance(came_by, float) else came_by
            robot.observe([Heading(x) for x in exits] if looked else None, came_by=told)
            belief.observe(exits if looked else None, came_by)
            held_equal(robot, belief)
        if not plane.degree[truth.at]:
            return
        if looked and ways and rng.random() < 0.7:
            dart = ways[int(rng.integers(len(ways)))]
            by = int(np.flatnonzero(order == ways.index(dart))[0])
        else:
            dart = next(d for d in plane.darts_at(truth.at) if not plane.tether[d >> 1])
            by = truth.sensed(dart)
        turned = truth.go(dart) + truth.error()
        turn = turned if rng.random() < 0.4 else None
        robot.move(Heading(by) if isinstance(by, float) else by, turn=turn)
        belief.move(by, turn)
        held_equal(robot, belief)


@pytest.mark.parametrize("k", [3, 4, 5, 6])
@pytest.mark.parametrize("look", ["alone", "heading back", "exit back"])
@pytest.mark.parametrize("leaving", ["not", "by heading", "by position"])
def test_the_closed_form_and_the_sum_over_offsets_agree(k, look, leaving, monkeypatch):
    rng = np.random.default_rng(k)
    yaw = np.sort(rng.uniform(-2.5, 2.5, (1, k)) + rng.normal(0, 0.3, (30, k)), axis=1)
    back = np.concatenate([[k - 1], rng.integers(0, k, 29)])
    exits = np.sort(yaw[0] + rng.normal(0, 0.1, k) + 0.3)
    seen = Look(exits)
    if look != "alone":
        seen = Look(exits, back=yaw[0, -1] + 0.4) if look == "heading back" else Look(exits, back_exit=k - 1)
    left = {"not": (None, None), "by heading": (yaw[0, 0] + 0.25, None), "by position": (None, 1)}[leaving]
    known = None if look == "alone" else back
    found = []
    for limit in (6, 0):
        monkeypatch.setattr(_matching, "DIRECT_UP_TO", limit)
        log = weights(yaw, known, seen, Noise(0.2), compass=False, leaving=left)
        found.append(np.exp(log - log.max()))
    np.testing.assert_allclose(found[0], found[1], atol=1e-6)


def test_a_place_of_many_exits_is_matched_by_what_errors_can_reach():
    spokes = 60
    yaw = np.linspace(-3.1, 3.1, spokes)[None]
    exits = np.sort(yaw[0] + np.random.default_rng(0).normal(0, 0.01, spokes))
    log = weights(yaw, None, Look(exits), Noise(0.01), compass=True)
    straight = -0.5 * float(((exits - yaw[0]) ** 2).sum()) / 0.01**2
    assert straight - 1e-9 <= log[0] < straight + 1.0


@pytest.mark.parametrize("compass", [True, False])
@pytest.mark.parametrize("listed", [True, False])
def test_pieces_of_a_noisy_walk_through_a_district_are_found_where_they_were(compass, listed):
    """A robot cut loose anywhere on its walk is found within 14 legs nearly always, and nowhere else than where it is."""
    source, sigma = samples.load("helsinki_district"), radians(5)
    plane = source.to_map()
    events = explore(source.to_world(), seed=3, noise=sigma, exits=listed).walk.events
    visits = [i for i, event in enumerate(events) if isinstance(event, Visit)]
    rng, found = np.random.default_rng(0), 0
    for first in rng.integers(0, len(visits) - 15, 25).tolist():
        robot = Follower(plane, WalkHeader(compass=compass), sigma=sigma)
        for event in events[visits[first] : visits[first + 14] + 1]:
            if robot.step(event) and robot.localizer.certain:
                assert robot.localizer.likeliest.vertex == event.place
                found += 1
                break
    assert found >= (25 if listed else 18)
