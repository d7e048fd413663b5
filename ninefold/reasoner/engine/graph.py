"""Which pairs of entities the engine keeps, and how they are numbered.

A `Frame` numbers the pairs of a *dense* network (all of them) or of a *chordal* one (the stated pairs and the fill of a
minimum-degree elimination). Nodes are renumbered by their place in the elimination, so that the neighbours of a node
which come later form a clique. Elimination stops when what is left is two fifths complete, and fills the rest in: this
*core* then holds most of the pairs, a pair in it is found by arithmetic, and it is swept over bit-planes, 64 pairs at a
time, which is worth the pairs added (at 10,000 nodes of degree 6, 2 % more pairs made the search twice as fast). A dense
frame is a chordal one whose core is everything.

Edge ``e`` joins nodes ``TAIL < HEAD``; arc ``2e`` runs from TAIL to HEAD and arc ``2e + 1`` back.

References
----------
D. J. Rose, "Triangulated graphs and the elimination process", J. Math. Anal. Appl. 32 (1970); A. George and J. W. H. Liu,
"The evolution of the minimum degree ordering algorithm", SIAM Review 31 (1989).
M. Sioutis and M. Koubarakis, "Consistency of chordal RCC-8 networks", ICTAI 2012 (Theorem 1: partial path consistency on
a chordal graph decides networks over the maximal tractable subclasses).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._kernels import kernel

from .columns import FIRST
from .words import WORD, bit_count, lowest_bit, n_words

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Frame", "arc_between", "dense_frame", "triangulated_frame"]

_ONE = np.uint64(1)


@dataclass(frozen=True, slots=True)
class Frame:
    """The pairs that are kept and their numbers.

    Attributes
    ----------
    n
        Number of nodes.
    order, place
        (n,) int32: the entity at each node, and the node of each entity.
    first
        (n + 1,) int32: edge ``first[p] + k`` joins node ``p`` to its k-th later neighbour.
    upper
        (edges before the core,) int32: those neighbours, ascending, for nodes before `core`.
    core
        First node of the complete part: node ``p >= core`` is joined to every later node.
    dense
        True when every pair is kept.
    """

    n: int
    order: NDArray[np.int32]
    place: NDArray[np.int32]
    first: NDArray[np.int32]
    upper: NDArray[np.int32]
    core: int
    dense: bool

    @property
    def n_edges(self) -> int:
        """Number of pairs kept."""
        return int(self.first[self.n])

    def ends(self) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
        """Return TAIL and HEAD of every edge, as two (E,) int32 arrays."""
        later = np.diff(self.first)
        tail = np.repeat(np.arange(self.n, dtype=np.int32), later)
        head = np.arange(self.n_edges, dtype=np.int32) - np.repeat(self.first[:-1], later) + tail + np.int32(1)
        head[: self.upper.size] = self.upper
        return tail, head

    def arcs(self, i: NDArray[Any], j: NDArray[Any]) -> NDArray[np.int64]:
        """Return the arcs from entities `i` to entities `j` (two (P,) arrays); every pair has to be kept."""
        p, q = self.place[i].astype(np.int64), self.place[j].astype(np.int64)
        low, high = np.minimum(p, q), np.maximum(p, q)
        edge = self.first[low] + high - low - 1
        sparse = np.flatnonzero(low < self.core)
        if sparse.size:
            # (node, neighbour) keys of the part before the core ascend with the edge number
            tails = np.repeat(np.arange(self.core, dtype=np.int64), np.diff(self.first[: self.core + 1]))
            keys = tails * self.n + self.upper
            edge[sparse] = np.searchsorted(keys, low[sparse] * self.n + high[sparse])
        result: NDArray[np.int64] = 2 * edge + (p > q)
        return result


def dense_frame(n: int) -> Frame:
    """Return the frame that keeps every pair of `n` entities, in their own order.

    Examples
    --------
    >>> frame = dense_frame(4)
    >>> frame.n_edges, [end.tolist() for end in frame.ends()]
    (6, [[0, 0, 0, 1, 1, 2], [1, 2, 3, 2, 3, 3]])
    """
    same = np.arange(n, dtype=np.int32)
    first = np.zeros(n + 1, dtype=np.int32)
    np.cumsum(n - 1 - same, out=first[1:])
    return Frame(n, same, same, first, np.empty(0, dtype=np.int32), 0, dense=True)


def triangulated_frame(n: int, i: NDArray[Any], j: NDArray[Any], *, most: int) -> Frame | None:
    """Return the frame of a chordal completion of the graph with edges ``i[k] - j[k]``.

    Parameters
    ----------
    most
        Give up and return None as soon as more than this many pairs would be kept.

    Complexity
    ----------
    O(E n / 64) for E pairs kept: the rows of the adjacency matrix are OR-ed a word at a time. n^2 / 8 bytes.

    Examples
    --------
    A ring of twenty gets a diagonal for each node that is eliminated, and all of them among the last few.

    >>> ring = np.arange(20)
    >>> frame = triangulated_frame(20, ring, (ring + 1) % 20, most=190)
    >>> frame.n_edges, 20 - frame.core
    (43, 6)
    """
    width = n_words(n)
    rows = np.zeros((n, width), dtype=np.uint64)
    for a, b in ((i, j), (j, i)):
        np.bitwise_or.at(rows, (a, b // WORD), _ONE << (b % WORD).astype(np.uint64))
    degree = np.bincount(np.concatenate([i, j]), minlength=n).astype(np.int32)
    order = np.full(n, -1, dtype=np.int32)
    links = np.empty((2 * n + 1, 2), dtype=np.int32)
    core, _ = eliminate.for_work(len(i) * (20 + 2 * width))(rows, degree, order, links, most)
    if core < 0:
        return None
    gone = np.zeros(n, dtype=bool)
    gone[order[:core]] = True
    order[core:] = np.flatnonzero(~gone)
    place = np.empty(n, dtype=np.int32)
    place[order] = np.arange(n, dtype=np.int32)

    later = np.concatenate([degree[order[:core]], np.arange(n - core - 1, -1, -1, dtype=np.int32)])
    first = np.zeros(n + 1, dtype=np.int32)
    np.cumsum(later, out=first[1:])
    keys = np.empty(int(first[core]), dtype=np.int64)
    list_members.for_work(keys.size + n * width // 4)(rows, order, place, core, keys)
    keys.sort()
    return Frame(n, order, place, first, (keys % n).astype(np.int32), core, dense=int(first[n]) == n * (n - 1) // 2)


@kernel(_nrt=False, forceinline=True)
def arc_between(nodes, upper, core, p, q):  # type: ignore[no-untyped-def]
    """Return the arc from node `p` to node `q`, or -1 if the pair is not kept.

    Complexity
    ----------
    O(1) in the core, else the logarithm of the number of later neighbours.
    """
    low, high, back = (p, q, 0) if p < q else (q, p, 1)
    start = nodes[low, FIRST]
    if low >= core:
        return 2 * (start + high - low - 1) + back
    stop = nodes[low + 1, FIRST]
    while start < stop:
        middle = (start + stop) >> 1
        if upper[middle] < high:
            start = middle + 1
        else:
            stop = middle
    if start < nodes[low + 1, FIRST] and upper[start] == high:
        return 2 * start + back
    return -1


@kernel(_nrt=False)
def eliminate(rows, degree, order, links, most):  # type: ignore[no-untyped-def]
    """Eliminate nodes of least degree, joining the neighbours of each, until two fifths of all pairs are there.

    Parameters
    ----------
    rows
        (n, words) uint64 adjacency, symmetric; the row of an eliminated node keeps its neighbours at that time.
    degree
        (n,) int32, kept up to date; the degree at elimination stays.
    order
        (n,) int32, receives the eliminated nodes.
    links
        (2n + 1, 2) int32 scratch: lists of nodes of equal degree, heads in the rows from n.
    most
        Give up beyond this many pairs.

    Returns
    -------
    core, kept
        Number of nodes eliminated and pairs kept, or (-1, pairs) after giving up.
    """
    n, width = rows.shape
    for head in range(n, 2 * n + 1):
        links[head, 0] = head
        links[head, 1] = head
    for v in range(n):
        _append(links, v, n + degree[v])
    left = n
    kept = 0
    least = 0
    while left > 0:
        while links[n + least, 0] == n + least:
            least += 1
        if 5 * least >= 2 * (left - 1):
            kept += left * (left - 1) // 2
            return (n - left, kept) if kept <= most else (-1, kept)
        v = links[n + least, 0]
        _unlink(links, v)
        order[n - left] = v
        left -= 1
        kept += least
        if kept > most:
            return -1, kept
        word_v, bit_v = v // WORD, _ONE << np.uint64(v % WORD)
        for w in range(width):
            rest = rows[v, w]
            while rest != 0:
                u = w * WORD + lowest_bit(rest)
                rest = rest & (rest - _ONE)
                # u takes over the other neighbours of v, and loses v
                count = 0
                for x in range(width):
                    joined = rows[u, x] | rows[v, x]
                    rows[u, x] = joined
                    count += bit_count(joined)
                word_u, bit_u = u // WORD, _ONE << np.uint64(u % WORD)
                rows[u, word_u] &= ~bit_u
                rows[u, word_v] &= ~bit_v
                count -= 2
                if count != degree[u]:
                    degree[u] = count
                    _unlink(links, u)
                    _append(links, u, n + count)
                    least = min(least, count)
    return n, kept


@kernel(_nrt=False)
def list_members(rows, order, place, core, keys):  # type: ignore[no-untyped-def]
    """Write ``node * n + neighbour`` (places in the order) for every pair kept before the core."""
    n, width = rows.shape
    top = 0
    for p in range(core):
        v = order[p]
        for w in range(width):
            rest = rows[v, w]
            while rest != 0:
                keys[top] = p * n + place[w * WORD + lowest_bit(rest)]
                top += 1
                rest = rest & (rest - _ONE)


@kernel(_nrt=False)
def _append(links, item, head):  # type: ignore[no-untyped-def]
    last = links[head, 1]
    links[last, 0] = item
    links[item, 0] = head
    links[item, 1] = last
    links[head, 1] = item


@kernel(_nrt=False)
def _unlink(links, item):  # type: ignore[no-untyped-def]
    ahead, behind = links[item, 0], links[item, 1]
    links[behind, 0] = ahead
    links[ahead, 1] = behind
