"""Walk logs: what is read, what is refused with which line, and that writing is whole or nothing."""

import errno
import json
import math
import os
import subprocess
import sys
from dataclasses import replace

import pytest

from ninefold.errors import AmbiguousDart, NinefoldError, WalkError
from ninefold.io.walks.json_lines import WalkReader, iter_events, read_header, read_walk, write_walk
from ninefold.mapping import Heading, Mapper, Samples, Visit, Walk, WalkHeader
from ninefold.mapping.robot.walk import checked_drift, checked_sigma

try:
    import resource
except ImportError:
    resource = None

HEADER = '{"ninefold": "walk", "version": 1, "heading": "yaw-rad"}'


@pytest.fixture
def log(tmp_path):
    """Write lines to a file, return its path."""

    def write(*lines, header=HEADER, end="\n"):
        path = tmp_path / "log.jsonl"
        data = [line if isinstance(line, bytes) else line.encode() for line in ([header] if header else []) + list(lines)]
        path.write_bytes(b"\n".join(data) + end.encode())
        return path

    return write


def test_every_kind_of_event(log):
    path = log(
        '{"place": "hall", "exits": [0, 1.5], "t": 0, "colour": "red"}',
        '{"heading": 0}',
        '{"headings": [0.5, 1], "t": 2}',
        "",
        '{"place": 7, "edge": "door", "t": 2.5}',
        '{"heading": -1.25}',
        '{"place": null}',
    )
    events = (
        Visit("hall", (Heading(0), Heading(1.5)), t=0.0),
        Samples((0.0,)),
        Samples((0.5, 1.0), 2.0),
        Visit("7", edge="door", t=2.5),
        Samples((-1.25,)),
        Visit(None),
    )
    assert read_walk(path) == Walk(WalkHeader(), events)
    assert tuple(iter_events(path)) == events


def test_the_header_is_kept(log):
    path = log(header='{"ninefold":"walk","version":1,"heading":"bearing-deg","compass":false,"tolerance":0.1,"robot":"r2"}')
    assert read_walk(path).header == WalkHeader("bearing-deg", compass=False, tolerance=0.1, extra={"robot": "r2"})
    assert read_header(path) == read_walk(path).header
    assert read_walk(path, tolerance=0.05).header.tolerance == 0.05


def test_declared_noise_is_read_and_written(log, tmp_path):
    path = log(
        header='{"ninefold":"walk","version":1,"heading":"bearing-deg","sigma":0.035,"drift":0,"exits":"in-order","robot":"r2"}'
    )
    header = read_walk(path).header
    assert header == WalkHeader("bearing-deg", sigma=0.035, drift=0.0, exits="in-order", extra={"robot": "r2"})
    assert read_walk(path, tolerance=0.05).header == replace(header, tolerance=0.05)
    write_walk(Walk(header, (Visit("a"),)), tmp_path / "again.jsonl")
    assert read_header(tmp_path / "again.jsonl") == header
    first = json.loads((tmp_path / "again.jsonl").read_text().splitlines()[0])
    assert (first["sigma"], first["drift"], first["exits"]) == (0.035, 0.0, "in-order")


def test_a_header_that_declares_nothing_is_written_as_ever(tmp_path):
    write_walk(Walk(WalkHeader(), ()), tmp_path / "w.jsonl")
    assert list(json.loads((tmp_path / "w.jsonl").read_text())) == ["ninefold", "version", "heading", "compass", "tolerance"]
    silent = '{"ninefold":"walk","version":1,"heading":"yaw-rad","sigma":null,"drift":null,"exits":"any-order"}'
    (tmp_path / "w.jsonl").write_text(silent)
    assert read_header(tmp_path / "w.jsonl") == WalkHeader()


def test_exits_in_a_near_tie_are_evidence_where_sigma_is_declared(log):
    line = '{"place": "a", "exits": [2, 1.01, 1, 3.14, -3.14]}'
    declared = HEADER.replace("}", ', "sigma": 0.05}')
    walk = read_walk(log(line, header=declared))
    assert [heading.yaw for heading in walk.events[0].exits] == [2, 1.01, 1, 3.14, -3.14]
    with pytest.raises(AmbiguousDart, match=r"event 1: .*within the tolerance"):  # the exact mapper takes no notice of sigma
        Mapper(walk.header).step(walk.events[0])
    with pytest.raises(WalkError, match="line 2: two exits"):
        read_walk(log(line, header=HEADER.replace("}", ', "drift": 0.05, "exits": "in-order"}')))


@pytest.mark.parametrize(
    ("unit", "east", "north"), [("yaw-rad", 0, math.pi / 2), ("yaw-deg", 0, 90), ("bearing-deg", 90, 0)]
)
def test_units(log, unit, east, north):
    path = log(
        json.dumps({"place": "a", "exits": [north]}),
        json.dumps({"heading": east}),
        json.dumps({"headings": [north, east]}),
        header=json.dumps({"ninefold": "walk", "version": 1, "heading": unit}),
    )
    visit, one, two = read_walk(path).events
    assert visit.exits[0].yaw == pytest.approx(math.pi / 2)
    assert one.yaw == pytest.approx((0.0,))
    assert two.yaw == pytest.approx((math.pi / 2, 0.0))


@pytest.mark.parametrize(
    "line",
    [
        b'\xef\xbb\xbf{"ninefold": "walk", "version": 1, "heading": "yaw-rad"}',
        f"  {HEADER}  ",
        f"\n\n{HEADER}",
        f"{HEADER}\r",
    ],
)
def test_a_byte_order_mark_and_white_space_are_let_pass(log, line):
    assert read_walk(log('{"place": "a"}\r', header=line, end="")).places == ("a",)


@pytest.mark.parametrize(
    ("header", "message"),
    [
        ("", "the file is empty|the first line is no walk header"),
        ('{"place": "a"}', "log.jsonl, line 1: the first line is no walk header"),
        ('{"ninefold": "atlas", "version": 1, "heading": "yaw-rad"}', "the first line is no walk header"),
        ("[]", r"log.jsonl, line 1: a line holds one JSON object, not \[\]"),
        ("walk", "log.jsonl, line 1: not JSON: Expecting value at column 1"),
        ('{"ninefold": "walk", "version": 2, "heading": "yaw-rad"}', "format version 2, newer than 1; update ninefold"),
        ('{"ninefold": "walk", "version": "1", "heading": "yaw-rad"}', "\"version\" is 1, not '1'"),
        ('{"ninefold": "walk", "version": 0, "heading": "yaw-rad"}', '"version" is 1, not 0'),
        ('{"ninefold": "walk", "version": true, "heading": "yaw-rad"}', '"version" is 1, not True'),
        ('{"ninefold": "walk", "heading": "yaw-rad"}', '"version" is 1, not None'),
        ('{"ninefold": "walk", "version": 1}', 'the header lacks "heading"'),
        ('{"ninefold": "walk", "version": 1, "heading": "rad"}', "'bearing-deg', not 'rad'"),
        ('{"ninefold": "walk", "version": 1, "heading": ["rad"]}', r"\"heading\" cannot be \['rad'\]"),
        ('{"ninefold": "walk", "version": 1, "heading": "yaw-rad", "compass": "yes"}', '"compass" is true or false'),
        ('{"ninefold": "walk", "version": 1, "heading": "yaw-rad", "tolerance": 2}', "a tolerance is an angle"),
        ('{"ninefold": "walk", "version": 1, "heading": "yaw-rad", "tolerance": NaN}', "NaN is no number"),
        ('{"ninefold": "walk", "version": 1, "heading": "yaw-rad", "tolerance": 1e-999}', "a tolerance is an angle"),
        *[
            (f'{{"ninefold": "walk", "version": 1, "heading": "yaw-rad", "{key}": {value}}}', f"line 1: {message}")
            for key, value, message in (
                ("sigma", 0, "sigma is the standard deviation of a heading in radians, .* for 2 degrees, not 0$"),
                ("sigma", -0.1, "sigma is .* not -0.1$"),
                ("sigma", 1.05, "sigma is .* at most 1.047 .60 degrees., .* not 1.05$"),
                ("sigma", '"2 deg"', "sigma is .* not '2 deg'$"),
                ("sigma", "true", "sigma is .* not True$"),
                ("sigma", "1" + "0" * 400, "sigma is .* not 1000"),
                ("sigma", "[0.1]", 'the header\'s "sigma" cannot be'),
                ("sigma", "NaN", "NaN is no number"),
                ("drift", -0.1, "drift is .* from 0 to 3.1416 .180 degrees., .* not -0.1$"),
                ("drift", 3.15, "drift is .* not 3.15$"),
                ("drift", "1e999", "drift is .* not inf$"),
                ("drift", "false", "drift is .* not False$"),
                ("exits", '"ccw"', "the header's \"exits\" is 'any-order' or 'in-order', not 'ccw'$"),
                ("exits", "null", "the header's \"exits\" is 'any-order' or 'in-order', not None$"),
                ("exits", '["in-order"]', 'the header\'s "exits" cannot be'),
            )
        ],
    ],
)
def test_headers_refused(log, header, message):
    path = log('{"place": "a"}' if header else "", header=header)
    for read in (read_walk, read_header, lambda p: list(iter_events(p))):
        with pytest.raises(WalkError, match=message) as caught:
            read(path)
        assert "\n" not in str(caught.value)


A = '{"place": "a"}'
H = '{"heading": 1}'


@pytest.mark.parametrize(
    ("lines", "line", "message"),
    [
        ([A, "{"], 3, "not JSON: Expecting property name"),
        ([A, '{"heading": }'], 3, "not JSON: Expecting value at column 13"),
        ([A, '{"heading": 1} {"heading": 2}'], 3, "not JSON: Extra data at column 16"),
        ([A, '{"heading": ' + "9" * 5000 + "}"], 3, "too many digits"),
        ([A, '{"heading": ' + "[" * 100_000], 3, "nested too deeply"),
        ([A, b'{"heading": "\xff"}'], 3, "not UTF-8 text"),
        ([A, b"\x00\x01\x02"], 3, "not JSON"),
        ([A, "3"], 3, "a line holds one JSON object, not 3"),
        ([A, '{"site": "b"}'], 3, 'an event has "place", "heading" or "headings"; this one has \'site\''),
        ([A, "{}"], 3, "this one has nothing"),
        ([A, '{"heading": NaN}'], 3, "NaN is no number that a walk can hold; headings are finite"),
        ([A, '{"heading": -Infinity}'], 3, "-Infinity is no number"),
        ([A, '{"heading": 1e999}'], 3, '"heading" is not finite'),
        ([A, '{"heading": ' + "9" * 400 + "}"], 3, '"heading" is not finite'),
        ([A, '{"heading": true}'], 3, '"heading" is a number, not True'),
        ([A, '{"heading": "north"}'], 3, "\"heading\" is a number, not 'north'"),
        ([A, '{"heading": null}'], 3, '"heading" is a number, not None'),
        ([A, '{"headings": []}'], 3, '"headings" is an empty list'),
        ([A, '{"headings": 1}'], 3, '"headings" is a list of numbers, not 1'),
        ([A, '{"headings": [1, "2"]}'], 3, '"headings" is a list of numbers, not'),
        ([A, '{"headings": [1, -1e999]}'], 3, '"headings" holds a number that is not finite'),
        ([A, '{"heading": 1, "headings": [1]}'], 3, "give one of them"),
        (['{"place": "a", "heading": 1}'], 2, "a place and a heading on one line"),
        (['{"place": 1.5}'], 2, '"place" is a name, not 1.5'),
        (['{"place": true}'], 2, '"place" is a name, not True'),
        (['{"place": ["a"]}'], 2, '"place" is a name, not'),
        (['{"place": ""}'], 2, "a vertex name is printable text"),
        (['{"place": "a\\u0007"}'], 2, "a vertex name is printable text"),
        (['{"place": "\\ud800"}'], 2, "cannot be written as text"),
        ([A, H, '{"place": "b", "edge": {}}'], 4, '"edge" is a name, not'),
        (['{"place": "a", "exits": 1}'], 2, '"exits" is a list of numbers'),
        (['{"place": "a", "exits": [1e999]}'], 2, '"exits" holds a number that is not finite'),
        (
            ['{"place": "a", "exits": [1, 2, 1.01]}'],
            2,
            "two exits, 1 rad and 1.01 rad, are within the tolerance of 0.02 rad",
        ),
        (['{"place": "a", "exits": [3.14, -3.14]}'], 2, "two exits, .* are within the tolerance"),
        (['{"place": "a", "t": "noon"}'], 2, "\"t\" is a number of seconds, not 'noon'"),
        (['{"place": "a", "t": 1e999}'], 2, '"t" is not finite'),
        (['{"place": "a", "t": 1' + "0" * 400 + "}"], 2, '"t" is not finite'),
        (['{"place": "a", "t": 5}', '{"heading": 1, "t": 4.5}'], 3, '"t" goes back from 5 to 4.5: events out of order'),
        ([H], 2, "a heading before the first place"),
        ([A, '{"place": "b"}'], 3, "two places with no heading between them"),
    ],
)
def test_lines_refused(log, lines, line, message):
    with pytest.raises(WalkError, match=message) as caught:
        read_walk(log(*lines))
    assert caught.value.where.endswith(f"log.jsonl, line {line}")
    assert str(caught.value).startswith(caught.value.where)
    assert "\n" not in str(caught.value)


def test_blank_lines_count_in_line_numbers(log):
    with pytest.raises(WalkError, match=r"log\.jsonl, line 5: "):
        read_walk(log("", A, "", "nonsense"))


def test_no_file_no_folder_no_name(tmp_path):
    with pytest.raises(WalkError, match=r"missing\.jsonl: the walk cannot be read: No such file or directory"):
        read_walk(tmp_path / "missing.jsonl")
    with pytest.raises(WalkError, match="cannot be read: Is a directory"):
        read_walk(tmp_path)
    with pytest.raises(WalkError, match="cannot be read"):
        read_walk("a\0b")
    empty = tmp_path / "empty.jsonl"
    empty.touch()
    with pytest.raises(WalkError, match=r"empty\.jsonl: the file is empty; a walk begins with a header line"):
        read_walk(empty)


WALK = Walk(
    WalkHeader(extra={"robot": "r2", "über": [1, None]}),
    (
        Visit("hall", (Heading(0.1), Heading(-3.0)), t=1.0),
        Samples((0.1, 2 / 3, 7.5)),
        Visit("größer", (), "door\u2028", 3.5),
        Samples((1e-300,), 4.0),
        Visit(None),
    ),
)


def test_writing_and_reading_gives_the_same_walk(tmp_path):
    path = tmp_path / "walk.jsonl"
    write_walk(WALK, path)
    assert read_walk(path) == WALK
    assert [p.name for p in tmp_path.iterdir()] == ["walk.jsonl"]


@pytest.mark.parametrize("unit", ["yaw-deg", "bearing-deg"])
def test_degrees_survive_to_rounding(tmp_path, unit):
    path = tmp_path / "walk.jsonl"
    write_walk(Walk(WalkHeader(unit), WALK.events), path)
    again = read_walk(path)
    assert again.header.heading == unit
    assert again.places == WALK.places
    assert [h.yaw for h in again.events[0].exits] == pytest.approx([h.yaw for h in WALK.events[0].exits], abs=1e-14)
    turned = [(a - b) / (2 * math.pi) for a, b in zip(again.events[1].yaw, WALK.events[1].yaw, strict=True)]
    assert turned == pytest.approx([round(x) for x in turned], abs=1e-14)


def test_a_reader_can_go_on_from_a_header_stored_elsewhere():
    reader = WalkReader("atlas", header=WalkHeader("bearing-deg"))
    assert reader.take(b'{"place": "a", "exits": [90]}') == Visit("a", (Heading(0.0),))


def test_an_old_file_stays_when_the_new_one_cannot_be_written(tmp_path, monkeypatch):
    path = tmp_path / "walk.jsonl"
    path.write_text("precious")

    def full(descriptor):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(WalkError, match=r"walk\.jsonl: cannot be written \(No space left on device\); nothing was changed"):
        write_walk(WALK, path)
    assert path.read_text() == "precious"
    assert [p.name for p in tmp_path.iterdir()] == ["walk.jsonl"]


@pytest.mark.skipif(resource is None, reason="needs POSIX limits")
def test_a_file_that_may_not_grow_for_real(tmp_path):
    script = (
        "import resource, sys; from ninefold.errors import WalkError; from ninefold.io.walks.json_lines import write_walk;"
        "from ninefold.mapping import *; walk = Walk(WalkHeader(), [Visit('a'), Samples((0.0,) * 10_000), Visit('b')]);"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))\n"
        "try: write_walk(walk, sys.argv[1])\n"
        "except WalkError as error: print(error)"
    )
    path = tmp_path / "walk.jsonl"
    path.write_text("precious")
    ran = subprocess.run([sys.executable, "-c", script, str(path)], capture_output=True, text=True, check=True)
    assert ran.stdout == f"{path}: cannot be written (File too large); nothing was changed\n"
    assert path.read_text() == "precious"
    assert [p.name for p in tmp_path.iterdir()] == ["walk.jsonl"]


def test_a_folder_that_does_not_exist(tmp_path):
    with pytest.raises(WalkError, match=r"the folder .*nowhere does not exist"):
        write_walk(WALK, tmp_path / "nowhere" / "walk.jsonl")


@pytest.mark.skipif(resource is None, reason="needs POSIX permissions")
def test_a_folder_that_is_read_only(tmp_path):
    script = (
        "import os, sys; from ninefold.errors import WalkError; from ninefold.io.walks.json_lines import write_walk;"
        "from ninefold.mapping import *; walk = Walk(WalkHeader(), [Visit('a')])\n"
        "if os.geteuid() == 0: os.seteuid(65534)  # the superuser may write everywhere\n"
        "try: write_walk(walk, sys.argv[1])\n"
        "except WalkError as error: print(error)"
    )
    folder = tmp_path / "locked"
    folder.mkdir(mode=0o555)
    path = folder / "walk.jsonl"
    ran = subprocess.run([sys.executable, "-c", script, str(path)], capture_output=True, text=True, check=True)
    assert ran.stdout == f"{path}: cannot be written (Permission denied); nothing was changed\n"


@pytest.mark.parametrize(
    "walk",
    [
        Walk(WalkHeader(extra={"x": object()}), ()),
        Walk(WalkHeader(extra={"x": math.nan}), ()),
        Walk(WalkHeader(), (Visit("\ud800"),)),
        Walk(WalkHeader(), (Visit("a", t=math.inf),)),
    ],
)
def test_what_no_reader_would_take_is_not_written(tmp_path, walk):
    with pytest.raises(NinefoldError, match="cannot be written"):
        write_walk(walk, tmp_path / "walk.jsonl")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("unit", "limit"), [("yaw-deg", "4.81e+08 deg"), ("bearing-deg", "4.81e+08 deg"), ("yaw-rad", "8.39e+06 rad")]
)
@pytest.mark.parametrize("line", ['{"heading": 1e300}', '{"headings": [0, -1e300]}', '{"place": "a", "exits": [1e300, 0]}'])
def test_numbers_too_large_for_an_angle_are_named_with_their_line(tmp_path, unit, limit, line):
    path = tmp_path / "w.jsonl"
    first = "" if "place" in line else '{"place": "a"}\n'
    path.write_text(f'{{"ninefold": "walk", "version": 1, "heading": "{unit}"}}\n{first}{line}\n')
    where = 2 if "place" in line else 3
    with pytest.raises(WalkError) as caught:
        read_walk(path)
    assert f"line {where}: " in str(caught.value)
    assert f"too large for an angle: {'-' if '-1' in line else ''}1e+300, and angles go up to {limit}" in str(caught.value)


def test_the_limits_of_declared_noise():
    assert checked_sigma(math.radians(60)) == math.radians(60)
    assert checked_sigma(1) == 1.0
    assert isinstance(checked_sigma(1), float)
    assert (checked_drift(0), checked_drift(math.pi)) == (0.0, math.pi)
    for value in (0, -1, math.radians(60.001), math.nan, math.inf, True, None, "1"):
        with pytest.raises(WalkError, match="sigma is the standard deviation"):
            checked_sigma(value)
    for value in (-1e-9, math.radians(180.001), math.nan, math.inf, False, None, "1"):
        with pytest.raises(WalkError, match="drift is the standard deviation"):
            checked_drift(value)
