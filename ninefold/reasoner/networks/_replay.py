"""Closure and clauses on arrays, with a trail that says why: what `proofs` confirms with and `clausal` writes from.

It knows nothing of the engine and imports nothing from it: one label for every direction of a pair, a queue of pairs whose
label became smaller, clauses with two watched literals, and a trail that can be walked back.

*Arcs* are the ordered pairs that are kept, sorted by tail and head; ``back[a]`` is the arc the other way. The arc whose tail
is the smaller entity stands for the pair. Composition of two masks is ``low[R, S & 255] | high[R, S >> 8]``, which holds for
up to 14 base relations. A *literal* is (arc of a pair, mask), "the label of the pair lies within the mask".

Functions marked `kernel` run plain or compiled. They take the whole `Replay`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._kernels import kernel
from ninefold.errors import BadInput, TooLarge

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ninefold.encodings.calculus import Calculus

__all__ = [
    "ASSUMED", "CLAUSE", "NEW", "OLD", "OTHER", "PAIR", "STATED", "TOP", "WHY",
    "Literal", "Replay", "append", "arcs_of", "assume", "new_replay", "propagate", "state_labels", "undo",
]  # fmt: skip

Literal = tuple[int, int, int]

MOST_BASES = 14

# trail: one label that became smaller
PAIR = 0
OLD = 1
NEW = 2  # 0 where nothing is left, which is the last entry then
WHY = 3  # first arc of the triangle, or one of the three below
OTHER = 4  # second arc of the triangle, or the clause
TRAIL_COLUMNS = 5
STATED = -1
ASSUMED = -2
CLAUSE = -3

# registers
TOP = 0  # entries on the trail
SEEN = 1  # entries whose clauses have been visited
LIMIT = 2  # clauses from this one on are not used
N_REGISTERS = 3


class Replay(NamedTuple):
    """Arcs, labels, clauses and trail; A arcs, m masks, C clauses of L literals together."""

    start: NDArray[np.int64]
    """(n + 1,) first arc of each entity."""
    head: NDArray[np.int32]
    """(A,)."""
    back: NDArray[np.int32]
    """(A,)."""
    label: NDArray[np.int32]
    """(A,)."""
    low: NDArray[np.int32]
    """(m, 256) composition with the part of a mask below bit 8."""
    high: NDArray[np.int32]
    """(m, m / 256 or 1) and with the rest of it."""
    converse: NDArray[np.int32]
    """(m,)."""
    size: NDArray[np.int32]
    """(m,) number of base relations."""
    queue: NDArray[np.int32]
    """(2, b + 1) first and last queued pair of each size, or -1."""
    behind: NDArray[np.int32]
    """(A,) the next one, -1 for the last, or -2 for a pair that is not queued."""
    trail: NDArray[np.int32]
    """(entries, TRAIL_COLUMNS), room for every base relation of every pair."""
    literals: NDArray[np.int32]
    """(L, 2) pair and mask; the first two of a clause are watched."""
    place: NDArray[np.int64]
    """(C + 1,) first literal of each clause."""
    after: NDArray[np.int32]
    """(2C,) next watch of the same pair: watch 2c + s is of literal s of clause c."""
    watch: NDArray[np.int32]
    """(A,) first watch of a pair, or -1."""
    reg: NDArray[np.int64]
    """Registers."""


def new_replay(
    calculus: Calculus,
    n: int,
    pairs: Sequence[tuple[int, int]] | None,
    stated: Sequence[Literal],
    clauses: Sequence[Sequence[Literal]],
) -> Replay:
    """Lay out the arrays; every label is universal and no clause is in use yet.

    Parameters
    ----------
    pairs
        Pairs that closure looks at beside the stated ones; None for all.
    stated, clauses
        Constraints and clauses over entities, as (i, j, mask).

    Raises
    ------
    BadInput
        A pair that is not of two entities, or a clause about a pair that is not kept.
    TooLarge
        More than 14 base relations.
    """
    if calculus.n_bases > MOST_BASES:
        raise TooLarge(f"calculus {calculus.name!r} has {calculus.n_bases} base relations; proofs hold at most {MOST_BASES}")
    if pairs is None:
        tail = np.repeat(np.arange(n, dtype=np.int64), max(n - 1, 0))
        head = np.tile(np.arange(max(n - 1, 0), dtype=np.int64), n)
        head += head >= tail
        keys = tail * n + head
    else:
        ends = np.array([*pairs, *((i, j) for i, j, _ in stated)], dtype=np.int64).reshape(-1, 2)
        if ends.size and not (ends.min() >= 0 and ends.max() < n and (ends[:, 0] != ends[:, 1]).all()):
            raise BadInput(f"the proof speaks of a pair that is not of two entities below {n}")
        keys = np.sort(np.concatenate([ends[:, 0] * n + ends[:, 1], ends[:, 1] * n + ends[:, 0]]))
        keys = keys[np.diff(keys, prepend=-1) > 0]
        tail, head = keys // max(n, 1), keys % max(n, 1)
    start = np.zeros(n + 1, dtype=np.int64)
    np.cumsum(np.bincount(tail, minlength=n), out=start[1:])
    n_arcs = keys.size
    literals, place = _pack(calculus, n, keys, clauses)
    low, high, converse = _tables(calculus)
    reg = np.zeros(N_REGISTERS, dtype=np.int64)
    return Replay(
        start=start,
        head=head.astype(np.int32),
        back=np.searchsorted(keys, head * n + tail).astype(np.int32),
        label=np.full(n_arcs, calculus.universal, dtype=np.int32),
        low=low,
        high=high,
        converse=converse,
        size=np.array([mask.bit_count() for mask in range(len(converse))], dtype=np.int32),
        queue=np.full((2, calculus.n_bases + 1), -1, dtype=np.int32),
        behind=np.full(n_arcs, -2, dtype=np.int32),
        trail=np.empty((n_arcs // 2 * calculus.n_bases + 1, TRAIL_COLUMNS), dtype=np.int32),
        literals=literals,
        place=place,
        after=np.empty(2 * len(clauses), dtype=np.int32),
        watch=np.full(n_arcs, -1, dtype=np.int32),
        reg=reg,
    )


def arcs_of(replay: Replay, triples: Sequence[Literal]) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """Return the arcs and the masks of constraints (i, j, mask) whose pairs are kept."""
    n = len(replay.start) - 1
    keys = np.repeat(np.arange(n, dtype=np.int64), np.diff(replay.start)) * n + replay.head
    rows = np.array(triples, dtype=np.int64).reshape(-1, 3)
    return np.searchsorted(keys, rows[:, 0] * n + rows[:, 1]), rows[:, 2].astype(np.int32)


def _pack(
    calculus: Calculus, n: int, keys: NDArray[np.int64], clauses: Sequence[Sequence[Literal]]
) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Return the literals of clauses over pairs, and where each clause starts; literals on one pair become one."""
    size = np.array([len(clause) for clause in clauses], dtype=np.int64)
    rows = np.array([literal for clause in clauses for literal in clause], dtype=np.int64).reshape(-1, 3)
    if rows.size and not (rows[:, :2].min() >= 0 and rows[:, :2].max() < n):
        raise BadInput(f"the proof speaks of a pair that is not of two entities below {n}")
    low, high = np.minimum(rows[:, 0], rows[:, 1]), np.maximum(rows[:, 0], rows[:, 1])
    key = low * n + high
    arc = np.searchsorted(keys, key)
    kept = arc < keys.size
    kept[kept] = keys[arc[kept]] == key[kept]
    missing = np.flatnonzero(~kept)
    if missing.size:
        i, j, _ = rows[missing[0]].tolist()
        raise BadInput(f"a clause is about the pair {i}, {j}, which is not among the proof's pairs")
    converse = _converses(calculus)
    mask = (rows[:, 2] & calculus.universal).astype(np.int32)
    mask = np.where(rows[:, 0] > rows[:, 1], converse[mask], mask)
    owner = np.repeat(np.arange(len(clauses)), size)
    joint = owner * max(keys.size, 1) + arc
    same, at = np.unique(joint, return_inverse=True)
    if same.size < joint.size:
        merged = np.zeros(same.size, dtype=np.int32)
        np.bitwise_or.at(merged, at, mask)
        owner, arc, mask = same // max(keys.size, 1), same % max(keys.size, 1), merged
    place = np.zeros(len(clauses) + 1, dtype=np.int64)
    np.cumsum(np.bincount(owner, minlength=len(clauses)), out=place[1:])
    return np.column_stack([arc, mask]).astype(np.int32), place


def _converses(calculus: Calculus) -> NDArray[np.int32]:
    converse = np.zeros(1 << calculus.n_bases, dtype=np.int32)
    for k, c in enumerate(calculus.base_converse.tolist()):
        converse[1 << k : 2 << k] = converse[: 1 << k] | np.int32(1 << c)
    return converse


def _tables(calculus: Calculus) -> tuple[NDArray[np.int32], NDArray[np.int32], NDArray[np.int32]]:
    """Return composition in two parts, and the converses."""
    b = calculus.n_bases
    base = calculus.base_composition.astype(np.int32)
    left = np.zeros((1 << b, b), dtype=np.int32)  # set ; base relation
    for k in range(b):
        left[1 << k : 2 << k] = left[: 1 << k] | base[k]
    low, high = np.zeros((1 << b, 256), dtype=np.int32), np.zeros((1 << b, max(1 << b >> 8, 1)), dtype=np.int32)
    for k in range(b):
        part, bit = (low, k) if k < 8 else (high, k - 8)
        part[:, 1 << bit : 2 << bit] = part[:, : 1 << bit] | left[:, k : k + 1]
    return low, high, _converses(calculus)


@kernel(_nrt=False)
def narrow(s, arc, new, why, other):  # type: ignore[no-untyped-def]
    """Give an arc a smaller label, note why on the trail, and queue its pair."""
    back = s.back[arc]
    if arc > back:
        arc, back = back, arc
        new = s.converse[new]
        if why >= 0:
            why, other = s.back[other], s.back[why]
    reg = s.reg
    at = reg[TOP]
    s.trail[at, PAIR] = arc
    s.trail[at, OLD] = s.label[arc]
    s.trail[at, NEW] = new
    s.trail[at, WHY] = why
    s.trail[at, OTHER] = other
    reg[TOP] = at + 1
    s.label[arc] = new
    s.label[back] = s.converse[new]
    if s.behind[arc] == -2:
        size = s.size[new]
        if s.queue[0, size] < 0:
            s.queue[0, size] = arc
        else:
            s.behind[s.queue[1, size]] = arc
        s.queue[1, size] = arc
        s.behind[arc] = -1


@kernel(_nrt=False)
def take_smallest(s):  # type: ignore[no-untyped-def]
    """Take the pair that was queued first among those of the smallest size, or return -1."""
    for size in range(s.queue.shape[1]):
        pair = s.queue[0, size]
        if pair >= 0:
            s.queue[0, size] = s.behind[pair]
            s.behind[pair] = -2
            return pair
    return -1


@kernel(_nrt=False)
def undo(s, top):  # type: ignore[no-untyped-def]
    """Take back every entry of the trail from `top` on, and empty the queue."""
    reg = s.reg
    for at in range(reg[TOP] - 1, top - 1, -1):
        arc = s.trail[at, PAIR]
        s.label[arc] = s.trail[at, OLD]
        s.label[s.back[arc]] = s.converse[s.trail[at, OLD]]
    reg[TOP] = top
    reg[SEEN] = top
    while take_smallest(s) >= 0:
        pass


@kernel(_nrt=False)
def propagate(s):  # type: ignore[no-untyped-def]
    """Close triangles and visit clauses until nothing changes; return False when a label runs empty."""
    reg = s.reg
    while True:
        while reg[SEEN] < reg[TOP]:
            pair = s.trail[reg[SEEN], PAIR]
            reg[SEEN] += 1
            if s.watch[pair] >= 0 and not visit_clauses(s, pair):
                return False
        pair = take_smallest(s)
        if pair < 0:
            return True
        if not close_triangles(s, pair):
            return False


@kernel(_nrt=False)
def close_triangles(s, pair):  # type: ignore[no-untyped-def]
    """Close every triangle over a pair; return False when a label runs empty."""
    head, label, low, high = s.head, s.label, s.low, s.high
    back = s.back[pair]
    i, j = head[back], head[pair]
    forth, turned = label[pair], label[back]
    x, x_stop, y, y_stop = s.start[i], s.start[i + 1], s.start[j], s.start[j + 1]
    while x < x_stop and y < y_stop:
        if head[x] < head[y]:
            x += 1
        elif head[x] > head[y]:
            y += 1
        else:
            old, source = label[x], label[y]
            new = old & (low[forth, source & 255] | high[forth, source >> 8])
            if new != old:
                narrow(s, x, new, pair, y)
                if new == 0:
                    return False
            left = source & (low[turned, new & 255] | high[turned, new >> 8])
            if left != source:
                narrow(s, y, left, back, x)
                if left == 0:
                    return False
            x += 1
            y += 1
    return True


@kernel(_nrt=False)
def visit_clauses(s, pair):  # type: ignore[no-untyped-def]
    """Visit the clauses that watch a pair; return False when a label runs empty."""
    literals, place, after, label = s.literals, s.place, s.after, s.label
    before, node = -1, s.watch[pair]
    while node >= 0:
        following = after[node]
        clause = node >> 1
        mine = place[clause] + (node & 1)
        partner = place[clause] + 1 - (node & 1)
        if clause >= s.reg[LIMIT] or label[pair] & literals[mine, 1] != 0:
            before, node = node, following
            continue
        other, mask = literals[partner, 0], literals[partner, 1]
        left = label[other] & mask
        if left != label[other]:
            moved = -1
            for k in range(place[clause] + 2, place[clause + 1]):
                if label[literals[k, 0]] & literals[k, 1] != 0:
                    moved = k
                    break
            if moved >= 0:
                swap_literals(literals, mine, moved)
                if before < 0:
                    s.watch[pair] = following
                else:
                    after[before] = following
                after[node] = s.watch[literals[mine, 0]]
                s.watch[literals[mine, 0]] = node
                node = following
                continue
            narrow(s, other, left, CLAUSE, clause)
            if left == 0:
                return False
        before, node = node, following
    return True


@kernel(_nrt=False)
def swap_literals(literals, k, m):  # type: ignore[no-untyped-def]
    """Exchange two literals."""
    for column in range(2):
        literals[k, column], literals[m, column] = literals[m, column], literals[k, column]


@kernel(_nrt=False)
def state_labels(s, arcs, masks):  # type: ignore[no-untyped-def]
    """Narrow arcs to stated masks; return False when a label runs empty."""
    for k in range(arcs.size):
        new = s.label[arcs[k]] & masks[k]
        if new != s.label[arcs[k]]:
            narrow(s, arcs[k], new, STATED, k)
            if new == 0:
                return False
    return True


@kernel(_nrt=False)
def assume(s, clause, full):  # type: ignore[no-untyped-def]
    """Narrow every pair of a clause to what makes its literal false, and propagate; return False at an empty label."""
    for k in range(s.place[clause], s.place[clause + 1]):
        pair = s.literals[k, 0]
        new = s.label[pair] & (full ^ s.literals[k, 1])
        if new != s.label[pair]:
            narrow(s, pair, new, ASSUMED, clause)
            if new == 0:
                return False
    return propagate(s)


@kernel(_nrt=False)
def append(s, clause):  # type: ignore[no-untyped-def]
    """Use a clause from here on, at a fixpoint; return False when a label runs empty.

    The two literals that are watched come first: those that can still hold. A literal that is false now stays so as long as
    the clause is in use, because clauses are given up in the order opposite to that in which they came.
    """
    literals, first, stop = s.literals, s.place[clause], s.place[clause + 1]
    s.reg[LIMIT] = clause + 1
    can_hold = 0
    for k in range(first, stop):
        if s.label[literals[k, 0]] & literals[k, 1] != 0:
            if can_hold < 2:
                swap_literals(literals, k, first + can_hold)
            can_hold += 1
    if stop - first >= 2:
        for side in range(2):
            pair = literals[first + side, 0]
            s.after[2 * clause + side] = s.watch[pair]
            s.watch[pair] = 2 * clause + side
    if can_hold >= 2:
        return True
    if stop == first:
        return False
    pair = literals[first, 0]
    new = s.label[pair] & literals[first, 1]
    if new != s.label[pair]:
        narrow(s, pair, new, CLAUSE, clause)
        if new == 0:
            return False
    return propagate(s)
