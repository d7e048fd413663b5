"""Sparse systems over points in the plane: scatter, assemble, solve."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["System", "scattered"]


def scattered(n: int, rows: NDArray[np.int64], vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Sum (k, 2) vectors into the (n, 2) rows that they belong to."""
    return np.stack([np.bincount(rows, vectors[:, k], n) for k in (0, 1)], axis=1)


class System:
    """A symmetric system for the points of a mask: 2 x 2 blocks of pieces and 6 x 6 blocks of triangles, summed.

    Parameters
    ----------
    free
        (n,) bool, the points that may move; the others stand still.
    """

    def __init__(self, free: NDArray[np.bool_]) -> None:
        self._free = np.flatnonzero(free)
        self._at = np.full(free.size, -1, np.int64)
        self._at[self._free] = np.arange(self._free.size)
        self._parts: list[tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]] = []

    def add(self, points: NDArray[np.int64], blocks: NDArray[np.float64]) -> None:
        """Add (k, 2 m, 2 m) blocks over (k, m) points, coordinates in turn."""
        k, m = points.shape
        unknown = (2 * self._at[points][:, :, None] + np.array([0, 1])).reshape(k, 2 * m)
        unknown[np.repeat(self._at[points] < 0, 2, axis=1)] = -1
        row = np.broadcast_to(unknown[:, :, None], blocks.shape).ravel()
        column = np.broadcast_to(unknown[:, None, :], blocks.shape).ravel()
        keep = (row >= 0) & (column >= 0)
        self._parts.append((row[keep], column[keep], blocks.ravel()[keep]))

    def add_differences(self, tail: NDArray[np.int64], head: NDArray[np.int64], blocks: NDArray[np.float64]) -> None:
        """Add (k, 2, 2) blocks A that stand for D' A D, D the difference of two points."""
        whole = np.empty((len(blocks), 4, 4))
        whole[:, :2, :2] = whole[:, 2:, 2:] = blocks
        whole[:, :2, 2:] = whole[:, 2:, :2] = -blocks
        self.add(np.stack([tail, head], axis=1), whole)

    def solve(self, right: NDArray[np.float64], *, ridge: float) -> NDArray[np.float64] | None:
        """Return the (n, 2) solution, 0 where nothing may move; None for a matrix past saving.

        Parameters
        ----------
        ridge
            Added to the diagonal.
        """
        import scipy.sparse as sp

        size = 2 * self._free.size
        rows, columns, values = (np.concatenate([part[k] for part in self._parts]) for k in range(3))
        matrix = sp.csc_array((values, (rows, columns)), shape=(size, size))
        matrix = matrix + sp.diags_array(np.full(size, ridge) + 1e-10 * matrix.diagonal() + 1e-12)
        if not np.isfinite(matrix.data).all():
            return None
        found = _solved(matrix.tocsc(), right[self._free].ravel())
        if found is None or not np.isfinite(found).all():
            return None
        full = np.zeros((self._at.size, 2))
        full[self._free] = found.reshape(-1, 2)
        return full


def _solved(matrix: Any, right: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Factorise without pivoting, and with pivoting and a heavier diagonal where that fails."""
    import scipy.sparse as sp
    from scipy.sparse.linalg import splu

    quick = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}
    for extra, options in ((0.0, quick), (1e-6, {})):
        heavier = matrix + sp.diags_array(extra * matrix.diagonal() + 1e-3 * extra) if extra else matrix
        try:
            return np.asarray(splu(heavier.tocsc(), **options).solve(right))
        except RuntimeError:
            continue
    return None
