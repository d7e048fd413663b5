"""Every outside format, a folder a family; coordinates may enter here, and nothing below keeps them.

**In.** `read_source` gives a `Source`: vertices, polylines and notes, with shapely geometry at hand; GeoJSON lines in the
base install, and the bundled `samples` (`ninefold.io.sources`). `read_walk` reads what a robot sensed (`ninefold.io.walks`),
`read_network` a set of declared relations (`ninefold.io.networks`), `read_pose_graph` odometry and loop closures, which
`judge_closures` judges (`ninefold.io.graphs`). `read_map` takes any source, walk or atlas and gives the
plane map (`ninefold.io.maps`); what a file is, one table tells (`ninefold.io.formats`).

**Kept.** `Atlas` is one SQLite file with a walk, its map, named sets, declared relations and where all that came from
(`ninefold.io.atlas`). An event that was appended is there after a crash.

**Out.** `relations.write_relations` writes tables of relations.

A reader raises `BadInput` with the file, the place in it and what to do; files are written beside the target and renamed, so
nothing half-written is ever seen. The names load when they are first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ninefold._lazy import attach

if TYPE_CHECKING:
    from .atlas.atlas import Atlas
    from .atlas.guess import Guess
    from .atlas.records import Provenance, Statement
    from .graphs.closures import judge_closures
    from .graphs.g2o import read_pose_graph
    from .maps import read_map
    from .networks.network_file import read_network, write_network
    from .sources import samples
    from .sources.reading import read_source
    from .sources.source import Source
    from .walks.json_lines import iter_events, read_walk, write_walk

__all__ = [
    "Atlas",
    "Guess",
    "Provenance",
    "Source",
    "Statement",
    "iter_events",
    "judge_closures",
    "read_map",
    "read_network",
    "read_pose_graph",
    "read_source",
    "read_walk",
    "samples",
    "write_network",
    "write_walk",
]

__getattr__, __dir__ = attach(
    __name__,
    {
        "atlas.atlas": ("Atlas",),
        "atlas.guess": ("Guess",),
        "atlas.records": ("Provenance", "Statement"),
        "graphs.closures": ("judge_closures",),
        "graphs.g2o": ("read_pose_graph",),
        "maps": ("read_map",),
        "networks.network_file": ("read_network", "write_network"),
        "sources.reading": ("read_source",),
        "sources.source": ("Source",),
        "walks.json_lines": ("iter_events", "read_walk", "write_walk"),
    },
    parts=("sources.samples",),
)
