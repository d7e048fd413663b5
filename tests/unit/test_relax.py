"""The relaxed drawing: the same map, plane, with wider angles and lengths more alike than Tutte's."""

import numpy as np
import pytest
from random_maps import random_map
from worlds import braced, world

from ninefold.layout import Drawing, draw, drawing_problems, relax, schnyder, tutte
from ninefold.layout.methods import relax as module
from ninefold.mapping import PlaneMap


def without_headings(plane):
    return PlaneMap.from_darts(plane.tail, plane.next_ccw, plane.outer, tether=plane.tether)


def least_angle(drawing):
    """Degrees between the two closest edges at each vertex with several."""
    plane = drawing.plane
    spots = np.concatenate([drawing.points, drawing.bends]).astype(float)
    found = []
    for v in range(plane.n_vertices):
        darts = [d for d in plane.darts_at(v) if not plane.tether[d >> 1]]
        if len(darts) > 1:
            step = spots[plane.tail[np.array(darts) ^ 1]] - spots[v]
            angle = np.sort(np.arctan2(step[:, 1], step[:, 0]))
            found.append(np.degrees(np.diff(np.append(angle, angle[0] + 2 * np.pi)).min()))
    return np.array(found)


def lengths(drawing):
    a, b = drawing.points[drawing.plane.tail.reshape(-1, 2).T].astype(float)
    return np.hypot(*(b - a).T)[~drawing.plane.tether]


def test_the_figures_asked_for():
    """At the median of some maps: a least angle five times Tutte's, the longest to the shortest edge at most 30."""
    wide, even = [], []
    for seed in range(8):
        plane = without_headings(PlaneMap.from_geometry(*braced(150, 0.15, seed)))
        given = tutte(plane)
        drawing = relax(given)
        assert drawing.layout == "relaxed"
        assert drawing.notes == ()
        wide.append(least_angle(drawing).min() / least_angle(given).min())
        even.append(lengths(drawing).max() / lengths(drawing).min())
    assert np.median(wide) >= 5
    assert np.median(even) <= 30


@pytest.mark.parametrize("layout", [tutte, schnyder])
@pytest.mark.parametrize("seed", range(4))
def test_any_plane_drawing_is_relaxed(layout, seed):
    drawing = relax(layout(random_map(seed, "simple", 30)))
    assert drawing.layout == "relaxed"
    assert drawing_problems(drawing) == ()


def test_dead_ends_are_as_long_as_others():
    plane = without_headings(PlaneMap.from_geometry(*braced(80, 0.3, 2)))
    drawing = relax(tutte(plane))
    dead = (plane.degree[plane.tail.reshape(-1, 2)] == 1).any(axis=1)[~plane.tether]
    assert dead.sum() > 5
    assert lengths(drawing)[dead].min() > 0.2 * np.median(lengths(drawing))


def test_headings_play_no_part():
    plane = PlaneMap.from_geometry(*braced(30, 0.4, 2))
    assert np.array_equal(relax(tutte(plane)).points, relax(tutte(without_headings(plane))).points)


def test_a_drawing_with_bends_of_its_own_is_given_back():
    plane = PlaneMap.from_geometry([(0, 0), (2, 0), (1, 2)], [(0, 1), (1, 2), (2, 0)])
    bent = Drawing.from_points(plane, [(0, 0), (2, 0), (1, 2)], [(1.0, -1.0)], [0, 1, 1, 1])
    assert drawing_problems(bent) == ()
    drawing = relax(bent)
    assert np.array_equal(drawing.bends, bent.bends)
    assert drawing.notes == ("not relaxed: its edges have bends of their own",)


def test_a_drawing_too_large_is_given_back(monkeypatch):
    monkeypatch.setattr(module, "LARGEST", 10)
    given = tutte(without_headings(world(1, "whole", 20).plane))
    drawing = relax(given)
    assert drawing.points is given.points
    assert "too many to relax" in drawing.notes[0]


def test_without_a_picture_of_its_directions_the_drawing_itself_is_relaxed(monkeypatch):
    plane = without_headings(PlaneMap.from_geometry(*braced(60, 0.3, 1)))
    monkeypatch.setattr(module, "plane_picture", lambda pieces: None)
    given = tutte(plane)
    drawing = relax(given)
    assert drawing.notes == ()
    assert drawing_problems(drawing) == ()
    assert least_angle(drawing).min() > least_angle(given).min()


def test_what_is_nested_too_deep_for_tutte_is_relaxed():
    plane = random_map(103, "bundles", 43)
    drawing = draw(plane, layout="relaxed")
    assert tutte(plane).layout == "schnyder"
    assert drawing.layout == "relaxed"
    assert not [note for note in drawing.notes if "not relaxed" in note]
    assert drawing_problems(drawing) == ()
