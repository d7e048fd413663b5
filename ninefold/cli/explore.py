"""``ninefold explore``: a simulated robot walks a source with geometry."""

from pathlib import Path
from typing import Annotated

import typer

from ._options import AsJson, DropCrossing, Force, SourceText
from ._output import note, notes, print_json, progress

__all__ = ["explore"]


def explore(
    source: SourceText,
    *,
    out: Annotated[
        Path, typer.Option("--out", "-o", metavar="WALK", help="The walk log to write (.jsonl).", show_default=False)
    ],
    start: Annotated[str | None, typer.Option(help="First place; left out, one of the largest component.")] = None,
    seed: Annotated[
        int | None, typer.Option(min=0, help="Of the order of exits and the noise; left out, no chance.")
    ] = None,
    noise: Annotated[float, typer.Option(min=0.0, help="Standard deviation of the heading, radians.")] = 0.0,
    step: Annotated[float, typer.Option(help="Metres between samples.")] = 1.0,
    exits: Annotated[bool, typer.Option("--exits/--no-exits", help="Log the exits of every place.")] = True,
    tolerance: Annotated[float | None, typer.Option(help="For the header: radians within which headings are one.")] = None,
    drop_crossing: DropCrossing = False,
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Simulate a robot that explores a source depth-first, every place and every way, and write its walk log."""
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
        robot = walk_in(world, start=start, seed=seed, noise=noise, step=step, exits=exits, tolerance=tolerance)
    with progress(f"writing {out}"):
        write_walk(robot.walk, out)
    warnings = list(found.notes)
    missed = sum(map(len, robot.unreached))
    if missed:
        count = len(robot.unreached)
        parts = "1 other component" if count == 1 else f"{count:,} other components"
        warnings.append(
            f"{missed:,} of {found.n_vertices:,} places are in {parts} that cannot be reached from {robot.start!r}, "
            f"the first with {robot.unreached[0][0]!r}; --start begins elsewhere"
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
                "crossings": sum(crossing.places for crossing in found.crossings),
                "unreached": [list(part) for part in robot.unreached],
                "warnings": warnings,
            }
        )
    else:
        notes(warnings)
        note(f"no crossing without a vertex in {found.n_edges:,} edges")
        print(
            f"{out}: {found.n_vertices - missed:,} places, {robot.walk.n_legs:,} legs, {robot.metres:,.0f} m, "
            f"{len(robot.walk.events):,} events, from {robot.start!r}"
        )
    return 0
