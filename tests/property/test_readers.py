"""Whatever bytes a file holds, a reader gives a value or a NinefoldError."""

from __future__ import annotations

import json
import sqlite3

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from ninefold.errors import AtlasError, NinefoldError
from ninefold.io import Atlas, read_map, samples
from ninefold.io.sources.geojson import parse_geojson

SLOW_OK = settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    """A real atlas with every kind of content."""
    path = tmp_path_factory.mktemp("good") / "office.atlas"
    from ninefold.io import Provenance, Statement
    from ninefold.mapping.robot.simulated import explore

    walk = explore(samples.load("office").to_world(), seed=1).walk
    with Atlas.from_walk(walk, path, provenance=Provenance.of("test", "walk")) as atlas:
        atlas.name("way", "path:lobby,hall,stairs")
        atlas.name("room", "cycle:lobby,hall,archive,desk")
        atlas.declare(Statement("room", ("DC",), "moon"))
    return path


def outcome(call, *arguments):
    """What a call gives, or the NinefoldError it raises; anything else escapes."""
    try:
        return call(*arguments)
    except NinefoldError as error:
        return error


def assert_one_line(result):
    assert "\n" not in str(result) or not isinstance(result, NinefoldError)


def read_everything(path):
    with Atlas.open(path, writable=False) as atlas:
        return atlas.plane, atlas.sets, atlas.walk, atlas.warnings, atlas.statements, atlas.provenance, atlas._log.follow()


@SLOW_OK
@given(content=st.binary(max_size=300))
@example(content=b"")
@example(content=b"SQLite format 3\0")
@example(content=b"SQLite format 3\0" + b"\0" * 300)
def test_random_bytes_are_no_atlas(tmp_path, content):
    (tmp_path / "x.atlas").write_bytes(content)
    with pytest.raises(AtlasError):
        read_everything(tmp_path / "x.atlas")
    with pytest.raises(AtlasError):
        read_map(tmp_path / "x.atlas")


@SLOW_OK
@given(data=st.data())
def test_a_truncated_atlas_is_refused(tmp_path, good, data):
    whole = good.read_bytes()
    size = data.draw(st.integers(0, len(whole) - 1))
    (tmp_path / "x.atlas").write_bytes(whole[:size])
    with pytest.raises(AtlasError):
        read_everything(tmp_path / "x.atlas")


@SLOW_OK
@given(changes=st.lists(st.tuples(st.integers(0, 10**6), st.binary(min_size=1, max_size=8)), min_size=1, max_size=6))
def test_an_atlas_with_changed_bytes_gives_a_value_or_one_error(tmp_path, good, changes):
    whole = good.read_bytes()
    content = bytearray(whole)
    for at, piece in changes:
        at %= len(whole)
        content[at : at + len(piece)] = piece
    (tmp_path / "x.atlas").write_bytes(bytes(content[: len(whole)]))
    assert_one_line(outcome(read_everything, tmp_path / "x.atlas"))


@SLOW_OK
@given(data=st.data())
def test_an_atlas_with_changed_values_gives_a_value_or_one_error(tmp_path, good, data):
    path = tmp_path / "x.atlas"
    path.write_bytes(good.read_bytes())
    connection = sqlite3.connect(path)
    table, column = data.draw(
        st.sampled_from(
            [
                (table, column)
                for table in ("meta", "event", "vertex", "edge", "named_set", "statement", "provenance")
                for (_, column, *_) in connection.execute(f"PRAGMA table_info({table})")
            ]
        )
    )
    value = data.draw(
        st.none()
        | st.integers(-(2**63), 2**63 - 1)
        | st.floats()
        | st.text(max_size=20)
        | st.binary(max_size=5)
        | st.integers(-3, 30)
    )
    rows = connection.execute(f"SELECT {column} FROM {table} ORDER BY {column}").fetchall()
    (row,) = data.draw(st.sampled_from(rows))
    try:
        with connection:
            connection.execute(f"UPDATE {table} SET {column} = ? WHERE {column} IS ?", (value, row))
    except (sqlite3.Error, UnicodeEncodeError):
        pass  # a value that the schema itself refuses
    finally:
        connection.close()
    assert_one_line(outcome(read_everything, path))


numbers = st.floats() | st.integers() | st.floats(-180, 180)
positions = st.lists(numbers, min_size=0, max_size=3) | st.tuples(st.floats(-90, 90), st.floats(-90, 90)).map(list)
anything = st.recursive(
    st.none() | st.booleans() | numbers | st.text(max_size=6), lambda x: st.lists(x, max_size=3), max_leaves=8
)
geometries = st.fixed_dictionaries(
    {
        "type": st.sampled_from(["LineString", "MultiLineString", "Point", "Polygon", "GeometryCollection"]) | anything,
        "coordinates": st.lists(positions, max_size=6) | st.lists(st.lists(positions, max_size=4), max_size=3) | anything,
    }
)
features = st.fixed_dictionaries(
    {
        "type": st.just("Feature") | anything,
        "geometry": geometries | anything,
        "properties": st.fixed_dictionaries({}, optional={"name": anything, "id": anything}) | anything,
    },
    optional={"id": anything},
)
documents = st.fixed_dictionaries(
    {"type": st.just("FeatureCollection"), "features": st.lists(features | anything, max_size=5) | anything},
    optional={"ninefold": st.just({"units": "m"}) | anything, "crs": anything},
)


@settings(max_examples=400, deadline=None)
@given(document=documents | features | geometries | anything)
def test_any_json_is_a_source_or_an_error(document):
    source = outcome(parse_geojson, json.dumps(document))
    assert_one_line(source)
    if not isinstance(source, NinefoldError):
        assert source.n_edges > 0
        assert_one_line(outcome(lambda: source.to_map().validate()))


@settings(max_examples=200, deadline=None)
@given(text=st.text(max_size=40) | st.binary(max_size=40).map(lambda raw: raw.decode("latin-1")))
def test_any_text_is_a_source_or_an_error(text):
    with pytest.raises(NinefoldError):
        parse_geojson(text)


@settings(max_examples=150, deadline=None)
@given(
    lines=st.lists(
        st.lists(st.tuples(st.integers(0, 6), st.integers(0, 6)).map(list), min_size=2, max_size=5), min_size=1, max_size=8
    )
)
def test_lines_on_a_grid_become_maps_once_crossings_are_dropped(lines):
    document = {"type": "MultiLineString", "coordinates": lines, "ninefold": {"units": "m"}}
    source = outcome(lambda: parse_geojson(json.dumps(document)).without_crossings())
    if isinstance(source, NinefoldError):
        assert "length zero" in str(source) or "is left" in str(source)
        return
    plane = source.to_map()
    plane.validate()
    assert plane.n_edges == source.n_edges
    lengths = sum(np.hypot(*np.diff(source.polyline(e), axis=0).T).sum() for e in range(source.n_edges))
    assert lengths > 0
