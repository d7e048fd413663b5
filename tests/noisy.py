"""Walks whose headings err, with the truth beside them, and maps of a walk in a form that can be compared.

The walker keeps the dart of every leg, so that the true map is known leg by leg, parallel ways and loops included.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ninefold.mapping import Heading, PlaneMap, Samples, SimulatedWorld, Visit, Walk, WalkHeader
from ninefold.mapping.doubt.evidence import read_evidence
from ninefold.mapping.doubt.noise import NoiseModel
from ninefold.mapping.doubt.outcome import Outcome, outcome_of
from ninefold.mapping.doubt.reading import Reading

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

Seen = tuple[object, object, object]
"""A map as its walk saw it: legs shared out among ways, cyclic orders, darts on the outer face; see `seen`."""


@dataclass(frozen=True)
class Truth:
    """A walk, the world it was taken in, and the dart of the world that every leg followed."""

    world: SimulatedWorld
    walk: Walk
    darts: tuple[int, ...]


def walked(
    world: SimulatedWorld,
    darts: Sequence[int],
    rng: np.random.Generator,
    *,
    start: int | None = None,
    sigma: float,
    declared: float | None = None,
    drift: float = 0.0,
    compass: bool = True,
    kept: float = 0.9,
    exits: str | None = "any-order",
    listed: float = 1.0,
    step: float = 1e9,
    names: bool = False,
) -> Truth:
    """Walk along darts of a world and note what a robot reads.

    With a compass the bias keeps a share `kept` from place to place; without, it is a random walk from a random first one.
    `listed` is the chance that a visit has its list of exits. Rotations are true in whole turns at a long step too.
    """
    ends = world.edges.reshape(-1)
    at = int(ends[darts[0]]) if len(darts) else int(start or 0)
    bias = rng.normal(0, drift) if compass else rng.uniform(-np.pi, np.pi)
    events: list[Visit | Samples] = []

    def look(place: int, name: str | None) -> None:
        seen = None
        if exits is not None and rng.random() < listed:
            yaw = world.heading[world.darts_at(place)] + bias
            yaw = yaw + rng.normal(0, sigma, yaw.size)
            yaw = (yaw + np.pi) % (2 * np.pi) - np.pi
            yaw = np.roll(yaw, int(rng.integers(yaw.size)) if yaw.size else 0) if exits == "in-order" else np.sort(yaw)
            seen = tuple(map(Heading, yaw.tolist()))
        events.append(Visit(world.vertex_names[place], seen, name))

    look(at, None)
    for dart in darts:
        assert at == int(ends[dart])
        yaw, _ = world.sampled(dart, step)
        if len(yaw) == 1:
            yaw = np.repeat(yaw, 2)
        after = kept * bias + rng.normal(0, drift * np.sqrt(1 - kept**2)) if compass else bias + rng.normal(0, drift)
        read = yaw + np.linspace(bias, after, yaw.size) + rng.normal(0, sigma, yaw.size)
        events.append(Samples(tuple(read.tolist())))
        at, bias = int(ends[dart ^ 1]), after
        look(at, world.edge_names[dart >> 1] if names else None)
    header = WalkHeader(
        compass=compass, sigma=declared if declared is not None else sigma, drift=drift, exits=exits or "any-order"
    )
    return Truth(world, Walk(header, tuple(events)), tuple(int(d) for d in darts))


def without_names(walk: Walk) -> Walk:
    """The walk of a log that names no edges."""
    return Walk(walk.header, tuple(replace(e, edge=None) if isinstance(e, Visit) else e for e in walk.events))


def random_darts(world: SimulatedWorld, start: int, steps: int, rng: np.random.Generator) -> list[int]:
    """A random walk that seldom turns back."""
    ends = world.edges.reshape(-1)
    at, darts = start, []
    for _ in range(steps):
        around = world.darts_at(at)
        if not around:
            break
        fresh = [d for d in around if not darts or d != darts[-1] ^ 1]
        dart = int(rng.choice(fresh if fresh and rng.random() < 0.9 else around))
        darts.append(dart)
        at = int(ends[dart ^ 1])
    return darts


def every_dart(world: SimulatedWorld, start: int, rng: np.random.Generator) -> list[int]:
    """A depth-first tour: every way there and back, or twice."""
    ends = world.edges.reshape(-1)
    darts: list[int] = []
    walked_ways: set[int] = set()
    been = {start}
    path: list[int] = []
    at = start
    while True:
        fresh = [d for d in world.darts_at(at) if d >> 1 not in walked_ways]
        if fresh:
            dart = int(rng.choice(fresh))
            walked_ways.add(dart >> 1)
            darts.append(dart)
            to = int(ends[dart ^ 1])
            if to in been:
                darts.append(dart ^ 1)
            else:
                been.add(to)
                path.append(dart)
                at = to
        elif path:
            back = path.pop() ^ 1
            darts.append(back)
            at = int(ends[back ^ 1])
        else:
            return darts


def turned_first(ring: Sequence[object]) -> tuple[object, ...]:
    """A cyclic order from its least member on."""
    low = min(range(len(ring)), key=lambda i: repr(ring[i]))
    return (*ring[low:], *ring[:low])


def seen(plane: PlaneMap, ways: Sequence[Sequence[int]]) -> Seen:
    """A map in terms of the legs that went its ways: dart 2e is seen by the first leg of way e, 2e + 1 is its twin."""
    label = [(min(legs), side) for legs in ways for side in (0, 1)]
    shares = frozenset(frozenset(int(leg) for leg in legs) for legs in ways)
    orders = frozenset(
        turned_first([label[d] for d in plane.darts_at(v)]) for v in range(plane.n_vertices) if plane.darts_at(v)
    )
    outer = frozenset(label[d] for d in range(len(label)) if plane.face_of[d] == plane.outer_face)
    return shares, orders, outer


def true_seen(truth: Truth) -> Seen:
    """The true map of the ways that were walked, in the same form."""
    return seen(*true_plane(truth))


def true_plane(truth: Truth) -> tuple[PlaneMap, list[list[int]]]:
    """The true map of the ways that were walked, and the legs of each."""
    world = truth.world
    first: dict[int, int] = {}
    legs: dict[int, list[int]] = {}
    for leg, dart in enumerate(truth.darts):
        first.setdefault(dart >> 1, dart)
        legs.setdefault(dart >> 1, []).append(leg)
    number = {}
    for e, dart in enumerate(first.values()):
        number[dart], number[dart ^ 1] = 2 * e, 2 * e + 1
    n = 2 * len(first)
    tail, after, heading, turn = np.zeros(n, int), np.zeros(n, int), np.zeros(n), np.zeros(n // 2)
    ends = world.edges.reshape(-1)
    place: dict[int, int] = {}
    for dart in truth.darts:
        place.setdefault(int(ends[dart]), len(place))
        place.setdefault(int(ends[dart ^ 1]), len(place))
    for dart, row in number.items():
        tail[row], heading[row] = place[int(ends[dart])], world.heading[dart]
        around = [number[d] for d in world.darts_at(int(ends[dart])) if d in number]
        after[row] = around[(around.index(row) + 1) % len(around)]
    for e, dart in enumerate(first.values()):
        yaw, _ = world.sampled(dart, 1e9)
        turn[e] = yaw[-1] - yaw[0]
    plane = PlaneMap.from_darts(tail, after, n_vertices=max(len(place), 1), heading=heading, turn=turn)
    return plane, list(legs.values())


def outcome(walk: Walk, *, effort: int = 20_000) -> Outcome:
    """What `estimate` finds, with its readings."""
    header = walk.header
    assert header.sigma is not None
    noise = NoiseModel(header.sigma, header.drift or 0.0, compass=header.compass, in_order=header.exits == "in-order")
    return outcome_of(read_evidence(walk), noise, effort=effort)


def maps_seen(found: Outcome) -> Iterator[Seen]:
    """Every map that is left, in the form of `seen`."""
    for reading in found.readings:
        for one in reading.found():
            yield seen(one.plane, [way.legs.tolist() for way in reading.ways])


def holds(found: Outcome, true: Seen, *, most: int = 300) -> bool | None:
    """Whether a map is among those left: all at once where they are few, else factor by factor. None: not told."""
    if found.count is not None and found.count <= 300:
        return true in set(maps_seen(found))
    shares, orders, outer = true
    for reading in found.readings:
        ways = [way.legs.tolist() for way in reading.ways]
        if frozenset(map(frozenset, ways)) == shares:
            return _holds(reading, ways, orders, outer, most)
    return None if any(doubt.kind == "uncounted" for doubt in found.doubts) or found.count is None else False


def _holds(reading: Reading, ways: list[list[int]], orders: object, outer: object, most: int) -> bool | None:
    if reading.settled is None:
        return None
    label = [(min(legs), side) for legs in ways for side in (0, 1)]

    def is_true(place: int, number: int) -> bool:
        ring = [label[reading.darts[place][i]] for i in reading.orders[place][number].ways]
        return turned_first(ring) in orders

    if not all(any(is_true(place, n) for n in numbers) for place, numbers in reading.settled.left.items()):
        return False
    for factor in reading.settled.factors:
        if factor.count is None:
            return None
        for number in range(most):
            choice = factor.get(number)
            if choice is None:
                return False
            if all(is_true(*pair) for pair in choice.orders):
                break
        else:
            return None
    return True
