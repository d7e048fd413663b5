"""Subdividing loops and parallel edges, so that a plane map becomes simple and every piece can be a straight segment.

Of several parallel edges the lowest keeps its straight form and each other gets one bend; a loop gets two. A bend is a
new vertex of degree 2, so faces, rotation and outer face are those of the map.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["SimpleMap", "make_simple"]


@dataclass(frozen=True, slots=True, eq=False)
class SimpleMap:
    """A simple connected plane map, and which of its vertices are bends of which edge of the map it came from.

    Attributes
    ----------
    tail, next_ccw
        (2M,) int32; the first 2E darts keep their numbers, dart 2e still leaves the tail it left.
    outer
        A dart with the outer face on its left, -1 for a map with no edge.
    n_vertices
        Bends included; they are numbered after the vertices, edge by edge.
    bend_start
        (E + 1,) int64: the bends of edge e are vertices ``V + bend_start[e]`` to ``V + bend_start[e + 1] - 1``, in order
        along dart 2e.
    """

    tail: NDArray[np.int32]
    next_ccw: NDArray[np.int32]
    outer: int
    n_vertices: int
    bend_start: NDArray[np.int64]


def make_simple(tail: NDArray[np.int32], next_ccw: NDArray[np.int32], outer: int, n_vertices: int) -> SimpleMap:
    """Subdivide every loop twice and every parallel edge but one of each bundle once.

    Parameters
    ----------
    tail, next_ccw
        (2E,) the rotation system.
    outer
        A dart with the outer face on its left, or -1.
    n_vertices
        Number of vertices.

    Notes
    -----
    Complexity O(E log E), array code throughout.

    Examples
    --------
    >>> import numpy as np
    >>> loop = make_simple(np.zeros(2, np.int32), np.array([1, 0], np.int32), 0, 1)
    >>> loop.n_vertices, loop.tail.tolist()
    (3, [0, 1, 1, 2, 2, 0])
    """
    n_edges = tail.size // 2
    bends = _bends_needed(tail, n_vertices)
    bend_start = np.concatenate([[0], np.cumsum(bends)]).astype(np.int64)
    extra = int(bend_start[-1])
    if not extra:
        return SimpleMap(tail, next_ccw, outer, n_vertices, bend_start)
    size = tail.size + 2 * extra
    far = np.arange(tail.size, dtype=np.int32)  # where the dart at the head of each edge goes: to the edge's last piece
    bent = np.flatnonzero(bends)
    last_piece = n_edges + bend_start[bent + 1] - 1
    far[2 * bent + 1] = 2 * last_piece + 1
    tails, after = np.empty(size, np.int32), np.empty(size, np.int32)
    tails[far], after[far] = tail, far[next_ccw]
    # At bend b piece `incoming` ends and piece E + b begins; the first bend of an edge ends the edge's own number.
    b = np.arange(extra)
    incoming = n_edges + b - 1
    incoming[bend_start[bent]] = bent
    arrive, leave = 2 * incoming + 1, 2 * (n_edges + b)
    tails[arrive] = tails[leave] = n_vertices + b
    after[arrive], after[leave] = leave, arrive
    return SimpleMap(tails, after, int(far[outer]), n_vertices + extra, bend_start)


def _bends_needed(tail: NDArray[np.int32], n_vertices: int) -> NDArray[np.int64]:
    """Bends per edge, (E,): 2 for a loop, 1 for a parallel edge that is not the lowest of its bundle, else 0."""
    ends = tail.reshape(-1, 2).astype(np.int64)
    low, high = ends.min(axis=1), ends.max(axis=1)
    bundle = low * n_vertices + high
    order = np.argsort(bundle, kind="stable")
    bends = np.zeros(len(ends), np.int64)
    bends[order[1:]] = bundle[order[1:]] == bundle[order[:-1]]
    bends[low == high] = 2
    return bends
