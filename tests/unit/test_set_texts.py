"""Sets as text: what the command line takes, `PlaneMap.parse` takes; any name can be written; what fails says how."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

import ninefold as nf
from ninefold.errors import AmbiguousDart, BadInput, NotACycle, UnknownName
from ninefold.mapping import PlaneMap

SQUARE = [(0, 0), (4, 0), (4, 4), (0, 4)]
RING = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)]


def square(places=("v0", "v1", "v2", "v3"), edges=("a", "b", "c", "d", "e")):
    return PlaneMap.from_geometry(SQUARE, RING, vertex_names=places, edge_names=edges)


@pytest.mark.parametrize(
    ("text", "listed"),
    [
        ("vertex:v3", ["vertex", "v3"]),
        ("edge:v0,v1", ["edge", "v0", "v1"]),
        ("edge:@e", ["edge", "@e"]),
        ("path:v0,v1,v2", ["path", "v0", "v1", "v2"]),
        ("path:v0,@a,v1", ["path", {"vertex": "v0"}, {"edge": "a"}, "v1"]),
        ("line:@a,@c", ["line", "@a", {"edge": "c"}]),
        ("cycle:v0,v1,v2", ["Cycle", "v0", "v1", "v2"]),
        ("cycle:@a,@b,@e", ["cycle", {"edge": "a"}, "@b", "@e"]),
        ("face:1", ["face", 1]),
        ("faces:1,2", ["faces", 1, "2"]),
    ],
)
def test_both_forms_mean_the_same_set(text, listed):
    plane = square()
    faces = [face for face in range(plane.n_faces) if face != plane.outer_face]
    text = (
        text.replace("1,2", f"{faces[0]},{faces[1]}")
        if text.startswith("faces")
        else text.replace("face:1", f"face:{faces[0]}")
    )
    listed = [listed[0], *faces[: len(listed) - 1]] if listed[0].startswith("face") else listed
    assert plane.parse(json.dumps(listed)) == plane.parse(f"  {json.dumps(listed)}") == plane.parse(text)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("[", "is no JSON list"),
        ('["cycle"]', "a set as a JSON list is one of vertex, edge"),
        ('["sphere", "v0"]', "a set as a JSON list is one of vertex, edge"),
        ('[["cycle"], "v0"]', "a set as a JSON list is one of vertex, edge"),
        ('["vertex", true]', "the names in a JSON list are strings, not True"),
        ('["vertex", ["v0"]]', "the names in a JSON list are strings"),
        ('["vertex", {"place": "v0"}]', 'a step is a name, {"vertex": name} or {"edge": name}'),
        ('["vertex", {"edge": "a"}]', "the edge 'a' stands where a place is needed"),
        ('["line", {"vertex": "v0"}]', "the place 'v0' stands where an edge is needed"),
        ('["vertex", {}]', "a step is a name"),
        ('["face", "x"]', "'x' is no face number"),
        ("sphere:1", 'or a JSON list such as ["cycle", "a, north", "b", "c"]'),
        ("[" * 100_000, "is no JSON list"),
    ],
)
def test_what_is_no_set_says_so_in_a_short_line(text, said):
    with pytest.raises(BadInput) as caught:
        square().parse(text)
    assert said in str(caught.value)
    assert len(str(caught.value)) < 300


def test_a_place_with_an_at_sign_is_a_step():
    plane = square(places=("@home", "v1", "v2", "v3"))
    region = plane.parse("cycle:@home,v1,v2")
    assert region == plane.cycle(["@home", "v1", "v2"]) == plane.parse('["cycle", "@home", "v1", "v2"]')
    assert region == plane.cycle(edges=["a", "b", "e"])
    assert plane.parse("path:v1,@home,v3").edge_names == ("a", "d")
    assert plane.parse("edge:@home,v1").edge_names == ("a",)
    assert plane.vertex("@home") == plane.parse(plane.vertex("@home").text)
    every = square(places=("@0", "@1", "@2", "@3"))
    assert every.parse("cycle:@0,@1,@2") == every.cycle(edges=["a", "b", "e"])


def test_a_name_of_both_an_edge_and_a_place_is_never_guessed(tmp_path):
    plane = square(places=("@home", "v1", "v2", "v3"), edges=("home", "b", "c", "d", "e"))
    for ask in (lambda: plane.parse("cycle:@home,v1,v2"), lambda: plane.path(["v1", "@home"])):
        with pytest.raises(AmbiguousDart, match=r'is an edge and also the name of a place; .*\{"vertex": .@home.\}'):
            ask()
    region = plane.parse('["cycle", {"vertex": "@home"}, "v1", "v2"]')
    assert region == plane.parse('["cycle", {"edge": "home"}, "v2"]') == plane.cycle(edges=["home", "b", "e"])
    with nf.Atlas.from_map(plane, tmp_path / "home.atlas") as atlas:
        way = atlas.name("way", '["path", {"vertex": "@home"}, "v1", "v2"]')
        atlas.name("room", region)
    with nf.Atlas.open(tmp_path / "home.atlas") as atlas:
        assert atlas.sets == {"room": region, "way": way}


def test_an_edge_with_an_at_sign_of_its_own(tmp_path):
    plane = square(edges=("@a", "a", "c", "d", "e"))
    assert plane.edge("@@a").edges == plane.parse('["edge", {"edge": "@a"}]').edges == (0,)
    assert plane.edge("@a").edges == plane.edge("a").edges == (1,)
    alone = square(edges=("@a", "b", "c", "d", "e"))
    assert alone.edge("@a") == alone.edge("@@a") == alone.parse("line:@@a")
    assert alone.parse(alone.edge("@a").text) == alone.edge("@a")
    with nf.Atlas.from_map(plane, tmp_path / "at.atlas") as atlas:
        atlas.name_all({"first": plane.edge("@@a"), "room": plane.cycle(["v0", "v1", "v2"])})
        assert atlas.sets == {"first": plane.edge("@@a"), "room": plane.cycle(["v0", "v1", "v2"])}


def test_where_a_cycle_does_not_close():
    with pytest.raises(UnknownName, match=r"^the cycle closes from 'v3' to 'v1', and no edge joins them$"):
        square().parse("cycle:v1,v2,v3")
    with pytest.raises(UnknownName, match=r"^no edge joins 'v1' and 'v3'$"):
        square().parse("cycle:v0,v1,v3")
    with pytest.raises(NotACycle, match="edge 'c' does not leave 'v1'"):
        square().parse("path:v0,v1,@c")


def test_names_with_commas_are_told_to_go_in_a_list():
    plane = square(places=("a, north", "b", "c", "d"))
    with pytest.raises(UnknownName) as caught:
        plane.parse("cycle:a, north,b,c")
    assert str(caught.value) == (
        "there is no vertex named 'a'; as 'a, north' has a comma, write a JSON list: [\"cycle\", \"a, north\", ...]"
    )
    assert plane.parse('["cycle", "a, north", "b", "c"]').n_faces == 1


names = st.text(st.characters(min_codepoint=32, exclude_categories=["Cs"]), min_size=1, max_size=6)


@given(st.lists(names, min_size=4, max_size=4, unique=True), st.lists(names, min_size=5, max_size=5, unique=True))
def test_every_text_is_read_back(places, edges):
    plane = square(tuple(places), tuple(edges))
    for item in (plane.vertex(places[0]), plane.edge(places[1], places[2]), plane.line([f"@{edges[2]}", f"@{edges[4]}"])):
        assert plane.parse(item.text) == item
