"""Splitting a region along a path into what lies on its left and on its right."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

if TYPE_CHECKING:
    from .sets import Line, Region

__all__ = ["faces_beside"]


def faces_beside(region: Region, path: Line) -> tuple[list[int], list[int]]:
    """Return the faces of a region on the left and on the right of a path of the same map.

    Faces of the region are joined across every edge that is neither on the path nor on the boundary; the left part holds
    the joined groups that touch the path from the left. Parts of the region that the path does not enter belong to
    neither.

    Raises
    ------
    BadInput
        If the line has no direction (make it with `PlaneMap.path`), or the path does not split the region: some face is on
        both sides, or one side has none.

    Notes
    -----
    Complexity O(E).
    """
    plane = region.plane
    if path.darts is None:
        raise BadInput(f"{quoted(path)} has no direction, so no left and right; make it with plane.path([...])")
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    inside = np.zeros(plane.n_faces, np.bool_)
    inside[list(region.faces)] = True
    left, right = plane.face_of[0::2], plane.face_of[1::2]
    open_edge = inside[left] & inside[right]
    open_edge[list(path.edge_set)] = False
    links = coo_array(
        (np.ones(int(open_edge.sum()), np.int8), (left[open_edge], right[open_edge])),
        shape=(plane.n_faces, plane.n_faces),
    )
    _, group = connected_components(links, directed=False)
    darts = np.array(path.darts, np.int64)
    on_left, on_right = (np.unique(group[side[inside[side]]]) for side in (plane.face_of[darts], plane.face_of[darts ^ 1]))
    if not (on_left.size and on_right.size) or np.intersect1d(on_left, on_right).size:
        raise BadInput(f"{quoted(path)} does not split {quoted(region)}: it must run through it from boundary to boundary")
    of_left, of_right = (np.flatnonzero(inside & np.isin(group, chosen)).tolist() for chosen in (on_left, on_right))
    return of_left, of_right
