"""Which of several maps is right, and where on it the robot is: against sums over all ways it can have gone."""

import random
from dataclasses import replace
from itertools import product
from math import exp, pi, radians

import numpy as np
import pytest

from ninefold.errors import BadInput, EmptyBelief, UnknownName
from ninefold.mapping import Heading, Localizer, PlaneMap, Samples, Visit, Walk, WalkHeader, hypotheses, locate_among
from ninefold.mapping.doubt.stretches import stretch_of
from ninefold.mapping.doubt.untravelled import with_ends
from tests.lattice import Lattice, straight

SIGMA = radians(8)
SQUARE = PlaneMap.from_geometry([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])
KITE = PlaneMap.from_geometry([(0, 0), (1, 0.1), (1.2, 1.2), (0.1, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])


def density(error):
    """Of an error, up to what is the same for all."""
    size = abs((error + pi) % (2 * pi) - pi) / SIGMA
    return exp(-size * size / 2) if size <= 6 else 0.0


def likelihood(plane, looks, moves):
    """Add up over all places to begin at and all ways taken; in every look each exit is each dart."""
    darts = [plane.darts_at(v) for v in range(plane.n_vertices)]

    def seen(v, look):
        pairs = (zip(look, order, strict=True) for order in product(darts[v], repeat=len(look)))
        orders = [list(pair) for pair in pairs]
        whole = [pairs for pairs in orders if len({d for _, d in pairs}) == len(look) == len(darts[v])]
        return sum(np.prod([density(yaw - plane.heading[d]) for yaw, d in pairs]) for pairs in whole)

    share = {v: seen(v, looks[0]) / plane.n_vertices for v in range(plane.n_vertices)}
    for move, look in zip(moves, looks[1:], strict=True):
        after = dict.fromkeys(share, 0.0)
        for v, p in share.items():
            for d in darts[v]:
                after[int(plane.tail[d ^ 1])] += p * density(move - plane.heading[d])
        share = {v: p * seen(v, look) for v, p in after.items()}
    return sum(share.values())


@pytest.mark.parametrize("seed", range(6))
def test_evidence_is_the_likelihood_of_all_that_was_seen(seed):
    rng = np.random.default_rng(seed)
    looks = [[0.0, pi / 2], [pi / 2, pi], [pi, 3 * pi / 2]]
    looks = [[yaw + rng.normal(0, SIGMA / 2) for yaw in look] for look in looks]
    moves = [rng.normal(0, SIGMA / 2), pi / 2 + rng.normal(0, SIGMA / 2)]
    found = []
    for plane in (SQUARE, KITE):
        robot = Localizer(plane, sigma=SIGMA).observe(list(map(Heading, looks[0])))
        for move, look in zip(moves, looks[1:], strict=True):
            robot.move(Heading(move)).observe(list(map(Heading, look)))
        found.append(robot.log_evidence)
    expected = [np.log(likelihood(plane, looks, moves)) for plane in (SQUARE, KITE)]
    assert found[0] - found[1] == pytest.approx(expected[0] - expected[1], abs=1e-9)
    assert found == pytest.approx(expected, abs=1e-9)


def test_evidence_before_anything_is_seen_is_that_of_what_is_certain():
    assert Localizer(SQUARE, sigma=SIGMA).log_evidence == 0.0


def rest_of(walk, visit):
    at = [k for k, event in enumerate(walk.events) if isinstance(event, Visit)]
    return Walk(walk.header, walk.events[at[visit] :])


@pytest.mark.parametrize("compass", [True, False])
def test_a_map_that_explains_the_longer_walk_too_is_never_ruled_out(compass):
    for seed in range(15):
        rng = random.Random(seed)
        world = Lattice.whole(2, 4).thinned(rng, 0.4)
        walk, true = world.walk(seed, 16, compass=compass)
        found, longer = hypotheses(stretch_of(walk, 0, 9)), hypotheses(walk)
        assert found.exact
        assert longer.exact
        going_on = {_numbered(one.visits[:10]) for one in longer}
        where = locate_among(found, rest_of(walk, 9), sigma=radians(2), start="end")
        assert where.weights.sum() == pytest.approx(1)
        left = {_numbered(one.visits) for one, weight in zip(found, where.weights, strict=True) if weight > 0}
        assert going_on <= left
        right = next(k for k, one in enumerate(found) if _numbered(one.visits) == _numbered(true[:10]))
        place = dict(zip(true, found.maps[right].visits.tolist(), strict=False)).get(true[-1])
        mine = {one.vertex for one in where.candidates(1.0) if one.map == right}
        assert mine & {None, *([] if place is None else [f"p{place}"])}


def _numbered(places):
    first = {}
    return tuple(first.setdefault(place, len(first)) for place in map(tuple, np.reshape(places, (len(places), -1)).tolist()))


def test_a_map_that_does_not_fit_has_no_weight():
    found = hypotheses(straight("ENWS"))
    merged, apart = (next(k for k, one in enumerate(found) if one.n_places == n) for n in (4, 5))
    walk = straight("E", "S")  # from the first place east, and then south, where nobody has been
    where = locate_among(found, walk, sigma=radians(2), start="end")
    assert where.weights[merged] == pytest.approx(where.weights[apart])
    seen = tuple(map(Heading.from_bearing, (0.0, 90.0)))
    two = Walk(WalkHeader(), (walk.events[0], walk.events[1], Visit(None, seen)))
    where = locate_among(found, two, sigma=radians(2), start="end")
    assert where.weights[merged] == 0
    assert where.localizers[merged] is None
    assert where.weights[apart] > 0
    assert where.candidates(1.0)[0].vertex is None
    assert repr(where).startswith(f"Whereabouts({int((where.weights > 0).sum())} of {found.count} maps left")


def test_a_walk_that_fits_on_no_map():
    found = hypotheses(straight("E", exits="EW"))
    north = Walk(WalkHeader(), (Visit(None, (Heading.from_bearing(0),)), Samples.of(Heading.from_bearing(0)), Visit(None)))
    with pytest.raises(EmptyBelief, match="event 1"):
        locate_among(found, north, sigma=radians(2))


def test_bad_questions():
    found = hypotheses(straight("E"))
    with pytest.raises(BadInput, match="no map"):
        locate_among([], straight("E"))
    with pytest.raises(BadInput, match="maps are those of hypotheses"):
        locate_among([SQUARE], straight("E"))
    with pytest.raises(BadInput, match="start is one of"):
        locate_among(found, straight("E"), start="middle")
    with pytest.raises(BadInput, match="mass is a probability"):
        locate_among(found, straight("E")).candidates(0)


def test_places_beyond_a_map_fit_everything_and_are_never_where_a_robot_begins():
    plane = PlaneMap.from_geometry([(0, 0), (1, 0), (2, 0)], [(0, 1), (1, 2)], vertex_names="abc")
    east, west, north = map(Heading.from_bearing, (90, 270, 0))
    robot = Localizer(plane, sigma=radians(3), beyond=["c"])
    assert {found.vertex for found in robot.candidates(1.0)} == {"a", "b"}
    robot.observe([east, west]).move(east, turn=4.0)
    assert robot.likeliest.vertex == "c"
    robot.observe([north, east, west], came_by=west).move(north, turn=1.0).observe([north])
    assert robot.likeliest.vertex == "c"
    assert robot.log_evidence == pytest.approx(-np.log(2), abs=1e-9)
    with pytest.raises(UnknownName):
        Localizer(plane, sigma=radians(3), beyond=["d"])


@pytest.mark.parametrize("compass", [True, False])
def test_every_exit_that_nobody_walked_leads_to_a_place_of_its_own(compass):
    walk = straight("ENWS", "ENE")
    for one in hypotheses(Walk(replace(walk.header, compass=compass), walk.events)):
        wide = with_ends(one)
        assert wide.n_places == one.n_places
        assert (wide.plane.degree[: one.n_places] == 4).all()
        assert (wide.plane.degree[one.n_places :] == 1).all()
        assert len(wide.unknown) == wide.plane.n_vertices - one.n_places
        wide.plane.validate()
