"""The steps from directions to a plane picture, each by itself."""

from dataclasses import replace

import networkx as nx
import numpy as np
import pytest
from random_maps import random_map
from worlds import braced, world

from ninefold._kernels import Kernel
from ninefold.layout.methods.subdivide import make_simple
from ninefold.layout.shaping.blocks import block_tree
from ninefold.layout.shaping.directions import FAITHFUL, FollowHeadings, heading_errors, shape_of_directions
from ninefold.layout.shaping.energy import EvenLengths, KeepPicture, damped, newton_step
from ninefold.layout.shaping.equations import System, scattered
from ninefold.layout.shaping.hung import HungBlocks
from ninefold.layout.shaping.mesh import FRAME, Mesh, doubled_areas, squared_sides, too_flat
from ninefold.layout.shaping.picture import plane_picture
from ninefold.layout.shaping.pieces import pieces_of, spread
from ninefold.mapping import PlaneMap


@pytest.fixture(params=["plain", "compiled"])
def form(request, monkeypatch):
    """Every kernel in one form, however little there is to do."""
    monkeypatch.setattr(Kernel, "for_work", lambda kernel, _: getattr(kernel, request.param))
    return request.param


def tangled(seed, n=60, share=0.3):
    """The pieces of a plane graph and points that have little to do with it."""
    points, edges = braced(n, share, seed)
    rng = np.random.default_rng(seed)
    return pieces_of(PlaneMap.from_geometry(points, edges)), points, points + 0.1 * rng.standard_normal(points.shape)


# -- pieces --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(8))
def test_spread_makes_the_rotation_hold_with_room(seed):
    plane = world(seed, ("half", "sparse", "ring", "dense")[seed % 4], 40).plane
    pieces = pieces_of(plane)
    error = np.radians(20) * np.random.default_rng(seed).standard_normal(plane.tether.size)
    noisy = spread(pieces_of(plane, chords=plane.heading[0::2] + plane.turn / 2 + error))
    for given in (spread(pieces), noisy):
        simple = given.simple
        for v in range(given.n_vertices):
            darts = [d for d in np.flatnonzero(simple.tail == v).tolist() if given.measured[d >> 1]]
            if len(darts) < 2 or not given.real[np.flatnonzero(simple.tail == v) >> 1].all():
                continue
            walk = [darts[0]]
            while simple.next_ccw[walk[-1]] != darts[0]:
                walk.append(int(simple.next_ccw[walk[-1]]))
            leaving = np.array([given.chord[d >> 1] + np.pi * (d & 1) for d in walk])
            gaps = np.diff(np.append(leaving, leaving[0])) % (2 * np.pi)
            assert gaps.sum() == pytest.approx(2 * np.pi)  # once around: the order is the rotation's
            assert gaps.min() > np.radians(1.9) - 1e-3


def test_spread_turns_nothing_that_has_room():
    square = PlaneMap.from_geometry([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    pieces = pieces_of(square)
    assert np.array_equal(spread(pieces).chord, pieces.chord)


def test_pieces_of_a_bend_point_along_their_part_of_the_turn():
    """Two parallel half circles: one is one piece, along the chord; the other two, a quarter turn apart."""
    angle = np.linspace(0, np.pi, 41)
    arc = np.stack([1 - np.cos(angle), np.sin(angle)], axis=1)
    arc[0], arc[-1] = (0, 0), (2, 0)
    plane = PlaneMap.from_geometry([(0, 0), (2, 0)], [(0, 1), (0, 1)], [arc, arc * (1, -1)])
    pieces = pieces_of(plane)
    assert pieces.edge.size == 3
    for e in (0, 1):
        chords = np.sort(np.degrees(pieces.chord[pieces.edge == e]))
        assert chords == pytest.approx([0] if len(chords) == 1 else [-45, 45], abs=5)


# -- blocks --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["any", "tree", "cactus", "simple", "islands", "bundles"])
def test_blocks_are_the_biconnected_components(kind, form):
    for seed in range(12):
        plane = random_map(seed, kind, 30)
        simple = make_simple(plane.tail, plane.next_ccw, plane.outer, plane.n_vertices)
        tail, after = simple.tail.astype(np.int64), simple.next_ccw.astype(np.int64)
        tree = block_tree(tail, after, simple.n_vertices, int(simple.outer))
        ends = tail.reshape(-1, 2)
        mine = {}
        for e, b in enumerate(tree.block.tolist()):
            mine.setdefault(b, set()).add(frozenset(ends[e].tolist()))
        graph = nx.Graph(ends.tolist())
        theirs = {frozenset(map(frozenset, part)) for part in nx.biconnected_component_edges(graph)}
        assert {frozenset(part) for part in mine.values()} == theirs
        cuts = set(nx.articulation_points(graph))
        for b, part in mine.items():
            assert any(int(tree.head[b]) in edge for edge in part)
            if tree.parent[b] >= 0:
                assert int(tree.head[b]) in cuts
                assert tree.parent[b] > b
                assert tree.level[b] == tree.level[tree.parent[b]] + 1
        assert (tree.of_vertex < 0).sum() == 1


def test_hung_blocks_scale_and_turn_about_their_heads():
    plane = PlaneMap.from_geometry([(0, 0), (2, 0), (1, 2), (1, 3), (2, 3)], [(0, 1), (1, 2), (2, 0), (2, 3), (3, 4)])
    pieces = pieces_of(plane)
    points = np.array([(0, 0), (2, 0), (1, 2), (1, 3), (2, 3)], float)
    hung = HungBlocks(pieces, points)
    assert hung.picture() == pytest.approx(points)
    for b in range(hung.scale.size):
        if b != hung.tree.root and hung.tree.parent[b] == hung.tree.root:
            hung.scale[b], hung.turn[b] = 0.5, np.pi / 2
    assert hung.picture() == pytest.approx(np.array([(0, 0), (2, 0), (1, 2), (0.5, 2), (0.5, 2.5)]))


def test_hung_parts_that_cross_shrink_until_they_do_not():
    """A dead end from a corner of a square that would run through the opposite side."""
    points = [(0, 0), (4, 0), (4, 4), (0, 4), (1, 1)]
    plane = PlaneMap.from_geometry(points, [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4)])
    long = np.array([*points[:4], (7, 6.5)], float)
    hung = HungBlocks(pieces_of(plane), long)
    picture = hung.shrink()
    assert picture[:4].tolist() == long[:4].tolist()
    assert 0 < picture[4].max() < 4
    assert picture[4, 1] / picture[4, 0] == pytest.approx(6.5 / 7)


# -- systems and pulls ---------------------------------------------------------------------------------------------------


def test_a_system_is_what_dense_numbers_say():
    rng = np.random.default_rng(1)
    n, free = 9, np.array([True, True, False, True, True, True, False, True, True])
    tail, head = rng.integers(0, n, 20), rng.integers(0, n, 20)
    tail, head = tail[tail != head], head[tail != head]
    square = rng.standard_normal((len(tail), 2, 2))
    pieces = square @ square.transpose(0, 2, 1)
    corners = np.array([rng.permutation(n)[:3] for _ in range(8)])
    square = rng.standard_normal((8, 6, 6))
    triangles = square @ square.transpose(0, 2, 1)
    dense = np.zeros((2 * n, 2 * n))
    for u, v, block in zip(tail, head, pieces, strict=True):
        d = np.zeros((2, 2 * n))
        d[:, 2 * v : 2 * v + 2], d[:, 2 * u : 2 * u + 2] = np.eye(2), -np.eye(2)
        dense += d.T @ block @ d
    for corner, block in zip(corners, triangles, strict=True):
        at = np.stack([2 * corner, 2 * corner + 1], axis=1).ravel()
        dense[np.ix_(at, at)] += block
    right = rng.standard_normal((n, 2))
    on = np.repeat(free, 2)
    expected = np.zeros(2 * n)
    expected[on] = np.linalg.solve(dense[np.ix_(on, on)] + 0.5 * np.eye(on.sum()), right.ravel()[on])
    system = System(free)
    system.add_differences(tail, head, pieces)
    system.add(corners, triangles)
    assert system.solve(right, ridge=0.5) == pytest.approx(expected.reshape(-1, 2), rel=1e-6, abs=1e-8)


def test_a_system_of_numbers_that_are_none_has_no_solution():
    system = System(np.ones(2, bool))
    system.add_differences(np.array([0]), np.array([1]), np.full((1, 2, 2), np.nan))
    assert system.solve(np.zeros((2, 2)), ridge=1.0) is None


def test_scattered_sums():
    rows, vectors = np.array([2, 0, 2]), np.array([[1.0, 2], [3, 4], [5, 6]])
    assert scattered(4, rows, vectors).tolist() == [[3, 4], [0, 0], [6, 8], [0, 0]]


def test_pulls_are_at_rest_where_their_wish_is_granted():
    pieces, points, _ = tangled(2)
    step = points[pieces.head] - points[pieces.tail]
    blocks, wanted = KeepPicture(pieces, points).terms(points + 1)
    assert np.einsum("kij,kj->ki", blocks, step) == pytest.approx(wanted)
    truth = FollowHeadings(pieces, lengths=FAITHFUL)
    mean = np.hypot(*step.T).mean()
    blocks, wanted = truth.terms(points / mean)
    assert np.einsum("kij,kj->ki", blocks, step / mean) == pytest.approx(wanted, abs=1e-6 * np.abs(wanted).max())
    unit = points.copy()
    blocks, wanted = EvenLengths(pieces).terms(unit)
    drawn = np.einsum("kij,kj->ki", blocks, step) - wanted
    short = np.hypot(*step.T) < 0.9
    assert ((drawn * step).sum(axis=1)[short] < 0).all()  # what is short is pulled apart


def test_headings_bring_back_what_they_fix():
    pieces, points, _ = tangled(3, n=80, share=0.9)
    found = shape_of_directions(pieces, rounds=40, lengths=FAITHFUL)
    assert np.degrees(np.abs(heading_errors(pieces, found))).max() < 0.5
    a, b = points - points[0], found - found[0]
    size = (a * b).sum() / (b * b).sum()
    assert np.abs(a - size * b).max() < 0.02


def test_a_bad_fit_does_not_shrink_to_nothing():
    pieces, _, _ = tangled(4, n=80, share=0.9)
    wrong = pieces.chord + np.radians(25) * np.random.default_rng(0).standard_normal(pieces.chord.size)
    other = replace(pieces, chord=wrong)
    found = shape_of_directions(other, rounds=60, lengths=FAITHFUL)
    assert np.hypot(*(found[pieces.head] - found[pieces.tail]).T).mean() == pytest.approx(1, rel=1e-6)


# -- meshes --------------------------------------------------------------------------------------------------------------


def is_a_mesh(mesh, pieces):
    """Every map edge a side, no side doubled, and the triangles' signed areas add up to the frame's."""
    t = mesh.triangles
    assert len(t) == 2 * (mesh.n + FRAME) - 2 - FRAME
    sides = np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]])
    assert len(np.unique(sides, axis=0)) == len(sides)
    assert (t[:, 0] != t[:, 1]).all()
    assert (t[:, 1] != t[:, 2]).all()
    assert (t[:, 2] != t[:, 0]).all()
    known = {tuple(side) for side in sides.tolist()}
    for u, v, real in zip(pieces.tail.tolist(), pieces.head.tolist(), pieces.real.tolist(), strict=True):
        if real:  # a tether may be flipped away
            assert (u, v) in known
            assert (v, u) in known
    rim = {(a, b) for a, b in known if (b, a) not in known}
    assert rim == {(mesh.n + k, mesh.n + (k + 1) % FRAME) for k in range(FRAME)}
    a = mesh.points[mesh.n :]
    b = np.roll(a, -1, axis=0)
    assert mesh.areas().sum() == pytest.approx((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]).sum())


def worst(mesh):
    return (mesh.areas() / squared_sides(mesh.points, mesh.triangles)).min()


@pytest.mark.parametrize("seed", range(6))
def test_meshes_of_tangled_pictures_cover_the_frame(seed, form):
    pieces, points, wrong = tangled(seed)
    right = Mesh(pieces, points)
    is_a_mesh(right, pieces)
    assert not right.bad().any()
    mesh = Mesh(pieces, wrong)
    is_a_mesh(mesh, pieces)
    assert mesh.bad().any()
    rng = np.random.default_rng(seed)
    for _ in range(4):
        mesh.points[: mesh.n] += 0.05 * rng.standard_normal((mesh.n, 2))
        before = worst(mesh)
        mesh.flip()
        is_a_mesh(mesh, pieces)
        assert worst(mesh) >= before - 1e-12


@pytest.mark.parametrize("kind", ["any", "tree", "cactus", "loops", "bundles", "islands"])
def test_meshes_of_every_kind_of_map(kind, form):
    for seed in range(5):
        plane = random_map(seed, kind, 25)
        pieces = pieces_of(plane)
        mesh = Mesh(pieces, np.random.default_rng(seed).random((pieces.n_vertices, 2)))
        is_a_mesh(mesh, pieces)


def test_both_forms_of_the_kernels_cut_the_same(monkeypatch):
    found = []
    for name in ("plain", "compiled"):
        monkeypatch.setattr(Kernel, "for_work", lambda kernel, _, name=name: getattr(kernel, name))
        meshes = []
        for seed in range(5):
            pieces, _, wrong = tangled(seed)
            meshes.append(Mesh(pieces, wrong))
        hung = HungBlocks(*tangled(9)[::2])
        hung.scale *= 0.9
        found.append((meshes, hung.picture(), hung.tree))
    (plain, picture, tree), (compiled, other, its) = found
    for a, b in zip(plain, compiled, strict=True):
        assert np.array_equal(a.triangles, b.triangles)
        assert a.forced == b.forced
    assert picture == pytest.approx(other, abs=1e-12)
    assert all(np.array_equal(x, y) for x, y in zip(tree, its, strict=True))


# -- steps ---------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("size", [0.01, 0.1, 10.0])
def test_damped_steps_fold_and_flatten_no_good_triangle(size):
    for seed in range(5):
        pieces, points, wrong = tangled(seed)
        rng = np.random.default_rng(seed)
        for given in (points, wrong):
            mesh = Mesh(pieces, given)
            good = mesh.triangles[~mesh.bad()]
            step = size * rng.standard_normal(mesh.points.shape)
            step[mesh.n :] = 0
            moved = damped(mesh, step, keep=0.1)
            assert not too_flat(moved, good).any()
            assert np.array_equal(moved[mesh.n :], mesh.points[mesh.n :])
            assert not np.array_equal(moved, mesh.points)


def test_a_damped_step_that_harms_nothing_is_taken_whole():
    pieces, points, _ = tangled(1)
    mesh = Mesh(pieces, points)
    step = np.zeros_like(mesh.points)
    step[: mesh.n] = 1e-7
    assert np.array_equal(damped(mesh, step, keep=0.1), mesh.points + step)


def test_repeated_damped_steps_keep_the_picture_plane():
    """Triangles that a step made thin are as well guarded by the next."""
    pieces, points, _ = tangled(5)
    mesh = Mesh(pieces, points)
    rng = np.random.default_rng(0)
    for _ in range(60):
        step = rng.standard_normal(mesh.points.shape)
        step[mesh.n :] = 0
        mesh.points = damped(mesh, step, keep=0.01)
        mesh.flip()
        assert not mesh.bad().any()


def test_newton_steps_make_the_energy_less_and_move_only_what_is_free():
    pieces, points, wrong = tangled(6)
    mesh = Mesh(pieces, wrong)
    pull = KeepPicture(pieces, points)
    free = mesh.near(np.arange(10), 1)
    step = newton_step(mesh, pieces, pull, free, shape=0.1, fold=1e-2)
    assert np.array_equal(step[~free], np.zeros_like(step[~free]))

    def energy(at):
        blocks, wanted = pull.terms(at)
        d = at[pieces.head] - at[pieces.tail]
        return float((np.einsum("ki,kij,kj->k", d, blocks, d) / 2 - (wanted * d).sum(axis=1)).sum())

    alone = newton_step(mesh, pieces, pull, np.arange(len(mesh.points)) < mesh.n, shape=0.0)
    assert energy(mesh.points + alone) < energy(mesh.points)
    assert energy(mesh.points + alone) == pytest.approx(energy(np.concatenate([points, mesh.points[mesh.n :]])), rel=1e-3)


def test_points_on_one_spot_are_no_harm():
    pieces, points, _ = tangled(7)
    points = points.copy()
    points[:10] = points[0]
    mesh = Mesh(pieces, points)
    step = newton_step(mesh, pieces, EvenLengths(pieces), np.arange(len(mesh.points)) < mesh.n, shape=0.5, fold=1e-12)
    assert step is None or np.isfinite(step).all()


@pytest.mark.parametrize("seed", range(4))
def test_plane_pictures_have_every_triangle_right(seed):
    pieces, _, _ = tangled(seed, n=120, share=0.2)
    mesh, shape = plane_picture(spread(pieces))
    assert shape.shape == (pieces.n_vertices, 2)
    assert not mesh.bad().any()
    is_a_mesh(mesh, pieces)
    assert (doubled_areas(mesh.points, mesh.triangles) > 0).all()
