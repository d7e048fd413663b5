"""What answers say where the network is not decided: for want of time, or because nobody knows how."""

import dataclasses
import json
import pickle

import numpy as np
import pytest
import typer

from ninefold.cli import networks
from ninefold.encodings import POINT
from ninefold.errors import BadInput, Undecided, UnknownName
from ninefold.reasoner.networks import inference
from ninefold.reasoner.networks.consistency import Consistent, Inconsistent, Unknown, check
from ninefold.reasoner.networks.enumeration import Count, count, scenarios, some_scenario
from ninefold.reasoner.networks.inference import entails, infer, minimal
from ninefold.reasoner.networks.network import Network
from ninefold.reasoner.networks.questions import ask
from ninefold.reasoner.networks.repairs import repair

SPEC = """
identity =
< :: >
= :: =
> :: <
< : < :: ( < )
< : = :: ( < )
< : > :: ( < = > )
= : < :: ( < )
= : = :: ( = )
= : > :: ( > )
> : < :: ( < = > )
> : = :: ( > )
> : > :: ( > )
"""


@pytest.fixture
def own():
    """A network of the point algebra under a name that nobody has written a paper about."""
    net = Network(dataclasses.replace(POINT, name="own"))
    net.add("a", "b", "<")
    net.add("b", "c", "< =")
    return net


@pytest.fixture
def house():
    net = Network("rcc8")
    net.add("kitchen", "house", "inside")
    net.add("house", "garden", "EC DC")
    return net


@pytest.fixture
def run(capsys):
    app = typer.Typer()
    for name in ("check", "infer", "ask", "repair", "scenarios"):
        app.command(name)(getattr(networks, name))

    def runner(*arguments):
        code = app(args=[str(argument) for argument in arguments], standalone_mode=False)
        out = capsys.readouterr().out
        return code, json.loads(out) if "--json" in arguments else out

    return runner


def late(monkeypatch):
    """Let the engine come to no answer in time."""
    monkeypatch.setattr("ninefold.reasoner.engine.engine.Engine.close", lambda *args: None)


class TestTime:
    def test_check_says_so(self, house, monkeypatch):
        late(monkeypatch)
        verdict = check(house, budget=3)
        assert isinstance(verdict, Unknown)
        assert (verdict.kind, verdict.reason) == ("time", "3 s were not enough")

    def test_nothing_is_refuted_because_nothing_was_decided(self, house, monkeypatch):
        late(monkeypatch)
        found = infer(house, "kitchen", "garden", budget=0.001)
        assert (found.mask, found.unknown, found.kind) == (0, 255, "time")
        assert found.consistent is None
        assert str(found) == "kitchen perhaps DC | EC | PO | TPP | NTPP | TPPi | NTPPi | EQ garden"
        with pytest.raises(BadInput, match="a larger one"):
            found.reason("DC")

    def test_infer_on_the_command_line(self, run, tmp_path, monkeypatch):
        late(monkeypatch)
        (tmp_path / "net.csv").write_text("a,relations,b\nkitchen,inside,house\nhouse,EC DC,garden\n")
        code, text = run("infer", tmp_path / "net.csv", "kitchen", "garden", "--budget", "0.001")
        assert code == 3
        assert "inconsistent" not in text
        assert "not decided between kitchen and garden: DC EC PO" in text
        assert "0.001 s were not enough" in text
        code, found = run("infer", tmp_path / "net.csv", "kitchen", "garden", "--budget", "0.001", "--json")
        assert (code, found["relations"], len(found["unknown"]), found["kind"]) == (3, [], 8, "time")

    def test_an_inconsistent_network_is_still_called_that(self, run, tmp_path):
        (tmp_path / "net.csv").write_text("a,relations,b\na,NTPP,b\nb,DC,c\na,EC,c\n")
        code, text = run("infer", tmp_path / "net.csv", "a", "c")
        assert (code, "nothing is possible: the network is inconsistent" in text) == (1, True)

    def test_minimal_keeps_to_its_budget_from_the_first_step(self, house, monkeypatch):
        asked = []

        def slow(net, budget=None, **options):
            asked.append(budget)
            return check(net, budget=budget, **options)

        monkeypatch.setattr(inference, "check", slow)
        assert minimal(house, budget=100).exact
        assert asked[0] == 100
        assert all(0 < later < 100 for later in asked[1:])
        late(monkeypatch)
        found = minimal(house, budget=0.001)
        assert not found.exact
        assert found.relations("kitchen", "house") == ("NTPP",)  # as stated

    def test_compiling_is_told_apart(self, house, run, tmp_path):
        assert check(house).decision.compiling >= 0
        (tmp_path / "net.csv").write_text("a,relations,b\nkitchen,inside,house\n")
        _, found = run("check", tmp_path / "net.csv", "--json")
        assert 0 <= found["compiling"] <= found["seconds"]

    def test_a_budget_does_not_pay_for_compiling(self, house, monkeypatch):
        """What the engine reports as compiling puts the deadline of later steps off."""
        clock = inference._Clock(10)
        before = clock.deadline
        clock.put_off(5)
        assert clock.deadline == before + 5
        assert inference._Clock(None).left() is None


class TestTheory:
    def test_check(self, own):
        verdict = check(own)
        assert isinstance(verdict, Unknown)
        assert verdict.kind == "theory"
        assert check(own, method="support").kind == "theory"
        own.add("c", "a", "<")
        assert isinstance(check(own), Inconsistent)

    def test_scenarios_are_not_listed_as_if_they_were_sure(self, own):
        for ask_for_one in (lambda: next(scenarios(own)), lambda: some_scenario(own)):
            with pytest.raises(Undecided, match="nobody has shown that closure decides 'own'") as caught:
                ask_for_one()
            assert caught.value.kind == "theory"
        assert count(own) == Count(0, exact=False)
        own.add("c", "a", "<")
        assert list(scenarios(own)) == []
        assert some_scenario(own) is None
        assert count(own) == Count(0, exact=True)

    def test_entails(self, own):
        assert entails(own, "a", "<", "c") is True  # closure refutes all else
        assert entails(own, "a", ">", "c") is None  # perhaps there is no scenario at all
        assert entails(own, "b", "<", "c") is None

    def test_infer(self, own):
        found = infer(own, "b", "c")
        assert (found.relations, found.undecided, found.kind) == ((), ("<", "="), "theory")
        assert found.consistent is None
        with pytest.raises(Undecided):
            found.reason("<")
        assert len(found.reason(">")) == 2

    def test_minimal_and_repair(self, own):
        found = minimal(own)
        assert not found.exact
        assert found.relations("a", "c") == ("<",)
        with pytest.raises(Undecided):
            repair(own)

    def test_no_statement_of_an_answer_is_left_out_because_the_rest_is_undecided(self, own):
        answer = ask(own, '">"(a, c)')
        assert answer.answer == "impossible"
        assert [s.index for s in answer.statements] == [0, 1]
        assert ask(own, '"<"(b, c)').answer == "unknown"

    def test_the_command_line(self, run, tmp_path):
        (tmp_path / "own.spec").write_text(SPEC)
        (tmp_path / "net.csv").write_text("a,relations,b\na,<,b\nb,< =,c\n")
        for command in (("scenarios",), ("repair",), ("check",)):
            code, text = run(command[0], tmp_path / "net.csv", "--calculus", tmp_path / "own.spec")
            assert code == 3
            assert "nobody has shown that closure decides" in text
            assert "None s" not in text
        code, found = run("scenarios", tmp_path / "net.csv", "--calculus", tmp_path / "own.spec", "--json")
        assert (code, found["count"], found["exact"], found["scenarios"]) == (3, 0, False, [])
        code, text = run("infer", tmp_path / "net.csv", "b", "c", "--calculus", tmp_path / "own.spec")
        assert (code, "None s" in text, "inconsistent" in text) == (3, False, False)
        code, found = run("check", tmp_path / "net.csv", "--calculus", tmp_path / "own.spec", "--json")
        assert (code, found["verdict"], found["kind"]) == (3, "unknown", "theory")
        (tmp_path / "net.csv").write_text("a,relations,b\na,<,b\nb,<,c\nc,<,a\n")
        code, text = run("check", tmp_path / "net.csv", "--calculus", tmp_path / "own.spec")
        assert code == 1
        assert "perhaps not minimal since nobody has shown that closure decides" in text


class TestMinimalNetworks:
    def test_an_unknown_entity(self, house):
        found = minimal(house)
        for pair in (("kitchen", "zz"), ("zz", "kitchen")):
            with pytest.raises(UnknownName, match="no entity named 'zz'"):
                found.relations(*pair)
        with pytest.raises(UnknownName, match="did you mean 'garden'"):
            found.relations("kitchen", "gardn")

    @pytest.mark.parametrize("consistent", [True, False])
    def test_labels_are_read_only(self, house, consistent):
        if not consistent:
            house.add("house", "garden", "NTPP")
        found = minimal(house)
        assert found.consistent == consistent
        for labels in (found.labels, pickle.loads(pickle.dumps(found)).labels):
            with pytest.raises(ValueError, match="read-only"):
                labels[0, 1] = 1

    def test_small_networks(self):
        net = Network("rcc8")
        assert minimal(net).labels.shape == (0, 0)
        net.add_entity("a")
        assert minimal(net).labels.tolist() == [[128]]
        net.add_entity("b")
        assert minimal(net).labels.tolist() == [[128, 255], [255, 128]]


def test_answers_are_shown_by_relations_and_in_short(house):
    assert repr(infer(house, "kitchen", "garden")) == "Inference(kitchen DC garden)"
    assert repr(ask(house, "inside(kitchen, house)")) == "Answer(entailed: inside(kitchen, house))"
    assert repr(minimal(house)) == "MinimalNetwork(rcc8, 3 entities: kitchen NTPP house, kitchen DC garden, ...)"
    assert (
        repr(check(house).scenario) == "Scenario(rcc8, 3 entities: kitchen NTPP house, kitchen DC garden, house DC garden)"
    )
    wide = Network("rcc8")
    for k in range(300):
        wide.add(k, k + 1, "DC | EC | NTPP")
    verdict = check(wide)
    assert isinstance(verdict, Consistent)
    assert max(len(repr(x)) for x in (verdict, verdict.scenario, infer(wide, 0, 300))) < 200
    long = " & ".join(f"EC({k}, {k + 1})" for k in range(20))
    assert len(repr(ask(wide, long))) < 120


def test_reading_labels_of_an_engine():
    net = Network("rcc8")
    net.add("a", "b", "NTPP")
    net.add("c", "b", "DC EC")
    engine = inference._closure(net)
    assert engine.close()
    labels = engine.labels()
    assert (labels.diagonal() == net.calculus.identity).all()
    assert labels[0, 2] == net.calculus.relation("DC")
    assert (labels == np.array([[net.calculus.converse_of(int(m)) for m in row] for row in labels]).T).all()
