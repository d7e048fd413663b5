"""Random plane worlds with true geometry, and the shapely geometry of any set of their maps.

The one trick: draw straight edges (a Delaunay triangulation thinned out), then dissolve vertices of degree two into bends.
That gives loops, parallel edges, dead ends, trees, cacti, islands and isolated vertices, all with exact geometry.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import shapely
from scipy.spatial import Delaunay, QhullError

from ninefold.mapping import Line, PlaneMap, Point, Region


@dataclass(frozen=True, eq=False)
class World:
    """Geometry and the map made from it."""

    points: np.ndarray
    edges: np.ndarray
    paths: list[np.ndarray]

    @cached_property
    def plane(self) -> PlaneMap:
        return PlaneMap.from_geometry(self.points, self.edges, self.paths)

    @cached_property
    def lines(self) -> list[Any]:
        return [shapely.LineString(path) for path in self.paths]

    @cached_property
    def face_polygons(self) -> dict[int, Any]:
        """Polygon of every bounded face, found from coordinates: polygonize, then look a hair left of every dart."""
        plane = self.plane
        polygons = list(shapely.get_parts(shapely.polygonize(self.lines)))
        tree = shapely.STRtree(polygons) if polygons else None
        found: dict[int, Any] = {}
        for d in range(2 * len(self.edges)):
            face = int(plane.face_of[d])
            if face in found or face == plane.outer_face:
                continue
            path = self.paths[d >> 1] if d % 2 == 0 else self.paths[d >> 1][::-1]
            step = path[1] - path[0]
            left = (path[0] + path[1]) / 2 + 1e-6 * np.array([-step[1], step[0]])
            hits = tree.query(shapely.Point(left), predicate="within") if tree is not None else []
            assert len(hits) == 1, f"face {face} of dart {d}: {len(hits)} polygons on its left"
            found[face] = polygons[int(hits[0])]
        assert len(found) == plane.n_faces - 1 == len(polygons)
        return found

    def _along(self, darts: tuple[int, ...]) -> np.ndarray:
        pieces = [self.paths[d >> 1] if d % 2 == 0 else self.paths[d >> 1][::-1] for d in darts]
        return np.concatenate([pieces[0][:1], *[piece[1:] for piece in pieces]])

    def geometry(self, x: Point | Line | Region) -> Any:
        """The true geometry of a set."""
        if isinstance(x, Point):
            return shapely.Point(self.points[x.index])
        if isinstance(x, Line):
            return shapely.MultiLineString([self._along(trail) for trail in x.trails])
        union = shapely.union_all([self.face_polygons[face] for face in x.faces])
        assert union.is_valid
        return union


def thinned(rng: np.random.Generator, n: int, keep: float, dissolve: float = 0.7) -> World:
    """A Delaunay triangulation of n random points with a share of its edges, degree-two vertices dissolved."""
    while True:
        points = rng.integers(0, 1000, size=(n, 2)).astype(float)
        if len(np.unique(points, axis=0)) == n:
            break
    if n >= 3:
        try:
            t = Delaunay(points).simplices
            pairs = np.unique(np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1), axis=0)
        except QhullError:
            pairs = np.zeros((0, 2), int)
    else:
        pairs = np.array([[0, 1]] if n == 2 else np.zeros((0, 2)), int).reshape(-1, 2)
    pairs = pairs[rng.random(len(pairs)) < keep]
    return dissolved(rng, points, pairs, dissolve)


def dissolved(rng: np.random.Generator, points: np.ndarray, pairs: np.ndarray, share: float) -> World:
    """Turn a share of the degree-two vertices into bends of one longer edge."""
    paths = [[int(a), int(b)] for a, b in pairs]
    for v in rng.permutation(len(points)):
        at = [i for i, path in enumerate(paths) if path[0] == v or path[-1] == v]
        if len(at) != 2 or rng.random() >= share:
            continue
        first, second = (paths[i] for i in at)
        if first[0] == first[-1] or second[0] == second[-1]:
            continue
        first = first if first[-1] == v else first[::-1]
        second = second if second[0] == v else second[::-1]
        paths = [path for i, path in enumerate(paths) if i not in at] + [first + second[1:]]
    used = sorted({v for path in paths for v in (path[0], path[-1])} | _isolated(len(points), pairs))
    row = {v: i for i, v in enumerate(used)}
    edges = np.array([(row[path[0]], row[path[-1]]) for path in paths], int).reshape(-1, 2)
    return World(points[used], edges, [points[path] for path in paths])


def _isolated(n: int, pairs: np.ndarray) -> set[int]:
    return set(range(n)) - set(pairs.ravel().tolist())


KINDS = ("dense", "half", "sparse", "tree", "tiny", "whole", "nested", "ring")


def world(seed: int, kind: str, size: int) -> World:
    """A random world of a kind; the same arguments give the same world."""
    rng = np.random.default_rng(seed)
    match kind:
        case "dense":
            return thinned(rng, size + 3, 0.9)
        case "half":
            return thinned(rng, size + 3, 0.6)
        case "sparse":
            return thinned(rng, size + 3, 0.4, 0.3)
        case "tree":
            return thinned(rng, size + 3, 0.2, 0.2)
        case "tiny":
            return thinned(rng, 1 + size % 4, 0.9)
        case "whole":
            return thinned(rng, size + 3, 1.0, 0.0)
        case "nested":
            return nested(rng, 1 + size % 5)
        case "ring":
            return thinned(rng, size + 3, 0.5, 1.0)
    raise ValueError(kind)


def nested(rng: np.random.Generator, depth: int) -> World:
    """Squares within squares, some joined by a spoke, some not, some with a dead end or an isolated vertex between."""
    points: list[tuple[float, float]] = []
    pairs: list[tuple[int, int]] = []
    for k in range(depth):
        r = 100.0 * (depth - k)
        base = len(points)
        points += [(-r, -r), (r, -r), (r, r), (-r, r)]
        pairs += [(base + i, base + (i + 1) % 4) for i in range(4)]
        if rng.random() < 0.5:
            pairs.append((base, base + 2) if k == depth - 1 else (base, len(points)))
        if rng.random() < 0.4:
            points.append((r - 40.0, -r + 50.0 + rng.integers(0, 9)))
            if rng.random() < 0.5:
                pairs.append((base + 1, len(points) - 1))
            if pairs[-1] == (base, len(points) - 1):  # the spoke would have met this vertex instead of the next square
                pairs.pop()
    pairs = [(a, b) for a, b in pairs if max(a, b) < len(points)]
    return dissolved(rng, np.array(points), np.array(pairs, int), float(rng.random()))


def random_sets(rng: np.random.Generator, plane: PlaneMap, count: int) -> list[Point | Line | Region]:
    """Points, lines (paths, branching, in pieces, closed) and regions (faces, unions, with holes, in parts)."""
    sets: list[Point | Line | Region] = []
    bounded = [f for f in range(plane.n_faces) if f != plane.outer_face]
    real = np.flatnonzero(~plane.tether)
    for _ in range(count):
        pick = rng.random()
        if pick < 0.15 or not len(real):
            sets.append(Point(plane, int(rng.integers(plane.n_vertices))))
        elif pick < 0.3:
            some = rng.choice(real, size=int(rng.integers(1, len(real) + 1)), replace=False)
            sets.append(Line(plane, tuple(sorted(some.tolist()))))
        elif pick < 0.5 or not bounded:
            sets.append(_trail(rng, plane, int(rng.choice(real))))
        elif pick < 0.7:
            some = rng.choice(bounded, size=int(rng.integers(1, len(bounded) + 1)), replace=False)
            sets.append(Region.from_faces(plane, some.tolist()))
        elif pick < 0.9:
            sets.append(_blob(rng, plane, bounded))
        else:
            sets.append(plane.face(int(rng.choice(bounded))))
    return sets


def _trail(rng: np.random.Generator, plane: PlaneMap, edge: int) -> Line:
    """A walk that uses no edge twice."""
    d = 2 * edge + int(rng.integers(2))
    darts = [d]
    used = {edge}
    for _ in range(int(rng.integers(0, 12))):
        on = [x for x in plane.darts_at(int(plane.tail[d ^ 1])) if x >> 1 not in used and not plane.tether[x >> 1]]
        if not on:
            break
        d = int(rng.choice(on))
        darts.append(d)
        used.add(d >> 1)
    return Line(plane, tuple(sorted(used)), tuple(darts))


def _blob(rng: np.random.Generator, plane: PlaneMap, bounded: list[int]) -> Region:
    """A union of faces grown across edges."""
    blob = {int(rng.choice(bounded))}
    for _ in range(int(rng.integers(0, len(bounded) + 1))):
        edge = {int(plane.face_of[d ^ 1]) for d in range(plane.tail.size) if int(plane.face_of[d]) in blob}
        edge -= blob | {plane.outer_face}
        if not edge:
            break
        blob.add(int(rng.choice(sorted(edge))))
    return Region.from_faces(plane, blob)


def braced(n: int, share: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Random points, and a spanning tree of their triangulation with a share of the edges that are left."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import minimum_spanning_tree

    rng = np.random.default_rng(seed)
    points = rng.random((n, 2))
    t = Delaunay(points).simplices
    edges = np.unique(np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1), axis=0)
    tree = minimum_spanning_tree(coo_array((rng.random(len(edges)) + 1, edges.T), shape=(n, n)).tocsr()).tocoo()
    keep = np.isin(edges @ [n, 1], np.minimum(tree.row, tree.col) * n + np.maximum(tree.row, tree.col))
    spare = rng.permutation(np.flatnonzero(~keep))
    keep[spare[: round(share * len(spare))]] = True
    return points, edges[keep]


def jittered(side: int, jitter: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """A grid whose points are moved a little, and the edges of its triangulation but for long ones at the rim."""
    rng = np.random.default_rng(seed)
    points = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2).astype(float)
    points += rng.uniform(-jitter, jitter, points.shape)
    t = Delaunay(points).simplices
    edges = np.unique(np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1), axis=0)
    return points, edges[np.hypot(*(points[edges[:, 0]] - points[edges[:, 1]]).T) < 1.6]
