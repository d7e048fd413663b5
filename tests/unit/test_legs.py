"""Legs: reading the samples of a leg without recognising a place, and a memory that forks."""

import math

import pytest

from ninefold.errors import WalkError
from ninefold.io import samples
from ninefold.mapping import Heading, Mapper, Samples, Visit, explore
from ninefold.mapping.robot._memory import Memory
from ninefold.mapping.robot.legs import LegReader, read_legs


def test_a_leg_has_both_ends_and_its_whole_turns():
    reader = LegReader()
    reader.take((0.0, 2.0, 4.0))
    reader.take((6.0, 8.0))
    leg = reader.finish()
    assert leg.out == 0.0
    assert leg.back == pytest.approx(math.remainder(8.0 + math.pi, math.tau))
    assert leg.turn == pytest.approx(8.0)
    assert not reader.started


def test_half_a_turn_between_samples_is_refused_and_changes_nothing():
    reader = LegReader()
    reader.take((0.0, 1.0))
    with pytest.raises(WalkError, match="half a turn"):
        reader.take((0.5, 0.5 + math.pi))
    assert reader.read().turn == pytest.approx(1.0)


def test_a_forked_reader_goes_its_own_way():
    reader = LegReader()
    reader.take((0.0, 1.0))
    other = reader.fork()
    other.take((2.0,))
    assert (reader.read().turn, other.read().turn) == (pytest.approx(1.0), pytest.approx(2.0))


def test_legs_of_a_walk_are_what_the_mapper_reads():
    walk = explore(samples.load("ring").to_world(), seed=3).walk
    legs = read_legs(walk.events)
    assert len(legs) == walk.n_legs
    plane = Mapper(walk.header)
    for event in walk.events:
        plane.step(event)
    turns = {round(abs(turn), 6) for turn in plane.plane.turn}
    assert {round(abs(leg.turn), 6) for leg in legs} == turns


def test_legs_need_no_places():
    east, north = Samples.of(Heading(0.0)), Samples.of(Heading(1.5))
    legs = read_legs([Visit(None), east, Visit(None), north, Visit(None)])
    assert [leg.out for leg in legs] == [0.0, 1.5]


@pytest.mark.parametrize(
    ("events", "where", "why"),
    [
        ([Samples.of(Heading(0.0))], "event 1", "before the first place"),
        ([Visit(None), Visit(None)], "event 2", "at least one sample"),
        ([Visit(None), Samples((0.0, math.pi))], "event 2", "half a turn"),
    ],
)
def test_a_leg_that_cannot_be_read_says_where(events, where, why):
    with pytest.raises(WalkError, match=why) as caught:
        read_legs(events)
    assert caught.value.where == where


def test_a_forked_memory_goes_its_own_way():
    walk = explore(samples.load("office").to_world(), seed=1).walk
    half = next(k for k in range(len(walk.events) // 2, len(walk.events)) if isinstance(walk.events[k], Visit)) + 1
    whole, part = Mapper(walk.header), Mapper(walk.header)
    for event in walk.events:
        whole.step(event)
    for event in walk.events[:half]:
        part.step(event)
    before = part.plane
    fork = part.fork()
    for event in walk.events[half:]:
        fork.step(event)
    assert fork.plane == whole.plane
    assert part.plane is before
    for event in walk.events[half:]:
        part.step(event)
    assert part.plane == whole.plane
    assert part.closures == fork.closures


def test_a_fork_shares_no_list():
    memory = Memory(0.02)
    memory.settle("a", memory.look("a", (Heading(0.0), Heading(1.0))))
    fork = memory.fork()
    fork.settle("b", fork.look("b", None))
    fork.stars[0].move(0.0, 0.1)
    assert memory.names == ["a"]
    assert memory.stars[0].yaws == [0.0, 1.0]
