"""The pebble game against the rank and the null space of the directions' equations, and what `rigidity` makes of it.

Two edges are in one rigid part if they stretch alike in every redrawing: in every drawing near a random one whose edges keep
their directions. Redrawings are the null space of the matrix with a row an edge, so a few random ones tell all.
"""

import networkx as nx
import numpy as np
import pytest
from worlds import braced, jittered

from ninefold._kernels import Kernel
from ninefold.errors import BadInput, NotPlane
from ninefold.layout import rigidity
from ninefold.mapping import PlaneMap
from ninefold.mapping.rigidity import rigid_parts


@pytest.fixture(params=["plain", "compiled"])
def form(request, monkeypatch):
    """Every kernel in one form, however little there is to do."""
    monkeypatch.setattr(Kernel, "for_work", lambda kernel, _: getattr(kernel, request.param))
    return request.param


def directions(ends, points):
    """The rows say that the difference of two moving points stays along what it is."""
    rows = np.zeros((len(ends), 2 * len(points)))
    for row, (a, b) in zip(rows, ends, strict=True):
        dx, dy = points[b] - points[a]
        row[2 * b : 2 * b + 2] = -dy, dx
        row[2 * a : 2 * a + 2] = dy, -dx
    return rows


def by_numbers(ends, rng):
    """Parts as a list of labels in order of their first edges, redundant edges, and open proportions."""
    ends = np.array(ends)
    points = rng.standard_normal((ends.max() + 1, 2))
    matrix = directions(ends, points)
    _, size, right = np.linalg.svd(matrix)
    tolerance = 1e-9 * size[0]
    rank = int((size > tolerance).sum())
    moves = (rng.standard_normal((4, len(right) - rank)) @ right[rank:]).reshape(4, -1, 2)
    step = points[ends[:, 1]] - points[ends[:, 0]]
    stretch = ((moves[:, ends[:, 1]] - moves[:, ends[:, 0]]) * step).sum(axis=2).T / (step**2).sum(axis=1)[:, None]
    part = np.full(len(ends), -1)
    for e in range(len(ends)):
        if part[e] < 0:
            part[np.abs(stretch - stretch[e]).max(axis=1) < 1e-6] = part.max() + 1
    ranks = [np.linalg.matrix_rank(matrix[:k], tol=tolerance) for k in range(len(ends) + 1)]
    return part.tolist(), (np.diff(ranks) == 0).tolist(), 2 * len(np.unique(ends)) - 3 - rank


def held_equal(ends, rng):
    found = rigid_parts(ends)
    mine = (found.part.tolist(), found.redundant.tolist(), found.freedom)
    # random points may lie badly for the numbers: then another time tells
    assert mine in (by_numbers(ends, rng), by_numbers(ends, rng)), ends
    return found


def test_small_random_graphs(form):
    rng = np.random.default_rng(4)
    several = 0
    for _ in range(400):
        n = int(rng.integers(2, 11))
        pairs = [(i, j) if rng.random() < 0.5 else (j, i) for i in range(n) for j in range(i)]
        count = int(rng.integers(1, min(len(pairs), 2 * n + 3) + 1))
        found = held_equal([pairs[k] for k in rng.permutation(len(pairs))[:count]], rng)
        several += found.n_parts > 1 and found.sizes.max() > 3
    assert several > 50


def test_larger_graphs_at_the_brink_of_rigidity(form):
    """Searches pass vertices that belong to the part on their way to free pebbles: those must not be left out."""
    rng = np.random.default_rng(5)
    for _ in range(250):
        n = int(rng.integers(12, 24))
        pairs = [(i, j) for i in range(n) for j in range(i)]
        some = rng.permutation(len(pairs))[: int(rng.integers(int(1.5 * n), int(2.3 * n)))]
        held_equal([pairs[k] for k in some], rng)


def test_plane_graphs_in_both_forms_and_against_numbers():
    rng = np.random.default_rng(6)
    for seed in range(30):
        _, edges = braced(25, 0.1 * (seed % 10), seed)
        held_equal(edges.tolist(), rng)


def test_order_and_names_of_vertices_change_no_part():
    rng = np.random.default_rng(7)
    for seed in range(20):
        _, edges = braced(300, 0.5, seed)
        plain = rigid_parts(edges)
        order, name = rng.permutation(len(edges)), rng.permutation(1000)[:300]
        other = rigid_parts(name[edges[order]][:, :: 1 if seed % 2 else -1])
        assert other.freedom == plain.freedom
        assert other.redundant.sum() == plain.redundant.sum()
        pairs = np.unique(np.stack([plain.part[order], other.part], axis=1), axis=0)
        assert len(pairs) == plain.n_parts == other.n_parts


SQUARE = [(0, 1), (1, 2), (2, 3), (3, 0)]
TRIANGLES_AT_A_VERTEX = [(0, 1), (1, 2), (2, 0), (2, 3), (3, 4), (4, 2)]


@pytest.mark.parametrize(
    ("name", "ends", "sizes", "redundant", "freedom"),
    [
        ("edge", [(0, 1)], [1], 0, 0),
        ("triangle", [(0, 1), (1, 2), (2, 0)], [3], 0, 0),
        ("square", SQUARE, [1] * 4, 0, 1),
        ("braced square", [*SQUARE, (0, 2)], [5], 0, 0),
        ("K4", [*SQUARE, (0, 2), (1, 3)], [6], 1, 0),
        ("K33", list(nx.complete_bipartite_graph(3, 3).edges), [9], 0, 0),
        ("prism", list(nx.circular_ladder_graph(3).edges), [9], 0, 0),
        ("cube", list(nx.cubical_graph().edges), [1] * 12, 0, 1),
        ("triangles at a vertex", TRIANGLES_AT_A_VERTEX, [3, 3], 0, 1),
        ("triangles at an edge", [(0, 1), (1, 2), (2, 0), (2, 3), (3, 0)], [5], 0, 0),
        ("triangles apart", [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)], [3, 3], 0, 3),
        ("tree", list(nx.balanced_tree(2, 3).edges), [1] * 14, 0, 13),
        ("path", list(nx.path_graph(50).edges), [1] * 49, 0, 48),
        ("octahedron", list(nx.octahedral_graph().edges), [12], 3, 0),
    ],
)
def test_known_graphs(name, ends, sizes, redundant, freedom, form):
    found = rigid_parts(ends)
    assert sorted(found.sizes.tolist()) == sizes
    assert int(found.redundant.sum()) == redundant
    assert found.freedom == freedom
    held_equal(ends, np.random.default_rng(0))


# -- what the headings of a map fix, and what they contradict ------------------------------------------------------------


def misread(plane, degrees, seed, *, edge=None, by=0.0):
    """The map with an error in every heading, and another in one; None where the rotation no longer follows them."""
    error = np.radians(degrees) * np.random.default_rng(seed).standard_normal(plane.tether.size)
    if edge is not None:
        error[edge] += np.radians(by)
    heading = (plane.heading + np.repeat(error, 2) + np.pi) % (2 * np.pi) - np.pi
    try:
        return PlaneMap.from_darts(plane.tail, plane.next_ccw, plane.outer, heading=heading, turn=plane.turn)
    except NotPlane:
        return None


def test_a_blunder_in_a_braced_map_is_named_and_nothing_else():
    tried = named = wrongly = 0
    for seed in range(40):
        plane = PlaneMap.from_geometry(*jittered(7, 0.2, seed))
        ends = plane.tail.reshape(-1, 2)
        inner = ~(plane.face_of.reshape(-1, 2) == plane.outer_face).any(axis=1) & (plane.degree[ends] >= 5).all(axis=1)
        edge = int(np.random.default_rng(seed).choice(np.flatnonzero(inner)))
        good, bad = misread(plane, 1, seed), misread(plane, 1, seed, edge=edge, by=25)
        if good is None or bad is None:
            continue
        tried += 1
        wrongly += rigidity(good).contradicted != ()
        found = rigidity(bad)
        named += found.contradicted == (plane.edge_names[edge],)
        assert np.degrees(found.sigma) == pytest.approx(1, abs=0.5)
    assert tried >= 25
    assert wrongly == 0
    assert named == tried


def test_the_miss_of_a_blunder_is_what_it_is():
    plane = PlaneMap.from_geometry(*jittered(7, 0.2, 3))
    edge = int(np.flatnonzero((plane.degree[plane.tail.reshape(-1, 2)] >= 6).all(axis=1))[0])
    found = rigidity(misread(plane, 0, 0, edge=edge, by=20))
    assert found.contradicted == (plane.edge_names[edge],)
    assert np.degrees(found.miss[edge]) == pytest.approx(-20, abs=0.5)
    assert np.degrees(np.abs(np.delete(found.miss, edge))).max() < 0.5


def test_true_headings_are_contradicted_by_nothing():
    for seed in range(10):
        found = rigidity(PlaneMap.from_geometry(*braced(150, 0.9, seed)))
        assert found.contradicted == ()
        assert np.degrees(np.abs(found.miss)).max() < 0.5


def test_curved_legs_do_not_count():
    corners = [(0, 0), (4, 0), (4, 2), (0, 2)]
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)]
    straight = rigidity(PlaneMap.from_geometry(corners, edges))
    assert straight.part.tolist() == [0] * 5
    assert straight.freedom == 0
    # the brace leaves to the south-east and arrives from the south: a net rotation
    paths = [[corners[a], corners[b]] for a, b in edges]
    paths[4] = [(0, 0), (3, 0.5), (4, 2)]
    curved = rigidity(PlaneMap.from_geometry(corners, edges, paths))
    assert curved.part[4] == -1
    assert curved.sizes.tolist() == [1] * 4
    assert curved.freedom == 1
    assert not curved.fixed.any()
    # by the caller's leave it is straight enough
    assert rigidity(PlaneMap.from_geometry(corners, edges, paths), straight=np.pi).part.tolist() == [0] * 5


def test_loops_parallel_legs_and_tethers_are_in_no_part():
    points = [(0, 0), (4, 0), (2, 3), (2, 1)]
    edges = [(0, 1), (1, 2), (2, 0), (0, 1), (2, 2)]
    paths = [[points[a], points[b]] for a, b in edges]
    paths[3] = [(0, 0), (2, -1), (4, 0)]
    paths[4] = [(2, 3), (1, 5), (3, 5), (2, 3)]
    plane = PlaneMap.from_geometry(points, edges, paths)
    assert plane.tether.any()  # of the lone vertex in the triangle
    found = rigidity(plane)
    assert found.part[plane.tether].tolist() == [-1]
    assert found.part[4] == -1
    assert found.part[:3].tolist() == [0, 0, 0]
    assert found.part[3] == -1


def test_a_map_without_headings_says_so():
    with pytest.raises(BadInput, match="no headings"):
        rigidity(PlaneMap.from_rotation({"a": ["b"], "b": ["a"]}))
