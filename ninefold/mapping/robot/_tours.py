"""The order in which a simulated robot walks the ways of a world: tours as sequences of darts.

A tour is a generator, so that its random choices and those of whoever walks it come from one generator of random numbers in
the order in which they are made. It ends when every way that can be reached is walked.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    import numpy as np

    from .simulated_world import SimulatedWorld

__all__ = ["covering", "depth_first"]


def depth_first(world: SimulatedWorld, start: int, ways: int, rng: np.random.Generator | None) -> Iterator[int]:
    """Yield the darts of a walk that takes new exits first, and goes back the way it came where there is none.

    Parameters
    ----------
    start
        Vertex where it begins.
    ways
        Number of ways that can be reached from there.
    rng
        Shuffles the exits of each place; None takes them counter-clockwise from the way back.

    Notes
    -----
    Every way is walked twice at most. Complexity O(E log E), no recursion.
    """
    ends = world.edges.reshape(-1).tolist()
    walked = bytearray(len(world.edges))
    untried = {start: _choices(world, start, -1, rng)}
    trail = [(start, -1)]
    while ways:
        at, came = trail[-1]
        choices = untried[at]
        while choices and walked[choices[-1] >> 1]:
            choices.pop()
        if not choices:
            trail.pop()
            yield came ^ 1
            continue
        dart = choices.pop()
        walked[dart >> 1] = True
        ways -= 1
        yield dart
        there = ends[dart ^ 1]
        if there not in untried:
            untried[there] = _choices(world, there, dart ^ 1, rng)
            trail.append((there, dart))
        elif there != at and ways:
            yield dart ^ 1


def covering(world: SimulatedWorld, start: int, ways: int, rng: np.random.Generator | None) -> Iterator[int]:
    """Yield the darts of a walk that always goes to the nearest way not yet walked, over ways that it knows.

    Parameters
    ----------
    start, ways
        As for `depth_first`.
    rng
        Breaks ties between ways equally many legs away; None takes the first, counter-clockwise by place as they are found.

    Notes
    -----
    Nearest is the fewest legs. A way is a few legs away but for the last ones, so this is near O(E log E); O(E^2) at worst.
    """
    ends = world.edges.reshape(-1).tolist()
    walked = bytearray(len(world.edges))
    at = start
    while ways:
        came = {at: -1}
        ring, new = [at], [dart for dart in world.darts_at(at) if not walked[dart >> 1]]
        while not new:  # every place of the ring has walked ways alone, so the robot knows where they lead
            further = []
            for vertex in ring:
                for dart in world.darts_at(vertex):
                    there = ends[dart ^ 1]
                    if there not in came:
                        came[there] = dart
                        further.append(there)
            ring, new = further, [dart for v in further for dart in world.darts_at(v) if not walked[dart >> 1]]
        last = new[0] if rng is None else new[int(rng.integers(len(new)))]
        route = [last]
        while (dart := came[ends[route[-1]]]) >= 0:
            route.append(dart)
        walked[last >> 1] = True
        ways -= 1
        yield from reversed(route)
        at = ends[last ^ 1]


def _choices(world: SimulatedWorld, vertex: int, back: int, rng: np.random.Generator | None) -> list[int]:
    """Darts to try from a vertex, the first last."""
    darts = world.darts_at(vertex)
    if rng is not None:
        rng.shuffle(darts)
        return darts
    at = darts.index(back) + 1 if back >= 0 else 0
    return (darts[at:] + darts[:at])[::-1]
