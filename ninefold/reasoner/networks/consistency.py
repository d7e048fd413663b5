"""Is a relation network consistent? ``check`` decides it, and only that: drawings and conflicts are made when asked for.

Closure comes first. Where every label is in a tractable subclass (H8 of RCC-8) it decides; otherwise a conflict-driven
search with closure as its theory does (`ninefold.reasoner.engine`), on all pairs of a dense network and on a chordal
completion of a sparse one. ``method`` names an encoding and a SAT solver instead, an independent referee for small networks.

Closure of one base relation a pair decides consistency for RCC-8, RCC-5, the point algebra and Allen's intervals. For a
calculus from a file nobody has shown that, so a network that closure cannot refute is `Unknown` there, never `Consistent`.

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
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from ninefold.encodings import ALLEN, H8, POINT, RCC5, RCC8, encode, open_solver
from ninefold.errors import BadInput

from ..engine.engine import Engine
from ..engine.graph import dense_frame, triangulated_frame
from ..engine.tables import Tables
from .network import require_network
from .proofs import Proof, digest_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ninefold.encodings.calculus import Calculus

    from ..engine.graph import Frame
    from .conflicts import Conflict
    from .network import Network
    from .scenario import Scenario

__all__ = ["Consistent", "Inconsistent", "Unknown", "Verdict", "check"]

DEFAULT_SOLVER = "cadical195"


@dataclass(frozen=True, slots=True)
class Consistent:
    """The network has a scenario.

    Attributes
    ----------
    network
        The network, as it was decided.
    seed
        Of the search.
    """

    network: Network = field(repr=False)
    seed: int = 0

    @property
    def scenario(self) -> Scenario:
        """One base relation for every pair of entities, all at once possible; made anew at each request, O(n^3)."""
        from .enumeration import some_scenario

        found = some_scenario(self.network, seed=self.seed)
        if found is None:
            raise BadInput("the network was changed since it was decided, and is inconsistent now")
        return found


@dataclass(frozen=True, slots=True)
class Inconsistent:
    """The network has no scenario.

    Attributes
    ----------
    network
        The network, as it was decided.
    seed
        Of the search.
    proof
        What `ninefold.reasoner.networks.proofs` confirms, if it was asked for.
    """

    network: Network = field(repr=False)
    seed: int = 0
    proof: Proof | None = field(default=None, repr=False)

    def conflict(self) -> Conflict:
        """Return a minimal set of statements that cannot hold together; see `ninefold.reasoner.networks.conflicts`."""
        from .conflicts import conflict

        found = conflict(self.network, seed=self.seed)
        if found is None:
            raise BadInput("the network was changed since it was decided, and is consistent now")
        return found


@dataclass(frozen=True, slots=True)
class Unknown:
    """Not decided.

    Attributes
    ----------
    network
        The network.
    reason
        Why, in words.
    """

    network: Network = field(repr=False)
    reason: str = ""


Verdict: TypeAlias = Consistent | Inconsistent | Unknown


def check(net: Network, budget: float | None = None, method: str = "auto", *, proof: bool = False, seed: int = 0) -> Verdict:
    """Decide whether a network is consistent.

    Parameters
    ----------
    net
        The network; a copy goes into the verdict.
    budget
        Seconds after which the answer is `Unknown`; None for no limit.
    method
        ``"auto"``, or an encoding and a SAT solver, such as ``"support:glucose42"`` (the solver may be left out).
    proof
        Keep the learned clauses, so that an `Inconsistent` carries a `Proof`; with ``method="auto"`` only.
    seed
        Breaks ties of the search; the same seed gives the same run.

    Raises
    ------
    BadInput, UnknownName
        For a budget that is not positive, or a method that does not exist.
    TooLarge
        For a calculus or a network that does not fit the engine's tables.

    Notes
    -----
    Consistency of RCC-8 is NP-complete; closure takes O(n^3) on dense networks. The clock is looked at about every 50 ms.

    Examples
    --------
    >>> from ninefold.reasoner.networks.consistency import check
    >>> from ninefold.reasoner.networks.network import Network
    >>> net = Network("rcc8")
    >>> _ = net.add("kitchen", "house", "inside")
    >>> _ = net.add("house", "garden", "disjoint")
    >>> check(net)
    Consistent(seed=0)
    >>> _ = net.add("kitchen", "garden", "meet")
    >>> check(net), check(net, method="support")
    (Inconsistent(seed=0), Inconsistent(seed=0))
    """
    if budget is not None and not budget > 0:
        raise BadInput(f"a budget is a positive number of seconds, not {budget!r}")
    deadline = None if budget is None or math.isinf(budget) else time.perf_counter() + budget
    require_network(net)
    decided = net.copy()
    constraints = decided.constraints()
    if proof and method != "auto":
        raise BadInput(f"only method 'auto' keeps a proof, not {method!r}")
    log: list[NDArray[np.int32]] | None = [] if proof else None
    if (constraints.mask == 0).any():
        return Inconsistent(decided, seed, None if log is None else _proof(decided, None, log))
    if decided.n_entities < 2 or not constraints.mask.size:
        return Consistent(decided, seed)
    if method == "auto":
        frame = _frame(decided, sparse=_closure_decides(decided.calculus))
        found = _search(decided, frame, deadline, seed, log)
        if found is False:
            return Inconsistent(decided, seed, None if log is None else _proof(decided, frame, log))
    else:
        found = _by_sat(decided, method, deadline)
    if found is None:
        return Unknown(decided, f"{budget} s were not enough")
    if not found:
        return Inconsistent(decided, seed)
    if not _closure_decides(decided.calculus):
        name = decided.calculus.name
        return Unknown(decided, f"closure finds no conflict, but nobody has shown that closure decides {name!r}")
    return Consistent(decided, seed)


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


def _proof(net: Network, frame: Frame | None, log: Sequence[NDArray[np.int32]]) -> Proof:
    """Write the engine's clauses, whose literals are (edge, mask) of its frame, over the network's entities."""
    pairs: tuple[tuple[int, int], ...] | None = None
    clauses: list[tuple[tuple[int, int, int], ...]] = []
    if frame is not None:
        tail, head = (frame.order[end].tolist() for end in frame.ends())
        if not frame.dense:
            pairs = tuple(zip(tail, head, strict=True))
        clauses = [tuple((tail[e], head[e], mask) for e, mask in clause.tolist()) for clause in log if len(clause)]
    return Proof(net.calculus.name, net.n_entities, digest_of(net), pairs, (*clauses, ()))


def _by_sat(net: Network, method: str, deadline: float | None) -> bool | None:
    encoding, _, solver_name = method.partition(":")
    encoded = encode(encoding, net.calculus, net.n_entities, net.constraints().triples())
    left = None if deadline is None else deadline - time.perf_counter()
    if left is not None and left <= 0:
        return None
    with open_solver(solver_name or DEFAULT_SOLVER, encoded.clauses) as solver:
        return solver.solve(budget=left)
