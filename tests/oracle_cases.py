"""Relate cases kept as JSON: a map, two sets in text form, their relation, and why the case is there."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ninefold.io import samples
from ninefold.mapping import PlaneMap, build, explore
from ninefold.mapping.sets import Set

FOLDER = Path(__file__).parent / "oracle" / "cases"
MIRRORED = {"contains": "inside", "covers": "coveredBy", "inside": "contains", "coveredBy": "covers"}
"""The name of the converse relation, where it is another one."""


def all_cases() -> list[tuple[str, dict[str, Any], dict[str, Any]]]:
    """Every case of every file, as (id, map, case)."""
    found = []
    for file in sorted(FOLDER.glob("*.json")):
        content = json.loads(file.read_text())
        found += [(f"{file.stem}: {case['case']}", content["maps"][case["map"]], case) for case in content["cases"]]
    return found


def made_map(given: dict[str, Any]) -> PlaneMap:
    """A map from points and edges (paths where an edge bends), from a rotation, or from the walk through a bundled world."""
    match given:
        case {"points": points, "edges": edges, **rest}:
            return PlaneMap.from_geometry(points, edges, **rest)
        case {"rotation": rotation, "outer": outer}:
            around = {v: [tuple(d) if isinstance(d, list) else d for d in darts] for v, darts in rotation.items()}
            return PlaneMap.from_rotation(around, outer=tuple(outer))
        case {"walk through": sample, "from": start}:
            return build(explore(samples.load(sample).to_world(), start=start).walk)
    raise ValueError(given)


def made_set(plane: PlaneMap, text: str) -> Set:
    """A set in text form; regions and lines are joined by `` | `` and cut by `` - ``, from left to right."""
    first, *rest = text.split(" ")
    found: Any = plane.parse(first)
    for sign, other in zip(rest[::2], rest[1::2], strict=True):
        found = found | plane.parse(other) if sign == "|" else found - plane.parse(other)
    return found
