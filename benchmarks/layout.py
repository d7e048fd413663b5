"""Drawings against networkx (and OGDF where `ogdf-wheel` is installed), against the ground, and the oracle's own time.

networkx draws on a (2n - 4) x (n - 2) grid and chooses its own outer face; OGDF's Schnyder layout embeds anew, forgetting
which component lies in which face. Neither keeps both the rotation and a prescribed outer face.

No layout of others draws from headings, so the compass drawing is compared with the ground, and the drawings that know no
headings stand beside it: they may be turned to fit the ground as well as moved and scaled, the compass drawing may not.
"""

from __future__ import annotations

import time
from collections.abc import Callable

import networkx as nx
import numpy as np

from benchmarks.clock import best, row, title
from benchmarks.worlds import braced, triangulation
from ninefold.io import samples
from ninefold.layout import (
    Drawing,
    TrueShapes,
    compass,
    drawing_problems,
    heading_errors,
    misplacement,
    relax,
    schnyder,
    tutte,
    verify,
)
from ninefold.mapping import PlaneMap
from ninefold.mapping.rigidity import rigid_parts

PEER_UP_TO = 100_000
SHARES = (0.05, 0.15, 0.3, 0.5, 0.9)
SEEDS = {300: 40, 1_000: 10, 5_000: 4}
NOISE = 5


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


def timed(job: Callable[[], Drawing]) -> tuple[Drawing, float]:
    """What a job makes, and the CPU seconds it takes."""
    begin = time.process_time()
    made = job()
    return made, time.process_time() - begin


def noisy(plane: PlaneMap, degrees: float, seed: int = 0) -> np.ndarray:
    """The directions of a map's edges from end to end, each with Gaussian noise of its own."""
    assert plane.heading is not None
    assert plane.turn is not None
    said = plane.heading[0::2] + plane.turn / 2
    return said + np.radians(degrees) * np.random.default_rng(seed).standard_normal(said.size)


def from_headings(n: int, share: float, degrees: float, seeds: int) -> None:
    """One row: random maps of one density, drawn from headings; legs in rigid parts of three or more are fixed."""
    mine, seconds, peers, fixed = [], [], [], []
    for seed in range(seeds):
        points, edges = braced(n, share, seed)
        plane = PlaneMap.from_geometry(points, edges)
        ground = Drawing.from_points(plane, points)
        drawing, took = timed(lambda p=plane, s=seed: compass(p, chords=noisy(p, degrees, s)))
        if drawing.layout == "compass":  # no fall-back to another
            mine.append(misplacement(drawing, ground))
        seconds.append(took)
        if not degrees:
            parts = rigid_parts(edges)
            fixed.append((np.mean(parts.sizes[parts.part] >= 3), parts.sizes.max() / len(edges)))
        if not degrees and seed < 3 and n <= 5_000:
            peers.append([misplacement(make(plane), ground, turned=True) for make in (tutte, schnyder)])
    row(
        f"{n:,} vertices, share {share:g}, noise {degrees} deg",
        f"{len(mine)} of {seeds}",
        *((f"{100 * np.median(mine):.2f} %", f"{100 * max(mine):.2f} %") if mine else ("-", "-")),
        f"{np.median(seconds):.2f}",
        *((f"{100 * peer:.1f} %" for peer in np.median(peers, axis=0)) if peers else ("-", "-")),
        *((f"{100 * share:.0f} %" for share in np.median(fixed, axis=0)) if fixed else ("-", "-")),
    )


def bundled(name: str, degrees: float) -> None:
    """One row: a bundled world, drawn from headings alone."""
    source = samples.load(name)
    plane = source.to_map()
    ground = TrueShapes(source).drawing(plane)
    chords = noisy(plane, degrees)
    drawing, took = timed(lambda: compass(plane, chords=chords))
    off = np.degrees(np.abs(heading_errors(drawing)))
    row(
        f"{name}, noise {degrees} deg",
        *(drawing.layout, f"{np.nanmedian(off):.2f} deg", f"{np.nanpercentile(off, 95):.2f} deg"),
        *(f"{100 * misplacement(drawing, ground):.1f} %", f"{took:.2f}"),
        *(f"{100 * misplacement(make(plane), ground, turned=True):.1f} %" for make in (tutte, schnyder)),
    )


def least_angle(drawing: Drawing) -> float:
    """The narrowest angle between two edges at a vertex, degrees; for drawings without bends."""
    plane = drawing.plane
    step = drawing.points[plane.tail[np.arange(plane.tail.size) ^ 1]] - drawing.points[plane.tail]
    way = np.arctan2(step[:, 1], step[:, 0])
    gap = (way[plane.next_ccw] - way) % (2 * np.pi)
    return float(np.degrees(gap[plane.next_ccw != np.arange(gap.size)].min()))


def unevenness(drawing: Drawing) -> float:
    """The longest edge over the shortest."""
    pieces = drawing.pieces[0].astype(float)
    length = np.hypot(*(pieces[:, 2:] - pieces[:, :2]).T)
    return float(length.max() / length.min())


def without_headings(n: int, share: float, seeds: int) -> None:
    """One row: the relaxed drawing beside the one that it starts from."""
    found, seconds, done = [], [], 0
    for seed in range(seeds):
        plane = PlaneMap.from_geometry(*braced(n, share, seed))
        start = tutte(plane)
        drawing, took = timed(lambda d=start: relax(d))
        done += not any("not relaxed" in note for note in drawing.notes)
        found.append([measure(d) for measure in (least_angle, unevenness) for d in (start, drawing)])
        seconds.append(took)
    angle, opened, uneven, evened = np.median(found, axis=0)
    row(
        f"{n:,} vertices, share {share:g}",
        *(f"{done} of {seeds}", f"{angle:.2f} deg", f"{opened:.1f} deg", f"{uneven:.3g}", f"{evened:.3g}"),
        f"{np.median(seconds):.2f}",
    )


def likeness() -> None:
    """Drawings from headings against the ground, and relaxed ones against Tutte's; CPU seconds."""
    columns = ("rms", "worst rms", "CPU seconds", "Tutte rms", "Schnyder rms")
    fixed = ("legs fixed", "largest part")
    compass(PlaneMap.from_geometry(*braced(5_000, 0.5)))
    for degrees in (0, NOISE):
        title(f"Compass, rms in % of the diagonal; noise {degrees} deg", "plane", *columns, *fixed)
        for n, seeds in SEEDS.items():
            for share in SHARES:
                from_headings(n, share, degrees, seeds)

    title("Compass on the bundled worlds", "layout", "median", "95 %", "rms", *columns[-3:])
    for degrees in (0, NOISE):
        for name in samples.names():
            bundled(name, degrees)

    columns = ("Tutte ratio", "ratio", "CPU seconds")
    title("Relaxed: least angle, longest to shortest edge; medians", "relaxed", "Tutte angle", "angle", *columns)
    for n, seeds in ((300, 20), (1_000, 6), (10_000, 1)):
        for share in (0.15, 0.5, 0.9):
            without_headings(n, share, seeds)


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

    likeness()
    title("Compass, large", "plane", "rms", "worst rms", "CPU seconds", "", "", "legs fixed", "largest part")
    for share in (0.15, 0.5, 0.9):
        from_headings(50_000, share, 0, 1)
    from_headings(50_000, 0.5, NOISE, 1)


if __name__ == "__main__":
    main()
