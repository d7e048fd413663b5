"""Every SAT back end keeps the Protocol: answers, models, cores, budget, interruption, closing."""

import itertools
import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from dratify import check_proof, parse_dimacs

from ninefold.encodings import DEFAULT_SOLVER, SOLVERS, open_solver
from ninefold.encodings.sat import refutation
from ninefold.errors import BadInput, UnknownName

ALL = pytest.mark.parametrize("name", SOLVERS)


def pigeons(holes):
    """One pigeon more than holes: unsatisfiable, and hopeless for resolution."""
    at = np.arange(1, (holes + 1) * holes + 1).reshape(holes + 1, holes).tolist()
    yield from at
    for hole in zip(*at, strict=True):
        yield from ([-x, -y] for x, y in itertools.combinations(hole, 2))


def random_clauses(rng, n_vars, n_clauses):
    for _ in range(n_clauses):
        chosen = rng.choice(n_vars, size=int(rng.integers(1, 4)), replace=False) + 1
        yield [int(v) if rng.random() < 0.5 else -int(v) for v in chosen]


def satisfies(values, clauses):
    return all(any((literal > 0) == values[abs(literal) - 1] for literal in clause) for clause in clauses)


@ALL
def test_answers_are_those_of_a_truth_table(name):
    rng = np.random.default_rng(3)
    verdicts = set()
    for _ in range(60):
        clauses = list(random_clauses(rng, 6, int(rng.integers(4, 16))))
        assumptions = [int(v) if rng.random() < 0.5 else -int(v) for v in rng.permutation(6)[:2] + 1]
        wanted = [*clauses, *([literal] for literal in assumptions)]
        possible = any(satisfies(values, wanted) for values in itertools.product([False, True], repeat=6))
        with open_solver(name, clauses) as solver:
            assert solver.name == name
            answer = solver.solve(assumptions)
            verdicts.add(answer)
            assert answer is possible
            if answer:
                true = {literal for literal in solver.model() if literal > 0}
                assert satisfies([v in true for v in range(1, 7)], wanted)
            else:
                core = solver.core()
                assert set(core) <= set(assumptions)
                kept = [*clauses, *([literal] for literal in core)]
                assert not any(satisfies(values, kept) for values in itertools.product([False, True], repeat=6))
    assert verdicts == {True, False}


@ALL
def test_is_incremental(name):
    with open_solver(name) as solver:
        assert solver.solve() is True
        solver.add_clause([1, 2])
        assert solver.solve([-1]) is True
        assert 2 in solver.model()
        solver.add_clauses([(-2, 3), (-3,)])
        assert solver.solve([-1]) is False
        assert solver.core() == [-1]
        assert solver.solve() is True
        assert {1, -2, -3} <= set(solver.model())
        solver.add_clause([-1])
        assert solver.solve() is False
        assert solver.core() == []


@ALL
def test_empty_clause_is_final(name):
    with open_solver(name, [[1], []]) as solver:
        assert solver.solve([1]) is False
        assert solver.core() == []
        solver.add_clause([2])
        assert solver.solve() is False


@ALL
def test_opposite_assumptions(name):
    with open_solver(name, [[1, 2]]) as solver:
        assert solver.solve([3, -3]) is False
        assert set(solver.core()) == {3, -3}


@ALL
def test_same_questions_same_models(name):
    clauses = [c for c in random_clauses(np.random.default_rng(8), 60, 300) if len(c) == 3]
    models = []
    for _ in range(2):
        with open_solver(name, clauses) as solver:
            assert solver.solve()
            models.append(solver.model())
    assert models[0] == models[1]


@ALL
def test_spent_budget_is_no_answer(name):
    with open_solver(name, pigeons(30)) as solver:
        assert solver.solve(budget=0.02) is None
        with pytest.raises(BadInput, match="no model"):
            solver.model()
        with pytest.raises(BadInput, match="no core"):
            solver.core()
        assert solver.solve(list(range(-931, -900)), budget=60) is False  # a question after it is answered as ever


@ALL
def test_misuse_is_refused(name):
    with open_solver(name, [[1]]) as solver:
        with pytest.raises(BadInput, match="0, which is no literal"):
            solver.add_clause([1, 0])
        with pytest.raises(BadInput, match="cannot be assumed"):
            solver.solve([0])
        for budget in (0, -1.0, float("nan")):
            with pytest.raises(BadInput, match="positive number of seconds"):
                solver.solve(budget=budget)
        with pytest.raises(BadInput, match="no model"):
            solver.model()
    with pytest.raises(BadInput, match="closed"):
        solver.solve()
    solver.close()


def test_unknown_solver():
    with pytest.raises(UnknownName, match="did you mean 'cadical195'"):
        open_solver("cadical")
    assert DEFAULT_SOLVER in SOLVERS


INTERRUPTED = """
import os, signal, sys, threading
from ninefold.encodings import open_solver
from tests.conformance.test_solvers import pigeons
with open_solver(sys.argv[1], pigeons(40)) as solver:
    assert solver.solve(budget=0.01) is None
    threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT)).start()
    try:
        solver.solve(budget=100)
    except KeyboardInterrupt:
        print("interrupted")
"""


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")
@ALL
def test_interrupt_key_is_a_keyboard_interrupt(name):
    assert signal.getsignal(signal.SIGINT) is not None
    done = subprocess.run([sys.executable, "-c", INTERRUPTED, name], capture_output=True, text=True, check=True)
    assert done.stdout == "interrupted\n"
    assert done.stderr == ""


# -- refutations ----------------------------------------------------------------------------------------------------------


def accepted(clauses, proof):
    header = f"p cnf {max(abs(x) for clause in clauses for x in clause)} {len(clauses)}\n"
    text = header + "".join(" ".join(map(str, [*clause, 0])) + "\n" for clause in clauses)
    found = check_proof(parse_dimacs(text), proof.decode())
    return found.ok and found.reached_empty


def test_a_refutation_is_accepted_by_a_foreign_checker():
    rng = np.random.default_rng(5)
    refuted = 0
    for _ in range(60):
        clauses = list(random_clauses(rng, 8, 36))
        proof = refutation(clauses)
        with open_solver(clauses=clauses) as solver:
            assert (proof is None) == solver.solve()
        if proof is not None:
            assert accepted(clauses, proof)
            refuted += 1
    assert refuted > 10
    holes = list(pigeons(5))
    assert accepted(holes, refutation(holes))
    assert not accepted(holes, b"0\n")
    assert refutation([[1], []]) == b"0\n"


def test_a_refutation_keeps_its_budget():
    assert refutation(pigeons(12), budget=0.05) is None
