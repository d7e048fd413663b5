"""Proofs of hard networks, from the search to dratify. Limits: writing one three searches, the native checker 1 s."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np
from dratify import check_proof, parse_dimacs

from benchmarks.clock import best, row, title
from ninefold.encodings import NP8, RCC8
from ninefold.reasoner import Inconsistent, Network, check, prove, to_drat

DRATIFY_MOST = 60_000
"""Lines up to which dratify, plain Python, is run."""


def hard_labels(n: int, degree: float, seed: int) -> Network:
    """H(n, d, 4): random labels on random pairs, all among those that closure does not decide."""
    rng = np.random.default_rng(seed)
    i, j = np.triu_indices(n, 1)
    triples = []
    for at in rng.choice(i.size, int(n * degree / 2), replace=False).tolist():
        mask = 0
        while mask not in NP8:
            mask = sum(1 << int(k) for k in np.flatnonzero(rng.random(8) < 0.5))
        triples.append((int(i[at]), int(j[at]), mask))
    return Network.from_constraints(RCC8, n, triples)


def timed(job: Callable[[], Any]) -> tuple[float, Any]:
    begin = time.perf_counter()
    result = job()
    return time.perf_counter() - begin, result


def main() -> None:
    title("proofs, H(n, d, 4)", "clauses", "search", "prove", "drat", "lrat", "drat/search", "MB", "dratify")
    warm = hard_labels(100, 16, 1)  # large enough for compiled kernels
    proof = check(warm, proof=True).proof
    prove(warm, proof)
    to_drat(warm, proof)
    for n, degree, seed in [
        (80, 15, 0),
        (80, 15.5, 1),
        (80, 16, 2),
        (100, 15.5, 0),
        (100, 16, 0),
        (100, 16, 1),
        (120, 16, 0),
    ]:
        net = hard_labels(n, degree, seed)
        verdict = check(net, proof=True)
        if not isinstance(verdict, Inconsistent):
            row(f"n = {n}, d = {degree}, seed {seed}", "consistent")
            continue
        proof = verdict.proof
        search = best(lambda net=net: check(net))
        native = best(lambda net=net, proof=proof: prove(net, proof))
        drat = best(lambda net=net, proof=proof: to_drat(net, proof))
        lrat = best(lambda net=net, proof=proof: to_drat(net, proof, lrat=True))
        found = to_drat(net, proof)
        other = "not run"
        if found.n_lines <= DRATIFY_MOST:
            seconds, answer = timed(
                lambda found=found: check_proof(parse_dimacs(found.cnf.decode()), found.refutation.decode())
            )
            assert answer.ok
            other = f"{seconds:.1f} s"
        size = (len(found.cnf) + len(found.refutation)) / 1e6
        times = (f"{1000 * t:.0f} ms" for t in (search, native, drat, lrat))
        row(f"n = {n}, d = {degree}, seed {seed}", len(proof.clauses), *times, f"{drat / search:.1f}", f"{size:.2f}", other)


if __name__ == "__main__":
    main()
