"""Close every triangle over one pair: the propagation step of algebraic closure.

When the relation R of nodes i and j has become smaller, every third node k may lose relations to i, which have to lie in
``R ; (j k)``, and to j, which have to lie in ``R~ ; (i k)``.

Dense back end: the partners are swept 64 at a time over bit-planes. Base relation c stays possible between i and k when
(j k) can be one of the b with ``c in R;b``; the union of the planes of those b, for 64 k at once, is compared with the
plane of c. Chordal back end: only a k whose relation to j is not universal can matter (``R ; universal`` is universal
in the calculi that use this back end), and such partners are listed.

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
    DENSE,
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


@kernel(_nrt=False)
def losing_partners(planes, rules, relation, target, source, word):  # type: ignore[no-untyped-def]
    """Return which of 64 nodes k lose a base relation to `target` through `source`, as bits.

    Parameters
    ----------
    planes
        (n, words, b) uint64.
    rules
        ``Tables.rules``.
    relation
        The relation from `target` to `source`.
    """
    losing = _NONE
    at = 1
    for _ in range(rules[relation, 0]):
        own = planes[target, word, rules[relation, at]]
        stop = at + 2 + rules[relation, at + 1]
        at += 2
        while at < stop:
            own = own & ~planes[source, word, rules[relation, at]]
            at += 1
        losing = losing | own
    return losing


@kernel(_nrt=False)
def _sweep_planes(dom, edges, nodes, upper, planes, active, trail, reg, converse, size, compose, rules, arc, i, j):  # type: ignore[no-untyped-def]
    """Narrow every (i, k) by the triangle over `arc` = (i, j); return False at an empty relation."""
    relation = dom[arc]
    for word in range(planes.shape[1]):
        losing = losing_partners(planes, rules, relation, i, j, word)
        while losing != 0:
            k = word * WORD + lowest_bit(losing)
            losing = losing & (losing - _ONE)
            target = arc_between(nodes, upper, 0, i, k)
            source = arc_between(nodes, upper, 0, j, k)
            new = dom[target] & compose_masks(compose, relation, dom[source])
            if new == 0:
                _report(reg, target, arc, source)
                return False
            narrow(dom, edges, nodes, planes, active, trail, reg, converse, size, target, new, arc, source)
    reg[TICKS] += planes.shape[1]
    return True


@kernel(_nrt=False)
def _sweep_partners(dom, edges, nodes, upper, planes, active, trail, reg, converse, size, compose, arc, i, j):  # type: ignore[no-untyped-def]
    """Narrow every kept (i, k) with (j, k) not universal; return False at an empty relation."""
    relation = dom[arc]
    core, full = reg[CORE], reg[FULL]
    start = nodes[j, ROOM]
    for at in range(start, start + nodes[j, BUSY]):
        source = active[at, 1]
        allowed = compose_masks(compose, relation, dom[source])
        if allowed == full:
            continue
        k = active[at, 0]
        if k == i:
            continue
        target = arc_between(nodes, upper, core, i, k)
        if target < 0:
            continue
        old = dom[target]
        new = old & allowed
        if new == old:
            continue
        if new == 0:
            _report(reg, target, arc, source)
            return False
        narrow(dom, edges, nodes, planes, active, trail, reg, converse, size, target, new, arc, source)
    reg[TICKS] += nodes[j, BUSY]
    return True


@kernel(_nrt=False)
def close_triangles(dom, edges, nodes, upper, planes, active, trail, reg, converse, size, compose, rules, edge):  # type: ignore[no-untyped-def]
    """Close every triangle over a pair, in both directions; return False when a relation would become empty."""
    i, j = edges[edge, TAIL], edges[edge, HEAD]
    arc = 2 * edge
    reg[TICKS] += 8
    if reg[DENSE]:
        return _sweep_planes(
            dom, edges, nodes, upper, planes, active, trail, reg, converse, size, compose, rules, arc, i, j
        ) and _sweep_planes(
            dom, edges, nodes, upper, planes, active, trail, reg, converse, size, compose, rules, arc + 1, j, i
        )
    return _sweep_partners(
        dom, edges, nodes, upper, planes, active, trail, reg, converse, size, compose, arc, i, j
    ) and _sweep_partners(dom, edges, nodes, upper, planes, active, trail, reg, converse, size, compose, arc + 1, j, i)


@kernel(_nrt=False)
def _report(reg, empty, first, second):  # type: ignore[no-untyped-def]
    """Note the triangle that leaves arc `empty` no relation."""
    reg[TROUBLE] = TRIANGLE_TROUBLE
    reg[TROUBLE_A] = empty
    reg[TROUBLE_F] = first
    reg[TROUBLE_G] = second
