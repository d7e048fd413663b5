"""Whether some legal map holds given mergers of nodes: the search of `quotients` on a walk with these nodes made one."""

from __future__ import annotations

from dataclasses import replace
from time import monotonic
from typing import TYPE_CHECKING

import numpy as np

from ninefold.errors import NotPlane

from .hypotheses import Hypothesis, hypothesis_of, is_closed
from .likeness import can_be_one, likeness
from .quotients import QuotientSearch, spread_roots

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from .walk_tree import WalkTree

__all__ = ["every_closed_map", "merged", "some_map"]

ROOTS = 6
"""Nodes that a search begins with in turn."""

FIRST_DECISIONS = 500
"""Decisions of the first round; every round has `GROWTH` times as many."""

GROWTH = 4

SLICE = 128
"""Decisions between two looks at the clock."""


def some_map(
    tree: WalkTree, place: NDArray[np.int64], shift: NDArray[np.int64], *, closed: bool, until: float
) -> Hypothesis | bool | None:
    """Return a legal map in which nodes of one place are one; False if there is none, None if time is up.

    Parameters
    ----------
    place, shift
        (N,) a congruent quotient of the tree: exit x of a node is exit x + shift of the first node of its place.
    closed
        Whether no exit may be left untravelled.
    until
        When to give up, by the monotonic clock.
    """
    one = Hypothesis(tree, place, shift, closed=is_closed(tree, place, shift))
    if (one.closed or not closed) and _is_legal(one):
        return one
    if monotonic() > until:
        return None
    for search, found in _in_turn(merged(tree, place, shift), closed=closed, until=until):
        for quotient in found:
            whole = _unfolded(tree, place, shift, quotient)
            if _is_legal(whole) and _is_alike(whole):
                return whole
        if search.done:
            return False
    return None


def every_closed_map(
    tree: WalkTree, place: NDArray[np.int64], shift: NDArray[np.int64], *, until: float, most: int
) -> list[Hypothesis] | None:
    """Return all legal maps that leave no exit untravelled, as `some_map` returns one.

    Returns
    -------
    list or None
        None if time is up, or there are more than `most`.
    """
    maps: list[Hypothesis] = []
    before = None
    for search, found in _in_turn(merged(tree, place, shift), closed=True, until=until):
        if search is not before:
            before, maps = search, []
        whole = (_unfolded(tree, place, shift, quotient) for quotient in found)
        maps += [one for one in whole if _is_legal(one) and _is_alike(one)]
        if len(maps) > most:
            return None
        if search.done:
            return maps
    return None


def _in_turn(tree: WalkTree, *, closed: bool, until: float) -> Iterator[tuple[QuotientSearch, NDArray[np.int64]]]:
    """Search from several roots in turn with growing numbers of decisions; yield the search and what a slice of it found.

    It ends with the slice in which time is up; whoever takes the slices leaves when a search is done.
    """
    alike = likeness(tree)
    fails: NDArray[np.int64] | None = None
    decisions = FIRST_DECISIONS
    while True:
        for root in spread_roots(tree, ROOTS):
            search = QuotientSearch(tree, alike, root=root, closed=closed, fails=fails)
            if search.done:
                yield search, search.more(0)
            while not search.done and search.decisions < decisions:
                yield search, search.more(min(SLICE, decisions - search.decisions))
                if monotonic() > until:
                    return
            fails = search.fails
        decisions *= GROWTH


def merged(tree: WalkTree, place: NDArray[np.int64], shift: NDArray[np.int64]) -> WalkTree:
    """Return a walk with its nodes made places: no tree any more where a way closes, and else as before.

    The exits of a place are those of its first node.
    """
    lead = np.unique(place, return_index=True)[1]
    count, width = lead.size, tree.heading.shape[1]
    other = np.full((count, width), -1, np.int64)
    back = np.full((count, width), -1, np.int64)
    turn = np.zeros((count, width))
    n, x = np.nonzero(tree.other >= 0)
    m, y = tree.other[n, x], tree.back[n, x]
    here, there = (x + shift[n]) % tree.degree[n], (y + shift[m]) % tree.degree[m]
    order = np.argsort(-n, kind="stable")  # the first node that walked an exit is written last, and stays
    n, x, m, here, there = n[order], x[order], m[order], here[order], there[order]
    other[place[n], here] = place[m]
    back[place[n], here] = there
    turn[place[n], here] = tree.turn[n, x]
    # both ends of a way keep the turn of one leg
    a, z = np.nonzero(other >= 0)
    b, w = other[a, z], back[a, z]
    mirrored = (b > a) | ((b == a) & (w > z))
    turn[b[mirrored], w[mirrored]] = -turn[a[mirrored], z[mirrored]]
    names: list[str | None] = [None] * count
    for node, name in enumerate(tree.names):
        if name is not None:
            names[place[node]] = name
    node_of = tree.node_of
    return replace(
        tree,
        degree=tree.degree[lead],
        heading=tree.heading[lead],
        other=other,
        back=back,
        turn=turn,
        node_of=place[node_of],
        shift_of=(tree.shift_of + shift[node_of]) % np.maximum(tree.degree[node_of], 1),
        taken=(tree.taken + shift[node_of[:-1]]) % np.maximum(tree.degree[node_of[:-1]], 1),
        names=tuple(names),
    )


def _unfolded(tree: WalkTree, place: NDArray[np.int64], shift: NDArray[np.int64], found: NDArray[np.int64]) -> Hypothesis:
    """Return a quotient of the merged walk as one of the walk itself, places in the order of their first visits."""
    return hypothesis_of(tree, found[place, 0], shift + found[place, 1])


def _is_legal(one: Hypothesis) -> bool:
    try:
        _ = one.plane
    except NotPlane:
        return False
    return True


def _is_alike(one: Hypothesis) -> bool:
    """Whether any two nodes of a place can be one; the search compared first nodes alone."""
    order = np.argsort(one.place, kind="stable")
    for nodes in np.split(order, np.flatnonzero(np.diff(one.place[order])) + 1):
        degree = int(one.tree.degree[nodes[0]])
        i, j = np.triu_indices(nodes.size, 1)
        n, m = nodes[i], nodes[j]
        if i.size and not can_be_one(one.tree, n, m, (one.shift[n] - one.shift[m]) % max(degree, 1)).all():
            return False
    return True
