"""Turning numbers: which face is the outer one, and whether headings can be a drawing in the plane at all.

Over a face walk the corner with interior angle t in (0, 2 pi] turns pi - t (a dead end turns -pi), plus each edge's own
net rotation (reversed: minus). Faces inside total +2 pi, the outer face -2 pi (Hopf's Umlaufsatz); in a map of several
components each component has one outer face of its own. The rule: per component exactly one face totals -2 pi and every
other +2 pi. "Exactly one negative" is too weak, since wrong closures give totals like (-1, 0, +2) turns on genus 0.

References
----------
H. Hopf, Ueber die Drehung der Tangenten und Sehnen ebener Kurven, Compositio Mathematica 2 (1935).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .heading import TAU

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["corner_angles", "edge_residual", "face_totals", "face_turns", "settle_turns"]


def edge_residual(heading: NDArray[np.float64], turn: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far each edge's net rotation is from its two end headings, (E,) radians in [-pi, pi]: sensor health."""
    gap = heading[1::2] - np.pi - heading[0::2] - turn
    return np.asarray(gap - TAU * np.round(gap / TAU))


def settle_turns(heading: NDArray[np.float64], turn: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return `turn` moved by the residual, so that every face totals a whole number of turns.

    Complexity O(E).
    """
    return turn + edge_residual(heading, turn)


def corner_angles(rotation: NDArray[np.int32], heading: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the angle from each dart to the next one counter-clockwise, (2E,) in (0, 2 pi]; alone at its vertex, 2 pi."""
    angle = heading[rotation]
    angle -= heading
    angle[angle <= 0] += TAU
    return angle


def face_totals(
    next_face: NDArray[np.int32],
    face_of: NDArray[np.int32],
    n_faces: int,
    corner: NDArray[np.float64],
    turn: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return by how much every face turns, (n_faces,) radians; the parameters are those of `face_turns`."""
    total = np.pi - corner[next_face]
    total[0::2] += turn
    total[1::2] -= turn
    return np.asarray(np.bincount(face_of, weights=total, minlength=n_faces), dtype=np.float64)


def face_turns(
    next_face: NDArray[np.int32],
    face_of: NDArray[np.int32],
    n_faces: int,
    corner: NDArray[np.float64],
    turn: NDArray[np.float64],
) -> NDArray[np.int64]:
    """Return the turning number of every face, in whole turns.

    Parameters
    ----------
    next_face, face_of
        (2E,) next dart of the face walk, and the face on each dart's left.
    corner, turn
        (2E,) angle from each dart to the next counter-clockwise, (E,) settled net rotation along dart 2e, radians.

    Returns
    -------
    ndarray
        (n_faces,) int64: +1 for a face inside, -1 for an outer face of a plane drawing.

    Notes
    -----
    The corner at the head of d lies between the next dart of the walk and the twin of d, which is the one after it around
    that vertex. Complexity O(E); array code throughout.
    """
    return np.rint(face_totals(next_face, face_of, n_faces, corner, turn) / TAU).astype(np.int64)
