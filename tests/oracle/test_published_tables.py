"""The derived and shipped tables against the literature and against an independent derivation."""

import itertools

import numpy as np
import pytest

from ninefold.encodings import ALLEN, POINT, RCC5, RCC8
from ninefold.encodings.model import RCC5_MODEL, RCC8_MODEL, relation_between

# Randell, Cui and Cohn 1992; the row a;b as in table 1 of Cohn, Bennett, Gooday and Gotts, "Qualitative spatial
# representation and reasoning with the region connection calculus", GeoInformatica 1, 1997. "*" is every relation.
# Columns: DC EC PO TPP NTPP TPPi NTPPi EQ.
RCC8_PUBLISHED = {
    "DC": "* | DC EC PO TPP NTPP | DC EC PO TPP NTPP | DC EC PO TPP NTPP | DC EC PO TPP NTPP | DC | DC | DC",
    "EC": "DC EC PO TPPi NTPPi | DC EC PO TPP TPPi EQ | DC EC PO TPP NTPP | EC PO TPP NTPP | PO TPP NTPP | DC EC | DC | EC",
    "PO": "DC EC PO TPPi NTPPi | DC EC PO TPPi NTPPi | * | PO TPP NTPP | PO TPP NTPP | DC EC PO TPPi NTPPi |"
    " DC EC PO TPPi NTPPi | PO",
    "TPP": "DC | DC EC | DC EC PO TPP NTPP | TPP NTPP | NTPP | DC EC PO TPP TPPi EQ | DC EC PO TPPi NTPPi | TPP",
    "NTPP": "DC | DC | DC EC PO TPP NTPP | NTPP | NTPP | DC EC PO TPP NTPP | * | NTPP",
    "TPPi": "DC EC PO TPPi NTPPi | EC PO TPPi NTPPi | PO TPPi NTPPi | PO TPP TPPi EQ | PO TPP NTPP |"
    " TPPi NTPPi | NTPPi | TPPi",
    "NTPPi": "DC EC PO TPPi NTPPi | PO TPPi NTPPi | PO TPPi NTPPi | PO TPPi NTPPi | PO TPP NTPP TPPi NTPPi EQ |"
    " NTPPi | NTPPi | NTPPi",
    "EQ": "DC | EC | PO | TPP | NTPP | TPPi | NTPPi | EQ",
}

# Columns: DR PO PP PPi EQ. Bennett, "Spatial reasoning with propositional logics", KR 1994; Jonsson and Drakengren,
# "A complete classification of tractability in RCC-5", JAIR 6, 1997, table 2.
RCC5_PUBLISHED = {
    "DR": "* | DR PO PP | DR PO PP | DR | DR",
    "PO": "DR PO PPi | * | PO PP | DR PO PPi | PO",
    "PP": "DR | DR PO PP | PP | * | PP",
    "PPi": "DR PO PPi | PO PPi | PO PP PPi EQ | PPi | PPi",
    "EQ": "DR | PO | PP | PPi | EQ",
}


@pytest.mark.parametrize(("calculus", "published"), [(RCC8, RCC8_PUBLISHED), (RCC5, RCC5_PUBLISHED)])
def test_derived_table_is_the_published_one(calculus, published):
    assert calculus.bases == tuple(published)
    for a, row in published.items():
        for b, cell in zip(calculus.bases, row.split("|"), strict=True):
            want = calculus.universal if cell.strip() == "*" else calculus.relation(cell)
            assert calculus.names(calculus.compose(calculus.relation(a), calculus.relation(b))) == calculus.names(want), (
                a,
                b,
            )


def test_number_of_possible_triples():
    assert sum(m.bit_count() for m in RCC8.base_composition.ravel().tolist()) == 193
    assert sum(m.bit_count() for m in RCC5.base_composition.ravel().tolist()) == 54


def test_rcc5_is_rcc8_without_boundaries():
    coarse = {"DR": "DC EC", "PO": "PO", "PP": "TPP NTPP", "PPi": "TPPi NTPPi", "EQ": "EQ"}
    fine = {name: RCC8.relation(words) for name, words in coarse.items()}
    for a, b in itertools.product(RCC5.bases, repeat=2):
        composed = RCC8.compose(fine[a], fine[b])
        names = {c for c in RCC5.bases if fine[c] & composed}
        assert names == set(RCC5.names(RCC5.compose(RCC5.relation(a), RCC5.relation(b))))


@pytest.mark.parametrize(("calculus", "model"), [(RCC8, RCC8_MODEL), (RCC5, RCC5_MODEL)])
def test_model_relations_are_exhaustive_disjoint_and_compose(calculus, model):
    # Every way in which two, then three, regions can look over up to three pairs of cells.
    rng = np.random.default_rng(20)
    for _ in range(1500):
        k = int(rng.integers(1, 5))
        x, y, z = rng.integers(0, 4, size=(3, k))
        if not (x.any() and y.any() and z.any()):
            continue
        xy, yz, xz = (relation_between(*pair, model) for pair in ((x, y), (y, z), (x, z)))
        assert calculus.is_atomic(xy)
        assert relation_between(y, x, model) == calculus.converse_of(xy)
        assert calculus.compose(xy, yz) & xz


def _point_relation(x, y):
    return "<" if x < y else ">" if x > y else "="


def _interval_relation(x, y):
    """Allen 1983, figure 2, by the four comparisons of end points."""
    (a, b), (c, d) = x, y
    if b < c:
        return "<"
    if b == c:
        return "m"
    if a < c:
        return "o" if b < d else "fi" if b == d else "di"
    if a == c:
        return "s" if b < d else "=" if b == d else "si"
    if a < d:
        return "d" if b < d else "f" if b == d else "oi"
    return "mi" if a == d else ">"


@pytest.mark.parametrize(
    ("calculus", "things", "relation"),
    [
        (POINT, range(3), _point_relation),
        (ALLEN, list(itertools.combinations(range(6), 2)), _interval_relation),  # three intervals have six end points
    ],
)
def test_shipped_definitions_follow_from_order(calculus, things, relation):
    composition = {pair: set() for pair in itertools.product(calculus.bases, repeat=2)}
    converse = {}
    for x, y, z in itertools.product(things, repeat=3):
        converse[relation(x, y)] = relation(y, x)
        composition[relation(x, y), relation(y, z)].add(relation(x, z))
    for a in calculus.bases:
        assert calculus.names(calculus.converse_of(calculus.relation(a))) == (converse[a],)
    for (a, b), want in composition.items():
        assert set(calculus.names(calculus.compose(calculus.relation(a), calculus.relation(b)))) == want
    assert calculus.names(calculus.identity) == ("=",)


def test_allen_has_409_triples():
    assert sum(m.bit_count() for m in ALLEN.base_composition.ravel().tolist()) == 409
