"""Drawings against networkx (and OGDF where `ogdf-wheel` is installed), and the oracle's own time, in one run.

networkx draws on a (2n - 4) x (n - 2) grid and chooses its own outer face; OGDF's Schnyder layout embeds anew, forgetting
which component lies in which face. Neither keeps both the rotation and a prescribed outer face.
"""

from __future__ import annotations

from collections.abc import Callable

import networkx as nx
import numpy as np

from benchmarks.clock import best, row, title
from benchmarks.worlds import triangulation
from ninefold.layout import drawing_problems, schnyder, tutte, verify
from ninefold.mapping import PlaneMap

PEER_UP_TO = 100_000


def embedding_of(plane: PlaneMap) -> nx.PlanarEmbedding:
    embedding = nx.PlanarEmbedding()
    for v in range(plane.n_vertices):
        before = None
        for d in reversed(plane.darts_at(v)):
            w = int(plane.tail[d ^ 1])
            embedding.add_half_edge(v, w, cw=before)
            before = w
    return embedding


def ogdf_schnyder() -> Callable[[np.ndarray, int], float] | None:
    """Return a function that times OGDF's Schnyder layout on a graph, or None where OGDF is not installed."""
    try:
        from ogdf_python import cppinclude, ogdf
    except ImportError:
        return None
    cppinclude("ogdf/planarlayout/SchnyderLayout.h")

    def run(edges: np.ndarray, n: int) -> float:
        graph = ogdf.Graph()
        nodes = [graph.newNode() for _ in range(n)]
        for u, v in edges.tolist():
            graph.newEdge(nodes[u], nodes[v])
        attributes = ogdf.GraphAttributes(graph)
        return best(lambda: ogdf.SchnyderLayout().call(attributes), repeat=1)

    return run


def half(n: int, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Half the edges of a triangulation: dead ends, cut vertices and islands."""
    points, edges = triangulation(n, seed)
    return points, edges[np.random.default_rng(seed + 1).random(len(edges)) < 0.5]


def star(spokes: int) -> PlaneMap:
    leaves = [str(k) for k in range(1, spokes + 1)]
    return PlaneMap.from_rotation({"0": leaves, **{leaf: ["0"] for leaf in leaves}})


def grid(side: int) -> PlaneMap:
    points = [(x, y) for y in range(side) for x in range(side)]
    edges = [(y * side + x, y * side + x + 1) for y in range(side) for x in range(side - 1)]
    edges += [(y * side + x, (y + 1) * side + x) for y in range(side - 1) for x in range(side)]
    return PlaneMap.from_geometry(points, edges)


def main() -> None:
    schnyder(PlaneMap.from_geometry(*triangulation(20_000)))
    schnyder(PlaneMap.from_geometry(*half(20_000)))
    peer = ogdf_schnyder()

    title("Schnyder drawing of a triangulation", "seconds", "us a vertex", "networkx", "ratio", "OGDF")
    for n in (1_000, 10_000, 100_000, 1_000_000):
        points, edges = triangulation(n)
        plane = PlaneMap.from_geometry(points, edges)
        mine = best(lambda p=plane: schnyder(p))
        its = None
        if n <= PEER_UP_TO:
            embedding = embedding_of(plane)
            its = best(lambda e=embedding: nx.combinatorial_embedding_to_pos(e), repeat=1)
        other = f"{peer(edges, n):.2f} s" if peer and n <= PEER_UP_TO else "-"
        row(
            f"{n:,} vertices",
            *(f"{mine:.4f}", f"{1e6 * mine / n:.2f}", f"{its:.2f} s" if its else "-"),
            *(f"{its / mine:.0f} x" if its else "-", other),
        )

    title("Schnyder drawing of half a triangulation", "seconds", "us a vertex", "components", "", "OGDF")
    for n in (1_000, 10_000, 100_000, 1_000_000):
        points, edges = half(n)
        plane = PlaneMap.from_geometry(points, edges)
        mine = best(lambda p=plane: schnyder(p))
        other = f"{peer(edges, n):.2f} s" if peer and n <= PEER_UP_TO else "-"
        name = f"{n:,} vertices, {plane.n_edges:,} edges"
        row(name, f"{mine:.4f}", f"{1e6 * mine / n:.2f}", plane.n_components, "", other)

    title("Tutte drawing, checked", "seconds", "layout")
    for n in (1_000, 10_000):
        for name, make in (("triangulation", triangulation), ("half", half)):
            plane = PlaneMap.from_geometry(*make(n))
            row(f"{n:,} vertices, {name}", f"{best(lambda p=plane: tutte(p), repeat=1):.2f}", tutte(plane).layout)

    title("Vertices of high degree, and thin pieces", "seconds", "layout", "check", "verify, 50 pairs")
    for name, plane in (
        ("star of 4,000", star(4_000)),
        ("star of 50,000", star(50_000)),
        ("grid of 101 x 101", grid(101)),
    ):
        drawing = tutte(plane)
        row(
            name,
            *(f"{best(lambda p=plane: tutte(p), repeat=1):.2f}", drawing.layout),
            f"{best(lambda d=drawing: drawing_problems(d), repeat=1):.2f} s",
            f"{best(lambda p=plane: verify(p, n_pairs=50), repeat=1):.2f} s",
        )

    title("The oracle, 10,000 pairs", "edges", "draw", "check", "all", "agree")
    for name, plane in (
        ("triangulation", PlaneMap.from_geometry(*triangulation(3_340))),
        ("half", PlaneMap.from_geometry(*half(6_700))),
    ):
        drawing = schnyder(plane)
        whole = best(lambda p=plane: verify(p, n_pairs=10_000), repeat=1)
        check = best(lambda d=drawing: drawing_problems(d), repeat=1)
        row(
            name,
            *(f"{plane.n_edges:,}", f"{best(lambda p=plane: schnyder(p)):.3f} s", f"{check:.2f} s", f"{whole:.2f} s"),
            verify(plane, n_pairs=10_000, drawing=drawing).agree,
        )


if __name__ == "__main__":
    main()
