"""What changes a map without changing what lies where: relations of the corresponding sets stay as they are.

Other numbers, the mirror image, another outer dart or spanning tree, a vertex more on an edge, an edge more across a face, a
dead end or a separate place more in it. Each change gives the new map and carries sets over to it; the relations of all
carried pairs, alone and in bulk, and the tree of what contains what are those of the first map.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_maps import MAP_KINDS, Growth, random_map
from worlds import KINDS, random_sets, world

from ninefold.errors import BadInput
from ninefold.mapping import Line, PlaneMap, Point, Region
from ninefold.mapping.containment import ContainmentIndex, numbers_of_ends
from ninefold.mapping.sets import Set
from ninefold.reasoner import containment_tree, de9im_strings, relate, relate_all

Carry = Callable[[Set], Set]
Change = Callable[[np.random.Generator, PlaneMap], tuple[PlaneMap, Carry]]

seeds = st.integers(0, 2**32 - 1)
maps = st.builds(random_map, seeds, st.sampled_from(MAP_KINDS), st.integers(0, 20)) | st.builds(
    lambda *given: world(*given).plane, seeds, st.sampled_from(KINDS), st.integers(1, 20)
)


def carried(plane: PlaneMap, again: PlaneMap, vertex, edges, faces) -> Carry:
    """Carry sets over: where each vertex goes, which edges each edge becomes, and which faces each face."""

    def carry(x: Set) -> Set:
        if isinstance(x, Point):
            return Point(again, int(vertex[x.index]))
        if isinstance(x, Line):
            return Line(again, tuple(sorted(int(e) for old in x.edges for e in edges[old])))
        return Region.from_faces(again, [f for old in x.faces for f in faces[old]])

    return carry


def single(values) -> list[tuple[int, ...]]:
    return [(int(value),) for value in values]


def faces_by_dart(plane: PlaneMap, again: PlaneMap, dart) -> list[tuple[int, ...]]:
    """The faces that each face becomes, told by the dart that stands for each of its darts."""
    becomes: list[set[int]] = [set() for _ in range(plane.n_faces)]
    for d in range(plane.tail.size):
        becomes[int(plane.face_of[d])].add(int(again.face_of[dart[d]]))
    return [tuple(faces) for faces in becomes]


# -- changes ---------------------------------------------------------------------------------------------------------------


def relabel(rng: np.random.Generator, plane: PlaneMap) -> tuple[PlaneMap, Carry]:
    """Renumber vertices and edges, turn some edges round."""
    n, m = plane.n_vertices, plane.tail.size // 2
    vertex, edge, flip = rng.permutation(n), rng.permutation(m), rng.integers(0, 2, m)
    darts = np.arange(2 * m)
    new = 2 * edge[darts >> 1] + ((darts & 1) ^ flip[darts >> 1])
    tail, after, tether = np.empty(2 * m, int), np.empty(2 * m, int), np.empty(m, bool)
    tail[new], after[new], tether[edge] = vertex[plane.tail], new[plane.next_ccw], plane.tether
    heading = turn = None
    outer: int | None = int(new[plane.outer]) if m else None
    if plane.heading is not None:  # then it is for the turning numbers to say where the outer face is
        outer, heading, turn = None, np.empty(2 * m), np.empty(m)
        heading[new], turn[edge] = plane.heading, np.where(flip, -1, 1) * plane.turn
    again = PlaneMap.from_darts(tail, after, outer, n_vertices=n, tether=tether, heading=heading, turn=turn)
    assert plane.outer < 0 or again.face_of[new[plane.outer]] == again.outer_face
    return again, carried(plane, again, vertex, single(edge), faces_by_dart(plane, again, new))


def mirror(_: np.random.Generator, plane: PlaneMap) -> tuple[PlaneMap, Carry]:
    """Turn the plane over: rotation, headings and turns the other way round."""
    before = np.empty_like(plane.next_ccw)
    before[plane.next_ccw] = np.arange(plane.tail.size)
    other_side = np.arange(plane.tail.size) ^ 1  # left of a dart is now what was left of its twin
    outer: int | None = plane.outer ^ 1 if plane.outer >= 0 else None
    heading = turn = None
    if plane.heading is not None:
        outer, turn = None, -plane.turn
        heading = np.where(plane.heading == math.pi, math.pi, -plane.heading)
    again = PlaneMap.from_darts(
        plane.tail, before, outer, n_vertices=plane.n_vertices, tether=plane.tether, heading=heading, turn=turn
    )
    assert plane.outer < 0 or again.face_of[plane.outer ^ 1] == again.outer_face
    edges = single(range(plane.tether.size))
    return again, carried(plane, again, range(plane.n_vertices), edges, faces_by_dart(plane, again, other_side))


def another_outer_dart(rng: np.random.Generator, plane: PlaneMap) -> tuple[PlaneMap, Carry]:
    """Name the outer face by another of its darts: the same map."""
    darts = np.flatnonzero(plane.face_of == plane.outer_face) if plane.outer >= 0 else []
    again = PlaneMap.from_darts(
        plane.tail, plane.next_ccw, int(rng.choice(darts)) if len(darts) else None, n_vertices=plane.n_vertices,
        tether=plane.tether, heading=plane.heading, turn=plane.turn,
    )  # fmt: skip
    assert again.outer_face == plane.outer_face
    return again, carried(
        plane, again, range(plane.n_vertices), single(range(plane.tether.size)), single(range(plane.n_faces))
    )


def another_spanning_tree(rng: np.random.Generator, plane: PlaneMap) -> tuple[PlaneMap, Carry]:
    """The same map with a containment index over another spanning tree."""
    again = PlaneMap.from_darts(
        plane.tail, plane.next_ccw, plane.outer if plane.outer >= 0 else None, n_vertices=plane.n_vertices,
        tether=plane.tether, heading=plane.heading, turn=plane.turn,
    )  # fmt: skip
    index = ContainmentIndex.build(again.next_face, again.face_of, random_tree(rng, again), again.outer, again.n_faces)
    again.__dict__["containment"] = index  # where the cached property keeps it
    assert again.containment is index
    return again, carried(
        plane, again, range(plane.n_vertices), single(range(plane.tether.size)), single(range(plane.n_faces))
    )


def random_forest(rng: np.random.Generator, plane: PlaneMap, edges) -> tuple[np.ndarray, list[int]]:
    """A random spanning forest of some edges, as a mask, and which tree each vertex is in."""
    root = list(range(plane.n_vertices))

    def top(v: int) -> int:
        while root[v] != v:
            v = root[v]
        return v

    forest = np.zeros(plane.tether.size, bool)
    for e in rng.permutation(edges).tolist():
        u, v = (top(int(plane.tail[d])) for d in (2 * e, 2 * e + 1))
        if u != v:
            root[u], forest[e] = v, True
    return forest, [top(v) for v in range(plane.n_vertices)]


def random_tree(rng: np.random.Generator, plane: PlaneMap) -> np.ndarray:
    return random_forest(rng, plane, range(plane.tether.size))[0]


def subdivide(rng: np.random.Generator, plane: PlaneMap) -> tuple[PlaneMap, Carry]:
    """A vertex on an edge: it becomes two."""
    real = np.flatnonzero(~plane.tether)
    if not len(real):
        return another_outer_dart(rng, plane)
    e = int(rng.choice(real))
    back, new, n = 2 * e + 1, plane.tail.size, plane.n_vertices
    tail = [*plane.tail.tolist(), n, int(plane.tail[back])]
    after = [*plane.next_ccw.tolist(), back, int(plane.next_ccw[back])]
    after[after.index(back)] = new + 1  # the far half takes the place of the edge's way back
    if after[new + 1] == back:
        after[new + 1] = new + 1
    tail[back], after[back] = n, new
    again = PlaneMap.from_darts(tail, after, plane.outer, n_vertices=n + 1, tether=[*plane.tether.tolist(), False])
    edges = [(k, new >> 1) if k == e else (k,) for k in range(plane.tether.size)]
    return again, carried(plane, again, range(n), edges, faces_by_dart(plane, again, range(new)))


def grown(plane: PlaneMap) -> Growth:
    """The map as a rotation system that grows."""
    grow = Growth()
    grow.n_vertices = plane.n_vertices
    grow.tail, grow.after = plane.tail.tolist(), plane.next_ccw.tolist()
    grow.before = [0] * len(grow.after)
    for d, following in enumerate(grow.after):
        grow.before[following] = d
    return grow


def regrown(plane: PlaneMap, grow: Growth, face: int, outer: int, *, tether: bool = False) -> tuple[PlaneMap, Carry]:
    """The map with the last edge of `grow`, drawn in a face."""
    tethers = [*plane.tether.tolist(), tether]
    again = PlaneMap.from_darts(grow.tail, grow.after, outer, n_vertices=grow.n_vertices, tether=tethers)
    faces = faces_by_dart(plane, again, range(plane.tail.size))
    faces[face] = tuple({*faces[face], *again.face_of[-2:].tolist()})  # a loop may have no known dart on one side
    return again, carried(plane, again, range(plane.n_vertices), single(range(plane.tether.size)), faces)


def split_a_face(rng: np.random.Generator, plane: PlaneMap) -> tuple[PlaneMap, Carry]:
    """An edge between two corners of a face, the outer one too, within one component: the face becomes two."""
    grow = grown(plane)
    if not plane.tail.size:
        grow.chord(-1, -1)
        return regrown(plane, grow, 0, int(rng.integers(2)))
    corner = int(rng.integers(plane.tail.size))
    _, component = random_forest(rng, plane, np.flatnonzero(~plane.tether))
    face = int(plane.face_of[corner])
    same = [d for d in plane.face_darts(face) if component[plane.tail[d]] == component[plane.tail[corner]]]
    grow.chord(corner, int(rng.choice(same)))
    # Either half of the outer face may be the one outside.
    outer = plane.tail.size + int(rng.integers(2)) if face == plane.outer_face else plane.outer
    return regrown(plane, grow, face, outer)


def dead_end(rng: np.random.Generator, plane: PlaneMap) -> tuple[PlaneMap, Carry]:
    """A dead end, or a place of its own tied by a tether, somewhere in a face."""
    grow = grown(plane)
    corner = int(rng.integers(plane.tail.size)) if plane.tail.size else -1
    grow.pendant(corner)
    face = int(plane.face_of[corner]) if corner >= 0 else 0
    return regrown(plane, grow, face, plane.outer if plane.outer >= 0 else 0, tether=bool(rng.integers(2)))


def several(rng: np.random.Generator, plane: PlaneMap) -> tuple[PlaneMap, Carry]:
    """Four changes, one after the other."""
    again, carries = plane, []
    for change in rng.choice(np.array(SINGLE, object), 4):
        again, carry = change(rng, again)
        carries.append(carry)

    def through(x: Set) -> Set:
        for carry in carries:
            x = carry(x)
        return x

    return again, through


SINGLE: list[Change] = [
    relabel, mirror, another_outer_dart, another_spanning_tree, subdivide, split_a_face, dead_end
]  # fmt: skip


# -- what stays ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("change", [*SINGLE, several], ids=lambda change: change.__name__)
@settings(max_examples=60, deadline=None)
@given(plane=maps, seed=seeds)
def test_relations_stay(change: Change, plane: PlaneMap, seed: int):
    rng = np.random.default_rng(seed)
    again, carry = change(rng, plane)
    again.validate()
    sets = random_sets(rng, plane, 7)
    moved = [carry(x) for x in sets]
    for x, there in zip(sets, moved, strict=True):
        for y, that in zip(sets, moved, strict=True):
            assert relate(there, that) == relate(x, y)
    assert de9im_strings(relate_all(moved)).tolist() == de9im_strings(relate_all(sets)).tolist()


@pytest.mark.parametrize("change", [*SINGLE, several], ids=lambda change: change.__name__)
@settings(max_examples=40, deadline=None)
@given(plane=maps, seed=seeds)
def test_the_tree_of_containment_stays(change: Change, plane: PlaneMap, seed: int):
    rng = np.random.default_rng(seed)
    _, carry = change(rng, plane)
    regions = {f"r{k}": x for k, x in enumerate(random_sets(rng, plane, 15)) if isinstance(x, Region)}
    before, after = containment_tree(regions), containment_tree({name: carry(x) for name, x in regions.items()})
    assert dict(after.nodes(data=True)) == dict(before.nodes(data=True))
    assert set(after.edges) == set(before.edges)


@settings(max_examples=150, deadline=None)
@given(maps, seeds)
def test_every_spanning_tree_gives_the_same_inside(plane: PlaneMap, seed: int):
    """The faces inside a closed walk, found over two trees, and by asking which faces a way across the walk separates."""
    rng = np.random.default_rng(seed)
    index = another_spanning_tree(rng, plane)[0].containment
    assert sorted(index.preorder.tolist()) == list(range(plane.n_faces))
    for x in random_sets(rng, plane, 6):
        if isinstance(x, Region):
            edges = np.array(x.boundary.edges, np.int64)
            for each in (plane.containment, index):
                assert sorted(each.face_at[numbers_of_ends(each.inside(edges))].tolist()) == list(x.faces)
    assert index.preorder[plane.outer_face] == 0


@settings(max_examples=150, deadline=None)
@given(maps, seeds)
def test_a_mirror_swaps_left_and_right(plane: PlaneMap, seed: int):
    rng = np.random.default_rng(seed)
    again, carry = mirror(rng, plane)
    for x in random_sets(rng, plane, 12):
        if not isinstance(x, Region):
            continue
        for path in chords(plane, x):
            there = Line(again, path.edges, path.darts)
            assert carry(x).left_of(there) == carry(x.right_of(path))
            assert carry(x).right_of(there) == carry(x.left_of(path))


def chords(plane: PlaneMap, region: Region) -> list[Line]:
    """Single edges that split a region, as paths; of the first five edges within it."""
    inside = np.isin(np.arange(plane.n_faces), region.faces)
    left, right = plane.face_of[0::2], plane.face_of[1::2]
    found = []
    for e in np.flatnonzero(inside[left] & inside[right] & (left != right) & ~plane.tether)[:5].tolist():
        path = Line(plane, (e,), (2 * e,))
        try:
            left_part, right_part = region.left_of(path), region.right_of(path)
        except BadInput:  # it does not go from rim to rim
            continue
        assert not set(left_part.faces) & set(right_part.faces)
        assert set(left_part.faces) | set(right_part.faces) <= set(region.faces)  # other parts are in neither
        found.append(path)
    return found


def test_the_changes_change_what_they_say():
    """On a square with a diagonal: counts before and after."""
    plane = PlaneMap.from_geometry([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)])
    rng = np.random.default_rng(1)
    counts = {change.__name__: change(rng, plane)[0] for change in SINGLE}
    counts = {name: (again.n_vertices, again.n_edges, again.n_faces) for name, again in counts.items()}
    same = (4, 5, 3)
    assert counts == {
        "relabel": same, "mirror": same, "another_outer_dart": same, "another_spanning_tree": same,
        "subdivide": (5, 6, 3), "split_a_face": (4, 6, 4), "dead_end": counts["dead_end"],
    }  # fmt: skip
    assert counts["dead_end"] in ((5, 6, 3), (5, 5, 3))
    mirrored = mirror(rng, plane)[0]
    around = plane.darts_at(0)
    assert all(mirrored.next_ccw[b] == a for a, b in pairwise(around))
    trees = {random_tree(rng, plane).tobytes() for _ in range(50)}
    assert len(trees) == 8  # of the diamond graph
