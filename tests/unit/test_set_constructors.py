"""`Point`, `Line` and `Region` called directly: every value they let through is one that a map could have made."""

from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_maps import MAP_KINDS, random_map

from ninefold.errors import BadInput, EmptySet
from ninefold.mapping import Line, PlaneMap, Point, Region
from ninefold.reasoner import relate

SQUARES = PlaneMap.from_geometry(
    [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1), (5, 5), (6, 5)],
    [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 0), (1, 4), (6, 7)],
)
BLOCK = SQUARES.cycle(["0", "1", "4", "5"])
TETHER = int(np.flatnonzero(SQUARES.tether)[0])


def test_a_line_is_the_set_of_its_edges_in_whatever_way_they_are_given():
    """`Line(plane, (0, 0))` had two ends fewer than edge 0, and `Line(plane, (1, 0))` was another line than `(0, 1)`."""
    once, twice = Line(SQUARES, (0,)), Line(SQUARES, (0, 0))
    assert once == twice == SQUARES.line(["0"])
    assert twice.boundary == {0, 1}
    assert relate(twice, SQUARES.vertex(0)) == relate(once, SQUARES.vertex(0))
    assert relate(twice, once).name == "equal"
    backwards = Line(SQUARES, (1, 0))
    assert backwards == SQUARES.line(["0", "1"]) == Line(SQUARES, (0, 1))
    assert hash(backwards) == hash(SQUARES.line(["0", "1"]))
    assert backwards.edges == (0, 1)
    given_ = Line(SQUARES, np.array([1, 0], np.int32))
    assert given_ == backwards
    assert all(type(e) is int for e in given_.edges)
    assert Line(SQUARES, (1, 0), [np.int64(0), np.int64(2)]).darts == (0, 2)


@pytest.mark.parametrize(
    ("make", "error", "match"),
    [
        (lambda: Point(SQUARES, 8), BadInput, "no vertex number 8: they run from 0 to 7; plane.vertex"),
        (lambda: Point(SQUARES, -1), BadInput, "no vertex number -1"),
        (lambda: Point(SQUARES, "0"), BadInput, "a vertex number is a whole number, not '0'"),
        (lambda: Point(SQUARES, True), BadInput, "whole number"),
        (lambda: Point(SQUARES, 0.0), BadInput, "whole number"),
        (lambda: Line(SQUARES, ()), EmptySet, "at least one edge"),
        (lambda: Line(SQUARES, (0, 9)), BadInput, "no edge number 9: they run from 0 to 8; plane.line"),
        (lambda: Line(SQUARES, (-1, 0)), BadInput, "no edge number -1"),
        (lambda: Line(SQUARES, (TETHER,)), BadInput, f"edge number {TETHER} is a tether"),
        (lambda: Line(SQUARES, "01"), BadInput, r"edges are given as several numbers, such as \[1, 2\], not as '01'"),
        (lambda: Line(SQUARES, 3), BadInput, "edges are given as several numbers"),
        (lambda: Line(SQUARES, ("0",)), BadInput, "an edge number is a whole number"),
        (lambda: Line(SQUARES, (0, 1), (0,)), BadInput, "do not run along each of the edges"),
        (lambda: Line(SQUARES, (0, 1), (0, 1, 2)), BadInput, "do not run along each of the edges"),
        (lambda: Line(SQUARES, (0, 1), (0, 3)), BadInput, "dart 3 does not begin at '1', where dart 0 ends"),
        (lambda: Line(SQUARES, (0,), (2,)), BadInput, "do not run along"),
        (lambda: Line(SQUARES, (0,), (-1,)), BadInput, "do not run along"),
        (lambda: Region(SQUARES, [], []), EmptySet, "at least one face"),
        (lambda: Region(SQUARES, [1], [0]), BadInput, r"even number of rising numbers from 1 to 3, not \[1\]"),
        (lambda: Region(SQUARES, [2, 1], [0]), BadInput, "rising"),
        (lambda: Region(SQUARES, [0, 1], [0]), BadInput, "rising numbers from 1"),
        (lambda: Region(SQUARES, [1, 9], [0]), BadInput, "rising numbers from 1 to 3"),
        (lambda: Region(SQUARES, [1, 2], []), BadInput, "not the boundary"),
        (lambda: Region(SQUARES, [1, 2], [99]), BadInput, "not the boundary"),
        (lambda: Region(SQUARES, ["a", 2], [0]), BadInput, "whole number"),
        (lambda: SQUARES.region(1), BadInput, r"several face numbers, as in plane.region\(\[1\]\); plane.face\(1\) is one"),
        (lambda: SQUARES.region(BLOCK), BadInput, "is a set already; .* joins regions"),
        (lambda: SQUARES.region([0.5]), BadInput, "a face number is a whole number, not 0.5"),
        (lambda: SQUARES.region([True]), BadInput, "whole number"),
        (lambda: SQUARES.cycle(7), BadInput, "a cycle takes a list of names, not 7"),
        (lambda: BLOCK.left_of("v1"), BadInput, r"split along a path .*, not by 'v1'; plane.path\(\[...\]\)"),
        (lambda: BLOCK.right_of(BLOCK), BadInput, "split along a path"),
    ],
)
def test_what_is_no_set_is_refused(make, error, match):
    with pytest.raises(error, match=match):
        make()


maps = st.builds(random_map, st.integers(0, 2**32 - 1), st.sampled_from(MAP_KINDS), st.integers(1, 14))


@settings(max_examples=150, deadline=None)
@given(maps, st.integers(0, 2**32 - 1))
def test_a_region_takes_its_own_boundary_and_no_other(plane, seed):
    """Every boundary but the right one is refused: darts left out (also all of one hole), added, or turned around."""
    rng = np.random.default_rng(seed)
    bounded = [f for f in range(plane.n_faces) if f != plane.outer_face]
    if not bounded:
        return
    region = plane.region([f for f in bounded if rng.random() < 0.5] or bounded[:1])
    assert Region(plane, region.ends, region.darts) == region
    assert Region(plane, region.ends.tolist(), region.darts[::-1].tolist()).darts.tolist() == region.darts.tolist()
    right = set(region.darts.tolist())
    others = [set(some) for k in range(min(3, len(right)) + 1) for some in combinations(sorted(right), k)]
    wrong = [right - some for some in others if some]
    wrong += [set(rim) for rim in (right ^ {d} for d in range(plane.tail.size))]
    wrong += [{d for d in right if int(plane.tail[d]) not in rim} for rim in region.rims]
    wrong += [{d ^ 1 for d in right}]
    for darts in wrong:
        if darts != right:
            with pytest.raises(BadInput, match="not the boundary"):
                Region(plane, region.ends, sorted(darts))
    with pytest.raises(BadInput, match="not the boundary"):
        Region(plane, region.ends, [*region.darts.tolist(), int(region.darts[0])])


@settings(max_examples=150, deadline=None)
@given(maps, st.integers(0, 2**32 - 1))
def test_a_line_takes_any_edges_in_any_order(plane, seed):
    rng = np.random.default_rng(seed)
    real = np.flatnonzero(~plane.tether)
    if not real.size:
        return
    some = rng.choice(real, size=rng.integers(1, 2 * real.size + 1))
    line = Line(plane, tuple(some))
    assert line == plane.line([plane.edge_names[int(e)] for e in some])
    assert list(line.edges) == sorted(set(some.tolist()))
