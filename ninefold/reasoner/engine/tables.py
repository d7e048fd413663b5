"""A calculus as the arrays that the kernels read.

Composition is tabulated for all pairs of relations up to eight base relations. Beyond that a relation is cut in two
halves, and four smaller tables are joined: ``(a | b);(c | d)`` is the union of the four compositions.

The *hull* of a relation is the least relation of the tractable subclass that holds it. A subclass closed under
intersection has one, and then a pair of relation D with stated label L is *settled* exactly when ``hull(D)`` lies in L.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from ninefold._kernels import kernel
from ninefold.encodings.theory import theory_of
from ninefold.errors import TooLarge

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.encodings import Calculus

__all__ = ["MOST_BASES", "Tables", "atomic_subclass", "compose_masks"]

MOST_BASES = 14
"""Most base relations the engine takes: its tables have a row for every relation."""

_BLOCK = 7  # bits of a half above eight base relations


@dataclass(frozen=True, slots=True)
class Tables:
    """Look-up tables of a calculus with b base relations, m = 2^b relations.

    Attributes
    ----------
    n_bases, identity
        b, and the mask of equality.
    converse, size
        (m,) int16: converse and number of base relations of a relation.
    compose
        (1, m, m) int16, or (4, 128, 128) for relations cut in halves; read through `compose_masks`.
    hull
        (m,) int16: least tractable relation that holds a relation.
    split
        (m,) int16: a largest tractable relation inside a relation.
    gates
        (m, w, w) uint64 with w the next multiple of 8 above b: all ones at ``[R, b, c]`` where c is in ``R;b``. What a
        sweep over bit-planes reads.
    """

    n_bases: int
    identity: int
    converse: NDArray[np.int16]
    size: NDArray[np.int16]
    compose: NDArray[np.int16]
    hull: NDArray[np.int16]
    split: NDArray[np.int16]
    gates: NDArray[np.uint64]

    @property
    def full(self) -> int:
        """Mask of the universal relation."""
        return len(self.converse) - 1

    def compose_bases(self) -> NDArray[np.int16]:
        """Return the (b, b) composition of base relations."""
        one = 1 << np.arange(self.n_bases)
        if len(self.compose) == 1:
            return np.ascontiguousarray(self.compose[0][np.ix_(one, one)])
        r, s = one[:, np.newaxis], one
        half = (1 << _BLOCK) - 1
        low_r, high_r, low_s, high_s = r & half, r >> _BLOCK, s & half, s >> _BLOCK
        parts = self.compose
        low, high = parts[0, low_r, low_s] | parts[1, low_r, high_s], parts[2, high_r, low_s] | parts[3, high_r, high_s]
        whole: NDArray[np.int16] = low | high
        return whole

    @classmethod
    def of(cls, calculus: Calculus, tractable: NDArray[np.bool_] | None = None) -> Tables:
        """Tabulate a calculus.

        Parameters
        ----------
        tractable
            (2^b,) bool, the subclass for which closure decides, closed under intersection and with every base relation.
            By default what is known of the calculus (`ninefold.encodings.theory`): the subclass that searches split into,
            or else the base relations and the universal one. These tables are made once and kept for the calculi used last.

        Raises
        ------
        TooLarge
            More than `MOST_BASES` base relations.
        """
        b = calculus.n_bases
        if b > MOST_BASES:
            raise TooLarge(
                f"calculus {calculus.name!r} has {b} base relations; the engine's tables hold at most {MOST_BASES}"
            )
        if tractable is None:
            return _known(calculus)
        converse = np.zeros(1 << b, dtype=np.int16)
        for k, c in enumerate(calculus.base_converse.tolist()):
            converse[1 << k : 2 << k] = converse[: 1 << k] | np.int16(1 << c)
        return cls.from_arrays(converse, calculus.base_composition.astype(np.int16), calculus.identity, tractable)

    @classmethod
    def from_arrays(
        cls,
        converse: NDArray[np.int16],
        base_composition: NDArray[np.int16],
        identity: int,
        tractable: NDArray[np.bool_],
    ) -> Tables:
        """Tabulate from the (2^b,) converses and the (b, b) composition of base relations; see `of`."""
        b = len(base_composition)
        size = np.array([mask.bit_count() for mask in range(1 << b)], dtype=np.int16)
        right = _unions(base_composition)  # right[k, S] = base k ; S
        hull, split = _hulls(tractable, b), _splits(tractable, size, b)
        arrays = (converse, size, _blocks(right), hull, split, _gates(_unions(base_composition.T)))
        for array in arrays:
            array.flags.writeable = False
        return cls(b, identity, *arrays)


@lru_cache(maxsize=4)
def _known(calculus: Calculus) -> Tables:
    """Return the tables of what is known of a calculus; at most 17 MB each, for Allen's relations."""
    split_class = theory_of(calculus).split_class
    return Tables.of(calculus, atomic_subclass(calculus.n_bases) if split_class is None else split_class.member)


@kernel(_nrt=False, forceinline=True)
def compose_masks(compose, r, s):  # type: ignore[no-untyped-def]
    """Return the weak composition of two relations."""
    if compose.shape[0] == 1:
        return compose[0, r, s]
    r0, r1, s0, s1 = r & 127, r >> 7, s & 127, s >> 7
    return compose[0, r0, s0] | compose[1, r0, s1] | compose[2, r1, s0] | compose[3, r1, s1]


def atomic_subclass(n_bases: int) -> NDArray[np.bool_]:
    """Return the (2^b,) subclass of the base relations, the empty and the universal one.

    Examples
    --------
    >>> atomic_subclass(2).tolist()
    [True, True, True, True]
    """
    members = np.zeros(1 << n_bases, dtype=bool)
    members[[1 << k for k in range(n_bases)]] = True
    members[[0, -1]] = True
    return members


def _unions(base: NDArray[np.int16]) -> NDArray[np.int16]:
    """Extend ``base[k, l]`` in its second index from base relations to sets of them."""
    b = len(base)
    table = np.zeros((b, 1 << b), dtype=np.int16)
    for k in range(b):
        table[:, 1 << k : 2 << k] = table[:, : 1 << k] | base[:, k : k + 1]
    return table


def _blocks(right: NDArray[np.int16]) -> NDArray[np.int16]:
    """Return the composition of sets as one table, or as four over halves."""
    b = len(right)
    if b <= 8:
        whole = np.zeros((1, 1 << b, 1 << b), dtype=np.int16)
        for k in range(b):
            whole[0, 1 << k : 2 << k] = whole[0, : 1 << k] | right[k]
        return whole
    half = 1 << _BLOCK
    blocks = np.zeros((4, half, half), dtype=np.int16)
    for block in range(4):
        high_r, high_s = block >> 1, block & 1
        for k in range(_BLOCK):
            bit = k + _BLOCK * high_r
            if bit < b:
                # sets of the second relation's half, as columns of `right`
                masks = np.arange(half) << (_BLOCK * high_s)
                row = right[bit, masks & ((1 << b) - 1)]
                blocks[block, 1 << k : 2 << k] = blocks[block, : 1 << k] | row
    return blocks


def _hulls(tractable: NDArray[np.bool_], b: int) -> NDArray[np.int16]:
    """Intersect, for every relation, the tractable relations that hold it."""
    hull = np.full(1 << b, (1 << b) - 1, dtype=np.int16)
    hull[tractable] = np.flatnonzero(tractable)
    for k in range(b):  # from supersets to sets, one bit at a time
        cube = hull.reshape(-1, 2, 1 << k)
        cube[:, 0] &= cube[:, 1]
    return hull


def _splits(tractable: NDArray[np.bool_], size: NDArray[np.int16], b: int) -> NDArray[np.int16]:
    """Return for every relation a largest tractable relation inside it, the one of least number among equals."""
    best = np.where(tractable, np.arange(1 << b), 0).astype(np.int16)
    for k in range(b):  # from sets to supersets
        cube = best.reshape(-1, 2, 1 << k)
        low, high = cube[:, 0], cube[:, 1]
        better = size[low] > size[high]
        equal = (size[low] == size[high]) & (low < high)
        cube[:, 1] = np.where(better | equal, low, high)
    return best


def _gates(left: NDArray[np.int16]) -> NDArray[np.uint64]:
    """Spread composition into words of ones and zeros; ``left[b, R]`` is ``R ; b``."""
    b = len(left)
    width = (b + 7) // 8 * 8
    gates = np.zeros((1 << b, width, width), dtype=np.uint64)
    for c in range(b):
        gates[:, :b, c] = (-(left.T >> c & 1).astype(np.int64)).view(np.uint64)
    return gates
