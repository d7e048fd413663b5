"""How far a robot goes until it knows what it wants to know: legs of strategies of exploration.

Until the map is complete: depth-first, nearest frontier (``covering``) and wall-following, on square grids without a share
of their streets, on the office and on the district; the mean over seeds, beside the number of ways, which no walk can beat.
Until a question is answered: whether a place is inside a block of the district or a few of them, asked of random places and
blocks, half of the places inside; legs of the ask-driven robot, against exploring everything nearest first.
Until one map is left: grids whose places look alike; legs of the doubt-driven robot, which recognises no place and is told
how many there are at most. Against an eager one, that takes the leg which leaves fewest maps from the beginning; against one
that does not compare maps, but goes to the nearest open exit of the smallest; and against the walk of a robot that
recognises every place and goes to the nearest new way, tour after tour, cut where one map is left for a reader that is not
told the places. A walk is given up after `MOST` legs and counted with that. In the first table of this kind the bound is the
true number of places, in the second twice that.
"""

from __future__ import annotations

import time

import numpy as np

from benchmarks.clock import row, title
from ninefold.io.sources import samples
from ninefold.mapping import AskDriven, DoubtDriven, OpenMap, PlaneMap, Region, SimulatedWorld, Visit, Walk, build, explore
from ninefold.mapping.doubt.likeness import likeness
from ninefold.mapping.doubt.quotients import QuotientSearch
from ninefold.mapping.doubt.walk_tree import fold

SEEDS = 10
QUESTIONS = 40
MOST = 150
DECISIONS = 200_000


def gappy_grid(side: int, missing: float, seed: int) -> SimulatedWorld:
    """A connected square grid without a share of its streets."""
    rng = np.random.default_rng(seed)
    number = np.arange(side * side).reshape(side, side)
    streets = np.concatenate(
        [
            np.stack([number[:, :-1].ravel(), number[:, 1:].ravel()], axis=1),
            np.stack([number[:-1].ravel(), number[1:].ravel()], axis=1),
        ]
    )
    down, right = np.divmod(number.ravel(), side)
    while True:
        world = SimulatedWorld(np.stack([right, down], axis=1), streets[rng.random(len(streets)) >= missing])
        if len(world.components()) == 1:
            return world


def complete() -> None:
    """Until everything is walked."""
    tours = ("depth-first", "covering", "wall")
    title("legs until the map is complete, mean over seeds", "ways", *tours)
    worlds = {
        "office": lambda seed: samples.load("office").to_world(),
        "district": lambda seed: samples.load("helsinki_district").to_world(),
        "grid 10 x 10": lambda seed: gappy_grid(10, 0.0, seed),
        "grid 10 x 10, 10 % missing": lambda seed: gappy_grid(10, 0.1, seed),
        "grid 10 x 10, 20 % missing": lambda seed: gappy_grid(10, 0.2, seed),
    }
    for name, make in worlds.items():
        legs: dict[str, list[int]] = {tour: [] for tour in tours}
        ways = []
        for seed in range(SEEDS):
            world = make(seed)
            ways.append(len(world.edges))
            for tour in tours:
                legs[tour].append(explore(world, seed=seed, tour=tour, step=1e6).walk.n_legs)
        row(name, f"{np.mean(ways):.0f}", *(f"{np.mean(legs[tour]):.0f}" for tour in tours))


def rings(plane: PlaneMap) -> list[list[str]]:
    """The places round every block, and every block with those beside it, that one simple cycle without parallels bounds."""
    found = []
    ends = [tuple(sorted(plane.tail[[d, d ^ 1]].tolist())) for d in range(0, plane.tail.size, 2)]
    for face in range(plane.n_faces):
        beside = set(plane.face_of[np.flatnonzero(plane.face_of == face) ^ 1].tolist())
        for faces in ({face}, {face} | beside):
            if plane.outer_face in faces:
                continue
            darts = Region.from_faces(plane, sorted(faces)).darts
            leaving = dict(zip(plane.tail[darts].tolist(), darts.tolist(), strict=True)) if darts.size > 2 else {}
            at, places = int(plane.tail[darts[0]]), []
            while len(leaving) == darts.size and (not places or at != places[0]):
                places.append(at)
                at = int(plane.tail[leaving[at] ^ 1])
            pairs = [tuple(sorted(pair)) for pair in zip(places, places[1:] + places[:1], strict=True)]
            if len(places) == darts.size and all(ends.count(pair) == 1 for pair in pairs):
                found.append([plane.vertex_names[v] for v in places])
    return found


def inside(plane: PlaneMap, ring: list[str]) -> list[str]:
    """The places inside a ring."""
    faces = set(plane.cycle(ring).faces)
    return [name for v, name in enumerate(plane.vertex_names) if set(plane.face_of[plane.darts_at(v)].tolist()) <= faces]


def answered() -> None:
    """Until it is known whether a place is inside a block."""
    title("legs until a question is answered, district", "median", "mean", "worst", "everything")
    world = samples.load("helsinki_district").to_world()
    full = explore(world, seed=0, tour="covering", step=1e6)
    plane = build(full.walk)
    blocks = rings(plane)
    rng = np.random.default_rng(0)
    legs: dict[str, list[int]] = {"inside": [], "outside": [], "boundary": []}
    within = [(name, ring) for ring in blocks for name in inside(plane, ring)]
    for k in range(QUESTIONS):
        name, ring = str(rng.choice(plane.vertex_names)), blocks[int(rng.integers(len(blocks)))]
        if k % 2:
            name, ring = within[int(rng.integers(len(within)))]
        question = AskDriven(name, ring)
        start = str(rng.choice(plane.vertex_names))
        walked = explore(world, start=start, tour=question, step=1e6).walk.n_legs
        assert question.answer is not None
        legs[question.answer].append(walked)
    everything = full.walk.n_legs
    for name, counts in (*legs.items(), ("all", [one for some in legs.values() for one in some])):
        if counts:
            row(f"{name}, {len(counts)}", f"{np.median(counts):.0f}", f"{np.mean(counts):.0f}", max(counts), everything)


class Limited:
    """A strategy that is given up after `MOST` legs."""

    def __init__(self, strategy: DoubtDriven) -> None:
        self.strategy, self.legs = strategy, -1

    def __call__(self, known: OpenMap) -> int | None:
        self.legs += 1
        return self.strategy(known) if self.legs < MOST else None


def one_left(walk: Walk, places: int) -> bool:
    """Whether a walk leaves exactly one map of so many places at most."""
    tree = fold(walk)
    search = QuotientSearch(tree, likeness(tree), most_places=places)
    found = 0
    while not search.done and found < 2 and search.decisions < DECISIONS:
        found += len(search.more(512, most=2))
    return search.done and found == 1


def legs_until_one_is_left(walk: Walk, places: int) -> int:
    """Legs of the shortest beginning of a walk that leaves one map, by bisection; `MOST` if there is none."""
    visits = [k for k, event in enumerate(walk.events) if isinstance(event, Visit)]
    low, high = 0, min(len(visits) - 1, MOST)
    if not one_left(Walk(walk.header, walk.events[: visits[high] + 1]), places):
        return MOST
    while high - low > 1:
        middle = (low + high) // 2
        if one_left(Walk(walk.header, walk.events[: visits[middle] + 1]), places):
            high = middle
        else:
            low = middle
    return high


def walked(world: SimulatedWorld, start: int, strategy: DoubtDriven) -> tuple[int, bool]:
    """Legs of a doubt-driven robot, and whether one map is left."""
    legs = explore(world, start=start, tour=Limited(strategy), places=False).walk.n_legs
    done = strategy.exact and strategy.left == 1
    return legs if done else MOST, done


def one_map(times: int, sides: tuple[tuple[int, float], ...]) -> None:
    """Until one map is left, of all with so many times the number of places at most."""
    title(
        f"legs until one map is left, bound {times} x the places", "ways", "doubt-driven", "eager", "not comparing",
        "recognising", "seconds", "undone",
    )  # fmt: skip
    for side, missing in sides:
        rows: list[tuple[int, ...]] = []
        seconds, undone = 0.0, 0
        for seed in range(SEEDS):
            world = gappy_grid(side, missing, seed)
            bound, start = times * len(world.points), seed % len(world.points)
            begin = time.process_time()
            doubt, done = walked(world, start, DoubtDriven(bound))
            seconds += time.process_time() - begin
            undone += not done
            eager, _ = walked(world, start, DoubtDriven(bound, eager=True))
            plain, _ = walked(world, start, DoubtDriven(bound, ahead=0))
            covering = explore(world, seed=seed, start=start, tour="covering", tours=3, places=False).walk
            rows.append((len(world.edges), doubt, eager, plain, legs_until_one_is_left(covering, bound)))
        means = (f"{mean:.1f}" for mean in np.mean(rows, axis=0))
        name = f"grid {side} x {side}" + (f", {missing:.0%} missing" if missing else "")
        row(name, *means, f"{seconds / SEEDS:.2f}", undone)


def main() -> None:
    complete()
    answered()
    one_map(1, ((3, 0.0), (3, 0.2), (4, 0.0), (4, 0.2), (5, 0.0), (5, 0.2), (6, 0.2)))
    one_map(2, ((2, 0.0), (3, 0.0), (3, 0.2)))


if __name__ == "__main__":
    main()
