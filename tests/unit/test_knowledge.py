"""Mapped regions and statements in one network."""

import math

import pytest

from ninefold.errors import BadInput, DifferentMaps
from ninefold.mapping import PlaneMap
from ninefold.reasoner import relate
from ninefold.reasoner.knowledge import KnowledgeBase
from ninefold.reasoner.networks.consistency import Consistent, Inconsistent
from ninefold.reasoner.networks.network import Network


@pytest.fixture(scope="module")
def plane():
    n = 4
    points = [(x, y) for y in range(n) for x in range(n)]
    edges = [(i, i + 1) for i in range(n * n) if i % n < n - 1] + [(i, i + n) for i in range(n * n - n)]
    return PlaneMap.from_geometry(points, edges)


@pytest.fixture(scope="module")
def names(plane):
    return {
        "district": plane.cycle([0, 1, 2, 3, 7, 11, 15, 14, 13, 12, 8, 4]),
        "plant": plane.cycle([5, 6, 10, 9]),
        "block 12": plane.cycle([6, 7, 11, 10]),
        "corner": plane.cycle([0, 1, 5, 4]),
    }


def test_mapped_relations_come_from_relate(plane, names):
    base = KnowledgeBase(plane, names)
    assert len(base.mapped) == 6
    for s in base.mapped:
        assert s.hard
        assert base.network.calculus.names(s.mask) == (relate(names[s.a], names[s.b]).rcc8,)
    assert isinstance(base.check(), Consistent)
    assert base.contradiction() is None


def test_things_never_mapped_are_reasoned_about(plane, names):
    base = KnowledgeBase(plane, names, [("boiler room", "plant", "inside")])
    assert base.infer("boiler room", "block 12").relations == ("DC",)
    assert base.infer("boiler room", "district").relations == ("NTPP",)
    assert base.ask("inside('boiler room', district) & ~meet('boiler room', corner)").answer == "entailed"
    assert base.ask("meet(plant, 'block 12')").answer == "entailed"
    assert base.infer("plant", "block 12").relations == ("EC",)


def test_a_contradiction_names_what_was_said(plane, names):
    base = KnowledgeBase(plane, names)
    base.say("boiler room", "plant", "inside", label="the plan")
    base.say("annexe", "plant", "overlap", label="a rumour")
    base.say("boiler room", "block 12", "meet | overlap", label="the caretaker")
    assert isinstance(base.check(), Inconsistent)
    found = base.contradiction()
    assert [str(s) for s in found.said] == ["the plan", "the caretaker"]
    assert [(s.a, s.b) for s in found.mapped] == [("plant", "block 12")]
    text = str(found)
    assert "contradicts the map" in text
    assert "(the caretaker)" in text
    assert "rumour" not in text


def test_contradicting_the_map_outright(plane, names):
    base = KnowledgeBase(plane, names, [("plant", "block 12", "disjoint", "a neighbour", 3)])
    found = base.contradiction()
    assert len(found.said) == len(found.mapped) == 1
    assert "plant disjoint block 12 (a neighbour)" in str(found)
    assert "plant meets block 12" in str(found)


def test_what_was_said_can_contradict_itself(plane, names):
    base = KnowledgeBase(plane, names, [("x", "y", "inside"), ("y", "x", "inside")])
    found = base.contradiction()
    assert not found.mapped
    assert "contradicts itself" in str(found)


def test_statements_from_a_network(plane, names):
    said = Network("rcc8")
    said.add("boiler room", "plant", "inside", label="plan", weight=2)
    base = KnowledgeBase(plane, names, said)
    (s,) = base.said
    assert (s.label, s.weight) == ("plan", 2)
    again = KnowledgeBase(plane, names, said.statements)
    assert again.said == base.said
    assert base.mapped[0].weight == math.inf


def test_bad_input(plane, names):
    with pytest.raises(BadInput, match="only regions"):
        KnowledgeBase(plane, {"v": plane.vertex(3)})
    other = PlaneMap.from_geometry([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)])
    with pytest.raises(DifferentMaps):
        KnowledgeBase(plane, {"t": other.cycle([0, 1, 2])})
    with pytest.raises(BadInput, match="rcc8"):
        KnowledgeBase(plane, names, Network("point"))
    with pytest.raises(BadInput, match="a statement is"):
        KnowledgeBase(plane, names, [("x", "y")])


def test_a_statement_of_a_network_is_taken_by_its_words(plane, names):
    coarse = Network("rcc5")
    said = coarse.add("boiler room", "plant", "EQ", label="hearsay")
    base = KnowledgeBase(plane, names, [said])
    assert base.said[0].relations == ("EQ",)
    assert base.said[0].mask == base.network.calculus.relation("EQ") != said.mask


def test_one_class_of_statement_serves_networks_and_atlases(plane, tmp_path):
    import ninefold as nf

    assert nf.io.Statement is nf.reasoner.Statement
    said = Network("rcc8").add("pond", "garden", "NTPP | TPP", "the deed", 2)
    assert repr(said) == "Statement(a='pond', relations=('TPP', 'NTPP'), b='garden', label='the deed', weight=2.0)"
    with nf.Atlas.from_map(plane, tmp_path / "town.atlas") as atlas:
        atlas.declare(said)
        (kept,) = atlas.statements
    assert kept == nf.io.Statement("pond", ("TPP", "NTPP"), "garden", "the deed", 2)
    assert (str(kept), kept.cost, kept.hard) == ("the deed", 2.0, False)
    assert str(nf.io.Statement("pond", ("TPP", "NTPP"), "garden")) == "pond TPP|NTPP garden"


def test_an_atlas_brings_its_regions_and_statements(plane, names, tmp_path):
    from ninefold.io.atlas.atlas import Atlas
    from ninefold.io.atlas.records import Statement

    with Atlas.from_map(plane, tmp_path / "town.atlas") as atlas:
        atlas.name_all({**names, "gate": "vertex:5"})
        atlas.declare(Statement("boiler room", ("inside",), "plant", label="the plan"))
        base = KnowledgeBase.from_atlas(atlas)
        assert set(base.names) == set(names)
        assert base.infer("boiler room", "block 12").relations == ("DC",)
        atlas.declare(Statement("boiler room", ("meet",), "block 12", label="the caretaker"))
        found = KnowledgeBase.from_atlas(atlas).contradiction()
        assert [str(s) for s in found.said] == ["the plan", "the caretaker"]
        atlas.declare(Statement("gate", ("meet",), "plant"))
        with pytest.raises(BadInput, match="between regions only"):
            KnowledgeBase.from_atlas(atlas)
