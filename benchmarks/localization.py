"""Finding a robot that was switched on somewhere: seconds a step, moves until certain, and how often it is right.

Two maps of about 5,000 junctions: random plane graphs (a triangulation thinned out) and a square grid with 15 % of its
streets missing, where places look alike. A robot stands at a random junction, lists its exits with Gaussian errors, takes
the best move, and so on until one place is 99.9 % certain. The localizer is told the true sigma. A step is one look and one
move; times are of the process, the median over all steps and their largest, after one trial that is not counted. The first
look is at all places, and shown apart.
"""

from __future__ import annotations

import time
from math import radians

import numpy as np

from benchmarks.clock import row, title
from benchmarks.worlds import braced
from ninefold.mapping import Heading, Localizer, PlaneMap

TRIALS = 40
MOST_MOVES = 40


def random_graph() -> PlaneMap:
    """A random plane graph of 5,000 junctions with about 3.3 exits each."""
    return PlaneMap.from_geometry(*braced(5_000, 0.33, seed=1))


def gappy_grid() -> PlaneMap:
    """A square grid of 4,900 junctions without 15 % of its streets; junctions left without any are left out."""
    side = 70
    down, right = np.divmod(np.arange(side * side), side)
    number = np.arange(side * side)
    streets = np.concatenate(
        [
            np.stack([number[right < side - 1], number[right < side - 1] + 1], axis=1),
            np.stack([number[down < side - 1], number[down < side - 1] + side], axis=1),
        ]
    )
    streets = streets[np.random.default_rng(2).random(len(streets)) < 0.85]
    used, ends = np.unique(streets, return_inverse=True)
    points = np.stack([right, down], axis=1)[used].astype(float)
    return PlaneMap.from_geometry(points, ends.reshape(-1, 2))


def exits_of(plane: PlaneMap) -> list[list[int]]:
    """The darts of the ways out of every place, counter-clockwise."""
    return [[d for d in plane.darts_at(v) if not plane.tether[d >> 1]] for v in range(plane.n_vertices)]


def trials(plane: PlaneMap, *, sigma: float, compass: bool) -> dict[str, float]:
    """Figures of all trials on a map."""
    assert plane.heading is not None
    exits = exits_of(plane)
    with_exits = [v for v, ways in enumerate(exits) if ways]
    rng = np.random.default_rng(0)
    switched_on = Localizer(plane, sigma=sigma, compass=compass)
    first, steps, best, moves, right = [], [], [], [], 0
    for trial in range(TRIALS + 1):
        at = with_exits[int(rng.integers(len(with_exits)))]
        robot, back = switched_on.fork(), None
        turned = 0.0 if compass else float(rng.uniform(-np.pi, np.pi))
        for move in range(MOST_MOVES):
            yaw = plane.heading[exits[at]] + rng.normal(0.0, sigma, len(exits[at])) + turned
            order = np.argsort(yaw % (2 * np.pi))
            ways = [exits[at][i] for i in order]
            seen = [Heading(float(yaw[i])) for i in order]
            came_by = None if back is None or compass else ways.index(back)
            begin = time.process_time()
            robot.observe(seen, came_by=came_by)
            looked = time.process_time() - begin
            if robot.certain:
                break
            begin = time.process_time()
            chosen = robot.best_move()
            best.append(time.process_time() - begin)
            begin = time.process_time()
            robot.move(chosen)
            (first if move == 0 else steps).append(looked + time.process_time() - begin)
            back = ways[chosen.exit] ^ 1
            at = int(plane.tail[back])
        if trial == 0:
            first, steps, best = [], [], []
            continue
        moves.append(move)
        right += robot.likeliest.vertex == plane.vertex_names[at]
    every = [*first, *steps]
    return {
        "step": 1e3 * float(np.median(every)) if every else 1e3 * looked,
        "first": 1e3 * float(np.median(first)) if first else 1e3 * looked,
        "longest": 1e3 * max(every, default=looked),
        "best": 1e3 * float(np.median(best)) if best else 0.0,
        "moves": float(np.median(moves)),
        "most": float(max(moves)),
        "right": right,
    }


def main() -> None:
    title("localization", "step", "first look", "longest", "best move", "moves", "most", "right")
    total = 0
    for name, plane in (("random graph", random_graph()), ("grid, 15 % missing", gappy_grid())):
        for compass in (True, False):
            for degrees in (2, 10):
                found = trials(plane, sigma=radians(degrees), compass=compass)
                total += int(found["right"])
                times = (f"{found[key]:.2f} ms" for key in ("step", "first", "longest", "best"))
                row(
                    f"{name}, {plane.n_vertices:,} places, {'compass' if compass else 'no compass'}, {degrees} deg",
                    *times,
                    *(f"{found[key]:g}" for key in ("moves", "most")),
                    f"{found['right']:g}/{TRIALS}",
                )
    row("right in all", total, f"of {8 * TRIALS}")


if __name__ == "__main__":
    main()
