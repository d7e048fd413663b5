"""GeoJSON lines become sources: what is a vertex, what names it, what is refused."""

from __future__ import annotations

import json

import numpy as np
import pytest

from ninefold.errors import BadInput
from ninefold.io import read_source
from ninefold.io.sources.geojson import parse_geojson, read_geojson


def planar(*lines, **members):
    """A planar FeatureCollection text; a line is coordinates, or (coordinates, properties)."""
    features = []
    for line in lines:
        coordinates, properties = line if isinstance(line, tuple) else (line, {})
        features.append(
            {"type": "Feature", "properties": properties, "geometry": {"type": "LineString", "coordinates": coordinates}}
        )
    return json.dumps({"type": "FeatureCollection", "ninefold": {"units": "m"}, "features": features, **members})


def test_ends_and_shared_coordinates_are_vertices_and_the_rest_are_bends():
    source = parse_geojson(planar([[0, 0], [1, 1], [2, 0], [4, 0]], [[2, 0], [2, -5]]))
    assert source.points.tolist() == [[0, 0], [2, 0], [4, 0], [2, -5]]
    assert source.edges.tolist() == [[0, 1], [1, 2], [1, 3]]
    assert source.paths[0].tolist() == [[0, 0], [1, 1], [2, 0]]
    assert source.paths[1] is None
    assert not source.warnings


def test_a_ring_is_one_loop_at_its_first_coordinate():
    source = parse_geojson(planar([[0, 0], [3, 0], [0, 3], [0, 0]]))
    assert source.edges.tolist() == [[0, 0]]
    assert source.to_map().n_faces == 2


def test_a_line_that_touches_itself_has_a_vertex_there():
    source = parse_geojson(planar([[-5, 0], [0, 0], [3, 0], [3, 3], [0, 0], [0, -4]]))
    assert source.edges.tolist() == [[0, 1], [1, 1], [1, 2]]
    assert not source.crossings


def test_a_spur_walked_there_and_back_is_one_dead_end():
    source = parse_geojson(planar([[0, 0], [2, 0], [2, 5], [2, 0], [4, 0]]))
    assert sorted(source.to_map().degree.tolist()) == [1, 1, 1, 3]
    assert source.notes == ("dropped 1 stretch that repeat another",)


def test_names_come_from_ids_then_names_and_are_numbered_where_shared():
    text = planar(
        ([[0, 0], [1, 0]], {"name": "High Street"}),
        ([[1, 0], [2, 0]], {"name": " High\u00a0Street\n"}),
        ([[2, 0], [2, 1]], {"id": 17, "name": "Mews"}),
        [[2, 1], [0, 0]],
    )
    source = parse_geojson(text)
    assert source.edge_names == ("High Street 1", "High Street 2", "17", "e3")
    assert source.labels == ("High Street", "High Street", "Mews", None)
    assert source.streets == {"High Street": (0, 1), "Mews": (2,)}


def test_a_made_up_name_never_repeats_a_given_one():
    source = parse_geojson(planar([[0, 0], [1, 0]], ([[1, 0], [2, 0]], {"name": "e0"})))
    assert len(set(source.edge_names)) == 2


def test_named_points_name_vertices_and_others_are_noted():
    document = json.loads(planar([[0, 0], [1, 0], [2, 0]]))
    for name, at in (("door", [0, 0]), ("bend", [1, 0]), ("door", [2, 0])):
        document["features"].append(
            {"type": "Feature", "properties": {"name": name}, "geometry": {"type": "Point", "coordinates": at}}
        )
    source = parse_geojson(json.dumps(document))
    assert source.vertex_names == ("door", "v1")
    assert "left out 2 named points" in source.notes[0]


def test_repeated_lines_positions_and_lines_without_length_are_dropped_and_said():
    source = parse_geojson(planar([[0, 0], [1, 0], [1, 0], [3, 1]], [[3, 1], [1, 0], [0, 0]], [[7, 7], [7, 7]]))
    assert source.n_edges == 1
    assert source.notes == (
        "dropped 1 position that repeat the one before",
        "dropped 1 line without length",
        "dropped 1 line that repeat another",
    )


def test_what_is_no_line_is_left_out_and_said():
    document = json.loads(planar([[0, 0], [1, 0]]))
    document["features"] += [
        {"type": "Feature", "properties": None, "geometry": None},
        {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": []}},
        {"type": "Feature", "properties": {}, "geometry": {"type": "LineString", "coordinates": [[0, 0]]}},
    ]
    (note,) = parse_geojson(json.dumps(document)).notes
    assert note == "left out 1 Polygon, 1 feature without geometry, 1 line with fewer than two positions"


def test_multi_lines_collections_and_bare_geometries_count():
    multi = {"type": "MultiLineString", "coordinates": [[[0, 0], [1, 0]], [[1, 0], [1, 1, 99.5]]]}
    assert parse_geojson(json.dumps(multi)).n_edges == 2
    assert parse_geojson(json.dumps({"type": "GeometryCollection", "geometries": [multi]})).n_edges == 2


def test_longitude_and_latitude_become_metres_about_the_middle():
    source = parse_geojson('{"type": "LineString", "coordinates": [[24.0, 60.0], [24.0, 60.01], [24.01, 60.01]]}')
    (path,) = source.paths
    north, east = np.hypot(*np.diff(path, axis=0).T)
    assert north == pytest.approx(1111.95, abs=0.1)
    assert east == pytest.approx(1111.95 * np.cos(np.radians(60.005)), abs=0.1)
    assert abs(path).max() < 600


def test_lines_across_the_antimeridian_stay_short():
    source = parse_geojson('{"type": "LineString", "coordinates": [[179.999, 0], [-179.999, 0]]}')
    assert float(np.ptp(source.points[:, 0])) == pytest.approx(222.4, abs=0.1)


@pytest.mark.parametrize(
    ("name", "span"), [("urn:ogc:def:crs:EPSG::3067", 9.0), ("urn:ogc:def:crs:OGC:1.3:CRS84", 9 * 111195.08)]
)
def test_an_old_style_crs_says_whether_coordinates_are_planar(name, span):
    crs = {"type": "name", "properties": {"name": name}}
    source = parse_geojson(json.dumps({"type": "LineString", "coordinates": [[0, -4.5], [0, 4.5]], "crs": crs}))
    assert float(np.ptp(source.points[:, 1])) == pytest.approx(span, rel=1e-6)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "not JSON"),
        ("{", "not JSON (line 1"),
        ("[" * 100_000, "nested too deep"),
        ("[1" + "0" * 5000 + "]", "a number is too long"),
        ("[]", "GeoJSON is an object"),
        ("{}", 'has no "type"'),
        ('{"type": "FeatureCollection"}', 'a list "features"'),
        ('{"type": "FeatureCollection", "features": []}', "no LineString"),
        ('{"type": "FeatureCollection", "features": [3]}', "feature 1 is a number"),
        ('{"type": "Polygon", "coordinates": []}', "no LineString or MultiLineString in it (1 Polygon)"),
        ('{"type": "Feature", "geometry": 3}', "the geometry of the document is a number"),
        ('{"type": "LineString", "coordinates": "here"}', "not a list of positions"),
        ('{"type": "LineString", "coordinates": [[0, 0], [NaN, 0]]}', "not a finite number"),
        ('{"type": "LineString", "coordinates": [[0, 0], [1e999, 0]]}', "not a finite number"),
        ('{"type": "LineString", "coordinates": [[0, 0], [true, 0]]}', "not a list of two or more numbers"),
        ('{"type": "LineString", "coordinates": [[0, 0], [1]]}', "not a list of two or more numbers"),
        ('{"type": "LineString", "coordinates": [[0, 0], ["1", "2"]]}', "not a list of two or more numbers"),
        ('{"type": "LineString", "coordinates": [[0, 0], [200, 0]]}', '"ninefold": {"units": "m"}'),
        ('{"type": "LineString", "coordinates": [[1, 1], [1, 1]]}', "length zero"),
        ('{"type": "LineString", "coordinates": [[0, 0], [1, 1]], "ninefold": {"units": "feet"}}', "'feet'"),
        ('{"type": "LineString", "coordinates": [[0, 0], [1e300, 1]], "ninefold": {"units": "m"}}', "1e+09 m"),
        ('{"type": "MultiLineString", "coordinates": 7}', "not a list of lines"),
        ('{"type": "GeometryCollection", "geometries": [{"type": "GeometryCollection"}]}', "may not hold another"),
    ],
)
def test_bad_geojson_is_refused_in_one_line(text, message):
    with pytest.raises(BadInput) as caught:
        parse_geojson(text, origin="town.geojson")
    assert message in str(caught.value)
    assert str(caught.value).startswith("town.geojson: ")
    assert "\n" not in str(caught.value)


def test_files_that_cannot_be_read_are_refused(tmp_path):
    with pytest.raises(BadInput, match="No such file"):
        read_geojson(tmp_path / "none.geojson")
    (tmp_path / "latin.geojson").write_bytes('{"name": "Mäkelä"}'.encode("latin-1"))
    with pytest.raises(BadInput, match="UTF-8"):
        read_geojson(tmp_path / "latin.geojson")
    with pytest.raises(BadInput, match="cannot be read"):
        read_geojson(tmp_path)
    (tmp_path / "town.dwg").write_bytes(b"AC1032")
    with pytest.raises(BadInput, match=r"town\.dwg: not lines in GeoJSON \(\.geojson\)"):
        read_source(tmp_path / "town.dwg")


def test_a_byte_order_mark_is_no_obstacle(tmp_path):
    file = tmp_path / "town.json"
    file.write_text(planar([[0, 0], [1, 0]]), encoding="utf-8-sig")
    assert read_source(file).origin == "town.json"
