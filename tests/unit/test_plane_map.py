"""Constructors, faces, tethers and the errors of the plane map."""

import subprocess
import sys

import networkx as nx
import numpy as np
import pytest

from ninefold.errors import AmbiguousDart, BadInput, NotPlane, UnknownName
from ninefold.mapping import Heading, Names, PlaneMap, bridges, cut_vertices, shortest_path

SQUARE = {"a": ["b", "d"], "b": ["c", "a"], "c": ["d", "b"], "d": ["a", "c"]}


def test_single_vertex():
    plane = PlaneMap.from_darts([], [], n_vertices=1)
    assert (plane.n_vertices, plane.n_edges, plane.n_faces, plane.outer, plane.outer_face) == (1, 0, 1, -1, 0)
    assert plane.vertex(0).name == "0"
    assert plane.degree.tolist() == [0]
    plane.validate()


def test_a_map_without_a_vertex_is_an_error():
    with pytest.raises(BadInput, match="at least one vertex"):
        PlaneMap.from_darts([], [])
    with pytest.raises(BadInput, match="V at least 1"):
        PlaneMap.from_geometry(np.zeros((0, 2)), [])


def test_one_edge_a_loop_and_parallel_edges():
    edge = PlaneMap.from_rotation({"a": ["b"], "b": ["a"]})
    assert (edge.n_faces, edge.outer) == (1, 0)
    loop = PlaneMap.from_rotation({"a": [("a", "ring"), ("a", "ring")]}, outer=1)
    assert loop.cycle(["a"]).edge_set == {0}
    assert loop.degree.tolist() == [2]
    two = PlaneMap.from_rotation({"a": [("b", "x"), ("b", "y")], "b": [("a", "y"), ("a", "x")]}, outer=("a", "b", "x"))
    assert two.cycle(edges=["x", "y"]).n_faces == 1
    with pytest.raises(AmbiguousDart, match="@x, @y"):
        two.edge("a", "b")
    assert two.edge("@y") == two.edge("y") == two.line(["y"])
    assert two.path(["a", "@x", "b", "@y", "a"]).boundary == frozenset()


def test_faces_are_numbered_by_their_lowest_dart_and_lie_on_the_left():
    plane = PlaneMap.from_geometry([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    assert plane.face_of.tolist() == [0, 1] * 4
    assert plane.outer == 1
    assert plane.face_darts(0) == [0, 2, 4, 6]
    assert plane.cycle([0, 1, 2, 3]).faces == (0,)
    assert plane.heading_of(0) == Heading(0.0)
    assert plane.heading_of(3).degrees == -90


def test_integers_are_labels():
    plane = PlaneMap.from_rotation({1: [2], 2: [1]})
    assert plane.vertex(1) == plane.vertex("1")
    assert plane.edge(1, 2) == plane.edge("0")


@pytest.mark.parametrize(
    ("rotation", "outer", "error", "match"),
    [
        ({"a": ["b"], "b": []}, None, BadInput, "mentioned at 'a' but not at 'b'"),
        ({"a": ["bb"], "b": ["a"]}, None, UnknownName, "did you mean 'b'"),
        ({"a": ["b", "b"], "b": ["a", "a"]}, None, AmbiguousDart, "name parallel edges"),
        ({"a": ["b"], "b": ["a"], "c": ["d"], "d": ["c"]}, None, BadInput, "2 components"),
        (SQUARE, None, BadInput, "give outer"),
        (SQUARE, ("a", "c"), BadInput, "no such edge"),
        ({"a": "bc", "b": ["a"], "c": ["a"]}, None, BadInput, "list of names"),
    ],
)
def test_bad_rotations(rotation, outer, error, match):
    with pytest.raises(error, match=match):
        PlaneMap.from_rotation(rotation, outer=outer)


def test_non_plane_rotation_names_genus_and_shortest_part():
    theta = {"a": [("b", k) for k in "xyz"], "b": [("a", k) for k in "xyz"], "tail": []}
    del theta["tail"]
    with pytest.raises(NotPlane, match=r"genus 1.*edges x, y, z") as caught:
        PlaneMap.from_rotation(theta)
    assert caught.value.genus == 1
    assert set(caught.value.edges) == {"x", "y", "z"}


def test_shortest_offending_part_in_a_larger_map():
    """Two crossing chords in one long cycle, and a theta of five short edges elsewhere: the theta is shorter."""
    graph = nx.cycle_graph(30)
    _, embedding = nx.check_planarity(graph)
    rotation = {str(v): [(str(w), f"{min(v, w)}-{max(v, w)}") for w in embedding.neighbors_cw_order(v)] for v in embedding}
    rotation["3"] += [("4", "p"), ("4", "q")]
    rotation["4"] += [("3", "p"), ("3", "q")]  # the same order at both ends: crossed
    with pytest.raises(NotPlane) as caught:
        PlaneMap.from_rotation(rotation)
    assert set(caught.value.edges) == {"3-4", "p", "q"}


def test_bad_darts():
    with pytest.raises(BadInput, match="two for each edge"):
        PlaneMap.from_darts([0], [0])
    with pytest.raises(BadInput, match="no rotation system"):
        PlaneMap.from_darts([0, 1, 0, 1], [0, 1, 2, 3])
    with pytest.raises(BadInput, match="darts from 0 to 1"):
        PlaneMap.from_darts([0, 1], [0, 7])
    with pytest.raises(BadInput, match="integers"):
        PlaneMap.from_darts([0.5, 1.0], [0, 1])
    with pytest.raises(BadInput, match="both or neither"):
        PlaneMap.from_darts([0, 1], [0, 1], heading=[0, 1])
    with pytest.raises(BadInput, match="outer is dart 9"):
        PlaneMap.from_darts([0, 1], [0, 1], 9)
    with pytest.raises(BadInput, match="given twice"):
        PlaneMap.from_darts([0, 1], [0, 1], vertex_names=["a", "a"])


def test_turning_rejects_what_genus_does_not_see():
    """A figure of eight drawn as one loop has genus 0, but its faces do not turn once each."""
    eight = [(0, 0), (2, 2), (2, 0), (0, 2), (0, 0)]
    with pytest.raises(NotPlane, match="turn"):
        PlaneMap.from_geometry([(0, 0)], [(0, 0)], [eight])


def test_given_outer_is_held_against_the_headings():
    square = PlaneMap.from_geometry([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    with pytest.raises(NotPlane, match="by the headings"):
        PlaneMap.from_darts(square.tail, square.next_ccw, 0, heading=square.heading, turn=square.turn)
    star = PlaneMap.from_rotation({"o": ["a", "b", "c"], "a": ["o"], "b": ["o"], "c": ["o"]})
    heading = np.array([0.0, np.pi, 2.0, 2.0 - np.pi, 1.0, 1.0 - np.pi])  # a, c, b, not a, b, c
    with pytest.raises(NotPlane, match="do not increase"):
        PlaneMap.from_darts(star.tail, star.next_ccw, heading=heading, turn=np.zeros(3))


@pytest.mark.parametrize(
    ("points", "edges", "paths", "match"),
    [
        ([(0, 0), (0, 0)], [(0, 1)], None, "no length"),
        ([(0, 0), (1, 1), (2, 2)], [(0, 1), (0, 2)], None, "same direction"),
        ([(0, 0), (np.nan, 1)], [(0, 1)], None, "not finite"),
        (
            [(0, 0), (1e308, 0), (-1e308, 1)],
            [(0, 1), (1, 2), (2, 0)],
            None,
            r"point 1, \(1e\+308, 0\), lies so far out.*1e\+150",
        ),
        ([(0, 0), (1, 0)], [(0, 1)], [[(0, 0), (5, -1e200), (1, 0)]], "the path of edge '0' lies so far out"),
        ([(0, 0), (1, 1)], [(0, 5)], None, "rows of points"),
        ([(0, 0), (1, 1)], [(0, 1)], [[(0, 0), (5, 5)]], "begin and end"),
        ([(0, 0), (1, 1)], [(0, 1)], [[(0, 0), (2, 2), (1, 1)]], "turns back"),
        ([(0, 0), (1, 1)], [(0, 1)], [None, None], "2 paths for 1 edges"),
    ],
)
def test_bad_geometry(points, edges, paths, match):
    with pytest.raises(BadInput, match=match):
        PlaneMap.from_geometry(points, edges, paths)


def test_crossing_edges_of_a_connected_map_are_refused():
    with pytest.raises(NotPlane):
        PlaneMap.from_geometry([(0, 0), (2, 2), (2, 0), (0, 2)], [(0, 1), (2, 3), (0, 2), (1, 3), (0, 3)])


def test_islands_are_tethered_to_the_face_that_hosts_them():
    points = [(0, 0), (9, 0), (9, 9), (0, 9), (1, 1), (4, 1), (4, 4), (1, 4), (2, 2), (3, 2), (20, 0), (6, 6)]
    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (8, 9)]
    plane = PlaneMap.from_geometry(points, edges)
    assert (plane.n_components, plane.n_edges, plane.n_faces) == (5, 9, 3)
    assert plane.tether.sum() == 4
    assert plane.n_vertices - plane.tether.size + plane.n_faces == 2
    house, room = plane.cycle([0, 1, 2, 3]), plane.cycle([4, 5, 6, 7])
    assert set(room.faces) < set(house.faces)
    assert not plane.degree[[10, 11]].any()
    assert room.has_face(int(plane.face_of[plane.first_dart[8]]))  # the bench 8-9 stands in the room
    assert plane.face_of[plane.first_dart[10]] == plane.outer_face
    assert house.has_face(int(plane.face_of[plane.first_dart[11]]))
    with pytest.raises(UnknownName):
        plane.edge(str(plane.tether.size - 1))  # a tether is no edge
    again = PlaneMap.from_darts(
        plane.tail, plane.next_ccw, tether=plane.tether, heading=plane.heading, turn=plane.turn, n_vertices=12
    )
    assert again == plane
    with pytest.raises(BadInput, match="no path joins"):
        shortest_path(plane.vertex(0), plane.vertex(10))


def test_an_edge_of_a_cycle_is_no_tether():
    square = PlaneMap.from_geometry([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    with pytest.raises(BadInput, match="tethers must be bridges"):
        PlaneMap.from_darts(square.tail, square.next_ccw, 1, tether=[True, False, False, False])


def test_networkx_round_trip_and_graph_questions():
    plane = PlaneMap.from_rotation({**SQUARE, "a": ["b", "d", "e"], "e": ["a"]}, outer=("b", "a"))
    again = PlaneMap.from_networkx(plane.to_networkx("embedding"), outer=("b", "a"))
    around = lambda m, v: [m.vertex_names[m.tail[d ^ 1]] for d in m.darts_at(m.vertex_names.row(v))]  # noqa: E731
    for v in plane.vertex_names:
        ours, theirs = around(plane, v), around(again, v)
        assert any(ours == theirs[k:] + theirs[:k] for k in range(len(ours)))
    assert bridges(plane) == ("2",)
    assert cut_vertices(plane) == ("a",)
    assert shortest_path(plane.vertex("e"), plane.vertex("c")).boundary == {4, 2}
    graph = plane.to_networkx()
    assert graph.number_of_edges() == 5
    with pytest.raises(BadInput, match="no rotation system"):
        PlaneMap.from_networkx(graph)
    loop = PlaneMap.from_rotation({"a": [("a", "ring"), ("a", "ring")]}, outer=1)
    with pytest.raises(BadInput, match="no parallel edges"):
        loop.to_networkx("embedding")


def test_maps_are_immutable_and_compare_by_structure():
    one = PlaneMap.from_rotation(SQUARE, outer=("b", "a"))
    two = PlaneMap.from_rotation(SQUARE, outer=("c", "b"))
    assert one == two
    assert hash(one) == hash(two)
    assert one != PlaneMap.from_rotation(SQUARE, outer=("a", "b"))
    with pytest.raises(ValueError, match="read-only"):
        one.tail[0] = 3
    assert repr(one) == "PlaneMap(4 vertices, 4 edges, 2 faces)"


@pytest.mark.parametrize("part", ["mapping", "reasoner", "encodings"])
def test_the_symbolic_core_imports_without_shapely(part):
    code = f"import sys; sys.modules['shapely'] = None; import ninefold.{part}; assert 'numba' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_with_the_root_on_the_path_python_still_starts(request):
    """ADR 1: a root-level `encodings` would shadow the interpreter's own."""
    root = request.config.rootpath
    subprocess.run([sys.executable, "-c", "import ninefold.encodings"], check=True, cwd=root, env={"PYTHONPATH": str(root)})


def test_numpy_integers_are_labels():
    points, edges = [(0, 0), (1, 0)], [(0, 1)]
    plane = PlaneMap.from_geometry(points, edges, vertex_names=np.arange(5, 7), edge_names=np.array([8]))
    assert plane.edge(np.int64(5), np.int32(6)) == plane.edge(8)
    one, two = np.array([1, 2])
    assert PlaneMap.from_rotation({one: [two], two: [one]}, outer=np.int64(0)).edge(1, 2).edges == (0,)
    with pytest.raises(BadInput, match="outer is a dart"):
        PlaneMap.from_rotation({1: [2], 2: [1]}, outer=True)


def test_labels_too_long_to_be_rows_are_unknown():
    plane = PlaneMap.from_geometry([(0, 0), (1, 0)], [(0, 1)])
    for label in ("9" * 5000, 10**5000):
        with pytest.raises(UnknownName):
            plane.vertex(label)
        assert label not in plane.vertex_names


def test_equal_names_have_equal_hashes():
    vertices, edges = Names("vertex", 2), Names("edge", 2, ["0", "1"])
    assert vertices == edges
    assert hash(vertices) == hash(edges)


def test_shortest_offending_part_far_from_the_first_vertex():
    """Two crossing diagonals in the far corner of a grid: found at once, and not by way of the first vertex."""
    side = 60
    at = np.arange(side * side).reshape(side, side)
    rows, columns = np.stack([at[:, :-1], at[:, 1:]], axis=-1), np.stack([at[:-1], at[1:]], axis=-1)
    diagonals = [(at[-2, -2], at[-1, -1]), (at[-2, -1], at[-1, -2])]
    edges = np.concatenate([rows.reshape(-1, 2), columns.reshape(-1, 2), diagonals])
    with pytest.raises(NotPlane, match=r"genus 1.* a shortest") as caught:
        PlaneMap.from_geometry(np.argwhere(at >= 0), edges)
    assert len(caught.value.edges) == 5
    assert {str(len(edges) - 2), str(len(edges) - 1)} < set(caught.value.edges)


def test_a_long_way_to_the_offending_part_is_left_out():
    way = {str(k): [(str(j), f"w{min(j, k)}") for j in (k - 1, k + 1) if j >= 0] for k in range(3000)}
    theta = [("end", k) for k in "xyz"]
    rotation = way | {"3000": [("2999", "w2999"), *theta], "end": [("3000", k) for k in "xyz"]}
    with pytest.raises(NotPlane) as caught:
        PlaneMap.from_rotation(rotation)
    assert caught.value.edges == ("x", "y", "z")


def test_what_a_map_derives_is_read_only_too():
    plane = PlaneMap.from_rotation(SQUARE, outer=("b", "a"))
    index = plane.containment
    arrays = [plane.face_of, plane.next_face, plane.rank, plane.first_dart, plane.spokes, plane.degree]
    for array in [*arrays, index.preorder, index.face_at, index.low, index.high]:
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


@pytest.mark.parametrize(
    ("make", "match"),
    [
        (lambda: PlaneMap.from_darts([[0], [1, 2]], [0, 1]), "tail must be"),
        (lambda: PlaneMap.from_darts([0, 1], [0, 1], tether=[[0], [1, 2]]), "tether must be"),
        (lambda: PlaneMap.from_darts([0, 1], [0, 1], heading=["east", "west"], turn=[0]), "heading must be"),
        (lambda: PlaneMap.from_darts([0, 1], [0, 1], 0.5), "outer is a whole number, not 0.5"),
        (lambda: PlaneMap.from_darts([0, 1], [0, 1], True), "outer is a whole number"),
        (lambda: PlaneMap.from_darts([0, 1], [0, 1], n_vertices=2.7), "n_vertices is a whole number"),
        (lambda: PlaneMap.from_darts([0, 1], [0, 1], n_vertices=10**15), "cannot join 1000000000000000 vertices"),
        (lambda: PlaneMap.from_darts([0, 2**31 - 2], [0, 1]), "cannot join"),
        (lambda: PlaneMap.from_geometry([(0, 0), (10**400, 0)], [(0, 1)]), "array of numbers"),
        (lambda: PlaneMap.from_geometry([(0, 0), (1, 0)], [(0, 1)], [[(0, 0), (10**400, 1), (1, 0)]]), "array of numbers"),
        (lambda: PlaneMap.from_geometry([(0, 0), (1, 0)], [(0, 1), (1,)]), "differ in length"),
        (lambda: PlaneMap.from_geometry([(0, 0), (1, 0)], [(0, -1)]), "found -1"),
    ],
)
def test_what_is_no_array_or_number_is_bad_input(make, match):
    with pytest.raises(BadInput, match=match):
        make()


def test_nodes_that_read_the_same_are_refused():
    graph = nx.PlanarEmbedding()
    graph.add_nodes_from([1, "1"])
    with pytest.raises(BadInput, match="same name"):
        PlaneMap.from_networkx(graph)
