"""The decision that every other answer rests on: whether a network has a scenario, and what shows it.

Closure comes first. Where every label is in a tractable subclass (H8 of RCC-8) it decides; otherwise a conflict-driven
search with closure as its theory does (`ninefold.reasoner.engine`), on all pairs of a dense network and on a chordal
completion of a sparse one. ``method`` names an encoding and a SAT solver instead, an independent referee for small networks.

`decide` is what `conflicts`, `enumeration` and the others call; `consistency` wraps its `Decision` in a verdict for users.

References
----------
J. Renz and B. Nebel, "On the complexity of qualitative spatial reasoning: a maximal tractable fragment of the Region
Connection Calculus", Artificial Intelligence 108 (1999). J. Huang, "Compactness and its implications for qualitative spatial
and temporal reasoning", KR 2012 (patchwork, which is why a chordal completion is enough).
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from ninefold.encodings import encode, open_solver, theory_of
from ninefold.errors import BadInput, Undecided

from ..engine.engine import Engine
from ..engine.graph import dense_frame, triangulated_frame
from ..engine.tables import Tables
from .completion import refined
from .scenario import Scenario

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.encodings.calculus import Calculus

    from ..engine.graph import Frame
    from .network import Network

__all__ = ["Decision", "Kind", "Witness", "decide", "undecided", "why_unknown"]

DEFAULT_SOLVER = "cadical195"

Kind = Literal["time", "theory"]
"""Why a network was not decided: the budget ended first, or nobody has shown that closure decides its calculus."""


@dataclass(frozen=True, eq=False)
class Witness:
    """Labels that have a scenario, in a class of relations in which closure decides, and so finds one without search.

    Attributes
    ----------
    calculus, entities
        Of the network.
    frame
        Pairs on which closure decides: all of them, or a chordal completion.
    arcs, masks
        (P,) arcs of the frame and their labels; each stated label holds the one here.
    """

    calculus: Calculus
    entities: tuple[str, ...]
    frame: Frame
    arcs: NDArray[np.int64]
    masks: NDArray[np.int16]

    @cached_property
    def scenario(self) -> Scenario:
        """One base relation for every pair; made at the first request by one more closure."""
        return Scenario.from_completion(refined(self.calculus, self.frame, self.arcs, self.masks), self.entities)


@dataclass(frozen=True, eq=False, slots=True)
class Decision:
    """What was decided of a network, and what shows it.

    Attributes
    ----------
    consistent
        Whether the network has a scenario; None where that was not decided.
    kind
        Then the reason, else None.
    witness
        Of a consistent network, what its scenario is read off; else None.
    frame
        The pairs that the engine kept, or None where it was not asked.
    log
        The learned clauses in their order, each an (L, 2) int32 array of (edge of the frame, mask); None where nobody
        asked for a proof.
    compiling
        Seconds spent on compiling kernels or loading compiled ones. No budget pays for them.
    """

    consistent: bool | None
    kind: Kind | None = None
    witness: Witness | None = field(default=None, repr=False)
    frame: Frame | None = field(default=None, repr=False)
    log: tuple[NDArray[np.int32], ...] | None = field(default=None, repr=False)
    compiling: float = 0.0

    @property
    def scenario(self) -> Scenario | None:
        """A scenario of a consistent network, made without search; None where none is known."""
        return None if self.witness is None else self.witness.scenario


def decide(
    net: Network, *, budget: float | None = None, method: str = "auto", proof: bool = False, seed: int = 0
) -> Decision:  # fmt: skip
    """Decide whether a network has a scenario; the parameters are those of `ninefold.reasoner.networks.consistency.check`.

    Raises
    ------
    BadInput, UnknownName
        For a budget that is not positive, or a method that does not exist.
    TooLarge
        For a calculus or a network that does not fit the engine's tables.

    Notes
    -----
    A scenario costs nothing before it is asked for: the decision keeps labels, and `Witness.scenario` closes them.
    """
    if budget is not None and not budget > 0:
        raise BadInput(f"a budget is a positive number of seconds, not {budget!r}")
    if proof and method != "auto":
        raise BadInput(f"only method 'auto' keeps a proof, not {method!r}")
    deadline = None if budget is None or math.isinf(budget) else time.perf_counter() + budget
    stated, theory = net.constraints(), theory_of(net.calculus)
    if (stated.mask == 0).any():
        return Decision(consistent=False, log=() if proof else None)
    if net.n_entities < 2 or not stated.mask.size:
        found = Decision(consistent=True, witness=_witness(net, stated.i, stated.j, stated.mask), log=() if proof else None)
    elif method == "auto":
        found = _by_search(net, deadline, seed, proof=proof)
    else:
        found = _by_sat(net, method, deadline)
    if found.consistent and not theory.closure_decides:
        return replace(found, consistent=None, kind="theory", witness=None)
    return found


def undecided(calculus: Calculus) -> Undecided:
    """Return the error for a network of a calculus that closure does not refute and of which nothing more is known."""
    why = why_unknown(calculus, "theory", None)
    return Undecided(f"it is not known whether the network is consistent: {why}", kind="theory")


def why_unknown(calculus: Calculus, kind: Kind, budget: float | None) -> str:
    """Say why a network of a calculus was not decided.

    Examples
    --------
    >>> from ninefold.encodings import RCC8
    >>> why_unknown(RCC8, "time", 2.0)
    '2.0 s were not enough'
    """
    match kind:
        case "theory":
            return f"closure finds no conflict, but nobody has shown that closure decides {calculus.name!r}"
        case "time":
            return f"{budget} s were not enough"


def _by_search(net: Network, deadline: float | None, seed: int, *, proof: bool) -> Decision:
    stated, tables = net.constraints(), Tables.of(net.calculus)
    frame = _frame(net, stated.i, stated.j)
    arcs = frame.arcs(stated.i, stated.j)
    log: list[NDArray[np.int32]] | None = [] if proof else None
    engine = Engine(tables, frame, arcs, stated.mask.astype(np.int16), seed=seed, log=log)
    consistent = engine.close(deadline)
    if consistent:
        consistent = engine.search(deadline)
    # every stated pair is settled: its label holds all of the hull of what the search left
    witness = Witness(net.calculus, net.entities, frame, arcs, tables.hull[engine.relations()[arcs]]) if consistent else None
    kind: Kind | None = "time" if consistent is None else None
    return Decision(consistent, kind, witness, frame, None if log is None else tuple(log), engine.compiling)


def _by_sat(net: Network, method: str, deadline: float | None) -> Decision:
    encoding, _, solver_name = method.partition(":")
    encoded = encode(encoding, net.calculus, net.n_entities, net.constraints().triples())
    left = None if deadline is None else deadline - time.perf_counter()
    if left is not None and left <= 0:
        return Decision(None, "time")
    with open_solver(solver_name or DEFAULT_SOLVER, encoded.clauses) as solver:
        consistent = solver.solve(budget=left)
        if consistent is None:
            return Decision(None, "time")
        model = encoded.decode(solver.model()) if consistent else {}
    if not consistent:
        return Decision(consistent=False)
    pairs = np.array(sorted(model), dtype=np.int64).reshape(-1, 2)
    masks = np.array([model[i, j] for i, j in pairs.tolist()], dtype=np.int64)
    return Decision(consistent=True, witness=_witness(net, pairs[:, 0], pairs[:, 1], masks))


def _witness(net: Network, i: NDArray[Any], j: NDArray[Any], masks: NDArray[Any]) -> Witness | None:
    """Return labels that are known to have a scenario as what it is read off."""
    if not theory_of(net.calculus).closure_decides:
        return None
    frame = _frame(net, i, j)
    return Witness(net.calculus, net.entities, frame, frame.arcs(i, j), masks.astype(np.int16))


def _frame(net: Network, i: NDArray[Any], j: NDArray[Any]) -> Frame:
    """Keep a chordal completion where that decides and has less than half of all pairs, else all."""
    n = net.n_entities
    sparse = n > 1 and theory_of(net.calculus).closure_decides
    frame = triangulated_frame(n, i, j, most=n * (n - 1) // 4) if sparse else None
    return frame if frame is not None else dense_frame(n)
