"""Answers about small random networks against plain closure and search, and against all scenarios there are."""

import itertools
import math

import numpy as np
import pytest

from ninefold.encodings import ALLEN, NP8, POINT, RCC5, RCC8
from ninefold.reasoner.networks.conflicts import Conflict, conflict
from ninefold.reasoner.networks.derivation import RecordedClosure
from ninefold.reasoner.networks.enumeration import count, scenarios, some_scenario
from ninefold.reasoner.networks.explanation import explain
from ninefold.reasoner.networks.inference import entails, infer, minimal
from ninefold.reasoner.networks.network import Network
from ninefold.reasoner.networks.questions import ask
from ninefold.reasoner.networks.refutation import refute
from ninefold.reasoner.networks.repairs import repair
from tests.oracle.network_reference import Reference, random_network

CALCULI = [RCC8, RCC5, POINT, ALLEN]
REFERENCES = {calculus.name: Reference(calculus) for calculus in CALCULI}
EVERY = pytest.mark.parametrize("calculus", CALCULI, ids=lambda calculus: calculus.name)


def random_networks(calculus, seed, count, sizes, density=(0.7, 1.0), label=0.4):
    """Yield (network, reference, constraints); labels of every second network of RCC-8 are outside H8."""
    rng = np.random.default_rng(seed)
    for at in range(count):
        n = int(rng.integers(*sizes))
        hard = calculus == RCC8 and at % 2
        degree = (n - 1) * float(rng.uniform(*density))
        size = max(1.3, calculus.n_bases * label * (1.2 if hard else 1))
        constraints = random_network(calculus, rng, n, degree, size, NP8.__contains__ if hard else lambda mask: True)
        yield Network.from_constraints(calculus, n, constraints), REFERENCES[calculus.name], constraints


def every_scenario(calculus, n, constraints):
    """All scenarios by trying every base relation on every pair: {(i, j): base name}."""
    reference = REFERENCES[calculus.name]
    pairs = list(itertools.combinations(range(n), 2))
    labels = reference.labels(n, constraints)
    found = []

    def extend(scenario, k):
        if k == len(pairs):
            found.append(dict(scenario))
            return
        i, j = pairs[k]
        for base in sorted(labels[i, j]):
            full = {**scenario, (i, j): base}
            # only triangles that are now complete and hold the new pair
            if all(fits(full, i, j, h) for h in range(n) if h not in (i, j) and known(full, i, h) and known(full, h, j)):
                extend(full, k + 1)

    def known(full, a, b):
        return (a, b) in full or (b, a) in full

    def at(full, a, b):
        return full[a, b] if (a, b) in full else reference.converse[full[b, a]]

    def fits(full, i, j, h):
        return full[i, j] in reference.composition[at(full, i, h), at(full, h, j)]

    extend({}, 0)
    return found


def named(scenario):
    return {
        (i, j): scenario.calculus.bases[int(scenario.bases[i, j])]
        for i, j in itertools.combinations(range(len(scenario.entities)), 2)
    }


@EVERY
def test_recorded_closure_is_closure_and_its_derivations_hold(calculus):
    for net, reference, constraints in random_networks(calculus, 1, 25, (3, 7)):
        n = net.n_entities
        closure = RecordedClosure(calculus, n)
        closed = all(closure.state(i, j, m, s) for s, (i, j, m) in enumerate(constraints)) and closure.close()
        expected = reference.closure(n, reference.labels(n, constraints))
        assert closed == (expected is not None)
        derivations = [closure.refutation()] if not closed else []
        if closed:
            for (i, j), names in expected.items():
                assert reference.names(closure.relation(i, j)) == names
                derivations.append(closure.derivation(i, j, closure.relation(i, j)))
                assert derivations[-1].conclusion.mask & ~closure.relation(i, j) == 0
        for derivation in derivations:
            replay(calculus, constraints, derivation)


def replay(calculus, constraints, derivation):
    """Every fact follows from earlier ones, with the reference's composition."""
    reference = REFERENCES[calculus.name]
    facts = derivation.facts

    def seen_from(k, i, j):
        if k < 0:
            return frozenset(calculus.bases)
        assert {facts[k].i, facts[k].j} == {i, j}
        names = reference.names(facts[k].mask)
        return names if facts[k].i == i else frozenset(reference.converse[name] for name in names)

    for at, fact in enumerate(facts):
        assert max(fact.left, fact.right, fact.kept) < at
        if fact.source >= 0:
            i, j, mask = constraints[fact.source]
            allowed = reference.names(mask if i == fact.i else calculus.converse_of(mask))
            assert {i, j} == {fact.i, fact.j}
        elif fact.via < 0:
            allowed = frozenset(calculus.bases)
        else:
            allowed = reference.compose(seen_from(fact.left, fact.i, fact.via), seen_from(fact.right, fact.via, fact.j))
        assert reference.names(fact.mask) == allowed & seen_from(fact.kept, fact.i, fact.j)


@EVERY
def test_undoing_restores_the_closure(calculus):
    for net, _, constraints in random_networks(calculus, 2, 10, (4, 6), density=(0.3, 0.6)):
        closure = RecordedClosure(calculus, net.n_entities)
        if not all(closure.state(*c, s) for s, c in enumerate(constraints)) or not closure.close():
            continue
        before, mark = closure.labels.copy(), closure.mark()
        for k in range(calculus.n_bases):
            if closure.state(0, 1, 1 << k, 99):
                closure.close()
            closure.undo(mark)
            assert (closure.labels == before).all()


@EVERY
def test_conflicts_are_inconsistent_and_every_statement_is_necessary(calculus):
    conflicts = by_cases = 0
    for net, reference, constraints in random_networks(calculus, 3, 60, (3, 8), label=0.36):
        n = net.n_entities
        found = conflict(net)
        if found is None:
            assert reference.solve(n, constraints) is not None
            continue
        conflicts += 1
        assert found.minimal
        assert reference.solve(n, [constraints[k] for k in found.indices]) is None
        for k in found.indices:
            assert reference.solve(n, [constraints[x] for x in found.indices if x != k]) is not None
        explanation = explain(found)
        assert explanation.complete
        by_cases += explanation.cases > 1
        assert all(s.a in str(explanation) and s.b in str(explanation) for s in found)
    assert conflicts >= 5


def test_conflicts_that_need_cases_are_found_and_proved():
    """Networks that closure leaves standing although they have no scenario."""
    rng = np.random.default_rng(5)
    reference, seen = REFERENCES["rcc8"], 0
    for _ in range(60):
        n = 8
        constraints = random_network(RCC8, rng, n, n - 1, 3.2, NP8.__contains__)
        net = Network.from_constraints(RCC8, n, constraints)
        if reference.closure(n, reference.labels(n, constraints)) is None or next(scenarios(net), None) is not None:
            continue
        seen += 1
        found = conflict(net)
        assert reference.solve(n, [constraints[k] for k in found.indices]) is None
        for k in found.indices:
            assert reference.solve(n, [constraints[x] for x in found.indices if x != k]) is not None
        explanation = explain(found)
        if reference.closure(n, reference.labels(n, [constraints[k] for k in found.indices])) is not None:
            assert explanation.cases > 1
            assert "case 1" in str(explanation)
            short = explain(found, most=1)
            assert not short.complete
            assert "not printed" in str(short)
        if seen == 3:
            break
    assert seen == 3


def test_refutations_cover_every_case():
    rng = np.random.default_rng(12)
    reference, deep = REFERENCES["rcc8"], 0
    for _ in range(80):
        n = int(rng.integers(7, 10))
        constraints = random_network(RCC8, rng, n, n - 1, 3.2, NP8.__contains__)
        found = refute(RCC8, n, constraints)
        assert found is not None or reference.solve(n, constraints) is not None
        if found is not None:
            deep += found.depth > 0
            confirm(n, list(constraints), found, len(constraints))
    assert deep >= 3


def confirm(n, constraints, found, first):
    if found.derivation is not None:
        assert found.derivation.conclusion.mask == 0
        replay(RCC8, constraints, found.derivation)
        return
    label = 0
    for part, case in found.cases:
        label |= part
        confirm(n, [*constraints, (*found.pair, part)], case, first)
    assert label == found.label
    replay(RCC8, constraints, found.ground)
    i, _ = found.pair
    ground = found.ground.conclusion
    mask = ground.mask if ground.i == i else RCC8.converse_of(ground.mask)
    assert mask & ~label == 0


@EVERY
def test_scenarios_are_all_there_are_each_once(calculus):
    for net, reference, constraints in random_networks(calculus, 4, 14, (3, 5), label=0.3):
        n = net.n_entities
        expected = every_scenario(calculus, n, constraints)
        if len(expected) > 400:
            continue
        found = list(scenarios(net))
        assert all(s.is_closed() and s.satisfies(net) for s in found)
        assert all(reference.is_scenario(n, constraints, named(s)) for s in found)
        key = [tuple(sorted(s.items())) for s in map(named, found)]
        assert sorted(key) == sorted(tuple(sorted(s.items())) for s in expected)
        assert (count(net).count, count(net).exact) == (len(expected), True)
        if len(expected) > 1:
            limited = count(net, limit=len(expected) - 1)
            assert (limited.count, limited.exact) == (len(expected) - 1, False)


@EVERY
def test_some_scenario_is_one_where_there_is_one(calculus):
    for net, reference, constraints in random_networks(calculus, 15, 40, (2, 8), density=(0.3, 1.0)):
        found = some_scenario(net)
        if found is None:
            assert reference.solve(net.n_entities, constraints) is None
        else:
            assert reference.is_scenario(net.n_entities, constraints, named(found))


@EVERY
def test_infer_minimal_and_entails_agree_with_all_scenarios(calculus):
    some = 0
    for net, reference, constraints in random_networks(calculus, 5, 14, (3, 5), label=0.3):
        n = net.n_entities
        expected = every_scenario(calculus, n, constraints)
        smallest = minimal(net)
        assert smallest.exact
        assert smallest.consistent == bool(expected)
        for i, j in itertools.permutations(range(n), 2):
            feasible = {s[i, j] if i < j else reference.converse[s[j, i]] for s in expected}
            assert reference.names(int(smallest.labels[i, j])) == feasible
            if (i, j) not in ((0, 1), (n - 1, 0)):
                continue
            answer = infer(net, i, j)
            assert set(answer.relations) == feasible
            for base in calculus.bases:
                reason = answer.reason(base)
                if base in feasible:
                    assert reason.relation(i, j) == base
                    assert reason.is_closed()
                    assert reason.satisfies(net)
                else:
                    assert isinstance(reason, Conflict)
                    assert all(s.label in (None, "supposed") for s in reason)
                some += 1
            for mask in (1, calculus.universal - 1, calculus.universal):
                assert entails(net, i, mask, j) == (feasible <= reference.names(mask))
    assert some > 50


def brute_repair(n, constraints, costs, reference):
    best = math.inf
    for size in range(len(constraints) + 1):
        for drop in itertools.combinations(range(len(constraints)), size):
            cost = sum(costs[k] for k in drop)
            if cost < best and reference.solve(n, [c for k, c in enumerate(constraints) if k not in drop]):
                best = cost
    return best


@EVERY
def test_repairs_cost_as_little_as_any(calculus):
    rng = np.random.default_rng(6)
    broken = hopeless = 0
    for net, reference, constraints in random_networks(calculus, 7, 25, (4, 6), label=0.25):
        if len(constraints) > 10:
            continue
        weights = [None if w < 0.3 else math.inf if w > 0.85 else round(10 * w) / 4 for w in rng.random(len(constraints))]
        weights[0] = 0.0
        weighted = Network(calculus)
        for s, weight in zip(net.statements, weights, strict=True):
            weighted.add(s.a, s.b, s.mask, weight=weight)
        found = repair(weighted)
        costs = [1.0 if w is None else w for w in weights]
        best = brute_repair(net.n_entities, constraints, costs, reference)
        assert found.cost == best
        assert found.optimal
        assert found.possible == (best < math.inf)
        if found.possible:
            broken += bool(found.drop)
            gone = {s.index for s in found.drop}
            rest = [c for k, c in enumerate(constraints) if k not in gone]
            assert reference.solve(net.n_entities, rest) is not None
            assert found.repaired().n_statements == len(rest)
            assert sum(s.cost for s in found.drop) == best
        else:
            hopeless += 1
            assert all(s.hard for s in found.conflict)
    assert broken >= 2


def random_formula(rng, calculus, n, depth):
    """A formula as text, and as a function of a scenario."""
    if depth == 0 or rng.random() < 0.2:
        i, j = (int(x) for x in rng.choice(n, size=2, replace=False))
        bases = [b for b in calculus.bases if rng.random() < 0.4] or [calculus.bases[0]]
        return f"{'|'.join(repr(b) for b in bases)}({i}, {j})", lambda s: s(i, j) in bases
    kind = int(rng.integers(5))
    left, holds_left = random_formula(rng, calculus, n, depth - 1)
    if kind == 0:
        return f"~({left})", lambda s: not holds_left(s)
    right, holds_right = random_formula(rng, calculus, n, depth - 1)
    text = f"({left}) {['', '&', '|', '->', '<->'][kind]} ({right})"
    meaning = [
        None,
        lambda s: holds_left(s) and holds_right(s),
        lambda s: holds_left(s) or holds_right(s),
        lambda s: not holds_left(s) or holds_right(s),
        lambda s: holds_left(s) == holds_right(s),
    ][kind]
    return text, meaning


@EVERY
def test_ask_agrees_with_all_scenarios(calculus):
    rng = np.random.default_rng(8)
    seen = set()
    for net, reference, constraints in random_networks(calculus, 9, 16, (3, 5), label=0.25):
        n = net.n_entities
        expected = every_scenario(calculus, n, constraints)
        if len(expected) > 2000:
            continue
        for _ in range(6):
            text, meaning = random_formula(rng, calculus, n, 3)

            def truth(scenario, meaning=meaning, reference=reference):
                return meaning(lambda i, j: scenario[i, j] if i < j else reference.converse[scenario[j, i]])

            values = {truth(s) for s in expected}
            answer = ask(net, text)
            wanted = {frozenset(): "impossible", frozenset({True}): "entailed", frozenset({False}): "impossible"}
            assert answer.answer == wanted.get(frozenset(values), "possible")
            seen.add(answer.answer)
            for scenario, value in ((answer.satisfied, True), (answer.falsified, False)):
                assert (scenario is not None) == (value in values)
                if scenario is not None:
                    assert scenario.satisfies(net)
                    assert truth(named(scenario)) is value
            if answer.answer != "possible":
                kept = [constraints[s.index] for s in answer.statements]
                check_forced(calculus, n, kept, truth, forced=answer.answer == "entailed")
                for k in range(len(kept)):
                    rest = kept[:k] + kept[k + 1 :]
                    if len(rest) >= n - 1:
                        values = {truth(s) for s in every_scenario(calculus, n, rest)}
                        assert (answer.answer != "entailed") in values
    assert seen == {"entailed", "possible", "impossible"}


def check_forced(calculus, n, kept, truth, *, forced):
    if len(kept) >= n - 1 or calculus.n_bases <= 5:
        assert {truth(s) for s in every_scenario(calculus, n, kept)} <= {forced}


def test_conflicts_of_networks_too_large_for_all_pairs():
    rng = np.random.default_rng(14)
    net = Network("rcc8")
    for a in range(1, 600):
        for b in rng.integers(max(0, a - 20), a, 2).tolist():
            net.add(b, a, "DC EC PO TPP NTPP")
    for k in range(8):
        net.add(5 + 30 * k, 35 + 30 * k, "TPP NTPP", f"link {k}")
    net.add(5, 245, "DC EC", "the false one")
    found = conflict(net)
    assert {s.label for s in found} == {*(f"link {k}" for k in range(8)), "the false one"}
    assert "the false one" in str(explain(found))
