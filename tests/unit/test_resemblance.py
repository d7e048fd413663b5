"""How much a drawing looks like the place."""

import numpy as np
import pytest

from ninefold.errors import BadInput, DifferentMaps
from ninefold.io import samples
from ninefold.layout import Drawing, TrueShapes, compass, heading_errors, misplacement
from ninefold.mapping import PlaneMap

CORNERS = np.array([(0.0, 0.0), (3.0, 0.0), (3.0, 4.0), (0.0, 4.0)])
AROUND = [(0, 1), (1, 2), (2, 3), (3, 0)]


@pytest.fixture
def square():
    return PlaneMap.from_geometry(CORNERS, AROUND)


def drawn(plane, points):
    return Drawing.from_points(plane, points)


def test_a_moved_and_scaled_drawing_is_in_place(square):
    assert misplacement(drawn(square, 7 * CORNERS - 3), drawn(square, CORNERS)) == pytest.approx(0, abs=1e-12)


def test_one_vertex_off_by_its_share_of_the_diameter(square):
    moved = CORNERS.copy()
    moved[2] += (0.05, 0)
    got = misplacement(drawn(square, moved), drawn(square, CORNERS))
    by_hand = 0.05 * np.sqrt(3) / 4 / 5  # rms about the mean of (0.05, 0, 0, 0), over the diagonal of 3 x 4
    assert got == pytest.approx(by_hand, rel=0.1)


def test_a_turned_drawing_is_in_place_only_if_it_may_be_turned(square):
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    assert misplacement(drawn(square, CORNERS @ turn), drawn(square, CORNERS), turned=True) == pytest.approx(0, abs=1e-12)
    assert misplacement(drawn(square, CORNERS @ turn), drawn(square, CORNERS)) == pytest.approx(0.5, abs=1e-9)


def test_the_fit_never_turns_a_drawing_round(square):
    assert misplacement(drawn(square, -CORNERS), drawn(square, CORNERS)) == pytest.approx(0.5)


def test_heading_errors_are_signed_and_leave_out_loops():
    path = [(3, 0), (4, -1), (5, 0), (4, 1), (3, 0)]
    plane = PlaneMap.from_geometry([(0, 0), (3, 0)], [(0, 1), (1, 1)], [None, path])
    straight = drawn(plane, [(0.0, 0.0), (1.0, np.tan(0.1))])
    off = heading_errors(straight)
    assert off[0] == pytest.approx(0.1)
    assert np.isnan(off[1])


def test_an_evenly_curved_leg_runs_along_its_chord():
    arc = np.stack([np.cos(np.linspace(0, np.pi / 2, 50)), np.sin(np.linspace(0, np.pi / 2, 50))], axis=1)
    plane = PlaneMap.from_geometry(arc[[0, -1]], [(0, 1)], [arc])
    assert abs(heading_errors(drawn(plane, arc[[0, -1]]))).max() < 1e-9


def test_what_cannot_be_compared_is_refused(square):
    other = samples.load("office").to_map()
    with pytest.raises(DifferentMaps, match="draw two maps"):
        misplacement(drawn(square, CORNERS), compass(other))
    with pytest.raises(BadInput, match="no extent"):
        misplacement(drawn(square, CORNERS), drawn(square, 0 * CORNERS))
    bare = PlaneMap.from_rotation({"a": ["b"], "b": ["a"]})
    with pytest.raises(BadInput, match="no headings"):
        heading_errors(drawn(bare, [(0.0, 0.0), (1.0, 0.0)]))


def test_the_compass_puts_the_district_where_it_is():
    source = samples.load("helsinki_district")
    plane = source.to_map()
    ground = TrueShapes(source).drawing(plane)
    drawing = compass(plane)
    off = np.degrees(np.abs(heading_errors(drawing)))
    assert np.nanmedian(off) < 0.1
    assert np.nanpercentile(off, 95) < 3
    assert misplacement(drawing, ground) < 0.05
