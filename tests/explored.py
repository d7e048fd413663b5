"""What a robot should have found: the true map of the part of a world it explored, and when a found map is that map."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from worlds import world

from ninefold.mapping import PlaneMap, SimulatedWorld


def simulated(seed: int, kind: str, size: int) -> SimulatedWorld:
    """A random world to walk in, its ways named ``w0``, ``w1``, ..."""
    w = world(seed, kind, size)
    return SimulatedWorld(w.points, w.edges, w.paths or None, edge_names=[f"w{e}" for e in range(len(w.edges))])


def true_map(w: SimulatedWorld, vertices: Sequence[int], edges: Mapping[int, str]) -> PlaneMap:
    """The map of some places and ways of a world, from their geometry alone; `edges` gives each way its name."""
    row = {v: i for i, v in enumerate(vertices)}
    return PlaneMap.from_geometry(
        w.points[list(vertices)],
        np.array([[row[int(v)] for v in w.edges[e]] for e in edges], int).reshape(-1, 2),
        [w.path(e) for e in edges] or None,
        vertex_names=[w.vertex_names[v] for v in vertices],
        edge_names=list(edges.values()),
    )


def component_map(w: SimulatedWorld, start: int) -> PlaneMap:
    """The true map of the component that holds a vertex."""
    part = next(part for part in w.components() if start in part)
    inside = set(part)
    return true_map(w, part, {e: w.edge_names[e] for e, (a, _) in enumerate(w.edges.tolist()) if a in inside})


def same_up_to_numbering(found: PlaneMap, true: PlaneMap, tolerance: float) -> None:
    """Match the darts by edge name, end and heading, and compare everything else."""
    assert set(found.vertex_names) == set(true.vertex_names)
    assert set(found.edge_names) == set(true.edge_names)
    to = np.full(true.tail.size, -1)
    for e, name in enumerate(true.edge_names):
        forward = 2 * found.edge_names.row(name)
        fits = [
            d
            for d in (forward, forward + 1)
            if found.vertex_names[int(found.tail[d])] == true.vertex_names[int(true.tail[2 * e])]
            and abs(found.heading_of(d).turn_to(true.heading_of(2 * e))) < tolerance
            and abs(found.heading_of(d ^ 1).turn_to(true.heading_of(2 * e + 1))) < tolerance
        ]
        assert len(fits) == 1
        to[2 * e], to[2 * e + 1] = fits[0], fits[0] ^ 1
        turn = found.turn[fits[0] >> 1] * (-1 if fits[0] & 1 else 1)
        assert abs(turn - true.turn[e]) < 2 * tolerance
    assert np.array_equal(found.next_ccw[to], to[true.next_ccw])
    faces = set(zip(found.face_of[to].tolist(), true.face_of.tolist(), strict=True))
    assert len(faces) == found.n_faces == true.n_faces or not len(to)
    assert (found.outer_face, true.outer_face) in faces or not len(to)
