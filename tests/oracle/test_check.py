"""The engine against plain search, its closure against plain closure, its proofs against the plain checker."""

import csv
import dataclasses
from pathlib import Path

import numpy as np
import pytest

from ninefold.encodings import ALLEN, NP8, POINT, RCC5, RCC8
from ninefold.errors import BadInput, UnknownName
from ninefold.io.networks.network_file import read_network
from ninefold.reasoner.engine.engine import Engine
from ninefold.reasoner.engine.graph import dense_frame, triangulated_frame
from ninefold.reasoner.engine.tables import Tables
from ninefold.reasoner.networks.consistency import Consistent, Inconsistent, Unknown, check
from ninefold.reasoner.networks.network import Network
from ninefold.reasoner.networks.proofs import Proof, prove
from tests.oracle.network_reference import Reference, random_network

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "data" / "networks"


def is_hard(mask):
    return mask in NP8


CASES = [
    (RCC8, 7, 4.0, 4.0, None),
    (RCC8, 8, 6.0, 4.0, is_hard),
    (RCC8, 9, 3.0, 4.0, is_hard),
    (RCC8, 6, 5.0, 2.0, None),
    (RCC5, 8, 5.0, 2.5, None),
    (POINT, 8, 4.0, 1.6, None),
    (ALLEN, 5, 3.0, 4.0, None),
]


def networks(calculus, n, degree, size, keep, count):
    rng = np.random.default_rng(n * 100 + calculus.n_bases)
    for _ in range(count):
        triples = random_network(calculus, rng, n, degree, size, keep or (lambda mask: True))
        yield triples, Network.from_constraints(calculus, n, triples)


@pytest.mark.parametrize(("calculus", "n", "degree", "size", "keep"), CASES, ids=lambda x: getattr(x, "name", ""))
def test_verdicts_scenarios_and_proofs(calculus, n, degree, size, keep):
    reference = Reference(calculus)
    seen = set()
    for triples, net in networks(calculus, n, degree, size, keep, 25 if calculus is not ALLEN else 8):
        expected = reference.solve(n, triples)
        verdict = check(net, proof=True)
        seen.add(type(verdict))
        if expected is None:
            assert isinstance(verdict, Inconsistent)
            assert verdict.proof is not None
            prove(net, Proof.from_text(verdict.proof.to_text()))
        else:
            assert isinstance(verdict, Consistent)
            scenario = verdict.scenario
            found = {(i, j): scenario.relation(str(i), str(j)) for i in range(n) for j in range(i + 1, n)}
            assert reference.is_scenario(n, triples, found)
    assert seen  # which of the two occur depends on the kind of network; over all kinds both do


def test_both_verdicts_occur():
    kinds = {type(check(net)) for case in CASES[:4] for _, net in networks(*case, 25)}
    assert kinds == {Consistent, Inconsistent}


@pytest.mark.parametrize("frame_of", ["dense", "chordal"])
def test_closure_equals_plain_closure(frame_of):
    """Every label of the engine's closure; on a chordal completion it may be weaker off the pairs kept, never stronger."""
    reference = Reference(RCC8)
    tables = Tables.of(RCC8)
    n = 9
    for triples, net in networks(RCC8, n, 3.0, 4.0, None, 30):
        stated = net.constraints()
        frame = dense_frame(n) if frame_of == "dense" else triangulated_frame(n, stated.i, stated.j, most=n * n)
        assert frame is not None
        engine = Engine(tables, frame, frame.arcs(stated.i, stated.j), stated.mask.astype(np.int16))
        closed = engine.close()
        plain = reference.closure(n, reference.labels(n, triples))
        assert closed or plain is None
        if plain is None or not closed:
            assert frame_of == "chordal" or not closed
            continue
        tail, head = frame.ends()
        for e, (p, q) in enumerate(zip(frame.order[tail].tolist(), frame.order[head].tolist(), strict=True)):
            label = reference.names(int(engine.relations()[2 * e]))
            assert plain[p, q] <= label
            assert frame_of == "chordal" or plain[p, q] == label


@pytest.mark.parametrize(
    "method", ["support:cadical195", "direct:glucose42", "triangulated", "splitting:minisat22", "cells"]
)
def test_encodings_are_referees(method):
    for _, net in networks(RCC8, 7, 4.0, 4.0, is_hard, 12):
        assert type(check(net, method=method)) is type(check(net))


def test_the_same_seed_gives_the_same_run():
    _, net = next(networks(RCC8, 20, 10.0, 4.0, is_hard, 1))
    first, again = (check(net, proof=True, seed=3) for _ in range(2))
    assert first == again


def test_a_budget_that_is_spent():
    rng = np.random.default_rng(1)
    net = Network.from_constraints(RCC8, 150, random_network(RCC8, rng, 150, 16.0, 4.0, is_hard))
    verdict = check(net, budget=1e-6)
    assert isinstance(verdict, Unknown)
    assert "not enough" in verdict.reason


def test_bad_arguments():
    net = Network("rcc8")
    net.add("a", "b", "DC")
    with pytest.raises(BadInput, match="positive"):
        check(net, budget=0)
    with pytest.raises(UnknownName, match="support"):
        check(net, method="supports")
    with pytest.raises(UnknownName, match="cadical"):
        check(net, method="support:cadical")
    with pytest.raises(BadInput, match="keeps a proof"):
        check(net, method="support", proof=True)


def test_no_verdict_without_a_theorem():
    """For a calculus from a file a closed network is not known to be consistent; a refuted one is refuted."""
    own = dataclasses.replace(POINT, name="own")
    net = Network(own)
    net.add("a", "b", "<")
    net.add("b", "c", "<")
    assert isinstance(check(net), Unknown)
    net.add("c", "a", "<")
    assert isinstance(check(net), Inconsistent)


@pytest.fixture(scope="module")
def refuted():
    for _, net in networks(RCC8, 14, 9.0, 4.0, is_hard, 60):
        verdict = check(net, proof=True)
        if isinstance(verdict, Inconsistent) and len(verdict.proof.clauses) > 3:
            return net, verdict.proof
    pytest.fail("no network here needs search to be refuted")


def test_damaged_proofs_are_refused(refuted):
    net, proof = refuted
    prove(net, proof)

    def refused(clauses, match):
        with pytest.raises(BadInput, match=match):
            prove(net, dataclasses.replace(proof, clauses=clauses))

    refused(proof.clauses[:-1], "does not end")
    refused(((),), "does not follow")  # every learned clause dropped
    # a mask flipped in the first clause: that no other relation is possible does not follow
    i, j, mask = proof.clauses[0][0]
    refused((((i, j, RCC8.universal & ~mask),), ()), "does not follow")
    other = net.copy()
    other.add("0", "1", "PO")
    with pytest.raises(BadInput, match="another network"):
        prove(other, proof)


@pytest.mark.parametrize(
    ("text", "match"),
    [
        ("", "line 1"),
        ("ninefold-proof 1 rcc8 x abc\npairs all\n0\n", "line 1"),
        ("ninefold-proof 1 rcc8 3 abc\n0\n", "line 2"),
        ("ninefold-proof 1 rcc8 3 abc\npairs 0-9\n0\n", "0-9"),
        ("ninefold-proof 1 rcc8 3 abc\npairs all\n0 1 0\n", "line 3"),
        ("ninefold-proof 1 rcc8 3 abc\npairs all\n0 9 4 0\n", "line 3"),
    ],
)
def test_proofs_that_cannot_be_read(text, match):
    with pytest.raises(BadInput, match=match):
        Proof.from_text(text)


@pytest.mark.skipif(not (FOLDER / "answers.csv").is_file(), reason="no folder ../shared/data/networks with recorded answers")
def test_recorded_answers_of_another_reasoner():
    with (FOLDER / "answers.csv").open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["answer"] and int(row["n"]) <= 200]
    for row in rows[::4]:
        verdict = check(read_network(next(FOLDER.rglob(row["file"]))), budget=60)
        assert isinstance(verdict, Consistent if row["answer"] == "sat" else Inconsistent), row["file"]
