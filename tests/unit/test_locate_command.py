"""`ninefold locate`: answers, exit codes, JSON, streams and pictures."""

import io
import json
import os
import subprocess
import sys
from math import radians
from pathlib import Path

import numpy as np
import pytest

from ninefold.cli import run
from ninefold.errors import BadInput
from ninefold.io import Atlas
from ninefold.layout import draw
from ninefold.mapping import Localizer, PlaneMap

HEADER = '{"ninefold": "walk", "version": 1, "heading": "bearing-deg"}'


@pytest.fixture
def yard(tmp_path, monkeypatch):
    """A square a b c d with a dead end e east of b, as an atlas."""
    monkeypatch.chdir(tmp_path)
    plane = PlaneMap.from_geometry(
        [(0, 0), (2, 0), (2, 1), (0, 1), (3, 0)], [(0, 1), (1, 2), (2, 3), (3, 0), (1, 4)], vertex_names="abcde"
    )
    with Atlas.from_map(plane, "yard.atlas") as atlas:
        atlas.name("square", "cycle:a,b,c,d")
    return plane


def log(*lines, header=HEADER, name="walk.jsonl"):
    Path(name).write_text("\n".join([header, *lines]) + "\n")
    return name


NINEFOLD = str(Path(sys.executable).parent / "ninefold")
PLACE = '{"place": null}'


def answer(capsys, *arguments, code=0):
    assert run(["locate", "yard.atlas", *arguments]) == code
    return capsys.readouterr().out


def test_a_walk_is_located(yard, capsys):
    walk = log(PLACE, '{"heading": 92}', PLACE, '{"heading": 357}', '{"place": null, "exits": [180, 270]}')
    out = answer(capsys, walk, "--inside", "square", "--inside", "vertex:c")
    assert out.splitlines() == [
        "yard.atlas: where the robot can be after 2 moves: certain",
        "         100 %  c, come from b by 1",
        "inside 'square': 0 %; on its boundary: 100 %",
        "inside 'vertex:c': 100 %; on its boundary: 0 %",
    ]


def test_json_has_the_keys_of_the_contract(yard, capsys):
    walk = log('{"place": null, "exits": [90, 0]}', '{"heading": 90}', '{"place": null}')
    found = json.loads(answer(capsys, walk, "--json", "--inside", "square"))
    assert found["candidates"] == [{"vertex": "b", "dart": 1, "probability": pytest.approx(1)}]
    assert (found["certain"], found["moves"], found["best_move"], found["more"]) == (True, 1, None, 0)
    assert found["inside"] == {"square": {"inside": 0.0, "boundary": pytest.approx(1)}}
    found = json.loads(answer(capsys, log('{"place": null}'), "--json", "--top", "2"))
    assert [one["dart"] for one in found["candidates"]] == [None, None]
    assert found["more"] == 3
    assert found["bits"] == pytest.approx(np.log2(5), abs=1e-6)


def test_the_best_move_is_told_in_the_unit_of_the_log(yard, capsys):
    header = '{"ninefold": "walk", "version": 1, "heading": "bearing-deg", "compass": false}'
    walk = log('{"place": null, "exits": [30, 120]}', header=header)
    found = json.loads(answer(capsys, walk, "--json"))
    assert sorted(one["vertex"] for one in found["candidates"]) == ["a", "c", "d"]
    assert found["best_move"]["heading"] == pytest.approx((30, 120)[found["best_move"]["exit"]])
    assert "best move: the exit at bearing 30 deg, which leaves 1.67 of 3 candidates in expectation" in answer(capsys, walk)


def test_nowhere_is_an_answer(yard, capsys):
    walk = log(PLACE, '{"heading": 90}', "", '{"place": null, "exits": [0, 120]}', PLACE)
    out = answer(capsys, walk, "-o", "no.svg", code=1)
    assert out == (
        "nowhere: walk.jsonl, line 5: after 0 looks and 1 move no place is left: none of the 3 places possible before "
        "fits 2 exits at bearing 120, 0 deg with the way back at bearing 270 deg; nearest comes 'c', its headings off by "
        "90 deg; either the map is wrong or the noise model is (sigma 5 degrees)\n"
    )
    assert not Path("no.svg").exists()
    found = json.loads(answer(capsys, walk, "--json", code=1))
    assert found["candidates"] == []
    assert "no place is left" in found["reason"]


def test_sigma_is_declared_by_option_or_header(yard, capsys):
    lines = (PLACE, '{"heading": 70}', PLACE)
    assert "candidates" in answer(capsys, log(*lines), "--sigma", "10")
    declared = HEADER[:-1] + f', "sigma": {radians(1)}}}'
    assert "sigma 1 degrees" in answer(capsys, log(*lines, header=declared), code=1)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["walk.jsonl", "--sigma", "0"], "--sigma is in degrees, above 0 and at most 60, not 0"),
        (["walk.jsonl", "--sigma", "61"], "--sigma is in degrees, above 0 and at most 60, not 61"),
        (["walk.jsonl", "--sigma", "nan"], "--sigma is in degrees"),
        (["walk.jsonl", "--inside", "hall"], "hall"),
        (["walk.jsonl", "-o", "belief.png"], "pictures are SVG"),
        (["none.jsonl"], "none.jsonl"),
        (["yard.atlas"], "yard.atlas"),
    ],
)
def test_bad_input_is_one_line(yard, capsys, arguments, message):
    log(PLACE)
    assert run(["locate", "yard.atlas", *arguments]) == 2
    said = capsys.readouterr().err
    assert message in said
    assert len(said.strip().splitlines()) == 1


def test_bad_events_are_named_by_line(yard, capsys):
    assert run(["locate", "yard.atlas", log(PLACE, '{"heading": 0}', '{"heading": 180}', PLACE)]) == 2
    assert "walk.jsonl, line 4: successive headings" in capsys.readouterr().err


def test_a_map_without_headings_is_refused(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Atlas.from_map(PlaneMap.from_rotation({"a": ["b"], "b": ["a"]}), "yard.atlas").close()
    assert run(["locate", "yard.atlas", log(PLACE)]) == 2
    assert "has no headings" in capsys.readouterr().err


def piped(text, *arguments):
    return subprocess.run(
        [NINEFOLD, "locate", "yard.atlas", "-", *arguments],
        input=text, capture_output=True, text=True, env={**os.environ, "NO_COLOR": "1"},
    )  # fmt: skip


def test_a_walk_on_standard_input_is_followed(yard):
    lines = [HEADER, PLACE, '{"heading": 90}', PLACE, '{"heading": 90}', PLACE]
    done = piped("\n".join(lines), "--follow")
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[:3] == [
        "0 moves: a 20 %, of 5 candidates",
        "1 move: b 33 %, of 3 candidates",
        "2 moves: e 100 %",
    ]
    done = piped("\n".join(lines), "--follow", "--json")
    told = [json.loads(line) for line in done.stdout.splitlines()]
    assert [one["moves"] for one in told] == [0, 1, 2]
    done = piped("\n".join([HEADER, PLACE, "nonsense"]), "--follow")
    assert done.returncode == 2
    assert "standard input, line 3: not JSON" in done.stderr
    assert piped("").returncode == 2


def test_following_tells_before_the_walk_ends(yard):
    """The answer for the first place is there while the robot still stands at it."""
    with subprocess.Popen(
        [NINEFOLD, "locate", "yard.atlas", "-", "--follow"],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
    ) as robot:  # fmt: skip
        robot.stdin.write(f'{HEADER}\n{{"place": null, "exits": [270, 0, 90]}}\n')
        robot.stdin.flush()
        assert robot.stdout.readline() == "0 moves: b 100 %\n"
        robot.stdin.close()
        assert robot.wait(timeout=60) == 0


def test_a_picture_marks_where_it_can_be(yard, capsys):
    out = answer(capsys, log('{"place": null}', '{"heading": 90}', '{"place": null}'), "-o", "belief.svg")
    assert "belief.svg: a picture of it" in out
    svg = Path("belief.svg").read_text()
    assert svg.count('class="belief1"') == 4  # b, c, e and the legend
    assert "10 to 50 %: 3 places" in svg
    assert "yard: where the robot can be after 1 move" in svg
    assert ">b: 33 %</text>" in svg


def test_pictures_take_probabilities_of_the_places(yard):
    drawing = draw(yard)
    robot = Localizer(yard, sigma=0.1)
    assert "20 %" in drawing.to_svg(belief=robot.probabilities)
    assert "belief0" not in drawing.to_svg()
    sure = drawing.to_svg(belief=[0, 0, 1, 0, 0], theme="dark")
    assert "the robot is as good as certainly at c, 100\N{NO-BREAK SPACE}%" in sure
    for wrong in ([1, 0], [0.5] * 5, [-1, 1, 1, 0, 0], "abcde", [float("nan")] * 5):
        with pytest.raises(BadInput, match="belief"):
            drawing.to_svg(belief=wrong)


def test_a_large_map_names_only_places_that_stand_out():
    n = 12
    points = [(x, y) for y in range(n) for x in range(n)]
    edges = [(i, i + 1) for i in range(n * n) if (i + 1) % n] + [(i, i + n) for i in range(n * n - n)]
    plane = PlaneMap.from_geometry(points, edges)
    even = draw(plane).to_svg(belief=np.full(n * n, 1 / n**2))
    assert "all about as likely; 7.2 bits are open" in even
    assert 'class="name"' not in even
    p = np.full(n * n, 0.2 / (n * n - 1))
    p[40] = 0.8
    svg = draw(plane).to_svg(belief=p)
    assert svg.count("<text") == 5 or svg.count(">40: 80 %</text>") == 1


def test_standard_input_is_read_in_this_process_too(yard, capsys, monkeypatch):
    class Stream:
        buffer = io.BytesIO(f"{HEADER}\n\n{PLACE}\n".encode())

    monkeypatch.setattr("sys.stdin", Stream)
    assert "5 candidates" in answer(capsys, "-")
