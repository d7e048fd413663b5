"""From a picture that may cross itself to one that is plane, and back towards what it was as far as it stays plane.

The rounds of `untangle` look at the triangles that are flat or folded, let the points around them move, and take a step
that makes the energy less and folds nothing that is right. Diagonals are flipped in every round; every few rounds the faces
are cut afresh from the picture as it has become, since those cut from a tangled one can be in the way.

Where that gets stuck, `mend` forgets the picture around what is folded, sets each point there amid its neighbours in
the mesh (which folds nothing inside a convex surrounding, and little inside another), and untangles again; around more
and more, in the end everywhere but the frame, which is convex.

References
----------
W. T. Tutte, How to draw a graph, 1963. M. S. Floater, One-to-one piecewise linear mappings over triangulations, 2003.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .directions import heading_errors
from .energy import KeepPicture, damped, newton_step
from .equations import System, scattered
from .mesh import Mesh

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .energy import Pull
    from .pieces import Pieces

__all__ = ["mend", "polish", "untangle"]

_RINGS, _GROW_EVERY, _CUT_EVERY = 3, 12, 6
_LONGEST_STEP = 2.0
_CAP = np.radians(30)
_PATCHES = (2, 3, 4, 6, 8, 12, 16, 24, 40, 80)
_MENDING_ROUNDS = 16


def untangle(
    mesh: Mesh,
    pieces: Pieces,
    pull: Pull,
    *,
    rounds: int,
    shape: float,
    rest: NDArray[np.float64] | None = None,
) -> Mesh:
    """Return a mesh of the same map with fewer triangles flat or folded; with none, if all goes well.

    Parameters
    ----------
    pull
        What the pieces are drawn to meanwhile.
    shape
        Weight of the triangles' shape.
    rest
        (n, 2) points: triangles that are thin there may stay thin.
    """
    rings = _RINGS
    for k in range(rounds):
        mesh.flip()
        bad = mesh.bad()
        if not bad.any():
            return mesh
        if k and k % _GROW_EVERY == 0:
            rings += 2
        if k and k % _CUT_EVERY == 0:
            again = Mesh(pieces, mesh.points[: mesh.n])
            if np.count_nonzero(again.bad()) <= np.count_nonzero(bad) + 5:
                mesh = again
            bad = mesh.bad()
            if not bad.any():
                return mesh
        free = mesh.near(np.unique(mesh.triangles[bad]), rings)
        at_rest = None if rest is None else np.concatenate([rest, mesh.points[mesh.n :]])
        fold = max(1e-2 * 0.8**k, 1e-4)
        step = newton_step(mesh, pieces, pull, free, shape=shape, rest=at_rest, fold=fold)
        if step is None:
            return mesh
        step *= np.minimum(1.0, _LONGEST_STEP / np.maximum(np.hypot(*step.T), 1e-9))[:, None]
        mesh.points = damped(mesh, step, keep=0.1)
    mesh.flip()
    return mesh


def mend(mesh: Mesh, pieces: Pieces, pull: Pull, *, shape: float) -> Mesh:
    """Return a mesh in which what is folded was set anew amid its surroundings and untangled, as little as it takes."""
    everywhere = np.arange(len(mesh.points)) < mesh.n
    for rings in (*_PATCHES, None):
        bad = mesh.bad()
        if not bad.any():
            break
        free = everywhere if rings is None else mesh.near(np.unique(mesh.triangles[bad]), rings)
        if not free.any():
            continue
        trial = mesh.copy()
        trial.points = _amid_neighbours(mesh, free)
        trial = untangle(trial, pieces, pull, rounds=_MENDING_ROUNDS, shape=shape)
        if np.count_nonzero(trial.bad()) < np.count_nonzero(bad):
            mesh = trial
    return mesh


def _amid_neighbours(mesh: Mesh, free: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Return the points with every free one at the mean of its neighbours in the mesh, the others as they are."""
    t = mesh.triangles
    sides = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    sides = np.unique(sides[free[sides].any(axis=1)], axis=0)
    u, v = sides[:, 0], sides[:, 1]
    system = System(free)
    system.add_differences(u, v, np.broadcast_to(np.eye(2), (len(sides), 2, 2)))
    points = np.where(free[:, None], 0.0, mesh.points)
    pulled = scattered(len(points), np.concatenate([u, v]), np.concatenate([points[v], points[u]]))
    found = system.solve(pulled, ridge=0.0)
    return mesh.points if found is None else np.where(free[:, None], found, mesh.points)


def polish(
    mesh: Mesh,
    pieces: Pieces,
    rest: NDArray[np.float64],
    *,
    rounds: int = 8,
    shape: tuple[float, float] = (0.02, 2e-4),
    worst: float = np.radians(2),
) -> Mesh:
    """Return the plane mesh brought back towards the picture `rest`, with an ever weaker hold on the triangles' shape.

    Only the points around pieces that miss their chords by more than `worst` move. The best picture seen is returned.
    """
    pull = KeepPicture(pieces, rest)
    at_rest = np.concatenate([rest, mesh.points[mesh.n :]])
    best, least = mesh.copy(), _score(mesh, pieces)
    for k in range(rounds):
        missed = np.flatnonzero(np.abs(heading_errors(pieces, mesh.points)) > worst)
        free = mesh.near(np.concatenate([pieces.tail[missed], pieces.head[missed]]), _RINGS)
        if not free.any():
            break
        weight = shape[0] * (shape[1] / shape[0]) ** (k / max(rounds - 1, 1))
        step = newton_step(mesh, pieces, pull, free, shape=weight, rest=at_rest)
        if step is None:
            break
        mesh.points = damped(mesh, step, keep=0.3)
        mesh.flip()
        score = _score(mesh, pieces)
        if score < least:
            best, least = mesh.copy(), score
    return best


def _score(mesh: Mesh, pieces: Pieces) -> float:
    """Return the mean angle by which pieces miss their chords, each counted up to a cap."""
    errors = np.abs(heading_errors(pieces, mesh.points))[pieces.measured]
    return float(np.minimum(errors, _CAP).mean()) if errors.size else 0.0
