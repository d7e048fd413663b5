"""Answers and messages of `estimate`."""

import time
from dataclasses import replace
from itertools import islice
from math import radians

import numpy as np
import pytest
from explored import simulated
from noisy import every_dart, holds, outcome, true_plane, true_seen, walked, without_names

from ninefold.errors import BadInput, Undecided, WalkError
from ninefold.io import samples
from ninefold.mapping import Heading, Samples, SimulatedWorld, Visit, Walk, WalkHeader, estimate, explore
from ninefold.mapping.doubt.evidence import read_evidence
from ninefold.mapping.doubt.exit_lists import averaged, biases
from ninefold.mapping.doubt.legality import judged
from ninefold.mapping.doubt.noise import NoiseModel
from ninefold.mapping.doubt.whole_turns import misses_by_outer_face, outer_faces

SQUARE = SimulatedWorld([(0, 0), (9, 0), (9, 9), (0, 9)], [(0, 1), (1, 2), (2, 3), (3, 0)], vertex_names="abcd")
NEAR = SimulatedWorld([(0, 0), (9, 0), (9, 1), (-5, 3)], [(0, 1), (0, 2), (0, 3)], vertex_names="abcd")


def leg(*degrees, metres=None):
    return replace(Samples.of(*(Heading.from_degrees(d) for d in degrees)), metres=metres)


def exits(*degrees):
    return tuple(Heading.from_degrees(d) for d in degrees)


def log(*events, **header):
    return Walk(WalkHeader(**header), events)


def toured(world, degrees, seed=0, *, declared=None, **options):
    rng = np.random.default_rng(seed)
    declared = None if declared is None else radians(declared)
    return walked(world, every_dart(world, 0, rng), rng, sigma=radians(degrees), declared=declared, **options)


# -- bad input -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sigma", [0, 0.0, -0.1, radians(61), float("nan"), "2", True])
def test_a_sigma_that_is_none(sigma):
    with pytest.raises(WalkError, match="sigma is the standard deviation of a heading in radians, above 0 and at most"):
        estimate(log(Visit("a")), sigma=sigma)


def test_a_drift_that_is_none():
    with pytest.raises(WalkError, match="drift is the standard deviation"):
        estimate(log(Visit("a")), sigma=0.1, drift=-1)


def test_a_sigma_that_is_missing():
    with pytest.raises(BadInput, match="how much headings err is not declared; give sigma"):
        estimate(log(Visit("a")))


def test_no_walk():
    with pytest.raises(BadInput, match="an estimate is made from a Walk"):
        estimate("walk.jsonl", sigma=0.1)


def test_a_place_that_was_not_recognised():
    with pytest.raises(WalkError, match=r"event 3: a place that was not recognised \(null\)"):
        estimate(log(Visit("a"), leg(0), Visit(None)), sigma=0.1)


def test_lists_that_differ_in_number():
    events = Visit("a", exits(0)), leg(0), Visit("b", exits(180)), leg(180), Visit("a", exits(0, 90))
    with pytest.raises(WalkError, match="event 5: place 'a' lists 2 exits and listed 1 at event 1"):
        estimate(log(*events), sigma=0.1)


@pytest.mark.parametrize(
    ("events", "message"),
    [
        ((), "there is no map before the first place"),
        ((leg(0),), "event 1: a heading before the first place"),
        ((Visit("a"), Visit("b")), "event 2: two places with no heading between them"),
        ((Visit("a", edge="w"),), "event 1: edge 'w' is named at the first place"),
    ],
)
def test_a_walk_that_is_none(events, message):
    with pytest.raises(WalkError, match=message):
        estimate(log(*events), sigma=0.1)


def test_more_ways_than_exits_is_an_answer():
    events = Visit("a", exits(0)), leg(0), Visit("b"), leg(90), Visit("c"), leg(225), Visit("a")
    found = estimate(log(*events), sigma=radians(2))
    assert found.count == 0
    assert not found.certain
    (doubt,) = found.doubts
    assert (doubt.kind, doubt.places) == ("noise", ("a",))
    assert "2 ways leave 'a', which lists 1 exit" in str(doubt)
    assert list(found.maps()) == []
    assert found.bits is None
    for asked in ("plane", "best"):
        with pytest.raises(Undecided, match="2 ways leave 'a', which lists 1 exit"):
            getattr(found, asked)


# -- small walks ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sigma", [0.001, 0.1, radians(30), radians(60)])
def test_one_place_alone_is_certain(sigma):
    for place in (Visit("a"), Visit("a", ())):
        found = estimate(log(place), sigma=sigma)
        assert found.certain
        assert (found.plane.n_vertices, found.plane.n_edges) == (1, 0)


@pytest.mark.parametrize("sigma", [0.001, 0.1, radians(30), radians(60)])
def test_one_way_is_certain(sigma):
    found = estimate(log(Visit("a"), leg(10, 12), Visit("b")), sigma=sigma)
    assert found.certain
    assert (found.plane.n_vertices, found.plane.n_edges) == (2, 1)


def test_a_leg_without_end_and_exits_untaken_are_told():
    found = estimate(log(Visit("a", exits(0, 120)), leg(0), Visit("b"), leg(90)), sigma=radians(2))
    assert found.certain
    assert found.warnings == (
        "the walk ends on a leg from 'b', which is left out",
        "1 exit was never travelled, the first at 'a'",
    )


def test_names_of_edges_in_the_log():
    found = estimate(toured(simulated(3, "whole", 3), 1, names=True).walk)
    assert found.best.edge_names
    assert all(name.startswith("w") for name in found.best.edge_names)


def test_metres_are_averaged():
    events = Visit("a"), leg(0, 0, metres=10.0), Visit("b"), leg(180, 180, metres=12.0), Visit("a")
    assert estimate(log(*events), sigma=radians(2)).plane.metres.tolist() == [11.0]


def test_loops_and_parallel_ways_walked_both_ways_several_times():
    lens = SimulatedWorld(
        [(0, 0), (10, 0)],
        [(0, 1), (0, 1), (1, 1)],
        [None, [(0, 0), (5, 6), (10, 0)], [(10, 0), (14, 3), (14, -3), (10, 0)]],
    )
    for seed in range(20):
        rng = np.random.default_rng(seed)
        darts = [0, 4, 3, 2, 5, 1, 0, 5, 4, 1, 2, 1]
        truth = walked(lens, darts, rng, sigma=radians(2), exits=[None, "any-order", "in-order"][seed % 3])
        found = outcome(truth.walk)
        assert found.count == 1
        assert holds(found, true_seen(truth))
        plane = estimate(truth.walk).plane
        assert np.array_equal(plane.tail, true_plane(truth)[0].tail)  # every edge runs as it was first walked


def test_parallel_ways_run_as_each_was_first_walked():
    """The second way is first walked backwards, between places that the first joined forwards."""
    lens = SimulatedWorld([(0, 0), (10, 0)], [(0, 1), (0, 1)], [None, [(0, 0), (5, 6), (10, 0)]])
    truth = walked(lens, [0, 3], np.random.default_rng(0), sigma=radians(2))
    assert estimate(truth.walk).plane.tail.tolist() == [0, 1, 1, 0]


def test_a_loop_where_no_exits_are_listed():
    world = SimulatedWorld([(0, 0)], [(0, 0)], [[(0, 0), (4, 3), (4, -3), (0, 0)]])
    assert estimate(walked(world, [0, 1, 0], np.random.default_rng(0), sigma=radians(2), exits=None).walk).certain


# -- doubts --------------------------------------------------------------------------------------------------------------


def test_the_doubt_is_named():
    found = estimate(toured(NEAR, 4).walk)
    assert found.count == 2
    assert found.bits == 1.0
    (doubt,) = found.doubts
    assert (doubt.kind, doubt.places, len(doubt.orders)) == ("order", ("a",), 2)
    assert doubt.text == "at 'a' the dead end 'c' lies left or right of the dead end 'b'"
    with pytest.raises(Undecided, match="2 maps are left; at 'a' the dead end 'c' lies left or right"):
        found.plane  # noqa: B018
    assert found.best.n_edges == 3
    (again,) = found.more(doubt)
    assert (again.place, set(again.ways)) == ("a", {"b", "c"})
    assert again.passes is not None
    with pytest.raises(BadInput, match="one of this estimate's doubts"):
        found.more("a")


def test_what_to_walk_again_settles_it():
    """Walking the ways as often as told makes the map certain, most of the time."""
    found = estimate(toured(NEAR, 2, 1).walk)
    if not found.certain:
        low, high = found.more()[0].passes
        rng = np.random.default_rng(5)
        darts = every_dart(NEAR, 0, rng) + [0, 1, 2, 3] * high
        assert low <= high
        assert estimate(walked(NEAR, darts, rng, sigma=radians(2)).walk).certain


def test_a_narrow_corner_of_two_ways_is_a_doubt_about_the_outer_face():
    flat = SimulatedWorld([(0, 0), (10, 0), (5, 1)], [(0, 1), (1, 2), (2, 0)], vertex_names="abc")
    found = estimate(walked(flat, [0, 2, 4], np.random.default_rng(1), sigma=radians(8), exits=None).walk)
    assert found.count == 2
    assert [doubt.kind for doubt in found.doubts] == ["outer"]
    assert "which face is the outer one: 2 faces can be, as a corner at " in found.doubts[0].text
    assert len({plane.outer_face for plane in found.maps()}) == 2


@pytest.mark.parametrize("fold", [2, 3])
def test_understated_noise_is_said_to_be_so(fold):
    world = samples.load("helsinki_district").to_world()
    found = estimate(toured(world, 2 * fold, declared=2).walk)
    assert found.count == 0
    (doubt,) = found.doubts
    assert doubt.kind == "noise"
    assert "no map is left with headings that err by 2 degrees" in doubt.text
    assert "there is more noise than declared" in doubt.text
    assert found.scatter is not None
    assert found.scatter == pytest.approx(radians(2 * fold), rel=0.25)
    assert "the readings seem to err by" in doubt.text


def test_declared_noise_is_what_scatters():
    world = samples.load("helsinki_district").to_world()
    assert estimate(toured(world, 3).walk).scatter == pytest.approx(radians(3), rel=0.1)


def test_legs_too_many_to_share_out_are_no_sign_of_noise():
    """59 legs on two ways that are hard to tell apart: once held against their common mean, as if there were one way."""
    world = SimulatedWorld([(0, 0), (9, 7)], [(0, 1), (0, 1)], [None, [(0, 0), (4, -6), (9, 7)]])
    rng = np.random.default_rng(4)
    darts = [0, 3, 2, 1] * 15
    found = outcome(walked(world, darts, rng, sigma=radians(10), exits="in-order").walk)
    assert found.count != 0


# -- large noise ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("degrees", [30, 50])
def test_large_noise_on_the_district_is_in_doubt_and_quick(degrees):
    world = samples.load("helsinki_district").to_world()
    truth = toured(world, degrees)
    began = time.process_time()
    found = estimate(truth.walk)
    assert not found.certain
    assert found.count is None
    assert found.doubts
    assert time.process_time() - began < 20


def test_maps_come_at_once_where_they_are_not_counted():
    world = SimulatedWorld(
        [(10.0 * i, 10.0 * j) for i in range(4) for j in range(4)],
        [(4 * i + j, 4 * i + j + 4) for i in range(3) for j in range(4)]
        + [(4 * i + j, 4 * i + j + 1) for i in range(4) for j in range(3)],
    )
    found = estimate(toured(world, 22, exits=None).walk, effort=300)
    assert found.count is None
    assert any(doubt.kind == "uncounted" for doubt in found.doubts)
    assert len(list(islice(found.maps(), 3))) == 3
    assert found.best.n_edges == 24


def test_the_same_walk_gives_the_same_estimate():
    walk = toured(samples.load("helsinki_district").to_world(), 8).walk
    one, two = estimate(walk), estimate(walk)
    assert (one.count, one.doubts, one.scatter) == (two.count, two.doubts, two.scatter)
    assert np.array_equal(one.best.next_ccw, two.best.next_ccw)


def test_an_explored_walk_declares_its_noise():
    walk = without_names(explore(SQUARE, seed=1, noise=radians(2), tours=2).walk)
    assert estimate(walk).certain


# -- parts ---------------------------------------------------------------------------------------------------------------


def test_judging_compiled_is_judging_plain():
    rng = np.random.default_rng(0)
    legal = 0
    for _ in range(300):
        places, edges = int(rng.integers(1, 5)), int(rng.integers(1, 6))
        tail = rng.integers(0, places, 2 * edges)
        previous, corner = np.arange(2 * edges), np.full(2 * edges, 2 * np.pi)
        for place in range(places):
            darts = rng.permutation(np.flatnonzero(tail == place))
            previous[np.roll(darts, -1)] = darts
            if darts.size:
                corner[darts] = rng.dirichlet(np.ones(darts.size)) * 2 * np.pi
        turn = rng.integers(-1, 2, edges) * np.pi
        keep = rng.random(edges) < 0.8
        for turning in (0, 1):
            arguments = (previous, corner, turn, tail, keep, places, turning)
            plain, compiled = judged.plain(*arguments), judged.compiled(*arguments)
            assert plain[0] == compiled[0]
            assert plain[1].tolist() == compiled[1].tolist()
            legal += bool(plain[0])
    assert legal > 50


def test_lists_are_averaged_over_cyclic_shifts():
    rng = np.random.default_rng(0)
    true = np.radians([10, 80, 170, 260])
    for in_order in (False, True):
        lists = []
        for _ in range(9):
            yaw = (true + rng.normal(0, radians(2), 4) + np.pi) % (2 * np.pi) - np.pi
            lists.append(np.roll(yaw, int(rng.integers(4))) if in_order else np.sort(yaw))
        found = averaged(lists, radians(2) ** 2, in_order=in_order)
        assert found.count == 4
        (lift,) = found.lifts
        assert lift[-1] - lift[0] < 2 * np.pi
        assert np.all(np.diff(lift) > 0)
        start = np.argmin(np.abs(np.exp(1j * lift) - np.exp(1j * true[0])))
        assert np.abs(np.angle(np.exp(1j * (np.roll(lift, -start) - true)))).max() < radians(3)


def test_lists_in_order_that_run_backwards_contradict():
    lists = [np.radians([0, 270, 180, 90])]
    assert averaged(lists, radians(2) ** 2, in_order=True).contradicts


def test_the_wandering_of_a_gyro_is_read_from_the_lists():
    world = samples.load("helsinki_district").to_world()
    rng = np.random.default_rng(1)
    noise = NoiseModel(radians(1), radians(0.5), compass=False, in_order=True)
    truth = walked(
        world, every_dart(world, 0, rng), rng, sigma=noise.sigma, drift=noise.drift, compass=False, exits="in-order"
    )
    evidence = read_evidence(truth.walk)
    bias, known = biases(evidence, evidence.visits_of(), noise)
    assert known.all()
    assert bias.shape == (evidence.n_legs + 1,)
    unbiased = evidence.without(bias)
    by_place = {}
    for place, list_ in zip(evidence.at.tolist(), unbiased.exits, strict=True):
        by_place.setdefault(place, []).append(np.sort(np.exp(1j * list_)))
    for rows in by_place.values():  # lists of one place now lie over each other, to a few sigmas
        for row in rows[1:]:
            assert np.abs(row[:, None] - rows[0][None]).min(axis=1).max() < radians(8)


def test_the_outer_face_by_likelihood_where_rounding_fails():
    world = samples.load("helsinki_district").to_world()
    plane = world_map(world)
    rng = np.random.default_rng(0)
    sigma, tau = radians(5), radians(30)
    among = by_likelihood = by_rounding = 0
    next_face = np.asarray(plane.next_face, np.int32)
    face_of = np.asarray(plane.face_of, np.int32)
    heading = np.asarray(plane.heading)
    draws = 200
    corner = (heading[plane.next_ccw] - heading) % (2 * np.pi)
    corner[corner == 0] = 2 * np.pi
    right = np.ones(plane.n_faces)
    right[plane.outer_face] = -1
    for _ in range(draws):
        at_end = rng.normal(0, sigma, heading.size)
        turn = plane.turn + rng.normal(0, tau, plane.turn.size) + at_end[1::2] - at_end[0::2]
        total = np.pi - corner[next_face]
        total[0::2] += turn
        total[1::2] -= turn
        turned = np.bincount(face_of, weights=total, minlength=plane.n_faces) / (2 * np.pi)
        by_rounding += bool((np.rint(turned) == right).all())
        miss = misses_by_outer_face(
            next_face, face_of, plane.n_faces, corner, turn, np.full(turn.size, tau**2 + 2 * sigma**2)
        )
        found = outer_faces(miss).tolist()
        by_likelihood += found[0] == plane.outer_face
        among += plane.outer_face in found
    assert among == by_likelihood == draws
    assert by_rounding < 0.9 * draws


def world_map(world):
    rng = np.random.default_rng(0)
    return true_plane(walked(world, every_dart(world, 0, rng), rng, sigma=0.01))[0]


NARROW = SimulatedWorld(
    [(0, 0), (10, 0.2), (0, 0.5), (-5, -5), (-5, 5), (10, 9)], [(0, 1), (1, 2), (2, 0), (0, 3), (3, 4), (4, 2), (1, 5)]
)


def test_narrow_corners_are_weighed_where_a_gyro_wanders():
    """Two ways 2 degrees apart: which corner is wide moves a full turn from face to face, and was taken as it seemed."""
    kept = 0
    for seed in range(40):
        rng = np.random.default_rng(seed)
        darts = [0, 2, 4, 6, 8, 10, 3, 1]
        truth = walked(NARROW, darts, rng, sigma=radians(2), drift=radians(1), compass=False, exits="in-order", step=2.0)
        found = outcome(truth.walk)
        if found.count is not None:
            kept += 1
            assert holds(found, true_seen(truth))
    assert kept > 20


def test_too_many_narrow_corners_leave_the_outer_face_in_doubt(monkeypatch):
    monkeypatch.setattr("ninefold.mapping.doubt.reading.MOST_LIFTED", 0)
    rng = np.random.default_rng(0)
    truth = walked(SQUARE, [0, 2, 4, 6], rng, sigma=radians(2), drift=radians(1), compass=False)
    found = estimate(truth.walk)
    assert found.count is None
    assert [doubt.kind for doubt in found.doubts] == ["outer"]
    assert "too many narrow corners" in found.doubts[0].text


def test_gyro_readings_without_any_map_are_an_answer():
    """Once a singular matrix: a reading that cannot be drawn has no faces to weigh."""
    world = SimulatedWorld(
        [(0, 0), (9, 0), (4, 8)],
        [(0, 1), (0, 1), (1, 2), (1, 2), (2, 0), (2, 0)],
        [None, [(0, 0), (4, -3), (9, 0)], None, [(9, 0), (9, 5), (4, 8)], None, [(4, 8), (-1, 5), (0, 0)]],
    )
    for seed in range(30):
        rng = np.random.default_rng(seed)
        darts = every_dart(world, 0, rng) * 2
        truth = walked(world, darts, rng, sigma=radians(10), drift=radians(3), compass=False, exits="in-order")
        found = outcome(truth.walk)
        assert holds(found, true_seen(truth)) is not False


def test_many_readings_of_a_crowded_place_take_no_time():
    """Two places and many ways between them, all in doubt together: every reading was once listed to the end."""
    bows = [[(0, 0), (5, y), (10, 0)] for y in (-4, -2.5, -1, 1, 2.5, 4)]
    world = SimulatedWorld([(0, 0), (10, 0)], [(0, 1)] * 6, bows)
    rng = np.random.default_rng(0)
    walk = walked(world, [0, 3, 4, 7, 8, 11] * 4, rng, sigma=radians(14), drift=radians(10)).walk
    began = time.process_time()
    found = estimate(walk)
    assert found.count is None
    assert found.doubts
    assert time.process_time() - began < 10
