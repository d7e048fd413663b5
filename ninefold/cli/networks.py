"""Commands on relation networks: ``check``, ``prove``, ``infer``, ``ask``, ``repair``, ``scenarios`` and ``compose``."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ninefold._wording import counted

from ._options import AsJson, Force
from ._output import note, notes, print_json, progress

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ninefold.reasoner.networks.network import Network
    from ninefold.reasoner.networks.proofs import Proof
    from ninefold.reasoner.networks.scenario import Scenario
    from ninefold.reasoner.networks.statement import Statement

__all__ = ["ask", "check", "compose", "infer", "prove", "repair", "scenarios"]

YES, NO, SPENT = 0, 1, 3

PROOF_FORMATS = ("native", "drat", "lrat")

LISTED = 1000
"""Entities up to which ``check --json`` writes the scenario out; it holds every pair."""

NetPath = Annotated[
    Path, typer.Argument(metavar="NET", help="A file of declared relations: .csp, .csv or .json.", show_default=False)
]  # fmt: skip
CalculusName = Annotated[
    str | None,
    typer.Option(
        "--calculus",
        help="rcc8, rcc5, point, allen or a .spec file; needed where NET is not in rcc8 and does not say.",
        show_default=False,
    ),
]
Budget = Annotated[float | None, typer.Option(min=0.001, help="Seconds after which to give up.", show_default=False)]
Seed = Annotated[int, typer.Option(min=0, help="Seed of random choices; the same seed gives the same answer.")]


def check(
    net: NetPath,
    *,
    calculus: CalculusName = None,
    budget: Budget = None,
    method: Annotated[str, typer.Option(help="auto, or an encoding and solver such as support:cadical195.")] = "auto",
    seed: Seed = 0,
    no_conflict: Annotated[bool, typer.Option("--no-conflict", help="Only decide; seek no minimal conflict.")] = False,
    draw: Annotated[
        Path | None, typer.Option(metavar="FILE.svg", help="Draw regions that satisfy it.", show_default=False)
    ] = None,
    proof: Annotated[
        Path | None, typer.Option(metavar="LOG", help="Keep a proof of an inconsistency, for `prove`.", show_default=False)
    ] = None,
    proof_format: Annotated[
        str, typer.Option(metavar="native|drat|lrat", help="drat and lrat, for other checkers, also write LOG's .cnf.")
    ] = "native",
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Decide whether a network is consistent, and show a scenario or a minimal conflict."""
    import time

    from ninefold._files import refuse_existing
    from ninefold.errors import BadInput
    from ninefold.reasoner.networks.consistency import Consistent, Inconsistent
    from ninefold.reasoner.networks.consistency import check as decide

    if draw is not None:
        if draw.suffix.lower() != ".svg":
            raise BadInput(f"{draw}: pictures are SVG; name a file that ends in .svg")
        refuse_existing(draw, force=force)
    proof_files = _proof_files(proof, proof_format)
    for file in proof_files:
        refuse_existing(file, force=force)
    network = _read(net, calculus)
    begin = time.perf_counter()
    with progress(f"deciding {net}"):
        verdict = decide(network, budget=budget, method=method, proof=proof is not None, seed=seed)
    seconds = time.perf_counter() - begin
    compiling = verdict.decision.compiling
    report: dict[str, Any] = {
        "verdict": "unknown",
        "seconds": round(seconds, 6),
        "compiling": round(compiling, 6),
        "scenario": None,
        "conflict": None,
    }
    text = ""
    code = SPENT
    if isinstance(verdict, Consistent):
        report["verdict"], code, text = "consistent", YES, f"consistent ({_counts(network)}, {seconds:.3g} s)"
        if as_json and network.n_entities <= LISTED:
            report["scenario"] = _triples(verdict.scenario)
        elif as_json:
            note(f"the scenario of {network.n_entities:,} entities is not written out; `scenarios` gives it")
        if draw is not None:
            _draw(verdict.scenario, draw, title=net.stem, force=force)
            report["drawing"] = str(draw)
            text += f"\n{draw}: a drawing of {counted(network.n_entities, 'region')}, checked pair by pair"
    elif isinstance(verdict, Inconsistent):
        report["verdict"], code, text = "inconsistent", NO, f"inconsistent ({_counts(network)}, {seconds:.3g} s)"
        if not no_conflict:
            left = None if budget is None else max(budget - (seconds - compiling), 0.0)
            why = _conflict(network, seed, left)
            report["conflict"] = why[0]
            text = f"{text}\n{why[1]}"
        if verdict.proof is not None:
            with progress("writing the proof"):
                _write_proof(network, verdict.proof, proof_format, proof_files, force=force)
            report |= zip(("proof", "cnf"), map(str, proof_files), strict=False)
    else:
        report["reason"], report["kind"] = verdict.reason, verdict.kind
        text = f"unknown: {verdict.reason}"
    if proof is not None and code != NO:
        note(
            f"no proof: {'the network is consistent' if code == YES else 'whether the network is consistent is not decided'}"
        )
    if draw is not None and code != YES:
        note("nothing was drawn: only a consistent network has a drawing")
    _print(report, text, as_json=as_json)
    return code


def prove(
    net: NetPath,
    log: Annotated[Path, typer.Argument(metavar="LOG", help="A proof that `check --proof` wrote.", show_default=False)],
    *,
    calculus: CalculusName = None,
    as_json: AsJson = False,
) -> int:
    """Confirm, clause by clause and without the search, a proof that a network is inconsistent."""
    from ninefold.errors import BadInput
    from ninefold.reasoner.networks.proofs import Proof
    from ninefold.reasoner.networks.proofs import prove as confirm

    network = _read(net, calculus)
    try:
        proof = Proof.from_text(log.read_text(encoding="ascii"))
    except (OSError, UnicodeDecodeError) as error:
        raise BadInput(f"{log}: cannot be read as a proof ({error})") from None
    except BadInput as error:
        raise BadInput(f"{log}: {error}") from None
    try:
        with progress(f"confirming {counted(len(proof.clauses), 'clause')}"):
            confirm(network, proof)
    except BadInput as error:
        _print(
            {"proved": False, "clauses": len(proof.clauses), "reason": str(error)}, f"not proved: {error}", as_json=as_json
        )
        return NO
    _print(
        {"proved": True, "clauses": len(proof.clauses)},
        f"proved: {counted(len(proof.clauses), 'clause')} confirmed",
        as_json=as_json,
    )
    return YES


def infer(
    net: NetPath,
    a: Annotated[str, typer.Argument(metavar="A", help="An entity.", show_default=False)],
    b: Annotated[str, typer.Argument(metavar="B", help="Another.", show_default=False)],
    *,
    calculus: CalculusName = None,
    why: Annotated[bool, typer.Option("--why", help="Explain every relation that is excluded.")] = False,
    budget: Budget = None,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> int:
    """Tell which relations are feasible between two entities."""
    from ninefold.reasoner.networks.conflicts import Conflict
    from ninefold.reasoner.networks.deciding import why_unknown
    from ninefold.reasoner.networks.explanation import explain
    from ninefold.reasoner.networks.inference import infer as inference

    network = _read(net, calculus)
    with progress(f"inferring from {net}"):
        found = inference(network, a, b, seed=seed, budget=budget)
    names = network.calculus.names
    report: dict[str, Any] = {"a": found.a, "b": found.b, "relations": list(found.relations)}
    feasible = " ".join(found.relations)
    if found.consistent is False:
        feasible = "nothing is possible: the network is inconsistent"
    lines = [f"{found.a}  {feasible}  {found.b}"] if feasible else []
    if found.kind is not None:
        report["unknown"], report["kind"] = list(found.undecided), found.kind
        report["reason"] = why_unknown(network.calculus, found.kind, budget)
        lines.append(f"not decided between {found.a} and {found.b}: {' '.join(found.undecided)} ({report['reason']})")
    if why:
        report["excluded"] = {}
        for relation in names(network.calculus.universal & ~found.mask & ~found.unknown):
            reason = found.reason(relation)
            if isinstance(reason, Conflict):
                report["excluded"][relation] = _stated(network, reason)
                lines += [f"not {relation}:", *(f"  {line}" for line in explain(reason).lines)]
    _print(report, "\n".join(lines), as_json=as_json)
    if found.unknown:
        return SPENT
    return YES if found.consistent else NO


def ask(
    net: NetPath,
    formula: Annotated[
        str, typer.Argument(metavar="FORMULA", help="Such as 'inside(a, b) & ~meet(a, \"block 12\")'.", show_default=False)
    ],
    *,
    calculus: CalculusName = None,
    budget: Budget = None,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> int:
    """Tell whether a Boolean formula is entailed, possible or impossible, with evidence."""
    from ninefold.reasoner.networks.questions import ask as question

    network = _read(net, calculus)
    with progress(f"asking {net}"):
        answer = question(network, formula, seed=seed, budget=budget)
        forced = answer.statements
    evidence = {
        "satisfied": None if answer.satisfied is None else _triples(answer.satisfied),
        "falsified": None if answer.falsified is None else _triples(answer.falsified),
        "statements": _stated(network, forced),
    }
    lines: list[str] = [answer.answer]
    if forced:
        lines += ["forced by:", *(f"  {_spoken(network, s)}" for s in forced)]
    if answer.answer == "possible":
        for value, scenario in (("true", answer.satisfied), ("false", answer.falsified)):
            lines += [
                f"{value} where:",
                *(f"  {a} {r} {b}" for a, b, r in _mentioned(scenario, answer.formula.atoms.values())),
            ]
    _print({"answer": answer.answer, "evidence": evidence}, "\n".join(lines), as_json=as_json)
    return {"impossible": NO, "unknown": SPENT}.get(answer.answer, YES)


def repair(
    net: NetPath, *, calculus: CalculusName = None, budget: Budget = None, seed: Seed = 0, as_json: AsJson = False
) -> int:
    """Find the cheapest statements to drop so that the rest is consistent."""
    from ninefold.errors import Undecided
    from ninefold.reasoner.networks.deciding import why_unknown
    from ninefold.reasoner.networks.repairs import repair as cheapest

    network = _read(net, calculus)
    reason = why_unknown(network.calculus, "time", budget)
    try:
        with progress(f"repairing {net}"):
            found = cheapest(network, seed=seed, budget=budget)
    except Undecided as error:
        found, reason = None, str(error)
    if found is None:
        _print({"drop": None, "cost": None, "optimal": False, "reason": reason}, f"unknown: {reason}", as_json=as_json)
        return SPENT
    if found.conflict is not None:
        report: dict[str, Any] = {"drop": None, "cost": None, "optimal": True, "conflict": _stated(network, found.conflict)}
        lines = ["there is no repair: these hard statements contradict each other"]
        _print(report, "\n".join([*lines, *(f"  {_spoken(network, s)}" for s in found.conflict)]), as_json=as_json)
        return NO
    report = {"drop": _stated(network, found.drop), "cost": found.cost, "optimal": found.optimal}
    lines = [f"drop {len(found.drop):,} of {counted(network.n_statements, 'statement')}, cost {found.cost:g}"]
    if not found.optimal:
        lines[0] += " (perhaps not the least: the budget is spent)"
    lines += [f"  {_spoken(network, s)}" for s in found.drop]
    _print(report, "\n".join(lines) if found.drop else "consistent: nothing has to be dropped", as_json=as_json)
    return YES if found.optimal else SPENT


def scenarios(
    net: NetPath,
    *,
    calculus: CalculusName = None,
    limit: Annotated[int, typer.Option(min=1, max=1_000_000, help="Most scenarios to find.")] = 100,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> int:
    """List the scenarios of a network, and say how many there are."""
    from itertools import islice

    from ninefold.errors import Undecided
    from ninefold.reasoner.networks.enumeration import scenarios as every

    network = _read(net, calculus)
    try:
        with progress(f"listing the scenarios of {net}"):
            found = list(islice(every(network, seed=seed), limit + 1))
    except Undecided as error:
        report = {"count": 0, "exact": False, "scenarios": [], "reason": str(error)}
        _print(report, f"unknown: {error}", as_json=as_json)
        return SPENT
    exact, found = len(found) <= limit, found[:limit]
    if as_json:
        print_json({"count": len(found), "exact": exact, "scenarios": [_triples(s) for s in found]})
    else:
        print(f"{'' if exact else 'more than '}{counted(len(found), 'scenario')}")
        for number, scenario in enumerate(found, start=1):
            print(f"{number}: " + "; ".join(f"{a} {r} {b}" for a, b, r in scenario.triples()))
    return YES if found else NO


def compose(
    r: Annotated[str, typer.Argument(metavar="R", help="Relations, such as 'inside|coveredBy'.", show_default=False)],
    s: Annotated[str, typer.Argument(metavar="S", help="Relations.", show_default=False)],
    *,
    calculus: CalculusName = None,
    by_sat: Annotated[bool, typer.Option("--sat", help="Compute it from the model instead of looking it up.")] = False,
    as_json: AsJson = False,
) -> int:
    """Compose relations: what x R y and y S z leave for x and z."""
    found = _calculus(calculus or "rcc8")
    first, second = found.relation(r), found.relation(s)
    if by_sat:
        from ninefold.encodings import compose_by_sat

        mask = compose_by_sat(found, first, second)
    else:
        mask = found.compose(first, second)
    names = list(found.names(mask))
    _print({"relations": names}, " ".join(names), as_json=as_json)
    return YES


def _read(net: Path, calculus: str | None) -> "Network":
    from ninefold.io.networks.network_file import load_network

    with progress(f"reading {net}"):
        found = load_network(net, calculus=calculus)
    notes(found.notes)
    return found.network


def _calculus(name: str) -> Any:
    from ninefold.encodings import Calculus, calculus_named

    return Calculus.from_file(name) if name.endswith(".spec") else calculus_named(name)


def _print(report: dict[str, Any], text: str, *, as_json: bool) -> None:
    if as_json:
        print_json(report)
    else:
        print(text)


def _counts(network: "Network") -> str:
    return f"{counted(network.n_entities, 'entity', 'entities')}, {counted(network.n_statements, 'statement')}"


def _triples(scenario: "Scenario") -> list[list[str]]:
    return [list(triple) for triple in scenario.triples()]


def _stated(network: "Network", statements: "Iterable[Statement]") -> list[list[Any]]:
    return [[s.a, s.b, list(network.calculus.names(s.mask))] for s in statements]


def _spoken(network: "Network", s: "Statement") -> str:
    from ninefold.reasoner.networks.words import spoken

    return spoken(network.calculus, s)


def _mentioned(scenario: "Scenario | None", atoms: "Iterable[Any]") -> list[tuple[str, str, str]]:
    """Return the relations of the pairs that a formula speaks of."""
    if scenario is None:
        return []
    names = scenario.entities
    pairs = sorted({(atom.i, atom.j) for atom in atoms})
    return [(names[i], names[j], scenario.relation(names[i], names[j])) for i, j in pairs]


def _conflict(network: "Network", seed: int, budget: float | None) -> tuple[list[list[Any]], str]:
    """Return the statements of a conflict, and it and its derivation in words."""
    from ninefold.encodings.theory import theory_of
    from ninefold.reasoner.networks.conflicts import conflict
    from ninefold.reasoner.networks.explanation import explain

    with progress("seeking a minimal conflict"):
        found = conflict(network, seed=seed, budget=budget, known=True)
        if found is None:
            return [], ""
        kind = "minimal conflict"
        if not found.minimal and theory_of(network.calculus).closure_decides:
            kind = "conflict, perhaps not minimal since the budget is spent,"
        elif not found.minimal:
            kind = f"conflict, perhaps not minimal since nobody has shown that closure decides {network.calculus.name!r},"
        lines = [f"{kind} of {counted(len(found), 'statement')}:", *(f"  {_spoken(network, s)}" for s in found)]
        return _stated(network, found), "\n".join([*lines, *explain(found, seed=seed).lines])


def _proof_files(proof: Path | None, proof_format: str) -> list[Path]:
    """Return the files that a proof is written to: LOG, and for other checkers the formula it refutes."""
    from ninefold.errors import BadInput, UnknownName

    if proof_format not in PROOF_FORMATS:
        raise UnknownName("proof format", proof_format, PROOF_FORMATS)
    if proof is None:
        if proof_format != "native":
            raise BadInput(f"--proof-format {proof_format} needs --proof LOG, the file to write the proof to")
        return []
    if proof_format == "native":
        return [proof]
    if proof.suffix.lower() == ".cnf":
        raise BadInput(f"{proof}: the formula gets this name; give the proof another ending, such as .{proof_format}")
    return [proof, proof.with_suffix(".cnf")]


def _write_proof(network: "Network", proof: "Proof", proof_format: str, files: "Sequence[Path]", *, force: bool) -> None:
    from ninefold._files import published

    if proof_format == "native":
        with published(files[0], force=force) as temporary:
            temporary.write_text(proof.to_text(), encoding="ascii")
        note(f"wrote the proof {files[0]}; `prove` confirms it")
    else:
        from ninefold.reasoner.networks.clausal import to_drat

        to_drat(network, proof, lrat=proof_format == "lrat").write(*files, force=force)
        note(f"wrote the proof {files[0]} and the formula {files[1]} that it refutes")


def _draw(scenario: "Scenario", out: Path, *, title: str, force: bool) -> None:
    from ninefold._files import published
    from ninefold.layout.realization import realize
    from ninefold.layout.witness import witness_svg

    with progress("drawing"), published(out, force=force) as file:
        file.write_text(witness_svg(realize(scenario), title=title), encoding="utf-8")
