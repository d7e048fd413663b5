"""Both layouts on every kind of map: plane, the map's own rotation, faces and outer face, on the promised grid."""

from fractions import Fraction
from itertools import combinations

import networkx as nx
import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from random_maps import MAP_KINDS, random_map
from scipy.spatial import Delaunay
from worlds import KINDS, world

from ninefold.layout import Drawing, draw, drawing_problems, schnyder, tutte
from ninefold.layout.methods._augment import close_faces, fan_faces
from ninefold.layout.methods._realizer import grid_coordinates, shell
from ninefold.layout.methods.subdivide import make_simple
from ninefold.layout.methods.triangulate import biconnect, triangulate
from ninefold.layout.planarity import crossing_pieces, orientation
from ninefold.layout.shapes import region_rings
from ninefold.mapping import PlaneMap, Region
from ninefold.mapping.checks import face_permutation

maps = st.builds(random_map, st.integers(0, 2**32 - 1), st.sampled_from(MAP_KINDS), st.integers(0, 60))


def is_simple(plane):
    ends = np.sort(plane.tail.reshape(-1, 2), axis=1)
    return len(np.unique(ends, axis=0)) == len(ends) and (ends[:, 0] != ends[:, 1]).all()


@settings(max_examples=1500, deadline=None)
@given(maps)
def test_schnyder_keeps_the_map_on_the_grid(plane):
    drawing = schnyder(plane)
    assert drawing_problems(drawing) == ()
    assert drawing.points.dtype == np.int64
    n = plane.n_vertices + len(drawing.bends)
    spots = np.concatenate([drawing.points, drawing.bends])
    assert spots.min() >= 0
    assert spots.max() <= max(n - 2, 1 if n == 2 else 0)
    assert len(np.unique(spots, axis=0)) == n
    if is_simple(plane):
        assert not len(drawing.bends)


@settings(max_examples=400, deadline=None)
@given(maps)
def test_tutte_keeps_the_map_or_says_so(plane):
    drawing = tutte(plane)
    assert drawing_problems(drawing) == ()
    assert (drawing.layout == "tutte") == (not drawing.notes)
    if drawing.notes:
        assert drawing.layout == "schnyder"
        assert "Schnyder" in drawing.notes[0]


@settings(max_examples=300, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(KINDS), st.integers(1, 40), st.sampled_from(["schnyder", "tutte"]))
def test_maps_from_geometry_are_drawn_again(seed, kind, size, layout):
    assert drawing_problems(draw(world(seed, kind, size).plane, layout=layout)) == ()


@settings(max_examples=300, deadline=None)
@given(maps)
def test_bends_are_the_fewest_for_the_method(plane):
    """None on an edge of its own, two on a loop, one on each parallel edge but one of a bundle."""
    drawing = schnyder(plane)
    bends = np.diff(drawing.bend_start)
    bundles = {}
    for e, (u, v) in enumerate(plane.tail.reshape(-1, 2).tolist()):
        bundles.setdefault(tuple(sorted((u, v))), []).append(int(bends[e]))
    for (u, v), counts in bundles.items():
        assert sorted(counts) == ([2] * len(counts) if u == v else [0] + [1] * (len(counts) - 1))


@settings(max_examples=400, deadline=None)
@given(maps)
def test_triangulation_is_simple_and_keeps_the_map(plane):
    simple = make_simple(plane.tail, plane.next_ccw, plane.outer, plane.n_vertices)
    n = simple.n_vertices
    if n < 3:
        return
    tail, after, before = triangulate(simple.tail, simple.next_ccw, n)
    assert tail.size == 6 * n - 12
    assert np.array_equal(before[after], np.arange(tail.size))
    ends = np.sort(tail.reshape(-1, 2), axis=1)
    assert len(np.unique(ends, axis=0)) == len(ends)
    whole = PlaneMap.from_darts(tail, after, simple.outer)
    assert (np.bincount(whole.face_of) == 3).all()
    # Taking the additions away leaves the rotation that was given.
    for d in range(simple.tail.size):
        x = after[d]
        while x >= simple.tail.size:
            x = after[x]
        assert x == simple.next_ccw[d]


@settings(max_examples=200, deadline=None)
@given(maps)
def test_closing_faces_makes_them_simple_cycles(plane):
    simple = make_simple(plane.tail, plane.next_ccw, plane.outer, plane.n_vertices)
    if simple.n_vertices < 3:
        return
    tail, after, _, used = biconnect(simple.tail, simple.next_ccw, simple.n_vertices)
    walk = face_permutation(after[:used])
    for s in range(used):
        corners, d = [], s
        while True:
            corners.append(int(tail[d]))
            d = int(walk[d])
            if d == s:
                break
        assert len(set(corners)) == len(corners) >= 3


@settings(max_examples=300, deadline=None)
@given(maps, st.sampled_from(["schnyder", "tutte"]))
def test_every_face_is_a_valid_polygon_and_they_tile(plane, layout):
    drawing = draw(plane, layout=layout)
    bounded = [f for f in range(plane.n_faces) if f != plane.outer_face]
    shapes = drawing.geometries(plane.face(f) for f in bounded)
    assert shapely.is_valid(shapes).all()
    assert (shapely.get_type_id(shapes) == shapely.GeometryType.POLYGON).all()
    if bounded:
        whole = drawing.geometry(plane.region(bounded))
        assert whole.is_valid
        assert whole.area == pytest.approx(shapely.area(shapes).sum())


@settings(max_examples=300, deadline=None)
@given(maps, st.integers(0, 2**32 - 1))
def test_unions_of_faces_are_valid_and_have_the_area_of_the_union(plane, seed):
    bounded = [f for f in range(plane.n_faces) if f != plane.outer_face]
    if not bounded:
        return
    rng = np.random.default_rng(seed)
    drawing = schnyder(plane)
    some = [f for f in bounded if rng.random() < 0.5] or bounded[:1]
    region = Region.from_faces(plane, some)
    shape = drawing.geometry(region)
    assert shape.is_valid
    parts = drawing.geometries(plane.face(f) for f in some)
    assert shape.area == pytest.approx(shapely.area(parts).sum())
    assert shape.equals(shapely.union_all(parts))
    assert sum(len(rings) for rings in region_rings(drawing, region)) == sum(
        1 + len(p.interiors) for p in shapely.get_parts(shape)
    )


def convex(ring):
    a, b, c = ring, np.roll(ring, -1, axis=0), np.roll(ring, -2, axis=0)
    u, v = b - a, c - b
    return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] > -1e-9).all()


@pytest.mark.parametrize("graph", [nx.wheel_graph(7), nx.dodecahedral_graph(), nx.cubical_graph(), nx.icosahedral_graph()])
def test_faces_of_three_connected_maps_are_convex(graph):
    _, embedding = nx.check_planarity(graph)
    outer = max((tuple(embedding.traverse_face(u, v)) for u, v in embedding.edges), key=len)
    plane = PlaneMap.from_networkx(embedding, outer=(outer[0], outer[1]) if len(outer) > 2 else None)
    drawing = tutte(plane)
    assert drawing.layout == "tutte"
    for f in range(plane.n_faces):
        if f != plane.outer_face:
            assert convex(np.array(drawing.geometry(plane.face(f)).exterior.coords)[:-1])


@settings(max_examples=60, deadline=None)
@given(maps)
def test_compiled_kernels_equal_plain_ones(plane):
    simple = make_simple(plane.tail, plane.next_ccw, plane.outer, plane.n_vertices)
    n = simple.n_vertices
    if n < 3:
        return
    results = []
    for form in ("plain", "compiled"):
        room = 6 * n - 12
        tail, after, before = (np.zeros(room, np.int32) for _ in range(3))
        used = simple.tail.size
        tail[:used], after[:used] = simple.tail, simple.next_ccw
        before[simple.next_ccw] = np.arange(used, dtype=np.int32)
        used = int(getattr(close_faces, form)(tail, after, before, n, used))
        degree = np.bincount(tail[:used], minlength=n).astype(np.int32)
        used = int(getattr(fan_faces, form)(tail, after, before, degree, used))
        assert used == room
        assert np.array_equal(degree, np.bincount(tail, minlength=n))
        order, parent = getattr(shell, form)(tail, after, before, simple.outer, n)
        left, right = tail[simple.outer ^ 1], tail[simple.outer]
        results.append((tail, after, order, parent, getattr(grid_coordinates, form)(order, parent, left, right, order[0])))
    for plain, compiled in zip(*results, strict=True):
        assert np.array_equal(plain, compiled)


@settings(max_examples=100, deadline=None)
@given(maps)
def test_realizer_is_three_trees_that_share_the_inner_edges(plane):
    simple = make_simple(plane.tail, plane.next_ccw, plane.outer, plane.n_vertices)
    n = simple.n_vertices
    if n < 4:
        return
    tail, after, before = triangulate(simple.tail, simple.next_ccw, n)
    order, parent = shell(tail, after, before, simple.outer, n)
    corners = [int(tail[simple.outer ^ 1]), int(tail[simple.outer]), int(order[0])]
    assert (parent[corners] == -1).all()
    assert sorted([*order.tolist(), *corners[:2]]) == list(range(n))
    inner = [v for v in range(n) if v not in corners]
    used = {frozenset((v, int(p))) for v in inner for p in parent[v]}
    assert len(used) == 3 * (n - 3)
    edges = {frozenset(ends) for ends in tail.reshape(-1, 2).tolist()}
    assert used == edges - {frozenset(pair) for pair in combinations(corners, 2)}
    for tree, root in enumerate(corners):
        for v in inner:
            steps = 0
            while v != root:
                v, steps = int(parent[v, tree]), steps + 1
                assert steps <= n


@pytest.mark.parametrize(("keep", "n"), [(1.0, 30_000), (0.5, 60_000)])
def test_large_drawings_carry_their_own_proof(keep, n):
    """If every triangle but the outer one is counter-clockwise and their areas add up to the hull's, nothing crosses."""
    rng = np.random.default_rng(7)
    t = Delaunay(rng.random((n, 2))).simplices
    pairs = np.unique(np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1), axis=0)
    points = np.random.default_rng(7).random((n, 2))
    plane = PlaneMap.from_geometry(points, pairs[rng.random(len(pairs)) < keep])
    xy = schnyder(plane).points
    tail, after, _ = triangulate(plane.tail, plane.next_ccw, n)
    walk = face_permutation(after)
    corner = xy[tail]
    u, v = corner[walk] - corner, corner[walk[walk]] - corner
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    outside = [plane.outer, int(walk[plane.outer]), int(walk[walk[plane.outer]])]
    assert (area[outside] < 0).all()
    assert (np.delete(area, outside) > 0).all()
    assert area.sum() == 0
    assert (xy.min(), xy.max()) == (0, n - 2)


def meets_badly(p, q, shared):
    """Whether two segments meet elsewhere than at one shared end, with exact fractions."""

    def turn(a, b, c):
        value = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        return (value > 0) - (value < 0)

    def between(a, b, c):
        return min(a[0], b[0]) <= c[0] <= max(a[0], b[0]) and min(a[1], b[1]) <= c[1] <= max(a[1], b[1])

    (a, b), (c, d) = p, q
    t = turn(a, b, c), turn(a, b, d), turn(c, d, a), turn(c, d, b)
    if t == (0, 0, 0, 0):
        on = {x for x in (c, d) if between(a, b, x)} | {x for x in (a, b) if between(c, d, x)}
        return len(on) > shared
    meets = (t[0] * t[1] <= 0) and (t[2] * t[3] <= 0)
    return meets and not shared


@settings(max_examples=400, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(2, 12), st.integers(2, 6))
def test_crossings_are_exactly_those_of_brute_force(seed, n, grid):
    """Random spots on a small grid make every kind of contact: crossings, touching ends, overlaps, coincidences."""
    rng = np.random.default_rng(seed)
    plane = random_map(seed, "simple", n)
    drawing = Drawing.from_points(plane, rng.integers(0, grid, size=(plane.n_vertices, 2)))
    ends = plane.tail.reshape(-1, 2)
    found, _ = crossing_pieces(drawing)
    spots = [tuple(map(Fraction, xy)) for xy in drawing.points.tolist()]
    expected = set()
    for e, f in combinations(range(len(ends)), 2):
        p, q = ([spots[v] for v in ends[k].tolist()] for k in (e, f))
        if p[0] == p[1] or q[0] == q[1]:
            continue
        if meets_badly(p, q, len(set(ends[e].tolist()) & set(ends[f].tolist()))):
            expected.add((e, f))
    flat = {e for e in range(len(ends)) if spots[ends[e, 0]] == spots[ends[e, 1]]}
    assert {(e, f) for e, f in found if not {e, f} & flat} == expected
    assert {e for e, f in found if e == f} == flat


def test_orientation_is_exact_where_floats_round():
    a = np.array([[0.0, 0.0]])
    b = np.array([[1e-8, 1e-8]])
    level, above = np.array([[3e-8, 3e-8]]), np.array([[3e-8, np.nextafter(3e-8, 1)]])
    assert orientation(a, b, level).tolist() == [0]
    assert orientation(a, b, above).tolist() == [1]
    base = np.array([[0.1, 0.1]])
    assert orientation(base, np.array([[0.2, 0.2]]), np.array([[0.30000000000000004, 0.3]])).tolist() == [-1]
