"""The pictures that the documents show: what the tool makes today, self-contained, small, with credit for the streets."""

import importlib.util
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "pictures"
PICTURES = sorted(FOLDER.glob("*.svg"))
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def tool():
    spec = importlib.util.spec_from_file_location("make_pictures", ROOT / "tools" / "make_pictures.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("file", PICTURES, ids=lambda f: f.name)
def test_a_picture_is_small_and_needs_nothing_from_outside(file):
    text = file.read_text("utf-8")
    assert len(text) < 300_000
    root = ElementTree.fromstring(text)
    assert root.tag == f"{SVG}svg"
    assert not {f"{SVG}script", f"{SVG}image", f"{SVG}foreignObject"} & {element.tag for element in root.iter()}
    assert not re.search(r"href|@import|url\((?!#)", text)
    assert "prefers-color-scheme:dark" in text


def test_the_documents_show_every_picture():
    shown = "".join((ROOT / name).read_text("utf-8") for name in ("README.md", "docs/index.md"))
    for name in re.findall(r'(?:src="|\]\()((?:docs/)?pictures/[^")]+)', shown):
        assert (ROOT / "docs" / name.removeprefix("docs/")).is_file()
    everywhere = "".join(file.read_text("utf-8") for file in [ROOT / "README.md", *ROOT.glob("docs/**/*.md")])
    assert all(f"pictures/{file.name}" in everywhere for file in PICTURES)
    assert "docs/pictures/district-beside.svg" in (ROOT / "README.md").read_text("utf-8")[:3000]


def test_the_streets_are_credited():
    pictures = [ElementTree.parse(FOLDER / name) for name in ("district-beside.svg", "lost.svg")]
    pages = [ROOT / name for name in ("README.md", "docs/index.md", "docs/how-to/where-am-i.md")]
    texts = [
        *(" ".join(element.text or "" for element in picture.iter(f"{SVG}text")) for picture in pictures),
        *(" ".join(page.read_text("utf-8").split()) for page in pages),
    ]
    assert all("\N{COPYRIGHT SIGN} OpenStreetMap contributors, ODbL" in text for text in texts)


def test_pictures_are_those_that_the_tool_makes(tool):
    """Up to the numbers in them, which may differ by rounding from one machine to another."""
    assert sorted(tool.PICTURES) == [file.name for file in PICTURES]
    for name, make in tool.PICTURES.items():
        made, kept = (re.sub(r"[-\d.,]+", "0", text) for text in (tool.slim(make()), (FOLDER / name).read_text("utf-8")))
        assert len(made) > 1000
        assert made == kept, f"{name} is out of date: run tools/make_pictures.py"
