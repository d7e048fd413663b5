"""Headings and circular arithmetic at the edges of their ranges."""

import math

import pytest

from ninefold.errors import BadInput
from ninefold.mapping import Heading, circular_mean, unwrap


@pytest.mark.parametrize("angle", [math.nan, math.inf, -math.inf])
def test_only_finite_angles(angle):
    for make in (Heading, Heading.from_degrees, Heading.from_bearing):
        with pytest.raises(BadInput, match="finite angle"):
            make(angle)
    for of_samples in (unwrap, circular_mean):
        with pytest.raises(BadInput, match="sample 2 is no finite angle"):
            of_samples([0.0, angle])


def test_a_bearing_is_below_a_full_turn():
    assert Heading(math.nextafter(math.pi / 2, math.inf)).bearing == 0.0
    assert Heading.from_bearing(359.5).bearing == pytest.approx(359.5)
