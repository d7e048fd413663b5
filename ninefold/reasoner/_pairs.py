"""Kernels that relate pairs of sets from their tables of stars.

One set X is *stamped*: ``slot[cell]`` holds its entry, which is valid when it lies within X's own range, so nothing is ever
cleared. Its partners are streamed past it. Codes are those of `ninefold.reasoner.relation`.
"""

from __future__ import annotations

import numpy as np

from ninefold._kernels import kernel

from .relation import BB, BE, BI, CURVE, EB, EE, EI, IB, IE, II

__all__ = ["all_pairs", "listed_pairs"]

ALL_EIGHT = II | IB | IE | BI | BB | BE | EI | EB
NONE = np.uint64(0)


@kernel
def has_number(ends, begin, end, number):  # type: ignore[no-untyped-def]
    """Say whether a preorder number is inside the intervals ends[begin:end]: the parity of a binary search."""
    if begin == end or number < ends[begin] or number >= ends[end - 1]:
        return False
    a = begin
    b = end
    while a < b:
        m = (a + b) >> 1
        if ends[m] <= number:
            a = m + 1
        else:
            b = m
    return ((a - begin) & 1) == 1


@kernel
def popcount(x):  # type: ignore[no-untyped-def]
    """Count the bits of a 64-bit word."""
    x = x - ((x >> np.uint64(1)) & np.uint64(0x5555555555555555))
    x = (x & np.uint64(0x3333333333333333)) + ((x >> np.uint64(2)) & np.uint64(0x3333333333333333))
    x = (x + (x >> np.uint64(4))) & np.uint64(0x0F0F0F0F0F0F0F0F)
    x = x + (x >> np.uint64(8))
    x = x + (x >> np.uint64(16))
    x = x + (x >> np.uint64(32))
    return np.int64(x & np.uint64(0x7F))


@kernel
def transposed(bits):  # type: ignore[no-untyped-def]
    """Transpose the matrix of a code (dimensions not yet in it)."""
    kept = bits & (II | BB | EE | CURVE)
    up = (bits & (IB | BE)) << 2 | (bits & IE) << 4
    down = (bits & (BI | EB)) >> 2 | (bits & EI) >> 4
    return kept | up | down


@kernel
def region_region(x, y, slot, mark, tick, cell, sectors, darts, part, start, ends, end_start, seed, part_start):  # type: ignore[no-untyped-def]
    """Relate region y to the stamped region x."""
    first = start[x]
    many_x = part_start[x + 1] - part_start[x] > 1
    many_y = part_start[y + 1] - part_start[y] > 1
    ii = ib = ie = bi = be = ei = eb = NONE
    curve = NONE
    touched = False
    stop = start[x + 1]
    for j in range(start[y], start[y + 1]):
        i = slot[cell[j]]
        if i < first or i >= stop:
            continue
        touched = True
        if many_x:
            mark[part_start[x] + part[i]] = tick
        if many_y:
            mark[part_start[y] + part[j]] = tick
        sx = sectors[i]
        sy = sectors[j]
        dx = darts[i]
        dy = darts[j]
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
        # nothing more to learn; untouched parts could add nothing either
        if curve and ii and ib and ie and bi and be and ei and eb:
            return ALL_EIGHT | CURVE
    bits = 0
    if touched:
        bits = BB
        bits |= II if ii else 0
        bits |= IB if ib else 0
        bits |= IE if ie else 0
        bits |= BI if bi else 0
        bits |= BE if be else 0
        bits |= EI if ei else 0
        bits |= EB if eb else 0
        bits |= CURVE if curve else 0
    if many_x or not touched:
        for p in range(part_start[x], part_start[x + 1]):
            if not (touched and mark[p] == tick):
                inside = has_number(ends, end_start[y], end_start[y + 1], seed[p])
                bits |= (II | BI | EI) if inside else (IE | BE)
    if many_y or not touched:
        for p in range(part_start[y], part_start[y + 1]):
            if not (touched and mark[p] == tick):
                inside = has_number(ends, end_start[x], end_start[x + 1], seed[p])
                bits |= (II | IB | IE) if inside else (EI | EB)
    return bits


@kernel
def line_region_meet(line_flags, line_darts, sectors, curve):  # type: ignore[no-untyped-def]
    """Bits of a line and a region at one cell that both have."""
    bits = BB if line_flags & np.uint64(1) else IB
    if line_darts & curve:
        bits |= IB | CURVE
    if line_darts & sectors & ~curve:
        bits |= II
    if line_darts & ~sectors & ~curve:
        bits |= IE
    if curve & ~line_darts:
        bits |= EB
    return bits


@kernel
def line_region(
    x, y, slot, mark, tick, cell, sectors, darts, part, start, ends, end_start, seed, part_start, number_at, line_is_x, hit
):  # type: ignore[no-untyped-def]  # noqa: E501
    """Relate the stamped set x to y, one of them a line (or point) and the other a region, as (line, region)."""
    a = x if line_is_x else y  # the line
    b = y if line_is_x else x  # the region
    bits = EI
    shared = 0
    for j in range(start[y], start[y + 1]):
        i = slot[cell[j]]
        if i < start[x] or i >= start[x + 1]:
            continue
        shared += 1
        m = i if line_is_x else j
        k = j if line_is_x else i
        hit[m] = tick
        mark[part_start[a] + part[m]] = tick
        mark[part_start[b] + part[k]] = tick
        bits |= line_region_meet(sectors[m], darts[m], sectors[k], darts[k])
    low = end_start[b]
    high = end_start[b + 1]
    for m in range(start[a], start[a + 1]):
        if sectors[m] == np.uint64(3) and hit[m] != tick:
            bits |= BI if has_number(ends, low, high, number_at[cell[m]]) else BE
    for p in range(part_start[a], part_start[a + 1]):
        if mark[p] != tick:
            bits |= II if has_number(ends, low, high, seed[p]) else IE
    for p in range(part_start[b], part_start[b + 1]):
        if mark[p] != tick:
            bits |= EB
    return bits


@kernel
def line_line(x, y, slot, cell, flags, darts, start, n_darts, n_ends):  # type: ignore[no-untyped-def]
    """Relate line or point y to the stamped line or point x."""
    bits = 0
    shared = 0
    ends_x = 0
    ends_y = 0
    vertices = 0
    for j in range(start[y], start[y + 1]):
        i = slot[cell[j]]
        if i < start[x] or i >= start[x + 1]:
            continue
        vertices += 1
        fx = flags[i]
        fy = flags[j]
        shared += popcount(darts[i] & darts[j])
        if fx & np.uint64(1):
            bits |= BB if fy & np.uint64(1) else BI
        else:
            bits |= IB if fy & np.uint64(1) else II
        ends_x += 1 if fx == np.uint64(3) else 0
        ends_y += 1 if fy == np.uint64(3) else 0
    if shared:
        bits |= II | CURVE
    if shared < n_darts[x] or (n_darts[x] == 0 and vertices == 0):
        bits |= IE
    if shared < n_darts[y] or (n_darts[y] == 0 and vertices == 0):
        bits |= EI
    if ends_x < n_ends[x]:
        bits |= BE
    if ends_y < n_ends[y]:
        bits |= EB
    return bits


@kernel
def stamp(x, slot, cell, start):  # type: ignore[no-untyped-def]
    """Write the entries of x into the slots of their cells."""
    for i in range(start[x], start[x + 1]):
        slot[cell[i]] = i


@kernel
def one_pair(
    x,
    y,
    slot,
    mark,
    hit,
    tick,
    cell,
    sectors,
    darts,
    part,
    start,
    ends,
    end_start,
    seed,
    part_start,
    number_at,
    dim,
    n_darts,
    n_ends,
):  # type: ignore[no-untyped-def]  # noqa: E501
    """Relate set y to the stamped set x: the whole code of (x, y)."""
    dx = dim[x]
    dy = dim[y]
    if dx == 2 and dy == 2:
        bits = region_region(x, y, slot, mark, tick, cell, sectors, darts, part, start, ends, end_start, seed, part_start)
    elif dx < 2 and dy < 2:
        bits = line_line(x, y, slot, cell, sectors, darts, start, n_darts, n_ends)
    else:
        bits = line_region(
            x, y, slot, mark, tick, cell, sectors, darts, part, start, ends, end_start, seed, part_start, number_at,
            dx < 2, hit,
        )  # fmt: skip
        if dx == 2:
            bits = transposed(bits)
    return bits | EE | dx << 10 | dy << 12


@kernel
def listed_pairs(
    xs, ys, n_cells, cell, sectors, darts, part, start, ends, end_start, seed, part_start, number_at, dim, n_darts, n_ends
):  # type: ignore[no-untyped-def]  # noqa: E501
    """Relate listed pairs, grouped by their first set with one counting sort: codes (P,) uint16."""
    n = start.size - 1
    size = xs.size
    begin = np.zeros(n + 1, np.int64)
    for k in range(size):
        begin[xs[k] + 1] += 1
    for x in range(n):
        begin[x + 1] += begin[x]
    fill = begin[:-1].copy()
    order = np.empty(size, np.int64)
    for k in range(size):
        order[fill[xs[k]]] = k
        fill[xs[k]] += 1
    slot = np.full(n_cells, -1, np.int64)
    mark = np.full(part_start[n] + 1, -1, np.int64)
    hit = np.full(start[n] + 1, -1, np.int64)
    codes = np.empty(size, np.uint16)
    for x in range(n):
        if begin[x] == begin[x + 1]:
            continue
        stamp(x, slot, cell, start)
        for at in range(begin[x], begin[x + 1]):
            k = order[at]
            codes[k] = one_pair(
                x, ys[k], slot, mark, hit, k, cell, sectors, darts, part, start, ends, end_start, seed, part_start,
                number_at, dim, n_darts, n_ends,
            )  # fmt: skip
    return codes


@kernel
def all_pairs(
    n_cells, cell, sectors, darts, part, start, ends, end_start, seed, part_start, number_at, dim, n_darts, n_ends
):  # type: ignore[no-untyped-def]  # noqa: E501
    """Relate every set to every set: codes (n, n) uint16.

    An inverted index from cell to sets finds, for each set, the later sets that touch it; only those are streamed. For the
    rest the stars are empty and a search or two decides. The lower half is the converse of the upper.
    """
    n = start.size - 1
    begin = np.zeros(n_cells + 1, np.int64)
    for i in range(start[n]):
        begin[cell[i] + 1] += 1
    for c in range(n_cells):
        begin[c + 1] += begin[c]
    fill = begin[:-1].copy()
    owner = np.empty(start[n], np.int32)
    for x in range(n):
        for i in range(start[x], start[x + 1]):
            owner[fill[cell[i]]] = x
            fill[cell[i]] += 1
    slot = np.full(n_cells, -1, np.int64)
    nothing = np.full(n_cells, -1, np.int64)
    empty = np.zeros(n + 1, np.int64)
    mark = np.full(part_start[n] + 1, -1, np.int64)
    hit = np.full(start[n] + 1, -1, np.int64)
    near = np.full(n, -1, np.int64)
    codes = np.empty((n, n), np.uint16)
    tick = 0
    for x in range(n):
        stamp(x, slot, cell, start)
        for i in range(start[x], start[x + 1]):
            for k in range(begin[cell[i]], begin[cell[i] + 1]):
                near[owner[k]] = x
        for y in range(x, n):
            tick += 1
            # an untouched region pair needs no streaming at all; a line's ends are still to be looked at
            code = one_pair(
                x, y, slot if near[y] == x else nothing, mark, hit, tick, cell, sectors, darts, part,
                start if near[y] == x or dim[x] < 2 or dim[y] < 2 else empty, ends, end_start, seed, part_start,
                number_at, dim, n_darts, n_ends,
            )  # fmt: skip
            codes[x, y] = code
            codes[y, x] = transposed(code & 1023) | dim[y] << 10 | dim[x] << 12
    return codes
