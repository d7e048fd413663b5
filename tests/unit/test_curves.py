"""Legs as curves: tangents, turns and ends as given, plane drawings."""

import numpy as np
import pytest

from ninefold.layout import compass, drawing_problems
from ninefold.layout.shaping.curves import spirals
from ninefold.mapping import PlaneMap


def tangents(xy):
    step = np.diff(xy, axis=0)
    return np.unwrap(np.arctan2(step[:, 1], step[:, 0]))


@pytest.mark.parametrize("mean", np.radians([-50, -20, 0, 5, 40]))
@pytest.mark.parametrize("turn", np.radians([-300, -90, -1, 0, 30, 180, 300]))
def test_spirals_end_where_they_have_to_with_the_tangents_asked(mean, turn):
    xy, bend, found = spirals(np.array([mean]), np.array([turn]))
    if not found[0]:
        pytest.skip("no such curve")
    curve = xy[0]
    assert curve[0].tolist() == [0, 0]
    assert curve[-1] == pytest.approx([1, 0], abs=1e-9)
    angle = tangents(curve)
    half = 0.06 + 0.02 * abs(turn)  # a piece's direction is that of its middle, and rounding at the end is shared out
    off = (angle[0] - (mean - turn / 2) + np.pi) % (2 * np.pi) - np.pi
    assert off == pytest.approx(0, abs=half)
    assert angle[-1] - angle[0] == pytest.approx(turn, abs=2 * half)
    assert bend[0] >= abs(turn) - 1e-9


def test_most_curves_exist():
    mean, turn = (g.ravel() for g in np.meshgrid(np.radians(np.arange(-60, 61, 10)), np.radians(np.arange(-180, 181, 20))))
    assert spirals(mean, turn)[2].mean() > 0.95


@pytest.mark.parametrize("turn", np.radians([-180, -90, -10, 10, 90, 200, 300]))
def test_no_mean_is_an_arc_of_a_circle(turn):
    xy, bend, found = spirals(np.zeros(1), np.array([turn]))
    assert found[0]
    centre = np.array([0.5, 0.5 / np.tan(turn / 2)])
    assert np.hypot(*(xy[0] - centre).T) == pytest.approx(0.5 / abs(np.sin(turn / 2)), rel=1e-3)
    assert bend[0] == pytest.approx(abs(turn))


def test_no_mean_and_no_turn_is_a_straight_line():
    xy, bend, found = spirals(np.zeros(1), np.zeros(1))
    assert found[0]
    assert np.abs(xy[0, :, 1]).max() < 1e-12
    assert np.diff(xy[0, :, 0]) == pytest.approx(1 / 256)
    assert bend[0] == 0


def bent_square():
    """A square whose south side bulges out, by a quarter turn."""
    angle = np.linspace(-np.pi * 3 / 4, -np.pi / 4, 40)
    arc = np.stack([2 + 2 * np.sqrt(2) * np.cos(angle), 2 + 2 * np.sqrt(2) * np.sin(angle)], axis=1)
    arc[0], arc[-1] = (0, 0), (4, 0)
    corners = [(0, 0), (4, 0), (4, 4), (0, 4)]
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)]
    paths = [arc, *([corners[a], corners[b]] for a, b in edges[1:])]
    return PlaneMap.from_geometry(corners, edges, paths)


def test_by_option_a_leg_leaves_and_arrives_at_its_headings():
    plane = bent_square()
    straight, drawing = compass(plane), compass(plane, curved=True)
    assert drawing_problems(drawing) == ()
    assert len(straight.bends) == 0
    start = drawing.bend_start
    assert start[1] - start[0] >= 5
    assert start[-1] == start[1]  # the straight ones stay straight
    curve = np.concatenate([drawing.points[:1], drawing.bends[: start[1]], drawing.points[1:2]])
    angle = tangents(curve)
    piece = np.pi / 2 / (len(curve) - 1)
    assert angle[0] == pytest.approx(plane.heading[0] + piece / 2, abs=0.03)
    assert angle[-1] - angle[0] == pytest.approx(np.pi / 2 - piece, abs=0.06)


def test_curves_that_would_cross_stay_straight():
    """A shallow triangle on a side that bulges far beyond its tip when it is drawn round."""
    angle = np.linspace(np.pi * 1.05, -np.pi * 0.05, 60)
    bulge = np.stack([2 + 2.03 * np.cos(angle), 0.32 + 2.03 * np.sin(angle)], axis=1)
    bulge[0], bulge[-1] = (0, 0), (4, 0)
    points = [(0, 0), (4, 0), (1.5, 2.0)]
    plane = PlaneMap.from_geometry(points, [(0, 1), (0, 2), (2, 1)], [bulge, [(0, 0), (1.5, 2.0)], [(1.5, 2.0), (4, 0)]])
    for curved in (False, True):
        assert drawing_problems(compass(plane, curved=curved)) == ()


def test_loops_and_parallel_edges_are_smooth_in_any_case():
    def round_path(turns, n=40):
        angle = np.linspace(0, turns, n)
        return np.stack([np.sin(angle), 1 - np.cos(angle)], axis=1)

    loop = round_path(2 * np.pi)
    loop[-1] = loop[0] = (0, 0)
    plane = PlaneMap.from_geometry([(0, 0), (3, -2)], [(0, 0), (0, 1)], [loop * 0.9 + 0, [(0, 0), (3, -2)]])
    drawing = compass(plane)
    assert drawing_problems(drawing) == ()
    assert drawing.bend_start[1] > 20
    curve = np.concatenate([drawing.points[:1], drawing.bends[: drawing.bend_start[1]], drawing.points[:1]])
    assert np.abs(np.diff(tangents(curve))).max() < np.radians(25)
