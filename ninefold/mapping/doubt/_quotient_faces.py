"""The faces of a quotient of a folded walk, how they turn, and which pairs of nodes made them what they are.

A quotient gives every node a place and a shift. Its faces are walked along the ways walked; a face turns by a whole number
of turns, and in a plane map one turns -1 and all others +1. What a face turns depends on few pairs of nodes only: those
where the walk round it goes on from a node by the exit that another node of the same place walked; and, where exits are left
untravelled, on that no node walked those in its corners.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..heading import TAU
from ._part_kernels import Part, smallest

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from .walk_tree import WalkTree

__all__ = ["Face", "Members", "Step", "faces", "is_plane", "members", "room", "smallest_part", "steps"]


class Face(NamedTuple):
    """A face: one of its exits as (node, exit), and how often it turns."""

    node: int
    exit: int
    turns: int


class Step(NamedTuple):
    """One way along a face: the node come to and the exit to go on by, the node that walked it, its exit.

    `corner` holds the exits of `node` passed over, which nobody walked.
    """

    node: int
    exit: int
    walker: int
    walked: int
    corner: tuple[int, ...]


def faces(
    tree: WalkTree, place: NDArray[np.int64], shift: NDArray[np.int64], inside: NDArray[np.bool_] | None = None
) -> list[Face]:
    """Return the faces of a quotient, or of the part of it that some nodes make.

    Parameters
    ----------
    place
        (N,) the lowest node of the place of every node, whose exits are those of the place.
    shift
        (N,) exit x of a node is exit x + shift of its place.
    inside
        (N,) the nodes of a connected part of the tree: only ways between them are looked at.

    Notes
    -----
    Complexity O(N K), array code.
    """
    width = tree.heading.shape[1]
    n, x = _ways(tree, inside)
    if not n.size:
        return [Face(0, 0, -1)]
    m, y = tree.other[n, x], tree.back[n, x]
    here = place[n] * width + (x + shift[n]) % tree.degree[n]
    there = place[m] * width + (y + shift[m]) % tree.degree[m]
    dart, row = np.unique(here, return_index=True)
    size = tree.n_nodes * width
    number = np.full(size, -1, np.int64)
    number[dart] = np.arange(dart.size)
    mate = number[there[row]]
    head = tree.heading.reshape(-1)[dart]
    turn = tree.turn[n[row], x[row]]
    miss = head[mate] + np.pi - head - turn
    settled = turn + miss - TAU * np.round(miss / TAU)
    before = np.arange(dart.size) - 1  # darts of a place are in a row, counter-clockwise
    owner = dart // width
    begins = np.flatnonzero(np.r_[True, owner[1:] != owner[:-1]])
    before[begins] = np.r_[begins[1:], dart.size] - 1
    corner = (head - head[before]) % TAU
    corner[(corner < 1e-9) | (before == np.arange(dart.size))] = TAU
    after = before[mate]
    total = settled + np.pi - corner[mate]
    label = _orbits(after)
    turned = np.bincount(label, weights=total)
    first = np.unique(label, return_index=True)[1]
    return [
        Face(int(n[row[d]]), int(x[row[d]]), int(t))
        for d, t in zip(first.tolist(), np.rint(turned / TAU).astype(np.int64).tolist(), strict=True)
    ]


def _ways(tree: WalkTree, inside: NDArray[np.bool_] | None) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the ways walked between some nodes, as nodes and exits."""
    walked = tree.other >= 0
    if inside is not None:
        walked &= inside[:, None] & inside[tree.other]
    n, x = np.nonzero(walked)
    return n, x


def _orbits(after: NDArray[np.int64]) -> NDArray[np.int64]:
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    size = after.size
    graph = coo_array((np.ones(size, np.int8), (np.arange(size), after)), shape=(size, size))
    _, label = connected_components(graph, directed=False)
    return np.asarray(label, np.int64)


class Members(NamedTuple):
    """A quotient, and the nodes that walked every exit of its places."""

    tree: WalkTree
    place: NDArray[np.int64]
    shift: NDArray[np.int64]
    walkers: dict[int, list[tuple[int, int]]]

    def dart(self, node: int, x: int) -> int:
        """Return the exit of a place that an exit of a node is."""
        width = self.tree.heading.shape[1]
        return int(self.place[node]) * int(width) + (x + int(self.shift[node])) % int(self.tree.degree[node])


def members(
    tree: WalkTree, place: NDArray[np.int64], shift: NDArray[np.int64], inside: NDArray[np.bool_] | None = None
) -> Members:
    """List who walked what, of some nodes or all. O(N K)."""
    width = tree.heading.shape[1]
    n, x = _ways(tree, inside)
    here = place[n] * width + (x + shift[n]) % tree.degree[n]
    walkers: dict[int, list[tuple[int, int]]] = {}
    for key, *walked in zip(here.tolist(), n.tolist(), x.tolist(), strict=True):
        walkers.setdefault(key, []).append((walked[0], walked[1]))
    return Members(tree, place, shift, walkers)


def steps(quotient: Members, node: int, out: int) -> list[Step]:
    """Walk a face from an exit that a node walked, once round; it begins where it first goes over to another node.

    Notes
    -----
    Complexity O(ways of the face times nodes that walked one exit).
    """
    ahead = _onward(quotient, node, out)
    first = begun = next(ahead)
    while first.node == first.walker:
        first = next(ahead)
        if quotient.dart(first.node, first.exit) == quotient.dart(begun.node, begun.exit):
            break
    found = [first]
    for step in ahead:
        if quotient.dart(step.node, step.exit) == quotient.dart(
            first.node, first.exit
        ):  # perhaps come to by another node than before: that is what closes it
            found[0] = Step(step.node, step.exit, first.walker, first.walked, step.corner)
            break
        found.append(step)
    return found


def _onward(quotient: Members, node: int, out: int) -> Iterator[Step]:
    """Walk a face for ever, from where the way out of an exit ends."""
    tree = quotient.tree
    width = tree.heading.shape[1]
    while True:
        there, back = int(tree.other[node, out]), int(tree.back[node, out])
        degree, base, shift = int(tree.degree[there]), int(quotient.place[there]) * width, int(quotient.shift[there])
        corner: list[int] = []
        x = (back - 1) % degree
        while base + (x + shift) % degree not in quotient.walkers:
            corner.append(x)
            x = (x - 1) % degree
        who = quotient.walkers[base + (x + shift) % degree]
        if (there, x) in who:
            node, out = there, x
        else:
            node, out = min(who, key=lambda one: (abs(one[0] - there), one[0]))
        yield Step(there, x, node, out, tuple(corner))


def is_plane(around: list[Face]) -> bool:
    """Whether one face turns -1 and all others +1."""
    turns = [face.turns for face in around]
    return turns.count(-1) == 1 and turns.count(1) == len(turns) - 1


def room(tree: WalkTree) -> Part:
    """Lay out a tree for `smallest_part`."""
    count, width = tree.heading.shape
    node = np.zeros((count, 5), np.int64)
    node[:, 0] = tree.degree
    return Part(
        np.stack([tree.other.reshape(-1), tree.back.reshape(-1)], axis=1),
        np.stack([np.nan_to_num(tree.heading).reshape(-1), tree.turn.reshape(-1)], axis=1),
        node,
        np.zeros(count, np.int64),
        np.zeros((count * width, 3), np.int64),
        np.zeros(count * width, np.int64),
        np.zeros(1, np.int64),
    )


def smallest_part(part: Part, place: NDArray[np.int64], shift: NDArray[np.int64], root: int) -> NDArray[np.int64]:
    """Return the nodes of a connected part of the tree whose quotient is not plane, none if the whole is.

    What is plane stays so when ways are taken away, as long as it is connected. So of parts that grow node by node from a
    root the first that is not plane is found by bisection, again from the node that came last, and then leaves are left out
    until none can be.

    Notes
    -----
    Complexity O((log N + size of the part) N K).
    """
    part.node[:, 1] = place
    part.node[:, 2] = shift
    form = smallest.for_work(200 * place.size)
    if not form(part, root):
        return np.zeros(0, np.int64)
    return np.flatnonzero(part.node[:, 3])
