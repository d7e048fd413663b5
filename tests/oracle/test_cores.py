"""Refutations that name their statements, and the minimal conflicts made from them, against plain references."""

import numpy as np
import pytest

from ninefold._kernels import Kernel
from ninefold.encodings import ALLEN, NP8, POINT, RCC5, RCC8
from ninefold.reasoner.networks import _cores
from ninefold.reasoner.networks._cores import OutOfTime
from ninefold.reasoner.networks._parts import Part
from ninefold.reasoner.networks.conflicts import conflict, part_of
from ninefold.reasoner.networks.consistency import Consistent, Inconsistent, check
from ninefold.reasoner.networks.network import Network
from tests.oracle.network_reference import Reference, random_network

CALCULI = [RCC8, RCC5, POINT, ALLEN]
REFERENCES = {calculus.name: Reference(calculus) for calculus in CALCULI}


@pytest.fixture
def compiled(monkeypatch):
    """Every kernel compiled, however little there is to do."""
    monkeypatch.setattr(Kernel, "for_work", lambda kernel, _: kernel.compiled)


@pytest.fixture
def plain(monkeypatch):
    """Every kernel plain."""
    monkeypatch.setattr(Kernel, "for_work", lambda kernel, _: kernel.plain)


def hard_network(n, degree, seed):
    """Random labels for which closure does not decide, on random pairs."""
    rng = np.random.default_rng(seed)
    rows, columns = np.triu_indices(n, 1)
    pick = np.sort(rng.choice(rows.size, size=round(n * degree / 2), replace=False))
    masks = [int(rng.choice(list(NP8))) for _ in pick]
    return Network.from_constraints(RCC8, n, zip(rows[pick].tolist(), columns[pick].tolist(), masks, strict=True))


def parts(net, rng, count):
    """Random parts of the statements, ascending."""
    for _ in range(count):
        size = int(rng.integers(net.n_statements // 2, net.n_statements + 1))
        yield sorted(rng.choice(net.n_statements, size, replace=False).tolist())


@pytest.mark.parametrize("form", ["plain", "compiled"])
@pytest.mark.parametrize("calculus", CALCULI, ids=lambda calculus: calculus.name)
def test_each_part_is_decided_and_each_core_is_a_refuted_part_of_it(calculus, form, request):
    request.getfixturevalue(form)
    rng = np.random.default_rng(21)
    reference, cores, smaller = REFERENCES[calculus.name], 0, 0
    for at in range(25):
        n = int(rng.integers(3, 8))
        hard = calculus == RCC8 and at % 2
        size = max(1.3, calculus.n_bases * 0.3)
        constraints = random_network(calculus, rng, n, n - 1.0, size, NP8.__contains__ if hard else lambda mask: True)
        net = Network.from_constraints(calculus, n, constraints)
        part = Part(net.statements, calculus, decides=True, seed=at)
        for chosen in parts(net, rng, 12):
            core = part.refute(chosen, None)
            solved = reference.solve(n, [constraints[k] for k in chosen])
            assert (core is None) == (solved is not None)
            if core is not None:
                assert set(core) <= set(chosen)
                assert reference.solve(n, [constraints[k] for k in core]) is None
                cores += 1
                smaller += len(core) < len(chosen)
    assert cores > 20 < smaller


@pytest.mark.usefixtures("compiled")
@pytest.mark.parametrize("seed", range(6))
def test_clauses_handed_on_stay_true(seed):
    """Each search after the first begins with clauses of others; the answers are those of searches that have none."""
    rng = np.random.default_rng(seed)
    net = hard_network(24, 10.5, seed)
    part = Part(net.statements, RCC8, decides=True, seed=0)
    refuted = 0
    for chosen in [list(range(net.n_statements)), *parts(net, rng, 15)]:
        if len(chosen) < net.n_statements // 2:
            continue
        core = part.refute(chosen, None)
        verdict = check(part_of(net, chosen))
        assert isinstance(verdict, Consistent if core is None else Inconsistent)
        if core is not None:
            refuted += 1
            assert isinstance(check(part_of(net, core)), Inconsistent)
    assert part.searched or not refuted


@pytest.mark.usefixtures("compiled")
def test_clean_ups_and_shortage_of_room_change_no_answer(monkeypatch):
    """Clauses are thrown away often, statements share bits of the sets, and every array is too small at first."""
    monkeypatch.setattr(_cores, "_REDUCE_FIRST", 10)
    monkeypatch.setattr(_cores, "_REDUCE_STEP", 1)
    monkeypatch.setattr(_cores, "_GROUPS", 70)
    monkeypatch.setattr(_cores, "_HANDED_ON", 30)
    made = _cores.t.new_trace

    def scarce(*arguments):
        trace = made(*arguments)
        return trace._replace(
            keys=trace.keys[:8], found=trace.found[:8], goals=trace.goals[:4], used=trace.used[:4],
            units=trace.units[:1], stack=trace.stack[:4], sets=trace.sets[: int(trace.reg[_cores.t.N_ROWS]) + 2],
        )  # fmt: skip

    clean_ups = []
    clean_up = _cores.CoreSearch._reduce
    monkeypatch.setattr(_cores.CoreSearch, "_reduce", lambda self: (clean_ups.append(self), clean_up(self)))
    monkeypatch.setattr(_cores.t, "new_trace", scarce)
    for seed in range(4):
        net = hard_network(80, 16, seed)
        part = Part(net.statements, RCC8, decides=True, seed=seed)
        core = part.refute(range(net.n_statements), None)
        verdict = check(net)
        assert isinstance(verdict, Consistent if core is None else Inconsistent)
        if core is not None:
            assert isinstance(check(part_of(net, core)), Inconsistent)
    assert len(clean_ups) > 3


@pytest.mark.parametrize(
    ("n", "degree", "seed"), [(30, 14.0, 0), (40, 15.0, 1), (40, 16.0, 2), (60, 16.0, 3), (80, 16.0, 4)]
)
def test_conflicts_of_hard_networks_are_minimal(n, degree, seed):
    net = hard_network(n, degree, seed)
    if isinstance(check(net), Consistent):
        assert conflict(net) is None
        return
    found = conflict(net)
    assert found.minimal
    assert isinstance(check(found.to_network()), Inconsistent)
    for k in found.indices:
        assert isinstance(check(part_of(net, [x for x in found.indices if x != k])), Consistent)


def test_the_same_seed_gives_the_same_conflict_plain_or_compiled(monkeypatch):
    net = hard_network(40, 16, 2)
    found = []
    for form in ("compiled", "plain", "compiled"):
        monkeypatch.setattr(Kernel, "for_work", lambda kernel, _, form=form: getattr(kernel, form))
        found.append(conflict(net, seed=3).indices)
    assert found[0] == found[1] == found[2]


def test_several_statements_about_one_pair():
    reference, rng, seen = REFERENCES["rcc8"], np.random.default_rng(5), 0
    for _ in range(60):
        n = int(rng.integers(2, 5))
        constraints = [c for _ in range(3) for c in random_network(RCC8, rng, n, n - 1.0, 4.5)]
        net = Network.from_constraints(RCC8, n, constraints)
        found = conflict(net)
        assert (found is None) == (reference.solve(n, constraints) is not None)
        if found is None:
            continue
        seen += 1
        assert reference.solve(n, [constraints[k] for k in found.indices]) is None
        for k in found.indices:
            assert reference.solve(n, [constraints[x] for x in found.indices if x != k]) is not None
    assert seen > 20


def test_hard_statements_are_left_out_last():
    """Statements that must not be dropped say all of it, and a soft one says it again."""
    net = Network("rcc8")
    for k in range(30):
        net.add(k, k + 1, "inside", weight=np.inf)
    net.add(0, 30, "inside", "said")
    net.add(30, 0, "disjoint", "wrong")
    assert [s.label for s in conflict(net) if not s.hard] == ["wrong"]


def test_a_ring_is_minimal_without_a_search():
    net = Network("rcc8")
    for k in range(401):
        net.add(k, (k + 1) % 401, "NTPP")
    found = conflict(net)
    assert len(found) == 401
    assert found.minimal


@pytest.mark.usefixtures("compiled")
def test_time():
    net = hard_network(80, 16, 4)
    assert isinstance(check(net), Inconsistent)
    found = conflict(net, budget=1e-9, known=True)
    assert not found.minimal
    assert isinstance(check(found.to_network()), Inconsistent)
    with pytest.raises(OutOfTime):
        Part(net.statements, RCC8, decides=True, seed=0).refute(range(net.n_statements), 0.0)


def test_a_calculus_that_nobody_has_studied_has_conflicts_not_known_to_be_minimal():
    own = type(POINT)("own", POINT.bases, POINT.identity, POINT.base_converse, POINT.base_composition)
    net = Network(own)
    for a, word, b in [("a", "<", "b"), ("b", "<", "c"), ("a", "<", "d"), ("c", "<", "a")]:
        net.add(a, b, word)
    found = conflict(net)
    assert found.indices == (0, 1, 3)
    assert not found.minimal
