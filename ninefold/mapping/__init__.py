"""The plane map and how a robot builds it: without coordinates, from places, loop closures and headings alone.

**The value** is `PlaneMap`: dart arrays (`tail`, `next_ccw`), a dart on the outer face, tethers for separate components,
and the evidence (`heading`, `turn`). Dart ``d`` is half of edge ``d // 2``; ``twin(d) = d ^ 1``; everything turns
counter-clockwise and a face lies on the left of its darts.

**The builders.** `PlaneMap.from_darts`, `from_rotation`, `from_geometry` and `from_networkx` check everything and return a
whole map or raise. `Mapper` grows one event by event, and `build` runs it over a `Walk`.

**The sets** are `Point`, `Line` and `Region`; a map makes them from names, edges, cycles or faces.

Nothing here imports shapely, and only `from_geometry` and the simulated world ever see a coordinate.
"""

from __future__ import annotations

from .graphs import bridges, cut_vertices, shortest_path
from .heading import Heading, circular_mean, unwrap, wrap
from .mapper import Closure, Mapper, build
from .names import Names
from .plane import PlaneMap
from .sets import Line, Point, Region, Set
from .simulated import Exploration, SimulatedWorld, explore
from .walk import Event, Samples, Visit, Walk, WalkHeader

__all__ = [
    "Closure",
    "Event",
    "Exploration",
    "Heading",
    "Line",
    "Mapper",
    "Names",
    "PlaneMap",
    "Point",
    "Region",
    "Samples",
    "Set",
    "SimulatedWorld",
    "Visit",
    "Walk",
    "WalkHeader",
    "bridges",
    "build",
    "circular_mean",
    "cut_vertices",
    "explore",
    "shortest_path",
    "unwrap",
    "wrap",
]
