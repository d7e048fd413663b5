"""The straight pieces of a map and the directions that headings give them.

Loops and parallel edges are bent (`ninefold.layout.methods.subdivide`), so that every piece can be a straight segment.
A piece is expected to point along its *chord*: piece j of the k pieces of an edge along ``heading + turn (2 j + 1) / (2
k)``, which for a straight edge is its heading and for an evenly curved one the direction of the chord.

Chords forget how an edge leaves its vertex, so two of them can come in another order than the map's rotation. `spread` turns
them, each as little as it can, until the rotation holds with a least angle at every vertex.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ninefold.mapping.heading import TAU

from ..methods.subdivide import make_simple

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.mapping import PlaneMap

    from ..methods.subdivide import SimpleMap

__all__ = ["Pieces", "pieces_of", "spread", "wrapped"]

LEAST_ANGLE = np.radians(2)
"""Angle that `spread` makes room for between two pieces; less where many meet."""

_SWEEPS, _STEP, _ENOUGH = 200, 0.7, 1e-4


@dataclass(frozen=True, slots=True, eq=False)
class Pieces:
    """Straight pieces with wanted directions.

    Attributes
    ----------
    simple
        The map, loops and parallel edges bent; piece m has darts 2m and 2m + 1 in it.
    tail, head
        (M,) int64, the vertices that piece m joins.
    edge, place
        (M,) int64, the edge of the map that it belongs to, and its place along dart 2e of that edge, from 0.
    chord
        (M,) float64 radians, the direction wanted from tail to head; 0 where none is.
    leaving
        (2M,) float64 radians, the heading on leaving along each dart; the map's rotation is their order.
    measured
        (M,) bool, whether there is a heading; false for tethers, and for every piece of a map without headings.
    real
        (M,) bool, false for tethers, which are no part of the picture.
    metres
        (M,) float64, the length measured, NaN where there is none.
    """

    simple: SimpleMap
    tail: NDArray[np.int64]
    head: NDArray[np.int64]
    edge: NDArray[np.int64]
    place: NDArray[np.int64]
    chord: NDArray[np.float64]
    leaving: NDArray[np.float64]
    measured: NDArray[np.bool_]
    real: NDArray[np.bool_]
    metres: NDArray[np.float64]

    @property
    def n_vertices(self) -> int:
        """Number of vertices, bends included."""
        return self.simple.n_vertices

    @property
    def along(self) -> NDArray[np.float64]:
        """(M, 2) unit vectors of the chords."""
        return np.stack([np.cos(self.chord), np.sin(self.chord)], axis=1)


def wrapped(angle: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return angles in [-pi, pi)."""
    return np.asarray((angle + np.pi) % TAU - np.pi)


def pieces_of(
    plane: PlaneMap, *, chords: NDArray[np.float64] | None = None, metres: NDArray[np.float64] | None = None
) -> Pieces:
    """Cut the edges of a map into straight pieces.

    Parameters
    ----------
    chords
        (E,) radians, directions of the edges' chords to use instead of those that the map's headings give.
    metres
        (E,) lengths of edges along the way, NaN where unknown.

    Notes
    -----
    Complexity O(E log E).
    """
    simple = make_simple(plane.tail, plane.next_ccw, plane.outer, plane.n_vertices)
    n_edges = plane.tether.size
    count = np.diff(simple.bend_start) + 1
    edge = np.concatenate([np.arange(n_edges), np.repeat(np.arange(n_edges), count - 1)])
    place = np.zeros(edge.size, np.int64)
    place[n_edges:] = np.arange(edge.size - n_edges) - np.repeat(simple.bend_start[:-1], count - 1) + 1
    tail, head = simple.tail[0::2].astype(np.int64), simple.tail[1::2].astype(np.int64)
    real = ~plane.tether[edge]
    length = np.full(edge.size, np.nan)
    if plane.heading is None or plane.turn is None:
        nothing = np.zeros(edge.size)
        return Pieces(
            simple, tail, head, edge, place, nothing, np.zeros(simple.tail.size), np.zeros(edge.size, np.bool_), real, length
        )
    start, turn = plane.heading[0::2], plane.turn
    chord = start[edge] + turn[edge] * (2 * place + 1) / (2 * count[edge])
    if chords is not None:
        chord = chord + (np.asarray(chords, np.float64) - start - turn / 2)[edge]
    leaving = np.stack([chord, chord + np.pi], axis=1)
    leaving[place == 0, 0] = start
    last = place == count[edge] - 1
    leaving[last, 1] = plane.heading[1::2][edge[last]]
    if metres is not None:
        # an even curve of this length has a chord shorter by sin(x) / x, x half the piece's turn
        length = (np.asarray(metres, np.float64) / count)[edge] * np.sinc(turn[edge] / (2 * count[edge]) / np.pi)
        length[~(length > 0)] = np.nan
    measured = real & np.isfinite(chord)
    chord, leaving = np.where(measured, chord, 0.0), np.where(np.isfinite(leaving), leaving, 0.0).ravel()
    return Pieces(simple, tail, head, edge, place, chord, leaving, measured, real, length)


def spread(pieces: Pieces, *, least: float = LEAST_ANGLE) -> Pieces:
    """Turn the chords as little as needed for the map's rotation to hold, with a least angle at every vertex.

    Where two neighbours at a vertex are too close, or in the wrong order, each turns by a share of what is lacking; the
    rounds end when nothing is lacking, or after a fixed number of them where a vertex is too crowded.
    """
    tail, after = pieces.simple.tail, pieces.simple.next_ccw
    dart = np.arange(tail.size)
    piece = dart >> 1
    looked_at = pieces.measured[piece] & pieces.measured[piece[after]] & (after != dart)
    degree = np.bincount(tail, minlength=pieces.n_vertices)[tail]
    # the headings obey the rotation: their gaps are where the chords start from
    gap = np.where(looked_at, (pieces.leaving[after] - pieces.leaving) % TAU, TAU)
    need = np.minimum(least, np.pi / np.maximum(degree, 1))
    bent = wrapped(pieces.chord[piece] + np.pi * (dart & 1) - pieces.leaving)
    turned = np.zeros(pieces.chord.size)
    for _ in range(_SWEEPS):
        away = bent + turned[piece]
        lack = np.where(looked_at, np.maximum(need - (gap + away[after] - away), 0.0), 0.0)
        if lack.max(initial=0.0) < _ENOUGH:
            break
        forth, back = (np.bincount(p, lack / 2, turned.size) for p in (piece[after], piece))
        turned += _STEP * (forth - back)
    return replace(pieces, chord=pieces.chord + turned)
