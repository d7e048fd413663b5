"""Make the pictures of the README and the documentation from what the package brings.

Usage::

    .venv/bin/python tools/make_pictures.py [FOLDER]

They go to ``docs/pictures``. The street map beside its drawing shows data of OpenStreetMap, and says so.
"""

from __future__ import annotations

import re
import sys
from dataclasses import replace
from math import radians
from pathlib import Path

from ninefold.io import samples
from ninefold.layout import Drawing, TrueShapes, compass, draw_alternatives, side_by_side
from ninefold.mapping import (
    Follower,
    Heading,
    PlaneMap,
    Samples,
    Set,
    Visit,
    Walk,
    WalkHeader,
    build,
    estimate,
    hypotheses,
)
from ninefold.mapping.robot.simulated import explore

FOLDER = Path(__file__).parents[1] / "docs" / "pictures"
CREDIT = "\N{COPYRIGHT SIGN} OpenStreetMap contributors, ODbL"
LOST = "v100"
AVENUES = ("Mannerheimintie", "Unioninkatu")


def walked(source: samples.Source, seed: int = 1) -> PlaneMap:
    """The map that a robot makes of a world from its walk alone."""
    return build(explore(source.to_world(), seed=seed).walk)


def street(plane: PlaneMap, name: str) -> list[str]:
    """The edges of a street, which are called after it and numbered."""
    return [edge for edge in plane.edge_names if re.fullmatch(rf"{re.escape(name)}( \d+)?", edge)]


def shown(plane: PlaneMap) -> dict[str, Set]:
    """Two avenues and the blocks along a third, to be found again in both pictures."""
    rows = [plane.edge_names.row(edge) for edge in street(plane, "Bulevardi")]
    along = set(plane.face_of.reshape(-1, 2)[rows].ravel().tolist()) - {plane.outer_face}
    blocks = {"Blocks along Bulevardi": plane.region(sorted(along))}
    return {**blocks, **{name: plane.line(street(plane, name)) for name in AVENUES}}


def slim(svg: str) -> str:
    """The picture without tool tips, which an image on a page cannot show, and to a tenth of a pixel."""
    svg = re.sub(r"(<(path|circle) [^>]*[^/])><title>[^<]*</title></\2>", r"\1/>", svg)
    return re.sub(r"(\d+\.\d)\d+(?=[, \"ZM])", r"\1", svg)


def district() -> str:
    """The streets that the robot never saw, beside what it drew."""
    source = samples.load("helsinki_district")
    plane = walked(source)
    ground: Drawing = replace(TrueShapes(source).drawing(plane), notes=(CREDIT,))
    drawing = replace(compass(plane), notes=("from the headings of a walk alone",))
    sets = shown(plane)
    return side_by_side(
        ground.to_svg(highlight=sets, title="The streets, which the robot never saw", width=580),
        drawing.to_svg(highlight=sets, title="What it drew from its compass alone", width=580),
    )


def office() -> str:
    """A small world with its names and two sets."""
    plane = walked(samples.load("office"))
    sets = {
        "west wing": plane.cycle(["lobby", "hall", "archive", "desk"]),
        "way in": plane.path(["lobby", "hall", "server"]),
    }
    return compass(plane).to_svg(highlight=sets, width=560)


def guess() -> str:
    """The same world walked with a compass that errs by 10 degrees: the likeliest map, and what is undecided about it."""
    walk = explore(samples.load("office").to_world(), seed=1, noise=radians(10), step=10.0).walk
    found = estimate(walk)
    doubts = [replace(one, text="; ".join([one.text, *map(str, found.more(one))])) for one in found.doubts]
    return compass(found.best).to_svg(doubts=doubts, width=560)


def lost() -> str:
    """Where a robot without a compass can be after its first look around, and one move later."""
    source = samples.load("helsinki_district")
    plane = walked(source)
    robot = Follower(plane, WalkHeader(compass=False), sigma=radians(10))
    drawing = replace(compass(plane), notes=(CREDIT,))
    told = {0: "After one look around", 1: "One move later"}
    sheets = []
    events = explore(source.to_world(), start=LOST, seed=2, noise=radians(10)).walk.events
    for event in events:
        if robot.step(event) and (title := told.pop(robot.localizer.moves, None)):
            sheets.append(drawing.to_svg(belief=robot.localizer.probabilities, title=title, width=580))
        if not told:
            break
    return side_by_side(*sheets)


def alike() -> str:
    """All maps of a walk round two halls whose corners and junctions nobody recognises."""
    exits = ((0, 90), (0, 90, 270), (90, 180, 270), (90, 180), (0, 90), (0, 90, 270), (0, 270), (180, 270), (90, 180, 270))
    events: list[Samples | Visit] = []
    for bearings, went in zip(exits, (None, 90, 0, 270, 180, 90, 90, 0, 270), strict=True):
        events += [] if went is None else [Samples.of(Heading.from_bearing(went))]
        events.append(Visit(None, tuple(map(Heading.from_bearing, bearings))))
    return draw_alternatives(hypotheses(Walk(WalkHeader(), tuple(events))))


PICTURES = {
    "alike.svg": alike,
    "district-beside.svg": district,
    "guess.svg": guess,
    "lost.svg": lost,
    "office.svg": office,
}


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in PICTURES.items():
        (folder / name).write_text(slim(make()), "utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
