"""What follows if two nodes of a folded walk are one place: all that has to be the same then, and what of it cannot be.

Where two nodes are one place, an exit walked from both leads to one place too, entered by one exit; and so on. `merged`
follows this to its end: to places that may all be, or to two nodes that would have to be one and cannot.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .likeness import Likeness
    from .walk_tree import WalkTree

__all__ = ["Clash", "Merged", "merged"]


@dataclass(frozen=True, slots=True)
class Clash:
    """Two nodes that would have to be one place and cannot.

    Attributes
    ----------
    chain
        Pairs of nodes, each the consequence of the one before, from the one assumed on.
    pair
        The two nodes that cannot; equal where one exit of a place would have to be another of the same place.
    """

    chain: tuple[tuple[int, int], ...]
    pair: tuple[int, int]


@dataclass(slots=True)
class Merged:
    """Nodes of a tree put together to places.

    Attributes
    ----------
    place
        For every node, the node that stands for its place.
    shift
        For every node: its exit x is exit x + shift of that node.
    members
        For every node that stands for a place, the nodes there.
    ways
        For such a node and an exit of it that was walked, a node and its exit by which.
    """

    place: list[int]
    shift: list[int]
    members: dict[int, list[int]] = field(default_factory=dict)
    ways: dict[tuple[int, int], tuple[int, int]] = field(default_factory=dict)


def merged(tree: WalkTree, alike: Likeness, n: int, m: int, shift: int) -> Merged | Clash:
    """Let exit x of node n be exit x + shift of node m, and follow what that means.

    Notes
    -----
    Complexity O(nodes times exits, and pairs of nodes that become one place).
    """
    count = tree.n_nodes
    found = Merged(list(range(count)), [0] * count, {k: [k] for k in range(count)})
    for k in range(count):
        for x in range(int(tree.degree[k])):
            if tree.other[k, x] >= 0:
                found.ways[k, x] = (k, x)
    came_from: list[int] = [-1]
    pairs = [(n, m, shift)]
    queue = deque([0])
    while queue:
        at = queue.popleft()
        a, b, k = pairs[at]
        follows = _joined(tree, alike, found, a, b, k)
        if isinstance(follows, tuple):
            return Clash(_chain(pairs, came_from, at), follows)
        for pair in follows:
            pairs.append(pair)
            came_from.append(at)
            queue.append(len(pairs) - 1)
    for (place, exit_), (k, x) in found.ways.items():
        m, y = int(tree.other[k, x]), int(tree.back[k, x])
        if found.place[m] == place and (y + found.shift[m]) % int(tree.degree[m]) == exit_:
            return Clash(_chain(pairs, came_from, 0), (k, k))
    return found


def _joined(
    tree: WalkTree, alike: Likeness, found: Merged, a: int, b: int, k: int
) -> list[tuple[int, int, int]] | tuple[int, int]:
    """Make the places of two nodes one; return the pairs that follow, or the two nodes that cannot be one."""
    degree = int(tree.degree[a])
    if degree != int(tree.degree[b]):
        return a, b
    if degree == 0:
        return []
    p, q = found.place[a], found.place[b]
    shift = (k + found.shift[b] - found.shift[a]) % degree  # exit x of p is exit x + shift of q
    if p == q:
        return [] if shift == 0 else (a, a)
    for one in found.members[p]:
        for other in found.members[q]:
            between = (found.shift[one] + shift - found.shift[other]) % degree
            if not (int(alike.shifts[one, other]) >> between) & 1:
                return one, other
    if len(found.members[p]) > len(found.members[q]):
        p, q, shift = q, p, -shift % degree
    for one in found.members[p]:
        found.place[one] = q
        found.shift[one] = (found.shift[one] + shift) % degree
    found.members[q] += found.members.pop(p)
    follows = []
    for x in range(degree):
        way = found.ways.pop((p, x), None)
        if way is None:
            continue
        y = (x + shift) % degree
        beside = found.ways.setdefault((q, y), way)
        if beside != way:
            one, other = int(tree.other[way]), int(tree.other[beside])
            follows.append((one, other, (int(tree.back[beside]) - int(tree.back[way])) % int(tree.degree[other])))
    return follows


def _chain(pairs: list[tuple[int, int, int]], came_from: list[int], at: int) -> tuple[tuple[int, int], ...]:
    chain = []
    while at >= 0:
        chain.append(pairs[at][:2])
        at = came_from[at]
    return tuple(reversed(chain))
