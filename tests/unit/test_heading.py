"""Headings and circular arithmetic at the edges of their ranges."""

import math

import pytest

from ninefold.errors import BadInput
from ninefold.mapping import Heading, PlaneMap, Samples, circular_mean, unwrap
from ninefold.mapping.heading import LARGEST_ANGLE


@pytest.mark.parametrize("angle", [math.nan, math.inf, -math.inf])
def test_only_finite_angles(angle):
    for make in (Heading, Heading.from_degrees, Heading.from_bearing):
        with pytest.raises(BadInput, match="finite angle"):
            make(angle)
    for of_samples in (unwrap, circular_mean):
        with pytest.raises(BadInput, match="sample 2 is no finite angle"):
            of_samples([0.0, angle])


@pytest.mark.parametrize("value", ["north", None, [1.0], True, 10**400])
def test_only_numbers(value):
    for make in (Heading, Heading.from_degrees, Heading.from_bearing):
        if value is not True or make is Heading:
            with pytest.raises(BadInput, match="is a finite angle"):
                make(value)


@pytest.mark.parametrize("angle", [1e300, -1e300, 1e9, math.nextafter(LARGEST_ANGLE, math.inf)])
def test_numbers_too_large_to_mean_a_direction(angle):
    for make, unit in ((Heading, 1.0), (Heading.from_degrees, 180 / math.pi), (Heading.from_bearing, 180 / math.pi)):
        with pytest.raises(BadInput, match=r"too large for an angle: beyond 8388608 radians"):
            make(min(angle * unit, 1e300))
    for of_samples in (unwrap, circular_mean):
        with pytest.raises(BadInput, match=r"sample 2: .* radians is too large for an angle"):
            of_samples([0.0, angle])
    with pytest.raises(BadInput, match="too large for an angle"):
        Samples((0.0, angle))
    for heading, turn in (([angle, math.pi], [0.0]), ([0.0, math.pi], [angle])):
        with pytest.raises(BadInput, match="at most 8388608"):
            PlaneMap.from_darts([0, 1], [0, 1], heading=heading, turn=turn)


def test_the_largest_angles_still_give_the_direction():
    turns = math.floor(LARGEST_ANGLE / (2 * math.pi))
    assert Heading(turns * 2 * math.pi + 0.25).yaw == pytest.approx(0.25, abs=2e-9)
    assert Heading.from_degrees(360.0 * turns + 45).degrees == pytest.approx(45, abs=1e-6)
    assert Heading.from_bearing(360.0 * turns + 45).bearing == pytest.approx(45, abs=1e-6)
    assert math.ulp(LARGEST_ANGLE / 2) < 1e-9 < math.ulp(LARGEST_ANGLE)


def test_a_bearing_is_below_a_full_turn():
    assert Heading(math.nextafter(math.pi / 2, math.inf)).bearing == 0.0
    assert Heading.from_bearing(359.5).bearing == pytest.approx(359.5)
