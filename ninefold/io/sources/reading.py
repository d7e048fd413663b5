"""Reading a source in whatever format it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..formats import recognise
from . import samples
from .geojson import read_geojson

if TYPE_CHECKING:
    from os import PathLike

    from ninefold.mapping import PlaneMap

    from .source import Source

__all__ = ["map_of_source", "read_source"]


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
    recognise(path, "source")
    return read_geojson(path)


def map_of_source(path: str | PathLike[str]) -> PlaneMap:
    """Read a source with geometry as a plane map; see `read_source` and `Source.to_map`."""
    return read_source(path).to_map()
