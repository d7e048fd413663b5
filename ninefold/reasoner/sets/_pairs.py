"""Kernels that relate pairs of sets from their tables of stars.

The cells of the map are grouped in *blocks* of 64, and a set keeps one mask for every block it touches. One set X is
*stamped*: ``slot[block]`` holds its block entry, every other slot an entry without cells. All slots stay in the nearest
cache. The blocks of its partners are streamed past it; the common bits of two masks are the shared cells, and counting the
bits below gives their entries. A set's signature tells which of 256 patches of the map it touches; of two large regions only
the blocks in common patches are streamed, and two sets with no common patch are *apart*.

The inner kernels are inlined and the outer ones allocate nothing and count no references, since passing arrays costs more
than relating two short cycles. Codes are those of `ninefold.reasoner.sets.relation`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ninefold._kernels import kernel

from .relation import BB, BE, BI, CURVE, EB, EE, EI, IB, IE, II

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Scratch", "Stars", "all_pairs", "blocks", "grouped", "listed_pairs"]

ALL_EIGHT = II | IB | IE | BI | BB | BE | EI | EB
NONE = np.uint64(0)
FEW_BLOCKS = 40
"""A region of at most so many blocks is streamed whole: finding common patches would cost more than it saves."""


class Stars(NamedTuple):
    """The stars of n sets; entries of one set are consecutive (see `ninefold.reasoner.sets._stars` for their fields)."""

    cell: NDArray[np.int32]
    star: NDArray[np.uint64]  # (M, 2) sectors and darts
    part: NDArray[np.int32]
    start: NDArray[np.int64]  # (n + 1,) entries of each set
    ends: NDArray[np.int32]  # interval ends of the regions, one after another
    end_start: NDArray[np.int64]  # (n + 1,)
    seed: NDArray[np.int32]  # the preorder number of a face beside each part
    part_start: NDArray[np.int64]  # (n + 1,)
    number_at: NDArray[np.int32]  # the preorder number of a face at each cell
    dim: NDArray[np.int64]
    n_darts: NDArray[np.int64]  # of lines
    n_ends: NDArray[np.int64]  # boundary vertices of lines
    signature: NDArray[np.uint64]  # (n, 4)
    block: NDArray[np.int32]  # the blocks each set touches, ascending, set after set
    mask: NDArray[np.uint64]  # which of the 64 cells of the block
    head: NDArray[np.int64]  # the first entry in the block; after the last block one without cells
    block_start: NDArray[np.int64]  # (n + 1,)
    run: NDArray[np.int64]  # where the blocks of each touched patch start, set after set, and the total number of blocks
    run_start: NDArray[np.int64]  # (n + 1,)


class Scratch(NamedTuple):
    """Working memory: the slot of each block, and the tick at which a part or an entry was last touched."""

    slot: NDArray[np.int32]
    mark: NDArray[np.int64]
    hit: NDArray[np.int64]


@kernel(_nrt=False, forceinline=True)
def has_number(t, x, number):  # type: ignore[no-untyped-def]
    """Say whether a preorder number is in region x: the parity of a binary search in its interval ends."""
    begin = t.end_start[x]
    b = t.end_start[x + 1]
    if number < t.ends[begin] or number >= t.ends[b - 1]:
        return False
    a = begin
    while a < b:
        m = (a + b) >> 1
        if t.ends[m] <= number:
            a = m + 1
        else:
            b = m
    return ((a - begin) & 1) == 1


@kernel(_nrt=False, forceinline=True)
def popcount(x):  # type: ignore[no-untyped-def]
    """Count the bits of a 64-bit word."""
    x = x - ((x >> np.uint64(1)) & np.uint64(0x5555555555555555))
    x = (x & np.uint64(0x3333333333333333)) + ((x >> np.uint64(2)) & np.uint64(0x3333333333333333))
    x = (x + (x >> np.uint64(4))) & np.uint64(0x0F0F0F0F0F0F0F0F)
    return np.int64((x * np.uint64(0x0101010101010101)) >> np.uint64(56))  # compilers know this form: one instruction


@kernel(_nrt=False, forceinline=True)
def stamped_entry(t, w, cell):  # type: ignore[no-untyped-def]
    """Return the entry of the stamped set in a cell, or -1."""
    b = np.int64(w.slot[cell >> 6])
    bit = np.uint64(1) << np.uint64(cell & 63)
    if not t.mask[b] & bit:
        return -1
    return t.head[b] + popcount(t.mask[b] & (bit - np.uint64(1)))


@kernel(_nrt=False, forceinline=True)
def transposed(bits):  # type: ignore[no-untyped-def]
    """Transpose the matrix of a code (dimensions not yet in it)."""
    kept = bits & (II | BB | EE | CURVE)
    up = (bits & (IB | BE)) << 2 | (bits & IE) << 4
    down = (bits & (BI | EB)) >> 2 | (bits & EI) >> 4
    return kept | up | down


@kernel(_nrt=False, forceinline=True)
def are_apart(t, x, y):  # type: ignore[no-untyped-def]
    """Say whether the signatures of two sets show that they share no vertex."""
    s = t.signature
    return not (s[x, 0] & s[y, 0] or s[x, 1] & s[y, 1] or s[x, 2] & s[y, 2] or s[x, 3] & s[y, 3])


@kernel(_nrt=False, forceinline=True)
def region_region(t, w, x, y, apart, tick):  # type: ignore[no-untyped-def]
    """Relate region y to the stamped region x."""
    many_x = t.part_start[x + 1] - t.part_start[x] > 1
    many_y = t.part_start[y + 1] - t.part_start[y] > 1
    ii = ib = ie = bi = be = ei = eb = curve = NONE
    touched = False
    full = False
    at = t.run_start[y]
    first = t.block_start[y]
    stop = first if apart else t.block_start[y + 1]
    k = 4 if stop - first <= FEW_BLOCKS else -1  # the word of the signature that is being looked at, 4 for none
    patches = NONE
    its = NONE
    while not full:
        if k < 4:  # many blocks: find the next common patch and take its blocks alone
            while not patches and k < 3:
                at += popcount(its)
                k += 1
                its = t.signature[y, k]
                patches = its & t.signature[x, k]
            if not patches:
                break
            patch = patches & (~patches + np.uint64(1))
            patches ^= patch
            r = at + popcount(its & (patch - np.uint64(1)))
            first = t.run[r]
            stop = t.run[r + 1]
        for b in range(first, stop):
            a = np.int64(w.slot[t.block[b]])
            cells = t.mask[a] & t.mask[b]
            while cells:
                bit = cells & (~cells + np.uint64(1))
                cells ^= bit
                i = t.head[a] + popcount(t.mask[a] & (bit - np.uint64(1)))
                j = t.head[b] + popcount(t.mask[b] & (bit - np.uint64(1)))
                touched = True
                if many_x:
                    w.mark[t.part_start[x] + t.part[i]] = tick
                if many_y:
                    w.mark[t.part_start[y] + t.part[j]] = tick
                sx = t.star[i, 0]
                dx = t.star[i, 1]
                sy = t.star[j, 0]
                dy = t.star[j, 1]
                curve |= dx & dy
                ii |= sx & sy
                ie |= sx & ~sy
                ei |= sy & ~sx
                ox = dx & ~dy
                oy = dy & ~dx
                bi |= ox & sy
                be |= ox & ~sy
                ib |= oy & sx
                eb |= oy & ~sx
            if curve and ii and ib and ie and bi and be and ei and eb:
                full = True  # nothing more to learn, and an untouched part could add nothing either
                break
        if k == 4:
            break
    bits = 0
    if full:
        bits = ALL_EIGHT | CURVE
    else:
        if touched:
            bits = BB
        if ii:
            bits |= II
        if ib:
            bits |= IB
        if ie:
            bits |= IE
        if bi:
            bits |= BI
        if be:
            bits |= BE
        if ei:
            bits |= EI
        if eb:
            bits |= EB
        if curve:
            bits |= CURVE
        if many_x or not touched:
            for p in range(t.part_start[x], t.part_start[x + 1]):
                if not touched or w.mark[p] != tick:
                    bits |= (II | BI | EI) if has_number(t, y, t.seed[p]) else (IE | BE)
        if many_y or not touched:
            for p in range(t.part_start[y], t.part_start[y + 1]):
                if not touched or w.mark[p] != tick:
                    bits |= (II | IB | IE) if has_number(t, x, t.seed[p]) else (EI | EB)
    return bits


@kernel(_nrt=False, forceinline=True)
def line_region(t, w, x, y, apart, tick):  # type: ignore[no-untyped-def]
    """Relate the stamped set x to y, one of them a line (or point) and the other a region, as (line, region)."""
    line_is_x = t.dim[x] < 2
    a = x if line_is_x else y  # the line
    b = y if line_is_x else x  # the region
    bits = EI
    for j in range(t.start[y], t.start[y] if apart else t.start[y + 1]):
        i = stamped_entry(t, w, t.cell[j])
        if i < 0:
            continue
        m = i if line_is_x else j
        k = j if line_is_x else i
        w.hit[m] = tick
        w.mark[t.part_start[a] + t.part[m]] = tick
        w.mark[t.part_start[b] + t.part[k]] = tick
        darts = t.star[m, 1]
        sectors = t.star[k, 0]
        curve = t.star[k, 1]
        bits |= BB if t.star[m, 0] & np.uint64(1) else IB
        if darts & curve:
            bits |= IB | CURVE
        if darts & sectors & ~curve:
            bits |= II
        if darts & ~sectors & ~curve:
            bits |= IE
        if curve & ~darts:
            bits |= EB
    if t.n_ends[a] > 0:
        for m in range(t.start[a], t.start[a + 1]):
            if t.star[m, 0] == np.uint64(3) and w.hit[m] != tick:
                bits |= BI if has_number(t, b, t.number_at[t.cell[m]]) else BE
    for p in range(t.part_start[a], t.part_start[a + 1]):
        if w.mark[p] != tick:
            bits |= II if has_number(t, b, t.seed[p]) else IE
    for p in range(t.part_start[b], t.part_start[b + 1]):
        if w.mark[p] != tick:
            bits |= EB
    return bits


@kernel(_nrt=False, forceinline=True)
def line_line(t, w, x, y, apart):  # type: ignore[no-untyped-def]
    """Relate line or point y to the stamped line or point x."""
    bits = 0
    shared = 0
    ends_x = 0
    ends_y = 0
    vertices = 0
    for j in range(t.start[y], t.start[y] if apart else t.start[y + 1]):
        i = stamped_entry(t, w, t.cell[j])
        if i < 0:
            continue
        vertices += 1
        fx = t.star[i, 0]
        fy = t.star[j, 0]
        shared += popcount(t.star[i, 1] & t.star[j, 1])
        if fx & np.uint64(1):
            bits |= BB if fy & np.uint64(1) else BI
        else:
            bits |= IB if fy & np.uint64(1) else II
        if fx == np.uint64(3):
            ends_x += 1
        if fy == np.uint64(3):
            ends_y += 1
    if shared:
        bits |= II | CURVE
    if shared < t.n_darts[x] or (t.n_darts[x] == 0 and vertices == 0):
        bits |= IE
    if shared < t.n_darts[y] or (t.n_darts[y] == 0 and vertices == 0):
        bits |= EI
    if ends_x < t.n_ends[x]:
        bits |= BE
    if ends_y < t.n_ends[y]:
        bits |= EB
    return bits


@kernel(_nrt=False, forceinline=True)
def one_pair(t, w, x, y, apart, tick):  # type: ignore[no-untyped-def]
    """Relate set y to the stamped set x: the whole code of (x, y)."""
    dx = t.dim[x]
    dy = t.dim[y]
    if dx == 2 and dy == 2:
        bits = region_region(t, w, x, y, apart, tick)
    elif dx < 2 and dy < 2:
        bits = line_line(t, w, x, y, apart)
    else:
        bits = line_region(t, w, x, y, apart, tick)
        if dx == 2:
            bits = transposed(bits)
    return bits | EE | dx << 10 | dy << 12


@kernel(_nrt=False, forceinline=True)
def stamp(t, w, x):  # type: ignore[no-untyped-def]
    """Let the slots of set x point at its blocks."""
    for b in range(t.block_start[x], t.block_start[x + 1]):
        w.slot[t.block[b]] = b


@kernel(_nrt=False, forceinline=True)
def unstamp(t, w, x):  # type: ignore[no-untyped-def]
    """Let the slots of set x point at the block without cells again."""
    for b in range(t.block_start[x], t.block_start[x + 1]):
        w.slot[t.block[b]] = t.block.size


def blocks(cell: NDArray[np.int32], start: NDArray[np.int64], n_cells: int) -> dict[str, NDArray[Any]]:
    """Find the blocks and patches each set touches, its entries being sorted by cell; by their names in `Stars`."""
    n, n_blocks = start.size - 1, (n_cells >> 6) + 1
    owner = np.repeat(np.arange(n), np.diff(start))
    its = cell >> 6
    head = _first_of_runs(owner, its)
    block, block_owner = its[head], owner[head]
    bit = np.uint64(1) << (cell & 63).astype(np.uint64)
    patch = block.astype(np.int64) * 256 // n_blocks
    run = _first_of_runs(block_owner, patch)
    signature = np.zeros((n, 4), np.uint64)
    touched = np.uint64(1) << (patch[run] & 63).astype(np.uint64)
    np.bitwise_or.at(signature, (block_owner[run], patch[run] >> 6), touched)
    return {
        "block": block,
        "mask": np.append(np.bitwise_or.reduceat(bit, head) if head.size else bit, np.uint64(0)),
        "head": np.append(head, 0),
        "block_start": _starts(block_owner, n),
        "signature": signature,
        "run": np.append(run, block.size),
        "run_start": _starts(block_owner[run], n),
    }


def _first_of_runs(owner: NDArray[np.int64], value: NDArray[Any]) -> NDArray[np.int64]:
    """Return where a run of equal values of one owner begins."""
    if not owner.size:
        return np.zeros(0, np.int64)
    changed = (owner[1:] != owner[:-1]) | (value[1:] != value[:-1])
    return np.flatnonzero(np.append(True, changed))


def _starts(owner: NDArray[np.int64], n: int) -> NDArray[np.int64]:
    """Return where each owner's rows start, and their number."""
    return np.append(0, np.cumsum(np.bincount(owner, minlength=n))).astype(np.int64)


def grouped(
    keys: NDArray[np.integer], n: int, order: NDArray[np.int64] | None = None
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Sort numbers stably by their keys: (sorted numbers, start (n + 1,)).

    Parameters
    ----------
    keys
        Integers below `n`.
    order
        The numbers to sort, rows of `keys`; all rows by default.
    """
    numbers = np.arange(keys.size) if order is None else order
    counted = counting_sort.for_work(numbers.size // 20)  # numpy takes a twentieth of a microsecond for each
    if counted is not counting_sort.plain:
        start, result = np.zeros(n + 1, np.int64), np.empty(numbers.size, np.int64)
        counted(keys.astype(np.int32, copy=False), numbers, start, result)
        return result, start
    key = keys[numbers]
    result = numbers[np.argsort(key, kind="stable")]
    return result, _starts(key.astype(np.int64), n)


@kernel(_nrt=False)
def counting_sort(keys, order, start, result):  # type: ignore[no-untyped-def]
    """Sort `order` stably by ``keys[order]`` into `result`; `start` (n + 1,), zeros, becomes where each key starts."""
    n = start.size - 1
    for k in order:
        start[keys[k] + 1] += 1
    for x in range(n):
        start[x + 1] += start[x]
    for k in order:
        result[start[keys[k]]] = k
        start[keys[k]] += 1
    for x in range(n, 0, -1):  # every start was moved to the next one
        start[x] = start[x - 1]
    start[0] = 0


@kernel(_nrt=False, compile_seconds=2)
def listed_pairs(t, w, order, group, ys, codes):  # type: ignore[no-untyped-def]
    """Relate listed pairs: set x with ``ys[k]`` for k in order[group[x]:group[x + 1]]; codes (P,) are written."""
    for x in range(t.start.size - 1):
        if group[x] == group[x + 1]:
            continue
        stamp(t, w, x)
        for at in range(group[x], group[x + 1]):
            k = order[at]
            y = ys[k]
            codes[k] = one_pair(t, w, x, y, are_apart(t, x, y), k)
        unstamp(t, w, x)


@kernel(_nrt=False, compile_seconds=2)
def all_pairs(t, w, owner, begin, near, codes):  # type: ignore[no-untyped-def]
    """Relate every set to every set; codes (n, n) are written.

    The inverted index (`owner`, `begin`) marks, for each set, the sets that touch it; the rest are apart. The lower half of
    the table is the converse of the upper.
    """
    n = t.start.size - 1
    tick = 0
    for x in range(n):
        stamp(t, w, x)
        for i in range(t.start[x], t.start[x + 1]):
            for k in range(begin[t.cell[i]], begin[t.cell[i] + 1]):
                near[owner[k]] = x
        for y in range(x, n):
            tick += 1
            code = one_pair(t, w, x, y, near[y] != x, tick)
            codes[x, y] = code
            codes[y, x] = transposed(code & 1023) | t.dim[y] << 10 | t.dim[x] << 12
        unstamp(t, w, x)
