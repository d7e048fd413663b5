"""Is there a map at all: the search for a first one, for questions of which the answer is yes, no, or not known in time."""

from __future__ import annotations

from dataclasses import replace
from math import inf
from time import monotonic
from typing import TYPE_CHECKING

import numpy as np

from .quotient_portfolio import closed_maps
from .quotients import QuotientSearch, spread_roots

if TYPE_CHECKING:
    from .likeness import Likeness
    from .walk_tree import WalkTree

__all__ = ["held_same", "some_map"]

FIRST_DECISIONS = 2000
"""Decisions for a first closed map from one root before all of them are looked for."""

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
    roots = spread_roots(tree, ROOTS) if closed else [0]
    for root in roots:
        search = QuotientSearch(tree, alike, root=root, closed=closed, most_places=max_places)
        while not search.done and (not closed or search.decisions < FIRST_DECISIONS):
            if len(search.more(512, 1)):
                return True
            if until is not None and monotonic() > until and not search.done:
                return None
        if search.done:
            return False
    found = closed_maps(tree, alike, until=inf if until is None else until, most=1, most_places=max_places)
    return True if found.found else False if found.exact else None


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
