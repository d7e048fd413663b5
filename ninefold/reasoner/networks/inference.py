"""What follows from a network: feasible relations with reasons, the minimal network, entailment.

A base relation is *feasible* between two entities when some scenario has it there. The reason for a feasible one is such
a scenario; for an excluded one it is a conflict of the statements with the supposition that it holds. Both are made when
asked for. An inconsistent network has no feasible relation and entails everything.

Examples
--------
>>> from ninefold.reasoner.networks.explanation import explain
>>> from ninefold.reasoner.networks.inference import entails, infer
>>> from ninefold.reasoner.networks.network import Network
>>> net = Network("rcc8")
>>> _ = net.add("kitchen", "house", "inside")
>>> _ = net.add("house", "garden", "meet")
>>> found = infer(net, "kitchen", "garden")
>>> found.relations
('DC',)
>>> print(explain(found.reason("meet")))
kitchen inside house, house meets garden, so kitchen disjoint garden; but kitchen meets garden (supposed)
>>> found.reason("disjoint").relation("house", "garden")
'EC'
>>> entails(net, "kitchen", "disjoint | meet", "garden")
True
"""

from __future__ import annotations

import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold.errors import BadInput, UnknownName

from ..engine.engine import Engine
from ..engine.graph import dense_frame
from ..engine.tables import Tables
from .conflicts import Conflict, conflict
from .consistency import Consistent, Inconsistent, check
from .deciding import decide, undecided
from .network import Network, require_network

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from ninefold.encodings.calculus import Calculus

    from .deciding import Kind
    from .scenario import Scenario

__all__ = ["SUPPOSED", "Inference", "MinimalNetwork", "entails", "infer", "minimal"]

SUPPOSED = "supposed"
"""Label of the statement that a reason supposes."""

_DENSE = 2000
"""Entities up to which closure over all pairs is asked before single relations are checked."""


@dataclass(frozen=True, slots=True, repr=False)
class Inference:
    """The relations that are feasible between two entities.

    Attributes
    ----------
    network, a, b
        What was asked. The network is a copy: later statements do not change a reason.
    mask
        The relations known to be feasible; none of an inconsistent network.
    unknown
        Relations that were left undecided, not in `mask`.
    kind
        Why, if there are any: ``"time"`` for a budget, ``"theory"`` for a calculus that nobody has shown how to decide.
    """

    network: Network
    a: str
    b: str
    mask: int
    unknown: int = 0
    kind: Kind | None = None
    _seed: int = field(default=0, repr=False)

    @property
    def relations(self) -> tuple[str, ...]:
        """Names of the feasible base relations."""
        return self.network.calculus.names(self.mask)

    @property
    def undecided(self) -> tuple[str, ...]:
        """Names of the base relations that were left undecided."""
        return self.network.calculus.names(self.unknown)

    @property
    def consistent(self) -> bool | None:
        """Whether anything is feasible, and so the network consistent; None where that was left undecided."""
        return None if self.unknown and not self.mask else self.mask != 0

    def reason(self, relation: str | int) -> Scenario | Conflict:
        """Return why a base relation is feasible, a scenario that has it, or why it is not, a conflict.

        The conflict's network holds, after all statements, one labelled `SUPPOSED`; it need not be part of the conflict
        where the network is inconsistent anyway.

        Raises
        ------
        BadInput
            Not one base relation, or one that the budget left undecided.
        Undecided
            One that nobody knows how to decide.
        """
        calculus = self.network.calculus
        mask = calculus.relation(relation)
        if not calculus.is_atomic(mask):
            raise BadInput(f"a reason is about one base relation, not {calculus.text(mask)}")
        if mask & self.unknown:
            if self.kind == "theory":
                raise undecided(calculus)
            raise BadInput(f"{calculus.text(mask)} was left undecided by the budget; ask again with a larger one")
        supposed = _suppose(self.network, self.a, self.b, mask)
        if supposed is None:
            return _required(conflict(self.network, seed=self._seed))
        if not mask & self.mask:
            return _required(conflict(supposed, seed=self._seed))
        verdict = check(supposed, seed=self._seed)
        assert isinstance(verdict, Consistent)  # noqa: S101 - the same question as in `infer`
        return verdict.scenario

    def __repr__(self) -> str:
        return f"Inference({self})"

    def __str__(self) -> str:
        parts = [" | ".join(self.relations)] if self.relations else []
        if self.unknown:
            parts.append(f"perhaps {' | '.join(self.undecided)}")
        return f"{self.a} {', '.join(parts) or 'nothing'} {self.b}"


def _required(found: Conflict | None) -> Conflict:
    if found is None:
        raise BadInput("the relation is neither feasible nor in conflict: equality of an entity with itself is no question")
    return found


def _suppose(net: Network, a: str, b: str, mask: int) -> Network | None:
    """Return the network with one more statement; None if it cannot even be stated."""
    if net.index(a) == net.index(b) and not mask & net.calculus.identity:
        return None
    more = net.copy()
    more.add(a, b, mask, label=SUPPOSED)
    return more


def infer(net: Network, a: str | int, b: str | int, *, seed: int = 0, budget: float | None = None) -> Inference:
    """Return the base relations that are feasible between a and b.

    Parameters
    ----------
    budget
        Seconds; what is not decided by then is in `Inference.unknown`. Compiling is not counted, as in ``check``.

    Raises
    ------
    UnknownName
        An entity that is not in the network.

    Complexity
    ----------
    One closure, and one check for each base relation that it leaves.
    """
    require_network(net)
    clock = _Clock(budget)
    i, j = net.index(a), net.index(b)
    first, second = net.entities[i], net.entities[j]
    kept, calculus = net.copy(), net.calculus
    label = net.stated(first, second)
    if i != j and net.n_entities <= _DENSE:
        closure = _closure(net)
        if closure is None or _close(closure, clock) is False:
            label = 0
        else:
            label = int(closure.relations()[closure.frame.arcs(np.array([i]), np.array([j]))[0]])
    feasible = unknown = 0
    kind: Kind | None = None
    for k in range(calculus.n_bases):
        base = 1 << k
        more = _suppose(kept, first, second, base) if label & base else None
        if more is None:
            continue
        verdict = check(more, budget=clock.left(), seed=seed)
        clock.put_off(verdict.decision.compiling)
        if isinstance(verdict, Consistent):
            feasible |= base
        elif not isinstance(verdict, Inconsistent):
            unknown |= base
            kind = verdict.kind
    return Inference(kept, first, second, feasible, unknown, kind, seed)


def entails(net: Network, a: str | int, relations: str | int | Iterable[str], b: str | int, *, seed: int = 0) -> bool | None:
    """Tell whether a is related to b by some of `relations` in every scenario.

    Returns
    -------
    None where that is not known: ``check`` cannot tell whether the network has a scenario with another relation, since
    nobody has shown that closure decides the calculus.

    Raises
    ------
    UnknownName, BadInput
        An entity or relation that is not there; an empty set of relations.
    """
    require_network(net)
    calculus = net.calculus
    i, j = net.index(a), net.index(b)
    rest = calculus.universal & ~calculus.relation(relations)
    if not rest:
        return True
    more = _suppose(net, net.entities[i], net.entities[j], rest)
    if more is None:
        return True
    consistent = decide(more, seed=seed).consistent
    return None if consistent is None else not consistent


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class MinimalNetwork:
    """For every pair exactly the feasible relations.

    Attributes
    ----------
    calculus, entities
        The calculus, and the names in order.
    labels
        (n, n) masks, read-only; all zero for an inconsistent network, equality on the diagonal of a consistent one.
    exact
        False where a budget ended first, or nobody has shown that closure decides the calculus: labels may then hold
        relations that are not feasible.
    """

    calculus: Calculus
    entities: tuple[str, ...]
    labels: NDArray[np.integer] = field(repr=False)
    exact: bool = True

    def __post_init__(self) -> None:
        labels = np.array(self.labels)
        labels.flags.writeable = False
        object.__setattr__(self, "labels", labels)

    @property
    def consistent(self) -> bool:
        """Whether anything is feasible."""
        return bool(self.labels.any()) or not self.entities

    def relations(self, a: str | int, b: str | int) -> tuple[str, ...]:
        """Return the names of the feasible relations of a to b.

        Raises
        ------
        UnknownName
            An entity that is not in the network.
        """
        return self.calculus.names(int(self.labels[self._index(a), self._index(b)]))

    def _index(self, name: str | int) -> int:
        key = str(name).strip()
        if key not in self.entities:
            raise UnknownName("entity", key, self.entities)
        return self.entities.index(key)

    def __reduce__(self) -> tuple[Any, ...]:
        return (MinimalNetwork, (self.calculus, self.entities, self.labels, self.exact))

    def __repr__(self) -> str:
        n, first = len(self.entities), self.entities[:4]
        said = [f"{first[0]} {'|'.join(self.relations(first[0], other))} {other}" for other in first[1:]]
        if n > 2:
            said.append("...")
        what = ", ".join(said) if self.consistent else "inconsistent"
        return (
            f"MinimalNetwork({self.calculus.name}, {n} entities: {what or 'no pair'}{'' if self.exact else '; not exact'})"
        )

    def to_network(self) -> Network:
        """Return a network that states every label but the universal one.

        Raises
        ------
        BadInput
            The network is inconsistent: no statement allows nothing.
        """
        if not self.consistent:
            raise BadInput("an inconsistent network has no minimal network to state; ask for its conflict")
        net = Network(self.calculus)
        for name in self.entities:
            net.add_entity(name)
        for i, a in enumerate(self.entities):
            for j in range(i + 1, len(self.entities)):
                if int(self.labels[i, j]) != self.calculus.universal:
                    net.add(a, self.entities[j], int(self.labels[i, j]))
        return net


def minimal(net: Network, *, seed: int = 0, budget: float | None = None) -> MinimalNetwork:
    """Return the minimal network: what `infer` says, for all pairs at once.

    Parameters
    ----------
    budget
        Seconds after which no more is narrowed; the labels are then perhaps not `MinimalNetwork.exact`. Compiling is not
        counted, as in ``check``.

    Each scenario found shows one relation of every pair to be feasible; relations not seen yet are supposed a pair at a
    time, all of them together, until each is seen or refuted.

    Raises
    ------
    TooLarge
        n^2 relations would not fit.

    Complexity
    ----------
    At most one check for each feasible relation and one for each pair.
    """
    require_network(net)
    clock = _Clock(budget)
    calculus, n, names = net.calculus, net.n_entities, net.entities
    nothing = np.zeros((n, n), dtype=calculus.base_composition.dtype)
    closure = _closure(net)
    verdict = None if closure is None else check(net, budget=budget, seed=seed)
    if closure is None or verdict is None or isinstance(verdict, Inconsistent):
        return MinimalNetwork(calculus, names, nothing)
    clock.put_off(verdict.decision.compiling)
    # what closure has not got to in time stays as it was stated, which is less narrow and as true
    exact = _close(closure, clock) is True and isinstance(verdict, Consistent)
    seen = nothing
    if isinstance(verdict, Consistent) and exact:
        _see(seen, verdict.scenario)
    labels = closure.labels()
    for i in range(n):
        for j in range(i + 1, n):
            while exact and (rest := int(labels[i, j]) & ~int(seen[i, j])):
                more = net.copy()
                more.add(names[i], names[j], rest)
                verdict = check(more, budget=clock.left(), seed=seed)
                clock.put_off(verdict.decision.compiling)
                if isinstance(verdict, Consistent):
                    _see(seen, verdict.scenario)
                elif isinstance(verdict, Inconsistent):
                    # what is known now narrows other pairs by closure as well
                    labels[i, j] = int(seen[i, j])
                    rows, columns = np.triu_indices(n, 1)
                    closure = _engine(calculus, n, rows, columns, labels[rows, columns])
                    exact = _close(closure, clock) is True
                    labels = closure.labels()
                else:
                    exact = False
    return MinimalNetwork(calculus, names, labels.astype(nothing.dtype), exact)


def _see(seen: NDArray[np.integer], scenario: Scenario) -> None:
    seen |= (np.uint64(1) << scenario.bases.astype(np.uint64)).astype(seen.dtype)


def _closure(net: Network) -> Engine | None:
    """Return an engine that is about to close what is stated over all pairs; None where a pair contradicts itself."""
    stated = net.constraints()
    if (stated.mask == 0).any():
        return None
    return _engine(net.calculus, net.n_entities, stated.i, stated.j, stated.mask)


def _engine(calculus: Calculus, n: int, i: NDArray[Any], j: NDArray[Any], masks: NDArray[Any]) -> Engine:
    frame = dense_frame(n)
    return Engine(Tables.of(calculus), frame, frame.arcs(i, j), masks.astype(np.int16))


def _close(engine: Engine, clock: _Clock) -> bool | None:
    """Close within the time that is left; None where that was not enough."""
    before = engine.compiling
    closed = engine.close(None if clock.deadline is None else clock.deadline - before)
    clock.put_off(engine.compiling - before)
    return closed


class _Clock:
    """A budget of seconds that several steps share; compiling is not counted.

    Attributes
    ----------
    deadline
        By `time.perf_counter`, or None.
    """

    def __init__(self, budget: float | None) -> None:
        self.deadline = None if budget is None else time.perf_counter() + budget

    def put_off(self, seconds: float) -> None:
        """Do not count what was spent on compiling."""
        if self.deadline is not None:
            self.deadline += seconds

    def left(self) -> float | None:
        """Return the seconds left; a trifle when time is over, so that a check that needs none can still answer."""
        return None if self.deadline is None else max(self.deadline - time.perf_counter(), 1e-3)
