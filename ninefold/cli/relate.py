"""``ninefold relate``: one relation, or a table of all."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ninefold._wording import counted

from ._options import AsJson, AtlasPath, Force
from ._output import print_json, progress

if TYPE_CHECKING:
    from ninefold.io import Atlas
    from ninefold.mapping import Set

__all__ = ["relate"]

_MATRIX = "IBE"


def relate(
    atlas: AtlasPath,
    x: Annotated[
        str | None,
        typer.Argument(
            metavar="X",
            help="A name that was stored, or a set such as cycle:a,b,c; `ninefold name --help` shows the forms.",
            show_default=False,
        ),
    ] = None,
    y: Annotated[
        str | None,
        typer.Argument(metavar="Y", help="The set that X is related to, written in the same way.", show_default=False),
    ] = None,
    *,
    every: Annotated[bool, typer.Option("--all", help="Write a table of all pairs of the named sets.")] = False,
    faces: Annotated[bool, typer.Option("--faces", help="Write a table of all pairs of the bounded faces.")] = False,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FILE", help="The file of the table: .csv or .parquet.", show_default=False),
    ] = None,
    force: Force = False,
    as_json: AsJson = False,
) -> int:
    """Tell how X lies to Y, as a word, a DE-9IM matrix and, for two regions, in RCC-8; or write a table of all pairs."""
    from ninefold.errors import BadInput
    from ninefold.io import Atlas

    table = every or faces
    if table and (x is not None or y is not None):
        raise BadInput("give either two sets X and Y, or --all or --faces with -o FILE")
    if table and out is None:
        raise BadInput("a table needs a file: -o FILE.csv or -o FILE.parquet")
    if not table and (x is None or y is None):
        raise BadInput("give two sets X and Y, or --all -o FILE")
    if not table and out is not None:
        raise BadInput("-o FILE goes with --all or --faces; one relation is printed")
    with progress(f"reading {atlas}"), Atlas.open(atlas, writable=False) as found:
        if x is not None and y is not None:
            return _one(found, x, y, as_json=as_json)
        sets = _faces(found) if faces else found.sets
    if out is not None:
        _table(sets, out, force=force, as_json=as_json)
    return 0


def _one(atlas: "Atlas", x: str, y: str, *, as_json: bool) -> int:
    from ninefold.reasoner.sets.relate import relate as relation_of

    relation = relation_of(atlas.parse(x), atlas.parse(y))
    matrix = relation.matrix.astype(int).tolist()
    if as_json:
        print_json({"x": x, "y": y, "name": relation.name, "de9im": relation.de9im, "matrix": matrix, "rcc8": relation.rcc8})
        return 0
    print(f"{x}  {relation.name}  {y}")
    print(f"DE-9IM {relation.de9im}" + (f"   RCC-8 {relation.rcc8}" if relation.rcc8 else ""))
    print("    " + "  ".join(_MATRIX))
    for letter, row in zip(_MATRIX, matrix, strict=True):
        print(f" {letter}  " + "  ".join(map(str, row)))
    return 0


def _faces(atlas: "Atlas") -> "dict[str, Set]":
    plane = atlas.plane
    return {f"face:{face}": plane.face(face) for face in range(plane.n_faces) if face != plane.outer_face}


def _table(sets: "dict[str, Set]", out: Path, *, force: bool, as_json: bool) -> None:
    import numpy as np

    from ninefold._files import refuse_existing
    from ninefold.errors import BadInput
    from ninefold.io.relations import write_relations
    from ninefold.reasoner import relate_all

    if len(sets) < 2:
        raise BadInput(f"there {'is only one set' if sets else 'is no set'} to relate; store sets with `ninefold name`")
    refuse_existing(out, force=force)
    with progress(f"relating {counted(len(sets), 'set')}"):
        codes = relate_all(list(sets.values()))
    with progress(f"writing {out}"):
        pairs = np.stack(np.triu_indices(len(sets), 1), axis=1)
        rows = write_relations(out, list(sets), pairs, codes[pairs[:, 0], pairs[:, 1]], force=force)
    if as_json:
        print_json({"file": str(out), "sets": len(sets), "pairs": rows})
    else:
        print(f"{out}: {counted(rows, 'pair')} of {counted(len(sets), 'set')}")
