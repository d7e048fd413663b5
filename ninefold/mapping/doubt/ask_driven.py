"""Exploring to answer one question: whether a place is inside a cycle.

While the cycle is not on the map, the robot heads for its missing ways. Then every open exit lies in a face on one side of
it, and a place not met yet lies behind one of them. So the answer is open as long as both sides have open exits. It is
settled, even before the place is seen, when one side has none: the robot walks the side with fewer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypeAlias

from ninefold._wording import quoted
from ninefold.errors import AmbiguousDart, BadInput, UnknownName

from ..robot.open_map import OPEN, OpenMap, named, nearest, route

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

__all__ = ["AskDriven", "Side"]

Side: TypeAlias = Literal["inside", "outside", "boundary"]


class AskDriven:
    """A strategy that stops when it knows on which side of a cycle a place is.

    Parameters
    ----------
    place
        Name of a place that can be reached; it need not be on the map.
    ring
        Names of the places of a simple cycle in order, at least three.

    Attributes
    ----------
    answer
        ``"inside"``, ``"outside"`` or ``"boundary"``; None until that is settled.
    seen
        Whether the place was met; else the answer follows from one side of the cycle being walked out.

    Raises
    ------
    BadInput
        For a ring that is none. While exploring: if all is walked and two places next to each other in the ring are not
        joined by a way.
    AmbiguousDart
        While exploring: if two ways join two places of the ring.
    UnknownName
        While exploring: if all is walked and there is no such place.

    Notes
    -----
    It takes for granted that the place can be reached, as one has to who goes to look for it. Where two ways join two places
    of the ring, the ring is the one on the map; with both on the map it is ambiguous, and the error says so. Each new way
    costs O(V + E).

    Examples
    --------
    >>> from ninefold.mapping import SimulatedWorld, explore
    >>> points = [(0, 0), (4, 0), (4, 4), (0, 4), (1, 1), (9, 0), (9, 9)]
    >>> ways = [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 5), (5, 6)]
    >>> question = AskDriven("6", ["0", "1", "2", "3"])
    >>> explore(SimulatedWorld(points, ways), start=0, tour=question).walk.places
    ('0', '1', '5', '1', '2', '3', '0', '4')
    >>> question.answer, question.seen
    ('outside', False)
    """

    def __init__(self, place: str | int, ring: Sequence[str | int]) -> None:
        self.place, self.ring = str(place), tuple(map(str, ring))
        if len(set(self.ring)) != len(self.ring) or len(self.ring) < 3:
            raise BadInput(f"a ring is three places or more, each once, such as ['a', 'b', 'c'], not {quoted(ring)}")
        self.answer: Side | None = "boundary" if self.place in self.ring else None
        self.seen = False
        self._route: list[int] = []

    def __call__(self, known: OpenMap) -> int | None:
        """Return the exit to take, or None once the question is answered."""
        self.seen = self.seen or known.names[known.at] == self.place
        if self._route:
            return self._route.pop()
        if self.answer is None:
            wanted = self._wanted(known)
            if wanted is not None:
                new, came = nearest(known, wanted)
                self._route = route(known, came, new[0])
                return self._route.pop()
        return None

    def _wanted(self, known: OpenMap) -> Callable[[int], bool] | None:
        """Return which open exits the answer depends on, or None if it does not any more: then it is there."""
        places = named(known)
        missing = self._missing(known, places)
        if missing is not None:
            return missing
        plane, dart = known.to_plane()
        region = plane.cycle(list(self.ring))
        inner = set(region.faces)
        if self.place in places:
            at = next(dart[out] for out in known.exits(places[self.place]) if out in dart)
            self.answer = "inside" if int(plane.face_of[at]) in inner else "outside"
            return None
        sides: tuple[list[int], list[int]] = ([], [])
        for place in range(known.n_places):
            walked = [out for out in known.exits(place) if out in dart]
            face = int(plane.face_of[dart[walked[-1]]])  # the one on the left of the exit walked before, clockwise
            for out in known.exits(place):
                if out in dart:
                    face = int(plane.face_of[dart[out]])
                else:
                    sides[face not in inner].append(out)
        within, without = sides
        if not within and not without:
            raise UnknownName("place", self.place, places)
        if not within or not without:
            self.answer = "outside" if not within else "inside"
            return None
        return set(without if len(without) < len(within) else within).__contains__

    def _missing(self, known: OpenMap, places: dict[str, int]) -> Callable[[int], bool] | None:
        """Return which open exits may lead on along the ring, or None if all of it is on the map."""
        ends: set[int] = set()
        whole = True
        for one, other in zip(self.ring, (*self.ring[1:], self.ring[0]), strict=True):
            a, b = places.get(one), places.get(other)
            if a is not None and b is not None:
                mates = [known.mate[out] for out in known.exits(a)]
                joining = sum(back != OPEN and known.place[back] == b for back in mates)
                if joining > 1:
                    raise AmbiguousDart(
                        f"{joining} ways join {quoted(one)} and {quoted(other)}, so the ring is not one cycle"
                    )
                if joining:
                    continue
                ways = [out for place in (a, b) for out in known.open_exits(place)]
                if not known.open_exits(a) or not known.open_exits(b):
                    raise BadInput(
                        f"all ways at {quoted(one)} or {quoted(other)} are walked, and none joins the two: no such ring"
                    )
            else:
                ways = [out for place in (a, b) if place is not None for out in known.open_exits(place)]
            whole = False
            ends.update(ways)
        if whole:
            return None
        if ends:
            return ends.__contains__
        if not known.n_open:
            for name in self.ring:
                if name not in places:
                    raise UnknownName("place", name, places)
        return lambda _: True
