"""Nothing half-written, ever: every writer leaves what was there, and no temporary file, whatever goes wrong."""

import errno
import os

import numpy as np
import pytest

from ninefold._files import published, write_text
from ninefold.errors import BadInput, NinefoldError
from ninefold.io import samples, write_network, write_walk
from ninefold.io.atlas.atlas import Atlas
from ninefold.io.relations import write_relations
from ninefold.layout import draw
from ninefold.mapping import PlaneMap, Samples, Visit, Walk, WalkHeader
from ninefold.reasoner import Network

HALF = "half \ud800 a character"


def network(name="lake"):
    net = Network("rcc8")
    net.add(name, "park", "inside")
    return net


def walk(name="lake"):
    return Walk(WalkHeader(), (Visit("a"), Samples((0.0,)), Visit(name)))


def table(path, name="lake"):
    write_relations(path, [name, "park"], np.array([[0, 1]]), np.array([0b001001111]), force=True)


FIGURE = samples.load("figure8").to_map()

WRITERS = {
    "net.csv": lambda path, name: write_network(network(name), path),
    "net.json": lambda path, name: write_network(network(name), path),
    "net.csp": lambda path, name: write_network(network(name), path),
    "walk.jsonl": lambda path, name: write_walk(walk(name), path),
    "map.svg": lambda path, name: draw(FIGURE).save(path, title=name),
    "table.csv": lambda path, name: table(path, name),
    "map.atlas": lambda path, name: Atlas.from_map(FIGURE, path, force=True, warnings=[name]).close(),
}


@pytest.fixture(params=WRITERS)
def target(request, tmp_path):
    path = tmp_path / request.param
    path.write_text("precious")
    return path, WRITERS[request.param]


def untouched(path):
    return path.read_text() == "precious" and [file.name for file in path.parent.iterdir()] == [path.name]


def test_the_writers_replace_what_is_there(target):
    path, write = target
    write(path, "lake")
    assert b"precious" not in path.read_bytes()
    assert {file.name for file in path.parent.iterdir()} == {path.name}


def test_text_that_no_file_can_hold_leaves_the_old_file(target):
    path, write = target
    if path.suffix in (".csp", ".svg"):  # they have a way to write it, and the file is whole
        write(path, HALF)
        assert path.read_text(encoding="utf-8").rstrip().endswith((".", "</svg>"))
        return
    with pytest.raises(NinefoldError, match=r"cannot be written|holds half a character") as caught:
        write(path, HALF)
    assert "\n" not in str(caught.value)
    assert untouched(path)


@pytest.mark.parametrize("step", ["open", "fsync", "replace"])
def test_a_disk_that_fails_leaves_the_old_file(target, monkeypatch, step):
    path, write = target

    def full(*_, **__):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    if step == "open":
        if path.suffix == ".atlas":
            pytest.skip("SQLite opens its file itself")
        monkeypatch.setattr("pathlib.Path.open", full)
        monkeypatch.setattr("io.open", full)
    elif step == "fsync":
        monkeypatch.setattr(os, "fsync", full)
    else:
        monkeypatch.setattr("pathlib.Path.replace", full)
    with pytest.raises(BadInput, match=rf"{path.name}: cannot be written \(No space left on device\); nothing was changed"):
        write(path, "lake")
    monkeypatch.undo()
    assert untouched(path)


def test_any_error_in_the_block_leaves_the_old_file(tmp_path):
    path = tmp_path / "file"
    path.write_text("precious")
    with pytest.raises(TypeError), published(path, force=True) as temporary:
        temporary.write_text("half") and temporary.write_text(None)
    assert untouched(path)


def test_a_link_stays_a_link_and_permissions_stay(tmp_path):
    real = tmp_path / "real"
    real.write_text("old")
    real.chmod(0o600)
    link = tmp_path / "link"
    link.symlink_to(real)
    write_text(link, "new", force=True)
    assert link.is_symlink()
    assert real.read_text() == "new"
    assert real.stat().st_mode & 0o777 == 0o600


def test_a_name_that_is_none():
    with pytest.raises(BadInput, match="is no file name: it holds a null character"):
        write_text("a\0b", "text", force=True)


def test_a_name_almost_as_long_as_the_system_allows(tmp_path):
    path = tmp_path / ("n" * 250)
    write_text(path, "text", force=False)
    assert path.read_text() == "text"
    with pytest.raises(BadInput, match="exists already"):
        write_text(path, "other", force=False)


def test_a_map_named_by_half_a_character_is_refused_before_any_file():
    with pytest.raises(BadInput, match="half a character"):
        PlaneMap.from_rotation({HALF: ["b"], "b": [HALF]}, outer=("b", HALF))
