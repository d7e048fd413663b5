"""The compass drawing: a map drawn as the place looks, from headings alone.

Nobody told the robot a distance, and it needs none. Directions fix the shape of whatever is braced (a triangle, but not
a rectangle, see `ninefold.mapping.rigidity`), and what they leave open is drawn with lengths as even as they let it be.
The steps are those of `ninefold.layout.shaping`: the shape that the headings fix, parts that hang by one vertex turned
into their place and shrunk where they are in the way, then the picture untangled until it is plane and has the map's
own rotation and outer face.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ninefold.errors import BadInput

from ..arguments import require_map
from ..drawing import Drawing
from ..planarity import drawing_problems
from ..shaping.curves import curved as with_curves
from ..shaping.picture import plane_picture
from ..shaping.pieces import pieces_of, spread
from ..shaping.untangle import polish
from .tutte import tutte

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from ninefold.mapping import PlaneMap

__all__ = ["compass"]

MOST_VERTICES = 100_000
"""Vertices, bends included, above which no compass drawing is tried."""


def compass(plane: PlaneMap, *, chords: ArrayLike | None = None, curved: bool = False) -> Drawing:
    """Draw a map from its headings: north is up, and what is braced has its true proportions.

    Parameters
    ----------
    plane
        A map with headings: from a walk, or from geometry.
    chords
        (E,) radians: the direction from the tail of dart 2e to its head, for every edge, instead of the one that the map's
        headings and turns give. For headings that are known better, or worse, than the map's rotation.
    curved
        Draw every leg as a curve that leaves and arrives at its measured headings and turns by its measured rotation, as far
        as the drawing stays plane. Loops and parallel edges are smooth in any case.

    Returns
    -------
    Drawing
        With float64 coordinates, lengths near 1 (or in proportion to the lengths measured, where the map has any). It
        is checked: no crossing, the map's rotation, outer face and hosts. Where no such picture was found, the Tutte
        drawing, and a note.

    Raises
    ------
    BadInput
        A map without headings.

    Notes
    -----
    Deterministic. Complexity: some tens of sparse factorisations, about O(V^1.5) each, and the check.

    Examples
    --------
    >>> from ninefold.io import samples
    >>> from ninefold.layout import compass
    >>> office = samples.load("office").to_map()
    >>> compass(office)
    Drawing(compass, PlaneMap(10 vertices, 11 edges, 3 faces))
    """
    require_map(plane, "compass")
    if plane.heading is None or plane.turn is None:
        raise BadInput("the map has no headings, so it has no compass drawing; the layouts relaxed and tutte need none")
    pieces = spread(pieces_of(plane, chords=_checked(plane, chords), metres=plane.metres))
    if pieces.n_vertices < 2:
        return Drawing.from_points(plane, np.zeros((1, 2)), layout="compass")
    if pieces.n_vertices > MOST_VERTICES:
        return _fallen_back(plane, f"{pieces.n_vertices:,} vertices are too many for a compass drawing")
    found = plane_picture(pieces, faithful=True)
    if found is None:
        return _fallen_back(plane, "no plane picture with these headings was found")
    mesh = polish(found[0], pieces, found[1])
    points = mesh.points[: mesh.n]
    drawing = Drawing.from_points(
        plane, points[: plane.n_vertices], points[plane.n_vertices :], pieces.simple.bend_start, layout="compass"
    )
    problems = drawing_problems(drawing)
    if problems:
        return _fallen_back(plane, f"the compass drawing is too fine for floating point ({problems[0]})")
    return with_curves(drawing, pieces, everything=curved)


def _checked(plane: PlaneMap, chords: ArrayLike | None) -> NDArray[np.float64] | None:
    if chords is None:
        return None
    given = np.array(chords, np.float64)
    if given.shape != (plane.tether.size,) or not np.isfinite(given[~plane.tether]).all():
        raise BadInput(f"chords are one finite angle in radians for each of {plane.tether.size} edges, not {given.shape}")
    return given


def _fallen_back(plane: PlaneMap, why: str) -> Drawing:
    drawing = tutte(plane)
    return replace(drawing, notes=(f"{why}; this is the {drawing.layout.title()} drawing", *drawing.notes))
