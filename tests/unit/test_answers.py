"""Answers about networks: values, errors, words, budgets, weights."""

import math

import numpy as np
import pytest

from ninefold.encodings import ALLEN, RCC5, RCC8
from ninefold.errors import BadInput, UnknownName
from ninefold.reasoner.networks.conflicts import conflict
from ninefold.reasoner.networks.derivation import RecordedClosure
from ninefold.reasoner.networks.enumeration import count, scenarios
from ninefold.reasoner.networks.explanation import explain
from ninefold.reasoner.networks.formula import parse
from ninefold.reasoner.networks.inference import SUPPOSED, entails, infer, minimal
from ninefold.reasoner.networks.network import Network
from ninefold.reasoner.networks.questions import ask
from ninefold.reasoner.networks.repairs import repair
from ninefold.reasoner.networks.scenario import Scenario
from ninefold.reasoner.networks.words import phrase


def network(*statements, calculus="rcc8"):
    net = Network(calculus)
    for statement in statements:
        net.add(*statement)
    return net


@pytest.fixture
def house():
    return network(("kitchen", "house", "inside", "plan"), ("house", "garden", "meet"))


@pytest.fixture
def broken():
    return network(
        ("kitchen", "house", "inside", "plan", math.inf),
        ("house", "garden", "disjoint", "deed", 2),
        ("kitchen", "garden", "meet", "hearsay"),
        ("shed", "garden", "inside"),
    )


class TestConflict:
    def test_statements_in_order(self, broken):
        found = conflict(broken)
        assert found.indices == (0, 1, 2)
        assert len(found) == 3
        assert found.triples()[0] == ("kitchen", "house", ("NTPP",))
        assert str(found).splitlines()[1] == "deed: house DC garden"
        assert conflict(found.to_network()).indices == (0, 1, 2)

    def test_none_where_consistent(self, house):
        assert conflict(house) is None
        assert conflict(Network("rcc8")) is None

    def test_two_statements_about_one_pair(self):
        net = network(("a", "b", "EC", "one"), ("c", "b", "DC"), ("b", "a", "NTPP PO", "two"))
        found = conflict(net)
        assert found.indices == (0, 2)
        assert str(explain(found)) == "b meets a (one); but b overlaps or inside a (two)"

    def test_statements_of_an_entity_about_itself_say_nothing(self):
        net = network(("a", "a", "EQ DC"), ("a", "b", "EC"), ("a", "b", "DC"))
        assert conflict(net).indices == (1, 2)
        assert repair(net).cost == 1
        assert count(network(("a", "a", "EQ DC"))).count == 1

    def test_soft_statements_are_left_out_first(self):
        """Of two conflicts with the same hard statements the one that blames fewer soft ones is found."""
        net = network(
            ("a", "b", "inside", "soft one"),
            ("b", "c", "inside", "soft two"),
            ("c", "a", "inside", "soft three"),
            ("a", "b", "disjoint", "hard", math.inf),
        )
        assert [str(s) for s in conflict(net)] == ["soft one", "hard"]

    def test_a_spent_budget_leaves_a_conflict_that_may_not_be_minimal(self):
        net = network(*((f"r{k}", f"r{k + 1}", "inside") for k in range(12)), ("r12", "r0", "inside"))
        found = conflict(net, budget=1e-9)
        assert not found.minimal
        assert conflict(found.to_network()) is not None
        assert conflict(net).minimal

    def test_the_network_is_left_as_it_was(self, broken):
        before = broken.copy()
        conflict(broken)
        repair(broken)
        minimal(broken)
        ask(broken, "inside(shed, house)")
        infer(broken, "shed", "house").reason("EC")
        assert broken == before


class TestReprs:
    def test_of_a_conflict(self, broken):
        found = conflict(broken)
        assert repr(found).startswith(f"Conflict({len(found)} statements, minimal: kitchen inside house")
        assert "mask" not in repr(found)

    def test_no_more_than_fits(self):
        net = Network("rcc8")
        for k in range(6):
            net.add(k, (k + 1) % 6, "inside")
        assert repr(conflict(net)) == "Conflict(6 statements, minimal: 0 inside 1; 1 inside 2; 2 inside 3; 3 more)"
        assert len(repr(explain(net))) < 200
        assert repr(explain(net)).startswith("Explanation(1 case, 4 lines: ")

    def test_of_an_explanation_that_is_not_printed(self, broken):
        found = explain(conflict(broken), most=0)
        assert repr(found).startswith("Explanation(too long to print, 5 lines: These 3 statements contradict each other")

    def test_of_repairs(self, house, broken):
        assert repr(repair(house)) == "Repair(nothing to drop: the network is consistent)"
        found = repair(broken)
        text = repr(found)
        assert text.startswith(f"Repair(drop 1 of {broken.n_statements} statements, cost {found.cost:g}: ")
        assert str(found.drop[0].a) in text
        one = Network("rcc8")
        one.add("a", "b", "meet", weight=math.inf)
        one.add("a", "b", "disjoint", weight=math.inf)
        assert repr(repair(one)).startswith("Repair(none: hard statements contradict each other: a meets b")


class TestExplain:
    def test_the_sentence(self, broken):
        text = "kitchen inside house (plan), house disjoint garden (deed), so kitchen disjoint garden; "
        assert str(explain(broken)) == text + "but kitchen meets garden (hearsay)"

    def test_longer_derivations_take_a_line_a_step(self):
        net = network(("a", "b", "inside"), ("b", "c", "inside"), ("c", "d", "inside"), ("d", "a", "meet"))
        lines = explain(net).lines
        assert len(lines) == 2
        assert lines[-1].count("; but ") == 1

    def test_a_consistent_network_has_nothing_to_explain(self, house):
        with pytest.raises(BadInput, match="consistent"):
            explain(house)

    def test_words(self):
        said = {name: phrase(RCC8, "a", RCC8.relation(name), "b") for name in RCC8.bases}
        assert said["TPP"] == "a covered by b"
        assert len(set(said.values())) == 8
        assert phrase(RCC8, "a", RCC8.universal & ~RCC8.relation("DC EC"), "b") == "a none of disjoint, meets b"
        assert phrase(RCC8, "a", 0, "b") == "a has no relation to b"
        assert phrase(RCC8, "a", RCC8.universal, "b") == "a anyhow related to b"
        assert phrase(ALLEN, "a", ALLEN.relation("<"), "b") == "a < b"
        assert phrase(RCC5, "a", RCC5.relation("PP DR"), "b") == "a apart from or part of b"


class TestInfer:
    def test_reasons(self, house):
        found = infer(house, "garden", "kitchen")
        assert (found.relations, found.consistent, found.unknown) == (("DC",), True, 0)
        why = found.reason("overlap")
        assert [str(s) for s in why] == ["plan", "statement 2", SUPPOSED]
        assert found.reason("disjoint").satisfies(house)
        with pytest.raises(BadInput, match="one base relation"):
            found.reason("EC DC")
        with pytest.raises(UnknownName):
            found.reason("insidex")

    def test_later_statements_do_not_change_reasons(self, house):
        found = infer(house, "kitchen", "garden")
        house.add("kitchen", "garden", "EC")
        assert found.reason("DC").relation("kitchen", "garden") == "DC"

    def test_an_entity_and_itself(self, house):
        assert infer(house, "house", "house").relations == ("EQ",)
        assert entails(house, "house", "EQ", "house")
        assert not entails(house, "house", "DC", "house")

    def test_entities_nobody_relates(self, house):
        house.add_entity("moon")
        assert len(infer(house, "moon", "house").relations) == 8
        assert not entails(house, "moon", "DC EC", "house")

    def test_minimal(self, house):
        found = minimal(house)
        assert found.relations("kitchen", "garden") == ("DC",)
        assert found.relations("garden", "house") == ("EC",)
        assert found.to_network().n_statements == 3
        with pytest.raises(ValueError, match="read-only"):
            found.labels[0, 0] = 0

    def test_minimal_of_a_contradiction(self, broken):
        found = minimal(broken)
        assert not found.consistent
        assert not found.labels.any()
        with pytest.raises(BadInput, match="inconsistent"):
            found.to_network()

    def test_unknown_entities_and_relations(self, house):
        with pytest.raises(UnknownName):
            infer(house, "kitchen", "gardn")
        with pytest.raises(UnknownName):
            entails(house, "kitchen", "insidex", "garden")
        with pytest.raises(BadInput):
            entails(house, "kitchen", "", "garden")


class TestAsk:
    def test_evidence(self, house):
        answer = ask(house, "meet(kitchen, garden) | inside(kitchen, house)")
        assert answer.answer == "entailed"
        assert answer.satisfied.satisfies(house)
        assert answer.falsified is None
        assert [str(s) for s in answer.statements] == ["plan"]

    def test_constants(self, house, broken):
        assert ask(house, "true").answer == "entailed"
        assert ask(house, "false").answer == "impossible"
        assert ask(house, "false").statements == ()
        assert ask(broken, "true").answer == "impossible"
        assert len(ask(broken, "true").statements) == 3

    def test_parsed_formulas(self, house):
        formula = parse("disjoint(kitchen, garden)", house)
        assert ask(house, formula).answer == "entailed"

    def test_many_atoms(self):
        net = network(*((f"r{k}", f"r{k + 1}", "inside") for k in range(10)))
        text = " & ".join(f"inside(r{i}, r{j})" for i in range(11) for j in range(i + 1, 11))
        assert ask(net, text).answer == "entailed"
        assert ask(net, f"~({text}) | meet(r0, r5)").answer == "impossible"


class TestRepair:
    def test_nothing_to_do(self, house):
        found = repair(house)
        assert (found.drop, found.cost, found.possible, found.optimal) == ((), 0.0, True, True)
        assert found.repaired() == house

    def test_weights_decide(self, broken):
        assert [str(s) for s in repair(broken).drop] == ["hearsay"]
        heavier = network(*((s.a, s.b, s.mask, s.label, 5 if s.label == "hearsay" else s.weight) for s in broken.statements))
        assert [str(s) for s in repair(heavier).drop] == ["deed"]
        assert repair(heavier).cost == 2

    def test_extreme_weights_are_exact(self):
        net = network(("a", "b", "EC", "x", 1e300), ("a", "b", "DC", "y", 1e-300), ("a", "b", "PO", "z", 0.1))
        found = repair(net)
        assert [str(s) for s in found.drop] == ["y", "z"]

    def test_free_statements_stay_where_they_can(self):
        net = network(("a", "b", "EC", None, 0), ("b", "c", "EC", None, 0), ("a", "b", "DC"))
        assert [s.index for s in repair(net).drop] == [0]

    def test_hard_statements_that_contradict_each_other(self):
        net = network(("a", "b", "EC", "x", math.inf), ("a", "b", "DC", "y", math.inf), ("a", "b", "PO"))
        found = repair(net)
        assert (found.cost, found.possible) == (math.inf, False)
        assert [str(s) for s in found.conflict] == ["x", "y"]
        with pytest.raises(BadInput, match="no repair"):
            found.repaired()

    def test_conflicts_that_overlap(self):
        """One statement in every conflict is cheaper than one for each."""
        net = network(("hub", "x", "inside", "hub", 3), *((f"s{k}", "x", "disjoint") for k in range(4)))
        for k in range(4):
            net.add(f"s{k}", "hub", "meet")
        assert (str(repair(net).drop[0]), repair(net).cost) == ("hub", 3)


class TestScenario:
    def test_values(self, house):
        one, other = next(scenarios(house)), next(scenarios(house))
        assert one == other
        assert hash(one) == hash(other)
        assert one.relation("house", "kitchen") == "NTPPi"
        assert one.mask("kitchen", "house") == RCC8.relation("NTPP")
        assert len(one.triples()) == 3
        assert one.is_closed()
        with pytest.raises(UnknownName):
            one.relation("kitchen", "moon")
        with pytest.raises(ValueError, match="read-only"):
            one.bases[0, 1] = 0

    def test_bad_arrays(self):
        with pytest.raises(BadInput, match="array"):
            Scenario(RCC8, ("a", "b"), np.zeros((3, 3), dtype=np.uint8))
        with pytest.raises(BadInput, match="base relation 9"):
            Scenario(RCC8, ("a",), np.array([[9]], dtype=np.uint8))
        with pytest.raises(BadInput, match="no single base"):
            Scenario.from_labels(RCC8, ("a", "b"), np.full((2, 2), 3))

    def test_what_is_not_closed(self):
        bases = np.full((3, 3), RCC8.bases.index("EQ"), dtype=np.uint8)
        assert Scenario(RCC8, ("a", "b", "c"), bases).is_closed()
        bases[0, 1] = bases[1, 0] = RCC8.bases.index("DC")
        assert not Scenario(RCC8, ("a", "b", "c"), bases).is_closed()
        bases[0, 1] = RCC8.bases.index("NTPP")
        assert not Scenario(RCC8, ("a", "b", "c"), bases).is_closed()

    def test_counting(self, house):
        assert (count(house).count, count(house).exact) == (1, True)
        free = Network("rcc8")
        free.add_entity("a")
        free.add_entity("b")
        assert count(free).count == 8
        assert (count(free, 3).count, count(free, 3).exact) == (3, False)
        assert (count(free, 0).count, count(free, 0).exact) == (0, False)
        with pytest.raises(BadInput, match="limit"):
            count(free, -1)
        assert count(Network("rcc8")).count == 1

    def test_lazy(self):
        net = Network("rcc8")
        for k in range(30):
            net.add_entity(k)
        first = next(scenarios(net))
        assert {first.relation(0, k) for k in range(1, 30)} == {"DC"}


class TestClosure:
    def test_derivations_of_what_was_always_known(self):
        closure = RecordedClosure(RCC8, 3)
        assert closure.close()
        assert closure.derivation(0, 1, RCC8.universal).sources == frozenset()
        with pytest.raises(BadInput, match="does not show"):
            closure.derivation(0, 1, RCC8.relation("DC"))
        with pytest.raises(BadInput, match="nothing to refute"):
            closure.refutation()

    def test_compiled_and_plain_agree(self):
        rng = np.random.default_rng(0)
        n = 70  # large enough to be compiled
        stated = [(i, i + 1, RCC8.relation("inside coveredBy")) for i in range(n - 1)]
        for _ in range(60):
            i, j = sorted(rng.choice(n, 2, replace=False).tolist())
            stated.append((i, j, RCC8.relation("inside coveredBy overlap disjoint")))
        closure = RecordedClosure(RCC8, n)
        for source, (i, j, mask) in enumerate(stated):
            closure.state(i, j, mask, source)
        assert closure.close()
        parts = RCC8.relation("inside coveredBy")
        for i in range(n):
            for j in range(i + 1, n):
                assert closure.relation(i, j) & ~parts == 0
                assert closure.relation(j, i) == RCC8.converse_of(closure.relation(i, j))
        assert closure.derivation(0, n - 1, parts).sources == set(range(n - 1))
