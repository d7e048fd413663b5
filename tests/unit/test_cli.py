"""The command line: exit codes, JSON, one clear line for every failure, nothing changed by a refused command."""

from __future__ import annotations

import csv
import json
import os
import shutil
import signal
import subprocess
import sys
import time

import pytest

from ninefold import cli
from ninefold.cli import _demonstration as demo
from ninefold.cli import _output
from ninefold.errors import WalkError
from ninefold.io import Atlas, read_walk, samples, write_network, write_walk
from ninefold.mapping import Visit, Walk, WalkHeader, build, explore
from ninefold.reasoner import Network

MODULE = [sys.executable, "-c", "from ninefold.cli import main; main()"]


@pytest.fixture
def run(capsys):
    """Run a command; return exit code, stdout, stderr."""

    def runner(*arguments):
        code = cli.run([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        assert "Traceback" not in err
        return code, out, err

    return runner


@pytest.fixture
def run_json(run):
    """Run a command with --json; return exit code and the object."""

    def runner(*arguments):
        code, out, _ = run(*arguments, "--json")
        assert out.count("\n") == 1
        return code, json.loads(out)

    return runner


@pytest.fixture
def figure8(tmp_path):
    path = tmp_path / "figure8.atlas"
    Atlas.from_map(samples.load("figure8").to_map(), path).close()
    return path


def assert_refused(result, *words):
    code, out, err = result
    assert code == 2
    assert out == ""
    assert err.startswith("ninefold: ")
    assert err.count("\n") == 1
    for word in words:
        assert word in err


def test_help_lists_the_commands(run):
    code, out, err = run("--help")
    assert (code, err) == (0, "")
    for command in ("demo", "explore", "map", "info", "name", "relate"):
        assert f"  {command} " in out
        assert run(command, "--help")[0] == 0
    assert run()[0] == 2
    assert run("--version")[1].startswith("ninefold ")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["relat"], ["No such command 'relat'"]),
        (["info"], ["Missing argument 'ATLAS'", "ninefold info --help"]),
        (["info", "a", "b"], ["unexpected extra argument"]),
        (["map", "x", "--nonsense"], ["No such option"]),
        (["map", "sample:ring"], ["Missing option '--out'"]),
        (["explore", "sample:ring", "-o", "w", "--step", "wide"], ["--step"]),
    ],
)
def test_bad_usage_is_one_line_and_exit_2(run, arguments, words):
    assert_refused(run(*arguments), *words)


def test_bad_usage_under_json_has_an_error_object(run_json):
    code, found = run_json("info")
    assert code == 2
    assert list(found) == ["error"]


def test_from_a_sample_to_a_relation(tmp_path, run, run_json):
    walk, atlas = tmp_path / "walk.jsonl", tmp_path / "figure8.atlas"
    code, found = run_json("explore", "sample:figure8", "-o", walk, "--seed", 4)
    assert code == 0
    assert {"file", "start", "legs", "events", "metres", "crossings", "unreached", "warnings"} <= found.keys()
    assert (found["vertices"], found["crossings"], found["unreached"]) == (9, 0, [])
    assert read_walk(walk).n_legs == found["legs"]
    code, found = run_json("map", walk, "-o", atlas)
    assert code == 0
    assert {**found, "file": ""} == {
        "file": "", "vertices": 9, "edges": 13, "faces": 6, "components": 1, "warnings": [],
    }  # fmt: skip
    code, found = run_json("name", atlas, "room", "cycle:v2,v3,v6,v5,v4")
    assert (code, found["name"], found["set"]) == (0, "room", "cycle:v2,v3,v6,v5,v4")
    assert run("name", atlas, "building", "cycle:v0,v1,v8,v7")[0] == 0
    code, found = run_json("relate", atlas, "room", "building")
    assert code == 0
    assert found == {
        "x": "room",
        "y": "building",
        "name": "inside",
        "de9im": "2FF1FF212",
        "matrix": [[1, 0, 0], [1, 0, 0], [1, 1, 1]],
        "rcc8": "NTPP",
    }
    code, found = run_json("relate", atlas, "vertex:v1", "building")
    assert (found["name"], found["rcc8"]) == ("meet", None)
    code, out, _ = run("relate", atlas, "room", "building")
    assert out.splitlines()[:2] == ["room  inside  building", "DE-9IM 2FF1FF212   RCC-8 NTPP"]
    code, found = run_json("info", atlas)
    assert (code, found["vertices"], found["edges"], found["faces"], found["components"]) == (0, 9, 13, 6, 1)
    assert found["names"] == {"building": "region", "room": "region"}
    assert found["origin"] == "walk"
    assert found["provenance"][0]["source"] == str(walk)
    assert found["checks"]["largest_residual"] < 1e-9
    code, out, _ = run("info", atlas)
    assert code == 0
    assert "2 regions: building, room" in out
    with Atlas.open(atlas, writable=False) as stored:
        assert stored.plane == build(read_walk(walk))


def test_explore_with_a_compass_that_errs(run_json, tmp_path):
    walk = tmp_path / "walk.jsonl"
    options = {"noise": 0.05, "drift": 0.02, "tour": "covering", "tours": 2}
    flags = [text for key, value in options.items() for text in (f"--{key}", value)]
    code, found = run_json("explore", "sample:office", "-o", walk, "--seed", 4, *flags, "--ordered-exits", "--step", 2)
    assert (code, found["sigma"], found["drift"]) == (0, 0.05, 0.02)
    world = samples.load("office").to_world()
    assert read_walk(walk) == explore(world, seed=4, step=2, ordered_exits=True, **options).walk
    assert read_walk(walk).header == WalkHeader(tolerance=found["tolerance"], sigma=0.05, drift=0.02, exits="in-order")


def test_explore_along_the_wall_and_without_names(run, tmp_path):
    walk = tmp_path / "walk.jsonl"
    assert run("explore", "sample:office", "-o", walk, "--tour", "wall", "--no-places")[0] == 0
    found = read_walk(walk)
    assert found == explore(samples.load("office").to_world(), tour="wall", places=False).walk
    assert set(found.places) == {None}


def test_measured_lengths_are_told_only_where_there_are_some(tmp_path, run, run_json):
    walk, atlas = tmp_path / "walk.jsonl", tmp_path / "office.atlas"
    assert run("explore", "sample:office", "-o", walk)[0] == 0
    assert not any("metres" in event for event in map(json.loads, walk.read_text().splitlines()))
    assert run("map", walk, "-o", atlas)[0] == 0
    assert "measured_lengths" not in run_json("info", atlas)[1]
    assert "lengths " not in run("info", atlas)[1]
    assert run("explore", "sample:office", "-o", walk, "--metres", "--force")[0] == 0
    events = [json.loads(line) for line in walk.read_text().splitlines()]
    assert all(event["metres"] > 0 for event in events if "headings" in event)
    del events[-2]["metres"]  # the last leg is walked for the first time
    walk.write_text("\n".join(map(json.dumps, events)))
    assert run("map", walk, "-o", atlas, "--force")[0] == 0
    code, found = run_json("info", atlas)
    assert (code, found["edges"], found["measured_lengths"]) == (0, 11, 10)
    assert "lengths      measured along 10 of 11 edges" in run("info", atlas)[1]


@pytest.mark.parametrize("name", samples.names())
def test_every_sample_maps_alike_from_geometry_and_from_a_walk(tmp_path, run, run_json, name):
    walk = tmp_path / "walk.jsonl"
    assert run("explore", f"sample:{name}", "-o", walk)[0] == 0
    _, ground = run_json("map", f"sample:{name}", "-o", tmp_path / "ground.atlas")
    _, walked = run_json("map", walk, "-o", tmp_path / "walk.atlas")
    for key in ("vertices", "edges", "faces", "components"):
        assert ground[key] == walked[key]


def test_names_that_do_not_exist_suggest_near_ones(run, figure8):
    run("name", figure8, "living room", "cycle:v2,v3,v6,v5,v4")
    assert_refused(run("relate", figure8, "living rom", "vertex:v1"), "did you mean 'living room'?")
    assert_refused(run("relate", figure8, "vertex:v10", "living room"), "no vertex named 'v10'", "'v1'")
    assert_refused(run("relate", figure8, "v1", "living room"), "no set named 'v1'", "the place", "'vertex:v1'")
    assert_refused(run("relate", figure8, "v0-v1", "living room"), "the edge", "'edge:@v0-v1'")
    assert_refused(run("name", figure8, "x", "edge:v1,v8,v7"), "two ends")
    assert_refused(run("name", figure8, "x", "edge:v1,v5"), "no edge")
    assert_refused(run("name", figure8, "x", "cycle:v0,v1,v3"), "no edge")
    assert_refused(run("name", figure8, "x", "blob:v0"), "write one of")
    assert_refused(run("name", figure8, "x:y", "vertex:v0"), "without a colon")
    with Atlas.open(figure8) as atlas:
        assert atlas.names == ("living room",)


def test_sets_may_be_json_lists(run, run_json, figure8):
    code, found = run_json("relate", figure8, '["cycle", "v0", "v1", "v8", "v7"]', '["vertex", "v2"]')
    assert (code, found["name"]) == (0, "contains")
    for text in ("[", "[1, 2]", '["vertex"]', '["vertex", "v1", "v2"]', '["blob", "x"]', '["line", null]', '["face", -1]'):
        assert_refused(run("relate", figure8, text, "vertex:v1"))
    cycle = '["cycle", "@v0-v1", "@v1-v8", "@v8-v7", "@v7-v0"]'
    for text in ('["edge", "v1", "v3"]', '["path", "v1", "v3", "v6"]', '["line", "v1-v3"]', cycle, '["faces", 1, "2"]'):
        assert run("name", figure8, "it", text, "--force")[0] == 0


def test_a_taken_name_needs_force(run, figure8):
    assert run("name", figure8, "spot", "vertex:v1")[0] == 0
    assert_refused(run("name", figure8, "spot", "vertex:v2"), "--force")
    assert run("name", figure8, "spot", "vertex:v2", "--force")[0] == 0


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_tables_of_all_pairs(tmp_path, run, run_json, figure8, suffix):
    if suffix == "parquet":
        pytest.importorskip("pyarrow")
    for name, text in (("room", "cycle:v2,v3,v6,v5,v4"), ("all", "cycle:v0,v1,v8,v7"), ("door, north", "vertex:v0")):
        run("name", figure8, name, text)
    table = tmp_path / f"pairs.{suffix}"
    code, found = run_json("relate", figure8, "--all", "-o", table)
    assert (code, found["sets"], found["pairs"]) == (0, 3, 3)
    if suffix == "csv":
        with table.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
    else:
        import pyarrow.parquet

        rows = pyarrow.parquet.read_table(table).to_pylist()
    none = "" if suffix == "csv" else None
    assert rows == [
        {"x": "all", "y": "door, north", "name": "contains", "de9im": "FF20F1FF2", "rcc8": none}
        | {"name": rows[0]["name"], "de9im": rows[0]["de9im"]},
        {"x": "all", "y": "room", "name": "contains", "de9im": "212FF1FF2", "rcc8": "NTPPi"},
        {"x": "door, north", "y": "room", "name": "disjoint", "de9im": "FF0FFF212", "rcc8": none},
    ]
    assert rows[0]["name"] == "meet"
    assert_refused(run("relate", figure8, "--all", "-o", table), "exists already")
    code, found = run_json("relate", figure8, "--faces", "-o", table, "--force")
    assert (code, found["sets"], found["pairs"]) == (0, 5, 10)


def test_tables_need_what_they_need(tmp_path, run, figure8):
    table = tmp_path / "t.csv"
    assert_refused(run("relate", figure8), "two sets")
    assert_refused(run("relate", figure8, "vertex:v1"), "two sets")
    assert_refused(run("relate", figure8, "--all"), "-o FILE")
    assert_refused(run("relate", figure8, "vertex:v1", "vertex:v2", "-o", table), "--all")
    assert_refused(run("relate", figure8, "vertex:v1", "vertex:v2", "--all", "-o", table), "either")
    assert_refused(run("relate", figure8, "--all", "-o", table), "no set to relate")
    assert_refused(run("relate", figure8, "--faces", "-o", tmp_path / "t.xlsx"), ".csv or .parquet")
    assert_refused(run("relate", figure8, "--faces", "-o", tmp_path / "no" / "t.csv"), "does not exist")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["figure8.atlas"]


def test_a_missing_extra_says_how_to_get_it(tmp_path, run, figure8, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    assert_refused(run("relate", figure8, "--faces", "-o", tmp_path / "t.parquet"), "pip install 'ninefold[gis]'")


def crossing_streets(path):
    lines = [[[0, 0], [10, 0]], [[5, -5], [5, 5]], [[0, 0], [0, 9]], [[50, 50], [60, 50]]]
    path.write_text(json.dumps({"type": "MultiLineString", "coordinates": lines, "ninefold": {"units": "m"}}))
    return path


def test_crossings_are_counted_refused_and_dropped_on_demand(tmp_path, run, run_json):
    source = crossing_streets(tmp_path / "town.geojson")
    for command in ("map", "explore"):
        assert_refused(run(command, source, "-o", tmp_path / "out.x"), "at 1 place without a vertex", "--drop-crossing")
    assert not (tmp_path / "out.x").exists()
    code, found = run_json("map", source, "-o", tmp_path / "town.atlas", "--drop-crossing")
    assert (code, found["edges"], found["components"]) == (0, 3, 2)
    assert found["warnings"] == ["dropped 1 of 4 edges that meet others without a vertex: 'e1'"]
    code, found = run_json("explore", source, "-o", tmp_path / "town.jsonl", "--drop-crossing")
    assert (code, found["vertices"]) == (0, 3)
    assert found["unreached"] == [["v5", "v6"]]
    assert "cannot be reached" in found["warnings"][1]


def test_what_is_refused_changes_nothing(tmp_path, run, figure8):
    before = figure8.read_bytes()
    assert_refused(run("map", "sample:ring", "-o", figure8), "exists already", "--force")
    assert_refused(run("explore", "sample:ring", "-o", figure8), "exists already")
    assert_refused(run("map", "sample:rings", "-o", tmp_path / "x.atlas"), "did you mean 'ring'")
    assert_refused(run("map", figure8, "-o", tmp_path / "x.atlas"), "an atlas already")
    assert_refused(run("map", tmp_path / "none.jsonl", "-o", tmp_path / "x.atlas"), "No such file")
    assert_refused(run("map", "sample:ring", "-o", tmp_path / "x.atlas", "--tolerance", "0.1"), "--tolerance is for walks")
    for options, word in (
        (("--noise", "5"), "60 degrees"),
        (("--drift", "4"), "180 degrees"),
        (("--tour", "wild"), "'covering' or 'wall', not 'wild'"),
    ):
        assert_refused(run("explore", "sample:ring", "-o", tmp_path / "x.jsonl", *options), word)
    assert_refused(run("explore", "sample:ring", "-o", tmp_path / "x.jsonl", "--step", "0"), "step")
    assert_refused(run("explore", "sample:ring", "-o", tmp_path / "x.jsonl", "--start", "in9"), "did you mean")
    bad = tmp_path / "bad.jsonl"
    bad.write_text('{"ninefold": "walk", "version": 1, "heading": "yaw-rad"}\n{"place": "a"}\n{"heading": NaN}\n')
    assert_refused(run("map", bad, "-o", tmp_path / "x.atlas"), "bad.jsonl, line 3: ")
    assert_refused(run("map", bad, "-o", tmp_path / "x.atlas", "--drop-crossing"), "--drop-crossing")
    bad.write_text(bad.read_text().replace("NaN", "0") + '{"place": "b", "exits": [0]}\n')
    assert_refused(
        run("map", bad, "-o", tmp_path / "x.atlas"), "bad.jsonl, line 4: ", "along none of its 1 exit; exits seen: 0 rad"
    )
    (tmp_path / "notes.txt").write_text("hello")
    assert_refused(run("map", tmp_path / "notes.txt", "-o", tmp_path / "x.atlas"), "neither an atlas")
    assert_refused(run("info", tmp_path / "notes.txt"), "not an atlas")
    assert figure8.read_bytes() == before
    assert sorted(file.name for file in tmp_path.iterdir()) == ["bad.jsonl", "figure8.atlas", "notes.txt"]


@pytest.mark.parametrize(
    ("unit", "headings", "words"),
    [
        ("yaw-rad", [90, 180, 270, 0], "headings reach 270 and the header says yaw-rad"),
        ("yaw-deg", [0, 1.5708, 3.1416, 4.7124], "if they are radians"),
        ("bearing-deg", [0, 1.5708, 3.1416, 4.7124], "if they are radians"),
        ("yaw-deg", [0, 90, 180, 270], None),
        ("bearing-deg", [0, 270, 180, 90], None),
        ("yaw-deg", [0, 1, 2, 3], None),
        ("yaw-rad", [0, 1.5708, 3.1416, 4.7124 + 2 * 6.2832], None),
    ],
)
def test_a_mistaken_unit_of_headings_is_doubted(tmp_path, run, run_json, unit, headings, words):
    walk = tmp_path / "walk.jsonl"
    lines = [{"ninefold": "walk", "version": 1, "heading": unit}, {"place": "0"}]
    for place, heading in enumerate(headings, 1):
        lines += [{"heading": heading}, {"place": str(place)}]
    walk.write_text("\n".join(map(json.dumps, lines)))
    code, out, err = run("map", walk, "-o", tmp_path / "walk.atlas")
    assert (code, out.count("\n")) == (0, 1)
    _, found = run_json("map", walk, "-o", tmp_path / "walk.atlas", "--force")
    if words is None:
        assert err == ""
        assert found["warnings"] == []
    else:
        assert words in err
        assert len(found["warnings"]) == 1
    lines[-1] = {"place": "0"}  # closes a loop that cannot be
    lines[4] = lines[2]
    walk.write_text("\n".join(map(json.dumps, lines)))
    assert_refused(run("map", walk, "-o", tmp_path / "loop.atlas"), "walk.jsonl, line ", words or "")


@pytest.fixture
def kinds(tmp_path, figure8):
    """A file of each kind."""
    write_walk(explore(samples.load("ring").to_world()).walk, tmp_path / "walk.jsonl")
    network = Network("rcc8")
    network.add("a", "b", "EC")
    write_network(network, tmp_path / "net.csv")
    shutil.copy(samples.path("ring"), tmp_path / "streets.geojson")
    nouns = {"walk.jsonl": "a walk log", "net.csv": "a relation network", "streets.geojson": "lines in GeoJSON"}
    return {tmp_path / name: noun for name, noun in nouns.items()} | {figure8: "an atlas"}


@pytest.mark.parametrize(
    ("command", "takes"),
    [
        (["info", "FILE"], "an atlas"),
        (["name", "FILE", "n", "vertex:v0"], "an atlas"),
        (["relate", "FILE", "vertex:v0", "vertex:v1"], "an atlas"),
        (["draw", "FILE", "-o", "x.svg"], "an atlas"),
        (["verify", "FILE"], "an atlas"),
        (["explore", "FILE", "-o", "x.jsonl"], "lines in GeoJSON"),
        (["check", "FILE"], "a relation network"),
        (["prove", "FILE", "proof"], "a relation network"),
        (["infer", "FILE", "a", "b"], "a relation network"),
        (["ask", "FILE", "EC(a, b)"], "a relation network"),
        (["repair", "FILE"], "a relation network"),
        (["scenarios", "FILE"], "a relation network"),
    ],
)
def test_every_command_says_what_a_wrong_file_is(tmp_path, monkeypatch, run, kinds, command, takes):
    monkeypatch.chdir(tmp_path)
    before = sorted(file.name for file in tmp_path.iterdir())
    for path, noun in kinds.items():
        if noun != takes:
            assert_refused(
                run(*[path if word == "FILE" else word for word in command]), f"{path}: this is {noun}, not ", "`ninefold "
            )
    assert sorted(file.name for file in tmp_path.iterdir()) == before


def test_map_says_what_a_network_and_an_atlas_are(tmp_path, run, kinds, figure8):
    assert_refused(
        run("map", tmp_path / "net.csv", "-o", tmp_path / "x.atlas"), "this is a relation network", "ninefold check"
    )
    assert_refused(run("map", figure8, "-o", tmp_path / "x.atlas"), "an atlas already", "ninefold info")


def test_plurals(tmp_path, run):
    atlas = tmp_path / "one.atlas"
    (tmp_path / "one.jsonl").write_text(
        '{"ninefold": "walk", "version": 1, "heading": "yaw-deg"}\n{"place": "a"}\n{"heading": 0}\n{"place": "b"}\n'
    )
    assert run("map", tmp_path / "one.jsonl", "-o", atlas)[1] == f"{atlas}: 2 vertices, 1 edge, 1 face\n"
    assert "along 1 edge: e0" in run("info", atlas)[1]
    assert run("name", atlas, "spot", "vertex:a")[1] == f"spot: Point(a), stored in {atlas}\n"
    assert run("name", atlas, "way", "edge:@e0")[0] == 0
    assert run("relate", atlas, "--all", "-o", tmp_path / "t.csv")[1] == f"{tmp_path / 't.csv'}: 1 pair of 2 sets\n"
    assert "named sets   1 line, 1 point: " in run("info", atlas)[1]
    net = tmp_path / "net.csv"
    net.write_text("a,relations,b\nx,EQ,x\n")
    assert "consistent (1 entity, 1 statement, " in run("check", net)[1]
    net.write_text("a,relations,b\nx,DC,y\nx,EQ,y\n")
    assert "(2 entities, 2 statements, " in run("check", net)[1]


def test_what_is_written_is_said(tmp_path, run):
    net, picture = tmp_path / "net.csv", tmp_path / "net.svg"
    net.write_text("a,relations,b\nx,EC,y\n")
    code, out, _ = run("check", net, "--draw", picture)
    assert (code, out.splitlines()[-1]) == (0, f"{picture}: a drawing of 2 regions, checked pair by pair")
    atlas = tmp_path / "ring.atlas"
    assert run("map", "sample:ring", "-o", atlas)[1].startswith(f"{atlas}: ")
    code, out, err = run("verify", atlas, "--pairs", 20, "-o", tmp_path / "wrong.svg")
    assert (code, err) == (0, f"ninefold: {tmp_path / 'wrong.svg'}: not written, since there is no disagreement to draw\n")
    assert not (tmp_path / "wrong.svg").exists()


def test_force_never_replaces_the_source(tmp_path, run):
    walk, streets = tmp_path / "ring.jsonl", tmp_path / "ring.geojson"
    assert run("explore", "sample:ring", "-o", walk)[0] == 0
    streets.write_bytes(samples.path("ring").read_bytes())
    for command, source in (("map", walk), ("map", streets), ("explore", streets)):
        before = source.read_bytes()
        assert_refused(run(command, source, "-o", source, "--force"), "the source itself", "another name")
        assert source.read_bytes() == before


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="pipes of Unix")
def test_pipes_and_devices_are_neither_read_nor_replaced(tmp_path, run):
    pipe = tmp_path / "pipe.svg"
    os.mkfifo(pipe)
    atlas = tmp_path / "ring.atlas"
    assert_refused(run("map", pipe, "-o", atlas), "save it to a file")
    assert run("map", "sample:ring", "-o", atlas)[0] == 0
    assert_refused(run("map", "sample:ring", "-o", pipe, "--force"), "a device or a pipe")
    assert_refused(run("explore", "sample:ring", "-o", pipe, "--force"), "a device or a pipe")
    assert_refused(run("draw", atlas, "-o", pipe, "--force"), "a device or a pipe")
    with pytest.raises(WalkError, match="a device or a pipe"):
        write_walk(Walk(WalkHeader(), (Visit("a"),)), pipe)
    assert pipe.is_fifo()


def test_our_own_mistakes_are_one_line_too(run, figure8, monkeypatch):
    def broken(*_, **__):
        raise RuntimeError("two\nlines")

    monkeypatch.setattr(Atlas, "open", broken)
    assert_refused(run("info", figure8), "a mistake in ninefold itself", "two lines")
    monkeypatch.setenv("NINEFOLD_TRACEBACK", "1")
    with pytest.raises(RuntimeError):
        run("info", figure8)


@pytest.mark.parametrize(
    ("error", "code"),
    [(KeyboardInterrupt, 130), (BrokenPipeError, 141), (MemoryError, 2), (PermissionError(13, "Permission denied"), 2)],
)
def test_interruptions_have_their_codes(run, figure8, monkeypatch, error, code):
    def broken(*_, **__):
        raise error

    monkeypatch.setattr(Atlas, "open", broken)
    assert run("info", figure8)[0] == code


def test_long_work_shows_progress_and_short_work_does_not(capsys, monkeypatch):
    with _output.progress("thinking"):
        pass
    assert capsys.readouterr().err == ""
    monkeypatch.setattr(_output, "QUIET_SECONDS", 0.01)
    shown = ""
    with _output.progress("thinking"):
        for _ in range(500):
            time.sleep(0.01)
            shown += capsys.readouterr().err
            if shown:
                break
    assert shown.startswith("ninefold: thinking ... 0 s")


def test_the_demo_agrees_with_the_ground(tmp_path, run, run_json):
    code, found = run_json("demo", "--out", tmp_path / "out", "--pairs", "3000", "--seed", "5")
    assert code == 0
    assert found["agree"] is True
    assert found["mismatches"] == []
    assert found["pairs"] == 3000
    assert len(found["relations"]) == 8, "all eight names occur"
    assert found["edges"] == samples.load("helsinki_district").n_edges
    for path in found["files"].values():
        assert os.path.getsize(path) > 1000  # noqa: PTH202
    median, most = found["heading_error_deg"]
    assert median < 0.1
    assert most < 3
    assert found["misplaced"] < 0.05 < found["misplaced_tutte"]
    beside = (tmp_path / "out" / "district-beside.svg").read_text("utf-8")
    assert beside.count("<svg ") == 3
    assert "which the robot never saw" in beside
    assert "compass layout" in beside
    assert "OpenStreetMap" in beside
    code, out, _ = run("demo", "--out", tmp_path / "out", "--pairs", "500")
    assert code == 0
    assert "all 500 pairs" in out
    assert "of 380 legs are in parts whose shape the headings fix" in out
    assert "% in the Tutte drawing" in out
    assert str(tmp_path / "out" / "district.atlas") in out


def test_the_demo_shows_what_disagrees_and_exits_1(tmp_path, run, run_json, monkeypatch):
    class Elsewhere(demo.TrueShapes):
        def of(self, item):
            import shapely

            return (
                shapely.affinity.translate(super().of(item), 1000 * item.dimension)
                if item.dimension < 2
                else super().of(item)
            )

    import shapely.affinity  # noqa: F401

    monkeypatch.setattr(demo, "TrueShapes", Elsewhere)
    code, found = run_json("demo", "--out", tmp_path, "--pairs", "1000")
    assert code == 1
    assert found["agree"] is False
    assert len(found["mismatches"][0]) == 4
    code, out, _ = run("demo", "--out", tmp_path, "--pairs", "1000")
    assert code == 1
    assert "disagrees" in out
    assert "on the ground" in out


def test_the_demo_needs_a_folder(tmp_path, run):
    (tmp_path / "file").write_text("")
    assert_refused(run("demo", "--out", tmp_path / "file"), "cannot be made")


# -- whole processes -----------------------------------------------------------------------------------------------------


def test_a_process_exits_with_the_code_and_prints_one_line(tmp_path):
    done = subprocess.run([*MODULE, "info", tmp_path / "none.atlas", "--json"], capture_output=True, text=True)
    assert done.returncode == 2
    assert done.stderr.startswith("ninefold: ")
    assert done.stderr.count("\n") == 1
    assert "no such file" in json.loads(done.stdout)["error"]


def test_the_installed_command_is_the_same(figure8):
    script = os.path.join(os.path.dirname(sys.executable), "ninefold")  # noqa: PTH118, PTH120
    if not os.access(script, os.X_OK):
        pytest.skip("ninefold is not installed as a command here")
    done = subprocess.run([script, "relate", figure8, "vertex:v0", "edge:v0,v1", "--json"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["name"] == "meet"


def test_names_in_other_scripts_pass_any_terminal(tmp_path):
    source = tmp_path / "way.geojson"
    line = {"type": "LineString", "coordinates": [[0, 0], [1, 0]]}
    feature = {"type": "Feature", "properties": {"name": "Töölönkatu 東京"}, "geometry": line}
    source.write_text(json.dumps(feature), encoding="utf-8")
    assert cli.run(["map", str(source), "-o", str(tmp_path / "way.atlas")]) == 0
    for encoding in ("ascii", "latin-1", "utf-8"):
        environment = {**os.environ, "PYTHONIOENCODING": encoding, "PYTHONUTF8": "0"}
        command = [*MODULE, "info", tmp_path / "way.atlas"]
        plain = subprocess.run(command, capture_output=True, env=environment)
        assert plain.returncode == 0, plain.stderr
        found = subprocess.run([*command, "--json"], capture_output=True, env=environment)
        assert json.loads(found.stdout.decode(encoding))["outer_edges"] == ["Töölönkatu 東京"]


@pytest.mark.skipif(sys.platform == "win32", reason="pipes and signals of Unix")
def test_a_reader_that_goes_away_is_no_traceback(figure8):
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run([*MODULE, "info", figure8], stdout=write, stderr=subprocess.PIPE, text=True)
    os.close(write)
    assert done.returncode == 141
    assert done.stderr == ""


@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no device that is always full")  # noqa: PTH110
@pytest.mark.parametrize("buffering", ["", "1"])
@pytest.mark.parametrize("arguments", [["info"], ["info", "--json"], ["relate", "none", "other", "--json"]])
def test_an_output_that_cannot_be_written_is_one_line(figure8, arguments, buffering):
    command = [*MODULE, arguments[0], figure8, *arguments[1:]]
    environment = {**os.environ, "PYTHONUNBUFFERED": buffering}
    with open("/dev/full", "w") as full:  # noqa: PTH123
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, env=environment)
        assert done.returncode == 2
        assert done.stderr.startswith("ninefold: ")
        assert done.stderr.count("\n") == 1
        assert subprocess.run([*MODULE, "info", "none"], stdout=full, stderr=full, env=environment).returncode == 2


@pytest.mark.skipif(sys.platform == "win32", reason="a shell of Unix")
@pytest.mark.parametrize(("closed", "code"), [(">&-", 0), ("2>&-", 0), (">&- 2>&-", 0), (">&-", 2)])
def test_streams_that_the_caller_closed_are_no_mistake(figure8, closed, code):
    path = figure8 if code == 0 else figure8.with_name("none.atlas")
    command = ["sh", "-c", f'"$@" {closed}', "sh", *MODULE, "info", str(path)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == code
    assert done.stderr.count("\n") == (code == 2)


WAITING = """
import os, time
from ninefold import cli
from ninefold.io import Atlas
def slow(*_, **__):
    os.write(1, b"here\\n")
    time.sleep(60)
Atlas.open = slow
cli.main()
"""


@pytest.mark.skipif(sys.platform == "win32", reason="pipes and signals of Unix")
def test_ctrl_c_is_exit_130_without_a_traceback(figure8):
    command = [sys.executable, "-c", WAITING, "info", str(figure8)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout.readline() == "here\n"
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in err


HEAVY = ("shapely", "numba", "networkx", "scipy", "rich", "sympy", "pysat", "pyarrow", "matplotlib")


@pytest.mark.parametrize("arguments", [["--help"], ["relate", "ATLAS", "vertex:v0", "cycle:v0,v1,v8,v7"]])
def test_small_commands_load_nothing_heavy(figure8, arguments):
    program = (
        "import sys\nfrom ninefold import cli\ncode = cli.run(sys.argv[1:])\n"
        "print(*sys.modules, file=sys.stderr)\nsys.exit(code)"
    )
    command = [sys.executable, "-c", program, *(str(figure8) if word == "ATLAS" else word for word in arguments)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    loaded = set(done.stderr.split())
    assert "ninefold.cli._app" in loaded
    assert not loaded & set(HEAVY)
    if arguments == ["--help"]:
        assert "numpy" not in loaded
