"""What all maps agree on, and how much a walk leaves open after every visit."""

from math import inf, log2

import numpy as np
import pytest
from lookalikes import covering, laps, walk_of

from ninefold.errors import BadInput
from ninefold.mapping import Backbone, Heading, Samples, Visit, Walk, WalkHeader, ambiguity, hypotheses
from ninefold.mapping.doubt.backbone import backbone_of


def by_the_maps(found):
    """Verdict over visits, one pair at a time."""
    places = [one.visits.tolist() for one in found]
    verdict = np.zeros((len(places[0]), len(places[0])), int)
    for i in range(len(places[0])):
        for j in range(len(places[0])):
            together = {place[i] == place[j] for place in places}
            verdict[i, j] = 0 if len(together) == 2 else 1 if together == {True} else -1
    return verdict


WALKS = [covering(3, 3, 0)[0], covering(3, 4, 1)[0], *(laps(2, 3, seed, 12)[0] for seed in range(6))]


@pytest.mark.parametrize("walk", WALKS)
@pytest.mark.parametrize("closed", [None, True])
def test_listed_or_asked_it_is_the_same(walk, closed):
    found = hypotheses(walk, closed=closed)
    asked = backbone_of(found.tree, found.alike, complete=False, closed=closed is True)
    if not found.count:
        assert found.backbone() is None
        assert asked is None
        return
    listed = found.backbone()
    assert listed.exact
    assert asked.exact
    assert np.array_equal(listed.visits, by_the_maps(found))
    assert np.array_equal(asked.visits, listed.visits)
    few = hypotheses(walk, closed=closed, limit=1)
    assert len(few) == 1
    assert np.array_equal(few.backbone().visits, listed.visits)


def test_pairs_and_single_questions_say_the_same():
    found = hypotheses(WALKS[0]).backbone()
    visits = found.node_of.size
    assert len(found.same) + len(found.different) + len(found.open) == visits * (visits - 1) // 2
    assert len(found.same)
    assert len(found.different)
    assert len(found.open)
    for pairs, answer in ((found.same, True), (found.different, False), (found.open, None)):
        for i, j in pairs.tolist():
            assert i < j
            assert found.known(i, j) is found.known(j, i) is answer
    same, different, left = len(found.same), len(found.different), len(found.open)
    assert str(found) == f"{same} pairs of visits certainly one place, {different} certainly two, {left} open"
    with pytest.raises(BadInput, match=f"numbered 0 to {visits - 1}; there is no {visits}"):
        found.known(0, visits)


def test_where_maps_are_too_many_to_list():
    """Tens of thousands of maps at least: what they agree on is settled pair by pair."""
    walk, places = covering(5, 5, 0)
    found = hypotheses(walk, limit=10, budget=0.2)
    assert not found.exact
    agreed = found.backbone(budget=60)
    assert agreed.exact
    assert len(agreed.open) > 50
    for i, j in agreed.same.tolist():
        assert places[i] == places[j]
    for i, j in agreed.different.tolist():
        assert places[i] != places[j]


def test_out_of_time_or_narrowed_what_is_certain_is_still_right():
    walk, places = covering(4, 4, 0)
    tree_of = hypotheses(walk, closed=True)
    for agreed in (
        backbone_of(tree_of.tree, tree_of.alike, complete=False, budget=1e-6),
        hypotheses(walk, max_places=16, limit=0).backbone(),
    ):
        assert isinstance(agreed, Backbone)
        assert not agreed.exact
        assert all(places[i] == places[j] for i, j in agreed.same.tolist())
        assert len(agreed.different)
        assert all(places[i] != places[j] for i, j in agreed.different.tolist())


def test_without_a_compass_congruence_and_names_are_certain():
    walk, places = covering(3, 3, 0)
    events = [
        Visit(f"p{places[i // 2]}", exits=event.exits) if i in (0, 8) else event for i, event in enumerate(walk.events)
    ]
    blind = Walk(WalkHeader(compass=False), tuple(events))
    found = hypotheses(blind, limit=0, budget=0.5)
    agreed = found.backbone()
    assert agreed.known(0, 4) is (places[0] == places[4])
    assert all(places[i] == places[j] for i, j in agreed.same.tolist())
    assert all(places[i] != places[j] for i, j in agreed.different.tolist())


# -- ambiguity -------------------------------------------------------------------------------------------------------------


def prefixes(walk):
    ends = [i for i, event in enumerate(walk.events) if isinstance(event, Visit)]
    return [Walk(walk.header, walk.events[: end + 1]) for end in ends]


@pytest.mark.parametrize("walk", [covering(3, 3, 1)[0], laps(3, 3, 0, 14)[0]])
def test_ambiguity_is_that_of_every_prefix(walk):
    found = ambiguity(walk)
    assert found == tuple(log2(hypotheses(part).count) for part in prefixes(walk))
    assert max(found) > 2


def test_a_name_takes_doubt_away():
    walk, places = covering(3, 3, 1)
    last = Visit("end", exits=walk.events[-1].exits)
    first = next(i for i, place in enumerate(places) if place == places[-1])
    events = [*walk.events[:-1], last]
    events[2 * first] = Visit("end", exits=walk.events[2 * first].exits)
    assert first < len(places) - 1
    named = Walk(walk.header, tuple(events))
    assert ambiguity(named)[-1] == log2(hypotheses(named).count)
    assert ambiguity(named)[-1] <= ambiguity(walk)[-1]
    assert ambiguity(named)[: first + 1] == ambiguity(walk)[: first + 1]


def test_no_map_is_minus_infinity():
    north, south = Heading.from_degrees(90), Heading.from_degrees(270)
    place, leg, back = Visit(None, exits=(north, south)), Samples.of(north, north), Samples.of(south, south)
    other = Visit(None, exits=(north, south, Heading.from_degrees(0)))
    walk = Walk(WalkHeader(), (place, leg, place, back, other, leg, place))
    assert ambiguity(walk) == (0.0, 0.0, -inf, -inf)


def test_not_counted_is_none():
    found = ambiguity(covering(5, 5, 0)[0], budget=0.5)
    assert found[0] == 0.0
    assert found[-1] is None


def test_a_walk_there_and_back_leaves_nothing_open():
    assert ambiguity(walk_of(3, 1, (0, 0), [0, 0, 2, 2])[0]) == (0.0,) * 5
