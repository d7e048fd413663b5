"""How much a drawing looks like the place, in two figures.

`heading_errors` needs the map alone: does every edge run as its leg was headed? `misplacement` needs the true geometry: how
far are the vertices from their places, once the drawing is moved and scaled as fits best?
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold.errors import BadInput, DifferentMaps

from .shaping.pieces import wrapped

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .drawing import Drawing

__all__ = ["heading_errors", "misplacement"]


def heading_errors(drawing: Drawing) -> NDArray[np.float64]:
    """Return by how much each edge's direction from end to end differs from what its leg's headings say, (E,) radians.

    A leg is expected to be straight or evenly curved: half its turn to the left of its first heading. NaN for loops and
    tethers, which have no such direction.

    Raises
    ------
    BadInput
        For a drawing of a map without headings.

    Examples
    --------
    >>> from ninefold.io import samples
    >>> from ninefold.layout import compass, heading_errors
    >>> bool(abs(heading_errors(compass(samples.load("office").to_map()))).max() < 1e-6)
    True
    """
    plane = drawing.plane
    if plane.heading is None or plane.turn is None:
        raise BadInput("the map has no headings to compare its drawing with; make it from a walk or from geometry")
    tail, head = plane.tail[0::2], plane.tail[1::2]
    step = (drawing.points[head] - drawing.points[tail]).astype(np.float64)
    said = plane.heading[0::2] + plane.turn / 2
    off = wrapped(np.arctan2(step[:, 1], step[:, 0]) - said)
    return np.asarray(np.where(plane.tether | (tail == head), np.nan, off))


def misplacement(drawing: Drawing, ground: Drawing, *, turned: bool = False) -> float:
    """Return the root mean square distance of the vertices to their true places, as a share of the ground's diameter.

    The drawing is moved and scaled as fits best. It is not turned, for a compass knows north.

    Parameters
    ----------
    drawing, ground
        Drawings of one map; `ninefold.layout.TrueShapes.drawing` makes one of true geometry.
    turned
        Whether to turn the drawing, too, as fits best: for a layout that knows no north.

    Raises
    ------
    DifferentMaps, BadInput
        For drawings of two maps; a ground without extent.

    Notes
    -----
    The diameter is the diagonal of the bounding box of the ground's vertices.

    Examples
    --------
    >>> from ninefold.io import samples
    >>> from ninefold.layout import TrueShapes, compass, misplacement, tutte
    >>> office = samples.load("office")
    >>> plane = office.to_map()
    >>> ground = TrueShapes(office).drawing(plane)
    >>> misplacement(compass(plane), ground) < misplacement(tutte(plane), ground, turned=True)
    True
    """
    if drawing.plane is not ground.plane and drawing.plane != ground.plane:
        raise DifferentMaps(f"{drawing!r} and {ground!r} draw two maps; compare drawings of one")
    diameter = float(np.hypot(*np.ptp(ground.points, axis=0)))
    if not diameter:
        raise BadInput("the ground has no extent, so nothing can be compared with it")
    drawn, true = ((xy - xy.mean(axis=0)) @ (1, 1j) for xy in (drawing.points, ground.points))
    # the best factor of the drawing as complex numbers, a real one if it is not to be turned
    fit = np.vdot(drawn, true)
    size = float(np.vdot(drawn, drawn).real)
    factor = (fit if turned else max(fit.real, 0.0)) / size if size else 0.0
    return float(np.sqrt(np.mean(np.abs(factor * drawn - true) ** 2))) / diameter
