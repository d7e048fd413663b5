"""Kernels of maps, plain and compiled, against numpy."""

import numpy as np
import pytest

from ninefold.mapping import _orbits


@pytest.mark.parametrize("form", ["plain", "compiled"])
@pytest.mark.parametrize("degree", [1, 2, 3, 40, 48, 49, 50, 121, 122, 1000])
def test_darts_are_sorted_by_heading(degree, form):
    """Vertices 0 and 2 have few darts, vertex 1 has many."""
    rng = np.random.default_rng(degree)
    tail = rng.permutation(np.repeat([0, 1, 2], [3, degree, 2])).astype(np.int32)
    heading = rng.permutation(tail.size) * 2 * np.pi / tail.size - np.pi
    next_ccw, closest, at = getattr(_orbits.sort_rotation, form)(tail, heading, 3)
    gaps = {}
    for v in range(3):
        darts = np.flatnonzero(tail == v)
        darts = darts[np.argsort(heading[darts])]
        assert next_ccw[darts].tolist() == np.roll(darts, -1).tolist()
        if darts.size > 1:
            its = (np.roll(heading[darts], -1) - heading[darts]) % (2 * np.pi)
            gaps.update(zip(darts.tolist(), its.tolist(), strict=True))
    assert closest == pytest.approx(min(gaps.values()))
    assert gaps[at] == pytest.approx(closest)
