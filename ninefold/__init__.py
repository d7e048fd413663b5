"""Plane maps a robot builds from places and headings alone, and exact topological relations on them.

The parts load when they are first used: `ninefold.mapping` (the plane map and how a robot builds it),
`ninefold.reasoner` (relations and answers), `ninefold.encodings` (calculi and clauses), `ninefold.layout`
(drawings and the geometric oracle) and `ninefold.io` (files).

Examples
--------
>>> import ninefold as nf
>>> square = nf.mapping.PlaneMap.from_rotation(
...     {"a": ["b", "d"], "b": ["c", "a"], "c": ["d", "b"], "d": ["a", "c"]}, outer=("b", "a"))
>>> room = square.cycle(["a", "b", "c", "d"])
>>> nf.reasoner.relate(square.vertex("a"), room).name
'meet'
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from . import encodings, errors, io, layout, mapping, reasoner
    from .io import Atlas, read_map, read_network, read_walk

__version__ = "0.1.0"
__all__ = ["Atlas", "encodings", "errors", "io", "layout", "mapping", "read_map", "read_network", "read_walk", "reasoner"]

_PARTS = ("encodings", "errors", "io", "layout", "mapping", "reasoner")
_SHORTCUTS = ("Atlas", "read_map", "read_network", "read_walk")


def __getattr__(name: str) -> Any:
    if name in _PARTS:
        return import_module(f"{__name__}.{name}")
    if name in _SHORTCUTS:
        return getattr(import_module(f"{__name__}.io"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
