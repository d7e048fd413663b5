"""Is a relation network consistent? ``check`` decides it, and only that: drawings and conflicts are made when asked for.

`ninefold.reasoner.networks.deciding` does the work; here are the verdicts that users get.

Closure of one base relation a pair decides consistency for RCC-8, RCC-5, the point algebra and Allen's intervals. For a
calculus from a file nobody has shown that, so a network that closure cannot refute is `Unknown` there, never `Consistent`.
`ninefold.encodings.theory` keeps what is known of each calculus.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeAlias

from ninefold.errors import BadInput

from .deciding import decide, why_unknown
from .network import require_network
from .proofs import Proof, digest_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from ..engine.graph import Frame
    from .conflicts import Conflict
    from .deciding import Decision, Kind
    from .network import Network
    from .scenario import Scenario

__all__ = ["Consistent", "Inconsistent", "Unknown", "Verdict", "check"]


@dataclass(frozen=True, slots=True)
class Consistent:
    """The network has a scenario.

    Attributes
    ----------
    network
        The network, as it was decided.
    seed
        Of the search.
    decision
        What was decided and what shows it.
    """

    network: Network = field(repr=False)
    seed: int = 0
    decision: Decision = field(kw_only=True, repr=False, compare=False)

    @property
    def scenario(self) -> Scenario:
        """One base relation for every pair of entities, all at once possible.

        Made at the first request and kept. No search is needed: the labels that the decision found are closed once more,
        or a SAT solver's model is read (see `ninefold.reasoner.networks.completion`).
        """
        found = self.decision.scenario
        assert found is not None  # noqa: S101 - a consistent decision has a witness
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
    decision
        What was decided; with a proof also the frame and the learned clauses.
    """

    network: Network = field(repr=False)
    seed: int = 0
    proof: Proof | None = field(default=None, repr=False)
    decision: Decision = field(kw_only=True, repr=False, compare=False)

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
    kind
        ``"time"``: the budget was spent, and a larger one may decide it; ``"theory"``: nobody has shown that closure
        decides networks of this calculus, and no budget helps.
    decision
        What was found until then.
    """

    network: Network = field(repr=False)
    reason: str
    kind: Kind
    decision: Decision = field(kw_only=True, repr=False, compare=False)


Verdict: TypeAlias = Consistent | Inconsistent | Unknown


def check(net: Network, budget: float | None = None, method: str = "auto", *, proof: bool = False, seed: int = 0) -> Verdict:
    """Decide whether a network is consistent.

    Parameters
    ----------
    net
        The network; a copy goes into the verdict.
    budget
        Seconds after which the answer is `Unknown`; None for no limit. Compiling the engine, once a machine, or loading it,
        once a process, is not counted; ``verdict.decision.compiling`` says how long that took.
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
    require_network(net)
    decided = net.copy()
    decision = decide(decided, budget=budget, method=method, proof=proof, seed=seed)
    if decision.consistent:
        return Consistent(decided, seed, decision=decision)
    if decision.consistent is None:
        kind = decision.kind or "time"
        return Unknown(decided, why_unknown(decided.calculus, kind, budget), kind, decision=decision)
    proved = None if decision.log is None else _proof(decided, decision.frame, decision.log)
    return Inconsistent(decided, seed, proved, decision=decision)


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
