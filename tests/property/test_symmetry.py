"""Names, numbers and the choice of a root change nothing."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import de9im
from worlds import KINDS, World, random_sets, world

from ninefold.mapping import Line, PlaneMap, Point, Region
from ninefold.reasoner import relate

worlds = st.builds(world, st.integers(0, 2**32 - 1), st.sampled_from(KINDS), st.integers(1, 25))


def shuffled(rng, plane):
    """The same map with vertices, edges and dart directions renumbered, and the two maps of darts and faces."""
    n, m = plane.n_vertices, plane.tail.size // 2
    vertex, edge, flip = rng.permutation(n), rng.permutation(m), rng.integers(0, 2, m)
    darts = np.arange(2 * m)
    new = 2 * edge[darts >> 1] + ((darts & 1) ^ flip[darts >> 1])
    tail, after, heading = np.empty(2 * m, int), np.empty(2 * m, int), np.empty(2 * m)
    tail[new], after[new] = vertex[plane.tail], new[plane.next_ccw]
    heading[new] = plane.heading
    turn, tether = np.empty(m), np.empty(m, bool)
    turn[edge], tether[edge] = np.where(flip, -1, 1) * plane.turn, plane.tether
    again = PlaneMap.from_darts(tail, after, n_vertices=n, tether=tether, heading=heading, turn=turn)
    return again, vertex, edge, new


@settings(max_examples=120, deadline=None)
@given(worlds, st.integers(0, 2**32 - 1))
def test_relabelling_changes_nothing(w: World, seed: int):
    plane, rng = w.plane, np.random.default_rng(seed)
    again, vertex, edge, dart = shuffled(rng, plane)
    assert again.n_faces == plane.n_faces
    if plane.outer >= 0:
        assert again.face_of[dart[plane.outer]] == again.outer_face
    again.validate()

    def moved(x):
        if isinstance(x, Point):
            return Point(again, int(vertex[x.index]))
        if isinstance(x, Line):
            return Line(again, tuple(sorted(int(edge[e]) for e in x.edges)))
        at = {int(plane.face_of[d]): int(again.face_of[dart[d]]) for d in range(plane.tail.size)}
        return Region.from_faces(again, [at[f] for f in x.faces])

    sets = random_sets(rng, plane, 6)
    for x in sets:
        for y in sets:
            assert relate(moved(x), moved(y)) == relate(x, y)


@settings(max_examples=120, deadline=None)
@given(worlds)
def test_any_dart_of_the_outer_face_will_do(w: World):
    plane = w.plane
    for d in np.flatnonzero(plane.face_of == plane.outer_face)[:5] if plane.outer >= 0 else []:
        again = PlaneMap.from_darts(
            plane.tail, plane.next_ccw, int(d), tether=plane.tether, heading=plane.heading, turn=plane.turn,
            n_vertices=plane.n_vertices,
        )  # fmt: skip
        assert again == plane


@settings(max_examples=120, deadline=None)
@given(worlds, st.integers(0, 2**32 - 1))
def test_symbolic_equals_cell_enumeration(w: World, seed: int):
    sets = random_sets(np.random.default_rng(seed), w.plane, 6)
    for x in sets:
        for y in sets:
            assert relate(x, y).de9im == de9im(x, y)


@settings(max_examples=120, deadline=None)
@given(worlds, st.integers(0, 2**32 - 1))
def test_an_edge_of_a_tree_closes_a_cycle_that_parts_the_faces(w: World, seed: int):
    """The faces of a cycle and of its complement partition the plane, and only the cycle's edges join the two."""
    plane = w.plane
    left, right = plane.face_of[0::2], plane.face_of[1::2]
    for x in random_sets(np.random.default_rng(seed), plane, 8):
        if isinstance(x, Region):
            inside = np.isin(np.arange(plane.n_faces), x.faces)
            assert [x.has_face(f) for f in range(plane.n_faces)] == inside.tolist()
            assert set(np.flatnonzero(inside[left] != inside[right]).tolist()) == x.edge_set
            assert not inside[plane.outer_face]
