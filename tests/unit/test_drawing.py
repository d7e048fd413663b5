"""Drawings as values: small maps of every shape, geometry, pictures, and what is refused."""

import sys
import xml.etree.ElementTree as ET

import numpy as np
import pytest
import shapely

from ninefold.errors import BadInput, DifferentMaps, MissingExtra, TooLarge
from ninefold.io import samples
from ninefold.layout import Drawing, draw, drawing_problems, schnyder, tutte
from ninefold.layout.labels import place_labels, text_width
from ninefold.layout.layouts import DEFAULT_LAYOUT
from ninefold.layout.methods.triangulate import check_size
from ninefold.mapping import Mapper, PlaneMap

ONE = PlaneMap.from_darts([], [], n_vertices=1)
EDGE = PlaneMap.from_rotation({"a": ["b"], "b": ["a"]})
PATH = PlaneMap.from_rotation({"a": ["b"], "b": ["a", "c"], "c": ["b", "d"], "d": ["c"]})
STAR = PlaneMap.from_rotation({"o": ["a", "b", "c", "d"], "a": ["o"], "b": ["o"], "c": ["o"], "d": ["o"]})
LOOP = PlaneMap.from_rotation({"a": [("a", "x"), ("a", "x")]}, outer=0)
LOOPS = PlaneMap.from_darts([0, 0, 0, 0], [2, 0, 3, 1], 0)  # one loop within the other
APART = PlaneMap.from_geometry([(0, 0), (1, 0)], np.zeros((0, 2), int))
NESTED = PlaneMap.from_geometry(
    [(0, 0), (9, 0), (0, 9), (1, 1), (3, 1), (1, 3), (1.4, 1.4), (20, 20)], [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3)]
)
BOWTIE = PlaneMap.from_geometry(
    [(0, 0), (2, 1), (2, -1), (-2, 1), (-2, -1)], [(0, 1), (1, 2), (2, 0), (0, 3), (3, 4), (4, 0)]
)
SQUARE = PlaneMap.from_geometry([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)])
SMALL = {
    "one": ONE, "edge": EDGE, "path": PATH, "star": STAR, "loop": LOOP, "loops": LOOPS, "apart": APART, "nested": NESTED,
    "bowtie": BOWTIE, "square": SQUARE,
}  # fmt: skip


@pytest.mark.parametrize("layout", ["schnyder", "tutte"])
@pytest.mark.parametrize("name", SMALL)
def test_small_maps_are_drawn_plane_with_a_picture(name, layout):
    plane = SMALL[name]
    drawing = draw(plane, layout=layout)
    assert drawing_problems(drawing) == ()
    assert drawing.layout == layout
    assert drawing.points.shape == (plane.n_vertices, 2)
    root = ET.fromstring(drawing._repr_svg_())
    texts = {t.text for t in root.iter("{http://www.w3.org/2000/svg}text")}
    assert set(plane.vertex_names) <= texts
    assert not drawing.points.flags.writeable


def test_a_loop_bends_twice_and_parallel_edges_once_but_one():
    assert len(schnyder(LOOP).bends) == 2
    assert schnyder(LOOP).path(0).shape == (4, 2)
    theta = PlaneMap.from_darts([0, 1, 0, 1, 0, 1], [2, 5, 4, 1, 0, 3], 0)
    drawing = schnyder(theta)
    assert [len(drawing.path(e)) for e in range(3)] == [2, 3, 3]
    pieces, edge = drawing.pieces
    assert edge.tolist() == [0, 1, 1, 2, 2]
    assert np.array_equal(pieces[1, 2:], pieces[2, :2])


def test_geometry_has_the_type_of_the_set():
    drawing = schnyder(NESTED)
    assert drawing.geometry(NESTED.vertex(6)).geom_type == "Point"
    assert drawing.geometry(NESTED.edge(0, 1)).geom_type == "LineString"
    assert drawing.geometry(NESTED.line(["0", "4"])).geom_type == "MultiLineString"
    room = drawing.geometry(NESTED.cycle([3, 4, 5]))
    assert room.geom_type == "Polygon"
    host = drawing.geometry(NESTED.cycle([0, 1, 2]) - NESTED.cycle([3, 4, 5]))
    assert len(host.interiors) == 1
    assert host.is_valid
    assert shapely.Polygon(host.interiors[0]).equals(room)
    both = schnyder(BOWTIE).geometry(BOWTIE.cycle([0, 1, 2]) | BOWTIE.cycle([0, 3, 4]))
    assert both.geom_type == "MultiPolygon"
    assert both.is_valid


def test_a_hole_that_touches_the_rim_stays_a_hole():
    plane = PlaneMap.from_geometry(
        [(0, 0), (9, 0), (9, 9), (0, 9), (3, 2), (2, 3)], [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (4, 5), (5, 0)]
    )
    ring = schnyder(plane).geometry(plane.cycle([0, 1, 2, 3]) - plane.cycle([0, 4, 5]))
    assert ring.geom_type == "Polygon"
    assert len(ring.interiors) == 1
    assert ring.is_valid


def test_sets_of_another_map_are_refused():
    with pytest.raises(DifferentMaps, match="another map"):
        schnyder(SQUARE).geometry(STAR.vertex("o"))
    with pytest.raises(DifferentMaps):
        schnyder(SQUARE).to_svg(highlight=STAR.vertex("o"))


def test_an_equal_map_made_twice_is_the_same_map():
    again = PlaneMap.from_darts(EDGE.tail, EDGE.next_ccw, vertex_names=["a", "b"])
    assert again == EDGE
    assert schnyder(EDGE).geometry(again.vertex("b")).equals(shapely.Point(1, 0))


def test_unknown_layouts_sizes_and_arrays_are_refused(tmp_path):
    with pytest.raises(BadInput, match="did you mean 'tutte'"):
        draw(SQUARE, layout="tute")
    with pytest.raises(BadInput, match="the layouts are auto, compass, relaxed, schnyder, tutte"):
        draw(SQUARE, layout="spring")
    with pytest.raises(TooLarge, match="357913943"):
        check_size(400_000_000)
    with pytest.raises(BadInput, match="4 vertices"):
        Drawing.from_points(SQUARE, [(0, 0)])
    with pytest.raises(BadInput, match="finite"):
        Drawing.from_points(SQUARE, [(0, 0), (1, 0), (1, np.nan), (0, 1)])
    with pytest.raises(BadInput, match="shape"):
        Drawing.from_points(SQUARE, [0, 1, 2, 3])
    with pytest.raises(BadInput, match="bend_start"):
        Drawing.from_points(SQUARE, np.eye(4)[:, :2], [(0.0, 0.0)], [0, 0, 0, 0, 0])
    with pytest.raises(BadInput, match="does not exist"):
        schnyder(SQUARE).save(tmp_path / "no" / "such" / "folder.svg")


def test_a_map_too_fine_for_floats_falls_back_and_says_so():
    """Loops nested in loops shrink by a constant factor each: sixty deep are beyond double precision."""
    depth = 60
    outward = [2 * k for k in range(depth)]
    around = [*outward, *[d + 1 for d in reversed(outward)]]
    after = np.empty(2 * depth, int)
    after[around] = np.roll(around, -1)
    plane = PlaneMap.from_darts(np.zeros(2 * depth, int), after, 1)
    drawing = tutte(plane)
    assert drawing.layout == "schnyder"
    assert "too fine for floating point" in drawing.notes[0]
    assert "too fine" in repr(drawing)
    assert drawing_problems(drawing) == ()
    assert "too fine" in drawing.to_svg().replace("\n", " ")


# -- pictures ------------------------------------------------------------------------------------------------------------


def test_svg_colours_sets_by_role_and_explains_them():
    sets = {"room": SQUARE.cycle([0, 1, 2, 3]), "way": SQUARE.path([0, 1, 2]), "door": SQUARE.vertex(3)}
    text = draw(SQUARE).to_svg(highlight=sets, title="A <house> & {garden}")
    root = ET.fromstring(text)
    texts = [t.text for t in root.iter("{http://www.w3.org/2000/svg}text")]
    assert "A <house> & {garden}" in texts
    assert {"room: region of 1 face", "way: line of 2 edges", "door: vertex 3"} <= set(texts)
    assert "prefers-color-scheme:dark" in text
    for k, part in enumerate(("0072B2", "D55E00", "009E73")):
        assert f".f{k}{{fill:#{part}}}" in text


def test_svg_themes_and_options_are_checked():
    light, dark = (draw(SQUARE).to_svg(theme=theme) for theme in ("light", "dark"))
    assert "prefers-color-scheme" not in light + dark
    assert light != dark
    with pytest.raises(BadInput, match="auto, light, dark"):
        draw(SQUARE).to_svg(theme="sepia")
    with pytest.raises(BadInput, match="pixels"):
        draw(SQUARE).to_svg(width=0)
    with pytest.raises(BadInput, match="7 colours"):
        draw(SQUARE).to_svg(highlight=[SQUARE.vertex(0)] * 8)
    with pytest.raises(BadInput, match="highlighted"):
        draw(SQUARE).to_svg(highlight=["0"])


def test_names_that_xml_cannot_hold_are_made_safe():
    plane = PlaneMap.from_rotation({"<a>&\"'": ["b\ufffe\uffff"], "b\ufffe\uffff": ["<a>&\"'"]})
    text = draw(plane).to_svg(title="{height}", highlight={"\x00\ud800": plane.vertex("<a>&\"'")})
    texts = [t.text for t in ET.fromstring(text).iter("{http://www.w3.org/2000/svg}text")]
    assert {"<a>&\"'", "b\ufffd\ufffd", "{height}", "\ufffd\ufffd: vertex <a>&\"'"} <= set(texts)


def test_the_same_drawing_gives_the_same_bytes():
    assert draw(NESTED).to_svg() == draw(NESTED).to_svg()


def test_save_writes_what_to_svg_gives(tmp_path):
    path = tmp_path / "map.svg"
    drawing = draw(SQUARE)
    drawing.save(path, theme="dark")
    assert path.read_text(encoding="utf-8") == drawing.to_svg(theme="dark")


@pytest.mark.parametrize("seed", range(12))
def test_names_never_collide(seed):
    rng = np.random.default_rng(seed)
    points = rng.random((25, 2)) * (700, 500) + 50
    names = [f"vertex {k}" for k in range(25)]
    placed = place_labels(names, points, np.zeros((0, 4)), size=13, dot=4, frame=(0, 0, 800, 600))
    boxes = [(p.x, p.y, text_width(p.text, 13) / 2, 6.5) for p in placed]
    assert len(placed) == 25
    for i, (x, y, w, h) in enumerate(boxes):
        for u, v, a, b in boxes[:i]:
            assert abs(x - u) >= w + a or abs(y - v) >= h + b
        assert (np.abs(points - (x, y)) >= (w, h)).any(axis=1).all()


def test_big_maps_have_no_names_unless_asked():
    n = 60
    ring = PlaneMap.from_rotation({k: [(k + 1) % n, (k - 1) % n] for k in range(n)}, outer=(1, 0))
    assert 'text-anchor="middle"' not in draw(ring).to_svg()
    assert 'text-anchor="middle"' in draw(ring).to_svg(labels=True)


def test_plot_draws_on_given_axes():
    pytest.importorskip("matplotlib", reason="the extra 'plot' is not installed")
    drawing = draw(NESTED)
    room = NESTED.cycle([0, 1, 2]) - NESTED.cycle([3, 4, 5])
    axes = drawing.plot(highlight={"room": room, "way": NESTED.edge(0, 1), "spot": NESTED.vertex(7)})
    assert drawing.plot(axes=axes) is axes
    assert {text.get_text() for text in axes.get_legend().get_texts()} == {"room", "way", "spot"}


def test_plot_without_matplotlib_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    monkeypatch.setitem(sys.modules, "matplotlib.collections", None)
    with pytest.raises(MissingExtra, match=r"ninefold\[plot\]"):
        draw(SQUARE).plot()


# -- draw ----------------------------------------------------------------------------------------------------------------


def test_one_default_layout_for_python_and_the_command_line():
    import inspect

    from ninefold.cli.pictures import draw as command

    assert inspect.signature(command).parameters["layout"].default == DEFAULT_LAYOUT == "auto"
    assert draw(SQUARE).layout == draw(SQUARE, layout="auto").layout == "compass"
    bare = PlaneMap.from_rotation({"a": ["b", "c"], "b": ["c", "a"], "c": ["a", "b"]}, outer=("b", "a"))
    assert draw(bare).to_svg() == draw(bare, layout="tutte").to_svg()  # no headings


def test_a_drawing_keeps_what_it_highlights():
    room, door = SQUARE.cycle(["0", "1", "2", "3"]), SQUARE.vertex(0)
    drawing = draw(SQUARE, highlight={"room": room, "door": door})
    assert drawing.highlight == (("room", room), ("door", door))
    for picture in (drawing.to_svg(), drawing._repr_svg_()):
        assert "room: region of 1 face" in picture
        assert "door: vertex 0" in picture
    assert drawing.to_svg() == draw(SQUARE).to_svg(highlight={"room": room, "door": door})
    assert "room" not in drawing.to_svg(highlight=[])
    assert "X: vertex 0" in drawing.to_svg(highlight=door)
    assert "room" not in drawing.to_svg(highlight=door)
    assert draw(SQUARE, highlight=[room]).highlight == draw(SQUARE, highlight=room).highlight == (("X", room),)
    assert drawing.highlighting([door]).highlight == (("X", door),)
    assert "highlight room, door" in repr(drawing)
    assert draw(SQUARE, highlight=[]).highlight == ()


def test_saved_pictures_show_the_highlight(tmp_path):
    draw(SQUARE, highlight={"way in": SQUARE.edge("0", "1")}).save(tmp_path / "a.svg")
    assert "way in: line of 1 edge" in (tmp_path / "a.svg").read_text()


@pytest.mark.parametrize(
    ("given", "match"),
    [
        (lambda: SQUARE.vertex(0), r"draw takes a map, and Point\(0\) is a set of one: draw\(X.plane, highlight=\[X\]\)"),
        (lambda: Mapper(), r"draw takes a map, not the Mapper that holds one: draw\(X.plane\)"),
        (lambda: samples.load("figure8"), r"draw takes a map, and a Source makes one: draw\(X.to_map\(\)\)"),
        (lambda: "plan.atlas", "draw takes a PlaneMap, not 'plan.atlas'; nf.read_map"),
        (lambda: None, "draw takes a PlaneMap, not None"),
    ],
)
def test_drawing_what_is_no_map_says_what_to_call(given, match):
    with pytest.raises(BadInput, match=match):
        draw(given())


@pytest.mark.parametrize("highlight", ["cycle:0,1,2,3", 7, ["cycle:0,1,2,3"], {"room": 3}])
def test_only_sets_are_highlighted(highlight):
    with pytest.raises(BadInput, match=r"highlight.*plane.parse makes a set of text"):
        draw(SQUARE, highlight=highlight)
    with pytest.raises(DifferentMaps):
        draw(SQUARE, highlight=[NESTED.vertex(0)])


def test_a_map_points_to_its_picture():
    for name in ("draw", "plot", "show", "to_svg", "points"):
        with pytest.raises(AttributeError, match=rf"no attribute '{name}'; ninefold.draw\(plane\) makes a picture"):
            getattr(SQUARE, name)
    with pytest.raises(AttributeError, match=r"no attribute 'vertices'$"):
        SQUARE.vertices  # noqa: B018
    assert not hasattr(SQUARE, "__array__")
    assert "ninefold.draw(plane)" in SQUARE._repr_html_()
    assert repr(SQUARE) in SQUARE._repr_html_()
    assert "ninefold.draw(plane)" in PlaneMap.__doc__
