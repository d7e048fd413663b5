"""Every outside format, one module each; coordinates may enter here, and nothing below keeps them.

**In.** `read_source` gives a `Source`: vertices, polylines and notes, with shapely geometry at hand; GeoJSON lines in the
base install, and the bundled `samples`. `read_walk` reads what a robot sensed. `read_map` takes any of these, or an atlas,
and gives the plane map.

**Kept.** `Atlas` is one SQLite file with a walk, its map, named sets, declared relations and where all that came from.
An event that was appended is there after a crash.

**Out.** `relations.write_relations` writes tables of relations.

A reader raises `BadInput` with the file, the place in it and what to do; files are written beside the target and renamed, so
nothing half-written is ever seen. The names load when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import samples
    from .atlas import Atlas
    from .formats import read_map
    from .networks import read_network, write_network
    from .records import Provenance, Statement
    from .sources import Source, read_source
    from .walks import iter_events, read_walk, write_walk

__all__ = [
    "Atlas",
    "Provenance",
    "Source",
    "Statement",
    "iter_events",
    "read_map",
    "read_network",
    "read_source",
    "read_walk",
    "samples",
    "write_network",
    "write_walk",
]

_HOME = {
    "Atlas": "atlas",
    "Provenance": "records",
    "Source": "sources",
    "Statement": "records",
    "iter_events": "walks",
    "read_map": "formats",
    "read_network": "networks",
    "read_source": "sources",
    "read_walk": "walks",
    "write_network": "networks",
    "write_walk": "walks",
}


def __getattr__(name: str) -> Any:
    if name == "samples":
        return import_module(f"{__name__}.samples")
    if name in _HOME:
        return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
