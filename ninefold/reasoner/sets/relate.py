"""``relate(X, Y)``: the exact nine-intersection of two sets of one map, from their stars.

Relations are local. At a vertex that both sets touch, their two stars are laid over each other: each sector and each dart is
inside, on the boundary or outside of either set, and every pair of answers found is one non-empty cell of the matrix.

Why that is enough, for two regions: take the graph G of both boundaries. A connected part of one boundary that touches the
other at all has its status (inside or outside the other set) constant between touching vertices, and the star at such a
vertex shows that status beside both of its own sides. A part that touches nowhere needs one question, "is this face in that
region", which the containment index answers with one binary search; the answer gives the bits on both its sides. Every face
of G lies beside some edge of G, so no cell is missed. Lines work the same with darts for sectors, but their ends are not
local: each end off the region's boundary asks its own question.

The bulk forms in `ninefold.reasoner.sets.bulk` do the same with 64-bit words; the tests hold the two equal.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ninefold._wording import quoted
from ninefold.errors import BadInput
from ninefold.mapping.numbering import Face
from ninefold.mapping.sets import Line, Point, Region, same_map

from .relation import BB, BE, BI, CURVE, EB, EE, EI, IB, IE, II, X_SHIFT, Y_SHIFT, Relation, converse_code

if TYPE_CHECKING:
    from ninefold.mapping.sets import Set

__all__ = ["relate", "relate_code"]


def relate(x: Set, y: Set) -> Relation:
    """Return how X lies to Y.

    Parameters
    ----------
    x, y
        Points, lines or regions of one map.

    Returns
    -------
    Relation
        Exact; ``.de9im`` equals what ``shapely.relate`` gives on any drawing of the map.

    Raises
    ------
    DifferentMaps
        If the sets belong to two maps.

    Notes
    -----
    Complexity O(shared vertices) once the stars are made (O(length) each, kept with the set), plus O(log length) for each
    part that touches nothing.

    Examples
    --------
    >>> from ninefold.mapping import PlaneMap
    >>> from ninefold.reasoner import relate
    >>> plane = PlaneMap.from_geometry(
    ...     [(0, 0), (4, 0), (4, 4), (0, 4), (1, 1), (2, 1), (2, 2)],
    ...     [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 4), (0, 4)])
    >>> house, room = plane.cycle([0, 1, 2, 3]), plane.cycle([4, 5, 6])
    >>> relate(room, house), relate(plane.edge(0, 4), house)
    (Relation(inside, 2FF1FF212), Relation(coveredBy, 1FF00F212))
    """
    for given in (x, y):
        if not isinstance(given, Point | Line | Region):
            raise BadInput(f"relate takes points, lines and regions of a map, not {quoted(given)}")
    same_map(x, y)
    return Relation(relate_code(x, y))


def relate_code(x: Set, y: Set) -> int:
    """Return the code of the relation; the two sets must be of one map."""
    if x.dimension > y.dimension:
        return converse_code(relate_code(y, x))
    match x, y:
        case Point(), Point():
            bits = II if x.index == y.index else IE | EI
        case Point(), Line():
            bits = _point_line(x, y)
        case Point(), Region():
            bits = _point_region(x, y)
        case Line(), Line():
            bits = _line_line(x, y)
        case Line(), Region():
            bits = _line_region(x, y)
        case Region(), Region():
            bits = _region_region(x, y)
        case _:
            raise TypeError(f"relate takes points, lines and regions, not {type(x).__name__} and {type(y).__name__}")
    return bits | EE | x.dimension << X_SHIFT | y.dimension << Y_SHIFT


def _point_line(x: Point, y: Line) -> int:
    at = x.index
    others = EB if len(y.boundary) > (at in y.boundary) else 0
    if at not in y.star:
        return IE | EI | others
    return (IB if at in y.boundary else II) | EI | others


def _point_region(x: Point, y: Region) -> int:
    if x.index in y.star:
        return IB | EI | EB
    return (II if _holds(y, x.index) else IE) | EI | EB


def _holds(region: Region, vertex: int) -> bool:
    """Say whether a vertex off the region's boundary lies in it."""
    plane = region.plane
    dart = int(plane.first_dart[vertex])
    return dart >= 0 and region.has_face(Face(int(plane.face_of[dart])))


def _line_line(x: Line, y: Line) -> int:
    shared = len(x.edge_set & y.edge_set)
    bits = II | CURVE if shared else 0
    if shared < len(x.edges):
        bits |= IE
    if shared < len(y.edges):
        bits |= EI
    mine, its = x.boundary, y.boundary
    for v in x.star.keys() & y.star.keys():
        bits |= (BB if v in its else BI) if v in mine else (IB if v in its else II)
    if not mine <= y.star.keys():
        bits |= BE
    if not its <= x.star.keys():
        bits |= EB
    return bits


def _line_region(x: Line, y: Region) -> int:
    mine, its = x.star, y.star
    shared = mine.keys() & its.keys()
    ends = x.boundary
    bits = EI
    for v in shared:
        darts, (sectors, curve) = mine[v], its[v]
        bits |= BB if v in ends else IB
        if darts & curve:
            bits |= IB | CURVE
        if darts & sectors & ~curve:
            bits |= II
        if darts & ~sectors & ~curve:
            bits |= IE
        if curve & ~darts:
            bits |= EB
    for v in ends - shared:
        bits |= BI if _holds(y, v) else BE
    if not bits & II or not bits & IE:
        for piece in x.pieces:
            if piece.isdisjoint(shared):
                bits |= II if _holds(y, next(iter(piece))) else IE
    if not bits & EB and any(rim.isdisjoint(shared) for rim in y.rims):
        bits |= EB
    return bits


def _region_region(x: Region, y: Region) -> int:
    mine, its = x.star, y.star
    shared = mine.keys() & its.keys()
    bits = 0
    for v in shared:
        (in_x, on_x), (in_y, on_y) = mine[v], its[v]
        if in_x & in_y:
            bits |= II
        if in_x & ~in_y:
            bits |= IE
        if in_y & ~in_x:
            bits |= EI
        if on_x & on_y:
            bits |= CURVE
        only = on_x & ~on_y
        if only & in_y:
            bits |= BI
        if only & ~in_y:
            bits |= BE
        only = on_y & ~on_x
        if only & in_x:
            bits |= IB
        if only & ~in_x:
            bits |= EB
    if shared:
        bits |= BB
    if len(x.rims) > 1 or not shared:
        for rim, dart in zip(x.rims, x.rim_darts, strict=True):
            if rim.isdisjoint(shared):
                inside = y.has_face(Face(int(x.plane.face_of[dart])))
                bits |= II | BI | EI if inside else IE | BE
    if len(y.rims) > 1 or not shared:
        for rim, dart in zip(y.rims, y.rim_darts, strict=True):
            if rim.isdisjoint(shared):
                inside = x.has_face(Face(int(x.plane.face_of[dart])))
                bits |= II | IB | IE if inside else EI | EB
    return bits
