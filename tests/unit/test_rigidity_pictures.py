"""What the headings fix: in words, as counts, and as colours of a picture that every reader can tell apart."""

import copy
import itertools
import pickle
import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from ninefold.errors import BadInput, DifferentMaps
from ninefold.io import samples
from ninefold.layout import Rigidity, compass, draw, rigidity, schnyder
from ninefold.layout import svg as pictures
from ninefold.layout.leg_classes import leg_classes
from ninefold.layout.theme import BELIEF, CONTRADICTED, DARK, EVENED, FIXED, LIGHT
from ninefold.mapping import PlaneMap
from ninefold.mapping.turning import settle_turns

SVG = "{http://www.w3.org/2000/svg}"
BARE = PlaneMap.from_rotation({"a": ["b", "c"], "b": ["c", "a"], "c": ["a", "b"]}, outer=("b", "a"))


def braced(n=7, *, tail=0):
    """An uneven grid of n x n squares with a diagonal in each, and a way of `tail` legs that leaves its corner."""
    rng = np.random.default_rng(3)
    at = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    corners = np.argwhere(at >= 0) + rng.uniform(-0.2, 0.2, (at.size, 2))
    ways = [(at[:-1], at[1:]), (at[:, :-1], at[:, 1:]), (at[:-1, :-1], at[1:, 1:])]
    edges = [np.stack([a.ravel(), b.ravel()], axis=1) for a, b in ways]
    leaving = [(n + 1 + k, n + 1 + 0.5 * (k % 2)) for k in range(tail)]
    edges.append(np.array([(at.size - 1 + k, at.size + k) for k in range(tail)]).reshape(-1, 2))
    points = np.concatenate([corners, np.reshape(leaving, (-1, 2))])
    ends = np.concatenate(edges)
    return PlaneMap.from_geometry(points, ends, edge_names=[f"e{k}" for k in range(len(ends))])


def misread(plane, degrees):
    """The same map with headings of some legs turned; the turns follow, so that the map is still right."""
    heading = np.array(plane.heading)
    for name, by in degrees.items():
        e = plane.edge_names.row(name)
        heading[2 * e : 2 * e + 2] += np.radians(by)
    turn = settle_turns(heading, np.array(plane.turn))
    return PlaneMap.from_darts(
        plane.tail, plane.next_ccw, plane.outer, heading=heading, turn=turn, edge_names=plane.edge_names
    )


WRONG = misread(braced(tail=2), {"e24": 15})


# -- words and counts ----------------------------------------------------------------------------------------------------


def test_counts_agree_with_the_arrays_and_with_the_words():
    plane = samples.load("house").to_map()
    found = rigidity(plane)
    assert found.counts == {"legs": 6, "parts": 2, "largest": 3, "open": 4, "curved": 0}
    assert int(found.fixed.sum()) == 6
    assert np.bincount(found.part[found.fixed]).tolist() == [3, 3]
    assert repr(found) == "Rigidity(6 of 11 legs fixed, 2 parts, 4 open)"
    ring = rigidity(samples.load("ring").to_map())
    assert ring.counts["curved"] == int(ring.curved.sum()) == 11


@pytest.mark.parametrize(
    ("corners", "edges", "words"),
    [
        ([(0, 0), (1, 0)], [(0, 1)], "0 of 1 leg are in parts whose shape the headings fix; 0 legs are curved, and 0 prop"),
        ([(0, 0), (1, 0), (2, 1)], [(0, 1), (1, 2)], "0 legs are curved, and 1 proportion is open"),
        ([(0, 0), (1, 0), (2, 1), (3, 1)], [(0, 1), (1, 2), (2, 3)], "0 legs are curved, and 2 proportions are open"),
    ],
)
def test_one_is_said_in_the_singular(corners, edges, words):
    assert words in str(rigidity(PlaneMap.from_geometry(corners, edges)))


def test_one_curved_leg_is_one():
    assert "1 leg is curved" in str(rigidity(samples.load("crossing").to_map()))


def test_a_leg_that_the_rest_contradicts_is_a_line_of_its_own():
    found = rigidity(WRONG)
    assert found.contradicted == ("e24",)
    (line,) = found.warnings
    degrees = re.fullmatch(
        r"leg 'e24' misses what the other headings say by (\d+) degrees: it is curved, its heading or one beside it is "
        r"wrong, or two places were taken for one",
        line,
    )
    assert int(degrees[1]) == 15
    assert repr(found).endswith("1 contradicted)")
    assert rigidity(braced(tail=2)).warnings == ()


def test_untested_headings_contradict_nothing_and_fix_the_same():
    quick, full = rigidity(WRONG, tested=False), rigidity(WRONG)
    assert quick.contradicted == ()
    assert not quick.miss.any()
    assert quick.counts == full.counts
    assert np.array_equal(quick.part, full.part)


def test_the_arrays_are_nobody_elses_and_stay_read_only():
    found = rigidity(WRONG)
    for name in ("part", "sizes", "redundant", "miss"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(found, name)[0] = 0
    again = pickle.loads(pickle.dumps(found))
    assert again.contradicted == found.contradicted
    assert not again.part.flags.writeable
    assert copy.deepcopy(found) is found


# -- classes of legs -----------------------------------------------------------------------------------------------------


def test_every_leg_is_of_one_class():
    for plane in (WRONG, samples.load("helsinki_district").to_map(), samples.load("crossing").to_map()):
        found = rigidity(plane)
        classes = leg_classes(found)
        assert sorted(e for kind in classes for e in kind.edges) == np.flatnonzero(~plane.tether).tolist()
        for kind in classes:
            parts = found.part[list(kind.edges)]
            match kind.name:
                case "evened":
                    assert not found.fixed[list(kind.edges)].any()
                case "contradicted":
                    assert {plane.edge_names[e] for e in kind.edges} == set(found.contradicted)
                case "fixed3":
                    assert (parts >= 3).all()
                case _:
                    assert set(parts) == {int(kind.name[-1])}


def test_the_legend_says_what_each_class_is_and_counts_it():
    words = {kind.name: kind.words for kind in leg_classes(rigidity(WRONG))}
    assert words == {
        "fixed0": "shape fixed by headings: 160 legs",
        "evened": "evened out, not measured: 2 legs",
        "contradicted": "contradicted by other headings: 1 leg",
    }
    district = [kind.words for kind in leg_classes(rigidity(samples.load("helsinki_district").to_map()))]
    assert district[0] == "part 1, shape fixed by headings: 5 legs"
    assert re.fullmatch(r"evened out, not measured: \d+ legs \(\d+ curved\)", district[-1])
    triangles = PlaneMap.from_geometry(
        [(2 * k + x, y) for k in range(6) for x, y in ((0, 0), (1, 0.1 * k), (0.4, 1))],
        [(3 * k + a, 3 * k + b) for k in range(6) for a, b in ((0, 1), (1, 2), (2, 0))],
    )
    assert [kind.words for kind in leg_classes(rigidity(triangles))] == [
        *(f"part {k}, shape fixed by headings: 3 legs" for k in (1, 2, 3)),
        "3 smaller parts, each shape fixed by headings: 9 legs",
    ]


# -- pictures ------------------------------------------------------------------------------------------------------------


def drawn(text):
    """The groups of legs by class: for each, the tool tips of its paths."""
    root = ET.fromstring(text)
    groups = [g for g in root.iter(f"{SVG}g") if re.match("fixed|evened|contradicted", g.get("class", ""))]
    return {g.get("class"): [path.find(f"{SVG}title").text for path in g] for g in groups}


def said(text):
    return " ".join(t.text for t in ET.fromstring(text).iter(f"{SVG}text"))


def test_legs_are_coloured_by_class_with_tool_tips_and_a_legend():
    found = rigidity(WRONG)
    text = compass(WRONG).to_svg(rigidity=found)
    groups = drawn(text)
    assert {name: len(tips) for name, tips in groups.items()} == {"fixed0": 160, "evened": 2, "contradicted": 1}
    assert re.fullmatch(r"e24: misses what the other headings say by [\d.]+ degrees", groups["contradicted"][0])
    assert groups["evened"][0] == "e161: length evened out, not measured"
    pattern = r"e0: in part 1, whose shape the headings fix \(161 legs\); its heading misses the others by [\d.]+ degrees"
    assert re.fullmatch(pattern, groups["fixed0"][0])
    for kind in leg_classes(found):
        assert kind.words in said(text)
    assert f"{found.freedom} proportions are open, chosen by the drawing" in said(text)
    assert 'class="edge"' not in text
    assert compass(WRONG).to_svg(rigidity=True) == text
    assert compass(WRONG).to_svg(rigidity=False) == compass(WRONG).to_svg()


def test_contradicted_legs_are_broad_and_drawn_last_and_evened_ones_dashed():
    root = ET.fromstring(compass(WRONG).to_svg(rigidity=True))
    groups = [g for g in root.iter(f"{SVG}g") if re.match("fixed|evened|contradicted", g.get("class", ""))]
    assert groups[-1].get("class") == "contradicted"
    width = {g.get("class"): float(g.get("stroke-width")) for g in groups}
    assert width["contradicted"] > 1.5 * width["fixed0"] > 1.5 * width["evened"]
    assert [g.get("class") for g in groups if g.get("stroke-dasharray")] == ["evened"]


def test_highlights_lie_below_the_coloured_legs():
    sets = {"room": WRONG.region([2, 3]), "way": WRONG.line(["e0", "e1"]), "spot": WRONG.vertex(2)}
    text = compass(WRONG).to_svg(rigidity=True, highlight=sets)
    for name in ("room: region", "way: line", "spot: vertex", "shape fixed", "contradicted by"):
        assert name in said(text)
    body = text[text.index("</defs>") if "</defs>" in text else 0 :]
    legs = body.index('<g class="fixed0"')
    assert body.index('class="s0"') < legs
    assert body.index('class="s1"') < legs
    assert body.rindex('<circle class="f2"') > legs  # a point hides nothing


@pytest.mark.parametrize("theme", ["auto", "light", "dark"])
def test_each_theme_has_its_own_colours(theme):
    text = compass(WRONG).to_svg(rigidity=True, theme=theme)
    for mode in ("light", "dark"):
        here = theme in ("auto", mode)
        for colour in (*FIXED[mode], EVENED[mode], CONTRADICTED[mode]):
            assert (colour in text) is here
    assert "contradicted{" not in compass(WRONG).to_svg(theme=theme)


def test_large_maps_have_one_path_a_class(monkeypatch):
    monkeypatch.setattr(pictures, "TIPS_UP_TO", 100)
    root = ET.fromstring(compass(WRONG).to_svg(rigidity=True))
    paths = [p.get("class") for p in root.iter(f"{SVG}path") if re.match("fixed|evened|contr", p.get("class") or "")]
    assert sorted(paths) == sorted(2 * ["fixed0", "evened", "contradicted"])  # the legs, and the legend
    assert not [g for g in root.iter(f"{SVG}g") if g.get("class") == "fixed0"]


def test_a_layout_that_does_not_keep_the_shapes_says_so():
    found = rigidity(WRONG)
    assert "this layout does not keep it; the compass layout does" in said(schnyder(WRONG).to_svg(rigidity=found))
    assert "does not keep" not in said(compass(WRONG).to_svg(rigidity=found))


def test_only_the_rigidity_of_this_map_is_taken():
    with pytest.raises(BadInput, match="no headings"):
        draw(BARE).to_svg(rigidity=True)
    with pytest.raises(BadInput, match=r"rigidity is True, False or what ninefold.layout.rigidity returns, not 'fixed'"):
        draw(WRONG).to_svg(rigidity="fixed")
    with pytest.raises(DifferentMaps, match="another map"):
        draw(WRONG).to_svg(rigidity=rigidity(samples.load("house").to_map()))
    assert isinstance(rigidity(WRONG), Rigidity)


def test_the_same_picture_gives_the_same_bytes():
    assert draw(WRONG).to_svg(rigidity=True) == draw(WRONG).to_svg(rigidity=rigidity(WRONG))


def test_plot_has_the_classes_in_its_legend():
    pytest.importorskip("matplotlib", reason="the extra 'plot' is not installed")
    axes = draw(WRONG).plot(rigidity=True, highlight={"spot": WRONG.vertex(1)})
    texts = {text.get_text() for text in axes.get_legend().get_texts()}
    assert texts == {"spot", *(kind.words for kind in leg_classes(rigidity(WRONG)))}


# -- colours -------------------------------------------------------------------------------------------------------------

# G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, A physiologically-based model for simulation of color vision
# deficiency, 2009: linear RGB to what is seen, full deficiency.
SEEN = {
    "common": np.eye(3),
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}


def linear(colour):
    c = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def lab(rgb):
    """CIE 1976 L*a*b* of linear sRGB."""
    to_xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
    t = to_xyz @ np.clip(rgb, 0, 1) / (0.9505, 1.0, 1.089)
    f = np.where(t > 0.008856, np.cbrt(t), 7.787 * t + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


@pytest.mark.parametrize("sight", SEEN)
@pytest.mark.parametrize(("mode", "base"), [("light", LIGHT), ("dark", DARK)])
def test_readers_of_every_sight_can_tell_the_classes_apart(mode, base, sight):
    colours = [*FIXED[mode], CONTRADICTED[mode], EVENED[mode]]
    seen = [lab(np.array(SEEN[sight]) @ linear(colour)) for colour in colours]
    for (one, a), (other, b) in itertools.combinations(zip(colours, seen, strict=True), 2):
        assert np.linalg.norm(a - b) > 18, (one, other)
    ground = lab(np.array(SEEN[sight]) @ linear(base["land"]))
    assert min(np.linalg.norm(a - ground) for a in seen) > 25


@pytest.mark.parametrize("sight", SEEN)
@pytest.mark.parametrize(("mode", "base"), [("light", LIGHT), ("dark", DARK)])
def test_and_where_a_robot_can_be(mode, base, sight):
    seen = [lab(np.array(SEEN[sight]) @ linear(colour)) for colour in BELIEF[mode]]
    for a, b in itertools.combinations(seen, 2):
        assert np.linalg.norm(a - b) > 18
    for ground in (base["land"], base["paper"]):
        assert min(np.linalg.norm(a - lab(np.array(SEEN[sight]) @ linear(ground))) for a in seen) > 25
