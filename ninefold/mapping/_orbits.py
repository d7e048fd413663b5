"""Kernels on dart arrays: rotation ranks, face orbits, spanning forest, contour of the cotree.

Every kernel is linear in the darts, allocates its results and calls nothing. A dart is an int; ``twin(d) = d ^ 1``.
"""

from __future__ import annotations

import numpy as np

from ninefold._kernels import kernel

__all__ = ["contour", "face_labels", "rotation_ranks", "sort_rotation", "spanning_forest"]


@kernel
def rotation_ranks(tail, next_ccw, n_vertices):  # type: ignore[no-untyped-def]
    """Number the darts around each vertex from its lowest dart on; find what is no rotation.

    Returns (rank (2E,) int32, first (V,) int32 the lowest dart or -1, bad): bad is -1, or a dart whose orbit leaves its
    vertex, does not close, or is a second orbit at its vertex.
    """
    n = tail.size
    rank = np.full(n, -1, np.int32)
    first = np.full(n_vertices, -1, np.int32)
    for d in range(n):
        if rank[d] >= 0:
            continue
        v = tail[d]
        if first[v] >= 0:
            return rank, first, d
        first[v] = d
        x = d
        r = 0
        while rank[x] < 0:
            if tail[x] != v:
                return rank, first, x
            rank[x] = r
            r += 1
            x = next_ccw[x]
        if x != d:
            return rank, first, x
    return rank, first, -1


@kernel
def face_labels(next_face):  # type: ignore[no-untyped-def]
    """Label the orbits of a permutation, numbered by their lowest element: (label (n,) int32, count)."""
    n = next_face.size
    label = np.full(n, -1, np.int32)
    count = 0
    for d in range(n):
        if label[d] < 0:
            x = d
            while label[x] < 0:
                label[x] = count
                x = next_face[x]
            count += 1
    return label, count


@kernel
def spanning_forest(tail, next_ccw, first):  # type: ignore[no-untyped-def]
    """Breadth-first forest: (in_tree (E,) bool, component (V,) int32 numbered by lowest vertex, count)."""
    n_vertices = first.size
    in_tree = np.zeros(tail.size // 2, np.bool_)
    component = np.full(n_vertices, -1, np.int32)
    queue = np.empty(n_vertices, np.int32)
    count = 0
    for root in range(n_vertices):
        if component[root] >= 0:
            continue
        component[root] = count
        queue[0] = root
        head = 0
        end = 1
        while head < end:
            v = queue[head]
            head += 1
            start = first[v]
            if start < 0:
                continue
            d = start
            while True:
                w = tail[d ^ 1]
                if component[w] < 0:
                    component[w] = count
                    in_tree[d >> 1] = True
                    queue[end] = w
                    end += 1
                d = next_ccw[d]
                if d == start:
                    break
        count += 1
    return in_tree, component, count


@kernel
def contour(next_face, face_of, in_tree, outer, n_faces):  # type: ignore[no-untyped-def]
    """Walk once around the cotree, entering each face's subtree and leaving it.

    Arriving at a dart of the spanning tree the walk goes on along the face; at a cotree dart it crosses to the face on
    the other side. That meets every dart once and every cotree edge twice: when its subtree is entered and when it is
    left, which is the preorder numbering and the subtree interval, without a stack.

    Returns (preorder (F,) int32, low (E,) int32, high (E,) int32): the faces below cotree edge e are those with
    low[e] <= preorder < high[e]; tree edges have low = high = 0.
    """
    preorder = np.full(n_faces, -1, np.int32)
    low = np.zeros(in_tree.size, np.int32)
    high = np.zeros(in_tree.size, np.int32)
    preorder[face_of[outer]] = 0
    count = 1
    d = outer
    for _ in range(next_face.size):
        e = d >> 1
        if not in_tree[e]:
            d = d ^ 1
            if low[e] == 0:
                low[e] = count
                preorder[face_of[d]] = count
                count += 1
            else:
                high[e] = count
        d = next_face[d]
    return preorder, low, high


@kernel
def sort_rotation(tail, heading, n_vertices):  # type: ignore[no-untyped-def]
    """Sort the darts at each vertex by heading: counting sort by vertex, then Shell sort of each list, short ones at gap 1.

    Returns (next_ccw (2E,) int32, closest (float), at (int)): the smallest angle between two successive darts of one
    vertex and one of those darts (-1 if no vertex has two).
    """
    n = tail.size
    start = np.zeros(n_vertices + 1, np.int64)
    for d in range(n):
        start[tail[d] + 1] += 1
    for v in range(n_vertices):
        start[v + 1] += start[v]
    fill = np.empty(n_vertices, np.int64)
    for v in range(n_vertices):
        fill[v] = start[v]
    order = np.empty(n, np.int32)
    for d in range(n):
        order[fill[tail[d]]] = d
        fill[tail[d]] += 1
    next_ccw = np.empty(n, np.int32)
    closest = np.inf
    at = -1
    for v in range(n_vertices):
        a = start[v]
        b = start[v + 1]
        gap = 1
        if b - a > 48:
            while 3 * gap < b - a:
                gap = 3 * gap + 1
        while gap > 0:
            for i in range(a + gap, b):
                x = order[i]
                h = heading[x]
                j = i - gap
                while j >= a and heading[order[j]] > h:
                    order[j + gap] = order[j]
                    j -= gap
                order[j + gap] = x
            gap //= 3
        for i in range(a, b):
            x = order[i]
            y = order[i + 1] if i + 1 < b else order[a]
            next_ccw[x] = y
            if x != y:
                gap = heading[y] - heading[x]
                if i + 1 == b:
                    gap += 2 * np.pi
                if gap < closest:
                    closest = gap
                    at = x
    return next_ccw, closest, at
