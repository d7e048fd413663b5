"""A localizer taken along a walk, event by event: places unnamed, exits and headings as they come."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ninefold.errors import EmptyBelief, WalkError, located

from ..heading import Heading
from ..robot.legs import LegReader
from ..robot.units import unit_of
from ..robot.walk import Visit, WalkHeader
from .localizer import Localizer
from .noise import sigma_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from ..plane import PlaneMap
    from ..robot.walk import Event, Walk
    from ..sets import Set

__all__ = ["Follower", "locate"]


def locate(plane: PlaneMap, walk: Walk, *, sigma: float | None = None, start: Set | None = None) -> Localizer:
    """Return where a robot can be at the end of a walk that began somewhere on a map.

    Parameters
    ----------
    walk
        Names of places and edges in it are not looked at.
    sigma
        Standard deviation of a heading in radians, the map's error included; left out, what the walk's header declares, or
        5 degrees.
    start
        A set of the map in which the walk began; left out, anywhere.

    Raises
    ------
    WalkError
        For legs that cannot be read, with the number of the event, counted from 1.
    EmptyBelief
        If the walk fits nowhere, with the number of the event that showed it.

    Examples
    --------
    >>> from ninefold.mapping import Heading, PlaneMap, Samples, Visit, Walk, WalkHeader, locate
    >>> plane = PlaneMap.from_geometry([(0, 0), (2, 0), (2, 1), (0, 1), (3, 0)], [(0, 1), (1, 2), (2, 3), (3, 0), (1, 4)])
    >>> east = Samples.of(Heading.from_bearing(90))
    >>> [found.vertex for found in locate(plane, Walk(WalkHeader(), (Visit(None), east, Visit(None)))).candidates()]
    ['1', '2', '4']
    >>> locate(plane, Walk(WalkHeader(), (Visit(None), east, Visit(None), east, Visit(None)))).likeliest.vertex
    '4'
    """
    follower = Follower(plane, walk.header, sigma=sigma, start=start)
    for event in walk.events:
        follower.step(event)
    return follower.localizer


class Follower:
    """Takes a localizer along a walk whose start is unknown, event by event.

    A leg is a move along the heading of its first sample; the way back, opposite to its last, and its net rotation weigh the
    places it can have led to, and so do the exits of the place reached, where they were looked for.

    Parameters
    ----------
    header
        Of the walk: whether it has a compass, the unit in which messages speak of headings, and sigma.
    sigma, start
        See `locate`.
    beyond
        Places of which nothing is known; see `Localizer`.

    Attributes
    ----------
    localizer
        Where the robot can be, as of the last place reached.
    """

    def __init__(
        self,
        plane: PlaneMap,
        header: WalkHeader | None = None,
        *,
        sigma: float | None = None,
        start: Set | None = None,
        beyond: Iterable[str] = (),
    ) -> None:
        header = WalkHeader() if header is None else header
        self.localizer = Localizer(
            plane,
            sigma=sigma_of(header) if sigma is None else sigma,
            compass=header.compass,
            start=start,
            beyond=beyond,
            unit="yaw-deg" if header.heading == "yaw-rad" else header.heading,
        )
        self._leg = LegReader(unit_of(header.heading))
        self._begun = False
        self._events = 0

    def step(self, event: Event) -> bool:
        """Take the next event; return whether it was a place.

        Raises
        ------
        WalkError
            For a heading before the first place, or a leg that cannot be read.
        EmptyBelief
            If nothing that was possible fits. After an error all is as it was before the event.
        """
        number = self._events + 1
        try:
            if isinstance(event, Visit):
                self.localizer = self._visited(event)
                self._leg.drop()
                self._begun = True
            elif self._begun:
                self._leg.take(event.yaw, event.metres)
            else:
                raise WalkError("a heading before the first place; a walk begins at a place")
        except WalkError as error:
            raise located(error, f"event {number}", event=number) from None
        except EmptyBelief as error:
            raise error.at_event(number) from None
        self._events = number
        return isinstance(event, Visit)

    def _visited(self, visit: Visit) -> Localizer:
        robot = self.localizer.fork()
        came_by = None
        if self._begun:
            leg = self._leg.read()
            robot.move(Heading(leg.out), turn=leg.turn)
            came_by = Heading(leg.back)
        if visit.exits is not None or came_by is not None:
            robot.observe(visit.exits, came_by=came_by)
        return robot
