"""The mapper, event by event: what it builds, and every reason for which it refuses."""

import math

import numpy as np
import pytest

from ninefold.errors import AmbiguousDart, BadInput, NotPlane, WalkError
from ninefold.mapping import Closure, Heading, Mapper, Samples, Visit, Walk, WalkHeader, build
from ninefold.mapping.robot.legs import LegReader


def events(*items):
    """Strings are places, numbers and tuples are yaw in degrees, the rest is taken as it is."""
    for item in items:
        if isinstance(item, str):
            yield Visit(item)
        elif isinstance(item, tuple):
            yield Samples(tuple(math.radians(x) for x in item))
        elif isinstance(item, int | float):
            yield Samples((math.radians(item),))
        else:
            yield item


def mapped(*items, tolerance=None):
    mapper = Mapper(tolerance=tolerance)
    for event in events(*items):
        mapper.step(event)
        if not mapper.on_leg:
            mapper.plane.validate()
    return mapper


def exits(*degrees):
    return tuple(Heading.from_degrees(x) for x in degrees)


def refused(error, message, *items, before=()):
    """The last event is refused with this message, and changes nothing."""
    *first, last = events(*before, *items)
    mapper = Mapper()
    for event in first:
        mapper.step(event)
    plane = mapper.plane if mapper.n_vertices else None
    with pytest.raises(error, match=message) as caught:
        mapper.step(last)
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith(f"event {len(first) + 1}: ")
    assert mapper.n_events == len(first)
    if plane is not None:
        assert mapper.plane is plane
    return caught.value


def outer_places(mapper):
    plane = mapper.plane
    return {plane.vertex_names[int(plane.tail[d])] for d in plane.face_darts(plane.outer_face)}


# -- what is built --------------------------------------------------------------------------------------------------------


def test_nothing_yet():
    mapper = Mapper()
    assert (mapper.n_vertices, mapper.n_edges, mapper.n_faces, mapper.place, mapper.outer) == (0, 0, 0, None, -1)
    with pytest.raises(BadInput, match="no map before the first place"):
        _ = mapper.plane
    with pytest.raises(BadInput, match="no map before the first place"):
        build(Walk(WalkHeader(), ()))


def test_one_place_is_a_map():
    mapper = mapped("a")
    assert (mapper.n_vertices, mapper.n_edges, mapper.n_faces, mapper.outer) == (1, 0, 1, -1)
    assert repr(mapper.plane) == "PlaneMap(1 vertex, 0 edges, 1 face)"


def test_a_path_has_one_face():
    mapper = mapped("a", 0, "b", 90, "c")
    assert (mapper.n_vertices, mapper.n_edges, mapper.n_faces, mapper.closures) == (3, 2, 1, ())
    assert mapper.plane.edge_names[1] == "e1"


@pytest.mark.parametrize("items", [("a", 0, "b", 120, "c", 240, "a"), ("a", 0, "b", 240, "c", 120, "a")])
def test_a_triangle_either_way_round(items):
    mapper = mapped(*items)
    left = items[3] == 120
    assert (mapper.n_faces, mapper.closures) == (2, (Closure(7, "e2"),))
    assert mapper.face_of[0] != mapper.face_of[1]
    assert (mapper.face_of[0] == mapper.face_of[mapper.outer]) is not left
    assert mapper.plane.cycle(["a", "b", "c"]).faces == (int(mapper.plane.face_of[0 if left else 1]),)


@pytest.mark.parametrize("sense", [1, -1])
def test_a_loop_either_way_round(sense):
    mapper = mapped("a", tuple(sense * x for x in (0, 90, 180, 270)), "a")
    assert (mapper.n_vertices, mapper.n_edges, mapper.n_faces) == (1, 1, 2)
    assert mapper.outer == (1 if sense == 1 else 0)
    assert mapper.plane.cycle(edges=["e0"]).faces == (int(mapper.plane.face_of[mapper.outer ^ 1]),)


def test_loops_side_by_side_and_inside_each_other():
    big, small, beside = (-40, 50, 140, 220), (-10, 80, 170, 190), (95, 180, 270, 300)
    mapper = mapped("a", big, "a", small, "a", beside, "a")
    plane = mapper.plane
    assert (plane.n_vertices, plane.n_edges, plane.n_faces) == (1, 3, 4)
    inner = plane.cycle(edges=["e1"])
    assert set(inner.faces) < set(plane.cycle(edges=["e0"]).faces)
    assert not set(plane.cycle(edges=["e2"]).faces) & set(plane.cycle(edges=["e0"]).faces)


def test_parallel_edges_are_told_apart_by_heading():
    mapper = mapped("a", 0, "b", (140, 220), "a", (-40, 40), "b", (140, 220), "a", 0, "b")
    assert (mapper.n_vertices, mapper.n_edges, mapper.n_faces) == (2, 3, 3)
    assert [closure.edge for closure in mapper.closures] == ["e1", "e2"]
    assert mapper.plane.edge_names[1] == "e1"


def test_a_dead_end_inside_stays_inside():
    mapper = mapped("a", 0, "b", 120, "c", 240, "a", 30, "inside")
    assert outer_places(mapper) == {"a", "b", "c"}
    mapper = mapped("a", 0, "b", 120, "c", 240, "a", 200, "outside")
    assert outer_places(mapper) == {"a", "b", "c", "outside"}


def test_starting_inside_the_outer_face_is_found_when_the_ring_closes():
    mapper = mapped("hub", 0, "e", (90, 180), "n", (180, 270), "w", 0, "hub", 180, "w", (-90, 0), "s", (0, 90), "e")
    assert outer_places(mapper) == {"e", "n", "w", "s"}
    assert mapper.n_faces == 3


@pytest.mark.parametrize("turns", [1, 2, 5])
def test_spirals_count_their_turns(turns):
    """Two spirals from a place inside to one outside, interleaved: the headings alone would not tell which way they wind."""
    one = tuple(range(0, 360 * turns + 1, 45))
    two = tuple(range(180, 360 * turns + 391, 30))  # half a turn longer, and it meets the first from outside
    mapper = mapped("in", one, "out", tuple(x + 180 for x in reversed(two)), "in")
    assert mapper.n_faces == 2
    assert np.degrees(mapper.plane.turn) == pytest.approx([360 * turns, -360 * turns - 210])
    assert outer_places(mapper) == {"in", "out"}
    assert mapper.face_of[mapper.outer] == mapper.face_of[0]
    refused(NotPlane, "would turn", "in", one, "out", tuple(x + 180 for x in reversed(two[12:])), "in")


def test_known_edges_are_recognised_and_refined():
    mapper = mapped("a", 0.0, "b", 180.4, "a", 0.2, "b")
    assert (mapper.n_edges, mapper.closures) == (1, ())
    assert mapper.plane.heading_of(0).degrees == pytest.approx((0.0 + 0.4 + 0.2) / 3)
    assert abs(mapper.plane.heading_of(1).degrees) == pytest.approx(180 - 0.2)
    assert mapper.residuals == pytest.approx([0], abs=1e-12)


def test_residuals_show_passes_that_disagree():
    mapper = mapped("a", (0, 90), "b", (270.8, 180), "a")
    # Means: leaving 0, way back 270.4; the first pass turned by 90.
    assert np.degrees(mapper.residuals) == pytest.approx([0.4])
    assert mapped("a").residuals.shape == (0,)


def test_a_heading_may_drift_across_the_cut_of_the_yaw():
    """Due west is both ends of (-pi, pi]; a mean that crosses it changes neither rotation nor turning."""
    items = ["a", 179.8, "b", 60, "c", -60.1, "a"]
    mapper = mapped(*items, -179.5, "b", -0.3, "a", -179.7, "b", -0.2, "a")
    assert mapper.n_edges == 3
    assert mapper.plane.heading_of(0).degrees < 0
    assert [mapper.plane.edge_names[d >> 1] for d in mapper.plane.darts_at(0)] == ["e0", "e2"]
    assert outer_places(mapper) == {"a", "b", "c"}
    mapper.step(Samples((math.radians(-90),)))
    mapper.step(Visit("d"))
    rotation = [mapper.plane.edge_names[d >> 1] for d in mapper.plane.darts_at(0)]
    assert rotation == ["e0", "e3", "e2"]


def test_samples_may_come_one_by_one_wrapped_or_not():
    together = mapped("a", (0, 90, 180, 270), "a")
    apart = mapped("a", 0, 90, -180, -90, "a")
    further = mapped("a", 720, 810, 900, 990, "a")
    assert together.plane == apart.plane
    assert np.array_equal(together.face_of, further.face_of)
    assert further.plane.heading == pytest.approx(together.plane.heading)


def test_names_of_edges_are_given_or_made():
    walk = [Visit("a"), 0, Visit("b", edge="e1"), 90, Visit("c"), 0, Visit("d"), 180, Visit("c")]
    mapper = mapped(*walk)
    assert list(mapper.plane.edge_names) == ["e1", "e2", "e3"]
    again = mapped(*walk, 270, Visit("b", edge="e2"), 180, Visit("a", edge="e1"))
    assert again.n_edges == 3


def test_open_exits_are_kept_until_travelled():
    mapper = mapped(Visit("a", exits(0, 90, 180)))
    assert [(place, round(heading.degrees)) for place, heading in mapper.open_exits] == [("a", 0), ("a", 90), ("a", 180)]
    for event in events(90, Visit("b", exits(-90, 10))):
        mapper.step(event)
    assert [(place, round(heading.degrees)) for place, heading in mapper.open_exits] == [("a", 0), ("a", 180), ("b", 10)]
    assert mapper.warnings == ("3 exits were never travelled, the first at 'a', 0 deg",)
    assert (mapper.n_edges, mapper.n_faces) == (1, 1)


def test_exits_may_be_seen_later_in_any_order_or_never():
    mapper = mapped(
        "a", 0, "b", 90, "c", 270, Visit("b", exits(180.3, 90, -45)), 180, "a", 0, Visit("b", exits(-45, 180, 89.7))
    )
    assert [(place, round(heading.degrees)) for place, heading in mapper.open_exits] == [("b", -45)]


def test_exits_next_to_the_cut_of_the_yaw():
    mapper = mapped(
        Visit("a", exits(179.9, 0)), 0, "b", 180, Visit("a", exits(0, -179.9)), -179.8, "c", 0, Visit("a", exits(-179.5, 0))
    )
    assert mapper.open_exits == ()
    assert mapper.n_edges == 2


def test_a_loop_takes_two_exits():
    mapper = mapped(Visit("a", exits(0, 90, 200)), (0, 90, 180, 270), "a")
    assert [round(heading.degrees) for _, heading in mapper.open_exits] == [-160]
    later = mapped("a", (0, 90, 180, 270), Visit("a", exits(0, 90, 200)))
    assert later.plane == mapper.plane
    assert later.open_exits == mapper.open_exits


def test_a_walk_may_end_on_a_leg():
    mapper = mapped("a", 0, "b", 90)
    assert mapper.on_leg
    assert mapper.warnings == ("the walk ends on a leg from 'b', which is left out",)
    assert mapper.plane.n_edges == 1


def test_the_map_is_kept_until_the_next_change():
    mapper = mapped("a", 0, "b")
    plane = mapper.plane
    mapper.step(Samples((math.pi,)))
    assert mapper.plane is plane
    mapper.step(Visit("a"))
    assert mapper.plane is plane  # the pass agreed to the last bit
    mapper.step(Samples((0.01,)))
    mapper.step(Visit("b"))
    assert mapper.plane is not plane
    assert plane.heading[0] == 0.0


def test_tolerance_comes_from_the_header_or_the_argument():
    walk = Walk(WalkHeader(tolerance=0.1), tuple(events("a", 0, "b", (175, 185), "a")))
    assert build(walk).n_edges == 1
    assert build(walk, tolerance=0.02).n_edges == 2
    assert Mapper(walk.header).tolerance == 0.1
    with pytest.raises(WalkError, match="a tolerance is an angle"):
        Mapper(tolerance=0)


def test_repr():
    assert repr(mapped("a", 0, "b")) == "Mapper(3 events, 2 vertices, 1 edge, 1 face)"


# -- order of events ------------------------------------------------------------------------------------------------------


def test_events_out_of_order():
    refused(WalkError, "a heading before the first place; a walk begins at a place", 0)
    refused(WalkError, "no heading between 'a' and 'b'; a leg has at least one sample", "a", "b")
    refused(WalkError, "edge 'x' is named at the first place, before any leg", Visit("a", edge="x"))
    refused(WalkError, "an event is a Visit or Samples, not None", "a", None)


def test_a_place_not_recognised():
    refused(WalkError, "a place that was not recognised .null.; one map needs every place", "a", 0, Visit(None))
    refused(WalkError, "a place that was not recognised", Visit(None))


def test_samples_too_coarse():
    refused(WalkError, "successive headings 0 deg and 180 deg differ by half a turn.*sample more often", "a", 0, 180)
    refused(WalkError, "successive headings 90 deg and -90 deg differ by half a turn", "a", (0, 90, -90))


def test_numbers_that_are_no_angles():
    with pytest.raises(WalkError, match=r"a sample of 1e\+17 radians is too large for an angle: beyond 8388608 radians"):
        Samples((3.0, 1e17))
    reader = LegReader()
    reader.take((1e17, 3.0))
    with pytest.raises(WalkError, match="numbers so large that their differences mean nothing"):
        reader.read()


def test_names_that_cannot_be():
    refused(WalkError, "a vertex name is printable text, not ''", "")
    refused(WalkError, r"an? edge name is printable text, not 'x\\n'", "a", 0, Visit("b", edge="x\n"))


# -- darts ----------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("off", [1.2, -1.2, 2.2, -2.2])
def test_near_ties_are_never_decided(off):
    refused(
        AmbiguousDart,
        r"leaves 'a' at .*, too close to edge 'e0' at 0 deg to tell .* match within 1.15 deg and differ from twice that",
        *("a", 0, "b", 180, "a", off, "c"),
    )
    message = "the leg reaches 'b' at .*, too close to edge 'e0' at 180 deg"
    refused(AmbiguousDart, message, "a", 0, "b", 90, "c", (-60, off), "b")


def test_two_darts_within_reach_are_both_named():
    message = r"the leg leaves 'a' at 1.4 deg, too close to edge 'e0' at 0 deg and edge 'e1' at 3 deg"
    refused(AmbiguousDart, message, "a", 0, "b", 180, "a", 3, "c", -177, "a", 1.4, "b")
    message = "too close to an exit at 0 deg and an exit at 1.5 deg"
    refused(AmbiguousDart, message, Visit("a", exits(0, 1.5)), 0.5, "b")
    refused(AmbiguousDart, message, Visit("a", exits(0, 1.5)), 0, "b")
    for yaw in (-0.5, 2):
        refused(AmbiguousDart, "too close to an exit at .* and an exit at", Visit("a", exits(0, 1.5, 90, 180)), yaw, "b")


def test_a_known_dart_that_leads_elsewhere():
    message = "edge 'e0' leaves 'a' at 0 deg and led to 'b' before, now to 'c': two places with one name"
    refused(WalkError, message, "a", 0, "b", 180, "a", 0, "c")


def test_a_known_dart_that_ends_otherwise():
    message = r"edge 'e0' from 'a' to 'b' ended at 180 deg \(looking back\) before, and now at -90 deg$"
    refused(WalkError, message, "a", 0, "b", 180, "a", (0, 90), "b")
    message = "and now at -90 deg, the end of edge 'e1'"
    refused(WalkError, message, "a", 0, "b", -90, "c", 180, "d", 80, "a", (0, 90), "b")


def test_a_known_dart_reached_from_elsewhere():
    message = "the leg reaches 'b' along edge 'e0', but left 'a' at 90 deg, where its other end is at 0 deg"
    refused(WalkError, message, "a", 0, "b", 180, "a", (90, 0), "b")
    message = "the leg reaches 'b' along edge 'e0', but left 'c' at -60 deg, where it has no end"
    refused(WalkError, message, "a", 0, "b", 90, "c", (-60, 0), "b")


def test_a_known_edge_that_winds_otherwise():
    message = "edge 'e0' turned by 0 deg before and now by 360 deg: sampled too coarsely, or another way"
    refused(WalkError, message, "a", 0, "b", 180, "a", (0, 120, 240, 360), "b")
    message = "turned by -360 deg before and now by 0 deg"
    refused(WalkError, message, "a", (0, 120, 240, 360), "b", 180, "a")


def test_a_loop_that_comes_back_along_itself():
    refused(AmbiguousDart, "a robot that turned round, or a loop whose ends", "a", (0, 90, 180), "a")
    refused(AmbiguousDart, "a robot that turned round, or a loop whose ends", Visit("a", exits(0, 90)), (0, 90, 180), "a")


def test_names_of_edges_must_hold():
    message = "the edge known as 'e0' is now called 'x'; name an edge at its first traversal"
    refused(WalkError, message, "a", 0, "b", 180, Visit("a", edge="x"))
    message = "edge 'x' joins 'a' and 'b', and the leg from 'b' to 'c' is another one by its headings"
    refused(WalkError, message, "a", 0, Visit("b", edge="x"), 0, Visit("c", edge="x"))


def test_a_compass_that_drifts_is_noticed():
    """One end of an edge drifts as far as is tolerated each time, the other stays, the way there is the same."""
    mapper = mapped("a", 0, "b", tolerance=0.7)
    with pytest.raises(WalkError, match="the headings of edge 'e0' have drifted a quarter turn from its first pass"):
        drift(mapper, passes=1000)
    assert mapper.n_edges == 1
    mapper.plane.validate()


def drift(mapper, passes):
    for _ in range(passes):
        yaw = mapper.plane.heading_of(0).yaw + 0.69
        there = tuple(yaw * k / 8 for k in range(8, -1, -1))
        back = tuple(x + math.pi for x in reversed(there))
        at = "b" if mapper.place == "a" else "a"
        mapper.step(Samples(there if at == "b" else back))
        mapper.step(Visit(at))


# -- exits ----------------------------------------------------------------------------------------------------------------


def test_exits_too_close():
    refused(AmbiguousDart, "two exits of 'a', 0 deg and 1 deg, are within the tolerance", Visit("a", exits(0, 90, 1)))
    refused(AmbiguousDart, "two exits of 'a', 179.8 deg and -179.8 deg, are within", Visit("a", exits(179.8, -179.8)))


def test_a_place_seen_with_two_degrees():
    message = "place 'a' was seen with 3 exits and now with 4: two places with one name"
    refused(WalkError, message, Visit("a", exits(0, 90, 180)), 0, "b", 180, Visit("a", exits(0, 90, 180, 270)))
    message = "place 'a' was seen with 1 exit and now with 0"
    refused(WalkError, message, Visit("a", exits(0)), 0, "b", 180, Visit("a", exits()))


def test_a_place_seen_with_other_exits():
    message = "place 'a' was seen with exits at 0, 90 deg and now at 0, 100 deg: two places with one name"
    refused(WalkError, message, Visit("a", exits(0, 90)), 0, "b", 180, Visit("a", exits(0, 100)))


def test_exits_that_miss_a_known_edge():
    message = "the exits of 'a', 90, 180 deg, do not show edge 'e0' at 0 deg: two places with one name"
    refused(WalkError, message, "a", 0, "b", 180, Visit("a", exits(90, 180)))
    message = "the exits of 'b', 0, 90 deg, do not show edge 'e0' at 180 deg"
    refused(WalkError, "the exits of 'b', none, do not show edge", "a", 0, "b", 90, "c", 270, Visit("b", ()))
    message = "the exits of 'b', 0, 90 deg, do not show edge 'e0' at 180 deg"
    refused(WalkError, message, "a", 0, "b", 90, "c", 270, Visit("b", exits(90, 0)))


def test_a_leg_along_no_exit():
    refused(
        WalkError,
        "the leg leaves 'a' at 45 deg, along none of its 2 exits; exits seen: 0, 90 deg$",
        Visit("a", exits(0, 90)),
        45,
        "b",
    )
    refused(
        WalkError,
        "the leg reaches 'b' at 180 deg, along none of its 1 exit; exits seen: 90 deg$",
        "a",
        0,
        Visit("b", exits(90)),
    )
    refused(WalkError, "the leg leaves 'a' at 0 deg, along none of its 0 exits; exits seen: none$", Visit("a", ()), 0, "b")


# -- the plane ------------------------------------------------------------------------------------------------------------

TRIANGLE = ("a", 0, "b", 120, "c", 240, "a")


def test_a_closure_across_faces_has_genus_one():
    error = refused(
        NotPlane,
        "the leg from 'in' to 'out' cannot be drawn: it would join corners of two different faces, and the map would have "
        "genus 1; a shortest offending part is the edges .*; a place was taken for another, a heading is wrong",
        *(30, "in", 210, "a", 200, "out", 20, "a", 30, "in", 0, "out"),
        before=TRIANGLE,
    )
    assert error.genus == 1
    assert set(error.edges) == {"e0", "e1", "e2", "e3", "e4", "e5"}


def test_a_closure_that_turns_wrongly():
    error = refused(
        NotPlane,
        r"the leg from 'c' to 'a' cannot be drawn: the faces on its two sides would turn \+0 and \+0 times",
        *("a", 0, "b", 60, "c", 300, "a"),
    )
    assert (error.genus, error.edges) == (None, ())
    refused(NotPlane, r"would turn \+3 and -3 times|would turn", "a", 0, "b", 120, "c", (240, 360, 480, 600), "a")


def test_a_chord_inside_must_make_two_faces_that_turn_once():
    mapper = mapped(*TRIANGLE, 0, "b", (150, 210), "a")
    assert mapper.n_faces == 3
    refused(NotPlane, "would turn", *TRIANGLE, 0, "b", (150, 250, 350, 450, 570), "a")


def test_a_loop_that_does_not_turn():
    refused(NotPlane, r"would turn \+0 and \+0 times", "a", (0, -90), "a")


def test_a_loop_in_an_inner_corner_cannot_run_round_the_rest():
    """Of the two ways to wind a loop from one corner into it again, the inner face allows one and the outer face both."""
    assert mapped(*TRIANGLE, (20, 90, 180, 220), "a").n_faces == 3
    refused(NotPlane, r"would turn \+0 and \+2 times", *TRIANGLE, (20, -60, -140), "a")
    refused(NotPlane, r"would turn -1 and \+3 times", *TRIANGLE, tuple(range(20, -501, -40)), "a")
    assert outer_places(mapped(*TRIANGLE, (200, 270, 360, 440), "a")) == {"a", "b", "c"}
    around = mapped(*TRIANGLE, (300, 390, 480, 570, 660), "a")
    assert around.n_faces == 3
    assert outer_places(around) == {"a"}


def test_build_names_the_event():
    with pytest.raises(NotPlane, match=r"^event 7: "):
        build(Walk(WalkHeader(), tuple(events("a", 0, "b", 60, "c", 300, "a"))))
