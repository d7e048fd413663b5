"""Every connected plane map with up to four edges, counted against the published numbers of rooted planar maps.

W. T. Tutte, A census of planar maps (1963): 1, 2, 9, 54, 378 (OEIS A000168).
"""

from itertools import combinations, permutations
from math import factorial

import numpy as np
import pytest
from naive import de9im, faces_by_sympy

from ninefold.errors import BadInput, NotPlane
from ninefold.mapping import Line, PlaneMap, Point, Region
from ninefold.reasoner import relate

ROOTED = {0: 1, 1: 2, 2: 9, 3: 54, 4: 378}


def tails(next_ccw):
    """Number the orbits of next_ccw."""
    tail = [-1] * len(next_ccw)
    count = 0
    for d in range(len(next_ccw)):
        x = d
        if tail[d] < 0:
            while tail[x] < 0:
                tail[x] = count
                x = next_ccw[x]
            count += 1
    return tail


def canonical(next_ccw):
    """Whether this labelling is the one that a breadth-first walk from dart 0 gives: one a rooted map."""
    label = {0: 0, 1: 1}
    queue = [0]
    for d in queue:
        for x in (next_ccw[d], d ^ 1):
            if x not in label:
                label[x], label[x ^ 1] = len(label), len(label) + 1
            if x not in queue:
                queue.append(x)
    return all(a == b for a, b in label.items()) and len(label) == len(next_ccw)


def maps(n_edges):
    """Each rooted plane map once, the root face outside; and how many labelled ones there are."""
    if n_edges == 0:
        yield PlaneMap.from_darts([], [], n_vertices=1)
        return
    for next_ccw in permutations(range(2 * n_edges)):
        if canonical(next_ccw):
            plane = plane_or_error(next_ccw)
            if isinstance(plane, PlaneMap):
                yield plane
            else:
                assert plane.genus >= 1
                assert plane.edges


def plane_or_error(next_ccw):
    try:
        return PlaneMap.from_darts(tails(next_ccw), next_ccw, 0)
    except NotPlane as error:
        return error


@pytest.mark.parametrize("n_edges", ROOTED)
def test_counts_are_the_published_ones(n_edges):
    found = list(maps(n_edges))
    assert len(found) == ROOTED[n_edges]
    for plane in found:
        plane.validate()
        assert plane.n_vertices - plane.n_edges + plane.n_faces == 2
        if n_edges:
            walks = {frozenset(plane.face_darts(f)) for f in range(plane.n_faces)}
            assert walks == faces_by_sympy(plane.next_ccw.tolist())


@pytest.mark.parametrize("n_edges", [1, 2, 3])
def test_labelled_counts(n_edges):
    """Every permutation is a rotation system; the plane connected ones are the rooted maps times their labellings."""
    plane = 0
    for next_ccw in permutations(range(2 * n_edges)):
        try:
            PlaneMap.from_darts(tails(next_ccw), next_ccw, 0)
        except BadInput:  # NotPlane, or not connected
            continue
        plane += 1
    assert plane == ROOTED[n_edges] * 2 ** (n_edges - 1) * factorial(n_edges - 1)


def every_set(plane):
    sets = [Point(plane, v) for v in range(plane.n_vertices)]
    for k in range(1, plane.n_edges + 1):
        sets += [Line(plane, edges) for edges in combinations(range(plane.n_edges), k)]
    bounded = [f for f in range(plane.n_faces) if f != plane.outer_face]
    for k in range(1, len(bounded) + 1):
        sets += [Region.from_faces(plane, faces) for faces in combinations(bounded, k)]
    return sets


@pytest.mark.parametrize("n_edges", [0, 1, 2, 3])
def test_every_pair_of_sets_on_every_map(n_edges):
    for plane in maps(n_edges):
        sets = every_set(plane)
        for x in sets:
            for y in sets:
                assert relate(x, y).de9im == de9im(x, y)


def test_pairs_of_sets_on_maps_of_four_edges():
    rng = np.random.default_rng(0)
    for plane in maps(4):
        sets = every_set(plane)
        for i, j in rng.integers(0, len(sets), (40, 2)):
            assert relate(sets[i], sets[j]).de9im == de9im(sets[i], sets[j])


def test_a_cycle_and_its_complement_partition_the_plane():
    for plane in maps(4):
        for k in range(1, 5):
            for edges in combinations(range(4), k):
                try:
                    region = plane.cycle(edges=edges)
                except BadInput:
                    continue
                assert plane.outer_face not in region.faces
                assert region.boundary.edges == edges
                # faces on either side of an edge off the cycle are on one side of it
                for e in set(range(4)) - set(edges):
                    left, right = (int(plane.face_of[d]) in region.faces for d in (2 * e, 2 * e + 1))
                    assert left == right
