"""Why two visits are not the same place; and the smallest stretch of a walk that no plane map explains."""

import random
from dataclasses import replace
from math import radians

import pytest

from ninefold.errors import BadInput, WalkError
from ninefold.mapping import Heading, Samples, Visit, Walk, hypotheses
from ninefold.mapping.doubt.likeness import likeness
from ninefold.mapping.doubt.stretches import smallest_stretch, stretch_of
from ninefold.mapping.doubt.walk_tree import fold
from ninefold.mapping.doubt.why_not import Reasons
from tests import alike
from tests.lattice import Lattice, straight


def test_other_exits():
    walk, _ = Lattice.whole(3, 3).walk(1, 6)
    found = hypotheses(walk)
    exits = [len(event.exits) for event in walk.events if isinstance(event, Visit)]
    j = next(k for k, count in enumerate(exits) if count != exits[0])
    reason = found.why_not(0, j)
    assert (reason.kind, reason.visits) == ("exits", (0, j))
    assert str(reason) == f"visit 1 has {exits[0]} exits and visit {j + 1} {exits[j]} exits"


def test_other_directions_of_as_many_exits():
    turned = straight("E")
    turned = replace(turned, events=(*turned.events[:-1], Visit(None, tuple(map(Heading.from_degrees, (0, 90, 180))))))
    turned = replace(turned, events=(Visit(None, tuple(map(Heading.from_degrees, (0, 90, 270)))), *turned.events[1:]))
    assert hypotheses(turned).why_not(0, 1).text == "visits 1 and 2: their exits lie in other directions"


def test_other_names_and_what_was_said():
    walk = straight("EE", names={0: "hall", 2: "yard"})
    reason = hypotheses(walk).why_not(2, 0)
    assert (reason.kind, reason.text) == ("names", "visit 3 is called 'yard' and visit 1 'hall'")
    assert hypotheses(straight("ENWS"), differ=[(0, 4)]).why_not(0, 4).kind == "given"


def test_a_place_may_be_the_same_in_some_map_or_in_all():
    found = hypotheses(straight("ENWS"))
    assert found.why_not(0, 4) is None
    assert hypotheses(straight("EW")).why_not(0, 2) is None


def test_a_loop_that_does_not_turn():
    reason = hypotheses(straight("ENE")).why_not(0, 3)
    assert (reason.kind, reason.around, reason.turning) == ("loop", (0, 1, 2, 3), 0.0)
    assert "visits 1 2 3 4 would be a loop that turns by 0" in reason.text


def test_a_loop_that_turns_either_way_round_is_none():
    for legs in ("ENWS", "NESW"):
        assert Reasons(*_tree(straight(legs))).plain(0, 4) is None


def test_a_face_that_nothing_opens_into():
    two = straight("EE", exits="EW")
    reason = hypotheses(two).why_not(0, 2)
    assert (reason.kind, reason.turning) == ("face", 0.0)
    assert set(reason.around) <= {0, 1, 2}


def test_a_consequence_further_on():
    walk = straight("ENWS", "E")
    last = Visit(None, tuple(map(Heading.from_bearing, (0.0, 270.0))))
    walk = Walk(walk.header, (*walk.events[:-1], last))
    reason = hypotheses(walk).why_not(0, 4)
    assert reason.kind == "consequence"
    assert reason.chain == ((0, 4), (1, 5))
    assert reason.text == (
        "if visits 1 and 5 were the same place, so would be visits 2 and 6; but visit 2 has 4 exits and visit 6 2 exits"
    )


def test_what_only_the_search_tells():
    found = hypotheses(straight("ENWS"), max_places=4)
    reason = found.why_not(0, 2)
    assert reason.kind in ("loop", "search")
    assert [one.n_places for one in found] == [4]
    kept = hypotheses(straight("ENWS", "ENWS"), limit=1)
    assert kept.count > len(kept.maps) == 1
    assert kept.why_not(0, 4) is None  # not among those kept


def test_the_budget_may_not_tell():
    walk, true = Lattice.whole(6, 6).walk(3, 300, back=0.0)
    found = hypotheses(walk, closed=True, budget=1e-9)
    assert not found.exact
    assert not found.maps
    node = found.tree.node_of
    i, j = next((i, j) for i in range(60) for j in range(i) if true[i] == true[j] and node[i] != node[j])
    unsure = found.why_not(i, j, budget=0.0)
    assert unsure.kind == "unknown"
    assert "the time was spent" in unsure.text


def test_visits_that_there_are_not():
    found = hypotheses(straight("EN"))
    for i, j in ((0, 3), (-1, 0), (0, "1"), (True, 0)):
        with pytest.raises(BadInput, match="visits are numbered 0 to 2"):
            found.why_not(i, j)


@pytest.mark.parametrize("compass", [True, False])
def test_every_reason_is_right_and_every_pair_has_one(compass):
    kinds = set()
    for seed in range(40):
        rng = random.Random(seed)
        world = Lattice.whole(rng.choice((2, 3)), rng.choice((3, 4))).thinned(rng, rng.random() / 2)
        walk, true = world.walk(seed, rng.randrange(6, 14), compass=compass)
        found = hypotheses(walk)
        assert found.exact
        reasons = Reasons(found.tree, found.alike)
        together = [one.visits for one in found]
        for i in range(found.tree.n_visits):
            for j in range(i):
                same = any(visits[i] == visits[j] for visits in together)
                reason, plain = found.why_not(j, i), reasons.plain(j, i)
                assert (reason is None) == same, (seed, i, j)
                assert plain is None or not same, (seed, plain)
                assert true[i] != true[j] or reason is None
                kinds.add(reason and reason.kind)
                if plain is None and rng.random() < 0.2 and reason is not None:
                    searched = reasons.searched(j, i, closed=None)
                    assert searched is not None
                    assert searched.kind == "search"
    assert kinds >= {None, "exits", "consequence", "loop"}


@pytest.mark.parametrize("compass", [True, False])
def test_no_reason_speaks_against_the_truth_where_headings_err(compass):
    kinds = set()
    for seed in range(24):
        rng = random.Random(seed)
        world = alike.piece(seed, rng.choice((4, 6, 10)), dead_ends=rng.random() < 0.7)
        tour = (alike.covering_walk if seed % 2 else alike.depth_first_walk)(world, seed)
        tolerance = radians(rng.choice((1, 10, 20, 40)))
        noise = tolerance * (0.49 if compass else 0.3)
        walk = alike.observed(world, tour, compass=compass, tolerance=tolerance, noise=noise, seed=seed)
        try:
            tree = fold(walk)
        except WalkError:  # exits so close together that the log does not tell which was taken
            continue
        reasons = Reasons(tree, likeness(tree))
        places = tour.places(world)
        for i in range(tree.n_visits):
            for j in range(i):
                reason = reasons.plain(j, i)
                assert reason is None or places[i] != places[j], (seed, str(reason))
                kinds.add(reason and reason.kind)
    assert kinds >= {None, "exits", "consequence"}


# -- the smallest stretch --------------------------------------------------------------------------------------------------


def _tree(walk):
    found = hypotheses(walk, limit=1, budget=0.5)
    return found.tree, found.alike


def _is_smallest(walk, wrong, **known):
    assert hypotheses(stretch_of(walk, wrong.first, wrong.last), **known).count == 0
    assert hypotheses(stretch_of(walk, wrong.first + 1, wrong.last), **known).count > 0
    assert hypotheses(stretch_of(walk, wrong.first, wrong.last - 1), **known).count > 0


def test_a_stretch_that_folding_refutes_is_the_smallest():
    walk = straight("EWEW")
    fewer = Visit(None, tuple(map(Heading.from_bearing, (0.0, 90.0, 270.0))))
    wrong = hypotheses(Walk(walk.header, (*walk.events[:-1], fewer))).contradiction
    assert (wrong.first, wrong.last) == (2, 4)
    assert wrong.text == "visit 5 must be the place of visit 3, which lists 4 exits and not 3"


def test_names_that_no_map_can_hold():
    walk = straight("EEENEE", names={2: "hall", 5: "hall"})
    found = hypotheses(walk)
    assert (found.count, found.exact) == (0, True)
    wrong = found.contradiction
    assert (wrong.first, wrong.last) == (2, 5)
    assert wrong.text.startswith(
        "visits 3 and 6 are both called 'hall'; if visits 3 and 6 were the same place, the way along"
    )
    _is_smallest(walk, wrong)


def test_visits_that_are_known_to_be_the_same():
    walk = straight("EENE")
    wrong = hypotheses(walk, same=[(1, 4)]).contradiction
    assert (wrong.first, wrong.last) == (1, 4)
    assert "visits 2 and 5 are known to be the same place" in wrong.text


def test_too_few_places():
    walk = straight("EENN")
    wrong = hypotheses(walk, max_places=3).contradiction
    assert wrong.last - wrong.first == 3
    _is_smallest(walk, wrong, max_places=3)


def test_a_walk_that_has_an_open_map_has_no_such_stretch():
    found = hypotheses(straight("EN"), closed=True)
    assert (found.count, found.exact, found.contradiction) == (0, True, None)
    assert smallest_stretch(straight("EN")) is None


def test_random_names_leave_stretches_that_cannot_be_shortened():
    refuted = 0
    for seed in range(30):
        rng = random.Random(seed)
        walk, _ = Lattice.whole(3, 3).walk(seed, 8)
        visits = [k for k, event in enumerate(walk.events) if not isinstance(event, Samples)]
        chosen = rng.sample(visits, 4)
        events = list(walk.events)
        for k in chosen:
            events[k] = Visit(rng.choice("ab"), events[k].exits)
        named = Walk(walk.header, tuple(events))
        found = hypotheses(named)
        if found.count == 0:
            _is_smallest(named, found.contradiction)
            refuted += 1
        else:
            assert found.contradiction is None
    assert refuted > 5
