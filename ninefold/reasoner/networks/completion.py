"""From closed labels to one base relation a pair, without search: on the pairs that were kept at once, on others on demand.

A decision leaves labels over a class in which closure decides, on a frame: all pairs, or those of a chordal completion.
`refined` closes them once more and picks a base relation for each kept pair:

- all at once, where the calculus is known to allow it (`ninefold.encodings.theory.Theory.at_once`: RCC-8, RCC-5);
- else node by node, from the last of the elimination to the first: the labels to later neighbours are closed against the
  relations picked among those, and each takes the first base relation it has left.

The pairs that were not kept follow from the kept ones. Going down the elimination again, a node v has relations to its later
neighbours s, and to any other later node w those that all of ``R(v, s) ; R(s, w)`` allow; among these it takes the first in
the order of `Theory.preference`. Base relations generate a *distributive* algebra in every calculus with a preference, so
these labels are closed and the picks fit together. R(v, w) depends on the frame and the kept pairs alone, never on what was
asked before.

References
----------
Z. Long and S. Li, "On distributive subalgebras of qualitative spatial and temporal calculi", COSIT 2015.
J. Renz, "Maximal tractable fragments of the region connection calculus: a complete analysis", IJCAI 1999 (refinement).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from heapq import heappop, heappush
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold.encodings.theory import theory_of
from ninefold.errors import NinefoldError

from ..engine.engine import Engine
from ..engine.tables import Tables

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.encodings.calculus import Calculus

    from ..engine.graph import Frame

__all__ = ["Completion", "refined"]

_NONE = np.uint8(255)


@dataclass(frozen=True, eq=False)
class Completion:
    """One base relation for each kept pair of a frame, which fixes those of all other pairs.

    Attributes
    ----------
    calculus
        One with a preference among its base relations.
    frame
        The pairs kept, a chordal graph.
    bases
        (E,) uint8, read-only: index of the base relation of every edge, from TAIL to HEAD.
    """

    calculus: Calculus
    frame: Frame
    bases: NDArray[np.uint8]

    def base(self, i: int, j: int) -> int:
        """Return the index of the base relation of entity i to entity j.

        Complexity
        ----------
        O(log E) for a kept pair. Otherwise a few array operations for every node met on the way up the elimination, where
        the earlier node of a pair that is not kept is replaced by each of its later neighbours.
        """
        p, q = int(self.frame.place[i]), int(self.frame.place[j])
        if p == q:
            return _identity(self.calculus)
        base = self._between(min(p, q), max(p, q))
        return base if p < q else int(self.calculus.base_converse[base])

    def _between(self, p: int, q: int) -> int:
        """Return the base relation of node p to a later node q."""
        edge = int(self._edges(np.array([p]), np.array([q]))[0])
        if edge >= 0:
            return int(self.bases[edge])
        frame = self.frame
        # upwards: which pairs are needed, by their earlier node; those that a pair rests on have a later one
        needed: dict[int, set[int]] = {p: {q}}
        waiting, plan = [p], []
        while waiting:
            first = heappop(waiting)
            near, others = frame.upper[frame.first[first] : frame.first[first + 1]], np.array(sorted(needed[first]))
            edges = self._edges(near[:, np.newaxis], others)
            rows, columns = np.nonzero(edges < 0)
            for s, other in zip(near[rows].tolist(), others[columns].tolist(), strict=True):
                low, high = min(s, other), max(s, other)
                if low not in needed:
                    needed[low] = set()
                    heappush(waiting, low)
                needed[low].add(high)
            plan.append((first, near, others, edges))
        # and down again
        converse, compose = self.calculus.base_converse, self.calculus.base_composition
        known: dict[tuple[int, int], int] = {}
        for first, near, others, edges in reversed(plan):
            labels = np.full(others.size, self.calculus.universal, dtype=compose.dtype)
            if near.size:
                onward = self.bases[np.maximum(edges, 0)]
                onward = np.where(near[:, np.newaxis] < others, onward, converse[onward])
                rows, columns = np.nonzero(edges < 0)
                for row, column in zip(rows.tolist(), columns.tolist(), strict=True):
                    s, other = int(near[row]), int(others[column])
                    onward[row, column] = known[s, other] if s < other else converse[known[other, s]]
                through = self.bases[frame.first[first] : frame.first[first + 1], np.newaxis]
                labels = np.bitwise_and.reduce(compose[through, onward], axis=0)
            known.update(zip([(first, x) for x in others.tolist()], _picked(self._first_of, labels).tolist(), strict=True))
        return known[p, q]

    @cached_property
    def _first_of(self) -> NDArray[np.uint8]:
        return _first_of(self.calculus)

    def table(self) -> NDArray[np.uint8]:
        """Return the base relations of all pairs, as an (n, n) array in the order of the entities.

        Complexity
        ----------
        O(E n) for E pairs kept.
        """
        calculus, frame, n = self.calculus, self.frame, self.frame.n
        converse, compose = calculus.base_converse.astype(np.uint8), calculus.base_composition
        table = np.full((n, n), _identity(calculus), dtype=np.uint8)
        for p in range(n - 2, -1, -1):
            through = self.bases[frame.first[p] : frame.first[p + 1]]
            if p >= frame.core:
                table[p, p + 1 :] = through
            elif through.size:
                near = frame.upper[frame.first[p] : frame.first[p + 1]]
                # at w = s composition with equality gives R(p, s) itself, so kept pairs come out as they are
                labels = np.bitwise_and.reduce(compose[through[:, np.newaxis], table[near, p + 1 :]], axis=0)
                table[p, p + 1 :] = _picked(self._first_of, labels)
            else:
                table[p, p + 1 :] = self._first_of[calculus.universal]
            table[p + 1 :, p] = converse[table[p, p + 1 :]]
        whole: NDArray[np.uint8] = table[np.ix_(frame.place, frame.place)]
        return whole

    def _edges(self, p: NDArray[Any], q: NDArray[Any]) -> NDArray[np.int64]:
        """Return the edges between nodes p and q, two arrays that fit together; -1 where a pair is not kept."""
        frame = self.frame
        low, high = np.minimum(p, q).astype(np.int64), np.maximum(p, q).astype(np.int64)
        edges: NDArray[np.int64] = frame.first[low] + high - low - 1
        before = low < frame.core
        if before.any():
            wanted = low[before] * frame.n + high[before]
            at = np.searchsorted(self._keys, wanted)
            edges[before] = np.where(self._keys[at] == wanted, at, -1)
        return edges

    @cached_property
    def _keys(self) -> NDArray[np.int64]:
        """TAIL * n + HEAD of the edges before the core, ascending, and one more that is larger than any."""
        frame = self.frame
        tails = np.repeat(np.arange(frame.core, dtype=np.int64), np.diff(frame.first[: frame.core + 1]))
        return np.append(tails * frame.n + frame.upper, np.int64(frame.n) ** 2)


def refined(calculus: Calculus, frame: Frame, arcs: NDArray[np.int64], masks: NDArray[Any]) -> Completion:
    """Pick base relations on a frame for labels of a class in which closure decides.

    Parameters
    ----------
    arcs, masks
        (P,) arcs of the frame, no pair twice, and their labels, none of them empty; in the first tractable subclass of the
        calculus, or base relations and the universal one. The network they make is known to be consistent.

    Complexity
    ----------
    One closure; node by node also O(d^2) for every node with d later neighbours.
    """
    theory = theory_of(calculus)
    engine = Engine(Tables.of(calculus), frame, arcs, masks)
    if not engine.close():
        raise NinefoldError(f"a consistent network of {calculus.name} has no closure; please report this")
    labels = engine.relations()[::2]
    first_of = _first_of(calculus)
    bases = _picked(first_of, labels) if theory.at_once else _node_by_node(calculus, frame, labels, first_of)
    bases.flags.writeable = False
    return Completion(calculus, frame, bases)


def _node_by_node(
    calculus: Calculus, frame: Frame, labels: NDArray[np.int16], first_of: NDArray[np.uint8]
) -> NDArray[np.uint8]:  # fmt: skip
    """Return the base relations (E,) that closed labels (E,) of the kept pairs take, from the last node to the first."""
    b, converse = calculus.n_bases, calculus.base_converse.astype(np.uint8)
    compose = np.zeros((1 << b, b), dtype=np.int32)  # a label with a base relation
    for k in range(b):
        compose[1 << k : 2 << k] = compose[: 1 << k] | calculus.base_composition[k].astype(np.int32)
    core, identity = frame.core, _identity(calculus)
    bases = np.full(frame.n_edges, _NONE)
    inner = np.full((frame.n - core, frame.n - core), identity, dtype=np.uint8)
    for p in range(frame.n - 2, -1, -1):
        edges = slice(int(frame.first[p]), int(frame.first[p + 1]))
        if p >= core:
            among = inner[p - core + 1 :, p - core + 1 :]
        else:
            near = frame.upper[edges]
            among = np.full((near.size, near.size), identity, dtype=np.uint8)
            for a, s in enumerate(near.tolist()):
                if s >= core:
                    among[a, a:] = inner[s - core, near[a:] - core]
                else:
                    later = slice(int(frame.first[s]), int(frame.first[s + 1]))
                    among[a, a + 1 :] = bases[later][np.searchsorted(frame.upper[later], near[a + 1 :])]
                among[a:, a] = converse[among[a, a:]]
        # what s' leaves to s: L(p, s') ; R(s', s)
        left = np.bitwise_and.reduce(compose[labels[edges][:, np.newaxis], among], axis=0)
        bases[edges] = _picked(first_of, left & labels[edges])
        if p >= core:
            inner[p - core, p - core + 1 :] = bases[edges]
            inner[p - core + 1 :, p - core] = converse[bases[edges]]
    return bases


def _first_of(calculus: Calculus) -> NDArray[np.uint8]:
    """Return for every relation the index of the base relation of it that comes first in the calculus' preference."""
    preference = theory_of(calculus).preference
    if preference is None:
        raise NinefoldError(f"no way to scenarios of {calculus.name!r} is known without search; please report this")
    first = np.full(1 << calculus.n_bases, _NONE)
    masks = np.arange(1 << calculus.n_bases)
    for base in reversed(preference.value):
        first[masks >> base & 1 == 1] = base
    return first


def _picked(first_of: NDArray[np.uint8], labels: NDArray[Any]) -> NDArray[np.uint8]:
    picked: NDArray[np.uint8] = first_of[labels]
    if (picked == _NONE).any():
        raise NinefoldError("closed labels did not fit together, against the theory of the calculus; please report this")
    return picked


def _identity(calculus: Calculus) -> int:
    """Return the index of equality, which is one base relation in every calculus with a preference."""
    return calculus.identity.bit_length() - 1
