"""The shape that directions fix: points whose differences point along the chords, by reweighted least squares.

A direction fixes no length, so every piece also pulls, weakly, towards a positive length along its chord; the weights are then
set anew from the picture so far, so that what counts is the angle by which a piece misses its chord, whatever its length.
Where the directions fix the shape (parallel rigidity) the weak pull changes nothing; elsewhere it evens lengths out.

The solution need not be plane, nor keep the rotation: that is for `ninefold.layout.shaping.untangle`.

References
----------
W. Whiteley, Some matroids from discrete applied geometry, 1996 (parallel rigidity). S. Zhao and D. Zelazo, Bearing rigidity and
almost global bearing-only formation stabilization, IEEE TAC 61, 2016 (bearing-based network localization).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .equations import System, scattered

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .pieces import Pieces

__all__ = ["FollowHeadings", "heading_errors", "shape_of_directions"]

SHORTEST, LONGEST = 0.25, 6.0
"""Lengths, in units of the mean, between which a piece without a measured length is pulled."""

ACROSS, ALONG, MEASURED = 3.0, 0.5, 2.0
"""Weights of the angle by which a piece misses its chord, of its length, and of a length that was measured."""

_THIN = 0.3
_LOOSE = 0.02
"""Pull of a piece without a heading, such as a tether: just enough that the system has one solution."""


class FollowHeadings:
    """The pull of every piece towards its chord: quadratic, with weights from the picture it is asked about.

    Parameters
    ----------
    pieces
        With their chords.
    """

    def __init__(self, pieces: Pieces) -> None:
        self._pieces = pieces
        self._t = pieces.along
        self._n = np.stack([-self._t[:, 1], self._t[:, 0]], axis=1)
        known = np.isfinite(pieces.metres)
        unit = float(np.exp(np.log(pieces.metres[known]).mean())) if known.any() else 1.0
        self._wanted = pieces.metres / unit

    def start(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the blocks and pulls of a picture of which nothing is known: all lengths 1, or as measured."""
        known = np.isfinite(self._wanted)
        length = np.where(known, self._wanted, 1.0)
        shape = (self._t.shape[0],)
        return self._blocks(length, np.full(shape, ACROSS) / length, np.where(known, MEASURED, 1.0) / length)

    def terms(self, points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return A (M, 2, 2) and g (M, 2): the energy of piece m is D' A D / 2 - g' D for its difference D."""
        step = points[self._pieces.head] - points[self._pieces.tail]
        along, across = (step * self._t).sum(axis=1), (step * self._n).sum(axis=1)
        known = np.isfinite(self._wanted)
        length = np.where(known, self._wanted, np.clip(along, SHORTEST, LONGEST) * 0.9 + 0.1)
        size = np.maximum(np.hypot(along, across), _THIN)
        return self._blocks(length, ACROSS / size, np.where(known, MEASURED, ALONG) / np.maximum(length, _THIN))

    def _blocks(
        self, length: NDArray[np.float64], across: NDArray[np.float64], along: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        t, n, on = self._t, self._n, self._pieces.measured
        w_n, w_t = np.where(on, across**2, 0.0), np.where(on, along**2, 0.0)
        blocks = w_n[:, None, None] * n[:, :, None] * n[:, None, :] + w_t[:, None, None] * t[:, :, None] * t[:, None, :]
        blocks += np.where(on, 0.0, _LOOSE)[:, None, None] * np.eye(2)
        return blocks, (w_t * length)[:, None] * t


def shape_of_directions(pieces: Pieces, *, rounds: int = 15, enough: float = 1e-3) -> NDArray[np.float64]:
    """Return (n, 2) points, the first at the origin, whose differences follow the chords; lengths are near 1.

    Parameters
    ----------
    rounds, enough
        Rounds of reweighting, fewer once no coordinate moves by more than `enough`.

    Notes
    -----
    Complexity: a sparse factorisation a round, about O(V^1.5).
    """
    n = pieces.n_vertices
    pull = FollowHeadings(pieces)
    free = np.ones(n, np.bool_)
    free[0] = False
    points = np.zeros((n, 2))
    blocks, wanted = pull.start()
    for k in range(rounds):
        system = System(free)
        system.add_differences(pieces.tail, pieces.head, blocks)
        right = scattered(n, np.concatenate([pieces.head, pieces.tail]), np.concatenate([wanted, -wanted]))
        found = system.solve(right, ridge=1e-9)
        if found is None:
            return points
        moved = float(np.abs(found - points).max())
        points = found
        if k and moved < enough:
            break
        blocks, wanted = pull.terms(points)
    return points


def heading_errors(pieces: Pieces, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the angle from each piece's chord to the piece as drawn, (M,) radians in (-pi, pi]; 0 where none is wanted."""
    step = points[pieces.head] - points[pieces.tail]
    t = pieces.along
    along, across = (step * t).sum(axis=1), step[:, 1] * t[:, 0] - step[:, 0] * t[:, 1]
    return np.where(pieces.measured, np.arctan2(across, along), 0.0)
