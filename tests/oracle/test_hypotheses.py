"""Every map that explains a walk: the published counts, a brute force, and the search without its pruning."""

import os
import random
from dataclasses import replace
from math import pi, radians

import numpy as np
import pytest
from alike import (
    AlikeWorld,
    Tour,
    Way,
    covering_walk,
    depth_first_walk,
    grid,
    observed,
    piece,
    same_places,
)

from ninefold._kernels import Kernel
from ninefold.errors import WalkError
from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader, hypotheses
from ninefold.mapping.doubt.likeness import can_be_one, likeness
from ninefold.mapping.doubt.quotients import QuotientSearch
from ninefold.mapping.doubt.walk_tree import WalkTree, fold
from tests.oracle.hypotheses_reference import Quotient, all_quotients

WORLDS = int(os.environ.get("NINEFOLD_WORLDS", "250"))
"""Random worlds for each of the two comparisons; 1,000 take a few minutes."""

MOST_QUOTIENTS = 2000
MOST_DECISIONS = 50_000

TABLE = {
    # columns, rows, seed: all, planar, closed faces turn, all faces turn
    (3, 3, 0): (16, 14, 14, 14),
    (3, 3, 1): (16, 12, 12, 11),
    (3, 4, 0): (96, 84, 68, 52),
    (3, 4, 1): (294, 181, 106, 44),
    (4, 4, 0): (19_868, 3_289, 2_768, 1_196),
    (4, 4, 1): (2_330, 676, 469, 187),
}


def alike_walk(columns: int, rows: int, seed: int, *, compass: bool = True) -> Walk:
    world = grid(columns, rows)
    return observed(world, covering_walk(world, seed), compass=compass, seed=seed)


def of_visits(tree: WalkTree, places: np.ndarray, shifts: np.ndarray) -> Quotient:
    """Places of nodes as places of visits, numbered as met, with the exits of their first visits."""
    degree = tree.degree[tree.node_of]
    first: dict[int, tuple[int, int]] = {}
    place, shift = [], []
    for w, s, d in zip(
        places[tree.node_of].tolist(), (tree.shift_of + shifts[tree.node_of]).tolist(), degree.tolist(), strict=True
    ):
        number, began = first.setdefault(w, (len(first), s))
        place.append(number)
        shift.append((s - began) % max(d, 1))
    return Quotient(tuple(place), tuple(shift))


def searched(
    tree: WalkTree, *, most: int | None = None, step: int = 4096, kept: int = 4096, **options
) -> set[Quotient] | None:
    """The quotients that the search finds, each once; None where that takes too many decisions."""
    alike = options.pop("alike", None)
    search = QuotientSearch(tree, likeness(tree) if alike is None else alike, **options)
    found: list[Quotient] = []
    while not search.done:
        found += [of_visits(tree, one[:, 0], one[:, 1]) for one in search.more(step, kept)]
        if most is not None and search.decisions > most:
            return None
    assert len(found) == len(set(found)) == search.found
    return set(found)


@pytest.mark.parametrize(("columns", "rows", "seed"), TABLE)
def test_the_table_of_counts(columns, rows, seed):
    walk = alike_walk(columns, rows, seed)
    every = all_quotients(walk)
    verdicts = list(every.values())
    counts = (len(every), *(sum(getattr(one, rule) for one in verdicts) for rule in ("planar", "turning", "strict")))
    assert counts == TABLE[columns, rows, seed]
    for rule in ("planar", "turning", "strict"):
        assert sum(one.closed and getattr(one, rule) for one in verdicts) == 1
    tree = fold(walk)
    planar = {quotient for quotient, one in every.items() if one.planar}
    strict = {quotient for quotient, one in every.items() if one.strict}
    for root in range(tree.n_nodes):
        assert searched(tree, root=root) == strict
        assert searched(tree, root=root, closed=True) == {quotient for quotient in strict if every[quotient].closed}
    for root in (0, tree.n_nodes // 2, tree.n_nodes - 1):
        assert searched(tree, root=root, turning=False) == planar
        assert len(searched(tree, root=root, turning=False, closed=True)) == 1


@pytest.mark.parametrize(("columns", "rows", "seed"), [at for at in TABLE if at[:2] != (4, 4)])
def test_without_a_compass_the_table_is_the_same(columns, rows, seed):
    walk = alike_walk(columns, rows, seed, compass=False)
    every = all_quotients(walk)
    strict = {quotient for quotient, one in every.items() if one.strict}
    assert len(strict) == TABLE[columns, rows, seed][3]
    tree = fold(walk)
    for root in range(tree.n_nodes):
        assert searched(tree, root=root) == strict
        assert searched(tree, root=root, closed=True) == {quotient for quotient in strict if every[quotient].closed}


def frames_turned(tree: WalkTree, seed: int) -> WalkTree:
    """The same tree, the headings of every node held against a direction of its own."""
    turned = np.random.default_rng(seed).uniform(-pi, pi, tree.n_nodes)
    return replace(tree, heading=tree.heading + turned[:, None])


@pytest.mark.parametrize("seed", range(6))
def test_without_a_compass_the_frames_of_visits_say_nothing(seed):
    for world in (grid(3, 3), piece(seed, 8)):
        tree = fold(observed(world, covering_walk(world, seed), compass=False, tolerance=radians(15), seed=seed))
        assert searched(frames_turned(tree, seed)) == searched(tree) != set()


def random_walk(seed: int, *, largest: int) -> tuple[Walk, tuple[int, ...]] | None:
    """A walk in a small random world, whole or cut short, and the true places; None where its headings are too near."""
    rng = random.Random(seed)
    tolerance = radians(rng.uniform(10, 40))
    compass = rng.random() < 0.6
    if rng.random() < 0.3:
        world = grid(rng.choice((2, 3)), rng.choice((2, 3)))
    else:
        world = piece(seed, rng.randint(2, largest), dead_ends=rng.random() < 0.5)
    tour = rng.choice((covering_walk, depth_first_walk))(world, seed)
    if rng.random() < 0.3:
        tour = Tour(tour.start, tour.taken[: rng.randint(3, 26)])
    noise = tolerance * rng.choice((0.0, 0.1, 0.3))
    walk = observed(world, tour, compass=compass, tolerance=tolerance, noise=noise, seed=seed)
    try:
        contradiction = fold(walk).contradiction
    except WalkError:  # two exits so near that a leg may have taken either
        return None
    return None if contradiction is not None else (walk, tour.places(world))


def roots(tree: WalkTree) -> set[int]:
    return {0, tree.n_nodes // 2, tree.n_nodes - 1}


def test_small_random_worlds_against_brute_force():
    done = seed = lost = 0
    kinds = set()
    while done < WORLDS:
        seed += 1
        made = random_walk(seed, largest=9)
        if made is None or len(made[1]) > 26:
            continue
        walk, true = made
        every = all_quotients(walk, most=MOST_QUOTIENTS)
        if every is None:
            continue
        done += 1
        tree = fold(walk)
        strict = {quotient for quotient, one in every.items() if one.strict}
        closed = {quotient for quotient in strict if every[quotient].closed}
        lost += not any(same_places(quotient.place, true) for quotient in strict)
        kinds.add((walk.header.compass, len(closed) > 1, len(strict) > 1))
        for root in roots(tree):
            assert searched(tree, root=root) == strict, (seed, root)
            assert searched(tree, root=root, closed=True) == closed, (seed, root)
            assert searched(tree, root=root, turning=False) == {q for q, one in every.items() if one.planar}, (seed, root)
        found = hypotheses(walk)
        assert (found.exact, found.count, len(found)) == (True, len(strict), len(strict)), seed
        assert {of_visits(tree, one.place, one.shift) for one in found} == strict, seed
        assert sum(one.closed for one in found) == len(closed), seed
        for one in found:
            plane = one.plane
            assert plane.n_vertices == one.n_places, seed
            assert plane.n_vertices - plane.n_edges + plane.n_faces == 2, seed
    assert len(kinds) >= 5, "worlds with one map and with several, closed or not, with and without a compass"
    assert lost <= done // 100, "the truth is among the maps, but where two exits came out in the wrong order"


def test_pruning_loses_nothing():
    done, seed = 0, 10_000
    several = 0
    while done < WORLDS:
        seed += 1
        made = random_walk(seed, largest=14)
        if made is None:
            continue
        tree = fold(made[0])
        openly = searched(tree, most=MOST_DECISIONS)
        if openly is None:
            continue
        done += 1
        closed = {quotient for quotient in openly if is_closed(tree, quotient)}
        several += len(openly) > 1
        for root in roots(tree):
            assert searched(tree, root=root, closed=True) == closed, (seed, root)
    assert several > done // 3


def is_closed(tree: WalkTree, quotient: Quotient) -> bool:
    """Whether every exit of every place was taken, forth or back."""
    degree = {place: int(tree.degree[n]) for place, n in zip(quotient.place, tree.node_of, strict=True)}
    used = set()
    for t in range(1, tree.n_visits):
        out = int(tree.taken[t - 1] - tree.shift_of[t - 1]) + quotient.shift[t - 1]
        used.add((quotient.place[t - 1], out % degree[quotient.place[t - 1]]))
        back = int(tree.back[tree.node_of[t - 1], tree.taken[t - 1]] - tree.shift_of[t]) + quotient.shift[t]
        used.add((quotient.place[t], back % degree[quotient.place[t]]))
    return len(used) == sum(degree.values())


def torus(columns: int, rows: int) -> AlikeWorld:
    """A grid whose opposite sides are joined: no plane, and every face of it turns +1."""
    stars = [tuple(h * pi / 2 for h in range(4))] * (columns * rows)
    ways = []
    for x in range(columns):
        for y in range(rows):
            beside = ((x + 1, y), (x, y + 1), (x - 1, y), (x, y - 1))
            ways.append(tuple(Way(a % columns * rows + b % rows, (h + 2) % 4, 0.0) for h, (a, b) in enumerate(beside)))
    return AlikeWorld(tuple(stars), tuple(ways))


@pytest.mark.parametrize("compass", [True, False])
def test_a_torus_is_no_map(compass):
    world = torus(2, 2)
    tour = covering_walk(world, 1)
    walk = observed(world, tour, compass=compass)
    every = all_quotients(walk)
    flat = [quotient for quotient, one in every.items() if one.torus]
    assert any(same_places(quotient.place, tour.places(world)) for quotient in flat), (
        "it explains the walk but for the plane"
    )
    tree = fold(walk)
    assert searched(tree) == {quotient for quotient, one in every.items() if one.strict} != set()
    for root in range(tree.n_nodes):
        assert searched(tree, root=root, closed=True) == {q for q, one in every.items() if one.strict and one.closed}


def test_a_torus_occurs_among_the_quotients_of_a_walk_in_the_plane():
    walk, _ = random_walk(888, largest=9)
    every = all_quotients(walk)
    assert any(one.torus for one in every.values())
    assert not any(one.torus and one.strict for one in every.values())
    assert searched(fold(walk), closed=True) == {q for q, one in every.items() if one.strict and one.closed}


def named(walk: Walk, names: dict[int, str]) -> Walk:
    """The walk with some visits recognised."""
    numbers = iter(range(len(walk.events)))
    return replace(
        walk,
        events=tuple(
            replace(event, place=names.get(next(numbers))) if isinstance(event, Visit) else event for event in walk.events
        ),
    )


@pytest.mark.parametrize("seed", range(30))
def test_names_and_known_pairs_are_constraints(seed):
    rng = random.Random(seed)
    columns, rows = rng.choice(((3, 3), (3, 4)))
    world = grid(columns, rows)
    tour = covering_walk(world, seed % 2)
    walk = observed(world, tour, compass=rng.random() < 0.7)
    true = tour.places(world)
    every = {quotient for quotient, one in all_quotients(walk).items() if one.strict}
    recognised = {t: f"place {true[t]}" for t in rng.sample(range(len(true)), rng.randint(0, 5))}
    pairs = [(rng.randrange(len(true)), rng.randrange(len(true))) for _ in range(4)]
    same = [(a, b) for a, b in pairs[:2] if true[a] == true[b]] + pairs[2:3] * (seed % 3 == 0)
    differ = [(a, b) for a, b in pairs[:2] if true[a] != true[b]] + pairs[3:] * (seed % 5 == 0)

    def holds(quotient: Quotient) -> bool:
        place = quotient.place
        return (
            all(place[a] == place[b] for a, b in same)
            and all(place[a] != place[b] for a, b in differ)
            and all((place[a] == place[b]) == (recognised[a] == recognised[b]) for a in recognised for b in recognised)
        )

    found = hypotheses(named(walk, recognised), same=same, differ=differ)
    assert found.exact
    assert {of_visits(found.tree, one.place, one.shift) for one in found} == {one for one in every if holds(one)}


def test_a_visit_does_not_differ_from_itself():
    walk = alike_walk(3, 3, 0)
    for visit in (0, 5):
        found = hypotheses(walk, differ=[(visit, visit)])
        assert (found.count, found.exact) == (0, True)


@pytest.mark.parametrize("most", [1, 8, 9, 10, 12, 40])
@pytest.mark.parametrize("compass", [True, False])
def test_no_map_has_more_places_than_asked_for(most, compass):
    walk = alike_walk(3, 4, 1, compass=compass)
    every = {quotient for quotient, one in all_quotients(walk).items() if one.strict and max(quotient.place) < most}
    found = hypotheses(walk, max_places=most)
    assert {of_visits(found.tree, one.place, one.shift) for one in found} == every
    for root in (0, 7):
        assert searched(found.tree, root=root, most_places=most) == every


@pytest.mark.parametrize(("step", "kept"), [(1, 1), (1, 4096), (4096, 1), (7, 3), (50, 10)])
@pytest.mark.parametrize("options", [{}, {"closed": True}, {"turning": False}])
def test_a_search_gone_on_with_finds_the_same(step, kept, options):
    tree = fold(alike_walk(3, 4, 0))
    assert searched(tree, step=step, kept=kept, **options) == searched(tree, **options)


@pytest.mark.parametrize("compass", [True, False])
def test_compiled_and_plain_kernels_find_the_same_in_the_same_order(compass, monkeypatch):
    walks = [alike_walk(3, 4, 0, compass=compass), alike_walk(4, 4, 1, compass=compass)]
    walks += [made[0] for made in (random_walk(seed, largest=12) for seed in range(20)) if made is not None]
    found = {}
    for form in ("plain", "compiled"):
        monkeypatch.setattr(Kernel, "for_work", lambda kernel, _, form=form: getattr(kernel, form))
        for number, walk in enumerate(walks):
            tree = fold(walk)
            for closed in (False, True):
                search = QuotientSearch(tree, likeness(tree), closed=closed, root=tree.n_nodes // 3)
                places = [search.more(100, 50).tolist() for _ in range(4)]
                found[form, number, closed] = places, search.found, search.decisions, search.done
    half = {key[1:]: value for key, value in found.items() if key[0] == "plain"}
    assert half == {key[1:]: value for key, value in found.items() if key[0] == "compiled"}
    assert sum(value[1] for value in half.values()) > 100


def test_maps_come_closed_before_open_and_fewest_places_first():
    found = hypotheses(alike_walk(3, 4, 0))
    assert found.count == 52
    order = [(not one.closed, one.n_places) for one in found]
    assert order == sorted(order)
    assert [one.closed for one in found].count(True) == 1
    assert found.maps[0].n_places == 12
    assert [hypotheses(alike_walk(3, 4, 0), closed=closed).count for closed in (True, False)] == [1, 51]


def walk_of_turns(*turns: float, compass: bool = True, back: bool = False) -> Walk:
    """Straight on through places with an exit east and one west, along ways that turn by half a turn or so.

    From the first place east; from every other by the exit it was not reached by, or by the same if the robot goes back.
    """
    headings = (Heading(0.0), Heading(pi))
    events: list[Visit | Samples] = [Visit(None, headings)]
    out = 0.0
    for turn in turns:
        events += [Samples(tuple(np.linspace(out, out + turn, 9).tolist())), Visit(None, headings)]
        out = out + turn + (pi if back else 0.0)
    return Walk(WalkHeader(compass=compass), tuple(events))


@pytest.mark.parametrize("compass", [True, False])
def test_a_way_turns_by_as_much_whenever_it_is_walked(compass):
    """East and round to the left, west and round to the left: a ring. East and round to the right is another way."""
    for turns, ring in (((pi, pi, pi), True), ((pi, pi, -pi), False), ((pi, pi, pi, pi, -pi), False)):
        walk = walk_of_turns(*turns, compass=compass)
        every = all_quotients(walk)
        tree = fold(walk)
        strict = {quotient for quotient, one in every.items() if one.strict}
        assert any(quotient.place[0] == quotient.place[2] for quotient in strict) == ring
        for root in range(tree.n_nodes):
            assert searched(tree, root=root) == strict
            assert searched(tree, root=root, closed=True) == {q for q in strict if every[q].closed}


@pytest.mark.parametrize("compass", [True, False])
def test_a_way_back_that_turns_otherwise_contradicts_the_way_there(compass):
    assert fold(walk_of_turns(pi, -pi, compass=compass, back=True)).contradiction is None
    found = hypotheses(walk_of_turns(pi, pi, compass=compass, back=True))
    assert (found.count, found.exact) == (0, True)
    assert (found.contradiction.first, found.contradiction.last) == (0, 2)
    assert "visit 3 must be the place of visit 1, and the way there turns by" in found.contradiction.text


@pytest.mark.parametrize("compass", [True, False])
def test_pairs_alone_are_as_alike_as_in_the_table(compass):
    different = 0
    for seed in range(40):
        world = piece(seed, 8)
        walk = observed(
            world, covering_walk(world, seed), compass=compass, tolerance=radians(20), noise=radians(2), seed=seed
        )
        trees = [fold(walk_of_turns(pi, pi, -pi, pi, compass=compass))]
        try:
            trees.append(fold(walk))
        except WalkError:
            continue
        for tree in trees:
            table = likeness(tree).shifts
            for k in range(int(tree.degree.max())):
                n, m = np.nonzero(tree.degree[:, None] + 0 * tree.degree[None, :] > k)
                found = can_be_one(tree, n, m, np.full(n.size, k))
                off = n != m
                assert (found == (table[n, m] >> k & 1).astype(bool))[off].all()
                different += int((~found).sum())
    assert different
