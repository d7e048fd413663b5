"""From a walk log to a map: reading, stepping, building, on growing grids.

A robot explores a square grid with a third of its streets taken out, four samples a leg, one event a line: a log as a plain
recorder writes it. Times are the best of the runs; the walk is made and written outside the clock.
"""

from __future__ import annotations

import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks.clock import row, title
from ninefold.io.walks.json_lines import iter_events, read_header, read_walk, write_walk
from ninefold.mapping import Event, Mapper, Samples, SimulatedWorld, Visit, Walk, build, explore

SIZES = (1_000, 10_000, 100_000)
SEED = 1


def grid_world(legs: int, rng: np.random.Generator) -> SimulatedWorld:
    """A grid whose exploration takes about `legs` legs: two for every street."""
    side = max(3, round((legs / 2 / (2 * 2 / 3)) ** 0.5))
    row, column = np.divmod(np.arange(side * side), side)
    points = np.stack([column, row], axis=1) + rng.uniform(-0.2, 0.2, (side * side, 2))
    right = np.flatnonzero(column < side - 1)
    up = np.flatnonzero(row < side - 1)
    streets = np.concatenate([np.stack([right, right + 1], axis=1), np.stack([up, up + side], axis=1)])
    return SimulatedWorld(points, streets[rng.random(len(streets)) < 2 / 3])


def plain_log(legs: int, *, exits: bool) -> Walk:
    """A walk of about `legs` legs with four samples each, every sample an event of its own."""
    world = grid_world(legs, np.random.default_rng(SEED))
    found = explore(world, step=10.0, exits=exits)
    events: list[Event] = []
    for event in found.walk.events:
        if isinstance(event, Visit):
            events.append(event)
        else:
            first, last = event.yaw[0], event.yaw[-1]
            events += [Samples((yaw,)) for yaw in (first, first + 0.1, last + 0.1, last)]
    return Walk(found.walk.header, tuple(events))


def measure(legs: int, *, exits: bool, runs: int) -> dict[str, float]:
    """Best seconds of each stage."""
    walk = plain_log(legs, exits=exits)
    best: dict[str, float] = {}

    def clock(stage: str, since: float) -> None:
        best[stage] = min(best.get(stage, float("inf")), time.perf_counter() - since)

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "walk.jsonl"
        write_walk(walk, path)
        for _ in range(runs):
            start = time.perf_counter()
            log = read_walk(path)
            clock("read", start)
            start = time.perf_counter()
            mapper = Mapper(log.header)
            for event in log.events:
                mapper.step(event)
            clock("step", start)
            start = time.perf_counter()
            plane = mapper.plane
            clock("plane", start)
            start = time.perf_counter()
            again = build(read_walk(path))
            clock("file to map", start)
            assert again == plane
            start = time.perf_counter()
            online = Mapper(read_header(path))
            for event in iter_events(path):
                online.step(event)
            clock("streamed", start)
            assert online.plane == plane
    return {
        "legs": walk.n_legs,
        "events": len(walk.events),
        "edges": plane.n_edges,
        "closures": len(mapper.closures),
        **best,
    }


def main() -> None:
    measure(1_000, exits=True, runs=1)
    title("walk log to map", "events", "edges", "read", "step", "plane", "file to map", "streamed", "steps a second")
    for exits in (False, True):
        for legs in SIZES:
            found = measure(legs, exits=exits, runs=3)
            stages = (f"{found[stage]:.3f} s" for stage in ("read", "step", "plane", "file to map", "streamed"))
            row(
                f"{found['legs']:,.0f} legs, {found['closures']:,.0f} closures, {'with' if exits else 'no'} exits",
                *(f"{found['events']:,.0f}", f"{found['edges']:,.0f}", *stages, f"{found['events'] / found['step']:,.0f}"),
            )


if __name__ == "__main__":
    main()
