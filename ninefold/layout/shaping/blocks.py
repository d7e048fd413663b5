"""Blocks: the 2-connected parts and bridges of a graph, and how they hang from each other at cut vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._kernels import kernel

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["BlockTree", "block_tree"]


class BlockTree(NamedTuple):
    """The blocks of a connected simple graph, rooted.

    Attributes
    ----------
    block
        (M,) int64, block of each edge. A block has a lower number than the block it hangs from.
    head
        (B,) int64, the vertex by which each block hangs; for blocks at the root the root vertex.
    of_vertex
        (n,) int64, the block in which a vertex is not the head, -1 for the root.
    parent, level
        (B,) int64, the block that the head belongs to (-1 at the root), and the number of blocks above.
    root
        The block that stands still.
    """

    block: NDArray[np.int64]
    head: NDArray[np.int64]
    of_vertex: NDArray[np.int64]
    parent: NDArray[np.int64]
    level: NDArray[np.int64]
    root: int


def block_tree(tail: NDArray[np.int64], after: NDArray[np.int64], n: int, outer: int) -> BlockTree:
    """Return the blocks, rooted in the largest one on the face of dart `outer`.

    Notes
    -----
    Two depth-first walks, O(V + E).

    Examples
    --------
    Two triangles that share vertex 2, and a dead end at 4:

    >>> import networkx as nx
    >>> graph = nx.Graph([(0, 1), (1, 2), (2, 0), (2, 3), (3, 4), (4, 2), (4, 5)])
    >>> ends = np.array(graph.edges)
    >>> tail = ends.ravel()
    >>> after = np.empty(tail.size, np.int64)
    >>> for v in range(6):
    ...     darts = np.flatnonzero(tail == v)
    ...     after[darts] = np.roll(darts, -1)
    >>> tree = block_tree(tail, after, 6, 0)
    >>> np.bincount(tree.block).tolist(), tree.head.tolist(), tree.parent.tolist()
    ([1, 3, 3], [4, 2, 0], [1, 2, -1])
    """
    first = np.full(n, -1, np.int64)
    first[tail[::-1]] = np.arange(tail.size)[::-1]
    find = find_blocks.for_work(12 * tail.size)
    block, _ = find(tail, after, first, int(tail[outer]))
    before = np.empty(tail.size, np.int64)
    before[after] = np.arange(tail.size)
    rim = [outer]
    d = int(before[outer ^ 1])
    while d != outer:
        rim.append(d)
        d = int(before[d ^ 1])
    on_rim = np.unique(block[np.array(rim) >> 1])
    largest = int(on_rim[np.argmax(np.bincount(block)[on_rim])])
    start = int(tail[2 * int(np.flatnonzero(block == largest)[0])])
    inside = int(np.flatnonzero(block == largest)[0])
    block, head = find(tail, after, first, start)
    of_vertex = np.full(n, -1, np.int64)
    for end in (tail[0::2], tail[1::2]):
        below = head[block] != end
        of_vertex[end[below]] = block[below]
    parent = of_vertex[head]
    level = np.zeros(head.size, np.int64)
    for b in range(head.size - 1, -1, -1):
        if parent[b] >= 0:
            level[b] = level[parent[b]] + 1
    return BlockTree(block, head, of_vertex, parent, level, int(block[inside]))


@kernel
def find_blocks(tail, after, first, root):  # type: ignore[no-untyped-def]
    """Return the block of every edge and the head of every block, numbered as a depth-first walk from `root` leaves them.

    References
    ----------
    R. E. Tarjan, Depth-first search and linear graph algorithms, SIAM J. Computing 1, 1972.
    """
    n_edges = tail.size // 2
    n = first.size
    block = np.full(n_edges, -1, np.int64)
    head = np.full(n_edges, -1, np.int64)
    degree = np.zeros(n, np.int64)
    for d in tail:
        degree[d] += 1
    number = np.zeros(n, np.int64)
    low = np.zeros(n, np.int64)
    at = first.copy()
    seen = np.zeros(n, np.int64)
    entered = np.full(n, -1, np.int64)
    used = np.zeros(n_edges, np.bool_)
    path = np.empty(n + 1, np.int64)
    stack = np.empty(n_edges + 1, np.int64)
    top = 0
    n_blocks = 0
    clock = 1
    depth = 1
    path[0] = root
    number[root] = 1
    low[root] = 1
    while depth > 0:
        u = path[depth - 1]
        if seen[u] < degree[u]:
            d = at[u]
            at[u] = after[d]
            seen[u] += 1
            e = d >> 1
            if used[e]:
                continue
            used[e] = True
            stack[top] = e
            top += 1
            v = tail[d ^ 1]
            if number[v] == 0:
                clock += 1
                number[v] = clock
                low[v] = clock
                entered[v] = e
                path[depth] = v
                depth += 1
            else:
                low[u] = min(low[u], number[v])
            continue
        depth -= 1
        if depth > 0:
            w = path[depth - 1]
            low[w] = min(low[w], low[u])
            if low[u] >= number[w]:
                while True:
                    top -= 1
                    e = stack[top]
                    block[e] = n_blocks
                    if e == entered[u]:
                        break
                head[n_blocks] = w
                n_blocks += 1
    return block, head[:n_blocks].copy()
