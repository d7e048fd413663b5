"""Some statements of a network, laid out so that parts of them can be refuted one after the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..engine.graph import dense_frame, triangulated_frame
from ..engine.tables import Tables
from ._cores import CoreSearch

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from ninefold.encodings.calculus import Calculus

    from ..engine.graph import Frame
    from .statement import Statement

__all__ = ["Part"]

_NARROW, _NARROW_SEARCHED = 0.75, 0.5
"""Share of the entities below which a new frame pays: clauses learned over the old one are lost with it."""


class Part:
    """Statements of one network.

    Parameters
    ----------
    statements
        Not about one entity alone.
    decides
        Whether closure decides it, on chordal completions too. Then pairs are kept sparingly, and statements whose graph
        has no cycle need no search: from one entity to the next each of them can be satisfied.
    seed
        Breaks ties of the search.
    """

    def __init__(self, statements: Sequence[Statement], calculus: Calculus, *, decides: bool, seed: int) -> None:
        index: dict[str, int] = {}
        for s in statements:
            index.setdefault(s.a, len(index))
            index.setdefault(s.b, len(index))
        self._ends = {s.index: (index[s.a], index[s.b]) for s in statements}
        self._place = {s.index: at for at, s in enumerate(statements)}
        self._indices = [s.index for s in statements]
        self._decides = decides
        self._n = len(index)
        self._masks = {}
        for s in statements:
            i, j = self._ends[s.index]
            self._masks[s.index] = s.mask if i < j else calculus.converse_of(s.mask)
        ends = np.array(list(self._ends.values()), dtype=np.int64).reshape(-1, 2)
        pairs = np.unique(np.sort(ends, axis=1), axis=0)
        frame = _frame(self._n, pairs[:, 0], pairs[:, 1], sparse=decides)
        masks = np.array([s.mask for s in statements], dtype=np.int16)
        hard = np.array([s.hard for s in statements], dtype=bool)
        arcs = frame.arcs(ends[:, 0], ends[:, 1])
        self._search = CoreSearch(Tables.of(calculus), frame, arcs, masks, hard, seed=seed)

    @property
    def searched(self) -> bool:
        """Whether closure was not enough so far."""
        return self._search.conflicts > 0

    def refute(self, rest: Sequence[int], deadline: float | None) -> list[int] | None:
        """Return which of some statements, by their indices, a refutation of these rests on; None if there is none.

        Raises
        ------
        OutOfTime
            The deadline passed first.
        """
        if self._decides and self._is_forest(rest):
            return None
        found = self._search.refute([self._place[k] for k in rest], deadline)
        return None if found is None else [self._indices[at] for at in found]

    def too_wide_for(self, rest: Iterable[int]) -> bool:
        """Tell whether these statements speak of so few of the entities that they should get a part of their own."""
        spoken_of = {end for k in rest for end in self._ends[k]}
        return len(spoken_of) < (_NARROW_SEARCHED if self.searched else _NARROW) * self._n

    def _is_forest(self, rest: Iterable[int]) -> bool:
        """Tell whether the statements leave each of their pairs something, and their pairs form no cycle."""
        masks: dict[tuple[int, int], int] = {}
        root = list(range(self._n))
        for k in rest:
            i, j = self._ends[k]
            pair = (i, j) if i < j else (j, i)
            if pair in masks:
                masks[pair] &= self._masks[k]
                if not masks[pair]:
                    return False
                continue
            masks[pair] = self._masks[k]
            while root[i] != i:
                root[i] = i = root[root[i]]
            while root[j] != j:
                root[j] = j = root[root[j]]
            if i == j:
                return False
            root[i] = j
        return True


def _frame(n: int, i: NDArray[np.int64], j: NDArray[np.int64], *, sparse: bool) -> Frame:
    """Keep a chordal completion where it has less than half of all pairs, else all."""
    frame = triangulated_frame(n, i, j, most=n * (n - 1) // 4) if sparse else None
    return frame if frame is not None else dense_frame(n)
