"""One call that reads any file as a plane map, whatever it is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .atlas.atlas import read_plane
from .formats import recognise
from .sources.reading import map_of_source
from .walks.mapped import map_of_walk

if TYPE_CHECKING:
    from os import PathLike

    from ninefold.mapping import PlaneMap

__all__ = ["read_map"]


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
    match recognise(path).name:
        case "walk":
            return map_of_walk(path, tolerance=tolerance)
        case "geojson":
            return map_of_source(path)
        case _:
            return read_plane(path)
