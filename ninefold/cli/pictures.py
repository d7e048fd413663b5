"""``ninefold draw`` and ``ninefold verify``: a map as a picture, and its symbolic answers held against geometry."""

from pathlib import Path
from typing import Annotated

import typer

from ._options import AsJson, AtlasPath, Force
from ._output import notes, print_json, progress

__all__ = ["draw", "verify"]

LayoutName = Annotated[str, typer.Option("--layout", metavar="auto|tutte|schnyder", help="How the map is laid out.")]


def draw(
    atlas: AtlasPath,
    *,
    out: Annotated[Path, typer.Option("--out", "-o", metavar="FILE.svg", help="The picture.", show_default=False)],
    layout: LayoutName = "auto",
    highlight: Annotated[
        list[str] | None,
        typer.Option("--highlight", metavar="SET", help="Colour a stored name or a set as for `name`; up to 7 times."),
    ] = None,
    title: Annotated[str | None, typer.Option(help="A heading of its own.", show_default=False)] = None,
    theme: Annotated[str, typer.Option(metavar="auto|light|dark", help="auto follows the reader's preference.")] = "auto",
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Draw the map with straight lines, its rotation and outer face as they are, and colour the sets you name."""
    from ninefold.errors import BadInput
    from ninefold.io import Atlas
    from ninefold.io.files import published, refuse_existing

    if out.suffix.lower() != ".svg":
        raise BadInput(f"{out}: pictures are SVG; name a file that ends in .svg")
    refuse_existing(out, force=force)
    with progress(f"reading {atlas}"), Atlas.open(atlas, writable=False) as found:
        plane = found.plane
        sets = {text: found.parse(text) for text in highlight or []}
    with progress("drawing"):
        from ninefold import layout as layouts

        drawing = layouts.draw(plane, layout=layout)
        with published(out, force=force) as file:
            drawing.save(file, highlight=sets or None, title=title if title is not None else atlas.stem, theme=theme)
    notes(drawing.notes)
    if as_json:
        print_json({"file": str(out), "layout": drawing.layout, "notes": list(drawing.notes)})
    else:
        print(f"{out}: {plane!r} in the {drawing.layout} layout")
    return 0


def verify(
    atlas: AtlasPath,
    *,
    pairs: Annotated[int, typer.Option(min=1, max=1_000_000, help="How many pairs of sets to compare.")] = 2000,
    seed: Annotated[int, typer.Option(min=0, help="Of the sets and pairs drawn.")] = 0,
    layout: LayoutName = "schnyder",
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE.svg", help="A picture of the first disagreement.", show_default=False),
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Hold symbolic relations against shapely on a drawing whose planarity, rotation and outer face are checked too."""
    from ninefold.io import Atlas
    from ninefold.io.files import published, refuse_existing

    if out is not None:
        refuse_existing(out, force=force)
    with progress(f"reading {atlas}"), Atlas.open(atlas, writable=False) as found:
        plane = found.plane
    with progress(f"comparing {pairs:,} pairs"):
        from ninefold import layout as layouts

        report = layouts.verify(plane, seed=seed, n_pairs=pairs, layout=layout)
    if report.disagreements and out is not None:
        with progress("shrinking the first disagreement"):
            svg = report.disagreements[0].minimal().to_svg()
        with published(out, force=force) as file:
            file.write_text(svg, encoding="utf-8")
    if as_json:
        found_problems = [*report.problems, *map(str, report.disagreements[:10])]
        print_json({"pairs": report.pairs, "agree": report.agree, "wrong": report.wrong, "problems": found_problems})
    else:
        print(report)
    return 0 if report.agree else 1
