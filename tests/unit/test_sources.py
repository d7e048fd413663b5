"""Sources: crossings without a vertex are found, counted and dropped; the bundled samples are what they claim."""

from __future__ import annotations

import json

import numpy as np
import pytest
import shapely

from ninefold.errors import BadInput, UnknownName
from ninefold.io import Source, read_source, samples
from ninefold.io.sources.geojson import parse_geojson


def source_of(*lines):
    document = {"type": "MultiLineString", "coordinates": lines, "ninefold": {"units": "m"}}
    return parse_geojson(json.dumps(document))


def test_a_crossing_without_a_vertex_is_found_and_refused():
    source = source_of([[0, 0], [10, 0]], [[5, -5], [5, 5]])
    (crossing,) = source.crossings
    assert (crossing.edges, crossing.at, crossing.places, crossing.overlap) == ((0, 1), (5.0, 0.0), 1, False)
    with pytest.raises(
        BadInput, match=r"edges meet at 1 place without a vertex: first, 'e0' and 'e1' meet near \(5.0, 0.0\)"
    ):
        source.to_map()


def test_a_dead_end_that_touches_a_street_between_its_vertices_counts():
    (crossing,) = source_of([[0, 0], [10, 0]], [[5, 0], [5, 5]]).crossings
    assert crossing.at == (5.0, 0.0)


def test_places_are_counted_not_pairs():
    source = source_of([[0, 0], [10, 0]], [[1, -1], [2, 1], [3, -1], [4, 1]])
    assert [crossing.places for crossing in source.crossings] == [3]


def test_a_stretch_in_common_is_an_overlap():
    source = source_of([[0, 0], [10, 0]], [[0, 0], [4, 0], [4, 4]])
    (crossing,) = source.crossings
    assert crossing.overlap
    with pytest.raises(BadInput, match="'e0' and 'e1' overlap"):
        source.to_map()


def test_straight_edges_in_one_direction_overlap():
    assert [crossing.overlap for crossing in source_of([[0, 0], [10, 0]], [[0, 0], [4, 0]]).crossings] == [True]
    assert not source_of([[0, 0], [10, 0]], [[0, 0], [-4, 0]]).crossings


def test_an_edge_that_crosses_itself_counts():
    (crossing,) = source_of([[0, 0], [10, 0], [10, 5], [5, 5], [5, -5]]).crossings
    assert crossing.edges == (0, 0)
    assert crossing.at == (5.0, 0.0)


def test_loops_and_parallel_edges_are_no_crossings():
    source = source_of(
        [[0, 0], [5, 0]],
        [[0, 0], [2, 3], [5, 0]],
        [[0, 0], [-3, 1], [-3, -1], [0, 0]],
        [[0, 0], [-1, 5], [1, 5], [0, 0]],
    )
    assert not source.crossings
    assert source.to_map().n_faces == 4


def test_a_street_across_a_loop_counts():
    source = source_of([[0, 0], [-3, 1], [-3, -1], [0, 0]], [[-5, 0], [-2, 0]])
    assert [crossing.edges for crossing in source.crossings] == [(0, 1)]


def test_dropping_takes_the_edge_with_most_crossings_and_says_so():
    streets = [[[x, 0], [x, 10]] for x in (1, 2, 3)]
    source = source_of(*streets, [[0, 5], [9, 5]])
    kept = source.without_crossings()
    assert kept.edge_names == ("e0", "e1", "e2")
    assert kept.n_vertices == 6
    assert kept.notes == ("dropped 1 of 4 edges that meet others without a vertex: 'e3'",)
    assert not kept.crossings
    assert kept.to_map().n_components == 3
    assert kept.without_crossings() is kept


def test_dropping_everything_is_refused():
    with pytest.raises(BadInput, match="no edge"):
        source_of([[0, 0], [10, 0], [10, 5], [5, 5], [5, -5]]).without_crossings()


def test_crossings_agree_with_pairwise_shapely_on_random_sticks():
    rng = np.random.default_rng(5)
    ends = rng.integers(0, 12, (40, 2, 2)).astype(float)
    ends = ends[(ends[:, 0] != ends[:, 1]).any(axis=1)]
    source = source_of(*ends.tolist())
    lines = source.geometry
    expected = {
        (i, j)
        for i in range(len(lines))
        for j in range(i + 1, len(lines))
        if shapely.intersects(lines[i], lines[j])
        and not shapely.intersection(lines[i], lines[j]).equals(
            shapely.MultiPoint(source.points[np.intersect1d(source.edges[i], source.edges[j])])
        )
    }
    assert {crossing.edges for crossing in source.crossings} == expected
    assert len(expected) > 50


def test_geometry_is_the_polylines():
    source = samples.load("garden")
    assert [line.geom_type for line in source.geometry] == ["LineString"] * 9
    assert source.geometry[1].coords[:] == [(8, 0), (16, 0)]


@pytest.mark.parametrize("name", samples.names())
def test_every_sample_is_a_valid_connected_plane_map(name):
    source = samples.load(name)
    assert isinstance(source, Source)
    assert not source.warnings
    plane = source.to_map()
    plane.validate()
    assert plane.n_components == 1
    if name != "helsinki_district":
        assert 4 <= plane.n_vertices <= 10
        assert 6 <= plane.n_edges <= 16


def test_the_paper_graph_has_its_cycles():
    plane = samples.load("figure8").to_map()
    outer = plane.cycle(["v0", "v1", "v8", "v7"])
    inner = plane.cycle(["v2", "v3", "v6", "v5", "v4"])
    assert outer.n_faces == 5
    assert inner.n_faces == 1
    assert outer.boundary.edge_set == {d >> 1 for d in plane.face_darts(plane.outer_face)}
    for u, v in (("v1", "v3"), ("v2", "v0"), ("v6", "v8"), ("v7", "v4")):
        assert plane.edge(u, v).edge_set.isdisjoint(outer.edge_set | inner.edge_set)


def test_the_district_is_of_the_promised_size_with_its_notice():
    source = samples.load("helsinki_district")
    plane = source.to_map()
    assert 300 <= source.n_edges <= 500
    assert int((plane.degree == 1).sum()) > 20
    ends = np.sort(source.edges, axis=1)
    assert len(np.unique(ends, axis=0)) < len(ends)  # parallel streets
    file = samples.path("helsinki_district")
    assert file.stat().st_size < 400_000
    text = file.read_text(encoding="utf-8")
    assert "OpenStreetMap contributors" in text
    assert "osm_ways" in text
    assert "ODbL-1.0" in (file.parent / "NOTICE.md").read_text(encoding="utf-8")


def test_an_unknown_sample_suggests_near_ones():
    with pytest.raises(UnknownName, match="figure8"):
        read_source("sample:figure-8")


def test_a_crossing_is_told_in_the_coordinates_of_the_file():
    lines = [[[24.94, 60.16], [24.96, 60.18]], [[24.94, 60.18], [24.96, 60.16]]]
    document = {"type": "MultiLineString", "coordinates": lines}
    with pytest.raises(BadInput, match=r"meet near longitude 24\.950000, latitude 60\.170000; add vertices"):
        parse_geojson(json.dumps(document)).to_map()
    across = [[[179.99, 0.0], [-179.99, 0.02]], [[179.99, 0.02], [-179.99, 0.0]], [[-179.99, 0.02], [-179.9, 0.02]]]
    document["coordinates"] = across
    found = parse_geojson(json.dumps(document))
    longitude, latitude = found.projection.degrees(found.crossings[0].at)
    assert (abs(longitude), latitude) == (180.0, 0.01)
    document |= {"coordinates": [[[0, 0], [4, 4]], [[0, 4], [4, 0]]], "ninefold": {"units": "m"}}
    with pytest.raises(BadInput, match=r"meet near \(2\.0, 2\.0\) metres; add vertices"):
        parse_geojson(json.dumps(document)).to_map()
