"""Shrinking a question about two sets: the smallest sub-map found on which a property of the pair still holds.

Edges that neither set uses are dropped, many at once while that works; a dropped edge that held the map together becomes a
tether; dead tethers go, vertices of degree two are smoothed away, and the sets lose edges and faces one by one.

References
----------
A. Zeller, R. Hildebrandt, Simplifying and isolating failure-inducing input, IEEE TSE 28 (2002).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold.mapping import Edge, Face, Line, PlaneMap, Point, Region, Vertex

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Sequence

    from numpy.typing import NDArray

    from ninefold.mapping import Set

    Candidates = Generator[tuple[Set, Set], bool | None, None]

__all__ = ["shrink", "without_edges"]


def shrink(x: Set, y: Set, holds: Callable[[Set, Set], bool], *, most_trials: int = 2000) -> tuple[Set, Set]:
    """Return a pair on a smaller map for which `holds` is still true; no single further step would keep it true.

    Parameters
    ----------
    x, y
        Two sets of one map with ``holds(x, y)``.
    holds
        The property, a pure function of the pair.
    most_trials
        How often `holds` may be asked; then the best pair so far is returned.

    Notes
    -----
    Complexity O(trials * V) plus what `holds` takes.
    """
    trials = most_trials
    changed = True
    while changed:
        changed = False
        for smaller in (_fewer_edges, _smaller_sets, _smoothed):
            candidates = smaller(x, y)
            found: bool | None = None
            while trials > 0:
                try:
                    a, b = candidates.send(found)
                except StopIteration:
                    break
                trials -= 1
                found = holds(a, b)
                if found:
                    x, y, changed = a, b, True
    return x, y


def _used(x: Set, y: Set) -> set[int]:
    return {e for s in (x, y) if not isinstance(s, Point) for e in s.edge_set}


def _fewer_edges(x: Set, y: Set) -> Candidates:
    """Drop blocks of unused edges, half of them first, then quarters, down to single ones."""
    spare = [e for e in range(x.plane.tether.size) if e not in _used(x, y)]
    names = [x.plane.edge_names[e] for e in spare]
    size = max(1, len(names))
    while names:
        place = 0
        while place < len(names):
            block = names[place : place + size]
            rows = [x.plane.edge_names.row(name) for name in block if name in x.plane.edge_names]
            a, b = without_edges((x, y), rows)
            smaller = (a.plane.tether.size, a.plane.n_edges) < (x.plane.tether.size, x.plane.n_edges)
            if smaller and (yield a, b):
                x, y = a, b
                del names[place : place + size]
            else:
                place += size
        if size == 1:
            return
        size //= 2


def _smaller_sets(x: Set, y: Set) -> Candidates:
    """Take an edge out of a line, or a face out of a region."""
    for first in (True, False):
        for part in _parts(x if first else y):
            less = _less(x if first else y, part)
            if less is not None and (yield (less, y) if first else (x, less)):
                x, y = (less, y) if first else (x, less)


def _parts(x: Set) -> tuple[int, ...]:
    match x:
        case Line():
            return x.edges
        case Region():
            return x.faces
        case Point():
            return ()


def _less(x: Set, part: int) -> Set | None:
    match x:
        case Line() if len(x.edges) > 1:
            return Line(x.plane, tuple(e for e in x.edges if e != part))
        case Region() if x.n_faces > 1:
            return Region.from_faces(x.plane, [f for f in x.faces if f != part])
        case _:
            return None


def _smoothed(x: Set, y: Set) -> Candidates:
    """Take out a vertex of degree two and join its two edges."""
    v = 0
    while v < x.plane.n_vertices:
        joined = _without_vertex((x, y), v)
        if joined is not None and (yield joined):
            x, y = joined
        else:
            v += 1


def without_edges(pair: tuple[Set, Set], edges: Sequence[int]) -> tuple[Set, Set]:
    """Drop edges, by number, that neither set uses, and everything that then hangs by a tether without being used.

    An edge that held the map together becomes a tether, so rotation, faces and hosts of the rest stay as they are.
    """
    plane = pair[0].plane
    gone = np.zeros(plane.tether.size, np.bool_)
    gone[list(edges)] = True
    label = list(range(plane.n_vertices))

    def find(v: int) -> int:
        while label[v] != v:
            label[v] = label[label[v]]
            v = label[v]
        return v

    ends = plane.tail.reshape(-1, 2).tolist()
    tether = plane.tether | gone
    kept = np.zeros(gone.size, np.bool_)
    for e in [*np.flatnonzero(~tether).tolist(), *np.flatnonzero(tether).tolist()]:
        a, b = find(ends[e][0]), find(ends[e][1])
        label[a] = b
        kept[e] = not tether[e] or a != b
    needed = {s.index for s in pair if isinstance(s, Point)}
    _prune(plane, kept, tether, needed)
    return _restricted(pair, kept, tether)


def _prune(plane: PlaneMap, kept: NDArray[np.bool_], tether: NDArray[np.bool_], needed: set[Vertex]) -> None:
    """Drop, in `kept`, the tethers that end at a vertex with nothing else, one after the other."""
    spokes: dict[int, set[int]] = {v: set() for v in range(plane.n_vertices)}
    for d in np.flatnonzero(np.repeat(kept, 2)).tolist():
        spokes[int(plane.tail[d])].add(d)
    bare = [v for v, darts in spokes.items() if len(darts) == 1 and v not in needed]
    while bare:
        v = bare.pop()
        d = next(iter(spokes[v]), -1)
        if len(spokes[v]) != 1 or not tether[d >> 1]:
            continue
        w = int(plane.tail[d ^ 1])
        kept[d >> 1] = False
        spokes[v].clear()
        spokes[w].discard(d ^ 1)
        if len(spokes[w]) == 1 and w not in needed:
            bare.append(w)


def _restricted(pair: tuple[Set, Set], kept: NDArray[np.bool_], tether: NDArray[np.bool_]) -> tuple[Set, Set]:
    """The map of the kept edges, some of them tethers now, and the two sets on it."""
    plane = pair[0].plane
    darts = np.flatnonzero(np.repeat(kept, 2))
    after = plane.next_ccw.copy()
    for d in darts.tolist():
        while not kept[after[d] >> 1]:
            after[d] = plane.next_ccw[after[d]]
    points = [s.index for s in pair if isinstance(s, Point)]
    vertices = np.unique(np.concatenate([plane.tail[darts], np.array(points, np.int32)]))
    if not vertices.size:
        vertices = np.zeros(1, np.int32)
    merged = _merged_faces(plane, ~kept)
    outer = darts[merged[plane.face_of[darts]] == merged[plane.outer_face]]
    return _sub_map(pair, plane.tail, after, kept, tether, vertices, int(outer[0]) if outer.size else -1)


def _merged_faces(plane: PlaneMap, dropped: NDArray[np.bool_]) -> NDArray[np.int32]:
    """Label the faces by what they are once the dropped edges are gone, (F,)."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    left, right = plane.face_of[0::2][dropped], plane.face_of[1::2][dropped]
    links = coo_array((np.ones(left.size, np.int8), (left, right)), shape=(plane.n_faces, plane.n_faces))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int32)


def _without_vertex(pair: tuple[Set, Set], v: int) -> tuple[Set, Set] | None:
    """Join the two edges at a vertex of degree two; None where that cannot be, or where it would change a set."""
    plane = pair[0].plane
    at = plane.darts_at(Vertex(v))
    if len(at) != 2 or at[0] >> 1 == at[1] >> 1 or plane.tether[[d >> 1 for d in at]].any():
        return None
    for s in pair:
        ends_here = isinstance(s, Line) and len({d >> 1 for d in at} & s.edge_set) == 1
        if ends_here or (isinstance(s, Point) and s.index == v):
            return None
    stay, drop = sorted(at, key=lambda d: d >> 1)
    far = drop ^ 1
    # Dart `stay` leaves v; it moves to the far end of the other edge, where it takes the place of `far`.
    tail, after = plane.tail.copy(), plane.next_ccw.copy()
    tail[stay] = tail[far]
    before = int(np.flatnonzero(plane.next_ccw == far)[0])
    after[stay] = stay if before == far else plane.next_ccw[far]
    if before != far:
        after[before] = stay
    kept = np.ones(plane.tether.size, np.bool_)
    kept[drop >> 1] = False
    outer = {far: stay, drop: stay ^ 1}.get(plane.outer, plane.outer)
    vertices = np.delete(np.arange(plane.n_vertices), v)
    return _sub_map(pair, tail, after, kept, plane.tether, vertices, outer)


def _sub_map(
    pair: tuple[Set, Set],
    tail: NDArray[np.int32],
    after: NDArray[np.int32],
    kept: NDArray[np.bool_],
    tether: NDArray[np.bool_],
    vertices: NDArray[np.int_],
    outer: int,
) -> tuple[Set, Set]:
    """Make the map of the kept edges from arrays in the old numbers, and carry the two sets over."""
    plane = pair[0].plane
    darts = np.flatnonzero(np.repeat(kept, 2))
    smaller = PlaneMap.from_darts(
        np.searchsorted(vertices, tail[darts]),
        np.searchsorted(darts, after[darts]),
        int(np.searchsorted(darts, outer)) if darts.size else None,
        n_vertices=vertices.size,
        tether=tether[kept],
        vertex_names=[plane.vertex_names[int(v)] for v in vertices],
        edge_names=[plane.edge_names[int(e)] for e in np.flatnonzero(kept)],
    )
    old_face = np.zeros(smaller.n_faces, np.int64)
    old_face[smaller.face_of] = plane.face_of[darts]
    row = np.cumsum(kept) - 1

    def carried(s: Set) -> Set:
        match s:
            case Point():
                return Point(smaller, Vertex(int(np.searchsorted(vertices, s.index))))
            case Line():
                return Line(smaller, tuple(Edge(int(row[e])) for e in s.edges if kept[e]))
            case Region():
                return Region.from_faces(smaller, [f for f in range(smaller.n_faces) if s.has_face(Face(int(old_face[f])))])

    return carried(pair[0]), carried(pair[1])
