"""Metres of legs: read, added up, averaged over passes, kept by the map and by the atlas, and never needed."""

import math
import pickle
import sqlite3

import numpy as np
import pytest

from ninefold.errors import AtlasError, BadInput, WalkError
from ninefold.io import Atlas, samples
from ninefold.io.walks.json_lines import event_to_json, read_walk, write_walk
from ninefold.io.walks.mapped import map_of_walk
from ninefold.mapping import Heading, Mapper, PlaneMap, Samples, Visit, Walk, WalkHeader, build, explore
from ninefold.mapping.robot.legs import LegReader

EAST, NORTH, SOUTHWEST, WEST = (Heading.from_bearing(b) for b in (90, 0, 225, 270))
HEADER = '{"ninefold": "walk", "version": 1, "heading": "bearing-deg"}'
NAN = math.nan


def triangle(first=12.5, second=None, third=None):
    """The events of a walk around a triangle, its legs measured or not."""
    return (
        Visit("a"),
        Samples.of(EAST, metres=first),
        Visit("b"),
        Samples.of(NORTH, metres=second),
        Visit("c"),
        Samples.of(SOUTHWEST, metres=third),
        Visit("a"),
    )


def plane_of(*events):
    return build(Walk(WalkHeader(), events))


def metres_of(plane):
    return None if plane.metres is None else [None if math.isnan(m) else m for m in plane.metres.tolist()]


# -- samples and legs --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "metres", [-1, NAN, math.inf, -math.inf, "2", True, 10**400, -(10**5000), [1]], ids=lambda m: type(m).__name__
)
def test_metres_that_are_none_are_refused(metres):
    with pytest.raises(WalkError, match="finite number that is not negative, not ") as caught:
        Samples((0.0,), metres=metres)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 200


@pytest.mark.parametrize("metres", [3, 3.0, np.float64(3)])
def test_metres_are_kept_as_a_float(metres):
    assert type(Samples((0.0,), metres=metres).metres) is float
    assert Samples.of(EAST, metres=metres) == Samples((0.0,), metres=3.0)


@pytest.mark.parametrize(
    ("takes", "metres"),
    [
        ([(1, 2.0)], 2.0),
        ([(1, None)], None),
        ([(3, 2.0)], 2.0),
        ([(3, None)], None),
        ([(1, 2.0), (2, 3.0), (1, 0.5)], 5.5),
        ([(1, 0.0), (1, 4.0)], 4.0),
        ([(1, None), (1, 4.0)], 4.0),  # the first sample is taken at the place left
        ([(1, None), (1, 4.0), (1, None)], None),
        ([(1, None), (1, None), (1, 4.0)], None),
        ([(2, None), (1, 4.0)], None),  # the second of the first two was taken on the way
        ([(1, 4.0), (1, None)], None),
        ([(1, 4.0), (1, None), (1, 4.0)], None),
    ],
)
def test_the_metres_of_a_leg_are_those_of_all_its_samples(takes, metres):
    reader = LegReader()
    for _ in range(2):  # a reader begins again after each leg
        for count, travelled in takes:
            reader.take((0.0,) * count, travelled)
        assert reader.fork().read().metres == metres
        assert reader.finish().metres == metres


def test_a_refused_sample_adds_no_metres():
    reader = LegReader()
    reader.take((0.0, 0.0), 2.0)
    with pytest.raises(WalkError, match="half a turn"):
        reader.take((math.pi,), 3.0)
    assert reader.read().metres == 2.0


def test_a_forked_reader_adds_up_its_own_metres():
    reader = LegReader()
    reader.take((0.0, 0.0), 2.0)
    other = reader.fork()
    other.take((0.0,), 1.0)
    assert (reader.read().metres, other.read().metres) == (2.0, 3.0)


@pytest.mark.parametrize("metres", [[0.0], [0.0, 0.0], [1e308, 1e308]])
def test_a_leg_without_length_is_refused_and_changes_nothing(metres):
    mapper = Mapper()
    mapper.step(Visit("a"))
    for travelled in metres:
        mapper.step(Samples.of(EAST, metres=travelled))
    with pytest.raises(WalkError, match=r"event \d: the metres of the leg add up to (0|inf), and a leg has a length"):
        mapper.step(Visit("b"))
    assert (mapper.n_vertices, mapper.n_edges) == (1, 0)


# -- the map -----------------------------------------------------------------------------------------------------------


def test_a_map_keeps_what_was_measured_and_nothing_where_nothing_was():
    assert plane_of(*triangle(None)).metres is None
    plane = plane_of(*triangle(12.5, None, 20.0))
    assert metres_of(plane) == [12.5, None, 20.0]
    assert plane.metres.dtype == np.float64
    with pytest.raises(ValueError, match="read-only"):
        plane.metres[0] = 1.0
    plane.validate()


def test_a_length_is_the_mean_of_the_passes_that_measured_it():
    mapper = Mapper()
    legs = [("b", EAST, None), ("a", WEST, 12.0), ("b", EAST, 15.0), ("a", WEST, None), ("b", EAST, 12.0)]
    means = [None, [12.0], [13.5], [13.5], [13.0]]
    mapper.step(Visit("a"))
    for (place, heading, metres), mean in zip(legs, means, strict=True):
        mapper.step(Samples.of(heading, metres=metres))
        mapper.step(Visit(place))
        assert mapper.n_edges == 1
        assert metres_of(mapper.plane) == mean


def test_a_forked_mapper_measures_on_its_own():
    mapper = Mapper()
    for event in triangle(10.0)[:3]:
        mapper.step(event)
    mapper.step(Samples.of(WEST, metres=5.0))
    fork = mapper.fork()
    fork.step(Samples.of(WEST, metres=15.0))
    fork.step(Visit("a"))
    assert (metres_of(mapper.plane), metres_of(fork.plane)) == ([10.0], [15.0])
    mapper.step(Visit("a"))
    assert metres_of(mapper.plane) == [7.5]


def darts(metres, **more):
    """A path of two edges, or with its second edge a tether."""
    return PlaneMap.from_darts([0, 1, 1, 2], [0, 2, 1, 3], metres=metres, **more)


def test_from_darts_takes_lengths():
    assert metres_of(darts([1, 2.5])) == [1.0, 2.5]
    assert metres_of(darts([NAN, 2.5])) == [None, 2.5]
    assert darts([NAN, NAN]).metres is None
    assert metres_of(darts([3.0, NAN], tether=[False, True])) == [3.0, None]
    assert metres_of(darts([3.0, -9.0], tether=[False, True])) == [3.0, None]  # as headings of tethers, left out
    assert darts([NAN, 4.0], tether=[False, True]).metres is None
    assert PlaneMap.from_darts([], [], n_vertices=1, metres=[]).metres is None
    given = np.array([1.0, 2.0])
    plane = darts(given)
    given[0] = 7.0
    assert metres_of(plane) == [1.0, 2.0]


@pytest.mark.parametrize(
    ("metres", "message"),
    [
        ([1.0], r"metres has shape \(1,\), not \(2,\)"),
        ([[1.0, 2.0]], r"metres has shape \(1, 2\), not \(2,\)"),
        (4.0, r"metres has shape \(\), not \(2,\)"),
        ([1.0, 0.0], "metres of edge '1' is 0; a length is positive and finite, NaN where unknown"),
        ([-2.0, 1.0], "metres of edge '0' is -2"),
        ([1.0, math.inf], "metres of edge '1' is inf"),
        (["far", "near"], "metres must be an array of numbers"),
    ],
)
def test_lengths_that_are_none_are_refused(metres, message):
    with pytest.raises(BadInput, match=message):
        darts(metres)


def test_lengths_are_part_of_a_map():
    plane, other, without = darts([NAN, 2.0]), darts([NAN, 3.0]), darts(None)
    assert plane == darts([NAN, 2.0])
    assert plane != other
    assert plane != without
    again = pickle.loads(pickle.dumps(plane))
    assert again == plane
    assert not again.metres.flags.writeable


def test_geometry_leaves_no_length_behind():
    assert samples.load("ring").to_map().metres is None


# -- files -------------------------------------------------------------------------------------------------------------


def write_lines(path, *lines):
    path.write_text("\n".join((HEADER, *lines)) + "\n")
    return path


def test_a_log_tells_metres_with_the_headings_of_a_leg(tmp_path):
    path = write_lines(
        tmp_path / "log.jsonl",
        '{"place": "a", "metres": null}',
        '{"heading": 90}',
        '{"headings": [90, 80], "metres": 7}',
        '{"heading": 80, "metres": 5.5, "t": 3}',
        '{"place": "b"}',
        '{"heading": 90, "metres": null}',
        '{"place": "c"}',
    )
    walk = read_walk(path)
    assert [event.metres for event in walk.events if isinstance(event, Samples)] == [None, 7.0, 5.5, None]
    assert metres_of(map_of_walk(path)) == [12.5, None]
    write_walk(walk, tmp_path / "again.jsonl")
    assert read_walk(tmp_path / "again.jsonl").events[3].metres == 5.5


def test_a_log_without_metres_is_written_without_the_key():
    header = WalkHeader()
    assert event_to_json(Samples((0.0,)), header) == {"heading": 0.0}
    assert event_to_json(Samples((0.0,), metres=2.0), header) == {"heading": 0.0, "metres": 2.0}


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ('{"heading": 90, "metres": -1}', '"metres" is negative'),
        ('{"headings": [90], "metres": -1e-9}', '"metres" is negative'),
        ('{"heading": 90, "metres": 1e999}', '"metres" is not finite'),
        ('{"heading": 90, "metres": 1' + "0" * 400 + "}", '"metres" is not finite'),
        ('{"heading": 90, "metres": NaN}', "NaN is no number"),
        ('{"heading": 90, "metres": "12 m"}', "\"metres\" is a number, not '12 m'"),
        ('{"heading": 90, "metres": true}', '"metres" is a number, not True'),
        ('{"headings": [90], "metres": [1]}', r'"metres" is a number, not \[1\]'),
        ('{"place": "b", "metres": 12.5}', '"metres" on the line of a place; give them with the headings of the leg'),
    ],
)
def test_metres_that_a_log_cannot_hold_are_refused_with_their_line(tmp_path, line, message):
    path = write_lines(tmp_path / "log.jsonl", '{"place": "a"}', '{"heading": 90}', line)
    with pytest.raises(WalkError, match=f"log.jsonl, line 4: {message}") as caught:
        read_walk(path)
    assert "\n" not in str(caught.value)


def test_a_leg_without_length_is_refused_with_its_line(tmp_path):
    path = write_lines(tmp_path / "log.jsonl", '{"place": "a"}', '{"heading": 90, "metres": 0}', '{"place": "b"}')
    with pytest.raises(WalkError, match=r"log\.jsonl, line 4: the metres of the leg add up to 0"):
        map_of_walk(path)


# -- the atlas ---------------------------------------------------------------------------------------------------------


def version_of(path):
    connection = sqlite3.connect(path)
    try:
        return connection.execute("PRAGMA user_version").fetchone()[0]
    finally:
        connection.close()


def columns_of_edges(path):
    connection = sqlite3.connect(path)
    try:
        return [row[1] for row in connection.execute("PRAGMA table_info(edge)")]
    finally:
        connection.close()


def test_an_atlas_keeps_metres_of_events_and_of_the_map(tmp_path):
    walk, path = Walk(WalkHeader(), triangle(12.5, None, 20.25)), tmp_path / "town.atlas"
    with Atlas.from_walk(walk, path) as atlas:
        assert atlas.walk == walk
    assert version_of(path) == 2
    with Atlas.open(path, writable=False) as atlas:
        assert atlas.walk == walk
        assert metres_of(atlas.plane) == [12.5, None, 20.25]
        assert atlas.plane == build(walk)
    connection = sqlite3.connect(path)
    assert connection.execute("SELECT name, metres FROM edge ORDER BY id").fetchall() == [
        ("e0", 12.5), ("e1", None), ("e2", 20.25),
    ]  # fmt: skip
    connection.close()


def test_a_map_with_metres_is_stored_as_a_whole(tmp_path):
    plane = darts([NAN, 2.5])
    with Atlas.from_map(plane, tmp_path / "map.atlas") as atlas:
        assert atlas.plane == plane
    with Atlas.open(tmp_path / "map.atlas", writable=False) as atlas:
        assert atlas.plane == plane


def test_an_atlas_without_metres_stays_readable_for_older_programs(tmp_path):
    path = tmp_path / "town.atlas"
    with Atlas.from_walk(Walk(WalkHeader(), triangle(None)), path) as atlas:
        atlas.append(Samples.of(EAST))
    assert version_of(path) == 1
    assert "metres" not in columns_of_edges(path)


def test_metres_of_a_leg_without_end_are_kept_too(tmp_path):
    walk, path = Walk(WalkHeader(), (*triangle(None)[:5], Samples.of(SOUTHWEST, metres=3.0))), tmp_path / "town.atlas"
    with Atlas.from_walk(walk, path) as atlas:
        assert (atlas.walk, atlas.plane.metres) == (walk, None)
    assert version_of(path) == 2
    with Atlas.open(path) as atlas:
        atlas.append(Visit("a"))
        assert metres_of(atlas.plane) == [None, None, 3.0]


@pytest.mark.parametrize("closed", [True, False])
def test_metres_appended_to_an_older_atlas_make_it_a_newer_one(tmp_path, closed):
    path = tmp_path / "town.atlas"
    Atlas.from_walk(Walk(WalkHeader(), triangle(None)), path).close()
    atlas = Atlas.open(path)
    atlas.append(Samples.of(EAST, metres=30.0))
    if not closed:  # the log has gone ahead of the map, as after a crash
        assert atlas._file.value("map_events") < atlas.n_events
        atlas._file.close()
    else:
        atlas.append(Visit("b"))
        atlas.close()
    assert version_of(path) == 2
    with Atlas.open(path) as atlas:
        if not closed:
            atlas.append(Visit("b"))
        assert metres_of(atlas.plane) == [30.0, None, None]
    with Atlas.open(path, writable=False) as atlas:
        assert metres_of(atlas.plane) == [30.0, None, None]


def test_a_refused_event_leaves_the_format_as_it_was(tmp_path):
    path = tmp_path / "town.atlas"
    with Atlas.from_walk(Walk(WalkHeader(), triangle(None)), path) as atlas, pytest.raises(WalkError):
        atlas.extend([Samples.of(EAST, metres=0.0), Visit("b")])
    assert version_of(path) == 1
    assert "metres" not in columns_of_edges(path)


@pytest.mark.parametrize("damage", ["metres = -1", "metres = 9e999", "metres = 'far'", "metres = x'00'"])
def test_damaged_metres_are_reported(tmp_path, damage):
    path = tmp_path / "town.atlas"
    Atlas.from_walk(Walk(WalkHeader(), triangle()), path).close()
    connection = sqlite3.connect(path)
    connection.execute("PRAGMA ignore_check_constraints = ON")
    connection.execute(f"UPDATE edge SET {damage} WHERE id = 0")
    connection.commit()
    connection.close()
    with pytest.raises(AtlasError, match="damaged: the stored map is no plane map") as caught, Atlas.open(path) as atlas:
        _ = atlas.plane
    assert "\n" not in str(caught.value)


# -- the simulated robot ----------------------------------------------------------------------------------------------


def test_a_simulated_robot_tells_the_lengths_of_the_ways():
    world = samples.load("office").to_world()
    robot = explore(world, seed=2, metres=True)
    told = [event.metres for event in robot.walk.events if isinstance(event, Samples)]
    assert math.fsum(told) == pytest.approx(robot.metres)
    plane = build(robot.walk)
    lengths = {name: float(np.hypot(*np.diff(world.path(e), axis=0).T).sum()) for e, name in enumerate(world.edge_names)}
    assert dict(zip(plane.edge_names, plane.metres.tolist(), strict=True)) == pytest.approx(lengths)


def test_a_simulated_robot_measures_only_when_told():
    world = samples.load("office").to_world()
    silent, telling = explore(world, seed=2, noise=0.001).walk, explore(world, seed=2, noise=0.001, metres=True).walk
    assert build(silent).metres is None
    assert [event.yaw for event in silent.events if isinstance(event, Samples)] == [
        event.yaw for event in telling.events if isinstance(event, Samples)
    ]
