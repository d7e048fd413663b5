"""Variables and clauses for "these nodes are one place": what holds of every quotient of a folded walk.

A variable says that two nodes are one place, exit x of the first being exit x + k of the second: one variable for every pair
and shift that `likeness` allows, so a pair without a variable is known to be two places. Clauses say

- *transitive*: two nodes that are one place with a third are one place with each other, and the shifts add up;
- *congruent*: the way out of one exit of a place leads to one place, by one exit of it; and no way is its
  own reverse;
- *covered*, where no exit is left untravelled: an exit that a node did not walk is walked by another node of its place;
- *together*: nodes known to be one place are.

A quotient is a solution of these clauses, and every solution is one. Which of them are plane maps is not said here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from .likeness import Likeness
    from .walk_tree import WalkTree

__all__ = ["NodePairs", "clauses", "node_pairs", "triples"]


@dataclass(frozen=True, slots=True, eq=False)
class NodePairs:
    """The variables over a tree of N nodes.

    Attributes
    ----------
    first, second, shift
        (X,) int64: variable i + 1 says that exit x of `first` is exit x + shift of `second`, a higher node.
    start, partner, variable
        The same by nodes: those paired with node n are ``partner[start[n]:start[n + 1]]``, ascending.
    along
        (2X,) int64, the shift from n to the partner.
    table
        The variable of (n, partner, shift along).
    """

    first: NDArray[np.int64]
    second: NDArray[np.int64]
    shift: NDArray[np.int64]
    start: NDArray[np.int64]
    partner: NDArray[np.int64]
    variable: NDArray[np.int64]
    along: NDArray[np.int64]
    table: dict[tuple[int, int, int], int]

    @property
    def n_variables(self) -> int:
        """Number of variables."""
        return self.first.size


def node_pairs(tree: WalkTree, alike: Likeness) -> NodePairs:
    """Number the pairs of nodes that can be one place. O(pairs)."""
    rows = []
    n, m = np.nonzero(np.triu(alike.shifts, 1))
    bits = alike.shifts[n, m]
    for k in range(int(tree.degree.max(initial=0)) or 1):
        has = (bits >> k) & 1 == 1
        rows.append(np.stack([n[has], m[has], np.full(int(has.sum()), k)], axis=1))
    pairs = np.concatenate(rows).astype(np.int64)
    pairs = pairs[np.lexsort(pairs.T[::-1])]
    first, second, shift = pairs.T
    number = np.arange(1, first.size + 1)
    back = np.where(tree.degree[first] > 0, -shift % np.maximum(tree.degree[first], 1), 0)
    owner = np.concatenate([first, second])
    partner, variable = np.concatenate([second, first]), np.concatenate([number, number])
    along = np.concatenate([shift, back])
    order = np.lexsort((along, partner, owner))
    start = np.searchsorted(owner[order], np.arange(tree.n_nodes + 1))
    keys = zip(owner.tolist(), partner.tolist(), along.tolist(), strict=True)
    table = dict(zip(keys, variable.tolist(), strict=True))
    return NodePairs(first, second, shift, start, partner[order], variable[order], along[order], table)


def triples(pairs: NodePairs) -> int:
    """Return how many clauses say that sameness is transitive: what a model costs."""
    beside = np.diff(pairs.start)
    return int((beside * (beside - 1) // 2).sum())


def clauses(tree: WalkTree, alike: Likeness, pairs: NodePairs, *, closed: bool) -> Iterator[tuple[str, list[list[int]]]]:
    """Yield the clauses of a model, each kind in blocks.

    Notes
    -----
    O(N d squared) of them, where a node can be one place with d others.
    """
    for n in range(tree.n_nodes):
        yield "transitive", _transitive(tree, pairs, n)
    yield "congruent", _congruent(tree, pairs)
    if closed:
        yield "covered", _covered(tree, pairs)
    yield "together", _together(alike, pairs)


def _transitive(tree: WalkTree, pairs: NodePairs, n: int) -> list[list[int]]:
    """Return what follows for every two nodes that are one place with node n."""
    span = slice(pairs.start[n], pairs.start[n + 1])
    others, number, along = pairs.partner[span].tolist(), pairs.variable[span].tolist(), pairs.along[span].tolist()
    degree = max(int(tree.degree[n]), 1)
    found: list[list[int]] = []
    find = pairs.table.get
    for i, (b, x, k) in enumerate(zip(others, number, along, strict=True)):
        for j in range(i + 1, len(others)):
            third = find((b, others[j], (along[j] - k) % degree))
            found.append([-x, -number[j]] if third is None else [-x, -number[j], third])
    return found


def _congruent(tree: WalkTree, pairs: NodePairs) -> list[list[int]]:
    """Return where the ways out of two nodes that are one place lead."""
    found: list[list[int]] = []
    degree, other, back = tree.degree.tolist(), tree.other.tolist(), tree.back.tolist()
    triple = zip(pairs.first.tolist(), pairs.second.tolist(), pairs.shift.tolist(), strict=True)
    for x, (a, b, k) in enumerate(triple, 1):
        for e in range(degree[a]):
            f = (e + k) % degree[b]
            p, q = other[a][e], other[b][f]
            if p < 0 or q < 0:
                continue
            if p == b and q == a and back[a][e] == f and back[b][f] == e:
                found.append([-x])  # the way would be its own reverse
                continue
            there = _same(degree, pairs, p, back[a][e], q, back[b][f])
            if there == 0:
                found.append([-x])
            elif there is not None and there != x:
                found.append([-x, there])
    return found


def _same(degree: list[int], pairs: NodePairs, p: int, y: int, q: int, z: int) -> int | None:
    """Return the variable that says that exit y of p is exit z of q; None if that holds anyway, 0 if it cannot be."""
    if p == q:
        return None if y == z else 0
    return pairs.table.get((p, q, (z - y) % degree[q]), 0) if degree[p] == degree[q] else 0


def _covered(tree: WalkTree, pairs: NodePairs) -> list[list[int]]:
    return [
        walkers(tree, pairs, n, x) for n in range(tree.n_nodes) for x in range(int(tree.degree[n])) if tree.other[n, x] < 0
    ]


def walkers(tree: WalkTree, pairs: NodePairs, n: int, x: int, inside: NDArray[np.bool_] | None = None) -> list[int]:
    """Return the variables of which one holds if an exit that a node did not walk is walked by another of its place.

    With `inside`, only ways between those nodes count.
    """
    span = slice(pairs.start[n], pairs.start[n + 1])
    partner = pairs.partner[span]
    beyond = tree.other[partner, (x + pairs.along[span]) % tree.degree[n]]
    walked = beyond >= 0
    if inside is not None:
        walked &= inside[partner] & inside[beyond]
    found: list[int] = pairs.variable[span][walked].tolist()
    return found


def _together(alike: Likeness, pairs: NodePairs) -> list[list[int]]:
    found = []
    for g in range(int(alike.group.max(initial=-1)) + 1):
        nodes = np.flatnonzero(alike.group == g).tolist()
        for m in nodes[1:]:
            span = slice(pairs.start[nodes[0]], pairs.start[nodes[0] + 1])
            found.append(pairs.variable[span][pairs.partner[span] == m].tolist())
    return found
