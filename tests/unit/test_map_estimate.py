"""`ninefold map` of walks whose headings err: the certain map, named doubts, a guess and what it keeps, and its pictures."""

from __future__ import annotations

import io
import json
import sqlite3
from contextlib import closing
from math import degrees, radians
from xml.etree import ElementTree

import pytest

from ninefold import cli, layout
from ninefold.errors import AtlasError, BadInput, UnknownName
from ninefold.io import Atlas, Guess, read_walk, samples
from ninefold.io.walks.json_lines import write_walk
from ninefold.io.walks.streams import read_stream
from ninefold.mapping import Doubt, Heading, PlaneMap, Samples, Visit, Walk, WalkHeader, estimate, explore

SIGMA = radians(2)


def leg(*yaws: float) -> Samples:
    return Samples.of(*(Heading.from_degrees(yaw) for yaw in yaws))


def there_and_back(**yaws: float) -> list[object]:
    """Events of a robot that walks straight from the yard to each place and back."""
    events: list[object] = [Visit("yard")]
    for place, yaw in yaws.items():
        events += [leg(yaw), Visit(place), leg(yaw + 180), Visit("yard")]
    return events


CLEAR = Walk(WalkHeader(), tuple(there_and_back(a=0, b=121, c=239)))
CLOSE = Walk(WalkHeader(), tuple(there_and_back(a=0, b=90, c=96)))
"""c lies left or right of b, with headings that err by 2 degrees; all three are dead ends."""


@pytest.fixture
def close(tmp_path):
    path = tmp_path / "close.jsonl"
    write_walk(CLOSE, path)
    return str(path)


@pytest.fixture
def clear(tmp_path):
    path = tmp_path / "clear.jsonl"
    write_walk(CLEAR, path)
    return str(path)


def run(capsys, *arguments: object) -> tuple[int, str, str]:
    code = cli.run([str(one) for one in arguments])
    said = capsys.readouterr()
    return code, said.out, said.err


# -- certain, or not ---------------------------------------------------------------------------------------------------


def test_a_certain_map_is_kept(clear, tmp_path, capsys):
    code, out, _ = run(capsys, "map", clear, "-o", tmp_path / "a.atlas", "--sigma", 2)
    assert code == 0
    assert "certain" in out
    with Atlas.open(tmp_path / "a.atlas") as atlas:
        assert atlas.plane == estimate(CLEAR, sigma=SIGMA).plane
        assert (atlas.origin, atlas.guess, atlas.provenance[0].kind) == ("map", None, "walk")
        assert atlas.walk == Walk(WalkHeader(sigma=SIGMA), CLEAR.events)
        with pytest.raises(BadInput, match="takes no events"):
            atlas.append(Visit("a"))
        assert not any("guess" in warning for warning in atlas.warnings)


def test_what_is_certain_stands_in_json(clear, tmp_path, capsys):
    code, out, _ = run(capsys, "map", clear, "-o", tmp_path / "a.atlas", "--sigma", 2, "--drift", 0.5, "--json")
    found = json.loads(out)
    assert code == 0
    assert (found["certain"], found["count"], found["bits"], found["doubts"]) == (True, 1, 0.0, [])
    assert (found["vertices"], found["edges"], found["faces"]) == (4, 3, 1)
    assert (found["sigma"], found["drift"]) == (pytest.approx(2), pytest.approx(0.5))


def test_doubts_are_told_and_nothing_is_written(close, tmp_path, capsys):
    out_file = tmp_path / "a.atlas"
    code, out, err = run(capsys, "map", close, "-o", out_file, "--sigma", 2)
    lines = out.splitlines()
    assert code == 1
    assert not out_file.exists()
    assert "not certain, 2 maps are left (1.0 bits); headings seem to err by 0 degrees, declared are 2" in lines[0]
    assert len(lines) == 2
    assert lines[1].startswith(
        "at 'yard' the dead end 'b' lies left or right of the dead end 'c'; walk the ways from 'yard'"
    )
    assert "--best keeps the likeliest map" in err


def test_doubts_stand_in_json(close, tmp_path, capsys):
    code, out, _ = run(capsys, "map", close, "-o", tmp_path / "a.atlas", "--sigma", 2, "--json")
    found = json.loads(out)
    assert code == 1
    assert (found["file"], found["certain"], found["count"], found["bits"]) == (None, False, 2, 1.0)
    (doubt,) = found["doubts"]
    assert (doubt["kind"], doubt["places"]) == ("order", ["yard"])
    assert sorted(doubt["orders"]) == [["a", "b", "c"], ["a", "c", "b"]]
    (more,) = estimate(CLOSE, sigma=SIGMA).more()
    assert doubt["more"] == str(more)


def test_an_atlas_that_is_there_stays_where_the_map_is_not_certain(clear, close, tmp_path, capsys):
    out_file = tmp_path / "a.atlas"
    assert run(capsys, "map", clear, "-o", out_file, "--sigma", 2)[0] == 0
    before = out_file.read_bytes()
    assert run(capsys, "map", close, "-o", out_file, "--sigma", 2, "--force")[0] == 1
    assert out_file.read_bytes() == before


def test_the_walk_is_kept_with_its_metres_and_can_be_estimated_again(tmp_path, capsys):
    lines = [
        b'{"ninefold": "walk", "version": 1, "heading": "bearing-deg", "drift": 0.01}\n',
        b'{"place": "a", "t": 1}\n',
        b'{"heading": 90, "metres": 3}\n',
        b'{"place": "b", "t": 5}\n',
    ]
    (tmp_path / "w.jsonl").write_bytes(b"".join(lines))
    assert run(capsys, "map", tmp_path / "w.jsonl", "-o", tmp_path / "a.atlas", "--sigma", 2)[0] == 0
    with Atlas.open(tmp_path / "a.atlas") as atlas:
        assert atlas.plane.metres is not None
        assert atlas.plane == estimate(atlas.walk).plane
        assert (atlas.walk.header.sigma, atlas.walk.header.drift, atlas.n_events) == (SIGMA, 0.01, 3)
        assert atlas.walk.events == read_walk(tmp_path / "w.jsonl").events
    assert "a walk whose headings err, 3 events" in run(capsys, "info", tmp_path / "a.atlas")[1]


def test_scatter_is_told_in_degrees(tmp_path, capsys):
    twice = Walk(WalkHeader(), (*there_and_back(a=0, b=121), *there_and_back(a=3, b=119)[1:]))
    write_walk(twice, tmp_path / "w.jsonl")
    found = estimate(twice, sigma=SIGMA)
    assert found.scatter is not None
    code, out, _ = run(capsys, "map", tmp_path / "w.jsonl", "-o", tmp_path / "a.atlas", "--sigma", 2, "--json")
    assert code == 0
    assert json.loads(out)["scatter"] == pytest.approx(degrees(found.scatter))


@pytest.mark.parametrize("best", [(), ("--best",)])
def test_no_map_left_is_one_line(tmp_path, capsys, best):
    wild = Walk(WalkHeader(), tuple(there_and_back(a=0, b=90)[:5] + [leg(60), Visit("a"), leg(200), Visit("yard")]))
    write_walk(wild, tmp_path / "w.jsonl")
    code, out, _ = run(capsys, "map", tmp_path / "w.jsonl", "-o", tmp_path / "a.atlas", "--sigma", 2, *best)
    assert code == 1
    assert len(out.splitlines()) == 1
    assert "more noise than declared" in out
    assert not (tmp_path / "a.atlas").exists()


def test_a_walk_on_standard_input_is_estimated_too(close, tmp_path, capsys, monkeypatch):
    content = (tmp_path / "close.jsonl").read_bytes()
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(content)))
    code, out, _ = run(capsys, "map", "-", "-o", tmp_path / "a.atlas", "--sigma", 2)
    assert code == 1
    assert out.startswith("standard input: not certain, 2 maps")


# -- what declares noise -----------------------------------------------------------------------------------------------


def test_a_header_that_declares_sigma_is_heeded(tmp_path, capsys):
    path = tmp_path / "w.jsonl"
    write_walk(Walk(WalkHeader(sigma=SIGMA), CLOSE.events), path)
    code, out, _ = run(capsys, "map", path, "-o", tmp_path / "a.atlas")
    assert code == 1
    assert "2 maps are left" in out


def test_a_tolerance_takes_headings_as_they_are(tmp_path, capsys):
    path = tmp_path / "w.jsonl"
    write_walk(Walk(WalkHeader(sigma=SIGMA), CLOSE.events), path)
    code, out, _ = run(capsys, "map", path, "-o", tmp_path / "a.atlas", "--tolerance", 0.01)
    assert (code, "certain" in out) == (0, False)
    with Atlas.open(tmp_path / "a.atlas") as atlas:
        assert atlas.origin == "walk"


def test_without_a_sigma_headings_are_taken_as_they_are(close, tmp_path, capsys):
    assert run(capsys, "map", close, "-o", tmp_path / "a.atlas")[0] == 0
    with Atlas.open(tmp_path / "a.atlas") as atlas:
        assert (atlas.origin, atlas.guess) == ("walk", None)


def test_the_option_goes_before_the_header(tmp_path, capsys):
    path = tmp_path / "w.jsonl"
    write_walk(Walk(WalkHeader(sigma=radians(20)), CLEAR.events), path)
    assert run(capsys, "map", path, "-o", tmp_path / "a.atlas", "--sigma", 2)[0] == 0


def test_a_walk_may_list_exits_that_lie_too_close_for_exact_headings(tmp_path, capsys):
    header = b'{"ninefold": "walk", "version": 1, "heading": "yaw-deg"}\n'
    lines = [
        header,
        b'{"place": "yard", "exits": [0, 90, 90.2]}\n',
        b'{"heading": 0}\n',
        b'{"place": "a", "exits": [180]}\n',
    ]
    path = tmp_path / "w.jsonl"
    path.write_bytes(b"".join(lines))
    assert "tolerance" in run(capsys, "map", path, "-o", tmp_path / "a.atlas")[2]
    code, _, err = run(capsys, "map", path, "-o", tmp_path / "a.atlas", "--sigma", 2)
    assert (code, "2 exits were never travelled" in err) == (0, True)
    assert read_walk(path, sigma=SIGMA).header.sigma == read_stream(lines, sigma=SIGMA).header.sigma == SIGMA


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--sigma", 0), "--sigma is a standard deviation in degrees, above 0 and at most 60, not 0"),
        (("--sigma", -2), "not -2"),
        (("--sigma", 61), "not 61"),
        (("--sigma", "nan"), "not nan"),
        (("--sigma", 2, "--drift", -1), "--drift is a standard deviation in degrees, from 0 to 180, not -1"),
        (("--sigma", 2, "--drift", 181), "not 181"),
        (("--sigma", 2, "--tolerance", 0.01), "give one of them"),
        (("--best",), "give --sigma DEG"),
        (("--drift", 0), "give --sigma DEG"),
    ],
)
def test_bad_options_are_one_line(close, tmp_path, capsys, options, words):
    code, _, err = run(capsys, "map", close, "-o", tmp_path / "a.atlas", *options)
    assert code == 2
    assert words in err
    assert len(err.splitlines()) == 1
    assert not (tmp_path / "a.atlas").exists()


@pytest.mark.parametrize("option", [("--sigma", 2), ("--drift", 0), ("--best",)])
def test_geometry_has_no_noise(tmp_path, capsys, option):
    code, _, err = run(capsys, "map", "sample:office", "-o", tmp_path / "a.atlas", *option)
    assert code == 2
    assert f"{option[0]} is for walks" in err


def test_following_takes_headings_as_they_are(tmp_path, capsys):
    code, _, err = run(capsys, "map", "-", "--follow", "-o", tmp_path / "a.atlas", "--sigma", 2)
    assert code == 2
    assert "--follow" in err


def test_an_error_names_the_line(tmp_path, capsys):
    path = tmp_path / "w.jsonl"
    write_walk(Walk(WalkHeader(), (Visit("a"), leg(0), Visit(None), leg(90), Visit("c"))), path)
    code, _, err = run(capsys, "map", path, "-o", tmp_path / "a.atlas", "--sigma", 2)
    assert code == 2
    assert "w.jsonl, line 4" in err


# -- a guess -----------------------------------------------------------------------------------------------------------


@pytest.fixture
def guessed(close, tmp_path, capsys):
    path = tmp_path / "guess.atlas"
    assert run(capsys, "map", close, "-o", path, "--sigma", 2, "--best")[0] == 0
    return path


def test_the_likeliest_map_is_kept_as_a_guess(close, tmp_path, capsys):
    code, out, err = run(capsys, "map", close, "-o", tmp_path / "a.atlas", "--sigma", 2, "--best")
    assert code == 0
    assert "a guess, 2 maps are left" in out
    assert "this map is a guess" in err
    found = estimate(CLOSE, sigma=SIGMA)
    with Atlas.open(tmp_path / "a.atlas") as atlas:
        assert atlas.plane == found.best
        assert atlas.guess == Guess.of(found)
        assert atlas.guess is not None
        assert (atlas.guess.count, atlas.guess.bits, atlas.guess.doubts) == (2, 1.0, found.doubts)
        assert atlas.warnings == atlas.guess.warnings


def test_best_of_a_certain_map_is_no_guess(clear, tmp_path, capsys):
    assert run(capsys, "map", clear, "-o", tmp_path / "a.atlas", "--sigma", 2, "--best")[0] == 0
    assert Guess.of(estimate(CLEAR, sigma=SIGMA)) is None
    with Atlas.open(tmp_path / "a.atlas") as atlas:
        assert (atlas.guess, atlas.warnings) == (None, ())


@pytest.mark.parametrize("best", [(), ("--best",)])
def test_where_no_map_can_be_listed_there_is_no_likeliest(tmp_path, capsys, best):
    crowd = Walk(WalkHeader(), tuple(there_and_back(**{f"p{k}": k for k in range(12)})))
    write_walk(crowd, tmp_path / "w.jsonl")
    code, out, err = run(capsys, "map", tmp_path / "w.jsonl", "-o", tmp_path / "a.atlas", "--sigma", 10, *best)
    assert code == 1
    assert "more maps are left than were counted" in out
    assert "the ways at 'yard' lie too close together" in out
    assert "no map is listed" in err
    assert not (tmp_path / "a.atlas").exists()


def test_info_tells_what_is_undecided_and_which_walk_would_settle_it(guessed, capsys):
    code, out, _ = run(capsys, "info", guessed)
    assert code == 0
    notes = [line for line in out.splitlines() if line.startswith("note")]
    assert "this map is a guess: headings that err by 2 degrees leave 2 maps" in notes[0]
    assert "lies left or right of the dead end 'c'; walk the ways from 'yard' to 'b' and 'c'" in notes[1]
    found = json.loads(run(capsys, "info", guessed, "--json")[1])["guess"]
    assert (found["count"], found["bits"], found["sigma"]) == (2, 1.0, pytest.approx(2))
    assert found["doubts"][0]["places"] == ["yard"]
    assert "times more" in found["doubts"][0]["more"]


def test_info_of_a_map_that_is_no_guess_has_none(tmp_path, capsys):
    run(capsys, "map", "sample:office", "-o", tmp_path / "a.atlas")
    assert json.loads(run(capsys, "info", tmp_path / "a.atlas", "--json")[1])["guess"] is None


def test_a_guess_is_format_one(guessed):
    with closing(sqlite3.connect(guessed)) as database:
        assert database.execute("PRAGMA user_version").fetchone() == (1,)


def stored(count: object = 2, sigma: object = 0.1, **doubt: object) -> str:
    told = {"kind": "ways", "places": ["yard"], "orders": [], "text": "", "more": ""} | doubt
    return json.dumps({"sigma": sigma, "drift": 0, "count": count, "doubts": [told]})


def test_what_stands_in_an_atlas_is_read_as_it_was():
    assert Guess.from_json(stored(count=None)).count is None


@pytest.mark.parametrize(
    "text",
    [
        "{",
        "[]",
        "{}",
        stored(sigma="x"),
        stored(count=-1),
        stored(count=True),
        stored(kind="tea"),
        stored(kind=[]),
        stored(places=[1]),
        stored(places="ab"),
        stored(orders=["ab"]),
        stored(text=3),
        stored(more=None),
        7,
    ],
)
def test_a_damaged_guess_is_one_line(guessed, capsys, text):
    with closing(sqlite3.connect(guessed)) as database, database:
        database.execute("UPDATE meta SET value = ? WHERE key = 'guess'", (text,))
    with Atlas.open(guessed) as atlas, pytest.raises(AtlasError, match="damaged"):
        _ = atlas.guess
    code, _, err = run(capsys, "info", guessed)
    assert (code, len(err.splitlines())) == (2, 1)


# -- pictures ----------------------------------------------------------------------------------------------------------


def texts(svg: str) -> list[str]:
    return [one.text or "" for one in ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}text")]


def rings(svg: str) -> list[ElementTree.Element]:
    found = ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}circle")
    return [one for one in found if one.get("class") == "doubt"]


@pytest.mark.parametrize("theme", ["light", "dark", "auto"])
def test_draw_shows_where_a_guess_is_undecided(guessed, tmp_path, capsys, theme):
    code, _, err = run(capsys, "draw", guessed, "-o", tmp_path / "g.svg", "--theme", theme)
    svg = (tmp_path / "g.svg").read_text()
    assert code == 0
    assert "this map is a guess" in err
    assert "order undecided: 1 place" in texts(svg)
    assert len(rings(svg)) == 2  # at the place, and in the legend
    said = " ".join(texts(svg))
    assert "1: at 'yard' the dead end 'b' lies left or right of the dead end 'c'; walk the ways from 'yard'" in said


def test_a_map_without_doubts_is_drawn_as_ever(clear, tmp_path, capsys):
    run(capsys, "map", clear, "-o", tmp_path / "a.atlas", "--sigma", 2)
    run(capsys, "draw", tmp_path / "a.atlas", "-o", tmp_path / "a.svg")
    svg = (tmp_path / "a.svg").read_text()
    assert (rings(svg), "undecided" in svg) == ([], False)


def test_a_ring_stands_at_its_place():
    found = estimate(CLOSE, sigma=SIGMA)
    svg = layout.draw(found.best).to_svg(doubts=found.doubts)
    ring = rings(svg)[0]
    spots = {
        one[0].text: (one.get("cx"), one.get("cy"))
        for one in ElementTree.fromstring(svg).iter("{http://www.w3.org/2000/svg}circle")
        if len(one)
    }
    assert spots["yard"] == (ring.get("cx"), ring.get("cy"))


PATH = PlaneMap.from_geometry([(0, 0), (1, 0), (2, 1)], [(0, 1), (1, 2)], vertex_names="abc")


def test_kinds_of_doubts_have_marks_of_their_own_and_many_are_cut_short():
    ways = Doubt("ways", ("a", "b"), (), "2 legs between 'a' and 'b' went one way or several")
    order = Doubt("order", ("b",), (("a", "c"), ("c", "a")), "at 'b' <all> is open & so on")
    svg = layout.draw(PATH).to_svg(doubts=[ways, order, *[order] * 8])
    assert {"order undecided: 1 place", "one way or several: 1 place", "and 2 doubts more"} <= set(texts(svg))
    assert "2: at 'b' <all> is open & so on" in texts(svg)
    assert "1,2,3,4,5,6,7,8,9,10" in texts(svg)
    dashes = [ring.get("stroke-dasharray") for ring in rings(svg)]
    assert len(set(dashes)) == 2


def test_an_outer_doubt_is_said_without_a_mark():
    svg = layout.draw(PATH).to_svg(doubts=[Doubt("outer", (), (), "which face is the outer one: 2 faces can be")])
    assert rings(svg) == []
    assert "1: which face is the outer one: 2 faces can be" in texts(svg)


def test_what_is_no_doubt_of_the_map_is_refused():
    drawing = layout.draw(PATH)
    with pytest.raises(BadInput, match=r"estimate\.doubts"):
        drawing.to_svg(doubts=["a"])
    with pytest.raises(UnknownName):
        drawing.to_svg(doubts=[Doubt("order", ("attic",), (), "at 'attic'")])


# -- a whole district --------------------------------------------------------------------------------------------------


def test_a_district_walked_with_five_degrees_is_in_few_named_doubts(tmp_path, capsys):
    robot = explore(samples.load("helsinki_district").to_world(), seed=1, noise=radians(5), step=50)
    write_walk(robot.walk, tmp_path / "w.jsonl")
    code, out, _ = run(capsys, "map", tmp_path / "w.jsonl", "-o", tmp_path / "a.atlas", "--best", "--json")
    found = json.loads(out)
    assert code == 0
    assert (found["vertices"], found["edges"], found["faces"], found["certain"]) == (293, 380, 89, False)
    assert 1 <= found["bits"] <= 8
    assert found["scatter"] == pytest.approx(5, rel=0.1)
    with Atlas.open(tmp_path / "a.atlas") as atlas:
        assert atlas.guess is not None
        assert len(atlas.guess.doubts) == len(found["doubts"])


def test_a_hundred_doubts_are_not_all_printed():
    from ninefold.cli._output import first_few

    assert first_few(["a", "b"], most=1) == ["a", "b"]
    assert first_few(map(str, range(5)), most=2) == ["0", "1", "... and 3 more; --json lists them all"]
