import itertools

import numpy as np
from hypothesis import example, given, settings
from hypothesis import strategies as st
from worlds import KINDS, random_sets, world

from ninefold.mapping import Line


@settings(max_examples=150, deadline=None)
@given(st.integers(0, 2**32 - 1), st.sampled_from(KINDS), st.integers(1, 30))
@example(197820, "whole", 25)  # a closed walk that joins two others
@example(2479651, "dense", 13)  # a loop that links an open trail to another loop
def test_trails_cover_every_edge_once_and_end_at_the_boundary(seed, kind, size):
    plane = world(seed, kind, size).plane
    for line in random_sets(np.random.default_rng(seed), plane, 10):
        if not isinstance(line, Line):
            continue
        assert sorted(d >> 1 for trail in line.trails for d in trail) == list(line.edges)
        ends = []
        for trail in line.trails:
            assert all(plane.tail[a ^ 1] == plane.tail[b] for a, b in itertools.pairwise(trail))
            if plane.tail[trail[0]] != plane.tail[trail[-1] ^ 1]:
                ends += [int(plane.tail[trail[0]]), int(plane.tail[trail[-1] ^ 1])]
        assert sorted(ends) == sorted(line.boundary)
        # fewest: one trail for every two odd vertices of a piece, one for a piece without
        assert len(line.trails) == sum(max(1, len(piece & line.boundary) // 2) for piece in line.pieces)
