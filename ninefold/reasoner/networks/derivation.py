"""Algebraic closure that remembers: every refinement keeps the triangle, or the statement, that caused it.

The record is a *trail*, one row a refinement, which is also the queue of what is still to be propagated: first in, first
out, so that what needs few steps is found by few steps. `RecordedClosure.derivation` walks the trail backwards and keeps
only what a conclusion needs; that is what conflicts and explanations are replays of. Undoing the trail restores any
earlier state, which is what enumeration lives on. Deciding large networks is the engine's work, not this module's.

Examples
--------
>>> from ninefold.encodings import RCC8
>>> from ninefold.reasoner.networks.derivation import RecordedClosure
>>> closure = RecordedClosure(RCC8, 3)
>>> for source, (i, j, words) in enumerate([(0, 1, "inside"), (1, 2, "disjoint"), (0, 2, "meet")]):
...     _ = closure.state(i, j, RCC8.relation(words), source)
>>> closure.close()
False
>>> sorted(closure.refutation().sources)
[0, 1, 2]

References
----------
U. Montanari, "Networks of constraints", Information Sciences 7, 1974. O. Ohrimenko, P. Stuckey and M. Codish, "Propagation
via lazy clause generation", Constraints 14, 2009 (weakening a reason to what is needed).
"""

from __future__ import annotations

from bisect import bisect_left
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._kernels import kernel
from ninefold.errors import BadInput, TooLarge

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.encodings.calculus import Calculus

__all__ = ["Derivation", "Fact", "RecordedClosure"]

_MEMORY = 4 << 30
_I, _J, _VIA, _BEFORE, _AFTER = range(5)
_FIXPOINT, _EMPTY, _FULL = range(3)


class _Tables(NamedTuple):
    """Converse and composition of all relations, empty for a calculus with many; and of base relations."""

    converse: NDArray[np.integer]
    base_converse: NDArray[np.int64]
    compose: NDArray[np.integer]
    base_compose: NDArray[np.int64]


@kernel
def _converse(tables, mask):  # type: ignore[no-untyped-def]
    """Return the converse of a relation, from the table of all relations if there is one."""
    if tables.converse.size:
        return tables.converse[mask]
    result = 0
    base = tables.base_converse
    for k in range(base.size):
        if mask >> k & 1:
            result |= 1 << base[k]
    return result


@kernel
def _compose(tables, r, s):  # type: ignore[no-untyped-def]
    """Return the composition of two relations, from the table of all relations if there is one."""
    if tables.compose.size:
        return tables.compose[r, s]
    result = 0
    base = tables.base_compose
    for k in range(base.shape[0]):
        if r >> k & 1:
            for l in range(base.shape[0]):
                if s >> l & 1:
                    result |= base[k, l]
    return result


@kernel
def _propagate(rel, trail, head, top, absorbing, full, tables):  # type: ignore[no-untyped-def]
    """Close the triangles over every trail row from `head` on; return (status, head, top).

    Parameters
    ----------
    rel
        (n, n) relations, changed in place; both directions are kept.
    trail
        (capacity, 5) int64 rows i, j, via, before, after; `via` is the third node, or ``-1 - source`` of a statement.
    absorbing
        Whether composing with the universal relation always gives the universal relation.
    """
    n = rel.shape[0]
    while head < top:
        i, j = trail[head, 0], trail[head, 1]
        r = rel[i, j]
        if trail[head, 4] == r:  # else a later row speaks for the pair
            if top + 2 * n > trail.shape[0]:
                return 2, head, top
            back = rel[j, i]
            for k in range(n):
                if k in (i, j):
                    continue
                for side in range(2):
                    # first (i, k) by way of j, then (j, k) by way of i
                    a, via, first = (i, j, r) if side == 0 else (j, i, back)
                    second = rel[via, k]
                    if absorbing and second == full:
                        continue
                    old = rel[a, k]
                    new = old & _compose(tables, first, second)
                    if new != old:
                        rel[a, k] = new
                        rel[k, a] = _converse(tables, new)
                        trail[top, 0] = a
                        trail[top, 1] = k
                        trail[top, 2] = via
                        trail[top, 3] = old
                        trail[top, 4] = new
                        top += 1
                        if new == 0:
                            return 1, head, top
        head += 1
    return 0, head, top


@dataclass(frozen=True, slots=True)
class Fact:
    """One line of a derivation: entities i and j are related by `mask`.

    Attributes
    ----------
    i, j, mask
        The pair and what is known of it.
    source
        The statement that says so, or -1.
    via
        For a derived fact the third entity, or -1.
    left, right
        Indices of the facts about (i, via) and (via, j) in the derivation, or -1 where nothing need be known.
    kept
        Index of an earlier fact about (i, j) that is intersected with this conclusion, or -1.
    """

    i: int
    j: int
    mask: int
    source: int = -1
    via: int = -1
    left: int = -1
    right: int = -1
    kept: int = -1


@dataclass(frozen=True, slots=True)
class Derivation:
    """Facts in an order in which each follows from statements and from facts before it; the last is the conclusion."""

    facts: tuple[Fact, ...]

    @property
    def conclusion(self) -> Fact:
        """The last fact; its mask is 0 where the derivation is a refutation."""
        return self.facts[-1]

    @property
    def sources(self) -> frozenset[int]:
        """The statements used."""
        return frozenset(fact.source for fact in self.facts if fact.source >= 0)


class RecordedClosure:
    """A dense network under closure; see the module's text.

    Parameters
    ----------
    calculus, n
        Calculus, and number of entities.

    Raises
    ------
    TooLarge
        n^2 relations would not fit.
    """

    def __init__(self, calculus: Calculus, n: int) -> None:
        if calculus.n_bases > 62:
            raise TooLarge(f"closure keeps relations in 63 bits; {calculus.name} has {calculus.n_bases} base relations")
        small = calculus.composition_table is not None
        dtype = np.uint8 if small else np.int64
        need = n * n * np.dtype(dtype).itemsize
        if need > _MEMORY:
            raise TooLarge(f"the relations of {n:,} entities pair by pair take {need / 2**30:,.0f} GiB")
        self.calculus = calculus
        self.n = n
        self.labels: NDArray[np.integer] = np.full((n, n), calculus.universal, dtype=dtype)
        np.fill_diagonal(self.labels, calculus.identity)
        self._trail = np.empty((4 * n + 256, 5), dtype=np.int64)
        self._head = self._top = self._work = 0
        none: NDArray[np.integer] = np.zeros(0, dtype=dtype)
        self._tables = _Tables(
            calculus.converse_table if calculus.converse_table is not None else none,
            calculus.base_converse.astype(np.int64),
            calculus.composition_table if calculus.composition_table is not None else none.reshape(0, 0),
            calculus.base_composition.astype(np.int64),
        )
        full = calculus.universal
        self._absorbing = all(
            calculus.compose(1 << k, full) == full == calculus.compose(full, 1 << k) for k in range(calculus.n_bases)
        )
        self._order: tuple[int, NDArray[np.int64]] | None = None
        self._said: dict[int, tuple[int, int, int]] = {}

    def relation(self, i: int, j: int) -> int:
        """Return what is known of (i, j) now."""
        return int(self.labels[i, j])

    def state(self, i: int, j: int, mask: int, source: int) -> bool:
        """Intersect a pair with a statement, to be propagated by `close`; return False if nothing is left."""
        old = int(self.labels[i, j])
        new = old & mask
        if new != old:
            self._said[source] = (i, j, mask)
            self._room(1)
            self._trail[self._top] = (i, j, -1 - source, old, new)
            self._top += 1
            self.labels[i, j] = new
            if i != j:
                self.labels[j, i] = self.calculus.converse_of(new)
        return new != 0

    def close(self) -> bool:
        """Propagate what was stated; return False where a relation ran empty.

        Complexity
        ----------
        O(b n^3) for b base relations.
        """
        if self._top and not self._trail[self._top - 1, _AFTER]:
            return False
        full = self.calculus.universal
        while True:
            known = self._top
            run = _propagate.for_work(self._work + self.n * (known - self._head))
            status, self._head, self._top = run(
                self.labels, self._trail, self._head, self._top, self._absorbing, full, self._tables
            )
            self._work = self.n * max(self._head - known, 0)  # found on the way and not counted yet
            if status != _FULL:
                return bool(status == _FIXPOINT)
            self._room(len(self._trail))

    def mark(self) -> int:
        """Return the present state for `undo`."""
        return self._top

    def undo(self, mark: int) -> None:
        """Go back to the state `mark` was made in; it must have been closed."""
        converse = self.calculus.converse_of
        for i, j, _, before, _ in self._trail[mark : self._top][::-1].tolist():
            self.labels[i, j] = before
            if i != j:
                self.labels[j, i] = converse(before)
        self._head = self._top = mark
        self._order = None

    def refutation(self) -> Derivation:
        """Return the derivation of an empty relation, after `close` or `state` returned False."""
        if not self._top or self._trail[self._top - 1, _AFTER]:
            raise BadInput("closure left every pair a relation: there is nothing to refute")
        i, j = self._trail[self._top - 1, :2].tolist()
        return self.derivation(i, j, 0)

    def derivation(self, i: int, j: int, wanted: int) -> Derivation:
        """Derive that (i, j) is related by some of `wanted`, which has to hold all of its present relation.

        Each premise is weakened to what is needed of it before its own derivation is sought, so that few statements
        are used (not always the fewest); its facts are then as strong as those statements make them.
        """
        if self.relation(i, j) & ~wanted:
            raise BadInput("closure does not show this: the pair can still be outside the wanted relation")
        return _Tracer(self).derivation(i, j, wanted)

    def _room(self, rows: int) -> None:
        if self._top + rows > len(self._trail):
            new = np.empty((2 * len(self._trail) + rows, 5), dtype=np.int64)
            new[: self._top] = self._trail[: self._top]
            self._trail = new

    def row(self, t: int) -> tuple[int, int, int, int, int]:
        """Return row t of the trail: i, j, via, before, after."""
        i, j, via, before, after = self._trail[t].tolist()
        return i, j, via, before, after

    def said(self, source: int, i: int) -> int:
        """Return the mask of a statement that changed something, seen from entity i."""
        a, _, mask = self._said[source]
        return mask if a == i else self.calculus.converse_of(mask)

    def rows_of(self, i: int, j: int) -> list[int]:
        """Return the trail rows about a pair, in order.

        Complexity
        ----------
        One sort of the trail at the first call after a change, then logarithmic.
        """
        if self._order is None or self._order[0] != self._top:
            trail = self._trail[: self._top]
            low, high = np.minimum(trail[:, _I], trail[:, _J]), np.maximum(trail[:, _I], trail[:, _J])
            keys = (low * self.n + high) * max(self._top, 1) + np.arange(self._top)
            keys.sort()
            self._order = (self._top, keys)
        keys, size = self._order[1], max(self._top, 1)
        pair = min(i, j) * self.n + max(i, j)
        low_key, high_key = np.searchsorted(keys, [pair * size, (pair + 1) * size])
        found: list[int] = (keys[low_key:high_key] % size).tolist()
        return found


class _Tracer:
    """Collects what a conclusion needs, from the end of the trail to its beginning."""

    def __init__(self, closure: RecordedClosure) -> None:
        self._closure = closure
        self._calculus = closure.calculus
        self._full = closure.calculus.universal
        self._rows: dict[tuple[int, int], list[int]] = {}

    def derivation(self, i: int, j: int, wanted: int) -> Derivation:
        """See `RecordedClosure.derivation`; facts are made once their premises are, with a stack for the recursion."""
        facts: list[Fact] = []
        known: dict[tuple[int, int, int, int], int] = {}
        goal = self._goal(i, j, wanted, self._closure.mark())
        if goal is None:
            return Derivation((Fact(i, j, self._full),))
        stack = [goal]
        while stack:
            top = stack[-1]
            if top in known:
                stack.pop()
                continue
            premises = self._premises(*top)
            missing = [p for p in premises if p is not None and p not in known]
            if missing:
                stack.extend(missing)
                continue
            known[top] = len(facts)
            facts.append(self._fact(top, [-1 if p is None else known[p] for p in premises], facts))
            stack.pop()
        return Derivation(tuple(facts))

    def _goal(self, i: int, j: int, wanted: int, before: int) -> tuple[int, int, int, int] | None:
        """Return (row, i, j, wanted) of the first row that put (i, j) into `wanted`, or None if it always was."""
        if self._full & ~wanted == 0 or (i == j and not self._calculus.identity & ~wanted):
            return None
        rows = self._rows.setdefault((min(i, j), max(i, j)), self._closure.rows_of(i, j))
        for t in rows[: bisect_left(rows, before)]:
            a, _, _, _, after = self._closure.row(t)
            if not (after if a == i else self._calculus.converse_of(after)) & ~wanted:
                return t, i, j, wanted
        raise AssertionError("a premise was not true when it was used")

    def _premises(self, t: int, i: int, j: int, wanted: int) -> list[tuple[int, int, int, int] | None]:
        """Return the goals of (i, via), (via, j) and of (i, j) before, as weak as row t lets them be."""
        a, b, via, _, _ = self._closure.row(t)
        if a != i:  # the row is about the converse
            a, b = b, a
        bad = self._full & ~wanted
        if via < 0:
            said = self._closure.said(-1 - via, i)
            return [None, None, self._goal(i, j, self._full & ~(bad & said), t) if bad & said else None]
        compose, converse = self._calculus.compose, self._calculus.converse_of
        p, q = self._at(i, via, t), self._at(via, j, t)
        left = bad & compose(p, q)
        gone = bad & ~left
        weak_p = self._full & ~compose(gone, converse(q))
        weak_q = self._full & ~compose(converse(weak_p), gone)
        kept = self._goal(i, j, self._full & ~left, t) if left else None
        return [self._goal(i, via, weak_p, t), self._goal(via, j, weak_q, t), kept]

    def _at(self, i: int, j: int, t: int) -> int:
        """Return the relation of (i, j) just before row t."""
        rows = self._rows.setdefault((min(i, j), max(i, j)), self._closure.rows_of(i, j))
        at = bisect_left(rows, t)
        if at == 0:
            return self._full
        a, _, _, _, after = self._closure.row(rows[at - 1])
        return after if a == i else self._calculus.converse_of(after)

    def _fact(self, goal: tuple[int, int, int, int], premises: list[int], facts: list[Fact]) -> Fact:
        t, i, j, _ = goal
        left, right, kept = premises
        _, _, via, _, _ = self._closure.row(t)
        before = facts[kept].mask if kept >= 0 else self._full
        if via < 0:
            return Fact(i, j, before & self._closure.said(-1 - via, i), source=-1 - via, kept=kept)
        p = facts[left].mask if left >= 0 else self._full
        q = facts[right].mask if right >= 0 else self._full
        return Fact(i, j, before & self._calculus.compose(p, q), via=via, left=left, right=right, kept=kept)
