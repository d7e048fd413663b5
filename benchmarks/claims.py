"""Claims that visits are one place: how many wrong ones are found, how many right ones are rejected, and how long it takes.

**Dense**: 1,000 claims, 10 wrong, on walks of 2,000 legs in a 12 x 12 grid, where visits look alike by their exits; right
claims are pairs of visits to one place, wrong ones pairs that look alike. **Sparse**: few claims on one tour of a grid;
wrong ones are such that no congruence speaks against them, so that turning alone can settle it, for walks that leave no
exit untravelled. **Pose graphs**: drives through the bundled district, closures at every junction, wrong ones within 150 m
that say the robot faces the same way. Beside each the same without its main rule: congruence alone; every closure against
odometry alone.
"""

from __future__ import annotations

import random
import time
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from benchmarks.clock import row, title
from ninefold.io import judge_closures, samples
from ninefold.io.graphs.closures import ODDS, judge_of
from ninefold.io.graphs.g2o import parse
from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader, claims, explore, hypotheses

if TYPE_CHECKING:
    from ninefold.mapping import Claims

SEEDS = 3
STEPS = ((1, 0), (0, 1), (-1, 0), (0, -1))

Place = tuple[int, int]
Pair = tuple[int, int]


def grid_walk(side: int, seed: int, legs: int = 0) -> tuple[Walk, list[Place]]:
    """A walk along all ways of a grid, to the nearest new one each time, then at random; and the place of every visit."""
    rng = random.Random(seed)
    at = rng.randrange(side), rng.randrange(side)
    new = {frozenset((p, q)) for p in np.ndindex(side, side) for q in _beside(p, side).values()}
    true, taken = [at], []
    while new or len(taken) < legs:
        if new:
            path = _to_new(at, side, new, rng)
        else:
            path = [rng.choice([h for h in _beside(at, side) if h != (taken[-1] + 2) % 4])]
        for h in path:
            there = _beside(at, side)[h]
            new.discard(frozenset((at, there)))
            at = there
            true.append(at)
            taken.append(h)
    events: list[Visit | Samples] = []
    for t, p in enumerate(true):
        if t:
            events.append(Samples.of(Heading.from_degrees(90 * taken[t - 1])))
        events.append(Visit(None, tuple(Heading.from_degrees(90 * h) for h in _beside(p, side))))
    return Walk(WalkHeader(heading="yaw-deg"), tuple(events)), true


def _beside(p: Place, side: int) -> dict[int, Place]:
    there = {h: (p[0] + dx, p[1] + dy) for h, (dx, dy) in enumerate(STEPS)}
    return {h: q for h, q in there.items() if 0 <= q[0] < side and 0 <= q[1] < side}


def _to_new(at: Place, side: int, new: set[frozenset[Place]], rng: random.Random) -> list[int]:
    paths: dict[Place, list[int]] = {at: []}
    for p in (queue := [at]):
        ways = [h for h, q in _beside(p, side).items() if frozenset((p, q)) in new]
        if ways:
            return [*paths[p], rng.choice(ways)]
        for h, q in _beside(p, side).items():
            if q not in paths:
                paths[q] = [*paths[p], h]
                queue.append(q)
    raise AssertionError("every way of a grid can be reached")


def said(walk: Walk, true: list[Place], right: int, seed: int) -> tuple[list[tuple[int, int, float]], list[Pair]]:
    """Right claims with scores, and the pairs that look alike and are wrong, in random order."""
    rng = random.Random(seed)
    exits = [event.exits for event in walk.events if isinstance(event, Visit)]
    node = hypotheses(walk, closed=True, budget=0).tree.node_of
    pairs = [(i, j) for i, j in combinations(range(len(true)), 2) if exits[i] == exits[j] and node[i] != node[j]]
    good = [(i, j) for i, j in pairs if true[i] == true[j]]
    bad = [(i, j) for i, j in pairs if true[i] != true[j]]
    rng.shuffle(bad)
    return [(*pair, round(rng.uniform(0.5, 1.0), 2)) for pair in rng.sample(good, min(right, len(good)))], bad


def rejected(found: Claims) -> set[Pair]:
    return {(one.claim.a, one.claim.b) for one in found.rejected}


def dense() -> None:
    title("dense: 1,000 claims, 10 wrong, 12 x 12", "found", "wrongly", "exact", "CPU s")
    for seed in range(SEEDS):
        walk, true = grid_walk(12, seed, 2000)
        good, bad = said(walk, true, 990, seed)
        rng = random.Random(seed)
        given = [*good, *((*pair, round(rng.uniform(0.5, 1.0), 2)) for pair in bad[:10])]
        rng.shuffle(given)
        begin = time.process_time()
        found = claims(walk, given)
        seconds = time.process_time() - begin
        hit = rejected(found)
        row(
            f"seed {seed}, {len(true):,} visits",
            f"{len(hit & set(bad[:10]))}/10",
            len(hit - set(bad)),
            found.exact,
            f"{seconds:.2f}",
        )


def sparse() -> None:
    title("sparse: turning alone", "congruence", "found", "wrongly", "exact", "CPU s")
    for side, right, wrong in ((6, 12, 3), (8, 16, 4), (10, 40, 6)):
        for seed in range(SEEDS):
            walk, true = grid_walk(side, seed)
            given, others = said(walk, true, right, seed)
            bad: list[Pair] = []
            for pair in others:
                if len(bad) == wrong:
                    break
                if not claims(walk, [*given, *((*one, 0.7) for one in [*bad, pair])], budget=0).rejected:
                    bad.append(pair)
            every = [*given, *((*pair, 0.7) for pair in bad)]
            alone = rejected(claims(walk, every, budget=0))
            begin = time.process_time()
            found = claims(walk, every, closed=True)
            seconds = time.process_time() - begin
            hit = rejected(found)
            row(
                f"{side} x {side}, {len(every)} claims, seed {seed}",
                f"{len(alone & set(bad))}/{len(bad)}",
                f"{len(hit & set(bad))}/{len(bad)}",
                len(hit - set(bad)),
                found.exact,
                f"{seconds:.2f}",
            )


def drive(seed: int, wrong: int, odometry: tuple[float, float]) -> tuple[bytes, set[Pair]]:
    """A pose graph of a drive through the district, a pose at every junction and one halfway of each street."""
    rng = np.random.default_rng(seed)
    world = samples.load("helsinki_district").to_world()
    points = np.asarray(world.points)
    number = {name: k for k, name in enumerate(world.vertex_names)}
    walk = explore(world, seed=seed).walk
    at = [number[event.place] for event in walk.events if isinstance(event, Visit)]
    ends = points[at]
    middle = (ends[1:] + ends[:-1]) / 2
    where = np.empty((2 * len(at) - 1, 2))
    where[0::2], where[1::2] = ends, middle
    ahead = np.diff(where, axis=0)
    yaw = np.arctan2(ahead[:, 1], ahead[:, 0])
    yaw = np.append(yaw, yaw[-1])
    lines = []

    def edge(i: int, j: int, sigma: tuple[float, float], claimed: tuple[float, float, float] | None = None) -> None:
        away = where[j] - where[i]
        cos, sin = np.cos(yaw[i]), np.sin(yaw[i])
        true = (cos * away[0] + sin * away[1], -sin * away[0] + cos * away[1], yaw[j] - yaw[i])
        x, y, turn = np.array(claimed or true) + rng.normal(0, (sigma[0], sigma[0], sigma[1]))
        a, b = sigma[0] ** -2, sigma[1] ** -2
        lines.append(f"EDGE_SE2 {i} {j} {x:.9g} {y:.9g} {turn:.9g} {a:.9g} 0 0 {a:.9g} 0 {b:.9g}")

    for k in range(len(where) - 1):
        edge(k, k + 1, odometry)
    last: dict[int, int] = {}
    for stop, place in enumerate(at):
        if place in last:
            edge(2 * last[place], 2 * stop, (0.3, 0.03))
        last[place] = stop
    bad: set[Pair] = set()
    while len(bad) < wrong:
        i, j = sorted(rng.choice(len(at), 2, replace=False).tolist())
        if at[i] != at[j] and np.hypot(*(points[at[i]] - points[at[j]])) < 150 and (2 * i, 2 * j) not in bad:
            bad.add((2 * i, 2 * j))
            edge(2 * i, 2 * j, (0.3, 0.03), (0.0, 0.0, 0.0))
    return "\n".join(lines).encode(), bad


def pose_graphs() -> None:
    from scipy.special import gammainccinv

    limit = 2 * float(gammainccinv(1.5, ODDS))
    title("pose graphs: district, 20 wrong within 150 m", "odometry", "found", "wrongly", "CPU s")
    for odometry in ((0.1, 0.005), (0.5, 0.02), (1.0, 0.05)):
        for seed in range(3):
            content, bad = drive(seed, 20, odometry)
            begin = time.process_time()
            graph = parse(content, "drive.g2o")
            judged = judge_closures(graph)
            seconds = time.process_time() - begin
            hit = {(one.a, one.b) for one in judged.rejected}
            over = graph.closures[judge_of(graph).alone().ratio > limit]
            alone = {(int(graph.first[e]), int(graph.second[e])) for e in over}
            row(
                f"{graph.closures.size} closures, a step {odometry[0]:g} m {odometry[1]:g} rad, seed {seed}",
                f"{len(alone & bad)}/20",
                f"{len(hit & bad)}/20",
                len(hit - bad),
                f"{seconds:.2f}",
            )


def main() -> None:
    dense()
    sparse()
    pose_graphs()


if __name__ == "__main__":
    main()
