"""Proofs of inconsistency, and a checker that shares no code with the engine.

A proof is text. Its first line names the format, the calculus, the number of entities and a digest of the constraints; its
second the pairs that closure looks at, ``pairs all`` or ``pairs i-j i-j ...``. Then comes one learned clause a line, each
literal as ``i j mask`` ("the relation of i to j is within the mask"), ended by 0; the last line is the empty clause, a 0.

The checker takes each clause in turn, assumes that it is false, and refines labels by closure over triangles of the listed
pairs and by unit propagation over the clauses confirmed before. A label must become empty; then the clause follows, and may
be used from there on. So the empty clause follows from the constraints alone.

References
----------
E. Goldberg and Y. Novikov, "Verification of proofs of unsatisfiability for CNF formulas", DATE 2003 (reverse unit
propagation).
"""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ninefold._kernels import kernel
from ninefold._wording import quoted
from ninefold.errors import BadInput

from ._replay import TOP, append, arcs_of, assume, new_replay, propagate, state_labels, undo

if TYPE_CHECKING:
    from ._replay import Literal
    from .network import Network

__all__ = ["Proof", "check_subject", "digest_of", "prove"]

_MAGIC = "ninefold-proof 1"

_DIGITS = 18
"""Most digits of a number in a proof, which then fits a signed word."""


@dataclass(frozen=True, slots=True)
class Proof:
    """A refutation that can be checked.

    Attributes
    ----------
    calculus, n, digest
        What it is about: name of the calculus, number of entities, SHA-256 of the constraints.
    pairs
        Pairs (i, j), i < j, that closure looks at; None for all.
    clauses
        Learned clauses in order; the last is empty.
    """

    calculus: str
    n: int
    digest: str
    pairs: tuple[tuple[int, int], ...] | None = field(repr=False)
    clauses: tuple[tuple[Literal, ...], ...] = field(repr=False)

    def to_text(self) -> str:
        """Return the proof as text; see the module's page."""
        lines = [f"{_MAGIC} {self.calculus} {self.n} {self.digest}"]
        lines.append("pairs all" if self.pairs is None else " ".join(["pairs", *(f"{i}-{j}" for i, j in self.pairs)]))
        lines += [" ".join([*(f"{i} {j} {mask}" for i, j, mask in clause), "0"]) for clause in self.clauses]
        return "\n".join(lines) + "\n"

    @classmethod
    def from_text(cls, text: str) -> Proof:
        """Read a proof.

        Raises
        ------
        BadInput
            With the line that is not of the format.
        """
        lines = text.splitlines()
        head = lines[0].split() if lines else []
        if len(head) != 5 or " ".join(head[:2]) != _MAGIC or not _is_number(head[3]):
            raise BadInput(f"line 1: a proof begins with '{_MAGIC} CALCULUS N DIGEST', N a number below 10^{_DIGITS}")
        if len(lines) < 2 or not lines[1].startswith("pairs "):
            raise BadInput("line 2: 'pairs all' or 'pairs i-j ...' is missing")
        words, n = lines[1].split()[1:], int(head[3])
        pairs = None if words == ["all"] else tuple(_pair(word, n) for word in words)
        clauses = tuple(_clause(line, number, n) for number, line in enumerate(lines[2:], 3))
        return cls(head[2], n, head[4], pairs, clauses)


def digest_of(net: Network) -> str:
    """Return the SHA-256 of a network's calculus, size and constraints."""
    stated = net.constraints()
    rows = [f"{net.calculus.name} {net.n_entities}", *(f"{i} {j} {mask}" for i, j, mask in stated.triples())]
    return hashlib.sha256("\n".join(rows).encode()).hexdigest()


def check_subject(net: Network, proof: Proof) -> None:
    """Raise `BadInput` unless a proof is of this network, of its relations alone, and ends in the empty clause."""
    if proof.calculus != net.calculus.name or proof.n != net.n_entities or proof.digest != digest_of(net):
        raise BadInput("the proof is of another network: calculus, size or digest of the constraints differ")
    universal = net.calculus.universal
    for clause in proof.clauses:
        for i, j, mask in clause:
            if not 0 <= mask <= universal:
                raise BadInput(
                    f"the proof has the literal {i} {j} {mask}, but masks of {net.calculus.name} run from 0 to {universal}"
                )
    if not proof.clauses or proof.clauses[-1]:
        raise BadInput("the proof does not end in the empty clause, so it proves nothing")


def prove(net: Network, proof: Proof) -> None:
    """Confirm a proof that a network is inconsistent.

    Raises
    ------
    BadInput
        If the proof is of another network, does not end in the empty clause, or holds a clause that does not follow.

    Notes
    -----
    Each clause costs one closure from what the constraints give. Nothing of the engine is used (see
    `ninefold.reasoner.networks._replay`).

    Examples
    --------
    >>> from ninefold.reasoner.networks.consistency import check
    >>> from ninefold.reasoner.networks.network import Network
    >>> net = Network("rcc8")
    >>> for a, b, r in [("kitchen", "house", "inside"), ("house", "garden", "disjoint"), ("kitchen", "garden", "meet")]:
    ...     _ = net.add(a, b, r)
    >>> prove(net, check(net, proof=True).proof)
    """
    check_subject(net, proof)
    stated, full = net.constraints().triples(), net.calculus.universal
    replay = new_replay(net.calculus, net.n_entities, proof.pairs, stated, proof.clauses)
    work = 10 * len(replay.head) * len(proof.clauses)
    if not start.for_work(work)(replay, *arcs_of(replay, stated)):
        return
    follows = confirm.for_work(work)
    for number, clause in enumerate(proof.clauses):
        outcome = follows(replay, number, full)
        if not outcome:
            shown = "the empty clause" if not clause else " ".join(map(str, clause[0])) + (" ..." if len(clause) > 1 else "")
            raise BadInput(
                f"clause {number + 1} of {len(proof.clauses)} ({shown}) does not follow from what was confirmed before"
            )
        if outcome == 3:
            return


@kernel(compile_seconds=1.0, _nrt=False)
def start(s, arcs, masks):  # type: ignore[no-untyped-def]
    """State the constraints and close them; return False when a label runs empty, and then everything follows."""
    return state_labels(s, arcs, masks) and propagate(s)


@kernel(compile_seconds=1.0, _nrt=False)
def confirm(s, clause, full):  # type: ignore[no-untyped-def]
    """Say of a clause whether it follows (bit 0), and take it up: whether everything follows from here on (bit 1)."""
    level = s.reg[TOP]
    if assume(s, clause, full):
        undo(s, level)
        return 0
    undo(s, level)
    return 1 if append(s, clause) else 3


def _is_number(word: str) -> bool:
    """Tell whether a word is a whole number of a size that occurs; Python reads no more than 4,300 digits."""
    return word.isascii() and word.isdecimal() and len(word) <= _DIGITS


def _pair(word: str, n: int) -> tuple[int, int]:
    i, dash, j = word.partition("-")
    if not (dash and _is_number(i) and _is_number(j) and int(i) != int(j) and max(int(i), int(j)) < n):
        raise BadInput(f"line 2: {quoted(word)} is no pair of entities below {n}")
    return int(i), int(j)


def _clause(line: str, number: int, n: int) -> tuple[Literal, ...]:
    words = line.split()
    if not words or words[-1] != "0" or len(words) % 3 != 1:
        raise BadInput(f"line {number}: a clause is triples 'i j mask', ended by 0")
    for word in words:
        if not _is_number(word):
            raise BadInput(f"line {number}: {quoted(word)} is no number below 10^{_DIGITS}")
    values = list(map(int, words[:-1]))
    literals = tuple(zip(values[0::3], values[1::3], values[2::3], strict=True))
    if any(i >= n or j >= n or i == j for i, j, _ in literals):
        raise BadInput(f"line {number}: a pair that is not of two entities below {n}")
    return literals
