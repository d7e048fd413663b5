"""The plane map and how a robot builds it: without coordinates, from places, loop closures and headings alone.

**The value** is `PlaneMap`: dart arrays (`tail`, `next_ccw`), a dart on the outer face, tethers for separate components,
and the evidence (`heading`, `turn`, `metres`). Dart ``d`` is half of edge ``d // 2``; ``twin(d) = d ^ 1``; everything turns
counter-clockwise and a face lies on the left of its darts.

**The builders.** `PlaneMap.from_darts`, `from_rotation`, `from_geometry` and `from_networkx` check everything and return a
whole map or raise. How a robot builds one, event by event, is a room of its own, `ninefold.mapping.robot`: a `Mapper` grows
a map, `build` runs it over a `Walk`, and `explore` simulates a robot.

**Its health** is how well headings and turns agree, edge by edge: `health`.
**Where it is.** A `Localizer` tells where on a map a robot can be that was switched on somewhere, from noisy headings;
`locate` takes one along a walk, a `Follower` event by event.

**The sets** are `Point`, `Line` and `Region`; a map makes them from names, edges, cycles or faces. `Vertex`, `Dart`, `Edge`
and `Face` are types for the numbers that index the arrays of a map.

Nothing here imports shapely, and only `from_geometry` and the simulated world ever see a coordinate. The names load when
they are first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ninefold._lazy import attach

if TYPE_CHECKING:
    from .closing import Health, health
    from .doubt.ambiguities import ambiguity
    from .doubt.among import Whereabouts, WhichMap, locate_among
    from .doubt.ask_driven import AskDriven
    from .doubt.backbone import Backbone
    from .doubt.claims import Claim, Claims, Rejection, claims
    from .doubt.completeness import Completeness
    from .doubt.completeness_check import listed_maps
    from .doubt.doubt_driven import DoubtDriven
    from .doubt.doubts import Again, Doubt
    from .doubt.estimate import Estimate, estimate
    from .doubt.following import Follower, locate
    from .doubt.hypotheses import Hypotheses, Hypothesis, hypotheses
    from .doubt.joining import joined
    from .doubt.localizer import Candidate, Localizer, Move
    from .doubt.merging import Merged, Overlaps, merge, overlaps
    from .doubt.opening import open_map
    from .doubt.why_not import WhyNot
    from .graphs import bridges, cut_vertices, shortest_path
    from .heading import Heading, circular_mean, unwrap, wrap
    from .names import Names
    from .numbering import Dart, Edge, Face, Vertex
    from .plane import PlaneMap
    from .robot.mapper import Closure, Mapper, build
    from .robot.open_map import OpenMap
    from .robot.simulated import Exploration, explore
    from .robot.simulated_world import SimulatedWorld
    from .robot.strategies import DepthFirst, NearestFirst, Strategy, WallFollowing
    from .robot.walk import Event, Samples, Visit, Walk, WalkHeader
    from .sets import Line, Point, Region, Set

__all__ = [
    "Again",
    "AskDriven",
    "Backbone",
    "Candidate",
    "Claim",
    "Claims",
    "Closure",
    "Completeness",
    "Dart",
    "DepthFirst",
    "Doubt",
    "DoubtDriven",
    "Edge",
    "Estimate",
    "Event",
    "Exploration",
    "Face",
    "Follower",
    "Heading",
    "Health",
    "Hypotheses",
    "Hypothesis",
    "Line",
    "Localizer",
    "Mapper",
    "Merged",
    "Move",
    "Names",
    "NearestFirst",
    "OpenMap",
    "Overlaps",
    "PlaneMap",
    "Point",
    "Region",
    "Rejection",
    "Samples",
    "Set",
    "SimulatedWorld",
    "Strategy",
    "Vertex",
    "Visit",
    "Walk",
    "WalkHeader",
    "WallFollowing",
    "Whereabouts",
    "WhichMap",
    "WhyNot",
    "ambiguity",
    "bridges",
    "build",
    "circular_mean",
    "claims",
    "cut_vertices",
    "estimate",
    "explore",
    "health",
    "hypotheses",
    "joined",
    "listed_maps",
    "locate",
    "locate_among",
    "merge",
    "open_map",
    "overlaps",
    "shortest_path",
    "unwrap",
    "wrap",
]

__getattr__, __dir__ = attach(
    __name__,
    {
        "doubt.claims": ("Claim", "Claims", "Rejection", "claims"),
        "doubt.among": ("Whereabouts", "WhichMap", "locate_among"),
        "doubt.ask_driven": ("AskDriven",),
        "doubt.doubt_driven": ("DoubtDriven",),
        "doubt.ambiguities": ("ambiguity",),
        "doubt.backbone": ("Backbone",),
        "doubt.completeness": ("Completeness",),
        "doubt.completeness_check": ("listed_maps",),
        "doubt.doubts": ("Again", "Doubt"),
        "doubt.estimate": ("Estimate", "estimate"),
        "closing": ("Health", "health"),
        "doubt.following": ("Follower", "locate"),
        "doubt.hypotheses": ("Hypotheses", "Hypothesis", "hypotheses"),
        "doubt.joining": ("joined",),
        "doubt.localizer": ("Candidate", "Localizer", "Move"),
        "doubt.why_not": ("WhyNot",),
        "doubt.merging": ("Merged", "Overlaps", "merge", "overlaps"),
        "doubt.opening": ("open_map",),
        "graphs": ("bridges", "cut_vertices", "shortest_path"),
        "heading": ("Heading", "circular_mean", "unwrap", "wrap"),
        "names": ("Names",),
        "numbering": ("Dart", "Edge", "Face", "Vertex"),
        "plane": ("PlaneMap",),
        "robot.mapper": ("Closure", "Mapper", "build"),
        "robot.open_map": ("OpenMap",),
        "robot.simulated": ("Exploration", "explore"),
        "robot.simulated_world": ("SimulatedWorld",),
        "robot.strategies": ("DepthFirst", "NearestFirst", "Strategy", "WallFollowing"),
        "robot.walk": ("Event", "Samples", "Visit", "Walk", "WalkHeader"),
        "sets": ("Line", "Point", "Region", "Set"),
    },
)
