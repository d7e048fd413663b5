"""Is there a map at all: the search for a first one, for questions of which the answer is yes, no, or not known in time."""

from __future__ import annotations

from dataclasses import replace
from time import monotonic
from typing import TYPE_CHECKING

import numpy as np

from .quotients import QuotientSearch

if TYPE_CHECKING:
    from .likeness import Likeness
    from .walk_tree import WalkTree

__all__ = ["held_same", "some_map"]

ROUND = 2000
"""Decisions from one root before another is tried; every round has `GROWTH` times as many."""

GROWTH = 4

ROOTS = 8


def some_map(
    tree: WalkTree, alike: Likeness, *, closed: bool = False, max_places: int | None = None, until: float | None = None
) -> bool | None:
    """Tell whether a walk has a map; None where the time was spent before that was known.

    Parameters
    ----------
    closed
        Whether only maps count that leave no exit untravelled.
    until
        When to give up, on the clock of `time.monotonic`.
    """
    if tree.contradiction is not None:
        return False
    roots = np.unique(np.linspace(0, tree.n_nodes - 1, ROOTS).astype(int)).tolist() if closed else [0]
    decisions = ROUND
    fails = None
    while True:
        for root in roots:
            search = QuotientSearch(tree, alike, root=root, closed=closed, most_places=max_places, fails=fails)
            while not search.done and (search.decisions < decisions or len(roots) == 1):
                if len(search.more(512, 1)):
                    return True
                if until is not None and monotonic() > until:
                    return False if search.done else None
            if search.done:
                return False
            fails = search.fails
        decisions *= GROWTH


def held_same(alike: Likeness, n: int, m: int) -> Likeness:
    """Return what can be the same if two nodes, beside those known before, are one place."""
    group = alike.group.copy()
    mine = {n, m}
    for node in (n, m):
        if group[node] >= 0:
            mine |= set(np.flatnonzero(group == group[node]).tolist())
    group[list(mine)] = int(group.max(initial=-1)) + 1
    used = group >= 0
    _, group[used] = np.unique(group[used], return_inverse=True)
    return replace(alike, group=group)
