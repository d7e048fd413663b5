"""Kernels on triangulations: the Schnyder realizer by shelling, and grid coordinates from it."""

from __future__ import annotations

import numpy as np

from ninefold._kernels import kernel

__all__ = ["grid_coordinates", "shell"]


@kernel
def shell(tail, after, before, outer, n_vertices):  # type: ignore[no-untyped-def]
    """Take the vertices of a triangulation off from the top: a canonical ordering, and the three trees of a realizer.

    The outer face is on the left of dart `outer`, which runs from the right root to the left root; the third corner is the
    top. A vertex of the upper boundary comes off when it is the end of no chord. Its boundary neighbours become its parents
    in the left and the right tree, and it becomes the top-tree parent of the vertices it uncovers.

    Returns (order (n - 2,) int32 vertices as they come off, the top first; parent (n, 3) int32 in the trees of the left
    root, the right root and the top, -1 at the three corners).
    """
    left = tail[outer ^ 1]
    right = tail[outer]
    up = before[outer ^ 1]  # left root -> top
    top = tail[up ^ 1]
    order = np.empty(n_vertices - 2, np.int32)
    parent = np.full((n_vertices, 3), -1, np.int32)
    on_rim = np.zeros(n_vertices, np.int8)  # 1 on the boundary, 2 just uncovered
    chords = np.zeros(n_vertices, np.int32)
    to_left = np.full(n_vertices, -1, np.int32)  # dart to the next boundary vertex on the left
    to_right = np.full(n_vertices, -1, np.int32)
    gone = np.zeros(n_vertices, np.bool_)
    on_rim[left] = 1
    on_rim[right] = 1
    on_rim[top] = 1
    to_right[left] = up
    to_left[top] = up ^ 1
    to_right[top] = before[up ^ 1]
    to_left[right] = to_right[top] ^ 1
    # A vertex is pushed when uncovered without chord, or when its last chord goes: at most once per dart.
    stack = np.empty(tail.size + 1, np.int32)
    stack[0] = top
    high = 1
    count = 0
    while high > 0:
        high -= 1
        v = stack[high]
        if gone[v] or chords[v] > 0:
            continue
        gone[v] = True
        on_rim[v] = 0
        order[count] = v
        count += 1
        first = to_left[v]
        last = to_right[v]
        a = tail[first ^ 1]
        b = tail[last ^ 1]
        if v != top:
            parent[v, 0] = a
            parent[v, 1] = b
        d = first
        while d != last:
            x = tail[d ^ 1]
            along = before[d ^ 1]
            to_right[x] = along
            to_left[tail[along ^ 1]] = along ^ 1
            d = after[d]
            if d != last:
                u = tail[d ^ 1]
                parent[u, 2] = v
                on_rim[u] = 2
        d = after[first]
        if d == last:  # the chord under v is boundary now
            for w in (a, b):
                chords[w] -= 1
                if chords[w] == 0 and w != left and w != right:
                    stack[high] = w
                    high += 1
            continue
        while d != last:
            u = tail[d ^ 1]
            g = after[to_left[u]]
            while g != to_right[u]:
                w = tail[g ^ 1]
                if on_rim[w] > 0:
                    chords[u] += 1
                    if on_rim[w] == 1:
                        chords[w] += 1
                g = after[g]
            d = after[d]
        d = after[first]
        while d != last:
            u = tail[d ^ 1]
            on_rim[u] = 1
            if chords[u] == 0:
                stack[high] = u
                high += 1
            d = after[d]
    return order, parent


@kernel
def grid_coordinates(order, parent, left, right, top):  # type: ignore[no-untyped-def]
    """Place the vertices of a realizer on the (n - 2) x (n - 2) grid: (n, 2) int64.

    With t_i(v) the size of v's subtree in tree i and P_i(v) its path to root i, region i of v holds
    r_i = sum of t_i over P_(i+1)(v) and P_(i-1)(v), less t_i(v), vertices; coordinate i is r_i - |P_(i-1)(v)| (Schnyder
    1990, lemma 6 and section 7). The column is the coordinate of the right root, the row that of the top. Parents in the top
    tree come off earlier and parents in the other two later, so one pass each way sums everything.
    """
    n = parent.shape[0]
    xy = np.zeros((n, 2), np.int64)
    size_right = np.ones(n, np.int64)
    size_top = np.ones(n, np.int64)
    over_top = np.zeros(n, np.int64)  # sum of size_right over the path to the top
    over_left = np.zeros((n, 2), np.int64)  # sums of size_right - 1 and of size_top over the path to the left root
    over_right = np.zeros(n, np.int64)  # sum of size_top - 1 over the path to the right root
    over_top[top] = 1
    over_left[left, 1] = 1
    for k in range(1, order.size):
        v = order[k]
        size_right[parent[v, 1]] += size_right[v]
        over_top[v] = over_top[parent[v, 2]] + size_right[v]
    for k in range(order.size - 1, 0, -1):
        v = order[k]
        size_top[parent[v, 2]] += size_top[v]
        a = parent[v, 0]
        over_left[v, 0] = over_left[a, 0] + size_right[v] - 1
        over_left[v, 1] = over_left[a, 1] + size_top[v]
        over_right[v] = over_right[parent[v, 1]] + size_top[v] - 1
        xy[v, 0] = over_top[v] + over_left[v, 0] - size_right[v]
        xy[v, 1] = over_left[v, 1] + over_right[v] - size_top[v]
    xy[left, 0] = 1
    xy[right, 0] = n - 2
    xy[right, 1] = 1
    xy[top, 1] = n - 2
    return xy
