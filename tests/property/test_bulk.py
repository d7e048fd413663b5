"""The compiled bulk forms give the codes of the plain `relate`."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import KINDS, random_sets, world

from ninefold.mapping import Line, PlaneMap, Region
from ninefold.reasoner import SetTable, converse_codes, relate, relate_all, relate_pairs
from ninefold.reasoner.sets import _pairs, _stars


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


@given(st.lists(st.integers(0, 9), max_size=60), st.integers(0, 2**32 - 1))
def test_grouping_in_both_forms(keys, seed):
    keys = np.array(keys, np.int32)
    order = np.random.default_rng(seed).permutation(keys.size)
    wanted = sorted(order.tolist(), key=lambda k: keys[k])
    starts = [int((keys < x).sum()) for x in range(11)]
    for form in (_pairs.counting_sort.plain, _pairs.counting_sort.compiled):
        start, result = np.zeros(11, np.int64), np.empty(keys.size, np.int64)
        form(keys, order, start, result)
        assert (result.tolist(), start.tolist()) == (wanted, starts)
    result, start = _pairs.grouped(keys, 10, order)
    assert (result.tolist(), start.tolist()) == (wanted, starts)
    result, start = _pairs.grouped(keys, 10)
    assert result.tolist() == sorted(range(keys.size), key=lambda k: keys[k])


def test_large_groups_are_sorted_by_the_kernel(monkeypatch):
    keys = np.random.default_rng(1).integers(0, 50, 5000).astype(np.int32)
    wanted = _pairs.grouped(keys, 50)
    monkeypatch.setattr(_pairs.counting_sort, "for_work", lambda steps: _pairs.counting_sort.compiled)
    for mine, its in zip(_pairs.grouped(keys, 50), wanted, strict=True):
        assert np.array_equal(mine, its)


@given(st.integers(0, 2**32 - 1), st.integers(1, 3000))
def test_blocks_by_definition(seed, n_cells):
    rng = np.random.default_rng(seed)
    cells = [np.unique(rng.integers(0, n_cells, rng.integers(0, 40))) for _ in range(5)]
    start = np.append(0, np.cumsum([x.size for x in cells]))
    found = _pairs.blocks(np.concatenate(cells).astype(np.int32), start, n_cells)
    n_blocks = (n_cells >> 6) + 1
    for x, its in enumerate(cells):
        rows = range(found["block_start"][x], found["block_start"][x + 1])
        assert found["block"][list(rows)].tolist() == sorted({int(c) >> 6 for c in its})
        for row in rows:
            inside = [int(c) & 63 for c in its if c >> 6 == found["block"][row]]
            assert int(found["mask"][row]) == sum(1 << bit for bit in inside)
            assert found["head"][row] == start[x] + next(k for k, c in enumerate(its) if c >> 6 == found["block"][row])
        patches = sorted({(int(c) >> 6) * 256 // n_blocks for c in its})
        assert sum(int(word) << 64 * k for k, word in enumerate(found["signature"][x])) == sum(1 << p for p in patches)
        runs = found["run"][found["run_start"][x] : found["run_start"][x + 1]].tolist()
        assert [int(found["block"][at]) * 256 // n_blocks for at in runs] == patches
    assert found["run"][-1] == found["block"].size == found["block_start"][-1]
    assert found["mask"][-1] == 0


@pytest.mark.parametrize("kind", KINDS)
def test_stars_in_both_forms(kind, monkeypatch):
    plane = world(3, kind, 30).plane
    sets = random_sets(np.random.default_rng(3), plane, 30)
    assert any(isinstance(x, Region) for x in sets) or any(isinstance(x, Line) for x in sets)
    tables = []
    for form in ("plain", "compiled"):
        for kernel in (_stars.line_stars, _stars.region_stars):
            monkeypatch.setattr(kernel, "for_work", lambda steps, kernel=kernel, form=form: getattr(kernel, form))
        tables.append(SetTable.build(sets).stars)
    for field in tables[0]._fields:
        plain, compiled = (getattr(table, field) for table in tables)
        assert plain.dtype == compiled.dtype
        assert np.array_equal(plain, compiled), field
