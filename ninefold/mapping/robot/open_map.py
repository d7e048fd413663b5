"""What a robot knows while it explores: a plane map with open exits, those that are seen and not walked yet.

A `PlaneMap` is a whole map and has no open exits. An `OpenMap` grows: a place is added with all its exits, and an exit that
is walked gets a *mate*, the exit by which the robot arrived at the other end. Strategies choose from it where to go next,
and two of them can be merged.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from math import pi
from typing import TYPE_CHECKING

from ninefold._wording import quoted
from ninefold.errors import BadInput

from ..heading import TAU

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ..plane import PlaneMap

__all__ = ["OPEN", "OpenMap", "checked_exit", "named", "nearest", "route"]

OPEN = -1
"""The mate of an exit that nobody has walked."""


@dataclass(slots=True)
class OpenMap:
    """Places with all their exits, and where the exits walked lead.

    Places are numbered in the order seen. Exits are numbered too, those of one place in a row, counter-clockwise.

    Attributes
    ----------
    compass
        Whether headings of different places can be compared.
    complete
        Whether all exits of every place are listed.
    names
        Of places, None for one that was not recognised.
    first
        Of places, their first exit; one entry more, the number of exits.
    place, heading, mate, turn
        Of exits: their place; yaw, radians; the exit at the other end of the way, or `OPEN`; net rotation along the way out,
        radians, 0 where nobody walked.
    at, came
        The place where the robot is, and the exit there by which it came (-1 where it began).
    n_open
        Number of open exits.

    Examples
    --------
    >>> known = OpenMap()
    >>> hall, desk = known.see([0.0, 1.5], "hall"), known.see([-3.0], "desk")
    >>> known.join(0, 2, turn=0.1)
    >>> known.open_exits(hall), known.n_open, known.mate
    ([1], 1, [2, -1, 0])
    """

    compass: bool = True
    complete: bool = field(default=True, kw_only=True)
    names: list[str | None] = field(default_factory=list)
    first: list[int] = field(default_factory=lambda: [0])
    place: list[int] = field(default_factory=list, repr=False)
    heading: list[float] = field(default_factory=list, repr=False)
    mate: list[int] = field(default_factory=list, repr=False)
    turn: list[float] = field(default_factory=list, repr=False)
    at: int = 0
    came: int = -1
    n_open: int = 0

    @property
    def n_places(self) -> int:
        """Number of places."""
        return len(self.names)

    def see(self, headings: Sequence[float], name: str | None = None) -> int:
        """Add a place with its exits, yaws in radians, ascending and less than a full turn apart; return its number.

        Raises
        ------
        BadInput
            For exits in another order, or two in one direction.
        """
        if any(b <= a for a, b in pairwise(headings)) or (len(headings) > 1 and headings[-1] - headings[0] >= TAU):
            raise BadInput(f"the exits of a place are listed by ascending yaw, within one turn; got {list(headings)}")
        number = len(self.names)
        self.names.append(name)
        self.place += [number] * len(headings)
        self.heading += headings
        self.mate += [OPEN] * len(headings)
        self.turn += [0.0] * len(headings)
        self.first.append(len(self.place))
        self.n_open += len(headings)
        return number

    def join(self, out: int, back: int, turn: float = 0.0) -> None:
        """Note that an open exit leads to another; joined already, nothing changes.

        Raises
        ------
        BadInput
            If one of them is known to lead elsewhere, or they are one exit.
        """
        if self.mate[out] == back:
            return
        if out == back or self.mate[out] != OPEN or self.mate[back] != OPEN:
            raise BadInput(f"exit {out} leads to exit {self.mate[out]} and {back} to {self.mate[back]}, not to each other")
        self.mate[out], self.mate[back] = back, out
        self.turn[out], self.turn[back] = turn, -turn
        self.n_open -= 2

    def arrive(self, back: int) -> None:
        """Be at the place of an exit, by which the robot came."""
        self.at, self.came = self.place[back], back

    def exits(self, place: int) -> range:
        """Return the exits of a place, counter-clockwise."""
        return range(self.first[place], self.first[place + 1])

    def open_exits(self, place: int) -> list[int]:
        """Return the open exits of a place, counter-clockwise."""
        return [out for out in self.exits(place) if self.mate[out] == OPEN]

    def after(self, out: int) -> int:
        """Return the next exit of the same place counter-clockwise."""
        start, end = self.first[self.place[out]], self.first[self.place[out] + 1]
        return out + 1 if out + 1 < end else start

    def name(self, place: int) -> str:
        """Return the name of a place in a map made of this: its own, or ``p`` and its number."""
        own = self.names[place]
        return f"p{place}" if own is None else own

    def to_plane(self) -> tuple[PlaneMap, dict[int, int]]:
        """Return the map of what was walked, and the dart of every exit walked; checked as every map is.

        Raises
        ------
        NotPlane
            If no drawing in the plane has these ways, orders and turns.

        Notes
        -----
        Open exits are left out. Without a compass headings are those of the frame of the first place. O(V + E).
        """
        from ..plane import PlaneMap

        dart: dict[int, int] = {}
        for out, back in enumerate(self.mate):
            if out < back:
                dart[out], dart[back] = len(dart), len(dart) + 1
        frame = [0.0] * self.n_places if self.compass else self._frames()
        after = [0] * len(dart)
        heading = [0.0] * len(dart)
        for place in range(self.n_places):
            walked = [out for out in self.exits(place) if out in dart]
            for out, following in zip(walked, [*walked[1:], *walked[:1]], strict=True):
                after[dart[out]] = dart[following]
                heading[dart[out]] = self.heading[out] + frame[place]
        turn = []
        for out, back in enumerate(self.mate):
            if out < back:
                miss = heading[dart[back]] - pi - heading[dart[out]] - self.turn[out]
                turn.append(self.turn[out] + miss - TAU * round(miss / TAU))
        plane = PlaneMap.from_darts(
            [self.place[out] for out in dart],
            after,
            n_vertices=self.n_places,
            heading=heading,
            turn=turn,
            vertex_names=[self.name(place) for place in range(self.n_places)],
        )
        return plane, dart

    def _frames(self) -> list[float]:
        """Return what to add to the headings of every place to have them in the frame of the first."""
        frame = {0: 0.0}
        queue = [0]
        for place in queue:
            for out in self.exits(place):
                back = self.mate[out]
                if back != OPEN and self.place[back] not in frame:
                    there = frame[place] + self.heading[out] + self.turn[out] + pi - self.heading[back]
                    frame[self.place[back]] = there
                    queue.append(self.place[back])
        return [frame.get(place, 0.0) for place in range(self.n_places)]


def nearest(known: OpenMap, wanted: Callable[[int], bool] | None = None) -> tuple[list[int], dict[int, int]]:
    """Find the open exits that are the fewest legs away over known ways.

    Parameters
    ----------
    wanted
        Which open exits count; all, if left out.

    Returns
    -------
    exits, came
        All wanted open exits at the least distance, as they are found; none if there are none. And for every place looked
        at, the exit by which it is entered from the robot's place, there -1.
    """
    came = {known.at: -1}
    ring = [known.at]
    while ring:
        new = [out for place in ring for out in known.open_exits(place) if wanted is None or wanted(out)]
        if new:
            return new, came
        further = []
        for place in ring:
            for out in known.exits(place):
                back = known.mate[out]
                if back != OPEN and (there := known.place[back]) not in came:
                    came[there] = back
                    further.append(there)
        ring = further
    return [], came


def route(known: OpenMap, came: dict[int, int], last: int) -> list[int]:
    """Return the exits to take so that the last one is `last`, in reverse; `came` as `nearest` gives it."""
    found = [last]
    while (back := came[known.place[found[-1]]]) >= 0:
        found.append(known.mate[back])
    return found


def named(known: OpenMap) -> dict[str, int]:
    """Return the place of every name."""
    return {name: place for place, name in enumerate(known.names) if name is not None}


def checked_exit(known: OpenMap, chosen: object) -> int:
    """Return the exit that a strategy chose, or say why it is none of the robot's place."""
    here = known.exits(known.at)
    if isinstance(chosen, bool) or not isinstance(chosen, int) or chosen not in here:
        raise BadInput(f"a strategy chooses an exit of the place where the robot is, {list(here)}, not {quoted(chosen)}")
    return chosen
