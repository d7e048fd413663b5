"""Kernels that triangulate a simple connected plane map by edges inside its own faces.

The kernels work in place on arrays with room for the darts to come. The new edge of a corner cut goes from the tail of
face dart ``p`` to the head of ``d = next_face(p)``: dart x is put after p, its twin y after the face dart that follows d.
The triangle p, d, y is cut off; x replaces p, d on the face that remains.
"""

from __future__ import annotations

import numpy as np

from ninefold._kernels import kernel

from ..corners import join_corners

__all__ = ["close_faces", "fan_faces"]


@kernel
def close_faces(tail, after, before, n_vertices, used):  # type: ignore[no-untyped-def]
    """Make every face a simple cycle: cut each corner at which a face comes back to a vertex. Returns darts used.

    At such a corner (u, v, w) a closed curve through the face and v alone has u on one side and w on the other: they are
    different and not adjacent, so the edge u w keeps the map simple. A map whose faces are simple cycles is biconnected.
    """
    seen = np.full(n_vertices, -1, np.int32)
    done = np.zeros(used, np.bool_)
    for s in range(used):
        if done[s]:
            continue
        done[s] = True
        seen[tail[s]] = s
        p = s
        d = before[p ^ 1]
        while d != s:
            done[d] = True
            if seen[tail[d]] != s:
                seen[tail[d]] = s
                p = d
            else:
                join_corners(tail, after, before, p, before[d ^ 1], used)
                p = used
                used += 2
            d = before[p ^ 1]
    return used


@kernel
def fan_faces(tail, after, before, degree, used):  # type: ignore[no-untyped-def]
    """Triangulate faces that are simple cycles, never doubling an edge. Returns darts used.

    Fan from the face's vertex v1 of least degree. If v1 is already joined to v3, two places on, that edge runs outside the
    face and parts v2 from all the rest of it, so a fan from v2 doubles nothing. Marking the neighbours of the vertex of
    least degree costs, over all faces, the sum over edges of the lesser end degree: linear in a planar map (Chiba and
    Nishizeki 1985).
    """
    mark = np.full(degree.size, -1, np.int32)
    given = used
    done = np.zeros(given, np.bool_)
    for s in range(given):
        if done[s]:
            continue
        a = s
        d = s
        k = 0
        while True:
            if d < given:
                done[d] = True
            if degree[tail[d]] < degree[tail[a]]:
                a = d
            k += 1
            d = before[d ^ 1]
            if d == s:
                break
        if k == 3:
            continue
        d = a
        while True:
            mark[tail[d ^ 1]] = s
            d = after[d]
            if d == a:
                break
        free = False
        b = before[a ^ 1]
        while k > 3:
            c = before[b ^ 1]
            if not free and mark[tail[c]] == s:
                free = True
                a = b
                b = c
                c = before[b ^ 1]
            join_corners(tail, after, before, a, c, used)
            degree[tail[a]] += 1
            degree[tail[c]] += 1
            a = used
            used += 2
            b = c
            k -= 1
    return used
