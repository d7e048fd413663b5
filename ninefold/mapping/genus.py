"""What is wrong with a rotation system that is not plane: its genus and a shortest offending part.

A rotation system has genus 0 exactly when no two of its cycles cross an odd number of times. The witness given is a
pair of closed walks through one vertex that cross once, of least total length: a theta whose two ends turn the same way,
or two interleaved loops.

For a root vertex contract its breadth-first tree: the contour of the tree lists the remaining darts in cyclic order, and
two edges cross when their ends interleave. Some root on the optimal pair shows it (each of the two cycles is a sum of
fundamental cycles no longer than itself, and crossing is bilinear), so trying every root is exact. Balls of the best
radius so far are enough, which keeps the search local. Any interleaving pair, found in linear time, tells where to begin.

References
----------
B. Mohar and C. Thomassen, Graphs on Surfaces (2001), section 4.3 (the three-path condition).
"""

from __future__ import annotations

from collections import deque
from itertools import chain, islice
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
    Complexity O(E) where the rotation system is plane, else O(E + V * ball), ball = darts within half the length of the
    answer; the work limit bounds the second part.
    """
    best, bound, near = _any_crossing(tail, next_ccw, first)
    if not best:
        return [], True
    work = 0
    radius = 1  # of the balls tried at a vertex near the first pair: doubled until one shows a crossing
    for root in chain(near, range(len(first))):
        if first[root] < 0:
            continue
        while True:
            if work > work_limit:
                return sorted(_without_stems(tail, best)), False
            radius = min(radius, bound // 2)
            depth, parent, steps = _ball(tail, next_ccw, first, root, radius)
            work += steps
            pair, length, steps = _cheapest_crossing(tail, next_ccw, first[root], depth, parent, bound, work_limit - work)
            work += steps
            if pair is not None:
                bound = length
                best = _union(tail, parent, pair)
            if radius >= bound // 2:
                break
            radius *= 2
    return sorted(_without_stems(tail, best)), work <= work_limit


def _any_crossing(tail: Sequence[int], next_ccw: Sequence[int], first: Sequence[int]) -> tuple[list[int], int, list[int]]:
    """Find some crossing pair in linear time: its edges, the length of its two walks and the ends of its two chords."""
    seen: set[int] = set()
    for root, start in enumerate(first):
        if start < 0 or root in seen:
            continue
        depth, parent, _ = _ball(tail, next_ccw, first, root, len(first))
        seen.update(depth)
        open_chords: list[int] = []
        is_open: set[int] = set()
        for e in _contour(tail, next_ccw, start, depth, parent)[0]:
            if e not in is_open:
                is_open.add(e)
                open_chords.append(e)
            elif open_chords[-1] == e:
                open_chords.pop()
            else:  # the chord on top began after e and has not ended
                pair = (open_chords[-1], e)
                ends = [tail[d] for f in pair for d in (2 * f, 2 * f + 1)]
                return _union(tail, parent, pair), sum(depth[v] for v in ends) + 2, ends
    return [], 0, []


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


def _contour(
    tail: Sequence[int], next_ccw: Sequence[int], start: int, depth: dict[int, int], parent: dict[int, int]
) -> tuple[list[int], int]:
    """Walk counter-clockwise around a tree: the chords between its vertices in order, each twice, and the steps taken."""
    tree = {d >> 1 for d in parent.values() if d >= 0}
    chords: list[int] = []
    d = start
    steps = 0
    while True:
        if d >> 1 in tree:
            d = next_ccw[d ^ 1]
        else:
            if tail[d ^ 1] in depth:
                chords.append(d >> 1)
            d = next_ccw[d]
        steps += 1
        if d == start:
            return chords, steps


def _cheapest_crossing(
    tail: Sequence[int],
    next_ccw: Sequence[int],
    start: int,
    depth: dict[int, int],
    parent: dict[int, int],
    bound: int,
    work_left: int,
) -> tuple[tuple[int, int] | None, int, int]:
    """Among the non-tree edges, the interleaving pair with the least sum of closed-walk lengths, if below the bound.

    Gives up, with the best pair so far, when more than `work_left` steps are taken; the number taken comes last.
    """
    order, steps = _contour(tail, next_ccw, start, depth, parent)
    at: dict[int, list[int]] = {}
    for place, e in enumerate(order):
        at.setdefault(e, []).append(place)
    chords = sorted((depth[tail[2 * e]] + depth[tail[2 * e + 1]] + 1, e, *ends) for e, ends in at.items())
    best: tuple[int, int] | None = None
    for i, (length, e, a, b) in enumerate(chords):
        if length + chords[0][0] >= bound or steps > work_left:
            break
        for other, f, x, y in islice(chords, i):
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
    incident: dict[int, set[int]] = {}
    for e in kept:
        for v in (tail[2 * e], tail[2 * e + 1]):
            incident.setdefault(v, set()).add(e)
    loops = {e for e in kept if tail[2 * e] == tail[2 * e + 1]}
    pendant = [v for v, at in incident.items() if len(at) == 1 and not at & loops]
    while pendant:
        at = incident[pendant.pop()]
        if not at:
            continue
        e = at.pop()
        kept.remove(e)
        for v in (tail[2 * e], tail[2 * e + 1]):
            incident[v].discard(e)
            if len(incident[v]) == 1 and not incident[v] & loops:
                pendant.append(v)
    return list(kept)
