"""What a mapper remembers, places, edges and the directions at each place, and what one more leg means against it.

Every method checks all it can object to before it changes anything, so an error leaves the memory as it was. Errors are
raised without saying at which event; that is the mapper's to add.
"""

from __future__ import annotations

from itertools import pairwise
from math import degrees, pi, remainder
from typing import TYPE_CHECKING

from ninefold.errors import AmbiguousDart, NotPlane, WalkError

from ..heading import TAU, wrap
from ..names import Names
from ..plane import PlaneMap
from ._growing import GrowingMap, whole_turns
from ._star import NONE, OPEN, TIE, Star
from .legs import show_angle, show_yaw

if TYPE_CHECKING:
    from ..heading import Heading
    from .legs import Leg

__all__ = ["Memory"]

FARTHEST_MISS = pi / 2
"""Radians by which mean headings may drift from the first pass of an edge before its turning is in doubt."""


class Memory:
    """Places and edges seen so far.

    Attributes
    ----------
    names, rows, stars
        Of places, in the order first seen: name, row by name, directions.
    edge_names, edge_rows, passes
        Of edges, in the order first travelled: name, row by name, number of times travelled.
    grown
        The plane map of all that.
    """

    __slots__ = ("edge_names", "edge_rows", "grown", "names", "passes", "rows", "stars", "tolerance")

    def __init__(self, tolerance: float) -> None:
        self.tolerance = tolerance
        self.names: list[str] = []
        self.rows: dict[str, int] = {}
        self.stars: list[Star] = []
        self.edge_names: list[str] = []
        self.edge_rows: dict[str, int] = {}
        self.passes: list[int] = []
        self.grown = GrowingMap()

    def fork(self) -> Memory:
        """Return a memory that knows the same and goes its own way from here. O(V + E)."""
        other = Memory(self.tolerance)
        other.names = self.names.copy()
        other.rows = self.rows.copy()
        other.stars = [star.fork() for star in self.stars]
        other.edge_names = self.edge_names.copy()
        other.edge_rows = self.edge_rows.copy()
        other.passes = self.passes.copy()
        other.grown = self.grown.fork()
        return other

    # -- places --------------------------------------------------------------------------------------------------------

    def look(self, place: str, exits: tuple[Heading, ...] | None) -> Star:
        """Return the directions at a place with its exits as seen now; the star is new if it is not the one remembered.

        Raises
        ------
        WalkError, AmbiguousDart
            If the exits are not what was seen there before, or too close to each other, or the name cannot be one.
        """
        v = self.rows.get(place)
        if v is None:
            Names("vertex", 1, (place,))
        star = self.stars[v] if v is not None else Star()
        if exits is None:
            return star
        tolerance = self.tolerance
        yaws = sorted([heading.yaw for heading in exits])
        for a, b in pairwise([*yaws, yaws[0] + TAU] if len(yaws) > 1 else []):
            if b - a <= tolerance:
                raise AmbiguousDart(f"two exits of {place!r}, {show_yaw(a)} and {show_yaw(b)}, are within the tolerance")
        if star.declared:
            if star.agrees(yaws, tolerance):
                return star
            if len(yaws) != len(star.yaws):
                raise WalkError(
                    f"place {place!r} was seen with {_exits(len(star.yaws))} and now with {len(yaws)}: "
                    "two places with one name?"
                )
            raise WalkError(
                f"place {place!r} was seen with exits at {_list(star.yaws)} and now at {_list(yaws)}: "
                "two places with one name?"
            )
        found = star.with_exits(yaws, tolerance)
        if isinstance(found, int):
            raise WalkError(
                f"the exits of {place!r}, {_list(yaws)}, do not show edge {self._edge(star.darts[found])!r} at "
                f"{show_yaw(star.yaws[found])}: two places with one name?"
            )
        return found

    def settle(self, place: str, star: Star) -> int:
        """Remember a place with these directions; return its row."""
        v = self.rows.get(place)
        if v is None:
            v = self.rows[place] = len(self.names)
            self.names.append(place)
            self.stars.append(star)
        else:
            self.stars[v] = star
        return v

    # -- legs ----------------------------------------------------------------------------------------------------------

    def recognise(self, u: int, place: str, star: Star, leg: Leg, name: str | None) -> int:
        """Return the known dart that a leg from `u` to a place travels, or -1 for a new edge.

        `star` holds the directions at the place, as `look` gave them.

        Raises
        ------
        WalkError, AmbiguousDart
            If the leg contradicts what is known, or more than one known direction could be meant.
        """
        v = self.rows.get(place, -1)
        origin = star if u == v else self.stars[u]
        i = self._match(origin, leg.out, self.names[u], "leaves")
        j = self._match(star, leg.back, place, "reaches")
        d = origin.darts[i] if i >= 0 else OPEN
        b = star.darts[j] if j >= 0 else OPEN
        if d >= 0 or b >= 0:
            self._check_known(u, place, v, leg, d, b)
            if name is not None and name != self._edge(d):
                raise WalkError(
                    f"the edge known as {self._edge(d)!r} is now called {name!r}; name an edge at its first traversal"
                )
            return d
        for at, index, yaw, end, verb in (
            (origin, i, leg.out, self.names[u], "leaves"),
            (star, j, leg.back, place, "reaches"),
        ):
            if index == NONE and at.declared:
                raise WalkError(f"the leg {verb} {end!r} at {show_yaw(yaw)}, along none of its {_exits(len(at.yaws))}")
        if u == v and abs(remainder(leg.out - leg.back, TAU)) <= 2 * self.tolerance:
            raise AmbiguousDart(
                f"the leg leaves {place!r} and comes back along one direction, {show_yaw(leg.out)}: a robot that turned "
                "round, or a loop whose ends cannot be told apart"
            )
        return OPEN

    def travel(self, d: int, leg: Leg) -> bool:
        """Refine the headings of a known edge by one more pass, along dart `d`; return whether they changed."""
        heading = self.grown.heading
        means = self._means(d, leg)
        self.passes[d >> 1] += 1
        changed = False
        for dart, new in zip((d, d ^ 1), means, strict=True):
            if new != heading[dart]:
                self.stars[self.grown.tail[dart]].move(heading[dart], new)
                changed = True
        self.grown.refine(d, *means)
        return changed

    def grow(self, u: int, place: str, star: Star, leg: Leg, given: str | None) -> tuple[int, bool]:
        """Draw a new edge from `u` to a place; return its row and whether it closed a loop.

        Raises
        ------
        WalkError
            If the name given is another edge's.
        NotPlane
            If no drawing in the plane has the edge.
        """
        grown = self.grown
        v = self.rows.get(place, -1)
        name = self._new_edge_name(u, place, given)
        origin = star if u == v else self.stars[u]
        at_u = origin.before(leg.out, grown.prev)
        if v < 0:
            e = grown.extend(u, at_u, len(self.names), *leg)
        else:
            at_v = star.before(leg.back, grown.prev)
            try:
                e = grown.close(u, at_u, v, at_v, *leg)
            except NotPlane as error:
                raise self._explained(error, u, v, at_u, at_v, name) from None
        self.settle(place, star)
        for at, yaw, dart in ((origin, leg.out, 2 * e), (star, leg.back, 2 * e + 1)):
            at.put(at.find(yaw, self.tolerance), yaw, dart)
        self.edge_rows[name] = e
        self.edge_names.append(name)
        self.passes.append(1)
        return e, v >= 0

    # -- evidence held against what is known ---------------------------------------------------------------------------

    def _match(self, star: Star, yaw: float, place: str, verb: str) -> int:
        index = star.find(yaw, self.tolerance)
        if index == TIE:
            near = star.near(yaw, 2 * self.tolerance)[:2]
            known = " and ".join(f"{self._direction(star.darts[k])} at {show_yaw(star.yaws[k])}" for k in near)
            raise AmbiguousDart(
                f"the leg {verb} {place!r} at {show_yaw(yaw)}, too close to {known} to tell whether it is the same: "
                f"headings match within {degrees(self.tolerance):.3g} deg and differ from twice that"
            )
        return index

    def _check_known(self, u: int, place: str, v: int, leg: Leg, d: int, b: int) -> None:
        """Hold a leg, of which at least one end is known as dart `d` or `b`, against its edge."""
        tail, heading, origin = self.grown.tail, self.grown.heading, self.names[u]
        if d < 0:
            other = f"its other end is at {show_yaw(heading[b ^ 1])}" if tail[b ^ 1] == u else "it has no end"
            raise WalkError(
                f"the leg reaches {place!r} along edge {self._edge(b)!r}, but left {origin!r} at {show_yaw(leg.out)}, "
                f"where {other}"
            )
        name = self._edge(d)
        if tail[d ^ 1] != v:
            raise WalkError(
                f"edge {name!r} leaves {origin!r} at {show_yaw(leg.out)} and led to {self.names[tail[d ^ 1]]!r} before, now "
                f"to {place!r}: two places with one name, or a wrong heading"
            )
        if b != d ^ 1:
            end = f", the end of edge {self._edge(b)!r}" if b >= 0 else ""
            raise WalkError(
                f"edge {name!r} from {origin!r} to {place!r} ended at {show_yaw(heading[d ^ 1])} (looking back) before, "
                f"and now at {show_yaw(leg.back)}{end}"
            )
        before = self.grown.turn[d >> 1] * (-1 if d & 1 else 1)
        if abs(leg.turn - before) > pi:
            raise WalkError(
                f"edge {name!r} turned by {show_angle(before)} before and now by {show_angle(leg.turn)}: sampled too "
                "coarsely, or another way"
            )
        if abs(whole_turns(*self._means(d, leg), before)[1]) > FARTHEST_MISS:
            raise WalkError(
                f"the headings of edge {name!r} have drifted a quarter turn from its first pass; check the compass"
            )

    def _means(self, d: int, leg: Leg) -> tuple[float, float]:
        """Mean headings of dart `d` and its twin with this pass counted in."""
        heading, share = self.grown.heading, 1 / (self.passes[d >> 1] + 1)
        out, back = heading[d], heading[d ^ 1]
        return (
            wrap(out + share * remainder(leg.out - out, TAU)),
            wrap(back + share * remainder(leg.back - back, TAU)),
        )

    def _new_edge_name(self, u: int, place: str, given: str | None) -> str:
        if given is None:
            number = len(self.edge_names)
            while f"e{number}" in self.edge_rows:
                number += 1
            return f"e{number}"
        known = self.edge_rows.get(given)
        if known is not None:
            ends = [self.names[v] for v in self.grown.tail[2 * known : 2 * known + 2]]
            raise WalkError(
                f"edge {given!r} joins {ends[0]!r} and {ends[1]!r}, and the leg from {self.names[u]!r} to {place!r} is "
                "another one by its headings; give it a name of its own"
            )
        Names("edge", 1, (given,))
        return given

    def _edge(self, dart: int) -> str:
        return self.edge_names[dart >> 1]

    def _direction(self, dart: int) -> str:
        return "an exit" if dart == OPEN else f"edge {self._edge(dart)!r}"

    def _explained(self, error: NotPlane, u: int, v: int, at_u: int, at_v: int, name: str) -> NotPlane:
        """Say which leg could not be drawn, and for a genus show a shortest offending part. O(E) and its search."""
        what = f"the leg from {self.names[u]!r} to {self.names[v]!r} cannot be drawn: {error}"
        edges: tuple[str, ...] = ()
        if error.genus:
            edges = self._offending_part(u, v, at_u, at_v, name)
            what += (
                f", and the map would have genus {error.genus}; a shortest offending part is the edges {', '.join(edges)}"
            )
        what += "; a place was taken for another, a heading is wrong, or legs cross"
        return NotPlane(what, genus=error.genus, edges=edges)

    def _offending_part(self, u: int, v: int, at_u: int, at_v: int, name: str) -> tuple[str, ...]:
        a = len(self.grown.tail)
        tail, after = [*self.grown.tail, u, v], [*self.grown.next, a, a + 1]
        for dart, before in ((a, at_u), (a + 1, at_v)):
            after[dart], after[before] = after[before], dart
        try:
            PlaneMap.from_darts(tail, after, 0, vertex_names=self.names, edge_names=[*self.edge_names, name])
        except NotPlane as found:
            return found.edges
        raise AssertionError("faces kept online differ from those of the rotation")


def _list(yaws: list[float]) -> str:
    return ", ".join(f"{degrees(yaw) + 0.0:.4g}" for yaw in yaws) + " deg" if yaws else "none"


def _exits(number: int) -> str:
    return f"{number} exit{'' if number == 1 else 's'}"
