"""The support encoding: a clause for every pair of base relations on two sides of a triangle.

Complete graph: a variable a pair and base relation, exactly one a pair; for a on (i, j) and b on (j, k) one clause
says that some base relation of ``a;b`` holds on (i, k). Models are those of the direct encoding, with fewer clauses
and, on these, stronger unit propagation.

Examples
--------
>>> from ninefold.encodings import RCC8, encode_support
>>> inside, disjoint, meet = map(RCC8.relation, ("inside", "disjoint", "meet"))
>>> encode_support(RCC8, 3, [(0, 1, inside), (1, 2, disjoint), (0, 2, meet)]).clauses
((1,), (2,), (3,), (-1, -3))

References
----------
I. P. Gent, "Arc consistency in SAT", ECAI 2002.
D. N. Pham, J. Thornton and A. Sattar, "Towards an efficient SAT encoding for temporal reasoning", CP 2006, section 4.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

from .encoding import Clause, Constraint, Encoding, Labels, label_matrix

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .calculus import Calculus

__all__ = ["encode_support", "support_clauses"]


def encode_support(calculus: Calculus, n: int, constraints: Iterable[Constraint]) -> Encoding:
    """Encode a network by what supports what; sound where `ninefold.encodings.direct` is.

    Complexity
    ----------
    O(n^3 b^2) clauses of up to b + 2 literals for b base relations.
    """
    given = label_matrix(calculus, n, constraints)
    universal = calculus.universal
    labels = Labels(calculus, {pair: given.get(pair, universal) for pair in combinations(range(n), 2)})
    clauses = [*labels.exactly_one(), *support_clauses(labels, combinations(range(n), 3))]
    return Encoding("support", calculus, n, len(labels.variables), tuple(clauses), labels.variables, labels.decode)


def support_clauses(labels: Labels, triangles: Iterable[tuple[int, int, int]]) -> list[Clause]:
    """Return the support clauses of triangles i < j < k, all three pairs of which have labels."""
    composition = labels.calculus.base_composition.tolist()
    clauses: list[Clause] = []
    for i, j, k in triangles:
        whole = labels.bases(i, k)
        label = labels.labels[i, k]
        for a, x in labels.bases(i, j):
            for b, y in labels.bases(j, k):
                possible = composition[a][b] & label
                if possible != label:
                    clauses.append((-x, -y, *(z for c, z in whole if possible >> c & 1)))
    return clauses
