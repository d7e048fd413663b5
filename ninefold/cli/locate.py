"""``ninefold locate``: where a robot can be whose walk began nobody knows where."""

import sys
from contextlib import contextmanager
from math import radians
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from ninefold._wording import counted, percent, quoted

from ._options import AsJson, AtlasPath, Force
from ._output import note, notes, one_line, print_json, progress

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ninefold.errors import EmptyBelief
    from ninefold.io.walks.json_lines import WalkReader
    from ninefold.mapping import Candidate, Event, Localizer, PlaneMap, Set, WalkHeader
    from ninefold.mapping.robot.units import Unit

__all__ = ["locate"]

_AS_CLOSE_AS_THEY_LIKE = 1e-9
"""Tolerance for reading: exits that noise brought close together are no error here."""


def locate(
    atlas: AtlasPath,
    walk: Annotated[
        str,
        typer.Argument(metavar="WALK", help="A walk log, or - for one on standard input.", show_default=False),
    ],
    *,
    sigma: Annotated[
        float | None,
        typer.Option(
            metavar="DEGREES",
            help="Standard deviation of a heading. Left out, the log's header says (sigma, in radians), else 5 degrees.",
            show_default=False,
        ),
    ] = None,
    start: Annotated[
        str | None,
        typer.Option(metavar="SET", help="Where the walk began; left out, anywhere.", show_default=False),
    ] = None,
    inside: Annotated[
        list[str] | None,
        typer.Option("--inside", metavar="SET", help="Tell how likely the robot is inside a set; may be repeated."),
    ] = None,
    top: Annotated[int, typer.Option(min=1, help="How many candidates to list at most.")] = 10,
    follow: Annotated[bool, typer.Option("--follow", help="Tell at every place, as the events come.")] = False,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE.svg", help="A picture of where it can be.", show_default=False),
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Tell where a robot can be at the end of a walk that began somewhere on the map.

    Headings and exits alone are looked at, not the names of places. Exit code 1 if the walk fits nowhere.
    """
    from ninefold._files import refuse_existing, shown, write_text
    from ninefold.errors import BadInput, EmptyBelief
    from ninefold.io import Atlas
    from ninefold.mapping import Follower
    from ninefold.mapping.robot.units import unit_of

    if sigma is not None and not 0 < sigma <= 60:
        raise BadInput(f"--sigma is in degrees, above 0 and at most 60, not {sigma:g}")
    if out is not None:
        if out.suffix.lower() != ".svg":
            raise BadInput(f"{shown(out)}: pictures are SVG; name a file that ends in .svg")
        refuse_existing(out, force=force)
    with progress(f"reading {atlas}"), Atlas.open(atlas, writable=False) as found:
        plane = found.plane
        sets = {text: found.parse(text) for text in inside or []}
        began = None if start is None else found.parse(start)
    log = _opened(walk)
    header = log.header
    follower = Follower(plane, header, sigma=None if sigma is None else radians(sigma), start=began)
    answer = _Answer(str(atlas), plane, sets, unit_of("yaw-deg" if header.heading == "yaw-rad" else header.heading), top)
    told = False
    try:
        with progress(f"following {log.name}"), log.naming_lines():
            for event in log.events:
                if follower.step(event) and follow:
                    answer.tell_briefly(follower.localizer, as_json=as_json)
                    told = True
    except EmptyBelief as nowhere:
        _tell_nowhere(log, nowhere, as_json=as_json)
        if out is not None:
            note(f"{out}: not written, since there is no place left to draw")
        return 1
    robot = follower.localizer
    if out is not None:
        with progress("drawing"):
            from ninefold import layout

            drawing = layout.draw(plane)
            title = f"{atlas.stem}: where the robot can be after {counted(robot.moves, 'move')}"
            svg = drawing.to_svg(belief=robot.probabilities, highlight=sets or None, title=title)
        write_text(out, svg, force=force)
        notes(drawing.notes)
    if not as_json:
        answer.tell(robot, out)
    elif not told:
        print_json(answer.facts(robot))
    return 0


class _Log(NamedTuple):
    """A walk that is being read."""

    name: str
    header: "WalkHeader"
    events: "Iterator[Event]"
    reader: "WalkReader | None"

    def line(self, event: int | None) -> int | None:
        """Return the line of an event: on standard input of the last, since it cannot be read again."""
        from ninefold.io.walks.mapped import line_of_event

        if self.reader is not None:
            return self.reader.line
        return None if event is None else line_of_event(self.name, event)

    @contextmanager
    def naming_lines(self) -> "Iterator[None]":
        """Let errors about an event name its line."""
        from ninefold.errors import BadInput, located

        try:
            yield
        except BadInput as error:
            if error.event is None:
                raise
            raise located(error, f"{self.name}, line {self.line(error.event)}") from None


def _opened(walk: str) -> _Log:
    """Read the header of a walk, and its events as they come."""
    from ninefold.io.walks.json_lines import WalkReader, iter_events, read_header

    if walk != "-":
        return _Log(walk, read_header(walk), iter_events(walk, tolerance=_AS_CLOSE_AS_THEY_LIKE), None)
    reader = WalkReader("standard input", tolerance=_AS_CLOSE_AS_THEY_LIKE)
    lines = iter(sys.stdin.buffer.readline, b"")
    for line in lines:
        reader.take(line)
        if reader.started:
            break
    events = (event for event in map(reader.take, lines) if event is not None)
    return _Log(reader.name, reader.header, events, reader)


def _tell_nowhere(log: _Log, nowhere: "EmptyBelief", *, as_json: bool) -> None:
    """Say that no place is left, and where in the walk."""
    where = f"{log.name}, line {log.line(nowhere.event)}"
    reason = one_line(f"{where}: {nowhere.reason}")
    if as_json:
        print_json({"candidates": [], "certain": False, "moves": nowhere.moves, "reason": reason})
    else:
        print(f"nowhere: {reason}", flush=True)


class _Answer(NamedTuple):
    """What is told of a localizer: of which atlas, about which sets, in which unit, and how many candidates at most."""

    atlas: str
    plane: "PlaneMap"
    sets: dict[str, "Set"]
    unit: "Unit"
    top: int

    def facts(self, robot: "Localizer") -> dict[str, Any]:
        """Return the JSON object."""
        best = None if robot.certain or not robot.n_exits else robot.best_move()
        candidates = robot.candidates()
        return {
            "file": self.atlas,
            "candidates": [found._asdict() for found in candidates[: self.top]],
            "more": max(0, len(candidates) - self.top),
            "certain": robot.certain,
            "bits": round(robot.entropy, 6),
            "moves": robot.moves,
            "inside": {
                text: {
                    "inside": robot.inside(item),
                    "boundary": max(0.0, robot.inside(item, closed=True) - robot.inside(item)),
                }
                for text, item in self.sets.items()
            },
            "best_move": best
            and {"exit": best.exit, "heading": self.unit.from_yaw(best.heading.yaw), "left": round(best.left, 3)},
        }

    def tell_briefly(self, robot: "Localizer", *, as_json: bool) -> None:
        """Print one line on where the robot can be now."""
        if as_json:
            print_json(self.facts(robot))
            sys.stdout.flush()
            return
        found = robot.likeliest
        several = len(robot.candidates())
        others = "" if robot.certain else f", of {counted(several, 'candidate')}"
        print(
            f"{counted(robot.moves, 'move')}: {found.vertex} {percent(float(robot.probabilities.max()))}{others}", flush=True
        )

    def tell(self, robot: "Localizer", out: Path | None) -> None:
        """Print where the robot can be."""
        candidates = robot.candidates()
        state = "certain" if robot.certain else f"{counted(len(candidates), 'candidate')}, {robot.entropy:.1f} bits"
        print(f"{self.atlas}: where the robot can be after {counted(robot.moves, 'move')}: {state}")
        for found in candidates[: self.top]:
            print(f"  {percent(found.probability):>12}  {found.vertex}{self._came_by(found)}")
        if len(candidates) > self.top:
            print(f"  {'':>12}  and {counted(len(candidates) - self.top, 'more', 'more')} (--top)")
        for text, item in self.sets.items():
            inside, closed = robot.inside(item), robot.inside(item, closed=True)
            print(f"inside {quoted(text)}: {percent(inside)}; on its boundary: {percent(max(0.0, closed - inside))}")
        if not robot.certain and robot.n_exits:
            best = robot.best_move()
            heading = self.unit.heading(best.heading.yaw)
            left = f"{best.left:.3g} of {counted(len(candidates), 'candidate')}"
            print(f"best move: the exit at {heading}, which leaves {left} in expectation")
        if out is not None:
            print(f"{out}: a picture of it")

    def _came_by(self, found: "Candidate") -> str:
        if found.dart is None:
            return ""
        names = self.plane.vertex_names
        edge = self.plane.edge_names[found.dart >> 1]
        return f", come from {names[int(self.plane.tail[found.dart ^ 1])]} by {edge}"
