"""The shape that directions fix: points whose differences point along the chords, by reweighted least squares.

A direction fixes no length, so every piece also pulls, weakly, towards a positive length along its chord; the weights
are then set anew from the picture so far, so that what counts is the angle by which a piece misses its chord, whatever
its length. Where the directions fix the shape (parallel rigidity) the weak pull changes nothing; elsewhere it evens
lengths out.

The solution need not be plane, nor keep the rotation: that is for `ninefold.layout.shaping.untangle`.

References
----------
W. Whiteley, Some matroids from discrete applied geometry, 1996 (parallel rigidity). S. Zhao and D. Zelazo, Bearing
rigidity and almost global bearing-only formation stabilization, IEEE TAC 61, 2016 (bearing-based network localization).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .equations import System, scattered

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .pieces import Pieces

__all__ = ["FAITHFUL", "LEGIBLE", "FollowHeadings", "Lengths", "along_and_across", "heading_errors", "shape_of_directions"]

ACROSS, MEASURED = 3.0, 2.0
"""Weights of the angle by which a piece misses its chord, and of a length that was measured."""


class Lengths(NamedTuple):
    """How lengths that were not measured are treated.

    Attributes
    ----------
    shortest, longest
        Between which a piece is pulled, in units of the mean.
    even
        Share of the way to 1 that it is pulled besides.
    along
        Weight of that pull.
    thin
        Size below which a piece's angle counts less.
    """

    shortest: float
    longest: float
    even: float
    along: float
    thin: float


LEGIBLE = Lengths(0.25, 6.0, 0.1, 0.5, 0.3)
"""For pictures: nothing too short to see."""

FAITHFUL = Lengths(0.01, 100.0, 0.0, 0.02, 0.02)
"""For fits: directions count, lengths hardly."""

_LOOSE = 0.02
"""Pull of a piece without a heading, such as a tether: just enough that the system has one solution."""


class FollowHeadings:
    """The pull of every piece towards its chord: quadratic, with weights from the picture it is asked about.

    Parameters
    ----------
    pieces
        With their chords.
    lengths
        How lengths that were not measured are treated.
    """

    def __init__(self, pieces: Pieces, *, lengths: Lengths = LEGIBLE) -> None:
        self._pieces = pieces
        self._lengths = lengths
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
        along, across = along_and_across(self._pieces, points)
        known = np.isfinite(self._wanted)
        free = self._lengths
        open_length = np.clip(along, free.shortest, free.longest) * (1 - free.even) + free.even
        length = np.where(known, self._wanted, open_length)
        size = np.maximum(np.hypot(along, across), free.thin)
        return self._blocks(length, ACROSS / size, np.where(known, MEASURED, free.along) / np.maximum(length, free.thin))

    def _blocks(
        self, length: NDArray[np.float64], across: NDArray[np.float64], along: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        t, n, on = self._t, self._n, self._pieces.measured
        w_n, w_t = np.where(on, across**2, 0.0), np.where(on, along**2, 0.0)
        blocks = w_n[:, None, None] * n[:, :, None] * n[:, None, :] + w_t[:, None, None] * t[:, :, None] * t[:, None, :]
        blocks += np.where(on, 0.0, _LOOSE)[:, None, None] * np.eye(2)
        return blocks, (w_t * length)[:, None] * t


def shape_of_directions(
    pieces: Pieces,
    *,
    rounds: int = 15,
    enough: float = 1e-3,
    start: NDArray[np.float64] | None = None,
    lengths: Lengths = LEGIBLE,
) -> NDArray[np.float64]:
    """Return (n, 2) points, the first at the origin, whose differences follow the chords; lengths are near 1.

    Parameters
    ----------
    rounds, enough
        Rounds of reweighting, fewer once no coordinate moves by more than `enough`.
    start
        (n, 2) picture to take the first weights from.
    lengths
        How lengths that were not measured are treated.

    Notes
    -----
    Complexity: a sparse factorisation a round, about O(V^1.5).
    """
    n = pieces.n_vertices
    pull = FollowHeadings(pieces, lengths=lengths)
    free = np.ones(n, np.bool_)
    free[0] = False
    points = np.zeros((n, 2)) if start is None else start
    blocks, wanted = pull.start() if start is None else pull.terms(start)
    unsized = lengths.even == 0 and not np.isfinite(pieces.metres).any()  # nothing holds the size of the picture
    for k in range(rounds):
        system = System(free)
        system.add_differences(pieces.tail, pieces.head, blocks)
        right = scattered(n, np.concatenate([pieces.head, pieces.tail]), np.concatenate([wanted, -wanted]))
        found = system.solve(right, ridge=1e-9)
        if found is None:
            return points
        if unsized:  # every round of a bad fit would shrink it
            step = (found[pieces.head] - found[pieces.tail])[pieces.measured]
            found = found / max(float(np.hypot(*step.T).mean()) if len(step) else 1.0, 1e-9)
        moved = float(np.abs(found - points).max())
        points = found
        if k and moved < enough:
            break
        blocks, wanted = pull.terms(points)
    return points


def heading_errors(pieces: Pieces, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the angle from each piece's chord to the piece as drawn, (M,) radians in (-pi, pi]; 0 where none is wanted."""
    along, across = along_and_across(pieces, points)
    return np.where(pieces.measured, np.arctan2(across, along), 0.0)


def along_and_across(pieces: Pieces, points: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return how far each piece as drawn goes along its chord, and how far to the left of it, (M,) and (M,)."""
    step = points[pieces.head] - points[pieces.tail]
    t = pieces.along
    return (step * t).sum(axis=1), step[:, 1] * t[:, 0] - step[:, 0] * t[:, 1]
