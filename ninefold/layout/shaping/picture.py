"""From wanted directions to a plane picture: the shape they fix, then hung parts settled and shrunk, then untangled."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .directions import LEGIBLE, shape_of_directions
from .energy import KeepPicture
from .hung import HungBlocks
from .mesh import Mesh
from .untangle import mend, untangle

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .pieces import Pieces

__all__ = ["plane_picture"]

_ATTEMPTS, _ROUNDS, _SHAPE = 4, 30, 0.1
_LAST_ROUNDS, _TRUE = 5, LEGIBLE._replace(even=0.0)
"""How often, and with what lengths, the shape is fitted once more where measured proportions have the last word."""


def plane_picture(pieces: Pieces, *, faithful: bool = False) -> tuple[Mesh, NDArray[np.float64]] | None:
    """Return a mesh in which every triangle is the right way round, and the (n, 2) picture that it was made of.

    Parameters
    ----------
    pieces
        With chords that obey the map's rotation; see `ninefold.layout.shaping.pieces.spread`.
    faithful
        Let the directions have the last word on lengths: where they fix proportions, these are then the measured ones.
        Otherwise all lengths are drawn together a little.

    Returns
    -------
    The mesh, whose points draw the map plane and with its own rotation and outer face as far as floating point tells,
    and the shape that the directions alone gave; None where no such picture was found.

    Notes
    -----
    Complexity: some tens of sparse factorisations, about O(V^1.5) each; those after the first few of the tangled parts only.
    """
    fitted = shape_of_directions(pieces)
    if faithful:
        fitted = shape_of_directions(pieces, start=fitted, rounds=_LAST_ROUNDS, lengths=_TRUE)
    hung = HungBlocks(pieces, fitted)
    hung.settle()
    for _ in range(_ATTEMPTS):
        shape = hung.shrink()
        keep = KeepPicture(pieces, shape)
        mesh = untangle(Mesh(pieces, shape), pieces, keep, rounds=_ROUNDS, shape=_SHAPE, rest=shape)
        mesh = mend(mesh, pieces, keep, shape=_SHAPE)
        bad = mesh.bad()
        if not bad.any():
            return mesh, shape
        vertices = np.unique(mesh.triangles[bad])
        hung.shrink_at(vertices[vertices < mesh.n])
    return None
