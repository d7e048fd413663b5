"""Telling formats apart by what is in the file, and the one call that reads any of them as a map."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ninefold.errors import BadInput

if TYPE_CHECKING:
    from os import PathLike

    from ninefold.mapping import PlaneMap

__all__ = ["Format", "format_of", "read_map"]

Format = Literal["atlas", "walk", "source"]


def format_of(path: str | PathLike[str]) -> Format:
    """Say what a file is: an atlas, a walk log, or a source with geometry.

    The first bytes decide, and the suffix (``.jsonl`` is a walk) where they do not. ``sample:NAME`` is a source.

    Raises
    ------
    BadInput
        For a file that cannot be read or is none of these.
    """
    text = str(path)
    if text.startswith("sample:"):
        return "source"
    file = Path(path)
    try:
        if file.exists() and not file.is_dir() and not file.is_file():
            raise BadInput(f"{file}: a device or a pipe, which can be read only once; save it to a file first")
        with file.open("rb") as stream:
            head = stream.read(4096)
    except OSError as error:
        raise BadInput(f"{file}: cannot be read ({error.strerror or error})") from None
    suffix = file.suffix.lower()
    if head.startswith(b"SQLite format 3\0") or suffix == ".atlas":
        return "atlas"
    if suffix == ".jsonl" or _is_walk_header(head):
        return "walk"
    if suffix in (".geojson", ".json") or head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{"):
        return "source"
    raise BadInput(f"{file}: neither an atlas (.atlas), a walk log (.jsonl) nor lines in GeoJSON (.geojson)")


def _is_walk_header(head: bytes) -> bool:
    line = head.removeprefix(b"\xef\xbb\xbf").lstrip().partition(b"\n")[0]
    try:
        found = json.loads(line)
    except (ValueError, RecursionError):
        return False
    return isinstance(found, dict) and found.get("ninefold") == "walk"


def read_map(path: str | PathLike[str], *, tolerance: float | None = None) -> PlaneMap:
    """Read a plane map from an atlas, a walk log or a source with geometry; the format is recognised.

    Parameters
    ----------
    tolerance
        Radians, for a walk, instead of its header's.

    Raises
    ------
    NinefoldError
        For a file that cannot be read, or makes no plane map; the message says where and why.

    Examples
    --------
    >>> from ninefold.io import read_map
    >>> read_map("sample:figure8")
    PlaneMap(9 vertices, 13 edges, 6 faces)
    """
    match format_of(path):
        case "atlas":
            from .atlas.atlas import Atlas

            with Atlas.open(path, writable=False) as atlas:
                return atlas.plane
        case "walk":
            from ninefold.mapping.robot.mapper import build

            from .walks.json_lines import read_walk

            return build(read_walk(path, tolerance=tolerance))
        case "source":
            from .sources.reading import read_source

            return read_source(path).to_map()
