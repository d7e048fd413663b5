"""Reading a source in whatever format it is."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ninefold.errors import BadInput

from . import samples
from .geojson import read_geojson

if TYPE_CHECKING:
    from os import PathLike

    from .source import Source

__all__ = ["read_source"]


def read_source(path: str | PathLike[str]) -> Source:
    """Read a source with geometry; the format is recognised, and ``sample:NAME`` is a bundled one.

    Raises
    ------
    BadInput
        For a file that cannot be read, or no known format.

    Examples
    --------
    >>> from ninefold.io import read_source
    >>> read_source("sample:office").n_edges > 5
    True
    """
    text = str(path)
    if text.startswith("sample:"):
        return samples.load(text.removeprefix("sample:"))
    suffix = Path(text).suffix.lower()
    if suffix in (".geojson", ".json"):
        return read_geojson(path)
    raise BadInput(
        f"{text}: no source with geometry is known by {suffix or 'no suffix'!r}; give a .geojson file or sample:NAME"
    )
