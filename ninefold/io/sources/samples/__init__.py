"""Bundled sources: a district of real streets, and small worlds in planar metres.

``helsinki_district`` is © OpenStreetMap contributors under the ODbL; see ``NOTICE.md`` beside it. The others are drawn by
hand: ``figure8`` is the graph of figure 8 of Corcoran and Bertolotto; the rest are of its size and have what it lacks:
dead ends (``office``), cut vertices and bridges (``house``), curved corridors and a loop (``ring``), a K4 (``crossing``),
parallel edges (``garden``).

Examples
--------
>>> from ninefold.io import samples
>>> samples.names()
('crossing', 'figure8', 'garden', 'helsinki_district', 'house', 'office', 'ring')
>>> samples.load("garden").to_map()
PlaneMap(5 vertices, 9 edges, 6 faces)
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ninefold.errors import UnknownName

if TYPE_CHECKING:
    from ..source import Source

__all__ = ["load", "names", "path"]

_FOLDER = Path(__file__).parent


def names() -> tuple[str, ...]:
    """Return the names of the bundled sources, sorted."""
    return tuple(sorted(file.stem for file in _FOLDER.glob("*.geojson")))


def path(name: str) -> Path:
    """Return the GeoJSON file of a bundled source.

    Raises
    ------
    UnknownName
        With near names.
    """
    known = names()
    if name not in known:
        raise UnknownName("sample", name, known)
    return _FOLDER / f"{name}.geojson"


def load(name: str) -> Source:
    """Read a bundled source."""
    from dataclasses import replace

    from ..geojson import read_geojson

    return replace(read_geojson(path(name)), origin=name)
