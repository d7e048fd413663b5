"""A search that knows, of everything it learns, which statements that rests on.

The search of `search` takes what closure makes of the stated network for granted and forgets why. Here nothing is granted:
the statements themselves are entries of the trail, at level 0, and so is all that follows from them. A premise that held at
level 0 is followed back to statements as any other is to decisions, once, and the answer is kept. So every learned clause
carries the set of the statements it follows from, a row of bits, and the refutation of the network is such a set, too. A
clause stays valid in every network that has its statements; that is what makes a long series of searches over ever fewer
statements quick.

Sets are made of *groups* of statements, one bit a group. Row g of the sets, for each group g, holds that group alone; rows
after those are unions that were needed.

References
----------
N. Eén and N. Sörensson, "Temporal induction by incremental SAT solving", BMC 2003 (clauses that outlive what was assumed);
A. Nadel, "Boosting minimal unsatisfiable core extraction", FMCAD 2010 (clauses that name the statements they came from).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._kernels import kernel

from .analyse import conflict_premises, rest_of_clause
from .clauses import add_clause, attach
from .columns import (
    ARENA_FULL,
    ARENA_TOP,
    AT,
    CLAUSE,
    CLAUSE_TROUBLE,
    CONFLICT,
    CONFLICTS,
    CONSISTENT,
    CURSOR,
    DECIDED,
    DECISIONS,
    DEPTH,
    EDGE,
    FIXPOINT,
    FULL,
    HEAD,
    HELD,
    INCONSISTENT,
    LABEL,
    LEVEL,
    LITERALS,
    N_CLAUSES,
    N_HELD,
    NEED,
    NEW,
    NO_TROUBLE,
    OLD,
    OTHER,
    REDUCE,
    REDUCE_AT,
    RESTARTS,
    SINCE_RESTART,
    TAIL,
    TOP,
    TROUBLE,
    TROUBLE_A,
    WHY,
)
from .decide import decay, luby, next_split
from .explain import explain, made_true_at
from .narrow import backjump, narrow
from .search import LONGEST_JUMP, propagate, recheck

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = [
    "N_GOALS",
    "N_MEMO",
    "N_ROWS",
    "N_UNITS",
    "N_USED",
    "SETS_FULL",
    "STATED",
    "Trace",
    "attach_all",
    "close_traced",
    "detach_root",
    "new_trace",
    "search_traced",
    "state_traced",
]

STATED = -3
"""WHY of a trail entry that a set of statements forces; OTHER is the row of the set."""

SETS_FULL = 10
"""Answer of the kernels: no room for more sets of statements."""

_RESTART_UNIT = 10
"""Conflicts to the first restart: with a scenario of nearly the same question to begin at, little is lost by it."""

_LONGEST_PROOF = 60
_MASK_BITS = 14

# registers of a trace
N_ROWS = 0  # rows of `sets` in use
N_GOALS = 1  # premises of level 0 in `goals`
N_USED = 2  # rows in `used`
N_MEMO = 3  # entries of the memory in use
N_UNITS = 4  # clauses of one literal in `units`
N_TRACE_REGISTERS = 5


class Trace(NamedTuple):
    """What a search keeps beside its `State` to know where things come from."""

    sets: NDArray[np.uint64]
    """(rows, words) sets of groups of statements."""
    clause_set: NDArray[np.int32]
    """The row of each clause."""
    keys: NDArray[np.int64]
    """Memory of premises of level 0, a hash table: entry of the trail and mask, or -1."""
    found: NDArray[np.int32]
    """The row of each of them."""
    goals: NDArray[np.int32]
    """(k, 2) premises of level 0 that the clause being made rests on: entry of the trail and mask."""
    used: NDArray[np.int32]
    """Rows of the clauses and statements that it rests on."""
    units: NDArray[np.int32]
    """(k, 3) clauses of one literal: pair, mask, row."""
    stack: NDArray[np.int32]
    """(k, 2) scratch."""
    total: NDArray[np.uint64]
    """(words,) the set of the clause being made; of the refutation at the end."""
    phase: NDArray[np.int16]
    """(E,) relation of every pair in the last scenario that was found, which a split tries first; 0 where there is none."""
    reg: NDArray[np.int64]
    """Registers."""


def new_trace(n_groups: int, n_edges: int, n_clauses: int) -> Trace:
    """Return an empty trace with the singletons of `n_groups` groups, and room for `n_clauses` clauses."""
    words = -(-n_groups // 64)
    sets = np.zeros((2 * n_groups + 4096, words), dtype=np.uint64)
    group = np.arange(n_groups)
    sets[group, group // 64] = np.uint64(1) << (group % 64).astype(np.uint64)
    reg = np.zeros(N_TRACE_REGISTERS, dtype=np.int64)
    reg[N_ROWS] = n_groups
    return Trace(
        sets=sets,
        clause_set=np.zeros(n_clauses, dtype=np.int32),
        keys=np.full(1 << 13, -1, dtype=np.int64),
        found=np.zeros(1 << 13, dtype=np.int32),
        goals=np.empty((4096, 2), dtype=np.int32),
        used=np.empty(4096, dtype=np.int32),
        units=np.empty((256, 3), dtype=np.int32),
        stack=np.empty((4096, 2), dtype=np.int32),
        total=np.zeros(words, dtype=np.uint64),
        phase=np.zeros(n_edges, dtype=np.int16),
        reg=reg,
    )


@kernel(_nrt=False)
def _slot(d, t, mask):  # type: ignore[no-untyped-def]
    """Return where a premise of level 0 is in the memory, or the free place for it."""
    key = np.int64(t) << _MASK_BITS | mask
    last = d.keys.size - 1
    at = (key * 40503 + (key >> 11)) & last
    while d.keys[at] != -1 and d.keys[at] != key:
        at = (at + 1) & last
    return at


@kernel(_nrt=False)
def _why(s, t, wanted):  # type: ignore[no-untyped-def]
    """Write the premises of a trail entry to ``s.out`` (see `explain`) and return their number."""
    trail, full = s.trail, s.reg[FULL]
    if trail[t, WHY] != STATED:
        return explain(s, t, wanted)
    # what was gone before is not the statement's doing
    left = full & ~wanted & ~trail[t, OLD]
    if left == 0:
        return 0
    s.out[0, 0] = trail[t, EDGE]
    s.out[0, 1] = full ^ left
    return 1


@kernel(_nrt=False)
def _own_set(s, d, t):  # type: ignore[no-untyped-def]
    """Return the row of what a trail entry rests on beside its premises, or -1."""
    why = s.trail[t, WHY]
    if why == STATED:
        return s.trail[t, OTHER]
    if why == CLAUSE:
        return d.clause_set[s.trail[t, OTHER]]
    return -1


@kernel(_nrt=False)
def _trace_root(s, d, t, mask):  # type: ignore[no-untyped-def]
    """Return the row of the statements that put a pair into `mask` by trail entry `t` of level 0; -1 without room."""
    stack, out, edges, trail = d.stack, s.out, s.edges, s.trail
    stack[0, 0] = t
    stack[0, 1] = mask
    n_stack = 1
    while n_stack > 0:
        t, mask = stack[n_stack - 1, 0], stack[n_stack - 1, 1]
        slot = _slot(d, t, mask)
        if d.keys[slot] != -1:
            n_stack -= 1
            continue
        n = _why(s, t, mask)
        if n_stack + n > stack.shape[0] or 2 * d.reg[N_MEMO] + 2 > d.keys.size or d.reg[N_ROWS] + 1 > d.sets.shape[0]:
            return -1
        missing = False
        for k in range(n):
            at = made_true_at(edges, trail, out[k, 0], out[k, 1])
            out[k, 0] = _slot(d, at, out[k, 1])
            if d.keys[out[k, 0]] == -1:
                stack[n_stack, 0] = at
                stack[n_stack, 1] = out[k, 1]
                n_stack += 1
                missing = True
        if missing:
            continue
        row = _own_set(s, d, t)
        fresh = False
        for k in range(n):
            other = d.found[out[k, 0]]
            if row < 0 or row == other:
                row = other
                continue
            if not fresh:
                new = d.reg[N_ROWS]
                for w in range(d.sets.shape[1]):
                    d.sets[new, w] = d.sets[row, w]
                row = new
                fresh = True
            for w in range(d.sets.shape[1]):
                d.sets[row, w] |= d.sets[other, w]
        if fresh:
            d.reg[N_ROWS] += 1
        d.keys[slot] = np.int64(t) << _MASK_BITS | mask
        d.found[slot] = row
        d.reg[N_MEMO] += 1
        n_stack -= 1
    return d.found[_slot(d, stack[0, 0], stack[0, 1])]


@kernel(_nrt=False)
def _gather(s, d):  # type: ignore[no-untyped-def]
    """Unite in ``d.total`` what the clause being made rests on; return False without room."""
    sets, total = d.sets, d.total
    for w in range(total.size):
        total[w] = 0
    for u in range(d.reg[N_USED]):
        row = d.used[u]
        for w in range(total.size):
            total[w] |= sets[row, w]
    for g in range(d.reg[N_GOALS]):
        row = _trace_root(s, d, d.goals[g, 0], d.goals[g, 1])
        if row < 0:
            return False
        for w in range(total.size):
            total[w] |= sets[row, w]
    return True


@kernel(_nrt=False)
def _note_goal(d, t, mask):  # type: ignore[no-untyped-def]
    """Note a premise of level 0; when there is no room it is only counted."""
    n = d.reg[N_GOALS]
    if n < d.goals.shape[0]:
        d.goals[n, 0] = t
        d.goals[n, 1] = mask
    d.reg[N_GOALS] = n + 1


@kernel(_nrt=False)
def _note_use(s, d, t):  # type: ignore[no-untyped-def]
    """Note the set that a trail entry rests on, if it has one of its own; without room it is only counted."""
    row = _own_set(s, d, t)
    if row >= 0:
        n = d.reg[N_USED]
        if n < d.used.size:
            d.used[n] = row
        d.reg[N_USED] = n + 1


@kernel(_nrt=False)
def _require(s, d, edge, mask, start):  # type: ignore[no-untyped-def]
    """Add a premise to those held, or to the goals; return by how much those from entry `start` on grew."""
    marks, trail = s.marks, s.trail
    need = marks[edge, NEED]
    if need & ~mask == 0:
        return 0
    at = made_true_at(s.edges, trail, edge, mask)
    if trail[at, DEPTH] == 0:
        _note_goal(d, at, mask)
        return 0
    mask = mask & need
    at = made_true_at(s.edges, trail, edge, mask)
    was_young = need != -1 and marks[edge, AT] >= start
    marks[edge, NEED] = mask
    marks[edge, AT] = at
    if marks[edge, HELD] == 0:
        marks[edge, HELD] = 1
        s.held[s.reg[N_HELD]] = edge
        s.reg[N_HELD] += 1
    return 1 if at >= start and not was_young else 0


@kernel(_nrt=False)
def _analyse(s, d):  # type: ignore[no-untyped-def]
    """As `analyse.analyse`, and note what level 0 and the clauses have to do with it."""
    reg, marks, trail, out = s.reg, s.marks, s.trail, s.out
    reg[N_HELD] = 0
    d.reg[N_GOALS] = 0
    d.reg[N_USED] = 0
    n = conflict_premises(s)
    if reg[TROUBLE] == CLAUSE_TROUBLE:
        d.used[0] = d.clause_set[reg[TROUBLE_A]]
        d.reg[N_USED] = 1
    youngest = -1
    for k in range(n):
        youngest = max(youngest, made_true_at(s.edges, trail, out[k, 0], out[k, 1]))
    if youngest < 0:
        return 0
    depth = trail[youngest, DEPTH]
    start = s.levels[depth, 0] if depth > 0 else 0
    young = 0
    for k in range(n):
        young += _require(s, d, out[k, 0], out[k, 1], start)
    if depth == 0:
        return 0
    t = youngest
    while True:
        edge = trail[t, EDGE]
        if marks[edge, NEED] != -1 and marks[edge, AT] == t:
            if young == 1:
                break
            wanted = marks[edge, NEED]
            marks[edge, NEED] = -1
            young -= 1
            n = _why(s, t, wanted)
            _note_use(s, d, t)
            for k in range(n):
                young += _require(s, d, out[k, 0], out[k, 1], start)
        t -= 1
    s.learnt[0, 0] = trail[t, EDGE]
    return 1 + rest_of_clause(s.marks, reg, s.activity, s.recent, s.held, s.learnt)


@kernel(_nrt=False)
def _is_implied(s, d, mark, edge):  # type: ignore[no-untyped-def]
    """Tell whether the premise held on `edge` follows from the others and from level 0; note by what."""
    marks, trail, stack, out = s.marks, s.trail, s.stack, s.out
    goals, used = d.reg[N_GOALS], d.reg[N_USED]
    stack[0, 0] = edge
    stack[0, 1] = marks[edge, NEED]
    n_stack = 1
    looked = 0
    while n_stack > 0:
        n_stack -= 1
        t = made_true_at(s.edges, trail, stack[n_stack, 0], stack[n_stack, 1])
        n = 0
        fine = trail[t, WHY] != DECIDED
        if fine:
            n = _why(s, t, stack[n_stack, 1])
            _note_use(s, d, t)
            looked += n
            fine = looked <= _LONGEST_PROOF
        for k in range(n):
            if not fine:
                break
            other, mask = out[k, 0], out[k, 1]
            if other != edge and marks[other, NEED] & ~mask == 0:
                continue
            at = made_true_at(s.edges, trail, other, mask)
            if trail[at, DEPTH] == 0:
                _note_goal(d, at, mask)
                continue
            fine = s.stamp[trail[at, DEPTH]] == mark
            stack[n_stack, 0] = other
            stack[n_stack, 1] = mask
            n_stack += 1
        if not fine:
            d.reg[N_GOALS], d.reg[N_USED] = goals, used
            return False
    return True


@kernel(_nrt=False)
def _minimise(s, d, mark, n_literals):  # type: ignore[no-untyped-def]
    """As `analyse.minimise`: return the number of literals, the level to go back to, and the number of levels."""
    marks, trail, learnt, stamp = s.marks, s.trail, s.learnt, s.stamp
    for k in range(n_literals):
        stamp[trail[marks[learnt[k, 0], AT], DEPTH]] = mark
    kept = 1
    for k in range(1, n_literals):
        edge = learnt[k, 0]
        if trail[marks[edge, AT], WHY] != DECIDED and _is_implied(s, d, mark, edge):
            marks[edge, NEED] = -1
        else:
            learnt[kept, 0] = edge
            kept += 1
    level, second, lbd = 0, 1, 0
    for k in range(kept):
        edge = learnt[k, 0]
        depth = trail[marks[edge, AT], DEPTH]
        if stamp[depth] == mark:
            stamp[depth] = mark - 1
            lbd += 1
        if k > 0 and depth > level:
            level, second = depth, k
        learnt[k, 1] = s.reg[FULL] & ~marks[edge, NEED]
        marks[edge, NEED] = -1
    if kept > 1:
        for c in range(2):
            learnt[1, c], learnt[second, c] = learnt[second, c], learnt[1, c]
    return kept, level, lbd


@kernel(_nrt=False)
def _learn(s, d):  # type: ignore[no-untyped-def]
    """Learn from the conflict in the registers and jump back; return CONFLICT, INCONSISTENT or SETS_FULL."""
    reg = s.reg
    n = _analyse(s, d)
    level, lbd, depth = 0, 0, 0
    if n > 0:
        depth = s.trail[s.marks[s.learnt[0, 0], AT], DEPTH]
        n, level, lbd = _minimise(s, d, 2 * reg[CONFLICTS] + 2, n)
    full = d.reg[N_GOALS] > d.goals.shape[0] or d.reg[N_USED] > d.used.size or d.reg[N_UNITS] == d.units.shape[0]
    if full or not _gather(s, d) or d.reg[N_ROWS] == d.sets.shape[0]:
        return SETS_FULL
    if n == 0:
        return INCONSISTENT
    reg[TROUBLE] = NO_TROUBLE
    row = d.reg[N_ROWS]
    d.reg[N_ROWS] += 1
    for w in range(d.total.size):
        d.sets[row, w] = d.total[w]
    if depth - level > LONGEST_JUMP:
        level = depth - 1
    backjump(s, level)
    why, other = STATED, row
    if n > 1:
        why = CLAUSE
        other = add_clause(s, n, lbd)
        d.clause_set[other] = row
    else:
        d.units[d.reg[N_UNITS], 0] = s.learnt[0, 0]
        d.units[d.reg[N_UNITS], 1] = s.learnt[0, 1]
        d.units[d.reg[N_UNITS], 2] = row
        d.reg[N_UNITS] += 1
    edge = s.learnt[0, 0]
    narrow(s, 2 * edge, s.edges[edge, TAIL], s.edges[edge, HEAD], s.dom[2 * edge] & s.learnt[0, 1], why, other, True)
    decay(s.activity)
    reg[CONFLICTS] += 1
    reg[SINCE_RESTART] += 1
    return CONFLICT


@kernel(_nrt=False)
def state_traced(s, d, arcs, masks, rows):  # type: ignore[no-untyped-def]
    """State relations at level 0, each forced by a set of statements, until one leaves nothing.

    Returns
    -------
    FIXPOINT when all are stated (and nothing propagated); INCONSISTENT, with the statements in ``d.total``; SETS_FULL.
    """
    for k in range(arcs.size):
        arc = arcs[k]
        edge, back = arc >> 1, arc & 1
        left = s.dom[arc] & masks[k]
        if left == s.dom[arc]:
            continue
        if left == 0:
            mask = s.converse[masks[k]] if back else masks[k]
            gone = s.reg[FULL] ^ mask
            row = _trace_root(s, d, made_true_at(s.edges, s.trail, edge, gone), gone)
            if row < 0:
                return SETS_FULL
            for w in range(d.total.size):
                d.total[w] = d.sets[row, w] | d.sets[rows[k], w]
            return INCONSISTENT
        narrow(s, arc, s.edges[edge, TAIL + back], s.edges[edge, HEAD - back], left, STATED, rows[k], True)
    return FIXPOINT


@kernel(compile_seconds=8, _nrt=False)
def close_traced(s, d, limit):  # type: ignore[no-untyped-def]
    """Close what is stated, at level 0; answers as `search_traced`, FIXPOINT instead of CONSISTENT."""
    while True:
        if s.reg[TROUBLE] == NO_TROUBLE:
            status = propagate(s, limit)
            if status == FIXPOINT:
                if recheck(s):
                    return FIXPOINT
                continue
            if status != CONFLICT:
                return status
        return _learn(s, d)


@kernel(compile_seconds=8, _nrt=False)
def search_traced(s, d, limit):  # type: ignore[no-untyped-def]
    """Search until an answer, `limit` in the register TICKS, or a shortage of room.

    Returns
    -------
    CONSISTENT; INCONSISTENT, with the statements in ``d.total``; PAUSED, TRAIL_FULL, ARENA_FULL, SETS_FULL or REDUCE.
    """
    reg = s.reg
    while True:
        if reg[TROUBLE] == NO_TROUBLE:
            status = propagate(s, limit)
            if status != FIXPOINT and status != CONFLICT:
                return status
        if reg[TROUBLE] != NO_TROUBLE:
            if reg[ARENA_TOP] + LITERALS + 2 * reg[TOP] > s.arena.size or reg[N_CLAUSES] == s.place.size:
                return ARENA_FULL
            status = _learn(s, d)
            if status != CONFLICT:
                return status
            continue
        if reg[SINCE_RESTART] >= _RESTART_UNIT * luby(reg[RESTARTS] + 1):
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
        _split(s, d, edge)


@kernel(_nrt=False)
def _split(s, d, edge):  # type: ignore[no-untyped-def]
    """Open a decision level that puts a pair where the last scenario had it, or into a tractable part of its relation."""
    reg = s.reg
    reg[LEVEL] += 1
    reg[DECISIONS] += 1
    s.levels[reg[LEVEL], 0] = reg[TOP]
    s.levels[reg[LEVEL], 1] = reg[CURSOR]
    relation = s.dom[2 * edge]
    part = relation & d.phase[edge]
    # a part of a tractable relation need not be settled when the label is another one now
    if part == 0 or s.hull[part] & ~s.marks[edge, LABEL] != 0:
        part = s.split[relation]
    narrow(s, 2 * edge, s.edges[edge, TAIL], s.edges[edge, HEAD], part, DECIDED, 0, True)


@kernel(_nrt=False)
def attach_all(s):  # type: ignore[no-untyped-def]
    """Watch every clause; none is watched yet."""
    for clause in range(s.reg[N_CLAUSES]):
        attach(s, clause)


@kernel(_nrt=False)
def detach_root(s, d):  # type: ignore[no-untyped-def]
    """Replace every clause among the reasons of level 0 by the statements behind it, so that clauses can be dropped.

    Returns
    -------
    Whether there was room.
    """
    full = s.reg[FULL]
    for t in range(s.reg[TOP]):
        if s.trail[t, WHY] == CLAUSE:
            gone = s.trail[t, OLD] & ~s.trail[t, NEW]
            row = _trace_root(s, d, t, full ^ gone)
            if row < 0:
                return False
            s.trail[t, WHY] = STATED
            s.trail[t, OTHER] = row
    return True
