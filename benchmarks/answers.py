"""Conflicts, inference, repair and drawings of networks of a few hundred regions.

Limits: 5 s a conflict, 20 s a conflict of a network on which closure does not decide, 1 s a ring, 10 s a drawing.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
import shapely

from benchmarks.clock import row, title
from benchmarks.networks import uniform
from ninefold.encodings import RCC8
from ninefold.layout.realization import realize
from ninefold.reasoner.networks.conflicts import conflict
from ninefold.reasoner.networks.enumeration import scenarios
from ninefold.reasoner.networks.explanation import explain
from ninefold.reasoner.networks.inference import infer
from ninefold.reasoner.networks.network import Network
from ninefold.reasoner.networks.questions import ask
from ninefold.reasoner.networks.repairs import repair
from ninefold.reasoner.networks.scenario import Scenario
from ninefold.reasoner.sets.relation import RCC8_OF_NAME, Relation


def boxes(n: int, size: int, seed: int) -> Scenario:
    """The scenario of n random boxes on a sheet of size x size."""
    rng = np.random.default_rng(seed)
    corner, side = rng.integers(0, size, (n, 2)), rng.integers(1, max(size // 3, 2), (n, 2))
    shapes = np.array([shapely.box(*a, *(a + s)) for a, s in zip(corner, side, strict=True)], dtype=object)
    bases = np.zeros((n, n), dtype=np.uint8)
    for text in np.unique(matrices := shapely.relate(shapes[:, None], shapes[None, :]).astype(str)):
        bases[matrices == text] = RCC8.bases.index(RCC8_OF_NAME[Relation.from_de9im(str(text)).name])
    return Scenario(RCC8, tuple(f"r{k}" for k in range(n)), bases)


def spoken(scenario: Scenario, statements: int, wrong: int, seed: int, extra: float = 0.25) -> Network:
    """Statements that are true of a scenario, with other relations allowed too, and a few that are false."""
    rng = np.random.default_rng(seed)
    net, n = Network(RCC8), len(scenario.entities)
    falsehoods = set(rng.choice(statements, wrong, replace=False).tolist())
    for at in range(statements):
        i, j = rng.choice(n, 2, replace=False).tolist()
        true = 1 << int(scenario.bases[i, j])
        mask = sum(1 << int(k) for k in np.flatnonzero(rng.random(8) < extra)) | true
        if at in falsehoods:
            mask = 1 << int(rng.choice([k for k in range(8) if 1 << k != true]))
        net.add(f"r{i}", f"r{j}", mask, label=f"said {at}")
    return net


def random_labels(n: int, degree: float, size: float, seed: int) -> Network:
    """A(n, d, l): random labels on random pairs."""
    rng = np.random.default_rng(seed)
    net, (i, j) = Network(RCC8), np.triu_indices(n, 1)
    for at in rng.choice(i.size, int(n * degree / 2), replace=False).tolist():
        mask = 0
        while mask in (0, RCC8.universal):
            mask = sum(1 << int(k) for k in np.flatnonzero(rng.random(8) < size / 8))
        net.add(f"r{i[at]}", f"r{j[at]}", mask)
    return net


def chain(n: int, statements: int, seed: int) -> Network:
    """Boxes one inside the next, the first said to be outside the last, and much that is true and says little."""
    rng = np.random.default_rng(seed)
    net = Network(RCC8)
    for k in range(n - 1):
        net.add(f"r{k}", f"r{k + 1}", "inside coveredBy")
    net.add("r0", f"r{n - 1}", "disjoint meet", label="the false one")
    while net.n_statements < statements:
        i, j = sorted(rng.choice(n, 2, replace=False).tolist())
        others = sum(1 << int(k) for k in np.flatnonzero(rng.random(8) < 0.5))
        net.add(f"r{i}", f"r{j}", others | RCC8.relation("inside disjoint meet overlap"))
    return net


def ring(n: int) -> Network:
    """Boxes each inside the next, the last inside the first."""
    net = Network(RCC8)
    for k in range(n):
        net.add(f"r{k}", f"r{(k + 1) % n}", "inside")
    return net


def timed(job: Callable[[], Any]) -> tuple[float, Any]:
    begin = time.perf_counter()
    result = job()
    return time.perf_counter() - begin, result


def main() -> None:
    conflict(random_labels(200, 20, 4, 0))  # compile

    title("minimal conflict, 200 entities, 2,000 statements", "seconds", "statements", "cases", "words, s")
    networks = [(f"random labels, d = 20, l = {size}", random_labels(200, 20, size, 1)) for size in (4.0, 4.8)]
    networks += [(f"of boxes, {w} false, {e:.0%} more", spoken(boxes(200, 30, 1), 2000, w, 3, e))
                 for w, e in ((5, 0.0), (20, 0.1), (60, 0.25))]  # fmt: skip
    networks += [("200 boxes in one another, one false", chain(200, 2000, 1))]
    for name, net in networks:
        seconds, found = timed(lambda net=net: conflict(net))
        if found is None:
            row(name, f"{seconds:.2f} s", "consistent", "", "")
            continue
        words, text = timed(lambda found=found: explain(found))
        row(name, f"{seconds:.2f} s", len(found), text.cases, f"{words:.2f} s")

    conflict(uniform(60, 16, 0, hard=True))  # compile
    title("minimal conflict, closure does not decide", "seconds", "statements", "asked")
    for seed in range(4):
        net = uniform(100, 16, seed, hard=True)
        seconds, found = timed(lambda net=net: conflict(net, budget=120))
        kind = "" if found is None or found.minimal else " (budget spent)"
        row(f"H n=100 d=16, seed {seed}", f"{seconds:.2f} s{kind}", "-" if found is None else len(found), "20 s")

    net = ring(401)
    title("a ring of 401 NTPP", "seconds", "statements", "asked")
    seconds, found = timed(lambda: conflict(net))
    row("conflict", f"{seconds:.2f} s", len(found), "1 s")
    seconds, text = timed(lambda: explain(found))
    row("explain the conflict", f"{seconds:.2f} s", len(text.lines), "1 s")
    seconds, repaired = timed(lambda: repair(net))
    row("repair", f"{seconds:.2f} s", len(repaired.drop), "1 s")

    title("realize, every pair confirmed by GEOS", "seconds", "pieces")
    for name, scenario in (
        ("100 boxes, crowded", boxes(100, 12, 1)),
        ("100 boxes", boxes(100, 40, 1)),
        ("100 boxes, sparse", boxes(100, 300, 1)),
        ("a scenario of 100 entities, random labels", next(scenarios(random_labels(100, 6, 4, 1)))),
    ):
        seconds, shapes = timed(lambda scenario=scenario: realize(scenario))
        row(name, f"{seconds:.2f} s", sum(len(getattr(shape, "geoms", [shape])) for shape in shapes.values()))

    title("answers about 60 entities, 300 statements", "seconds", "answer")
    net = spoken(boxes(60, 30, 2), 300, 0, 4)
    seconds, found = timed(lambda: infer(net, "r0", "r1"))
    row("infer", f"{seconds:.2f} s", " ".join(found.relations))
    seconds, answer = timed(lambda: ask(net, "(inside(r0, r1) | meet(r2, r3)) -> ~disjoint(r4, r5)"))
    row("ask", f"{seconds:.2f} s", answer.answer)
    net = spoken(boxes(60, 30, 2), 300, 5, 4)
    seconds, repaired = timed(lambda: repair(net))
    row("repair, 5 false", f"{seconds:.2f} s", f"drop {len(repaired.drop)}")


if __name__ == "__main__":
    main()
