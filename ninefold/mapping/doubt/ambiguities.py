"""How much a walk leaves open, in bits, after every visit: the logarithm of the number of maps that explain it so far."""

from __future__ import annotations

from dataclasses import replace
from math import inf, log2
from time import monotonic
from typing import TYPE_CHECKING

import numpy as np

from ..robot.walk import Visit
from .likeness import likeness
from .quotients import QuotientSearch
from .walk_tree import fold

if TYPE_CHECKING:
    from ..robot.walk import Walk
    from .walk_tree import WalkTree

__all__ = ["ambiguity"]

BUDGET = 60.0
"""Seconds for all visits, if nothing else is asked for."""

SHARE = 4
"""How many times its even share of the budget left one visit may take."""

AT_ONCE = 2048
"""Decisions between two looks at the clock."""


def ambiguity(walk: Walk, *, tolerance: float | None = None, budget: float | None = None) -> tuple[float | None, ...]:
    """Return the bits that a walk leaves open after each of its visits.

    All maps count, whether exits are left untravelled in them or not: the robot is on its way.

    Parameters
    ----------
    tolerance
        Radians within which two headings may be of one exit, instead of the header's.
    budget
        Seconds, 60 if left out.

    Returns
    -------
    tuple
        For every visit the logarithm to base 2 of the number of maps that explain the walk as far as it; minus infinity once
        there is none, None where counting them did not come to its end.

    Raises
    ------
    WalkError
        As `hypotheses` does.

    Examples
    --------
    Two steps north where every place has an exit north and one south: the third place may be the first, but no plane map has
    such a ring, and so may not.

    >>> from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader
    >>> north, south = Heading.from_degrees(90), Heading.from_degrees(270)
    >>> place, leg = Visit(None, exits=(north, south)), Samples.of(north, north)
    >>> ambiguity(Walk(WalkHeader(), (place, leg, place, leg, place)))
    (0.0, 0.0, 0.0)
    """
    tree = fold(walk, tolerance=tolerance)
    names = [event.place for event in walk.events if isinstance(event, Visit)]
    found: list[float | None] = []
    until = monotonic() + (BUDGET if budget is None else budget)
    known: dict[int, str] = {}
    before: tuple[int, int] | None = None
    for visit in range(tree.n_visits):
        name = names[visit]
        if name is not None:
            known[int(tree.node_of[visit])] = name
        size = int(tree.node_of[: visit + 1].max()) + 1
        if (size, len(known)) != before:
            before = size, len(known)
            now = monotonic()
            share = SHARE * (until - now) / (tree.n_visits - visit)
            bits = _bits(_begun(tree, size, known), min(until, now + share))
        found.append(bits)
    return (*found, *[-inf] * (len(names) - len(found)))


def _begun(tree: WalkTree, size: int, known: dict[int, str]) -> WalkTree:
    """Return the first nodes of a tree, with the names known by then."""
    beyond = tree.other[:size] >= size
    return replace(
        tree,
        degree=tree.degree[:size],
        heading=tree.heading[:size],
        other=np.where(beyond, -1, tree.other[:size]),
        back=np.where(beyond, -1, tree.back[:size]),
        turn=np.where(beyond, 0.0, tree.turn[:size]),
        names=tuple(known.get(n) for n in range(size)),
    )


def _bits(tree: WalkTree, until: float) -> float | None:
    search = QuotientSearch(tree, likeness(tree))
    while not search.done:
        if monotonic() > until:
            return None
        search.more(AT_ONCE)
    return log2(search.found) if search.found else -inf
