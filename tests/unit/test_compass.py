"""The compass drawing: north up, true proportions where directions fix them, and a plain word where there is none."""

import numpy as np
import pytest
from worlds import braced, jittered

from ninefold.errors import BadInput
from ninefold.io import samples
from ninefold.layout import compass, drawing_problems, relax, rigidity, tutte
from ninefold.layout.methods import compass as module
from ninefold.mapping import PlaneMap

CORNERS = [(0, 0), (3, 0), (3, 1), (0, 1)]
BRACED = PlaneMap.from_geometry(CORNERS, [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)])


def directions(drawing):
    a, b = drawing.points[drawing.plane.tail.reshape(-1, 2).T]
    return np.arctan2(*(b - a).T[::-1])


def apart(a, b):
    return np.degrees(np.abs((a - b + np.pi) % (2 * np.pi) - np.pi))


def test_a_braced_rectangle_has_its_sides():
    drawing = compass(BRACED)
    assert drawing.layout == "compass"
    assert drawing.notes == ()
    step = drawing.points[[1, 2]] - drawing.points[[0, 1]]
    assert apart(directions(drawing), BRACED.heading[0::2]).max() < 1
    assert step[0, 0] / step[1, 1] == pytest.approx(3, rel=0.08)  # evening lengths out costs a little


def test_an_open_rectangle_is_evened_out():
    drawing = compass(PlaneMap.from_geometry(CORNERS, [(0, 1), (1, 2), (2, 3), (3, 0)]))
    step = drawing.points[[1, 2]] - drawing.points[[0, 1]]
    assert step[0, 0] / step[1, 1] == pytest.approx(1, rel=0.05)


def test_a_tree_keeps_every_heading():
    plane = PlaneMap.from_geometry(*braced(60, 0.0, 3))
    drawing = compass(plane)
    assert drawing.layout == "compass"
    assert np.percentile(apart(directions(drawing), plane.heading[0::2]), 95) < 2.1


def test_headings_with_noise_are_kept_as_well_as_they_agree():
    points, edges = jittered(8, 0.2, 1)
    plane = PlaneMap.from_geometry(points, edges)
    true = plane.heading[0::2]
    error = np.radians(5) * np.random.default_rng(1).standard_normal(true.size)
    drawing = compass(plane, chords=true + error)
    assert drawing.layout == "compass"
    assert np.median(apart(directions(drawing), true)) < 3
    assert np.median(apart(directions(drawing), true)) < np.median(np.degrees(np.abs(error)))


def test_chords_are_used_instead_of_headings():
    sheared = np.array(CORNERS) @ [[1, 0], [0.2, 1]]
    step = sheared[BRACED.tail.reshape(-1, 2)]
    chords = np.arctan2(*(step[:, 1] - step[:, 0]).T[::-1])
    assert apart(directions(compass(BRACED, chords=chords)), chords).max() < 1


@pytest.mark.parametrize("wrong", [[0.0], np.zeros(6), np.full(5, np.inf), np.zeros((5, 1)), 0.0])
def test_chords_of_another_shape_are_turned_down(wrong):
    with pytest.raises(BadInput, match="chords are one finite angle in radians for each of 5 edges, not"):
        compass(BRACED, chords=wrong)


def test_a_map_without_headings_is_told_what_to_do():
    with pytest.raises(BadInput, match="so it has no compass drawing; the layouts relaxed and tutte need none"):
        compass(PlaneMap.from_rotation({"a": ["b"], "b": ["a"]}))


def test_where_no_picture_is_found_the_drawing_says_so(monkeypatch):
    plane = PlaneMap.from_geometry(*braced(20, 0.5, 1))
    monkeypatch.setattr(module, "plane_picture", lambda pieces, **_: None)
    drawing = compass(plane)
    assert drawing.layout == "tutte"
    assert drawing.notes == ("no plane picture with these headings was found; this is the Tutte drawing",)
    assert np.array_equal(drawing.points, tutte(plane).points)


def test_a_map_too_large_says_so(monkeypatch):
    monkeypatch.setattr(module, "MOST_VERTICES", 10)
    drawing = compass(PlaneMap.from_geometry(*braced(20, 0.5, 1)))
    assert drawing.layout == "tutte"
    assert drawing.notes[0].startswith("20 vertices are too many for a compass drawing")


def test_what_is_wrong_with_a_picture_is_noticed(monkeypatch):
    """Nothing that the shaping does is trusted."""
    monkeypatch.setattr(module, "drawing_problems", lambda drawing: ("it looks odd",))
    drawing = compass(BRACED)
    assert drawing.layout == "tutte"
    assert "it looks odd" in drawing.notes[0]


def test_one_degree_in_the_district_is_one_degree():
    plane = samples.load("helsinki_district").to_map()
    drawing = compass(plane)
    assert drawing.layout == "compass"
    assert drawing_problems(drawing) == ()
    straight = (np.abs(plane.turn) < np.radians(3)) & (np.diff(drawing.bend_start) == 0)
    off = apart(directions(drawing), plane.heading[0::2])[straight]
    assert np.median(off) < 1
    assert np.percentile(off, 95) < 4


@pytest.mark.parametrize("long", [1.0, 2.5, 4.0])
def test_a_braced_rectangle_has_its_measured_proportions(long):
    corners = [(0.0, 0.0), (long, 0.0), (long, 1.0), (0.0, 1.0)]
    points = compass(PlaneMap.from_geometry(corners, [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)])).points
    assert np.hypot(*(points[1] - points[0])) / np.hypot(*(points[2] - points[1])) == pytest.approx(long, rel=0.005)


def test_what_is_no_map_or_drawing_says_what_to_call():
    house = samples.load("house").to_map()
    with pytest.raises(BadInput, match=r"relax takes a drawing of a map: relax\(tutte\(plane\)\)"):
        relax(house)
    with pytest.raises(BadInput, match=r"relax takes a Drawing, not 'x'; draw\(plane\) makes one"):
        relax("x")
    for call, name in ((compass, "compass"), (rigidity, "rigidity")):
        with pytest.raises(BadInput, match=rf"{name} takes a PlaneMap, not 'x'"):
            call("x")
        with pytest.raises(BadInput, match=rf"{name} takes a map, and a Source makes one: {name}\(X\.to_map\(\)\)"):
            call(samples.load("house"))
