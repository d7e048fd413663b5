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
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

import numpy as np

from ninefold.encodings import ALLEN, H8, POINT, RCC5, RCC8, encode, open_solver
from ninefold.errors import BadInput

from ..engine.engine import Engine
from ..engine.graph import dense_frame, triangulated_frame
from ..engine.tables import Tables

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.encodings.calculus import Calculus

    from ..engine.graph import Frame
    from .network import Network

__all__ = ["Decision", "Why", "decide"]

DEFAULT_SOLVER = "cadical195"

Why = Literal["time", "theory"]
"""Why a network was not decided: the budget ended first, or nobody has shown that closure decides its calculus."""


@dataclass(frozen=True)
class Decision:
    """What was decided of a network, and what shows it.

    Attributes
    ----------
    consistent
        Whether the network has a scenario; None where that was not decided.
    why
        Then the reason, else None.
    frame
        The pairs that the engine kept, or None where it was not asked.
    log
        The learned clauses in their order, each an (L, 2) int32 array of (edge of the frame, mask); None where nobody
        asked for a proof.
    """

    consistent: bool | None
    why: Why | None = None
    frame: Frame | None = field(default=None, repr=False)
    log: tuple[NDArray[np.int32], ...] | None = field(default=None, repr=False)


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
    """
    if budget is not None and not budget > 0:
        raise BadInput(f"a budget is a positive number of seconds, not {budget!r}")
    if proof and method != "auto":
        raise BadInput(f"only method 'auto' keeps a proof, not {method!r}")
    deadline = None if budget is None or math.isinf(budget) else time.perf_counter() + budget
    constraints = net.constraints()
    log: list[NDArray[np.int32]] | None = [] if proof else None
    frame: Frame | None = None
    if (constraints.mask == 0).any():
        return Decision(consistent=False, log=None if log is None else ())
    if net.n_entities < 2 or not constraints.mask.size:
        return Decision(consistent=True)
    decided = _closure_decides(net.calculus)
    if method == "auto":
        frame = _frame(net, sparse=decided)
        found = _search(net, frame, deadline, seed, log)
    else:
        found = _by_sat(net, method, deadline)
    why: Why | None = None
    if found is None:
        why = "time"
    elif found and not decided:
        found, why = None, "theory"
    return Decision(found, why, frame, None if log is None else tuple(log))


def _closure_decides(calculus: Calculus) -> bool:
    """Say whether closure decides networks of one base relation a pair, on chordal completions too."""
    return calculus in (RCC8, RCC5, POINT, ALLEN)


def _search(
    net: Network, frame: Frame, deadline: float | None, seed: int, log: list[NDArray[np.int32]] | None
) -> bool | None:
    stated = net.constraints()
    tables = Tables.of(net.calculus, H8.member if net.calculus == RCC8 else None)
    masks = stated.mask.astype(np.int16)
    engine = Engine(tables, frame, frame.arcs(stated.i, stated.j), masks, seed=seed, log=log)
    closed = engine.close(deadline)
    if not closed:
        return closed
    return engine.search(deadline)


def _frame(net: Network, *, sparse: bool) -> Frame:
    """Keep a chordal completion where it has less than half of all pairs, else all."""
    n, stated = net.n_entities, net.constraints()
    frame = triangulated_frame(n, stated.i, stated.j, most=n * (n - 1) // 4) if sparse else None
    return frame if frame is not None else dense_frame(n)


def _by_sat(net: Network, method: str, deadline: float | None) -> bool | None:
    encoding, _, solver_name = method.partition(":")
    encoded = encode(encoding, net.calculus, net.n_entities, net.constraints().triples())
    left = None if deadline is None else deadline - time.perf_counter()
    if left is not None and left <= 0:
        return None
    with open_solver(solver_name or DEFAULT_SOLVER, encoded.clauses) as solver:
        return solver.solve(budget=left)
