"""The mapper: a plane map built online from a walk, one event at a time.

A place seen for the first time is a vertex, the leg to it an edge that ends dead for now. A leg to a known place along
unknown directions is a loop closure. The directions at a place, sorted by yaw, are its rotation; the turning numbers tell
the outer face. Nothing is decided by guess: what two directions could explain is an error, and an error changes nothing.

References
----------
P. Corcoran and M. Bertolotto, Cognitively Adequate Topological Robot Localization and Mapping, sections 5.1.1 to 5.1.3.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput, WalkError, located

from ..heading import Heading
from ..plane import PlaneMap
from ..turning import edge_residual
from ._memory import Memory
from ._star import OPEN
from .legs import DEGREES, Leg, LegReader
from .units import unit_of
from .walk import Event, Samples, Visit, Walk, WalkHeader, checked_tolerance

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Closure", "Mapper", "build"]


class Closure(NamedTuple):
    """A loop closure: the event, counted from 1, that showed a new edge between known places."""

    event: int
    edge: str


def build(walk: Walk, *, tolerance: float | None = None) -> PlaneMap:
    """Return the plane map of a whole walk.

    Parameters
    ----------
    walk
        Every place of it recognised.
    tolerance
        Radians; the header's if left out.

    Raises
    ------
    WalkError, AmbiguousDart, NotPlane
        With the number of the event, counted from 1.

    Notes
    -----
    Complexity O(events + E log E), see `Mapper`.

    Examples
    --------
    >>> from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader, build
    >>> north, east, southwest = (Heading.from_bearing(b) for b in (0, 90, 225))
    >>> build(Walk(WalkHeader(), (
    ...     Visit("a"), Samples.of(east), Visit("b"), Samples.of(north), Visit("c"), Samples.of(southwest), Visit("a"))))
    PlaneMap(3 vertices, 3 edges, 2 faces)
    """
    mapper = Mapper(walk.header, tolerance=tolerance)
    step = mapper.step
    for event in walk.events:
        step(event)
    return mapper.plane


class Mapper:
    """Builds a plane map event by event; after every event the map so far is there and valid.

    Parameters
    ----------
    header
        Of the walk; the tolerance is taken from it, and the unit in which messages speak of headings.
    tolerance
        Radians within which two headings at one place are the same dart, instead of the header's.

    Notes
    -----
    Edge ``e`` has dart ``2e`` in the direction of its first traversal. A leg whose two headings match the two ends of a
    known edge travels that edge, and refines its headings to the mean of all passes; its net rotation stays that of the
    first pass, so that `residuals` show how well the passes agree. Its length is the mean of the passes that measured one.

    Complexity: an event is O(log degree), or O(degree) when exits are given, and a loop closure O(log E) amortised.

    Examples
    --------
    >>> from ninefold.mapping import Heading, Mapper, Samples, Visit
    >>> mapper = Mapper()
    >>> for event in (Visit("a"), Samples.of(Heading.from_bearing(90)), Visit("b"), Samples.of(Heading.from_bearing(0)),
    ...               Visit("c"), Samples.of(Heading.from_bearing(225)), Visit("a")):
    ...     mapper.step(event)
    >>> mapper.n_faces, mapper.closures
    (2, (Closure(event=7, edge='e2'),))
    >>> mapper.plane.cycle(["a", "b", "c"])
    Region(1 face, boundary @e0 @e1 @e2)
    """

    def __init__(self, header: WalkHeader | None = None, *, tolerance: float | None = None) -> None:
        self.header = WalkHeader() if header is None else header
        self.tolerance = self.header.tolerance if tolerance is None else checked_tolerance(tolerance)
        self._unit = DEGREES if header is None else unit_of(header.heading)
        self._memory = Memory(self.tolerance, self._unit)
        self._events = 0
        self._closures: list[Closure] = []
        self._plane: PlaneMap | None = None
        self._at = -1
        self._leg = LegReader(self._unit)

    # -- what is known so far ------------------------------------------------------------------------------------------

    @property
    def n_events(self) -> int:
        """Number of events taken."""
        return self._events

    @property
    def n_vertices(self) -> int:
        """Number of places seen."""
        return len(self._memory.names)

    @property
    def n_edges(self) -> int:
        """Number of edges travelled."""
        return len(self._memory.edge_names)

    @property
    def n_faces(self) -> int:
        """Number of faces, the outer one counted; 0 before the first place."""
        return self._memory.grown.n_faces if self._memory.names else 0

    @property
    def place(self) -> str | None:
        """The place last seen, None before the first."""
        return self._memory.names[self._at] if self._at >= 0 else None

    @property
    def on_leg(self) -> bool:
        """Whether samples were taken since the place last seen."""
        return self._leg.started

    @property
    def closures(self) -> tuple[Closure, ...]:
        """The loop closures, in order."""
        return tuple(self._closures)

    @property
    def outer(self) -> int:
        """A dart with the outer face on its left, -1 while there is no edge. O(1)."""
        return self._memory.grown.outer

    @property
    def face_of(self) -> NDArray[np.int32]:
        """(2E,) int32, the face on each dart's left, numbered in the order in which faces came about. O(E)."""
        return np.array(self._memory.grown.face, dtype=np.int32)

    @property
    def residuals(self) -> NDArray[np.float64]:
        """How far each edge's first net rotation is from the mean of its end headings, (E,) radians: sensor health. O(E)."""
        return edge_residual(np.array(self._memory.grown.heading), np.array(self._memory.grown.turn))

    @property
    def open_exits(self) -> tuple[tuple[str, Heading], ...]:
        """The exits seen and never travelled, as (place, heading). O(V + E)."""
        return tuple(
            (name, Heading(yaw))
            for name, star in zip(self._memory.names, self._memory.stars, strict=True)
            for yaw, dart in zip(star.yaws, star.darts, strict=True)
            if dart == OPEN
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is unfinished or in doubt: a leg without end, exits never travelled, edges that may be one. O(V + E)."""
        found = []
        if self._leg.started:
            found.append(f"the walk ends on a leg from {quoted(self.place)}, which is left out")
        if still_open := len(self.open_exits):
            first = self.open_exits[0]
            exits = f"{counted(still_open, 'exit')} {'was' if still_open == 1 else 'were'}"
            found.append(f"{exits} never travelled, the first at {quoted(first[0])}, {self._unit.heading(first[1].yaw)}")
        found += self._memory.doubles()
        return tuple(found)

    @property
    def plane(self) -> PlaneMap:
        """The map so far, immutable; kept until the next change.

        Raises
        ------
        BadInput
            Before the first place. Complexity O(V + E) after a change.
        """
        if self._plane is None:
            if not self._memory.names:
                raise BadInput("there is no map before the first place; a walk visits at least one")
            grown = self._memory.grown
            self._plane = PlaneMap.from_darts(
                np.array(grown.tail, dtype=np.int32),
                np.array(grown.next, dtype=np.int32),
                n_vertices=len(self._memory.names),
                heading=np.array(grown.heading, dtype=np.float64),
                turn=np.array(grown.turn, dtype=np.float64),
                metres=np.array(self._memory.metres, dtype=np.float64) if any(self._memory.measured) else None,
                vertex_names=self._memory.names,
                edge_names=self._memory.edge_names,
            )
        return self._plane

    def fork(self) -> Mapper:
        """Return a mapper that knows the same and goes its own way from here. O(V + E)."""
        other = Mapper(self.header, tolerance=self.tolerance)
        other._unit = self._unit
        other._memory = self._memory.fork()
        other._leg = self._leg.fork()
        other._closures = self._closures.copy()
        other._events, other._at, other._plane = self._events, self._at, self._plane
        return other

    def __repr__(self) -> str:
        kinds = (("event", None), ("vertex", "vertices"), ("edge", None), ("face", None))
        numbers = (self._events, self.n_vertices, self.n_edges, self.n_faces)
        return f"Mapper({', '.join(counted(n, one, many) for n, (one, many) in zip(numbers, kinds, strict=True))})"

    # -- events --------------------------------------------------------------------------------------------------------

    def step(self, event: Event) -> None:
        """Take the next event.

        Raises
        ------
        WalkError
            For an event out of order, a place not recognised, or evidence that contradicts what was seen before.
        AmbiguousDart
            If more than one known direction could be meant.
        NotPlane
            If no drawing in the plane has the loop closure.

        Notes
        -----
        After an error everything is as it was before the event.
        """
        try:
            if isinstance(event, Samples):
                self._sample(event)
            elif isinstance(event, Visit):
                self._visit(event)
            else:
                raise WalkError(f"an event is a Visit or Samples, not {quoted(event)}")
        except BadInput as error:
            raise located(error, f"event {self._events + 1}", event=self._events + 1) from None
        self._events += 1

    def _sample(self, event: Samples) -> None:
        if self._at < 0:
            raise WalkError("a heading before the first place; a walk begins at a place")
        self._leg.take(event.yaw, event.metres)

    def _visit(self, event: Visit) -> None:
        place, memory = event.place, self._memory
        if place is None:
            raise WalkError(
                "a place that was not recognised (null); one map needs every place named: name it, or let `ninefold "
                "hypotheses` find every map that explains the walk"
            )
        if self._at < 0:
            if event.edge is not None:
                raise WalkError(f"edge {quoted(event.edge)} is named at the first place, before any leg")
            self._at = memory.settle(place, memory.look(place, event.exits))
            return
        leg = self._leg_to(place)
        star = memory.look(place, event.exits)
        dart = memory.recognise(self._at, place, star, leg, event.edge)
        if dart >= 0:
            memory.settle(place, star)
            changed = memory.travel(dart, leg)
        else:
            edge, closed = memory.grow(self._at, place, star, leg, event.edge)
            changed = True
            if closed:
                self._closures.append(Closure(self._events + 1, memory.edge_names[edge]))
        if changed:
            self._plane = None
        self._at = memory.rows[place]
        self._leg.drop()

    def _leg_to(self, place: str) -> Leg:
        if not self._leg.started:
            raise WalkError(f"no heading between {quoted(self.place)} and {quoted(place)}; a leg has at least one sample")
        return self._leg.read()
