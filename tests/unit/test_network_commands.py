"""Commands on networks: exit codes, JSON keys, one clear error for bad input."""

import csv
import json
import xml.etree.ElementTree as ElementTree

import pytest
import typer

from ninefold.cli import networks
from ninefold.errors import BadInput, NinefoldError, UnknownName

COMMANDS = ("check", "prove", "infer", "ask", "repair", "scenarios", "compose")


def typer_app():
    app = typer.Typer()
    for name in COMMANDS:
        app.command(name)(getattr(networks, name))
    return app


@pytest.fixture
def run(capsys):
    """Run a command; return exit code and stdout, read as JSON if it is."""
    app = typer_app()

    def runner(*arguments):
        code = app(args=[str(argument) for argument in arguments], standalone_mode=False)
        out = capsys.readouterr().out
        return code, json.loads(out) if "--json" in arguments else out

    return runner


def network(path, *rows):
    with path.open("w", newline="") as file:
        csv.writer(file).writerows([("a", "relations", "b", "weight", "label"), *rows])
    return path


@pytest.fixture
def house(tmp_path):
    return network(tmp_path / "house.csv", ("kitchen", "inside", "house", "", "plan"), ("house", "EC|DC", "garden", "", ""))


@pytest.fixture
def broken(tmp_path):
    return network(
        tmp_path / "broken.csv",
        ("kitchen", "inside", "house", "inf", "plan"),
        ("house", "disjoint", "garden", "2", "deed"),
        ("kitchen", "meet", "garden", "", "hearsay"),
        ("shed", "inside", "garden", "", ""),
    )


def test_check_consistent(run, house):
    code, found = run("check", house, "--json")
    assert code == 0
    assert (found["verdict"], found["conflict"]) == ("consistent", None)
    assert found["seconds"] >= 0
    scenario = {(a, b): r for a, b, r in found["scenario"]}
    assert scenario["kitchen", "house"] == "NTPP"
    assert scenario["house", "garden"] in ("EC", "DC")
    assert len(scenario) == 3
    code, text = run("check", house)
    assert (code, text.split()[0]) == (0, "consistent")


def test_check_inconsistent(run, broken):
    code, found = run("check", broken, "--json")
    assert code == 1
    assert (found["verdict"], found["scenario"]) == ("inconsistent", None)
    assert found["conflict"] == [
        ["kitchen", "house", ["NTPP"]],
        ["house", "garden", ["DC"]],
        ["kitchen", "garden", ["EC"]],
    ]
    code, text = run("check", broken)
    assert code == 1
    assert "so kitchen disjoint garden; but kitchen meets garden (hearsay)" in text
    assert "shed" not in text
    code, found = run("check", broken, "--no-conflict", "--json")
    assert (code, found["conflict"]) == (1, None)


def test_counts_agree_with_their_nouns(run, tmp_path):
    one = network(tmp_path / "one.csv", ("a", "meet", "b", "", ""))
    assert "(2 entities, 1 statement, " in run("check", one)[1]
    none = network(tmp_path / "none.csv", ("a", "equal", "a", "", ""))
    assert "(1 entity, 1 statement, " in run("check", none)[1]
    two = network(tmp_path / "two.csv", ("a", "meet", "b", "", ""), ("a", "inside", "b", "2", ""))
    assert "minimal conflict of 2 statements:" in run("check", two)[1]
    assert run("repair", two)[1].startswith("drop 1 of 2 statements, cost 1\n")


def test_check_draws(run, house, broken, tmp_path):
    picture = tmp_path / "house.svg"
    code, found = run("check", house, "--draw", picture, "--json")
    assert (code, found["drawing"]) == (0, str(picture))
    texts = [e.text for e in ElementTree.parse(picture).iter("{http://www.w3.org/2000/svg}text")]
    assert {"kitchen", "house", "garden"} <= set(texts)
    with pytest.raises(BadInput, match="exists"):
        run("check", house, "--draw", picture)
    assert run("check", house, "--draw", picture, "--force")[0] == 0
    with pytest.raises(BadInput, match="SVG"):
        run("check", house, "--draw", tmp_path / "house.png")
    other = tmp_path / "other.svg"
    assert run("check", broken, "--draw", other)[0] == 1
    assert not other.exists()


def test_infer(run, house, broken):
    code, found = run("infer", house, "garden", "kitchen", "--json")
    assert (code, found) == (0, {"a": "garden", "b": "kitchen", "relations": ["DC"]})
    code, text = run("infer", house, "kitchen", "garden", "--why")
    assert code == 0
    assert "not EC:" in text
    assert "kitchen inside house (plan), house disjoint or meets garden, so kitchen disjoint garden" in text
    code, found = run("infer", house, "kitchen", "garden", "--why", "--json")
    assert set(found["excluded"]) == {"EC", "PO", "TPP", "NTPP", "TPPi", "NTPPi", "EQ"}
    code, found = run("infer", broken, "shed", "house", "--json")
    assert (code, found["relations"]) == (1, [])
    with pytest.raises(UnknownName, match="kitchen"):
        run("infer", house, "kitchn", "house")


def test_ask(run, house):
    code, found = run("ask", house, "inside(kitchen, house) & ~meet(kitchen, garden)", "--json")
    assert (code, found["answer"], found["evidence"]["falsified"]) == (0, "entailed", None)
    assert found["evidence"]["statements"] == [["kitchen", "house", ["NTPP"]], ["house", "garden", ["DC", "EC"]]]
    assert len(found["evidence"]["satisfied"]) == 3
    code, found = run("ask", house, "meet(house, garden)", "--json")
    assert (code, found["answer"], found["evidence"]["statements"]) == (0, "possible", [])
    assert ["house", "garden", "EC"] in found["evidence"]["satisfied"]
    assert ["house", "garden", "DC"] in found["evidence"]["falsified"]
    assert run("ask", house, "meet(house, garden)")[1].splitlines()[0] == "possible"
    code, found = run("ask", house, "meet(kitchen, garden)", "--json")
    assert (code, found["answer"], found["evidence"]["satisfied"]) == (1, "impossible", None)
    with pytest.raises(BadInput, match="character"):
        run("ask", house, "meet(kitchen")


def test_repair(run, broken, house, tmp_path):
    code, found = run("repair", broken, "--json")
    assert code == 0
    assert (found["drop"], found["cost"], found["optimal"]) == ([["kitchen", "garden", ["EC"]]], 1.0, True)
    assert "kitchen meets garden (hearsay)" in run("repair", broken)[1]
    assert run("repair", house, "--json")[1]["drop"] == []
    hard = network(tmp_path / "hard.csv", ("a", "EC", "b", "inf", ""), ("a", "DC", "b", "inf", ""), ("a", "EC", "c", "", ""))
    code, found = run("repair", hard, "--json")
    assert (code, found["cost"], found["drop"]) == (1, None, None)
    assert found["conflict"] == [["a", "b", ["EC"]], ["a", "b", ["DC"]]]
    assert "no repair" in run("repair", hard)[1]


def test_scenarios(run, house, broken):
    code, found = run("scenarios", house, "--json")
    assert (code, found["count"], found["exact"]) == (0, 2, True)
    assert [len(scenario) for scenario in found["scenarios"]] == [3, 3]
    code, found = run("scenarios", house, "--limit", "1", "--json")
    assert (code, found["count"], found["exact"], len(found["scenarios"])) == (0, 1, False, 1)
    code, found = run("scenarios", broken, "--json")
    assert (code, found) == (1, {"count": 0, "exact": True, "scenarios": []})
    assert run("scenarios", house)[1].splitlines()[0] == "2 scenarios"


def test_compose(run):
    assert run("compose", "inside", "disjoint", "--json") == (0, {"relations": ["DC"]})
    assert run("compose", "TPP", "EC|PO") == run("compose", "coveredBy", "meet overlap", "--sat")
    assert run("compose", "<", "=", "--calculus", "point", "--json")[1] == {"relations": ["<"]}
    with pytest.raises(UnknownName, match="did you mean"):
        run("compose", "insidex", "EC")
    with pytest.raises(UnknownName):
        run("compose", "EC", "EC", "--calculus", "rcc9")


@pytest.mark.parametrize("command", ["check", "repair", "scenarios"])
def test_bad_files(run, tmp_path, command):
    with pytest.raises(NinefoldError, match="cannot read"):
        run(command, tmp_path / "nothing.csv")
    wrong = network(tmp_path / "wrong.csv", ("a", "insidex", "b", "", ""))
    with pytest.raises(NinefoldError, match=r"wrong\.csv, line 2"):
        run(command, wrong)


def test_point_networks(run, tmp_path):
    path = network(tmp_path / "times.csv", ("x", "<", "y", "", ""), ("y", "<", "z", "", ""))
    code, found = run("infer", path, "x", "z", "--calculus", "point", "--json")
    assert (code, found["relations"]) == (0, ["<"])
    code, found = run("check", path, "--calculus", "point", "--json")
    assert (code, found["verdict"]) == (0, "consistent")


def test_proofs_are_written_in_every_format_and_said(run, broken, tmp_path, capsys):
    def told(*arguments):
        code = typer_app()(args=[str(argument) for argument in arguments], standalone_mode=False)
        out, err = capsys.readouterr()
        return code, json.loads(out) if out.startswith("{") else out, err

    log, drat, lrat = tmp_path / "a.log", tmp_path / "b.drat", tmp_path / "c.lrat"
    code, found, err = told("check", broken, "--proof", log, "--json")
    assert (code, found["proof"], "cnf" in found) == (1, str(log), False)
    assert err == f"ninefold: wrote the proof {log}; `prove` confirms it\n"
    assert told("prove", broken, log)[:2] == (0, "proved: 1 clause confirmed\n")
    code, found, err = told("check", broken, "--proof", drat, "--proof-format", "drat", "--json")
    assert (code, found["proof"], found["cnf"]) == (1, str(drat), str(drat.with_suffix(".cnf")))
    assert err == f"ninefold: wrote the proof {drat} and the formula {drat.with_suffix('.cnf')} that it refutes\n"
    assert drat.read_text().endswith("\n0\n")
    assert "\np cnf " in drat.with_suffix(".cnf").read_text()
    assert told("check", broken, "--proof", lrat, "--proof-format", "lrat")[0] == 1
    assert lrat.with_suffix(".cnf").read_bytes() == drat.with_suffix(".cnf").read_bytes()
    assert lrat.read_text() != drat.read_text()


def test_no_proof_of_what_is_consistent(house, tmp_path, capsys):
    log = tmp_path / "a.drat"
    assert typer_app()(["check", str(house), "--proof", str(log), "--proof-format", "drat"], standalone_mode=False) == 0
    assert capsys.readouterr().err == "ninefold: no proof: the network is consistent\n"
    assert sorted(tmp_path.iterdir()) == [house]


def test_proof_files_that_cannot_be(run, broken, tmp_path):
    (tmp_path / "a.cnf").write_text("mine")
    with pytest.raises(BadInput, match=r"a\.cnf: exists"):
        run("check", broken, "--proof", tmp_path / "a.drat", "--proof-format", "drat")
    with pytest.raises(BadInput, match=r"another ending, such as \.drat"):
        run("check", broken, "--proof", tmp_path / "b.cnf", "--proof-format", "drat")
    with pytest.raises(BadInput, match="needs --proof LOG"):
        run("check", broken, "--proof-format", "drat")
    with pytest.raises(UnknownName, match=r"dart.*drat"):
        run("check", broken, "--proof", tmp_path / "b", "--proof-format", "dart")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["a.cnf", "broken.csv"]
