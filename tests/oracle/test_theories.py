"""What `encodings.theory` claims, over all labels: distributive algebras, scenarios without search, fewer splits."""

import dataclasses
import itertools

import numpy as np
import pytest

from ninefold.encodings import ALLEN, C8, H5, H8, POINT, Q8, RCC5, RCC8, theory_of
from ninefold.reasoner.engine.engine import Engine
from ninefold.reasoner.engine.graph import dense_frame
from ninefold.reasoner.engine.tables import Tables
from tests.oracle.network_reference import Reference, random_network

STUDIED = [RCC8, RCC5, POINT, ALLEN]
EACH = pytest.mark.parametrize("calculus", STUDIED, ids=lambda calculus: calculus.name)


def algebra_of_bases(calculus):
    """The least set of relations that holds the base relations, closed under converse, intersection and composition."""
    found = {1 << k for k in range(calculus.n_bases)} | {calculus.universal}
    waiting = list(found)
    while waiting:
        r = waiting.pop()
        new = {calculus.converse_of(r)}
        for s in found:
            new |= {r & s, calculus.compose(r, s), calculus.compose(s, r)}
        waiting += new - found - {0}
        found |= new - {0}
    return sorted(found)


def is_closed(calculus, xy, yz, xz):
    converse = calculus.converse_of
    return not (
        xz & ~calculus.compose(xy, yz)
        or xy & ~calculus.compose(xz, converse(yz))
        or yz & ~calculus.compose(converse(xy), xz)
    )


def first(theory, mask):
    return next(1 << k for k in theory.preference.value if mask >> k & 1)


@EACH
def test_base_relations_generate_a_distributive_algebra(calculus):
    for r, s, t in itertools.product(algebra_of_bases(calculus), repeat=3):
        if r & s:
            assert calculus.compose(r & s, t) == calculus.compose(r, t) & calculus.compose(s, t)


@EACH
def test_a_new_node_can_take_the_preferred_relations(calculus):
    """The labels v-x and v-y, closed with the base relation x-y, still fit after each took its first base relation."""
    theory = theory_of(calculus)
    assert sorted(theory.preference.value) == list(range(calculus.n_bases))
    triangles = 0
    for vx, vy in itertools.product(algebra_of_bases(calculus), repeat=2):
        for base in range(calculus.n_bases):
            if is_closed(calculus, vx, 1 << base, vy):
                triangles += 1
                assert first(theory, vy) & calculus.compose(first(theory, vx), 1 << base)
    assert triangles > 10


def broken_triangles(calculus, subclass):
    """How many closed triangles over a subclass break when each pair takes its first base relation."""
    theory, table, converse = theory_of(calculus), calculus.composition_table, calculus.converse_table
    members = np.array(sorted(subclass.relations - {0}))
    pick = np.array([0, *(first(theory, mask) for mask in range(1, calculus.universal + 1))])
    xy, yz = members[:, np.newaxis], members
    broken = 0
    for xz in members.tolist():
        closed = xz & ~table[xy, yz] | xy & ~table[xz, converse[yz]] | yz & ~table[converse[xy], xz]
        broken += int(((closed == 0) & (pick[xz] & table[pick[xy], pick[yz]] == 0)).sum())
    return broken


@pytest.mark.parametrize(("calculus", "subclass"), [(RCC8, H8), (RCC8, Q8), (RCC5, H5)], ids=["H8", "Q8", "H5"])
def test_all_pairs_can_take_the_preferred_relation_at_once(calculus, subclass):
    assert theory_of(calculus).at_once
    assert broken_triangles(calculus, subclass) == 0


def test_not_every_tractable_subclass_allows_that():
    assert broken_triangles(RCC8, C8) > 0


@EACH
def test_the_subclasses_are_closed_and_hold_the_base_relations(calculus):
    for known in theory_of(calculus).subclasses:
        relations = known.value.relations
        assert {1 << k for k in range(calculus.n_bases)} | {calculus.universal} <= relations
        for r, s in itertools.product(relations, repeat=2):
            assert r & s in relations
        assert {calculus.converse_of(r) for r in relations} == relations
        if calculus is RCC5:
            assert {calculus.compose(r, s) for r, s in itertools.product(relations, repeat=2)} <= relations


@EACH
def test_every_claim_names_its_source(calculus):
    theory = theory_of(calculus)
    assert theory.closure_decides
    sources = [theory.closure, theory.preference.source, *(known.source for known in theory.subclasses)]
    sources += [known.source for known in (theory.horn, theory.model) if known is not None]
    sources += [theory.at_once] if theory.at_once else []
    assert all(len(source) > 20 for source in sources)


def test_nothing_is_claimed_of_a_calculus_that_nobody_studied():
    own = dataclasses.replace(RCC8, name="own")
    renamed = dataclasses.replace(POINT, name="rcc8")  # a known name alone is not enough
    for calculus in (own, renamed):
        theory = theory_of(calculus)
        assert theory.calculus == calculus
        assert not theory.closure_decides
        assert (theory.subclasses, theory.at_once, theory.preference, theory.horn, theory.model) == (
            (),
            None,
            None,
            None,
            None,
        )
        assert theory.parts_of(0b101) == (0b001, 0b100)


def decisions(calculus, n, constraints, tables):
    stated = Reference(calculus).labels(n, constraints)
    pairs = [(i, j) for i, j in stated if i < j and len(stated[i, j]) < calculus.n_bases]
    i, j = np.array(pairs).T
    masks = np.array([calculus.relation(sorted(stated[pair])) for pair in pairs])
    frame = dense_frame(n)
    engine = Engine(tables, frame, frame.arcs(i, j), masks)
    consistent = engine.close() and engine.search()
    return consistent, engine.decisions


def test_rcc5_is_split_into_h5():
    """The same answers with a fraction of the splits that base relations take."""
    rng = np.random.default_rng(11)
    bases_only = Tables.of(RCC5, np.isin(np.arange(32), [0, 1, 2, 4, 8, 16, 31]))
    few = many = 0
    for _ in range(20):
        constraints = random_network(RCC5, rng, 12, 4.0, 2.5, lambda mask: True)
        answer, with_h5 = decisions(RCC5, 12, constraints, Tables.of(RCC5))
        again, with_bases = decisions(RCC5, 12, constraints, bases_only)
        assert answer == again
        few, many = few + with_h5, many + with_bases
    assert many > 5 * few > 0  # 218 and 33


def test_labels_in_h5_need_no_split_at_all():
    rng = np.random.default_rng(3)
    constraints = random_network(RCC5, rng, 10, 3.0, 3.0, H5.__contains__)
    assert decisions(RCC5, 10, constraints, Tables.of(RCC5)) == (True, 0)


def test_tables_are_made_once_a_calculus():
    again = dataclasses.replace(RCC5)
    assert again is not RCC5
    assert Tables.of(again) is Tables.of(RCC5)
    assert Tables.of(dataclasses.replace(RCC5, name="other")) is not Tables.of(RCC5)
    with pytest.raises(ValueError, match="read-only"):
        Tables.of(RCC5).converse[1] = 2
