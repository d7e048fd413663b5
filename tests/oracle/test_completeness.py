"""Evidence that a list of maps is complete: the clauses against the walk, the refutation against a foreign checker."""

import dataclasses

import pytest
from dratify import check_proof, parse_dimacs
from explored import simulated
from lookalikes import covering, laps, unrecognised

from ninefold.errors import BadInput, TooLarge
from ninefold.io import samples
from ninefold.mapping import Completeness, Heading, Samples, Visit, Walk, WalkHeader, explore, hypotheses, listed_maps


def accepted(found):
    checked = check_proof(parse_dimacs(found.cnf.decode()), found.refutation.decode())
    return checked.ok and checked.reached_empty


def confirmed(walk, closed, **known):
    """Both checkers accept, and the maps listed are those found; their number."""
    found = hypotheses(walk, closed=closed, **known)
    evidence = found.evidence()
    assert accepted(evidence)
    listed = listed_maps(walk, evidence.cnf, **known)
    assert sorted(one.tolist() for one in listed) == sorted(one.visits.tolist() for one in found)
    assert evidence.n_maps == found.count
    header = next(line for line in evidence.cnf.decode().splitlines() if line.startswith("p"))
    assert header == f"p cnf {evidence.n_variables} {evidence.n_clauses}"
    return found.count


@pytest.mark.parametrize("closed", [None, True])
def test_small_walks(closed):
    assert sum(confirmed(laps(*size, seed, 14)[0], closed) for size in ((2, 3), (3, 3)) for seed in range(12)) > 10


@pytest.mark.parametrize("kind", ["sparse", "ring"])
def test_random_worlds(kind):
    for seed in range(8):
        walk = unrecognised(explore(simulated(seed, kind, 5), seed=seed, step=1e6).walk, 15.0)
        confirmed(walk, True)


def test_a_grid_of_six_by_six():
    for seed in range(2):
        assert confirmed(covering(6, 6, seed)[0], True) == 1


def test_the_district():
    walk = explore(samples.load("helsinki_district").to_world(), seed=8, step=1e6, tour="covering").walk
    assert confirmed(unrecognised(walk, 10.0), True) == 2


def test_pairs_that_are_known():
    walk, places = covering(3, 3, 1)
    pair = next((j, i) for i in range(len(places)) for j in range(i - 2) if places[i] == places[j])
    every = hypotheses(walk).count
    assert confirmed(walk, None, same=[pair]) + confirmed(walk, None, differ=[pair]) == every


def test_legs_that_turn_differently_went_different_ways():
    """Once straight on and once round in a spiral: places where the way on differs by a whole turn are two."""
    yaw = [Heading.from_degrees(d) for d in (0, 90, 180, 270, 0)]
    place = Visit(None, exits=(yaw[0], yaw[2]))
    straight, spiral = Samples.of(yaw[0], yaw[0]), Samples.of(*yaw)
    legs = [straight, spiral, straight, straight, spiral, spiral]
    events = [place, *(event for leg in legs for event in (leg, place))]
    assert confirmed(Walk(WalkHeader(), tuple(events)), None) > 0


@pytest.fixture(scope="module")
def walk():
    return covering(4, 4, 0)[0]


@pytest.fixture(scope="module")
def evidence(walk):
    return hypotheses(walk, closed=True).evidence()


def test_a_list_with_a_map_left_out_has_no_evidence(walk):
    found = hypotheses(walk, closed=True)
    shorter = dataclasses.replace(found, maps=(), count=0)
    with pytest.raises(BadInput, match=r"0 maps listed, and there is another with 16 places"):
        shorter.evidence()


def test_without_the_clause_of_a_map_nothing_is_refuted(evidence):
    lines = evidence.cnf.decode().splitlines()
    head = lines.index(f"p cnf {evidence.n_variables} {evidence.n_clauses}")
    lines[head] = f"p cnf {evidence.n_variables} {evidence.n_clauses - 1}"
    assert not accepted(dataclasses.replace(evidence, cnf="\n".join([*lines[:-1], ""]).encode()))


def test_a_clause_that_does_not_follow_is_refused(walk, evidence):
    """With one literal less a clause is refused, or still holds of the one map there is."""
    found = hypotheses(walk, closed=True)
    place = found.maps[0].place
    head, _, body = evidence.cnf.decode().partition("\np cnf ")
    pairs = [line.split()[2:6] for line in head.splitlines() if line.startswith("c variable")]
    true = {int(x) for x, _, n, m in pairs if place[int(n)] == place[int(m)]}
    size, *clauses = body.splitlines()
    tried = [at for at, clause in enumerate(clauses) if len(clause.split()) > 2][::5]
    refused = 0
    for at in tried:
        shorter = clauses[at].split(" ", 1)[1]
        text = "\n".join([f"{head}\np cnf {size}", *clauses[:at], shorter, *clauses[at + 1 :], ""])
        try:
            listed_maps(walk, text.encode())
        except BadInput as error:
            refused += f"clause {at + 1} of the formula does not follow" in str(error)
        else:
            assert any((int(x) > 0) == (abs(int(x)) in true) for x in shorter.split()[:-1])
    assert refused > len(tried) / 2


def test_a_clause_without_a_reason_is_refused(walk, evidence):
    lines = [line for line in evidence.cnf.decode().splitlines() if " map " not in line or line.startswith("c ninefold")]
    with pytest.raises(BadInput, match="does not follow from the walk as 'nothing'"):
        listed_maps(walk, "\n".join(lines).encode())


def test_a_formula_of_another_walk_is_refused(evidence):
    with pytest.raises(BadInput):
        listed_maps(covering(4, 4, 1)[0], evidence.cnf)


def test_what_is_no_formula_is_refused(walk):
    with pytest.raises(BadInput, match="begins with 'c ninefold maps 1'"):
        listed_maps(walk, b"p cnf 1 1\n1 0\n")


def test_evidence_is_written_whole_and_never_over_a_file(evidence, tmp_path):
    proof, formula = evidence.write(tmp_path / "maps.drat")
    assert (proof.read_bytes(), formula.read_bytes()) == (evidence.refutation, evidence.cnf)
    assert formula == tmp_path / "maps.cnf"
    with pytest.raises(BadInput, match=r"maps\.drat"):
        evidence.write(tmp_path / "maps.drat")
    assert isinstance(evidence, Completeness)
    with pytest.raises(BadInput, match="give the refutation another ending"):
        evidence.write(tmp_path / "maps.cnf")


def test_what_has_no_evidence_says_so(walk):
    found = hypotheses(walk, closed=True)
    with pytest.raises(BadInput, match="an exact count"):
        dataclasses.replace(found, exact=False).evidence()
    with pytest.raises(BadInput, match="leave out max_places"):
        hypotheses(walk, closed=True, max_places=20).evidence()
    with pytest.raises(BadInput, match="closed be None or True"):
        hypotheses(covering(2, 2, 0)[0], closed=False).evidence()
    with pytest.raises(BadInput, match="without a compass"):
        hypotheses(Walk(WalkHeader(compass=False), laps(2, 2, 0, 3)[0].events), closed=True).evidence()
    with pytest.raises(TooLarge, match="give more seconds"):
        hypotheses(covering(6, 6, 0)[0], closed=True).evidence(budget=1e-4)
