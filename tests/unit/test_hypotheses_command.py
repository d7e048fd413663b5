"""`ninefold hypotheses`: answers, exit codes, JSON, the picture, the atlas it keeps, and what it says to bad input."""

import json
import re
from dataclasses import replace
from xml.etree import ElementTree

import pytest

from ninefold.cli import run
from ninefold.errors import BadInput, DifferentMaps
from ninefold.io import Atlas, write_walk
from ninefold.layout import draw, draw_alternatives, side_by_side
from ninefold.mapping import Visit, Walk, build, hypotheses
from ninefold.mapping.doubt.comparing import place_labels_against
from tests.lattice import Lattice, straight

RING = straight("ENWS", "ENWS")
"""Round a block of places that look alike, twice: 2 maps and more."""


@pytest.fixture
def said(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)

    def ask(walk, *options, code=0):
        write_walk(walk, "walk.jsonl")
        assert run(["hypotheses", "walk.jsonl", *map(str, options)]) == code
        return capsys.readouterr().out

    return ask


def test_all_maps_are_counted_and_listed(said):
    found = hypotheses(RING)
    lines = said(RING).splitlines()
    assert lines[0] == f"walk.jsonl: {found.count} maps explain the walk ({found.ambiguity:.1f} bits), none of them closed"
    assert lines[1].split() == ["1", "open", "4", "places"]
    differ = [label.text for label in place_labels_against(found.maps[0], found.maps[1]) if label.kind != "same"]
    assert lines[2].split() == ["2", "open", str(found.maps[1].n_places), "places", *differ]
    assert lines[-1] == "the visits of map 1: A 1 5 9; B 2 6; C 3 7; D 4 8"
    listed = said(RING, "--top", 1).splitlines()
    assert listed[2].split() == ["and", str(found.count - 1), "more", "(--top)"]


def test_how_many_were_found_so_far_is_reported():
    counts = []
    found = hypotheses(RING, report=counts.append)
    assert counts == sorted(counts)
    assert counts[-1] == found.count


def test_json_has_the_keys_of_the_contract(said):
    found = hypotheses(RING)
    told = json.loads(said(RING, "--json"))
    assert (told["count"], told["exact"], told["more"]) == (found.count, True, 0)
    assert [(one["places"], one["closed"]) for one in told["maps"]] == [(one.n_places, one.closed) for one in found]
    assert told["maps"][0]["visits"] == [1, 2, 3, 4, 1, 2, 3, 4, 1]
    few = json.loads(said(RING, "--json", "--limit", 1))
    assert (len(few["maps"]), few["count"], few["more"]) == (1, found.count, found.count - 1)


def test_closed_and_open_and_few_places(said):
    walk, _ = Lattice.whole(2, 2).walk(1, 12)
    assert said(walk, "--closed").startswith("walk.jsonl: 1 closed map explains the walk\n")
    found = hypotheses(walk, closed=False)
    assert len(json.loads(said(walk, "--open", "--json"))["maps"]) == found.count
    assert json.loads(said(RING, "--max-places", 5, "--json"))["count"] == hypotheses(RING, max_places=5).count


def test_no_map_is_an_answer_with_the_stretch_that_shows_it(said):
    walk = straight("EENEE", names={1: "hall", 4: "hall"})
    out = said(walk, code=1)
    assert out.startswith("walk.jsonl: no map explains the walk\n")
    assert "the smallest stretch that cannot be (visits 2 to 5, lines 4 to 10): visits 2 and 5 are both called 'hall'" in out
    told = json.loads(said(walk, "--json", code=1))
    assert (told["count"], told["maps"]) == (0, [])
    assert (told["contradiction"]["first"], told["contradiction"]["last"]) == (2, 5)
    assert said(straight("E"), "--closed", code=1) == (
        "walk.jsonl: no closed map explains the walk; one that leaves exits unwalked may\n"
    )


def test_a_budget_that_is_spent(said):
    walk, _ = Lattice.whole(6, 6).walk(3, 300, back=0.0)
    out = said(walk, "--budget", 0.05, "--limit", 2, code=3)
    assert re.match(r"walk\.jsonl: at least [\d,]+ maps explain the walk; the budget of 0\.05 s was spent before all", out)
    assert json.loads(said(walk, "--budget", 0.05, "--limit", 2, "--json", code=3))["exact"] is False
    out = said(walk, "--budget", 1e-9, "--closed", code=3)
    assert out == (
        "walk.jsonl: the budget of 1e-09 s was spent before any closed map was found; whether there is one is not known\n"
    )


def test_what_is_known_of_pairs(said):
    assert json.loads(said(RING, "--same", "1,5", "--json"))["count"] == hypotheses(RING, same=[(0, 4)]).count
    assert json.loads(said(RING, "--differ", "1, 5", "--json"))["count"] == hypotheses(RING, differ=[(0, 4)]).count


def test_why_two_visits_are_not_the_same(said):
    reason = hypotheses(RING).why_not(0, 2)
    assert said(RING, "--why", "1,3").splitlines()[-1] == reason.text
    told = json.loads(said(RING, "--why", "1,3", "--json"))["why"]
    assert (told["kind"], told["visits"], told["around"]) == (reason.kind, [1, 3], [1 + visit for visit in reason.around])
    some = said(RING, "--why", "1,5").splitlines()[-1]
    assert re.fullmatch(r"visits 1 and 5 are the same place in \d+ of \d+ maps: map 1.*", some)
    assert said(RING, "--same", "1,5", "--why", "1,5").splitlines()[-1] == "visits 1 and 5 are the same place in every map"
    assert json.loads(said(RING, "--why", "1,5", "--json"))["why"] is None


def test_without_a_compass_fewest_places_are_no_promise(said):
    walk = Walk(replace(RING.header, compass=False), RING.events)
    assert said(walk).splitlines()[-1] == "without a compass the map of fewest places need not be the right one"


def test_a_map_is_kept_and_says_that_it_is_a_guess(said, capsys):
    said(RING, "--atlas", "ring.atlas", "--map", 2)
    with Atlas.open("ring.atlas") as atlas:
        assert atlas.plane == hypotheses(RING).maps[1].plane
        assert atlas.warnings[0].startswith(f"this map is a guess: {hypotheses(RING).count} maps explain the walk")
        assert atlas.warnings[0].endswith("it is number 2")
    walk, true = Lattice.whole(2, 2).walk(1, 12)
    said(walk, "--closed", "--atlas", "only.atlas")
    named = [
        Visit(f"v{true[k // 2]}", event.exits) if isinstance(event, Visit) else event for k, event in enumerate(walk.events)
    ]
    with Atlas.open("only.atlas") as atlas:
        assert atlas.warnings == ()
        assert atlas.plane.n_faces == build(Walk(walk.header, tuple(named))).n_faces == 2
    assert run(["info", "only.atlas"]) == 0
    assert "made from    a walk whose places look alike" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--why", "3"], "--why takes two visits, counted from 1 to 9, such as 3,9, not '3'"),
        (["--same", "0,3"], "--same takes two visits"),
        (["--differ", "3,10"], "--differ takes two visits"),
        (["--budget", "0"], "--budget is in seconds, above 0"),
        (["--budget", "nan"], "--budget is in seconds, above 0"),
        (["--tolerance", "3"], "a tolerance is an angle in radians"),
        (["-o", "maps.png"], "pictures are SVG"),
        (["--atlas", "x.atlas", "--map", "99"], "--map 99: there are"),
    ],
)
def test_bad_options_are_one_line(said, capsys, options, says):
    write_walk(RING, "walk.jsonl")
    assert run(["hypotheses", "walk.jsonl", *options]) == 2
    err = capsys.readouterr().err
    assert says in err
    assert err.count("\n") == 1


def test_a_bad_walk_is_named_by_its_line(said, capsys):
    write_walk(Walk(RING.header, (*RING.events[:2], Visit(None), *RING.events[3:])), "walk.jsonl")
    assert run(["hypotheses", "walk.jsonl"]) == 2
    assert "walk.jsonl, line 4: the exits of the place are not listed" in capsys.readouterr().err


# -- the picture -----------------------------------------------------------------------------------------------------------


def test_the_picture_shows_the_best_maps(said, tmp_path):
    said(RING, "-o", "maps.svg", "--pictures", 2)
    root = ElementTree.parse(tmp_path / "maps.svg").getroot()
    assert len([one for one in root if one.tag.endswith("svg")]) == 2
    assert not (tmp_path / "none.svg").exists()
    said(straight("E"), "--closed", "-o", "none.svg", code=1)
    assert not (tmp_path / "none.svg").exists()


def test_places_are_called_what_they_are_in_the_best_map():
    best, *others = hypotheses(straight("ENWS"))
    assert [label.text for label in place_labels_against(best, best)] == ["A", "B", "C", "D"]
    (apart,) = (one for one in others if one.n_places == 5)
    labels = place_labels_against(best, apart)
    assert [(label.text, label.kind) for label in labels] == [
        ("A1", "split"),
        ("B", "same"),
        ("C", "same"),
        ("D", "same"),
        ("A2", "split"),
    ]
    merged = place_labels_against(apart, best)
    assert [(label.text, label.kind) for label in merged] == [
        ("A=E", "merged"),
        ("B", "same"),
        ("C", "same"),
        ("D", "same"),
    ]
    with pytest.raises(DifferentMaps):
        place_labels_against(best, hypotheses(straight("E")).maps[0])


def test_labels_hold_for_every_pair_of_maps():
    kinds = set()
    maps = hypotheses(Lattice.whole(3, 3).walk(5, 24)[0], limit=30).maps
    for best in maps:
        for other in maps:
            labels = place_labels_against(best, other)
            assert len({label.text for label in labels}) == len(labels) == other.n_places
            for place, label in enumerate(labels):
                mine = set((other.place == place).nonzero()[0].tolist())
                theirs = [set((best.place == k).nonzero()[0].tolist()) for k in range(best.n_places)]
                met = [nodes for nodes in theirs if nodes & mine]
                whole = all(nodes <= mine for nodes in met)
                kind = ("same" if whole else "split") if len(met) == 1 else "merged" if whole else "mixed"
                assert label.kind == kind
                kinds.add(kind)
    assert kinds >= {"same", "split", "merged"}


def test_names_of_the_walk_are_the_names_of_places():
    found = hypotheses(straight("ENWS", names={1: "hall"}))
    assert [label.text for label in place_labels_against(found.maps[0], found.maps[0])] == ["A", "hall", "C", "D"]


def test_what_differs_is_marked_and_exits_that_nobody_walked_are_dashed():
    maps = hypotheses(straight("ENWS")).maps
    for theme in ("light", "dark", "auto"):
        svg = draw_alternatives(maps[:2], theme=theme)
        first, second = svg.split("<svg ")[2:]
        assert ">A<" in first
        assert ">A1<" in second
        assert "several places" not in svg
        assert "some visits of a place of map 1" not in first
        assert "some visits of a place of map 1 (A1)" in second
        assert "2: open, 2 places differ" in second
        assert "4 places, 4 ways, 8 exits that nobody walked" in first
        assert "stroke-dasharray" in first
    assert "several places of map 1 in one (A=B)" in draw_alternatives((maps[1], maps[0]))


def test_pictures_that_cannot_be():
    maps = hypotheses(straight("ENWS")).maps
    with pytest.raises(BadInput, match="1 to 24 maps, not 0"):
        draw_alternatives([])
    with pytest.raises(BadInput, match="1 to 24 maps, not 25"):
        draw_alternatives([maps[0]] * 25)
    with pytest.raises(BadInput, match="maps are those of hypotheses"):
        draw_alternatives([maps[0].plane])
    with pytest.raises(DifferentMaps):
        draw_alternatives([maps[0], hypotheses(straight("E")).maps[0]])


def test_a_sheet_has_rows():
    one = draw(hypotheses(straight("ENWS")).maps[0].plane).to_svg(width=200)
    wide, high = (int(found) for found in re.search(r'width="(\d+)" height="(\d+)"', one).groups())
    sheet = side_by_side(one, one, one, columns=2)
    assert f'width="{2 * wide + 16}" height="{2 * high + 16}"' in sheet
    assert f'<svg x="0" y="{high + 16}"' in sheet
    assert f'width="{3 * wide + 32}" height="{high}"' in side_by_side(one, one, one)
    with pytest.raises(BadInput, match="at least one column"):
        side_by_side(one, columns=0)


def test_a_map_of_many_places_names_only_what_differs():
    walk, _ = Lattice.whole(7, 7).walk(2, 70)
    maps = hypotheses(walk, limit=2, budget=1.0).maps
    assert maps[0].n_places > 40
    svg = draw_alternatives(maps[:2])
    assert ">A<" not in svg.split("<svg ")[2]
