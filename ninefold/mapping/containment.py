"""The containment index: the faces inside any cycle, whatever its area, in time that depends on its length alone.

Take a spanning tree T of the map (tethers, being bridges, are in it). The edges not in T form a spanning tree of the
dual, rooted at the outer face. Number the faces in preorder; then the faces below an edge of the dual tree are an
interval. A face is inside a cycle exactly when its way to the root crosses the cycle an odd number of times, so the inside
is the symmetric difference of the intervals of the cycle's edges not in T: a sorted list of at most 2k ends for a cycle of
k edges, and "is this face in this region" is the parity of one binary search.

References
----------
D. Eppstein, Dynamic generators of topologically embedded graphs, SODA 2003 (tree-cotree decomposition).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ninefold.immutable import Immutable, freeze

from . import _orbits

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["ContainmentIndex", "ends_of_numbers", "numbers_of_ends"]


@dataclass(frozen=True, slots=True, eq=False)
class ContainmentIndex(Immutable):
    """Preorder numbers of the faces and the interval below each cotree edge.

    Attributes
    ----------
    preorder
        (F,) int32, the outer face has 0.
    face_at
        (F,) int32, the inverse of `preorder`.
    low, high
        (E,) int32, the faces below edge e have ``low[e] <= preorder < high[e]``; 0, 0 for edges of the tree.
    """

    preorder: NDArray[np.int32]
    face_at: NDArray[np.int32]
    low: NDArray[np.int32]
    high: NDArray[np.int32]

    @classmethod
    def build(
        cls,
        next_face: NDArray[np.int32],
        face_of: NDArray[np.int32],
        in_tree: NDArray[np.bool_],
        outer: int,
        n_faces: int,
    ) -> ContainmentIndex:
        """Build the index of a connected map. Complexity O(E)."""
        if outer < 0:
            zero, none = np.zeros(1, np.int32), np.zeros(0, np.int32)
            freeze(zero, none)
            return cls(zero, zero, none, none)
        walk = _orbits.contour.for_work(next_face.size)
        preorder, low, high = walk(next_face, face_of, in_tree, outer, n_faces)
        face_at = np.empty(n_faces, np.int32)
        face_at[preorder] = np.arange(n_faces, dtype=np.int32)
        freeze(preorder, face_at, low, high)
        return cls(preorder, face_at, low, high)

    def inside(self, edges: NDArray[np.int64]) -> NDArray[np.int32]:
        """Return the sorted interval ends of the faces inside the cycle with these edges. O(k log k)."""
        ends = np.concatenate([self.low[edges], self.high[edges]])
        return odd_values(ends[ends > 0])


def odd_values(values: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return, sorted, the values that occur an odd number of times."""
    ordered = np.sort(values)
    if ordered.size == 0:
        return ordered
    first = np.flatnonzero(np.concatenate([[True], ordered[1:] != ordered[:-1]]))
    counts = np.diff(np.append(first, ordered.size))
    return np.asarray(ordered[first[counts % 2 == 1]], dtype=values.dtype)


def ends_of_numbers(numbers: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return the interval ends of a set of preorder numbers."""
    return odd_values(np.concatenate([numbers, numbers + 1]).astype(np.int32))


def numbers_of_ends(ends: NDArray[np.int32]) -> NDArray[np.int64]:
    """Return the preorder numbers inside the intervals, ascending. O(area)."""
    low, high = ends[0::2].astype(np.int64), ends[1::2].astype(np.int64)
    size = high - low
    steps = np.arange(int(size.sum())) - np.repeat(np.cumsum(size) - size, size)
    return np.asarray(np.repeat(low, size) + steps, dtype=np.int64)
