"""Which face is the outer one, where whole turns are not certain: by likelihood over all faces at once.

Without a compass the frame wanders. The order of the exits at a place is still seen there, but by how much a face turns is
then a sum of many errors, and rounding every face on its own is wrong as soon as one sum errs by half a turn. Yet only so
many outcomes are possible as there are faces: one face turns by -2 pi and every other by +2 pi. The errors of faces that
share an edge are correlated, and the likelihood of each outcome takes the whole of that into account.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..heading import TAU
from ..turning import face_totals, face_turns
from .noise import LOG_ODDS

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["misses_by_outer_face", "outer_faces", "settled_turns"]


def misses_by_outer_face(
    next_face: NDArray[np.int32],
    face_of: NDArray[np.int32],
    n_faces: int,
    corner: NDArray[np.float64],
    turn: NDArray[np.float64],
    var_turn: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return, for every face, half the squared miss of all turning from what it would be if that face were the outer one.

    Parameters
    ----------
    next_face, face_of
        (2E,) next dart of the face walk, and the face on each dart's left.
    corner
        (2E,) angle from each dart to the next counter-clockwise, radians; they sum to a full turn at every place.
    turn, var_turn
        (E,) measured net rotation along dart 2e and the variance of its error, radians and radians squared. Errors at the
        corners of a place shift what one face turns to another; they belong to the ends of the edges and are counted here.

    Returns
    -------
    ndarray
        (F,) float64, in standard deviations. The smallest is the likeliest.

    Notes
    -----
    All faces together turn as Euler's formula says, whatever the errors, so one of them tells nothing new and is left out.
    Complexity O(E + F cubed) for the dense solve, O(E + F squared) memory.
    """
    turned = face_totals(next_face, face_of, n_faces, corner, turn)
    left, right = face_of[0::2], face_of[1::2]
    apart = left != right
    covariance = np.zeros((n_faces, n_faces))
    np.add.at(covariance, (left[apart], left[apart]), var_turn[apart])
    np.add.at(covariance, (right[apart], right[apart]), var_turn[apart])
    np.add.at(covariance, (left[apart], right[apart]), -var_turn[apart])
    np.add.at(covariance, (right[apart], left[apart]), -var_turn[apart])
    if n_faces == 1:
        return np.zeros(1)
    inverse = np.linalg.inv(covariance[:-1, :-1])
    miss = turned - TAU  # if no face were the outer one; an outer face g adds two turns to its own
    base = inverse @ miss[:-1]
    half = 0.5 * float(miss[:-1] @ base)
    found = np.full(n_faces, half)
    found[:-1] += 2 * TAU * base + 0.5 * (2 * TAU) ** 2 * np.diagonal(inverse)
    return found


def outer_faces(miss: NDArray[np.float64]) -> NDArray[np.int64]:
    """Return the faces that can be the outer one, the likeliest first: those within `LOG_ODDS` of the best."""
    order = np.argsort(miss, kind="stable")
    return np.asarray(order[miss[order] <= miss[order[0]] + LOG_ODDS], dtype=np.int64)


def settled_turns(
    next_face: NDArray[np.int32],
    face_of: NDArray[np.int32],
    n_faces: int,
    corner: NDArray[np.float64],
    turn: NDArray[np.float64],
    outer: int,
) -> NDArray[np.float64]:
    """Return net rotations moved by whole turns so that every face turns as it must, (E,) radians.

    Parameters
    ----------
    turn
        (E,) that agree with the end headings up to whole turns.
    outer
        The outer face.

    Notes
    -----
    What a face lacks is handed on along a spanning tree of the dual graph, from its leaves to its root. Complexity O(E).
    """
    lacks = np.ones(n_faces, np.int64)
    lacks[outer] = -1
    lacks -= face_turns(next_face, face_of, n_faces, corner, turn)
    moved = turn.copy()
    left, right = face_of[0::2].tolist(), face_of[1::2].tolist()
    across: list[list[int]] = [[] for _ in range(n_faces)]
    for edge, (a, b) in enumerate(zip(left, right, strict=True)):
        if a != b:
            across[a].append(edge)
            across[b].append(edge)
    came = {outer: -1}
    order = [outer]
    for face in order:
        for edge in across[face]:
            other = right[edge] if left[edge] == face else left[edge]
            if other not in came:
                came[other] = edge
                order.append(other)
    for face in reversed(order[1:]):
        edge, share = came[face], int(lacks[face])
        if share:
            sign = 1 if left[edge] == face else -1
            moved[edge] += sign * TAU * share
            lacks[right[edge] if sign > 0 else left[edge]] += share
    return moved
