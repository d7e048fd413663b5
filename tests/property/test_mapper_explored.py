"""What a robot finds out from headings is what the geometry is; what it keeps online is what the map derives."""

import copy
import math

import numpy as np
from explored import component_map, same_up_to_numbering, simulated
from hypothesis import given, settings
from hypothesis import strategies as st
from worlds import KINDS

from ninefold.errors import NinefoldError, NotPlane
from ninefold.mapping import Heading, Mapper, PlaneMap, Samples, Visit, Walk, build, explore

seeds = st.integers(0, 2**32 - 1)
kinds = st.sampled_from(KINDS)
sizes = st.integers(1, 30)


@settings(max_examples=300, deadline=None)
@given(seeds, kinds, sizes, st.booleans(), st.booleans(), st.floats(0.5, 200))
def test_the_explored_map_is_the_true_map(seed, kind, size, sees_exits, noisy, step):
    w = simulated(seed, kind, size)
    start = seed % len(w.points)
    tolerance = min(0.02, w.narrowest / 3)
    robot = explore(w, start=start, seed=seed, step=step, exits=sees_exits, noise=tolerance / 15 if noisy else 0.0)
    plane = build(robot.walk)
    true = component_map(w, start)
    same_up_to_numbering(plane, true, tolerance if noisy else 1e-9)
    assert plane.n_vertices + sum(map(len, robot.unreached)) == len(w.points)


def online_equals_derived(mapper):
    plane = mapper.plane
    assert (plane.n_vertices, plane.n_edges, plane.n_faces) == (mapper.n_vertices, mapper.n_edges, mapper.n_faces)
    assert len(mapper.closures) == mapper.n_edges - mapper.n_vertices + 1
    faces = set(zip(mapper.face_of.tolist(), plane.face_of.tolist(), strict=True))
    assert len(faces) == mapper.n_faces or not plane.n_edges
    assert len({a for a, _ in faces}) == len({b for _, b in faces}) == len(faces)
    if plane.n_edges:
        assert plane.face_of[mapper.outer] == plane.outer_face
    else:
        assert mapper.outer == -1


@settings(max_examples=100, deadline=None)
@given(seeds, kinds, sizes, st.booleans())
def test_after_every_event_the_map_so_far_is_valid(seed, kind, size, noisy):
    w = simulated(seed, kind, size)
    noise = min(0.02, w.narrowest / 3) / 15 if noisy else 0.0
    walk = explore(w, seed=seed, step=100.0, noise=noise).walk
    mapper = Mapper(walk.header)
    for event in walk.events:
        mapper.step(event)
        online_equals_derived(mapper)
    assert mapper.open_exits == ()
    assert [warning for warning in mapper.warnings if "may be one edge" not in warning] == []  # some parallel edges are thin
    assert np.abs(mapper.residuals).max(initial=0.0) <= (walk.header.tolerance if noisy else 1e-9)


def everything(mapper):
    """All that a mapper holds, copied."""
    memory = mapper._memory
    held = {name: getattr(memory, name) for name in memory.__slots__ if name not in ("stars", "grown")}
    held["stars"] = [(star.yaws, star.darts, star.declared) for star in memory.stars]
    held["grown"] = {name: getattr(memory.grown, name) for name in memory.grown.__slots__}
    held["self"] = {
        name: value for name, value in vars(mapper).items() if name not in ("_memory", "_plane", "_leg", "header")
    }
    held["leg"] = [getattr(mapper._leg, name) for name in mapper._leg.__slots__]
    return copy.deepcopy(held)


def damaged(draw, events, places):
    """A walk with a few events changed, dropped or repeated."""
    events = list(events)
    for _ in range(draw(st.integers(1, 6))):
        at = draw(st.integers(0, len(events) - 1))
        event = events[at]
        kind = draw(
            st.sampled_from(["drop", "repeat", "other place", "new place", "unknown", "yaw", "exits", "edge", "swap"])
        )
        angle = draw(st.sampled_from([0.005, 0.03, 0.3, 1.0, math.pi / 2, 3.0, 2 * math.pi]) | st.floats(-7, 7))
        if kind == "drop" and len(events) > 1:
            del events[at]
        elif kind == "repeat":
            events.insert(at, event)
        elif kind == "swap":
            events[at], events[-1 - at] = events[-1 - at], event
        elif isinstance(event, Samples):
            k = draw(st.integers(0, len(event.yaw) - 1))
            events[at] = Samples((*event.yaw[:k], *(yaw + angle for yaw in event.yaw[k:])))
        elif kind == "unknown":
            events[at] = Visit(None)
        elif kind == "new place":
            events[at] = Visit(draw(st.sampled_from(["x", "y"])))
        elif kind == "exits":
            exits = event.exits or ()
            events[at] = Visit(event.place, draw(st.sampled_from([None, exits[1:], (*exits, Heading(angle))])), event.edge)
        elif kind == "edge":
            events[at] = Visit(event.place, event.exits, draw(st.sampled_from([None, "w0", "w1", "e1"])))
        else:
            events[at] = Visit(draw(st.sampled_from(places)), event.exits, event.edge)
    return events


def cannot_be_drawn(mapper, place):
    """Whether the leg on which a mapper is makes no plane map, judged from all its darts at once."""
    memory, grown = mapper._memory, mapper._memory.grown
    leg = mapper._leg.read()
    tail = np.array([*grown.tail, mapper._at, memory.rows[place]])
    heading = np.array([*grown.heading, leg.out, leg.back])
    after = np.empty(len(tail), int)
    for v in range(mapper.n_vertices):
        around = sorted(np.flatnonzero(tail == v).tolist(), key=lambda d: heading[d])
        after[around] = np.roll(around, -1)
    try:
        PlaneMap.from_darts(tail, after, n_vertices=mapper.n_vertices, heading=heading, turn=[*grown.turn, leg.turn])
    except NotPlane as error:
        return True, error.genus
    return False, None


@settings(max_examples=400, deadline=None)
@given(st.data(), seeds, kinds, st.integers(1, 12))
def test_errors_change_nothing_and_what_is_accepted_is_plane(data, seed, kind, size):
    walk = explore(simulated(seed, kind, size), seed=seed, step=200.0, exits=bool(seed % 2)).walk
    mapper = Mapper(walk.header)
    for event in damaged(data.draw, walk.events, sorted(set(walk.places))):
        before, plane = everything(mapper), mapper._plane
        error = error_of(mapper, event)
        if error is None:
            if mapper.n_vertices:
                online_equals_derived(mapper)
            continue
        assert everything(mapper) == before
        assert mapper._plane is plane
        assert str(error).startswith(f"event {mapper.n_events + 1}: ")
        assert "\n" not in str(error)
        if isinstance(error, NotPlane):
            assert cannot_be_drawn(mapper, event.place) == (True, error.genus)
            assert (len(error.edges) > 0) == (error.genus is not None)


def error_of(mapper, event):
    try:
        mapper.step(event)
    except NinefoldError as error:
        return error
    return None


@settings(max_examples=100, deadline=None)
@given(seeds, kinds, sizes)
def test_a_turned_compass_turns_nothing_but_headings(seed, kind, size):
    """A constant error of the compass moves the cut of the yaw through every corner, and the map stays the same."""
    walk = explore(simulated(seed, kind, size), seed=seed, step=100.0).walk
    offset = np.random.default_rng(seed).uniform(-math.pi, math.pi)

    def turned(event):
        if isinstance(event, Samples):
            return Samples(tuple(yaw + offset for yaw in event.yaw))
        return Visit(event.place, tuple(Heading(heading.yaw + offset) for heading in event.exits), event.edge)

    straight, other = build(walk), build(Walk(walk.header, tuple(map(turned, walk.events))))
    assert np.array_equal(straight.next_ccw, other.next_ccw)
    assert np.array_equal(straight.face_of, other.face_of)
    assert straight.outer_face == other.outer_face
