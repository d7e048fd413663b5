"""``ninefold claims``: which loop closures of a pose graph cannot be right."""

from pathlib import Path
from typing import Annotated

import typer

from ninefold._wording import counted

from ._options import AsJson, Force
from ._output import note, print_json, progress

__all__ = ["claims"]

YES, NO, SPENT = 0, 1, 3


def claims(
    graph: Annotated[
        Path,
        typer.Argument(metavar="GRAPH", help="A pose graph in the plane, .g2o.", show_default=False),
    ],
    *,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="CLEANED.g2o", help="Write it without them.", show_default=False),
    ] = None,
    headings_only: Annotated[
        bool, typer.Option("--headings-only", help="Judge by headings alone, where lengths are not to be trusted.")
    ] = False,
    budget: Annotated[
        float | None,
        typer.Option(min=0.001, help="Seconds to find the fewest to reject, 60 if left out.", show_default=False),
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Name the loop closures that cannot be right, and why.

    A loop of odometry and closures must come back to where it began, within the errors that the file declares. Exit code 1
    if any closure is rejected, 3 if the budget is spent before it is known that no fewer will do.
    """
    from ninefold._files import refuse_existing
    from ninefold.io.graphs.closures import judge_closures
    from ninefold.io.graphs.g2o import read_pose_graph, write_without

    if out is not None:
        refuse_existing(out, force=force)
    with progress(f"reading {graph}"):
        read = read_pose_graph(graph)
    closures = read.closures.size
    with progress(f"judging {counted(closures, 'closure')}"):
        judged = judge_closures(read, headings_only=headings_only, budget=budget)
    if out is not None:
        write_without(read, [one.edge for one in judged.rejected], out, force=force)
    if judged.silent:
        note(f"no loop says anything about {counted(judged.silent, 'closure')}: on the way the heading is lost, or odometry")
    if not judged.exact:
        note("the budget is spent: fewer might do; the file may declare smaller errors than there are")
    code = SPENT if not judged.exact else NO if judged.rejected else YES
    if as_json:
        print_json(
            {
                "file": str(graph),
                "poses": int(read.poses.size),
                "closures": int(closures),
                "rejected": [
                    {
                        "a": one.a,
                        "b": one.b,
                        "score": one.score,
                        "reason": one.reason,
                        "against": None if one.against is None else list(one.against),
                        "line": int(read.line[one.edge]) + 1,
                    }
                    for one in judged.rejected
                ],
                "exact": judged.exact,
                "silent": judged.silent,
                "out": None if out is None else str(out),
            }
        )
        return code
    count = len(judged.rejected)
    cannot = f"{count:,} cannot be right" if count else "none that cannot be right"
    print(f"{graph}: {counted(int(read.poses.size), 'pose')}, {counted(closures, 'closure')}, {cannot}")
    for one in judged.rejected:
        print(f"  line {read.line[one.edge] + 1}, {one.a} - {one.b}: {one.reason}")
    if out is not None:
        print(f"{out}: the graph without {'it' if count == 1 else 'them'}" if count else f"{out}: the graph as it was")
    return code
