"""What is wrong with a rotation system that is not plane: its genus and a shortest offending part.

A rotation system has genus 0 exactly when no two of its cycles cross an odd number of times. The witness given is a
pair of closed walks through one vertex that cross once, of least total length: a theta whose two ends turn the same way,
or two interleaved loops.

For a root vertex contract its breadth-first tree: the contour of the tree lists the remaining darts in cyclic order, and
two edges cross when their ends interleave. Some root on the optimal pair shows it (each of the two cycles is a sum of
fundamental cycles no longer than itself, and crossing is bilinear), so trying every root is exact. Balls of the best
radius so far are enough, which keeps the search local.

References
----------
B. Mohar and C. Thomassen, Graphs on Surfaces (2001), section 4.3 (the three-path condition).
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["offending_part"]

WORK_LIMIT = 4_000_000


def offending_part(
    tail: Sequence[int], next_ccw: Sequence[int], first: Sequence[int], *, work_limit: int = WORK_LIMIT
) -> tuple[list[int], bool]:
    """Find a shortest part of a rotation system that has no plane drawing.

    Parameters
    ----------
    tail, next_ccw
        (2E,) the rotation system, as Python lists for speed.
    first
        (V,) a dart at each vertex, -1 for none.
    work_limit
        Darts looked at before the search settles for the best part found so far.

    Returns
    -------
    edges
        Edge numbers, ascending; empty if the rotation system is plane.
    shortest
        False if the work limit was reached, so that a shorter part may exist.

    Notes
    -----
    Complexity O(V * ball), ball = darts within half the length of the answer; O(E + beta^2) for the first root.
    """
    best: list[int] = []
    bound = 2 * len(tail) + 2
    work = 0
    shortest = True
    for root, start in enumerate(first):
        if start < 0:
            continue
        if work > work_limit and best:
            shortest = False
            break
        depth, parent, steps = _ball(tail, next_ccw, first, root, bound // 2)
        work += steps
        pair, length, steps = _cheapest_crossing(tail, next_ccw, start, depth, parent, bound)
        work += steps
        if pair is not None:
            bound = length
            best = _union(tail, parent, pair)
    return sorted(_without_stems(tail, best)), shortest


def _ball(
    tail: Sequence[int], next_ccw: Sequence[int], first: Sequence[int], root: int, radius: int
) -> tuple[dict[int, int], dict[int, int], int]:
    """Breadth-first tree around a root: depth and the dart that leads back up, for vertices within the radius."""
    depth, parent = {root: 0}, {root: -1}
    queue = deque([root])
    steps = 0
    while queue:
        v = queue.popleft()
        if depth[v] >= radius:
            continue
        d = start = first[v]
        while True:
            steps += 1
            w = tail[d ^ 1]
            if w not in depth:
                depth[w] = depth[v] + 1
                parent[w] = d ^ 1
                queue.append(w)
            d = next_ccw[d]
            if d == start:
                break
    return depth, parent, steps


def _cheapest_crossing(
    tail: Sequence[int],
    next_ccw: Sequence[int],
    start: int,
    depth: dict[int, int],
    parent: dict[int, int],
    bound: int,
) -> tuple[tuple[int, int] | None, int, int]:
    """Among the non-tree edges, the interleaving pair with the least sum of closed-walk lengths, if below the bound."""
    tree = {d >> 1 for d in parent.values() if d >= 0}
    at: dict[int, list[int]] = {}
    d = start
    steps = 0
    while True:  # the contour of the tree, counter-clockwise
        if d >> 1 in tree:
            d = next_ccw[d ^ 1]
        else:
            if tail[d ^ 1] in depth:
                at.setdefault(d >> 1, []).append(steps)
            d = next_ccw[d]
        steps += 1
        if d == start:
            break
    chords = sorted(
        (depth[tail[2 * e]] + depth[tail[2 * e + 1]] + 1, e, ends[0], ends[1]) for e, ends in at.items() if len(ends) == 2
    )
    best: tuple[int, int] | None = None
    for i, (length, e, a, b) in enumerate(chords):
        if length + chords[0][0] >= bound:
            break
        for other, f, x, y in chords[:i]:
            steps += 1
            if length + other >= bound:
                break
            if (a < x < b) != (a < y < b):
                best, bound = (f, e), length + other
                break
    return best, bound, steps


def _union(tail: Sequence[int], parent: dict[int, int], pair: tuple[int, int]) -> list[int]:
    """Collect the edges of the two closed walks through the root."""
    edges = set(pair)
    for e in pair:
        for v in (tail[2 * e], tail[2 * e + 1]):
            up = parent[v]
            while up >= 0:
                edges.add(up >> 1)
                up = parent[tail[up ^ 1]]
    return list(edges)


def _without_stems(tail: Sequence[int], edges: list[int]) -> list[int]:
    """Drop the pendant paths that only led to the root."""
    kept = set(edges)
    while True:
        ends: dict[int, list[int]] = {}
        for e in kept:
            ends.setdefault(tail[2 * e], []).append(e)
            ends.setdefault(tail[2 * e + 1], []).append(e)
        pendant = {incident[0] for incident in ends.values() if len(incident) == 1}
        if not pendant:
            return list(kept)
        kept -= pendant
