"""The compass drawing: a map drawn as the place looks, from headings alone."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold.errors import BadInput

from ..drawing import Drawing
from ..planarity import drawing_problems
from ..shaping.picture import plane_picture
from ..shaping.pieces import pieces_of, spread
from ..shaping.untangle import polish
from .tutte import tutte

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ninefold.mapping import PlaneMap

    from ..shaping.pieces import Pieces

__all__ = ["compass"]

_ATTEMPTS = 6


def compass(plane: PlaneMap, *, chords: ArrayLike | None = None) -> Drawing:
    if plane.heading is None or plane.turn is None:
        raise BadInput("a compass drawing needs headings")
    pieces = spread(pieces_of(plane, chords=None if chords is None else np.asarray(chords, np.float64)))
    if pieces.n_vertices < 3:
        return tutte(plane)
    found = plane_picture(pieces)
    if found is None:
        return replace(tutte(plane), notes=("untangling failed",))
    mesh = polish(found[0], pieces, found[1])
    points = mesh.points[: mesh.n]
    drawing = Drawing.from_points(
        plane, points[: plane.n_vertices], points[plane.n_vertices :], pieces.simple.bend_start, layout="compass"
    )
    problems = drawing_problems(drawing)
    if problems:
        return replace(tutte(plane), notes=(f"problems {problems}",))
    return drawing
