"""What the compass fixes, in words and numbers; the oracle tests hold it against linear algebra."""

import numpy as np
import pytest
from worlds import braced

from ninefold.layout import Rigidity, rigidity
from ninefold.mapping import PlaneMap
from ninefold.mapping.rigidity import rigid_parts

SQUARE = [(0, 0), (2, 0), (2, 1), (0, 1)]
SIDES = [(0, 1), (1, 2), (2, 3), (3, 0)]


def test_no_edges_no_parts():
    found = rigid_parts([])
    assert (found.n_parts, found.freedom, found.part.tolist(), found.sizes.tolist()) == (0, 0, [], [])


def test_parts_are_numbered_by_their_lowest_edges():
    found = rigid_parts([(7, 8), (0, 1), (1, 2), (2, 0), (8, 9)])
    assert found.part.tolist() == [0, 1, 1, 1, 2]
    assert found.n_parts == 3
    assert found.sizes.tolist() == [1, 3, 1]


def test_parts_of_a_map_are_numbered_from_the_largest():
    points = [*SQUARE, (4, 0), (4, 1), (6, 0.5), (5, 3)]
    edges = [(1, 4), (4, 5), (5, 6), (6, 4), *SIDES, (0, 2), (1, 3)][:-1]
    found = rigidity(PlaneMap.from_geometry(points[:7], edges))
    assert isinstance(found, Rigidity)
    assert found.sizes.tolist() == [5, 3, 1]
    assert found.part.tolist() == [2, 1, 1, 1, 0, 0, 0, 0, 0]
    assert found.fixed.tolist() == [False, *[True] * 8]
    assert found.freedom == 2
    assert not found.redundant.any()
    assert found.contradicted == ()
    assert found.sigma == 0
    assert str(found) == (
        "8 of 9 legs are in parts whose shape the headings fix, the largest of 5; "
        "0 legs are curved, and 2 proportions are open"
    )


def test_nothing_fixed_in_words():
    tree = rigidity(PlaneMap.from_geometry(*braced(6, 0.0, 1)))
    assert (
        str(tree) == "0 of 5 legs are in parts whose shape the headings fix; 0 legs are curved, and 4 proportions are open"
    )
    lone = rigidity(PlaneMap.from_geometry([(0, 0)], np.zeros((0, 2), int)))
    assert (
        str(lone) == "0 of 0 legs are in parts whose shape the headings fix; 0 legs are curved, and 0 proportions are open"
    )


def test_a_triangulation_is_one_part_with_a_spare_edge_a_triangle():
    points, edges = braced(200, 1.0, 2)
    found = rigidity(PlaneMap.from_geometry(points, edges))
    assert found.sizes.tolist() == [len(edges)]
    assert found.freedom == 0
    assert found.redundant.sum() == len(edges) - (2 * 200 - 3)


@pytest.mark.parametrize("seed", range(3))
def test_the_same_map_gives_the_same_answer(seed):
    one, other = (rigidity(PlaneMap.from_geometry(*braced(60, 0.8, seed))) for _ in range(2))
    assert np.array_equal(one.miss, other.miss)
    assert (one.part == other.part).all()
    assert one.sigma == other.sigma
