"""The cell-pair encoding: a model of the regions themselves, instead of the composition table.

Every somewhere-clause a label may need, and every region, gets a pair of cells of its own (an island); two variables a
region and island say which of the two cells the region holds. The base relation that is chosen for a constrained pair
switches its never-clauses on at all islands and its somewhere-clauses at the islands of the pair. Nothing is composed:
a model is a set of regions, and the scenario is read off them, for all pairs, constrained or not.

Examples
--------
>>> from ninefold.encodings import RCC8, encode_cells
>>> encoding = encode_cells(RCC8, 3, [(0, 1, RCC8.relation("inside")), (1, 2, RCC8.relation("disjoint"))])
>>> from ninefold.encodings.sat import open_solver
>>> with open_solver(clauses=encoding.clauses) as solver:
...     consistent = solver.solve()
...     scenario = encoding.decode(solver.model())
>>> {pair: RCC8.text(mask) for pair, mask in scenario.items()}
{(0, 1): 'NTPP', (0, 2): 'DC', (1, 2): 'DC'}

References
----------
J. Renz, "A canonical model of the region connection calculus", Journal of Applied Non-Classical Logics 12, 2002.
B. Bennett, "Spatial reasoning with propositional logics", KR 1994, for regions as formulas and clauses that hold
everywhere or somewhere.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from ninefold.errors import BadInput

from .encoding import Clause, Constraint, Encoding, Labels, label_matrix
from .model import relation_between
from .theory import theory_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from .calculus import Calculus

__all__ = ["encode_cells"]


def encode_cells(calculus: Calculus, n: int, constraints: Iterable[Constraint]) -> Encoding:
    """Encode a network of regions by what they look like at pairs of cells.

    Parameters
    ----------
    calculus
        One with a model (see `ninefold.encodings.theory`): RCC-8 or RCC-5.

    Notes
    -----
    `Encoding.variables` has the constrained pairs only, but the decoded scenario covers all pairs.

    Raises
    ------
    BadInput
        A calculus that is not about regions.

    Complexity
    ----------
    O(m (m + n)) clauses for m constrained pairs, at most 12 a pair and island.
    """
    known = theory_of(calculus).model
    if known is None:
        raise BadInput(f"cells are a model of rcc8 and rcc5, not of {calculus.name!r}: use another encoding")
    model = known.value
    labels = Labels(calculus, label_matrix(calculus, n, constraints))
    clauses: list[Clause] = labels.exactly_one()
    n_vars = len(labels.variables)

    # One island a region, for being non-empty, then as many a pair as its most demanding base relation needs.
    islands = {(i, j): max((len(model[k].somewhere) for k, _ in labels.bases(i, j)), default=0) for i, j in labels.labels}
    n_islands = n + sum(islands.values())
    first_cell = n_vars + 1

    def cells(region: int, island: int) -> tuple[int, int]:
        w1 = first_cell + 2 * (region * n_islands + island)
        return w1, w1 + 1

    n_vars += 2 * n * n_islands
    clauses.extend((cells(region, region)[0],) for region in range(n))
    at = n
    for (i, j), count in islands.items():
        guards: dict[str, int] = {}
        for k, variable in labels.bases(i, j):
            for pattern in model[k].never:
                if pattern not in guards:
                    n_vars += 1
                    guards[pattern] = n_vars
                clauses.append((-variable, guards[pattern]))
            # Cells can be exchanged within an island, so the pattern is asked for as it stands.
            for island, pattern in enumerate(model[k].somewhere, start=at):
                four = (*cells(i, island), *cells(j, island))
                clauses.extend((-variable, literal) for literal in _literals(pattern, four))
        at += count
        for pattern, guard in guards.items():
            for island in range(n_islands):
                four = (*cells(i, island), *cells(j, island))
                clauses.append((-guard, *(-literal for literal in _literals(pattern, four))))

    def decode(solution: Sequence[int]) -> dict[tuple[int, int], int]:
        true = np.zeros(n_vars + 1, dtype=bool)
        true[[literal for literal in solution if 0 < literal <= n_vars]] = True
        states = true[first_cell : first_cell + 2 * n * n_islands].reshape(n, n_islands, 2) @ np.array([1, 2])
        return {(i, j): relation_between(states[i], states[j], model) for i, j in combinations(range(n), 2)}

    return Encoding("cells", calculus, n, n_vars, tuple(clauses), labels.variables, decode)


def _literals(pattern: str, four: tuple[int, ...]) -> list[int]:
    return [variable if want == "1" else -variable for want, variable in zip(pattern, four, strict=True) if want != "."]
