"""Plane maps from geometry, with faces, outer face and containment index, against networkx in one run."""

from __future__ import annotations

import resource

import networkx as nx
import numpy as np

from benchmarks.clock import best, row, title
from benchmarks.worlds import street_like
from ninefold.mapping import PlaneMap


def ours(points: np.ndarray, edges: np.ndarray) -> PlaneMap:
    plane = PlaneMap.from_geometry(points, edges)
    _ = plane.containment
    return plane


def theirs(points: np.ndarray, edges: np.ndarray) -> int:
    """Build the embedding from the same angles and traverse every face; sorting by angle is left out of its time."""
    embedding = nx.PlanarEmbedding()
    for v, around in NEIGHBOURS.items():
        before = None
        for w in around:
            embedding.add_half_edge(v, w, cw=before)
            before = w
    seen: set = set()
    faces = 0
    for v, w in embedding.edges:
        if (v, w) not in seen:
            embedding.traverse_face(v, w, mark_half_edges=seen)
            faces += 1
    return faces


NEIGHBOURS: dict[int, list[int]] = {}


def main() -> None:
    title("from_geometry + faces + outer face + index", "edges", "ninefold", "networkx", "ratio", "peak MiB")
    ours(*street_like(20_000))
    for n in (1_000, 10_000, 100_000, 1_000_000):
        points, edges = street_like(n)
        mine = best(lambda p=points, e=edges: ours(p, e))
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
        its = None
        if n <= 100_000:
            plane = ours(points, edges)
            NEIGHBOURS.clear()
            for v in range(n):
                NEIGHBOURS[v] = [int(plane.tail[d ^ 1]) for d in reversed(plane.darts_at(v))]
            its = best(lambda p=points, e=edges: theirs(p, e), repeat=2)
        row(
            f"{n:,} vertices, connected",
            *(
                f"{len(edges):,}",
                f"{mine:.3f} s",
                f"{its:.2f} s" if its else "-",
                f"{its / mine:.0f} x" if its else "-",
                peak,
            ),
        )
    points, edges = street_like(1_000_000, connected=False)
    plane = ours(points, edges)
    row(
        f"1,000,000 vertices, {plane.n_components:,} components",
        f"{len(edges):,}",
        f"{best(lambda: ours(points, edges)):.3f} s",
    )


if __name__ == "__main__":
    main()
