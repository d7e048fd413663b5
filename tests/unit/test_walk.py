"""The walk as a value: header, visits, samples."""

import math

import pytest

from ninefold.errors import BadInput, WalkError
from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader


def test_headings_enter_as_bearings_and_are_yaw_inside():
    assert Samples.of(Heading.from_bearing(0), Heading.from_bearing(90)).yaw == pytest.approx((math.pi / 2, 0.0))
    assert Visit("a", exits=[Heading(1.0)]).exits == (Heading(1.0),)


def test_integers_name_places_and_edges():
    assert (Visit(7, edge=12).place, Visit(7, edge=12).edge) == ("7", "12")


@pytest.mark.parametrize("name", [True, 1.5, ("a",), b"a"])
def test_other_things_name_nothing(name):
    with pytest.raises(WalkError, match="the name of a place is a string"):
        Visit(name)
    with pytest.raises(WalkError, match="the name of an edge is a string"):
        Visit("a", edge=name)


def test_an_exit_is_a_heading_and_never_a_bare_number():
    with pytest.raises(WalkError, match=r"an exit is a Heading, such as Heading.from_degrees\(90\), not 90"):
        Visit("a", exits=(90,))


@pytest.mark.parametrize("yaw", [(math.nan,), (0.0, math.inf), ("1",), (10**400,), (None,)])
def test_samples_are_finite_numbers(yaw):
    with pytest.raises(WalkError, match="samples are finite numbers"):
        Samples(yaw)


def test_samples_are_not_empty():
    with pytest.raises(WalkError, match="at least one"):
        Samples(())
    with pytest.raises(BadInput, match="finite"):
        Samples.of(Heading(math.nan))


@pytest.mark.parametrize("tolerance", [0, -0.1, 1.0, math.nan, math.inf, True, "0.1", None])
def test_tolerance_is_a_small_positive_angle(tolerance):
    with pytest.raises(WalkError, match="a tolerance is an angle in radians between 0 and pi/4"):
        WalkHeader(tolerance=tolerance)


def test_header_says_what_it_does_not_know():
    with pytest.raises(WalkError, match="'yaw-rad', 'yaw-deg', 'bearing-deg', not 'degrees'"):
        WalkHeader("degrees")
    with pytest.raises(WalkError, match='"compass" is true or false, not 1'):
        WalkHeader(compass=1)


def test_values_are_immutable_and_structural():
    walk = Walk(WalkHeader(extra={"robot": "r2"}), [Visit("a"), Samples((0.0,)), Visit("b"), Samples((1.0,))])
    assert walk == Walk(WalkHeader(extra={"robot": "r2"}), walk.events)
    assert (walk.n_legs, walk.places) == (1, ("a", "b"))
    with pytest.raises(AttributeError):
        walk.events = ()
    with pytest.raises(TypeError):
        walk.header.extra["robot"] = "c3"


def test_a_walk_of_nothing_has_no_leg():
    assert Walk(WalkHeader(), ()).n_legs == 0
