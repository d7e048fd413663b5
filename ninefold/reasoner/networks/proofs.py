"""Proofs of inconsistency, and a checker in plain Python that shares no code with the engine.

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
from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ninefold.errors import BadInput

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ninefold.encodings.calculus import Calculus

    from .network import Network

__all__ = ["Proof", "prove"]

Literal = tuple[int, int, int]

_MAGIC = "ninefold-proof 1"


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
        if len(head) != 5 or " ".join(head[:2]) != _MAGIC or not head[3].isdecimal():
            raise BadInput(f"line 1: a proof begins with '{_MAGIC} CALCULUS N DIGEST'")
        if len(lines) < 2 or not lines[1].startswith("pairs "):
            raise BadInput("line 2: 'pairs all' or 'pairs i-j ...' is missing")
        words = lines[1].split()[1:]
        pairs = None if words == ["all"] else tuple(_pair(word, int(head[3])) for word in words)
        clauses = tuple(_clause(line, number, int(head[3])) for number, line in enumerate(lines[2:], 3))
        return cls(head[2], int(head[3]), head[4], pairs, clauses)


def digest_of(net: Network) -> str:
    """Return the SHA-256 of a network's calculus, size and constraints."""
    stated = net.constraints()
    rows = [f"{net.calculus.name} {net.n_entities}", *(f"{i} {j} {mask}" for i, j, mask in stated.triples())]
    return hashlib.sha256("\n".join(rows).encode()).hexdigest()


def prove(net: Network, proof: Proof) -> None:
    """Confirm a proof that a network is inconsistent.

    Raises
    ------
    BadInput
        If the proof is of another network, does not end in the empty clause, or holds a clause that does not follow.

    Notes
    -----
    Plain Python, meant to be read: each clause costs one closure from what the constraints give.

    Examples
    --------
    >>> from ninefold.reasoner.networks.consistency import check
    >>> from ninefold.reasoner.networks.network import Network
    >>> net = Network("rcc8")
    >>> for a, b, r in [("kitchen", "house", "inside"), ("house", "garden", "disjoint"), ("kitchen", "garden", "meet")]:
    ...     _ = net.add(a, b, r)
    >>> prove(net, check(net, proof=True).proof)
    """
    if proof.calculus != net.calculus.name or proof.n != net.n_entities or proof.digest != digest_of(net):
        raise BadInput("the proof is of another network: calculus, size or digest of the constraints differ")
    if not proof.clauses or proof.clauses[-1]:
        raise BadInput("the proof does not end in the empty clause, so it proves nothing")
    checker = _Checker(net.calculus, net.n_entities, proof.pairs, net.constraints().triples())
    for number, clause in enumerate(proof.clauses, 1):
        if not checker.follows(clause):
            shown = "the empty clause" if not clause else " ".join(map(str, clause[0])) + (" ..." if len(clause) > 1 else "")
            raise BadInput(
                f"clause {number} of {len(proof.clauses)} ({shown}) does not follow from what was confirmed before"
            )
        checker.keep(clause)


class _Checker:
    """Labels of pairs, refined by closure and by clauses, with an undo trail."""

    def __init__(
        self,
        calculus: Calculus,
        n: int,
        pairs: tuple[tuple[int, int], ...] | None,
        constraints: Iterable[tuple[int, int, int]],
    ) -> None:
        self._calculus = calculus
        self._near: list[set[int]] = [set() for _ in range(n)]
        self._label: dict[tuple[int, int], int] = {}
        self._clauses: list[tuple[Literal, ...]] = []
        self._at: dict[tuple[int, int], list[int]] = {}
        self._trail: list[tuple[int, int, int]] = []
        self._queue: deque[tuple[int, int]] = deque()
        triples = list(constraints)
        kept = [(i, j) for i in range(n) for j in range(i)] if pairs is None else [*pairs, *((i, j) for i, j, _ in triples)]
        for i, j in kept:
            self._near[i].add(j)
            self._near[j].add(i)
            self._label[i, j] = self._label[j, i] = calculus.universal
        self._holds = all(self._refine(i, j, mask) for i, j, mask in triples) and self._propagate()

    def follows(self, clause: Sequence[Literal]) -> bool:
        """Say whether assuming every literal false empties a label."""
        if not self._holds:
            return True
        level = len(self._trail)
        universal = self._calculus.universal
        fine = all(self._refine(i, j, universal & ~mask) for i, j, mask in clause) and self._propagate()
        self._queue.clear()
        while len(self._trail) > level:
            i, j, mask = self._trail.pop()
            self._label[i, j], self._label[j, i] = mask, self._calculus.converse_of(mask)
        return not fine

    def keep(self, clause: tuple[Literal, ...]) -> None:
        """Use a confirmed clause from here on."""
        self._clauses.append(clause)
        for i, j, _ in clause:
            self._at.setdefault((min(i, j), max(i, j)), []).append(len(self._clauses) - 1)
        self._holds = self._holds and self._unit(clause) and self._propagate()

    def _refine(self, i: int, j: int, mask: int) -> bool:
        """Intersect the label of a pair; False if nothing is left."""
        old = self._label.get((i, j))
        if old is None:
            raise BadInput(f"a clause is about the pair {i}, {j}, which is not among the proof's pairs")
        new = old & mask
        if new != old:
            self._trail.append((i, j, old))
            self._label[i, j], self._label[j, i] = new, self._calculus.converse_of(new)
            self._queue.append((i, j))
        return new != 0

    def _propagate(self) -> bool:
        compose, label = self._calculus.compose, self._label
        while self._queue:
            i, j = self._queue.popleft()
            for k in self._near[i] & self._near[j]:
                if not self._refine(i, k, compose(label[i, j], label[j, k])):
                    return False
                if not self._refine(k, j, compose(label[k, i], label[i, j])):
                    return False
            for number in self._at.get((min(i, j), max(i, j)), ()):
                if not self._unit(self._clauses[number]):
                    return False
        return True

    def _unit(self, clause: tuple[Literal, ...]) -> bool:
        """Refine by the only literal that can still hold; False if none can."""
        open_literal = None
        for i, j, mask in clause:
            if self._label[i, j] & mask:
                if open_literal is not None:
                    return True
                open_literal = (i, j, mask)
        return open_literal is not None and self._refine(*open_literal)


def _pair(word: str, n: int) -> tuple[int, int]:
    i, dash, j = word.partition("-")
    if not (dash and i.isdecimal() and j.isdecimal() and int(i) != int(j) and max(int(i), int(j)) < n):
        raise BadInput(f"line 2: {word!r} is no pair of entities below {n}")
    return int(i), int(j)


def _clause(line: str, number: int, n: int) -> tuple[Literal, ...]:
    words = line.split()
    if not words or words[-1] != "0" or len(words) % 3 != 1 or not all(word.isdecimal() for word in words):
        raise BadInput(f"line {number}: a clause is triples 'i j mask', ended by 0")
    values = list(map(int, words[:-1]))
    literals = tuple(zip(values[0::3], values[1::3], values[2::3], strict=True))
    if any(i >= n or j >= n or i == j for i, j, _ in literals):
        raise BadInput(f"line {number}: a pair that is not of two entities below {n}")
    return literals
