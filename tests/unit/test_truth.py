"""True shapes: what a set of the map is on the ground, whatever way the robot took through it."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from ninefold.errors import BadInput, UnknownName
from ninefold.io import samples
from ninefold.io.relations import write_relations
from ninefold.layout import Drawing, drawing_problems
from ninefold.layout.truth import TrueShapes
from ninefold.mapping import build
from ninefold.mapping.robot.simulated import explore
from ninefold.reasoner import de9im_strings, relate_all


@pytest.mark.parametrize("name", samples.names())
def test_a_union_of_blocks_is_the_union_of_their_shapes(name):
    source = samples.load(name)
    plane = build(explore(source.to_world(), seed=2).walk)
    shapes = TrueShapes(source)
    bounded = [face for face in range(plane.n_faces) if face != plane.outer_face]
    blocks = {face: shapes.of(plane.face(face)) for face in bounded}
    assert all(block.is_valid for block in blocks.values())
    assert sum(block.area for block in blocks.values()) == pytest.approx(shapely.polygonize(source.geometry).area)
    rng = np.random.default_rng(3)
    for _ in range(20):
        chosen = rng.choice(bounded, int(rng.integers(1, len(bounded) + 1)), replace=False).tolist()
        shape = shapes.of(plane.region(chosen))
        assert shape.is_valid
        assert shape.symmetric_difference(shapely.union_all([blocks[face] for face in chosen])).area < 1e-6


@pytest.mark.parametrize("name", [name for name in samples.names() if name != "helsinki_district"])
def test_every_pair_of_small_sets_relates_as_its_shapes(name):
    source = samples.load(name)
    plane = build(explore(source.to_world(), seed=5).walk)
    shapes = TrueShapes(source)
    edges = list(plane.edge_names)
    rng = np.random.default_rng(4)
    bounded = [face for face in range(plane.n_faces) if face != plane.outer_face]
    sets = [
        *(plane.vertex(v) for v in plane.vertex_names),
        *(plane.edge(e) for e in edges),
        *(plane.line(rng.choice(edges, int(rng.integers(2, len(edges))), replace=False).tolist()) for _ in range(10)),
        *(plane.region(rng.choice(bounded, int(rng.integers(1, len(bounded) + 1)), replace=False)) for _ in range(15)),
    ]
    ground = np.array([shapes.of(item) for item in sets], dtype=object)
    truth = shapely.relate(ground[:, None], ground[None, :])
    assert (de9im_strings(relate_all(sets)) == truth).all()


def test_a_line_runs_along_the_bends_of_its_edges():
    source = samples.load("garden")
    plane = build(explore(source.to_world(), seed=1).walk)
    shape = TrueShapes(source).of(plane.line(["bow", "lap"]))
    assert shape.length == pytest.approx(source.geometry[[2, 4]][0].length + source.geometry[4].length)
    assert shape.intersects(shapely.Point(12, 2.5))
    assert not shape.intersects(shapely.Point(12, 0))


@pytest.mark.parametrize("name", samples.names())
def test_a_map_lies_on_the_ground_as_its_rotation_and_faces_say(name):
    source = samples.load(name)
    plane = build(explore(source.to_world(), seed=9).walk)
    ground = TrueShapes(source).drawing(plane)
    assert drawing_problems(ground) == ()
    mirrored = Drawing.from_points(plane, ground.points * (-1, 1), ground.bends * (-1, 1), ground.bend_start)
    assert drawing_problems(mirrored) != ()


def test_a_set_of_another_place_is_refused():
    shapes = TrueShapes(samples.load("house"))
    with pytest.raises(UnknownName, match="no vertex named 'tree'"):
        shapes.of(samples.load("garden").to_map().vertex("tree"))


def test_tables_refuse_what_does_not_fit(tmp_path):
    with pytest.raises(BadInput, match="do not fit"):
        write_relations(tmp_path / "t.csv", ["a"], [(0, 1)], [0])
    with pytest.raises(BadInput, match="do not fit"):
        write_relations(tmp_path / "t.csv", ["a", "b"], [(0, 1)], [0, 0])
    assert write_relations(tmp_path / "t.csv", ["a", "b"], np.zeros((0, 2), int), np.zeros(0, int)) == 0
    assert (tmp_path / "t.csv").read_text() == "x,y,name,de9im,rcc8\n"
    with pytest.raises(BadInput, match="exists already"):
        write_relations(tmp_path / "t.csv", ["a", "b"], [(0, 1)], [0])
