"""Faces cut into triangles inside a frame, while the picture may still be tangled.

The map, in a picture of it, is put into a convex frame that stands still. Edges of the map are fixed; the other sides
of the triangles, *diagonals*, are for the mesh to choose: they are cut from the picture as it is (ears first), and
flipped whenever that makes the worse of two triangles better. Where every triangle is turned the right way round, the
picture is plane and has the map's rotation and faces: that is what untangling works towards.

A diagonal never doubles a side that is there: two triangles between the same three vertices can never both be turned right.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold._kernels import kernel
from ninefold.mapping.checks import face_labels, face_permutation

from ..corners import join_corners

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .pieces import Pieces

__all__ = ["Mesh", "doubled_areas", "squared_sides", "too_flat"]

FRAME = 16
"""Corners of the frame."""

_FRAME_RADIUS = 0.75
"""Of the frame, in diagonals of the picture."""

_FLAT = 1e-9
"""Twice the area over the squared sides, up to which a triangle counts as flat."""

_SWEEPS = 30
_STEPS, _FLIP_STEPS = 10, 5
"""Elementary steps that cutting and flipping take a dart, of the kind `Kernel.for_work` counts; measured on streets."""


class Mesh:
    """A triangulated picture.

    Parameters
    ----------
    pieces, points
        The map's pieces, and (n, 2) points to cut the faces by.

    Attributes
    ----------
    points
        (n + FRAME, 2) float64, the corners of the frame last.
    n
        Number of vertices of the map, bends included.
    triangles
        (T, 3) int64, counter-clockwise where the picture is right.
    forced
        Number of diagonals for which no ear was found when the faces were cut.
    """

    def __init__(self, pieces: Pieces, points: NDArray[np.float64]) -> None:
        simple, n = pieces.simple, pieces.n_vertices
        low, high = points.min(axis=0), points.max(axis=0)
        angle = 2 * np.pi * np.arange(FRAME) / FRAME
        circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        radius = max(float(np.hypot(*(high - low))), 1e-9) * _FRAME_RADIUS
        self.n = n
        self.points = np.concatenate([points, (low + high) / 2 + radius * circle])
        room = 6 * (n + FRAME) + 20
        self._tail, self._after, self._before = (np.zeros(room, np.int32) for _ in range(3))
        m = simple.tail.size
        self._tail[:m], self._after[:m] = simple.tail, simple.next_ccw
        forth = m + 2 * np.arange(FRAME)
        self._tail[forth], self._tail[forth + 1] = n + np.arange(FRAME), n + (np.arange(FRAME) + 1) % FRAME
        back = np.roll(forth + 1, 1)
        self._after[forth], self._after[back] = back, forth
        used = m + 2 * FRAME
        self._before[self._after[:used]] = np.arange(used)
        corner = self._eastmost_corner(simple.outer)
        join_corners.plain(self._tail, self._after, self._before, corner, int(forth[0]), used)
        self._outside = int(forth[0] + 1)
        self._fixed = np.zeros(room // 2, np.bool_)
        self._fixed[: m // 2] = pieces.real
        self._fixed[m // 2 : m // 2 + FRAME] = True
        sizes = np.bincount(face_labels(face_permutation(simple.next_ccw))[0]) + FRAME
        cut = cut_faces.for_work(_STEPS * room + int((sizes**2).sum()) // 2)
        self._used, self.forced = cut(self._tail, self._after, self._before, self.points, used + 2, self._outside)
        self.triangles = np.zeros((0, 3), np.int64)
        self.flip()

    def _eastmost_corner(self, outer: int) -> int:
        """Return the dart whose corner, on the outer face, looks east from the eastmost vertex there."""
        rim = [outer]
        d = int(self._before[outer ^ 1])
        while d != outer:
            rim.append(d)
            d = int(self._before[d ^ 1])
        darts = np.array(rim)
        east = self.points[self._tail[darts], 0]
        darts = darts[east >= east.max() - 1e-12]
        step = self.points[self._tail[darts ^ 1]] - self.points[self._tail[darts]]
        return int(darts[np.argmax(np.arctan2(step[:, 1], step[:, 0]) % (2 * np.pi))])

    def flip(self) -> None:
        """Flip diagonals until no flip makes the worse of two triangles better."""
        run = flip_diagonals.for_work(_FLIP_STEPS * self._tail.size)
        run(self._tail, self._after, self._before, self.points, self._used, self._fixed, _SWEEPS)
        dart = np.arange(self._used)
        second = self._before[dart ^ 1]
        third = self._before[second ^ 1]
        lowest = (dart < second) & (dart < third)
        d = self._outside
        for _ in range(FRAME):  # the outside of the frame is no triangle
            lowest[d] = False
            d = int(self._before[d ^ 1])
        self.triangles = self._tail[np.stack([dart, second, third], axis=1)[lowest]].astype(np.int64)

    def areas(self, points: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Return twice the signed area of every triangle, (T,), in this picture or another."""
        return doubled_areas(self.points if points is None else points, self.triangles)

    def bad(self) -> NDArray[np.bool_]:
        """Mark the triangles, (T,), that are the wrong way round, or so flat that rounding could turn them."""
        return too_flat(self.points, self.triangles)

    def near(self, seeds: NDArray[np.int64], rings: int) -> NDArray[np.bool_]:
        """Mark the vertices within some rings of triangles of the seeds; the frame is never among them."""
        found = np.zeros(len(self.points), np.bool_)
        found[seeds] = True
        for _ in range(rings):
            found[self.triangles[found[self.triangles].any(axis=1)].ravel()] = True
        found[self.n :] = False
        return found

    def copy(self) -> Mesh:
        """Return a mesh that changes on its own."""
        other = object.__new__(Mesh)
        other.__dict__.update({k: v.copy() if isinstance(v, np.ndarray) else v for k, v in self.__dict__.items()})
        return other


def doubled_areas(points: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return twice the signed area of triangles, (T,); positive for counter-clockwise ones."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.asarray((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]))


def squared_sides(points: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.float64]:
    """Return the sum of the squared sides of triangles, (T,)."""
    corner = points[triangles]
    return np.asarray(((corner - np.roll(corner, 1, 1)) ** 2).sum(axis=(1, 2)))


def too_flat(points: NDArray[np.float64], triangles: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Mark the triangles, (T,), that are the wrong way round, or so flat that rounding could turn them."""
    return np.asarray(doubled_areas(points, triangles) <= _FLAT * squared_sides(points, triangles))


@kernel(forceinline=True)
def quality(points, a, b, c):  # type: ignore[no-untyped-def]
    """Return how good a triangle is: 1 equilateral, 0 flat, -1 equilateral and the wrong way round."""
    ux, uy = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1]
    vx, vy = points[c, 0] - points[b, 0], points[c, 1] - points[b, 1]
    wx, wy = points[a, 0] - points[c, 0], points[a, 1] - points[c, 1]
    squares = ux * ux + uy * uy + vx * vx + vy * vy + wx * wx + wy * wy
    return 3.4641016151377544 * (ux * vy - uy * vx) / max(squares, 1e-300)


@kernel
def adjacent(tail, after, p, q):  # type: ignore[no-untyped-def]
    """Tell whether the tails of darts p and q are joined; both rotations are searched at once, the lesser degree counts."""
    a, c = tail[p], tail[q]
    i, j = p, q
    while True:
        if tail[i ^ 1] == c or tail[j ^ 1] == a:
            return True
        i, j = after[i], after[j]
        if i == p or j == q:
            return False


@kernel
def holds_corner(tail, before, points, p, q, b):  # type: ignore[no-untyped-def]
    """Tell whether the ear from dart p by vertex b to dart q holds another corner of its face."""
    a, c = tail[p], tail[q]
    west, east = min(points[a, 0], points[b, 0], points[c, 0]), max(points[a, 0], points[b, 0], points[c, 0])
    south, north = min(points[a, 1], points[b, 1], points[c, 1]), max(points[a, 1], points[b, 1], points[c, 1])
    d = before[q ^ 1]
    while d != p:
        w = tail[d]
        other = w != a and w != b and w != c
        near = other and west <= points[w, 0] <= east and south <= points[w, 1] <= north
        if near and quality(points, a, b, w) >= 0 and quality(points, b, c, w) >= 0 and quality(points, c, a, w) >= 0:
            return True
        d = before[d ^ 1]
    return False


@kernel
def best_corner(tail, after, before, points, start, size):  # type: ignore[no-untyped-def]
    """Return the dart before the best-shaped corner of a face that doubles no side, or -1."""
    best = -9.0
    found = -1
    p = start
    for _ in range(size):
        d = before[p ^ 1]
        q = before[d ^ 1]
        if tail[p] != tail[q] and not adjacent(tail, after, p, q):
            shape = quality(points, tail[p], tail[d], tail[q])
            if shape > best:
                best = shape
                found = p
        p = d
    return found


@kernel
def cut_faces(tail, after, before, points, used, outside):  # type: ignore[no-untyped-def]
    """Cut ears off every face but the outside until all are triangles; return darts used, and how many were forced.

    An ear is a corner that turns left and holds no other corner of its face. Where a face is tangled none may be left; then
    the best-shaped corner is cut all the same, even inside out.

    Complexity
    ----------
    O(sum of squares of face sizes) at worst.
    """
    done = np.zeros(tail.size, np.bool_)
    given = used
    forced = 0
    d = outside
    while not done[d]:
        done[d] = True
        d = before[d ^ 1]
    for start in range(given):
        if done[start]:
            continue
        size = 0
        d = start
        while True:
            done[d] = True
            size += 1
            d = before[d ^ 1]
            if d == start:
                break
        here = start
        fails = 0
        while size > 3:
            d = before[here ^ 1]
            q = before[d ^ 1]
            a, b, c = tail[here], tail[d], tail[q]
            # well-shaped ears in the first round, any in the second
            least = 1e-3 if fails < size else 0.0
            ear = a != c and quality(points, a, b, c) > least and not adjacent(tail, after, here, q)
            if ear and not holds_corner(tail, before, points, here, q, b):
                join_corners(tail, after, before, here, q, used)
                here = before[used ^ 1]
                used += 2
                size -= 1
                fails = 0
                continue
            here = d
            fails += 1
            if fails > 2 * size:
                p = best_corner(tail, after, before, points, here, size)
                q = before[before[p ^ 1] ^ 1]
                join_corners(tail, after, before, p, q, used)
                here = used
                used += 2
                size -= 1
                fails = 0
                forced += 1
    return used, forced


@kernel
def flip_diagonals(tail, after, before, points, used, fixed, sweeps):  # type: ignore[no-untyped-def]
    """Flip diagonals while the worse of the two triangles gets better and no side is doubled; return how many flips."""
    total = 0
    for _ in range(sweeps):
        flipped = 0
        for e in range(used // 2):
            if fixed[e]:
                continue
            x = 2 * e
            y = x + 1
            right = before[y]
            right2 = before[right ^ 1]
            left = before[x]
            left2 = before[left ^ 1]
            a, c, b, d = tail[x], tail[y], tail[right2], tail[left2]
            if b == d:
                continue
            old = min(quality(points, a, c, b), quality(points, c, a, d))
            new = min(quality(points, a, d, b), quality(points, d, c, b))
            if new <= old + 1e-9 or (old > 0 and new <= 0) or adjacent(tail, after, right2, left2):
                continue
            for z in (x, y):
                f, g = before[z], after[z]
                after[f] = g
                before[g] = f
            join_corners(tail, after, before, right2, left2, x)
            flipped += 1
        total += flipped
        if flipped == 0:
            break
    return total
