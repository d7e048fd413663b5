"""``ninefold hypotheses``: every plane map that explains a walk whose places look alike."""

import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

import typer

from ninefold._wording import counted, quoted

from ._options import AsJson, Force
from ._output import note, print_json, progress

if TYPE_CHECKING:
    from ninefold.mapping import Hypotheses, Walk
    from ninefold.mapping.doubt.comparing import PlaceLabel
    from ninefold.mapping.doubt.why_not import WhyNot

__all__ = ["hypotheses"]

NO_MAP = 1
BUDGET_SPENT = 3

_AS_CLOSE_AS_THEY_LIKE = 1e-9
"""Tolerance for reading: which of two exits close together a leg takes is for the search to say."""

_LETTERED_UP_TO = 26
"""Places of the best map up to which it is told which visits each of them is."""

_LABELS = 8


def hypotheses(
    walk: Annotated[str, typer.Argument(metavar="WALK", help="A walk log.", show_default=False)],
    *,
    closed: Annotated[
        bool | None,
        typer.Option("--closed/--open", help="Only maps that leave no exit unwalked, or only those that leave some."),
    ] = None,
    max_places: Annotated[
        int | None, typer.Option(metavar="N", min=1, help="Places of a map at most.", show_default=False)
    ] = None,
    limit: Annotated[
        int | None, typer.Option(metavar="N", min=1, help="Maps to keep at most; all are counted.", show_default=False)
    ] = None,
    budget: Annotated[float, typer.Option(metavar="SECONDS", help="When to stop searching.")] = 60.0,
    tolerance: Annotated[
        float | None,
        typer.Option(help="Headings that differ by less, in radians, may be of one exit. Left out, the log says."),
    ] = None,
    same: Annotated[
        list[str] | None,
        typer.Option("--same", metavar="I,J", help="Two visits, counted from 1, known to be one place; may be repeated."),
    ] = None,
    differ: Annotated[
        list[str] | None, typer.Option("--differ", metavar="I,J", help="Two visits known to be two places; may be repeated.")
    ] = None,
    why: Annotated[
        str | None,
        typer.Option("--why", metavar="I,J", help="Tell why two visits are not the same place.", show_default=False),
    ] = None,
    top: Annotated[int, typer.Option(min=1, help="How many maps to list at most.")] = 10,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE.svg", help="A picture of the best maps side by side.", show_default=False),
    ] = None,
    pictures: Annotated[int, typer.Option(metavar="N", min=1, max=24, help="How many maps the picture shows.")] = 6,
    atlas: Annotated[
        Path | None,
        typer.Option(
            "--atlas", metavar="ATLAS", help="Keep one of the maps; it says so if others are left.", show_default=False
        ),
    ] = None,
    number: Annotated[int, typer.Option("--map", metavar="N", min=1, help="Which map --atlas keeps.")] = 1,
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Find every plane map that explains a walk through places that are not recognised, because they look alike.

    Exit code 1 if there is none, 3 if the budget was spent before all were found. Visits are counted from 1.
    """
    from ninefold._files import refuse_existing, shown, write_text
    from ninefold.errors import BadInput
    from ninefold.mapping import hypotheses as explain

    if not budget > 0:
        raise BadInput(f"--budget is in seconds, above 0, not {budget:g}")
    if out is not None:
        if out.suffix.lower() != ".svg":
            raise BadInput(f"{shown(out)}: pictures are SVG; name a file that ends in .svg")
        refuse_existing(out, force=force)
    if atlas is not None:
        refuse_existing(atlas, force=force)
    log = _read(walk, tolerance)
    asked = None if why is None else _pair("--why", why, log.visits)
    known = [_pair("--same", text, log.visits) for text in same or []]
    apart = [_pair("--differ", text, log.visits) for text in differ or []]
    so_far = [0]
    with progress(lambda: f"searching for maps of {log.name}, {so_far[0]:,} found"), log.naming_lines():
        found = explain(
            log.walk,
            closed=closed,
            max_places=max_places,
            limit=limit,
            budget=budget,
            tolerance=log.tolerance,
            same=known,
            differ=apart,
            report=lambda count: so_far.__setitem__(0, count),
        )
    answer = _Answer(log, found, budget, top)
    files = {}
    if out is not None and found.maps:
        from ninefold import layout

        with progress("drawing"):
            write_text(out, layout.draw_alternatives(found.maps[:pictures]), force=force)
        files["picture"] = str(out)
    if atlas is not None and found.maps:
        _keep(answer, atlas, number, force=force)
        files["atlas"] = str(atlas)
    reason = None if asked is None else answer.why(asked)
    if as_json:
        print_json({**answer.facts(), **files, **({} if asked is None else {"why": reason and _reason_as_json(reason)})})
    else:
        answer.tell()
        if asked is not None:
            print(answer.why_in_words(asked, reason))
        for name, file in files.items():
            print(f"{file}: {'a picture of the best' if name == 'picture' else f'map {number}'}")
    for path in (out, atlas):
        if path is not None and not found.maps:
            note(f"{path}: not written, since there is no map")
    return BUDGET_SPENT if not found.exact else 0 if found.count else NO_MAP


class _Log(NamedTuple):
    """A walk that was read, and the tolerance to read its headings with."""

    name: str
    walk: "Walk"
    tolerance: float

    @property
    def visits(self) -> int:
        return len(self.walk.places)

    def naming_lines(self) -> Any:
        from ninefold.io.walks.mapped import by_line

        return by_line(self.name)

    def lines(self, first: int, last: int) -> str:
        """Return the lines of a stretch of visits."""
        from ninefold.io.walks.mapped import line_of_event
        from ninefold.mapping import Visit

        at = [k for k, event in enumerate(self.walk.events, 1) if isinstance(event, Visit)]
        begin, end = line_of_event(self.name, at[first]), line_of_event(self.name, at[last])
        return f"lines {begin} to {end}" if begin and end else f"events {at[first]} to {at[last]}"


def _read(path: str, tolerance: float | None) -> _Log:
    from ninefold.io.walks.json_lines import read_header, read_walk
    from ninefold.mapping.robot.walk import checked_tolerance

    allowed = read_header(path).tolerance if tolerance is None else checked_tolerance(tolerance)
    with progress(f"reading {path}"):
        return _Log(path, read_walk(path, tolerance=_AS_CLOSE_AS_THEY_LIKE), allowed)


def _pair(option: str, text: str, visits: int) -> tuple[int, int]:
    """Return two visits, counted from 0."""
    from ninefold.errors import BadInput

    found = re.fullmatch(r"\s*(\d{1,9})\s*,\s*(\d{1,9})\s*", text)
    pair = [int(one) for one in found.groups()] if found else []
    if not pair or not all(1 <= one <= visits for one in pair):
        raise BadInput(f"{option} takes two visits, counted from 1 to {visits}, such as 3,9, not {quoted(text)}")
    return pair[0] - 1, pair[1] - 1


def _keep(answer: "_Answer", path: Path, number: int, *, force: bool) -> None:
    """Write one of the maps as an atlas, with a sentence that it is a guess if others are left."""
    from ninefold.errors import BadInput
    from ninefold.io import Atlas
    from ninefold.io.atlas.records import Provenance

    found = answer.found
    if number > len(found.maps):
        raise BadInput(f"--map {number}: there are {counted(len(found.maps), 'map')}; give a number from 1 on")
    warnings = []
    if found.count > 1 or not found.exact:
        others = f"{'' if found.exact else 'at least '}{counted(found.count, 'map')}"
        explain = "explains" if found.count == 1 else "explain"
        warnings.append(
            f"this map is a guess: {others} {explain} the walk, whose places look alike, and it is number {number}"
        )
    one = found.maps[number - 1]
    if not one.closed:
        warnings.append("exits that nobody walked are not in it")
    source = Provenance.of_file(answer.log.name, "walk")
    with progress(f"writing {path}"):
        Atlas.from_map(one.plane, path, provenance=source, warnings=warnings, walk=answer.log.walk, force=force).close()


def _reason_as_json(reason: "WhyNot") -> dict[str, Any]:
    return {
        "kind": reason.kind,
        "visits": [visit + 1 for visit in reason.visits],
        "text": reason.text,
        "chain": [[a + 1, b + 1] for a, b in reason.chain],
        "around": [visit + 1 for visit in reason.around],
        "turning": reason.turning,
    }


class _Answer(NamedTuple):
    """What is told of the maps that were found."""

    log: _Log
    found: "Hypotheses"
    budget: float
    top: int

    def facts(self) -> dict[str, Any]:
        """Return the JSON object."""
        found, wrong = self.found, self.found.contradiction
        bits = found.ambiguity
        return {
            "file": self.log.name,
            "count": found.count,
            "exact": found.exact,
            "bits": None if bits is None else round(bits, 6),
            "maps": [
                {"places": one.n_places, "closed": one.closed, "visits": (one.visits + 1).tolist()} for one in found.maps
            ],
            "more": found.count - len(found.maps),
            "contradiction": None
            if wrong is None
            else {"first": wrong.first + 1, "last": wrong.last + 1, "text": wrong.text},
            "seconds": round(found.seconds, 3),
        }

    def tell(self) -> None:
        """Print what was found."""
        found = self.found
        print(f"{self.log.name}: {self._summary()}")
        wrong = found.contradiction
        if wrong is not None:
            stretch = f"visits {wrong.first + 1} to {wrong.last + 1}, {self.log.lines(wrong.first, wrong.last)}"
            print(f"  the smallest stretch that cannot be ({stretch}): {wrong.text}")
        if not found.maps:
            return
        from ninefold.mapping.doubt.comparing import place_labels_against

        shown = found.maps[: self.top]
        labels = [place_labels_against(found.maps[0], one) for one in shown]
        for k, (one, places) in enumerate(zip(shown, labels, strict=True), 1):
            state = "closed" if one.closed else "open"
            print(f"{k:>5}  {state:6}  {counted(one.n_places, 'place')}{_differing(places)}")
        if found.count > len(shown):
            print(f"       and {counted(found.count - len(shown), 'more', 'more')} (--top)")
        if found.maps[0].n_places <= _LETTERED_UP_TO:
            visits = found.maps[0].visits
            parts = [
                f"{label.text} {' '.join(str(t + 1) for t, w in enumerate(visits.tolist()) if w == place)}"
                for place, label in enumerate(labels[0])
            ]
            print(f"the visits of map 1: {'; '.join(parts)}")
        if not found.tree.compass and found.count > 1:
            print("without a compass the map of fewest places need not be the right one")

    def _summary(self) -> str:
        found = self.found
        kind = {None: "map", True: "closed map", False: "open map"}[found.closed]
        number = counted(found.count, kind)
        explain = "explains" if found.count == 1 else "explain"
        if not found.exact:
            if not found.count:
                spent = f"the budget of {self.budget:g} s was spent before any {kind} was found"
                return f"{spent}; whether there is one is not known"
            return f"at least {number} {explain} the walk; the budget of {self.budget:g} s was spent before all were found"
        if not found.count:
            others = "; one that leaves exits unwalked may" if found.closed and found.contradiction is None else ""
            return f"no {kind} explains the walk{others}"
        bits = f" ({found.ambiguity:.1f} bits)" if found.count > 1 else ""
        shut = sum(one.closed for one in found.maps)
        which = f", {shut or 'none'} of them closed" if found.closed is None and found.count > 1 else ""
        return f"{number} {explain} the walk{bits}{which}"

    def why(self, pair: tuple[int, int]) -> "WhyNot | None":
        """Return why two visits are not the same place."""
        with progress("searching for a map that has the two the same"):
            return self.found.why_not(*pair, budget=self.budget)

    def why_in_words(self, pair: tuple[int, int], reason: "WhyNot | None") -> str:
        """Return why two visits are not the same place, or in how many maps they are."""
        if reason is not None:
            return reason.text
        having = [k for k, one in enumerate(self.found.maps, 1) if one.visits[pair[0]] == one.visits[pair[1]]]
        both = f"visits {pair[0] + 1} and {pair[1] + 1} are the same place"
        if not having:
            return f"{both} in some map that is not among those kept"
        if len(having) == len(self.found.maps) == self.found.count and self.found.exact:
            return f"{both} in every map"
        which = "map " + ", ".join(map(str, having[:_LABELS])) + (", ..." if len(having) > _LABELS else "")
        return f"{both} in {len(having):,} of {counted(len(self.found.maps), 'map')}: {which}"


def _differing(places: "tuple[PlaceLabel, ...]") -> str:
    """Return the places that differ from the best map."""
    names = [label.text for label in places if label.kind != "same"]
    more = f" and {len(names) - _LABELS:,} more" if len(names) > _LABELS else ""
    return f"  {' '.join(names[:_LABELS])}{more}" if names else ""
