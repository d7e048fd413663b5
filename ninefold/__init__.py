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
>>> nf.relate(square.vertex("a"), room).name
'meet'
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ninefold._lazy import attach

if TYPE_CHECKING:
    from . import encodings, errors, io, layout, mapping, reasoner
    from .errors import NinefoldError
    from .io.atlas.atlas import Atlas
    from .io.maps import read_map
    from .io.networks.network_file import read_network
    from .io.walks.json_lines import read_walk
    from .layout.layouts import draw
    from .layout.oracle import verify
    from .mapping.plane import PlaneMap
    from .mapping.robot.mapper import Mapper, build
    from .reasoner.networks.consistency import check
    from .reasoner.networks.network import Network
    from .reasoner.sets.relate import relate

__version__ = "0.1.0"
__all__ = [
    "Atlas",
    "Mapper",
    "Network",
    "NinefoldError",
    "PlaneMap",
    "build",
    "check",
    "draw",
    "encodings",
    "errors",
    "io",
    "layout",
    "mapping",
    "read_map",
    "read_network",
    "read_walk",
    "reasoner",
    "relate",
    "verify",
]

__getattr__, __dir__ = attach(
    __name__,
    {
        "errors": ("NinefoldError",),
        "io.atlas.atlas": ("Atlas",),
        "io.maps": ("read_map",),
        "io.networks.network_file": ("read_network",),
        "io.walks.json_lines": ("read_walk",),
        "layout.layouts": ("draw",),
        "layout.oracle": ("verify",),
        "mapping.plane": ("PlaneMap",),
        "mapping.robot.mapper": ("Mapper", "build"),
        "reasoner.networks.consistency": ("check",),
        "reasoner.networks.network": ("Network",),
        "reasoner.sets.relate": ("relate",),
    },
    parts=("encodings", "errors", "io", "layout", "mapping", "reasoner"),
)
