"""Walks through places that look alike: grids of identical places, and simulated worlds with all names taken out."""

from __future__ import annotations

import random
from dataclasses import replace
from math import radians

from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader

STEPS = ((1, 0), (0, 1), (-1, 0), (0, -1))


def grid(width: int, height: int) -> dict[tuple[int, int], list[int]]:
    """The directions, in quarter turns from east, that lead on from every place of a grid."""
    return {
        (x, y): [h for h, (dx, dy) in enumerate(STEPS) if 0 <= x + dx < width and 0 <= y + dy < height]
        for x in range(width)
        for y in range(height)
    }


def beyond(place: tuple[int, int], h: int) -> tuple[int, int]:
    return place[0] + STEPS[h][0], place[1] + STEPS[h][1]


def walk_of(width: int, height: int, start: tuple[int, int], moves: list[int]) -> tuple[Walk, list[tuple[int, int]]]:
    """A walk in a grid with a perfect compass, and the true places of its visits."""
    world, at = grid(width, height), start

    def visit() -> Visit:
        return Visit(None, exits=tuple(Heading.from_degrees(90 * h) for h in world[at]))

    events, places = [visit()], [at]
    for h in moves:
        at = beyond(at, h)
        events += [Samples.of(Heading.from_degrees(90 * h), Heading.from_degrees(90 * h)), visit()]
        places.append(at)
    return Walk(WalkHeader(), tuple(events)), places


def laps(width: int, height: int, seed: int, moves: int) -> tuple[Walk, list[tuple[int, int]]]:
    """A random walk that never turns back, and so goes round and round."""
    world, rng = grid(width, height), random.Random(seed)
    at = start = rng.choice(sorted(world))
    taken: list[int] = []
    for _ in range(moves):
        ahead = [h for h in world[at] if not taken or h != (taken[-1] + 2) % 4]
        taken.append(rng.choice(ahead))
        at = beyond(at, taken[-1])
    return walk_of(width, height, start, taken)


def covering(width: int, height: int, seed: int) -> tuple[Walk, list[tuple[int, int]]]:
    """A walk that takes a random way not yet walked, or goes to the nearest place that has one, until all are walked."""
    world, rng = grid(width, height), random.Random(seed)
    at = start = rng.choice(sorted(world))
    taken: list[int] = []
    left = {frozenset((place, beyond(place, h))) for place in world for h in world[place]}
    while left:
        paths = [(at, [])]
        seen = {at}
        for place, path in paths:
            new = [h for h in world[place] if frozenset((place, beyond(place, h))) in left]
            if new:
                path.append(rng.choice(new))
                break
            for h in world[place]:
                if beyond(place, h) not in seen:
                    seen.add(beyond(place, h))
                    paths.append((beyond(place, h), [*path, h]))
        for h in path:
            left.discard(frozenset((at, beyond(at, h))))
            taken.append(h)
            at = beyond(at, h)
    return walk_of(width, height, start, taken)


def unrecognised(walk: Walk, degrees: float) -> Walk:
    """The walk with all names taken out, headings to be held together within so many degrees."""
    events = [replace(event, place=None, edge=None) if isinstance(event, Visit) else event for event in walk.events]
    return Walk(replace(walk.header, tolerance=radians(degrees)), tuple(events))
