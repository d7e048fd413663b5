"""A simulated robot in a world of plane geometry: it sees places, exits and its own yaw, and no coordinate.

By default the robot explores depth-first. It takes an exit it has not taken; if that leads to a place it knows, it comes
back the way it went; at a place without new exits it goes back along the edge that first led there. Its compass may err in
two ways: each reading by itself (noise), and all readings at one place alike (drift), by a bias that changes slowly.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import sqrt
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

from ..heading import Heading
from .open_map import OPEN, OpenMap, checked_exit
from .strategies import DepthFirst, NearestFirst, WallFollowing
from .walk import DEFAULT_TOLERANCE, Event, Samples, Visit, Walk, WalkHeader, checked_drift, checked_sigma

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from .simulated_world import SimulatedWorld
    from .strategies import Strategy

__all__ = ["DRIFT_KEPT", "Exploration", "Tour", "explore"]

Tour: TypeAlias = Literal["depth-first", "covering", "wall"]

DRIFT_KEPT = 0.966
"""Share of the compass bias that is kept from one place to the next: half of it is left after 20 legs."""

_MOST_SAMPLES = 1e8
_TOURS: dict[str, Callable[[np.random.Generator | None], Strategy]] = {
    "depth-first": DepthFirst,
    "covering": NearestFirst,
    "wall": WallFollowing,
}


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
    drift: float = 0.0,
    tour: Tour | Strategy = "depth-first",
    tours: int = 1,
    ordered_exits: bool = False,
    places: bool = True,
) -> Exploration:
    """Walk a world until every place that can be reached is visited and every way there walked, or a strategy is done.

    Parameters
    ----------
    start
        Name of the first place; left out, the first place of the component with the most ways.
    seed
        Order in which exits are tried, noise and drift. None tries them counter-clockwise from the way back.
    noise
        Standard deviation of the yaw, radians, on samples and exits, each by itself; at most pi / 3 (60 degrees).
    step
        Metres between samples.
    exits
        Whether the log lists the exits of every place.
    metres
        Whether the log tells the length of every leg, without error.
    tolerance
        For the header; left out, 0.02, or a third of the narrowest angle between two ways if that is less.
    drift
        Standard deviation, radians, of a bias that all readings at one visit have in common: the exits seen, the last sample
        of the leg that led there, the first of the leg that leads on. At most pi. From place to place it keeps the share
        `DRIFT_KEPT` and gains noise of its own, so that its spread stays the same; along a leg it changes evenly.
    tour
        ``"depth-first"``; ``"covering"``: always to the nearest way not yet walked; ``"wall"``: with the wall on the right
        hand, and from a wall followed before to the nearest way not yet walked. Or a `Strategy`, which is given the map so
        far as a robot has it whose compass does not err, and walks until it gives no exit.
    tours
        How often every way is to be walked anew; each tour begins where the one before ended. 1 for a strategy.
    ordered_exits
        List the exits in their true order, counter-clockwise and beginning anywhere, and let the header say so. Otherwise,
        where headings err, they are in the order of the headings seen.
    places
        False leaves the names of places and ways out of the log. The named tours still go where a robot goes that recognises
        every place; a strategy gets a map in which every open exit has led to a new place.

    Returns
    -------
    Exploration
        The same arguments give the same walk, if there is a seed. Where there is noise or drift, the header of the walk
        declares both.

    Raises
    ------
    BadInput, UnknownName
        For a step, noise, drift or number of tours that is none, or an unknown start or tour.

    Notes
    -----
    Depth-first, every way is walked twice at most in a tour. Complexity O(samples + E log E), no recursion; a covering tour
    can take O(E^2), and on street networks does not.

    Examples
    --------
    >>> from ninefold.mapping import SimulatedWorld
    >>> world = SimulatedWorld([(0, 0), (3, 0), (9, 9)], [(0, 1)])
    >>> robot = explore(world, step=1.0)
    >>> robot.unreached, robot.metres
    ((('2',),), 3.0)
    >>> robot.walk.events[1]
    Samples(yaw=(0.0, 0.0, 0.0, 0.0), t=None, metres=None)
    """
    if not (isinstance(step, int | float) and 0 < step < float("inf")):
        raise BadInput(f"step is a positive number of metres, not {quoted(step)}")
    sigma = _checked_noise(noise)
    drift = checked_drift(drift)
    if not callable(tour) and tour not in _TOURS:
        *others, last = map(repr, _TOURS)
        raise BadInput(f"a tour is {', '.join(others)} or {last}, not {quoted(tour)}")
    if isinstance(tours, bool) or not isinstance(tours, int) or tours < 1:
        raise BadInput(f"tours is how often to walk every way, 1 or more, not {quoted(tours)}")
    if callable(tour) and tours != 1:
        raise BadInput(f"a strategy makes one tour, not {tours}; make a new one and start where this one ended")
    if (most := tours * world.metres / step) > _MOST_SAMPLES:
        raise BadInput(
            f"a step of {step:g} m takes {most:.2g} samples over {tours * world.metres:.3g} m of ways; take a longer step"
        )
    parts = world.components()
    ways = np.bincount(world.edges[:, 0], minlength=len(world.points))
    home = max(parts, key=lambda part: (int(ways[part].sum()), -part[0]))
    first = home[0] if start is None else world.vertex_names.row(start)
    home = next(part for part in parts if first in part)
    if tolerance is None:
        tolerance = min(DEFAULT_TOLERANCE, world.narrowest / 3)
    rng = np.random.default_rng(seed)
    compass = _Compass(rng, sigma or 0.0, drift)
    looks = _Looks(exits=exits, in_order=ordered_exits, metres=metres, step=step, places=places)
    choosing = rng if seed is not None else None
    robot = _Robot(world, compass, looks, choosing)
    if callable(tour):
        robot.run(first, tour, recognises=places)
    else:
        at = first
        for _ in range(tours):
            at = robot.run(at, _TOURS[tour](choosing), recognises=True)
    names = world.vertex_names
    header = WalkHeader(
        tolerance=tolerance,
        sigma=sigma,
        drift=drift if sigma is not None or drift else None,
        exits="in-order" if ordered_exits else "any-order",
    )
    return Exploration(
        Walk(header, tuple(robot.events)),
        names[first],
        tuple(tuple(names[v] for v in part) for part in parts if part is not home),
        robot.metres,
    )


def _checked_noise(noise: float) -> float | None:
    """Return the sigma that a noise is declared as, None for no noise."""
    if not isinstance(noise, bool) and isinstance(noise, int | float) and noise == 0:
        return None
    try:
        return checked_sigma(noise)
    except BadInput:
        raise BadInput(
            f"noise is a standard deviation in radians, 0 to 1.047 (60 degrees), such as 0.035 for 2 degrees, "
            f"not {quoted(noise)}"
        ) from None


@dataclass(frozen=True, slots=True)
class _Looks:
    """What the robot notes: exits, whether in their true order, metres, places; and the metres between two samples."""

    exits: bool
    in_order: bool
    metres: bool
    step: float
    places: bool


class _Compass:
    """Errs: each reading by itself, and all readings at one place alike by a bias that drifts from place to place."""

    def __init__(self, rng: np.random.Generator, noise: float, drift: float) -> None:
        self.exact = not noise and not drift
        self._rng, self._noise, self._drift = rng, noise, drift
        self._bias = self._bias_before = rng.normal(0.0, drift) if drift else 0.0

    def travel(self) -> None:
        """Go on to another place, whose bias is a little different."""
        if self._drift:
            gained = self._rng.normal(0.0, self._drift * sqrt(1 - DRIFT_KEPT**2))
            self._bias_before, self._bias = self._bias, DRIFT_KEPT * self._bias + gained

    def along(self, yaw: NDArray[np.float64]) -> NDArray[np.float64]:
        """Read yaws sampled on the way from the place before to this one."""
        if self._drift:
            yaw = yaw + np.linspace(self._bias_before, self._bias, yaw.size)
        return self._scattered(yaw)

    def here(self, yaw: NDArray[np.float64]) -> NDArray[np.float64]:
        """Read yaws at this place."""
        return self._scattered(yaw + self._bias if self._drift else yaw)

    def _scattered(self, yaw: NDArray[np.float64]) -> NDArray[np.float64]:
        return yaw + self._rng.normal(0.0, self._noise, yaw.size) if self._noise else yaw


class _Robot:
    """Writes the log while it walks."""

    def __init__(self, world: SimulatedWorld, compass: _Compass, looks: _Looks, rng: np.random.Generator | None) -> None:
        self.world, self.compass, self.looks, self.rng = world, compass, looks, rng
        self.ends = world.edges.reshape(-1).tolist()
        self.events: list[Event] = []
        self.metres = 0.0
        self._legs: dict[int, tuple[Samples, float, float]] = {}
        self._stars: dict[int, tuple[Heading, ...]] = {}

    def run(self, start: int, strategy: Strategy, *, recognises: bool) -> int:
        """Explore from a vertex until the strategy is done; return the vertex where that is."""
        known = OpenMap()
        darts: list[int] = []  # of every exit
        place: dict[int, int] = {}  # of every vertex recognised
        at = start
        self._see(known, darts, place, at)
        chosen = strategy(known)  # what the robot will do first is settled before it looks round
        if not self.events:
            self._visit(at, None)
        while chosen is not None:
            dart = darts[checked_exit(known, chosen)]
            turned = self._go(dart)
            at = self.ends[dart ^ 1]
            if known.mate[chosen] == OPEN:
                if not recognises or at not in place:
                    self._see(known, darts, place, at)
                exits = known.exits(place[at])
                known.join(chosen, exits[darts[exits.start : exits.stop].index(dart ^ 1)], turned)
            known.arrive(known.mate[chosen])
            chosen = strategy(known)
        return at

    def _see(self, known: OpenMap, darts: list[int], place: dict[int, int], vertex: int) -> None:
        """Add a place for a vertex to what is known."""
        exits = self.world.darts_at(vertex)
        name = self.world.vertex_names[vertex] if self.looks.places else None
        place[vertex] = known.see(self.world.heading[exits].tolist(), name)
        darts += exits

    def _go(self, dart: int) -> float:
        """Go along a dart; return the net rotation."""
        self.compass.travel()
        samples, metres, turned = self._samples(dart)
        self.metres += metres
        self.events.append(samples)
        self._visit(self.ends[dart ^ 1], dart >> 1)
        return turned

    def _samples(self, dart: int) -> tuple[Samples, float, float]:
        known = self._legs.get(dart)
        if known is None:
            yaw, metres = self.world.sampled(dart, self.looks.step)
            turned = float(yaw[-1] - yaw[0])
            read = self.compass.along(yaw)
            known = Samples(tuple(read.tolist()), metres=metres if self.looks.metres else None), metres, turned
            if self.compass.exact:
                self._legs[dart] = known
        return known

    def _visit(self, vertex: int, edge: int | None) -> None:
        names = self.world.edge_names
        unnamed = edge is None or names.are_rows or not self.looks.places
        exits = self._exits(vertex) if self.looks.exits else None
        place = self.world.vertex_names[vertex] if self.looks.places else None
        self.events.append(Visit(place, exits, None if unnamed or edge is None else names[edge]))

    def _exits(self, vertex: int) -> tuple[Heading, ...]:
        known = self._stars.get(vertex)
        if known is None:
            yaw = self.compass.here(self.world.heading[self.world.darts_at(vertex)])
            known = tuple(map(Heading, yaw.tolist()))
            if self.compass.exact:
                self._stars[vertex] = known
            elif not self.looks.in_order:
                known = tuple(sorted(known, key=lambda heading: heading.yaw))
        if self.looks.in_order and self.rng is not None and known:
            first = int(self.rng.integers(len(known)))
            known = known[first:] + known[:first]
        return known
