"""Tethers: which face hosts which component, and the virtual edges that record it.

From the westernmost point of a component look west: the first piece of another component that is met has the host face on
the side that faces the point; if nothing is met, the component lies in the outer face. The pieces are kept in horizontal
rows, so a look costs about the square root of the number of pieces.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold._kernels import kernel

from . import checks

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .names import Names

__all__ = ["tie_components"]


def tie_components(
    tail: NDArray[np.int32],
    next_ccw: NDArray[np.int32],
    heading: NDArray[np.float64],
    turn: NDArray[np.float64],
    derived: checks.Derived,
    xy: NDArray[np.float64],
    segments: tuple[NDArray[np.float64], NDArray[np.int32]],
    edge_names: Names,
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Return tail and next_ccw with one more edge, a tether, for every component but one.

    Parameters
    ----------
    segments
        The straight pieces of all edges, (S, 4) along dart 2e, and the edge of each (S,).

    Notes
    -----
    Complexity O(S + C sqrt(S)) for C components and S pieces of similar length.
    """
    piece, piece_edge = segments
    component = derived.component
    n_components = derived.n_components
    piece_component = component[tail[2 * piece_edge]] if len(piece) else np.zeros(0, np.int32)
    hosts = _hosts(xy, component, n_components, piece, piece_edge, piece_component)
    outer = np.full(n_components, -1, np.int64)
    if tail.size:
        none = np.zeros(tail.size // 2, np.bool_)
        walks = checks.component_walks(tail, next_ccw, none, heading, turn, component, derived, edge_names)
        darts = walks.lowest[walks.clockwise]
        outer[component[tail[darts]]] = darts
    vertex = np.zeros(n_components, np.int64)
    vertex[component[::-1]] = np.arange(component.size - 1, -1, -1)  # the lowest vertex of each component

    free = np.flatnonzero(hosts < 0)
    root = int(free[np.argmax(outer[free] >= 0)])
    size = tail.size
    tails = np.concatenate([tail, np.empty(2 * (n_components - 1), np.int32)])
    after = np.concatenate([next_ccw, np.empty(2 * (n_components - 1), np.int32)])
    anchor: dict[int, int] = {}  # isolated vertex -> a tether dart there

    def attach(owner: int, dart: int) -> None:
        """Put a new dart into the corner after `dart`, or at the owner's isolated vertex."""
        nonlocal size
        new, size = size, size + 1
        at = int(tails[dart] if dart >= 0 else vertex[owner])
        before = dart if dart >= 0 else anchor.get(at, -1)
        tails[new] = at
        if before < 0:
            after[new] = new
        else:
            after[new] = after[before]
            after[before] = new
        if dart < 0:
            anchor[at] = new

    for guest in range(n_components):
        if guest == root:
            continue
        attach(guest, int(outer[guest]))
        host = int(hosts[guest])
        if host >= 0:
            attach(int(component[tails[host]]), host)
        else:
            attach(root, int(outer[root]))
    return tails, after


def _hosts(
    xy: NDArray[np.float64],
    component: NDArray[np.int32],
    n_components: int,
    piece: NDArray[np.float64],
    piece_edge: NDArray[np.int32],
    piece_component: NDArray[np.int32],
) -> NDArray[np.int64]:
    """Per component a dart with the host face on its left, -1 where no other component lies west."""
    if not len(piece):
        return np.full(n_components, -1, np.int64)
    corners = ((xy, component), (piece[:, :2], piece_component), (piece[:, 2:], piece_component))
    looks = np.full((n_components, 2), np.inf)
    for points, owner in corners:
        np.minimum.at(looks[:, 0], owner, points[:, 0])
    for points, owner in corners:
        west = points[:, 0] == looks[owner, 0]
        np.minimum.at(looks[:, 1], owner[west], points[west, 1])
    low, high = np.minimum(piece[:, 1], piece[:, 3]), np.maximum(piece[:, 1], piece[:, 3])
    bottom, height = float(low.min()), float(high.max() - low.min())
    spread = float((high - low).sum())
    rows = 1
    if height > 0 and spread > 0:
        rows = max(1, int(min(np.sqrt(len(piece)), 4 * len(piece) * height / spread)))
    scale = rows / height if height > 0 else 0.0
    work = len(piece) * 4 + n_components * (len(piece) // rows + 1)
    found = look_west.for_work(work)(looks, piece, piece_component, bottom, scale, rows)
    up = piece[found, 3] > piece[found, 1]
    dart = 2 * piece_edge[found].astype(np.int64) + up
    dart[found < 0] = -1
    return np.asarray(dart, dtype=np.int64)


@kernel
def look_west(looks, piece, piece_component, bottom, scale, rows):  # type: ignore[no-untyped-def]
    """For component c looking west from looks[c], the number of the nearest piece of another component, or -1.

    A look runs a hair above its height, so a piece counts when low <= y < high and level pieces never do; of two pieces
    that meet on the look the one further east just above it is the nearer.
    """
    count = np.zeros(rows + 1, np.int64)
    n = piece.shape[0]
    for s in range(n):
        a = min(piece[s, 1], piece[s, 3])
        b = max(piece[s, 1], piece[s, 3])
        for r in range(int(min((a - bottom) * scale, rows - 1)), int(min((b - bottom) * scale, rows - 1)) + 1):
            count[r + 1] += 1
    for r in range(rows):
        count[r + 1] += count[r]
    fill = count[:-1].copy()
    inside = np.empty(count[rows], np.int32)
    for s in range(n):
        a = min(piece[s, 1], piece[s, 3])
        b = max(piece[s, 1], piece[s, 3])
        for r in range(int(min((a - bottom) * scale, rows - 1)), int(min((b - bottom) * scale, rows - 1)) + 1):
            inside[fill[r]] = s
            fill[r] += 1
    found = np.full(looks.shape[0], -1, np.int64)
    for c in range(looks.shape[0]):
        x = looks[c, 0]
        y = looks[c, 1]
        row = int(np.floor((y - bottom) * scale))
        if row < 0 or row > rows:
            continue
        row = min(row, rows - 1)
        best = -np.inf
        slope = 0.0
        for i in range(count[row], count[row + 1]):
            s = inside[i]
            if piece_component[s] == c:
                continue
            x0 = piece[s, 0]
            y0 = piece[s, 1]
            x1 = piece[s, 2]
            y1 = piece[s, 3]
            if not (min(y0, y1) <= y < max(y0, y1)):
                continue
            lean = (x1 - x0) / (y1 - y0)
            at = x0 + (y - y0) * lean
            if y == y1:
                at = x1
            if at < x and (at > best or (at == best and lean > slope)):
                best = at
                slope = lean
                found[c] = s
    return found
