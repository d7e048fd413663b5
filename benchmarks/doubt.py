"""Every map that explains a walk through places that look alike: seconds of the process until all maps are known.

Grids of identical places with a perfect compass. *Closed* asks for the maps in which no exit is left untravelled: there is
one, and the row counts the walks for which the search knows that within a minute. Five depth-first walks and five covering
walks each; median and worst of those that end. *All* counts all maps of the two covering walks whose counts are published.
The district is the bundled one, its names forgotten, headings held against each other within 10 degrees: how often one map
is left and is the true one. ``python -m benchmarks doubt`` runs all, ``python -m benchmarks.doubt district`` a part:
first_call, closed, all, pieces, district.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from math import radians

import numpy as np

from benchmarks.clock import row, title
from ninefold.io import samples
from ninefold.mapping import Hypotheses, Walk, WalkHeader, explore, hypotheses
from tests.alike import covering_walk, depth_first_walk, grid, observed, piece, same_places, without_names

MINUTE = 60.0
WALKS = {"depth-first": depth_first_walk, "covering": covering_walk}
GRIDS = ((6, "0.1 s"), (8, "1 s"), (10, "5 s (60 s)"), (12, "4 of 5"))


def clocked(job: Callable[[], Hypotheses]) -> tuple[float, Hypotheses]:
    """Seconds of the process, and what came out."""
    begin = time.process_time()
    found = job()
    return time.process_time() - begin, found


def spread(seconds: list[float]) -> tuple[str, str]:
    """Median and worst, as cells of a table."""
    return (f"{np.median(seconds):.2f} s", f"{max(seconds):.2f} s") if seconds else ("-", "-")


def closed_maps() -> None:
    """Grids, the maps without open exits."""
    title("closed maps of a grid", "whole", "median", "worst", "asked")
    for side, asked in GRIDS:
        world = grid(side, side)
        for name, walker in WALKS.items():
            seconds = []
            for seed in range(5):
                walk = observed(world, walker(world, seed))
                spent, found = clocked(lambda walk=walk: hypotheses(walk, closed=True, budget=MINUTE))
                if found.exact:
                    assert found.count == 1
                    assert same_places(found.maps[0].visits.tolist(), walker(world, seed).places(world))
                    seconds.append(spent)
            row(f"{side}x{side}, {name}", f"{len(seconds)}/5", *spread(seconds), asked)


def counts_of_all() -> None:
    """Grids, all maps."""
    title("all maps of a grid", "maps", "seconds")
    for columns, rows in ((3, 3), (3, 4), (4, 4)):
        world = grid(columns, rows)
        for seed in (0, 1):
            for compass in (True, False):
                walk = observed(world, covering_walk(world, seed), compass=compass)
                spent, found = clocked(lambda walk=walk: hypotheses(walk, budget=MINUTE))
                number = f"{found.count:,}" if found.exact else f"> {found.count:,}"
                row(
                    f"{columns}x{rows}, walk {'ab'[seed]}, {'compass' if compass else 'no compass'}",
                    number,
                    f"{spent:.3f} s",
                )


def pieces() -> None:
    """Pieces of the district, all maps and closed ones."""
    title("pieces of the district, 20 walks, 10 degrees", "whole", "median", "worst", "maps, median", "unique")
    for size in (10, 20, 40):
        for closed in (False, True):
            seconds, counts = [], []
            for seed in range(20):
                world = piece(seed, size)
                walk = observed(world, covering_walk(world, seed), tolerance=radians(10))
                spent, found = clocked(lambda walk=walk, closed=closed: hypotheses(walk, closed=closed or None, budget=10.0))
                if found.exact:
                    seconds.append(spent)
                    counts.append(found.count)
            row(
                f"{size} places, {'closed' if closed else 'all'}",
                f"{len(counts)}/20",
                *spread(seconds),
                f"{np.median(counts):g}" if counts else "-",
                f"{counts.count(1)}/20",
            )


def district() -> None:
    """The whole district, its names forgotten; 80 % unique in 60 s each, median 2 s, and never a wrong one are asked for."""
    title("district, names removed, 10 degrees, closed", "unique", "several", "wrong", "no answer", "median", "worst")
    world = samples.load("helsinki_district").to_world()
    every: list[float] = []
    total = 0
    for tour, seeds in (("depth-first", 20), ("covering", 10)):
        seconds, several, wrong, unknown = [], 0, 0, 0
        for seed in range(seeds):
            named = explore(world, seed=seed, tour=tour, step=10.0).walk  # type: ignore[arg-type]
            walk = without_names(Walk(WalkHeader(tolerance=radians(10)), named.events))
            spent, found = clocked(lambda walk=walk: hypotheses(walk, closed=True, budget=MINUTE))
            if not found.exact:
                unknown += 1
            elif found.count == 1 and same_places(found.maps[0].visits.tolist(), named.places):
                seconds.append(spent)
            else:
                several += found.count > 1
                wrong += found.count <= 1
        row(tour, f"{len(seconds)}/{seeds}", several, wrong, unknown, *spread(seconds))
        every += seconds
        total += seeds
    row("both", f"{len(every)}/{total}", "", "", "", *spread(every))


def first_call() -> None:
    """A new process that compiles the kernels, beside one that finds them compiled."""
    title("first call in a new process, closed 8x8", "compiles", "after that", "asked")
    code = (
        "import time; begin = time.process_time()\n"
        "from tests.alike import covering_walk, grid, observed\n"
        "from ninefold.mapping import hypotheses\n"
        "world = grid(8, 8); hypotheses(observed(world, covering_walk(world, 0)), closed=True)\n"
        "print(time.process_time() - begin)"
    )
    with tempfile.TemporaryDirectory() as folder:
        seconds = []
        for _ in range(2):
            done = subprocess.run(
                [sys.executable, "-c", code],
                env={**os.environ, "NUMBA_CACHE_DIR": folder},
                capture_output=True,
                text=True,
                check=True,
            )
            seconds.append(f"{float(done.stdout):.1f} s")
    row("process time", *seconds, "10 s")


PARTS = {"first_call": first_call, "closed": closed_maps, "all": counts_of_all, "pieces": pieces, "district": district}


def main(parts: list[str] | None = None) -> None:
    small = grid(3, 3)
    hypotheses(observed(small, covering_walk(small, 0)), closed=True)  # imports
    for name in parts or PARTS:
        PARTS[name]()


if __name__ == "__main__":
    main(sys.argv[1:])
