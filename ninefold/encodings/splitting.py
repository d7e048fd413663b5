"""Splitting into a tractable subclass: Horn clauses for everything but the choice between parts of a label.

What composition says of three regions is a handful of Horn clauses over atoms of pairs (`ninefold.encodings.horn`), and a
label that belongs to the subclass of that theory (H8 of RCC-8, H5 of RCC-5) is Horn clauses too. Every other label is
split into its parts in the subclass, with one selector a part: once the selectors are chosen, unit propagation alone
decides.

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

from functools import cache
from itertools import combinations, permutations
from typing import TYPE_CHECKING

from ninefold._wording import quoted
from ninefold.errors import BadInput

from .encoding import Clause, Constraint, Encoding, label_matrix
from .orders import triangulate
from .theory import theory_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from .calculus import Calculus
    from .horn import HornTheory

__all__ = ["encode_splitting"]


def encode_splitting(calculus: Calculus, n: int, constraints: Iterable[Constraint], *, order: str | None = None) -> Encoding:
    """Encode a network by Horn clauses and, where a label is outside the subclass, a choice between its parts.

    Parameters
    ----------
    calculus
        One with a Horn theory (see `ninefold.encodings.theory`): RCC-8 or RCC-5.
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
    known = theory_of(calculus).horn
    if known is None:
        name = quoted(calculus.name)
        raise BadInput(f"no Horn theory of {name} is known, only of rcc8 and rcc5: use another encoding")
    theory = known.value
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
                signed = _definition(theory, k)
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
            for body, head in _horn_label(theory, part):
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
def _horn_label(theory: HornTheory, mask: int) -> tuple[tuple[tuple[str, ...], str | None], ...]:
    """Return Horn clauses (body, head) that hold for the base relations in a mask of the subclass, and for no other.

    For a base relation outside, the atoms that it shows are the body. The members that show all of these have
    a meet in the mask, which is not that base relation, so it shows a further atom: the head; without such members
    there is none.
    """
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
def _definition(theory: HornTheory, base: int) -> tuple[tuple[str, bool], ...]:
    """Return signed atoms that tell a base relation from all others, as few as leaving them out one by one gives."""
    signed = [(name, name in theory.meaning[base]) for name in theory.atoms]
    for literal in list(signed):
        rest = [other for other in signed if other != literal]
        alike = [k for k, held in enumerate(theory.meaning) if all((name in held) == sign for name, sign in rest)]
        if alike == [base]:
            signed = rest
    return tuple(signed)
