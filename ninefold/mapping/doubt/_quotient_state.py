"""The state of a search for quotients of a folded walk, as arrays; what is done with it is in ``_quotient_kernels``.

Columns have names below. Exit x of node n is ``n * K + x``, exit x of place w is ``w * K + x``. Angles are radians.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = [
    "BACK",
    "BEYOND",
    "BOTTOM",
    "CLOCKWISE",
    "CLOSED",
    "COMPONENT",
    "DEGREE",
    "DEGREE_OF_SIGN",
    "DEMAND",
    "DEPTH",
    "DONE",
    "EARLIEST",
    "ENDS",
    "ENTERED",
    "ENTERED_BY",
    "ENTERED_STUB",
    "FAILS",
    "FIRST",
    "GOING_DOWN",
    "GROUP",
    "HEADING",
    "HERE",
    "KIND",
    "KINDS",
    "KIND_OF_EXIT",
    "LACK",
    "LENGTH",
    "MATE",
    "MICRO",
    "MOST_PLACES",
    "NEXT",
    "NONE",
    "NOTHING",
    "N_DECISIONS",
    "N_FOUND",
    "N_PLACES",
    "N_TRAIL",
    "OTHER",
    "PLACE",
    "PLACED",
    "PLACES_BEFORE",
    "PLACE_OF_GROUP",
    "REFERENCE",
    "RELATIVE",
    "SEEN",
    "SHIFT",
    "SIDE",
    "SIGN",
    "SIGN_OF_PLACE",
    "STRICT",
    "STUB",
    "STUBS",
    "SURPLUS",
    "TOLERANCE",
    "TOP",
    "TRAIL_BEFORE",
    "TURN",
    "TURN_LEFT",
    "UNITS",
    "UNITS_LEFT",
    "WORK",
    "Quotient",
]

# columns of `node`
DEGREE, PLACE, SHIFT, NEXT, SIGN, UNITS, FAILS, GROUP = 0, 1, 2, 3, 4, 5, 6, 7
# columns of `way`
OTHER, BACK, KIND, LENGTH, BEYOND = 0, 1, 2, 3, 4
# columns of `angle` and `bearing`
HEADING, TURN = 0, 1
# columns of `place`: DEGREE, FIRST, SIGN_OF_PLACE, REFERENCE, EARLIEST
FIRST, SIGN_OF_PLACE, REFERENCE, EARLIEST = 1, 2, 3, 4
# columns of `exit`
MATE, KIND_OF_EXIT, SEEN, ENTERED, ENTERED_BY, CLOCKWISE = 0, 1, 2, 3, 4, 5
# columns of `group`
PLACED, PLACE_OF_GROUP = 0, 1
# columns of `balance`
HERE, SURPLUS, LACK = 0, 1, 2
# columns of `kind`
STUBS, ENDS, COMPONENT, SIDE = 0, 1, 2, 3
# columns of `sign`, kinds of its exits after them
UNITS_LEFT, DEMAND, DEGREE_OF_SIGN, KINDS = 0, 1, 2, 3
# rows of `number`
N_PLACES, N_TRAIL, TURN_LEFT, RELATIVE, CLOSED, STRICT, WORK = 0, 1, 2, 3, 4, 5, 6
# rows of `limit`
TOLERANCE, MOST_PLACES = 0, 1
# rows of `control`, how the search stands
DEPTH, TOP, GOING_DOWN, N_DECISIONS, N_FOUND, DONE = 0, 1, 2, 3, 4, 5
# columns of `frame`
STUB, BOTTOM, TRAIL_BEFORE, PLACES_BEFORE, ENTERED_STUB = 0, 1, 2, 3, 4

NONE = -1
NOTHING = -2
MICRO = 1e-6
"""Radians in a unit of `LENGTH` and `TURN_LEFT`, which are whole numbers so that they come back exactly."""


class Quotient(NamedTuple):
    """The tree of a walk and a quotient in the making: N nodes, at most P places, K exits each, C kinds, S signatures."""

    node: NDArray[np.int64]
    """(N, 8): degree; place, shift, next node of the same place; signature; places a node can stand in for; failures; group
    of nodes that must be one place, or -1."""
    way: NDArray[np.int64]
    """(N K, 5): other node, exit there, kind; microradians that its edge can turn; edges of the tree out that way."""
    angle: NDArray[np.float64]
    """(N K, 2): heading, net turn."""
    alike: NDArray[np.int64]
    """(N, N): shifts under which two nodes can be one, as bits."""
    place: NDArray[np.int64]
    """(P, 5): degree, first node of the list, signature, node whose exits it has, and its earliest node."""
    exit: NDArray[np.int64]
    """(P K, 6): mate or -1, kind, a mark, how many ways may enter here and the last of them, the next exit clockwise."""
    bearing: NDArray[np.float64]
    """(P K, 2): heading, net turn of the edge."""
    kind: NDArray[np.int64]
    """(C, 4): stubs, ends of walked ways not placed; component and side of kinds joined by ways, if they have two sides."""
    sign: NDArray[np.int64]
    """(S, 3 + K): units left, units needed, degree, kinds."""
    bend: NDArray[np.float64]
    """(S,): largest reflex turn of a place."""
    surplus: NDArray[np.int64]
    """(S, B): exits of one side beyond those of the other, per component."""
    number: NDArray[np.int64]
    """(7,): places, length of the trail, microradians that edges not placed can turn, flags; ends looked at so far."""
    limit: NDArray[np.float64]
    """(2,): tolerance, radians; most places."""
    trail: NDArray[np.int64]
    """(N,): nodes in the order placed."""
    group: NDArray[np.int64]
    """(G, 2): nodes placed of every group, and their place."""
    queue: NDArray[np.int64]
    """(Q, 3)."""
    stub: NDArray[np.int64]
    """(P K + 2,): stubs along a contour."""
    turned: NDArray[np.float64]
    """(P K + 2,): turn from the first stub to each of them."""
    option: NDArray[np.int64]
    """(P K + 2,): options of a stub."""
    balance: NDArray[np.int64]
    """(B, 3)."""
    start: NDArray[np.int64]
    """(N K + 1,): where the candidates of an exit begin."""
    candidate: NDArray[np.int64]
    """Exits of nodes that walk through an exit of a place that has this node's exits."""
