"""Which statements the engine's closure used to refute a large network.

On thousands of entities closure over all pairs is out of reach; the engine keeps only the pairs of a chordal completion.
Its trail, followed back from the empty relation, names the stated pairs behind it. What is left is then small enough for
`ninefold.reasoner.networks.derivation`.
"""

from __future__ import annotations

from bisect import bisect_left
from typing import TYPE_CHECKING

import numpy as np

from ..engine import columns as c
from ..engine.engine import Engine
from ..engine.graph import dense_frame, triangulated_frame
from ..engine.tables import Tables

if TYPE_CHECKING:
    from ninefold.encodings.calculus import Calculus

    from .network import Constraints

__all__ = ["pairs_behind_refutation"]

_MOST_PAIRS = 30_000_000


def pairs_behind_refutation(calculus: Calculus, constraints: Constraints) -> list[int] | None:
    """Return the numbers of stated pairs from which closure derives a contradiction, or None if it finds none.

    Complexity
    ----------
    A sparse closure, and the length of its trail.
    """
    empty = np.flatnonzero(constraints.mask == 0)
    if empty.size:
        return [int(empty[0])]
    n = constraints.n
    frame = triangulated_frame(n, constraints.i, constraints.j, most=min(n * (n - 1) // 2, _MOST_PAIRS))
    frame = frame or dense_frame(n)
    arcs = frame.arcs(constraints.i, constraints.j)
    engine = Engine(Tables.of(calculus), frame, arcs, constraints.mask)
    engine.state.reg[c.KEEP] = 1  # from here on closure writes its reasons to the trail
    if engine.close():
        return None
    pair_of_edge = {arc >> 1: pair for pair, arc in enumerate(arcs.tolist())}
    # an arc runs from i to j, and its edge perhaps the other way
    said = {
        arc >> 1: calculus.converse_of(mask) if arc & 1 else mask
        for arc, mask in zip(arcs.tolist(), constraints.mask.tolist(), strict=True)
    }
    return sorted(pair_of_edge[edge] for edge in _Walk(engine, calculus, said).stated_edges())


class _Walk:
    """From the empty relation back along the trail."""

    def __init__(self, engine: Engine, calculus: Calculus, said: dict[int, int]) -> None:
        state = engine.state
        self._calculus = calculus
        self._reg = state.reg
        self._trail = state.trail[: int(state.reg[c.TOP])].tolist()
        self._said = said
        self._rows: dict[int, list[int]] = {}
        for t, row in enumerate(self._trail):
            self._rows.setdefault(row[c.EDGE], []).append(t)

    def stated_edges(self) -> set[int]:
        """Return the edges whose labels were used."""
        top = len(self._trail)
        stack = [(int(self._reg[at]) >> 1, top) for at in (c.TROUBLE_A, c.TROUBLE_F, c.TROUBLE_G)]
        seen: set[tuple[int, int]] = set()
        stated: set[int] = set()
        while stack:
            edge, before = stack.pop()
            rows = self._rows.get(edge, [])
            at = bisect_left(rows, before)
            t = rows[at - 1] if at else -1
            if (edge, t) in seen:
                continue
            seen.add((edge, t))
            if t < 0:
                if edge in self._said:
                    stated.add(edge)
                continue
            row = self._trail[t]
            first, second = row[c.WHY], row[c.OTHER]
            stack += [(first >> 1, t), (second >> 1, t)]
            derived = self._calculus.compose(self._relation(first, t), self._relation(second, t))
            if derived != row[c.NEW]:  # what was known before took part
                stack.append((edge, t))
        return stated

    def _relation(self, arc: int, before: int) -> int:
        """Return the relation of an arc just before a trail entry."""
        rows = self._rows.get(arc >> 1, [])
        at = bisect_left(rows, before)
        mask = self._trail[rows[at - 1]][c.NEW] if at else self._said.get(arc >> 1, self._calculus.universal)
        return self._calculus.converse_of(mask) if arc & 1 else mask
