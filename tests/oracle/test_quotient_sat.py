"""The SAT model of the maps that explain a walk, against the search by faces: only the folded walk is common to both."""

import numpy as np
import pytest
from explored import simulated
from lookalikes import covering, laps, unrecognised, walk_of

from ninefold.errors import BadInput, WalkError
from ninefold.io import samples
from ninefold.mapping import Walk, WalkHeader, explore, hypotheses
from ninefold.mapping.doubt._quotient_faces import faces
from ninefold.mapping.doubt.likeness import likeness
from ninefold.mapping.doubt.quotient_portfolio import closed_maps
from ninefold.mapping.doubt.quotient_sat import QuotientSat
from ninefold.mapping.doubt.quotients import QuotientSearch
from ninefold.mapping.doubt.walk_tree import fold


def canonical(tree, maps):
    """Place and shift of every node, numbered as they come, of maps in no order."""
    found = set()
    for one in maps:
        _, first, place = np.unique(one[:, 0], return_index=True, return_inverse=True)
        shift = (one[:, 1] - one[first[place], 1]) % np.maximum(tree.degree, 1)
        found.add((tuple(first[place].tolist()), tuple(shift.tolist())))
    assert len(found) == len(maps)
    return found


def by_search(tree, alike, closed, most=1000):
    """All maps, or None where there are more than can be listed."""
    search, found = QuotientSearch(tree, alike, closed=closed), []
    while not search.done:
        found += list(search.more(2000))
        if len(found) > most or search.decisions > 200_000:
            return None
    return canonical(tree, found)


def by_sat(tree, alike, closed):
    sat = QuotientSat(tree, alike, closed=closed)
    found = sat.more(60)
    assert sat.done
    assert sat.found == len(found)
    sat.close()
    return canonical(tree, found)


def both_agree(walk):
    tree = fold(walk)
    alike = likeness(tree)
    listed = 0
    for closed in (True, False):
        expected = by_search(tree, alike, closed)
        if expected is not None:
            assert by_sat(tree, alike, closed) == expected
            listed += len(expected)
    return listed


@pytest.mark.parametrize(("width", "height"), [(2, 2), (2, 3), (2, 4), (3, 3)])
def test_walks_round_and_round(width, height):
    """A cut must not take a face walked twice for one that turns twice, nor one face for two."""
    assert sum(both_agree(laps(width, height, seed, 14)[0]) for seed in range(25)) > 70


def test_grids_of_identical_places():
    assert sum(both_agree(covering(3, 3, seed)[0]) for seed in range(8)) > 80


@pytest.mark.parametrize("kind", ["half", "sparse", "tree", "ring", "nested"])
@pytest.mark.parametrize("degrees", [10.0, 40.0])
def test_random_worlds(kind, degrees):
    listed = 0
    for seed in range(12):
        for tour in ("depth-first", "covering"):
            walk = unrecognised(explore(simulated(seed, kind, 5 + seed % 6), seed=seed, step=1e6, tour=tour).walk, degrees)
            try:
                if fold(walk).n_nodes <= 20:
                    listed += both_agree(walk)
            except WalkError:  # two exits closer together than the tolerance
                continue
    assert listed > 20


def test_pairs_that_are_known():
    walk, places = covering(3, 3, 1)
    tree = fold(walk)
    at = tree.node_of
    pairs = {
        (int(at[i]), int(at[j])) for i in range(len(places)) for j in range(i) if places[i] == places[j] and at[i] != at[j]
    }
    same = sorted(pairs)[:1]
    free = by_search(tree, likeness(tree), False)
    for known in ({"same": same}, {"differ": same}):
        alike = likeness(tree, **known)
        expected = by_search(tree, alike, False)
        assert by_sat(tree, alike, False) == expected
        assert 0 < len(expected) < len(free)


def test_no_map_has_more_places_than_asked_for():
    walk, _ = covering(3, 3, 0)
    tree = fold(walk)
    alike = likeness(tree)
    everything = QuotientSat(tree, alike).more(30)
    fewest = min(np.unique(one[:, 0]).size for one in everything)
    sat = QuotientSat(tree, alike, most_places=fewest)
    assert len(sat.more(30)) == sum(np.unique(one[:, 0]).size == fewest for one in everything) == sat.found
    assert sat.done


def test_a_torus_is_no_map():
    """East, then north, where every place looks alike: the only closed quotient is one place, on a torus."""
    tree = fold(walk_of(7, 7, (3, 3), [0, 1])[0])
    alike = likeness(tree)
    one_place = np.zeros(tree.n_nodes, np.int64)
    assert [face.turns for face in faces(tree, one_place, one_place)] == [1]
    assert by_sat(tree, alike, True) == by_search(tree, alike, True) == set()


def test_without_a_compass_there_is_no_model():
    walk, _ = covering(2, 2, 0)
    tree = fold(Walk(WalkHeader(compass=False), walk.events))
    with pytest.raises(BadInput, match="without a compass"):
        QuotientSat(tree, likeness(tree))


# -- the two side by side ------------------------------------------------------------------------------------------------


def test_the_race_gives_what_each_gives_alone():
    from time import monotonic

    for seed in range(4):
        tree = fold(covering(4, 4, seed)[0])
        alike = likeness(tree)
        found = closed_maps(tree, alike, until=monotonic() + 60, most=100)
        assert found.exact
        assert canonical(tree, found.maps) == by_sat(tree, alike, True) == by_search(tree, alike, True)


def test_a_race_out_of_time_says_so():
    from time import monotonic

    tree = fold(covering(4, 4, 0)[0])
    assert closed_maps(tree, likeness(tree), until=monotonic() - 1, most=10) == ([], 0, False)


@pytest.fixture(scope="module")
def district():
    return samples.load("helsinki_district").to_world()


@pytest.mark.parametrize(("tour", "seed", "count"), [("covering", 0, 1), ("covering", 8, 2), ("depth-first", 3, 1)])
def test_the_district_without_names(district, tour, seed, count):
    """The search alone does not end on these in minutes; the solver takes less than a second."""
    walk = explore(district, seed=seed, step=1e6, tour=tour).walk
    found = hypotheses(unrecognised(walk, 10.0), closed=True)
    assert found.exact
    assert found.count == len(found) == count
    name = [event.place for event in walk.events if hasattr(event, "place")]
    true = [{p: i for i, p in enumerate(dict.fromkeys(name))}[p] for p in name]
    assert true in [one.visits.tolist() for one in found]
    for one in found:
        assert one.plane.n_vertices == one.n_places
