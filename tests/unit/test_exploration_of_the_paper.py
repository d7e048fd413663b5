"""The paper's map (figure 8) and its exploration v6 v8 v1 v3 v6 (figure 9), one event at a time.

The coordinates are ours: any drawing with the paper's cycles and edges will do, and the mapper sees none of them.
"""

import numpy as np
import pytest

from ninefold.mapping import Closure, Mapper, PlaneMap, Samples, SimulatedWorld, Visit, build, explore

PLACES = {
    "v0": (0, 10), "v1": (10, 10), "v8": (10, 0), "v7": (0, 0),
    "v2": (3, 7), "v3": (7, 7), "v6": (7, 3), "v5": (5, 2), "v4": (3, 3),
}  # fmt: skip
OUTER = ["v0", "v1", "v8", "v7"]
INNER = ["v2", "v3", "v6", "v5", "v4"]
SPOKES = [("v1", "v3"), ("v2", "v0"), ("v6", "v8"), ("v7", "v4")]


@pytest.fixture(scope="module")
def world():
    names = list(PLACES)
    ways = [(ring[k], ring[(k + 1) % len(ring)]) for ring in (OUTER, INNER) for k in range(len(ring))] + SPOKES
    edges = [(names.index(u), names.index(v)) for u, v in ways]
    return SimulatedWorld(list(PLACES.values()), edges, vertex_names=names, edge_names=[f"{u}-{v}" for u, v in ways])


def leg(u, v):
    """Samples along the straight way from u to v, and the visit at its end."""
    (x0, y0), (x1, y1) = PLACES[u], PLACES[v]
    yaw = float(np.arctan2(y1 - y0, x1 - x0))
    return [Samples((yaw, yaw)), Visit(v)]


def state(mapper):
    plane = mapper.plane
    outer = [plane.vertex_names[int(plane.tail[d])] for d in plane.face_darts(plane.outer_face)] if plane.n_edges else []
    assert (plane.n_vertices, plane.n_edges, plane.n_faces) == (mapper.n_vertices, mapper.n_edges, mapper.n_faces)
    return mapper.n_vertices, mapper.n_edges, mapper.n_faces, sorted(set(outer)), mapper.closures


def test_figure_9_step_by_step():
    mapper = Mapper()
    mapper.step(Visit("v6"))
    assert state(mapper) == (1, 0, 1, [], ())
    expected = {
        ("v6", "v8"): (2, 1, 1, ["v6", "v8"], ()),
        ("v8", "v1"): (3, 2, 1, ["v1", "v6", "v8"], ()),
        ("v1", "v3"): (4, 3, 1, ["v1", "v3", "v6", "v8"], ()),
        ("v3", "v6"): (4, 4, 2, ["v1", "v3", "v6", "v8"], (Closure(9, "e3"),)),
    }
    before = state(mapper)
    for (u, v), after in expected.items():
        samples, visit = leg(u, v)
        mapper.step(samples)
        assert state(mapper) == before
        mapper.step(visit)
        assert state(mapper) == after
        before = after
    plane = mapper.plane
    assert plane.cycle(["v6", "v8", "v1", "v3"]).faces == (int(plane.face_of[0]),)  # on the left of v6-v8
    assert plane.edge("e3") == plane.edge("v3", "v6")
    assert plane.outer_face == plane.face_of[1]


def test_the_loop_is_found_as_well_when_walked_the_other_way():
    mapper = Mapper()
    mapper.step(Visit("v6"))
    for u, v in [("v6", "v3"), ("v3", "v1"), ("v1", "v8"), ("v8", "v6")]:
        for event in leg(u, v):
            mapper.step(event)
    assert state(mapper) == (4, 4, 2, ["v1", "v3", "v6", "v8"], (Closure(9, "e3"),))
    assert mapper.plane.outer_face == mapper.plane.face_of[0]


@pytest.mark.parametrize("start", PLACES)
@pytest.mark.parametrize("seed", [None, 1, 2])
def test_the_whole_of_figure_8_from_every_place(world, start, seed):
    walk = explore(world, start=start, seed=seed).walk
    plane = build(walk)
    assert (plane.n_vertices, plane.n_edges, plane.n_faces) == (9, 13, 6)
    assert {plane.vertex_names[int(plane.tail[d])] for d in plane.face_darts(plane.outer_face)} == set(OUTER)
    truth = PlaneMap.from_geometry(world.points, world.edges, vertex_names=world.vertex_names, edge_names=world.edge_names)
    for v in PLACES:
        around, true = ([m.edge_names[d >> 1] for d in m.darts_at(m.vertex_names.row(v))] for m in (plane, truth))
        at = true.index(around[0])
        assert around == true[at:] + true[:at]
