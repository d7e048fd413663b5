"""Consistency of relation networks: closure beside plain Python, search beside the recorded times of GQR.

The recorded networks and times are read from a folder beside the repository, ``../shared/data/networks``, or from the one
that NINEFOLD_NETWORKS names; without it the random families below still run.
"""

from __future__ import annotations

import csv
import os
import statistics
import time
from pathlib import Path

import numpy as np

from benchmarks.clock import best, row, title
from ninefold.encodings import H8, NP8, RCC8
from ninefold.io import read_network
from ninefold.reasoner import Consistent, Inconsistent, Network, check
from ninefold.reasoner.engine.engine import Engine
from ninefold.reasoner.engine.graph import dense_frame, triangulated_frame
from ninefold.reasoner.engine.tables import Tables

FOLDER = Path(os.environ.get("NINEFOLD_NETWORKS", Path(__file__).parents[2] / "shared" / "data" / "networks"))
CAP = 60.0


def labels(rng: np.random.Generator, count: int, *, hard: bool) -> list[int]:
    """Random RCC-8 labels, each base relation with probability one half; `hard`: redrawn until in NP8."""
    found: list[int] = []
    while len(found) < count:
        mask = int(rng.integers(1, 255))
        if not hard or mask in NP8:
            found.append(mask)
    return found


def uniform(n: int, degree: float, seed: int, *, hard: bool) -> Network:
    """A(n, d, 4) or H(n, d, 4): n * d / 2 pairs at random."""
    rng = np.random.default_rng(seed)
    rows, columns = np.triu_indices(n, 1)
    pick = np.sort(rng.choice(rows.size, size=round(n * degree / 2), replace=False))
    masks = labels(rng, pick.size, hard=hard)
    return Network.from_constraints(RCC8, n, zip(rows[pick].tolist(), columns[pick].tolist(), masks, strict=True))


def preferential(n: int, m: int, seed: int) -> Network:
    """BH(n, m): a Barabasi-Albert graph, m edges for each new node, labels in NP8."""
    import networkx as nx

    edges = sorted(tuple(sorted(edge)) for edge in nx.barabasi_albert_graph(n, m, seed=seed).edges)
    masks = labels(np.random.default_rng(seed), len(edges), hard=True)
    return Network.from_constraints(RCC8, n, ((i, j, mask) for (i, j), mask in zip(edges, masks, strict=True)))


def plain_closure(net: Network) -> bool:
    """The textbook queue over a dense table of masks, in plain Python."""
    n, table, converse = net.n_entities, RCC8.composition_table.tolist(), RCC8.converse_table.tolist()
    label = [[255] * n for _ in range(n)]
    queue = []
    for i, j, mask in net.constraints().triples():
        label[i][j], label[j][i] = mask, converse[mask]
        queue.append((i, j))
    waiting = set(queue)
    while queue:
        i, j = queue.pop()
        waiting.discard((i, j))
        for k in range(n):
            if k in (i, j):
                continue
            for a, b, via in ((i, k, table[label[i][j]][label[j][k]]), (k, j, table[label[k][i]][label[i][j]])):
                new = label[a][b] & via
                if new != label[a][b]:
                    if not new:
                        return False
                    label[a][b], label[b][a] = new, converse[new]
                    pair = (a, b) if a < b else (b, a)
                    if pair not in waiting:
                        waiting.add(pair)
                        queue.append(pair)
    return True


def our_closure(net: Network, *, sparse: bool) -> bool | None:
    stated, n = net.constraints(), net.n_entities
    frame = triangulated_frame(n, stated.i, stated.j, most=n * (n - 1) // 4) if sparse else dense_frame(n)
    assert frame is not None
    engine = Engine(Tables.of(RCC8, H8.member), frame, frame.arcs(stated.i, stated.j), stated.mask.astype(np.int16))
    return engine.close()


def timed(net: Network, seed: int = 0) -> tuple[float, object]:
    net.constraints()
    begin = time.perf_counter()
    verdict = check(net, budget=CAP, seed=seed)
    return time.perf_counter() - begin, verdict


def main() -> None:
    timed(uniform(60, 12, 0, hard=True))
    our_closure(uniform(300, 8, 0, hard=False), sparse=False)
    our_closure(preferential(500, 2, 0), sparse=True)
    title("closure, warm", "ninefold", "plain Python", "ratio", "asked")
    for n in (100, 300, 1000):
        net = uniform(n, 8 if n < 1000 else 10, 1, hard=False)
        mine = best(lambda net=net: our_closure(net, sparse=False))
        its = best(lambda net=net: plain_closure(net), repeat=1) if n <= 300 else None
        cells = (f"{mine:.4f} s", f"{its:.2f} s" if its else "-", f"{its / mine:.0f} x" if its else "-")
        row(f"A n={n} d={8 if n < 1000 else 10}, dense", *cells, "0.1 s" if n == 1000 else "-")
    for n in (1000, 10_000):
        net = preferential(n, 2, 1)
        mine = best(lambda net=net: our_closure(net, sparse=True))
        row(f"BH m=2 n={n:,}, triangulation included", f"{mine:.3f} s", "-", "-", "0.6 s" if n == 10_000 else "-")

    title("search, warm, five networks", "median", "mean", "worst", "asked")
    for n, degree, asked in ((100, 14, "3 s"), (100, 15, "3 s"), (150, 16, "0.5 s mean"), (200, 16, "1 s")):
        times = [timed(uniform(n, degree, seed, hard=True))[0] for seed in range(5)]
        cells = (f"{statistics.median(times):.2f} s", f"{statistics.mean(times):.2f} s", f"{max(times):.2f} s")
        row(f"H n={n} d={degree}", *cells, asked)
    times = [timed(preferential(10_000, 2, seed))[0] for seed in range(3)]
    row(
        "BH m=2 n=10,000 (three)",
        f"{statistics.median(times):.2f} s",
        f"{statistics.mean(times):.2f} s",
        f"{max(times):.2f} s",
        "3 s",
    )

    scenario_times()

    if not (FOLDER / "answers.csv").is_file():
        print("\nno folder with recorded networks; set NINEFOLD_NETWORKS to compare with GQR")
        return
    recorded()


def scenario_times() -> None:
    """A scenario beside the check that it comes from, and questions about pairs that no completion holds; CPU time."""
    title("scenarios, warm, CPU time", "check", "scenario", "pairs kept", "1,000 pairs", "asked")
    families = (
        ("H n=100 d=14", lambda seed: uniform(100, 14, seed, hard=True), "+ 1 s"),
        ("BH m=2 n=500", lambda seed: preferential(500, 2, seed), "+ 1 s"),
        ("BH m=1 n=10,000", lambda seed: preferential(10_000, 1, seed), "no table"),
        ("BH m=2 n=10,000", lambda seed: preferential(10_000, 2, seed), "no table"),
    )
    for name, family, asked in families:
        net, verdict, took = None, None, 0.0
        for seed in range(50):
            net = family(seed)
            net.constraints()
            begin = time.process_time()
            verdict = check(net, budget=CAP)
            took = time.process_time() - begin
            if isinstance(verdict, Consistent):
                break
        assert net is not None
        assert isinstance(verdict, Consistent)
        begin = time.process_time()
        scenario = verdict.scenario
        made = time.process_time() - begin
        pairs = np.random.default_rng(0).integers(0, net.n_entities, (1000, 2)).tolist()
        begin = time.process_time()
        for a, b in pairs:
            scenario.relation(a, b)
        answered = time.process_time() - begin
        assert scenario.satisfies(net)
        kept = verdict.decision.witness.frame.n_edges if verdict.decision.witness else 0
        row(name, f"{took:.3f} s", f"{made:.3f} s", f"{kept:,}", f"{answered:.2f} s", asked)


def recorded() -> None:
    """Every network with a recorded answer and time of GQR."""
    mine = its = 0.0
    files = wrong = slow = 0
    with (FOLDER / "answers.csv").open(newline="", encoding="utf-8") as file:
        for line in csv.DictReader(file):
            if not line["answer"]:
                continue
            took, verdict = timed(read_network(next(FOLDER.rglob(line["file"]))))
            expected = Consistent if line["answer"] == "sat" else Inconsistent
            files, wrong = files + 1, wrong + (not isinstance(verdict, expected))
            gqr = float(line["gqr_search_s"]) if line["gqr_search_s"].replace(".", "").isdecimal() else CAP
            mine, its, slow = mine + took, its + gqr, slow + (took > 2 * gqr + 2)
    title("recorded networks", "files", "wrong", "too slow", "ninefold", "GQR", "ratio")
    row("in-process against GQR's whole process", files, wrong, slow, f"{mine:.1f} s", f"{its:.1f} s", f"{its / mine:.1f} x")


if __name__ == "__main__":
    main()
