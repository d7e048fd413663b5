"""Kernels that turn sets into tables of stars: 64-bit words a vertex, grouped by set.

A *cell* is 64 darts of one vertex: vertex v has cells ``cell_start[v] .. cell_start[v + 1] - 1``, mostly one. An
*entry* is the star of one set in one cell:

=======  =====================================================  ===========================================================
field    region                                                 line (a point is a line without darts)
=======  =====================================================  ===========================================================
cell     every cell of every boundary vertex                    every cell of every vertex
sectors  mask of the sectors inside                             bit 0: boundary vertex; bit 1: first cell of its vertex
darts    mask of the boundary darts                             mask of the line's darts
part     number of the connected part of the boundary           number of the connected piece
=======  =====================================================  ===========================================================
"""

from __future__ import annotations

import numpy as np

from ninefold._kernels import kernel

__all__ = ["line_stars", "region_stars"]


@kernel
def root_of(parent, i):  # type: ignore[no-untyped-def]
    """Find the representative of i, halving the way."""
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


@kernel
def join_parts(parent, i, j):  # type: ignore[no-untyped-def]
    """Put i and j into one part; the lower representative stands for both."""
    a = root_of(parent, i)
    b = root_of(parent, j)
    parent[max(a, b)] = min(a, b)


@kernel
def below(rank, chunk):  # type: ignore[no-untyped-def]
    """Mask of the ranks below `rank` that fall into a chunk of 64."""
    r = rank - 64 * chunk
    if r <= 0:
        return np.uint64(0)
    if r >= 64:
        return ~np.uint64(0)
    return (np.uint64(1) << np.uint64(r)) - np.uint64(1)


@kernel
def claim(v, entry_of, start, end, cell_start, cell, parent):  # type: ignore[no-untyped-def]
    """Return the first entry of vertex v in the set with entries start .. end - 1 (made if missing), and the new end."""
    c = cell_start[v]
    i = entry_of[c]
    if start <= i < end and cell[i] == c:
        return i, end
    i = end
    entry_of[c] = i
    for k in range(c, cell_start[v + 1]):
        cell[end] = k
        parent[end] = i
        end += 1
    return i, end


@kernel
def number_parts(start, end, parent, part, seed, part_seed, n_parts):  # type: ignore[no-untyped-def]
    """Number the connected parts of one set from 0, keep a seed (a preorder number) of each; return the running total."""
    first = n_parts
    for i in range(start, end):
        if parent[i] == i:
            part[i] = n_parts - first
            part_seed[n_parts] = seed[i]
            n_parts += 1
    for i in range(start, end):
        part[i] = part[root_of(parent, i)]
    return n_parts


@kernel(compile_seconds=1)
def region_stars(darts, offset, tail, rank, spokes, cell_start, number_of, room):  # type: ignore[no-untyped-def]
    """Build the entries of regions from their boundary darts.

    `darts` (D,) with `offset` (n + 1,) groups by region; `number_of` (2E,) is the preorder number of the face on a dart's
    left; `room` bounds the number of entries. Returns cell, sectors, darts, part, start (n + 1,), part seeds and their
    start (n + 1,).

    Toggling the ranks below every boundary dart leaves a sector set when an odd number of boundary darts lies above it.
    That is the inside if the lowest boundary dart leaves (inside on its left), else its complement.
    """
    n = offset.size - 1
    entry_of = np.full(cell_start[-1], -1, np.int64)
    cell = np.empty(room, np.int32)
    sectors = np.zeros(room, np.uint64)
    curve = np.zeros(room, np.uint64)
    part = np.zeros(room, np.int32)
    parent = np.empty(room, np.int64)
    seed = np.zeros(room, np.int32)
    lowest = np.zeros(room, np.int64)  # 2 * lowest rank + whether that dart arrives
    owner = np.full(room, -1, np.int32)
    part_seed = np.empty(room, np.int32)
    start = np.zeros(n + 1, np.int64)
    part_start = np.zeros(n + 1, np.int64)
    end = 0
    n_parts = 0
    for s in range(n):
        begin = end
        for k in range(offset[s], offset[s + 1]):
            d = darts[k]
            leaving = -1
            for arrives in range(2):
                x = d ^ arrives
                v = tail[x]
                r = rank[x]
                i, end = claim(v, entry_of, begin, end, cell_start, cell, parent)
                if owner[i] < 0 or 2 * r + arrives < lowest[i]:
                    owner[i] = v
                    lowest[i] = 2 * r + arrives
                seed[i] = number_of[d]
                for c in range(cell_start[v + 1] - cell_start[v]):
                    sectors[i + c] ^= below(r, c)
                curve[i + (r >> 6)] |= np.uint64(1) << np.uint64(r & 63)
                if arrives:
                    join_parts(parent, leaving, i)
                leaving = i
        for i in range(begin, end):
            v = owner[i]
            if v >= 0 and lowest[i] & 1:
                for c in range(cell_start[v + 1] - cell_start[v]):
                    sectors[i + c] ^= below(spokes[v], c)
        n_parts = number_parts(begin, end, parent, part, seed, part_seed, n_parts)
        start[s + 1] = end
        part_start[s + 1] = n_parts
    return cell, sectors, curve, part, start, part_seed, part_start


@kernel
def line_stars(edges, offset, tail, rank, cell_start, number_of, first, room):  # type: ignore[no-untyped-def]
    """Build the entries of lines from their edges; as `region_stars`.

    `first` (V,) is a dart at each vertex, for the seeds.
    """
    n = offset.size - 1
    entry_of = np.full(cell_start[-1], -1, np.int64)
    cell = np.empty(room, np.int32)
    flags = np.zeros(room, np.uint64)
    darts = np.zeros(room, np.uint64)
    part = np.zeros(room, np.int32)
    parent = np.empty(room, np.int64)
    seed = np.zeros(room, np.int32)
    part_seed = np.empty(room, np.int32)
    start = np.zeros(n + 1, np.int64)
    part_start = np.zeros(n + 1, np.int64)
    end = 0
    n_parts = 0
    for s in range(n):
        begin = end
        for k in range(offset[s], offset[s + 1]):
            other = -1
            for side in range(2):
                x = 2 * edges[k] + side
                v = tail[x]
                i, end = claim(v, entry_of, begin, end, cell_start, cell, parent)
                seed[i] = number_of[first[v]]
                r = rank[x]
                darts[i + (r >> 6)] |= np.uint64(1) << np.uint64(r & 63)
                for c in range(cell_start[v + 1] - cell_start[v]):
                    flags[i + c] ^= np.uint64(1)
                flags[i] |= np.uint64(2)
                if side:
                    join_parts(parent, other, i)
                other = i
        n_parts = number_parts(begin, end, parent, part, seed, part_seed, n_parts)
        start[s + 1] = end
        part_start[s + 1] = n_parts
    return cell, flags, darts, part, start, part_seed, part_start
