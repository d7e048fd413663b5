"""The atlas: what goes in comes out, every change is whole or not at all, and damage is reported in one line."""

from __future__ import annotations

import json
import os
import sqlite3
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from ninefold.errors import AtlasError, BadInput, DifferentMaps, NinefoldError, UnknownName, WalkError
from ninefold.io import Atlas, Provenance, Statement, samples
from ninefold.io.atlas import _schema
from ninefold.mapping import Heading, PlaneMap, Samples, Visit, Walk, WalkHeader, build
from ninefold.mapping.robot.simulated import explore

EAST, NORTH, SOUTHWEST = (Samples.of(Heading.from_bearing(b)) for b in (90, 0, 225))
TRIANGLE = (Visit("a"), EAST, Visit("b"), NORTH, Visit("c"), SOUTHWEST, Visit("a"))


def robot_walk(name="ring", **options):
    return explore(samples.load(name).to_world(), **options).walk


@pytest.fixture
def triangle(tmp_path):
    path = tmp_path / "triangle.atlas"
    Atlas.from_walk(Walk(WalkHeader(), TRIANGLE), path).close()
    return path


@pytest.mark.parametrize("name", samples.names())
def test_a_map_comes_back_as_it_went_in(tmp_path, name):
    plane = samples.load(name).to_map()
    with Atlas.from_map(plane, tmp_path / "map.atlas", warnings=["a note"]) as atlas:
        assert atlas.plane == plane
        assert atlas.warnings == ("a note",)
        assert atlas.origin == "map"
    with Atlas.open(tmp_path / "map.atlas", writable=False) as atlas:
        assert atlas.plane == plane
        atlas.plane.validate()


@pytest.mark.parametrize(
    "plane",
    [
        PlaneMap.from_darts([], [], n_vertices=1, vertex_names=["only"]),
        PlaneMap.from_rotation({"a": [("a", "ring"), ("a", "ring")]}, outer=1),
        PlaneMap.from_geometry([(0, 0), (9, 0), (0, 9), (1, 1), (2, 1), (50, 50)], [(0, 1), (1, 2), (2, 0), (3, 4)]),
        PlaneMap.from_geometry([(0, 0), (1, 0)], np.zeros((0, 2), int)),
    ],
    ids=["one vertex", "no headings", "three components", "two places and no way"],
)
def test_maps_without_edges_headings_or_connection_come_back(tmp_path, plane):
    with Atlas.from_map(plane, tmp_path / "map.atlas") as atlas:
        assert atlas.plane == plane
        assert atlas.plane.vertex_names.are_rows == plane.vertex_names.are_rows


def test_a_walk_comes_back_and_its_map_is_stored_beside_it(tmp_path):
    walk = robot_walk(seed=3, noise=0.001)
    with Atlas.from_walk(walk, tmp_path / "walk.atlas") as atlas:
        assert atlas.walk == walk
        assert atlas.plane == build(walk)
    with Atlas.open(tmp_path / "walk.atlas") as atlas:
        assert atlas._log._mapper is None
        assert atlas.plane == build(walk)
        assert atlas._log._mapper is None, "an up-to-date map is read, not built again"


def test_events_appended_one_by_one_make_the_same_atlas(tmp_path):
    with Atlas.create(tmp_path / "live.atlas", provenance=Provenance.of("robot 7", "walk")) as atlas:
        with pytest.raises(BadInput, match="before the first place"):
            _ = atlas.plane
        for number, event in enumerate(TRIANGLE, 1):
            atlas.append(event)
            assert atlas.n_events == number
            atlas.plane.validate()
    with Atlas.open(tmp_path / "live.atlas") as atlas:
        assert atlas.plane == build(Walk(WalkHeader(), TRIANGLE))
        assert atlas.walk.events == TRIANGLE
        assert [record.source for record in atlas.provenance] == ["robot 7"]


def test_declared_noise_stays_in_the_atlas(tmp_path):
    header = WalkHeader("bearing-deg", sigma=0.035, drift=0.01, exits="in-order", extra={"robot": "r2"})
    walk = Walk(
        header, (Visit("a", (Heading.from_bearing(300), Heading.from_bearing(90), Heading.from_bearing(45))), *TRIANGLE[1:])
    )
    Atlas.from_walk(walk, tmp_path / "whole.atlas").close()
    Atlas.create(tmp_path / "live.atlas", header=header).close()
    for name in ("whole", "live"):
        with Atlas.open(tmp_path / f"{name}.atlas", writable=False) as atlas:
            assert atlas.walk.header == replace(header, heading="yaw-rad")
    with Atlas.open(tmp_path / "whole.atlas") as atlas:
        assert atlas.walk.events[0].exits == walk.events[0].exits  # in the order given


def test_what_is_no_event_is_refused_and_not_stored(tmp_path):
    with Atlas.create(tmp_path / "a.atlas") as atlas:
        with pytest.raises(WalkError, match="an event is a Visit or Samples, not 'hall'"):
            atlas.append("hall")
        assert atlas.n_events == 0


def test_a_log_ahead_of_the_stored_map_is_replayed(triangle):
    atlas = Atlas.open(triangle)
    atlas.append(Samples.of(Heading.from_bearing(180)))
    atlas.append(Visit("d"))
    atlas._file.close()  # as a crash would, without storing the map
    with Atlas.open(triangle, writable=False) as again:
        assert again.plane.n_vertices == 4
        assert again._log._mapper is not None


def test_warnings_tell_what_is_unfinished(tmp_path, triangle):
    with Atlas.open(triangle) as atlas:
        assert atlas.warnings == ()
        atlas.append(EAST)
        (unfinished,) = atlas.warnings
    assert "leg" in unfinished
    with Atlas.open(triangle, writable=False) as atlas:
        assert atlas.warnings == (unfinished,)
        assert atlas._log._mapper is None


@pytest.mark.parametrize(
    "event",
    [
        Visit(None),  # not recognised
        Visit("b", edge="e0"),  # another edge has that name
        Visit("b", t=float("nan")),
        Visit("b", t=5.0),  # before the last event
        Visit("\ud800"),  # half a character
        Samples.of(Heading.from_bearing(0)),  # half a turn
    ],
)
def test_a_refused_event_is_not_stored(triangle, event):
    with Atlas.open(triangle) as atlas:
        atlas.append(Samples.of(Heading.from_bearing(180), t=7.0))
        before, plane = atlas.n_events, atlas.plane
        with pytest.raises(NinefoldError):
            atlas.append(event)
        assert atlas.n_events == before
        assert atlas.plane == plane
        atlas.append(Visit("d", t=8.0))
        assert atlas.plane.n_vertices == 4
    with Atlas.open(triangle) as atlas:
        assert len(atlas.walk.events) == before + 1


def test_several_events_are_taken_together_or_not_at_all(triangle):
    with Atlas.open(triangle) as atlas:
        with pytest.raises(WalkError):
            atlas.extend([Samples.of(Heading.from_bearing(180)), Visit("d"), Visit("e")])
        assert atlas.n_events == len(TRIANGLE)
        assert atlas.plane.n_vertices == 3
        atlas.extend([Samples.of(Heading.from_bearing(180)), Visit("d")])
        assert atlas.plane.n_vertices == 4


def test_two_writers_do_not_mix_their_events(triangle):
    with Atlas.open(triangle) as first, Atlas.open(triangle) as second:
        assert second.plane.n_edges == first.plane.n_edges
        second.append(Samples.of(Heading.from_bearing(180)))
        for _ in range(2):
            with pytest.raises(AtlasError, match="another writer has added events"):
                first.append(Visit("d"))
        second.append(Visit("d"))
        assert first.plane.n_vertices == second.plane.n_vertices == 4
    with Atlas.open(triangle) as again:
        again.append(Samples.of(Heading.from_bearing(90)))


def test_a_finished_map_takes_no_events(tmp_path):
    with (
        Atlas.from_map(samples.load("house").to_map(), tmp_path / "map.atlas") as atlas,
        pytest.raises(BadInput, match="finished map"),
    ):
        atlas.append(Visit("a"))


def test_sets_are_stored_by_names_and_survive_new_edges(triangle):
    with Atlas.open(triangle) as atlas:
        room = atlas.name("room", "cycle:a,b,c")
        atlas.name("corner", atlas.plane.vertex("a"))
        atlas.name("wall", atlas.plane.path(["c", "b", "a"]))
        atlas.name("pieces", "line:@e2,@e0")
        assert room.n_faces == 1
        rows = dict(atlas._file.rows("SELECT name, definition FROM named_set"))
        assert json.loads(rows["room"]) == {"boundary": ["e0", "e1", "e2"]}
        assert json.loads(rows["wall"]) == {"start": "c", "edges": ["e1", "e0"]}
        # From the middle of nowhere back in: a dead end inside the room splits no face, a chord does.
        atlas.extend([Samples.of(Heading.from_degrees(20)), Visit("m"), Samples.of(Heading.from_degrees(60)), Visit("c")])
    with Atlas.open(triangle) as atlas:
        assert list(atlas.sets) == ["corner", "pieces", "room", "wall"]
        assert atlas.parse("room").n_faces == 2
        assert atlas.parse("room").boundary == atlas.plane.line(["e0", "e1", "e2"])
        assert atlas.parse("wall").darts == atlas.plane.path(["c", "b", "a"]).darts
        assert atlas.parse("vertex:a") == atlas.parse("corner")


def test_regions_with_holes_and_several_parts_are_stored(tmp_path):
    plane = samples.load("helsinki_district").to_map()
    rng = np.random.default_rng(2)
    bounded = [f for f in range(plane.n_faces) if f != plane.outer_face]
    with Atlas.from_map(plane, tmp_path / "city.atlas") as atlas:
        chosen = {f"r{k}": plane.region(rng.choice(bounded, 30, replace=False).tolist()) for k in range(10)}
        chosen["ring"] = plane.region(bounded) - plane.face(bounded[40])
        for name, region in chosen.items():
            atlas.name(name, region)
        assert atlas.sets == dict(sorted(chosen.items()))


def test_a_map_of_one_place_is_the_same_when_opened_again(tmp_path):
    """It has no edge, and headings none the less: an empty array of them, not None."""
    with Atlas.create(tmp_path / "one.atlas") as atlas:
        atlas.append(Visit("gate"))
        before = atlas.plane
    with Atlas.open(tmp_path / "one.atlas") as atlas:
        assert atlas.plane == before


def test_names_can_be_changed_and_forgotten(triangle):
    with Atlas.open(triangle) as atlas:
        atlas.name("room", "cycle:a,b,c")
        with pytest.raises(BadInput, match="'room' is the name of a set already"):
            atlas.name("room", "vertex:a")
        atlas.name("room", "vertex:a", force=True)
        atlas.rename("room", "spot")
        with pytest.raises(UnknownName, match="did you mean 'spot'"):
            atlas.parse("sport")
        with pytest.raises(UnknownName):
            atlas.remove("room")
        with pytest.raises(UnknownName):
            atlas.rename("room", "other")
        atlas.name("hall", "edge:a,b")
        with pytest.raises(BadInput, match="already"):
            atlas.rename("hall", "spot")
        atlas.remove("spot")
        assert atlas.names == ("hall",)


@pytest.mark.parametrize("name", ["", "  ", "a:b", "line\nbreak", "\ud800", 7])
def test_names_that_cannot_be_are_refused(triangle, name):
    with Atlas.open(triangle) as atlas:
        with pytest.raises(BadInput):
            atlas.name(name, "vertex:a")
        assert atlas.names == ()


def test_a_set_of_another_map_is_refused(triangle):
    with Atlas.open(triangle) as atlas:
        with pytest.raises(DifferentMaps):
            atlas.name("spot", samples.load("house").to_map().vertex("sw"))
        with pytest.raises(BadInput, match="a set is a point"):
            atlas.name("spot", 3)


def test_statements_are_kept_in_order(triangle):
    given = (
        Statement("pond", ("TPP", "NTPP"), "garden"),
        Statement("pond", ["DC"], "house", label="the deed", weight=float("inf")),
        Statement("house", ("EC",), "garden", weight=2),
    )
    with Atlas.open(triangle) as atlas:
        for statement in given:
            atlas.declare(statement)
    with Atlas.open(triangle) as atlas:
        assert atlas.statements == given


@pytest.mark.parametrize(
    "parts",
    [("", ("DC",), "b"), ("a", (), "b"), ("a", ("P O",), "b"), ("a", "DC", "b"), ("a", ("DC",), "b", 3)],
)
def test_statements_that_say_nothing_are_refused(parts):
    with pytest.raises(BadInput):
        Statement(*parts)
    with pytest.raises(BadInput):
        Statement("a", ("DC",), "b", weight=float("nan"))


def test_provenance_holds_the_digest_of_the_file(tmp_path):
    (tmp_path / "a.txt").write_bytes(b"abc")
    record = Provenance.of_file(tmp_path / "a.txt", "walk")
    assert record.sha256 == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
    assert record.tool.startswith("ninefold ")
    with pytest.raises(BadInput, match="cannot be read"):
        Provenance.of_file(tmp_path / "none", "walk")


def test_any_sqlite_tool_reads_the_map(triangle):
    with sqlite3.connect(triangle) as connection:
        darts = connection.execute("SELECT dart, tail, head, next_ccw, heading FROM dart ORDER BY dart").fetchall()
        assert connection.execute("PRAGMA application_id").fetchone() == (0x4E39464C,)
        assert connection.execute("PRAGMA user_version").fetchone() == (1,)
        assert connection.execute("PRAGMA journal_mode").fetchone() == ("wal",)
        assert connection.execute("SELECT count(*) FROM event").fetchone() == (len(TRIANGLE),)
    connection.close()
    plane = build(Walk(WalkHeader(), TRIANGLE))
    assert [row[1] for row in darts] == plane.tail.tolist()
    assert [row[2] for row in darts] == plane.tail[np.arange(6) ^ 1].tolist()
    assert [row[3] for row in darts] == plane.next_ccw.tolist()
    assert [row[4] for row in darts] == plane.heading.tolist()


def test_an_existing_file_is_replaced_only_when_told(triangle):
    before = triangle.read_bytes()
    plane = samples.load("house").to_map()
    with pytest.raises(BadInput, match="exists already"):
        Atlas.from_map(plane, triangle)
    assert triangle.read_bytes() == before
    Atlas.from_map(plane, triangle, force=True).close()
    with Atlas.open(triangle) as atlas:
        assert atlas.plane == plane
    assert [file.name for file in triangle.parent.iterdir()] == ["triangle.atlas"]


def test_a_log_left_by_a_crash_is_not_applied_to_the_file_that_replaces_it(triangle):
    log = triangle.with_name(triangle.name + "-wal")
    crashed = Atlas.open(triangle)
    crashed.append(EAST)
    saved = log.read_bytes()
    crashed._file.close()
    log.write_bytes(saved)
    plane = samples.load("house").to_map()
    Atlas.from_map(plane, triangle, force=True).close()
    with Atlas.open(triangle) as atlas:
        assert atlas.plane == plane


def test_a_walk_that_makes_no_map_leaves_nothing(tmp_path):
    with pytest.raises(WalkError):
        Atlas.from_walk(Walk(WalkHeader(), (*TRIANGLE, Visit("a"))), tmp_path / "bad.atlas")
    with pytest.raises(BadInput, match="does not exist"):
        Atlas.create(tmp_path / "no folder" / "x.atlas")
    with pytest.raises(BadInput, match="a folder"):
        Atlas.create(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_what_is_no_atlas_is_refused(tmp_path, triangle):
    cases = {"empty": b"", "text": b"hello " * 50, "short": b"SQLite format 3\0"}
    for name, content in cases.items():
        (tmp_path / name).write_bytes(content)
        with pytest.raises(AtlasError, match="not an atlas"):
            Atlas.open(tmp_path / name)
    with pytest.raises(AtlasError, match="no such file"):
        Atlas.open(tmp_path / "none.atlas")
    with pytest.raises(AtlasError, match="cannot be read"):
        Atlas.open(tmp_path)
    foreign = sqlite3.connect(tmp_path / "foreign.db")
    foreign.execute("CREATE TABLE meta (key, value)")
    foreign.commit()
    foreign.close()
    with pytest.raises(AtlasError, match="not an atlas of ninefold"):
        Atlas.open(tmp_path / "foreign.db")


def test_a_newer_format_is_refused(triangle):
    connection = sqlite3.connect(triangle)
    connection.execute(f"PRAGMA user_version = {_schema.VERSION + 1}")
    connection.close()
    with pytest.raises(AtlasError, match="format 3; this ninefold reads up to 2"):
        Atlas.open(triangle)


def test_a_truncated_file_is_refused(triangle):
    whole = triangle.read_bytes()
    triangle.write_bytes(whole[: len(whole) // 2])
    with pytest.raises(AtlasError, match="truncated"):
        Atlas.open(triangle)


@pytest.mark.parametrize(
    "damage",
    [
        "DROP TABLE edge",
        "DELETE FROM edge WHERE id = 1",
        "DELETE FROM meta WHERE key = 'outer'",
        "UPDATE meta SET value = 'x' WHERE key = 'outer'",
        "UPDATE meta SET value = 99 WHERE key = 'outer'",
        "UPDATE meta SET value = 4294967296000 WHERE key = 'outer'",
        "UPDATE edge SET tail = 'x' WHERE id = 0",
        "UPDATE edge SET tail = 77 WHERE id = 0",
        "UPDATE edge SET next_out = 9223372036854775807 WHERE id = 0",
        "UPDATE edge SET heading_out = 'north' WHERE id = 0",
        "UPDATE edge SET heading_out = NULL WHERE id = 0",
        "UPDATE edge SET turn = 1e300 WHERE id = 0",
        "UPDATE edge SET id = 12 WHERE id = 0",
        "UPDATE edge SET name = 'e1'",
        "UPDATE vertex SET name = x'ff'",
        "UPDATE vertex SET id = 12 WHERE id = 0",
        "UPDATE named_set SET kind = 'sphere'",
        "UPDATE named_set SET definition = '{'",
        'UPDATE named_set SET definition = \'{"boundary": ["e0"]}\'',
        "UPDATE named_set SET definition = '{\"boundary\": [[]]}'",
        "UPDATE named_set SET definition = x'00'",
        "UPDATE meta SET value = '{}' WHERE key = 'warnings'",
        "UPDATE meta SET value = '[1]' WHERE key = 'warnings'",
        "UPDATE meta SET value = 3 WHERE key = 'origin'",
        "DELETE FROM event WHERE seq = 2",
        'UPDATE event SET json = \'{"place": "c"}\' WHERE seq = 4',
        "UPDATE event SET json = '' WHERE seq = 5",
        "UPDATE event SET json = x'00' WHERE seq = 5",
        "UPDATE meta SET value = '' WHERE key = 'header'",
        'UPDATE meta SET value = \'{"ninefold": "walk", "version": 9}\' WHERE key = \'header\'',
        "UPDATE statement SET weight = -1",
    ],
)
def test_damaged_rows_are_reported(triangle, damage):
    with Atlas.open(triangle) as atlas:
        atlas.name("room", "cycle:a,b,c")
        atlas.declare(Statement("room", ("DC",), "pond"))
    connection = sqlite3.connect(triangle)
    connection.execute("PRAGMA ignore_check_constraints = ON")
    connection.execute(damage)
    connection.commit()
    connection.close()
    with pytest.raises(AtlasError) as caught, Atlas.open(triangle) as atlas:
        _ = (atlas.plane, atlas.sets, atlas.warnings, atlas.statements, atlas.walk, atlas._log.follow())
    assert str(caught.value).startswith(f"{triangle}: ")
    assert "\n" not in str(caught.value)


TABLES_WITHOUT_CONSTRAINTS = """
CREATE TABLE meta (key TEXT PRIMARY KEY, value) WITHOUT ROWID;
CREATE TABLE event (seq INTEGER PRIMARY KEY, json TEXT NOT NULL);
CREATE TABLE vertex (id INTEGER PRIMARY KEY, name TEXT);
CREATE TABLE edge (
  id INTEGER PRIMARY KEY, name TEXT, tail INTEGER NOT NULL, head INTEGER NOT NULL,
  next_out INTEGER NOT NULL, next_back INTEGER NOT NULL,
  heading_out REAL, heading_back REAL, turn REAL, tether INTEGER NOT NULL
);
CREATE VIEW dart AS
  SELECT 2 * id AS dart, tail, head, next_out AS next_ccw, heading_out AS heading FROM edge
  UNION ALL SELECT 2 * id + 1, head, tail, next_back, heading_back FROM edge;
CREATE TABLE named_set (name TEXT PRIMARY KEY, kind TEXT NOT NULL, definition TEXT NOT NULL, text TEXT NOT NULL);
CREATE TABLE statement (
  id INTEGER PRIMARY KEY, a TEXT NOT NULL, relations TEXT NOT NULL, b TEXT NOT NULL, label TEXT, weight REAL
);
CREATE TABLE provenance (
  id INTEGER PRIMARY KEY, source TEXT NOT NULL, kind TEXT NOT NULL, sha256 TEXT, tool TEXT NOT NULL, made TEXT NOT NULL
);
"""


@pytest.fixture
def old_atlas(tmp_path, monkeypatch):
    """An atlas as it was written before its tables had constraints."""
    path = tmp_path / "old.atlas"
    with monkeypatch.context() as patch:
        patch.setattr(_schema, "TABLES", TABLES_WITHOUT_CONSTRAINTS)
        with Atlas.from_map(samples.load("figure8").to_map(), path) as atlas:
            atlas.name("room", "cycle:v2,v3,v6,v5,v4")
            atlas.declare(Statement("room", ("DC",), "pond", weight=2))
    return path


def test_an_atlas_without_constraints_still_opens(old_atlas):
    with Atlas.open(old_atlas) as atlas:
        assert (atlas.names, atlas.sets["room"].text) == (("room",), atlas.plane.cycle(["v2", "v3", "v6", "v5", "v4"]).text)
        assert atlas.statements == (Statement("room", ("DC",), "pond", weight=2),)
        atlas.name("corner", "vertex:v0")
    with Atlas.open(old_atlas, writable=False) as atlas:
        assert atlas.names == ("corner", "room")


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        ("UPDATE named_set SET name = NULL", "a named set, row 1 of named_set, has the name NULL"),
        ("INSERT INTO named_set VALUES (NULL, 'point', '{}', '')", "a named set, row 2 of named_set, has the name NULL"),
        ("UPDATE named_set SET name = x'00ff'", r"has the name b'\\x00\\xff'"),
        ("UPDATE named_set SET name = ''", "has the name ''"),
        ("UPDATE named_set SET kind = x'01'", "has the kind"),
        ("UPDATE statement SET a = ''", "a statement, row 1 of statement, has the a ''"),
        ("UPDATE statement SET relations = '  '", "has the relations '  '"),
        ("UPDATE statement SET weight = -1", "has the weight -1.0"),
        ("UPDATE statement SET weight = 'heavy'", "has the weight 'heavy'"),
        ("UPDATE statement SET label = x'00'", "has the label"),
        ("INSERT INTO provenance VALUES (1, x'00', '', NULL, '', '')", "a source, row 1 of provenance, has the source"),
    ],
)
@pytest.mark.parametrize("writable", [True, False])
def test_what_constraints_would_have_refused_is_found_on_opening(old_atlas, damage, said, writable):
    connection = sqlite3.connect(old_atlas)
    connection.execute(damage)
    connection.commit()
    connection.close()
    with pytest.raises(AtlasError, match=said) as caught, Atlas.open(old_atlas, writable=writable) as atlas:
        _ = atlas.sets
    assert str(caught.value).startswith(f"{old_atlas}: damaged (")


@pytest.mark.parametrize(
    "statement",
    [
        "INSERT INTO named_set VALUES (NULL, 'point', '{}', '')",
        "INSERT INTO named_set VALUES ('', 'point', '{}', '')",
        "INSERT INTO named_set VALUES ('a', 'sphere', '{}', '')",
        "INSERT INTO named_set VALUES ('a', 'point', NULL, '')",
        "INSERT INTO statement VALUES (1, 'a', ' ', 'b', NULL, NULL)",
        "INSERT INTO statement VALUES (1, 'a', 'DC', 'b', NULL, -1)",
        "INSERT INTO statement VALUES (1, 'a', 'DC', 'b', NULL, 'heavy')",
        "INSERT INTO event VALUES (0, '{}')",
        "INSERT INTO event VALUES (99, NULL)",
        "INSERT INTO meta VALUES ('origin', NULL)",
        "UPDATE edge SET tether = 2",
        "UPDATE edge SET tail = -1",
        "UPDATE edge SET name = x'00'",
    ],
)
def test_the_tables_refuse_what_no_reader_takes(triangle, statement):
    connection = sqlite3.connect(triangle)
    with pytest.raises(sqlite3.IntegrityError):
        connection.execute(statement)
    connection.close()
    with Atlas.open(triangle) as atlas:
        assert atlas.plane.n_vertices == 3


@pytest.mark.parametrize("path", ["town.atlas", Path("town.atlas")])
def test_the_class_itself_opens_no_file(path):
    with pytest.raises(BadInput, match=r"Atlas\.open\('town\.atlas'\) opens an atlas"):
        Atlas(path)


def test_a_closed_atlas_says_so(triangle):
    atlas = Atlas.open(triangle)
    atlas.close()
    atlas.close()
    with pytest.raises(AtlasError, match="closed"):
        _ = atlas.plane
    assert "closed" in repr(atlas)


def test_reading_alone_changes_nothing(triangle):
    with Atlas.open(triangle, writable=False) as atlas, pytest.raises(AtlasError, match="opened for reading"):
        atlas.name("room", "cycle:a,b,c")


def test_a_writer_that_holds_the_file_is_named_as_the_reason(triangle, monkeypatch):
    monkeypatch.setattr(_schema, "BUSY_SECONDS", 0.05)
    other = sqlite3.connect(triangle, isolation_level=None)
    other.execute("BEGIN IMMEDIATE")
    with Atlas.open(triangle) as atlas:
        with pytest.raises(AtlasError, match="another program has been writing"):
            atlas.append(EAST)
        other.execute("ROLLBACK")
        atlas.append(EAST)
        assert atlas.n_events == len(TRIANGLE) + 1
    other.close()


def test_a_full_disk_stops_an_event_and_changes_nothing(triangle):
    with Atlas.open(triangle) as atlas:
        connection = atlas._file.connection
        (pages,) = connection.execute("PRAGMA page_count").fetchone()
        connection.execute(f"PRAGMA max_page_count = {pages}")
        stored = 0

        def fill():
            nonlocal stored
            for _ in range(2000):
                atlas.append(Samples(EAST.yaw * 50))
                stored += 1

        with pytest.raises(AtlasError, match="the disk is full"):
            fill()
        assert atlas.n_events == len(TRIANGLE) + stored
        connection.execute("PRAGMA max_page_count = 100000")
        atlas.append(EAST)
    with Atlas.open(triangle) as atlas:
        assert len(atlas.walk.events) == len(TRIANGLE) + stored + 1


LIMITED = """
import resource, signal, sys
from ninefold.errors import NinefoldError
from ninefold.io import Atlas, samples
plane = samples.load("helsinki_district").to_map()
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
try:
    Atlas.from_map(plane, sys.argv[1])
except NinefoldError as error:
    print(error)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="file size limits are a Unix thing")
def test_a_disk_that_fills_up_leaves_no_new_file(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", LIMITED, tmp_path / "city.atlas"], capture_output=True, text=True, check=True
    )
    assert "disk" in done.stdout
    assert done.stdout.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


READ_ONLY = """
import os, shutil, sys, tempfile
from ninefold.errors import NinefoldError
from ninefold.io import Atlas
with tempfile.TemporaryDirectory() as folder:  # load every module while the library itself can surely be read
    with Atlas.open(shutil.copy(sys.argv[1], folder + "/copy.atlas")) as atlas:
        atlas.name("room", "cycle:a,b,c")
if os.geteuid() == 0:
    os.setuid(65534)  # to the superuser nothing is read-only
with Atlas.open(sys.argv[1], writable=False) as atlas:
    print(atlas.plane)
for change in (lambda: Atlas.open(sys.argv[1]).name("room", "cycle:a,b,c"),
               lambda: Atlas.create(sys.argv[1] + "2")):
    try:
        change()
    except NinefoldError as error:
        print(error)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="folder permissions are a Unix thing")
def test_a_read_only_folder_can_be_read_and_not_written(triangle):
    folder = triangle.parent
    before = triangle.read_bytes()
    triangle.chmod(0o644)
    folder.chmod(0o555)
    closed = [parent for parent in folder.parents if parent.stat().st_mode & 0o777 == 0o700]
    opened = closed if os.geteuid() == 0 else []  # the superuser's folders, for the ordinary user of the child process
    for parent in opened:
        parent.chmod(0o711)
    try:
        done = subprocess.run([sys.executable, "-c", READ_ONLY, triangle], capture_output=True, text=True)
    finally:
        folder.chmod(0o755)
        for parent in opened:
            parent.chmod(0o700)
    lines = done.stdout.splitlines()
    assert lines[0] == "PlaneMap(3 vertices, 3 edges, 2 faces)", done.stderr
    assert "read-only" in lines[1]
    assert "read-only" in lines[2]
    assert len(lines) == 3
    assert triangle.read_bytes() == before
