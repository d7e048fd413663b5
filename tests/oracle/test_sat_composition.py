"""Composition by SAT from the model equals the table, for all relations."""

import itertools

import pytest

from ninefold.encodings import ALLEN, RCC5, RCC8, SOLVERS, SatComposition, compose_by_sat
from ninefold.errors import BadInput


@pytest.mark.parametrize("solver", SOLVERS)
def test_base_relations_with_every_solver(solver):
    with SatComposition(RCC8, solver) as composition:
        for r, s in itertools.product([1 << k for k in range(8)], repeat=2):
            assert composition.compose(r, s) == RCC8.compose(r, s), (RCC8.names(r), RCC8.names(s))


def test_all_relations_of_rcc5():
    with SatComposition(RCC5) as composition:
        for r, s in itertools.product(range(32), repeat=2):
            assert composition.compose(r, s) == RCC5.compose(r, s)


@pytest.mark.slow
def test_all_65536_pairs_of_relations():
    with SatComposition(RCC8) as composition:
        for r, s in itertools.product(range(256), repeat=2):
            assert composition.compose(r, s) == RCC8.compose(r, s), (RCC8.names(r), RCC8.names(s))


def test_one_question():
    assert RCC8.text(compose_by_sat(RCC8, RCC8.relation("EC"), RCC8.relation("NTPPi"))) == "DC"
    assert compose_by_sat(RCC8, 0, 255) == 0
    with pytest.raises(BadInput, match="256 is no relation"):
        compose_by_sat(RCC8, 256, 1)
    with pytest.raises(BadInput, match="use another encoding"):
        compose_by_sat(ALLEN, 1, 1)
