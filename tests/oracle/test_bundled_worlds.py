"""The published method's figure 8 and five more graphs of its size: every relation, against cells and against the ground."""

from itertools import combinations

import pytest
import shapely
from naive import de9im

from ninefold.io import samples
from ninefold.layout.truth import TrueShapes
from ninefold.mapping import Line, Point, Region, build
from ninefold.mapping.robot.simulated import explore
from ninefold.reasoner import relate

SMALL = [name for name in samples.names() if name != "helsinki_district"]


@pytest.fixture(scope="module")
def figure8():
    """The map as a robot builds it from its walk, not from geometry."""
    return build(explore(samples.load("figure8").to_world(), start="v6").walk)


def test_there_are_five_more_graphs_in_its_size_range():
    assert len(SMALL) >= 6
    for name in SMALL:
        plane = samples.load(name).to_map()
        assert 4 <= plane.n_vertices <= 10
        assert 6 <= plane.n_edges <= 16


def test_figure_8_is_what_its_text_determines(figure8):
    assert (figure8.n_vertices, figure8.n_edges, figure8.n_faces) == (9, 13, 6)
    ends = {tuple(sorted((figure8.vertex_names[figure8.tail[2 * e]], figure8.vertex_names[figure8.tail[2 * e + 1]])))
            for e in range(13)}  # fmt: skip
    outer, inner = ["v0", "v1", "v8", "v7"], ["v2", "v3", "v6", "v5", "v4"]
    cycle = lambda c: {tuple(sorted(pair)) for pair in zip(c, c[1:] + c[:1], strict=True)}  # noqa: E731
    spokes = {("v1", "v3"), ("v0", "v2"), ("v6", "v8"), ("v4", "v7")}
    assert ends == cycle(outer) | cycle(inner) | spokes
    assert figure8.cycle(outer).n_faces == 5
    assert figure8.cycle(inner).n_faces == 1


@pytest.mark.parametrize("name", SMALL)
def test_every_relation_of_cells_faces_and_short_unions(name):
    source = samples.load(name)
    walked = build(explore(source.to_world()).walk)
    bounded = [f for f in range(walked.n_faces) if f != walked.outer_face]
    sets = [Point(walked, v) for v in range(walked.n_vertices)]
    sets += [Line(walked, edges) for k in (1, 2) for edges in combinations(range(walked.n_edges), k)]
    sets += [Region.from_faces(walked, faces) for k in (1, 2, 3) for faces in combinations(bounded, k)]
    shapes = TrueShapes(source)
    ground = [shapes.of(x) for x in sets]
    for i, j in combinations(range(len(sets)), 2):
        if (i * 7 + j) % 5 == 0:  # a fifth of the pairs, evenly
            relation = relate(sets[i], sets[j])
            assert relation.de9im == de9im(sets[i], sets[j]) == shapely.relate(ground[i], ground[j])
