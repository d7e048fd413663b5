"""Localizer: what it believes, what it refuses, and what it says when nothing is left."""

import pickle
from collections import defaultdict
from math import degrees, floor, pi, radians, tau

import numpy as np
import pytest
from worlds import random_sets, world

from ninefold.errors import BadInput, DifferentMaps, EmptyBelief, TooLarge, WalkError
from ninefold.mapping import Follower, Heading, Localizer, PlaneMap, Samples, Visit, Walk, WalkHeader, locate
from ninefold.reasoner import relate

EAST, NORTH, WEST, SOUTH = (Heading.from_bearing(b) for b in (90, 0, 270, 180))


@pytest.fixture
def yard():
    """A square 0 1 2 3 with a dead end 4 east of 1."""
    return PlaneMap.from_geometry([(0, 0), (2, 0), (2, 1), (0, 1), (3, 0)], [(0, 1), (1, 2), (2, 3), (3, 0), (1, 4)])


def grid(columns, rows):
    points = [(x, y) for y in range(rows) for x in range(columns)]
    edges = [(y * columns + x, y * columns + x + 1) for y in range(rows) for x in range(columns - 1)]
    edges += [(y * columns + x, (y + 1) * columns + x) for y in range(rows - 1) for x in range(columns)]
    return PlaneMap.from_geometry(points, edges)


def exits(plane, vertex):
    v = plane.vertex_names.row(vertex)
    return [Heading(plane.heading[d]) for d in plane.darts_at(v) if not plane.tether[d >> 1]]


def names(robot):
    return sorted(found.vertex for found in robot.candidates(1))


def shares(robot):
    return {found.vertex: found.probability for found in robot.candidates(1)}


# -- belief ----------------------------------------------------------------------------------------------------------------


def test_before_anything_was_seen_every_place_is_as_likely(yard):
    robot = Localizer(yard, sigma=0.1)
    assert shares(robot) == pytest.approx(dict.fromkeys("01234", 0.2))
    assert {found.dart for found in robot.candidates()} == {None}
    assert not robot.certain
    assert robot.entropy == pytest.approx(np.log2(5))


def test_looks_and_moves_chain(yard):
    robot = Localizer(yard, sigma=radians(5)).observe(exits=[WEST, NORTH, EAST]).move(2).observe(exits=[WEST], came_by=0)
    assert robot.certain
    assert (robot.likeliest.vertex, robot.likeliest.dart) == ("4", yard.darts_at(4)[0])
    assert robot.moves == 1
    assert repr(robot) == "Localizer(at 4, 1 move)"


def test_the_order_in_which_exits_are_listed_is_of_no_matter(yard):
    for order in ([WEST, NORTH, EAST], [EAST, WEST, NORTH]):
        robot = Localizer(yard, sigma=radians(5)).observe(order).move(order.index(NORTH))
        assert robot.likeliest.vertex == "2"


def test_without_a_compass_only_angles_count(yard):
    robot = Localizer(yard, sigma=radians(5), compass=False).observe([Heading(1.0), Heading(1.0 + pi / 2)])
    assert names(robot) == ["0", "2", "3"]
    assert shares(robot) == pytest.approx(dict.fromkeys("023", 1 / 3))


def test_a_new_offset_at_every_place_changes_nothing_without_a_compass(yard):
    found = []
    for offset in (0.0, 2.0):
        robot = Localizer(yard, sigma=radians(5), compass=False)
        robot.observe([Heading(h.yaw + offset) for h in (WEST, NORTH, EAST)])
        robot.move(2).observe([Heading(offset)], came_by=0)
        found.append(shares(robot))
    assert found[0] == pytest.approx(found[1])
    assert max(found[0], key=found[0].get) == "4"


def test_near_tied_exits_are_summed_over_and_both_are_left_by():
    """Two ways 6 degrees apart, headings that err by 5: the list shows them in the wrong order about as often as not."""
    ends = [(10 * np.cos(a), 10 * np.sin(a)) for a in (0.0, radians(6), radians(180))]
    plane = PlaneMap.from_geometry([(0, 0), *ends], [(0, 1), (0, 2), (0, 3)])
    robot = Localizer(plane, sigma=radians(5)).observe([Heading(radians(3)), Heading(radians(3)), Heading(pi)])
    assert robot.likeliest.vertex == "0"
    robot.move(0)
    assert shares(robot) == pytest.approx({"1": 0.5, "2": 0.5})
    robot = Localizer(plane, sigma=radians(5)).observe([Heading(radians(-1)), Heading(radians(5)), Heading(pi)]).move(0)
    # exp(-(1 + 1) / 50) against exp(-(7^2 + 5^2) / 50)
    ratio = np.exp(-((7**2 + 5**2) - (1 + 1)) / 50)
    assert shares(robot) == pytest.approx({"1": 1 / (1 + ratio), "2": ratio / (1 + ratio)})


def test_the_way_back_tells_which_way_the_robot_came(yard):
    robot = Localizer(yard, sigma=radians(5)).observe(came_by=WEST)
    assert names(robot) == ["1", "2", "4"]
    assert shares(robot)["4"] == pytest.approx(0.2 / (0.2 + 0.2 / 3 + 0.2 / 2))
    assert all(degrees(yard.heading[found.dart]) == pytest.approx(180) for found in robot.candidates())


def test_a_heading_on_leaving_is_weighed(yard):
    robot = Localizer(yard, sigma=radians(5)).move(NORTH)
    assert shares(robot) == pytest.approx({"2": 0.5, "3": 0.5})


def test_a_turn_tells_apart_ways_that_wind_otherwise():
    """Two ways leave eastwards: one straight on, one inwards along a spiral of two turns, which no heading tells."""
    spiral = [(-3, -3), (3, -3), (3, 3), (-2, 3), (-2, -2), (2, -2), (2, 2), (-1, 2), (-1, -1), (1, -1), (1, 1), (0, 1)]
    plane = PlaneMap.from_geometry(
        [(-9, -3), (0, 1), (-9, -9), (0, -9)], [(0, 1), (2, 3), (0, 2)], [[(-9, -3), *spiral], None, None]
    )
    wound = float(plane.turn[0])
    assert wound > 2 * tau
    for compass in (True, False):
        robot = Localizer(plane, sigma=radians(10), compass=compass)
        assert robot.fork().move(EAST, turn=wound).likeliest.vertex == "1"
        assert robot.fork().move(EAST, turn=0.1).likeliest.vertex != "1"


def test_a_robot_may_be_where_there_is_no_way_out():
    plane = PlaneMap.from_geometry([(0, 0), (1, 0), (5, 5)], [(0, 1)])
    assert plane.n_components == 2
    robot = Localizer(plane, sigma=0.1).observe(exits=[])
    assert (robot.likeliest.vertex, robot.likeliest.dart, robot.certain) == ("2", None, True)
    with pytest.raises(BadInput, match="no exits were observed here, so there is none to choose"):
        robot.best_move()
    with pytest.raises(EmptyBelief, match=r"none of the 1 place possible before fits a way at 90 deg; '2' was among them"):
        robot.move(NORTH)
    alone = Localizer(PlaneMap.from_geometry([(0, 0)], []), sigma=0.1, compass=False)
    assert alone.certain
    assert alone.observe(exits=[]).likeliest.vertex == "0"


def test_tethers_are_no_exits():
    for seed in range(12):
        plane = world(seed, "nested", 4).plane
        for name in plane.vertex_names:
            robot = Localizer(plane, sigma=0.01).observe(exits(plane, name))
            assert name in names(robot)
            assert {plane.degree[plane.vertex_names.row(v)] for v in names(robot)} == {len(exits(plane, name))}


def test_several_components(yard):
    both = PlaneMap.from_geometry([(0, 0), (2, 0), (2, 1), (0, 1), (9, 0), (9, 1)], [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5)])
    robot = Localizer(both, sigma=0.1).observe([NORTH]).move(0)
    assert robot.likeliest.vertex == "5"
    assert robot.certain


def test_many_looks_do_not_wear_the_truth_away():
    """300 looks at 10 degrees; every single one is unlikely, and their product is far below the smallest float."""
    plane, rng, sigma = grid(6, 5), np.random.default_rng(4), radians(10)
    robot, at, back = Localizer(plane, sigma=sigma), 7, None
    for _ in range(300):
        ways = plane.darts_at(at)
        seen = [Heading(plane.heading[d] + float(np.clip(rng.normal(0, sigma), -5 * sigma, 5 * sigma))) for d in ways]
        robot.observe(seen, came_by=None if back is None else ways.index(back))
        out = int(rng.integers(len(ways)))
        robot.move(out)
        back = ways[out] ^ 1
        at = int(plane.tail[back])
    assert robot.probabilities[at] > 0.5
    assert robot.probabilities.sum() == pytest.approx(1)


def test_a_fork_goes_on_by_itself(yard):
    robot = Localizer(yard, sigma=0.1)
    other = robot.fork().observe([WEST, SOUTH])
    assert other.certain
    assert names(robot) == list("01234")


def test_where_the_robot_was_switched_on_may_be_known(yard):
    robot = Localizer(yard, sigma=0.1, start=yard.edge("1", "4"))
    assert names(robot) == ["1", "4"]
    robot = Localizer(yard, sigma=0.1, compass=False, start=yard.cycle(["0", "1", "2", "3"]))
    assert names(robot) == ["0", "1", "2", "3"]


def test_exits_may_be_missed_or_made_up(yard):
    with pytest.raises(EmptyBelief):
        Localizer(yard, sigma=0.05).observe([WEST, EAST])
    robot = Localizer(yard, sigma=0.05, missed=0.05).observe([WEST, EAST])
    assert robot.likeliest.vertex == "1"
    assert robot.best_move().left == pytest.approx(1)
    assert robot.move(robot.best_move()).likeliest.vertex == "0"
    with pytest.raises(EmptyBelief):
        Localizer(yard, sigma=0.05).observe([WEST, SOUTH, Heading(1.0)])
    robot = Localizer(yard, sigma=0.05, extra=0.05).observe([WEST, SOUTH, Heading(1.0)])
    assert robot.likeliest.vertex == "2"
    robot.move(1)
    assert robot.likeliest.vertex == "1"


# -- sets ------------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(12))
def test_inside_is_what_relate_calls_inside(seed):
    plane = world(seed, ("dense", "nested", "half", "ring")[seed % 4], 8).plane
    robot = Localizer(plane, sigma=0.1)
    for item in random_sets(np.random.default_rng(seed), plane, 12):
        relations = [relate(plane.vertex(name), item).name for name in plane.vertex_names]
        within = sum(name in ("inside", "equal") for name in relations) / plane.n_vertices
        boundary = sum(name == "meet" for name in relations) / plane.n_vertices
        assert robot.inside(item) == pytest.approx(within)
        assert robot.inside(item, closed=True) == pytest.approx(within + boundary)


def test_inside_is_for_sets_of_the_map(yard):
    robot = Localizer(yard, sigma=0.1)
    with pytest.raises(DifferentMaps):
        robot.inside(grid(2, 2).vertex("0"))
    with pytest.raises(BadInput, match=r"a point, line or region of the map is needed, not 'hall'"):
        robot.inside("hall")


# -- where to go -----------------------------------------------------------------------------------------------------------


def test_the_best_move_leads_to_where_places_differ():
    """A corridor of alike places: only towards the near end does it tell where one is."""
    plane = PlaneMap.from_geometry([(x, 0) for x in range(6)] + [(2, 1)], [(x, x + 1) for x in range(5)] + [(2, 6)])
    robot = Localizer(plane, sigma=radians(3)).observe([WEST, EAST])
    assert names(robot) == ["1", "3", "4"]
    forecast = robot.forecast()
    assert [move.heading for move in forecast] == [WEST, EAST]
    # westwards 1, 3 and 4 come to a dead end, the fork and a place like their own; eastwards 1 comes to the fork, 3 to 4
    assert [move.left for move in forecast] == pytest.approx([1.0, 1.0])
    assert robot.best_move() == forecast[0]
    assert robot.move(robot.best_move()).observe([EAST]).likeliest.vertex == "0"


@pytest.mark.parametrize("compass", [True, False])
def test_where_no_move_tells_apart_the_robot_heads_for_where_places_differ(compass):
    """Two corridors alike but for a stub at the far east end: going back and forth in the west would never tell."""
    corridor = [(x, x + 1) for x in range(6)]
    points = [(x, y) for y in (0, 9) for x in range(7)] + [(6, 1)]
    plane = PlaneMap.from_geometry(points, [*corridor, *((a + 7, b + 7) for a, b in corridor), (6, 14)])
    robot = Localizer(plane, sigma=radians(3), compass=compass, start=plane.line(["0", "6"]))
    robot.observe([EAST]).move(0)
    for x in range(1, 6):
        robot.observe([WEST, EAST], came_by=0)
        assert names(robot) == sorted([str(x), str(x + 7)])
        assert robot.forecast()[0].exit == (1 if x == 5 else 0)  # one move ahead both are alike, until the last
        assert robot.best_move().exit == 1
        robot.move(robot.best_move())
    assert robot.observe([WEST, NORTH], came_by=0).likeliest.vertex == "6"


def test_where_nothing_ever_tells_apart_the_first_exit_is_taken():
    plane = PlaneMap.from_geometry([(0, 0), (1, 0), (0, 5), (1, 5)], [(0, 1), (2, 3)])
    robot = Localizer(plane, sigma=radians(3)).observe([EAST])
    assert robot.best_move().left == pytest.approx(2)
    assert robot.move(robot.best_move()).observe([WEST]).best_move().left == pytest.approx(2)


@pytest.mark.parametrize("compass", [True, False])
@pytest.mark.parametrize("seed", range(6))
def test_the_forecast_counts_what_is_left_in_expectation(seed, compass):
    rng = np.random.default_rng(seed)
    plane = grid(7, 6)
    keep = rng.random(plane.tether.size) < 0.85
    ends = plane.tail.reshape(-1, 2)[keep]
    used, rows = np.unique(ends, return_inverse=True)
    plane = PlaneMap.from_geometry([(v % 7, v // 7) for v in used.tolist()], rows.reshape(-1, 2))
    sigma = radians(2)
    robot = Localizer(plane, sigma=sigma, compass=compass)
    seen = sorted(exits(plane, plane.vertex_names[int(rng.integers(plane.n_vertices))]), key=lambda h: h.yaw)
    robot.observe(seen, came_by=None if compass else 0)
    cell = max(3 * sigma, radians(5))
    for move in robot.forecast():
        groups, likely = defaultdict(set), defaultdict(float)
        found = robot.candidates()
        total = sum(one.probability for one in found)
        for one in found:
            v = plane.vertex_names.row(one.vertex)
            ways = sorted(
                (d for d in plane.darts_at(v) if not plane.tether[d >> 1]), key=lambda d: Heading(plane.heading[d]).yaw
            )
            at = move.exit if compass else (move.exit + ways.index(one.dart)) % len(ways)
            back = ways[at] ^ 1
            there = [d for d in plane.darts_at(plane.tail[back]) if not plane.tether[d >> 1]]
            zero = 0.0 if compass else plane.heading[back]
            look = tuple(sorted(floor(((plane.heading[d] - zero) % tau) / cell) for d in there))
            groups[look].add(back)
            likely[look] += one.probability / total
        expected = sum(likely[look] * len(groups[look]) for look in groups)
        assert move.left == pytest.approx(expected, abs=1e-6)


def test_a_random_kidnapped_robot_is_found():
    plane, rng, sigma = world(5, "dense", 60).plane, np.random.default_rng(1), radians(3)
    right = 0
    for _ in range(40):
        at, back = int(rng.integers(plane.n_vertices)), None
        robot = Localizer(plane, sigma=sigma, compass=False)
        for _ in range(6):
            ways = [d for d in plane.darts_at(at) if not plane.tether[d >> 1]]
            if not ways:
                robot.observe([])
                break
            turned = rng.uniform(-3, 3)
            seen = [Heading(plane.heading[d] + rng.normal(0, sigma) + turned) for d in ways]
            robot.observe(seen, came_by=None if back is None else ways.index(back))
            if robot.certain:
                break
            chosen = robot.best_move()
            robot.move(chosen)
            back = ways[chosen.exit] ^ 1
            at = int(plane.tail[back])
        right += robot.likeliest.vertex == plane.vertex_names[at]
    assert right >= 38


# -- nothing left ----------------------------------------------------------------------------------------------------------


def test_an_empty_belief_is_named_and_changes_nothing(yard):
    robot = Localizer(yard, sigma=radians(2)).observe([WEST, NORTH, EAST]).move(0)
    before = shares(robot), robot.moves
    with pytest.raises(EmptyBelief) as caught:
        robot.observe([EAST, Heading.from_degrees(60)], came_by=0)
    assert str(caught.value) == (
        "after 1 look and 1 move no place is left: none of the 1 place possible before fits 2 exits at 0, 60 deg; nearest "
        "comes '0', its headings off by 30 deg; either the map is wrong or the noise model is (sigma 2 degrees)"
    )
    assert (caught.value.observation, caught.value.moves, caught.value.nearest) == (2, 1, "0")
    assert (shares(robot), robot.moves) == before
    assert robot.observe([EAST, NORTH], came_by=0).likeliest.vertex == "0"


def test_a_number_of_exits_that_no_place_has_is_named(yard):
    with pytest.raises(EmptyBelief, match=r"fits 4 exits at -90, 0, 90, 180 deg; none has so many, '1' has 3 exits"):
        Localizer(yard, sigma=0.1).observe([WEST, NORTH, EAST, SOUTH])


def test_a_move_that_fits_nowhere_is_named(yard):
    robot = Localizer(yard, sigma=0.1).observe([WEST])
    with pytest.raises(EmptyBelief, match=r"fits a way at 0 deg; nearest comes '4', its headings off by 180 deg"):
        robot.move(EAST)
    assert robot.likeliest.vertex == "4"
    with pytest.raises(EmptyBelief, match="possible before fits a way that turns by 172 deg"):
        robot.move(0, turn=3.0)
    with pytest.raises(EmptyBelief, match=r"sigma 1.15 degrees, without a compass"):
        Localizer(yard, sigma=0.02, compass=False).observe([WEST, Heading(1.0)])


def test_messages_speak_the_unit_of_the_log(yard):
    with pytest.raises(EmptyBelief, match=r"fits 1 exit at bearing 45 deg; .* off by 135 deg"):
        Localizer(yard, sigma=0.1, unit="bearing-deg").observe([Heading.from_bearing(45)])


# -- bad input -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sigma", [0, -0.1, radians(61), float("nan"), True, "5", None])
def test_a_sigma_that_is_none_is_refused(yard, sigma):
    said = r"sigma is the standard deviation of a heading in radians, above 0 and at most 1\.047"
    with pytest.raises(BadInput, match=said):
        Localizer(yard, sigma=sigma)


def test_what_cannot_be_is_refused_in_one_line(yard):
    robot = Localizer(yard, sigma=0.1)
    cases = [
        (lambda: robot.observe(), "nothing was seen"),
        (lambda: robot.observe([0.5]), r"an exit is a Heading, such as Heading.from_degrees\(90\), not 0.5"),
        (lambda: robot.observe(EAST), "exits are a list of headings"),
        (lambda: robot.observe("east"), "exits are a list of headings"),
        (lambda: robot.observe([EAST], came_by=1), "came_by is a position in the 1 exit given, from 0 on, not 1"),
        (lambda: robot.observe([EAST], came_by=0.5), "came_by is the position of an exit, or a Heading, not 0.5"),
        (lambda: robot.move(0), "no exits were observed here, so none can be told by its position"),
        (lambda: robot.move(0.5), "an exit is its position in the list observed, or a Heading, not 0.5"),
        (
            lambda: robot.fork().observe([WEST]).move(1),
            "the list observed has 1 exit, from 0 on; there is none at position 1",
        ),
        (lambda: robot.move(EAST, turn=float("inf")), "a turn is a finite number of radians, not inf"),
        (lambda: robot.candidates(0), "mass is a probability above 0 and at most 1, not 0"),
        (lambda: Localizer("yard.atlas", sigma=0.1), "a PlaneMap is needed, such as read_map gives, not 'yard.atlas'"),
        (lambda: Localizer(yard, sigma=0.1, unit="deg"), "unit is one of yaw-rad, yaw-deg, bearing-deg, not 'deg'"),
        (lambda: Localizer(yard, sigma=0.1, missed=1), "missed is a probability from 0 to below 1, not 1"),
        (lambda: Localizer(yard, sigma=0.1, extra=0.1, compass=False), "missed and extra are for compass=True"),
        (lambda: Localizer(PlaneMap.from_rotation({"a": ["b"], "b": ["a"]}), sigma=0.1), "has no headings"),
    ]
    for call, message in cases:
        with pytest.raises(BadInput, match=message) as caught:
            call()
        assert "\n" not in str(caught.value)
    assert names(robot) == list("01234")


def test_too_many_exits_too_close_together_are_refused_not_guessed():
    n = 40
    hub = [(0, 0), *((np.cos(a), np.sin(a)) for a in np.arange(n) * tau / n)]
    plane = PlaneMap.from_geometry(hub, [(0, i + 1) for i in range(n)])
    robot = Localizer(plane, sigma=radians(10))
    with pytest.raises(TooLarge, match="40 exits of one place lie so close together"):
        robot.observe([Heading(plane.heading[d]) for d in plane.darts_at(0)])
    assert len(robot.candidates(1)) == n + 1


# -- along a walk ----------------------------------------------------------------------------------------------------------


def walk_of(*events, **header):
    return Walk(WalkHeader(**header), events)


def test_a_walk_without_exits_is_located_by_its_legs(yard):
    walk = walk_of(Visit(None), Samples.of(NORTH), Visit(None), Samples.of(WEST), Visit(None))
    assert locate(yard, walk).likeliest.vertex == "3"
    assert locate(yard, walk, start=yard.vertex("1")).certain


def test_names_of_places_in_a_walk_are_not_looked_at(yard):
    walk = walk_of(Visit("nowhere"), Samples.of(EAST), Visit("0"), Samples.of(EAST), Visit("0"))
    assert locate(yard, walk).likeliest.vertex == "4"


def test_a_walk_without_a_compass_is_located(yard):
    turned = 1.0
    samples = [Samples.of(*(Heading(h.yaw + turned) for h in hs)) for hs in ((EAST,), (NORTH,), (WEST,))]
    at = [tuple(Heading(h.yaw + turned) for h in exits(yard, name)) for name in "0123"]
    walk = walk_of(Visit(None, at[0]), samples[0], Visit(None, at[1]), samples[1], Visit(None, at[2]), compass=False)
    robot = locate(yard, walk, sigma=radians(3))
    assert robot.likeliest.vertex == "2"
    assert not robot.compass


def test_sigma_comes_from_the_header(yard):
    leg = Samples.of(Heading.from_degrees(20))
    walk = walk_of(Visit(None), leg, Visit(None), sigma=radians(2))
    with pytest.raises(EmptyBelief, match=r"^event 3: after 0 looks and 0 moves .* \(sigma 2 degrees\)"):
        locate(yard, walk)
    assert locate(yard, walk_of(Visit(None), leg, Visit(None))).moves == 1  # 5 degrees where nothing is declared


def test_a_follower_is_as_it_was_after_an_error(yard):
    follower = Follower(yard, sigma=0.1)
    with pytest.raises(WalkError, match="event 1: a heading before the first place"):
        follower.step(Samples.of(EAST))
    assert follower.step(Visit(None, (WEST, EAST, NORTH)))
    assert follower.localizer.likeliest.vertex == "1"
    with pytest.raises(WalkError, match="event 2: no heading"):
        follower.step(Visit(None))
    assert not follower.step(Samples.of(EAST))
    with pytest.raises(EmptyBelief) as caught:
        follower.step(Visit(None, (SOUTH, EAST)))
    assert caught.value.event == 3
    assert not caught.value.reason.startswith("event")
    again = pickle.loads(pickle.dumps(caught.value))
    assert (again.event, str(again)) == (3, str(caught.value))
    assert follower.localizer.moves == 0
    assert follower.step(Visit(None, (WEST,)))
    assert follower.localizer.likeliest.vertex == "4"
