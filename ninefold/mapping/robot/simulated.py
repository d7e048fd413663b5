"""A simulated robot in a world of plane geometry: it sees places, exits and its own yaw, and no coordinate.

The robot explores depth-first. It takes an exit it has not taken; if that leads to a place it knows, it comes back the way
it went; at a place without new exits it goes back along the edge that first led there.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import ceil, pi
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

from .. import geometry
from ..heading import TAU, Heading
from ..names import Names
from .walk import DEFAULT_TOLERANCE, Event, Samples, Visit, Walk, WalkHeader

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import ArrayLike, NDArray

__all__ = ["Exploration", "SimulatedWorld", "explore"]

_MOST_SAMPLES = 1e8


class SimulatedWorld:
    """Places with coordinates and the ways between them. Ways do not cross; that is not checked.

    Parameters
    ----------
    points
        (V, 2) metres in a plane, x east and y north.
    edges
        (E, 2) integers, the rows of `points` a way joins; loops and parallel ways need `paths`.
    paths
        Per edge None for a straight way, or a (k, 2) polyline that includes both ends.
    vertex_names, edge_names
        Labels; row numbers for places if left out, and the robot then names no edge.

    Attributes
    ----------
    heading
        (2E,) float64 yaw on leaving along each dart, radians; dart 2e runs as edge e is given.
    narrowest
        The least angle between two ways at one place, radians.
    metres
        Length of all ways.

    Raises
    ------
    BadInput
        As `PlaneMap.from_geometry` does, crossings apart: two ways that leave a place in the same direction, for instance.

    Examples
    --------
    >>> world = SimulatedWorld([(0, 0), (3, 0), (0, 4)], [(0, 1), (1, 2), (2, 0)], vertex_names="abc")
    >>> explore(world).walk.places
    ('a', 'b', 'c', 'a')
    """

    __slots__ = (
        "_darts",
        "_paths",
        "_start",
        "edge_names",
        "edges",
        "heading",
        "metres",
        "narrowest",
        "points",
        "vertex_names",
    )

    def __init__(
        self,
        points: ArrayLike,
        edges: ArrayLike,
        paths: Sequence[ArrayLike | None] | None = None,
        *,
        vertex_names: Iterable[str | int] | None = None,
        edge_names: Iterable[str | int] | None = None,
    ) -> None:
        xy, ends = geometry.checked_points(points), geometry.checked_edges(edges)
        n_vertices, n_edges = len(xy), len(ends)
        if n_edges and (int(ends.min()) < 0 or int(ends.max()) >= n_vertices):
            raise BadInput(f"edges must hold rows of points, 0 to {n_vertices - 1}; found {int(ends.max())}")
        self.points, self.edges = xy, ends
        self.vertex_names = Names("vertex", n_vertices, vertex_names)
        self.edge_names = Names("edge", n_edges, edge_names)
        heading, _, line, start = geometry.bearings(xy, ends, paths, self.edge_names)
        self.heading: NDArray[np.float64] = heading
        self._paths, self._start = line, start
        tail = np.ascontiguousarray(ends.reshape(-1), dtype=np.int32)
        following = geometry.rotation_by_heading(tail, heading, n_vertices, self.vertex_names, self.edge_names)
        gaps = (heading[following] - heading) % TAU
        gaps[following == np.arange(tail.size)] = TAU
        self.narrowest = float(gaps.min()) if gaps.size else TAU
        order = np.lexsort((heading, tail))
        bounds = np.searchsorted(tail[order], np.arange(n_vertices + 1))
        self._darts = (order, bounds)
        self.metres = float(sum(np.hypot(*np.diff(self.path(e), axis=0).T).sum() for e in range(n_edges)))

    def __repr__(self) -> str:
        return f"SimulatedWorld({len(self.points)} places, {len(self.edges)} ways)"

    def darts_at(self, vertex: int) -> list[int]:
        """Return the darts that leave a vertex, counter-clockwise, ascending yaw; dart 2e runs as edge e is given."""
        order, bounds = self._darts
        return [int(d) for d in order[bounds[vertex] : bounds[vertex + 1]]]

    def path(self, edge: int) -> NDArray[np.float64]:
        """Return the polyline of an edge, (k, 2)."""
        if self._paths is None:
            return np.asarray(self.points[self.edges[edge]])
        return self._paths[self._start[edge] : self._start[edge + 1]]

    def sampled(self, dart: int, step: float) -> tuple[NDArray[np.float64], float]:
        """Return the yaw of a robot that goes along a dart, (n,) radians not wrapped, and the metres it goes.

        Sampled at the start, every `step` metres, at every bend and at the end. A robot that turns more than a quarter turn
        on the spot is also sampled half-way through, so that noise cannot flip the sense in which it turned.
        """
        line = self.path(dart >> 1)
        if dart & 1:
            line = line[::-1]
        pieces = np.diff(line, axis=0)
        length = np.hypot(pieces[:, 0], pieces[:, 1])
        yaw = np.arctan2(pieces[:, 1], pieces[:, 0])
        if len(yaw) == 1:
            return np.full(ceil(length[0] / step) + 1, yaw[0]), float(length[0])
        bend = np.diff(yaw)
        bend -= TAU * np.round(bend / TAU)
        yaw = yaw[0] + np.concatenate([[0.0], np.cumsum(bend)])
        reach = np.concatenate([[0.0], np.cumsum(length)])
        # Multiples of step strictly inside each piece, and one sample where it begins.
        inside = np.maximum(np.ceil(reach[1:] / step) - np.floor(reach[:-1] / step) - 1, 0).astype(np.int64)
        samples = np.repeat(yaw, inside + 1)
        sharp = np.flatnonzero(np.abs(bend) > pi / 2)
        if sharp.size:
            samples = np.insert(samples, np.cumsum(inside + 1)[sharp], yaw[sharp] + bend[sharp] / 2)
        return np.append(samples, yaw[-1]), float(reach[-1])

    def components(self) -> list[list[int]]:
        """Return the vertices of each connected component, ascending, the component of the lowest vertex first."""
        from scipy.sparse import coo_array
        from scipy.sparse.csgraph import connected_components

        n = len(self.points)
        links = coo_array((np.ones(len(self.edges), np.int8), (self.edges[:, 0], self.edges[:, 1])), shape=(n, n))
        count, component = connected_components(links, directed=False)
        order = np.argsort(component, kind="stable")
        parts = np.split(order, np.cumsum(np.bincount(component, minlength=count))[:-1])
        return sorted(part.tolist() for part in parts)


@dataclass(frozen=True, slots=True)
class Exploration:
    """What a simulated robot brings back.

    Attributes
    ----------
    walk
        Its log.
    start
        Where it began.
    unreached
        The other components, each as the names of its places.
    metres
        How far it went.
    """

    walk: Walk
    start: str
    unreached: tuple[tuple[str, ...], ...] = field(repr=False)
    metres: float


def explore(
    world: SimulatedWorld,
    *,
    start: str | int | None = None,
    seed: int | None = None,
    noise: float = 0.0,
    step: float = 1.0,
    exits: bool = True,
    metres: bool = False,
    tolerance: float | None = None,
) -> Exploration:
    """Walk a world depth-first until every place that can be reached is visited and every way there walked.

    Parameters
    ----------
    start
        Name of the first place; left out, the first place of the component with the most ways.
    seed
        Order in which exits are tried, and noise. None tries them counter-clockwise from the way back.
    noise
        Standard deviation of the yaw, radians, on samples and exits, each by itself.
    step
        Metres between samples.
    exits
        Whether the log lists the exits of every place.
    metres
        Whether the log tells the length of every leg, without error.
    tolerance
        For the header; left out, 0.02, or a third of the narrowest angle between two ways if that is less.

    Returns
    -------
    Exploration
        The same arguments give the same walk.

    Raises
    ------
    BadInput, UnknownName
        For a step or noise that is none, or an unknown start.

    Notes
    -----
    Every way is walked twice at most. Complexity O(samples + E log E), no recursion.

    Examples
    --------
    >>> world = SimulatedWorld([(0, 0), (3, 0), (9, 9)], [(0, 1)])
    >>> robot = explore(world, step=1.0)
    >>> robot.unreached, robot.metres
    ((('2',),), 3.0)
    >>> robot.walk.events[1]
    Samples(yaw=(0.0, 0.0, 0.0, 0.0), t=None, metres=None)
    """
    if not (isinstance(step, int | float) and 0 < step < float("inf")):
        raise BadInput(f"step is a positive number of metres, not {quoted(step)}")
    if not (isinstance(noise, int | float) and 0 <= noise < float("inf")):
        raise BadInput(f"noise is a standard deviation in radians, not {quoted(noise)}")
    if (most := world.metres / step) > _MOST_SAMPLES:
        raise BadInput(
            f"a step of {step:g} m takes {most:.2g} samples over {world.metres:.3g} m of ways; take a longer step"
        )
    parts = world.components()
    ways = np.bincount(world.edges[:, 0], minlength=len(world.points))
    home = max(parts, key=lambda part: (int(ways[part].sum()), -part[0]))
    first = home[0] if start is None else world.vertex_names.row(start)
    home = next(part for part in parts if first in part)
    if tolerance is None:
        tolerance = min(DEFAULT_TOLERANCE, world.narrowest / 3)
    robot = _Robot(
        world,
        np.random.default_rng(seed),
        shuffles=seed is not None,
        noise=noise,
        step=step,
        exits=exits,
        measures=metres,
    )
    robot.run(first, int(ways[home].sum()))
    names = world.vertex_names
    return Exploration(
        Walk(WalkHeader(tolerance=tolerance), tuple(robot.events)),
        names[first],
        tuple(tuple(names[v] for v in part) for part in parts if part is not home),
        robot.metres,
    )


class _Robot:
    """Writes the log while it walks."""

    def __init__(
        self,
        world: SimulatedWorld,
        rng: np.random.Generator,
        *,
        shuffles: bool,
        noise: float,
        step: float,
        exits: bool,
        measures: bool,
    ) -> None:
        self.world, self.rng, self.shuffles, self.noise, self.step, self.exits = world, rng, shuffles, noise, step, exits
        self.measures = measures
        self.ends = world.edges.reshape(-1).tolist()
        self.events: list[Event] = []
        self.metres = 0.0
        self._legs: dict[int, tuple[Samples, float]] = {}
        self._stars: dict[int, tuple[Heading, ...]] = {}

    def run(self, start: int, ways: int) -> None:
        """Explore from a vertex until as many ways as its component has are walked."""
        walked = bytearray(len(self.world.edges))
        untried = {start: self._choices(start, -1)}
        self._visit(start, None)
        trail = [(start, -1)]
        while ways:
            at, came = trail[-1]
            choices = untried[at]
            while choices and walked[choices[-1] >> 1]:
                choices.pop()
            if not choices:
                trail.pop()
                self._go(came ^ 1)
                continue
            dart = choices.pop()
            walked[dart >> 1] = True
            ways -= 1
            self._go(dart)
            there = self.ends[dart ^ 1]
            if there not in untried:
                untried[there] = self._choices(there, dart ^ 1)
                trail.append((there, dart))
            elif there != at and ways:
                self._go(dart ^ 1)

    def _choices(self, vertex: int, back: int) -> list[int]:
        """Darts to try from a vertex, the first last."""
        darts = self.world.darts_at(vertex)
        if self.shuffles:
            self.rng.shuffle(darts)
            return darts
        at = darts.index(back) + 1 if back >= 0 else 0
        return (darts[at:] + darts[:at])[::-1]

    def _go(self, dart: int) -> None:
        samples, metres = self._samples(dart)
        self.metres += metres
        self.events.append(samples)
        self._visit(self.ends[dart ^ 1], dart >> 1)

    def _samples(self, dart: int) -> tuple[Samples, float]:
        known = self._legs.get(dart)
        if known is None:
            yaw, metres = self.world.sampled(dart, self.step)
            if self.noise:
                yaw = yaw + self.rng.normal(0.0, self.noise, yaw.size)
            known = Samples(tuple(yaw.tolist()), metres=metres if self.measures else None), metres
            if not self.noise:
                self._legs[dart] = known
        return known

    def _visit(self, vertex: int, edge: int | None) -> None:
        names = self.world.edge_names
        name = None if edge is None or names.are_rows else names[edge]
        self.events.append(Visit(self.world.vertex_names[vertex], self._exits(vertex) if self.exits else None, name))

    def _exits(self, vertex: int) -> tuple[Heading, ...]:
        known = self._stars.get(vertex)
        if known is None:
            yaw = self.world.heading[self.world.darts_at(vertex)]
            if self.noise:
                yaw = yaw + self.rng.normal(0.0, self.noise, yaw.size)
            known = tuple(map(Heading, yaw.tolist()))
            if not self.noise:
                self._stars[vertex] = known
        return known
