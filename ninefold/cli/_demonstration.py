"""The main job on real input, end to end: a robot walks a district, and every relation it infers is held against the ground.

The robot senses places, exits and its own yaw. The map is made of its log alone; the true geometry of the streets is used
twice, and never by the map: by the simulated world that the robot walks in, and by shapely in the comparison.
"""

from __future__ import annotations

import time
from collections import Counter
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ninefold._files import write_text
from ninefold.errors import BadInput
from ninefold.io import samples
from ninefold.io.atlas.atlas import Atlas
from ninefold.io.atlas.records import Provenance
from ninefold.io.relations import write_relations
from ninefold.io.walks.json_lines import read_walk, write_walk
from ninefold.layout import draw, drawing_problems, heading_errors, misplacement, rigidity, side_by_side, verify
from ninefold.layout.truth import TrueShapes
from ninefold.mapping import Line, Point, Region, shortest_path
from ninefold.mapping.robot.simulated import explore
from ninefold.reasoner import relate

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping
    from os import PathLike

    from numpy.typing import NDArray

    from ninefold.layout import Drawing
    from ninefold.mapping import PlaneMap, Set

__all__ = ["DemoReport", "Mismatch", "run_demo"]

_STREETS = "helsinki_district"
_CREDIT = "\N{COPYRIGHT SIGN} OpenStreetMap contributors, ODbL"
_GROUPS = 60
_PATHS = 60
_PAIRS = 20_000
_ON_DRAWING = 2_000
_FILES = (
    *("district.walk.jsonl", "district.atlas", "relations.csv"),
    *("map.svg", "map-schnyder.svg", "streets.svg", "district-beside.svg", "figure8.svg"),
)


@dataclass(frozen=True, slots=True)
class Mismatch:
    """A pair on which the map and the ground differ: names, and both DE-9IM strings."""

    x: str
    y: str
    map: str
    ground: str


@dataclass(frozen=True, slots=True)
class DemoReport:
    """What the demo did.

    Attributes
    ----------
    source
        Name of the bundled source.
    events, legs, metres
        The walk.
    plane
        The map made of it.
    sets
        How many named sets of each kind: points, lines, regions.
    pairs
        Pairs compared.
    mismatches
        Those that differ.
    drawn, drawn_wrong
        Pairs compared on the map's own drawing, and how many of them differ.
    problems
        What of the map's rotation, faces and outer face differs from the ground's, in words.
    heading_error
        Degrees by which the drawn streets run off their headings: the median, and what 95 % of them stay below.
    misplaced, misplaced_tutte
        Root mean square distance of the places drawn from headings to where they are, as a share of the diameter, and the
        same of Tutte's drawing, which knows no headings.
    names
        How often each relation occurred.
    seconds
        Time of each step, in order.
    files
        What was written.
    """

    source: str
    events: int
    legs: int
    metres: float
    plane: PlaneMap
    sets: dict[str, int]
    pairs: int
    mismatches: tuple[Mismatch, ...]
    drawn: int
    drawn_wrong: int
    problems: tuple[str, ...]
    heading_error: tuple[float, float]
    misplaced: float
    misplaced_tutte: float
    names: dict[str, int]
    seconds: dict[str, float]
    files: dict[str, Path]

    @property
    def agree(self) -> bool:
        """Whether the map lies on the ground as it should, and every pair agrees."""
        return not self.mismatches and not self.problems and not self.drawn_wrong


def run_demo(
    out: str | PathLike[str],
    *,
    source: str = _STREETS,
    seed: int = 1,
    pairs: int = _PAIRS,
    say: Callable[[str], None] = lambda _: None,
) -> DemoReport:
    """Explore, map, name, relate, compare.

    Parameters
    ----------
    out
        Folder for the walk, the atlas and the table of relations; made if it is not there, its own files replaced.
    source
        A bundled source.
    seed
        Of the robot's choices and of the sets and pairs drawn.
    pairs
        How many ordered pairs of named sets to compare, half of them of sets that share a vertex; or all, if there are
        fewer.
    say
        Is told what was done, a line a step.

    Returns
    -------
    DemoReport
        The same arguments give the same report, times apart.
    """
    folder = Path(out)
    _make_folder(folder)
    files = {name: folder / name for name in _FILES}
    walk_file, atlas_file, table_file, map_file, grid_file, streets_file, beside_file, figure_file = files.values()
    seconds: dict[str, float] = {}
    streets = samples.load(source)

    with _timed(seconds, "explore"):
        robot = explore(streets.to_world(), seed=seed)
        write_walk(robot.walk, walk_file)
    say(
        f"A robot walked every street of {source}: {robot.walk.n_legs:,} legs, {robot.metres / 1000:.1f} km, "
        f"{len(robot.walk.events):,} events in its log."
    )
    with _timed(seconds, "map"):
        provenance = Provenance.of_file(walk_file, "walk")
        atlas = Atlas.from_walk(read_walk(walk_file), atlas_file, provenance=provenance, force=True)
    with atlas:
        plane = atlas.plane
        say(
            f"From headings and loop closures alone: {plane.n_vertices} vertices, {plane.n_edges} edges, "
            f"{plane.n_faces} faces; rotation, faces and outer face, no coordinate."
        )
        with _timed(seconds, "name"):
            named = _named_sets(plane, np.random.default_rng(seed))
            atlas.name_all({name: item for name, item in named.items() if item.dimension > 0})
        kinds = Counter(("points", "lines", "regions")[item.dimension] for item in named.values())
        say(f"Named and stored: {kinds['regions']} blocks and groups of blocks, {kinds['lines']} streets and paths.")

    names, sets = list(named), list(named.values())
    with _timed(seconds, "relate"):
        chosen = _chosen_pairs(sets, pairs, np.random.default_rng(seed))
        codes = np.array([relate(sets[i], sets[j]).code for i, j in chosen.tolist()], np.uint16)
        write_relations(table_file, names, chosen, codes, force=True)
    say(f"Related {len(chosen):,} pairs of points, lines and regions without geometry.")
    shapes = TrueShapes(streets)
    with _timed(seconds, "compare"):
        ground = shapes.drawing(plane)
        problems = drawing_problems(ground)
        mismatches, found = _compared(sets, names, chosen, codes, shapes)
    for problem in problems:
        say(f"The map differs from the ground: {problem}.")
    if not problems:
        say("Laid on the true streets, which it never saw, the map has the right rotation, faces and outer face.")
    if mismatches:
        say(f"shapely on the true streets disagrees on {len(mismatches):,} pairs.")
    else:
        say(f"shapely on the true streets gives the same nine-intersection for all {len(chosen):,} pairs.")
    with _timed(seconds, "draw"):
        drawing = draw(plane)
        likeness = _likeness(drawing, ground)
    say(
        f"Drawn from headings alone ({drawing.layout} layout): streets run as the compass said to {likeness[0]:.2f} degrees "
        f"(median; 95 % within {likeness[1]:.1f})."
    )
    say(
        f"Places lie {100 * likeness[2]:.1f} % of the diameter from where they are on the ground; "
        f"{100 * likeness[3]:.1f} % in the Tutte drawing, which knows no headings."
    )
    say(f"What the compass fixes: {rigidity(plane)}.")
    with _timed(seconds, "verify"):
        some = chosen[:: max(1, len(chosen) // _ON_DRAWING)].tolist()
        report = verify(plane, [(sets[i], sets[j]) for i, j in some], drawing=drawing)
        problems += report.problems
    say(
        f"On that drawing, checked to be plane, shapely {'gives the same' if report.agree else 'disagrees'} "
        f"for {report.pairs:,} pairs{'' if report.agree else f', wrong in {report.wrong:,}'}."
    )
    with _timed(seconds, "pictures"):
        shown = _shown(named)
        known = f"{source}, as the robot drew it from its compass"
        drawing.save(map_file, highlight=shown, title=known)
        draw(plane, layout="schnyder").save(grid_file, highlight=shown, title=f"{source} on an integer grid")
        streets_drawing = replace(ground, notes=(_CREDIT,)) if source == _STREETS else ground
        on_ground = f"{source}, which the robot never saw"
        streets_drawing.save(streets_file, highlight=shown, title=on_ground)
        both = {on_ground: streets_drawing, known: drawing}
        write_text(beside_file, _beside(both, shown), force=True)
        write_text(figure_file, _figure_eight(), force=True)
    say("Drew three of the sets on the streets and beside them on the map, and on a grid; and figure 8 beside its own grid.")
    return DemoReport(
        source=source,
        events=len(robot.walk.events),
        legs=robot.walk.n_legs,
        metres=robot.metres,
        plane=plane,
        sets=dict(kinds),
        pairs=len(chosen),
        mismatches=mismatches,
        drawn=report.pairs,
        drawn_wrong=report.wrong,
        problems=problems,
        heading_error=likeness[:2],
        misplaced=likeness[2],
        misplaced_tutte=likeness[3],
        names=found,
        seconds=seconds,
        files=files,
    )


def _likeness(drawing: Drawing, ground: Drawing) -> tuple[float, float, float, float]:
    """Return the figures of `DemoReport.heading_error`, `misplaced` and `misplaced_tutte`."""
    off = np.degrees(np.abs(heading_errors(drawing)))
    tutte = misplacement(draw(drawing.plane, layout="tutte"), ground, turned=True)
    return float(np.nanmedian(off)), float(np.nanpercentile(off, 95)), misplacement(drawing, ground), tutte


def _beside(drawings: Mapping[str, Drawing], shown: Mapping[str, Set]) -> str:
    """Return drawings next to each other, by their titles, with the same sets coloured."""
    return side_by_side(*(d.to_svg(highlight=shown, title=title, width=670) for title, d in drawings.items()))


def _figure_eight() -> str:
    """Return the published method's figure 8 as it stands on the ground, beside its Schnyder drawing."""
    figure = samples.load("figure8")
    plane = figure.to_map()
    shown = {
        "outer cycle": plane.cycle(["v0", "v1", "v8", "v7"]),
        "inner cycle": plane.cycle(["v2", "v3", "v6", "v5", "v4"]),
    }
    drawings = {"figure 8": TrueShapes(figure).drawing(plane), "its Schnyder drawing": draw(plane, layout="schnyder")}
    return _beside(drawings, shown)


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise BadInput(
            f"{folder}: this folder cannot be made ({error.strerror or error}); choose another with --out"
        ) from None


@contextmanager
def _timed(seconds: dict[str, float], step: str) -> Iterator[None]:
    start = time.perf_counter()
    yield
    seconds[step] = time.perf_counter() - start


def _named_sets(plane: PlaneMap, rng: np.random.Generator) -> dict[str, Set]:
    """Return places, streets, paths, blocks and groups of blocks by name, in this order."""
    named: dict[str, Set] = {name: plane.vertex(name) for name in plane.vertex_names}
    for street, edges in _streets(plane).items():
        named[f"street {street}"] = plane.line(edges)
    for k in range(_PATHS):
        u, v = rng.choice(plane.n_vertices, 2, replace=False).tolist()
        named[f"path {k + 1}"] = shortest_path(plane.vertex(plane.vertex_names[u]), plane.vertex(plane.vertex_names[v]))
    bounded = [face for face in range(plane.n_faces) if face != plane.outer_face]
    for k, face in enumerate(bounded):
        named[f"block {k + 1}"] = plane.face(face)
    neighbours = _neighbours(plane)
    for k in range(_GROUPS):
        # Grown from one block along shared streets, or a handful from anywhere: one part or several, with holes or without.
        size = int(rng.integers(2, 25))
        if k % 2:
            chosen = rng.choice(bounded, min(size, len(bounded)), replace=False).tolist()
        else:
            chosen = _grown(int(rng.choice(bounded)), size, neighbours, rng)
        named[f"group {k + 1}"] = plane.region(chosen)
    return named


def _shown(named: dict[str, Set]) -> dict[str, Set]:
    """Return the largest group of blocks in one piece, the longest street and the longest path, to be coloured."""
    lines = {name: item for name, item in named.items() if isinstance(item, Line)}
    groups = {name: item.n_faces for name, item in named.items() if isinstance(item, Region) and len(item.rims) == 1}
    longest = [
        max((name for name in lines if name.startswith(kind)), key=lambda name: len(lines[name].edges), default=None)
        for kind in ("street ", "path ")
    ]
    return {name: named[name] for name in (max(groups, key=groups.__getitem__, default=None), *longest) if name is not None}


def _streets(plane: PlaneMap) -> dict[str, list[str]]:
    """Return the edges of each street: those whose names differ in a final number alone."""
    streets: dict[str, list[str]] = {}
    for name in plane.edge_names:
        street, _, number = name.rpartition(" ")
        if street and number.isdecimal():
            streets.setdefault(street, []).append(name)
    return {street: streets[street] for street in sorted(streets)}


def _neighbours(plane: PlaneMap) -> dict[int, list[int]]:
    """Return the bounded faces across an edge from each bounded face."""
    across: dict[int, set[int]] = {}
    for left, right in plane.face_of.reshape(-1, 2).tolist():
        if left != right and plane.outer_face not in (left, right):
            across.setdefault(left, set()).add(right)
            across.setdefault(right, set()).add(left)
    return {face: sorted(others) for face, others in across.items()}


def _grown(start: int, size: int, neighbours: dict[int, list[int]], rng: np.random.Generator) -> list[int]:
    group = [start]
    while len(group) < size:
        rim = sorted({face for inside in group for face in neighbours.get(inside, [])} - set(group))
        if not rim:
            break
        group.append(int(rng.choice(rim)))
    return group


def _chosen_pairs(sets: list[Set], pairs: int, rng: np.random.Generator) -> NDArray[np.int64]:
    """Return (P, 2) distinct ordered pairs of rows, ascending: half of sets that share a vertex, the rest from all."""
    count = len(sets)
    if pairs >= count * count:
        return np.stack(np.divmod(np.arange(count * count), count), axis=1)
    at: dict[int, list[int]] = {}
    for row, item in enumerate(sets):
        for v in _vertices(item):
            at.setdefault(v, []).append(row)
    touching = np.unique(np.concatenate([np.add.outer(np.array(rows) * count, rows).ravel() for rows in at.values()]))
    near = rng.choice(touching, min(pairs // 2, touching.size), replace=False)
    rest = np.setdiff1d(np.arange(count * count), near)
    drawn = np.sort(np.concatenate([near, rng.choice(rest, pairs - near.size, replace=False)]))
    return np.stack(np.divmod(drawn, count), axis=1)


def _vertices(item: Set) -> Iterable[int]:
    match item:
        case Point():
            return (item.index,)
        case Line() | Region():
            return item.star


def _compared(
    sets: list[Set], names: list[str], pairs: NDArray[np.int64], codes: NDArray[np.uint16], shapes: TrueShapes
) -> tuple[tuple[Mismatch, ...], dict[str, int]]:
    """Hold the codes against shapely on the ground; return what differs, and how often each relation occurs."""
    import shapely

    from ninefold.reasoner import de9im_strings, names_of

    ground = np.array([shapes.of(item) for item in sets], dtype=object)
    truth = shapely.relate(ground[pairs[:, 0]], ground[pairs[:, 1]])
    mine = de9im_strings(codes)
    differ = np.flatnonzero(mine != truth.astype(mine.dtype))
    mismatches = tuple(
        Mismatch(names[pairs[k, 0]], names[pairs[k, 1]], str(mine[k]), str(truth[k])) for k in differ.tolist()
    )
    return mismatches, dict(Counter(names_of(codes).tolist()).most_common())
