"""Relations kept as JSON, each with the reason it is there: held by `relate`, in bulk, by cells, by shapely on drawings."""

import json
from functools import cache

import numpy as np
import pytest
import shapely
from naive import de9im
from oracle_cases import FOLDER, MIRRORED, all_cases, made_map, made_set

from ninefold.layout import LAYOUTS, draw
from ninefold.layout.shapes import geometry
from ninefold.reasoner import Relation, SetTable, converse_codes, relate, relate_pairs

CASES = all_cases()
KEYS = {"case", "why", "map", "x", "y", "de9im", "name", "rcc8"}


@cache
def drawn(given: str):
    """A map and its drawings, one a layout; the compass layout needs headings."""
    plane = made_map(json.loads(given))
    plane.validate()
    drawings = [draw(plane, layout=layout) for layout in LAYOUTS if layout != "compass" or plane.heading is not None]
    assert len(drawings) >= len(LAYOUTS) - 1
    return plane, drawings


@pytest.mark.parametrize(("given", "case"), [pytest.param(*rest, id=name) for name, *rest in CASES])
def test_relation(given, case):
    plane, drawings = drawn(json.dumps(given))
    x, y = made_set(plane, case["x"]), made_set(plane, case["y"])
    there, back = relate(x, y), relate(y, x)
    word = case["name"]
    assert (there.de9im, there.name, there.rcc8) == (case["de9im"], word, case["rcc8"])
    assert back.de9im == "".join(case["de9im"][3 * k + row] for row in range(3) for k in range(3))
    assert back.name == MIRRORED.get(word, word)
    assert (back.converse, there.converse) == (there, back)
    assert Relation.from_de9im(case["de9im"], dimensions=(x.dimension, y.dimension)) == there

    codes = relate_pairs(SetTable.build([x, y]), [(0, 1), (1, 0)])
    assert codes.tolist() == [there.code, back.code]
    assert np.array_equal(converse_codes(codes), codes[::-1])

    assert (de9im(x, y), de9im(y, x)) == (there.de9im, back.de9im)
    for drawing in drawings:
        assert shapely.relate(geometry(drawing, x), geometry(drawing, y)) == there.de9im, drawing
        assert shapely.relate(geometry(drawing, y), geometry(drawing, x)) == back.de9im, drawing


def test_every_case_says_why_it_is_there():
    assert len(CASES) >= 150
    names = [name for name, _, _ in CASES]
    reasons = [case["why"].strip() for _, _, case in CASES]
    assert len(set(names)) == len(names)
    assert all(len(reason.split()) > 3 for reason in reasons)
    assert len(set(reasons)) == len(reasons)
    assert all(set(case) == KEYS for _, _, case in CASES)
    for file in FOLDER.iterdir():
        content = json.loads(file.read_text())
        assert content["about"]
        assert {case["map"] for case in content["cases"]} == set(content["maps"])  # no map that no case uses


def test_the_cases_hold_every_relation_of_the_literature():
    """Eight of simple regions, three of point and region, 19 of line and region, 33 of lines, each by one case."""
    counts = {"regions": 8, "point and region": 3, "line and region": 19, "lines": 33}
    found: dict[str, set[str]] = {theme: set() for theme in counts}
    for name, _, case in CASES:
        theme = next((t for t in counts if name.startswith((f"egenhofer: {t}:", f"egenhofer: {t} "))), None)
        if theme is not None and (theme != "lines" or " of 33" in name):
            found[theme].add("".join("F" if dimension == "F" else "T" for dimension in case["de9im"]))
    assert {theme: len(matrices) for theme, matrices in found.items()} == counts
