"""``ninefold explore``: a simulated robot walks a source with geometry."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import typer

from ninefold._wording import counted, quoted

from ._options import AsJson, DropCrossing, Force, SourceText
from ._output import note, notes, print_json, progress

if TYPE_CHECKING:
    from ninefold.mapping.robot.simulated import Tour

__all__ = ["explore"]


def explore(
    source: SourceText,
    *,
    out: Annotated[
        Path, typer.Option("--out", "-o", metavar="WALK", help="The walk log to write (.jsonl).", show_default=False)
    ],
    start: Annotated[
        str | None, typer.Option(help="The place to begin at; left out, one in the largest connected part.")
    ] = None,
    seed: Annotated[
        int | None, typer.Option(min=0, help="Seed of random choices; left out, exits are taken in a fixed order.")
    ] = None,
    noise: Annotated[
        float,
        typer.Option(
            min=0.0, help="Standard deviation of the error of a heading, each by itself, in radians (0.035 is 2 degrees)."
        ),
    ] = 0.0,
    drift: Annotated[
        float,
        typer.Option(min=0.0, help="That of a bias common to all headings at one place, which changes slowly; in radians."),
    ] = 0.0,
    tour: Annotated[
        str,
        typer.Option(
            metavar="depth-first|covering|wall",
            help="Where to go next: back the way it came, to the nearest new way, or on along the wall on the right.",
        ),
    ] = "depth-first",
    tours: Annotated[int, typer.Option(min=1, help="How often to walk every way anew.")] = 1,
    step: Annotated[float, typer.Option(help="Metres between two samples of the heading.")] = 1.0,
    exits: Annotated[
        bool, typer.Option("--exits/--no-exits", help="Whether the log tells the exits seen at every place.")
    ] = True,
    places: Annotated[
        bool,
        typer.Option("--places/--no-places", help="Whether the log names places and ways, or the robot recognises none."),
    ] = True,
    ordered_exits: Annotated[
        bool,
        typer.Option("--ordered-exits", help="List exits in their true order, counter-clockwise, whatever their headings."),
    ] = False,
    metres: Annotated[bool, typer.Option("--metres", help="Let the log tell the length of every leg too.")] = False,
    tolerance: Annotated[
        float | None, typer.Option(help="Written into the log: headings that differ by less, in radians, count as one.")
    ] = None,
    drop_crossing: DropCrossing = False,
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Let a simulated robot visit every place and walk every way of a source, and write the log of its walk."""
    from ninefold._files import refuse_existing
    from ninefold.errors import BadInput
    from ninefold.io.sources.reading import read_source
    from ninefold.io.walks.json_lines import write_walk

    refuse_existing(out, force=force)
    if out.exists() and not source.startswith("sample:") and out.samefile(source):
        raise BadInput(f"{out}: the source itself, which the walk would replace; give -o another name")
    with progress(f"reading {source}"):
        from ninefold.mapping.robot.simulated import explore as walk_in

        found = read_source(source)
        if drop_crossing:
            found = found.without_crossings()
        world = found.to_world()
    with progress("exploring"):
        robot = walk_in(
            world,
            start=start,
            seed=seed,
            noise=noise,
            drift=drift,
            tour=cast("Tour", tour),
            tours=tours,
            step=step,
            exits=exits,
            ordered_exits=ordered_exits,
            places=places,
            metres=metres,
            tolerance=tolerance,
        )
    with progress(f"writing {out}"):
        write_walk(robot.walk, out)
    warnings = list(found.notes)
    missed = sum(map(len, robot.unreached))
    if missed:
        warnings.append(
            f"{missed:,} of {counted(found.n_vertices, 'place')} cannot be reached from {quoted(robot.start)}: they are in "
            f"{counted(len(robot.unreached), 'other component')}, the first with {quoted(robot.unreached[0][0])}; --start "
            "begins elsewhere"
        )
    if as_json:
        print_json(
            {
                "file": str(out),
                "start": robot.start,
                "vertices": found.n_vertices - missed,
                "legs": robot.walk.n_legs,
                "events": len(robot.walk.events),
                "metres": round(robot.metres, 3),
                "tolerance": robot.walk.header.tolerance,
                "sigma": robot.walk.header.sigma,
                "drift": robot.walk.header.drift,
                "crossings": sum(crossing.places for crossing in found.crossings),
                "unreached": [list(part) for part in robot.unreached],
                "warnings": warnings,
            }
        )
    else:
        notes(warnings)
        note(f"no crossing without a vertex in {counted(found.n_edges, 'edge')}")
        print(
            f"{out}: {counted(found.n_vertices - missed, 'place')}, {counted(robot.walk.n_legs, 'leg')}, "
            f"{robot.metres:,.0f} m, {counted(len(robot.walk.events), 'event')}, from {quoted(robot.start)}"
        )
    return 0
