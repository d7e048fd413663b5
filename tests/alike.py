"""Small worlds of places that look alike, walks through them, and what a robot that recognises no place writes down.

A world is combinatorial: every place has exits, every exit leads along a way with a net turn to an exit of some place. The
walks make the same random choices as the walks whose hypotheses were counted by others, so that those counts hold here.
"""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import ceil, pi
from typing import NamedTuple

import numpy as np

from ninefold.io import samples
from ninefold.mapping import Heading, PlaneMap, Samples, Visit, Walk, WalkHeader

FINE = 0.02
"""Tolerance of walks whose headings do not err."""


class Way(NamedTuple):
    """Where an exit leads: the place, the exit by which it is reached, and the net turn on the way there, radians."""

    place: int
    exit: int
    turn: float


@dataclass(frozen=True)
class AlikeWorld:
    """The yaws of every place's exits, radians, counter-clockwise; and where each leads."""

    exits: tuple[tuple[float, ...], ...]
    ways: tuple[tuple[Way, ...], ...]

    @property
    def n_ways(self) -> int:
        return sum(map(len, self.exits)) // 2

    def way_at(self, place: int, x: int) -> frozenset[tuple[int, int]]:
        """The way behind an exit, the same from either end."""
        way = self.ways[place][x]
        return frozenset(((place, x), (way.place, way.exit)))


@dataclass(frozen=True)
class Tour:
    """Where a robot begins, and the exits it takes one after another."""

    start: int
    taken: tuple[int, ...]

    def places(self, world: AlikeWorld) -> tuple[int, ...]:
        """The true place of every visit."""
        found = [self.start]
        for x in self.taken:
            found.append(world.ways[found[-1]][x].place)
        return tuple(found)


def grid(columns: int, rows: int) -> AlikeWorld:
    """A grid whose places look alike wherever they have the same exits: inside, and along each side."""
    steps = ((1, 0), (0, 1), (-1, 0), (0, -1))
    row = {(x, y): x * rows + y for x in range(columns) for y in range(rows)}
    open_to = {at: [h for h, (dx, dy) in enumerate(steps) if (at[0] + dx, at[1] + dy) in row] for at in row}
    ways = []
    for (x, y), headings in open_to.items():
        ends = [(h, (x + steps[h][0], y + steps[h][1])) for h in headings]
        ways.append(tuple(Way(row[there], open_to[there].index((h + 2) % 4), 0.0) for h, there in ends))
    return AlikeWorld(tuple(tuple(h * pi / 2 for h in headings) for headings in open_to.values()), tuple(ways))


def of_map(plane: PlaneMap) -> AlikeWorld:
    """The places of a plane map with headings; tethers are no ways."""
    assert plane.heading is not None
    row: dict[int, tuple[int, int]] = {}
    stars = []
    for v in range(plane.n_vertices):
        darts = sorted((d for d in plane.darts_at(v) if not plane.tether[d >> 1]), key=lambda d: plane.heading[d])
        row |= {d: (v, x) for x, d in enumerate(darts)}
        stars.append(darts)
    return AlikeWorld(
        tuple(tuple(float(plane.heading[d]) for d in darts) for darts in stars),
        tuple(tuple(Way(*row[d ^ 1], float(plane.turn[d >> 1]) * (-1 if d & 1 else 1)) for d in darts) for darts in stars),
    )


@cache
def district() -> AlikeWorld:
    """The bundled streets, their names forgotten."""
    return of_map(samples.load("helsinki_district").to_map())


def piece(seed: int, size: int, *, dead_ends: bool = True) -> AlikeWorld:
    """Some places of the district near each other, with their ways; ways that lead out of it are dead ends, or left out."""
    world = district()
    rng = random.Random(seed)
    order = [rng.choice([v for v, star in enumerate(world.exits) if star])]
    inside = set(order)
    for v in order:
        for way in rng.sample(world.ways[v], len(world.ways[v])):
            if way.place not in inside and len(inside) < size:
                inside.add(way.place)
                order.append(way.place)
    row = {v: i for i, v in enumerate(order)}
    stars: list[list[float]] = [[] for _ in order]
    ways: list[list[Way]] = [[] for _ in order]
    kept = {v: [x for x, way in enumerate(world.ways[v]) if dead_ends or way.place in inside] for v in order}
    for v in order:
        for x in kept[v]:
            way = world.ways[v][x]
            stars[row[v]].append(world.exits[v][x])
            if way.place in inside:
                ways[row[v]].append(Way(row[way.place], kept[way.place].index(way.exit), way.turn))
            else:
                ways[row[v]].append(Way(len(stars), 0, way.turn))
                stars.append([world.exits[way.place][way.exit]])
                ways.append([Way(row[v], len(ways[row[v]]) - 1, -way.turn)])
    return AlikeWorld(tuple(map(tuple, stars)), tuple(map(tuple, ways)))


def covering_walk(world: AlikeWorld, seed: int) -> Tour:
    """Take a random exit not taken yet, or else go to the nearest place that has one, until every way is walked."""
    rng = random.Random(seed)
    at = start = rng.choice(range(len(world.exits)))
    seen: set[frozenset[tuple[int, int]]] = set()
    taken: list[int] = []
    while len(seen) < world.n_ways:
        fresh = [x for x in range(len(world.exits[at])) if world.way_at(at, x) not in seen]
        path = [rng.choice(fresh)] if fresh else _way_to_fresh(world, at, seen)
        for x in path:
            seen.add(world.way_at(at, x))
            taken.append(x)
            at = world.ways[at][x].place
    return Tour(start, tuple(taken))


def _way_to_fresh(world: AlikeWorld, at: int, seen: set[frozenset[tuple[int, int]]]) -> list[int]:
    queue: deque[tuple[int, list[int]]] = deque([(at, [])])
    met = {at}
    while queue:
        v, path = queue.popleft()
        if any(world.way_at(v, x) not in seen for x in range(len(world.exits[v]))):
            return path
        for x, way in enumerate(world.ways[v]):
            if way.place not in met:
                met.add(way.place)
                queue.append((way.place, [*path, x]))
    raise AssertionError("a world is connected")


def depth_first_walk(world: AlikeWorld, seed: int) -> Tour:
    """Take a fresh exit; come straight back from a place that is known; go back the way first come when nothing is fresh.

    This walker is told which places it knows.
    """
    rng = random.Random(seed)
    start = rng.choice(range(len(world.exits)))
    seen: set[frozenset[tuple[int, int]]] = set()
    known = {start}
    taken: list[int] = []
    degree = list(map(len, world.exits))
    stack = [(start, -1, rng.sample(range(degree[start]), degree[start]))]
    while len(seen) < world.n_ways:
        at, came_by, fresh = stack[-1]
        while fresh and world.way_at(at, fresh[-1]) in seen:
            fresh.pop()
        if not fresh:
            stack.pop()
            taken.append(came_by)
            continue
        x = fresh.pop()
        way = world.ways[at][x]
        seen.add(world.way_at(at, x))
        taken.append(x)
        if way.place not in known:
            known.add(way.place)
            stack.append((way.place, way.exit, rng.sample(range(degree[way.place]), degree[way.place])))
        elif len(seen) < world.n_ways:
            taken.append(way.exit)
    return Tour(start, tuple(taken))


def observed(
    world: AlikeWorld, tour: Tour, *, compass: bool = True, tolerance: float = FINE, noise: float = 0.0, seed: int = 0
) -> Walk:
    """What a robot that recognises no place writes down.

    Parameters
    ----------
    compass
        False: yaws are from a direction of the robot's own, which errors of its gyro turn a little on every leg.
    noise
        Every reading errs by up to this, uniformly, radians, and without a compass the gyro by as much on every leg. Up to
        half the tolerance, or a third without a compass, the truth explains the walk.
    seed
        Of the errors and of that direction.
    """
    rng = np.random.default_rng(seed)
    frame = 0.0 if compass else float(rng.uniform(-pi, pi))

    def read(yaw: float) -> float:
        return yaw + frame + (float(rng.uniform(-noise, noise)) if noise else 0.0)

    def visit(place: int) -> Visit:
        return Visit(None, tuple(Heading(read(yaw)) for yaw in world.exits[place]))

    at = tour.start
    events: list[Visit | Samples] = [visit(at)]
    for x in tour.taken:
        way = world.ways[at][x]
        out = read(world.exits[at][x])
        if noise and not compass:
            frame += float(rng.uniform(-noise, noise))
        arrived = read(world.exits[at][x] + way.turn)
        count = max(2, ceil(abs(arrived - out) / (pi / 4)) + 1)
        events.append(Samples(tuple(np.linspace(out, arrived, count).tolist())))
        at = way.place
        events.append(visit(at))
    return Walk(WalkHeader(compass=compass, tolerance=tolerance), tuple(events))


def without_names(walk: Walk) -> Walk:
    """The walk of a robot that did not recognise any place or way."""
    return replace(
        walk,
        events=tuple(replace(event, place=None, edge=None) if isinstance(event, Visit) else event for event in walk.events),
    )


def same_places(first: Sequence[int], second: Sequence[int]) -> bool:
    """Whether two numberings of the visits make the same ones one place."""
    pairs = set(zip(first, second, strict=True))
    return len(pairs) == len(set(first)) == len(set(second))
