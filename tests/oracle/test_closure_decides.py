"""Algebraic closure alone decides networks over each tractable subclass, as the literature says."""

import numpy as np
import pytest

from ninefold.encodings import C8, H5, H8, Q8, RCC5, RCC8
from tests.oracle.network_reference import Reference, random_network


@pytest.mark.parametrize(
    ("calculus", "subclass"), [(RCC8, H8), (RCC8, Q8), (RCC8, C8), (RCC5, H5)], ids=["H8", "Q8", "C8", "H5"]
)
def test_closure_decides(calculus, subclass):
    reference, rng, verdicts = Reference(calculus), np.random.default_rng(4), []
    for _ in range(25):
        n = int(rng.integers(5, 8))
        degree, size = float(rng.uniform(2.5, 5)), calculus.n_bases * float(rng.uniform(0.28, 0.4))
        constraints = random_network(calculus, rng, n, degree, size, subclass.__contains__)
        closed = reference.closure(n, reference.labels(n, constraints)) is not None
        assert closed == (reference.solve(n, constraints) is not None)
        verdicts.append(closed)
    assert 3 < sum(verdicts) < 22
