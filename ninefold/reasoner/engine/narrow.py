"""Make a relation smaller, and take that back.

Everything that follows from a pair's relation is kept beside it: the relation of the converse arc, the bit-planes of the
core or the lists of earlier partners, and the trail.

Bit-planes: bit ``k % 64`` of ``planes[i, k // 64, b]`` says that base relation b is possible between nodes i and k, both
counted from the core's first. Lists: the rows ``nodes[i, ROOM] ...`` of `active` hold (partner, arc to it) for partners of
i before i and the core whose relation is not universal, newest last, ``nodes[i, BUSY]`` of them; narrowings are taken
back in reverse order, so that a list is a stack.
"""

from __future__ import annotations

import numpy as np

from ninefold._kernels import kernel

from .columns import (
    BUSY,
    CORE,
    CURSOR,
    DEPTH,
    EDGE,
    FULL,
    HEAD,
    KEEP,
    LAST,
    LEVEL,
    N_BASES,
    N_EDGES,
    NARROWED,
    NEW,
    OLD,
    OTHER,
    PREV,
    ROOM,
    SEEN,
    TAIL,
    TOP,
    WHY,
)
from .queue import clear_queue, enqueue
from .words import WORD

__all__ = ["backjump", "flip_planes", "list_partner", "narrow"]

_ONE = np.uint64(1)


@kernel(_nrt=False, forceinline=True)
def flip_planes(planes, i, k, mask):  # type: ignore[no-untyped-def]
    """Flip the bits of the base relations in `mask` between nodes `i` and `k`, as seen from `i`."""
    word = k // WORD
    bit = _ONE << np.uint64(k % WORD)
    for base in range(planes.shape[2]):
        planes[i, word, base] ^= bit * np.uint64(mask >> base & 1)


@kernel(_nrt=False, forceinline=True)
def list_partner(active, nodes, node, partner, arc):  # type: ignore[no-untyped-def]
    """Append `partner` to the partners of `node` whose relation is not universal."""
    at = nodes[node, ROOM] + nodes[node, BUSY]
    active[at, 0] = partner
    active[at, 1] = arc
    nodes[node, BUSY] += 1


@kernel(_nrt=False, forceinline=True)
def narrow(s, arc, i, k, new, why, other, queued):  # type: ignore[no-untyped-def]
    """Give an arc a smaller relation that is not empty.

    Parameters
    ----------
    s
        The `State`.
    arc, i, k
        The arc and the nodes it runs from and to.
    new
        Its relation, a proper subset of the present one.
    why, other
        The two arcs of the triangle that forces it, in the order of their composition; or DECIDED; or CLAUSE and the
        clause. Written to the trail when the register KEEP is set.
    queued
        Whether the triangles over the pair have to be closed.
    """
    dom, edges, planes, reg, converse = s.dom, s.edges, s.planes, s.reg, s.converse
    edge = arc >> 1
    if arc & 1:
        new = converse[new]
        i, k = k, i
        if why >= 0:
            why, other = other ^ 1, why ^ 1
    old = dom[2 * edge]
    dom[2 * edge] = new
    dom[2 * edge + 1] = converse[new]
    core = reg[CORE]
    if i >= core:
        flip_planes(planes, i - core, k - core, old ^ new)
        flip_planes(planes, k - core, i - core, converse[old ^ new])
    elif old == reg[FULL]:
        list_partner(s.active, s.nodes, k, i, 2 * edge + 1)
    if reg[KEEP]:
        trail, top = s.trail, reg[TOP]
        trail[top, EDGE] = edge
        trail[top, OLD] = old
        trail[top, NEW] = new
        trail[top, WHY] = why
        trail[top, OTHER] = other
        trail[top, PREV] = edges[edge, LAST]
        trail[top, DEPTH] = reg[LEVEL]
        edges[edge, LAST] = top
        reg[TOP] = top + 1
    reg[NARROWED] += 1
    if queued:
        enqueue(edges, reg[N_EDGES], edge, s.size[new])


@kernel(_nrt=False)
def backjump(s, level):  # type: ignore[no-untyped-def]
    """Take back every narrowing above decision level `level`, and empty the queue."""
    dom, edges, nodes, planes, trail, reg, converse = s.dom, s.edges, s.nodes, s.planes, s.trail, s.reg, s.converse
    clear_queue(edges, reg[N_EDGES], reg[N_BASES])
    if reg[LEVEL] <= level:
        return
    core = reg[CORE]
    start = s.levels[level + 1, 0]
    for t in range(reg[TOP] - 1, start - 1, -1):
        edge = trail[t, EDGE]
        old, new = trail[t, OLD], trail[t, NEW]
        dom[2 * edge] = old
        dom[2 * edge + 1] = converse[old]
        i, k = edges[edge, TAIL], edges[edge, HEAD]
        if i >= core:
            flip_planes(planes, i - core, k - core, old ^ new)
            flip_planes(planes, k - core, i - core, converse[old ^ new])
        elif old == reg[FULL]:
            nodes[k, BUSY] -= 1
        edges[edge, LAST] = trail[t, PREV]
    reg[TOP] = start
    reg[SEEN] = start
    reg[LEVEL] = level
    reg[CURSOR] = s.levels[level + 1, 1]
