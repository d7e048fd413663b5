"""What every constructor checks before a plane map exists: rotation, connection, Euler, turning numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput, NotPlane
from ninefold.immutable import Immutable

from . import _orbits
from .genus import offending_part
from .heading import TAU
from .turning import corner_angles, face_turns, settle_turns

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .names import Names

__all__ = [
    "Derived",
    "Walks",
    "component_walks",
    "components_without_tethers",
    "derive",
    "face_labels",
    "face_permutation",
    "first_darts",
    "outer_dart",
    "strip_tethers",
]


@dataclass(frozen=True, slots=True, eq=False)
class Derived(Immutable):
    """Everything that follows from tail and next_ccw alone.

    Attributes
    ----------
    rank
        (2E,) int32 place of the dart in the rotation of its tail, counted from the lowest dart.
    first
        (V,) int32 lowest dart of a vertex, -1 for none.
    next_face
        (2E,) int32 next dart of the face on the left.
    face_of, n_faces
        (2E,) int32 face on the left, numbered by lowest dart; a single vertex has one face.
    in_tree, component, n_components
        Spanning forest, (E,) bool and (V,) int32.
    """

    rank: NDArray[np.int32]
    first: NDArray[np.int32]
    next_face: NDArray[np.int32]
    face_of: NDArray[np.int32]
    n_faces: int
    in_tree: NDArray[np.bool_]
    component: NDArray[np.int32]
    n_components: int


def derive(tail: NDArray[np.int32], next_ccw: NDArray[np.int32], vertex_names: Names, edge_names: Names) -> Derived:
    """Check a rotation system and derive faces and components; genus must be 0 in every component.

    Raises
    ------
    BadInput
        If `next_ccw` is not one cycle of darts around every vertex.
    NotPlane
        With the genus and a shortest offending part.
    """
    size, n_vertices = tail.size, vertex_names.size
    rank, first, bad = _orbits.rotation_ranks.for_work(size)(tail, next_ccw, n_vertices)
    if bad >= 0:
        raise BadInput(
            f"next_ccw is no rotation system: around vertex {quoted(vertex_names[int(tail[bad])])} the darts do not form "
            f"one cycle (see dart {int(bad)})"
        )
    next_face = face_permutation(next_ccw)
    face_of, n_faces = face_labels(next_face)
    in_tree, component, n_components = _orbits.spanning_forest.for_work(size)(tail, next_ccw, first)
    isolated = int((first < 0).sum())
    # Each component on its own sphere: V - E + F = 2 per component, an isolated vertex counting one face.
    genus2 = 2 * int(n_components) - (n_vertices - size // 2 + n_faces + isolated)
    if genus2:
        edges, shortest = offending_part(tail.tolist(), next_ccw.tolist(), first.tolist())
        real = [edge_names[e] for e in edges if e < len(edge_names)]
        shown = ", ".join(real[:12]) + (f", ... ({counted(len(real), 'edge')})" if len(real) > 12 else "")
        raise NotPlane(
            f"the rotation system has genus {genus2 // 2}, so no drawing in the plane has it; "
            f"{'a shortest' if shortest else 'an'} offending part is the edge{'' if len(real) == 1 else 's'} {shown}",
            genus=genus2 // 2,
            edges=real,
        )
    if size == 0:
        n_faces = 1
    return Derived(rank, first, next_face, face_of, n_faces, in_tree, component, int(n_components))


def face_permutation(next_ccw: NDArray[np.int32]) -> NDArray[np.int32]:
    """Return ``d -> previous-ccw(twin d)``, whose orbits are the faces, (2E,) int32."""
    previous = np.empty(next_ccw.size, np.int32)
    previous[next_ccw] = np.arange(next_ccw.size, dtype=np.int32)
    return np.ascontiguousarray(previous.reshape(-1, 2)[:, ::-1].reshape(-1))


def face_labels(next_face: NDArray[np.int32]) -> tuple[NDArray[np.int32], int]:
    """Return the face on each dart's left, (2E,) int32, numbered by lowest dart, and how many there are. O(E)."""
    labels, count = _orbits.face_labels.for_work(next_face.size)(next_face)
    return labels, int(count)


def strip_tethers(next_ccw: NDArray[np.int32], tether: NDArray[np.bool_]) -> NDArray[np.int32]:
    """Return the rotation without the tethers: they become fixed points."""
    stripped = next_ccw.copy()
    previous = np.empty_like(next_ccw)
    previous[next_ccw] = np.arange(next_ccw.size, dtype=np.int32)
    for e in np.flatnonzero(tether):
        for d in (2 * int(e), 2 * int(e) + 1):
            before, after = previous[d], stripped[d]
            stripped[before], previous[after] = after, before
            stripped[d] = previous[d] = d
    return stripped


def components_without_tethers(
    tail: NDArray[np.int32], next_ccw: NDArray[np.int32], tether: NDArray[np.bool_], n_vertices: int
) -> NDArray[np.int32]:
    """Return the component of each vertex once tethers are gone, (V,) int32.

    Raises
    ------
    BadInput
        If the tethers do not join the components like a tree.
    """
    real = np.flatnonzero(~np.repeat(tether, 2))[::-1]
    first = np.full(n_vertices, -1, np.int32)
    first[tail[real]] = real
    forest = _orbits.spanning_forest.for_work(tail.size)
    _, component, count = forest(tail, strip_tethers(next_ccw, tether), first)
    if count - 1 != int(tether.sum()):
        raise BadInput(
            f"{counted(int(tether.sum()), 'tether')} for {counted(int(count), 'component')}: tethers must be bridges, one "
            "fewer than components"
        )
    return np.asarray(component, dtype=np.int32)


@dataclass(frozen=True, slots=True, eq=False)
class Walks:
    """The face walks of the components, tethers taken away.

    Attributes
    ----------
    lowest
        (W,) int64 lowest dart of each walk.
    clockwise
        (W,) bool, true for the outer walk of a component: exactly one each.
    """

    lowest: NDArray[np.int64]
    clockwise: NDArray[np.bool_]


def component_walks(
    tail: NDArray[np.int32],
    next_ccw: NDArray[np.int32],
    tether: NDArray[np.bool_],
    heading: NDArray[np.float64],
    turn: NDArray[np.float64],
    component: NDArray[np.int32],
    derived: Derived,
    edge_names: Names,
) -> Walks:
    """Hold the headings against the rotation, component by component (`component` is (V,), without tethers).

    Raises
    ------
    NotPlane
        If headings do not increase counter-clockwise around a vertex, or the walks of a component do not turn once each,
        exactly one of them clockwise. Complexity O(V + E).
    """
    real = ~np.repeat(tether, 2)
    rotation, next_face, face_of, n_faces = next_ccw, derived.next_face, derived.face_of, derived.n_faces
    if tether.any():
        rotation = strip_tethers(next_ccw, tether)
        next_face = face_permutation(rotation)
        face_of, n_faces = face_labels(next_face)
    corner = corner_angles(rotation, heading)
    corner[~real] = 0.0
    wrong = np.flatnonzero(np.bincount(tail, weights=corner, minlength=component.size) > 1.5 * TAU)
    if wrong.size:
        dart = int(np.flatnonzero(real & (tail == wrong[0]))[0])
        raise NotPlane(
            f"the headings at the tail of edge {quoted(edge_names[dart >> 1])} do not increase counter-clockwise in the "
            "order of the rotation; sort the rotation by heading, or leave the headings out"
        )
    lowest = first_darts(face_of, int(n_faces))
    settled = settle_turns(heading, turn)
    settled[tether] = 0.0
    turns = face_turns(next_face, face_of, int(n_faces), corner, settled)
    lowest, turns = lowest[real[lowest]], turns[real[lowest]]
    odd = np.flatnonzero(np.abs(turns) != 1)
    if odd.size:
        edge = edge_names[int(lowest[odd[0]]) >> 1]
        raise NotPlane(
            f"the face along edge {quoted(edge)} turns {int(turns[odd[0]]):+d} times, and in a plane drawing every face "
            "turns exactly once: a closure or a heading is wrong, or edges cross"
        )
    outer = np.bincount(component[tail[lowest[turns < 0]]], minlength=int(component.max()) + 1)
    has_edge = np.zeros(outer.size, np.bool_)
    has_edge[component[tail[real]]] = True
    bad = np.flatnonzero(has_edge & (outer != 1))
    if bad.size:
        dart = int(np.flatnonzero(real & (component[tail] == bad[0]))[0])
        raise NotPlane(
            f"{int(outer[bad[0]])} faces of the part with edge {quoted(edge_names[dart >> 1])} turn clockwise, and in a "
            "plane drawing exactly one does, the outer face: a closure or a heading is wrong, or edges cross"
        )
    return Walks(lowest, turns < 0)


def outer_dart(walks: Walks, derived: Derived) -> int:
    """Return the lowest dart on the outer face: the face of the tethered map that no walk bounds from outside.

    A face holds the clockwise walks of its guests beside the one counter-clockwise walk of its host, if any.

    Raises
    ------
    NotPlane
        If a face has two hosts, or not exactly one face has none.
    """
    face = derived.face_of[walks.lowest]
    hosts = np.bincount(face[~walks.clockwise], minlength=derived.n_faces)
    free = walks.clockwise & (hosts[face] == 0)
    if int(hosts.max()) > 1 or np.unique(face[free]).size != 1:
        raise NotPlane("the tethers tie components so that a face has two hosts, or not exactly one face is unbounded")
    return int(walks.lowest[free][0])


def first_darts(face_of: NDArray[np.int32], n_faces: int) -> NDArray[np.int64]:
    """Return the lowest dart of every face, (n_faces,) int64."""
    first = np.empty(n_faces, np.int64)
    first[face_of[::-1]] = np.arange(face_of.size - 1, -1, -1)
    return first
