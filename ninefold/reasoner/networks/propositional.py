"""What a network says, in propositional clauses: the part of a clausal proof that has to be trusted.

Entities are numbered as the network has them, and each pair i < j that is used gets one variable a base relation:
``x(i, j, r)``, "r is the relation of i to j". What is between j and i is read off by converse. There are four kinds of
clauses.

1. For a pair: some base relation holds, ``x(i, j, 0) or x(i, j, 1) or ...``.
2. For a pair: no two of them do, ``not x(i, j, r) or not x(i, j, s)``.
3. For a statement that i and j are related by one of a set: ``not x(i, j, r)`` for every r outside it.
4. For three entities i, k, j and base relations t, r: where j is t from i and k is r from i, then j is from k one of those s
   that allow it, ``not x(i, j, t) or not x(i, k, r) or x(k, j, s) or ...`` over the s with t in the composition ``r;s``.

A scenario of the network satisfies all of them, so if they cannot be satisfied, the network has none. Leaving some out can
only make them easier to satisfy; so it does not matter for soundness which pairs and triangles `to_cnf` is asked for.

This module reads the network, the names and the composition table of its calculus, and nothing else.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from .integers import to_text

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .network import Network

__all__ = ["Cnf", "to_cnf"]


@dataclass(frozen=True, slots=True, eq=False)
class Cnf:
    """Clauses in DIMACS form, and where to find them; clauses are numbered from 1.

    Attributes
    ----------
    text
        The DIMACS file, with the meaning of each block of variables in comments.
    n_variables, n_clauses
        As the header has them.
    unique
        (P,) number of the first clause of kind 2 of a pair, or 0.
    stated
        (P * b,) number of the clause of kind 3 that excludes a base relation of a pair, or 0.
    composed
        (T, b) number of the clause of kind 4 of a row of `triangles` and a base relation r, or 0.
    """

    text: bytes
    n_variables: int
    n_clauses: int
    unique: NDArray[np.int64]
    stated: NDArray[np.int64]
    composed: NDArray[np.int64]


def to_cnf(
    net: Network, pairs: NDArray[Any], one_only: NDArray[np.bool_], triangles: NDArray[Any], *, comments: bool = True
) -> Cnf:
    """Write a network in clauses.

    Parameters
    ----------
    pairs
        (P, 2), i < j, ascending: the pairs that get variables, and a clause of kind 1.
    one_only
        (P,), those that get clauses of kind 2.
    triangles
        (T, 5) rows (i, j, k, t, mask of r): the clauses of kind 4.
    comments
        Say in the file which variables are of which pair.
    """
    calculus = net.calculus
    n, b = net.n_entities, calculus.n_bases
    keys = pairs[:, 0].astype(np.int64) * n + pairs[:, 1]
    converse = np.asarray(calculus.base_converse)

    def variables(i: NDArray[Any], j: NDArray[Any]) -> NDArray[np.int64]:
        """Return the (T, b) variables of "r is the relation of i to j"."""
        pair = np.searchsorted(keys, np.minimum(i, j).astype(np.int64) * n + np.maximum(i, j))
        found: NDArray[np.int64] = b * pair[:, None] + np.where((i < j)[:, None], np.arange(b), converse) + 1
        return found

    first = np.arange(len(pairs)) * b + 1
    blocks = [_rows(first[:, None] + np.arange(b))]
    count = len(pairs)

    one, two = np.triu_indices(b, 1)
    chosen = np.flatnonzero(one_only)
    unique = np.zeros(len(pairs), dtype=np.int64)
    unique[chosen] = count + 1 + np.arange(chosen.size) * one.size
    blocks.append(_rows(-np.stack([first[chosen, None] + one, first[chosen, None] + two], axis=2).reshape(-1, 2)))
    count += chosen.size * one.size

    stated = np.zeros(len(pairs) * b, dtype=np.int64)
    known = {pair: at for at, pair in enumerate(map(tuple, pairs.tolist()))}
    units: list[int] = []
    for statement in net.statements:
        u, v = net.index(statement.a), net.index(statement.b)
        mask = statement.mask if u < v else calculus.converse_of(statement.mask)
        place = known.get((min(u, v), max(u, v)))
        if place is not None:
            units += [b * place + base for base in range(b) if not mask >> base & 1]
    number = np.array(units, dtype=np.int64)
    stated[number[::-1]] = count + np.arange(number.size, 0, -1)
    blocks.append(_rows(-(number[:, None] + 1)))
    count += number.size

    composed = np.zeros((len(triangles), b), dtype=np.int64)
    table = calculus.base_composition
    i, j, k, of_t, of_r = triangles.T
    x_ij, x_ik, x_kj = variables(i, j), variables(i, k), variables(k, j)
    for t in range(b):
        for r in range(b):
            at = np.flatnonzero((of_t == t) & (of_r >> r & 1 == 1))
            if at.size:
                allowed = [base for base in range(b) if int(table[r, base]) >> t & 1]
                blocks.append(_rows(np.column_stack([-x_ij[at, t], -x_ik[at, r], x_kj[at][:, allowed]])))
                composed[at, r] = count + 1 + np.arange(at.size)
                count += at.size

    notes = [
        f"c {net.n_entities} entities, calculus {calculus.name}: {' '.join(calculus.bases)}",
        "c variables of a pair of entities follow each other in that order",
    ]
    if comments:
        notes += [f"c {v} pair {i} {j}" for v, (i, j) in zip(first.tolist(), pairs.tolist(), strict=True)]
    head = "\n".join([*notes, f"p cnf {len(pairs) * b} {count}\n"]).encode()
    return Cnf(head + to_text(np.concatenate(blocks)), len(pairs) * b, count, unique, stated, composed)


def _rows(clauses: NDArray[Any]) -> NDArray[np.int64]:
    """Return clauses of one length, a row each, one after another and ended by 0."""
    closed = np.zeros((clauses.shape[0], clauses.shape[1] + 1), dtype=np.int64)
    closed[:, :-1] = clauses
    return closed.ravel()
