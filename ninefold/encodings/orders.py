"""Elimination orders and the chordal graphs they complete a graph to.

A graph is chordal when every cycle of more than three edges has a chord. Eliminating vertices one by one, each time
joining the neighbours that are left, completes any graph to a chordal one; the order decides how many edges come in.
Finding the fewest is NP-hard, so greedy rules choose the next vertex:

==================  ===========================================================  ====================================
order               next vertex                                                  in Bodlaender and Koster
==================  ===========================================================  ====================================
``min-fill``        fewest new edges, then fewest neighbours                     GreedyFillIn
``greedy-fill-in``  fewest new edges and neighbours together, then neighbours    GreedyDegree and fill-in, summed
``min-degree``      fewest neighbours                                            GreedyDegree
==================  ===========================================================  ====================================

Ties go to the lowest number, so an order is reproducible.

Examples
--------
>>> from ninefold.encodings.orders import triangulate
>>> square = triangulate(4, [(0, 1), (1, 2), (2, 3), (0, 3)])
>>> square.fill, square.triangles
(((1, 3),), ((0, 1, 3), (1, 2, 3)))

References
----------
H. L. Bodlaender and A. M. C. A. Koster, "Treewidth computations I: upper bounds", Information and Computation 208,
2010, section 4.
D. J. Rose, "Triangulated graphs and the elimination process", J. Mathematical Analysis and Applications 32, 1970.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from heapq import heapify, heappop, heappush
from typing import TYPE_CHECKING

from ninefold.errors import BadInput, UnknownName

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = ["ORDERS", "Triangulation", "triangulate"]

ORDERS = ("min-fill", "greedy-fill-in", "min-degree")
"""Names of the elimination orders."""


@dataclass(frozen=True, slots=True)
class Triangulation:
    """A chordal completion of a graph.

    Parameters
    ----------
    n, order
        Number of vertices, and the vertices as they were eliminated.
    edges, fill
        All edges i < j of the chordal graph, and those of them that were not in the graph; sorted.
    triangles
        Every triangle i < j < k of the chordal graph; sorted.
    width
        Most neighbours a vertex had when it was eliminated: an upper bound of the treewidth.
    """

    n: int
    order: tuple[int, ...] = field(repr=False)
    edges: tuple[tuple[int, int], ...] = field(repr=False)
    fill: tuple[tuple[int, int], ...] = field(repr=False)
    triangles: tuple[tuple[int, int, int], ...] = field(repr=False)
    width: int


def triangulate(n: int, edges: Iterable[tuple[int, int]], order: str = "min-fill") -> Triangulation:
    """Complete a graph to a chordal one.

    Parameters
    ----------
    n
        Number of vertices.
    edges
        Pairs of different vertices in either direction; repeats do no harm.
    order
        One of `ORDERS`.

    Raises
    ------
    UnknownName
        None of `ORDERS`.
    BadInput
        An edge that is not between two different vertices.

    Complexity
    ----------
    O(sum of d^2) set operations for ``min-degree``, with d the degrees at elimination; the fill-in rules recount the
    missing edges around every vertex that an elimination touches, one more factor of d.
    """
    if order not in ORDERS:
        raise UnknownName("elimination order", order, ORDERS)
    adjacent: list[set[int]] = [set() for _ in range(n)]
    for i, j in edges:
        if not (0 <= i < n and 0 <= j < n) or i == j:
            raise BadInput(f"edge ({i}, {j}) is not between two different vertices of 0 to {n - 1}")
        adjacent[i].add(j)
        adjacent[j].add(i)
    chordal = {(i, j) for i in range(n) for j in adjacent[i] if i < j}
    fill: list[tuple[int, int]] = []
    triangles: list[tuple[int, int, int]] = []
    eliminated: list[int] = []
    width = 0

    # A vertex is pushed again whenever its cost changes; entries with an old cost are passed over.
    cost = [_cost(adjacent, v, order) for v in range(n)]
    queue = [(cost[v], v) for v in range(n)]
    heapify(queue)
    gone = [False] * n
    while queue:
        known, v = heappop(queue)
        if gone[v] or known != cost[v]:
            continue
        gone[v] = True
        eliminated.append(v)
        around = sorted(adjacent[v])
        width = max(width, len(around))
        touched = set(around)
        for at, a in enumerate(around):
            adjacent[a].discard(v)
            for b in around[:at]:
                low, middle, high = sorted((a, b, v))
                triangles.append((low, middle, high))
                if b not in adjacent[a]:
                    if order != "min-degree":
                        touched |= adjacent[a] & adjacent[b]  # they miss one edge less
                    adjacent[a].add(b)
                    adjacent[b].add(a)
                    fill.append((b, a))
        for u in touched:
            new = _cost(adjacent, u, order)
            if new != cost[u]:
                cost[u] = new
                heappush(queue, (new, u))
    chordal.update(fill)
    return Triangulation(n, tuple(eliminated), tuple(sorted(chordal)), tuple(sorted(fill)), tuple(sorted(triangles)), width)


def _cost(adjacent: list[set[int]], v: int, order: str) -> tuple[int, int]:
    around = adjacent[v]
    degree = len(around)
    if order == "min-degree":
        return (degree, 0)
    present = sum(len(adjacent[u] & around) for u in around) // 2
    missing = degree * (degree - 1) // 2 - present
    return (missing, degree) if order == "min-fill" else (missing + degree, degree)
