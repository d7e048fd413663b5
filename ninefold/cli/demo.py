"""``ninefold demo``: the main job on bundled real streets."""

import time
from pathlib import Path
from typing import Annotated

import typer

from ._options import AsJson
from ._output import note, print_json, progress

__all__ = ["demo"]


def demo(
    *,
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for what the demo writes.")] = Path("demo-out"),
    seed: Annotated[
        int, typer.Option(min=0, help="Seed of the robot's choices and of the sets and pairs that are compared.")
    ] = 1,
    pairs: Annotated[
        int, typer.Option(min=1, max=1_000_000, help="How many pairs of sets to compare with shapely.")
    ] = 20_000,
    as_json: AsJson = False,
) -> int:
    """Let a robot walk a district of Helsinki, map it from headings, and check every relation against the real streets."""
    start = time.perf_counter()
    with progress("loading"):
        from ._demonstration import run_demo

    with progress("exploring, mapping and comparing"):
        report = run_demo(out, seed=seed, pairs=pairs, say=note if as_json else print)
    seconds = time.perf_counter() - start
    if as_json:
        print_json(
            {
                "source": report.source,
                "events": report.events,
                "legs": report.legs,
                "metres": round(report.metres, 1),
                "vertices": report.plane.n_vertices,
                "edges": report.plane.n_edges,
                "faces": report.plane.n_faces,
                "sets": report.sets,
                "pairs": report.pairs,
                "agree": report.agree,
                "problems": list(report.problems),
                "pairs_on_drawing": report.drawn,
                "wrong_on_drawing": report.drawn_wrong,
                "heading_error_deg": [round(degrees, 3) for degrees in report.heading_error],
                "misplaced": round(report.misplaced, 4),
                "misplaced_tutte": round(report.misplaced_tutte, 4),
                "mismatches": [[m.x, m.y, m.map, m.ground] for m in report.mismatches],
                "relations": report.names,
                "seconds": {**{step: round(took, 3) for step, took in report.seconds.items()}, "all": round(seconds, 3)},
                "files": {name: str(path) for name, path in report.files.items()},
            }
        )
    else:
        for mismatch in report.mismatches[:10]:
            print(f"  {mismatch.x} and {mismatch.y}: {mismatch.map} on the map, {mismatch.ground} on the ground")
        print("Relations: " + ", ".join(f"{name} {count:,}" for name, count in report.names.items()) + ".")
        print(
            "Time: "
            + ", ".join(f"{step} {took:.1f} s" for step, took in report.seconds.items())
            + f"; in all {seconds:.1f} s."
        )
        print("Files: " + ", ".join(str(path) for path in report.files.values()))
        print(f"Try: ninefold relate {report.files['district.atlas']} 'block 1' 'street Bulevardi'")
    return 0 if report.agree else 1
