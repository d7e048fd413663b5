"""Compass drawings are legible: legs that turn back are curves, and parts in the way stay large enough to see."""

import numpy as np
import shapely

from ninefold.io import samples
from ninefold.layout import TrueShapes, compass, drawing_problems, misplacement, tutte


def roundness(drawing, face):
    """4 pi area / perimeter squared: 1 for a disc, near 0 for a needle."""
    shape = drawing.geometry(drawing.plane.face(face))
    return 4 * np.pi * shape.area / shape.length**2


def test_a_way_around_a_corner_leaves_no_needle():
    plane = samples.load("crossing").to_map()
    drawing = compass(plane)
    assert not drawing_problems(drawing)
    assert min(roundness(drawing, f) for f in range(plane.n_faces) if f != plane.outer_face) > 0.3
    around = int(np.argmax(np.abs(plane.turn)))
    assert len(drawing.path(around)) > 10
    assert [len(drawing.path(e)) for e in range(plane.n_edges) if e != around] == [2] * (plane.n_edges - 1)


def test_in_the_district_legs_that_turn_back_are_curves_and_others_are_not():
    plane = samples.load("helsinki_district").to_map()
    drawing = compass(plane)
    ends = plane.tail.reshape(-1, 2)
    pairs = {}
    for e, (u, v) in enumerate(ends.tolist()):
        pairs.setdefault((min(u, v), max(u, v)), []).append(e)
    single = [rows[0] for (u, v), rows in pairs.items() if len(rows) == 1 and u != v]
    bent = {e for e in single if len(drawing.path(e)) > 2}
    assert bent
    assert all(abs(plane.turn[e]) > np.radians(100) for e in bent)
    lines = shapely.MultiLineString([drawing.path(e) for e in range(plane.n_edges)])
    assert len(shapely.get_parts(shapely.node(lines))) == plane.n_edges


def test_a_room_in_the_way_has_its_corridor_shortened_too():
    source = samples.load("house")
    plane = source.to_map()
    drawing = compass(plane)

    def length(a, b):
        return np.hypot(*np.subtract(*drawing.points[[plane.vertex_names.row(a), plane.vertex_names.row(b)]]))

    assert length("stair", "bath") > length("nw", "ne") / 8
    assert length("nw", "stair") < length("nw", "ne")
    ground = TrueShapes(source).drawing(plane)
    assert misplacement(drawing, ground) < misplacement(tutte(plane), ground, turned=True)
