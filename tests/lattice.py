"""Pieces of a square grid of places without names, random walks through them, and the walk logs that a robot would write."""

from __future__ import annotations

import random
from dataclasses import dataclass

from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader

STEPS = ((1, 0), (0, 1), (-1, 0), (0, -1))


@dataclass(frozen=True)
class Lattice:
    """A connected piece of a grid: for every crossing the directions of its ways, 0 to 3 for east, north, west, south."""

    ways: dict[tuple[int, int], tuple[int, ...]]

    @classmethod
    def whole(cls, columns: int, rows: int) -> Lattice:
        inside = {(x, y) for x in range(columns) for y in range(rows)}
        return cls({at: tuple(h for h in range(4) if _beyond(at, h) in inside) for at in sorted(inside)})

    def thinned(self, rng: random.Random, share: float) -> Lattice:
        """The same with some ways left out, as many as connection allows."""
        ways = {at: list(out) for at, out in self.ways.items()}
        for at in self.ways:
            for h in (0, 1):
                if h in ways[at] and rng.random() < share:
                    there = _beyond(at, h)
                    ways[at].remove(h)
                    ways[there].remove(h + 2)
                    if not _connected(ways):
                        ways[at] = sorted([*ways[at], h])
                        ways[there] = sorted([*ways[there], h + 2])
        return Lattice({at: tuple(out) for at, out in ways.items()})

    def walk(self, seed: int, legs: int, *, compass: bool = True, back: float = 0.1) -> tuple[Walk, list[tuple[int, int]]]:
        """A random walk, and the true place of every visit."""
        rng = random.Random(seed)
        at = rng.choice(sorted(self.ways))
        places, events = [at], [self._seen(at)]
        came: int | None = None
        for _ in range(legs):
            on = [h for h in self.ways[at] if h != came] or list(self.ways[at])
            h = came if came is not None and rng.random() < back else rng.choice(on)
            at, came = _beyond(at, h), (h + 2) % 4
            places.append(at)
            events += [Samples.of(Heading.from_degrees(90.0 * h)), self._seen(at)]
        return Walk(WalkHeader(compass=compass), tuple(events)), places

    def _seen(self, at: tuple[int, int]) -> Visit:
        return Visit(None, tuple(Heading.from_degrees(90.0 * h) for h in self.ways[at]))


def straight(*legs: str, exits: str = "NESW", names: dict[int, str] | None = None) -> Walk:
    """A walk by compass letters through places that all have the same exits; `names` of visits, counted from 0."""
    at = {letter: Heading.from_bearing(90.0 * k) for k, letter in enumerate("NESW")}
    seen = tuple(at[letter] for letter in exits)
    events: list[Samples | Visit] = [Visit((names or {}).get(0), seen)]
    for k, letter in enumerate("".join(legs), 1):
        events += [Samples.of(at[letter]), Visit((names or {}).get(k), seen)]
    return Walk(WalkHeader(), tuple(events))


def _beyond(at: tuple[int, int], h: int) -> tuple[int, int]:
    return at[0] + STEPS[h][0], at[1] + STEPS[h][1]


def _connected(ways: dict[tuple[int, int], list[int]]) -> bool:
    reached = [next(iter(ways))]
    for at in reached:
        reached += [there for h in ways[at] if (there := _beyond(at, h)) not in reached]
    return len(reached) == len(ways)
