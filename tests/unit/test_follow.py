"""A walk on standard input: followed line by line into an atlas, or read whole; what a kill, Ctrl-C or a bad line leaves."""

from __future__ import annotations

import io
import json
import random
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing
from itertools import pairwise

import pytest

from ninefold import cli
from ninefold.cli import follow
from ninefold.errors import AtlasError, BadInput, NotPlane, WalkError
from ninefold.io import Atlas, read_walk, samples
from ninefold.io.atlas.feed import Feed
from ninefold.io.walks.json_lines import write_walk
from ninefold.io.walks.streams import read_stream, walk_lines
from ninefold.mapping import Mapper, Samples, Visit, WalkHeader, build, explore

FOLLOW = [sys.executable, "-c", "from ninefold.cli import main; main()", "map", "-", "--follow", "-o"]
HEADER = b'{"ninefold": "walk", "version": 1, "heading": "bearing-deg"}\n'
YARD = [
    HEADER,
    b'{"place": "gate"}\n',
    b'{"heading": 90}\n',
    b'{"place": "well"}\n',
    b'{"heading": 0}\n',
    b'{"place": "oak"}\n',
]

needs_signals = pytest.mark.skipif(sys.platform == "win32", reason="signals are a Unix thing")


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    """A walk of about 500 events: its file, and its lines."""
    path = tmp_path_factory.mktemp("log") / "walk.jsonl"
    write_walk(explore(samples.load("office").to_world(), seed=8, step=1.0, tours=10).walk, path)
    return path, path.read_bytes().splitlines(keepends=True)


@pytest.fixture
def run(capsys, monkeypatch):
    """Run a command with bytes on standard input; return exit code, stdout, stderr."""

    def runner(*arguments, given=b""):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(given)))
        code = cli.run([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        assert "Traceback" not in err
        return code, out, err

    return runner


def stored(path):
    """The number of events in an atlas, seen from outside while it is being written; -1 before there is one."""
    try:
        with closing(sqlite3.connect(f"file:{path}?mode=ro", uri=True)) as connection:
            return connection.execute("SELECT coalesce(max(seq), 0) FROM event").fetchone()[0]
    except sqlite3.OperationalError:
        return -1


def wait_for(path, count):
    for _ in range(3000):
        if stored(path) >= count:
            return
        time.sleep(0.01)
    raise AssertionError(f"{count} events never came, only {stored(path)}")


def started(path, *options):
    return subprocess.Popen([*FOLLOW, path, *options], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def send(process, lines):
    process.stdin.writelines(lines)
    process.stdin.flush()


def test_every_line_is_in_the_atlas_before_the_next(tmp_path):
    path = tmp_path / "yard.atlas"
    mapper = Mapper(WalkHeader("bearing-deg"))
    with Feed(path) as feed:
        assert feed.take(b"\n") is None
        assert not path.exists()
        assert feed.take(HEADER) is None
        assert feed.atlas.n_events == 0
        for number, line in enumerate(YARD[1:], 1):
            event = feed.take(line)
            mapper.step(event)
            assert stored(path) == number
            with Atlas.open(path, writable=False) as atlas:  # a reader beside the writer sees the map so far
                assert atlas.plane == mapper.plane
                assert atlas.walk.events[-1] == event
        assert feed.take(b"  \n") is None
        assert feed.finish().header == WalkHeader("bearing-deg")
        assert feed.finish().places == ("gate", "well", "oak")
    with Atlas.open(path) as atlas:
        assert atlas.provenance[0].source == "standard input"


def test_a_bad_line_is_named_and_leaves_the_atlas_as_it_was(tmp_path):
    bad = [
        (b'{"heading": 90', "line 7: not JSON"),
        (b'{"place": "elm"}', "line 7: two places with no heading"),
        (b'{"headings": [10, 190.0]}', "line 7: "),
    ]
    for k, (line, message) in enumerate(bad):
        with Feed(tmp_path / f"{k}.atlas", name="robot 7") as feed:
            for good in YARD:
                feed.take(good)
            with pytest.raises(WalkError, match=message) as caught:
                feed.take(line)
            assert caught.value.where == "robot 7, line 7"
            assert feed.atlas.n_events == 5


def test_what_cannot_be_in_the_plane_is_an_error_of_its_line(tmp_path):
    lines = [
        {"place": "a"},
        {"heading": 0},
        {"place": "b"},
        {"heading": 60},
        {"place": "c"},
        {"heading": 300},
        {"place": "a"},
    ]
    with Feed(tmp_path / "x.atlas") as feed:
        feed.take(HEADER.replace(b"bearing", b"yaw"))
        for line in lines[:-1]:
            feed.take(json.dumps(line).encode())
        with pytest.raises(NotPlane, match=r"^standard input, line 8: the leg from 'c' to 'a' cannot be drawn"):
            feed.take(json.dumps(lines[-1]).encode())
        assert feed.atlas.n_events == 6


def test_the_rest_of_a_walk_goes_on_where_it_stopped(tmp_path, log):
    path, (file, lines) = tmp_path / "office.atlas", log
    whole = read_walk(file)
    cuts = [0, 1, 2, 60, 61, 62, len(lines) - 1]
    for begin, end in pairwise(cuts):
        with Feed(path, resume=True) as feed:
            assert feed.kept == begin
            for line in [lines[0], *lines[1 + begin : 1 + end]]:
                feed.take(line)
    with Atlas.open(path) as atlas:
        assert (atlas.walk, atlas.plane) == (whole, build(whole))


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ({"tolerance": 0.1}, 'the header\'s "tolerance" is 0.1, but 0.02 in the walk that .* holds; a walk that goes on'),
        ({"compass": False}, '"compass" is false, but true in'),
        ({"sigma": 0.03}, '"sigma" is 0.03, but left out in'),
        ({"exits": "in-order"}, '"exits" is "in-order", but "any-order" in'),
    ],
)
def test_a_walk_that_goes_on_keeps_its_header(tmp_path, header, message):
    path = tmp_path / "yard.atlas"
    with Feed(path) as feed:
        for line in YARD:
            feed.take(line)
    with Feed(path, resume=True) as feed, pytest.raises(WalkError, match=f"standard input, line 1: .*{message}"):
        feed.take(json.dumps({**json.loads(HEADER), **header}).encode())
    assert stored(path) == 5
    with Feed(path, resume=True) as feed:  # the unit may be another
        feed.take(b'{"ninefold": "walk", "version": 1, "heading": "yaw-deg", "robot": "r2"}')
        feed.take(b'{"heading": -90}')
        feed.take(b'{"place": "well"}')
        assert feed.atlas.plane.n_edges == 2


def test_only_an_atlas_of_a_walk_goes_on(tmp_path):
    Atlas.from_map(samples.load("ring").to_map(), tmp_path / "ring.atlas").close()
    with pytest.raises(BadInput, match=r"ring\.atlas: made from a finished map, so no walk goes on in it"):
        Feed(tmp_path / "ring.atlas", resume=True)
    (tmp_path / "text.atlas").write_text("hello")
    with pytest.raises(AtlasError, match=r"text\.atlas"):
        Feed(tmp_path / "text.atlas", resume=True)
    with pytest.raises(BadInput, match="exists already"):
        Feed(tmp_path / "ring.atlas")


def test_lines_of_a_stream(tmp_path):
    assert read_stream([b"\xef\xbb\xbf" + YARD[0], *YARD[1:]]).places == ("gate", "well", "oak")
    with pytest.raises(WalkError, match="pipe 3, line 2: "):
        read_stream([HEADER, b"{"], name="pipe 3")
    with pytest.raises(WalkError, match="standard input: the file is empty; a walk begins with a header line"):
        read_stream([])
    with pytest.raises(WalkError, match="standard input: this is lines in GeoJSON, not a walk log; save it to a file"):
        list(walk_lines([b'{"type": "FeatureCollection", "features": []}']))

    def broken():
        yield HEADER
        raise OSError(5, "Input/output error")

    with pytest.raises(WalkError, match=r"standard input: cannot be read \(Input/output error\)"):
        list(walk_lines(broken()))


# -- the command -----------------------------------------------------------------------------------------------------------


def test_following_to_the_end_gives_the_usual_summary(run, tmp_path, log):
    file, lines = log
    code, out, err = run("map", "-", "--follow", "-o", tmp_path / "a.atlas", "--json", given=b"".join(lines))
    code_of_file, out_of_file, _ = run("map", file, "-o", tmp_path / "b.atlas", "--json")
    found, expected = json.loads(out), json.loads(out_of_file)
    assert code == code_of_file == 0
    assert found == {**expected, "file": str(tmp_path / "a.atlas"), "events": len(lines) - 1}
    assert err.count("\n") == 1  # what is going on, and no flood
    assert "a.atlas; its end or Ctrl-C ends this" in err
    code, out, _ = run("map", "-", "--follow", "-o", tmp_path / "a.atlas", "--force", given=b"".join(YARD))
    assert (code, out) == (0, f"{tmp_path / 'a.atlas'}: 3 vertices, 2 edges, 1 face\n")


def test_a_whole_walk_from_standard_input_is_mapped_as_a_file_is(run, tmp_path, log):
    file, lines = log
    code, out, _ = run("map", "-", "-o", tmp_path / "a.atlas", "--json", given=b"".join(lines))
    _, out_of_file, _ = run("map", file, "-o", tmp_path / "b.atlas", "--json")
    assert (code, json.loads(out)) == (0, {**json.loads(out_of_file), "file": str(tmp_path / "a.atlas")})
    with Atlas.open(tmp_path / "a.atlas") as atlas:
        assert atlas.plane == build(read_walk(file))
        assert atlas.provenance[0].source == "standard input"
    bad = [*YARD, b"\n", b'{"headings": [180, 90]}\n', b'{"place": "gate", "exits": [0]}\n']
    code, out, err = run("map", "-", "-o", tmp_path / "c.atlas", given=b"".join(bad))
    assert (code, out) == (2, "")
    assert "standard input, line 9: " in err
    assert not (tmp_path / "c.atlas").exists()


@pytest.mark.parametrize("options", [(), ("--follow",)])
@pytest.mark.parametrize("given", [b"", b"\n\n", b"nonsense", b"\xff\xfe", HEADER, HEADER + b"[]"])
def test_streams_that_are_no_walk(run, tmp_path, options, given):
    code, out, err = run("map", "-", *options, "-o", tmp_path / "a.atlas", given=given)
    assert (code, out) == (2, "")
    assert "standard input" in err.splitlines()[-1] or "before the first place" in err.splitlines()[-1]
    if given in (b"", b"nonsense") and options:
        assert "no atlas was made" in err
        assert not (tmp_path / "a.atlas").exists()
    if given.startswith(HEADER) and options:
        assert "holds no event yet, and --resume goes on from there" in err


def test_a_bad_line_ends_it_and_says_what_is_kept(run, tmp_path):
    path = tmp_path / "a.atlas"
    given = b"".join([*YARD, b'{"place": "elm"}\n', b'{"heading": 0}\n'])
    code, out, err = run("map", "-", "--follow", "-o", path, "--json", given=given)
    assert code == 2
    assert err.splitlines()[-1] == (
        "ninefold: standard input, line 7: two places with no heading between them; a leg has at least one sample; "
        f"{path} keeps the 5 events before, and --resume goes on from there"
    )
    assert json.loads(out) == {"error": err.splitlines()[-1].removeprefix("ninefold: ")}
    code, out, err = run("map", "-", "--follow", "-o", path, given=b"".join(YARD))
    assert code == 2
    assert "exists already; --resume goes on with its walk, --force replaces it" in err
    rest = b"".join([HEADER, b'{"heading": 270}\n', b'{"place": "elm"}\n'])
    code, out, err = run("map", "-", "--follow", "--resume", "-o", path, "--json", given=rest)
    assert (code, json.loads(out)["vertices"], json.loads(out)["events"]) == (0, 4, 7)
    assert "a.atlas after 5 events; its end" in err


def test_a_doubtful_header_is_named_with_the_line_that_does_not_fit(run, tmp_path):
    yard = [HEADER.replace(b"bearing-deg", b"yaw-rad"), *YARD[1:]]
    code, _, err = run("map", "-", "--follow", "-o", tmp_path / "a.atlas", given=b"".join(yard))
    doubt = "headings reach {} and the header says yaw-rad; if they are degrees, write yaw-deg or bearing-deg there"
    assert (code, err.splitlines()[-1]) == (0, f"ninefold: {doubt.format(90)}")
    yard += [b'{"heading": 180}\n', b'{"place": "well", "exits": [1]}\n']
    code, _, err = run("map", "-", "--follow", "-o", tmp_path / "b.atlas", given=b"".join(yard))
    assert code == 2
    last = err.splitlines()[-1]
    assert last.startswith("ninefold: standard input, line 8: ")
    assert f"; {doubt.format(180)}; " in last
    assert last.endswith("b.atlas keeps the 6 events before, and --resume goes on from there")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("log", "--follow"), "--follow takes a walk from standard input: `ninefold map - --follow -o ATLAS`"),
        (("-", "--resume"), "--resume is for `ninefold map - --follow`"),
        (("-", "--follow", "--resume", "--force"), "--resume goes on with the atlas that is there and --force replaces it"),
        (("-", "--follow", "--drop-crossing"), "--drop-crossing is for sources with geometry"),
        (("-", "--follow", "--tolerance", "9"), "a tolerance is an angle in radians"),
    ],
)
def test_options_that_do_not_go_together(run, tmp_path, log, arguments, message):
    given = [str(log[0]) if argument == "log" else argument for argument in arguments]
    code, _, err = run("map", *given, "-o", tmp_path / "a.atlas", given=HEADER)
    assert code == 2
    assert message in err
    assert not (tmp_path / "a.atlas").exists()


def test_standard_input_that_is_closed(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(sys, "stdin", None)
    for options in ([], ["--follow"]):
        assert cli.run(["map", "-", *options, "-o", str(tmp_path / "a.atlas")]) == 2
        assert "standard input is closed" in capsys.readouterr().err


def test_it_tells_where_the_robot_is_now_and_then(run, tmp_path, log, monkeypatch):
    clock = iter(range(10**6))
    monkeypatch.setattr(follow.time, "monotonic", lambda: next(clock) * 0.1)  # a tenth of a second a look
    code, _, err = run("map", "-", "--follow", "-o", tmp_path / "a.atlas", given=b"".join(log[1]))
    told = [line for line in err.splitlines() if line.startswith("ninefold: at '")]
    assert code == 0
    assert 2 <= len(told) <= 6  # after 2, 4, 8, 16, 30 s, however many places there were
    assert "vertices, " in told[0]
    assert told[0].endswith(" events")


# -- killed and interrupted ------------------------------------------------------------------------------------------------


@needs_signals
def test_killing_it_loses_at_most_the_event_in_flight(tmp_path, log):
    path, (file, lines) = tmp_path / "live.atlas", log
    walk, rng = read_walk(file), random.Random(5)
    reached = 0
    for _ in range(6):
        with started(path, "--resume") as process:
            sure = min(reached + rng.randint(5, 40), len(walk.events) - 1)
            send(process, [lines[0], *lines[1 + reached : 1 + sure]])
            wait_for(path, sure)  # everything sent is there while the process waits for more
            send(process, [lines[1 + sure]])
            time.sleep(rng.uniform(0.0, 0.002))
            process.kill()
        assert process.returncode == -signal.SIGKILL
        with Atlas.open(path) as atlas:
            reached = atlas.n_events
            assert sure <= reached <= sure + 1
            assert atlas.walk.events == walk.events[:reached]
            atlas.plane.validate()
    with started(path, "--resume") as process:
        out, _ = process.communicate(b"".join([lines[0], *lines[1 + reached :]]))
    assert process.returncode == 0
    assert b"live.atlas: " in out
    with Atlas.open(path, writable=False) as atlas:
        assert (atlas.walk, atlas.plane) == (walk, build(walk))


@needs_signals
def test_interrupting_it_leaves_a_whole_atlas(run, tmp_path, log):
    path, lines = tmp_path / "live.atlas", log[1]
    with started(path, "--json") as process:
        send(process, lines[:100])
        wait_for(path, 99)
        code, out, _ = run("info", path, "--json")  # somebody looks while it goes on
        assert (code, json.loads(out)["events"]) == (0, 99)
        process.send_signal(signal.SIGINT)
        out, err = process.communicate()
    assert process.returncode == 130
    assert out == b""
    assert f"interrupted; {path} keeps the 99 events before, and --resume goes on from there" in err.decode()
    with Atlas.open(path) as atlas:
        assert atlas.n_events == 99
        mapper = Mapper(atlas.walk.header)
        for event in atlas.walk.events:
            mapper.step(event)
        assert atlas.plane == mapper.plane
    assert {type(event) for event in read_walk(log[0]).events} == {Samples, Visit}
