"""The health of a map: closing residuals in numbers, in words, and as colours of the legs."""

from __future__ import annotations

import json
import re
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from ninefold import cli
from ninefold.errors import BadInput, DifferentMaps
from ninefold.io import Atlas, samples
from ninefold.layout import compass, draw, schnyder
from ninefold.layout import svg as pictures
from ninefold.layout.health_scale import STEPS, health_colouring
from ninefold.layout.theme import CLOSING, DARK, LIGHT
from ninefold.mapping import Health, Mapper, PlaneMap, SimulatedWorld, build, explore, health

SVG = "{http://www.w3.org/2000/svg}"
HOUSE = samples.load("house").to_map()
BARE = PlaneMap.from_rotation({"a": ["b"], "b": ["a"]})


def off(plane, degrees):
    """The map with turns wrong by so many degrees, edge by edge from the first."""
    turn = np.array(plane.turn)
    turn[: len(degrees)] += np.radians(degrees)
    names = {"vertex_names": plane.vertex_names, "edge_names": plane.edge_names}
    return PlaneMap.from_darts(plane.tail, plane.next_ccw, plane.outer, heading=plane.heading, turn=turn, **names)


SICK = off(HOUSE, [0.03, -0.07, 0.15, 0.3, -0.8, 1.5, -3, 7])


# -- numbers and words -----------------------------------------------------------------------------------------------------


def test_residuals_are_what_is_left_between_headings_and_turn():
    found = health(SICK)
    assert found.residual == pytest.approx([-0.03, 0.07, -0.15, -0.3, 0.8, -1.5, 3, -7, 0, 0, 0], abs=1e-9)
    assert not found.residual.flags.writeable
    assert found.n_edges == 11
    assert found.within(0.5) == pytest.approx(0.15)
    assert found.within(1) == pytest.approx(7)
    names = SICK.edge_names
    assert [name for name, _ in found.worst] == [names[7], names[6], names[5]]
    assert [size for _, size in found.worst] == pytest.approx([7, 3, 1.5])
    assert str(found) == (
        "headings and turns disagree by up to 7 degrees: half of the legs within 0.15, 95 of 100 within 5; "
        f"worst {names[7]} (7), {names[6]} (3), {names[5]} (1.5)"
    )
    assert repr(found) == f"Health({found})"
    assert json.loads(json.dumps(found.counts)) == {
        "edges": 11,
        "median": pytest.approx(0.15),
        "p95": pytest.approx(5),
        "largest": pytest.approx(7),
        "worst": [{"edge": names[7 - k], "degrees": pytest.approx(size)} for k, size in enumerate((7, 3, 1.5))],
    }


def test_a_perfect_map_names_no_edge():
    found = health(HOUSE)
    assert str(found) == "headings and turns agree to within a millionth of a degree on 11 legs"
    assert found.worst == ()
    assert found.within(1) < 1e-9
    assert str(health(off(HOUSE, [0.004]))) == "headings and turns agree to within 0.004 degrees on 11 legs"
    two = health(off(HOUSE, [0.004, 0, 0.2]))
    assert [size for _, size in two.worst] == pytest.approx([0.2])  # at most three, and none that is right


def test_tethers_have_no_residual():
    islands = PlaneMap.from_geometry([(0, 0), (9, 0), (0, 9), (2, 2), (3, 2)], [(0, 1), (1, 2), (2, 0), (3, 4)])
    found = health(islands)
    assert np.isnan(found.residual[islands.tether]).all()
    assert found.n_edges == islands.n_edges == 4
    assert found.within(1) < 1e-9
    alone = health(PlaneMap.from_geometry([(0, 0)], np.empty((0, 2), int)))
    assert (alone.n_edges, alone.within(0.95), alone.worst, str(alone)) == (0, 0.0, (), "no leg to judge by")
    with pytest.raises(BadInput, match="the map has no headings, so nothing tells how well they agree"):
        health(BARE)


def test_it_is_the_mappers_residuals_and_grows_with_the_noise():
    world = samples.load("office").to_world()
    largest = []
    for noise in (0.0, 0.0005, 0.002):
        walk = explore(world, seed=1, noise=noise, tours=3, tolerance=0.03).walk
        mapper = Mapper(walk.header)
        for event in walk.events:
            mapper.step(event)
        found = health(mapper.plane)
        assert found.residual == pytest.approx(np.degrees(mapper.residuals), abs=1e-9)
        largest.append(found.within(1))
    assert largest[0] < 1e-9 < largest[1] < largest[2] < 1
    square = SimulatedWorld([(0, 0), (9, 0), (9, 9), (0, 9)], [(0, 1), (1, 2), (2, 3), (3, 0)])
    once = build(explore(square, seed=1, noise=0.002).walk)
    assert health(once).within(1) < 1e-9  # an edge passed once agrees with itself


# -- pictures --------------------------------------------------------------------------------------------------------------


def drawn(text):
    """The groups of legs by class, in the order drawn: for each, the tool tips of its paths."""
    groups = [g for g in ET.fromstring(text).iter(f"{SVG}g") if re.match("closing", g.get("class", ""))]
    return {g.get("class"): [path.find(f"{SVG}title").text for path in g] for g in groups}


def said(text):
    return " ".join(t.text for t in ET.fromstring(text).iter(f"{SVG}text"))


def test_legs_are_coloured_by_the_size_of_their_residual():
    text = draw(SICK).to_svg(health=True)
    names = SICK.edge_names
    groups = drawn(text)
    assert list(groups) == [f"closing{k}" for k in range(8)]  # the worst on top
    assert [tips[0] for tips in groups.values()] == [
        f"{names[k]}: headings and turn disagree by {size} degrees"
        for k, size in enumerate(("0.03", "0.07", "0.15", "0.3", "0.8", "1.5", "3", "7"))
    ]
    assert [len(tips) for tips in groups.values()] == [4, 1, 1, 1, 1, 1, 1, 1]
    widths = [float(g.get("stroke-width")) for g in ET.fromstring(text).iter(f"{SVG}g") if "closing" in g.get("class", "")]
    assert widths == sorted(widths)
    assert widths[-1] > 2 * widths[0]
    assert 'class="edge"' not in text
    assert draw(SICK).to_svg(health=health(SICK)) == text
    assert draw(SICK).to_svg(health=False) == draw(SICK).to_svg()


def test_the_legend_is_a_scale_in_degrees_with_counts():
    text = draw(SICK).to_svg(health=True, highlight={"room": SICK.face(2)})
    words = said(text)
    assert "Legs by how far their headings and turn disagree 4 0.05\N{DEGREE SIGN} 1 0.1\N{DEGREE SIGN}" in words
    assert "2\N{DEGREE SIGN} 1 5\N{DEGREE SIGN} 1 " in words
    assert "room: region" in words
    assert re.sub(r"\s+", " ", str(health(SICK))) in words
    root = ET.fromstring(text)
    bar = [p for p in root.iter(f"{SVG}path") if "closing" in p.get("class", "") and p.get("stroke-width") == "9"]
    assert [p.find(f"{SVG}title").text for p in bar][:2] == ["up to 0.05 degrees: 4 legs", "0.05 to 0.1 degrees: 1 leg"]
    assert bar[-1].find(f"{SVG}title").text == "above 5 degrees: 1 leg"
    assert len(bar) == len(STEPS) + 1
    low = max(float(p.get("d").split(",")[1].split()[0]) for p in bar)
    assert low < float(root.get("height"))


@pytest.mark.parametrize("width", [100, 300, 560, 2000])
def test_the_scale_fits_the_picture(width):
    root = ET.fromstring(draw(SICK).to_svg(health=True, width=width))
    bar = [p for p in root.iter(f"{SVG}path") if "closing" in p.get("class", "") and p.get("stroke-width") == "9"]
    assert max(float(p.get("d").split()[-1].split(",")[0]) for p in bar) <= width


def test_a_perfect_map_is_of_one_colour():
    assert list(drawn(draw(HOUSE).to_svg(health=True))) == ["closing0"]
    assert [kind.words for kind in health_colouring(health(HOUSE)).classes] == ["up to 0.05 degrees: 11 legs"]


def test_limits_belong_to_the_lower_colour():
    plane = off(HOUSE, [])
    found = Health(plane, np.array([*STEPS, 0.0, -0.05, 180, -5.000001]))
    assert [(kind.name, kind.edges) for kind in health_colouring(found).classes] == [
        ("closing0", (0, 7, 8)),
        *((f"closing{k}", (k,)) for k in range(1, 7)),
        ("closing7", (9, 10)),
    ]


def test_tethers_are_not_drawn_and_large_maps_have_one_path_a_class(monkeypatch):
    islands = PlaneMap.from_geometry([(0, 0), (9, 0), (0, 9), (2, 2), (3, 2)], [(0, 1), (1, 2), (2, 0), (3, 4)])
    assert {name: len(tips) for name, tips in drawn(draw(islands).to_svg(health=True)).items()} == {"closing0": 4}
    monkeypatch.setattr(pictures, "TIPS_UP_TO", 5)
    root = ET.fromstring(draw(SICK).to_svg(health=True))
    assert not [g for g in root.iter(f"{SVG}g") if "closing" in g.get("class", "")]
    assert len([p for p in root.iter(f"{SVG}path") if "closing" in p.get("class", "")]) == 8 + 8  # legs, and the scale


@pytest.mark.parametrize("theme", ["auto", "light", "dark"])
def test_each_theme_has_its_own_colours(theme):
    text = compass(SICK).to_svg(health=True, theme=theme)
    for mode in ("light", "dark"):
        assert all((colour in text) is (theme in ("auto", mode)) for colour in CLOSING[mode])
    assert "closing" not in compass(SICK).to_svg(theme=theme)
    assert schnyder(SICK).to_svg(health=True)  # any layout, since nothing is read off the shape


def test_what_cannot_be_coloured():
    with pytest.raises(BadInput, match="a leg has one colour: draw by rigidity or by health, not by both"):
        draw(SICK).to_svg(health=True, rigidity=True)
    with pytest.raises(BadInput, match="no headings"):
        draw(BARE).to_svg(health=True)
    with pytest.raises(BadInput, match=r"health is True, False or what ninefold.mapping.health returns, not 'good'"):
        draw(SICK).to_svg(health="good")
    with pytest.raises(DifferentMaps, match="another map"):
        draw(SICK).to_svg(health=health(HOUSE))


def test_plot_has_the_classes_in_its_legend():
    pytest.importorskip("matplotlib", reason="the extra 'plot' is not installed")
    axes = draw(SICK).plot(health=True)
    texts = [text.get_text() for text in axes.get_legend().get_texts()]
    assert texts == [kind.words for kind in health_colouring(health(SICK)).classes]


# G. M. Machado, M. M. Oliveira, L. A. F. Fernandes, 2009: linear RGB to what is seen, full deficiency.
SEEN = {
    "common": np.eye(3),
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}


def lightness(colour, sight):
    """CIE 1976 L* of a colour as it is seen."""
    c = np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)]) / 255
    linear = np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)
    y = float(np.array([0.2126, 0.7152, 0.0722]) @ np.clip(np.array(SEEN[sight]) @ linear, 0, 1))
    return 116 * y ** (1 / 3) - 16 if y > 0.008856 else 903.3 * y


@pytest.mark.parametrize("sight", SEEN)
@pytest.mark.parametrize(("mode", "base", "sense"), [("light", LIGHT, -1), ("dark", DARK, 1)])
def test_the_scale_is_ordered_in_lightness_for_every_sight(mode, base, sense, sight):
    seen = [lightness(colour, sight) for colour in CLOSING[mode]]
    steps = sense * np.diff(seen)
    assert steps.min() > 2.5
    assert abs(seen[0] - lightness(base["land"], sight)) > 18
    if sight == "common":
        assert steps.min() > 6
        assert steps.max() < 9


# -- the commands ----------------------------------------------------------------------------------------------------------


@pytest.fixture
def run(capsys):
    def runner(*arguments):
        code = cli.run([str(argument) for argument in arguments])
        out, err = capsys.readouterr()
        assert "Traceback" not in err
        return code, out, err

    return runner


@pytest.fixture
def sick(tmp_path):
    Atlas.from_map(SICK, tmp_path / "sick.atlas").close()
    return tmp_path / "sick.atlas"


def test_info_tells_the_health(run, sick, tmp_path):
    code, out, _ = run("info", sick)
    assert code == 0
    assert f"health       {health(SICK)}" in out.splitlines()
    found = json.loads(run("info", sick, "--json")[1])
    assert found["health"] == json.loads(json.dumps(health(SICK).counts))
    assert found["checks"]["largest_residual"] == pytest.approx(np.radians(7))
    Atlas.from_map(BARE, tmp_path / "bare.atlas").close()
    assert "\nhealth " not in run("info", tmp_path / "bare.atlas")[1]
    assert json.loads(run("info", tmp_path / "bare.atlas", "--json")[1])["health"] is None


def test_draw_by_health(run, sick, tmp_path):
    out = tmp_path / "sick.svg"
    code, said_json, _ = run("draw", sick, "-o", out, "--health", "--json")
    assert code == 0
    assert json.loads(said_json)["health"] == json.loads(json.dumps(health(SICK).counts))
    assert out.read_text() == draw(SICK).to_svg(health=True, title="sick")
    code, _, err = run("draw", sick, "-o", tmp_path / "b.svg", "--health", "--rigidity")
    assert (code, "--rigidity and --health both colour the legs; give one of them" in err) == (2, True)
    Atlas.from_map(BARE, tmp_path / "bare.atlas").close()
    code, _, err = run("draw", tmp_path / "bare.atlas", "-o", tmp_path / "b.svg", "--health")
    assert (code, "the map has no headings" in err) == (2, True)
    assert not (tmp_path / "b.svg").exists()
