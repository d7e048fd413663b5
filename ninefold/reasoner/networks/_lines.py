"""From noted premises to the lines of a DRAT or LRAT proof, as integers (see `integers`)."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ninefold._kernels import kernel

from ._premises import BEGIN, BY_CLAUSE, CLOSED, DENIED, OPEN, TRIANGLE, find, key_of
from .integers import DELETE, END

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["LINE", "VARIABLE", "Lines", "write_lines"]

# registers
DENIAL = 0  # variable of the denial that the present clause is derived from, or 0
N_WIDE = 1  # exclusions by it
N_OWN = 2  # all exclusions that hang on it
DEFINED = 3  # number of its definition
LINE = 4  # number of the last line, continuing those of the CNF
VARIABLE = 5  # last variable


class Lines(NamedTuple):
    """What the lines speak of, and where the writing stands."""

    place: NDArray[np.int32]
    """(A,) first variable of a pair, or 0."""
    at_least: NDArray[np.int32]
    """(A,) number of the clause that a pair has some base relation."""
    unique: NDArray[np.int64]
    """(A,) number of the first clause that a pair has no two."""
    composed: NDArray[np.int64]
    """(slots, b) numbers of composition clauses, by the place of their triangle in the hash table."""
    turn: NDArray[np.int32]
    """(b,) converse of a base relation."""
    number: NDArray[np.int64]
    """(V + 1,) number of the clause that excludes a base relation of a pair, by variable; 0 where none does."""
    learned: NDArray[np.int64]
    """(C,) number of the line of a learned clause."""
    own: NDArray[np.int32]
    """(V + 1,) scratch: variables excluded under the present denial."""
    own_lines: NDArray[np.int64]
    """(V + 1,) scratch: and in which line."""
    reg: NDArray[np.int64]
    """Registers."""


@kernel(compile_seconds=1.5, _nrt=False)
def write_lines(s, w, x, out, row, hints):  # type: ignore[no-untyped-def]
    """Write rows from `row` down to 0, as many as there is room for.

    Parameters
    ----------
    hints
        Write LRAT instead of DRAT.

    Returns
    -------
    next row (-1 when all are written), integers written, and integers that the next row needs at most
    """
    at = 0
    b = x.turn.size
    while row >= 0:
        kind, a, c, d = w.rows[row, 0], w.rows[row, 1], w.rows[row, 2], w.rows[row, 3]
        least = 8 + 4 * b
        if kind == BY_CLAUSE:
            least = b * (8 + b + b * (s.place[d + 1] - s.place[d]))
        elif kind == OPEN:
            least = 8 + 8 * x.reg[N_WIDE]
        elif kind == CLOSED:
            least = 24 + b + 4 * x.reg[N_WIDE] + 4 * x.reg[N_OWN]
        if at + least > out.size:
            return row, at, least
        if kind == BEGIN:
            x.reg[VARIABLE] += 1
            x.reg[DENIAL] = x.reg[VARIABLE]
            x.reg[N_WIDE] = 0
            x.reg[N_OWN] = 0
        elif kind == DENIED:
            for base in range(b):
                if c >> base & 1:
                    x.own[x.reg[N_WIDE]] = x.place[a] + base
                    x.reg[N_WIDE] += 1
        elif kind == OPEN:
            at = write_denial(x, out, at, hints)
        elif kind == TRIANGLE:
            at = write_triangle(s, w, x, out, at, hints, w.rows[row])
        elif kind == BY_CLAUSE:
            at = write_by_clause(s, x, out, at, hints, a, c, d)
        else:
            at = write_closed(x, out, at, hints, a, c)
        row -= 1
    return -1, at, 0


@kernel(_nrt=False)
def begin_line(x, out, at, hints):  # type: ignore[no-untyped-def]
    """Number the next line."""
    x.reg[LINE] += 1
    if hints:
        out[at] = x.reg[LINE]
        at += 1
    return at


@kernel(_nrt=False)
def exclude(x, variable):  # type: ignore[no-untyped-def]
    """Note that the present line excludes what a variable stands for."""
    x.number[variable] = x.reg[LINE]
    if x.reg[DENIAL]:
        x.own[x.reg[N_OWN]] = variable
        x.own_lines[x.reg[N_OWN]] = x.reg[LINE]
        x.reg[N_OWN] += 1


@kernel(_nrt=False)
def write_excluded(x, out, at, variable):  # type: ignore[no-untyped-def]
    """Write the clause: what the variable stands for is excluded, if the denial holds."""
    if x.reg[DENIAL]:
        out[at] = -x.reg[DENIAL]
        at += 1
    out[at] = -variable
    return at + 1


@kernel(_nrt=False)
def write_denial(x, out, at, hints):  # type: ignore[no-untyped-def]
    """Define the denial: it holds exactly when every base relation that the clause allows is excluded."""
    wide = x.reg[N_WIDE]
    at = begin_line(x, out, at, hints)
    x.reg[DEFINED] = x.reg[LINE]
    out[at] = x.reg[DENIAL]
    at += 1
    for k in range(wide):
        out[at] = x.own[k]
        at += 1
    if hints:
        out[at] = END
        at += 1
    out[at] = 0
    at += 1
    for k in range(wide):
        at = begin_line(x, out, at, hints)
        at = write_excluded(x, out, at, x.own[k])
        if hints:
            out[at] = END
            out[at + 1] = -x.reg[DEFINED]
            at += 2
        out[at] = 0
        at += 1
        exclude(x, x.own[k])
    return at


@kernel(_nrt=False)
def write_triangle(s, w, x, out, at, hints, row):  # type: ignore[no-untyped-def]
    """Exclude a base relation by composition."""
    b = x.turn.size
    pair, t, first, second, need_first, need_second = row[1], row[2], row[3], row[4], row[5], row[6]
    at = begin_line(x, out, at, hints)
    at = write_excluded(x, out, at, x.place[pair] + t)
    if hints:
        out[at] = END
        at += 1
        at = write_numbers_of(s, x, out, at, first, need_first)
        at = write_numbers_of(s, x, out, at, second, need_second)
        slot = find(w.keys, key_of(s, pair, first, t, b))
        for r in range(b):
            if need_first >> r & 1 == 0:
                out[at] = x.composed[slot, r]
                at += 1
        out[at] = x.at_least[min(first, s.back[first])]
        at += 1
    out[at] = 0
    exclude(x, x.place[pair] + t)
    return at + 1


@kernel(_nrt=False)
def write_numbers_of(s, x, out, at, arc, mask):  # type: ignore[no-untyped-def]
    """Write the numbers of the clauses that exclude a mask of an arc."""
    pair = min(arc, s.back[arc])
    for base in range(x.turn.size):
        if mask >> base & 1:
            out[at] = x.number[x.place[pair] + (base if arc == pair else x.turn[base])]
            at += 1
    return at


@kernel(_nrt=False)
def write_by_clause(s, x, out, at, hints, pair, mask, clause):  # type: ignore[no-untyped-def]
    """Exclude what the one literal of a learned clause that can hold excludes."""
    b = x.turn.size
    within = 0
    for k in range(s.place[clause], s.place[clause + 1]):
        if s.literals[k, 0] == pair:
            within = s.literals[k, 1]
    for t in range(b):
        if mask >> t & 1 == 0:
            continue
        at = begin_line(x, out, at, hints)
        at = write_excluded(x, out, at, x.place[pair] + t)
        if hints:
            out[at] = END
            at += 1
            for k in range(s.place[clause], s.place[clause + 1]):
                if s.literals[k, 0] != pair:
                    at = write_numbers_of(s, x, out, at, s.literals[k, 0], s.literals[k, 1])
            for base in range(b):
                if within >> base & 1:
                    r, q = min(base, t), max(base, t)
                    out[at] = x.unique[pair] + r * (2 * b - r - 1) // 2 + q - r - 1
                    at += 1
            out[at] = x.learned[clause]
            at += 1
        out[at] = 0
        at += 1
        exclude(x, x.place[pair] + t)
    return at


@kernel(_nrt=False)
def write_closed(x, out, at, hints, pair, clause):  # type: ignore[no-untyped-def]
    """Conclude that the denial fails, and so the clause holds; then drop what hung on the denial."""
    b = x.turn.size
    denial, wide, own = x.reg[DENIAL], x.reg[N_WIDE], x.reg[N_OWN]
    at = begin_line(x, out, at, hints)
    if denial:
        out[at] = -denial
        at += 1
    if hints:
        out[at] = END
        at += 1
        for base in range(b):
            out[at] = x.number[x.place[pair] + base]
            at += 1
        out[at] = x.at_least[pair]
        at += 1
    out[at] = 0
    at += 1
    if denial == 0:
        return at
    refuted = x.reg[LINE]
    at = begin_line(x, out, at, hints)
    x.learned[clause] = x.reg[LINE]
    for k in range(wide):
        out[at] = x.own[k]
        at += 1
    if hints:
        out[at] = END
        out[at + 1] = refuted
        out[at + 2] = x.reg[DEFINED]
        at += 3
    out[at] = 0
    at += 1
    if hints:
        out[at] = x.reg[LINE]
        out[at + 1] = DELETE
        out[at + 2] = x.reg[DEFINED]
        at += 3
    else:
        out[at] = DELETE
        out[at + 1] = denial
        at += 2
        for k in range(wide):
            out[at] = x.own[k]
            at += 1
        out[at] = 0
        at += 1
    for k in range(own):
        x.number[x.own[k]] = 0
        if hints:
            out[at] = x.own_lines[k]
            at += 1
        else:
            out[at] = DELETE
            out[at + 1] = -denial
            out[at + 2] = -x.own[k]
            out[at + 3] = 0
            at += 4
    if hints:
        out[at] = 0
        at += 1
    x.reg[DENIAL] = 0
    return at
