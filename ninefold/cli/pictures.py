"""``ninefold draw`` and ``ninefold verify``: a map as a picture, and its symbolic answers held against geometry."""

from pathlib import Path
from typing import Annotated

import typer

from ninefold._wording import counted, quoted

from ._options import AsJson, AtlasPath, Force
from ._output import note, notes, print_json, progress

__all__ = ["draw", "verify"]

LayoutName = Annotated[
    str,
    typer.Option(
        "--layout",
        metavar="auto|compass|tutte|schnyder|relaxed",
        help="How the map is laid out. auto: as its headings say (compass), or without headings, tutte.",
    ),
]


def draw(
    atlas: AtlasPath,
    *,
    out: Annotated[Path, typer.Option("--out", "-o", metavar="FILE.svg", help="The picture.", show_default=False)],
    layout: LayoutName = "auto",
    highlight: Annotated[
        list[str] | None,
        typer.Option(
            "--highlight", metavar="SET", help="A named set, or one such as cycle:a,b,c, to colour; up to 7 times."
        ),
    ] = None,
    title: Annotated[
        str | None, typer.Option(help="What stands above the picture; left out, the name of the atlas.", show_default=False)
    ] = None,
    theme: Annotated[
        str, typer.Option(metavar="auto|light|dark", help="Colours; auto follows the setting of whoever looks at it.")
    ] = "auto",
    curved: Annotated[
        bool, typer.Option("--curved", help="In the compass layout, draw every leg as the curve that its headings tell.")
    ] = False,
    rigidity: Annotated[
        bool,
        typer.Option(
            "--rigidity",
            help="Colour the legs by what the headings fix: measured shapes, evened-out lengths, headings that do not fit.",
        ),
    ] = False,
    health: Annotated[
        bool,
        typer.Option(
            "--health", help="Colour the legs by how far their headings and turn disagree, with a scale in degrees."
        ),
    ] = False,
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Draw the map, with the ways around each place in their order, and colour the sets you name."""
    from ninefold._files import refuse_existing, shown, write_text
    from ninefold.errors import BadInput
    from ninefold.io import Atlas

    if out.suffix.lower() != ".svg":
        raise BadInput(f"{shown(out)}: pictures are SVG; name a file that ends in .svg")
    if curved and layout not in ("auto", "compass"):
        raise BadInput(f"--curved is for --layout compass, which follows the headings, not for {quoted(layout)}")
    if rigidity and health:
        raise BadInput("--rigidity and --health both colour the legs; give one of them")
    refuse_existing(out, force=force)
    with progress(f"reading {atlas}"), Atlas.open(atlas, writable=False) as found:
        plane = found.plane
        sets = {text: found.parse(text) for text in highlight or []}
        guess = found.guess
    with progress("drawing"):
        from ninefold import layout as layouts
        from ninefold import mapping

        measured = layouts.rigidity(plane) if rigidity else None
        closing = mapping.health(plane) if health else None
        drawing = layouts.compass(plane, curved=True) if curved else layouts.draw(plane, layout=layout)
        heading = title if title is not None else atlas.stem
        svg = drawing.to_svg(
            highlight=sets or None,
            title=heading,
            theme=theme,
            rigidity=measured or False,
            health=closing or False,
            doubts=guess.told if guess else (),
        )
        write_text(out, svg, force=force)
    doubted = guess.warnings[:1] if guess else ()
    said = (*doubted, *drawing.notes, *(measured.warnings if measured else ()))
    notes(said)
    if as_json:
        facts = {"fixed": measured.counts} if measured else {"health": closing.counts} if closing else {}
        print_json({"file": str(out), "layout": drawing.layout, "notes": list(said), **facts})
    else:
        print(f"{out}: {plane!r} in the {drawing.layout} layout")
    return 0


def verify(
    atlas: AtlasPath,
    *,
    pairs: Annotated[int, typer.Option(min=1, max=1_000_000, help="How many pairs of sets to compare.")] = 2000,
    seed: Annotated[int, typer.Option(min=0, help="Seed of the random sets and pairs.")] = 0,
    layout: LayoutName = "schnyder",
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            "-o",
            metavar="FILE.svg",
            help="Where to draw the first pair that disagrees, if one does.",
            show_default=False,
        ),
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Check the map and its relations on a drawing of it: the same pairs of sets, related by shapely from coordinates."""
    from ninefold._files import refuse_existing, write_text
    from ninefold.io import Atlas

    if out is not None:
        refuse_existing(out, force=force)
    with progress(f"reading {atlas}"), Atlas.open(atlas, writable=False) as found:
        plane = found.plane
    with progress(f"comparing {counted(pairs, 'pair')}"):
        from ninefold import layout as layouts

        drawing = layouts.draw(plane, layout=layout)
        report = layouts.verify(plane, seed=seed, n_pairs=pairs, drawing=drawing)
    notes(drawing.notes)
    if report.disagreements and out is not None:
        with progress("shrinking the first disagreement"):
            svg = report.disagreements[0].minimal().to_svg()
        write_text(out, svg, force=force)
        note(f"{out}: a picture of the first disagreement")
    elif out is not None:
        note(f"{out}: not written, since there is no disagreement to draw")
    if as_json:
        found_problems = [*report.problems, *map(str, report.disagreements[:10])]
        facts = {"pairs": report.pairs, "agree": report.agree, "wrong": report.wrong, "problems": found_problems}
        print_json({**facts, "layout": drawing.layout, "notes": list(drawing.notes)})
    else:
        print(report)
    return 0 if report.agree else 1
