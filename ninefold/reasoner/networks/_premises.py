"""Walk the trail of a replay backwards, and note only the exclusions that the end needs.

An *exclusion* is a pair and a base relation it cannot have. Every entry of the trail excludes a few; `walk` keeps for each
pair which exclusions are needed by what was noted so far, and when it takes back the entry that made one it notes a row:
what is excluded, and by which others. Read from the last row to the first they are a derivation. Exclusions that an
assumption or a clause made are rows too, so the walk goes through learned clauses, each only if it is needed, down to the
statements.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ninefold._kernels import kernel

from ._replay import (
    ASSUMED,
    CLAUSE,
    LIMIT,
    NEW,
    OLD,
    OTHER,
    PAIR,
    SEEN,
    TOP,
    WHY,
    append,
    assume,
    propagate,
    state_labels,
    undo,
)  # fmt: skip

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = [
    "BEGIN",
    "BY_CLAUSE",
    "CLOSED",
    "DENIED",
    "N_KEYS",
    "N_ROWS",
    "OPEN",
    "ROW_COLUMNS",
    "TRIANGLE",
    "Walk",
    "backward",
    "find",
    "forward",
    "key_of",
    "rehash",
]  # fmt: skip

# rows
TRIANGLE = 1  # pair, base relation, first arc, second arc, what is needed of each
BY_CLAUSE = 2  # pair, mask, clause
DENIED = 3  # pair, mask: excluded by denying the clause that is being derived
OPEN = 4  # all rows DENIED of this clause stand before this one
CLOSED = 5  # pair with nothing left, clause that follows
BEGIN = 6  # clause
ROW_COLUMNS = 7


class Walk(NamedTuple):
    """What `backward` writes."""

    need: NDArray[np.int32]
    """(A,) exclusions of a pair that are needed and not yet noted."""
    used: NDArray[np.bool_]
    """(A,) pairs that some row is about."""
    split: NDArray[np.bool_]
    """(A,) pairs that a needed clause is about."""
    wanted: NDArray[np.bool_]
    """(C + 1,) clauses that are needed."""
    mark: NDArray[np.int64]
    """(C + 1,) length of the trail before each clause."""
    support: NDArray[np.int32]
    """(b, b) at ``[t, r]`` the s with t in ``r;s``."""
    rows: NDArray[np.int32]
    """(rows, ROW_COLUMNS)."""
    keys: NDArray[np.int64]
    """Hash table of triangles with one base relation: (pair, middle, t), or -1."""
    masks: NDArray[np.int32]
    """Which base relations of the first arc their clauses are needed for."""
    filled: NDArray[np.int64]
    """Rows, and keys, so far."""


N_ROWS = 0
N_KEYS = 1


@kernel(compile_seconds=1.0, _nrt=False)
def forward(s, w, arcs, masks, n_clauses):  # type: ignore[no-untyped-def]
    """State, close, and take up clauses until a label runs empty; return how many were taken up, or -1 if none does."""
    holds = state_labels(s, arcs, masks) and propagate(s)
    for clause in range(n_clauses):
        if not holds:
            return clause
        w.mark[clause] = s.reg[TOP]
        holds = append(s, clause)
    return -1 if holds else n_clauses


@kernel(compile_seconds=1.5, _nrt=False)
def backward(s, w, clause, full):  # type: ignore[no-untyped-def]
    """Go back over the clauses before `clause`, in the state after them, and note what is needed.

    Returns
    -------
    -1 when done, ``clause + 1`` for more room and then to be called again with that, or ``-2 - clause`` for a clause that
    does not follow.
    """
    b = w.support.shape[0]
    while clause > 0:
        if short_of_room(s, w, s.reg[TOP] - w.mark[clause - 1], b):
            return clause
        walk(s, w, w.mark[clause - 1], full)
        s.reg[LIMIT] = clause - 1
        clause -= 1
        if not w.wanted[clause]:
            continue
        level = s.reg[TOP]
        if assume(s, clause, full):
            undo(s, level)
            return -2 - clause
        if short_of_room(s, w, s.reg[TOP] - level, b):
            undo(s, level)
            return clause + 1
        last = s.trail[s.reg[TOP] - 1, PAIR]
        w.need[last] = full
        note(w, CLOSED, last, clause, 0, 0, 0, 0)
        assumed = level
        while assumed < s.reg[TOP] and s.trail[assumed, WHY] == ASSUMED:
            assumed += 1
        walk(s, w, assumed, full)
        note(w, OPEN, 0, 0, 0, 0, 0, 0)
        walk(s, w, level, full)
        note(w, BEGIN, clause, 0, 0, 0, 0, 0)
    if short_of_room(s, w, s.reg[TOP], b):
        return 0
    walk(s, w, 0, full)
    return -1


@kernel(_nrt=False)
def short_of_room(s, w, entries, b):  # type: ignore[no-untyped-def]
    """Tell whether walking over so many entries may write more than there is room for."""
    return (w.filled[N_ROWS] + entries * b + 3 > w.rows.shape[0]) | (2 * (w.filled[N_KEYS] + entries * b) > w.keys.size)


@kernel(_nrt=False)
def walk(s, w, top, full):  # type: ignore[no-untyped-def]
    """Take back the trail down to `top`, noting needed exclusions."""
    trail, need = s.trail, w.need
    for at in range(s.reg[TOP] - 1, top - 1, -1):
        pair = trail[at, PAIR]
        s.label[pair] = trail[at, OLD]
        s.label[s.back[pair]] = s.converse[trail[at, OLD]]
        mask = need[pair] & trail[at, OLD] & (full ^ trail[at, NEW])
        if mask == 0:
            continue
        need[pair] ^= mask
        w.used[pair] = True
        why = trail[at, WHY]
        if why >= 0:
            for t in range(w.support.shape[0]):
                if mask >> t & 1:
                    note_triangle(s, w, pair, t, why, trail[at, OTHER], full)
        elif why == CLAUSE:
            clause = trail[at, OTHER]
            w.wanted[clause] = True
            w.split[pair] = True
            for k in range(s.place[clause], s.place[clause + 1]):
                other = s.literals[k, 0]
                if other != pair:
                    need[other] |= s.literals[k, 1]
            note(w, BY_CLAUSE, pair, mask, clause, 0, 0, 0)
        elif why == ASSUMED:
            note(w, DENIED, pair, mask, 0, 0, 0, 0)
    s.reg[TOP] = top
    s.reg[SEEN] = top
    undo(s, top)


@kernel(_nrt=False)
def note(w, kind, a, b, c, d, e, f):  # type: ignore[no-untyped-def]
    """Append a row."""
    at = w.filled[N_ROWS]
    row = w.rows[at]
    row[0], row[1], row[2], row[3], row[4], row[5], row[6] = kind, a, b, c, d, e, f
    w.filled[N_ROWS] = at + 1


@kernel(_nrt=False)
def note_triangle(s, w, pair, t, first, second, full):  # type: ignore[no-untyped-def]
    """Note that t is excluded by the labels of two arcs, with few exclusions of theirs needed.

    For every r and s with t in ``r;s``, one of the two has to be excluded. What the first arc may still be forces exclusions
    of the second, and the other way round; of the two covers that grow from there, that with fewer new exclusions is taken.
    """
    support, need, b = w.support, w.need, w.support.shape[0]
    one, two = first, second
    needed_one, needed_two = need[one], need[two]
    if one > s.back[one]:
        one = s.back[one]
        needed_one = s.converse[need[one]]
    if two > s.back[two]:
        two = s.back[two]
        needed_two = s.converse[need[two]]
    # cover A: all that the first arc can be, then the rest of it
    a_one, a_two = 0, 0
    for r in range(b):
        if s.label[first] >> r & 1:
            a_two |= support[t, r]
    for r in range(b):
        if support[t, r] & (full ^ a_two):
            a_one |= 1 << r
    # cover B: all that the second arc can be, then the rest of it
    b_one, b_two = 0, 0
    for r in range(b):
        if support[t, r] & s.label[second]:
            b_one |= 1 << r
    for r in range(b):
        if b_one >> r & 1 == 0:
            b_two |= support[t, r]
    if bits((a_one & ~needed_one) | ((a_two & ~needed_two) << b)) <= bits(
        (b_one & ~needed_one) | ((b_two & ~needed_two) << b)
    ):
        b_one, b_two = a_one, a_two
    need[one] |= b_one if one == first else s.converse[b_one]
    need[two] |= b_two if two == second else s.converse[b_two]
    w.used[one] = True
    w.used[two] = True
    note(w, TRIANGLE, pair, t, first, second, b_one, b_two)
    key = key_of(s, pair, first, t, b)
    at = find(w.keys, key)
    if w.keys[at] != key:
        w.keys[at] = key
        w.masks[at] = 0
        w.filled[N_KEYS] += 1
    w.masks[at] |= full ^ b_one


@kernel(_nrt=False)
def bits(mask):  # type: ignore[no-untyped-def]
    """Count the members of a mask."""
    count = 0
    while mask:
        mask &= mask - 1
        count += 1
    return count


@kernel(_nrt=False)
def key_of(s, pair, first, t, b):  # type: ignore[no-untyped-def]
    """Return the key of a pair, the head of an arc from its tail, and a base relation."""
    return (int(pair) * (s.start.size - 1) + int(s.head[first])) * b + int(t)


@kernel(_nrt=False)
def find(keys, key):  # type: ignore[no-untyped-def]
    """Return where a key is, or where it goes."""
    last = keys.size - 1
    at = ((key & 0xFFFFFFFF) * 40503 >> 7 ^ key >> 32) & last
    while keys[at] != -1 and keys[at] != key:
        at = (at + 1) & last
    return at


@kernel(_nrt=False)
def rehash(old_keys, old_masks, keys, masks):  # type: ignore[no-untyped-def]
    """Move a hash table into a larger one."""
    for k in range(old_keys.size):
        if old_keys[k] != -1:
            at = find(keys, old_keys[k])
            keys[at] = old_keys[k]
            masks[at] = old_masks[k]
