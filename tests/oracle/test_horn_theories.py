"""The Horn theories behind splitting: models are the composition tables, labels the tractable subclasses."""

import itertools

import pytest

from ninefold.encodings import H5, H8, NP8, RCC5, RCC8, encode_splitting, open_solver, theory_of

HORN = {calculus.name: theory_of(calculus).horn.value for calculus in (RCC8, RCC5)}
ALL = pytest.mark.parametrize("theory", HORN.values(), ids=list(HORN))


@ALL
def test_expressible_labels_are_those_closed_under_meet(theory):
    bit = {held: 1 << k for k, held in enumerate(theory.meaning)}
    assert len(bit) == theory.calculus.n_bases
    for mask in range(theory.calculus.universal + 1):
        members = [held for held in theory.meaning if bit[held] & mask]
        closed = all(bit[a & b] & mask for a, b in itertools.combinations(members, 2))
        assert closed == (mask in theory.subclass), theory.calculus.names(mask)


@ALL
def test_atoms_of_the_converse(theory):
    for k, held in enumerate(theory.meaning):
        turned = frozenset(theory.atoms[name] for name in held)
        assert theory.meaning[int(theory.calculus.base_converse[k])] == turned


@ALL
def test_all_clauses_but_the_selectors_are_horn(theory):
    """A network of labels in the subclass needs no clause with two positive atoms."""
    u = theory.calculus.universal
    for mask in theory.subclass.relations - {0}:
        encoding = encode_splitting(theory.calculus, 3, [(0, 1, mask), (1, 2, u), (0, 2, u)])
        names = set(encoding.variables.values())
        for clause in encoding.clauses:
            if not any(abs(literal) in names for literal in clause):
                assert sum(literal > 0 for literal in clause) <= 1


@pytest.mark.parametrize(("calculus", "triples"), [(RCC8, 193), (RCC5, 54)])
def test_number_of_models_on_three_regions(calculus, triples):
    u = calculus.universal
    encoding = encode_splitting(calculus, 3, [(0, 1, u), (1, 2, u), (0, 2, u)])
    theory = HORN[calculus.name]
    atoms = range(1, 3 * len(theory.atoms) + 1)
    count = 0
    with open_solver("minisat22", encoding.clauses) as solver:
        while solver.solve():
            model = {abs(literal): literal for literal in solver.model()}
            solver.add_clause([-model[atom] for atom in atoms])
            count += 1
    assert count == triples


def test_h5_is_closed():
    masks = H5.relations
    assert len(masks) == 28
    for r, s in itertools.product(masks, repeat=2):
        assert r & s in masks
        assert RCC5.compose(r, s) in masks
        assert RCC5.converse_of(r) in masks


def test_hard_labels_get_selectors():
    plain = encode_splitting(RCC8, 2, [(0, 1, RCC8.universal)])
    assert plain.n_vars == 6 + 8
    for mask in NP8:
        encoding = encode_splitting(RCC8, 2, [(0, 1, mask)])
        assert encoding.n_vars == 6 + mask.bit_count() + len(H8.split(mask))
