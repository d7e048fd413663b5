"""Scenarios read off decisions: of every calculus, method and frame, and the same whatever is asked first."""

import copy
import pickle
import random

import numpy as np
import pytest

from ninefold.encodings import ALLEN, NP8, POINT, RCC5, RCC8
from ninefold.errors import BadInput, UnknownName
from ninefold.reasoner.engine.graph import dense_frame, triangulated_frame
from ninefold.reasoner.networks import deciding
from ninefold.reasoner.networks.completion import refined
from ninefold.reasoner.networks.consistency import Consistent, Inconsistent, check
from ninefold.reasoner.networks.network import Network
from ninefold.reasoner.networks.scenario import Scenario
from tests.oracle.network_reference import Reference, random_network

KINDS = {
    "rcc8": (RCC8, 7, 3.5, 4.0, lambda mask: True),
    "np8": (RCC8, 7, 3.5, 4.0, NP8.__contains__),
    "rcc5": (RCC5, 8, 4.0, 2.5, lambda mask: True),
    "point": (POINT, 8, 2.6, 2.0, lambda mask: True),
    "allen": (ALLEN, 5, 3.0, 5.0, lambda mask: True),
}
METHODS = {
    "rcc8": ["auto", "direct:glucose42", "support", "triangulated", "splitting:minisat22", "cells"],
    "np8": ["auto", "triangulated", "splitting"],
    "rcc5": ["auto", "direct", "support", "triangulated", "splitting", "cells"],
    "point": ["auto", "direct", "support", "triangulated"],
    "allen": ["auto", "support", "triangulated"],
}


def networks(kind, count, n=None, degree=None):
    calculus, size_n, size_d, size, keep = KINDS[kind]
    rng = np.random.default_rng([ord(kind[0]), count])
    n, degree = n or size_n, degree or size_d
    for _ in range(count):
        constraints = random_network(calculus, rng, n, degree, size, keep)
        yield constraints, Network.from_constraints(calculus, n, constraints)


def named(scenario):
    n = len(scenario.entities)
    return {(i, j): scenario.relation(i, j) for i in range(n) for j in range(i + 1, n)}


@pytest.mark.parametrize("frame_of", ["as it comes", "dense", "chordal"])
@pytest.mark.parametrize(("kind", "method"), [(kind, method) for kind in KINDS for method in METHODS[kind]])
def test_a_scenario_for_every_method_and_frame(kind, method, frame_of, monkeypatch):
    """It satisfies all statements and triangles, by the plain reference; where there is none plain search finds none."""
    if frame_of == "dense":
        monkeypatch.setattr(deciding, "triangulated_frame", lambda n, i, j, most: None)
    if frame_of == "chordal":
        monkeypatch.setattr(deciding, "triangulated_frame", lambda n, i, j, most: triangulated_frame(n, i, j, most=n * n))
    reference = Reference(KINDS[kind][0])
    verdicts = set()
    for constraints, net in networks(kind, 6):
        verdict = check(net, method=method)
        verdicts.add(type(verdict))
        if isinstance(verdict, Inconsistent):
            assert reference.solve(net.n_entities, constraints) is None
            continue
        assert isinstance(verdict, Consistent)
        scenario = verdict.scenario
        assert reference.is_scenario(net.n_entities, constraints, named(scenario))
        assert scenario.satisfies(net)
        assert scenario.is_closed()
        assert verdict.scenario is scenario
    assert Consistent in verdicts


@pytest.mark.parametrize("kind", KINDS)
def test_larger_sparse_networks(kind):
    """Pairs outside the completion fit together: the table of all pairs is closed."""
    sizes = {"rcc8": (60, 2.2), "np8": (60, 2.2), "rcc5": (60, 2.2), "point": (60, 2.0), "allen": (40, 2.0)}
    found = 0
    for _, net in networks(kind, 4, *sizes[kind]):
        verdict = check(net)
        if isinstance(verdict, Consistent):
            found += 1
            assert not verdict.decision.witness.frame.dense
            assert verdict.scenario.is_closed()
            assert verdict.scenario.satisfies(net)
    assert found


@pytest.mark.parametrize("kind", KINDS)
def test_the_order_of_questions_does_not_matter(kind):
    """A pair asked alone, in any order, from either end, before or after the whole table: always the same relation."""
    net = next(net for _, net in networks(kind, 20, 40, 1.8) if isinstance(check(net), Consistent))
    calculus = net.calculus
    whole = check(net).scenario.bases
    pairs = [(i, j) for i in range(40) for j in range(40)]
    for seed in range(2):
        random.Random(seed).shuffle(pairs)
        scenario = check(net).scenario
        assert all(scenario.mask(i, j) == 1 << int(whole[i, j]) for i, j in pairs[:300])
        assert (scenario.bases == whole).all()
    assert (calculus.base_converse[whole] == whole.T).all()
    again = check(net).scenario
    assert again == check(net).scenario
    assert pickle.dumps(check(net).scenario) == pickle.dumps(check(net).scenario)  # the same bytes


def test_ten_thousand_entities_need_no_table(monkeypatch):
    """A chain of random labels; pairs far apart are answered one by one and fit together."""
    n = 10_000
    rng = np.random.default_rng(0)
    net = Network.from_constraints(RCC8, n, [(i, i + 1, int(rng.integers(1, 255))) for i in range(n - 1)])
    scenario = check(net).scenario
    monkeypatch.setattr(Scenario, "bases", property(lambda self: pytest.fail("a table of all pairs was made")))
    assert scenario.satisfies(net)
    few = rng.choice(n, 6, replace=False).tolist()
    small = [[scenario.mask(a, b) for b in few] for a in few]
    for i in range(6):
        for j in range(6):
            for k in range(6):
                assert small[i][k] & RCC8.compose(small[i][j], small[j][k])
    assert repr(scenario).startswith("Scenario(rcc8, 10000 entities: 0 ")
    assert len(repr(scenario)) < 100


@pytest.mark.parametrize("calculus", [RCC8, RCC5, POINT, ALLEN], ids=lambda calculus: calculus.name)
def test_networks_that_say_nothing(calculus):
    for n in range(4):
        net = Network(calculus)
        for k in range(n):
            net.add_entity(k)
        scenario = check(net).scenario
        assert scenario.is_closed()
        assert len(scenario.triples()) == n * (n - 1) // 2
        if n > 1:
            net.add("0", "1", calculus.universal)
            assert check(net).scenario.is_closed()
    for k in range(30):
        net.add_entity(k)  # most of them related to nothing, so that the completion has nodes without neighbours
    scenario = check(net).scenario
    alone = [[scenario.mask(i, j) for j in range(30)] for i in range(30)]
    assert scenario.is_closed()
    assert (1 << scenario.bases.astype(np.int64) == alone).all()


def test_the_search_is_not_repeated(monkeypatch):
    """The scenario is made with the engine's search out of reach."""
    _, net = next(networks("np8", 1, 12, 6.0))
    verdict = check(net)
    assert isinstance(verdict, Consistent)
    monkeypatch.setattr("ninefold.reasoner.engine.engine.Engine.search", lambda *args: pytest.fail("searched again"))
    assert verdict.scenario.satisfies(net)


def test_a_scenario_asked_of_foreign_things():
    net = Network("rcc8")
    net.add("kitchen", "house", "inside")
    scenario = check(net).scenario
    other = Network("rcc8")
    other.add("kitchen", "hous", "inside")
    with pytest.raises(UnknownName, match="did you mean 'house'"):
        scenario.satisfies(other)
    with pytest.raises(BadInput, match="rcc8 says nothing of a network of rcc5"):
        scenario.satisfies(Network("rcc5"))
    assert repr(scenario) == "Scenario(rcc8, 2 entities: kitchen NTPP house)"


@pytest.mark.parametrize("sparse", [False, True])
def test_copies_are_equal_and_read_only(sparse):
    i, j = np.array([0, 1, 2, 3]), np.array([1, 2, 3, 4])
    frame = triangulated_frame(5, i, j, most=10) if sparse else dense_frame(5)
    found = refined(RCC8, frame, frame.arcs(i, j), np.array([1, 2, 4, 8], dtype=np.int16))
    scenario = Scenario.from_completion(found, tuple("abcde"))
    for again in (copy.deepcopy(scenario), pickle.loads(pickle.dumps(scenario))):
        assert again == scenario
        with pytest.raises(ValueError, match="read-only"):
            again.bases[0, 1] = 3
