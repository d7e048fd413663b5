"""Naming sets, region algebra, splitting, and their errors."""

import numpy as np
import pytest

from ninefold.errors import AmbiguousDart, BadInput, DifferentMaps, EmptySet, NotACycle, UnknownName
from ninefold.mapping import Line, PlaneMap, Point, Region
from ninefold.reasoner import containment_tree, de9im_strings, names_of, relate, relate_all, relate_pairs


@pytest.fixture
def plane():
    """Three blocks in a row, a dead end, and a loop in the last block."""
    points = [(0, 0), (1, 0), (2, 0), (3, 0), (3, 1), (2, 1), (1, 1), (0, 1), (-1, -1)]
    edges = [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 6), (6, 7), (7, 0), (1, 6), (2, 5), (0, 8), (3, 3)]
    paths = [None] * 11 + [[(3, 0), (2.5, 0.2), (2.6, 0.5), (3, 0)]]
    return PlaneMap.from_geometry(points, edges, paths, edge_names=[f"e{k}" for k in range(12)])


def test_text_forms(plane):
    assert plane.parse("vertex:3") == Point(plane, 3)
    assert plane.parse("edge:1,6") == plane.parse("edge:@e8") == Line(plane, (8,))
    assert plane.parse("path:0,1,@e8,6") == Line(plane, (0, 8))
    assert plane.parse("path:@e0,@e8").darts == (0, 16)
    assert plane.parse("line:@e1,@e5") == Line(plane, (1, 5))
    cycle = plane.parse("cycle:0,1,6,7")
    assert cycle == plane.parse("cycle:7,6,1,0") == plane.parse("cycle:@e0,@e8,@e6,@e7")
    assert cycle == plane.parse(cycle.text)
    assert plane.parse("cycle:3") == plane.cycle(edges=["e11"])
    for x in (plane.vertex(3), plane.edge("e8"), plane.path([0, 1, 2])):
        assert plane.parse(x.text) == x


@pytest.mark.parametrize(
    ("text", "error", "match"),
    [
        ("cycle:0,1,2", UnknownName, "no edge"),
        ("cycle:0,1,6,7,0,1", NotACycle, "twice"),
        ("cycle:@e0,@e1", NotACycle, "1 of them meet at '0'"),
        ("cycle:@e0,@e8,@e6,@e7,@e11", NotACycle, "several cycles"),
        ("cycle:8,0", NotACycle, "twice"),
        ("path:0", EmptySet, "at least one edge"),
        ("path:0,1,0", NotACycle, "used twice"),
        ("path:@e0,@e5", NotACycle, "does not leave"),
        ("vertex:33", UnknownName, "did you mean '3'"),
        ("vertex:0,1", BadInput, "one name"),
        ("edge:@e99", UnknownName, "did you mean"),
        ("face:x", BadInput, "no face number"),
        ("faces:0,99", BadInput, "numbered from 0"),
        ("blob:3", BadInput, "write one of vertex"),
        ("vertex:", BadInput, "empty name"),
        ("kitchen", BadInput, "is no set"),
    ],
)
def test_bad_text(plane, text, error, match):
    with pytest.raises(error, match=match):
        plane.parse(text)


def test_outer_face_is_no_region(plane):
    with pytest.raises(BadInput, match="outer face"):
        plane.face(plane.outer_face)
    with pytest.raises(EmptySet):
        plane.region([])
    with pytest.raises(BadInput, match="list of names"):
        plane.cycle("0167")


def test_parallel_edges_must_be_told_apart():
    two = PlaneMap.from_rotation({"a": [("b", "x"), ("b", "y")], "b": [("a", "y"), ("a", "x")]}, outer=("a", "b", "x"))
    with pytest.raises(AmbiguousDart, match="say which"):
        two.path(["a", "b"])


def test_region_algebra(plane):
    left, middle, right = plane.cycle([0, 1, 6, 7]), plane.cycle([1, 2, 5, 6]), plane.cycle([2, 3, 4, 5])
    row = left | middle | right
    assert row == plane.cycle([0, 1, 2, 3, 4, 5, 6, 7])
    assert row - middle == left | right
    assert (left | middle) & (middle | right) == middle
    assert len((left | right).rims) == 2
    hole = right - plane.cycle(["3"])
    assert len(hole.rims) == 1  # the loop hangs on the boundary: two cycles that touch at a vertex
    with pytest.raises(EmptySet, match="intersection"):
        left & right
    with pytest.raises(EmptySet, match="difference"):
        left - row
    assert repr(left) == "Region(1 face, boundary @e0 @e6 @e7 @e8)"
    assert len({left, plane.cycle([7, 6, 1, 0])}) == 1


def test_left_and_right_of_a_path(plane):
    row = plane.cycle([0, 1, 2, 3, 4, 5, 6, 7])
    up = plane.path([1, 6])
    assert row.left_of(up) == plane.cycle([0, 1, 6, 7])
    assert row.right_of(up) == plane.cycle([1, 2, 3, 4, 5, 6])
    assert row.left_of(plane.path([6, 1])) == row.right_of(up)
    with pytest.raises(BadInput, match="does not split"):
        row.left_of(plane.path([0, 1]))
    with pytest.raises(BadInput, match="no direction"):
        row.left_of(plane.line(["e8"]))


def test_sets_of_two_maps_do_not_mix(plane):
    other = PlaneMap.from_rotation({"a": ["b"], "b": ["a"]})
    for question in (
        lambda: relate(plane.vertex(0), other.vertex("a")),
        lambda: relate_pairs([plane.vertex(0), other.vertex("a")], [(0, 1)]),
        lambda: relate_all([plane.vertex(0), other.vertex("a")]),
        lambda: plane.edge("e0") | other.edge("0"),
    ):
        with pytest.raises(DifferentMaps, match="two different maps"):
            question()


def test_pairs_must_be_rows(plane):
    sets = [plane.vertex(0), plane.vertex(1)]
    assert relate_pairs(sets, []).size == 0
    with pytest.raises(BadInput, match="rows of sets"):
        relate_pairs(sets, [(0, 2)])
    with pytest.raises(BadInput, match="shape"):
        relate_pairs(sets, [0, 1])
    with pytest.raises(EmptySet):
        relate_all([])


def test_containment_tree(plane):
    left, middle, right = plane.cycle([0, 1, 6, 7]), plane.cycle([1, 2, 5, 6]), plane.cycle([2, 3, 4, 5])
    tree = containment_tree(
        {"row": left | middle | right, "west": left | middle, "left": left, "loop": plane.cycle(["3"]), "also left": left}
    )
    assert set(tree.edges) == {("row", "west"), ("west", "left"), ("row", "loop")}
    assert tree.nodes["left"]["members"] == ("left", "also left")
    assert containment_tree([left, right]).number_of_edges() == 0
    with pytest.raises(BadInput, match="takes regions"):
        containment_tree({"gate": plane.vertex(0)})


def test_a_set_survives_its_text_and_the_map_its_hash(plane):
    region = plane.region([0])
    assert isinstance(region, Region)
    assert {region: 1}[plane.region([0])] == 1


def test_a_cycle_from_an_array(plane):
    assert plane.cycle(np.array([0, 1, 6, 7])) == plane.cycle([0, 1, 6, 7])


@pytest.mark.parametrize("face", [-1, 2**70, -(2**70)])
def test_a_face_number_out_of_range_is_named(plane, face):
    with pytest.raises(BadInput, match=f"got {face}"):
        plane.region([0, face])


def test_questions_about_no_sets_and_no_codes(plane):
    for x, y in (("kitchen", plane.vertex(0)), (plane.vertex(0), "kitchen")):
        with pytest.raises(BadInput, match="not 'kitchen'"):
            relate(x, y)
    with pytest.raises(BadInput, match="differ in length"):
        relate_pairs([plane.vertex(0)], [[0], [0, 0]])
    with pytest.raises(BadInput, match="found -1"):
        relate_pairs([plane.vertex(0)], [(0, -1)])
    for codes in ([-1], [1 << 14], ["meet"], [0.5]):
        for words in (de9im_strings, names_of):
            with pytest.raises(BadInput, match="0 to 16383"):
                words(codes)


@pytest.mark.parametrize("vertices", ["abc", "bac"])
def test_a_path_may_begin_with_two_parallel_edges(vertices):
    """The first edge is left at the end from which the whole list follows, not only its second step."""
    rotation = {"a": [("b", "x"), ("b", "y"), ("c", "z")], "b": [("a", "y"), ("a", "x")], "c": [("a", "z")]}
    plane = PlaneMap.from_rotation({v: rotation[v] for v in vertices}, outer=("a", "b", "x"))
    for first, second in (("x", "y"), ("y", "x")):
        path = plane.path([f"@{first}", f"@{second}", "c"])
        assert path.edge_names == (first, second, "z")
        assert path == plane.path(["a", f"@{first}", f"@{second}", "@z"])
    with pytest.raises(NotACycle, match="used twice"):
        plane.path(["@x", "@y", "@x", "c"])
