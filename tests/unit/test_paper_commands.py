"""Every statement of the paper (Corcoran and Bertolotto) that a user can check, asked from the command line.

Figure 2: one graph in the plane in two ways that are not equivalent. Figures 5 and 6: the three relations of a point to a
region, the eight of two regions. Figure 8: what contains what. Figure 9: the exploration, a step at a time.
"""

import json
import math
from itertools import product

import pytest

from ninefold import cli
from ninefold.io import Atlas, samples


@pytest.fixture
def ask(capsys, tmp_path, monkeypatch):
    """Run a command with --json in a folder of its own; return exit code and object."""
    monkeypatch.chdir(tmp_path)

    def runner(*arguments):
        code = cli.run([*map(str, arguments), "--json"])
        return code, json.loads(capsys.readouterr().out)

    return runner


def geojson(name, **lines):
    features = [
        {"type": "Feature", "id": edge, "geometry": {"type": "LineString", "coordinates": at}, "properties": {}}
        for edge, at in lines.items()
    ]
    with open(name, "w") as file:  # noqa: PTH123
        json.dump({"type": "FeatureCollection", "ninefold": {"units": "m"}, "features": features}, file)
    return name


@pytest.fixture
def figure8(ask):
    """The atlas of figure 8, from a walk that visits every place and walks every way."""
    code, walk = ask("explore", "sample:figure8", "-o", "figure8.jsonl")
    assert (code, walk["vertices"], walk["unreached"], walk["crossings"]) == (0, 9, [], 0)
    code, found = ask("map", "figure8.jsonl", "-o", "figure8.atlas")
    assert (code, found["vertices"], found["edges"], found["faces"], found["warnings"]) == (0, 9, 13, 6, [])
    return "figure8.atlas"


@pytest.mark.parametrize(
    ("x", "y", "name", "rcc8"),
    [
        ("cycle:v0,v1,v8,v7", "cycle:v2,v3,v6,v5,v4", "contains", "NTPPi"),
        ("cycle:v2,v3,v6,v5,v4", "cycle:v0,v1,v8,v7", "inside", "NTPP"),
        ("cycle:v0,v1,v3,v2", "cycle:v4,v5,v6,v8,v7", "disjoint", "DC"),
        ("cycle:v0,v1,v8,v7", "vertex:v3", "contains", None),
        ("vertex:v3", "cycle:v0,v1,v8,v7", "inside", None),
    ],
)
def test_figure_8_says_what_contains_what(ask, figure8, x, y, name, rcc8):
    code, found = ask("relate", figure8, x, y)
    assert (code, found["name"], found["rcc8"]) == (0, name, rcc8)
    listed = [json.dumps([form, *names.split(",")]) for form, _, names in (text.partition(":") for text in (x, y))]
    code, again = ask("relate", figure8, *listed)
    assert (code, again["de9im"], again["matrix"]) == (0, found["de9im"], found["matrix"])


def test_figure_8_has_the_right_rotation_and_outer_face(ask, figure8):
    code, found = ask("info", figure8)
    assert (code, found["checks"]["euler"], found["checks"]["turning"]) == (0, True, True)
    streets = samples.load("figure8").to_map()
    with Atlas.open(figure8, writable=False) as atlas:
        walked = atlas.plane

    def around(plane):
        """The neighbours of every place, counter-clockwise from the first by name."""
        rings = {}
        for v, name in enumerate(plane.vertex_names):
            ring = [plane.vertex_names[int(plane.tail[d ^ 1])] for d in plane.darts_at(v)]
            start = ring.index(min(ring))
            rings[name] = ring[start:] + ring[:start]
        return rings

    def outer(plane):
        return {plane.vertex_names[int(plane.tail[d])] for d in plane.face_darts(plane.outer_face)}

    assert around(walked) == around(streets)
    assert outer(walked) == outer(streets) == {"v0", "v1", "v8", "v7"}
    code, checked = ask("verify", figure8, "--pairs", 200)
    assert (code, checked["agree"]) == (0, True)


def test_figure_9_step_by_step(ask):
    source = samples.load("figure8")
    at = dict(zip(source.vertex_names, source.points.tolist(), strict=True))
    lines = ['{"ninefold": "walk", "version": 1, "heading": "yaw-rad"}', '{"place": "v6"}']
    seen = []
    for step, (u, v) in enumerate([("v6", "v8"), ("v8", "v1"), ("v1", "v3"), ("v3", "v6")]):
        yaw = math.atan2(at[v][1] - at[u][1], at[v][0] - at[u][0])
        lines += [json.dumps({"headings": [yaw, yaw]}), json.dumps({"place": v})]
        with open("walk.jsonl", "w") as file:  # noqa: PTH123
            file.write("\n".join(lines))
        code, found = ask("map", "walk.jsonl", "-o", f"step{step}.atlas")
        assert code == 0
        seen.append((found["vertices"], found["edges"], found["faces"]))
    # a new vertex and edge, twice more the same, and then a loop closure: an edge and no vertex
    assert seen == [(2, 1, 1), (3, 2, 1), (4, 3, 1), (4, 4, 2)]
    code, found = ask("info", "step3.atlas")
    assert set(found["outer_edges"]) == {"e0", "e1", "e2", "e3"}


def test_figure_2_one_graph_two_inequivalent_embeddings(ask):
    tail = {"t1": [[0, 0], [-2, 0]], "t2": [[-2, 0], [-4, 0]]}
    inside = {"t1": [[0, 0], [2, 0]], "t2": [[2, 0], [3, 0]]}
    bent = {"t1": [[0, 0], [0, -1], [-3, -1]], "t2": [[-3, -1], [-3, 5]]}
    small = {"loop": [[0, 0], [2, -1], [4, 0], [2, 1], [0, 0]]}
    embeddings = {"a": tail | small, "b": inside | {"loop": [[0, 0], [9, -9], [9, 9], [0, 0]]}, "c": bent | small}
    outer, far, maps = {}, {}, {}
    for name, lines in embeddings.items():
        code, found = ask("map", geojson(f"{name}.geojson", **lines), "-o", f"{name}.atlas")
        assert (code, found["vertices"], found["edges"], found["faces"]) == (0, 3, 3, 2)
        outer[name] = set(ask("info", f"{name}.atlas")[1]["outer_edges"])
        far[name] = ask("relate", f"{name}.atlas", "edge:@t2", "cycle:@loop")[1]["name"]
        with Atlas.open(f"{name}.atlas") as atlas:
            plane = maps[name] = atlas.plane
        degrees = sorted(len(list(plane.face_darts(face))) for face in range(plane.n_faces))
        assert degrees == [1, 5]
    assert outer == {"a": {"t1", "t2", "loop"}, "b": {"loop"}, "c": {"t1", "t2", "loop"}}
    assert far == {"a": "disjoint", "b": "inside", "c": "disjoint"}

    def equivalent(p, q):
        return (p.next_ccw.tolist(), p.face_of.tolist(), p.outer_face) == (
            q.next_ccw.tolist(),
            q.face_of.tolist(),
            q.outer_face,
        )

    assert equivalent(maps["a"], maps["c"])
    assert not equivalent(maps["a"], maps["b"])


@pytest.fixture
def grid(ask):
    """The atlas of three by three square rooms, corners named by column and row."""
    lines = {}
    for x, y in product(range(4), range(4)):
        if x < 3:
            lines[f"h{x}{y}"] = [[x, y], [x + 1, y]]
        if y < 3:
            lines[f"v{x}{y}"] = [[x, y], [x, y + 1]]
    assert ask("map", geojson("grid.geojson", **lines), "-o", "grid.atlas")[0] == 0
    return "grid.atlas"


def rectangle(x0, y0, x1, y1):
    """A rectangle by its edges."""
    edges = [f"@h{x}{y}" for x in range(x0, x1) for y in (y0, y1)] + [f"@v{x}{y}" for x in (x0, x1) for y in range(y0, y1)]
    return f"cycle:{','.join(edges)}"


def test_two_regions_have_eight_relations(ask, grid):
    rooms = {
        "all": (0, 0, 3, 3),
        "centre": (1, 1, 2, 2),
        "middle": (1, 1, 2, 2),
        "corner": (0, 0, 1, 1),
        "far corner": (2, 2, 3, 3),
        "four": (0, 0, 2, 2),
        "other four": (1, 1, 3, 3),
    }
    for name, corners in rooms.items():
        assert ask("name", grid, name, rectangle(*corners))[0] == 0
    found = {(x, y): ask("relate", grid, x, y)[1] for x, y in product(rooms, rooms)}
    assert {relation["name"] for relation in found.values()} == {
        *("disjoint", "contains", "inside", "equal", "meet", "covers", "coveredBy", "overlap")
    }
    assert len({relation["de9im"] for relation in found.values() if relation["name"] != "meet"}) == 7
    assert {relation["rcc8"] for relation in found.values()} == {"DC", "EC", "PO", "EQ", "TPP", "TPPi", "NTPP", "NTPPi"}
    assert found["all", "centre"]["name"] == "contains"
    assert found["centre", "middle"]["name"] == "equal"
    assert found["corner", "far corner"]["name"] == "disjoint"
    code, table = ask("relate", grid, "--all", "-o", "rooms.csv")
    assert (code, table["sets"], table["pairs"]) == (0, 7, 21)


def test_a_point_and_a_region_have_three_relations(ask, grid):
    with Atlas.open(grid, writable=False) as atlas:
        places = atlas.plane.vertex_names
    found = [ask("relate", grid, f"vertex:{place}", rectangle(0, 0, 2, 2))[1] for place in places]
    assert {(relation["name"], relation["rcc8"]) for relation in found} == {
        ("inside", None),
        ("meet", None),
        ("disjoint", None),
    }
    assert [relation["name"] for relation in found].count("inside") == 1
    back = {ask("relate", grid, rectangle(0, 0, 2, 2), f"vertex:{place}")[1]["name"] for place in places}
    assert back == {"contains", "meet", "disjoint"}


def test_is_the_room_inside_the_building(ask, figure8):
    """The question the paper starts from, with the words of its answer."""
    assert ask("name", figure8, "building", "cycle:v0,v1,v8,v7")[0] == 0
    assert ask("name", figure8, "room", "cycle:v2,v3,v6,v5,v4")[0] == 0
    assert ask("relate", figure8, "room", "building")[1]["name"] == "inside"
