"""What all maps that explain a walk agree on: which visits are certainly one place, and which certainly are not.

Where all maps are listed they are compared. Where they are too many to list, a SAT solver is asked, pair by pair, whether
there is a map in which the two are one place, and one in which they are not; every map it finds answers for many pairs at
once. Where that cannot be asked either, without a compass, what folding, headings, names and congruence exclude is still
certain.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from time import monotonic
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

from ._node_pairs import clauses, node_pairs, triples
from .quotient_sat import QuotientSat

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from ._node_pairs import NodePairs
    from .likeness import Likeness
    from .walk_tree import WalkTree

__all__ = ["Backbone", "backbone_of"]

MOST_CLAUSES = 5_000_000
"""Clauses beyond which the solver is not asked."""

SAME, DIFFERENT, OPEN = 1, -1, 0


@dataclass(frozen=True, eq=False)
class Backbone:
    """What is certain of pairs of visits, over a walk of T visits.

    Attributes
    ----------
    nodes
        (N, N) int8 over nodes of the folded walk: 1 for one place in every map, -1 for two places in every map, else 0.
    node_of
        (T,) int64, the node of every visit.
    exact
        Whether every pair left open is one place in some map and two in another. Otherwise some of them may be certain too;
        what is called certain is so in any case.
    """

    nodes: NDArray[np.int8] = field(repr=False)
    node_of: NDArray[np.int64] = field(repr=False)
    exact: bool

    @cached_property
    def visits(self) -> NDArray[np.int8]:
        """The same over visits, (T, T) int8."""
        return np.asarray(self.nodes[np.ix_(self.node_of, self.node_of)])

    def _pairs(self, verdict: int) -> NDArray[np.int64]:
        return np.argwhere(np.triu(self.visits == verdict, 1)).astype(np.int64)

    @cached_property
    def same(self) -> NDArray[np.int64]:
        """Pairs of visits, counted from 0, that are one place in every map, (P, 2) int64, the first before the second."""
        return self._pairs(SAME)

    @cached_property
    def different(self) -> NDArray[np.int64]:
        """Pairs of visits that are two places in every map, (P, 2) int64."""
        return self._pairs(DIFFERENT)

    @cached_property
    def open(self) -> NDArray[np.int64]:
        """Pairs of visits that are not known to be either, (P, 2) int64."""
        return self._pairs(OPEN)

    def known(self, visit: int, other: int) -> bool | None:
        """Return whether two visits, counted from 0, are certainly one place or certainly two; None if that is open."""
        for one in (visit, other):
            if not 0 <= one < self.node_of.size:
                raise BadInput(f"visits are numbered 0 to {self.node_of.size - 1}; there is no {quoted(one)}")
        verdict = int(self.nodes[self.node_of[visit], self.node_of[other]])
        return None if verdict == OPEN else verdict == SAME

    def __str__(self) -> str:
        same, different, left = len(self.same), len(self.different), len(self.open)
        return f"{same} pairs of visits certainly one place, {different} certainly two, {left} open"


def backbone_of(
    tree: WalkTree,
    alike: Likeness,
    maps: Sequence[NDArray[np.int64]] = (),
    *,
    complete: bool,
    closed: bool = False,
    narrowed: bool = False,
    budget: float = 10.0,
) -> Backbone | None:
    """Return what all maps of a folded walk agree on; None if there is no map.

    Parameters
    ----------
    maps
        The place of every node, (N,) each, in maps that are known.
    complete
        Whether these are all.
    closed
        Whether only maps count in which no exit is left untravelled.
    narrowed
        Whether even fewer count, such as those with few places: what is certain stays so, and the rest is not exact.
    budget
        Seconds for the solver.

    Notes
    -----
    O(maps N squared), or a call of the solver for every pair that its maps leave open.
    """
    if complete:
        if not len(maps):
            return None
        return Backbone(_compared(maps), tree.node_of, exact=True)
    pairs = node_pairs(tree, alike)
    certain = _by_congruence(tree, alike, pairs)
    if tree.compass and triples(pairs) <= MOST_CLAUSES:
        sat = QuotientSat(tree, alike, closed=closed)
        try:
            whole = _asked(sat, certain, maps, monotonic() + budget)
        finally:
            sat.close()
        return None if whole is None else Backbone(certain, tree.node_of, exact=whole and not narrowed)
    one, two = _seen(tree.n_nodes, maps)
    return Backbone(certain, tree.node_of, exact=not narrowed and bool(((one & two) | (certain != OPEN)).all()))


def _seen(count: int, maps: Iterable[NDArray[np.int64]]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return which nodes are one place in some map, and which are two."""
    one, two = np.zeros((count, count), np.bool_), np.zeros((count, count), np.bool_)
    for place in maps:
        together = place[:, None] == place[None, :]
        one |= together
        two |= ~together
    return one, two


def _compared(maps: Sequence[NDArray[np.int64]]) -> NDArray[np.int8]:
    one, two = _seen(maps[0].size, maps)
    return (np.where(one & two, OPEN, np.where(one, SAME, DIFFERENT))).astype(np.int8)


def _by_congruence(tree: WalkTree, alike: Likeness, pairs: NodePairs) -> NDArray[np.int8]:
    """Return what is certain by likeness, names and congruence alone, (N, N)."""
    false = np.zeros(pairs.n_variables + 1, np.bool_)
    needs: dict[int, list[int]] = {}
    queue: list[int] = []
    for kind, block in clauses(tree, alike, pairs, closed=False):
        for clause in block if kind == "congruent" else ():
            if len(clause) == 1:
                queue.append(-clause[0])
            else:
                needs.setdefault(clause[1], []).append(-clause[0])
    for x in queue:
        if not false[x]:
            false[x] = True
            queue += needs.get(x, [])
    certain = np.full((tree.n_nodes, tree.n_nodes), DIFFERENT, np.int8)
    possible = ~false[1:]
    certain[pairs.first[possible], pairs.second[possible]] = OPEN
    certain[pairs.second[possible], pairs.first[possible]] = OPEN
    certain[(alike.group[:, None] == alike.group[None, :]) & (alike.group >= 0)[:, None]] = SAME
    np.fill_diagonal(certain, SAME)
    return certain


def _asked(sat: QuotientSat, certain: NDArray[np.int8], maps: Sequence[NDArray[np.int64]], until: float) -> bool | None:
    """Settle the pairs that are open; return whether all are, or None if there is no map."""
    one, two = _seen(sat.tree.n_nodes, maps)
    if not len(maps):
        quotient = sat.solved(seconds=max(until - monotonic(), 1e-3))
        if quotient is None:
            return None if sat.done else False
        one, two = _seen(sat.tree.n_nodes, [quotient[:, 0]])
    variables: dict[tuple[int, int], list[int]] = {}
    for x, (n, m) in enumerate(zip(sat.pairs.first.tolist(), sat.pairs.second.tolist(), strict=True), 1):
        if certain[n, m] == OPEN:
            variables.setdefault((n, m), []).append(x)
    for (n, m), shifts in variables.items():
        for seen, verdict in ((one, DIFFERENT), (two, SAME)):
            questions = [[x] for x in shifts] if verdict == DIFFERENT else [[-x for x in shifts]]
            while questions and not seen[n, m]:
                left = until - monotonic()
                quotient = sat.solved(questions.pop(), seconds=left) if left > 0 else None
                if quotient is not None:
                    more_one, more_two = _seen(sat.tree.n_nodes, [quotient[:, 0]])
                    one |= more_one
                    two |= more_two
                elif left <= 0 or not sat.refuted:
                    return False
            if not seen[n, m]:
                certain[n, m] = certain[m, n] = verdict
                break
    return True
