"""Every encoding, with every solver, against plain search: same verdict, and a scenario that holds."""

import itertools

import numpy as np
import pytest

from ninefold.encodings import (
    ALLEN,
    ENCODINGS,
    NP8,
    ORDERS,
    POINT,
    RCC5,
    RCC8,
    SOLVERS,
    encode,
    encode_splitting,
    encode_triangulated,
    open_solver,
)
from ninefold.errors import BadInput, UnknownName
from tests.oracle.network_reference import Reference, random_network

REFERENCES = {calculus.name: Reference(calculus) for calculus in (RCC8, RCC5, POINT, ALLEN)}
REGIONS_ONLY = ("splitting", "cells")
PAIRED = [
    (calculus, name)
    for calculus in (RCC8, RCC5, POINT, ALLEN)
    for name in ENCODINGS
    if calculus in (RCC8, RCC5) or name not in REGIONS_ONLY
]
EVERY = pytest.mark.parametrize(("calculus", "name"), PAIRED, ids=lambda x: getattr(x, "name", x))


def solved(encoding, solver="minisat22"):
    with open_solver(solver, encoding.clauses) as back_end:
        answer = back_end.solve()
        return encoding.decode(back_end.model()) if answer else None


def confirm(calculus, n, constraints, encoding, scenario):
    """The decoded scenario holds, and where it does not cover all pairs it extends to them."""
    reference = REFERENCES[calculus.name]
    assert set(scenario) >= set(encoding.pairs)
    assert all(calculus.is_atomic(mask) for mask in scenario.values())
    named = {pair: calculus.names(mask)[0] for pair, mask in scenario.items()}
    if len(named) == n * (n - 1) // 2:
        assert reference.is_scenario(n, constraints, named)
    else:
        assert reference.solve(n, [*constraints, *((i, j, mask) for (i, j), mask in scenario.items())]) is not None


def networks(calculus, seed, count, sizes, degrees):
    """Random networks, some consistent and some not; every second one of RCC-8 has hard labels only."""
    rng = np.random.default_rng(seed)
    for at in range(count):
        n = int(rng.integers(*sizes))
        hard = calculus == RCC8 and at % 2
        size = max(1.4, calculus.n_bases * float(rng.uniform(0.3, 0.5)))
        keep = NP8.__contains__ if hard else lambda mask: True
        yield n, random_network(calculus, rng, n, float(rng.uniform(*degrees)) + 3 * hard, size, keep)


@EVERY
def test_every_triangle_of_base_relations(calculus, name):
    """All b^3 atomic networks of three entities, put as assumptions on the universal one."""
    u = calculus.universal
    encoding = encode(name, calculus, 3, [(0, 1, u), (1, 2, u), (0, 2, u)])
    with open_solver("minisat22", encoding.clauses) as solver:
        for a, b, c in np.ndindex(calculus.n_bases, calculus.n_bases, calculus.n_bases):
            possible = bool(int(calculus.base_composition[a, b]) >> c & 1)
            chosen = [encoding.variables[0, 1, a], encoding.variables[1, 2, b], encoding.variables[0, 2, c]]
            assert solver.solve(chosen) is possible, (calculus.names(1 << a), calculus.names(1 << b), 1 << c)
            if possible:
                assert encoding.decode(solver.model()) == {(0, 1): 1 << a, (1, 2): 1 << b, (0, 2): 1 << c}


@EVERY
def test_every_pair_label(calculus, name):
    """All labels of one pair: the models are its base relations, no more and no fewer."""
    masks = range(calculus.universal + 1) if calculus.n_bases <= 8 else range(0, calculus.universal + 1, 97)
    for mask in masks:
        encoding = encode(name, calculus, 2, [(1, 0, mask)])
        found = 0
        with open_solver("minisat22", encoding.clauses) as solver:
            while solver.solve():
                seen = encoding.decode(solver.model())[0, 1]
                assert not seen & found
                found |= seen
                k = seen.bit_length() - 1
                solver.add_clause([-encoding.variables[0, 1, k]])
        assert found == calculus.converse_of(mask)


@EVERY
def test_small_networks_as_assumptions(calculus, name):
    """Random labels on all pairs of four entities, under one encoding of the universal network."""
    n, rng = 4, np.random.default_rng(7)
    pairs = list(itertools.combinations(range(n), 2))
    encoding = encode(name, calculus, n, [(i, j, calculus.universal) for i, j in pairs])
    reference = REFERENCES[calculus.name]
    verdicts = set()
    with open_solver("minisat22", encoding.clauses) as solver:
        for _ in range(60):
            constraints = random_network(calculus, rng, n, 3, calculus.n_bases / 2.6)
            out = [
                -encoding.variables[min(i, j), max(i, j), k]
                for i, j, mask in constraints
                for k in range(calculus.n_bases)
                if not (mask if i < j else calculus.converse_of(mask)) >> k & 1
            ]
            answer = solver.solve(out)
            verdicts.add(answer)
            assert answer is (reference.solve(n, constraints) is not None)
            if answer:
                confirm(calculus, n, constraints, encoding, encoding.decode(solver.model()))
    assert verdicts == {True, False}


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("name", ENCODINGS)
def test_random_networks_with_every_solver(name, solver):
    verdicts = []
    for n, constraints in networks(RCC8, 15, 6, (8, 10), (5.0, 9.0)):
        encoding = encode(name, RCC8, n, constraints)
        scenario = solved(encoding, solver)
        verdicts.append(scenario is not None)
        assert verdicts[-1] == (REFERENCES["rcc8"].solve(n, constraints) is not None)
        if scenario is not None:
            confirm(RCC8, n, constraints, encoding, scenario)
    assert len(set(verdicts)) == 2


@EVERY
def test_larger_random_networks(calculus, name):
    degrees = {"rcc8": (4.0, 8.0), "rcc5": (2.0, 5.0), "point": (1.0, 4.0), "allen": (3.0, 6.0)}[calculus.name]
    verdicts = set()
    for n, constraints in networks(calculus, 12, 6, (8, 11), degrees):
        encoding = encode(name, calculus, n, constraints)
        scenario = solved(encoding)
        verdicts.add(scenario is not None)
        assert (scenario is not None) == (REFERENCES[calculus.name].solve(n, constraints) is not None)
        if scenario is not None:
            confirm(calculus, n, constraints, encoding, scenario)
    assert verdicts == {True, False}


@pytest.mark.parametrize("order", ORDERS)
def test_chordal_variants(order):
    for n, constraints in networks(RCC8, 13, 6, (8, 11), (4.0, 8.0)):
        want = REFERENCES["rcc8"].solve(n, constraints) is not None
        for encoding in (
            encode_triangulated(RCC8, n, constraints, order=order),
            encode_splitting(RCC8, n, constraints, order=order),
        ):
            scenario = solved(encoding)
            assert (scenario is not None) == want
            if want:
                confirm(RCC8, n, constraints, encoding, scenario)


@EVERY
def test_degenerate_networks(calculus, name):
    assert solved(encode(name, calculus, 1, [])) == {}
    contradiction = [(0, 1, 1), (1, 0, calculus.converse_of(calculus.universal & ~1))]
    assert solved(encode(name, calculus, 2, contradiction)) is None
    assert solved(encode(name, calculus, 3, [(0, 1, 0)])) is None
    encoding = encode(name, calculus, 3, [(0, 1, calculus.identity), (2, 1, calculus.identity)])
    scenario = solved(encoding)
    assert {scenario[0, 1], scenario[1, 2]} == {calculus.identity}


@EVERY
def test_statement_clauses_can_be_added_later(calculus, name):
    """`Encoding.clause` states a relation in either direction, so that selectors can guard it."""
    u = calculus.universal
    encoding = encode(name, calculus, 3, [(0, 1, u), (1, 2, u), (0, 2, u)])
    one, two = encoding.n_vars + 1, encoding.n_vars + 2
    mask = 1 | calculus.identity
    with open_solver("minisat22", encoding.clauses) as solver:
        solver.add_clause([*encoding.clause(2, 0, mask), -one])
        solver.add_clause([*encoding.clause(0, 2, u & ~calculus.converse_of(mask)), -two])
        assert solver.solve([one])
        assert encoding.decode(solver.model())[0, 2] & calculus.converse_of(mask)
        assert solver.solve([two])
        assert solver.solve([one, two]) is False
        assert set(solver.core()) == {one, two}


@EVERY
def test_same_input_same_clauses(calculus, name):
    (_, constraints), *_ = networks(calculus, 14, 1, (6, 7), (4.0, 5.0))
    one, two = (encode(name, calculus, 7, constraints) for _ in range(2))
    assert one.clauses == two.clauses
    assert one.variables == two.variables
    used = {abs(literal) for clause in one.clauses for literal in clause}
    assert max(used) <= one.n_vars
    assert set(one.variables.values()) <= set(range(1, one.n_vars + 1))


@pytest.mark.parametrize("name", ENCODINGS)
def test_bad_networks_are_refused(name):
    for n, constraints in [(0, []), (2, [(0, 2, 1)]), (2, [(-1, 0, 1)]), (2, [(1, 1, 1)]), (2, [(0, 1, 256)])]:
        with pytest.raises(BadInput):
            encode(name, RCC8, n, constraints)
    with pytest.raises(BadInput, match=r"the pair \(0, 2\) is not encoded"):
        encode("triangulated", RCC8, 3, [(0, 1, 1)]).clause(0, 2, 1)


def test_unknown_encoding_and_calculus():
    with pytest.raises(UnknownName, match="there is no encoding named 'supports'; did you mean 'support'"):
        encode("supports", RCC8, 2, [])
    for name in REGIONS_ONLY:
        with pytest.raises(BadInput, match="use another encoding"):
            encode(name, ALLEN, 2, [])
