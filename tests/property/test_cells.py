"""Relations and regions against every cell of the map, one by one."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from naive import de9im
from worlds import KINDS, World, random_sets, world

from ninefold.mapping import Region
from ninefold.reasoner import relate

worlds = st.builds(world, st.integers(0, 2**32 - 1), st.sampled_from(KINDS), st.integers(1, 25))


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
