"""Worlds and regions of a wanted size for the benchmarks; fixed seeds, made outside the clock."""

from __future__ import annotations

import numpy as np
import shapely
from scipy.spatial import Delaunay, cKDTree

from ninefold.mapping import PlaneMap, Region


def triangulation(n: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 2) in the unit square and the edges of their Delaunay triangulation."""
    points = np.random.default_rng(seed).random((n, 2))
    t = Delaunay(points).simplices.astype(np.int64)
    ends = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    key = np.unique(ends[:, 0] * n + ends[:, 1])
    return points, np.stack([key // n, key % n], axis=1)


def street_like(n: int, share: float = 2.2, seed: int = 0, *, connected: bool = True) -> tuple[np.ndarray, np.ndarray]:
    """Random edges of a triangulation, about `share` an n; a spanning tree is kept if it is to be connected."""
    points, edges = triangulation(n, seed)
    rng = np.random.default_rng(seed + 1)
    keep = rng.random(len(edges)) < share * n / len(edges)
    if connected:
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import minimum_spanning_tree

        weights = coo_array((rng.random(len(edges)) + 1, (edges[:, 0], edges[:, 1])), shape=(n, n)).tocsr()
        tree = minimum_spanning_tree(weights).tocoo()
        chosen = np.minimum(tree.row, tree.col).astype(np.int64) * n + np.maximum(tree.row, tree.col)
        spare = rng.permutation(np.flatnonzero(~np.isin(edges[:, 0] * n + edges[:, 1], chosen)))
        keep = np.ones(len(edges), bool)
        keep[spare[int(share * n) - len(chosen) :]] = False
    return points, edges[keep]


def braced(n: int, share: float, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A random spanning tree of a triangulation and a share of its spare edges: 0 a tree, 1 all of them."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import minimum_spanning_tree

    points, edges = triangulation(n, seed)
    rng = np.random.default_rng(seed + 1)
    weights = coo_array((rng.random(len(edges)) + 1, (edges[:, 0], edges[:, 1])), shape=(n, n)).tocsr()
    tree = minimum_spanning_tree(weights).tocoo()
    chosen = np.minimum(tree.row, tree.col).astype(np.int64) * n + np.maximum(tree.row, tree.col)
    kept = np.isin(edges[:, 0] * n + edges[:, 1], chosen)
    spare = rng.permutation(np.flatnonzero(~kept))
    kept[spare[: round(share * spare.size)]] = True
    return points, edges[kept]


class Discs:
    """Regions of a triangulated map that fill discs, so that their boundary length can be chosen."""

    def __init__(self, n: int, seed: int = 0) -> None:
        self.points, edges = triangulation(n, seed)
        self.plane = PlaneMap.from_geometry(self.points, edges)
        plane = self.plane
        size = np.bincount(plane.face_of, minlength=plane.n_faces)
        total = [np.bincount(plane.face_of, weights=self.points[plane.tail, k], minlength=plane.n_faces) for k in (0, 1)]
        self.centre = np.stack(total, axis=1) / size[:, None]
        self.centre[plane.outer_face] = -9
        self.tree = cKDTree(self.centre)
        self.spacing = 1 / np.sqrt(n)

    def region(self, rng: np.random.Generator, vertices: int, spread: float) -> tuple[Region, np.ndarray]:
        """A simple cycle's inside with about `vertices` boundary vertices, and the ring of its vertices in order."""
        while True:
            radius = self.spacing * vertices / 7.6 * rng.uniform(0.9, 1.1)
            room = max(0.0, 0.49 - radius)
            at = 0.5 + rng.uniform(-1, 1, 2) * min(spread, room)
            region = Region.from_faces(self.plane, self.tree.query_ball_point(at, radius))
            ring = simple_ring(region)
            if ring is not None:
                return region, ring

    def polygon(self, ring: np.ndarray) -> shapely.Polygon:
        """The geometry of a ring of vertices."""
        return shapely.Polygon(self.points[ring])


def simple_ring(region: Region) -> np.ndarray | None:
    """The vertices around a region that is bounded by one simple cycle, else None."""
    plane = region.plane
    leaving = dict(zip(plane.tail[region.darts].tolist(), region.darts.tolist(), strict=True))
    if len(leaving) != region.darts.size:
        return None
    start = at = int(region.darts[0])
    ring = []
    while True:
        ring.append(int(plane.tail[at]))
        at = leaving[int(plane.tail[at ^ 1])]
        if at == start:
            break
    return np.array(ring) if len(ring) == region.darts.size else None
