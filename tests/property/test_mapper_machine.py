"""A machine that walks, errs, forks, stores, is killed and opens again, against a list of events and the true geometry.

The model is as plain as can be: the list of events that were accepted, of which `build` makes a map in one go, and the part
of a random world that they explored, of which `PlaneMap.from_geometry` does. A `Mapper`, its forks, and an `Atlas` that
follows with a lag must agree with it after every step; whatever is refused must leave no trace.
"""

from __future__ import annotations

import math
import os
import shutil
import tempfile
from contextlib import ExitStack
from copy import copy
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest
from explored import same_up_to_numbering, simulated, true_map
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule
from naive import de9im
from worlds import KINDS, random_sets

from ninefold.errors import AmbiguousDart, AtlasError, BadInput, NotPlane, UnknownName, WalkError
from ninefold.io import Atlas, Statement
from ninefold.mapping import Heading, Line, Mapper, PlaneMap, Point, Samples, SimulatedWorld, Visit, Walk, WalkHeader, build
from ninefold.reasoner import relate

TAU = 2 * math.pi
MOST_SETS = 5
MEMORY = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None  # every commit waits for the disk, where there is one


@dataclass
class Robot:
    """A mapper, what it was told, and where in the true world it is."""

    world: SimulatedWorld
    mapper: Mapper
    rng: np.random.Generator
    noise: float
    at: int
    events: list[Visit | Samples] = field(default_factory=list)
    dart: int = -1  # of the leg it is on
    ends: tuple[float, float] = (0.0, 0.0)  # of that leg, looking along it and back
    edges: dict[int, str] = field(default_factory=dict)  # the ways it walked, in order, and what they are called
    seen: list[int] = field(default_factory=list)
    declared: set[int] = field(default_factory=set)
    first: dict[int, int] = field(default_factory=dict)  # the dart along which each way was first walked
    misses: dict[int, list[float]] = field(default_factory=dict)  # how far off each reading of a dart's heading was

    def fork(self) -> Robot:
        other = copy(self)
        other.mapper = self.mapper.fork()
        other.events, other.edges = self.events.copy(), self.edges.copy()
        other.seen, other.declared, other.first = self.seen.copy(), self.declared.copy(), self.first.copy()
        other.misses = {dart: found.copy() for dart, found in self.misses.items()}
        return other

    def take(self, event: Visit | Samples) -> None:
        self.mapper.step(event)
        self.events.append(event)

    def name(self, vertex: int) -> str:
        return self.world.vertex_names[vertex]

    @property
    def ahead(self) -> int:
        """The place at the end of the leg it is on."""
        return int(self.world.edges.reshape(-1)[self.dart ^ 1])

    def noisy(self, yaw):
        return yaw + self.rng.normal(0.0, self.noise, len(yaw)) if self.noise else yaw

    def yaws(self, dart: int) -> list[float]:
        """What it senses along a dart, each yaw by any number of whole turns off."""
        yaw = self.noisy(self.world.sampled(dart, 150.0)[0])
        return (yaw + TAU * self.rng.integers(-1, 2, len(yaw))).tolist()

    def exits(self, vertex: int) -> list[Heading]:
        yaws = self.noisy(self.world.heading[self.world.darts_at(vertex)])
        return [Heading(yaw) for yaw in self.rng.permutation(yaws).tolist()]

    def choose(self, choice: int, fresh: bool) -> int:
        """A dart to leave by, one never walked if there is one and `fresh`."""
        darts = self.world.darts_at(self.at)
        untried = [d for d in darts if d >> 1 not in self.edges]
        pool = untried if fresh and untried else darts
        return pool[choice % len(pool)]

    def leave(self, dart: int, parts: int) -> None:
        yaws = self.yaws(dart)
        for piece in np.array_split(yaws, min(parts, len(yaws))):
            self.take(Samples(tuple(piece.tolist())))
        self.dart, self.ends = dart, (yaws[0], yaws[-1] + math.pi)

    def arrive(self, sees_exits: bool, named: bool) -> None:
        place, edge = self.ahead, self.dart >> 1
        exits = tuple(self.exits(place)) if sees_exits else None
        known = self.edges.get(edge)
        name = self.world.edge_names[edge] if known is None else known
        self.take(Visit(self.name(place), exits, name if named else None))
        if known is None:
            self.edges[edge] = name if named else f"e{len(self.edges)}"
        self.first.setdefault(edge, self.dart)
        for dart, yaw in zip((self.dart, self.dart ^ 1), self.ends, strict=True):
            self.misses.setdefault(dart, []).append(math.remainder(yaw - self.world.heading[dart], TAU))
        if place not in self.seen:
            self.seen.append(place)
        if sees_exits:
            self.declared.add(place)
        self.at, self.dart = place, -1

    def walk(self, way: list[tuple[int, bool, bool]]) -> None:
        """Walk on, by ways never walked where there are some."""
        for choice, sees_exits, named in way:
            if self.dart < 0:
                self.leave(self.choose(choice, fresh=True), 1)
            self.arrive(sees_exits, named)

    def known_at(self, vertex: int) -> list[int]:
        """The darts of a place whose directions the mapper knows: walked, or an exit it was shown."""
        return [d for d in self.world.darts_at(vertex) if vertex in self.declared or d >> 1 in self.edges]

    def check(self) -> None:
        """Hold the mapper against the events and against the true world."""
        mapper, plane = self.mapper, self.mapper.plane
        plane.validate()
        assert plane.n_vertices - plane.n_edges + plane.n_faces == 2
        assert plane == build(Walk(mapper.header, tuple(self.events)))
        same_up_to_numbering(plane, true_map(self.world, self.seen, self.edges), 5 * self.noise + 1e-9)
        for edge, name in self.edges.items():  # headings are the mean of all passes
            row, dart = plane.edge_names.row(name), self.first[edge]
            for found, true in ((plane.heading[2 * row], dart), (plane.heading[2 * row + 1], dart ^ 1)):
                mean = self.world.heading[true] + sum(self.misses[true]) / len(self.misses[true])
                assert abs(math.remainder(found - mean, TAU)) < 1e-9
        assert mapper.n_events == len(self.events)
        assert (mapper.n_vertices, mapper.n_edges, mapper.n_faces) == (plane.n_vertices, plane.n_edges, plane.n_faces)
        assert (mapper.place, mapper.on_leg) == (self.name(self.at), self.dart >= 0)
        assert len(mapper.closures) == plane.n_edges - plane.n_vertices + 1
        faces = set(zip(mapper.face_of.tolist(), plane.face_of.tolist(), strict=True))
        assert len(faces) == len({a for a, _ in faces}) == len({b for _, b in faces})
        assert (plane.face_of[mapper.outer] == plane.outer_face) if plane.n_edges else mapper.outer == -1
        untried = [self.name(v) for v in self.declared for d in self.world.darts_at(v) if d >> 1 not in self.edges]
        assert sorted(place for place, _ in mapper.open_exits) == sorted(untried)
        assert len(mapper.warnings) == (self.dart >= 0) + bool(untried)


def state(mapper: Mapper) -> tuple:
    """All that a mapper shows."""
    plane = mapper.plane if mapper.n_vertices else None
    counts = (mapper.n_events, mapper.n_vertices, mapper.n_edges, mapper.n_faces, mapper.outer, mapper.on_leg, mapper.place)
    arrays = (mapper.face_of.tobytes(), mapper.residuals.tobytes())
    return (*counts, *arrays, mapper.closures, mapper.open_exits, mapper.warnings, plane)


def contents(atlas: Atlas) -> tuple:
    """All that an atlas holds."""
    sets = {name: (type(x), x.text) for name, x in atlas.sets.items()} if atlas.n_events else {}
    return atlas.walk, sets, atlas.kinds, atlas.statements, atlas.provenance, atlas.warnings, atlas.origin


choices = st.integers(0, 999)
rarely = st.sampled_from([False, False, False, True])
legs = st.tuples(choices, rarely, st.booleans())  # which way, whether the exits are seen at its end, whether it is named
is_open = precondition(lambda self: self.atlas is not None)
at_a_place = precondition(lambda self: self.robot.dart < 0)
on_a_leg = precondition(lambda self: self.robot.dart >= 0)
has_ways = precondition(lambda self: bool(self.robot.world.darts_at(self.robot.at)))


class Exploring(RuleBasedStateMachine):
    atlas: Atlas | None = None

    @initialize(
        seed=st.integers(0, 2**32 - 1), kind=st.sampled_from(KINDS), size=st.sampled_from([9, 13, 20, 27, 2]),
        noisy=st.booleans(), sees_exits=st.booleans(), way=st.lists(legs, max_size=12),
        stores=st.booleans(),
    )  # fmt: skip
    def begin(self, seed, kind, size, noisy, sees_exits, way, stores):
        world = simulated(seed, kind, size)
        tolerance = min(0.02, world.narrowest / 3)
        rng = np.random.default_rng(seed)
        largest = max(world.components(), key=len)
        start = largest[seed % len(largest)]
        header = WalkHeader(tolerance=tolerance)
        self.robot = Robot(world, Mapper(header), rng, tolerance / 40 if noisy else 0.0, start)
        self.other: Robot | None = None
        self.resting: tuple | None = None
        self.stack = ExitStack()
        self.folder = Path(self.stack.enter_context(tempfile.TemporaryDirectory(dir=MEMORY)))
        self.files = 0
        self.path = self.folder / "0.atlas"
        self.atlas = Atlas.create(self.path, header=header)
        self.stored = 0
        self.sets: dict[str, tuple] = {}
        self.relations: dict[tuple[str, str], str] = {}
        self.statements: list[Statement] = []
        self.refused(WalkError, Samples((0.0,)))  # a heading before the first place
        self.refused(WalkError, Visit("hall", edge="door"))  # an edge that led to the first place
        self.robot.seen.append(start)
        self.robot.take(Visit(self.robot.name(start), tuple(self.robot.exits(start)) if sees_exits else None))
        if sees_exits:
            self.robot.declared.add(start)
        if world.darts_at(start):
            self.robot.walk(way)
        if stores:
            self.store(len(self.robot.events), together=True)

    def teardown(self):
        if hasattr(self, "stack"):
            if self.atlas is not None:
                self.atlas.close()
            self.stack.close()

    # -- walking -------------------------------------------------------------------------------------------------------

    @rule(way=st.lists(legs, min_size=2, max_size=12))
    @at_a_place
    @has_ways
    def walk_on(self, way):
        self.robot.walk(way)

    @rule(choice=choices, fresh=st.booleans(), parts=st.integers(1, 3))
    @at_a_place
    @has_ways
    def leave(self, choice, fresh, parts):
        self.robot.leave(self.robot.choose(choice, fresh), parts)

    @rule(sees_exits=rarely, named=st.booleans())
    @on_a_leg
    def arrive(self, sees_exits, named):
        self.robot.arrive(sees_exits, named)

    @rule(times=st.integers(1, 3))
    @at_a_place
    @has_ways
    def revisit(self, times):
        """There and back along one way."""
        dart = self.robot.choose(0, fresh=False)
        for _ in range(2 * times):
            self.robot.leave(dart, 1)
            self.robot.arrive(False, False)
            dart ^= 1

    # -- what is refused -----------------------------------------------------------------------------------------------

    def refused(self, error, *events):
        """The last of these events is refused, by a mapper and by an atlas that takes all in one go; nothing has changed."""
        robot, before = self.robot, state(self.robot.mapper)
        mapper = robot.mapper if len(events) == 1 else robot.mapper.fork()
        for event in events[:-1]:
            mapper.step(event)
        almost = state(mapper)
        with pytest.raises(error) as caught:
            mapper.step(events[-1])
        assert str(caught.value).startswith(f"event {len(robot.events) + len(events)}: ")
        assert "\n" not in str(caught.value)
        assert state(mapper) == almost
        assert state(robot.mapper) == before
        if self.atlas is not None:
            kept = contents(self.atlas)
            with pytest.raises(error) as again:
                self.atlas.extend([*robot.events[self.stored :], *events])
            assert str(again.value) == str(caught.value)
            assert contents(self.atlas) == kept
        return caught.value

    @rule(choice=choices)
    def out_of_order(self, choice):
        robot = self.robot
        self.refused(WalkError, Visit(None))
        if robot.dart < 0:
            self.refused(WalkError, Visit(robot.name(robot.seen[choice % len(robot.seen)])))  # no leg led there
        else:
            last = robot.events[-1].yaw[-1]
            self.refused(WalkError, Samples((last + math.pi,)))  # half a turn, either way round

    @rule(choice=choices)
    @precondition(lambda self: self.robot.dart >> 1 in self.robot.edges)
    def known_way_to_another_place(self, choice):
        others = [self.robot.name(v) for v in self.robot.seen if v != self.robot.ahead] + ["elsewhere"]
        self.refused((WalkError, AmbiguousDart), Visit(others[choice % len(others)]))

    @rule()
    @on_a_leg
    def another_name_for_an_edge(self):
        robot = self.robot
        place = robot.name(robot.ahead)
        if robot.dart >> 1 in robot.edges:
            self.refused(WalkError, Visit(place, robot.exits(robot.ahead), "another"))
        elif robot.edges:
            self.refused(WalkError, Visit(place, robot.exits(robot.ahead), next(iter(robot.edges.values()))))

    @rule(choice=choices)
    @on_a_leg
    def other_exits(self, choice):
        """Two exits too close to each other, one known direction missing, or one too many."""
        robot, place = self.robot, self.robot.ahead
        exits, name = robot.exits(place), robot.name(self.robot.ahead)
        close = (*exits, Heading(exits[0].yaw + robot.mapper.tolerance / 2))
        self.refused(AmbiguousDart, Visit(name, close))
        known = robot.known_at(place)
        if known:
            gone = robot.world.heading[known[choice % len(known)]]
            left = tuple(h for h in exits if abs(math.remainder(h.yaw - gone, TAU)) > robot.mapper.tolerance)
            assert len(left) == len(exits) - 1
            self.refused(WalkError, Visit(name, left))

    @rule(choice=choices, sign=st.sampled_from([-1, 1]))
    @at_a_place
    @precondition(lambda self: bool(self.robot.known_at(self.robot.at)))
    def almost_a_known_heading(self, choice, sign):
        """Farther than the tolerance from a known direction, nearer than twice that: neither the same nor another."""
        robot = self.robot
        known = robot.known_at(robot.at)
        yaws = robot.yaws(known[choice % len(known)])
        off = robot.world.heading[known[choice % len(known)]] + sign * 1.5 * robot.mapper.tolerance
        self.refused(AmbiguousDart, Samples((off, *yaws)), Visit("elsewhere"))

    @rule(sign=st.sampled_from([-1, 1]))
    @precondition(lambda self: self.robot.dart >= 0 and self.robot.ahead in self.robot.seen)
    def a_whole_turn_more(self, sign):
        """The same headings at the ends, wound once more around: no way in the plane, and not the way walked before."""
        last = self.robot.events[-1].yaw[-1]
        wound = Samples(tuple(last + sign * k * TAU / 4 for k in range(1, 5)))
        again = self.robot.dart >> 1 in self.robot.edges
        place = self.robot.ahead
        self.refused(WalkError if again else NotPlane, wound, Visit(self.robot.name(place), self.robot.exits(place)))

    @rule(where=choices, gaps=st.tuples(choices, choices), whole=st.integers(-1, 1))
    @at_a_place
    @precondition(lambda self: not self.robot.declared & {self.robot.at})
    def a_leg_that_is_not_there(self, where, gaps, whole):
        """A leg between any two places, any way: a fork takes it exactly if a plane map has it, judged from scratch."""
        robot, plane, tolerance = self.robot, self.robot.mapper.plane, self.robot.mapper.tolerance
        there = [v for v in robot.seen if v not in robot.declared]
        u, v = (plane.vertex_names.row(robot.name(w)) for w in (robot.at, there[where % len(there)]))
        ends = []
        for vertex, pick, share in ((u, gaps[0], 0.35), (v, gaps[1], 0.65)):
            darts = plane.darts_at(vertex)
            yaws = sorted(plane.heading_of(d).yaw for d in darts) or [0.0]
            k = pick % len(yaws)
            gap = (yaws[(k + 1) % len(yaws)] - yaws[k]) % TAU or TAU
            if gap < 10 * tolerance:
                return
            ends.append(math.remainder(yaws[k] + share * gap, TAU))
        out, back = ends
        turn = math.remainder(back - math.pi - out, TAU) + whole * TAU
        samples = Samples(tuple(np.linspace(out, out + turn, 9).tolist()))
        expected = plane_with(plane, u, v, out, back, turn)
        if isinstance(expected, NotPlane):
            error = self.refused(NotPlane, samples, Visit(plane.vertex_names[v]))
            assert error.genus == expected.genus
            assert (len(error.edges) > 0) == (error.genus is not None)
            return
        fork, before = robot.mapper.fork(), state(robot.mapper)
        for event in (samples, Visit(plane.vertex_names[v])):
            fork.step(event)
        for field_ in ("tail", "next_ccw", "face_of"):
            assert np.array_equal(getattr(fork.plane, field_), getattr(expected, field_))
        assert fork.plane.outer_face == expected.outer_face
        assert state(robot.mapper) == before

    # -- forks ---------------------------------------------------------------------------------------------------------

    @rule(stays=st.booleans())
    def fork(self, stays):
        """One of the two rests from here; the other goes on."""
        fork = self.robot.fork()
        assert state(fork.mapper) == state(self.robot.mapper)
        self.other, self.robot = (fork, self.robot) if stays else (self.robot, fork)
        self.resting = state(self.other.mapper)

    @rule(way=st.lists(legs, min_size=2, max_size=12))
    @precondition(lambda self: self.other is not None and self.other.world.darts_at(self.other.at))
    def the_other_goes_its_own_way(self, way):
        before = state(self.robot.mapper)
        self.other.walk(way)
        self.other.check()
        self.resting = state(self.other.mapper)
        assert state(self.robot.mapper) == before

    @rule()
    @precondition(lambda self: self.other is not None)
    def the_other_takes_over(self):
        if self.robot.events[: self.stored] == self.other.events[: self.stored]:
            self.robot, self.other, self.resting = self.other, None, None

    # -- the atlas -----------------------------------------------------------------------------------------------------

    @rule(count=st.just(10**6) | st.integers(1, 8), together=st.booleans())
    @is_open
    def store(self, count, together):
        events = self.robot.events[self.stored : self.stored + count]
        if together:
            self.atlas.extend(events)
        else:
            for event in events:
                self.atlas.append(event)
        self.stored += len(events)

    @rule(count=st.integers(0, 5))
    @is_open
    def interrupted(self, count):
        """Something of the caller's fails while it hands over events: none is stored."""

        def events():
            yield from self.robot.events[self.stored : self.stored + count]
            raise ZeroDivisionError

        with pytest.raises(ZeroDivisionError):
            self.atlas.extend(events())

    @rule()
    @is_open
    def close(self):
        self.atlas.close()
        with pytest.raises(AtlasError, match="closed"):
            _ = self.atlas.plane
        assert [file.name for file in self.folder.iterdir()] == [self.path.name]
        self.atlas = None

    @rule()
    @precondition(lambda self: self.atlas is None)
    def open(self):
        self.atlas = Atlas.open(self.path)

    @rule()
    @precondition(lambda self: self.atlas is None)
    def open_for_reading(self):
        with Atlas.open(self.path, writable=False) as atlas:
            self.check_atlas(atlas)
            with pytest.raises(AtlasError, match="opened for reading"):
                atlas.append(Visit("elsewhere"))

    @rule()
    @is_open
    def kill(self):
        """What the disk holds at this moment, the write-ahead log with it, is all that is left."""
        left = self.copied()
        self.atlas.close()
        self.path.unlink()
        self.path = left
        self.atlas = Atlas.open(left)

    @rule(share=st.floats(0, 1))
    @is_open
    def torn_log(self, share):
        """A write-ahead log that breaks off anywhere: the beginning of the walk is there, and all of it is sound."""
        left = self.copied()
        log = left.with_name(left.name + "-wal")
        if log.exists():
            log.write_bytes(log.read_bytes()[: int(share * log.stat().st_size)])
        with Atlas.open(left) as atlas:
            count = atlas.n_events
            assert list(atlas.walk.events) == self.robot.events[:count]
            assert count <= self.stored
            if count:
                assert atlas.plane == build(Walk(self.robot.mapper.header, tuple(self.robot.events[:count])))
                assert tuple(atlas.sets) == atlas.names
            assert list(atlas.statements) == self.statements[: len(atlas.statements)]
        left.unlink()

    def copied(self):
        self.files += 1
        left = self.folder / f"{self.files}.atlas"
        for suffix in ("", "-wal"):
            file = self.path.with_name(self.path.name + suffix)
            if file.exists():
                shutil.copy(file, left.with_name(left.name + suffix))
        return left

    @rule()
    @precondition(lambda self: self.atlas is not None and self.stored < len(self.robot.events))
    def second_writer(self):
        """Another writer adds the next event; this one is refused until it opens the file again."""
        with Atlas.open(self.path) as second:
            second.append(self.robot.events[self.stored])
            self.stored += 1
            self.check_atlas(self.atlas)  # which reads what the other wrote
            kept = contents(second)
            with pytest.raises(AtlasError, match="another writer"):
                self.atlas.append(self.robot.events[self.stored - 1])
            assert contents(second) == kept
        self.check_atlas(self.atlas)
        self.atlas.close()
        self.atlas = Atlas.open(self.path)

    @rule(seed=st.integers(0, 2**32 - 1))
    @precondition(lambda self: self.atlas is not None and self.stored and len(self.sets) < MOST_SETS)
    def name_a_set(self, seed):
        rng = np.random.default_rng(seed)
        if seed % 3:
            self.store(10**6, together=True)
        name = f"set {seed % 9}"
        (x,) = random_sets(rng, self.atlas.plane, 1)
        if name in self.sets:
            with pytest.raises(BadInput, match="already"):
                self.atlas.name(name, x)
            return
        stored = self.atlas.name(name, x.text if seed % 2 else x)
        assert stored == x
        self.sets[name] = by_names(stored)
        for other, y in self.atlas.sets.items():
            self.relations[name, other], self.relations[other, name] = de9im(x, y), de9im(y, x)

    @rule(choice=choices, forget=st.booleans())
    @precondition(lambda self: self.atlas is not None and self.sets)
    def rename_or_remove(self, choice, forget):
        old = sorted(self.sets)[choice % len(self.sets)]
        new = f"renamed {choice % 5}"
        if not forget and new in self.sets:
            with pytest.raises(BadInput, match="already"):
                self.atlas.rename(old, new)
            return
        if forget:
            self.atlas.remove(old)
        else:
            self.atlas.rename(old, new)
            self.sets[new] = self.sets[old]
        del self.sets[old]
        with pytest.raises(UnknownName):
            self.atlas.remove(old)
        moved = {(a, b): r for (a, b), r in self.relations.items() if not (forget and old in (a, b))}
        self.relations = {(new if a == old else a, new if b == old else b): r for (a, b), r in moved.items()}

    @rule(words=st.lists(st.sampled_from(["DC", "EC", "TPP", "inside"]), min_size=1), weight=st.none() | st.floats(0))
    @is_open
    def declare(self, words, weight):
        statement = Statement("pond", tuple(words), "garden", label=None if weight is None else "the deed", weight=weight)
        self.atlas.declare(statement)
        self.statements.append(statement)

    # -- what always holds -----------------------------------------------------------------------------------------------

    @invariant()
    def the_map_is_that_of_the_events_and_of_the_world(self):
        self.robot.check()

    @invariant()
    def a_resting_fork_rests(self):
        assert self.other is None or state(self.other.mapper) == self.resting

    @invariant()
    def the_atlas_holds_what_was_stored(self):
        if self.atlas is not None:
            self.check_atlas(self.atlas)

    def check_atlas(self, atlas):
        events = self.robot.events[: self.stored]
        assert atlas.n_events == len(events)
        assert list(atlas.walk.events) == events
        assert list(atlas.statements) == self.statements
        assert atlas.names == tuple(sorted(self.sets))
        if not events:
            with pytest.raises(BadInput, match="no map before the first place"):
                _ = atlas.plane
            return
        mapper = Mapper(self.robot.mapper.header)
        for event in events:
            mapper.step(event)
        atlas.plane.validate()
        assert atlas.plane == mapper.plane
        assert atlas.warnings == mapper.warnings
        sets = atlas.sets
        assert {name: by_names(x) for name, x in sets.items()} == self.sets
        assert {pair: relate(sets[pair[0]], sets[pair[1]]).de9im for pair in self.relations} == self.relations


def by_names(x) -> tuple:
    """A set in the names of its cells: what it is on every later map."""
    if isinstance(x, Point):
        return "point", x.name
    if isinstance(x, Line):
        return "line", sorted(x.edge_names) if x.darts is None else list(x.edge_names)
    return "region", sorted(x.plane.edge_names[e] for e in x.boundary.edges)


def plane_with(plane: PlaneMap, u: int, v: int, out: float, back: float, turn: float) -> PlaneMap | NotPlane:
    """The map with one more edge, made from all headings at once; or why there is none."""
    tail = np.array([*plane.tail.tolist(), u, v])
    heading = np.array([*plane.heading.tolist(), out, back])
    after = np.empty(len(tail), int)
    for vertex in range(plane.n_vertices):
        around = sorted(np.flatnonzero(tail == vertex).tolist(), key=lambda d: heading[d])
        after[around] = np.roll(around, -1)
    try:
        return PlaneMap.from_darts(
            tail, after, n_vertices=plane.n_vertices, heading=heading, turn=[*plane.turn.tolist(), turn]
        )
    except NotPlane as error:
        return error


Exploring.TestCase.settings = settings(
    Exploring.TestCase.settings, max_examples=150, stateful_step_count=40, derandomize=True
)
TestExploring = Exploring.TestCase
