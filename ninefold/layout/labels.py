"""Placing vertex names on a small picture so that no two collide, and few lie on an edge.

Each name tries places around its vertex. A place that meets another name, a vertex or the rim is out; crossing an edge
costs, and so does distance. Names are set in order of how crowded their vertices are, the most crowded first.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

__all__ = ["Label", "place_labels", "text_width"]

_REACH = (9.0, 14.0, 22.0, 34.0, 50.0, 70.0)
_DIRECTIONS = 16
_LEADER_FROM = 22.0


@dataclass(frozen=True, slots=True)
class Label:
    """A placed name.

    Attributes
    ----------
    text
        The name.
    x, y
        Centre of its box in pixels, y downwards.
    leader
        Start and end of the line that joins it to its vertex, or None where it is near enough.
    """

    text: str
    x: float
    y: float
    leader: tuple[float, float, float, float] | None


def text_width(text: str, size: float) -> float:
    """Estimate the width of a text in a sans-serif face, in pixels: wide letters count double in East Asian scripts."""
    return size * sum(1.0 if ord(letter) > 0x2E80 else 0.58 for letter in text)


def place_labels(
    names: Sequence[str],
    points: NDArray[np.float64],
    pieces: NDArray[np.float64],
    *,
    size: float,
    dot: float | NDArray[np.float64],
    frame: tuple[float, float, float, float],
) -> list[Label]:
    """Place the names of points.

    Parameters
    ----------
    names, points
        The texts, and (V, 2) pixel positions, y downwards.
    pieces
        (S, 4) straight pieces to keep clear of where possible.
    size, dot
        Height of the text and radius of a vertex, or of each, (V,), pixels.
    frame
        x0, y0, x1, y1: no label leaves it.

    Returns
    -------
    list of Label
        In the order of the points; a name without a free place is left out.

    Notes
    -----
    Complexity O(V (V + S)) for a fixed number of places.
    """
    reach = np.sort(np.hypot(*(points[:, None] - points[None]).transpose(2, 0, 1)), axis=1)
    crowded = np.argsort(reach[:, min(3, len(points) - 1)], kind="stable")
    boxes = np.zeros((0, 4))
    radius = np.broadcast_to(np.asarray(dot, np.float64), len(points))
    dots = np.concatenate([points - radius[:, None] - 1, points + radius[:, None] + 1], axis=1)
    found: dict[int, Label] = {}
    for v in crowded.tolist():
        wide, high = text_width(names[v], size) / 2 + 1, size / 2 + 1
        centres, radii = _places(points[v], wide, high, float(radius[v]))
        candidate = np.concatenate([centres - (wide, high), centres + (wide, high)], axis=1)
        free = (candidate[:, :2] >= frame[:2]).all(axis=1) & (candidate[:, 2:] <= frame[2:]).all(axis=1)
        free &= ~_overlap(candidate, np.concatenate([boxes, dots])).any(axis=1)
        if not free.any():
            continue
        rows = np.flatnonzero(free)
        cost = 6.0 * _cuts(candidate[rows], pieces) + 0.55 * radii[rows]
        best = int(rows[np.argmin(cost)])
        boxes = np.concatenate([boxes, candidate[best : best + 1]])
        found[v] = _label(names[v], points[v], centres[best], float(radii[best]), (wide, high), float(radius[v]))
    return [found[v] for v in sorted(found)]


def _places(
    at: NDArray[np.float64], wide: float, high: float, dot: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Centres of the places to try, upper right first, and how far each lies from the vertex."""
    angle = -np.pi / 4 + 2 * np.pi * np.arange(_DIRECTIONS) / _DIRECTIONS
    unit = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    reach = np.repeat(_REACH, _DIRECTIONS) + dot - 4
    unit = np.tile(unit, (len(_REACH), 1))
    return at + unit * (reach[:, None] + np.array([wide, high]) * np.abs(unit)), reach


def _label(
    text: str, at: NDArray[np.float64], centre: NDArray[np.float64], reach: float, half: tuple[float, float], dot: float
) -> Label:
    x, y = float(centre[0]), float(centre[1])
    if reach < _LEADER_FROM:
        return Label(text, x, y, None)
    end = np.clip(at, centre - half, centre + half)
    way = end - at
    start = at + way * (dot + 1) / max(float(np.hypot(*way)), 1e-9)
    return Label(text, x, y, (float(start[0]), float(start[1]), float(end[0]), float(end[1])))


def _overlap(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Which boxes of a meet which of b, (A, B)."""
    a, b = a[:, None], b[None]
    return np.asarray(
        (a[..., 0] < b[..., 2]) & (a[..., 2] > b[..., 0]) & (a[..., 1] < b[..., 3]) & (a[..., 3] > b[..., 1]), np.bool_
    )


def _cuts(boxes: NDArray[np.float64], pieces: NDArray[np.float64]) -> NDArray[np.int64]:
    """How many straight pieces run through each box, by clipping (Liang and Barsky)."""
    x0, y0, x1, y1 = (pieces[None, :, k] for k in range(4))
    enter, leave = np.zeros((len(boxes), len(pieces))), np.ones((len(boxes), len(pieces)))
    for start, step, low, high in ((x0, x1 - x0, boxes[:, :1], boxes[:, 2:3]), (y0, y1 - y0, boxes[:, 1:2], boxes[:, 3:4])):
        with np.errstate(divide="ignore", invalid="ignore"):
            t, u = (low - start) / step, (high - start) / step
        level = np.broadcast_to(step == 0, enter.shape)
        outside = level & ((start < low) | (start > high))
        enter = np.where(level, enter, np.maximum(enter, np.minimum(t, u)))
        leave = np.where(level, leave, np.minimum(leave, np.maximum(t, u)))
        leave = np.where(outside, -1.0, leave)
    return np.asarray((enter < leave).sum(axis=1), dtype=np.int64)
