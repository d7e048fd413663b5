"""Refutations that can be read: a derivation by closure, or a split into cases each of which is refuted.

This is for the few statements of a conflict, not for deciding: cases are split where that ends soonest, and the search
gives up when the proof would be too long to be of use.

References
----------
J. Renz and B. Nebel, "Efficient methods for qualitative spatial reasoning", JAIR 15, 2001 (splitting into tractable parts).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ninefold.encodings.theory import theory_of

from .derivation import RecordedClosure

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ninefold.encodings.calculus import Calculus
    from ninefold.encodings.encoding import Constraint

    from .derivation import Derivation

__all__ = ["Refutation", "refute"]

_LOOK_AHEAD = 16
"""Entities up to which every pair is tried before one is split."""


@dataclass(frozen=True, slots=True)
class Refutation:
    """Why constraints cannot hold together.

    Attributes
    ----------
    derivation
        Closure's derivation, which ends in an empty relation; None where cases are split.
    pair
        The pair split, or None.
    cases
        For each part of the pair's relation the refutation of the constraints with it. In their derivations the assumption
        is a source of its own, numbered from the number of constraints on, by depth.
    label
        What was left of the pair, the union of the parts, and `ground`, the derivation of it.
    ground
        Derivation that nothing else is possible between the pair; None where there is nothing to derive.
    """

    derivation: Derivation | None = None
    pair: tuple[int, int] | None = None
    cases: tuple[tuple[int, Refutation], ...] = ()
    label: int = 0
    ground: Derivation | None = None

    @property
    def sources(self) -> frozenset[int]:
        """Numbers of the constraints and assumptions used, those of cases among them."""
        used: frozenset[int] = frozenset()
        for derivation in (self.derivation, self.ground):
            used |= derivation.sources if derivation else frozenset()
        return used.union(*(case.sources for _, case in self.cases))

    @property
    def n_leaves(self) -> int:
        """Number of derivations by closure, 1 if no case was split."""
        return 1 if self.derivation else sum(case.n_leaves for _, case in self.cases)

    @property
    def depth(self) -> int:
        """How deep cases are split, 0 if not at all."""
        return 0 if self.derivation else 1 + max(case.depth for _, case in self.cases)


class _TooLong(Exception):
    """The proof has too many cases."""


def refute(calculus: Calculus, n: int, constraints: Sequence[Constraint], *, most: int = 200) -> Refutation | None:
    """Refute constraints by closure, and by cases where that is not enough.

    Parameters
    ----------
    constraints
        Triples (i, j, mask); their positions are the sources of the derivations.
    most
        Derivations to try before giving up.

    Returns
    -------
    A refutation; None if there is none or it would take more than `most` cases. Which of the two is for ``check`` to say.
    """
    closure = RecordedClosure(calculus, n)
    for source, (i, j, mask) in enumerate(constraints):
        if not closure.state(i, j, mask, source):
            return Refutation(derivation=closure.refutation())
    splitter = _Splitter(closure, constraints, most)
    try:
        return splitter.search(0)
    except _TooLong:
        return None


class _Splitter:
    def __init__(self, closure: RecordedClosure, constraints: Sequence[Constraint], most: int) -> None:
        self._closure = closure
        self._theory = theory_of(closure.calculus)
        self._first = len(constraints)
        self._left = most
        self._pairs = list(dict.fromkeys((min(i, j), max(i, j)) for i, j, _ in constraints if i != j))
        self._blamed = dict.fromkeys(self._pairs, 0)

    def search(self, depth: int) -> Refutation | None:
        """Refute what is stated now; None if it has a scenario."""
        closure = self._closure
        if not closure.close():
            self._left -= 1
            if self._left < 0:
                raise _TooLong
            return Refutation(derivation=closure.refutation())
        pair = self._choose(depth)
        if pair is None:
            return None
        mark, label = closure.mark(), closure.relation(*pair)
        cases: list[tuple[int, Refutation]] = []
        for part in self._theory.parts_of(label):
            closure.state(*pair, part, self._first + depth)
            found = self.search(depth + 1)
            closure.undo(mark)
            if found is None:
                return None
            self._blamed[pair] += 1
            if self._first + depth not in found.sources:
                return found  # refuted without this case
            cases.append((part, found))
        return Refutation(pair=pair, cases=tuple(cases), label=label, ground=closure.derivation(*pair, label))

    def _choose(self, depth: int) -> tuple[int, int] | None:
        """Return the stated pair to split, or None if closure has decided."""
        closure = self._closure
        open_pairs = [pair for pair in self._pairs if not self._theory.decides(closure.relation(*pair))]
        if not open_pairs:
            return None
        if closure.n > _LOOK_AHEAD:
            return max(open_pairs, key=lambda pair: self._blamed[pair] / len(self._theory.parts_of(closure.relation(*pair))))
        return min(open_pairs, key=lambda pair: self._after_split(pair, depth))

    def _after_split(self, pair: tuple[int, int], depth: int) -> tuple[int, int]:
        """Return how many parts of a pair survive closure, and how many there are: few are best."""
        closure = self._closure
        parts, mark, alive = self._theory.parts_of(closure.relation(*pair)), closure.mark(), 0
        for part in parts:
            closure.state(*pair, part, self._first + depth)
            alive += closure.close()
            closure.undo(mark)
        return alive, len(parts)
