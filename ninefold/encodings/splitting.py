"""Splitting into a tractable subclass: Horn clauses for everything but the choice between parts of a label.

Six atoms describe a pair of regions (x, y): contact C, overlap O, part P(x, y) and P(y, x), inner part N(x, y) and
N(y, x). The base relations are the truth assignments

====  ====  ====  ===============  ========================  ======================
DC    EC    PO    TPP              NTPP                      EQ
none  C     C, O  C, O, P(x, y)    C, O, P(x, y), N(x, y)    C, O, P(x, y), P(y, x)
====  ====  ====  ===============  ========================  ======================

and the converses. What composition says of three regions is a handful of Horn clauses over these atoms ("a part of a
part is a part", ...), and the labels that Horn clauses can express, those closed under taking the atoms two members
have in common, are exactly H8. Every other label is split into its parts in H8, with one selector a part: once the
selectors are chosen, unit propagation alone decides. RCC-5 is the same without boundaries (O and P only).

Examples
--------
>>> from ninefold.encodings import RCC8, encode_splitting
>>> both = [(0, 1, RCC8.relation("DC TPP")), (1, 2, RCC8.relation("NTPP EQ"))]
>>> encode_splitting(RCC8, 3, both).n_vars  # 3 * 6 atoms, 2 + 2 + 8 base relations; selectors for NTPP or EQ
32

References
----------
M. Westphal and J. Hue, "A concise Horn theory for RCC8", ECAI 2014.
J. Renz and B. Nebel, "On the complexity of qualitative spatial reasoning: a maximal tractable fragment of the region
connection calculus", Artificial Intelligence 108, 1999, for H8.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import combinations, permutations
from typing import TYPE_CHECKING

from ninefold._wording import quoted
from ninefold.errors import BadInput

from .encoding import Clause, Constraint, Encoding, label_matrix
from .orders import triangulate
from .rcc8 import RCC5, RCC8
from .subclasses import H5, H8, Subclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from .calculus import Calculus

__all__ = ["HORN_THEORIES", "HornTheory", "encode_splitting"]


@dataclass(frozen=True, slots=True)
class HornTheory:
    """Atoms over pairs of entities in which composition and a subclass of labels are Horn.

    Parameters
    ----------
    calculus, subclass
        What it is a theory of, and the labels that it expresses.
    atoms
        For every atom the one that says the same of (y, x): itself if it is symmetric.
    meaning
        For every base relation, in the order of the bits, the atoms that hold.
    pair_rules
        Horn clauses over one pair: atoms that cannot hold without the last, or (last None) together.
    triangle_rules
        ``(p, q, r)``: p of (x, y) and q of (y, z) give r of (x, z).
    """

    calculus: Calculus
    subclass: Subclass
    atoms: dict[str, str]
    meaning: tuple[frozenset[str], ...]
    pair_rules: tuple[tuple[tuple[str, ...], str | None], ...]
    triangle_rules: tuple[tuple[str, str, str], ...]


_ATOMS8 = {"C": "C", "O": "O", "P": "Pi", "Pi": "P", "N": "Ni", "Ni": "N"}
_ATOMS5 = {"O": "O", "P": "Pi", "Pi": "P"}

_RCC8_THEORY = HornTheory(
    calculus=RCC8,
    subclass=H8,
    atoms=_ATOMS8,
    meaning=tuple(
        map(frozenset, ([], ["C"], "CO", "COP", "COPN", ["C", "O", "Pi"], ["C", "O", "Pi", "Ni"], ["C", "O", "P", "Pi"]))
    ),
    pair_rules=(
        (("N",), "P"),
        (("Ni",), "Pi"),
        (("P",), "O"),
        (("Pi",), "O"),
        (("O",), "C"),
        (("N", "Pi"), None),
        (("P", "Ni"), None),
    ),
    triangle_rules=(
        ("C", "P", "C"),
        ("O", "P", "O"),
        ("P", "P", "P"),
        ("N", "P", "N"),
        ("P", "N", "N"),
        ("C", "N", "O"),
    ),
)

_RCC5_THEORY = HornTheory(
    calculus=RCC5,
    subclass=H5,
    atoms=_ATOMS5,
    meaning=tuple(map(frozenset, ([], ["O"], ["O", "P"], ["O", "Pi"], ["O", "P", "Pi"]))),
    pair_rules=((("P",), "O"), (("Pi",), "O")),
    triangle_rules=(("O", "P", "O"), ("P", "P", "P")),
)

HORN_THEORIES = {"rcc8": _RCC8_THEORY, "rcc5": _RCC5_THEORY}
"""The calculi that can be split, by name."""


def encode_splitting(calculus: Calculus, n: int, constraints: Iterable[Constraint], *, order: str | None = None) -> Encoding:
    """Encode a network by Horn clauses and, where a label is outside the subclass, a choice between its parts.

    Parameters
    ----------
    calculus
        RCC-8 or RCC-5.
    order
        Elimination order for a chordal completion (see `ninefold.encodings.orders`); None encodes the complete graph.

    Raises
    ------
    BadInput
        A calculus without a theory here.

    Complexity
    ----------
    36 clauses of three literals a triangle for RCC-8, 12 for RCC-5.
    """
    theory = HORN_THEORIES.get(calculus.name)
    if theory is None or theory.calculus != calculus:
        known = " and ".join(HORN_THEORIES)
        raise BadInput(f"no Horn theory of {quoted(calculus.name)} is known, only of {known}: use another encoding")
    given = label_matrix(calculus, n, constraints)
    triangles: Iterable[tuple[int, int, int]]
    if order is None:
        edges: Sequence[tuple[int, int]] = list(combinations(range(n), 2))
        triangles = combinations(range(n), 3)
    else:
        chordal = triangulate(n, given, order)
        edges, triangles = chordal.edges, chordal.triangles

    atom: dict[tuple[str, int, int], int] = {}
    n_atoms = 0
    for i, j in edges:
        for name in theory.atoms:
            n_atoms += 1
            atom[name, i, j] = atom[theory.atoms[name], j, i] = n_atoms
    clauses: list[Clause] = []
    for i, j in edges:
        for body, head in theory.pair_rules:
            clauses.append((*(-atom[name, i, j] for name in body), *(() if head is None else (atom[head, i, j],))))
    for triangle in triangles:
        for x, y, z in permutations(triangle):
            clauses.extend((-atom[p, x, y], -atom[q, y, z], atom[r, x, z]) for p, q, r in theory.triangle_rules)

    variables: dict[tuple[int, int, int], int] = {}
    n_vars = n_atoms
    for i, j in edges:
        mask = given.get((i, j), calculus.universal)
        for k in range(calculus.n_bases):
            if mask >> k & 1:
                n_vars += 1
                variables[i, j, k] = n_vars
                signed = _definition(theory.calculus.name, k)
                literals = [atom[name, i, j] if sign else -atom[name, i, j] for name, sign in signed]
                clauses.extend((-n_vars, literal) for literal in literals)
                clauses.append((n_vars, *(-literal for literal in literals)))
        if not mask:
            clauses.append(())
            continue
        parts = theory.subclass.split(mask)
        selectors: list[int] = []
        for part in parts:
            guard: Clause = ()
            if len(parts) > 1:
                n_vars += 1
                selectors.append(n_vars)
                guard = (-n_vars,)
            for body, head in _horn_label(theory.calculus.name, part):
                clauses.append(
                    (*guard, *(-atom[name, i, j] for name in body), *(() if head is None else (atom[head, i, j],)))
                )
        if selectors:
            clauses.append(tuple(selectors))

    def decode(model: Sequence[int]) -> dict[tuple[int, int], int]:
        true = {literal for literal in model if literal > 0}
        base = {held: k for k, held in enumerate(theory.meaning)}
        return {(i, j): 1 << base[frozenset(name for name in theory.atoms if atom[name, i, j] in true)] for i, j in edges}

    return Encoding("splitting", calculus, n, n_vars, tuple(clauses), variables, decode)


@cache
def _horn_label(calculus: str, mask: int) -> tuple[tuple[tuple[str, ...], str | None], ...]:
    """Return Horn clauses (body, head) that hold for the base relations in a mask of the subclass, and for no other.

    For a base relation outside, the atoms that it shows are the body. The members that show all of these have
    a meet in the mask, which is not that base relation, so it shows a further atom: the head; without such members
    there is none.
    """
    theory = HORN_THEORIES[calculus]
    members = [held for k, held in enumerate(theory.meaning) if mask >> k & 1]
    rules: list[tuple[tuple[str, ...], str | None]] = []
    for k, outside in enumerate(theory.meaning):
        if mask >> k & 1:
            continue
        if any(set(body) <= outside and head not in outside for body, head in rules):
            continue  # a clause for another one excludes it already
        above = [held for held in members if held >= outside]
        head = min(frozenset.intersection(*above) - outside, key=list(theory.atoms).index) if above else None
        body = set(outside)
        for name in theory.atoms:  # fewest atoms that still imply the head among the members
            fewer = body - {name}
            if name in body and all(head in held for held in members if held >= fewer):
                body = fewer
        rules.append((tuple(sorted(body)), head))
    return tuple(rules)


@cache
def _definition(calculus: str, base: int) -> tuple[tuple[str, bool], ...]:
    """Return signed atoms that tell a base relation from all others, as few as leaving them out one by one gives."""
    theory = HORN_THEORIES[calculus]
    signed = [(name, name in theory.meaning[base]) for name in theory.atoms]
    for literal in list(signed):
        rest = [other for other in signed if other != literal]
        alike = [k for k, held in enumerate(theory.meaning) if all((name in held) == sign for name, sign in rest)]
        if alike == [base]:
            signed = rest
    return tuple(signed)
