"""Conflicts: statements that cannot hold together, none of which can be left out.

First comes a refutation, and with it the statements that it rests on: closure's record where closure is enough, else a
search whose every learned clause knows its statements (`ninefold.reasoner.networks._cores`). Then statements are left out,
one at a time. Where the rest is still refuted, only what that refutation rests on is kept, which often drops many at once;
where the rest has a scenario, the statement is necessary and stays. When every statement has had its turn, each of those
left is necessary.

Examples
--------
>>> from ninefold.reasoner.networks.conflicts import conflict
>>> from ninefold.reasoner.networks.network import Network
>>> net = Network("rcc8")
>>> for a, b, words in [("kitchen", "house", "inside"), ("attic", "house", "coveredBy"), ("house", "garden", "disjoint"),
...                     ("kitchen", "garden", "meet")]:
...     _ = net.add(a, b, words)
>>> found = conflict(net)
>>> found
Conflict(3 statements, minimal: kitchen inside house; house disjoint garden; kitchen meets garden)
>>> [str(statement) for statement in found]
['statement 1', 'statement 3', 'statement 4']

References
----------
R. R. Bakker et al., "Diagnosing and solving over-determined constraint satisfaction problems", IJCAI 1993 (deletion).
A. Belov, I. Lynce and J. Marques-Silva, "Towards efficient MUS extraction", AI Communications 25, 2012 (each refutation
narrows what is left).
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ninefold._wording import counted
from ninefold.encodings.theory import theory_of

from ._cores import OutOfTime
from ._parts import Part
from .derivation import RecordedClosure
from .network import Network, require_network
from .words import told

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from .statement import Statement

__all__ = ["Conflict", "Shrinker", "conflict", "part_of"]

_RECORDED = 400
"""Entities up to which closure is recorded pair by pair, which finds refutations of few steps."""

_ROUNDS = 16
"""Searches, each with another seed, that begin with what the last refutation rests on."""

_WORTH = 0.99
"""Another round is made where the last one left at most this share of the statements."""


@dataclass(frozen=True, slots=True, repr=False)
class Conflict:
    """Statements of a network that are inconsistent together.

    Attributes
    ----------
    network
        The whole network.
    statements
        In the network's order.
    minimal
        Whether each is known to be necessary: without it the others have a scenario. False where a budget ended before all
        had been tried, and in calculi of which nobody has shown that closure decides them.
    """

    network: Network
    statements: tuple[Statement, ...]
    minimal: bool = True

    @property
    def indices(self) -> tuple[int, ...]:
        """Indices of the statements in the network."""
        return tuple(s.index for s in self.statements)

    def triples(self) -> list[tuple[str, str, tuple[str, ...]]]:
        """Return the statements as (a, b, names of relations)."""
        names = self.network.calculus.names
        return [(s.a, s.b, names(s.mask)) for s in self.statements]

    def to_network(self) -> Network:
        """Return the network of the statements alone, over the entities they speak of."""
        return part_of(self.network, self.indices)

    def __iter__(self) -> Iterator[Statement]:
        return iter(self.statements)

    def __len__(self) -> int:
        return len(self.statements)

    def __str__(self) -> str:
        text = self.network.calculus.text
        return "\n".join(f"{s}: {s.a} {text(s.mask)} {s.b}" for s in self.statements)

    def __repr__(self) -> str:
        kind = "minimal" if self.minimal else "perhaps not minimal"
        return f"Conflict({counted(len(self), 'statement')}, {kind}: {told(self.network.calculus, self.statements)})"


def conflict(net: Network, *, seed: int = 0, budget: float | None = None, known: bool = False) -> Conflict | None:
    """Return a minimal conflict of a network, or None if closure and search find none.

    Parameters
    ----------
    seed
        For the search; the same seed gives the same conflict.
    budget
        Seconds after which no more statements are left out; what is left then is a conflict, perhaps not minimal.
    known
        That the network is inconsistent has been decided already. Otherwise that is decided first, without regard to
        the budget.

    Notes
    -----
    Statements of finite weight are left out before hard ones, so that a conflict of mapped facts with what was said
    names as little as possible of what was said. There may be smaller conflicts: this one only has none inside it.

    Complexity
    ----------
    A search, and one more for each statement of the conflict, most of them short: what was learned is kept.

    Examples
    --------
    >>> from ninefold.reasoner.networks.network import Network
    >>> net = Network("rcc8")
    >>> _ = net.add("kitchen", "house", "inside")
    >>> conflict(net) is None
    True
    """
    require_network(net)
    deadline = None if budget is None else time.perf_counter() + budget
    found = Shrinker(net, seed, deadline).conflict(range(net.n_statements), known=known)
    if found is None:
        return None
    indices, minimal = found
    return Conflict(net, tuple(net.statements[k] for k in indices), minimal)


def part_of(net: Network, indices: Iterable[int]) -> Network:
    """Return the network of some statements over the entities they speak of, in the order they first come."""
    part = Network(net.calculus)
    for k in sorted(indices):
        s = net.statements[k]
        part.add(s.a, s.b, s.mask, s.label, s.weight)
    return part


class _Late(Exception):
    """Time is up before every statement had its turn; what is left is a conflict."""

    def __init__(self, used: list[int]) -> None:
        super().__init__()
        self.used = used


class Shrinker:
    """Finds minimal conflicts inside given statements of one network.

    Parameters
    ----------
    deadline
        On the clock of `time.perf_counter`: when it has passed, no more statements are left out.
    soft_only
        Leave hard statements where they are: they count as part of the conflict, all of them, and are never left out. A
        repair, which drops soft statements only, has no use for knowing which of the hard ones take part.
    """

    def __init__(self, net: Network, seed: int = 0, deadline: float | None = None, *, soft_only: bool = False) -> None:
        self._net = net
        self._seed = seed
        self._deadline = deadline
        self._soft_only = soft_only
        self._statements = net.statements
        self._decides = theory_of(net.calculus).closure_decides

    def conflict(self, indices: Iterable[int], *, known: bool = False) -> tuple[list[int], bool] | None:
        """Return a conflict among statements `indices`, and whether it is minimal; None if there is none.

        Parameters
        ----------
        known
            That they are inconsistent has been decided already, so that the deadline holds from the beginning.
        """
        # statements of an entity about itself say nothing
        given = sorted(k for k in indices if self._statements[k].a != self._statements[k].b)
        deadline = self._deadline if known else None
        try:
            used = self._first_refutation(given, deadline)
        except OutOfTime:
            return sorted(given), False
        if used is None:
            return None
        try:
            used = self._without_each(used)
        except _Late as late:
            return sorted(late.used), False
        return sorted(used), self._decides

    def _first_refutation(self, given: list[int], deadline: float | None) -> list[int] | None:
        """Return the statements that a refutation rests on, made few by further rounds; None if there is none."""
        used = self._recorded(given)
        if used is not None:
            return used
        part = self._part(given)
        used = part.refute(given, deadline)
        if used is None:
            return None
        used = self._with_hard(given, used)
        recorded = self._recorded(used)
        if recorded is not None:
            return recorded
        for more in range(1, _ROUNDS if part.searched else 0):
            before = used
            try:
                fewer = self._part(used, more).refute(used, self._deadline)
            except OutOfTime:
                break
            if fewer is None:
                break
            used = self._with_hard(used, fewer)
            if len(used) > _WORTH * len(before):
                break
        return used

    def _without_each(self, used: list[int]) -> list[int]:
        """Leave out what can be left out, soft statements before hard ones and late before early ones."""
        part = self._part(used)
        order = sorted(used, key=lambda k: (self._statements[k].hard, -k))
        if self._soft_only:
            order = [k for k in order if not self._statements[k].hard]
        kept = set(used)
        for k in order:
            if k not in kept:
                continue
            if self._deadline is not None and time.perf_counter() > self._deadline:
                raise _Late(used)
            rest = [x for x in used if x != k]
            try:
                fewer = part.refute(rest, self._deadline)
            except OutOfTime:
                raise _Late(used) from None
            if fewer is not None:
                used = self._with_hard(rest, fewer)
                kept = set(used)
                if part.too_wide_for(used):
                    part = self._part(used)
        return used

    def _part(self, indices: Sequence[int], more: int = 0) -> Part:
        """Lay out some statements for the search."""
        chosen = [self._statements[k] for k in indices]
        return Part(chosen, self._net.calculus, decides=self._decides, seed=self._seed + more)

    def _recorded(self, kept: Sequence[int]) -> list[int] | None:
        """Return the statements closure needs to refute `kept`, fewer at every round; None if it does not."""
        used: list[int] | None = None
        while True:
            closure = self._refuting_closure(kept)
            if closure is None:
                return used
            found = self._with_hard(kept, closure.refutation().sources)
            if used is not None and len(found) == len(used):
                return found
            used = kept = found

    def _refuting_closure(self, kept: Sequence[int]) -> RecordedClosure | None:
        """Return the closure of some statements if it refutes them; hard ones are stated and closed first."""
        statements = [self._statements[k] for k in kept]
        index: dict[str, int] = {}
        for s in statements:
            index.setdefault(s.a, len(index))
            index.setdefault(s.b, len(index))
        if len(index) > _RECORDED:
            return None
        closure = RecordedClosure(self._net.calculus, len(index))
        for hard in (True, False):
            for s in statements:
                if s.hard == hard and not closure.state(index[s.a], index[s.b], s.mask, s.index):
                    return closure
            if not closure.close():
                return closure
        return None

    def _with_hard(self, kept: Sequence[int], sources: Iterable[int]) -> list[int]:
        used = set(sources)
        if self._soft_only:
            used |= {k for k in kept if self._statements[k].hard}
        return sorted(used)
