"""The oracle agrees with the symbolic answers on thousands of maps, and notices whatever is made wrong."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from random_maps import MAP_KINDS, random_map
from worlds import KINDS, world

import ninefold.layout.oracle as oracle
from ninefold.errors import BadInput, DifferentMaps
from ninefold.layout import Drawing, draw, drawing_problems, schnyder, verify, verify_geometry
from ninefold.layout.shrinking import shrink, without_edges
from ninefold.mapping import Line, PlaneMap, Point, Region
from ninefold.reasoner import Relation, relate

maps = st.builds(random_map, st.integers(0, 2**32 - 1), st.sampled_from(MAP_KINDS), st.integers(0, 50))


@settings(max_examples=1500, deadline=None)
@given(maps, st.integers(0, 2**32 - 1))
def test_relations_agree_on_the_schnyder_drawing(plane, seed):
    report = verify(plane, seed=seed, n_pairs=60)
    assert report.agree, str(report)
    assert report.pairs == 60


@settings(max_examples=300, deadline=None)
@given(maps, st.integers(0, 2**32 - 1))
def test_relations_agree_on_the_tutte_drawing(plane, seed):
    report = verify(plane, seed=seed, n_pairs=60, layout="tutte")
    assert report.agree, str(report)


@settings(max_examples=200, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(KINDS), st.integers(1, 30))
def test_relations_agree_on_the_true_geometry(seed, kind, size):
    w = world(seed, kind, size)
    report = verify_geometry(w.plane, w.geometry, seed=seed, n_pairs=60)
    assert report.agree, str(report)
    assert report.layout == ""


def ladder(rungs=6):
    points = [(x, y) for x in range(rungs) for y in (0, 1)]
    edges = [(2 * x, 2 * x + 1) for x in range(rungs)]
    edges += [(2 * x + y, 2 * x + 2 + y) for x in range(rungs - 1) for y in (0, 1)]
    return PlaneMap.from_geometry(points, edges)


def grid(side=7):
    points = [(x, y) for x in range(side) for y in range(side)]
    edges = [(side * x + y, side * x + y + 1) for x in range(side) for y in range(side - 1)]
    edges += [(side * x + y, side * x + y + side) for x in range(side - 1) for y in range(side)]
    return PlaneMap.from_geometry(points, edges)


# -- the drawing can be wrong --------------------------------------------------------------------------------------------


@settings(max_examples=200, deadline=None)
@given(maps, st.integers(0, 2**32 - 1))
def test_a_swap_of_two_darts_is_noticed(plane, seed):
    """Two darts that change places around a vertex of three or more: another map, so the old drawing is not one of it."""
    rng = np.random.default_rng(seed)
    candidates = np.flatnonzero(plane.degree >= 3)
    if not len(candidates) or plane.tether.any():
        return
    around = plane.darts_at(int(rng.choice(candidates)))
    i = int(rng.integers(len(around)))
    swapped = around.copy()
    j = (i + 1) % len(around)
    swapped[i], swapped[j] = swapped[j], swapped[i]
    after = plane.next_ccw.copy()
    after[swapped] = np.roll(swapped, -1)
    try:
        other = PlaneMap.from_darts(plane.tail, after, plane.outer)
    except BadInput:  # the swap is no plane map: nothing to draw
        return
    drawing = schnyder(plane)
    wrong = Drawing.from_points(other, drawing.points, drawing.bends, drawing.bend_start)
    report = verify(other, drawing=wrong, n_pairs=10)
    assert not report.agree
    assert report.pairs == 0
    assert "rotation" in report.problems[0]


@settings(max_examples=200, deadline=None)
@given(maps, st.integers(0, 2**32 - 1))
def test_a_vertex_moved_far_away_is_noticed(plane, seed):
    """Beyond the hull a vertex of an inner cycle must cross something, or else turn a rotation."""
    inner = np.setdiff1d(np.arange(plane.n_vertices), plane.tail[plane.face_of == plane.outer_face])
    inner = inner[plane.degree[inner] >= 1]
    if not len(inner):
        return
    drawing = schnyder(plane)
    points = drawing.points.copy()
    points[np.random.default_rng(seed).choice(inner)] += 10 * points.max() + 100
    moved = Drawing.from_points(plane, points, drawing.bends, drawing.bend_start)
    assert not verify(plane, drawing=moved, n_pairs=10).agree


def test_a_vertex_on_an_edge_and_a_lone_vertex_in_the_wrong_face_are_noticed():
    split = [(0, 0), (4, 0), (4, 4), (0, 4), (3, 1)]
    plane = PlaneMap.from_geometry(split, [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)])
    assert drawing_problems(Drawing.from_points(plane, split)) == ()
    for spot, word in (((1, 3), "host"), ((9, 9), "host"), ((2, 2), "lies on edge"), ((4, 4), "lies on edge")):
        moved = Drawing.from_points(plane, [*split[:4], spot])
        assert word in drawing_problems(moved)[0]


def test_two_lone_vertices_on_one_spot_are_noticed():
    plane = PlaneMap.from_geometry([(0, 0), (1, 1), (2, 5)], np.zeros((0, 2), int))
    assert drawing_problems(Drawing.from_points(plane, [(0, 0), (1, 1), (2, 5)])) == ()
    assert drawing_problems(Drawing.from_points(plane, [(0, 0), (1, 1), (1, 1)])) == (
        "two isolated vertices lie on each other",
    )


def test_the_wrong_outer_face_is_noticed():
    plane = PlaneMap.from_rotation(
        {"a": [("b", "x"), ("b", "y"), ("b", "z")], "b": [("a", "z"), ("a", "y"), ("a", "x")]}, outer=0
    )
    other = PlaneMap.from_darts(plane.tail, plane.next_ccw, 2)
    drawing = schnyder(plane)
    assert plane.outer_face != other.outer_face
    assert drawing_problems(drawing) == ()
    wrong = Drawing.from_points(other, drawing.points, drawing.bends, drawing.bend_start)
    assert drawing_problems(wrong) == ("the outer face is not the map's",)


def test_a_mirror_image_is_noticed():
    plane = ladder()
    drawing = schnyder(plane)
    assert "rotation" in drawing_problems(Drawing.from_points(plane, drawing.points * (-1, 1)))[0]


# -- the answer can be wrong ---------------------------------------------------------------------------------------------


@pytest.fixture
def lying(monkeypatch):
    """A ``relate`` that calls two regions which meet in a point disjoint."""

    def relate_wrongly(x, y):
        r = relate(x, y)
        return Relation.from_de9im("FF2FF1212") if r.de9im == "FF2F01212" else r

    monkeypatch.setattr(oracle, "relate", relate_wrongly)


def test_a_wrong_answer_is_shown_with_both_matrices_and_shrunk(lying):
    plane = grid()
    x = plane.cycle([0, 1, 2, 9, 16, 15, 14, 7])
    y = plane.cycle([16, 17, 18, 25, 32, 31, 30, 23])
    report = verify(plane, [x, y])
    assert not report.agree
    assert (report.pairs, report.wrong) == (4, 2)
    text = str(report)
    assert "  I   F F 2   F F 2\n" in text
    assert "  B   F F 1   F 0 1   <\n" in text
    assert "<svg" in report.disagreements[0].to_svg()
    small = report.disagreements[0].minimal()
    assert (small.symbolic, small.geometric) == ("FF2FF1212", "FF2F01212")
    # Two loops at one vertex are the least that touch in a point.
    assert (small.x.plane.n_vertices, small.x.plane.n_edges) == (1, 2)
    assert "<svg" in small._repr_svg_()


def test_sampling_finds_the_wrong_answer(lying):
    assert not verify(grid(), seed=3, n_pairs=2000).agree


def test_a_wrong_geometry_is_noticed():
    w = world(5, "whole", 20)
    shifted = verify_geometry(
        w.plane, lambda x: shapely.transform(w.geometry(x), lambda c: c * (1 + x.dimension)), n_pairs=300
    )
    assert not shifted.agree
    assert "disagree on the given geometry" in repr(shifted)
    lost = shifted.disagreements[0]
    assert lost.minimal() is lost  # on a fresh drawing the two do agree, so there is nothing smaller to show


# -- shrinking -----------------------------------------------------------------------------------------------------------


@settings(max_examples=150, deadline=None)
@given(maps, st.integers(0, 2**32 - 1))
def test_shrinking_keeps_the_relation(plane, seed):
    """Every step of the shrinker is a sub-map on which unused things are gone: relations stay what they were."""
    rng = np.random.default_rng(seed)
    sets, _ = oracle.sample_pairs(plane, 1, rng)
    x, y = sets[0], sets[1]
    word = relate(x, y).name
    a, b = shrink(x, y, lambda a, b: relate(a, b).name == word, most_trials=60)
    assert relate(a, b).name == word
    assert a.plane == b.plane
    assert a.plane.tether.size <= plane.tether.size
    assert verify(a.plane, [(a, b)]).agree


@settings(max_examples=300, deadline=None)
@given(maps, st.integers(0, 2**32 - 1))
def test_dropping_unused_edges_changes_no_relation(plane, seed):
    rng = np.random.default_rng(seed)
    sets, _ = oracle.sample_pairs(plane, 1, rng)
    x, y = sets[2], sets[3]
    used = {e for s in (x, y) if not isinstance(s, Point) for e in s.edge_set}
    unused = [e for e in range(plane.tether.size) if e not in used and rng.random() < 0.7]
    a, b = without_edges((x, y), unused)
    assert relate(a, b) == relate(x, y)
    kept = {plane.edge_names[e] for e in range(plane.tether.size)} - {plane.edge_names[e] for e in unused}
    real = {a.plane.edge_names[e] for e in np.flatnonzero(~a.plane.tether)}
    assert real == {plane.edge_names[e] for e in np.flatnonzero(~plane.tether)} & kept


# -- what is asked -------------------------------------------------------------------------------------------------------


def test_sets_pairs_and_nothing_to_compare():
    plane = ladder()
    sets = [plane.face(f) for f in range(plane.n_faces) if f != plane.outer_face][:3]
    assert verify(plane, sets).pairs == 9
    assert verify(plane, [(sets[0], sets[1]), (sets[1], plane.vertex(0))]).pairs == 2
    assert verify(plane, []).pairs == 0
    assert verify(plane, n_pairs=7, seed=1) == verify(plane, n_pairs=7, seed=1)


def test_bad_questions():
    plane, other = ladder(), ladder(4)
    with pytest.raises(BadInput, match="sets of the map"):
        verify(plane, ["vertex:0"])
    with pytest.raises(DifferentMaps):
        verify(plane, [other.vertex(0)])
    with pytest.raises(BadInput, match="another map"):
        verify(plane, drawing=draw(other))
    with pytest.raises(BadInput, match="at least one"):
        verify(plane, n_pairs=0)
    with pytest.raises(BadInput, match="did you mean 'schnyder'"):
        verify(plane, layout="schneider")


def test_samples_hold_every_kind_of_set_and_relation():
    plane = world(1, "dense", 40).plane
    sets, pairs = oracle.sample_pairs(plane, 3000, np.random.default_rng(0))
    assert pairs.shape == (3000, 2)
    assert {type(x) for x in sets} == {Point, Line, Region}
    words = {relate(sets[i], sets[j]).name for i, j in pairs.tolist()}
    assert words == {"disjoint", "meet", "overlap", "equal", "contains", "inside", "covers", "coveredBy"}
