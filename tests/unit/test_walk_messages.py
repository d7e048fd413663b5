"""What a user reads about a walk that makes no map: lines of the file, the file's own unit, and what to do."""

import json
import math

import pytest

import ninefold as nf
from ninefold.errors import AmbiguousDart, NotPlane, WalkError
from ninefold.io.walks.mapped import line_of_event
from ninefold.mapping import Heading, Mapper, Samples, Visit, WalkHeader
from ninefold.mapping.robot.units import unit_of


@pytest.fixture
def log(tmp_path):
    def write(unit, *lines, tolerance=0.02):
        path = tmp_path / "walk.jsonl"
        header = {"ninefold": "walk", "version": 1, "heading": unit, "tolerance": tolerance}
        path.write_text("\n".join(line if isinstance(line, str) else json.dumps(line) for line in (header, *lines)) + "\n")
        return path

    return write


def at(place, *exits):
    return {"place": place, "exits": list(exits)} if exits else {"place": place}


def along(*headings):
    return {"headings": list(headings)}


def test_lines_of_the_file_and_its_own_bearings(log):
    path = log("bearing-deg", at("A", 90, 45), "", along(90), at("B"), along(270), at("A"), "  ", along(0), at("C"))
    with pytest.raises(WalkError) as caught:
        nf.read_map(path)
    assert str(caught.value) == (
        f"{path}, line 10: the leg leaves 'A' at bearing 0 deg, along none of its 2 exits; exits seen: 90, 45 deg"
    )
    assert caught.value.event == 7
    assert line_of_event(path, 7) == 10


@pytest.mark.parametrize(
    ("unit", "headings", "said"),
    [
        ("bearing-deg", (90, 45, 0), "at bearing 0 deg, along none of its 2 exits; exits seen: 90, 45 deg"),
        ("yaw-deg", (0, 45, 90), "at 90 deg, along none of its 2 exits; exits seen: 0, 45 deg"),
        ("yaw-rad", (0, 0.7854, 1.5708), "at 1.571 rad, along none of its 2 exits; exits seen: 0, 0.7854 rad"),
    ],
)
def test_every_unit(log, unit, headings, said):
    a, b, c = headings
    path = log(unit, at("A", a, b), along(c), at("C"))
    with pytest.raises(WalkError, match="line 4: ") as caught:
        nf.read_map(path)
    assert said in str(caught.value)


def test_noise_above_the_tolerance_is_named(log):
    path = log("bearing-deg", at("A"), along(90), at("B", 270), along(273), at("A"))
    with pytest.raises(WalkError) as caught:
        nf.read_map(path)
    assert str(caught.value).endswith(
        "at bearing 273 deg, along none of its 1 exit; exits seen: 270 deg; "
        "known edge 'e0' leaves 'B' only 3 deg from this heading: raise --tolerance (radians) to 0.055"
    )
    assert nf.read_map(path, tolerance=0.055).n_edges == 1


def test_noise_in_the_way_back_in_exits_and_in_a_known_edge(log):
    back = log("bearing-deg", at("A"), along(90), at("B"), along(270, 267), at("A"))
    with pytest.raises(WalkError, match=r"known edge 'e0' leaves 'A' only 3 deg from this heading|reaches 'A' only 3 deg"):
        nf.read_map(back)
    assert nf.read_map(back, tolerance=0.055).n_edges == 1
    exits = log("bearing-deg", at("A", 0, 90), along(90), at("B"), along(270), at("A", 0, 93))
    with pytest.raises(
        WalkError, match=r"two places with one name\?; they differ by at most 3 deg: raise --tolerance .* 0.055"
    ):
        nf.read_map(exits)
    assert nf.read_map(exits, tolerance=0.055).n_edges == 1
    shown = log("bearing-deg", at("A"), along(90), at("B"), along(270), at("A", 0, 93))
    with pytest.raises(WalkError, match=r"do not show edge 'e0' at bearing 90 deg.*; the nearest exit is only 3 deg"):
        nf.read_map(shown)


def test_a_wide_miss_is_not_called_noise(log):
    path = log("bearing-deg", at("A"), along(90), at("B", 270), along(300), at("A"))
    with pytest.raises(WalkError) as caught:
        nf.read_map(path)
    assert "tolerance" not in str(caught.value)


def test_an_edge_walked_twice_with_too_much_noise_is_doubted(log):
    path = log("bearing-deg", at("A"), along(90), at("B"), along(273, 267), at("A"))
    mapper = Mapper(nf.read_walk(path).header)
    for event in nf.read_walk(path).events:
        mapper.step(event)
    assert mapper.n_edges == 2
    (warning,) = mapper.warnings
    assert warning.startswith(
        "edges 'e0' and 'e1' both join 'A' and 'B', and may be one edge; where they meet them they are "
    )
    assert warning.endswith("at most 3 deg apart: raise --tolerance (radians) to 0.055")


def test_errors_of_every_kind_keep_their_type_and_say_the_line(log):
    thin = log("bearing-deg", at("A"), along(90), at("B"), along(273), at("A"))
    with pytest.raises(NotPlane, match=r"cannot be drawn.*; known edge 'e0' leaves 'B' only 3 deg from this heading"):
        nf.read_map(thin)
    near = log("bearing-deg", at("A"), along(90), at("B"), along(270), at("A"), along(92), at("C"))
    with pytest.raises(AmbiguousDart, match=r"walk\.jsonl, line 8: .* too close to edge 'e0' at bearing 90 deg") as caught:
        nf.read_map(near)
    assert caught.value.event == 7
    half = log("bearing-deg", at("A"), along(90, 270), at("B"))
    with pytest.raises(WalkError, match=r"line 3: successive headings bearing 90 deg and bearing 270 deg differ"):
        nf.read_map(half)
    loop = log("yaw-deg", at("0"), along(0), at("1"), along(0), at("2"), along(2), at("0"))
    with pytest.raises(NotPlane, match=r"line 8: the leg from '2' to '0' cannot be drawn"):
        nf.read_map(loop)


def test_a_mapper_without_a_log_speaks_degrees_and_counts_events():
    mapper = Mapper()
    mapper.step(Visit("A", (Heading.from_degrees(0),)))
    mapper.step(Samples((math.pi / 2,)))
    with pytest.raises(WalkError, match=r"^event 3: the leg leaves 'A' at 90 deg, .* exits seen: 0 deg"):
        mapper.step(Visit("B"))
    assert mapper.n_events == 2
    east = Mapper(WalkHeader("bearing-deg"))
    east.step(Visit("A", (Heading.from_degrees(0),)))
    assert east.warnings == ("1 exit was never travelled, the first at 'A', bearing 90 deg",)
    assert east.fork().warnings == east.warnings


def test_bearings_are_written_below_360():
    unit = unit_of("bearing-deg")
    assert unit.heading(math.radians(90.0 + 1e-9)) == "bearing 0 deg"
    assert unit.heading(math.radians(90.0) - 1e-18) == "bearing 0 deg"
    assert unit.headings([]) == "none"


def test_a_log_that_changed_meanwhile_has_no_line(log, tmp_path):
    path = log("yaw-deg", at("A"))
    assert line_of_event(path, 5) is None
    assert line_of_event(tmp_path / "gone", 1) is None
