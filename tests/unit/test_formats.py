"""Files are recognised by what is in them, and all become the same map."""

from __future__ import annotations

import shutil

import pytest

import ninefold as nf
from ninefold.errors import BadInput, NinefoldError
from ninefold.io import Atlas, read_source, samples
from ninefold.io.formats import FORMATS, recognise, told_by
from ninefold.io.relations import write_relations
from ninefold.io.walks.json_lines import write_walk
from ninefold.mapping.robot.simulated import explore


def test_one_call_reads_every_format(tmp_path):
    walk = explore(read_source("sample:house").to_world()).walk
    write_walk(walk, tmp_path / "walk.jsonl")
    from_walk = nf.read_map(tmp_path / "walk.jsonl")
    Atlas.from_walk(walk, tmp_path / "house.atlas").close()
    assert nf.read_map(tmp_path / "house.atlas") == from_walk
    from_geometry = nf.read_map(str(samples.path("house")))
    assert nf.read_map("sample:house") == from_geometry
    assert set(from_geometry.edge_names) == set(from_walk.edge_names)
    assert (from_geometry.n_faces, from_geometry.n_components) == (from_walk.n_faces, 1)


def test_content_decides_where_the_suffix_does_not(tmp_path):
    write_walk(explore(read_source("sample:house").to_world()).walk, tmp_path / "log")
    (tmp_path / "marked").write_bytes(b"\xef\xbb\xbf" + (tmp_path / "log").read_bytes())
    shutil.copy(samples.path("house"), tmp_path / "streets")
    Atlas.from_map(read_source("sample:house").to_map(), tmp_path / "kept").close()
    found = {name: recognise(tmp_path / name).name for name in ("log", "marked", "streets", "kept")}
    assert found == {"log": "walk", "marked": "walk", "streets": "geojson", "kept": "atlas"}


def test_a_tolerance_replaces_that_of_the_walk(tmp_path):
    write_walk(explore(read_source("sample:house").to_world()).walk, tmp_path / "walk.jsonl")
    with pytest.raises(BadInput):
        nf.read_map(tmp_path / "walk.jsonl", tolerance=0.7)


def test_what_is_none_of_them_is_refused(tmp_path):
    (tmp_path / "notes.txt").write_text("hello")
    with pytest.raises(BadInput, match="neither an atlas"):
        nf.read_map(tmp_path / "notes.txt")
    with pytest.raises(BadInput, match="cannot be read"):
        nf.read_map(tmp_path)


@pytest.fixture
def files(tmp_path):
    """One file of each format, by what to call it."""
    source = read_source("sample:house")
    write_walk(explore(source.to_world()).walk, tmp_path / "walk.jsonl")
    Atlas.from_map(source.to_map(), tmp_path / "house.atlas").close()
    shutil.copy(samples.path("house"), tmp_path / "house.geojson")
    net = nf.Network("rcc8")
    net.add("a", "b", "EC")
    for suffix in ("csp", "csv", "json"):
        nf.io.write_network(net, tmp_path / f"net.{suffix}")
    write_relations(tmp_path / "table.csv", ["a", "b"], [[0, 1]], [0])
    nf.draw(source.to_map()).save(tmp_path / "map.svg")
    net.add("a", "b", "DC")
    (tmp_path / "proof.log").write_text(nf.check(net, proof=True).proof.to_text())
    (tmp_path / "graph.g2o").write_text("# drive 7\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n")
    nouns = {
        "walk.jsonl": "a walk log",
        "house.atlas": "an atlas",
        "house.geojson": "lines in GeoJSON",
        "net.csp": "a relation network",
        "net.csv": "a relation network",
        "net.json": "a relation network",
        "table.csv": "a table of relations",
        "map.svg": "a picture",
        "proof.log": "a proof of inconsistency",
        "graph.g2o": "a pose graph",
    }
    return {tmp_path / name: noun for name, noun in nouns.items()}


@pytest.mark.parametrize(
    ("read", "takes"),
    [
        (nf.read_map, {"a walk log", "an atlas", "lines in GeoJSON"}),
        (nf.read_walk, {"a walk log"}),
        (nf.read_network, {"a relation network"}),
        (read_source, {"lines in GeoJSON"}),
        (nf.io.read_pose_graph, {"a pose graph"}),
        (lambda path: Atlas.open(path).close(), {"an atlas"}),
    ],
)
def test_the_wrong_kind_of_file_is_called_what_it_is(files, read, takes):
    for path, noun in files.items():
        if noun in takes:
            read(path)
            continue
        with pytest.raises(NinefoldError, match=f"{path.name}: this is {noun}.*, not ") as caught:
            read(path)
        assert "\n" not in str(caught.value)


def test_the_wrong_kind_is_known_under_any_name(files, tmp_path):
    for path, noun in files.items():
        for suffix in (".csv", ".csp", ".json", ".jsonl", ".atlas", ".geojson", ""):
            other = tmp_path / f"other{suffix}"
            shutil.copy(path, other)
            assert told_by(other.read_bytes()[:4096]).noun.startswith(noun)


def test_every_entry_of_the_table_is_whole():
    assert len({known.name for known in FORMATS}) == len(FORMATS)
    suffixes = [suffix for known in FORMATS for suffix in known.suffixes]
    assert len(set(suffixes)) == len(suffixes)
    for known in FORMATS:
        assert known.noun
        assert known.use or "map" not in known.kinds or known.name == "sqlite"


def test_a_new_format_is_one_entry(monkeypatch, tmp_path):
    import ninefold.io.formats as formats

    entry = formats.Format(
        "shapes", "a shape", (".shp",), lambda head: head.startswith(b"SHAPE"), (), "`ninefold shapes FILE` reads it"
    )
    monkeypatch.setattr(formats, "FORMATS", (*FORMATS, entry))
    (tmp_path / "net.csv").write_text("SHAPE 0 1 2 3\n")
    with pytest.raises(BadInput, match=r"net\.csv: this is a shape, not a relation network .*; `ninefold shapes .*net.csv`"):
        nf.read_network(tmp_path / "net.csv")
