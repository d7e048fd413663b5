"""Commands that draw, verify and tell what headings fix: options, JSON, and one clear line for what cannot be drawn."""

import json
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from ninefold import cli
from ninefold.cli import atlas as atlas_commands
from ninefold.io import Atlas, samples, write_walk
from ninefold.layout import LAYOUTS, compass, rigidity
from ninefold.mapping import Heading, PlaneMap, Samples, Visit, Walk, WalkHeader
from ninefold.mapping.turning import settle_turns


@pytest.fixture
def run(capsys):
    """Run a command; return exit code, stdout, stderr."""

    def runner(*arguments):
        code = cli.run([str(argument) for argument in arguments])
        return code, *capsys.readouterr()

    return runner


@pytest.fixture
def run_json(run):
    """Run a command with --json; return exit code and the object."""

    def runner(*arguments):
        code, out, _ = run(*arguments, "--json")
        return code, json.loads(out)

    return runner


@pytest.fixture
def house(tmp_path):
    path = tmp_path / "house.atlas"
    Atlas.from_map(samples.load("house").to_map(), path).close()
    return path


@pytest.fixture
def bare(tmp_path):
    """An atlas of a map without headings."""
    path = tmp_path / "bare.atlas"
    plane = PlaneMap.from_rotation({"a": ["b", "c"], "b": ["c", "a"], "c": ["a", "b"]}, outer=("b", "a"))
    Atlas.from_map(plane, path).close()
    return path


@pytest.fixture
def wrong(tmp_path):
    """An atlas of a braced grid in which the heading of leg 24 is wrong by 15 degrees."""
    at = np.arange(64).reshape(8, 8)
    corners = np.argwhere(at >= 0) + np.random.default_rng(3).uniform(-0.2, 0.2, (64, 2))
    ways = [(at[:-1], at[1:]), (at[:, :-1], at[:, 1:]), (at[:-1, :-1], at[1:, 1:])]
    right = PlaneMap.from_geometry(corners, np.concatenate([np.stack([a.ravel(), b.ravel()], axis=1) for a, b in ways]))
    heading = np.array(right.heading)
    heading[48:50] += np.radians(15)
    turn = settle_turns(heading, np.array(right.turn))
    path = tmp_path / "wrong.atlas"
    Atlas.from_map(PlaneMap.from_darts(right.tail, right.next_ccw, right.outer, heading=heading, turn=turn), path).close()
    return path


def walked(plane):
    """A walk along every edge of a connected map and back, straight along its headings."""
    events, seen, way = [Visit("0")], set(), []

    def step(dart):
        edge = plane.edge_names[dart >> 1]
        place = plane.vertex_names[plane.tail[dart ^ 1]]
        events.extend([Samples.of(Heading(float(plane.heading[dart]))), Visit(place, edge=edge)])

    at = plane.vertex_names.row("0")
    while True:
        leaving = [d for d in np.flatnonzero(plane.tail == at).tolist() if d >> 1 not in seen]
        if leaving:
            seen.add(leaving[0] >> 1)
            way.append(leaving[0])
            step(leaving[0])
        elif way:
            step(way.pop() ^ 1)
        else:
            return Walk(WalkHeader(), tuple(events))
        at = plane.vertex_names.row(events[-1].place)


def assert_refused(result, *words):
    code, out, err = result
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    for word in words:
        assert word in err


# -- info ----------------------------------------------------------------------------------------------------------------


def test_info_tells_what_the_headings_fix(run, run_json, house):
    assert run_json("info", house)[1]["fixed"] == {"legs": 6, "parts": 2, "largest": 3, "open": 4, "curved": 0}
    line = "headings fix 6 of 11 legs, in 2 parts (largest 3); 4 proportions are open; no leg is curved"
    assert line in run("info", house)[1].splitlines()


@pytest.mark.parametrize(
    ("name", "line"),
    [
        ("crossing", "headings fix 5 of 6 legs, in 1 part (largest 5); no proportion is open; 1 leg is curved"),
        ("garden", "headings fix 0 of 9 legs; 1 proportion is open; 3 legs are curved"),
    ],
)
def test_info_counts_in_the_right_number(tmp_path, run, name, line):
    run("map", f"sample:{name}", "-o", tmp_path / "a.atlas")
    assert line in run("info", tmp_path / "a.atlas")[1].splitlines()


def test_info_names_legs_that_the_rest_contradicts(run, run_json, wrong):
    code, found = run_json("info", wrong)
    (line,) = found["warnings"]
    assert code == 0
    assert line.startswith("leg '24' misses what the other headings say by 15 degrees: it is curved, ")
    assert f"note         {line}" in run("info", wrong)[1].splitlines()


def test_info_of_a_map_without_headings_leaves_it_out(run, run_json, bare):
    code, found = run_json("info", bare)
    assert (code, found["fixed"], found["warnings"]) == (0, None, [])
    assert "headings fix" not in run("info", bare)[1]
    code, _, err = run("info", bare, "--rigidity")
    assert (code, err) == (0, "ninefold: the map has no headings, so nothing is fixed by them\n")


def test_info_of_a_large_map_works_it_out_when_asked(run, run_json, wrong, monkeypatch):
    monkeypatch.setattr(atlas_commands, "TESTED_UP_TO", 100)
    code, found = run_json("info", wrong)
    assert (code, found["warnings"], found["fixed"]["legs"]) == (0, [], 161)
    assert "the headings of 161 edges were not held against each other; --rigidity does" in run("info", wrong)[2]
    monkeypatch.setattr(atlas_commands, "FIXED_UP_TO", 100)
    assert run_json("info", wrong)[1]["fixed"] is None
    assert "what the headings fix is left out, with 161 edges; --rigidity works it out" in run("info", wrong)[2]
    _, asked = run_json("info", wrong, "--rigidity")
    assert (asked["fixed"]["legs"], len(asked["warnings"])) == (161, 1)


def test_mapping_a_walk_names_legs_that_the_rest_contradicts(tmp_path, run, run_json, wrong):
    with Atlas.open(wrong, writable=False) as atlas:
        plane = atlas.plane
    calm = tmp_path / "calm.jsonl"
    run("explore", "sample:house", "-o", calm)
    assert run_json("map", calm, "-o", tmp_path / "calm.atlas")[1]["warnings"] == []
    walk = tmp_path / "wrong.jsonl"
    write_walk(walked(plane), walk)
    code, found = run_json("map", walk, "-o", tmp_path / "walked.atlas")
    assert code == 0
    (line,) = found["warnings"]
    assert line.startswith("leg '24' misses what the other headings say by 15 degrees")


# -- draw ----------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("layout", sorted(LAYOUTS))
def test_every_layout_can_be_drawn_and_verified(run, run_json, house, tmp_path, layout):
    code, found = run_json("draw", house, "-o", tmp_path / "a.svg", "--layout", layout)
    name = "compass" if layout == "auto" else layout
    assert (code, found["layout"], found["notes"]) == (0, name, [])
    assert f"{name} layout" in (tmp_path / "a.svg").read_text()
    code, found = run_json("verify", house, "--layout", layout, "--pairs", 300)
    assert (code, found["agree"], found["layout"], found["notes"]) == (0, True, name, [])


@pytest.mark.parametrize("layout", ["compass", "relaxed"])
def test_the_district_agrees_with_shapely_on_drawings_for_people(run_json, tmp_path, layout):
    atlas = tmp_path / "district.atlas"
    Atlas.from_map(samples.load("helsinki_district").to_map(), atlas).close()
    code, found = run_json("verify", atlas, "--layout", layout, "--pairs", 20_000)
    assert (code, found["pairs"], found["wrong"], found["layout"]) == (0, 20_000, 0, layout)


def test_help_lists_every_layout(run):
    for command in ("draw", "verify"):
        out = run(command, "--help")[1]
        for layout in LAYOUTS:
            assert layout in out


def test_verify_checks_schnyder_unless_told(run_json, house):
    assert run_json("verify", house, "--pairs", 50)[1]["layout"] == "schnyder"


def test_unknown_layouts_are_refused_with_the_known_ones(run, house, tmp_path):
    known = "the layouts are auto, compass, relaxed, schnyder, tutte"
    assert_refused(run("draw", house, "-o", tmp_path / "a.svg", "--layout", "compas"), "did you mean 'compass'", known)
    assert_refused(run("verify", house, "--layout", "spring"), known)
    assert not (tmp_path / "a.svg").exists()


def test_a_map_without_headings_has_no_compass_drawing(run, run_json, bare, tmp_path):
    picture = tmp_path / "a.svg"
    for options in (["--layout", "compass"], ["--curved"]):
        assert_refused(run("draw", bare, "-o", picture, *options), "no headings", "the layouts relaxed and tutte need none")
    assert_refused(run("draw", bare, "-o", picture, "--rigidity"), "no headings")
    assert_refused(run("verify", bare, "--layout", "compass"), "no headings")
    assert not picture.exists()
    assert run_json("draw", bare, "-o", picture)[1]["layout"] == "tutte"


def test_curved_legs_are_for_the_compass_layout(run, run_json, tmp_path):
    atlas, picture = tmp_path / "c.atlas", tmp_path / "c.svg"
    plane = samples.load("crossing").to_map()
    Atlas.from_map(plane, atlas).close()
    for layout in ("auto", "compass"):
        assert run_json("draw", atlas, "-o", picture, "--curved", "--layout", layout, "--force")[1]["layout"] == "compass"
        assert picture.read_text() == compass(plane, curved=True).to_svg(title="c")
    assert picture.read_text() != compass(plane).to_svg(title="c")
    for layout in ("tutte", "schnyder", "relaxed"):
        refused = run("draw", atlas, "-o", tmp_path / "d.svg", "--curved", "--layout", layout)
        assert_refused(refused, "--curved is for --layout compass", layout)
    assert not (tmp_path / "d.svg").exists()


def test_rigidity_colours_the_picture_and_warns(run, run_json, wrong, tmp_path):
    picture = tmp_path / "a.svg"
    code, out, err = run("draw", wrong, "-o", picture, "--rigidity")
    assert code == 0
    assert "in the compass layout" in out
    assert "leg '24' misses what the other headings say by 15 degrees" in err
    with Atlas.open(wrong, writable=False) as atlas:
        plane = atlas.plane
    assert picture.read_text() == compass(plane).to_svg(title="wrong", rigidity=rigidity(plane))
    assert 'class="contradicted"' in ET.tostring(ET.parse(picture).getroot(), encoding="unicode")
    code, found = run_json("draw", wrong, "-o", picture, "--rigidity", "--force")
    assert (found["fixed"]["legs"], len(found["notes"])) == (161, 1)
    assert "fixed" not in run_json("draw", wrong, "-o", picture, "--force")[1]


def test_verify_says_where_a_layout_fell_back(run, run_json, house, monkeypatch):
    from dataclasses import replace

    from ninefold.layout import layouts, tutte

    monkeypatch.setitem(layouts.LAYOUTS, "compass", lambda plane: replace(tutte(plane), notes=("a note",)))
    code, found = run_json("verify", house, "--layout", "compass", "--pairs", 20)
    assert (code, found["layout"], found["notes"]) == (0, "tutte", ["a note"])
    assert run("verify", house, "--layout", "compass", "--pairs", 20)[2] == "ninefold: a note\n"
