"""Close every triangle over one pair: the propagation step of algebraic closure.

When the relation R of nodes i and j has become smaller, every third node k may lose relations to i, which have to lie in
``R ; (j k)``, and to j, which have to lie in ``R~ ; (i k)``.

Inside the core, which is complete, partners are swept 64 at a time over bit-planes. Base relation c stays possible
between i and k when (j k) can be one of the b with ``c in R;b``; the union of the planes of those b, for 64 k at once, is
compared with the plane of c. A dense frame is all core. Triangles with a node before the core are closed one by one: from
their first node over its later neighbours, which form a clique, and from the other two over the listed partners before
them, those that are not universal (``R ; universal`` is universal in every calculus that gets a chordal frame).

Where the new relation of (i, k) is all of ``(i j);(j k)``, closing triangles over (i, k) would find, composition being
associative, what the triangles over (i, j) and (j, k) find in two steps, so in a dense frame the pair is not queued. That
halves the work. As such reasons can run in circles, a round over all pairs confirms a fixpoint before it counts
(`search.recheck`). In a chordal frame the two steps may pass through a pair that is not kept.

References
----------
P. van Beek and D. W. Manchak, "The design and experimental analysis of algorithms for temporal reasoning", JAIR 4 (1996).
"""

from __future__ import annotations

import numpy as np

from ninefold._kernels import kernel

from .columns import (
    BUSY,
    CORE,
    FIRST,
    FULL,
    HEAD,
    ROOM,
    TAIL,
    TICKS,
    TRIANGLE_TROUBLE,
    TROUBLE,
    TROUBLE_A,
    TROUBLE_F,
    TROUBLE_G,
)
from .graph import arc_between
from .narrow import narrow
from .tables import compose_masks
from .words import WORD, lowest_bit

__all__ = ["close_triangles", "losing_partners"]

_ONE = np.uint64(1)
_NONE = np.uint64(0)


@kernel(_nrt=False, forceinline=True)
def losing_partners(planes, gates, relation, target, source, word):  # type: ignore[no-untyped-def]
    """Return which of 64 nodes k lose a base relation to `target` through `source`, as bits.

    Parameters
    ----------
    planes, gates
        ``State.planes`` and ``Tables.gates``.
    relation
        The relation from `target` to `source`.

    Notes
    -----
    Written out so that the loop over c becomes vector code with everything of `source` in registers.
    """
    p0, p1, p2, p3 = planes[source, word, 0], planes[source, word, 1], planes[source, word, 2], planes[source, word, 3]
    p4, p5, p6, p7 = planes[source, word, 4], planes[source, word, 5], planes[source, word, 6], planes[source, word, 7]
    losing = _NONE
    if planes.shape[2] == 8:
        for c in range(8):
            possible = (
                (p0 & gates[relation, 0, c])
                | (p1 & gates[relation, 1, c])
                | (p2 & gates[relation, 2, c])
                | (p3 & gates[relation, 3, c])
                | (p4 & gates[relation, 4, c])
                | (p5 & gates[relation, 5, c])
                | (p6 & gates[relation, 6, c])
                | (p7 & gates[relation, 7, c])
            )
            losing |= planes[target, word, c] & ~possible
        return losing
    for c in range(planes.shape[2]):
        possible = _NONE
        for b in range(planes.shape[2]):
            possible |= planes[source, word, b] & gates[relation, b, c]
        losing |= planes[target, word, c] & ~possible
    return losing


@kernel(_nrt=False)
def _sweep_planes(s, arc, i, j):  # type: ignore[no-untyped-def]
    """Narrow every (i, k) in the core by the triangle over `arc` = (i, j); return False at an empty relation."""
    dom, nodes, upper, planes, reg = s.dom, s.nodes, s.upper, s.planes, s.reg
    relation = dom[arc]
    core = reg[CORE]
    for word in range(planes.shape[1]):
        losing = losing_partners(planes, s.gates, relation, i - core, j - core, word)
        while losing != 0:
            k = core + word * WORD + lowest_bit(losing)
            losing = losing & (losing - _ONE)
            target = arc_between(nodes, upper, core, i, k)
            source = arc_between(nodes, upper, core, j, k)
            allowed = compose_masks(s.compose, relation, dom[source])
            new = dom[target] & allowed
            if new == 0:
                _report(reg, target, arc, source)
                return False
            queued = new != allowed or core != 0
            narrow(s, target, i, k, new, arc, source, queued)
    reg[TICKS] += planes.shape[1]
    return True


@kernel(_nrt=False)
def _apply(s, target, i, k, arc, source):  # type: ignore[no-untyped-def]
    """Narrow `target` = (i, k) to ``arc ; source``; return False at an empty relation."""
    dom = s.dom
    allowed = compose_masks(s.compose, dom[arc], dom[source])
    if allowed == s.reg[FULL]:
        return True
    old = dom[target]
    new = old & allowed
    if new == old:
        return True
    if new == 0:
        _report(s.reg, target, arc, source)
        return False
    narrow(s, target, i, k, new, arc, source, True)
    return True


@kernel(_nrt=False)
def _visit_later(s, arc, i, j):  # type: ignore[no-untyped-def]
    """Close the triangles of i, before the core, and j with the other later neighbours of i."""
    dom, nodes, upper, reg = s.dom, s.nodes, s.upper, s.reg
    core, full = reg[CORE], reg[FULL]
    for at in range(nodes[i, FIRST], nodes[i + 1, FIRST]):
        k = upper[at]
        if k == j:
            continue
        first, second = 2 * at, arc_between(nodes, upper, core, j, k)
        if dom[second] != full and not _apply(s, first, i, k, arc, second):
            return False
        if dom[first] != full and not _apply(s, second, j, k, arc + 1, first):
            return False
    reg[TICKS] += 2 * (nodes[i + 1, FIRST] - nodes[i, FIRST])
    return True


@kernel(_nrt=False)
def _visit_earlier(s, arc, i, j):  # type: ignore[no-untyped-def]
    """Narrow every kept (i, k) with k before i and j, and (j, k) not universal; return False at an empty relation."""
    dom, nodes, active, reg = s.dom, s.nodes, s.active, s.reg
    core, full = reg[CORE], reg[FULL]
    start = nodes[j, ROOM]
    for at in range(start, start + nodes[j, BUSY]):
        k = active[at, 0]
        if k < i and compose_masks(s.compose, dom[arc], dom[active[at, 1]]) != full:
            target = arc_between(nodes, s.upper, core, i, k)
            if target >= 0 and not _apply(s, target, i, k, arc, active[at, 1]):
                return False
    reg[TICKS] += nodes[j, BUSY]
    return True


@kernel(_nrt=False)
def close_triangles(s, edge):  # type: ignore[no-untyped-def]
    """Close every triangle over a pair, in both directions; return False when a relation would become empty."""
    edges, nodes, reg = s.edges, s.nodes, s.reg
    i, j = edges[edge, TAIL], edges[edge, HEAD]
    arc = 2 * edge
    reg[TICKS] += 8
    if i < reg[CORE]:
        if not _visit_later(s, arc, i, j):
            return False
    else:
        for back in range(2):
            if not _sweep_planes(s, arc + back, edges[edge, TAIL + back], edges[edge, HEAD - back]):
                return False
    if nodes[j, BUSY] and not _visit_earlier(s, arc, i, j):
        return False
    return nodes[i, BUSY] == 0 or _visit_earlier(s, arc + 1, j, i)


@kernel(_nrt=False, forceinline=True)
def _report(reg, empty, first, second):  # type: ignore[no-untyped-def]
    """Note the triangle that leaves arc `empty` no relation."""
    reg[TROUBLE] = TRIANGLE_TROUBLE
    reg[TROUBLE_A] = empty
    reg[TROUBLE_F] = first
    reg[TROUBLE_G] = second
