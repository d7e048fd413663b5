"""Adding edges to a simple plane map, inside its own faces, until every face is a triangle.

The rotation of the given darts and the outer face are kept: the outer triangle is a piece of the old outer face, so once the
additions are dropped the unbounded face is the old one. No vertex is added, which is what the (n - 2) x (n - 2) grid needs.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold.errors import TooLarge

from ._augment import close_faces, fan_faces

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["biconnect", "check_size", "triangulate"]

_MOST_DARTS = 2**31 - 1


def check_size(n_vertices: int) -> None:
    """Raise `TooLarge` if a triangulation of that many vertices has more darts than 32-bit numbers.

    Examples
    --------
    >>> check_size(1_000_000)
    >>> check_size(10**9)
    Traceback (most recent call last):
    ninefold.errors.TooLarge: a drawing of 1000000000 vertices, bends included, needs 5999999988 darts ...
    """
    darts = 6 * n_vertices - 12
    if darts > _MOST_DARTS:
        raise TooLarge(
            f"a drawing of {n_vertices} vertices, bends included, needs {darts} darts and they are numbered up to "
            f"{_MOST_DARTS}: draw a part of at most {(_MOST_DARTS + 12) // 6} vertices"
        )


def biconnect(
    tail: NDArray[np.int32], next_ccw: NDArray[np.int32], n_vertices: int
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32], int]:
    """Add edges to a simple connected plane map of three or more vertices until every face is a simple cycle.

    Returns
    -------
    tail, next_ccw, prev_ccw
        (6 V - 12,) int32, room for a triangulation; the given darts keep their numbers.
    used
        How many darts there are.

    Notes
    -----
    Complexity O(V + E).
    """
    check_size(n_vertices)
    room = 6 * n_vertices - 12
    tails, after, before = (np.zeros(room, np.int32) for _ in range(3))
    used = tail.size
    tails[:used], after[:used] = tail, next_ccw
    before[next_ccw] = np.arange(used, dtype=np.int32)
    used = int(close_faces.for_work(room)(tails, after, before, n_vertices, used))
    return tails, after, before, used


def triangulate(
    tail: NDArray[np.int32], next_ccw: NDArray[np.int32], n_vertices: int
) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
    """Add edges to a simple connected plane map of three or more vertices until every face is a triangle.

    Parameters
    ----------
    tail, next_ccw
        (2E,) int32, the rotation system.
    n_vertices
        At least 3.

    Returns
    -------
    tail, next_ccw, prev_ccw
        (6 V - 12,) int32; the given darts keep their numbers and their cyclic order.

    Raises
    ------
    TooLarge
        If the darts would not fit 32 bits.

    Notes
    -----
    Complexity O(V). Corner cuts as in Kant (1996) make the faces simple cycles, and fans triangulate them.

    References
    ----------
    G. Kant, Drawing planar graphs using the canonical ordering, Algorithmica 16 (1996).
    T. Biedl, G. Kant, M. Kaufmann, On triangulating planar graphs under the four-connectivity constraint, Algorithmica 19
    (1997).

    Examples
    --------
    >>> import numpy as np
    >>> path = np.array([0, 1, 1, 2]), np.array([0, 2, 1, 3])
    >>> tails, after, _ = triangulate(path[0].astype(np.int32), path[1].astype(np.int32), 3)
    >>> tails.tolist()
    [0, 1, 1, 2, 2, 0]
    """
    tails, after, before, used = biconnect(tail, next_ccw, n_vertices)
    if used < tails.size:
        degree = np.bincount(tails[:used], minlength=n_vertices).astype(np.int32)
        fan_faces.for_work(tails.size)(tails, after, before, degree, used)
    return tails, after, before
