"""The sweep over straight pieces against shapely's search and against exact fractions; stars with thousands of spokes."""

from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_maps import MAP_KINDS, random_map

from ninefold.layout import Drawing, draw, drawing_problems, planarity, schnyder, tutte, verify
from ninefold.layout._sweep import insert_after, remove, sweep, turn
from ninefold.layout.planarity import crossing_pieces, first_meeting
from ninefold.mapping import PlaneMap

seeds = st.integers(0, 2**32 - 1)


def exact_turn(a, b, c):
    (ax, ay), (bx, by), (cx, cy) = ([Fraction(float(t)) for t in point] for point in (a, b, c))
    det = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return (det > 0) - (det < 0)


@settings(max_examples=500, deadline=None)
@given(seeds, st.sampled_from(["anywhere", "level", "almost level", "far"]))
def test_turns_are_exact(seed, kind):
    rng = np.random.default_rng(seed)
    xy = rng.random((3, 2)) - 0.5
    if kind in ("level", "almost level"):
        xy = np.round(xy * 64) / 64
        xy[2] = 2 * xy[1] - xy[0] if rng.random() < 0.5 else xy[0] + rng.random() * (xy[1] - xy[0])
    if kind == "almost level":
        xy[2] += rng.integers(-1, 2, 2) * 2.0**-54
    if kind == "far":
        xy = np.round(xy * 2.0**40)
        xy[2] = xy[0] + 3 * (xy[1] - xy[0]) + rng.integers(-1, 2, 2)
    for a, b, c in ((0, 1, 2), (2, 0, 1), (1, 0, 2), (0, 1, 1)):
        assert turn.plain(xy, a, b, c) == turn.compiled(xy, a, b, c) == exact_turn(xy[a], xy[b], xy[c])


def meets(p, q):
    """Whether two pieces, as pairs of exact points, meet elsewhere than at one common end."""
    if p[0] == p[1] or q[0] == q[1]:
        return True
    common = [x for x in p if x in q]
    if len(common) == 2:
        return True
    if common:
        apex = common[0]
        a, b = (x[0] if x[1] == apex else x[1] for x in (p, q))
        same_way = sum((a[k] - apex[k]) * (b[k] - apex[k]) for k in (0, 1)) > 0
        return exact_turn(apex, a, b) == 0 and same_way
    one, two = exact_turn(*p, q[0]) * exact_turn(*p, q[1]), exact_turn(*q, p[0]) * exact_turn(*q, p[1])
    if one == two == 0 and exact_turn(*p, q[0]) == exact_turn(*p, q[1]) == 0:
        return max(min(p), min(q)) <= min(max(p), max(q))
    return one <= 0 and two <= 0


def scattered(seed, kind, size, grid):
    """A drawing of a random map at places of a small grid: mostly wrong, in every degenerate way."""
    plane = random_map(seed, kind, size)
    rng = np.random.default_rng(seed)
    straight = tutte(plane)
    xy, bends = (np.round(part * grid) / (3 if seed % 2 else 1) for part in (straight.points, straight.bends))
    if rng.random() < 0.5 and len(xy):
        xy[rng.integers(len(xy))] = rng.integers(-grid, grid + 1, 2)
    return Drawing.from_points(plane, xy, bends, straight.bend_start)


@settings(max_examples=600, deadline=None)
@given(seeds, st.sampled_from(MAP_KINDS), st.integers(1, 12), st.integers(1, 40))
def test_the_sweep_finds_a_meeting_exactly_where_there_is_one(seed, kind, size, grid):
    drawing = scattered(seed, kind, size, grid)
    pairs, points = crossing_pieces(drawing)
    one, on = first_meeting(drawing)
    assert bool(one or on) == bool(pairs or points)
    assert set(one) <= set(pairs)
    assert set(on) <= set(points)
    pieces = [(tuple(row[:2]), tuple(row[2:])) for row in drawing.pieces[0].tolist()]
    ends = planarity._piece_ends(drawing).tolist()
    place = [drawing.points.tolist(), drawing.bends.tolist()]
    nodes = [tuple(xy) for part in place for xy in part]
    # two nodes at one place are no common end
    wrong = {
        (i, j)
        for i, j in combinations(range(len(pieces)), 2)
        if meets(pieces[i], pieces[j]) or any(nodes[u] == nodes[v] and u != v for u in ends[i] for v in ends[j])
    } | {(i, i) for i, (a, b) in enumerate(pieces) if a == b}
    assert set(one) <= wrong
    if not points:
        assert bool(wrong) == bool(one)


@settings(max_examples=150, deadline=None)
@given(seeds, st.sampled_from(MAP_KINDS), st.integers(1, 60))
def test_right_drawings_pass_the_sweep(seed, kind, size):
    plane = random_map(seed, kind, size)
    for drawing in (schnyder(plane), tutte(plane)):
        assert first_meeting(drawing) == ([], [])


@settings(max_examples=60, deadline=None)
@given(seeds, st.integers(1, 60))
def test_plain_and_compiled_sweep_are_equal(seed, grid):
    drawing = scattered(seed, MAP_KINDS[seed % len(MAP_KINDS)], 10, grid)
    compiled = first_meeting(drawing)  # the kernel is compiled by now, or its plain form runs
    sweep.compiled  # noqa: B018
    assert first_meeting(drawing) == compiled


@settings(max_examples=100, deadline=None)
@given(st.lists(st.tuples(st.booleans(), st.integers(0, 10**6)), max_size=80))
def test_the_treap_keeps_the_order_of_a_list(steps):
    size = len(steps)
    tree = np.full((6, size + 1), -1, np.int64)
    tree[3, size] = tree[4, size] = size
    tree[5, :size] = np.random.default_rng(size).integers(2**31, size=size)
    order = []
    for s, (grow, at) in enumerate(steps):
        if grow or not order:
            place = at % (len(order) + 1)
            insert_after.plain(tree, order[place - 1] if place else size, s)
            order.insert(place, s)
        else:
            remove.plain(tree, order.pop(at % len(order)))
        seen, s = [], int(tree[3, size])
        while s != size:
            seen.append(s)
            s = int(tree[3, s])
        assert seen == order == in_order(tree, int(tree[0, size]))


def in_order(tree, root):
    if root < 0:
        return []
    left, right = int(tree[0, root]), int(tree[1, root])
    assert all(tree[2, child] == root and tree[5, child] <= tree[5, root] for child in (left, right) if child >= 0)
    return [*in_order(tree, left), root, *in_order(tree, right)]


# -- large drawings ------------------------------------------------------------------------------------------------------


def star(spokes):
    leaves = [f"l{i}" for i in range(spokes)]
    return PlaneMap.from_rotation({"hub": leaves, **{leaf: ["hub"] for leaf in leaves}})


def wheel(spokes):
    around = {f"l{i}": [f"l{(i + 1) % spokes}", "hub", f"l{(i - 1) % spokes}"] for i in range(spokes)}
    return PlaneMap.from_rotation({"hub": list(around), **around}, outer=("l1", "l0"))


@pytest.mark.parametrize("plane", [star(20_000), wheel(20_000)], ids=["star", "wheel"])
def test_work_does_not_grow_with_the_square_of_the_degree(plane, monkeypatch):
    """Pairs around a vertex, 200 million of them here, are never made."""
    monkeypatch.setattr(planarity, "crossing_pieces", None)
    drawing = draw(plane)
    assert drawing.layout == "tutte"
    assert drawing_problems(drawing) == ()
    assert verify(plane, n_pairs=30).agree


def test_a_large_wrong_drawing_is_still_noticed():
    plane = star(3_000)
    drawing = draw(plane)
    spoke = np.arange(3001)[:, None] == 7
    for wrong, words in (
        (drawing.points[8], "edges '6' and '7' meet off their ends"),
        (-drawing.points[7] * 0.9, "the rotation at vertex 'hub' is not the map's"),
        (drawing.points[0], "meet off their ends"),
    ):
        problems = drawing_problems(Drawing.from_points(plane, np.where(spoke, wrong, drawing.points)))
        assert words in problems[0]


def test_the_check_of_a_grid_compares_neighbours_only(monkeypatch):
    """A Schnyder drawing of a large grid is full of long thin pieces, whose boxes nearly all overlap."""
    side = 60
    points = [(x, y) for x in range(side) for y in range(side)]
    edges = [(side * x + y, side * x + y + 1) for x in range(side) for y in range(side - 1)]
    edges += [(side * x + y, side * x + y + side) for x in range(side - 1) for y in range(side)]
    plane = PlaneMap.from_geometry(points, edges)
    monkeypatch.setattr(planarity, "crossing_pieces", None)
    drawing = schnyder(plane)
    assert drawing_problems(drawing) == ()
    moved = drawing.points.copy()
    moved[1000] = moved[2500]
    assert "meet off their ends" in drawing_problems(Drawing.from_points(plane, moved))[0]
