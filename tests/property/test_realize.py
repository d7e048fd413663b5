"""Scenarios of random boxes, and of random networks, drawn and looked at by GEOS again."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from ninefold.encodings import POINT, RCC5, RCC8
from ninefold.errors import BadInput
from ninefold.layout.realization import realize
from ninefold.layout.witness import witness_svg
from ninefold.reasoner.networks.enumeration import scenarios
from ninefold.reasoner.networks.network import Network
from ninefold.reasoner.networks.scenario import Scenario
from ninefold.reasoner.sets.relation import RCC8_OF_NAME, Relation
from tests.oracle.network_reference import random_network

PART = {"TPP": "PP", "NTPP": "PP", "TPPi": "PPi", "NTPPi": "PPi", "DC": "DR", "EC": "DR"}


def seen(a, b):
    return RCC8_OF_NAME[Relation.from_de9im(shapely.relate(a, b)).name]


def scenario_of(shapes, calculus=RCC8):
    """The scenario that GEOS sees."""
    bases = np.zeros((len(shapes), len(shapes)), dtype=np.uint8)
    for i, a in enumerate(shapes):
        for j, b in enumerate(shapes):
            name = seen(a, b)
            bases[i, j] = calculus.bases.index(name if calculus == RCC8 else PART.get(name, name))
    return Scenario(calculus, tuple(f"r{k}" for k in range(len(shapes))), bases)


def confirm(scenario, shapes):
    names = scenario.entities
    assert list(shapes) == list(names)
    for name in names:
        assert shapes[name].is_valid
        assert (shapely.get_coordinates(shapes[name]) % 1 == 0).all()
    for a, b, relation in scenario.triples():
        name = seen(shapes[a], shapes[b])
        assert (name if scenario.calculus == RCC8 else PART.get(name, name)) == relation


boxes = st.lists(
    st.tuples(st.integers(0, 5), st.integers(0, 5), st.integers(1, 4), st.integers(1, 4)), min_size=1, max_size=9
)


@given(boxes, st.sampled_from([RCC8, RCC5]))
@settings(max_examples=120, deadline=None)
def test_scenarios_of_boxes(sides, calculus):
    scenario = scenario_of([shapely.box(x, y, x + w, y + h) for x, y, w, h in sides], calculus)
    assert scenario.is_closed()
    confirm(scenario, realize(scenario))


@given(st.integers(0, 10**6))
@settings(max_examples=60, deadline=None)
def test_scenarios_of_random_networks(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(2, 9))
    net = Network.from_constraints(RCC8, n, random_network(RCC8, rng, n, min(3.0, n - 1), 3.5))
    for scenario in [s for s, _ in zip(scenarios(net), range(3), strict=False)]:
        confirm(scenario, realize(scenario))


def test_a_hundred_regions():
    rng = np.random.default_rng(1)
    corners, sides = rng.integers(0, 40, (100, 2)), rng.integers(1, 20, (100, 2))
    shapes = [shapely.box(*corner, *(corner + side)) for corner, side in zip(corners, sides, strict=True)]
    scenario = scenario_of(shapes)
    found = realize(scenario)
    confirm(scenario, found)
    islands = {part.bounds for shape in found.values() for part in getattr(shape, "geoms", [shape])}
    assert len(islands) < 1000  # one island serves many pairs


def test_chains_reach_further_and_further():
    net = Network(RCC8)
    for k in range(30):
        net.add(f"r{k}", f"r{k + 1}", "inside" if k % 2 else "coveredBy")
    scenario = next(scenarios(net))
    confirm(scenario, realize(scenario))


def test_what_cannot_be_drawn_is_refused():
    bases = np.full((3, 3), RCC8.bases.index("EQ"), dtype=np.uint8)
    for i, j, name in ((0, 1, "NTPP"), (1, 2, "DC"), (0, 2, "EC")):
        bases[i, j] = RCC8.bases.index(name)
        bases[j, i] = RCC8.base_converse[bases[i, j]]
    with pytest.raises(BadInput, match="contradicts the composition table"):
        realize(Scenario(RCC8, ("a", "b", "c"), bases))
    points = Network(POINT)
    points.add("x", "y", "<")
    with pytest.raises(BadInput, match="only regions"):
        realize(next(scenarios(points)))


def test_one_region_and_none():
    one = Scenario(RCC8, ("a",), np.array([[RCC8.bases.index("EQ")]], dtype=np.uint8))
    assert realize(one)["a"].area > 0
    none = Scenario(RCC8, (), np.zeros((0, 0), dtype=np.uint8))
    assert realize(none) == {}


def test_the_picture_holds_every_region_and_is_safe_xml():
    import xml.etree.ElementTree as ElementTree

    net = Network(RCC8)
    net.add("a<b> & 'c' {height}", "ünï\x01", "overlap")
    shapes = realize(next(scenarios(net)))
    for theme in ("auto", "light", "dark"):
        svg = witness_svg(shapes, title="<two> regions", theme=theme)
        root = ElementTree.fromstring(svg)
        texts = [element.text for element in root.iter("{http://www.w3.org/2000/svg}text")]
        assert "a<b> & 'c' {height}" in texts
        assert "<two> regions" in texts
    assert witness_svg(shapes) == witness_svg(shapes)
    many = {f"region {k}": shape for k, shape in enumerate(list(shapes.values()) * 30)}
    ElementTree.fromstring(witness_svg(many))
    with pytest.raises(BadInput, match="no region"):
        witness_svg({})
    with pytest.raises(BadInput, match="theme"):
        witness_svg(shapes, theme="sepia")
    with pytest.raises(BadInput, match="width"):
        witness_svg(shapes, width=3)
