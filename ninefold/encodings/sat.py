"""SAT solvers behind one Protocol: incremental, with assumptions, cores and a budget in seconds.

The back ends are python-sat's builds of CaDiCaL, Glucose, MiniSat and MapleSAT. A question is put in slices of
conflicts, so that a budget is kept within a slice, and so that Ctrl-C is seen between two slices; what was learned
stays. Glucose looks at its limits only where it restarts, which on some formulas is seldom: where a budget matters take
another.

Examples
--------
>>> from ninefold.encodings.sat import open_solver
>>> with open_solver("glucose42") as solver:
...     solver.add_clauses([[1, 2], [-1, 2]])
...     solver.solve(), solver.solve([-2]), solver.core()
(True, False, [-2])

References
----------
A. Ignatiev, A. Morgado and J. Marques-Silva, "PySAT: a Python toolkit for prototyping with SAT oracles", SAT 2018.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, Protocol, Self

from ninefold._wording import quoted
from ninefold.errors import BadInput, UnknownName

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from types import TracebackType

__all__ = ["DEFAULT_SOLVER", "SOLVERS", "SatSolver", "open_solver", "refutation"]

SOLVERS = ("cadical195", "cadical153", "glucose42", "glucose4", "maplechrono", "minisat22")
"""Names that `open_solver` takes."""

DEFAULT_SOLVER = "cadical195"

_FIRST_SLICE = 200
_SLICE_SECONDS = 0.05


class SatSolver(Protocol):
    """An incremental SAT solver over clauses of non-zero ints, a negative one being a negated variable."""

    @property
    def name(self) -> str:
        """Name of the back end."""

    def add_clause(self, clause: Sequence[int]) -> None:
        """Add one clause; the empty one makes the formula unsatisfiable for good."""

    def add_clauses(self, clauses: Iterable[Sequence[int]]) -> None:
        """Add clauses in order."""

    def solve(self, assumptions: Sequence[int] = (), budget: float | None = None) -> bool | None:
        """Tell whether there is a model in which every assumption holds; None when `budget` seconds are over."""

    def model(self) -> list[int]:
        """Return one literal a variable after `solve` said True; variables in no clause may be missing."""

    def core(self) -> list[int]:
        """Return assumptions that cannot hold together, after `solve` said False."""

    def close(self) -> None:
        """Free the solver; further calls are errors, but closing twice is not."""

    def __enter__(self) -> Self: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...


def open_solver(name: str = DEFAULT_SOLVER, clauses: Iterable[Sequence[int]] = ()) -> SatSolver:
    """Return a new solver that holds `clauses`; use it in a ``with`` statement.

    Raises
    ------
    UnknownName
        None of `SOLVERS`.
    """
    if name not in SOLVERS:
        raise UnknownName("SAT solver", name, SOLVERS)
    solver = _PySat(name)
    try:
        solver.add_clauses(clauses)
    except BaseException:
        solver.close()
        raise
    return solver


def refutation(clauses: Iterable[Sequence[int]], *, budget: float | None = None) -> bytes | None:
    """Return a refutation of clauses in DRAT, for any checker; None if they have a model, or when `budget` seconds are over.

    Written by CaDiCaL as it solves.

    Examples
    --------
    >>> refutation([[1, 2], [-1, 2], [1, -2], [-1, -2]]).splitlines()[-1]
    b'0'
    """
    with _PySat(DEFAULT_SOLVER, proof=True) as solver:
        solver.add_clauses(clauses)
        return solver.proof() if solver.solve(budget=budget) is False else None


class _PySat:
    """A solver of python-sat."""

    def __init__(self, name: str, *, proof: bool = False) -> None:
        from pysat.solvers import Solver

        self._name = name
        self._solver: Any = Solver(name=name, with_proof=True) if proof else Solver(name=name)
        self._false = False  # python-sat's back ends disagree about the empty clause, so it is kept here
        self._answer: bool | None = None
        self._by_clause = False
        self._slice = _FIRST_SLICE

    @property
    def name(self) -> str:
        return self._name

    def add_clause(self, clause: Sequence[int]) -> None:
        self.add_clauses((clause,))

    def add_clauses(self, clauses: Iterable[Sequence[int]]) -> None:
        solver = self._open()
        self._answer = None
        for clause in clauses:
            if not len(clause):
                self._false = True
            elif 0 in clause:
                raise BadInput(f"clause {quoted(list(clause))} holds 0, which is no literal: variables are numbered from 1")
            else:
                solver.add_clause(clause)

    def solve(self, assumptions: Sequence[int] = (), budget: float | None = None) -> bool | None:
        solver = self._open()
        if 0 in assumptions:
            raise BadInput("0 is no literal and cannot be assumed: variables are numbered from 1")
        if budget is not None and not budget > 0:
            raise BadInput(f"a budget is a positive number of seconds, not {quoted(budget)}")
        assumed = list(assumptions)
        self._answer = None
        self._by_clause = self._false
        if self._false:
            self._answer = False
            return False
        start = time.monotonic()
        answer = None
        while answer is None:
            before = time.monotonic()
            left = None if budget is None else budget - (before - start)
            if left is not None and left <= 0:
                return None
            solver.conf_budget(self._slice)
            answer = self._slice_of(solver, assumed)
            self._fit_slice(time.monotonic() - before, left)
        self._answer = answer
        return answer

    def _slice_of(self, solver: Any, assumed: list[int]) -> bool | None:
        from pysat.solvers import pysolvers

        try:
            # expect_interrupt: the back ends that know it leave Ctrl-C to Python, which raises between two slices
            answer: bool | None = solver.solve_limited(assumptions=assumed, expect_interrupt=True)
        except pysolvers.error as error:
            if "interrupt" not in str(error).lower():
                raise
            self._solver = None  # it was left by a jump out of its search, so it cannot even be freed safely
            raise KeyboardInterrupt from None
        return answer

    def _fit_slice(self, took: float, left: float | None) -> None:
        """Let the next slice take about `_SLICE_SECONDS`, and less near the end of the budget."""
        wish = _SLICE_SECONDS if left is None else min(_SLICE_SECONDS, max(left / 4, 1e-3))
        rate = self._slice / max(took, 1e-6)
        self._slice = int(min(max(rate * wish, 20), 4 * self._slice, 1_000_000))

    def model(self) -> list[int]:
        if self._answer is not True:
            raise BadInput("there is no model: the last question was not answered with True")
        model: list[int] = self._open().get_model()
        return model

    def core(self) -> list[int]:
        if self._answer is not False:
            raise BadInput("there is no core: the last question was not answered with False")
        if self._by_clause:
            return []
        return list(self._open().get_core() or ())

    def proof(self) -> bytes:
        if self._false:
            return b"0\n"
        return "".join(f"{line}\n" for line in self._open().get_proof()).encode()

    def close(self) -> None:
        if self._solver is not None:
            self._solver.delete()
            self._solver = None

    def _open(self) -> Any:
        if self._solver is None:
            raise BadInput(f"solver {self._name} is closed")
        return self._solver

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()
