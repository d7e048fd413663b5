"""Files are recognised by what is in them, and all become the same map."""

from __future__ import annotations

import shutil

import pytest

import ninefold as nf
from ninefold.errors import BadInput
from ninefold.io import Atlas, read_source, samples
from ninefold.io.formats import format_of
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
    found = {name: format_of(tmp_path / name) for name in ("log", "marked", "streets", "kept")}
    assert found == {"log": "walk", "marked": "walk", "streets": "source", "kept": "atlas"}


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
