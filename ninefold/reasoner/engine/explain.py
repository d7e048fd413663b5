"""Why a pair lies in a mask: the premises of one trail entry, as weak as they can be.

A *premise* (edge, mask) says that the pair lies in the mask. Entry t narrowed its pair from OLD to NEW; wanted is a mask A
that holds NEW and not OLD. For a triangle ``e in f;g`` the values that have to go are W. Given the relation q of g then, f
may be as large as ``not (W ; g~)`` without letting any of W back in; after that g may be as large as ``not (f~ ; W)``.
Both are one look-up. Values that were already impossible at level 0 are free and never premises.

References
----------
O. Ohrimenko, P. Stuckey and M. Codish, "Propagation via lazy clause generation", Constraints 14 (2009).
"""

from __future__ import annotations

from ninefold._kernels import kernel

from .columns import EDGE, FULL, LAST, LITERALS, NEW, OLD, OTHER, PREV, ROOT, SIZE, WHY
from .tables import compose_masks

__all__ = ["explain", "explain_triangle_conflict", "made_true_at", "relation_before"]


@kernel(_nrt=False)
def relation_before(edges, marks, trail, converse, arc, t):  # type: ignore[no-untyped-def]
    """Return the relation that `arc` had just before trail entry `t`."""
    at = edges[arc >> 1, LAST]
    while at >= t:
        at = trail[at, PREV]
    mask = trail[at, NEW] if at >= 0 else marks[arc >> 1, ROOT]
    return converse[mask] if arc & 1 else mask


@kernel(_nrt=False)
def made_true_at(edges, trail, edge, mask):  # type: ignore[no-untyped-def]
    """Return the entry after which a pair lay in `mask`, or -1 if it did at level 0; it has to lie in it now."""
    at = edges[edge, LAST]
    while at >= 0 and trail[at, OLD] & ~mask == 0:
        at = trail[at, PREV]
    return at


@kernel(_nrt=False)
def _last_change(edges, trail, arc, t):  # type: ignore[no-untyped-def]
    """Return the last entry before `t` that changed the pair of `arc`, or -1."""
    at = edges[arc >> 1, LAST]
    while at >= t:
        at = trail[at, PREV]
    return at


@kernel(_nrt=False)
def _put(marks, converse, out, n, arc, mask):  # type: ignore[no-untyped-def]
    """Append the premise that `arc` lies in `mask`, on the pair's own arc, unless it is free; return the new count."""
    edge = arc >> 1
    if arc & 1:
        mask = converse[mask]
    if marks[edge, ROOT] & ~mask == 0:
        return n
    out[n, 0] = edge
    out[n, 1] = mask
    return n + 1


@kernel(_nrt=False)
def weaken_pair(converse, compose, full, first, second, swap, bad):  # type: ignore[no-untyped-def]
    """Return the largest relations of arcs f and g, one after the other, whose composition avoids `bad`.

    Parameters
    ----------
    first, second
        Relations of f and g with which it does.
    swap
        Enlarge g before f.
    """
    if swap:
        second = full ^ compose_masks(compose, converse[first], bad)
        first = full ^ compose_masks(compose, bad, converse[second])
    else:
        first = full ^ compose_masks(compose, bad, converse[second])
        second = full ^ compose_masks(compose, converse[first], bad)
    return first, second


@kernel(_nrt=False)
def explain(s, t, wanted):  # type: ignore[no-untyped-def]
    """Write premises, true before entry `t`, from which its reason makes its pair lie in `wanted`; return their number.

    The entry must not be a decision. Premises go to `State.out`, which needs a row for each literal of a clause, and three
    for a triangle.
    """
    edges, marks, trail, arena, converse, compose, out = s.edges, s.marks, s.trail, s.arena, s.converse, s.compose, s.out
    full = s.reg[FULL]
    edge = trail[t, EDGE]
    bad = marks[edge, ROOT] & ~wanted
    n = 0
    f, g = trail[t, WHY], trail[t, OTHER]
    if f >= 0:
        p = relation_before(edges, marks, trail, converse, f, t)
        q = relation_before(edges, marks, trail, converse, g, t)
        must = bad
        if bad & compose_masks(compose, p, q) != 0:
            must = bad & trail[t, OLD]
        swap = _last_change(edges, trail, g, t) > _last_change(edges, trail, f, t)
        p, q = weaken_pair(converse, compose, full, p, q, swap, must)
        n = _put(marks, converse, out, n, f, p)
        n = _put(marks, converse, out, n, g, q)
        left = bad & ~must
        if left:
            left = left & compose_masks(compose, p, q)
    else:
        at = s.place[g] + LITERALS
        left = bad
        for k in range(at, at + 2 * arena[at - LITERALS + SIZE], 2):
            if arena[k] == edge:
                left = bad & arena[k + 1]
            else:
                n = _put(marks, converse, out, n, 2 * arena[k], full ^ arena[k + 1])
    if left:
        n = _put(marks, converse, out, n, 2 * edge, full ^ left)
    return n


@kernel(_nrt=False)
def explain_triangle_conflict(s, e, f, g):  # type: ignore[no-untyped-def]
    """Write premises on arcs e, f, g with ``e`` and ``f;g`` disjoint to `State.out`; return their number.

    The pair changed last is enlarged first, in the hope that it then lies further down the trail.
    """
    dom, edges, marks, converse, compose, out = s.dom, s.edges, s.marks, s.converse, s.compose, s.out
    full = s.reg[FULL]
    p, q = dom[f], dom[g]
    bad = dom[e]
    le, lf, lg = edges[e >> 1, LAST], edges[f >> 1, LAST], edges[g >> 1, LAST]
    if le > lf and le > lg:
        bad = full ^ compose_masks(compose, p, q)
        p, q = weaken_pair(converse, compose, full, p, q, lg > lf, bad)
    else:
        p, q = weaken_pair(converse, compose, full, p, q, lg > lf, bad)
        bad = full ^ compose_masks(compose, p, q)
    n = _put(marks, converse, out, 0, e, bad)
    n = _put(marks, converse, out, n, f, p)
    return _put(marks, converse, out, n, g, q)
