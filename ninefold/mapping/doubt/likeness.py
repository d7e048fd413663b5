"""Which nodes of a folded walk can be one place, and what that says of their exits.

Two nodes can be one place under a shift k, exit x of the one being exit x + k of the other, when they have as many exits and
the headings agree within the tolerance: with a compass as they are, without one once some common turn is taken off. Where
both walk an exit they must have walked it alike: with a compass as many whole turns, without one as far round, within twice
the tolerance. Exits that some chain of such shifts makes one are of one *kind*: whatever map explains the walk, exits of
different kinds are different.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..heading import TAU, wrap_all

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from .walk_tree import WalkTree

__all__ = ["Likeness", "can_be_one", "likeness"]

EPSILON = 1e-9
"""Radians that rounding may add."""


@dataclass(frozen=True, slots=True)
class Likeness:
    """What of a tree of N nodes can be the same.

    Attributes
    ----------
    shifts
        (N, N) int64; bit k of entry (n, m): node n can be node m, its exit x the other's exit x + k.
    kind
        (N, K) int64, the kind of every exit, -1 beyond the degree.
    n_kinds
        Number of kinds.
    signature
        (N,) int64: nodes with the same kinds of exits have one.
    group
        (N,) int64: nodes that must be one place have one number; -1 for a node that need not be any other's place.
    """

    shifts: NDArray[np.int64]
    kind: NDArray[np.int64]
    n_kinds: int
    signature: NDArray[np.int64]
    group: NDArray[np.int64]


def likeness(tree: WalkTree, *, same: Iterable[tuple[int, int]] = (), differ: Iterable[tuple[int, int]] = ()) -> Likeness:
    """Compare all nodes of a tree.

    Parameters
    ----------
    same, differ
        Pairs of nodes known to be one place, and different places, beside those whose names say so.

    Notes
    -----
    Complexity O(N squared times K squared), array code.
    """
    shifts = _shifts(tree)
    named: dict[str, list[int]] = {}
    for n, name in enumerate(tree.names):
        if name is not None:
            named.setdefault(name, []).append(n)
    groups = list(named.values())
    for i, group in enumerate(groups):
        for others in groups[:i]:
            shifts[np.ix_(group, others)] = 0
            shifts[np.ix_(others, group)] = 0
    for n, m in differ:
        shifts[n, m] = shifts[m, n] = 0
    kind, n_kinds = _kinds(tree, shifts)
    keys = [tuple(sorted(kind[n, : tree.degree[n]].tolist())) for n in range(tree.n_nodes)]
    number: dict[tuple[int, ...], int] = {}
    signature = np.array([number.setdefault(key, len(number)) for key in keys], np.int64)
    pairs = [*same, *((group[0], n) for group in groups for n in group[1:])]
    return Likeness(shifts, kind, n_kinds, signature, _groups(tree.n_nodes, pairs))


def can_be_one(tree: WalkTree, n: NDArray[np.int64], m: NDArray[np.int64], shift: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Whether pairs of nodes can be one place under given shifts, (P,); as the table of `likeness` without making it.

    Parameters
    ----------
    n, m, shift
        (P,) int64: exit x of node n would be exit x + shift of node m.

    Notes
    -----
    Complexity O(P times K), array code.
    """
    degree = tree.degree[n]
    exits = np.arange(tree.heading.shape[1])
    there = (exits + shift[:, None]) % np.maximum(degree, 1)[:, None]
    real = exits < degree[:, None]
    miss = tree.heading[m[:, None], there] - tree.heading[n]
    if not tree.compass:
        miss -= miss[:, :1]
    miss = np.where(real, wrap_all(miss), 0.0)
    if tree.compass:
        found = np.abs(miss).max(axis=1) <= tree.tolerance + EPSILON
    else:
        found = np.ptp(miss, axis=1) <= 2 * tree.tolerance + EPSILON
    agree = _legs_agree(tree, (n[:, None], exits), (m[:, None], there))
    return np.asarray(found & (agree | ~real).all(axis=1) & (tree.degree[m] == degree))


def _groups(count: int, same: list[tuple[int, int]]) -> NDArray[np.int64]:
    """Number the sets of nodes that a chain of pairs makes one place; -1 for nodes in no pair."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    group = np.full(count, -1, np.int64)
    if not same:
        return group
    a, b = np.array(same, np.int64).T
    _, label = connected_components(coo_array((np.ones(a.size, np.int8), (a, b)), shape=(count, count)), directed=False)
    paired = np.unique(np.concatenate([a, b]))
    _, group[paired] = np.unique(label[paired], return_inverse=True)
    return group


def _shifts(tree: WalkTree) -> NDArray[np.int64]:
    count = tree.n_nodes
    found = np.zeros((count, count), np.int64)
    for degree in np.unique(tree.degree).tolist():
        nodes = np.flatnonzero(tree.degree == degree)
        if degree == 0:
            found[np.ix_(nodes, nodes)] = 1
            continue
        heading = tree.heading[nodes, :degree]
        bits = np.zeros((nodes.size, nodes.size), np.int64)
        for k in range(degree):
            miss = np.roll(heading, -k, axis=1)[None, :, :] - heading[:, None, :]
            if not tree.compass:
                miss = miss - miss[:, :, :1]
            miss = wrap_all(miss)
            if tree.compass:
                agree = np.abs(miss).max(axis=2) <= tree.tolerance + EPSILON
            else:
                agree = np.ptp(miss, axis=2) <= 2 * tree.tolerance + EPSILON
            for x in range(degree):
                agree &= _legs_agree(tree, (nodes[:, None], x), (nodes[None, :], (x + k) % degree))
            bits |= agree.astype(np.int64) << k
        found[np.ix_(nodes, nodes)] = bits
    np.fill_diagonal(found, 1)
    return found


def _legs_agree(tree: WalkTree, one: tuple[Any, Any], two: tuple[Any, Any]) -> NDArray[np.bool_]:
    """Whether ways out of exits, given as (nodes, exits), can be those out of others; so where one is not walked."""
    if tree.compass:
        near = tree.heading[two] - tree.heading[one]
        far = tree.heading[tree.other[two], tree.back[two]] - tree.heading[tree.other[one], tree.back[one]]
        off = _settled(tree, two) - _settled(tree, one)
        off += near - TAU * np.round(near / TAU) - far + TAU * np.round(far / TAU)
        agree = np.abs(off) < np.pi
    else:
        agree = np.abs(tree.turn[two] - tree.turn[one]) <= 2 * tree.tolerance + EPSILON
    return np.asarray(agree | (tree.other[one] < 0) | (tree.other[two] < 0))


def _settled(tree: WalkTree, exits: tuple[Any, Any]) -> NDArray[np.float64]:
    """Return the turns along the ways out of some exits as the headings at their ends have them."""
    miss = tree.heading[tree.other[exits], tree.back[exits]] + np.pi - tree.heading[exits] - tree.turn[exits]
    return np.asarray(tree.turn[exits] + miss - TAU * np.round(miss / TAU))


def _kinds(tree: WalkTree, shifts: NDArray[np.int64]) -> tuple[NDArray[np.int64], int]:
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    count, most = tree.heading.shape
    left: list[NDArray[np.int64]] = []
    right: list[NDArray[np.int64]] = []
    for degree in np.unique(tree.degree).tolist():
        nodes = np.flatnonzero(tree.degree == degree)
        bits = shifts[np.ix_(nodes, nodes)]
        for k in range(degree):
            n, m = np.nonzero((bits >> k) & 1)
            for x in range(degree):
                left.append(nodes[n] * most + x)
                right.append(nodes[m] * most + (x + k) % degree)
    size = count * most
    if not left:
        return np.full((count, most), -1, np.int64), 0
    a, b = np.concatenate(left), np.concatenate(right)
    _, label = connected_components(coo_array((np.ones(a.size, np.int8), (a, b)), shape=(size, size)), directed=False)
    real = (np.arange(most)[None, :] < tree.degree[:, None]).reshape(-1)
    kind = np.full(size, -1, np.int64)
    _, kind[real] = np.unique(label[real], return_inverse=True)
    return kind.reshape(count, most), int(kind.max()) + 1
