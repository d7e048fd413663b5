"""What directions alone fix: the parallel-rigid parts of a graph.

Let every edge of a graph in the plane have a known direction. Some parts then have a shape, up to place and size:
whoever draws them with these directions draws the same figure. A triangle is such a part, a rectangle is not (its two
sides may have any lengths), a rectangle with a diagonal is. These parts are *parallel-rigid*; every edge lies in
exactly one largest of them, perhaps alone.

For directions in general position it is only a matter of counting: n vertices carry at most 2 n - 3 independent
directions, and a part is rigid where some of its subsets of edges reach that with no smaller part exceeding it (Laman's
count; Whiteley showed that lengths and directions obey the same one in the plane). The *pebble game* does the count:
every vertex has two pebbles, an independent edge takes one from an end, and an edge is independent if four can be
brought to its ends. An edge that is not independent is *redundant*: its direction follows from others, so it tests
them.

Directions in special position, such as many parallel streets, can fix less than the count says; never more.

References
----------
G. Laman, On graphs and rigidity of plane skeletal structures, 1970. W. Whiteley, Some matroids from discrete applied
geometry, 1996. D. J. Jacobs and B. Hendrickson, An algorithm for two-dimensional rigidity percolation: the pebble game,
1997. A. Lee and I. Streinu, Pebble game algorithms and sparse graphs, 2008.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._kernels import kernel

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["RigidParts", "rigid_parts"]


class RigidParts(NamedTuple):
    """The parallel-rigid parts of a simple graph.

    Attributes
    ----------
    part
        (E,) int64, the part of every edge, numbered from 0 in the order of their lowest edges.
    redundant
        (E,) bool, edges whose direction follows from edges before them.
    freedom
        How many proportions are open: 2 n - 3 - (independent edges) for n vertices that edges touch. 0 for one rigid part;
        every number more is a length that can be chosen.
    """

    part: NDArray[np.int64]
    redundant: NDArray[np.bool_]
    freedom: int

    @property
    def n_parts(self) -> int:
        """Number of parts."""
        return int(self.part.max()) + 1 if self.part.size else 0

    @property
    def sizes(self) -> NDArray[np.int64]:
        """(parts,) number of edges of each part."""
        return np.bincount(self.part, minlength=self.n_parts)


def rigid_parts(ends: ArrayLike) -> RigidParts:
    """Return the parallel-rigid parts of a graph whose edges have known directions, in general position.

    Parameters
    ----------
    ends
        (E, 2) integers, the vertices that each edge joins; no loop, no two edges between the same vertices.

    Notes
    -----
    Complexity: O(V^2) at worst; nearly linear on maps, where searches for pebbles stay near or end in parts known to be
    rigid.

    Examples
    --------
    A square with a diagonal, and a square without:

    >>> rigid_parts([(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)])
    RigidParts(part=array([0, 0, 0, 0, 0]), redundant=array([False, False, False, False, False]), freedom=0)
    >>> found = rigid_parts([(0, 1), (1, 2), (2, 3), (3, 0)])
    >>> found.part.tolist(), found.freedom
    ([0, 1, 2, 3], 1)
    """
    pairs = np.asarray(ends, np.int64).reshape(-1, 2)
    if not len(pairs):
        return RigidParts(np.zeros(0, np.int64), np.zeros(0, np.bool_), 0)
    vertices, flat = np.unique(pairs, return_inverse=True)
    graph = np.ascontiguousarray(flat.reshape(-1, 2), dtype=np.int64)
    n = vertices.size
    work = 200 * len(graph)
    out, redundant = play.for_work(work)(graph, n)
    raw = collect_parts.for_work(work)(graph, out)
    _, first, labels = np.unique(raw, return_index=True, return_inverse=True)
    rank = np.empty(first.size, np.int64)
    rank[np.argsort(first)] = np.arange(first.size)
    return RigidParts(rank[labels.ravel()], redundant, int(2 * n - 3 - np.count_nonzero(~redundant)))


@kernel
def bring_pebble(out, start, stamp, stamps, mark, stack, came):  # type: ignore[no-untyped-def]
    """Bring a pebble to vertex `start`, which has none free in some slot; return whether one was found.

    Vertices with ``stamp == mark`` are not entered; those that are entered get it. ``stamps[1]`` is the number entered, and
    ``stack`` holds them.
    """
    top = 0
    stamp[start] = mark
    entered = 0
    stack[0] = start
    top = 1
    while entered < top:
        x = stack[entered]
        entered += 1
        for slot in range(2):
            y = out[x, slot]
            if y < 0 or stamp[y] == mark:
                continue
            stamp[y] = mark
            came[y] = x
            if out[y, 0] < 0 or out[y, 1] < 0:
                # turn the way round: y pays for the edge that x paid for, and so on back to the start
                b = y
                while b != start:
                    a = came[b]
                    side = 0 if out[a, 0] == b else 1
                    free = 0 if out[b, 0] < 0 else 1
                    out[b, free] = a
                    out[a, side] = -1
                    b = a
                return True
            stack[top] = y
            top += 1
    stamps[1] = top
    return False


@kernel
def gather(out, u, v, wanted, stamp, stamps, stack, came):  # type: ignore[no-untyped-def]
    """Bring up to two pebbles to u, then to v until both hold `wanted`; return how many they hold.

    Where fewer than four of four were found, ``stack`` holds the vertices that the failed search reached.
    """
    held = 0
    for k in range(2):
        x, other = (u, v) if k == 0 else (v, u)
        while True:
            mine = (1 if out[x, 0] < 0 else 0) + (1 if out[x, 1] < 0 else 0)
            if mine == 2 or (k == 1 and held + mine >= wanted):
                break
            stamps[0] += 1
            stamp[other] = stamps[0]
            if not bring_pebble(out, x, stamp, stamps, stamps[0], stack, came):
                break
        held += mine
        if held + 2 < wanted:  # the other end cannot make up for it
            break
    return held


@kernel
def play(pairs, n):  # type: ignore[no-untyped-def]
    """Play the pebble game; return who pays for the independent edges, (n, 2), and which edges are redundant."""
    out = np.full((n, 2), -1, np.int64)
    redundant = np.zeros(pairs.shape[0], np.bool_)
    stamp = np.zeros(n, np.int64)
    stamps = np.zeros(2, np.int64)
    stack = np.empty(n + 1, np.int64)
    came = np.empty(n, np.int64)
    body = np.zeros(n, np.int64)
    for e in range(pairs.shape[0]):
        u, v = pairs[e, 0], pairs[e, 1]
        if body[u] != 0 and body[u] == body[v]:
            redundant[e] = True
            continue
        if gather(out, u, v, 4, stamp, stamps, stack, came) == 4:
            out[u, 0] = v
            continue
        redundant[e] = True
        body[u] = e + 1
        body[v] = e + 1
        for k in range(stamps[1]):  # what was reached is one rigid body with u and v
            body[stack[k]] = e + 1
    return out, redundant


@kernel
def all_paid(out, start, stamp, found, seen, mark, stack):  # type: ignore[no-untyped-def]
    """Return how many vertices are reached from `start` before those stamped `found`, or -1 if one has a free pebble.

    Which were reached is marked in `seen`.
    """
    seen[start] = mark
    stack[0] = start
    top = 1
    entered = 0
    if out[start, 0] < 0 or out[start, 1] < 0:
        return -1
    while entered < top:
        x = stack[entered]
        entered += 1
        for slot in range(2):
            y = out[x, slot]
            if seen[y] == mark or stamp[y] == found:
                continue
            if out[y, 0] < 0 or out[y, 1] < 0:
                return -1
            seen[y] = mark
            stack[top] = y
            top += 1
    return top


@kernel
def collect_parts(pairs, out):  # type: ignore[no-untyped-def]
    """Return the part of every edge, numbered by an edge of it.

    With three pebbles on the ends of an edge, the part that the edge is in is what can be reached from the ends, and what
    reaches only that: not a vertex from which another free pebble can be had.
    """
    n, n_edges = out.shape[0], pairs.shape[0]
    first = np.zeros(n + 1, np.int64)
    for e in range(n_edges):
        first[pairs[e, 0] + 1] += 1
        first[pairs[e, 1] + 1] += 1
    for v in range(n):
        first[v + 1] += first[v]
    fill = first[:n].copy()
    at = np.empty(2 * n_edges, np.int64)
    for e in range(n_edges):
        for k in range(2):
            v = pairs[e, k]
            at[fill[v]] = e
            fill[v] += 1
    part = np.full(n_edges, -1, np.int64)
    stamp = np.zeros(n, np.int64)
    stamps = np.zeros(2, np.int64)
    stack = np.empty(n + 1, np.int64)
    came = np.empty(n, np.int64)
    members = np.empty(n, np.int64)
    seen = np.zeros(n, np.int64)
    mark = 0
    for e in range(n_edges):
        if part[e] >= 0:
            continue
        u, v = pairs[e, 0], pairs[e, 1]
        gather(out, u, v, 3, stamp, stamps, stack, came)
        stamps[0] += 1
        found = stamps[0]
        stamps[0] += 1
        loose = stamps[0]
        stamp[u] = found
        stamp[v] = found
        members[0] = u
        members[1] = v
        size = 2
        at_member = 0
        while at_member < size:  # what the ends reach: no free pebble, or the ends would hold four
            x = members[at_member]
            at_member += 1
            for slot in range(2):
                y = out[x, slot]
                if y >= 0 and stamp[y] != found:
                    stamp[y] = found
                    members[size] = y
                    size += 1
        at_member = 0
        while at_member < size:  # neighbours that reach only these
            x = members[at_member]
            at_member += 1
            for k in range(first[x], first[x + 1]):
                f = at[k]
                y = pairs[f, 0] + pairs[f, 1] - x
                if stamp[y] == found or stamp[y] == loose:
                    continue
                mark += 1
                reached = all_paid(out, y, stamp, found, seen, mark, stack)
                if reached < 0:
                    stamp[y] = loose
                    continue
                for j in range(reached):
                    stamp[stack[j]] = found
                    members[size] = stack[j]
                    size += 1
        for j in range(size):
            x = members[j]
            for k in range(first[x], first[x + 1]):
                f = at[k]
                if stamp[pairs[f, 0]] == found and stamp[pairs[f, 1]] == found:
                    part[f] = e
    return part
