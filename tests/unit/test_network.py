"""`Network`: what may be stated, and the arrays that come out."""

import math

import numpy as np
import pytest

from ninefold.encodings import ALLEN, POINT, RCC8
from ninefold.errors import BadInput, NinefoldError, UnknownName
from ninefold.reasoner.networks.network import Network
from ninefold.reasoner.networks.statement import Statement


@pytest.fixture
def house():
    net = Network(RCC8)
    net.add("kitchen", "house", "inside", label="plan")
    net.add("house", "garden", "disjoint meet", weight=math.inf)
    net.add("garden", "house", ["EC", "PO"], weight=2)
    net.add("kitchen", "kitchen", "EQ TPP")
    return net


def test_statements_are_kept_as_given(house):
    assert house.statements[0] == Statement("kitchen", ("NTPP",), "house", "plan", index=0, mask=RCC8.relation("NTPP"))
    assert house.statements[2] == Statement(
        "garden", ("EC", "PO"), "house", weight=2.0, index=2, mask=RCC8.relation("EC PO")
    )
    assert [s.cost for s in house.statements] == [1.0, math.inf, 2.0, 1.0]
    assert [s.hard for s in house.statements] == [False, True, False, False]
    assert [str(s) for s in house.statements] == ["plan", "statement 2", "statement 3", "statement 4"]
    assert house.entities == ("kitchen", "house", "garden")
    assert house.index("garden") == 2
    assert repr(house) == "Network(rcc8, 3 entities, 4 statements)"
    assert (house.n_entities, house.n_statements) == (3, 4)


def test_constraints_are_intersections(house):
    pairs = house.constraints()
    assert pairs.triples() == [(0, 1, RCC8.relation("NTPP")), (1, 2, RCC8.relation("EC"))]
    assert [pairs.statements(p) for p in range(len(pairs))] == [[0], [1, 2]]
    assert (pairs.i.dtype, pairs.j.dtype, pairs.mask.dtype) == (np.int32, np.int32, np.uint8)
    assert house.constraints() is pairs
    with pytest.raises(ValueError, match="read-only"):
        pairs.mask[0] = 1
    house.add("garden", "kitchen", "DC")
    assert len(house.constraints()) == 3
    assert len(pairs) == 2


def test_contradiction_on_one_pair_is_kept():
    net = Network("rcc8")
    net.add("a", "b", "DC")
    net.add("b", "a", "EQ")
    assert net.constraints().triples() == [(0, 1, 0)]
    assert net.stated("a", "b") == 0


def test_stated(house):
    assert RCC8.text(house.stated("house", "kitchen")) == "NTPPi"
    assert RCC8.text(house.stated("garden", "house")) == "EC"
    assert house.stated("garden", "kitchen") == RCC8.universal
    assert RCC8.text(house.stated("garden", "garden")) == "EQ"
    with pytest.raises(UnknownName, match="there is no entity named 'kitchn'; did you mean 'kitchen'"):
        house.stated("kitchn", "house")


def test_empty_network():
    net = Network(POINT)
    assert len(net.constraints()) == 0
    assert net.constraints().triples() == []
    net.add_entity("x")
    assert len(net.constraints()) == 0
    assert net.entities == ("x",)


def test_large_calculi_use_wider_masks():
    net = Network(ALLEN)
    net.add(1, 0, "before after")
    net.add(2, 1, "<")
    pairs = net.constraints()
    assert net.entities == ("1", "0", "2")
    assert pairs.mask.dtype == np.uint16
    assert [ALLEN.text(mask) for _, _, mask in pairs.triples()] == ["< >", ">"]


def test_random_statements_against_dictionaries():
    rng = np.random.default_rng(1)
    net, labels, touching = Network(RCC8), {}, {}
    for at in range(400):
        i, j, mask = int(rng.integers(0, 20)), int(rng.integers(0, 20)), int(rng.integers(1, 256))
        if i == j:
            mask |= RCC8.identity
        net.add(i, j, mask)
        a, b = net.index(i), net.index(j)
        if a > b:
            a, b, mask = b, a, RCC8.converse_of(mask)
        if a != b:
            labels[a, b] = labels.get((a, b), 255) & mask
            touching.setdefault((a, b), []).append(at)
    pairs = net.constraints()
    assert {(i, j): mask for i, j, mask in pairs.triples()} == labels
    assert {(i, j): pairs.statements(p) for p, (i, j, _) in enumerate(pairs.triples())} == touching
    assert pairs.triples() == sorted(pairs.triples())


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("a", "b", ""), "is empty"),
        (("a", "b", []), "is empty"),
        (("a", "b", 0), "allows no relation at all"),
        (("a", "b", 256), "masks run from 0 to 255"),
        (("a", "b", "NTTP"), "there is no relation named 'NTTP'"),
        (("a", "a", "DC EC"), "'a' cannot be DC EC of itself: without EQ no entity is related to itself"),
        (("", "b", "DC"), "non-empty string or an integer"),
        ((" ", "b", "DC"), "non-empty string or an integer"),
        ((None, "b", "DC"), "non-empty string or an integer"),
        ((True, "b", "DC"), "non-empty string or an integer"),
        (("a", 1.5, "DC"), "non-empty string or an integer"),
        (("a", "b", "DC", ""), "a label is a non-empty string"),
        (("a", "b", "DC", 7), "a label is a non-empty string"),
        (("a", "b", "DC", None, -1), "a weight is not negative"),
        (("a", "b", "DC", None, float("nan")), "a weight is not negative"),
        (("a", "b", "DC", None, "1"), "a weight is a number"),
        (("a", "b", "DC", None, True), "a weight is a number"),
    ],
)
def test_a_refused_statement_changes_nothing(house, arguments, message):
    before = house.copy()
    with pytest.raises(NinefoldError, match=message):
        house.add(*arguments)
    assert house == before


def test_self_statement_may_hold_more_than_equality(house):
    assert house.statements[3].mask == RCC8.relation("EQ TPP")
    assert all(3 not in house.constraints().statements(p) for p in range(2))


def test_subset_and_copy(house):
    some = house.subset([2, 0])
    assert some.entities == house.entities
    assert [(s.index, s.a, s.mask) for s in some.statements] == [
        (0, "kitchen", RCC8.relation("NTPP")),
        (1, "garden", RCC8.relation("EC PO")),
    ]
    some.add("attic", "house", "inside")
    assert house.n_entities == 3
    assert house.copy() == house
    assert house.copy() is not house
    assert house.subset([]) != house
    for bad in ([4], [-1]):
        with pytest.raises(BadInput, match="numbered 0 to 3"):
            house.subset(bad)


def test_sorts_are_kept():
    net = Network("rcc8")
    assert net.add_entity("p", sort="point") == 0
    assert net.add_entity("p") == 0
    net.add("p", "r", "DC")
    assert net.sorts == ("point", None)
    with pytest.raises(BadInput, match="has sort 'point'; it cannot be 'line'"):
        net.add_entity("p", sort="line")


def test_from_constraints():
    net = Network.from_constraints(RCC8, 3, [(2, 1, 1)])
    assert net.entities == ("0", "1", "2")
    assert net.constraints().triples() == [(1, 2, 1)]
    with pytest.raises(BadInput, match="not between entities 0 to 2"):
        Network.from_constraints(RCC8, 3, [(0, 3, 1)])


def test_is_mutable_and_so_unhashable(house):
    with pytest.raises(TypeError):
        hash(house)
    assert house != "house"
    with pytest.raises(BadInput, match="needs a calculus"):
        Network(8)
    with pytest.raises(UnknownName, match="did you mean 'rcc8'"):
        Network("rcc88")
