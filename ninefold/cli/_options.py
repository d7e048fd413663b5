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
    bool, typer.Option("--drop-crossing", help="Drop edges that meet others without a vertex, as few as seems possible.")
]
Force = Annotated[bool, typer.Option("--force", help="Replace what is there.")]
SourceText = Annotated[
    str,
    typer.Argument(metavar="SOURCE", help="A file, or sample:NAME for a bundled world.", show_default=False),
]
