"""The relaxed drawing: the same map with wider angles and lengths that are more alike; headings are not needed.

The directions of a given drawing are opened, so that no two edges leave a vertex at a narrow angle, and then taken for
headings: `ninefold.layout.shaping` finds the plane picture that they fix, in which dead ends that were squeezed into a
corner are as long as others. From there every step makes lengths more alike and triangles better, and folds nothing.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput
from ninefold.mapping import PlaneMap

from ..drawing import Drawing
from ..planarity import drawing_problems
from ..shaping.energy import EvenLengths, damped, newton_step
from ..shaping.mesh import Mesh
from ..shaping.picture import plane_picture
from ..shaping.pieces import pieces_of, spread

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..shaping.pieces import Pieces

__all__ = ["relax"]

LEAST_ANGLE = np.radians(20)
"""Angle to which the directions of the given drawing are opened; less where many edges meet."""

LARGEST = 100_000
"""Vertices, bends included, above which a drawing is given back as it is."""

_ROUNDS, _MOST_ROUNDS, _CUT_EVERY = 20, 60, 3
_UNEVEN = 30.0
_SHAPE = 0.5


def relax(drawing: Drawing) -> Drawing:
    """Return a drawing of the same map that is easier to read.

    Parameters
    ----------
    drawing
        Any plane drawing of the map; rotation and outer face are kept.

    Returns
    -------
    Drawing
        With ``layout == "relaxed"``; the given drawing with a note where no better one that is plane was found.

    Notes
    -----
    Complexity: about a hundred sparse factorisations, each about O(V^1.5).

    Examples
    --------
    >>> from ninefold.io import samples
    >>> from ninefold.layout import relax, tutte
    >>> relax(tutte(samples.load("house").to_map())).layout
    'relaxed'
    """
    _require_drawing(drawing)
    plane = drawing.plane
    pieces = pieces_of(plane)
    if pieces.n_vertices < 3:
        return replace(drawing, layout="relaxed")
    if pieces.n_vertices > LARGEST:
        return _unchanged(drawing, f"{pieces.n_vertices:,} vertices are too many to relax")
    if len(drawing.bends) != pieces.n_vertices - plane.n_vertices:
        return _unchanged(drawing, "its edges have bends of their own")
    given = np.concatenate([drawing.points, drawing.bends]).astype(np.float64)
    found = plane_picture(_opened(pieces, given))
    mesh = _as_given(pieces, given) if found is None else found[0]
    if mesh.bad().any():
        return _unchanged(drawing, "no plane picture was found on the way")
    points = _evened(mesh, pieces)
    relaxed = Drawing.from_points(
        plane, points[: plane.n_vertices], points[plane.n_vertices :], pieces.simple.bend_start, layout="relaxed"
    )
    problems = drawing_problems(relaxed)
    return _unchanged(drawing, f"the relaxed one is too fine for floating point ({problems[0]})") if problems else relaxed


def _unchanged(drawing: Drawing, why: str) -> Drawing:
    return replace(drawing, notes=(*drawing.notes, f"not relaxed: {why}"))


def _as_given(pieces: Pieces, points: NDArray[np.float64]) -> Mesh:
    """Return the given drawing cut into triangles, the median length 1."""
    step = (points[pieces.head] - points[pieces.tail])[pieces.real]
    typical = float(np.median(np.hypot(*step.T))) if len(step) else 1.0
    return Mesh(pieces, points / (typical or 1.0))


def _opened(pieces: Pieces, points: NDArray[np.float64]) -> Pieces:
    """Return the pieces with the directions of a picture for headings, opened to a least angle."""
    step = points[pieces.head] - points[pieces.tail]
    chord = np.arctan2(step[:, 1], step[:, 0])
    leaving = np.stack([chord, chord + np.pi], axis=1).ravel()
    return spread(replace(pieces, chord=chord, leaving=leaving, measured=pieces.real), least=LEAST_ANGLE)


def _evened(mesh: Mesh, pieces: Pieces) -> NDArray[np.float64]:
    """Return the points after steps that make lengths alike and fold nothing."""
    pull = EvenLengths(pieces)
    free = np.arange(len(mesh.points)) < mesh.n
    for k in range(_MOST_ROUNDS):
        if k >= _ROUNDS and _unevenness(mesh, pieces) <= _UNEVEN:
            break
        step = newton_step(mesh, pieces, pull, free, shape=_SHAPE, fold=1e-12, ridge=1e-4)
        if step is None:
            break
        mesh.points = damped(mesh, step, keep=0.05)
        mesh.flip()
        if k % _CUT_EVERY == _CUT_EVERY - 1:
            again = Mesh(pieces, mesh.points[: mesh.n])
            if not again.bad().any():
                mesh = again
    return mesh.points[: mesh.n]


def _unevenness(mesh: Mesh, pieces: Pieces) -> float:
    """Return the longest piece's length over the shortest's."""
    step = (mesh.points[pieces.head] - mesh.points[pieces.tail])[pieces.real]
    length = np.hypot(*step.T)
    return float(length.max() / max(length.min(), 1e-300)) if length.size else 1.0


def _require_drawing(given: object) -> None:
    if isinstance(given, PlaneMap):
        raise BadInput("relax takes a drawing of a map: relax(tutte(plane)), or draw(plane, layout='relaxed')")
    if not isinstance(given, Drawing):
        raise BadInput(f"relax takes a Drawing, not {quoted(given)}; draw(plane) makes one")
