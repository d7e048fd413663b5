"""What the compass fixes in a map, and which headings the rest contradicts.

A leg that was walked straight has one direction, its heading. Where the directions fix a part of the map (it is
*parallel-rigid*, see `ninefold.mapping.rigidity`) the proportions of that part in a compass drawing are measured;
everywhere else they are only evened out. Where there are more directions than are needed they test each other: the part
is fitted to all of them, and the leg without which the rest fits best is taken away and named, again and again, as long
as that explains far more than its share. Such a leg may have been curved, its heading may be wrong, or it may join two
places of which one was taken for another: so it is a warning, never a refusal.

References
----------
W. Baarda, A testing procedure for use in geodetic networks, 1968 (blunders by residuals).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput
from ninefold.immutable import Immutable, frozen_copy
from ninefold.mapping.rigidity import rigid_parts

from .arguments import require_map
from .shaping.directions import FAITHFUL, along_and_across, shape_of_directions
from .shaping.pieces import pieces_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.mapping import PlaneMap

    from .shaping.pieces import Pieces

__all__ = ["Rigidity", "rigidity"]

STRAIGHT = np.radians(3)
"""Net rotation up to which a leg is taken to be straight."""

LEAST_MISS = np.radians(3)
"""Radians up to which a leg's miss is no news, however well the others fit."""

_TIMES = 5.0
_LEAST_PART = 3
_LEAST_SIGMA = np.radians(0.1)
_LEAST_SPARE = 2
_LEAST_SHARE = 0.1
_MOST = 40
_PROBES = 64
_CANDIDATES = 8
_SHORT = 0.3


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Rigidity(Immutable):
    """What the headings of a map fix.

    Attributes
    ----------
    plane
        The map.
    part
        (E,) int64: the parallel-rigid part of every straight leg, -1 for a leg that is curved, a loop, or a tether.
        Parts are numbered from the largest.
    sizes
        (parts,) int64 number of legs of each part.
    freedom
        How many proportions between parts are open: chosen by the drawing, not measured.
    redundant
        (E,) bool: legs whose direction follows from the others.
    miss
        (E,) float64 radians in (-pi, pi]: from the heading of a leg to its direction in the fit; 0 where nothing tests it.
    sigma
        Radians: the spread of the headings, from how they miss the fit; 0 where nothing is tested.
    contradicted
        Names of legs that the rest contradicts, the worst first.
    """

    plane: PlaneMap
    part: NDArray[np.int64]
    sizes: NDArray[np.int64]
    freedom: int
    redundant: NDArray[np.bool_]
    miss: NDArray[np.float64]
    sigma: float = 0.0
    contradicted: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in ("part", "sizes", "redundant", "miss"):
            object.__setattr__(self, name, frozen_copy(getattr(self, name)))

    @property
    def fixed(self) -> NDArray[np.bool_]:
        """(E,) bool: legs whose length is measured relative to others, those of parts with three legs or more."""
        known = np.append(self.sizes, 0)[self.part] >= _LEAST_PART
        return np.asarray(known & (self.part >= 0))

    @property
    def curved(self) -> NDArray[np.bool_]:
        """(E,) bool: legs that have no one direction, such as curved ones and loops."""
        return np.asarray((self.part < 0) & ~self.plane.tether)

    @property
    def counts(self) -> dict[str, int]:
        """How many: legs fixed, parts that they are in, legs of the largest, proportions open, legs curved."""
        known = self.sizes[self.sizes >= _LEAST_PART]
        return {
            "legs": int(known.sum()),
            "parts": int(known.size),
            "largest": int(known[0]) if known.size else 0,
            "open": self.freedom,
            "curved": int(self.curved.sum()),
        }

    @property
    def warnings(self) -> tuple[str, ...]:
        """One line for each leg that the rest contradicts, the worst first."""
        return tuple(
            f"leg {quoted(name)} misses what the other headings say by {self._degrees(name):.0f} degrees: "
            "it is curved, its heading or one beside it is wrong, or two places were taken for one"
            for name in self.contradicted
        )

    def _degrees(self, name: str) -> float:
        return abs(float(np.degrees(self.miss[self.plane.edge_names.row(name)])))

    def __repr__(self) -> str:
        found = self.counts
        parts = [f"{found['legs']} of {counted(self.plane.n_edges, 'leg')} fixed"]
        if found["parts"]:
            parts.append(counted(found["parts"], "part"))
        parts += [f"{found[key]} {key}" for key in ("open", "curved") if found[key]]
        if self.contradicted:
            parts.append(f"{len(self.contradicted)} contradicted")
        return f"Rigidity({', '.join(parts)})"

    def __str__(self) -> str:
        found = self.counts
        text = f"{found['legs']:,} of {counted(self.plane.n_edges, 'leg')} are in parts whose shape the headings fix"
        if found["parts"]:
            text += f", the largest of {found['largest']:,}"
        curved, proportions = (_are(found["curved"], "leg"), _are(found["open"], "proportion"))
        return f"{text}; {curved} curved, and {proportions} open"


def _are(number: int, noun: str) -> str:
    return f"{counted(number, noun)} {'is' if number == 1 else 'are'}"


def rigidity(plane: PlaneMap, *, straight: float = STRAIGHT, tested: bool = True) -> Rigidity:
    """Return what the headings of a map fix, and how far each misses the rest.

    Parameters
    ----------
    straight
        Radians of net rotation up to which a leg is taken to be straight. A leg that bends and bends back is taken to
        be straight too: nothing in the walk tells.
    tested
        Whether to hold the headings against each other. Without it no leg is contradicted and no miss known, and a large
        map is done many times faster.

    Raises
    ------
    BadInput
        A map without headings.

    Notes
    -----
    Complexity: the pebble game, and a few tens of sparse factorisations if any direction is redundant.

    Examples
    --------
    >>> from ninefold.mapping import PlaneMap
    >>> corners = [(0, 0), (2, 0), (2, 1), (0, 1)]
    >>> braced = PlaneMap.from_geometry(corners, [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)])
    >>> print(rigidity(braced))
    5 of 5 legs are in parts whose shape the headings fix, the largest of 5; 0 legs are curved, and 0 proportions are open
    >>> open_square = PlaneMap.from_geometry(corners, [(0, 1), (1, 2), (2, 3), (3, 0)])
    >>> print(rigidity(open_square))
    0 of 4 legs are in parts whose shape the headings fix; 0 legs are curved, and 1 proportion is open
    >>> rigidity(open_square)
    Rigidity(0 of 4 legs fixed, 1 open)
    """
    require_map(plane, "rigidity")
    if plane.heading is None or plane.turn is None:
        raise BadInput("the map has no headings, so nothing is fixed by them; make it from a walk or from geometry")
    n_edges = plane.tether.size
    pieces = pieces_of(plane)
    ends = plane.tail.reshape(-1, 2).astype(np.int64)
    bent = np.diff(pieces.simple.bend_start) > 0
    known = ~plane.tether & ~bent & (np.abs(np.nan_to_num(plane.turn)) <= straight)  # a loop is bent
    rows = np.flatnonzero(known)
    found = rigid_parts(ends[rows])
    order = np.argsort(-found.sizes, kind="stable")
    rank = np.empty(order.size, np.int64)
    rank[order] = np.arange(order.size)
    part = np.full(n_edges, -1, np.int64)
    part[rows] = rank[found.part]
    redundant = np.zeros(n_edges, np.bool_)
    redundant[rows] = found.redundant
    miss = np.zeros(n_edges)
    sigma = 0.0
    spare = np.bincount(part[redundant], minlength=order.size)
    testable = (part >= 0) & (np.append(spare, 0)[part] >= _LEAST_SPARE)
    contradicted: tuple[int, ...] = ()
    if tested and testable.any():
        contradicted, miss, sigma = _snoop(pieces, testable, int(np.count_nonzero(redundant & testable)))
    names = tuple(plane.edge_names[e] for e in contradicted)
    return Rigidity(plane, part, found.sizes[order], max(found.freedom, 0), redundant, miss, sigma, names)


def _snoop(pieces: Pieces, tested: NDArray[np.bool_], spare: int) -> tuple[tuple[int, ...], NDArray[np.float64], float]:
    """Take away the leg that misses its heading by most of what it could, again and again, until none misses by too much.

    Returns
    -------
    The legs taken away, worst first; the misses of all tested legs, (E,), radians; and the spread of the headings that stay.
    """
    n_edges = tested.size
    pieces = replace(pieces, measured=pieces.measured & tested[pieces.edge])
    points = shape_of_directions(pieces, rounds=25, lengths=FAITHFUL)
    dropped: list[int] = []
    left = spare
    while True:
        errors = _missed(pieces, points)
        cost = float((errors**2).sum())
        sigma = max(np.sqrt(cost / max(left, 1)), _LEAST_SIGMA)
        if left <= _LEAST_SPARE or len(dropped) >= _MOST:
            break
        rows = np.flatnonzero(pieces.measured)
        share = _redundancy(pieces, points, rows)
        scaled = np.abs(errors[rows]) / np.sqrt(np.maximum(share, _LEAST_SHARE))
        best = (cost, -1, pieces, points)
        for row in rows[np.argsort(-scaled, kind="stable")[:_CANDIDATES]].tolist():
            measured = pieces.measured.copy()
            measured[row] = False
            without = replace(pieces, measured=measured)
            fit = shape_of_directions(without, start=points, rounds=5, lengths=FAITHFUL)
            remains = float((_missed(without, fit) ** 2).sum())
            if remains < best[0]:
                best = (remains, row, without, fit)
        remains, row, without, fit = best
        if row < 0:
            break
        after = max(remains / (left - 1), _LEAST_SIGMA**2)
        alone = abs(float(_missed(replace(without, measured=pieces.measured), fit)[row]))
        if cost - remains <= _TIMES**2 * after or alone <= LEAST_MISS:
            break
        dropped.append(row)
        pieces, points, left = without, fit, left - 1
    errors = _missed(replace(pieces, measured=tested[pieces.edge]), points)
    miss = np.zeros(n_edges)
    miss[tested] = errors[:n_edges][tested]
    return tuple(dropped), miss, float(sigma)


def _missed(pieces: Pieces, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return by how much pieces miss their chords, (M,) radians; for a short piece as if it were longer.

    Where a piece is shorter than its ends are uncertain, its direction in the fit says nothing.
    """
    along, across = along_and_across(pieces, points)
    typical = float(np.abs(along[pieces.measured]).mean()) if pieces.measured.any() else 1.0
    return np.where(pieces.measured, np.arctan2(across, np.maximum(along, _SHORT * typical)), 0.0)


def _redundancy(pieces: Pieces, points: NDArray[np.float64], rows: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return, for each heading, the share of an error in it that shows as a miss, (k,) in [0, 1]; by random probes.

    It is the diagonal of 1 - A (A' A)^-1 A' for the directions' equations A at the picture.
    """
    import scipy.sparse as sp
    from scipy.sparse.linalg import splu

    u, v = pieces.tail[rows], pieces.head[rows]
    step = points[v] - points[u]
    length = np.hypot(*step.T)
    floor = np.maximum(length, _SHORT * length.mean()) * np.maximum(length, 1e-9)
    across = np.stack([-step[:, 1], step[:, 0]], axis=1) / floor[:, None]  # slope of the angle
    k = np.arange(rows.size)
    column = np.concatenate([2 * v, 2 * v + 1, 2 * u, 2 * u + 1])
    value = np.concatenate([across[:, 0], across[:, 1], -across[:, 0], -across[:, 1]])
    A = sp.csr_array((value, (np.tile(k, 4), column)), shape=(rows.size, 2 * pieces.n_vertices))
    normal = (A.T @ A).tocsc()
    ridge = 1e-9 * float(normal.diagonal().mean()) + 1e-300
    factor = splu((normal + ridge * sp.eye_array(normal.shape[0])).tocsc(), permc_spec="MMD_AT_PLUS_A")
    signs = np.random.default_rng(0).choice([-1.0, 1.0], (rows.size, _PROBES))
    seen = A @ factor.solve(A.T @ signs)
    return np.asarray(np.clip(1 - (signs * seen).mean(axis=1), 0.0, 1.0))
