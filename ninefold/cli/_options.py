"""Arguments and options that several commands share, spelled alike."""

from pathlib import Path
from typing import Annotated

import typer

__all__ = ["AsJson", "AtlasPath", "DropCrossing", "Force", "SourceText"]

AsJson = Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")]
AtlasPath = Annotated[
    Path, typer.Argument(metavar="ATLAS", help="An atlas file, made by `ninefold map`.", show_default=False)
]
DropCrossing = Annotated[
    bool,
    typer.Option("--drop-crossing", help="Leave out edges that cross others where no place is; few, and it says which."),
]
Force = Annotated[bool, typer.Option("--force", help="Replace a file or a name that is there already.")]
SourceText = Annotated[
    str,
    typer.Argument(
        metavar="SOURCE",
        help="A walk log, lines in GeoJSON, or sample:NAME for a world that comes with it.",
        show_default=False,
    ),
]
