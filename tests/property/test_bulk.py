"""The compiled bulk forms give the codes of the plain `relate`."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import KINDS, random_sets, world

from ninefold.mapping import PlaneMap
from ninefold.reasoner import SetTable, converse_codes, relate, relate_all, relate_pairs


@settings(max_examples=150, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(KINDS), st.integers(1, 40))
def test_bulk_equals_plain(seed, kind, size):
    plane = world(seed, kind, size).plane
    sets = random_sets(np.random.default_rng(seed), plane, 12)
    n = len(sets)
    table = SetTable.build(sets)
    expected = np.array([[relate(x, y).code for y in sets] for x in sets], np.uint16)
    assert np.array_equal(relate_all(table), expected)
    pairs = np.random.default_rng(seed).permutation(n * n)
    pairs = np.stack([pairs // n, pairs % n], axis=1)
    codes = relate_pairs(table, pairs)
    assert np.array_equal(codes, expected[pairs[:, 0], pairs[:, 1]])
    assert np.array_equal(relate_pairs(table, pairs[:, ::-1]), converse_codes(codes))


@pytest.mark.parametrize("degree", [63, 64, 65, 128, 200])
def test_vertices_of_many_darts(degree):
    """Stars wider than a word: fans of triangles around one vertex of high degree."""
    angle = np.linspace(0, 2 * np.pi, degree, endpoint=False)
    points = np.concatenate([[[0, 0]], np.stack([np.cos(angle), np.sin(angle)], axis=1)])
    spokes = [(0, k) for k in range(1, degree + 1)]
    rim = [(k, k % degree + 1) for k in range(1, degree + 1)]
    plane = PlaneMap.from_geometry(points, spokes + rim)
    sets = random_sets(np.random.default_rng(degree), plane, 40)
    expected = np.array([[relate(x, y).code for y in sets] for x in sets], np.uint16)
    assert np.array_equal(relate_all(SetTable.build(sets)), expected)
    assert np.array_equal(relate_all(sets), expected)
