"""Bulk relations against GEOS, in one run: near pairs, random pairs, mixed kinds, all pairs, and one pair."""

from __future__ import annotations

import numpy as np
import shapely

from benchmarks.clock import best, row, title
from benchmarks.worlds import Discs
from ninefold.mapping import Line, Point, Region
from ninefold.reasoner import SetTable, de9im_strings, relate, relate_all, relate_pairs


def near_pairs(shapes: list, limit: int, rng: np.random.Generator) -> np.ndarray:
    """Pairs whose bounding boxes meet, at most `limit`, at random."""
    pairs = shapely.STRtree(shapes).query(shapes).T
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    return rng.permutation(pairs)[:limit].astype(np.int64)


def compare(name: str, sets: list, shapes: list, pairs: np.ndarray, sample: int) -> None:
    """Time ours on all pairs and GEOS on a sample, check the sample, print a row."""
    table = SetTable.build(sets)
    codes = relate_pairs(table, pairs)
    ours = best(lambda: relate_pairs(table, pairs)) / len(pairs)
    few = pairs[:sample]
    a, b = (np.array(shapes, object)[few[:, k]] for k in (0, 1))
    theirs = best(lambda: shapely.relate(a, b), repeat=2) / len(few)
    wrong = int((de9im_strings(codes[: len(few)]) != shapely.relate(a, b)).sum())
    build = best(lambda: SetTable.build(sets), repeat=2)
    row(name, f"{ours * 1e6:.3f} us", f"{theirs * 1e6:.2f} us", f"{theirs / ours:.0f} x", f"{build * 1e3:.0f} ms", wrong)


def main() -> None:
    rng = np.random.default_rng(1)
    discs = Discs(300_000)
    title("relate_pairs against shapely.relate, a pair", "ninefold", "GEOS", "ratio", "table", "wrong")
    pools: dict[int, tuple[list, list]] = {}
    for vertices, count, spread in ((10, 3000, 0.035), (100, 1500, 0.12), (1000, 120, 0.5)):
        found = [discs.region(rng, vertices, spread) for _ in range(count)]
        sets, shapes = [r for r, _ in found], [discs.polygon(ring) for _, ring in found]
        pools[vertices] = sets, shapes
        mean = np.mean([len(ring) for _, ring in found])
        pairs = near_pairs(shapes, 400_000, rng)
        compare(f"boxes meet, {mean:.0f} vertices", sets, shapes, pairs, 200_000 // vertices)
    sets, shapes = pools[100]
    compare("random pairs, 100 vertices", sets, shapes, rng.integers(0, len(sets), (400_000, 2)), 20_000)
    mixed, geometry = mixture(discs, rng, pools[100])
    compare("points, lines, regions mixed", mixed, geometry, near_pairs(geometry, 400_000, rng), 10_000)

    title("relate_all", "pairs", "seconds")
    found = [discs.region(rng, int(rng.integers(10, 400)), 0.45)[0] for _ in range(3000)]
    relate_all(found[:20])
    row(
        "3,000 regions of 10 to 400 vertices, table included",
        f"{3000 * 2999 // 2:,}",
        f"{best(lambda: relate_all(found)):.2f}",
    )

    title("one relate(X, Y), warm, two cycles of 100", "time")
    pairs = near_pairs(pools[100][1], 200, rng)
    for i, j in pairs:
        relate(sets[i], sets[j])
    row("mean of 200 near pairs", f"{best(lambda: [relate(sets[i], sets[j]) for i, j in pairs]) / len(pairs) * 1e6:.1f} us")


def mixture(discs: Discs, rng: np.random.Generator, regions: tuple[list, list]) -> tuple[list, list]:
    """Regions with the vertices and parts of their boundaries: points and open or closed lines."""
    sets, shapes = list(regions[0][:400]), list(regions[1][:400])
    plane, xy = discs.plane, discs.points
    for region in regions[0][400:1000]:
        darts = {int(plane.tail[d]): int(d) for d in region.darts}
        at = int(rng.choice(list(darts)))
        sets.append(Point(plane, at))
        shapes.append(shapely.Point(xy[at]))
        way = []
        for _ in range(int(rng.integers(5, len(darts)))):
            way.append(darts[at])
            at = int(plane.tail[darts[at] ^ 1])
        sets.append(Line(plane, tuple(sorted({d >> 1 for d in way}))))
        shapes.append(shapely.LineString(xy[[int(plane.tail[d]) for d in way] + [at]]))
    assert all(isinstance(x, Point | Line | Region) for x in sets)
    return sets, shapes


if __name__ == "__main__":
    main()
