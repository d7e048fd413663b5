"""Random networks with GQR's answers, where the data folder is at hand: encodings and solvers as referees."""

import csv
from pathlib import Path

import pytest

from ninefold.encodings import RCC8, encode, open_solver
from ninefold.io.networks.network_file import read_network
from tests.oracle.network_reference import Reference

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "data" / "networks"

if not (FOLDER / "answers.csv").is_file():
    pytest.skip("no folder ../shared/data/networks with recorded answers", allow_module_level=True)


def small_networks():
    with (FOLDER / "answers.csv").open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if int(row["n"]) <= 20:
                yield next(FOLDER.rglob(row["file"])), row["answer"] == "sat"


@pytest.mark.parametrize("solver", ["cadical195", "glucose42"])
@pytest.mark.parametrize("name", ["direct", "support", "triangulated", "splitting"])
def test_recorded_answers(name, solver):
    answers = list(small_networks())
    assert {answer for _, answer in answers} == {True, False}
    for path, answer in answers[:: 3 if name in ("direct", "support") else 1]:
        net = read_network(path)
        constraints = net.constraints().triples()
        encoding = encode(name, RCC8, net.n_entities, constraints)
        with open_solver(solver, encoding.clauses) as back_end:
            assert back_end.solve() is answer, path.name
            if answer and name != "triangulated":
                scenario = {pair: RCC8.names(mask)[0] for pair, mask in encoding.decode(back_end.model()).items()}
                assert Reference(RCC8).is_scenario(net.n_entities, constraints, scenario)
