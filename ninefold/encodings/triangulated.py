"""The support encoding on a chordal graph: only the triangles of a triangulation are encoded.

The constrained pairs are completed to a chordal graph. An atomic network on it whose triangles are all possible is
consistent as soon as atomic networks that agree on a common part can be patched together, as in RCC-8, RCC-5, the point
algebra and Allen's; pairs outside the graph then need no variable. On sparse networks that saves nearly everything.

Examples
--------
>>> from ninefold.encodings import RCC8, encode_support, encode_triangulated
>>> ring = [(i, (i + 1) % 9, RCC8.relation("EC PO")) for i in range(9)]
>>> len(encode_support(RCC8, 9, ring).clauses), len(encode_triangulated(RCC8, 9, ring).clauses)
(3471, 277)

References
----------
J. J. Li, J. Huang and J. Renz, "A divide-and-conquer approach for solving interval algebra networks", IJCAI 2009.
M. Sioutis and M. Koubarakis, "Consistency of chordal RCC-8 networks", ICTAI 2012.
J. Huang, "Compactness and its implications for qualitative spatial and temporal reasoning", KR 2012, for patchwork.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .encoding import Constraint, Encoding, Labels, label_matrix
from .orders import triangulate
from .support import support_clauses

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .calculus import Calculus

__all__ = ["encode_triangulated"]


def encode_triangulated(
    calculus: Calculus, n: int, constraints: Iterable[Constraint], *, order: str = "min-fill"
) -> Encoding:
    """Encode a network by support on a chordal completion of its constrained pairs.

    Parameters
    ----------
    order
        Elimination order, one of `ninefold.encodings.orders.ORDERS`.

    Notes
    -----
    The decoded scenario covers the edges of the chordal graph. It extends to all pairs where the calculus has the
    patchwork property.

    Complexity
    ----------
    O(t b^2) clauses for t triangles and b base relations.
    """
    given = label_matrix(calculus, n, constraints)
    chordal = triangulate(n, given, order)
    labels = Labels(calculus, {edge: given.get(edge, calculus.universal) for edge in chordal.edges})
    clauses = [*labels.exactly_one(), *support_clauses(labels, chordal.triangles)]
    return Encoding("triangulated", calculus, n, len(labels.variables), tuple(clauses), labels.variables, labels.decode)
