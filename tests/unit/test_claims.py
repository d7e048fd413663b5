"""Claims that visits are one place: the cheapest to reject is held against brute force, every reason against its meaning."""

from __future__ import annotations

import itertools
import math
import random

import numpy as np
import pytest

from ninefold.errors import BadInput
from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader, claims, hypotheses
from ninefold.mapping.doubt._congruence import Assertion, Congruence, core_of
from ninefold.mapping.doubt._held import merged, some_map
from ninefold.mapping.doubt.likeness import can_be_one, likeness
from ninefold.mapping.doubt.quotients import QuotientSearch
from ninefold.mapping.doubt.walk_tree import fold

STEPS = [(1, 0), (0, 1), (-1, 0), (0, -1)]


def grid_walk(width, height, seed, *, legs=0, compass=True, tolerance=0.02, names=None):
    """A walk along all ways of a grid, then at random up to some legs; and the true place of every visit."""
    rng = random.Random(seed)

    def ways(p):
        return [h for h in range(4) if 0 <= p[0] + STEPS[h][0] < width and 0 <= p[1] + STEPS[h][1] < height]

    def ahead(p, h):
        return p[0] + STEPS[h][0], p[1] + STEPS[h][1]

    at = rng.randrange(width), rng.randrange(height)
    number = 2 * width * height - width - height
    seen, true, taken = set(), [at], []
    while len(seen) < number or len(taken) < legs:
        fresh = [h for h in ways(at) if frozenset((at, ahead(at, h))) not in seen]
        h = rng.choice(fresh or [h for h in ways(at) if not taken or h != (taken[-1] + 2) % 4] or ways(at))
        seen.add(frozenset((at, ahead(at, h))))
        at = ahead(at, h)
        true.append(at)
        taken.append(h)
    turned = 0 if compass else rng.uniform(-180, 180)  # without a compass the frame of the walk is any
    events = []
    for t, p in enumerate(true):
        if t:
            events.append(Samples.of(Heading.from_degrees(90 * taken[t - 1] + turned)))
        exits = tuple(Heading.from_degrees(90 * h + turned) for h in ways(p))
        events.append(Visit((names or {}).get(p), exits))
    return Walk(WalkHeader(heading="yaw-deg", tolerance=tolerance, compass=compass), tuple(events)), true


def alike(walk):
    """Pairs of visits of different nodes that list the same exits."""
    tree = fold(walk)
    exits = [tuple(round(e.yaw, 6) for e in v.exits) for v in walk.events if isinstance(v, Visit)]
    pairs = itertools.combinations(range(len(exits)), 2)
    return [(i, j) for i, j in pairs if exits[i] == exits[j] and tree.node_of[i] != tree.node_of[j]]


def mixed(walk, true, right, wrong, seed):
    rng = random.Random(seed)
    pairs = alike(walk)
    good = rng.sample([(i, j) for i, j in pairs if true[i] == true[j]], right)
    others = [(i, j) for i, j in pairs if true[i] != true[j]]
    bad = rng.sample(others, min(wrong, len(others)))
    said = [(i, j, round(rng.uniform(0.5, 1.0), 2)) for i, j in [*good, *bad]]
    rng.shuffle(said)
    return said, set(bad)


def pairs_of(found):
    return {(one.claim.a, one.claim.b) for one in found.rejected}


# -- held against brute force ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("seed", range(6))
def test_the_cheapest_is_rejected_as_all_maps_say(seed, closed):
    walk, true = grid_walk(3, 3 + closed, seed, legs=30)
    every = hypotheses(walk, closed=True if closed else None)
    assert every.exact
    assert len(every) == every.count > 0
    said, _ = mixed(walk, true, 5, 5, seed)
    cheapest = min(math.fsum(s for i, j, s in said if one.visits[i] != one.visits[j]) for one in every)
    found = claims(walk, said, closed=closed)
    assert found.exact
    assert found.cost == pytest.approx(cheapest)
    assert found.map is not None
    assert all(found.map.visits[one.a] == found.map.visits[one.b] for one in found.kept)
    assert found.map.closed or not closed
    assert found.map.plane.n_vertices == found.map.n_places
    for one in found.rejected:  # no map holds it with those it is said to contradict; without any one of them, one does
        core = [one.claim, *one.against]
        held = [[h.visits[c.a] == h.visits[c.b] for c in core] for h in every]
        assert not any(map(all, held))


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("seed", range(8))
def test_the_search_on_merged_nodes_finds_exactly_the_maps_that_hold_the_claims(seed, closed):
    walk, _ = grid_walk(3, 3 + seed % 2, seed)
    every = hypotheses(walk, closed=True if closed else None, budget=60)
    assert every.exact
    tree = every.tree
    rng = random.Random(seed)
    for pair in rng.sample(alike(walk), 6):
        n, m = (int(tree.node_of[t]) for t in pair)
        shift = next(k for k in range(4) if can_be_one(tree, np.array([n]), np.array([m]), np.array([k]))[0])
        congruence = Congruence(tree)
        expected = sum(one.visits[pair[0]] == one.visits[pair[1]] for one in every)
        if not congruence.assert_all([(0, Assertion(n, m, shift))]):
            assert expected == 0
            continue
        place, turned = congruence.places()
        small = merged(tree, place, turned)
        counts = set()
        for root in (0, small.n_nodes // 2, small.n_nodes - 1):
            search = QuotientSearch(small, likeness(small), root=root, closed=closed)
            while not search.done:
                search.more(4096)
            counts.add(search.found)
        assert counts == {expected}
        one = some_map(tree, place, turned, closed=closed, until=math.inf)
        assert (one is False) == (expected == 0)


def naive_holds(tree, assertions):
    """Whether assertions hold by congruence: a fixpoint over all pairs of exits, no structure at all."""
    exits = [(n, x) for n in range(tree.n_nodes) for x in range(int(tree.degree[n]))]
    group = {e: e for e in exits}

    def find(e):
        while group[e] != e:
            e = group[e]
        return e

    def join(n, m, k):
        if tree.degree[n] != tree.degree[m]:
            return False
        for x in range(int(tree.degree[n])):
            group[find((n, x))] = find((m, (x + k) % int(tree.degree[m])))
        return True

    if not all(join(n, m, k) for n, m, k in assertions):
        return False
    changed = True
    while changed:
        changed = False
        for a, b in itertools.combinations(exits, 2):
            if find(a) != find(b):
                continue
            for (n, x), (m, y) in ((a, b), (b, a)):
                p, q = int(tree.other[n, x]), int(tree.other[m, y])
                if p < 0 or q < 0:
                    continue
                k = int(tree.back[m, y] - tree.back[n, x])
                if tree.degree[p] != tree.degree[q]:
                    return False
                if any(find((p, z)) != find((q, (z + k) % int(tree.degree[q]))) for z in range(int(tree.degree[p]))):
                    join(p, q, k)
                    changed = True
    for (n, x), (m, y) in itertools.combinations(exits, 2):
        if find((n, x)) == find((m, y)):
            if n == m or not can_be_one(tree, np.array([n]), np.array([m]), np.array([(y - x) % tree.degree[n]]))[0]:
                return False
            if tree.other[n, x] == m and tree.back[n, x] == y:
                return False
    return True


@pytest.mark.parametrize("compass", [True, False])
@pytest.mark.parametrize("seed", range(5))
def test_congruence_says_what_the_fixpoint_says_and_cores_are_minimal(seed, compass):
    walk, true = grid_walk(3, 3, seed, compass=compass)
    tree = fold(walk)
    rng = random.Random(seed)
    congruence = Congruence(tree)
    nodes = {int(n): true[t] for t, n in enumerate(tree.node_of)}
    clashes = 0
    for _ in range(12):
        said = {}
        while len(said) < 6:
            n, m = rng.sample(range(tree.n_nodes), 2)
            degree = int(tree.degree[n])
            if tree.degree[m] == degree and (nodes[n] == nodes[m] or rng.random() < 0.1):
                said[len(said)] = Assertion(n, m, rng.randrange(degree) if not compass and rng.random() < 0.2 else 0)
        core = core_of(congruence, said)
        assert (core is None) == naive_holds(tree, said.values())
        if core is not None:
            clashes += 1
            assert not naive_holds(tree, [said[k] for k in core.members])
            for k in core.members:
                assert naive_holds(tree, [said[other] for other in core.members if other != k])
    assert clashes


# -- many claims, few claims -----------------------------------------------------------------------------------------------


def test_wrong_claims_among_many_are_found_and_no_right_one():
    walk, true = grid_walk(8, 8, 1, legs=600)
    said, bad = mixed(walk, true, 296, 4, 1)
    found = claims(walk, said)
    assert pairs_of(found) == bad
    assert found.exact
    assert found.map.n_places == 64
    assert {(one.a, one.b) for one in found.kept} == {(i, j) for i, j, _ in said} - bad
    for one in found.rejected:  # what it is said to contradict is kept, and enough to contradict it
        assert not set(one.against) & {other.claim for other in found.rejected}
        again = claims(walk, [(c.a, c.b, 1.0) for c in one.against] + [(one.claim.a, one.claim.b, 0.5)], budget=0)
        assert pairs_of(again) == {(one.claim.a, one.claim.b)}


def test_what_only_turning_tells():
    walk, true = grid_walk(5, 5, 3)
    rng = random.Random(3)
    said, _ = mixed(walk, true, 12, 0, 3)
    pairs = [(i, j) for i, j in alike(walk) if true[i] != true[j]]
    rng.shuffle(pairs)
    bad = next(pair for pair in pairs if not claims(walk, [*said, (*pair, 0.6)], budget=0).rejected)
    found = claims(walk, [*said, (*bad, 0.6)], closed=True)
    assert pairs_of(found) == {bad}
    assert found.exact
    assert found.rejected[0].visits is None
    assert "no closed plane map" in found.rejected[0].reason


def test_without_time_what_is_known_is_said_and_marked():
    walk, true = grid_walk(5, 5, 3)
    said, _ = mixed(walk, true, 3, 0, 3)
    found = claims(walk, said, closed=True, budget=0)
    assert not found.exact
    assert found.map is None
    assert not found.rejected


def test_a_wrong_claim_that_agrees_with_everything_stays():
    """A straight corridor: nothing tells one door from the next."""
    ahead, behind = Heading.from_degrees(0), Heading.from_degrees(180)
    events = [Visit(None, (ahead, behind))]
    for _ in range(3):
        events += [Samples.of(ahead), Visit(None, (ahead, behind))]
    walk = Walk(WalkHeader(), tuple(events))
    assert pairs_of(claims(walk, [(0, 3, 1.0)])) == {(0, 3)}  # a closed straight line turns 0
    events[-1] = Visit(None, (ahead, behind, Heading.from_degrees(90)))
    assert pairs_of(claims(Walk(WalkHeader(), tuple(events)), [(1, 2, 1.0)])) == {(1, 2)}
    around, true = grid_walk(2, 2, 0, legs=8)  # around a block twice, or around two blocks: who knows
    assert len(set(true)) == 4
    assert not claims(around, [(0, 4, 1.0)]).rejected
    assert not claims(around, []).rejected


@pytest.mark.parametrize("seed", range(3))
def test_without_a_compass_claims_may_mean_several_shifts(seed):
    walk, true = grid_walk(3, 3, seed, compass=False)
    tree = fold(walk)
    every = hypotheses(walk, closed=True)
    assert every.exact
    rng = random.Random(seed)
    nodes = [(i, j) for i, j in itertools.combinations(range(len(true)), 2) if tree.node_of[i] != tree.node_of[j]]
    good = rng.sample([(i, j) for i, j in nodes if true[i] == true[j]], 4)
    bad = rng.sample([(i, j) for i, j in nodes if true[i] != true[j]], 4)
    said = [(i, j, round(rng.uniform(0.5, 1), 2)) for i, j in good + bad]
    cheapest = min(math.fsum(s for i, j, s in said if one.visits[i] != one.visits[j]) for one in every)
    found = claims(walk, said, closed=True)
    assert found.exact
    assert found.cost == pytest.approx(cheapest)


# -- names, words ----------------------------------------------------------------------------------------------------------


def test_two_names_cannot_be_one_place():
    walk, true = grid_walk(4, 4, 1, names={(1, 1): "hall", (2, 1): "yard"})
    a, b = true.index((1, 1)), true.index((2, 1))
    (one,) = claims(walk, [(a, b, 1.0)], budget=0).rejected
    assert one.visits == (a, b)
    assert one.against == ()
    assert one.reason == f"visits {a} and {b} would be one place, but they are called 'hall' and 'yard'"


def test_visits_of_one_name_are_one_place_beyond_doubt():
    named, true = grid_walk(4, 4, 1, names={(1, 1): "hall"})
    tree = fold(named)
    first = true.index((1, 1))
    again = next(t for t, p in enumerate(true) if p == (1, 1) and tree.node_of[t] != tree.node_of[first])
    wrong = next(t for t, p in enumerate(true) if p == (2, 1))
    (one,) = claims(named, [(again, wrong, 1.0)], budget=0).rejected
    assert one.against == ()  # the walk between the two visits and the names are enough


def test_a_claim_about_places_that_look_different_is_rejected_by_itself():
    walk, true = grid_walk(3, 3, 0)
    a, b = true.index((0, 0)), true.index((1, 1))
    (one,) = claims(walk, [(a, b, 1.0)]).rejected
    assert one.reason == f"visits {a} and {b} would be one place, but they have 2 exits and 4 exits"


def test_a_walk_that_cannot_be_says_so_and_blames_no_claim():
    ahead, behind = Heading.from_degrees(0), Heading.from_degrees(180)
    events = (
        Visit(None, (ahead,)),
        Samples.of(ahead),
        Visit(None, (behind,)),
        Samples.of(behind),
        Visit(None, (ahead, behind)),
    )
    found = claims(Walk(WalkHeader(), events), [(0, 2, 1.0)])
    assert found.contradiction is not None
    assert not found.rejected
    assert not found.exact


# -- a matrix, bad input ---------------------------------------------------------------------------------------------------


def test_a_matrix_gives_the_claims_above_its_threshold():
    walk, true = grid_walk(4, 4, 2)
    look = np.array([[0.9 if p == q else 0.2 for q in true] for p in true])
    look[0, 5], look[5, 0] = 0.3, 0.95
    found = claims(walk, look, threshold=0.5)
    expected = {(i, j) for i, j in itertools.combinations(range(len(true)), 2) if true[i] == true[j] or (i, j) == (0, 5)}
    assert {(one.a, one.b) for one in found.claims} == expected
    assert next(one for one in found.claims if (one.a, one.b) == (0, 5)).score == 0.95


@pytest.mark.parametrize(
    ("given", "threshold", "says"),
    [
        (np.zeros((3, 4)), 0.5, r"is 3 x 4, and the walk has \d+ visits; give a matrix of"),
        (np.zeros(5), 0.5, "is 5, and the walk has"),
        (0.5, 0.5, "is a single number, and the walk has"),
        ([["a"]], 0.5, "a matrix of numbers"),
        (np.zeros((2, 2)), math.nan, "the threshold nan"),
        (np.zeros((2, 2)), 0.0, "the threshold 0.0"),
        ([(0, 1)], None, r"claim 0: \(0, 1\); a claim is"),
        ([(0, 99999, 1.0)], None, r"claim 0: there are no visits \(0, 99999\); visits are numbered 0 to"),
        ([(0, 1.5, 1.0)], None, "claim 0: there are no visits"),
        ([(0, -1, 1.0)], None, "claim 0: there are no visits"),
        ([(0, 1, 1.0), (0, 1, 0.0)], None, "claim 1: the score 0.0; a score is a number above 0"),
        ([(0, 1, math.nan)], None, "claim 0: the score nan"),
        ([(0, math.inf, 1)], None, "claim 0: "),
        (7, None, "claims are"),
    ],
)
def test_bad_claims_are_named(given, threshold, says):
    walk, _ = grid_walk(3, 3, 0)
    with pytest.raises(BadInput, match=says) as caught:
        claims(walk, given, threshold=threshold)
    assert "\n" not in str(caught.value)


def test_a_matrix_with_nan_says_where():
    walk, true = grid_walk(3, 3, 0)
    look = np.ones((len(true), len(true)))
    look[4, 2] = math.nan
    with pytest.raises(BadInput, match=r"visits 4 and 2 look alike as nan \(row 4, column 2\); give finite numbers"):
        claims(walk, look, threshold=0.5)
    with pytest.raises(BadInput, match="claims are about a Walk"):
        claims(true, [])


def test_no_claims_are_no_trouble():
    walk, true = grid_walk(3, 3, 0)
    found = claims(walk, [], closed=True)
    assert (found.claims, found.rejected, found.kept, found.cost) == ((), (), (), 0)
    assert found.exact
    assert found.map.n_places == len(set(true))


def test_where_no_closed_map_explains_the_walk_no_claim_is_blamed():
    ahead, behind = Heading.from_degrees(0), Heading.from_degrees(180)
    events = [Visit(None, (ahead, behind)), Samples.of(ahead), Visit(None, (ahead, behind))]
    events += [Samples.of(ahead), Visit(None, (behind,))]
    found = claims(Walk(WalkHeader(), tuple(events)), [(0, 1, 1.0)], closed=True)
    assert found.rejected == ()
    assert found.contradiction.text == "no closed plane map explains the walk, whatever is claimed"


def test_when_maps_are_hard_to_find_all_are_listed_and_no_claim_is_blamed_by_guess():
    walk, true = grid_walk(6, 6, 5)
    rng = random.Random(5)
    said, _ = mixed(walk, true, 8, 0, 5)
    pairs = [(i, j) for i, j in alike(walk) if true[i] != true[j]]
    rng.shuffle(pairs)
    bad = []
    for pair in pairs:
        if len(bad) < 3 and not claims(walk, [*said, *((*one, 0.6) for one in [*bad, pair])], budget=0).rejected:
            bad.append(pair)
    given = [*said, *((*one, 0.6) for one in bad)]
    found = claims(walk, given, closed=True)
    assert pairs_of(found) == set(bad)
    assert found.exact
    spent = claims(walk, given, closed=True, budget=0)
    assert (spent.exact, spent.rejected, spent.map) == (False, (), None)
