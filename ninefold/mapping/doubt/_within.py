"""Which places of a map are inside a set, for all of them at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

from ..sets import Line, Point, Region, same_map

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..plane import PlaneMap
    from ..sets import Set

__all__ = ["places_in"]


def places_in(plane: PlaneMap, item: Set, *, closed: bool) -> NDArray[np.bool_]:
    """Say of each place of the map whether it is inside a set, (V,).

    Parameters
    ----------
    closed
        Whether places on the set's boundary count.

    Raises
    ------
    BadInput, DifferentMaps
        For what is no set, or one of another map.

    Notes
    -----
    Complexity O(E log size of the set).
    """
    if not isinstance(item, Point | Line | Region):
        raise BadInput(f"a point, line or region of the map is needed, not {quoted(item)}; plane.parse makes one of text")
    same_map(plane.vertex(plane.vertex_names[0]), item)
    within = np.zeros(plane.n_vertices, np.bool_)
    match item:
        case Point():
            within[item.index] = True
        case Line():
            edges = np.array(item.edges, np.int64)
            within[plane.tail[np.concatenate([2 * edges, 2 * edges + 1])]] = True
            if not closed:
                within[list(item.boundary)] = False
        case Region():
            number = plane.containment.preorder[plane.face_of]
            on_left = np.searchsorted(item.ends, number, side="right") % 2
            faces = np.bincount(plane.tail, weights=on_left, minlength=plane.n_vertices)
            within = faces > 0 if closed else (faces == plane.spokes) & (faces > 0)
    return within
