"""Kernels that find a small part of a quotient that is not plane.

Exit x of node n is ``n * K + x``. The place of a node is the lowest node of it, whose exits it has. All functions change the
scratch arrays they are given.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._kernels import kernel

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Part", "smallest"]


class Part(NamedTuple):
    """A folded walk of N nodes, at most K exits each, a quotient of it, and room to look at parts of it."""

    way: NDArray[np.int64]
    """(N K, 2): the node at the other end and the exit there, or -1."""
    angle: NDArray[np.float64]
    """(N K, 2): heading, net turn."""
    node: NDArray[np.int64]
    """(N, 5): degree; place, shift; whether it is in the part; whether it was met."""
    order: NDArray[np.int64]
    """(N,): nodes by distance from a root."""
    exit: NDArray[np.int64]
    """(N K, 3): when an exit of a place was last walked, by which exit of a node, when its face was walked."""
    dart: NDArray[np.int64]
    """(N K,): exits of places walked."""
    clock: NDArray[np.int64]
    """(1,): how many parts were looked at."""


@kernel
def is_plane(part, size):  # type: ignore[no-untyped-def]
    """Whether the quotient of the first nodes in `order` that are in the part is plane: one face turns -1, all others +1."""
    width = part.way.shape[0] // part.node.shape[0]
    part.clock[0] += 1
    now = part.clock[0]
    darts = 0
    for i in range(size):
        n = part.order[i]
        if not part.node[n, 3]:
            continue
        for x in range(part.node[n, 0]):
            m = part.way[n * width + x, 0]
            if m < 0 or not part.node[m, 3]:
                continue
            e = part.node[n, 1] * width + (x + part.node[n, 2]) % part.node[n, 0]
            if part.exit[e, 0] != now:
                part.exit[e, 0] = now
                part.exit[e, 1] = n * width + x
                part.dart[darts] = e
                darts += 1
            elif n * width + x < part.exit[e, 1]:
                part.exit[e, 1] = n * width + x
    outer = 0
    for i in range(darts):
        first = part.dart[i]
        if part.exit[first, 2] == now:
            continue
        total = 0.0
        d = first
        while True:
            part.exit[d, 2] = now
            walked = part.exit[d, 1]
            m = part.way[walked, 0]
            base = part.node[m, 1] * width
            degree = part.node[m, 0]
            x = (part.way[walked, 1] + part.node[m, 2]) % degree
            mate = base + x
            turn = part.angle[walked, 1]
            miss = part.angle[mate, 0] + np.pi - part.angle[d, 0] - turn
            x = (x - 1) % degree
            while part.exit[base + x, 0] != now:
                x = (x - 1) % degree
            corner = (part.angle[mate, 0] - part.angle[base + x, 0]) % (2 * np.pi)
            if corner < 1e-9 or base + x == mate:
                corner = 2 * np.pi
            total += turn + (miss + np.pi) % (2 * np.pi) - corner
            d = base + x
            if d == first:
                break
        turns = int(np.rint(total / (2 * np.pi)))
        if turns == -1:
            outer += 1
        elif turns != 1:
            return False
        if outer > 1:
            return False
    return outer == 1 or darts == 0


@kernel
def outward(part, root):  # type: ignore[no-untyped-def]
    """Put the nodes of the part into `order` by their distance from one of them; return their number."""
    width = part.way.shape[0] // part.node.shape[0]
    part.node[:, 4] = 0
    part.node[root, 4] = 1
    part.order[0] = root
    size = 1
    i = 0
    while i < size:
        n = part.order[i]
        i += 1
        for x in range(part.node[n, 0]):
            m = part.way[n * width + x, 0]
            if m >= 0 and part.node[m, 3] and not part.node[m, 4]:
                part.node[m, 4] = 1
                part.order[size] = m
                size += 1
    return size


@kernel(compile_seconds=2.0)
def smallest(part, root):  # type: ignore[no-untyped-def]
    """Leave a part that is not plane and of which no node can be left out; return its number of nodes, 0 if all is plane.

    It is marked in ``node[:, 3]``. Parts grow from the root, the first that is not plane is found by bisection, then again
    from the node that came last, and so on while that makes it smaller; then leaves are left out.
    """
    width = part.way.shape[0] // part.node.shape[0]
    part.node[:, 3] = 1
    size = outward(part, root)
    if is_plane(part, size):
        return 0
    before = size + 1
    while True:
        low = 0
        high = size
        while high - low > 1:
            middle = (low + high) // 2
            for i in range(size):
                part.node[part.order[i], 3] = 1 if i < middle else 0
            if is_plane(part, middle):
                low = middle
            else:
                high = middle
        for i in range(size):
            part.node[part.order[i], 3] = 1 if i < high else 0
        if high >= before:
            break
        before = high
        size = outward(part, part.order[high - 1])
    left = high
    for i in range(high - 1, -1, -1):
        n = part.order[i]
        beside = 0
        for x in range(part.node[n, 0]):
            m = part.way[n * width + x, 0]
            if m >= 0 and part.node[m, 3]:
                beside += 1
        if beside == 1:
            part.node[n, 3] = 0
            if is_plane(part, high):
                part.node[n, 3] = 1
            else:
                left -= 1
    return left
