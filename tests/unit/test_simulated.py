"""The simulated robot: what it visits, in what order it sees, and what it says."""

import math

import networkx as nx
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


# Turned by an eighth, so that no heading is near the cut between -pi and pi.
GRID = SimulatedWorld(
    np.stack(np.divmod(np.arange(64), 8), axis=1) @ [[1, 1], [-1, 1]] * math.sqrt(50),
    [(i, i + 8) for i in range(56)] + [(i, i + 1) for i in range(64) if i % 8 < 7],
    edge_names=[f"w{k}" for k in range(112)],
)


def ways_of(walk):
    return [event.edge for event in walk.events if isinstance(event, Visit)][1:]


def test_noise_and_drift_are_declared_in_the_header():
    world = SimulatedWorld(SQUARE, RING)
    assert explore(world, seed=0, noise=0.03).walk.header == WalkHeader(sigma=0.03, drift=0.0)
    assert explore(world, seed=0, noise=0.03, drift=0.01).walk.header == WalkHeader(sigma=0.03, drift=0.01)
    assert explore(world, seed=0, drift=0.01, ordered_exits=True).walk.header == WalkHeader(drift=0.01, exits="in-order")
    assert explore(world, seed=0, tours=2, tour="covering").walk.header == WalkHeader()


def test_drift_is_common_to_the_readings_at_a_place_and_changes_evenly_between_places():
    robot = explore(GRID, seed=3, drift=0.1, step=2.5)
    events, bias = robot.walk.events, []
    star = {v: np.sort(GRID.heading[GRID.darts_at(v)]) for v in range(64)}
    for event in events[::2]:
        off = np.array([heading.yaw for heading in event.exits]) - star[int(event.place)]
        assert np.ptp(off) < 1e-12
        bias.append(off[0])
    for k, event in enumerate(events[1::2]):
        dart = next(
            2 * e + side
            for e, ends in enumerate(GRID.edges.tolist())
            for side in (0, 1)
            if (str(ends[side]), str(ends[1 - side])) == (events[2 * k].place, events[2 * k + 2].place)
        )
        off = np.array(event.yaw) - GRID.heading[dart]
        assert off == pytest.approx(np.linspace(bias[k], bias[k + 1], 5), abs=1e-12)


def test_drift_has_the_spread_asked_for_and_is_half_forgotten_after_twenty_legs():
    bias = []
    for seed in range(30):
        visits = explore(GRID, seed=seed, drift=0.05, step=100.0, start=9).walk.events[::2]
        bias.append([np.mean([h.yaw for h in v.exits]) - np.mean(GRID.heading[GRID.darts_at(int(v.place))]) for v in visits])
    length = min(map(len, bias))
    bias = np.array([row[:length] for row in bias])
    assert length > 150
    assert bias.std() == pytest.approx(0.05, rel=0.15)
    assert bias[:, 0].std() == pytest.approx(0.05, rel=0.4)  # from the first place on
    assert (bias[:, :-1] * bias[:, 1:]).mean() / (bias**2).mean() == pytest.approx(0.966, abs=0.03)
    assert (bias[:, :-20] * bias[:, 20:]).mean() / (bias**2).mean() == pytest.approx(0.5, abs=0.2)


def test_noise_is_independent_from_reading_to_reading():
    walk = explore(GRID, seed=1, noise=0.05, step=100.0, tours=20).walk
    ends = np.array([event.yaw for event in walk.events if isinstance(event, Samples)])
    assert ends.shape[1] == 2  # a leg of one long step has its two ends
    off = (ends % (math.pi / 2)) - math.pi / 4
    assert off.std() == pytest.approx(0.05, rel=0.05)
    assert abs(np.corrcoef(off.T)[0, 1]) < 0.05
    assert abs(np.corrcoef(off[:-1, 1], off[1:, 0])[0, 1]) < 0.05


def test_a_covering_tour_goes_to_the_nearest_new_way():
    graph = nx.MultiGraph(GRID.edges.tolist())
    ends = dict(zip(GRID.edge_names, GRID.edges.tolist(), strict=True))
    for seed in (None, 0, 1):
        walk = explore(GRID, seed=seed, tour="covering", start=0).walk
        places, walked, since = [int(place) for place in walk.places], set(), 0
        for k, way in enumerate(ways_of(walk)):
            if way not in walked:
                near = nx.single_source_shortest_path_length(graph, places[since])
                assert k - since == min(near[v] for name in ends.keys() - walked for v in ends[name])
                walked.add(way)
                since = k + 1
        assert since == walk.n_legs  # it stops at the end of the last new way
        assert walked == set(ends)
        assert build(walk).n_edges == 112
    assert len({explore(GRID, seed=s, tour="covering").walk.places for s in range(10)}) > 1
    assert explore(GRID, tour="covering").walk == explore(GRID, tour="covering").walk


@pytest.mark.parametrize("tour", ["depth-first", "covering"])
def test_tours_follow_each_other_from_where_the_last_ended(tour):
    options = {"seed": 7, "tour": tour}
    one, three = explore(GRID, **options), explore(GRID, **options, tours=3)
    assert three.walk.events[: len(one.walk.events)] == one.walk.events
    ways = ways_of(three.walk)
    first = len(ways_of(one.walk))
    assert min(ways.count(name) for name in GRID.edge_names) >= 3
    assert set(ways[:first]) == set(ways[first : 2 * first + 112]) == set(GRID.edge_names)
    assert build(three.walk).n_faces == build(one.walk).n_faces
    assert three.metres == pytest.approx(10 * len(ways))
    alone = SimulatedWorld([(0, 0)], np.empty((0, 2), int))
    assert explore(alone, tour=tour, tours=3).walk.events == (Visit("0", ()),)


def test_loops_and_parallel_ways_are_covered_too():
    loop, arc = [(0, 0), (0, 5), (-5, 5), (-5, 0), (0, 0)], [(0, 0), (5, 5), (10, 0)]
    world = SimulatedWorld([(0, 0), (10, 0), (3, 1)], [(0, 0), (0, 1), (0, 1), (0, 2)], [loop, None, arc, None])
    for seed in (None, *range(8)):
        plane = build(explore(world, seed=seed, tour="covering", tours=2, start=1).walk)
        assert (plane.n_vertices, plane.n_edges, plane.n_faces) == (3, 4, 3)


def test_exits_are_in_the_order_of_their_headings_unless_their_true_order_is_asked_for():
    def stars(walk):
        return [(int(v.place), [h.yaw for h in v.exits]) for v in walk.events if isinstance(v, Visit) and v.exits]

    noisy = {"seed": 2, "noise": 0.9, "drift": 0.5}
    assert all(yaws == sorted(yaws) for _, yaws in stars(explore(GRID, **noisy).walk))
    begins = set()
    for noise in (0.0, 1e-9, 0.9):
        walk = explore(GRID, seed=2, noise=noise, ordered_exits=True).walk
        assert walk.header.exits == "in-order"
        if noise < 0.1:  # near enough to tell which exit is which
            for place, yaws in stars(walk):
                true = GRID.heading[GRID.darts_at(place)]
                order = [int(np.abs(np.angle(np.exp(1j * (true - yaw)))).argmin()) for yaw in yaws]
                assert [(k - order[0]) % len(order) for k in order] == list(range(len(order)))
                begins.add((len(order), order[0]))
    assert {(4, k) for k in range(4)} <= begins  # they begin anywhere
    true = explore(GRID, seed=2, ordered_exits=True, noise=0.9).walk
    assert any(yaws != sorted(yaws) for _, yaws in stars(true))


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
        ({"noise": 5}, BadInput, r"noise is .* 0 to 1.047 \(60 degrees\), such as 0.035 for 2 degrees, not 5"),
        ({"noise": True}, BadInput, "noise is a standard deviation"),
        ({"drift": -0.1}, BadInput, "drift is the standard deviation"),
        ({"drift": 4}, BadInput, "drift is the standard deviation"),
        ({"tour": "random"}, BadInput, "a tour is 'depth-first', 'covering' or 'wall', not 'random'"),
        ({"tours": 0}, BadInput, "tours is how often to walk every way, 1 or more, not 0"),
        ({"tours": 1.5}, BadInput, "tours is how often"),
        ({"tours": True}, BadInput, "tours is how often"),
        ({"tours": 10**8}, BadInput, "a step of 1 m takes 4e.09 samples over 4e.09 m of ways"),
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
