"""Random points, lines and regions of a map, in groups that lie near each other, so that most pairs have something to say.

Nothing here asks how two sets relate, so that a sample can judge the answers.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold.mapping import Dart, Edge, Face, Line, Point, Region, Vertex

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.mapping import PlaneMap, Set

__all__ = ["random_sets", "sample_pairs"]

GROUP = 16

MOST_SPOKES = 64
"""Darts of one vertex that sets are drawn from: GEOS takes a time quadratic in the parts of a line that meet in a point."""


def sample_pairs(plane: PlaneMap, count: int, rng: np.random.Generator) -> tuple[list[Set], NDArray[np.int64]]:
    """Sample sets, and pairs of them: four of five within a group of neighbours, the rest across the map.

    Parameters
    ----------
    count
        How many ordered pairs.

    Returns
    -------
    sets
        About ``count / 12`` of them.
    pairs
        (count, 2) int64 rows of `sets`.
    """
    groups = max(1, -(-count // (12 * GROUP)))
    sets: list[Set] = []
    for _ in range(groups):
        sets += random_sets(plane, GROUP, rng)
    first = rng.integers(len(sets), size=count)
    near = first - first % GROUP + rng.integers(GROUP, size=count)
    anywhere = rng.integers(len(sets), size=count)
    second = np.where(rng.random(count) < 0.8, near, anywhere)
    return sets, np.stack([first, second], axis=1)


def random_sets(plane: PlaneMap, count: int, rng: np.random.Generator) -> list[Set]:
    """Draw sets around one random place of the map: vertices, walks, loose and branching lines, cycles, unions of faces.

    Examples
    --------
    >>> import numpy as np
    >>> from ninefold.mapping import PlaneMap
    >>> star = PlaneMap.from_rotation({"o": ["a", "b", "c"], "a": ["o"], "b": ["o"], "c": ["o"]})
    >>> sets = random_sets(star, 5, np.random.default_rng(1))
    >>> {type(x).__name__ for x in sets} <= {"Point", "Line"}
    True
    """
    centre = int(rng.integers(plane.n_vertices))
    reach = int(rng.choice([6, 20, 60]))
    darts = _around(plane, centre, reach, rng)
    edges = sorted({d >> 1 for d in darts if not plane.tether[d >> 1]})
    faces = sorted({int(plane.face_of[d]) for d in darts} - {plane.outer_face})
    vertices = sorted({centre, *(int(plane.tail[d]) for d in darts)})
    return [_one_set(plane, vertices, edges, faces, rng) for _ in range(count)]


def _one_set(plane: PlaneMap, vertices: list[int], edges: list[int], faces: list[int], rng: np.random.Generator) -> Set:
    roll = rng.random()
    if roll < 0.12 or not edges:
        return Point(plane, Vertex(int(rng.choice(vertices))))
    if roll < 0.25:
        return _walk(plane, int(rng.choice(edges)), rng)
    if roll < 0.4 or not faces:
        share = rng.random()
        some = [e for e in edges if rng.random() < share] or [int(rng.choice(edges))]
        return Line(plane, tuple(map(Edge, some)))
    if roll < 0.6:
        ring = _cycle(plane, int(rng.choice(edges)), rng)
        return plane.cycle(edges=[plane.edge_names[e] for e in ring]) if ring else plane.face(int(rng.choice(faces)))
    if roll < 0.8:
        share = rng.random()
        return Region.from_faces(plane, [f for f in faces if rng.random() < share] or [int(rng.choice(faces))])
    return Region.from_faces(plane, _blob(plane, int(rng.choice(faces)), rng))


def _around(plane: PlaneMap, centre: int, reach: int, rng: np.random.Generator) -> list[int]:
    """The darts at the nearest `reach` vertices, breadth first, with tethers; of a vertex with very many a run of them."""
    seen, queue = {centre}, [centre]
    darts: list[int] = []
    for v in queue:
        if len(queue) > 4 * reach or len(darts) > 12 * reach:
            break
        spokes = plane.darts_at(Vertex(v))
        if len(spokes) > MOST_SPOKES:
            first = int(rng.integers(len(spokes)))
            spokes = (spokes + spokes)[first : first + MOST_SPOKES]
        for d in spokes:
            darts.append(d)
            w = int(plane.tail[d ^ 1])
            if w not in seen and len(seen) < reach:
                seen.add(w)
                queue.append(w)
    return darts


def _walk(plane: PlaneMap, edge: int, rng: np.random.Generator) -> Line:
    """A walk that uses no edge twice."""
    d = 2 * edge + int(rng.integers(2))
    darts = [d]
    used = {edge}
    for _ in range(int(rng.integers(0, 20))):
        on = [x for x in plane.darts_at(Vertex(int(plane.tail[d ^ 1]))) if x >> 1 not in used and not plane.tether[x >> 1]]
        if not on:
            break
        d = on[int(rng.integers(len(on)))]
        darts.append(d)
        used.add(d >> 1)
    return Line(plane, tuple(map(Edge, used)), tuple(map(Dart, darts)))


def _cycle(plane: PlaneMap, edge: int, rng: np.random.Generator) -> list[int]:
    """The edges of a simple cycle: a random walk until it meets itself, what led there cut off; empty at a dead end."""
    d = 2 * edge + int(rng.integers(2))
    way = [d]
    place = {int(plane.tail[d]): 0}
    while True:
        v = int(plane.tail[d ^ 1])
        if v in place:
            return [x >> 1 for x in way[place[v] :]]
        place[v] = len(way)
        on = [x for x in plane.darts_at(Vertex(v)) if x != d ^ 1 and not plane.tether[x >> 1]]
        if not on:
            return []
        d = on[int(rng.integers(len(on)))]
        way.append(d)


def _blob(plane: PlaneMap, face: int, rng: np.random.Generator) -> set[int]:
    """A union of faces grown across edges or vertices."""
    blob = {face}
    rim = plane.face_darts(Face(face))
    for _ in range(int(rng.integers(0, 25))):
        d = rim[int(rng.integers(len(rim)))]
        if rng.random() < 0.3:
            spokes = plane.darts_at(Vertex(int(plane.tail[d])))
            d = spokes[int(rng.integers(len(spokes)))]
        new = Face(int(plane.face_of[d ^ 1]))
        if new != plane.outer_face and new not in blob:
            blob.add(new)
            rim += plane.face_darts(new)
    return blob
