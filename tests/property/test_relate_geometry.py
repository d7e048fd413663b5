"""Symbolic relations equal shapely's on the generating geometry."""

import numpy as np
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import KINDS, random_sets, world

from ninefold.mapping import Region
from ninefold.reasoner import Relation, relate


@settings(max_examples=400, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(KINDS), st.integers(1, 30))
def test_symbolic_equals_shapely(seed, kind, size):
    w = world(seed, kind, size)
    plane = w.plane
    rng = np.random.default_rng(seed + 1)
    sets = random_sets(rng, plane, 8)
    shapes = [w.geometry(x) for x in sets]
    for x, gx in zip(sets, shapes, strict=True):
        for y, gy in zip(sets, shapes, strict=True):
            r = relate(x, y)
            assert r.de9im == shapely.relate(gx, gy), (x, y, r)
            assert relate(y, x) == r.converse
            assert Relation.from_de9im(r.de9im, dimensions=r.dimensions) == r
            for predicate in PREDICATES:
                assert getattr(r, predicate)() == getattr(shapely, predicate)(gx, gy), (predicate, x, y, r)


PREDICATES = [
    "disjoint",
    "intersects",
    "touches",
    "equals",
    "within",
    "contains",
    "contains_properly",
    "covers",
    "covered_by",
    "crosses",
    "overlaps",
]


@settings(max_examples=150, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(KINDS), st.integers(1, 30))
def test_region_algebra_is_set_algebra(seed, kind, size):
    plane = world(seed, kind, size).plane
    sets = [x for x in random_sets(np.random.default_rng(seed), plane, 12) if isinstance(x, Region)]
    for x in sets:
        for y in sets:
            mine, its = set(x.faces), set(y.faces)
            assert (x | y) == Region.from_faces(plane, mine | its)
            if mine & its:
                assert (x & y) == Region.from_faces(plane, mine & its)
            if mine - its:
                assert (x - y) == Region.from_faces(plane, mine - its)
