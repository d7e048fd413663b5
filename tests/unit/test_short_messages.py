"""However long what was given, the message about it is one short line."""

import json

import pytest

import ninefold as nf
from ninefold.cli import run
from ninefold.encodings import RCC8, Calculus, calculus_named
from ninefold.errors import NinefoldError, UnknownName
from ninefold.io import samples
from ninefold.io.sources.geojson import parse_geojson
from ninefold.mapping import Mapper, PlaneMap, Samples, Visit, WalkHeader
from ninefold.reasoner import Network, Relation, Statement, ask, check, entails, infer

LONG = "x" * 10_035
LONGEST = 500
PLANE = samples.load("figure8").to_map()
NET = Network("rcc8")
NET.add("a", "b", "EC")


def written(tmp_path, name, text):
    path = tmp_path / name
    path.write_text(text)
    return path


def walk_of(*lines):
    header = '{"ninefold": "walk", "version": 1, "heading": "yaw-rad"}'
    return "\n".join([header, *lines])


CALLS = {
    "vertex": lambda _: PLANE.vertex(LONG),
    "edge": lambda _: PLANE.edge(LONG),
    "edge by ends": lambda _: PLANE.edge("v0", LONG),
    "path": lambda _: PLANE.path(["v0", LONG]),
    "path as text": lambda _: PLANE.path(LONG),
    "cycle": lambda _: PLANE.cycle(["v0", f"@{LONG}"]),
    "line": lambda _: PLANE.line([LONG]),
    "parse": lambda _: PLANE.parse(LONG),
    "parse a form": lambda _: PLANE.parse(f"cycle:{LONG}"),
    "parse empty names": lambda _: PLANE.parse("cycle:v0," + "," * 10_000),
    "parse a face": lambda _: PLANE.parse(f"face:{LONG}"),
    "parse a list": lambda _: PLANE.parse(json.dumps(["cycle", LONG])),
    "parse no list": lambda _: PLANE.parse("[" + LONG),
    "parse a wrong list": lambda _: PLANE.parse(json.dumps([LONG, "v0"])),
    "parse a wrong object": lambda _: PLANE.parse(json.dumps(["vertex", {LONG: "v0"}])),
    "rotation": lambda _: PlaneMap.from_rotation({"a": [LONG]}, outer=("a", LONG)),
    "rotation text": lambda _: PlaneMap.from_rotation({LONG: LONG}, outer=("a", "b")),
    "outer": lambda _: PlaneMap.from_rotation({"a": ["b"], "b": ["a"]}, outer=("a", LONG)),
    "names": lambda _: PlaneMap.from_geometry([(0, 0), (1, 0)], [(0, 1)], vertex_names=[LONG, LONG]),
    "name of control characters": lambda _: Mapper().step(Visit(LONG + "\n")),
    "no length": lambda _: PlaneMap.from_geometry([(0, 0), (0, 0)], [(0, 1)], edge_names=[LONG]),
    "visit": lambda _: Visit([LONG]),
    "exits": lambda _: Visit("a", [LONG]),
    "event": lambda _: Mapper().step(LONG),
    "header": lambda _: WalkHeader(LONG),
    "tolerance": lambda _: Mapper(tolerance=LONG),
    "layout": lambda _: nf.draw(PLANE, layout=LONG),
    "theme": lambda _: nf.draw(PLANE).to_svg(theme=LONG),
    "highlight": lambda _: nf.draw(PLANE).to_svg(highlight={"x": LONG}),
    "relate": lambda _: nf.relate(LONG, PLANE.vertex("v0")),
    "relation": lambda _: Relation.from_de9im(LONG),
    "calculus": lambda _: calculus_named(LONG),
    "calculus of a file": lambda _: Calculus.from_file(LONG[:200] + ".spec"),
    "relations": lambda _: RCC8.relation(LONG),
    "relations of many": lambda _: RCC8.relation([LONG, "EC"]),
    "relations of no kind": lambda _: RCC8.relation({"x": LONG}.values),
    "network": lambda _: Network(LONG),
    "network of no kind": lambda _: Network([LONG]),
    "add": lambda _: Network("rcc8").add("a", "b", LONG),
    "add itself": lambda _: Network("rcc8").add(LONG, LONG, "DC"),
    "add a label": lambda _: Network("rcc8").add("a", "b", "DC", [LONG]),
    "add a weight": lambda _: Network("rcc8").add("a", "b", "DC", None, LONG),
    "add an entity": lambda _: Network("rcc8").add([LONG], "b", "DC"),
    "statement": lambda _: Statement("a", (LONG + " b",), "b"),
    "statement text": lambda _: Statement("a", LONG, "b"),
    "statement name": lambda _: Statement([LONG], ("DC",), "b"),
    "infer": lambda _: infer(NET, "a", LONG),
    "entails": lambda _: entails(NET, "a", LONG, "EC"),
    "ask": lambda _: ask(NET, LONG),
    "ask a relation": lambda _: ask(NET, f"{LONG}(a, b)"),
    "ask an entity": lambda _: ask(NET, f"EC(a, {LONG})"),
    "ask a string": lambda _: ask(NET, f'EC(a, "{LONG}")'),
    "ask nonsense": lambda _: ask(NET, "(" * 3_000),
    "ask nothing": lambda _: ask(NET, [LONG]),
    "method": lambda _: check(NET, method=LONG),
    "sample": lambda _: samples.load(LONG),
    "geojson": lambda _: parse_geojson(json.dumps({"type": LONG})),
    "geojson units": lambda _: parse_geojson(
        json.dumps({"type": "LineString", "coordinates": [[0, 0], [1, 1]], "ninefold": {"units": LONG}})
    ),
    "map of no file": lambda _: nf.read_map(LONG),
    "walk of no file": lambda _: nf.read_walk(LONG),
    "network of no file": lambda _: nf.read_network(LONG),
    "atlas of no file": lambda _: nf.Atlas.open(LONG),
    "atlas of no kind": lambda _: nf.Atlas(LONG),
    "drawing to no folder": lambda _: nf.draw(PLANE).save(f"{LONG}/map.svg"),
    "drawing to a long name": lambda _: nf.draw(PLANE).save(LONG),
    "walk value": lambda p: nf.read_walk(written(p, "w.jsonl", walk_of(f'{{"place": ["{LONG}"]}}'))),
    "walk key": lambda p: nf.read_walk(written(p, "w.jsonl", walk_of(f'{{"{LONG}": 1}}'))),
    "walk heading": lambda p: nf.read_walk(written(p, "w.jsonl", walk_of('{"place": 1}', f'{{"heading": "{LONG}"}}'))),
    "walk header": lambda p: nf.read_walk(
        written(p, "w.jsonl", f'{{"ninefold": "walk", "version": 1, "heading": "{LONG}"}}')
    ),
    "walk version": lambda p: nf.read_walk(written(p, "w.jsonl", f'{{"ninefold": "walk", "version": "{LONG}"}}')),
    "walk places": lambda p: nf.read_map(
        written(
            p,
            "w.jsonl",
            walk_of(f'{{"place": "{LONG}"}}', '{"heading": 0}', '{"place": "%s", "exits": [1, 2]}' % (LONG + "y")),
        )
    ),
    "csp": lambda p: nf.read_network(written(p, "n.csp", f"1\n0 1 ( {LONG} )\n.\n")),
    "csp line": lambda p: nf.read_network(written(p, "n.csp", f"1\n{LONG}\n.\n")),
    "csp head": lambda p: nf.read_network(written(p, "n.csp", LONG)),
    "csp comment": lambda p: nf.read_network(written(p, "n.csp", f"1\n#@ {LONG}\n.\n")),
    "csv column": lambda p: nf.read_network(written(p, "n.csv", f"a,relations,{LONG}\n")),
    "csv relation": lambda p: nf.read_network(written(p, "n.csv", f"a,relations,b\nx,{LONG},y\n")),
    "csv weight": lambda p: nf.read_network(written(p, "n.csv", f"a,relations,b,weight\nx,DC,y,{LONG}\n")),
    "json key": lambda p: nf.read_network(written(p, "n.json", json.dumps({LONG: 1}))),
    "json calculus": lambda p: nf.read_network(written(p, "n.json", json.dumps({"calculus": LONG, "statements": []}))),
    "json calculus kind": lambda p: nf.read_network(
        written(p, "n.json", json.dumps({"calculus": [LONG], "statements": []}))
    ),
    "json statement": lambda p: nf.read_network(written(p, "n.json", json.dumps({"statements": [LONG]}))),
    "json relation": lambda p: nf.read_network(
        written(p, "n.json", json.dumps({"statements": [{"a": "x", "b": "y", "relations": [LONG]}]}))
    ),
    "json key twice": lambda p: nf.read_network(written(p, "n.json", f'{{"{LONG}": 1, "{LONG}": 2}}')),
    "spec line": lambda p: Calculus.from_file(written(p, "c.spec", LONG)),
    "spec name": lambda p: Calculus.from_file(written(p, "c.spec", f"name: {LONG}\nbase_relations: a a\n")),
    "network kind": lambda p: nf.read_network(written(p, "n.csv", "a,relations,b\n"), kind=LONG),
    "write kind": lambda p: nf.io.write_network(NET, p / f"net.{LONG[:200]}"),
}


@pytest.mark.parametrize("name", CALLS)
def test_a_message_is_short(tmp_path, name):
    with pytest.raises(NinefoldError) as caught:
        CALLS[name](tmp_path)
    message = str(caught.value)
    assert "\n" not in message
    assert len(message) - message.count(str(tmp_path)) * len(str(tmp_path)) <= LONGEST, message[:2000]


COMMANDS = [
    ["info", LONG],
    ["map", LONG, "-o", "x.atlas"],
    ["map", f"sample:{LONG}", "-o", "x.atlas"],
    ["explore", "sample:ring", "-o", "walk.jsonl", "--start", LONG],
    ["explore", "sample:ring", "-o", LONG],
    ["name", "figure8.atlas", LONG + ":", "vertex:v0"],
    ["name", "figure8.atlas", "n", LONG],
    ["relate", "figure8.atlas", LONG, "vertex:v0"],
    ["relate", "figure8.atlas", "cycle:v0,v1,v8,v7", f"vertex:{LONG}"],
    ["relate", "figure8.atlas", "--faces", "-o", f"table.{LONG[:200]}"],
    ["draw", "figure8.atlas", "-o", f"{LONG}.svg"],
    ["draw", "figure8.atlas", "-o", LONG],
    ["draw", "figure8.atlas", "-o", "x.svg", "--layout", LONG],
    ["draw", "figure8.atlas", "-o", "x.svg", "--theme", LONG],
    ["draw", "figure8.atlas", "-o", "x.svg", "--highlight", LONG],
    ["check", LONG],
    ["check", "net.csv", "--calculus", LONG],
    ["check", "net.csv", "--method", LONG],
    ["infer", "net.csv", "a", LONG],
    ["ask", "net.csv", LONG],
    ["compose", LONG, "EC"],
]


@pytest.mark.parametrize("arguments", COMMANDS, ids=lambda a: " ".join(part[:12] for part in a))
def test_the_command_line_is_short_too(tmp_path, monkeypatch, capsys, arguments):
    monkeypatch.chdir(tmp_path)
    nf.Atlas.from_map(PLANE, "figure8.atlas").close()
    nf.io.write_network(NET, "net.csv")
    assert run(arguments) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1
    assert len(err) <= LONGEST, err[:2000]


def test_near_names_are_still_suggested():
    with pytest.raises(UnknownName, match="there is no vertex named 'v33'; did you mean 'v3'"):
        PLANE.vertex("v33")
    assert str(UnknownName("set", "a" * 100)) == f"there is no set named '{'a' * 37} ... {'a' * 36}'"


def test_samples_of_no_kind():
    with pytest.raises(NinefoldError):
        Samples([LONG])
