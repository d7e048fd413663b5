"""Learned clauses over literals "this pair is in this mask", with two watched literals.

A literal (edge, mask) is *false* when the pair's relation and the mask have nothing in common, *true* when the relation
lies in the mask. A clause holds at most one literal of a pair, because two of them join into one. When all but one are
false, the pair of the last one is narrowed to its mask.

Clause c starts at ``place[c]`` in the arena; its literals 0 and 1 are watched by nodes 2c and 2c + 1 of the lists headed
by ``edges[edge, WATCH]``. A node keeps its literal's mask, so that a look at the pair's relation is enough most times,
and another literal of the clause (the blocker), which settles the clause when it is true.

References
----------
M. Moskewicz et al., "Chaff: engineering an efficient SAT solver", DAC 2001; N. Sörensson and N. Eén, MiniSat 2.1 (blockers).
"""

from __future__ import annotations

from ninefold._kernels import kernel

from .columns import (
    ARENA_TOP,
    BLOCK_EDGE,
    BLOCK_MASK,
    CLAUSE,
    CLAUSE_TROUBLE,
    FULL,
    HEAD,
    LBD,
    LITERALS,
    MASK,
    N_CLAUSES,
    NEXT,
    SIZE,
    TAIL,
    TICKS,
    TROUBLE,
    TROUBLE_A,
    WATCH,
)
from .narrow import narrow

__all__ = ["add_clause", "attach", "visit_watches"]


@kernel(_nrt=False)
def attach(s, clause):  # type: ignore[no-untyped-def]
    """Watch the first two literals of a clause, each blocked by the other."""
    edges, arena, watch = s.edges, s.arena, s.watch
    at = s.place[clause] + LITERALS
    for side in range(2):
        node = 2 * clause + side
        edge = arena[at + 2 * side]
        watch[node, MASK] = arena[at + 2 * side + 1]
        watch[node, BLOCK_EDGE] = arena[at + 2 - 2 * side]
        watch[node, BLOCK_MASK] = arena[at + 3 - 2 * side]
        watch[node, NEXT] = edges[edge, WATCH]
        edges[edge, WATCH] = node


@kernel(_nrt=False)
def add_clause(s, n_literals, lbd):  # type: ignore[no-untyped-def]
    """Store the clause of the first rows of `learnt` (at least two), watch it, and return its number."""
    arena, reg, learnt = s.arena, s.reg, s.learnt
    clause = reg[N_CLAUSES]
    at = reg[ARENA_TOP]
    s.place[clause] = at
    arena[at + SIZE] = n_literals
    arena[at + LBD] = lbd
    for k in range(n_literals):
        arena[at + LITERALS + 2 * k] = learnt[k, 0]
        arena[at + LITERALS + 2 * k + 1] = learnt[k, 1]
    reg[ARENA_TOP] = at + LITERALS + 2 * n_literals
    reg[N_CLAUSES] = clause + 1
    attach(s, clause)
    return clause


@kernel(_nrt=False)
def visit_watches(s, edge):  # type: ignore[no-untyped-def]
    """Visit the clauses that watch a narrowed pair; narrow what is left alone, return False at a false clause."""
    dom, edges, reg, arena, watch = s.dom, s.edges, s.reg, s.arena, s.watch
    full = reg[FULL]
    relation = dom[2 * edge]
    before = -1
    node = edges[edge, WATCH]
    while node >= 0:
        after = watch[node, NEXT]
        reg[TICKS] += 1
        blocker = watch[node, BLOCK_EDGE]
        if relation & watch[node, MASK] or dom[2 * blocker] & (full ^ watch[node, BLOCK_MASK]) == 0:
            before, node = node, after
            continue
        clause = node >> 1
        at = s.place[clause] + LITERALS
        mine = at + 2 * (node & 1)
        partner = at + 2 - 2 * (node & 1)
        other, mask = arena[partner], arena[partner + 1]
        left = dom[2 * other] & mask
        if left == dom[2 * other]:
            watch[node, BLOCK_EDGE] = other
            watch[node, BLOCK_MASK] = mask
            before, node = node, after
            continue
        moved = False
        for k in range(at + 4, at + 2 * arena[at - LITERALS + SIZE], 2):
            if dom[2 * arena[k]] & arena[k + 1]:
                _swap(arena, k, mine)
                watch[node, MASK] = arena[mine + 1]
                watch[node, NEXT] = edges[arena[mine], WATCH]
                edges[arena[mine], WATCH] = node
                if before < 0:
                    edges[edge, WATCH] = after
                else:
                    watch[before, NEXT] = after
                moved = True
                break
        if moved:
            node = after
            continue
        if left == 0:
            reg[TROUBLE] = CLAUSE_TROUBLE
            reg[TROUBLE_A] = clause
            return False
        narrow(s, 2 * other, edges[other, TAIL], edges[other, HEAD], left, CLAUSE, clause, True)
        before, node = node, after
    return True


@kernel(_nrt=False)
def _swap(arena, k, m):  # type: ignore[no-untyped-def]
    """Exchange two literals, given by their places in the arena."""
    arena[k], arena[m] = arena[m], arena[k]
    arena[k + 1], arena[m + 1] = arena[m + 1], arena[k + 1]
