"""The direct encoding: a clause for every triple of base relations that no three entities can show.

Complete graph: a variable a pair and base relation, exactly one a pair; a conflict clause for a on (i, j), b on (j, k)
and every c outside ``a;b`` on (i, k). A model is an atomic network closed under composition, so the encoding is sound
where such networks are consistent, as they are in RCC-8, RCC-5, the point algebra and Allen's.

Examples
--------
>>> from ninefold.encodings import RCC8, encode_direct
>>> inside, disjoint, meet = map(RCC8.relation, ("inside", "disjoint", "meet"))
>>> encoding = encode_direct(RCC8, 3, [(0, 1, inside), (1, 2, disjoint), (0, 2, meet)])
>>> encoding.clauses
((1,), (2,), (3,), (-1, -3, -2))

References
----------
D. N. Pham, J. Thornton and A. Sattar, "Towards an efficient SAT encoding for temporal reasoning", CP 2006, section 4.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

from .encoding import Clause, Constraint, Encoding, Labels, label_matrix

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .calculus import Calculus

__all__ = ["encode_direct"]


def encode_direct(calculus: Calculus, n: int, constraints: Iterable[Constraint]) -> Encoding:
    """Encode a network by its forbidden triples.

    Complexity
    ----------
    O(n^3 b^3) clauses of three literals for b base relations.
    """
    given = label_matrix(calculus, n, constraints)
    universal = calculus.universal
    labels = Labels(calculus, {pair: given.get(pair, universal) for pair in combinations(range(n), 2)})
    clauses: list[Clause] = labels.exactly_one()
    composition = calculus.base_composition.tolist()
    for i, j, k in combinations(range(n), 3):
        whole = labels.bases(i, k)
        for a, x in labels.bases(i, j):
            for b, y in labels.bases(j, k):
                possible = composition[a][b]
                clauses.extend((-x, -y, -z) for c, z in whole if not possible >> c & 1)
    return Encoding("direct", calculus, n, len(labels.variables), tuple(clauses), labels.variables, labels.decode)
