"""A sweep that finds out whether straight pieces meet off their ends, in O(S log S) whatever the degrees and boxes.

A line moves over the plane from west to east (south to north where two nodes have one x) and stops at every node. The
pieces it crosses are kept in their order along it; only pieces that become neighbours in that order are compared. If any
two pieces meet off their common ends, the westernmost such place is found that way (Shamos and Hoey 1976). The order is a
treap, threaded as a list, and every comparison is the exact sign of a turn.

References
----------
M. I. Shamos and D. Hoey, Geometric intersection problems, FOCS 1976. J. R. Shewchuk, Adaptive precision floating-point
arithmetic and fast robust geometric predicates, 1997. C. R. Aragon and R. Seidel, Randomized search trees, FOCS 1989.
"""

from __future__ import annotations

import numpy as np

from ninefold._kernels import kernel

__all__ = ["NOTHING", "ON_PIECE", "PIECES", "sweep", "turn"]

NOTHING, PIECES, ON_PIECE = 0, 1, 2
"""What `sweep` found: no meeting, two pieces that meet off their ends, a node on a piece."""

LEFT, RIGHT, UP, NEXT, PREVIOUS, PRIORITY = range(6)
"""Rows of the table that holds the treap. The last column is a sentinel: over the root, before the first, after the last."""


@kernel
def turn(xy, a, b, c):  # type: ignore[no-untyped-def]
    """Return the exact sign of the turn a -> b -> c (rows of xy, float64): 1.0 counter-clockwise, -1.0 clockwise, 0.0 level.

    Shewchuk's filter settles nearly all; the rest is summed without rounding, as an expansion of at most 12 terms. (Products
    below the smallest double are lost: coordinates must not differ by factors beyond 1e300.)
    """
    one = (xy[b, 0] - xy[a, 0]) * (xy[c, 1] - xy[a, 1])
    two = (xy[b, 1] - xy[a, 1]) * (xy[c, 0] - xy[a, 0])
    det = one - two
    if abs(det) > 4e-16 * (abs(one) + abs(two)):
        return 1.0 if det > 0 else -1.0
    terms = np.zeros(12)
    used = 0
    for k in range(6):  # b x c + c x a + a x b
        i = b if k < 2 else c if k < 4 else a
        j = c if k < 2 else a if k < 4 else b
        side = k % 2
        p = xy[i, side]
        q = xy[j, 1 - side] if side == 0 else -xy[j, 1 - side]
        product = p * q
        big = 134217729.0 * p
        p_high = big - (big - p)
        p_low = p - p_high
        big = 134217729.0 * q
        q_high = big - (big - q)
        q_low = q - q_high
        rest = p_low * q_low - (((product - p_high * q_high) - p_low * q_high) - p_high * q_low)
        for part in range(2):
            total = rest if part == 0 else product
            for m in range(used):
                term = terms[m]
                added = total + term
                back = added - total
                terms[m] = (total - (added - back)) + (term - back)
                total = added
            terms[used] = total
            used += 1
    for m in range(used - 1, -1, -1):
        if terms[m] != 0.0:
            return 1.0 if terms[m] > 0 else -1.0
    return 0.0


@kernel
def rotate_up(tree, s):  # type: ignore[no-untyped-def]
    """Let a node of the treap and its parent change places, keeping the order."""
    p = tree[UP, s]
    g = tree[UP, p]
    if tree[LEFT, p] == s:
        c = tree[RIGHT, s]
        tree[LEFT, p] = c
        tree[RIGHT, s] = p
    else:
        c = tree[LEFT, s]
        tree[RIGHT, p] = c
        tree[LEFT, s] = p
    if c >= 0:
        tree[UP, c] = p
    tree[UP, p] = s
    tree[UP, s] = g
    if tree[LEFT, g] == p:
        tree[LEFT, g] = s
    else:
        tree[RIGHT, g] = s


@kernel
def insert_after(tree, p, s):  # type: ignore[no-untyped-def]
    """Put s next above p; the sentinel for p puts it lowest."""
    end = tree.shape[1] - 1
    q = tree[NEXT, p]
    tree[NEXT, p] = s
    tree[PREVIOUS, s] = p
    tree[NEXT, s] = q
    tree[PREVIOUS, q] = s
    tree[LEFT, s] = -1
    tree[RIGHT, s] = -1
    if p != end and tree[RIGHT, p] < 0:
        tree[RIGHT, p] = s
        tree[UP, s] = p
    else:  # the node next above p, or the sentinel of an empty treap, has nothing on its left
        tree[LEFT, q] = s
        tree[UP, s] = q
    while tree[UP, s] != end and tree[PRIORITY, tree[UP, s]] < tree[PRIORITY, s]:
        rotate_up(tree, s)


@kernel
def remove(tree, s):  # type: ignore[no-untyped-def]
    """Take s out of the treap and the list."""
    while tree[LEFT, s] >= 0 and tree[RIGHT, s] >= 0:
        low = tree[LEFT, s]
        high = tree[RIGHT, s]
        rotate_up(tree, low if tree[PRIORITY, low] > tree[PRIORITY, high] else high)
    c = tree[LEFT, s] if tree[LEFT, s] >= 0 else tree[RIGHT, s]
    p = tree[UP, s]
    if tree[LEFT, p] == s:
        tree[LEFT, p] = c
    else:
        tree[RIGHT, p] = c
    if c >= 0:
        tree[UP, c] = p
    tree[NEXT, tree[PREVIOUS, s]] = tree[NEXT, s]
    tree[PREVIOUS, tree[NEXT, s]] = tree[PREVIOUS, s]


@kernel
def meet(xy, low, high, e, f):  # type: ignore[no-untyped-def]
    """Say whether two pieces that the line crosses at one time meet elsewhere than at a common end."""
    if low[e] == low[f]:
        return turn(xy, low[e], high[e], high[f]) == 0.0
    if high[e] == high[f]:
        return turn(xy, high[e], low[e], low[f]) == 0.0
    across = turn(xy, low[e], high[e], low[f]) * turn(xy, low[e], high[e], high[f])
    if across > 0:
        return False
    return turn(xy, low[f], high[f], low[e]) * turn(xy, low[f], high[f], high[e]) <= 0


@kernel
def sweep(xy, low, high, leave, arriving, arrive):  # type: ignore[no-untyped-def]
    """Sweep over nodes and straight pieces and stop at the first meeting off the ends.

    Parameters: xy (N, 2) float64, the nodes from west to east, no two alike; low and high (S,), the western and the eastern
    node of each piece; pieces leave[v] to leave[v + 1] have v for their western node, counter-clockwise from south; pieces
    arriving[arrive[v] : arrive[v + 1]] have it for their eastern node.

    Returns (kind, i, j): NOTHING, -1, -1; or PIECES and the two; or ON_PIECE, the node and the piece.
    """
    end = low.size
    tree = np.full((6, end + 1), -1, np.int64)
    tree[NEXT, end] = end
    tree[PREVIOUS, end] = end
    number = 12345
    for s in range(end):
        number = (number * 1103515245 + 12345) % 2147483648
        tree[PRIORITY, s] = number
    for v in range(xy.shape[0]):
        count = arrive[v + 1] - arrive[v]
        if count > 0:
            one = arriving[arrive[v]]
            below = tree[PREVIOUS, one]
            above = tree[NEXT, one]
            found = 1
            while below != end and high[below] == v:
                below = tree[PREVIOUS, below]
                found += 1
            while above != end and high[above] == v:
                above = tree[NEXT, above]
                found += 1
            if found != count:
                return PIECES, one, below if below != end else above
            s = tree[NEXT, below]
            while s != above:
                following = tree[NEXT, s]
                remove(tree, s)
                s = following
        else:
            below = end
            s = tree[LEFT, end]
            while s >= 0:
                side = turn(xy, low[s], high[s], v)
                if side == 0.0:
                    return ON_PIECE, v, s
                if side > 0:
                    below = s
                    s = tree[RIGHT, s]
                else:
                    s = tree[LEFT, s]
            above = tree[NEXT, below]
        at = below
        for s in range(leave[v], leave[v + 1]):
            if at != below and turn(xy, v, high[at], high[s]) <= 0:
                return PIECES, at, s
            insert_after(tree, at, s)
            at = s
        if at != below and below != end and meet(xy, low, high, below, leave[v]):
            return PIECES, below, leave[v]
        if at != end and above != end and meet(xy, low, high, at, above):
            return PIECES, at, above
    return NOTHING, -1, -1
