"""Two robots in one space: what they share, the whole map, what contradicts, and all ways in which they can overlap."""

import networkx as nx
import numpy as np
import pytest

from ninefold.errors import BadInput, MapsDisagree, NotPlane, UnknownName
from ninefold.io.sources import samples
from ninefold.mapping import (
    Heading,
    OpenMap,
    PlaneMap,
    Samples,
    SimulatedWorld,
    Visit,
    Walk,
    WalkHeader,
    build,
    explore,
    joined,
    merge,
    open_map,
    overlaps,
)
from ninefold.mapping.doubt.hypotheses import hypotheses

DEG = Heading.from_degrees


def grid(width, height, missing=(), names=None):
    points = [(x, y) for y in range(height) for x in range(width)]
    ways = [
        (i, j)
        for i, a in enumerate(points)
        for j, b in enumerate(points)
        if i < j and abs(a[0] - b[0]) + abs(a[1] - b[1]) == 1 and (i, j) not in missing
    ]
    return SimulatedWorld(points, ways, vertex_names=names or [f"v{x}{y}" for x, y in points])


def cut(walk, first, last):
    """The part of a walk from one visit to another, counted from 0."""
    visits = [k for k, event in enumerate(walk.events) if isinstance(event, Visit)]
    return Walk(walk.header, walk.events[visits[first] : visits[last] + 1])


def renamed(walk, called):
    """A walk in which places have other names and ways none."""
    return Walk(
        walk.header,
        tuple(Visit(called(e.place), e.exits) if isinstance(e, Visit) else e for e in walk.events),
    )


def same_map(found: PlaneMap, true: PlaneMap) -> None:
    """Same names, ways, rotations and outer face; ways are told apart by their ends and headings."""
    assert set(found.vertex_names) == set(true.vertex_names)

    def key(plane, d):
        one, other = (plane.vertex_names[int(plane.tail[x])] for x in (d, d ^ 1))
        yaws = [round(float(np.degrees(plane.heading[x])) / 3) % 120 for x in (d, d ^ 1)]
        return one, other, *yaws

    ours, theirs = ({key(p, d): d for d in range(p.tail.size)} for p in (found, true))
    assert len(ours) == found.tail.size == true.tail.size
    assert set(ours) == set(theirs)
    to = np.array([theirs[key(found, d)] for d in range(found.tail.size)])
    assert np.array_equal(to[found.next_ccw], true.next_ccw[to])
    faces = set(zip(found.face_of.tolist(), true.face_of[to].tolist(), strict=True))
    assert (found.outer_face, true.outer_face) in faces
    assert len(faces) == found.n_faces == true.n_faces


@pytest.mark.parametrize("seed", range(8))
def test_two_halves_of_a_walk_make_the_whole(seed):
    world = grid(5, 5, missing=[(6, 7), (12, 17)])
    walk = explore(world, seed=seed, tour="covering").walk
    n = len(walk.places) - 1
    first, second = cut(walk, 0, 2 * n // 3), renamed(cut(walk, n // 3, n), lambda name: f"w{name}")
    shared = walk.places[n // 2]
    both = set(cut(walk, 0, 2 * n // 3).places) & set(cut(walk, n // 3, n).places)
    true = {(name, f"w{name}") for name in both}
    try:
        assert set(merge(first, second, at=(shared, f"w{shared}")).shared) <= true
    except NotPlane:  # the two meet elsewhere too
        assert true in [set(one.shared) for one in overlaps(first, second, at=(shared, f"w{shared}"), least=1)]
    everywhere = merge(first, cut(walk, n // 3, n), same_names=True)
    same_map(everywhere.plane, build(walk))
    assert everywhere.known.n_open == 0
    assert {a for a, _ in everywhere.shared} == both


def test_halves_of_the_district_make_the_district():
    world = samples.load("helsinki_district").to_world()
    walk = explore(world, seed=3).walk
    n = len(walk.places) - 1
    first, second = cut(walk, 0, 2 * n // 3), cut(walk, n // 3, n)
    whole = merge(first, second, same_names=True)
    same_map(whole.plane, build(walk))
    other = renamed(second, lambda name: f"{name}'")
    shared = walk.places[n // 2]
    placed = merge(first, other, at=(shared, f"{shared}'"))
    assert all(b == f"{a}'" for a, b in placed.shared)
    assert len(placed.shared) > 50


def test_the_overlap_of_two_walks_in_the_district_is_found():
    world = samples.load("helsinki_district").to_world()
    walk = explore(world, seed=5).walk
    first, second = cut(walk, 0, 120), renamed(cut(walk, 80, 200), lambda name: f"{name}'")
    found = overlaps(first, second, least=4)
    assert found.exact
    best = found.found[0]
    assert len(best.shared) > 8
    assert all(b == f"{a}'" for a, b in best.shared)
    assert [len(one.shared) for one in found] == sorted((len(one.shared) for one in found), reverse=True)


def test_what_one_walked_and_the_other_left_open_is_walked_in_the_whole():
    ring = grid(2, 2)
    walk = explore(ring, start="v00").walk
    first, second = cut(walk, 0, 2), cut(walk, 2, 4)
    assert (open_map(first).n_open, open_map(second).n_open) == (2, 2)
    whole = merge(first, second, same_names=True)
    assert (whole.known.n_open, whole.ways, whole.plane.n_edges, whole.plane.n_faces) == (0, 0, 4, 2)


def test_a_plane_map_may_lack_exits_that_the_other_knows():
    world = grid(3, 3)
    walk = explore(world, seed=1, tour="covering").walk
    part = build(cut(walk, 0, 6))
    second = cut(walk, 3, len(walk.places) - 1)
    same_map(merge(part, second, same_names=True).plane, build(walk))
    same_map(merge(second, part, same_names=True).plane, build(walk))
    assert not merge(part, build(second), same_names=True).known.complete


def test_names_that_mean_other_places_in_the_second_map_get_an_apostrophe():
    world = grid(4, 1, names=["a", "b", "c", "d"])
    walk = explore(world, start="a").walk
    second = renamed(cut(walk, 1, 3), {"b": "x", "c": "a", "d": "b"}.get)
    whole = merge(cut(walk, 0, 1), second, at=("b", "x"))
    assert dict(whole.names) == {"x": "b", "a": "a'", "b": "b'"}
    assert sorted(whole.plane.vertex_names) == ["a", "a'", "b", "b'"]


# -- contradictions -------------------------------------------------------------------------------------------------------


def leg(*degrees):
    return Samples.of(*map(DEG, degrees))


def place(name, *degrees):
    return Visit(name, tuple(map(DEG, degrees)))


def test_contradictions_name_the_places_and_exits():
    first = Walk(WalkHeader(), (place("a", 0), leg(0), place("b", 180, 90), leg(90), place("c", -90)))
    other_exits = Walk(WalkHeader(), (place("s", 0), leg(0), place("t", 180, 90, 0)))
    with pytest.raises(
        MapsDisagree, match=r"'t' of the second map would be 'b' of the first, and cannot: .*90.*180"
    ) as error:
        merge(first, other_exits, at=("a", "s"))
    assert "\n" not in str(error.value)
    with pytest.raises(MapsDisagree, match="'a' and 't' cannot be one place"):
        merge(first, other_exits, at=("a", "t"))
    curved = Walk(WalkHeader(), (place("s", 0), leg(0, 120, 240, 360), place("t", 180, 90)))
    with pytest.raises(MapsDisagree, match=r"leaves 'a' at 0 deg turns 0 deg in the first map and 360 deg in"):
        merge(first, curved, at=("a", "s"))
    with pytest.raises(MapsDisagree, match=r"the way from 'a' to 'b' leaves at .* and that from 'c' to 'b' at"):
        merge(first, first, way=(("a", "b"), ("c", "b")))


def test_one_place_that_would_be_two_is_named():
    ring = grid(3, 3)
    walk = explore(ring, seed=0).walk
    line = Walk(  # walks once round the same square, and takes the corner it comes back to for another place
        WalkHeader(),
        (
            place("s", 0, 90),
            leg(0),
            place("t", 0, 90, 180),
            leg(90),
            place("u", 0, 90, 180, 270),
            leg(180),
            place("v", 0, 90, 270),
            leg(270),
            place("w", 0, 90),
        ),
    )
    with pytest.raises(MapsDisagree, match="'w' of the second map would be 'v00' of the first, and so would 's'"):
        merge(walk, line, at=("v00", "s"))
    with pytest.raises(MapsDisagree, match="'s' of the second map would be both 'v00' and 'v02' of the first") as error:
        merge(renamed(line, {"s": "v00", "t": "b", "u": "c", "v": "d", "w": "v02"}.get), walk_round(), at=("v00", "s"))
    assert isinstance(error.value, BadInput)


def walk_round():
    """Once round the square, and the corner recognised."""
    return Walk(
        WalkHeader(),
        (
            place("s", 0, 90),
            leg(0),
            place("t", 0, 90, 180),
            leg(90),
            place("u", 0, 90, 180, 270),
            leg(180),
            place("v", 0, 90, 270),
            leg(270),
            place("s", 0, 90),
        ),
    )


def test_a_whole_that_is_not_plane_is_refused():
    first = Walk(WalkHeader(), (place("a", 0, 90), leg(0), place("b", 180, 90)))
    over = Walk(WalkHeader(), (place("a", 0, 90), leg(90, 0, -90), place("b", 180, 90)))
    assert merge(first, over, same_names=True).plane.n_faces == 2
    around = Walk(WalkHeader(), (place("a", 0, 90), leg(90, 180, 270), place("b", 180, 90)))  # it would cross the first way
    with pytest.raises(NotPlane):
        merge(first, around, same_names=True)
    assert len(overlaps(first, around, same_names=True)) == 0
    elsewhere = Walk(WalkHeader(), (place("a", 0, 90), leg(0), place("c", 180, 90), leg(90), place("b", 270, 90)))
    with pytest.raises(MapsDisagree, match="'b' cannot be the same place in both: the exits lie at 90, 180 and at -90, 90"):
        merge(first, elsewhere, same_names=True)


def test_what_is_given_is_checked():
    walk = explore(grid(2, 2)).walk
    with pytest.raises(BadInput, match="nothing given in common"):
        merge(walk, walk)
    with pytest.raises(UnknownName, match="no place named 'v99'"):
        merge(walk, walk, at=("v99", "v00"))
    with pytest.raises(BadInput, match="no ways lead from 'v00' to 'v11'"):
        merge(walk, walk, way=(("v00", "v11"), ("v00", "v01")))
    with pytest.raises(BadInput, match="visit 1 of the walk names no place; take one of its hypotheses"):
        merge(walk, explore(grid(2, 2), places=False).walk, at=("v00", "v00"))
    with pytest.raises(BadInput, match=r"a Walk, OpenMap, Hypothesis or PlaneMap, not 'walk\.jsonl'"):
        overlaps(walk, "walk.jsonl")
    with pytest.raises(BadInput, match="has no headings"):
        overlaps(walk, PlaneMap.from_rotation({"a": ["b"], "b": ["a"]}))
    with pytest.raises(BadInput, match="least is a whole number"):
        overlaps(walk, walk, least=0)


# -- overlaps -------------------------------------------------------------------------------------------------------------


def test_no_overlap():
    first = explore(SimulatedWorld([(0, 0), (1, 0)], [(0, 1)])).walk
    second = explore(SimulatedWorld([(0, 0), (0, 1)], [(0, 1)])).walk
    found = overlaps(first, second, least=1)
    assert (len(found), found.exact) == (0, True)


def test_several_overlaps_are_all_returned_the_largest_first():
    corridor = explore(grid(6, 1), start="v00").walk  # doors all alike
    first, second = cut(corridor, 0, 3), renamed(cut(corridor, 2, 5), lambda name: f"w{name}")
    found = overlaps(first, second, least=1)
    assert found.exact
    pairs = [dict(one.shared) for one in found]
    assert {"v20": "wv20", "v30": "wv30"} in pairs
    assert [len(one) for one in pairs] == sorted(map(len, pairs), reverse=True)
    assert len(pairs) > 1
    assert len({tuple(sorted(one.items())) for one in pairs}) == len(pairs)
    for one, shared in zip(found, pairs, strict=True):
        assert one.plane.n_vertices == 4 + 4 - len(shared)
        assert (one.plane.n_edges, one.plane.n_faces) == (one.plane.n_vertices - 1, 1)


def brute_overlaps(a: OpenMap, b: OpenMap) -> set[tuple[tuple[str, str], ...]]:
    """All matchings of places under which the two maps agree and the whole is plane, and none larger is; slowly."""
    possible = [(p, q) for p in range(a.n_places) for q in range(b.n_places)]
    found = set()

    def agrees(pairs):
        names = [(a.name(p), b.name(q)) for p, q in pairs]
        # rename the second's places as the matching says, and let names alone decide
        called = {q: a.name(p) for p, q in pairs}
        other = OpenMap()
        for q in range(b.n_places):
            other.see([b.heading[y] for y in b.exits(q)], called.get(q, f"own{q}"))
        for out, back in enumerate(b.mate):
            if out < back:
                other.join(out, back, b.turn[out])
        try:
            whole = merge(a, other, same_names=True)
        except (MapsDisagree, NotPlane):
            return None
        return tuple(sorted(names)) if len(whole.shared) == len(pairs) else None

    def grow(pairs, start):
        if pairs and (names := agrees(pairs)) is not None:
            found.add(names)
        for k in range(start, len(possible)):
            p, q = possible[k]
            if all(p != r and q != s for r, s in pairs):
                grow([*pairs, (p, q)], k + 1)

    grow([], 0)
    return {one for one in found if not any(set(one) < set(other) for other in found)}


@pytest.mark.parametrize("seed", range(4))
def test_overlaps_are_those_of_a_brute_force(seed):
    rng = np.random.default_rng(seed)
    walk = explore(grid(3, 2), seed=seed, tour="covering").walk
    n = len(walk.places) - 1
    one = int(rng.integers(2, 4))
    first, second = cut(walk, 0, one), renamed(cut(walk, one - 1, min(n, one + 2)), lambda name: f"w{name}")
    found = overlaps(first, second, least=1)
    assert found.exact
    assert {one.shared for one in found} == brute_overlaps(open_map(first), open_map(second))


def test_an_overlap_in_two_pieces_that_cross():
    # Two rings that meet twice: one meeting alone leaves no plane map, both together do.
    west = [(2, 5), (-2, 5), (-2, -1), (2, -1)]
    true = PlaneMap.from_geometry(
        [(0, 0), (4, 0), (4, 4), (0, 4), (2, -1), (2, 0), (2, 4), (2, 5), (2, 2)],
        [(0, 5), (5, 1), (1, 2), (2, 6), (6, 3), (3, 0), (4, 5), (5, 8), (8, 6), (6, 7), (7, 4)],
        [None] * 10 + [west],
    )
    ring = [place("a", 0, 90), leg(0), place("m", 0, 90, 180, 270), leg(0), place("b", 90, 180), leg(90)]
    ring += [place("c", 180, 270), leg(180), place("n", 0, 90, 180, 270), leg(180), place("d", 0, 270), leg(270)]
    ring += [place("a", 0, 90)]
    across = [place("S", 90, 180), leg(90), place("M", 0, 90, 180, 270), leg(90), place("X", 90, 270), leg(90)]
    across += [place("N", 0, 90, 180, 270), leg(90), place("T", 180, 270), leg(180, 270, 360), place("S", 90, 180)]
    first, second = Walk(WalkHeader(), tuple(ring)), Walk(WalkHeader(), tuple(across))
    with pytest.raises(NotPlane):
        merge(first, second, at=("m", "M"))
    (one,) = overlaps(first, second, at=("m", "M"), least=1)
    assert one.shared == (("m", "M"), ("n", "N"))
    assert (one.plane.n_vertices, one.plane.n_edges, one.plane.n_faces) == (9, 11, 4)
    assert nx.is_isomorphic(one.plane.to_networkx(), true.to_networkx())
    assert one.shared in [other.shared for other in overlaps(first, second, least=1)]


# -- without a compass ----------------------------------------------------------------------------------------------------


def test_without_a_compass_a_shared_way_says_how_the_maps_lie():
    # Headings of the second robot are all turned by 90 degrees: without a compass it cannot know.
    world = grid(3, 3, missing=[(0, 1)])
    walk = explore(world, seed=2, tour="covering").walk
    n = len(walk.places) - 1
    header = WalkHeader(compass=False)
    first = Walk(header, cut(walk, 0, 2 * n // 3).events)
    turned = tuple(
        Visit(f"w{e.place}", tuple(Heading(h.yaw + np.pi / 2) for h in e.exits))
        if isinstance(e, Visit)
        else Samples(tuple(y + np.pi / 2 for y in e.yaw))
        for e in cut(walk, n // 3, n).events
    )
    second = Walk(header, turned)
    a, b = walk.places[n // 2], walk.places[n // 2 + 1]
    whole = merge(first, second, way=((a, b), (f"w{a}", f"w{b}")))
    assert all(f"w{p}" == q for p, q in whole.shared)
    with pytest.raises(MapsDisagree):
        merge(cut(walk, 0, 2 * n // 3), Walk(WalkHeader(), turned), at=(a, f"w{a}"))
    assert whole.plane.n_edges >= len(whole.shared)


def test_without_a_compass_a_place_that_looks_alike_after_a_turn_is_not_guessed():
    header = WalkHeader(compass=False)
    cross = Walk(header, (place("a", 0, 90, 180, 270), leg(0), place("b", 180)))
    with pytest.raises(BadInput, match="the shared place can be turned in 4 ways; say with way="):
        merge(cross, cross, at=("a", "a"))
    assert merge(cross, cross, way=(("a", "b"), ("a", "b"))).known.n_open == 3
    found = overlaps(cross, cross, least=1)
    assert {len(one.shared) for one in found} >= {1, 2}


@pytest.mark.parametrize("seed", range(4))
def test_two_walks_without_names_are_explained_like_one(seed):
    walk = explore(grid(3, 2), seed=seed, tour="covering", places=False).walk
    n = len(walk.places) - 1
    whole = hypotheses(walk)
    for middle in (n // 3, n // 2):
        both = joined(cut(walk, 0, middle), cut(walk, middle, n), at=(middle, 0))
        found = hypotheses(both)
        assert (found.count, found.exact) == (whole.count, whole.exact)
        assert both.n_legs == n
    # a second walk that was in the shared place half-way through
    both = joined(cut(walk, 0, n // 2), cut(walk, n // 4, n), at=(n // 2, n // 2 - n // 4))
    (one,) = hypotheses(both, closed=True)
    (true,) = hypotheses(walk, closed=True)
    assert one.n_places == true.n_places == 6
    assert nx.is_isomorphic(one.plane.to_networkx(), true.plane.to_networkx())


def test_walks_that_cannot_be_joined():
    walk = explore(grid(2, 2)).walk
    with pytest.raises(BadInput, match="visits of the second walk are numbered 0 to 4; there is no 5"):
        joined(walk, walk, at=(0, 5))
    with pytest.raises(BadInput, match="'v00' and 'v10' are two names, so not one place"):
        joined(walk, walk, at=(0, 1))
    with pytest.raises(BadInput, match="the second walk has no compass"):
        joined(walk, Walk(WalkHeader(compass=False), walk.events), at=(0, 0))
    with pytest.raises(BadInput, match="the first is a Walk"):
        joined("walk.jsonl", walk, at=(0, 0))


def test_a_hypothesis_can_be_merged():
    walk = explore(grid(2, 2), places=False).walk
    (closed,) = hypotheses(walk, closed=True)
    whole = merge(closed, explore(grid(2, 2)).walk, at=("p0", "v00"))
    assert (whole.plane.n_vertices, len(whole.shared), whole.ways) == (4, 4, 4)
