"""A witness for every relation the literature says exists, found by looking at all short paths and all blocks of a grid.

Eight relations of simple regions and three of a point and a region (the paper's figures 5 and 6); 19 of a simple open line
and a region and 33 of two simple open lines: M. J. Egenhofer and J. R. Herring, Categorizing binary topological relations
between regions, lines, and points in geographic databases (1991).
"""

from itertools import combinations

import numpy as np
import pytest

from ninefold.mapping import PlaneMap, Region
from ninefold.reasoner import NAMES, Relation, relate_pairs


def grid(n):
    points = [(x, y) for y in range(n) for x in range(n)]
    edges = [(i, i + 1) for i in range(n * n) if i % n < n - 1] + [(i, i + n) for i in range(n * n - n)]
    return PlaneMap.from_geometry(points, edges)


def simple_paths(plane, longest):
    """Every simple path of up to `longest` edges, each once."""
    found = {}
    stack = [(v,) for v in range(plane.n_vertices)]
    while stack:
        way = stack.pop()
        if len(way) > 1:
            line = plane.path(way)
            found[line.edges] = line
        if len(way) <= longest:
            ends = {int(plane.tail[d ^ 1]) for d in plane.darts_at(way[-1])}
            stack += [(*way, w) for w in ends if w not in way]
    return list(found.values())


def simple_regions(plane, largest):
    """Every union of up to `largest` faces that is bounded by one simple cycle."""
    bounded = [f for f in range(plane.n_faces) if f != plane.outer_face]
    found = []
    for k in range(1, largest + 1):
        for faces in combinations(bounded, k):
            region = Region.from_faces(plane, faces)
            if len(region.rims) == 1 and len(region.star) == region.darts.size:
                found.append(region)
    return found


def matrices(left, right):
    sets = [*left, *right]
    i, j = np.meshgrid(np.arange(len(left)), np.arange(len(left), len(sets)))
    codes = np.unique(relate_pairs(sets, np.stack([i.ravel(), j.ravel()], axis=1)))
    return {Relation(int(code)).matrix.tobytes() for code in codes}, {Relation(int(code)).name for code in codes}


@pytest.fixture(scope="module")
def plane():
    return grid(4)


def test_eight_relations_of_regions(plane):
    regions = simple_regions(plane, 9)
    found, names = matrices(regions, regions)
    # nothing but the eight; a grid of nine blocks has a block inside the other eight and more
    assert names == set(NAMES)
    assert len(found) == 8


def test_three_relations_of_point_and_region(plane):
    points = [plane.vertex(v) for v in range(plane.n_vertices)]
    found, names = matrices(points, simple_regions(plane, 9))
    assert names == {"disjoint", "meet", "inside"}
    assert len(found) == 3


def test_nineteen_relations_of_line_and_region(plane):
    found, _ = matrices(simple_paths(plane, 6), simple_regions(plane, 9))
    assert len(found) == 19


def test_thirty_three_relations_of_lines(plane):
    paths = simple_paths(plane, 6)
    found, _ = matrices(paths, paths)
    assert len(found) == 33
