"""Proofs: the fast checker against a plain one, and CNF with DRAT or LRAT against checkers that are not ours."""

import dataclasses
import itertools
import shutil
import subprocess

import numpy as np
import pytest
from dratify import check_proof, parse_dimacs
from hypothesis import given
from hypothesis import strategies as st
from pysat.solvers import Solver

from ninefold.encodings import ALLEN, NP8, POINT, RCC5, RCC8
from ninefold.errors import BadInput
from ninefold.reasoner import Inconsistent, Network, Proof, check, conflict, entails, prove, to_drat
from ninefold.reasoner.networks import proofs
from ninefold.reasoner.networks.propositional import to_cnf
from tests.oracle.network_reference import Reference, random_network
from tests.oracle.proof_reference import first_that_fails, why_lrat_is_refused


def is_hard(mask):
    return mask in NP8


def is_split(mask):
    """A label of RCC-5 that closure does not decide, or one that goes well with those."""
    return mask in (3, 6, 10) or (mask & 12 == 12 and not mask & 2)


CASES = {
    "rcc8": (RCC8, 24, 12.0, 4.0, is_hard),
    "rcc5": (RCC5, 16, 11.0, 2.2, is_split),
    "allen": (ALLEN, 9, 8.0, 7.5, None),
    "point": (POINT, 8, 4.0, 1.6, None),
}
FRAMES = ("dense", "chordal")
KINDS = list(itertools.product(CASES, FRAMES))


def refuted(name, frame, count, seed=0):
    """Random inconsistent networks and their proofs; a long tail of entities makes the engine keep few pairs."""
    calculus, n, degree, size, keep = CASES[name]
    rng = np.random.default_rng([seed, n])
    total = n if frame == "dense" else 4 * n
    while count:
        triples = random_network(calculus, rng, n, degree, size, keep or (lambda _: True))
        triples += [(k - 1, k, 1 << int(rng.integers(calculus.n_bases))) for k in range(n, total)]
        net = Network.from_constraints(calculus, total, triples)
        verdict = check(net, proof=True)
        if isinstance(verdict, Inconsistent):
            assert (verdict.proof.pairs is None) == (frame == "dense")
            count -= 1
            yield net, verdict.proof


def by_dratify(cnf, drat):
    found = check_proof(parse_dimacs(cnf), drat)
    return found.ok and found.reached_empty


def test_the_cases_need_learned_clauses():
    for frame in FRAMES:
        assert max(len(proof.clauses) for _, proof in refuted("rcc8", frame, 8)) > 3
        assert min(len(proof.clauses) for _, proof in refuted("rcc5", frame, 8)) > 1
        assert max(len(proof.clauses) for _, proof in refuted("allen", frame, 4)) > 1


# --- CNF + DRAT and LRAT -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("name", "frame"), KINDS)
def test_other_checkers_accept_every_proof(name, frame):
    for net, proof in refuted(name, frame, 8 if name != "allen" else 4):
        found = to_drat(net, proof)
        assert by_dratify(found.cnf.decode(), found.refutation.decode())
        again = to_drat(net, proof, lrat=True)
        assert again.cnf == found.cnf
        assert why_lrat_is_refused(again.cnf.decode(), again.refutation.decode()) is None
        header = next(line for line in found.cnf.decode().splitlines() if line.startswith("p"))
        assert header == f"p cnf {found.n_variables} {found.n_clauses}"
        assert sum(line[0] not in "cp" for line in found.cnf.decode().splitlines()) == found.n_clauses
        assert sum(line[0] != "d" for line in found.refutation.decode().splitlines()) == found.n_lines


@pytest.mark.skipif(shutil.which("drat-trim") is None, reason="no drat-trim on the PATH")
@pytest.mark.parametrize(("name", "frame"), KINDS)
def test_drat_trim_accepts_every_proof(name, frame, tmp_path):
    for at, (net, proof) in enumerate(refuted(name, frame, 3)):
        drat, cnf = to_drat(net, proof).write(tmp_path / f"{at}.drat")
        done = subprocess.run(["drat-trim", cnf, drat], capture_output=True, text=True)
        assert "s VERIFIED" in done.stdout, done.stdout


def test_a_damaged_refutation_is_refused():
    """Without any one of its learned clauses the rest does not follow: nothing is written that is not needed."""
    net, proof = max(refuted("rcc8", "dense", 12), key=lambda found: len(found[1].clauses))
    found, exact = to_drat(net, proof), to_drat(net, proof, lrat=True)
    cnf = found.cnf.decode()
    lines = found.refutation.decode().splitlines(keepends=True)
    # a derivation starts with its definition, a line whose fresh variable comes first
    starts = [k for k, line in enumerate(lines) if line[0] not in "-d" and int(line.split()[0]) > found.n_variables]
    assert len(starts) > 3
    assert not by_dratify(cnf, "".join(lines[: starts[-1]]))
    assert not by_dratify(cnf, "".join(lines[: starts[0]] + lines[starts[-1] :]))
    assert not by_dratify(cnf, "0\n")
    hinted = exact.refutation.decode().splitlines(keepends=True)
    for k in range(0, len(hinted), len(hinted) // 20):
        if " d " not in hinted[k]:
            assert why_lrat_is_refused(cnf, "".join(hinted[:k] + hinted[k + 1 :])) is not None


@pytest.mark.parametrize("name", ["rcc8", "rcc5", "allen"])
def test_a_proof_with_a_statement_left_out_is_refused(name):
    for net, _ in refuted(name, "dense", 2, seed=5):
        core = conflict(net).to_network()
        proof = check(core, proof=True).proof
        whole = to_drat(core, proof)
        assert by_dratify(whole.cnf.decode(), whole.refutation.decode())
        prove(core, proof)
        for left_out in range(core.n_statements):
            less = core.subset(set(range(core.n_statements)) - {left_out})
            assert less.n_entities == core.n_entities
            with pytest.raises(BadInput, match="another network"):
                prove(less, proof)
            forged = dataclasses.replace(proof, digest=proofs.digest_of(less))
            with pytest.raises(BadInput, match="does not follow"):
                prove(less, forged)
            with pytest.raises(BadInput, match="does not"):
                to_drat(less, forged)
            assert not by_dratify(without(whole, core, left_out), whole.refutation.decode())


def without(found, net, statement):
    """The CNF less the unit clauses of a statement, which is the only one about its pair."""
    said = net.statements[statement]
    pair = sorted((net.index(said.a), net.index(said.b)))
    lines = found.cnf.decode().splitlines(keepends=True)
    first = next(
        int(line.split()[1]) for line in lines if line.startswith("c ") and line.endswith(" pair {} {}\n".format(*pair))
    )
    units = {f"-{first + base} 0\n" for base in range(net.calculus.n_bases)}
    assert units & set(lines)
    return "".join(line for line in lines if line not in units)


def test_entailment_is_the_inconsistency_of_the_opposite():
    net = Network("rcc8")
    net.add("kitchen", "house", "NTPP")
    net.add("house", "garden", "DC")
    assert entails(net, "kitchen", "DC", "garden")
    opposite = net.copy()
    opposite.add("kitchen", "garden", RCC8.universal & ~RCC8.relation("DC"))
    found = to_drat(opposite, check(opposite, proof=True).proof)
    assert by_dratify(found.cnf.decode(), found.refutation.decode())


def test_statements_that_contradict_each_other_at_once():
    for calculus in (RCC8, POINT):
        net = Network.from_constraints(calculus, 3, [(0, 1, 1), (1, 0, calculus.converse_of(2))])
        proof = check(net, proof=True).proof
        prove(net, proof)
        found = to_drat(net, proof)
        assert by_dratify(found.cnf.decode(), found.refutation.decode())


def test_a_proof_that_does_not_hold_is_not_written():
    net = Network.from_constraints(RCC8, 3, [(0, 1, 1), (1, 2, 1)])
    with pytest.raises(BadInput, match="does not hold"):
        to_drat(net, Proof("rcc8", 3, proofs.digest_of(net), None, ((),)))
    forged = Proof("rcc8", 3, proofs.digest_of(net), None, (((0, 2, 4),), ((0, 2, 2),), ()))
    with pytest.raises(BadInput, match="clause 2 of the proof does not follow"):
        to_drat(net, forged)


def test_both_files_are_written_and_none_is_replaced(tmp_path):
    net, proof = next(refuted("rcc8", "dense", 1))
    found = to_drat(net, proof)
    files = found.write(tmp_path / "a.drat")
    assert files == (tmp_path / "a.drat", tmp_path / "a.cnf")
    assert [file.read_bytes() for file in files] == [found.refutation, found.cnf]
    (tmp_path / "b.cnf").write_text("mine")
    with pytest.raises(BadInput, match=r"b\.cnf: exists"):
        found.write(tmp_path / "b.drat")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.cnf", "a.drat", "b.cnf"]
    with pytest.raises(BadInput, match="another ending"):
        found.write(tmp_path / "c.cnf")


# --- the CNF is what the network says ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("calculus", "n"), [(RCC8, 6), (RCC5, 7), (POINT, 7), (ALLEN, 5)], ids=lambda x: getattr(x, "name", "")
)
def test_the_whole_cnf_can_be_satisfied_exactly_if_the_network_can(calculus, n):
    """With every pair, triangle and base relation; a part of these clauses is what a proof refutes."""
    reference, rng = Reference(calculus), np.random.default_rng(3)
    pairs = np.array(list(itertools.combinations(range(n), 2)))
    triangles = np.array(
        [
            (i, j, k, t, calculus.universal)
            for i, j, k in itertools.permutations(range(n), 3)
            if i < j
            for t in range(calculus.n_bases)
        ]
    )
    answers = set()
    for degree in [1.5, n - 1.0] * 10:
        triples = random_network(calculus, rng, n, degree, calculus.n_bases / 2.6)
        net = Network.from_constraints(calculus, n, triples)
        cnf = to_cnf(net, pairs, np.ones(len(pairs), dtype=bool), triangles)
        lines = [line for line in cnf.text.decode().splitlines() if line[0] not in "cp"]
        assert len(lines) == cnf.n_clauses
        with Solver("cadical195", [list(map(int, line.split()[:-1])) for line in lines]) as solver:
            possible = solver.solve()
        expected = reference.solve(n, triples)
        assert possible == (expected is not None)
        answers.add(possible)
        if expected:  # and a scenario, read as an assignment, satisfies every clause
            true = {
                calculus.n_bases * at + calculus.bases.index(expected[i, j]) + 1 for at, (i, j) in enumerate(pairs.tolist())
            }
            for line in lines:
                assert any((x > 0) == (abs(x) in true) for x in map(int, line.split()[:-1])), line
    assert answers == {True, False}


# --- the native checker --------------------------------------------------------------------------------------------------


def outcome(net, proof):
    """The number of the first clause that fails by the library's checker, or None."""
    try:
        prove(net, proof)
    except BadInput as error:
        return int(str(error).split()[1]) - 1
    return None


@pytest.mark.parametrize("form", ["plain", "compiled"])
@pytest.mark.parametrize(("name", "frame"), KINDS)
def test_both_checkers_find_the_same_first_clause_that_fails(name, frame, form, monkeypatch):
    cases = list(refuted(name, frame, 3))
    monkeypatch.setattr(type(proofs.start), "for_work", lambda kernel, _: getattr(kernel, form))
    rng = np.random.default_rng(1)
    outcomes = set()
    for net, proof in cases:
        variants = [proof.clauses, ((),)]
        for _ in range(3):  # drop a clause, or make a literal smaller
            kept = [clause for clause in proof.clauses if rng.random() < 0.8 or not clause]
            variants.append(tuple(kept))
            at = int(rng.integers(len(proof.clauses)))
            if proof.clauses[at]:
                (i, j, mask), *rest = proof.clauses[at]
                changed = ((i, j, mask & int(rng.integers(net.calculus.universal))), *rest)
                variants.append((*proof.clauses[:at], changed, *proof.clauses[at + 1 :]))
        for clauses in variants:
            stated = net.constraints().triples()
            expected = first_that_fails(net.calculus, net.n_entities, proof.pairs, stated, clauses)
            assert outcome(net, dataclasses.replace(proof, clauses=clauses)) == expected
            outcomes.add(expected is None)
    assert True in outcomes


def test_two_literals_on_one_pair_are_one():
    net = Network.from_constraints(POINT, 3, [(0, 1, 1), (1, 2, 1), (0, 2, 6)])
    proof = check(net, proof=True).proof
    twice = dataclasses.replace(proof, clauses=(((0, 2, 1), (2, 0, 1), (0, 2, 2)), ()))
    prove(net, twice)
    found = to_drat(net, twice)
    assert by_dratify(found.cnf.decode(), found.refutation.decode())


def test_proofs_of_what_is_not_there():
    net = Network.from_constraints(RCC8, 4, [(0, 1, 1), (1, 2, 1)])
    digest = proofs.digest_of(net)
    for pairs, clauses, match in [
        (((0, 9),), ((),), "two entities below 4"),
        (((1, 1),), ((),), "two entities below 4"),
        (None, (((0, 4, 1),), ()), "two entities below 4"),
        (((0, 1), (1, 2)), (((0, 3, 1),), ()), "pair 0, 3, which is not among"),
        (None, (((0, 1, 256),), ()), "masks of rcc8 run from 0 to 255"),
        (None, (((0, 1, -1),), ()), "masks of rcc8 run from 0 to 255"),
        (None, (((0, 1, 1 << 80),), ()), "masks of rcc8 run from 0 to 255"),
    ]:
        for reader in (prove, to_drat):
            with pytest.raises(BadInput, match=match):
                reader(net, Proof("rcc8", 4, digest, pairs, clauses))


# --- the reader ----------------------------------------------------------------------------------------------------------

GOOD = "ninefold-proof 1 rcc8 5 abc\npairs 0-1 1-2\n0 1 4 1 2 8 0\n0\n"
LONG = "9" * 5000


@pytest.mark.parametrize(
    ("text", "match"),
    [
        (GOOD.replace("rcc8 5", f"rcc8 {LONG}"), "line 1: .* N a number below 10"),
        (GOOD.replace("0-1", f"0-{LONG}"), "line 2: '0-999.* is no pair"),
        (GOOD.replace("0 1 4", f"0 1 {LONG}"), "line 3: '999.* is no number below 10"),
        (GOOD.replace("0 1 4", "0 1 \u0664"), "line 3: .* is no number"),
        (GOOD.replace("0 1 4", "0 1 -4"), "line 3: '-4' is no number"),
        (GOOD.replace("0 1 4", "0 1"), "line 3: a clause is triples"),
    ],
)
def test_one_clear_line_for_a_proof_that_cannot_be_read(text, match):
    with pytest.raises(BadInput, match=match) as caught:
        Proof.from_text(text)
    assert len(str(caught.value)) < 200
    assert "\n" not in str(caught.value)


@given(
    st.lists(st.tuples(st.integers(0, len(GOOD)), st.integers(0, 3), st.text("09 -\n\x00x\u0664", max_size=3)), max_size=4),
    st.sampled_from([1, 20, 5000]),
)
def test_a_mutated_proof_is_read_or_refused(cuts, times):
    text = GOOD
    for at, gone, put in cuts:
        text = text[:at] + put * times + text[at + gone :]
    try:
        proof = Proof.from_text(text)
    except BadInput:
        return
    assert Proof.from_text(proof.to_text()) == proof
