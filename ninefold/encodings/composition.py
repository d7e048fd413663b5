"""Composition worked out by a SAT solver from the cell-pair model, with no table in sight.

``R;S`` is the set of base relations T for which regions x, y, z with ``x R y``, ``y S z`` and ``x T z`` exist. The
cell-pair encoding of three regions is written down once; R and S are assumptions, and T is read off models until none
is left.

Examples
--------
>>> from ninefold.encodings import RCC8
>>> from ninefold.encodings.composition import compose_by_sat
>>> RCC8.text(compose_by_sat(RCC8, RCC8.relation("TPP"), RCC8.relation("TPPi")))
'DC EC PO TPP TPPi EQ'
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Self

from .cells import encode_cells
from .sat import open_solver

if TYPE_CHECKING:
    from types import TracebackType

    from .calculus import Calculus

__all__ = ["COMPOSITION_SOLVER", "SatComposition", "compose_by_sat"]

COMPOSITION_SOLVER = "minisat22"
"""Quickest of the solvers on many small questions."""


class SatComposition:
    """Composition of many relations on one incremental solver; use it in a ``with`` statement.

    Parameters
    ----------
    calculus
        RCC-8 or RCC-5.
    solver
        One of `ninefold.encodings.sat.SOLVERS`.
    """

    def __init__(self, calculus: Calculus, solver: str = COMPOSITION_SOLVER) -> None:
        universal = calculus.universal
        encoding = encode_cells(calculus, 3, [(0, 1, universal), (1, 2, universal), (0, 2, universal)])
        self._calculus = calculus
        self._left, self._right, self._whole = (
            [encoding.variables[i, j, k] for k in range(calculus.n_bases)] for i, j in ((0, 1), (1, 2), (0, 2))
        )
        self._solver = open_solver(solver, encoding.clauses)

    def compose(self, r: int, s: int) -> int:
        """Return the composition of two relations; one model for each base relation of it.

        Raises
        ------
        BadInput, UnknownName
            See `Calculus.relation`.
        """
        r, s = self._calculus.relation(r), self._calculus.relation(s)
        assumed = [-v for k, v in enumerate(self._left) if not r >> k & 1]
        assumed += [-v for k, v in enumerate(self._right) if not s >> k & 1]
        found = 0
        while found != self._calculus.universal and self._solver.solve(assumed):
            model = self._solver.model()
            k = next(k for k, variable in enumerate(self._whole) if model[variable - 1] > 0)
            found |= 1 << k
            assumed.append(-self._whole[k])
        return found

    def close(self) -> None:
        """Free the solver."""
        self._solver.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()


def compose_by_sat(calculus: Calculus, r: int, s: int, *, solver: str = COMPOSITION_SOLVER) -> int:
    """Return the composition of two relations of RCC-8 or RCC-5 as a SAT solver finds it; see `SatComposition`."""
    with SatComposition(calculus, solver) as composition:
        return composition.compose(r, s)
