"""What a type checker infers for the public names; run by mypy, never executed."""

from typing import assert_type

import numpy as np
from numpy.typing import NDArray

from ninefold.layout import Drawing, draw
from ninefold.mapping import Candidate, Dart, Edge, Face, Heading, Line, Localizer, Move, PlaneMap, Point, Region, Vertex
from ninefold.reasoner import Relation, relate, relate_all, relate_pairs


def check(plane: PlaneMap) -> None:
    """Never called."""
    assert_type(PlaneMap.from_rotation({"a": ["b"], "b": ["a"]}), PlaneMap)
    assert_type(plane, PlaneMap)
    assert_type(plane.vertex("a"), Point)
    assert_type(plane.edge("a", "b"), Line)
    assert_type(plane.cycle(["a"]), Region)
    assert_type(plane.parse("vertex:a"), Point | Line | Region)
    assert_type(plane.cycle(["a"]) | plane.face(0), Region)
    assert_type(relate(plane.vertex("a"), plane.edge("0")), Relation)
    assert_type(relate(plane.vertex("a"), plane.edge("0")).rcc8, str | None)
    assert_type(relate_pairs([plane.vertex("a")], [(0, 0)]), NDArray[np.uint16])
    assert_type(relate_all([plane.vertex("a")]), NDArray[np.uint16])
    assert_type(Heading.from_bearing(90).yaw, float)
    assert_type(plane.vertex("a").index, Vertex)
    assert_type(plane.darts_at(plane.vertex("a").index), list[Dart])
    assert_type(plane.face_darts(plane.outer_face), list[Dart])
    assert_type(plane.heading_of(plane.darts_at(Vertex(0))[0]), Heading)
    assert_type(plane.edge("0").edges, tuple[Edge, ...])
    assert_type(plane.edge("0").boundary, frozenset[Vertex])
    assert_type(plane.region([1, 2]).faces, tuple[Face, ...])
    plane.darts_at(plane.outer_face)  # type: ignore[arg-type]
    plane.face_darts(3)  # type: ignore[arg-type]
    plane.heading_of(plane.vertex("a").index)  # type: ignore[arg-type]
    assert_type(draw(plane, highlight=[plane.face(1)]), Drawing)
    robot = Localizer(plane, sigma=0.1)
    assert_type(robot.observe([Heading(0.0)], came_by=0).move(0).move(Heading(1.0)), Localizer)
    assert_type(robot.best_move(), Move)
    assert_type(robot.move(robot.best_move()).candidates(), tuple[Candidate, ...])
    assert_type(robot.likeliest.dart, Dart | None)
    assert_type(robot.inside(plane.face(1)), float)
    robot.observe([0.5])  # type: ignore[list-item]
    robot.move(0.5)  # type: ignore[arg-type]
