"""The simulated robot: what it visits, in what order it sees, and what it says."""

import math

import numpy as np
import pytest

from ninefold.errors import BadInput, UnknownName
from ninefold.mapping import Heading, Samples, SimulatedWorld, Visit, WalkHeader, build, explore

SQUARE = [(0, 0), (10, 0), (10, 10), (0, 10)]
RING = [(0, 1), (1, 2), (2, 3), (3, 0)]


def test_a_square_is_walked_round():
    robot = explore(SimulatedWorld(SQUARE, RING))
    assert robot.walk.places == ("0", "1", "2", "3", "0")
    assert (robot.start, robot.unreached, robot.metres) == ("0", (), 40.0)
    assert robot.walk.header == WalkHeader()
    assert robot.walk.events[0] == Visit("0", (Heading(0.0), Heading(math.pi / 2)))


def test_a_tree_is_walked_there_and_back_until_nothing_is_left():
    robot = explore(SimulatedWorld([(0, 0), (1, 0), (2, 0), (1, 1), (1, -1)], [(0, 1), (1, 2), (1, 3), (1, 4)]))
    assert robot.walk.places == ("0", "1", "4", "1", "2", "1", "3")  # counter-clockwise from the way back
    assert build(robot.walk).n_edges == 4


def test_ways_are_walked_twice_at_most():
    rng = np.random.default_rng(0)
    points = np.stack(np.divmod(np.arange(400), 20), axis=1) + rng.uniform(-0.3, 0.3, (400, 2))
    ways = [(i, i + 20) for i in range(380)] + [(i, i + 1) for i in range(400) if i % 20 < 19]
    world = SimulatedWorld(points, ways, edge_names=[f"w{i}" for i in range(len(ways))])
    for seed in (None, 0, 1):
        walk = explore(world, seed=seed).walk
        walked = [event.edge for event in walk.events if isinstance(event, Visit)][1:]
        assert set(walked) == set(world.edge_names)
        assert max(walked.count(name) for name in set(walked)) == 2
        assert build(walk).n_faces == len(ways) - 400 + 2


def test_a_long_dead_end_needs_no_recursion():
    n = 5_000
    robot = explore(SimulatedWorld([(i, 0) for i in range(n)], [(i, i + 1) for i in range(n - 1)]), start=n // 2)
    assert build(robot.walk).n_vertices == n


def test_loops_parallel_ways_and_dead_ends():
    loop = [(0, 0), (0, 5), (-5, 5), (-5, 0), (0, 0)]
    arc = [(0, 0), (5, 5), (10, 0)]
    world = SimulatedWorld(
        [(0, 0), (10, 0), (3, 1), (-2, 2)],
        [(0, 0), (0, 1), (0, 1), (0, 2), (0, 3)],
        [loop, None, arc, None, None],
        edge_names=["loop", "street", "arc", "between", "within"],
    )
    for seed in (None, 0, 1, 2, 3):
        plane = build(explore(world, seed=seed, start=1).walk)
        assert (plane.n_vertices, plane.n_edges, plane.n_faces) == (4, 5, 3)
        face = dict(zip(plane.edge_names, plane.face_of.reshape(-1, 2).tolist(), strict=True))
        assert face["within"][0] in plane.cycle(edges=["loop"]).faces
        assert face["between"][0] in plane.cycle(edges=["street", "arc"]).faces


def test_what_cannot_be_reached_is_said():
    world = SimulatedWorld(
        [(0, 0), (1, 0), (5, 5), (9, 0), (9, 1), (9, 2)],
        [(0, 1), (3, 4), (4, 5)],
        vertex_names=["a", "b", "c", "d", "e", "f"],
    )
    robot = explore(world)
    assert (robot.start, robot.unreached) == ("d", (("a", "b"), ("c",)))
    assert explore(world, start="a").unreached == (("c",), ("d", "e", "f"))
    alone = explore(world, start="c")
    assert alone.walk.events == (Visit("c", ()),)
    assert alone.metres == 0
    assert build(alone.walk).n_vertices == 1


def test_orientation_is_sampled_by_distance_and_at_bends():
    world = SimulatedWorld([(0, 0), (2.5, 2)], [(0, 1)], [[(0, 0), (2.5, 0), (2.5, 2)]])
    forward, metres = world.sampled(0, 1.0)
    # At 0, 1 and 2 m; at the bend, 2.5 m; at 3 and 4 m; and at the end, 4.5 m.
    assert forward == pytest.approx([0, 0, 0, *[math.pi / 2] * 4])
    assert metres == 4.5
    back, _ = world.sampled(1, 1.0)
    assert back == pytest.approx([-math.pi / 2] * 2 + [-math.pi] * 4)
    assert len(world.sampled(0, 100.0)[0]) == 3
    straight = SimulatedWorld([(0, 0), (0, 3)], [(0, 1)])
    assert straight.sampled(0, 1.0)[0] == pytest.approx([math.pi / 2] * 4)
    assert straight.sampled(1, 100.0)[0] == pytest.approx([-math.pi / 2] * 2)


def test_a_hairpin_bend_is_sampled_half_way():
    world = SimulatedWorld([(0, 0), (0, 1)], [(0, 1)], [[(0, 0), (10, 0.5), (0, 1)]])
    yaw, _ = world.sampled(0, 100.0)
    assert len(yaw) == 4
    assert np.abs(np.diff(yaw)).max() < math.pi / 2
    assert yaw[-1] - yaw[0] == pytest.approx(math.pi - 2 * math.atan2(0.5, 10))
    for seed in range(20):
        events = explore(world, noise=0.1, seed=seed, step=100.0).walk.events
        assert build_turn(events) > 2


def build_turn(events):
    (samples,) = (event for event in events if isinstance(event, Samples))
    return sum(math.remainder(b - a, 2 * math.pi) for a, b in zip(samples.yaw, samples.yaw[1:], strict=False))


def test_the_same_arguments_give_the_same_walk():
    world = SimulatedWorld(SQUARE, [*RING, (0, 2)])
    assert explore(world, seed=5, noise=0.01).walk == explore(world, seed=5, noise=0.01).walk
    assert explore(world, seed=5, noise=0.01).walk != explore(world, seed=6, noise=0.01).walk
    assert explore(world).walk == explore(world).walk
    assert len({explore(world, seed=s).walk.places for s in range(20)}) > 1


def test_noise_has_the_spread_asked_for():
    world = SimulatedWorld([(0, 0), (1, 0)], [(0, 1)])
    yaw = explore(world, seed=0, noise=0.05, step=0.001).walk.events[1].yaw
    assert len(yaw) == 1001
    assert np.std(yaw) == pytest.approx(0.05, rel=0.1)
    assert explore(world, seed=0, noise=0.05).walk.events[0].exits[0] != Heading(0.0)


def test_exits_and_names_are_given_when_asked_for():
    world = SimulatedWorld(SQUARE, RING, vertex_names="abcd", edge_names="uvwx")
    walk = explore(world, exits=False).walk
    assert [event.exits for event in walk.events if isinstance(event, Visit)] == [None] * 5
    assert [event.edge for event in walk.events if isinstance(event, Visit)] == [None, "u", "v", "w", "x"]
    assert walk.places == ("a", "b", "c", "d", "a")
    unnamed = explore(SimulatedWorld(SQUARE, RING)).walk
    assert {event.edge for event in unnamed.events if isinstance(event, Visit)} == {None}


def test_the_tolerance_suits_the_narrowest_fork():
    fork = SimulatedWorld([(0, 0), (100, 0), (100, 1)], [(0, 1), (0, 2)])
    assert fork.narrowest == pytest.approx(math.atan2(1, 100))
    robot = explore(fork, step=50)
    assert robot.walk.header.tolerance == pytest.approx(fork.narrowest / 3)
    assert build(robot.walk).n_edges == 2
    assert explore(fork, step=50, tolerance=0.5).walk.header.tolerance == 0.5


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"start": "nowhere"}, UnknownName, "there is no vertex named 'nowhere'"),
        ({"step": 0}, BadInput, "step is a positive number of metres, not 0"),
        ({"step": math.nan}, BadInput, "step is a positive number"),
        ({"step": "1"}, BadInput, "step is a positive number"),
        ({"step": 1e-9}, BadInput, "a step of 1e-09 m takes 4e.10 samples over 40 m of ways; take a longer step"),
        ({"noise": -1}, BadInput, "noise is a standard deviation"),
        ({"noise": math.inf}, BadInput, "noise is a standard deviation"),
        ({"tolerance": 3}, BadInput, "a tolerance is an angle"),
    ],
)
def test_arguments_refused(arguments, error, message):
    with pytest.raises(error, match=message):
        explore(SimulatedWorld(SQUARE, RING), **arguments)


@pytest.mark.parametrize(
    ("points", "edges", "paths", "message"),
    [
        ([], [], None, "points must have shape"),
        ([(0, math.nan)], [], None, "point 0 is not finite"),
        ([(0, 0)], [(0, 1)], None, "edges must hold rows of points, 0 to 0; found 1"),
        ([(0, 0)], [(0, 0)], None, "edge '0' has no length"),
        ([(0, 0), (1, 0), (2, 0)], [(0, 1), (0, 2)], None, "leave vertex '0' in the same direction"),
        ([(0, 0), (1, 0)], [(0, 1)], [[(0, 0), (2, 0), (1, 0)]], "turns back on itself"),
    ],
)
def test_worlds_refused(points, edges, paths, message):
    with pytest.raises(BadInput, match=message):
        SimulatedWorld(points, edges, paths)


def test_repr_and_darts():
    world = SimulatedWorld(SQUARE, RING)
    assert repr(world) == "SimulatedWorld(4 places, 4 ways)"
    assert world.darts_at(1) == [2, 1]  # north to 2, then west to 0
    assert np.array_equal(world.path(1), [(10, 0), (10, 10)])
