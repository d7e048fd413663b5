"""Drawings from headings, and relaxed ones, on every kind of map: plane and true to it, or another layout that says so."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_maps import MAP_KINDS, random_map
from worlds import KINDS, braced, world

from ninefold.errors import BadInput
from ninefold.io import samples
from ninefold.layout import compass, draw, drawing_problems, relax, tutte, verify
from ninefold.mapping import PlaneMap

SHARED = Path(__file__).resolve().parents[3] / "shared"

maps = st.builds(random_map, st.integers(0, 2**32 - 1), st.sampled_from(MAP_KINDS), st.integers(0, 60))
seeds = st.integers(0, 2**32 - 1)


def right_or_said(drawing, name):
    assert drawing_problems(drawing) == ()
    if drawing.layout != name:
        assert drawing.notes
    return drawing.layout == name and not drawing.notes


@settings(max_examples=80, deadline=None)
@given(maps)
def test_relaxed_drawings_of_maps_without_headings(plane):
    right_or_said(draw(plane, layout="relaxed"), "relaxed")


def test_relaxed_drawings_are_seldom_given_up():
    """Also where parts are nested so deep that Tutte's drawing is too fine for floating point."""
    done = [
        right_or_said(relax(tutte(random_map(seed, kind, 45))), "relaxed") for kind in MAP_KINDS for seed in range(100, 106)
    ]
    assert sum(done) >= 0.9 * len(done)


@settings(max_examples=80, deadline=None)
@given(seeds, st.sampled_from(KINDS), st.integers(1, 40), st.booleans())
def test_compass_drawings_of_maps_from_geometry(seed, kind, size, curved):
    """Loops, parallel legs, bends, islands and isolated vertices come up."""
    right_or_said(compass(world(seed, kind, size).plane, curved=curved), "compass")


@settings(max_examples=40, deadline=None)
@given(seeds, st.sampled_from(KINDS), st.integers(1, 30))
def test_relaxed_drawings_keep_islands(seed, kind, size):
    right_or_said(draw(world(seed, kind, size).plane, layout="relaxed"), "relaxed")


@pytest.mark.parametrize("noise", [0, 5])
@pytest.mark.parametrize(("share", "asked"), [(0.05, 0.95), (0.15, 0.99), (0.5, 0.99)])
def test_unseen_graphs_come_out_plane(share, asked, noise):
    done = []
    for seed in range(12):
        points, edges = braced(200, share, seed)
        plane = PlaneMap.from_geometry(points, edges)
        step = points[edges[:, 1]] - points[edges[:, 0]]
        error = np.radians(noise) * np.random.default_rng(seed).standard_normal(len(edges))
        drawing = compass(plane, chords=np.arctan2(step[:, 1], step[:, 0]) + error)
        done.append(right_or_said(drawing, "compass"))
    assert np.mean(done) >= asked


def misses(points, drawn):
    """Distances between two pictures, one moved and sized to fit the other, in units of its diagonal."""
    a, b = points - points.mean(axis=0), drawn - drawn.mean(axis=0)
    a, b = a[:, 0] + 1j * a[:, 1], b[:, 0] + 1j * b[:, 1]
    size = (b.conj() @ a).real / (b.conj() @ b).real
    return np.abs(a - size * b) / np.hypot(*np.ptp(points, axis=0))


def test_what_is_braced_has_its_true_shape():
    for seed in range(3):
        points, edges = braced(300, 0.9, seed)
        assert np.median(misses(points, compass(PlaneMap.from_geometry(points, edges)).points)) < 0.002
        points, edges = braced(300, 0.5, seed)
        assert np.median(misses(points, compass(PlaneMap.from_geometry(points, edges)).points)) < 0.03


@pytest.mark.parametrize("layout", ["auto", "compass", "relaxed", "tutte", "schnyder"])
def test_the_same_map_gives_the_same_bytes(layout):
    for seed, kind in ((3, "half"), (4, "sparse"), (5, "nested")):
        one, other = (draw(world(seed, kind, 40).plane, layout=layout) for _ in range(2))
        assert one.points.tobytes() == other.points.tobytes()
        assert one.bends.tobytes() == other.bends.tobytes()
        assert one.to_svg() == other.to_svg()


@settings(max_examples=60, deadline=None)
@given(seeds, st.sampled_from(KINDS), st.integers(1, 25), st.sampled_from(["compass", "relaxed"]))
def test_relations_agree_on_maps_from_geometry(seed, kind, size, layout):
    report = verify(world(seed, kind, size).plane, seed=seed, n_pairs=60, layout=layout)
    assert report.agree, str(report)
    assert report.pairs == 60


@settings(max_examples=60, deadline=None)
@given(maps, seeds)
def test_relations_agree_on_relaxed_drawings(plane, seed):
    report = verify(plane, seed=seed, n_pairs=60, layout="relaxed")
    assert report.agree, str(report)


@pytest.mark.parametrize("layout", ["compass", "relaxed"])
@pytest.mark.parametrize("name", sorted(samples.names()))
def test_the_bundled_worlds(name, layout):
    plane = samples.load(name).to_map()
    drawing = draw(plane, layout=layout)
    assert right_or_said(drawing, layout)
    assert verify(plane, n_pairs=300, drawing=drawing).agree


# -- special maps --------------------------------------------------------------------------------------------------------


def ring_of_loops(n):
    """A vertex with n loops, each within the next."""
    angle = np.radians(10 + 70 * np.arange(1, n + 1) / n)
    x, y = (np.arange(1, n + 1) * f(angle) for f in (np.cos, np.sin))
    paths = [[(0, 0), (-a, -b), (-3 * k - 3, 0), (-a, b), (0, 0)] for k, (a, b) in enumerate(zip(x, y, strict=True))]
    return PlaneMap.from_geometry([(0, 0)], [(0, 0)] * n, paths)


def star(n):
    angle = 2 * np.pi * np.arange(n) / n
    return PlaneMap.from_geometry(
        np.vstack([[0, 0], np.stack([np.cos(angle), np.sin(angle)], axis=1)]), [(0, k + 1) for k in range(n)]
    )


def path(n):
    return PlaneMap.from_geometry([(k, np.sin(k)) for k in range(n + 1)], [(k, k + 1) for k in range(n)])


def grid(side):
    spots = [(x, y) for y in range(side) for x in range(side)]
    edges = [(side * y + x, side * y + x + 1) for y in range(side) for x in range(side - 1)]
    return PlaneMap.from_geometry(
        spots, edges + [(side * y + x, side * y + x + side) for y in range(side - 1) for x in range(side)]
    )


def squares(depth):
    spots = [(r * x, r * y) for r in range(depth, 0, -1) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    return PlaneMap.from_geometry(
        [*spots, (0.3, 0.2)], [(4 * k + i, 4 * k + (i + 1) % 4) for k in range(depth) for i in range(4)]
    )


SPECIAL = {
    "vertex": lambda: PlaneMap.from_geometry([(0, 0)], np.zeros((0, 2), int)),
    "two lone vertices": lambda: PlaneMap.from_geometry([(0, 0), (1, 0)], np.zeros((0, 2), int)),
    "edge": lambda: PlaneMap.from_geometry([(0, 0), (3, 1)], [(0, 1)]),
    "loop": lambda: ring_of_loops(1),
    "nested loops": lambda: ring_of_loops(6),
    "two parallel edges": lambda: PlaneMap.from_geometry(
        [(0, 0), (2, 0)], [(0, 1), (0, 1)], [[(0, 0), (1, 1), (2, 0)], [(0, 0), (1, -1), (2, 0)]]
    ),
    "squares in squares": lambda: squares(5),
    "star": lambda: star(2000),
    "path": lambda: path(3000),
    "grid": lambda: grid(40),
}


@pytest.mark.parametrize("layout", ["compass", "relaxed"])
@pytest.mark.parametrize("name", SPECIAL)
def test_special_maps(name, layout):
    assert right_or_said(draw(SPECIAL[name](), layout=layout), layout)


def test_a_grid_is_a_grid():
    points = compass(grid(12)).points.reshape(12, 12, 2)
    assert np.ptp(points[:, :, 0], axis=0).max() < 1e-5
    assert np.ptp(points[:, :, 1], axis=1).max() < 1e-5
    assert np.diff(points[0, :, 0]) == pytest.approx(1, abs=1e-3)


def test_a_compass_turned_has_a_picture_turned():
    plane = PlaneMap.from_geometry(*braced(60, 0.9, 1))
    straight = compass(plane).points
    quarter = (plane.heading + np.pi / 2 + np.pi) % (2 * np.pi) - np.pi
    turned = PlaneMap.from_darts(plane.tail, plane.next_ccw, plane.outer, heading=quarter, turn=plane.turn)
    drawn = compass(turned).points
    a, b = straight - straight[0], drawn - drawn[0]
    assert np.stack([-a[:, 1], a[:, 0]], axis=1) == pytest.approx(b, abs=1e-3 * np.abs(a).max())


# -- what is asked -------------------------------------------------------------------------------------------------------


def test_chords_and_headings_are_asked_for():
    plane = PlaneMap.from_geometry(*braced(12, 0.5, 0))
    for wrong in (
        [0.0],
        np.zeros(plane.tether.size + 1),
        np.full(plane.tether.size, np.nan),
        np.zeros((plane.tether.size, 2)),
    ):
        with pytest.raises(BadInput, match=f"one finite angle in radians for each of {plane.tether.size} edges"):
            compass(plane, chords=wrong)
    with pytest.raises(BadInput, match=r"no headings.*relaxed"):
        compass(random_map(1, "tree", 5))
    given = np.zeros(plane.tether.size)
    before = given.copy()
    right_or_said(compass(plane, chords=given), "compass")  # any nonsense is drawn plane, or said
    assert np.array_equal(given, before)


@settings(max_examples=30, deadline=None)
@given(seeds, st.integers(2, 40))
def test_chords_at_random_are_no_harm(seed, size):
    plane = world(seed, "half", size).plane
    chords = np.random.default_rng(seed).uniform(-10, 10, plane.tether.size)
    right_or_said(compass(plane, chords=chords), "compass")
