"""The conflict-driven search: propagate, learn, jump back, split.

`search` runs until it has an answer, has spent its steps, or needs more room; then it returns to Python, which looks at
the clock, lets an interrupt through or makes the arrays longer, and calls it again. Everything it has to remember is in
the arrays, so stopping changes nothing in the run.

References
----------
J. P. Marques-Silva, I. Lynce and S. Malik, "Conflict-driven clause learning SAT solvers", Handbook of Satisfiability.
A. Nadel and V. Ryvchin, "Chronological backtracking", SAT 2018 (stepping back one level where the jump would be long).
"""

from __future__ import annotations

from ninefold._kernels import kernel

from .analyse import analyse, minimise
from .clauses import add_clause, visit_watches
from .columns import (
    ARENA_FULL,
    ARENA_TOP,
    AT,
    CHECKED,
    CLAUSE,
    CONFLICT,
    CONFLICTS,
    CONSISTENT,
    CORE,
    CURSOR,
    DECIDED,
    DECISIONS,
    DEPTH,
    EDGE,
    FIXPOINT,
    FULL,
    HEAD,
    INCONSISTENT,
    LAST,
    LEVEL,
    LITERALS,
    LOG_FULL,
    LOG_TOP,
    LOGGING,
    N_BASES,
    N_CLAUSES,
    N_EDGES,
    N_NODES,
    NARROWED,
    NO_TROUBLE,
    PAUSED,
    REDUCE,
    REDUCE_AT,
    RESTARTS,
    ROOT,
    SEEN,
    SINCE_RESTART,
    TAIL,
    TICKS,
    TOP,
    TRAIL_FULL,
    TROUBLE,
    WATCH,
)
from .decide import decay, luby, next_split
from .narrow import backjump, narrow
from .queue import enqueue, take_smallest
from .sweep import close_triangles

__all__ = ["close", "learn", "propagate", "recheck", "search", "settle_root"]

RESTART_UNIT = 50
LONGEST_JUMP = 100


@kernel(_nrt=False)
def propagate(s, limit):  # type: ignore[no-untyped-def]
    """Propagate clauses and triangles until nothing changes: algebraic closure of what is kept.

    Returns
    -------
    FIXPOINT; CONFLICT, noted in the registers; PAUSED when the register TICKS passes `limit`; or TRAIL_FULL.
    """
    reg, edges, trail = s.reg, s.edges, s.trail
    room = trail.shape[0] - 2 * reg[N_NODES] - reg[N_CLAUSES] - 2
    while True:
        while reg[SEEN] < reg[TOP]:
            edge = trail[reg[SEEN], EDGE]
            reg[SEEN] += 1
            if edges[edge, WATCH] >= 0 and not visit_watches(s, edge):
                return CONFLICT
        if reg[TICKS] > limit:
            return PAUSED
        if reg[TOP] > room:
            return TRAIL_FULL
        edge = take_smallest(edges, reg[N_EDGES], reg[N_BASES])
        if edge < 0:
            return FIXPOINT
        if not close_triangles(s, edge):
            return CONFLICT


@kernel(_nrt=False)
def recheck(s):  # type: ignore[no-untyped-def]
    """Queue every pair that is not universal, unless that was done since the last narrowing; tell whether it was.

    In a dense frame pairs that follow exactly from two others are not queued (see `sweep`), so a fixpoint is known to be
    one only after a round in which nothing changed.
    """
    reg = s.reg
    if reg[CORE] != 0 or reg[CHECKED] == reg[NARROWED]:
        return True
    reg[CHECKED] = reg[NARROWED]
    for edge in range(reg[N_EDGES]):
        relation = s.dom[2 * edge]
        if relation != reg[FULL]:
            enqueue(s.edges, reg[N_EDGES], edge, s.size[relation])
    return False


@kernel(_nrt=False, compile_seconds=3)
def close(s, limit):  # type: ignore[no-untyped-def]
    """Close the stated network at level 0; answers as `propagate`."""
    while True:
        status = propagate(s, limit)
        if status != FIXPOINT or recheck(s):
            return status


@kernel(_nrt=False)
def settle_root(s):  # type: ignore[no-untyped-def]
    """Make what was derived at level 0 the new root, and forget its trail."""
    for t in range(s.reg[TOP]):
        edge = s.trail[t, EDGE]
        s.marks[edge, ROOT] = s.dom[2 * edge]
        s.edges[edge, LAST] = -1
    s.reg[TOP] = 0
    s.reg[SEEN] = 0


@kernel(_nrt=False)
def learn(s):  # type: ignore[no-untyped-def]
    """Learn from the conflict in the registers and jump back; return False when it refutes the network."""
    reg = s.reg
    n = analyse(s)
    reg[TROUBLE] = NO_TROUBLE
    if n == 0:
        return False
    depth = s.trail[s.marks[s.learnt[0, 0], AT], DEPTH]
    n, level, lbd = minimise(s, 2 * reg[CONFLICTS] + 2, n)
    if reg[LOGGING]:
        _log(s.log, reg, s.learnt, n)
    # far down a network that gives way easily, what lies between is worth keeping: step back one level only
    if depth - level > LONGEST_JUMP:
        level = depth - 1
    backjump(s, level)
    clause = -1
    if n > 1:
        clause = add_clause(s, n, lbd)
    edge = s.learnt[0, 0]
    new = s.dom[2 * edge] & s.learnt[0, 1]
    narrow(s, 2 * edge, s.edges[edge, TAIL], s.edges[edge, HEAD], new, CLAUSE, clause, True)
    decay(s.activity)
    reg[CONFLICTS] += 1
    reg[SINCE_RESTART] += 1
    return True


@kernel(_nrt=False)
def split(s, edge):  # type: ignore[no-untyped-def]
    """Open a decision level that puts a pair into a tractable part of its relation."""
    reg = s.reg
    reg[LEVEL] += 1
    reg[DECISIONS] += 1
    s.levels[reg[LEVEL], 0] = reg[TOP]
    s.levels[reg[LEVEL], 1] = reg[CURSOR]
    narrow(s, 2 * edge, s.edges[edge, TAIL], s.edges[edge, HEAD], s.split[s.dom[2 * edge]], DECIDED, 0, True)


@kernel(_nrt=False, compile_seconds=6)
def search(s, limit):  # type: ignore[no-untyped-def]
    """Search until an answer, `limit` in the register TICKS, or a shortage of room.

    Returns
    -------
    CONSISTENT, INCONSISTENT, PAUSED, TRAIL_FULL, ARENA_FULL, LOG_FULL, or REDUCE (clauses are due for a clean-up).
    """
    reg = s.reg
    while True:
        if reg[TROUBLE] == NO_TROUBLE:
            status = propagate(s, limit)
            if status != FIXPOINT and status != CONFLICT:
                return status
        if reg[TROUBLE] != NO_TROUBLE:
            if reg[LEVEL] == 0:
                return INCONSISTENT
            # a clause is never longer than the trail, and a conflict can wait in the registers
            if reg[ARENA_TOP] + LITERALS + 2 * reg[TOP] > s.arena.size or reg[N_CLAUSES] == s.place.size:
                return ARENA_FULL
            if reg[LOGGING] and reg[LOG_TOP] + 1 + 2 * reg[TOP] > s.log.size:
                return LOG_FULL
            if not learn(s):
                return INCONSISTENT
            continue
        if reg[LEVEL] == 0:
            settle_root(s)
        if reg[SINCE_RESTART] >= RESTART_UNIT * luby(reg[RESTARTS] + 1):
            reg[RESTARTS] += 1
            reg[SINCE_RESTART] = 0
            backjump(s, 0)
            if reg[CONFLICTS] >= reg[REDUCE_AT]:
                return REDUCE
            continue
        edge = next_split(s.dom, s.marks, s.stated, s.recent, s.activity, reg, s.hull, s.size)
        if edge < 0:
            if recheck(s):
                return CONSISTENT
            continue
        split(s, edge)


@kernel(_nrt=False)
def _log(log, reg, learnt, n):  # type: ignore[no-untyped-def]
    """Append a clause to the log."""
    at = reg[LOG_TOP]
    log[at] = n
    for k in range(n):
        log[at + 1 + 2 * k] = learnt[k, 0]
        log[at + 2 + 2 * k] = learnt[k, 1]
    reg[LOG_TOP] = at + 1 + 2 * n
