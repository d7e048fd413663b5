"""Parts that hang at cut vertices: they turn and shrink about the vertex they hang by, and nothing else changes.

A dead end, a bridge with what is behind it, a lobe: each block of the map but the root hangs by one vertex. Scaling it about
that vertex leaves every direction as it is, so parts that are in the way can be made small without any heading being missed;
turning it brings it back to its place in the rotation.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold._kernels import kernel
from ninefold.mapping.heading import TAU

from .blocks import block_tree
from .mesh import doubled_areas
from .pieces import wrapped

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .pieces import Pieces

__all__ = ["HungBlocks"]

_GAP = np.radians(3)
_SETTLE_SWEEPS, _SETTLE_STEP, _ENOUGH = 100, 0.6, 1e-4
_SMALL = 0.5
"""Scale of a block from which, at first, the block that it hangs from is shrunk instead."""

_AT_ONCE = 1000
_SHRINK_ROUNDS, _SHRINK, _GENTLE, _LEAST = 200, 0.6, 66, 0.01


class HungBlocks:
    """A picture with one scale and one turn a block.

    Parameters
    ----------
    pieces, points
        The pieces, and the (n, 2) picture to start from.

    Attributes
    ----------
    scale, turn
        (B,) factor and radians of each block about its head, on top of those of the blocks it hangs from.
    """

    def __init__(self, pieces: Pieces, points: NDArray[np.float64]) -> None:
        self._pieces = pieces
        self._points = points
        simple = pieces.simple
        self.tree = block_tree(
            simple.tail.astype(np.int64), simple.next_ccw.astype(np.int64), pieces.n_vertices, int(simple.outer)
        )
        n_blocks = self.tree.head.size
        self.scale = np.ones(n_blocks)
        self.turn = np.zeros(n_blocks)
        below = self.tree.of_vertex
        self._offset = points - points[self.tree.head[np.maximum(below, 0)]]
        # vertices of a block come after its head
        self._order = np.argsort(np.where(below >= 0, self.tree.level[np.maximum(below, 0)], -1), kind="stable")
        self._weight = np.bincount(self.tree.block, minlength=n_blocks)
        for b in range(n_blocks):
            if self.tree.parent[b] >= 0:
                self._weight[self.tree.parent[b]] += self._weight[b]

    def picture(self) -> NDArray[np.float64]:
        """Return the points with every block scaled and turned."""
        scale, turn = self.scale.copy(), self.turn.copy()
        for b in range(scale.size - 1, -1, -1):  # parents have higher numbers
            if self.tree.parent[b] >= 0:
                scale[b] *= scale[self.tree.parent[b]]
                turn[b] += turn[self.tree.parent[b]]
        points = self._points.copy()
        place = place_blocks.for_work(10 * len(points))
        cos, sin = scale * np.cos(turn), scale * np.sin(turn)
        place(points, self._offset, self.tree.of_vertex, self.tree.head, cos, sin, self._order)
        return points

    def settle(self) -> None:
        """Turn hung blocks as little as needed for the rotation at their heads to hold in the picture."""
        tail, after = self._pieces.simple.tail, self._pieces.simple.next_ccw
        dart = np.arange(tail.size)
        piece = dart >> 1
        step = self._points[tail[dart ^ 1]] - self._points[tail]
        block = self.tree.block[piece]
        moves = (self.tree.head[block] == tail) & (block != self.tree.root)
        measured = self._pieces.measured
        looked_at = measured[piece] & measured[piece[after]] & (block != block[after]) & (moves | moves[after])
        chord = self._pieces.chord[piece] + np.pi * (dart & 1)
        drawn = np.arctan2(step[:, 1], step[:, 0])
        away = wrapped(chord - self._pieces.leaving) + wrapped(drawn - chord)  # of the picture from the heading
        gap = (self._pieces.leaving[after] - self._pieces.leaving) % TAU
        need = np.minimum(_GAP, np.pi / np.bincount(tail)[tail])
        share = np.where(moves & moves[after], 0.5, 1.0)
        size = self.scale.size
        for _ in range(_SETTLE_SWEEPS):
            turned = np.where(moves, self.turn[block], 0.0)
            lack = np.where(looked_at, np.maximum(need - (gap + away[after] + turned[after] - away - turned), 0.0), 0.0)
            if lack.max(initial=0.0) < _ENOUGH:
                break
            forth = np.bincount(block[after], np.where(moves[after], lack * share, 0.0), size)
            back = np.bincount(block, np.where(moves, lack * share, 0.0), size)
            self.turn += _SETTLE_STEP * (forth - back)

    def shrink(self) -> NDArray[np.float64]:
        """Shrink hung blocks whose pieces cross pieces of other blocks, the smaller of two; return the picture.

        Crossings inside a block stay, and so do those of blocks that are as small as they may get.
        """
        crossings = _Crossings(self._pieces)
        for k in range(_SHRINK_ROUNDS):
            points = self.picture()
            a, b = crossings.update(points)
            hit = {
                block
                for x, y in set(zip(self.tree.block[a].tolist(), self.tree.block[b].tolist(), strict=True))
                if x != y and (block := self._in_the_way(x, y, gentle=k < _GENTLE)) >= 0
            }
            if not hit:
                break
            self.scale[sorted(hit)] *= _SHRINK
        return points

    def shrink_at(self, vertices: NDArray[np.int64]) -> None:
        """Shrink, once and strongly, the blocks that some vertices belong to or hold: what is there did not come right."""
        of = np.unique(self.tree.of_vertex[vertices])
        held = np.flatnonzero(np.isin(self.tree.head, vertices))
        hit = np.unique(np.concatenate([of[of >= 0], held]))
        hit = hit[hit != self.tree.root]
        self.scale[hit] = np.maximum(self.scale[hit] * 0.3, np.minimum(self.scale[hit], 1e-3))

    def _in_the_way(self, x: int, y: int, *, gentle: bool) -> int:
        """Return the block to shrink for a crossing of blocks x and y: of the two ends, or of the two branches; or -1."""
        level, parent = self.tree.level, self.tree.parent
        ways: tuple[list[int], list[int]] = ([x], [y])
        while x != y:  # up to the block, or the head, that both hang from
            if level[x] >= level[y]:
                x = int(parent[x])
                if x < 0:
                    break
                ways[0].append(x)
            else:
                y = int(parent[y])
                ways[1].append(y)
        branches = [way[:-1] for way in ways] if x == y else list(ways)
        branches = [way for way in branches if way]
        # from the end upwards: a room at the end of a long corridor gets half as large, then the corridor gets shorter
        ends = [next((b for b in way if self.scale[b] > _SMALL), way[0]) for way in branches]
        tops = [way[-1] for way in branches]
        choice = [b for b in (ends if gentle else tops) if self.scale[b] > _LEAST]
        choice = choice or [b for b in tops if self.scale[b] > _LEAST]
        choice = [b for b in choice if b != self.tree.root]
        return min(choice, key=lambda b: (self._weight[b], b)) if choice else -1


class _Crossings:
    """Pairs of pieces that cross, kept up to date: only pieces that moved are asked again."""

    def __init__(self, pieces: Pieces) -> None:
        self._pieces = pieces
        self._old: NDArray[np.float64] | None = None
        self._pairs = np.zeros(0, np.int64)

    def update(self, points: NDArray[np.float64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the crossing pairs, (k,) and (k,), the lower piece first."""
        import shapely

        tail, head = self._pieces.tail, self._pieces.head
        m = tail.size
        moved = np.ones(m, np.bool_)
        if self._old is not None:
            moved = (points[tail] != self._old[tail]).any(axis=1) | (points[head] != self._old[head]).any(axis=1)
        self._old = points
        segments = shapely.linestrings(np.stack([points[tail], points[head]], axis=1))
        tree = shapely.STRtree(segments)
        rows = np.flatnonzero(moved)
        found = [np.zeros((2, 0), np.int64)]
        for part in np.array_split(rows, rows.size // _AT_ONCE + 1):
            i, j = tree.query(segments[part])
            found.append(self._crossing(points, part[i], j))
        i, j = np.concatenate(found, axis=1)
        still = ~(moved[self._pairs // m] | moved[self._pairs % m])
        self._pairs = np.unique(np.concatenate([np.minimum(i, j) * m + np.maximum(i, j), self._pairs[still]]))
        return self._pairs // m, self._pairs % m

    def _crossing(self, points: NDArray[np.float64], i: NDArray[np.int64], j: NDArray[np.int64]) -> NDArray[np.int64]:
        """Return those of the pairs of pieces that cross inside both, (2, k)."""
        tail, head = self._pieces.tail, self._pieces.head
        a, b, c, d = tail[i], head[i], tail[j], head[j]
        apart = (a != c) & (a != d) & (b != c) & (b != d)
        i, j = i[apart], j[apart]
        a, b, c, d = tail[i], head[i], tail[j], head[j]
        sides = [
            doubled_areas(points, np.stack(corners, axis=1)) for corners in ((a, b, c), (a, b, d), (c, d, a), (c, d, b))
        ]
        across = (np.sign(sides[0]) * np.sign(sides[1]) < 0) & (np.sign(sides[2]) * np.sign(sides[3]) < 0)
        return np.stack([i[across], j[across]])


@kernel
def place_blocks(points, offset, of_vertex, head, cos, sin, order):  # type: ignore[no-untyped-def]
    """Set every point from the point that its block hangs by, in place."""
    for v in order:
        b = of_vertex[v]
        if b >= 0:
            x, y = offset[v, 0], offset[v, 1]
            points[v, 0] = points[head[b], 0] + cos[b] * x - sin[b] * y
            points[v, 1] = points[head[b], 1] + sin[b] * x + cos[b] * y
