"""Whether a part of a map can be drawn in the plane as its headings say, judged on dart arrays.

A part is legal when every one of its components has genus 0 and exactly one face that turns by -2 pi, every other one by
+2 pi. Every part of a legal map is legal: taking an edge from between two faces that turn a and b times leaves one that
turns a + b - 1 times, and the two faces that a bridge leaves turn as those of separate components must. So what makes a part
illegal makes the whole illegal, and dead ends never matter.

Corners of a part are sums of corners of the whole. They must not be worked out anew from the headings that are left: of two
ways that noise turned round, the corner is a little below nought in the whole and would be taken for a full turn.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold._kernels import kernel

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

__all__ = ["Arrangement"]


class Arrangement:
    """Stars and net rotations under trial: one order at every place, to be judged on any part of the edges.

    Parameters
    ----------
    tail
        (2E,) int64, the place each dart starts at.
    n_places
        Number of places.
    turning
        False where net rotations are not known in whole turns: then genus alone is judged.
    """

    __slots__ = ("corner", "judged", "n_places", "next_ccw", "previous", "tail", "turn", "turning")

    def __init__(self, tail: NDArray[np.int64], n_places: int, *, turning: bool = True) -> None:
        self.tail = tail
        self.n_places = n_places
        self.turning = turning
        self.next_ccw = np.arange(tail.size)
        self.previous = np.arange(tail.size)
        self.corner = np.zeros(tail.size)
        self.turn = np.zeros(tail.size // 2)
        self.judged = 0

    def put(self, darts: Sequence[int], corners: Iterable[float]) -> None:
        """Let the darts of a place stand in this order, counter-clockwise, with these corners after them."""
        before = darts[-1]
        for dart in darts:
            self.next_ccw[before] = dart
            self.previous[dart] = before
            before = dart
        for dart, corner in zip(darts, corners, strict=True):
            self.corner[dart] = corner

    def judge(self, keep: NDArray[np.bool_]) -> tuple[int, ...] | None:
        """Return a dart on the outer face of every component of the kept edges, or None if they are not legal. O(E)."""
        self.judged += 1
        form = judged.for_work(6 * self.tail.size)
        legal, outer = form(self.previous, self.corner, self.turn, self.tail, keep, self.n_places, 1 if self.turning else 0)
        return tuple(outer.tolist()) if legal else None


@kernel(compile_seconds=2.0)
def judged(previous, corner, turn, tail, keep, n_places, turning):  # type: ignore[no-untyped-def]
    """Judge the kept edges: (whether they are legal, the lowest dart on the outer face of every component)."""
    n = tail.size
    parent = np.arange(n_places)
    here = np.zeros(n_places, np.bool_)
    for e in range(n // 2):
        if not keep[e]:
            continue
        a = tail[2 * e]
        b = tail[2 * e + 1]
        here[a] = True
        here[b] = True
        while parent[a] != a:
            parent[a] = parent[parent[a]]
            a = parent[a]
        while parent[b] != b:
            parent[b] = parent[parent[b]]
            b = parent[b]
        if a != b:
            parent[a] = b
    euler = np.zeros(n_places, np.int64)
    outside = np.full(n_places, -1, np.int64)
    parts = 0
    for v in range(n_places):
        if here[v]:
            a = v
            while parent[a] != a:
                parent[a] = parent[parent[a]]
                a = parent[a]
            euler[a] += 1
            if a == v:
                parts += 1
    seen = np.zeros(n, np.bool_)
    for d in range(n):
        if not keep[d // 2]:
            continue
        root = tail[d]
        while parent[root] != root:
            root = parent[root]
        if d % 2 == 0:
            euler[root] -= 1
        if seen[d]:
            continue
        x = d
        total = 0.0
        while not seen[x]:
            seen[x] = True
            if x % 2 == 0:
                total += turn[x // 2]
            else:
                total -= turn[x // 2]
            y = previous[x ^ 1]
            total += np.pi - corner[y]
            while not keep[y // 2]:
                y = previous[y]
                total -= corner[y]
            x = y
        euler[root] += 1
        if turning == 1:
            whole = round(total / (2 * np.pi))
            if whole == -1 and outside[root] < 0:
                outside[root] = d
            elif whole != 1:
                return False, np.zeros(0, np.int64)
    outer = np.full(parts, -1, np.int64)
    k = 0
    for v in range(n_places):
        if here[v] and parent[v] == v:
            if euler[v] != 2 or (turning == 1 and outside[v] < 0):
                return False, np.zeros(0, np.int64)
            outer[k] = outside[v]
            k += 1
    return True, outer
