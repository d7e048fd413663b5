"""Slow and obviously right: orbits by sympy, relations by enumerating every cell of the map."""

from __future__ import annotations

from sympy.combinatorics import Permutation

from ninefold.mapping import Line, PlaneMap, Point, Region
from ninefold.mapping.sets import Set


def faces_by_sympy(next_ccw: list[int]) -> set[frozenset[int]]:
    """Orbits of d -> previous-ccw(twin d)."""
    twin = Permutation([d ^ 1 for d in range(len(next_ccw))])
    previous = Permutation(next_ccw) ** -1
    walk = Permutation([previous(twin(d)) for d in range(len(next_ccw))])
    return {frozenset(cycle) for cycle in walk.full_cyclic_form}


def cells(x: Set) -> tuple[set, set]:
    """Interior and boundary of a set as sets of cells ("v", i), ("e", i), ("f", i)."""
    plane = x.plane
    if isinstance(x, Point):
        return {("v", x.index)}, set()
    if isinstance(x, Line):
        degree: dict[int, int] = {}
        for e in x.edges:
            for d in (2 * e, 2 * e + 1):
                degree[int(plane.tail[d])] = degree.get(int(plane.tail[d]), 0) + 1
        boundary = {("v", v) for v, k in degree.items() if k % 2}
        return {("e", e) for e in x.edges} | {("v", v) for v in degree} - boundary, boundary
    assert isinstance(x, Region)
    faces = set(x.faces)
    interior, boundary = {("f", f) for f in faces}, set()
    for e in range(plane.tail.size // 2):
        sides = [int(plane.face_of[d]) in faces for d in (2 * e, 2 * e + 1)]
        if all(sides):
            interior.add(("e", e))
        elif any(sides):
            boundary.add(("e", e))
    for v in range(plane.n_vertices):
        around = [int(plane.face_of[d]) in faces for d in plane.darts_at(v)]
        if around and all(around):
            interior.add(("v", v))
        elif any(around):
            boundary.add(("v", v))
    return interior, boundary


def every_cell(plane: PlaneMap) -> set:
    """All cells of a map; tethers are part of the faces they cross, so their cells stand for faces."""
    return (
        {("v", v) for v in range(plane.n_vertices)}
        | {("e", e) for e in range(plane.tail.size // 2)}
        | {("f", f) for f in range(plane.n_faces)}
    )


def de9im(x: Set, y: Set) -> str:
    """The DE-9IM string by intersecting sets of cells."""
    rows = []
    everything = every_cell(x.plane)
    for s in (x, y):
        interior, boundary = cells(s)
        rows.append((interior, boundary, everything - interior - boundary))
    dimension = {"v": 0, "e": 1, "f": 2}
    text = ""
    for a in rows[0]:
        for b in rows[1]:
            common = a & b
            text += str(max(dimension[kind] for kind, _ in common)) if common else "F"
    return text
