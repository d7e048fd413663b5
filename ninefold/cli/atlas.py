"""``ninefold map``, ``info`` and ``name``: making an atlas, looking at it, naming sets in it."""

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ninefold._wording import counted

from ._options import AsJson, AtlasPath, DropCrossing, Force, SourceText
from ._output import first_few, note, notes, print_json, progress
from .estimating import doubts_as_json, in_radians, map_noisy_walk
from .follow import follow_walk, read_whole_walk

if TYPE_CHECKING:
    from ninefold.io import Atlas, Guess
    from ninefold.layout import Rigidity
    from ninefold.mapping import PlaneMap

__all__ = ["info", "map_source", "name"]

FIXED_UP_TO = 50_000
"""Edges up to which `info` says what the headings fix without being asked: a moment's work."""

TESTED_UP_TO = 5_000
"""Edges up to which it holds the headings against each other without being asked: a second, and half for each it names."""


def map_source(
    source: SourceText,
    *,
    out: Annotated[Path, typer.Option("--out", "-o", metavar="ATLAS", help="The atlas to write.", show_default=False)],
    tolerance: Annotated[
        float | None,
        typer.Option(help="For a walk: headings that differ by less, in radians, count as one. Left out, the log says."),
    ] = None,
    sigma: Annotated[
        float | None,
        typer.Option(
            metavar="DEG",
            help="For a walk whose headings err: their standard deviation in degrees. Left out, the log says; without "
            "either, headings are taken as they are.",
        ),
    ] = None,
    drift: Annotated[
        float | None,
        typer.Option(metavar="DEG", help="With sigma: standard deviation of a bias common to all headings of one visit."),
    ] = None,
    best: Annotated[
        bool, typer.Option("--best", help="Where the map is not certain, keep the likeliest, marked as a guess.")
    ] = False,
    drop_crossing: DropCrossing = False,
    follow: Annotated[
        bool,
        typer.Option("--follow", help="For a walk on standard input: keep the atlas current with every line that comes."),
    ] = False,
    resume: Annotated[
        bool, typer.Option("--resume", help="With --follow: go on with the walk of an atlas that is there already.")
    ] = False,
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Build a map from a walk log, or from lines with geometry whose coordinates are then dropped, and keep it.

    SOURCE - is a walk on standard input. Where its headings err, as --sigma or the log says, only a map that is certain is
    kept; else the answer is what is in doubt, and the exit code 1.
    """
    from ninefold._files import refuse_existing
    from ninefold.errors import BadInput
    from ninefold.io.formats import recognise

    _check_following(source, out, follow=follow, resume=resume, force=force)
    kind = "walk" if source == "-" else recognise(source).name
    if kind == "atlas":
        raise BadInput(f"{source}: an atlas already; `ninefold info` shows what is in it")
    if kind == "walk" and drop_crossing:
        raise BadInput("--drop-crossing is for sources with geometry, and a walk has none")
    if kind != "walk" and tolerance is not None:
        raise BadInput("--tolerance is for walks; geometry needs none")
    noise = _declared_noise(kind, sigma, drift, best=best, exact=follow or tolerance is not None)
    if not resume:
        refuse_existing(out, force=force)
    if out.exists() and source != "-" and not source.startswith("sample:") and out.samefile(source):
        raise BadInput(f"{out}: the source itself, which the atlas would replace; give -o another name")
    doubts: list[str] = []
    if follow:
        atlas, doubts = follow_walk(out, tolerance, resume=resume, force=force)
    elif kind == "walk":
        found = _from_walk(source, out, tolerance, noise, best=best, force=force, as_json=as_json)
        if isinstance(found, int):
            return found
        atlas, doubts = found
    else:
        with progress(f"mapping {source}"):
            atlas = _from_source(source, out, drop_crossing=drop_crossing, force=force)
    with atlas:
        plane, warnings, n_events = atlas.plane, (*doubts, *atlas.warnings), atlas.n_events
    if kind == "walk" and plane.heading is not None and plane.n_edges <= TESTED_UP_TO:
        from ninefold.layout import rigidity

        with progress("holding the headings against each other"):
            warnings = (*warnings, *rigidity(plane).warnings)
    if as_json:
        followed = {"events": n_events} if follow else {}
        print_json({"file": str(out), **_counts(plane), **followed, "warnings": list(warnings)})
    else:
        notes(warnings)
        print(f"{out}: {_described(plane)}")
    return 0


def _check_following(source: str, out: Path, *, follow: bool, resume: bool, force: bool) -> None:
    from ninefold.errors import BadInput

    if follow and source != "-":
        raise BadInput("--follow takes a walk from standard input: `ninefold map - --follow -o ATLAS`")
    if resume and not follow:
        raise BadInput(
            "--resume is for `ninefold map - --follow`, whose walk goes on; a finished walk makes its map at once"
        )
    if resume and force:
        raise BadInput("--resume goes on with the atlas that is there and --force replaces it; give one of them")
    if follow and out.is_file() and not (resume or force):
        raise BadInput(f"{out}: exists already; --resume goes on with its walk, --force replaces it")


def _declared_noise(
    kind: str, sigma: float | None, drift: float | None, *, best: bool, exact: bool
) -> tuple[float | None, float | None]:
    """Return --sigma and --drift in radians."""
    from ninefold.errors import BadInput

    given = [
        name for name, on in (("--sigma", sigma), ("--drift", drift), ("--best", best)) if on is not None and on is not False
    ]
    if given and kind != "walk":
        raise BadInput(f"{given[0]} is for walks; geometry has no headings that err")
    if given and exact:
        raise BadInput(
            f"{given[0]} is for headings that err, and --tolerance and --follow take them as they are; give one of them"
        )
    return in_radians(sigma, "--sigma", 60), in_radians(drift, "--drift", 180, nought=True)


def _from_walk(
    source: str,
    out: Path,
    tolerance: float | None,
    noise: tuple[float | None, float | None],
    *,
    best: bool,
    force: bool,
    as_json: bool,
) -> "tuple[Atlas, list[str]] | int":
    """Map a walk: exactly, or where its headings are declared to err, as far as it is certain; then return the exit code."""
    from ninefold.errors import BadInput
    from ninefold.io import Atlas, Provenance, read_walk
    from ninefold.io.walks.heading_units import doubts
    from ninefold.io.walks.mapped import by_line
    from ninefold.io.walks.streams import STANDARD_INPUT

    sigma, drift = noise
    content = None
    if source == "-":
        walk, content = read_whole_walk(tolerance, sigma)
        source = STANDARD_INPUT
        origin = Provenance.of(source, "walk")
    else:
        with progress(f"reading {source}"):
            walk, origin = read_walk(source, tolerance=tolerance, sigma=sigma), Provenance.of_file(source, "walk")
    if walk.header.sigma is None and (drift is not None or best):
        raise BadInput(f"{source}: it does not say how much its headings err; give --sigma DEG, their standard deviation")
    try:
        if walk.header.sigma is not None and tolerance is None:
            return map_noisy_walk(
                walk,
                out,
                source=source,
                located=by_line(source, content=content),
                provenance=origin,
                sigma=sigma,
                drift=drift,
                best=best,
                doubted=doubts(walk),
                force=force,
                as_json=as_json,
            )
        with progress(f"mapping {source}"), by_line(source, content=content):
            return Atlas.from_walk(walk, out, provenance=origin, force=force), doubts(walk)
    except BadInput as error:
        if error.event is None:
            raise
        raise BadInput("; ".join([str(error), *doubts(walk)])) from None


def _from_source(source: str, out: Path, *, drop_crossing: bool, force: bool) -> "Atlas":
    from ninefold.io import Atlas, Provenance, samples
    from ninefold.io.sources.reading import read_source

    found = read_source(source)
    if drop_crossing:
        found = found.without_crossings()
    name = source.removeprefix("sample:")
    origin = Provenance.of_file(source if name == source else samples.path(name), "geojson")
    return Atlas.from_map(found.to_map(), out, provenance=origin, warnings=found.notes, force=force)


def info(
    atlas: AtlasPath,
    *,
    rigidity: Annotated[
        bool,
        typer.Option("--rigidity", help="Tell what the headings fix on a large map too, which takes a while."),
    ] = False,
    as_json: AsJson = False,
) -> int:
    """Show what an atlas holds: the size of its map, what was checked, the named sets, and where it all came from."""
    from ninefold.io import Atlas
    from ninefold.mapping import health

    with progress(f"reading {atlas}"), Atlas.open(atlas, writable=False) as found:
        plane = found.plane
        plane.validate()
        facts: dict[str, Any] = {
            "file": str(atlas),
            **_counts(plane),
            "outer_face": plane.outer_face,
            "outer_edges": _outer_edges(plane),
            "dead_ends": int((plane.degree == 1).sum()),
            **_measured(plane),
            "origin": found.origin,
            "alike": found.origin == "map" and found.n_events > 0 and found.walk.header.sigma is None,
            "events": found.n_events,
            "checks": _checks(plane),
            "health": None if plane.heading is None else health(plane).counts,
            "fixed": None,
            "names": found.kinds,
            "statements": len(found.statements),
            "guess": _guess(found.guess),
            "provenance": [
                {"source": p.source, "kind": p.kind, "sha256": p.sha256, "tool": p.tool, "made": p.made}
                for p in found.provenance
            ],
            "warnings": list(found.warnings),
        }
    with progress("holding the headings against each other"):
        measured = _fixed_by_headings(plane, asked=rigidity)
    if measured is not None:
        facts["fixed"] = measured.counts
        facts["warnings"] += measured.warnings
    if as_json:
        print_json(facts)
    else:
        _show(facts, plane)
    return 0


def name(
    atlas: AtlasPath,
    set_name: Annotated[
        str, typer.Argument(metavar="NAME", help="The name to give it: any text without a colon.", show_default=False)
    ],
    set_text: Annotated[
        str,
        typer.Argument(
            metavar="SET",
            help="vertex:v3, edge:v1,v3, edge:@e7, path:v1,v2,@e9,v3, line:@e1,@e2, cycle:v0,v1,v8,v7, face:12, "
            'faces:3,4,9, a stored name, or a JSON list such as ["cycle", "a, north", "b", "c"].',
            show_default=False,
        ),
    ],
    *,
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Store a place, a path or a region of the map under a name."""
    from ninefold.io import Atlas

    with progress(f"reading {atlas}"), Atlas.open(atlas) as found:
        item = found.name(set_name, set_text, force=force)
    if as_json:
        print_json({"name": set_name, "set": set_text, "kind": type(item).__name__.lower(), "dimension": item.dimension})
    else:
        print(f"{set_name}: {item!r}, stored in {atlas}")
    return 0


def _guess(guess: "Guess | None") -> dict[str, Any] | None:
    """Return what is in doubt about the map as a JSON value; None for one that is no guess."""
    if guess is None:
        return None
    from math import degrees

    return {
        "count": guess.count,
        "bits": guess.bits,
        "sigma": degrees(guess.sigma),
        "drift": degrees(guess.drift),
        "doubts": doubts_as_json(guess.doubts, guess.more),
    }


def _counts(plane: "PlaneMap") -> dict[str, int]:
    return {
        "vertices": plane.n_vertices,
        "edges": plane.n_edges,
        "faces": plane.n_faces,
        "components": plane.n_components,
    }


def _described(plane: "PlaneMap") -> str:
    return repr(plane).removeprefix("PlaneMap(").removesuffix(")")


def _outer_edges(plane: "PlaneMap") -> list[str]:
    """Return the edges along the outer face, in order of the walk, each once."""
    edges = dict.fromkeys(d >> 1 for d in plane.face_darts(plane.outer_face) if not plane.tether[d >> 1])
    return [plane.edge_names[e] for e in edges]


def _measured(plane: "PlaneMap") -> dict[str, int]:
    """Return how many edges have a measured length, if any has."""
    return {} if plane.metres is None else {"measured_lengths": int((plane.metres > 0).sum())}


def _checks(plane: "PlaneMap") -> dict[str, Any]:
    """Return what `PlaneMap.validate` has just confirmed, and how well headings and turns agree."""
    checks: dict[str, Any] = {"euler": True, "turning": None, "largest_residual": None, "worst_edge": None}
    if plane.heading is not None and plane.turn is not None and plane.n_edges:
        import numpy as np

        from ninefold.mapping.turning import edge_residual

        residual = np.where(plane.tether, 0.0, np.abs(edge_residual(plane.heading, plane.turn)))
        worst = int(np.nanargmax(residual))
        checks |= {"turning": True, "largest_residual": float(residual[worst]), "worst_edge": plane.edge_names[worst]}
    return checks


def _fixed_by_headings(plane: "PlaneMap", *, asked: bool) -> "Rigidity | None":
    """Return what the headings fix; None for a map without headings, or one that is large if nobody asked."""
    if plane.heading is None:
        if asked:
            note("the map has no headings, so nothing is fixed by them")
        return None
    if plane.n_edges > FIXED_UP_TO and not asked:
        note(f"what the headings fix is left out, with {counted(plane.n_edges, 'edge')}; --rigidity works it out")
        return None
    from ninefold.layout import rigidity

    tested = asked or plane.n_edges <= TESTED_UP_TO
    if not tested:
        note(f"the headings of {counted(plane.n_edges, 'edge')} were not held against each other; --rigidity does")
    return rigidity(plane, tested=tested)


def _fixed_in_words(counts: dict[str, int]) -> str:
    """Return the line on what the headings fix."""
    text = f"{counts['legs']:,} of {counted(counts['all'], 'leg')}"
    if counts["parts"]:
        text += f", in {counted(counts['parts'], 'part')} (largest {counts['largest']:,})"
    for key, noun, what in (("open", "proportion", "open"), ("curved", "leg", "curved")):
        n = counts[key]
        text += f"; {counted(n, noun) if n else f'no {noun}'} {'are' if n > 1 else 'is'} {what}"
    return text


def _show(facts: dict[str, Any], plane: "PlaneMap") -> None:
    from ninefold.mapping import health

    outer = facts["outer_edges"]
    print(f"{facts['file']}: {_described(plane)}")
    print(
        f"outer face   {facts['outer_face']}, along {counted(len(outer), 'edge')}"
        f"{': ' + ', '.join(outer[:6]) if outer else ''}"
        f"{', ...' if len(outer) > 6 else ''}"
    )
    print(f"dead ends    {facts['dead_ends']}")
    if "measured_lengths" in facts:
        print(f"lengths      measured along {facts['measured_lengths']} of {counted(facts['edges'], 'edge')}")
    turning = "no headings" if facts["checks"]["turning"] is None else "every face turns once"
    print(f"checks       V - E + F is right; {turning}")
    if plane.heading is not None:
        print(f"health       {health(plane)}")
    if facts["fixed"] is not None:
        print(f"headings fix {_fixed_in_words({**facts['fixed'], 'all': facts['edges']})}")
    events = f", {counted(facts['events'], 'event')}" if facts["origin"] == "walk" or facts["events"] else ""
    estimated = facts["origin"] == "map" and facts["events"]
    walk = "walk whose places look alike" if facts["alike"] else "walk whose headings err"
    print(f"made from    a {walk if estimated else facts['origin']}{events}")
    for record in facts["provenance"]:
        print(f"source       {record['source']} ({record['kind']}, {record['tool']}, {record['made']})")
    named = facts["names"]
    kinds = ", ".join(counted(count, kind) for kind, count in sorted(Counter(named.values()).items()))
    shown = ", ".join(list(named)[:8]) + (", ..." if len(named) > 8 else "")
    print(f"named sets   {kinds}: {shown}" if named else "named sets   none")
    if facts["statements"]:
        print(f"statements   {facts['statements']}")
    for warning in first_few(facts["warnings"]):
        print(f"note         {warning}")
