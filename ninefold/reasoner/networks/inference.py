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
from typing import TYPE_CHECKING

import numpy as np

from ninefold.errors import BadInput

from .conflicts import Conflict, conflict
from .consistency import Consistent, Inconsistent, check
from .enumeration import closed
from .network import require_network

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from ninefold.encodings.calculus import Calculus

    from .network import Network
    from .scenario import Scenario

__all__ = ["SUPPOSED", "Inference", "MinimalNetwork", "entails", "infer", "minimal"]

SUPPOSED = "supposed"
"""Label of the statement that a reason supposes."""

_DENSE = 2000
"""Entities up to which closure over all pairs is asked before single relations are checked."""


@dataclass(frozen=True, slots=True)
class Inference:
    """The relations that are feasible between two entities.

    Attributes
    ----------
    network, a, b
        What was asked. The network is a copy: later statements do not change a reason.
    mask
        The feasible relations; 0 for an inconsistent network.
    unknown
        Relations that a budget left undecided, not in `mask`.
    """

    network: Network
    a: str
    b: str
    mask: int
    unknown: int = 0
    _seed: int = field(default=0, repr=False)

    @property
    def relations(self) -> tuple[str, ...]:
        """Names of the feasible base relations."""
        return self.network.calculus.names(self.mask)

    @property
    def consistent(self) -> bool:
        """Whether anything is feasible."""
        return self.mask != 0

    def reason(self, relation: str | int) -> Scenario | Conflict:
        """Return why a base relation is feasible, a scenario that has it, or why it is not, a conflict.

        The conflict's network holds, after all statements, one labelled `SUPPOSED`; it need not be part of the conflict
        where the network is inconsistent anyway.

        Raises
        ------
        BadInput
            Not one base relation, or one that was left undecided.
        """
        calculus = self.network.calculus
        mask = calculus.relation(relation)
        if not calculus.is_atomic(mask):
            raise BadInput(f"a reason is about one base relation, not {calculus.text(mask)}")
        if mask & self.unknown:
            raise BadInput(f"{calculus.text(mask)} was left undecided by the budget; ask again with a larger one")
        supposed = _suppose(self.network, self.a, self.b, mask)
        if supposed is None:
            return _required(conflict(self.network, seed=self._seed))
        if not mask & self.mask:
            return _required(conflict(supposed, seed=self._seed))
        verdict = check(supposed, seed=self._seed)
        assert isinstance(verdict, Consistent)  # noqa: S101 - the same question as in `infer`
        return verdict.scenario

    def __str__(self) -> str:
        return f"{self.a} {' | '.join(self.relations) or 'nothing'} {self.b}"


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
        Seconds; what is not decided by then is in `Inference.unknown`.

    Raises
    ------
    UnknownName
        An entity that is not in the network.

    Complexity
    ----------
    One closure, and one check for each base relation that it leaves.
    """
    require_network(net)
    deadline = None if budget is None else time.perf_counter() + budget
    i, j = net.index(a), net.index(b)
    first, second = net.entities[i], net.entities[j]
    kept, calculus = net.copy(), net.calculus
    if net.n_entities <= _DENSE:
        closure = closed(net)
        label = 0 if closure is None else closure.relation(i, j)
    else:
        label = net.stated(first, second)
    feasible = unknown = 0
    for k in range(calculus.n_bases):
        base = 1 << k
        more = _suppose(kept, first, second, base) if label & base else None
        if more is None:
            continue
        verdict = check(more, budget=_left(deadline), seed=seed)
        if isinstance(verdict, Consistent):
            feasible |= base
        elif not isinstance(verdict, Inconsistent):
            unknown |= base
    return Inference(kept, first, second, feasible, unknown, seed)


def entails(
    net: Network, a: str | int, relations: str | int | Iterable[str], b: str | int, *, seed: int = 0
) -> bool:  # fmt: skip
    """Tell whether a is related to b by some of `relations` in every scenario.

    Raises
    ------
    UnknownName, BadInput
        An entity or relation that is not there; an empty set of relations.
    """
    calculus = net.calculus
    i, j = net.index(a), net.index(b)
    rest = calculus.universal & ~calculus.relation(relations)
    if not rest:
        return True
    more = _suppose(net, net.entities[i], net.entities[j], rest)
    if more is None:
        return True
    return isinstance(check(more, seed=seed), Inconsistent)


@dataclass(frozen=True, slots=True, eq=False)
class MinimalNetwork:
    """For every pair exactly the feasible relations.

    Attributes
    ----------
    calculus, entities
        The calculus, and the names in order.
    labels
        (n, n) masks, read-only; all zero for an inconsistent network, equality on the diagonal of a consistent one.
    exact
        False where a budget ended first: labels may then hold relations that are not feasible.
    """

    calculus: Calculus
    entities: tuple[str, ...]
    labels: NDArray[np.integer] = field(repr=False)
    exact: bool = True

    @property
    def consistent(self) -> bool:
        """Whether anything is feasible."""
        return bool(self.labels.any()) or not self.entities

    def relations(self, a: str | int, b: str | int) -> tuple[str, ...]:
        """Return the names of the feasible relations of a to b."""
        i, j = (self.entities.index(str(x).strip()) for x in (a, b))
        return self.calculus.names(int(self.labels[i, j]))

    def to_network(self) -> Network:
        """Return a network that states every label but the universal one.

        Raises
        ------
        BadInput
            The network is inconsistent: no statement allows nothing.
        """
        from .network import Network

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
    deadline = None if budget is None else time.perf_counter() + budget
    calculus, n, names = net.calculus, net.n_entities, net.entities
    closure = closed(net)
    verdict = None if closure is None else check(net, budget=budget, seed=seed)
    if closure is None or isinstance(verdict, Inconsistent):
        return MinimalNetwork(calculus, names, np.zeros((n, n), dtype=calculus.base_composition.dtype))
    seen = np.zeros_like(closure.labels)
    exact = isinstance(verdict, Consistent)
    if isinstance(verdict, Consistent):
        _see(seen, verdict.scenario)
    for i in range(n):
        for j in range(i + 1, n):
            while exact and (rest := closure.relation(i, j) & ~int(seen[i, j])):
                more = net.copy()
                more.add(names[i], names[j], rest)
                verdict = check(more, budget=_left(deadline), seed=seed)
                if isinstance(verdict, Consistent):
                    _see(seen, verdict.scenario)
                elif isinstance(verdict, Inconsistent):
                    # what is known now narrows other pairs by closure as well
                    closure.state(i, j, int(seen[i, j]), 0)
                    closure.close()
                else:
                    exact = False
    labels = closure.labels.copy()
    labels.flags.writeable = False
    return MinimalNetwork(calculus, names, labels, exact)


def _see(seen: NDArray[np.integer], scenario: Scenario) -> None:
    seen |= (np.uint64(1) << scenario.bases.astype(np.uint64)).astype(seen.dtype)


def _left(deadline: float | None) -> float | None:
    """Return the seconds left; a trifle when time is over, so that a check that needs none can still answer."""
    return None if deadline is None else max(deadline - time.perf_counter(), 1e-3)
