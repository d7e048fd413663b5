"""From a conflict to a clause: first unique implication point over premises, and its minimisation.

The premises of a conflict are held in the columns NEED and AT of `marks`, one mask a pair (two premises on a pair are
one, on the common part). Going down the trail, the entry that made a premise true is replaced by the premises of its
reason, until one premise alone is younger than the last decision. The clause denies all that are held.

A premise that the others imply is dropped; the proof runs over the trail with a stack and a limit, so it is cut short now
and then but never wrong.

References
----------
J. P. Marques-Silva and K. A. Sakallah, "GRASP", IEEE Trans. Computers 48 (1999); N. Sörensson and A. Biere, "Minimizing
learned clauses", SAT 2009; G. Audemard and L. Simon, "Predicting learnt clauses quality", IJCAI 2009 (LBD).
"""

from __future__ import annotations

from ninefold._kernels import kernel

from .columns import (
    AT,
    CLAUSE_TROUBLE,
    DEPTH,
    EDGE,
    FULL,
    HELD,
    LABEL,
    LITERALS,
    N_HELD,
    N_RECENT,
    NEED,
    RING,
    ROOT,
    SIZE,
    TROUBLE,
    TROUBLE_A,
    TROUBLE_F,
    TROUBLE_G,
    WHY,
)
from .explain import explain, explain_triangle_conflict, made_true_at

__all__ = ["analyse", "conflict_premises", "minimise", "require", "rest_of_clause"]

_LONGEST_PROOF = 60
"""Premises looked at in the attempt to drop one."""


@kernel(_nrt=False)
def require(edges, marks, trail, held, reg, edge, mask, start):  # type: ignore[no-untyped-def]
    """Add a premise to those held; return by how much the number of those made true from entry `start` on grew."""
    need = marks[edge, NEED]
    mask = mask & need
    if mask == need:
        return 0
    at = made_true_at(edges, trail, edge, mask)
    if at < 0:
        return 0
    was_young = need != -1 and marks[edge, AT] >= start
    marks[edge, NEED] = mask
    marks[edge, AT] = at
    if marks[edge, HELD] == 0:
        marks[edge, HELD] = 1
        held[reg[N_HELD]] = edge
        reg[N_HELD] += 1
    return 1 if at >= start and not was_young else 0


@kernel(_nrt=False)
def conflict_premises(s):  # type: ignore[no-untyped-def]
    """Write the premises of the conflict noted in the registers to `State.out`; return their number."""
    reg, arena, out = s.reg, s.arena, s.out
    if reg[TROUBLE] == CLAUSE_TROUBLE:
        at = s.place[reg[TROUBLE_A]] + LITERALS
        n = 0
        for k in range(at, at + 2 * arena[at - LITERALS + SIZE], 2):
            out[n, 0] = arena[k]
            out[n, 1] = reg[FULL] ^ arena[k + 1]
            n += 1
        return n
    return explain_triangle_conflict(s, reg[TROUBLE_A], reg[TROUBLE_F], reg[TROUBLE_G])


@kernel(_nrt=False)
def analyse(s):  # type: ignore[no-untyped-def]
    """Write the clause of the first unique implication point to `learnt`, that literal first; return its length.

    Activities of stated pairs that had a part in it are raised by ``activity[-1]``.
    """
    edges, marks, trail, reg, held, out = s.edges, s.marks, s.trail, s.reg, s.held, s.out
    n = conflict_premises(s)
    reg[N_HELD] = 0
    # the youngest premise, nearly always of the present level, tells where the conflict belongs
    youngest = -1
    for k in range(n):
        youngest = max(youngest, made_true_at(edges, trail, out[k, 0], out[k, 1]))
    if youngest < 0:
        return 0
    start = s.levels[trail[youngest, DEPTH], 0]
    young = 0
    for k in range(n):
        young += require(edges, marks, trail, held, reg, out[k, 0], out[k, 1], start)
    t = youngest
    while True:
        edge = trail[t, EDGE]
        if marks[edge, NEED] != -1 and marks[edge, AT] == t:
            if young == 1:
                break
            wanted = marks[edge, NEED]
            marks[edge, NEED] = -1
            young -= 1
            n = explain(s, t, wanted)
            for k in range(n):
                young += require(edges, marks, trail, held, reg, out[k, 0], out[k, 1], start)
        t -= 1
    s.learnt[0, 0] = trail[t, EDGE]
    return 1 + rest_of_clause(marks, reg, s.activity, s.recent, held, s.learnt)


@kernel(_nrt=False)
def rest_of_clause(marks, reg, activity, recent, held, learnt):  # type: ignore[no-untyped-def]
    """List the pairs held, after the first; raise the activity of stated pairs, held or met on the way."""
    n = 0
    first = learnt[0, 0]
    gain = activity[activity.size - 1]
    for h in range(reg[N_HELD]):
        edge = held[h]
        marks[edge, HELD] = 0
        if marks[edge, LABEL] >= 0:
            activity[edge] += gain
            if reg[RING]:
                recent[reg[N_RECENT] % recent.size] = edge
                reg[N_RECENT] += 1
        if marks[edge, NEED] != -1 and edge != first:
            n += 1
            learnt[n, 0] = edge
    return n


@kernel(_nrt=False)
def _is_implied(s, mark, edge):  # type: ignore[no-untyped-def]
    """Tell whether the premise held on `edge` follows from the others held (or from level 0)."""
    edges, marks, trail, out, stack = s.edges, s.marks, s.trail, s.out, s.stack
    stack[0, 0] = edge
    stack[0, 1] = marks[edge, NEED]
    n_stack = 1
    looked = 0
    while n_stack > 0:
        n_stack -= 1
        t = made_true_at(edges, trail, stack[n_stack, 0], stack[n_stack, 1])
        if trail[t, WHY] == -1:  # a decision
            return False
        n = explain(s, t, stack[n_stack, 1])
        looked += n
        if looked > _LONGEST_PROOF:
            return False
        for k in range(n):
            other, mask = out[k, 0], out[k, 1]
            if other != edge and marks[other, NEED] & marks[other, ROOT] & ~mask == 0:
                continue
            at = made_true_at(edges, trail, other, mask)
            if at < 0:
                continue
            if s.stamp[trail[at, DEPTH]] != mark:  # no premise held at that level: it cannot follow
                return False
            stack[n_stack, 0] = other
            stack[n_stack, 1] = mask
            n_stack += 1
    return True


@kernel(_nrt=False)
def minimise(s, mark, n_literals):  # type: ignore[no-untyped-def]
    """Drop premises that follow from the others, turn the rest into literals, second youngest level second.

    Parameters
    ----------
    mark
        A number not used before: ``State.stamp[l] == mark`` is made to say that level l has a premise.
    n_literals
        Rows of ``State.learnt`` in use; their pairs hold their premises in NEED.

    Returns
    -------
    n_literals, level, lbd
        Literals left, the level to jump back to, and the number of levels among the literals.
    """
    marks, trail, stamp, learnt = s.marks, s.trail, s.stamp, s.learnt
    for k in range(n_literals):
        stamp[trail[marks[learnt[k, 0], AT], DEPTH]] = mark
    kept = 1
    for k in range(1, n_literals):
        edge = learnt[k, 0]
        if trail[marks[edge, AT], WHY] != -1 and _is_implied(s, mark, edge):
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
        learnt[k, 1] = marks[edge, ROOT] & ~marks[edge, NEED]
        marks[edge, NEED] = -1
    if kept > 1:
        _swap_rows(learnt, 1, second)
    return kept, level, lbd


@kernel(_nrt=False)
def _swap_rows(table, k, m):  # type: ignore[no-untyped-def]
    for c in range(2):
        table[k, c], table[m, c] = table[m, c], table[k, c]
