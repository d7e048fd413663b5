"""What a mapper remembers, places, edges and the directions at each place, and what one more leg means against it.

Every method checks all it can object to before it changes anything, so an error leaves the memory as it was. Errors are
raised without saying at which event; that is the mapper's to add.
"""

from __future__ import annotations

from itertools import pairwise
from math import nan, pi, remainder
from typing import TYPE_CHECKING

from ninefold._wording import counted, quoted, shortened
from ninefold.errors import AmbiguousDart, NotPlane, WalkError

from ..heading import TAU, wrap
from ..names import Names
from ..plane import PlaneMap
from ._growing import GrowingMap, whole_turns
from ._star import NONE, OPEN, TIE, Star
from .legs import DEGREES
from .walk import LARGEST_TOLERANCE

if TYPE_CHECKING:
    from ..heading import Heading
    from .legs import Leg
    from .units import Unit

__all__ = ["Memory"]

FARTHEST_MISS = pi / 2
"""Radians by which mean headings may drift from the first pass of an edge before its turning is in doubt."""

THINNEST = 3
"""Times the tolerance up to which two edges that join the same places are doubted to be two."""

FARTHEST_NOISE = 10
"""Times the tolerance up to which a miss is taken for noise, in messages alone."""


class Memory:
    """Places and edges seen so far.

    Attributes
    ----------
    names, rows, stars
        Of places, in the order first seen: name, row by name, directions.
    edge_names, edge_rows, passes
        Of edges, in the order first travelled: name, row by name, number of times travelled.
    metres, measured
        Of edges: mean length over the passes that measured it, NaN before the first, and their number.
    grown
        The plane map of all that.
    tolerance, unit
        Radians within which two headings are the same direction; how messages write headings.
    """

    __slots__ = (
        "edge_names",
        "edge_rows",
        "grown",
        "measured",
        "metres",
        "names",
        "passes",
        "rows",
        "stars",
        "tolerance",
        "unit",
    )

    def __init__(self, tolerance: float, unit: Unit = DEGREES) -> None:
        self.tolerance = tolerance
        self.unit = unit
        self.names: list[str] = []
        self.rows: dict[str, int] = {}
        self.stars: list[Star] = []
        self.edge_names: list[str] = []
        self.edge_rows: dict[str, int] = {}
        self.passes: list[int] = []
        self.metres: list[float] = []
        self.measured: list[int] = []
        self.grown = GrowingMap()

    def fork(self) -> Memory:
        """Return a memory that knows the same and goes its own way from here. O(V + E)."""
        other = Memory(self.tolerance, self.unit)
        other.names = self.names.copy()
        other.rows = self.rows.copy()
        other.stars = [star.fork() for star in self.stars]
        other.edge_names = self.edge_names.copy()
        other.edge_rows = self.edge_rows.copy()
        other.passes = self.passes.copy()
        other.metres = self.metres.copy()
        other.measured = self.measured.copy()
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
        tolerance, show = self.tolerance, self.unit.heading
        yaws = sorted([heading.yaw for heading in exits])
        for a, b in pairwise([*yaws, yaws[0] + TAU] if len(yaws) > 1 else []):
            if b - a <= tolerance:
                raise AmbiguousDart(
                    f"two exits of {quoted(place)}, {show(a)} and {show(b)}, are within the tolerance of "
                    f"{self.unit.angle(tolerance)}"
                )
        if star.declared:
            if star.agrees(yaws, tolerance):
                return star
            if len(yaws) != len(star.yaws):
                raise WalkError(
                    f"place {quoted(place)} was seen with {counted(len(star.yaws), 'exit')} and now with {len(yaws)}: "
                    f"two places with one name? Exits seen before: {self._list(star.yaws)}; now: {self._list(yaws)}"
                )
            raise WalkError(
                f"place {quoted(place)} was seen with exits at {self._list(star.yaws)} and now at {self._list(yaws)}: "
                f"two places with one name?{self._noise(star.farthest(yaws), 'they differ by at most')}"
            )
        found = star.with_exits(yaws, tolerance)
        if isinstance(found, int):
            miss = min((abs(remainder(yaw - star.yaws[found], TAU)) for yaw in yaws), default=pi)
            raise WalkError(
                f"the exits of {quoted(place)}, {self._list(yaws)}, do not show edge {self._edge(star.darts[found])} at "
                f"{show(star.yaws[found])}: two places with one name?{self._noise(miss, 'the nearest exit is only')}"
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
            if name is not None and name != self.edge_names[d >> 1]:
                raise WalkError(
                    f"the edge known as {self._edge(d)} is now called {quoted(name)}; name an edge at its first traversal"
                )
            return d
        for at, index, yaw, end, verb in (
            (origin, i, leg.out, self.names[u], "leaves"),
            (star, j, leg.back, place, "reaches"),
        ):
            if index == NONE and at.declared:
                raise WalkError(
                    f"the leg {verb} {quoted(end)} at {self.unit.heading(yaw)}, along none of its "
                    f"{counted(len(at.yaws), 'exit')}; exits seen: {self._list(at.yaws)}"
                    f"{self._near_miss(at, yaw, end, verb)}"
                )
        if u == v and abs(remainder(leg.out - leg.back, TAU)) <= 2 * self.tolerance:
            raise AmbiguousDart(
                f"the leg leaves {quoted(place)} and comes back along one direction, {self.unit.heading(leg.out)}: a robot "
                "that turned round, or a loop whose ends cannot be told apart"
            )
        return OPEN

    def travel(self, d: int, leg: Leg) -> bool:
        """Refine the headings and length of a known edge by one more pass, along dart `d`; return whether any changed."""
        heading = self.grown.heading
        means = self._means(d, leg)
        self.passes[d >> 1] += 1
        changed = False
        for dart, new in zip((d, d ^ 1), means, strict=True):
            if new != heading[dart]:
                self.stars[self.grown.tail[dart]].move(heading[dart], new)
                changed = True
        self.grown.refine(d, *means)
        return self._measure(d >> 1, leg) or changed

    def _measure(self, e: int, leg: Leg) -> bool:
        """Count the length that a pass measured, if it did; return whether the mean changed."""
        if leg.metres is None:
            return False
        before, count = self.metres[e], self.measured[e] + 1
        self.measured[e] = count
        self.metres[e] = leg.metres if count == 1 else before + (leg.metres - before) / count
        return self.metres[e] != before

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
            e = grown.extend(u, at_u, len(self.names), leg.out, leg.back, leg.turn)
        else:
            at_v = star.before(leg.back, grown.prev)
            try:
                e = grown.close(u, at_u, v, at_v, leg.out, leg.back, leg.turn)
            except NotPlane as error:
                raise self._explained(error, u, v, at_u, at_v, name, leg) from None
        self.settle(place, star)
        for at, yaw, dart in ((origin, leg.out, 2 * e), (star, leg.back, 2 * e + 1)):
            at.put(at.find(yaw, self.tolerance), yaw, dart)
        self.edge_rows[name] = e
        self.edge_names.append(name)
        self.passes.append(1)
        self.metres.append(nan)
        self.measured.append(0)
        self._measure(e, leg)
        return e, v >= 0

    # -- evidence held against what is known ---------------------------------------------------------------------------

    def _match(self, star: Star, yaw: float, place: str, verb: str) -> int:
        index = star.find(yaw, self.tolerance)
        if index == TIE:
            near = star.near(yaw, 2 * self.tolerance)[:2]
            known = " and ".join(f"{self._direction(star.darts[k])} at {self.unit.heading(star.yaws[k])}" for k in near)
            raise AmbiguousDart(
                f"the leg {verb} {quoted(place)} at {self.unit.heading(yaw)}, too close to {known} to tell whether it is "
                f"the same: headings match within {self.unit.angle(self.tolerance)} and differ from twice that"
            )
        return index

    def _check_known(self, u: int, place: str, v: int, leg: Leg, d: int, b: int) -> None:
        """Hold a leg, of which at least one end is known as dart `d` or `b`, against its edge."""
        tail, heading, origin = self.grown.tail, self.grown.heading, quoted(self.names[u])
        show, there = self.unit.heading, quoted(place)
        if d < 0:
            known = tail[b ^ 1] == u
            other = f"its other end is at {show(heading[b ^ 1])}" if known else "it has no end"
            raise WalkError(
                f"the leg reaches {there} along edge {self._edge(b)}, but left {origin} at {show(leg.out)}, "
                f"where {other}{self._near_dart(b ^ 1, leg.out, 'leaves') if known else ''}"
            )
        name = self._edge(d)
        if tail[d ^ 1] != v:
            raise WalkError(
                f"edge {name} leaves {origin} at {show(leg.out)} and led to {quoted(self.names[tail[d ^ 1]])} before, now "
                f"to {there}: two places with one name, or a wrong heading"
            )
        if b != d ^ 1:
            end = f", the end of edge {self._edge(b)}" if b >= 0 else self._near_dart(d ^ 1, leg.back, "reaches")
            raise WalkError(
                f"edge {name} from {origin} to {there} ended at {show(heading[d ^ 1])} (looking back) before, "
                f"and now at {show(leg.back)}{end}"
            )
        before = self.grown.turn[d >> 1] * (-1 if d & 1 else 1)
        if abs(leg.turn - before) > pi:
            raise WalkError(
                f"edge {name} turned by {self.unit.angle(before)} before and now by {self.unit.angle(leg.turn)}: sampled "
                "too coarsely, or another way"
            )
        if abs(whole_turns(*self._means(d, leg), before)[1]) > FARTHEST_MISS:
            raise WalkError(
                f"the headings of edge {name} have drifted a quarter turn from its first pass; check the compass"
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
                f"edge {quoted(given)} joins {quoted(ends[0])} and {quoted(ends[1])}, and the leg from "
                f"{quoted(self.names[u])} to {quoted(place)} is "
                "another one by its headings; give it a name of its own"
            )
        Names("edge", 1, (given,))
        return given

    # -- words ---------------------------------------------------------------------------------------------------------

    def doubles(self) -> list[str]:
        """Return a sentence on each pair of edges that may be one edge, passed twice with noise above the tolerance.

        They join the same two places and leave both within a few times the tolerance. O(V + E).
        """
        found: dict[str, None] = {}
        tail, heading = self.grown.tail, self.grown.heading
        for v, star in enumerate(self.stars):
            darts = [dart for dart in star.darts if dart >= 0]
            for a, b in pairwise([*darts, darts[0]] if len(darts) > 1 else []):
                w = tail[a ^ 1]
                if a >> 1 == b >> 1 or w != tail[b ^ 1] or w <= v:
                    continue
                miss = max(abs(remainder(heading[x] - heading[y], TAU)) for x, y in ((a, b), (a ^ 1, b ^ 1)))
                hint = self._noise(miss, "where they meet them they are at most", " apart")
                if hint and miss <= THINNEST * self.tolerance:
                    first, second = sorted((a >> 1, b >> 1))
                    sentence = (
                        f"edges {quoted(self.edge_names[first])} and {quoted(self.edge_names[second])} both join "
                        f"{quoted(self.names[v])} and {quoted(self.names[w])}, and may be one edge{hint}"
                    )
                    found[sentence] = None
        return list(found)

    def _near_miss(self, star: Star, yaw: float, place: str, verb: str) -> str:
        """Name the direction at a place that a heading misses by little more than the tolerance, if there is one."""
        if not star.yaws:
            return ""
        k = min(range(len(star.yaws)), key=lambda k: abs(remainder(star.yaws[k] - yaw, TAU)))
        known = "an exit" if star.darts[k] == OPEN else f"known edge {self._edge(star.darts[k])}"
        miss = abs(remainder(star.yaws[k] - yaw, TAU))
        return self._noise(miss, f"{known} {verb} {quoted(place)} only", " from this heading")

    def _near_dart(self, dart: int, yaw: float, verb: str) -> str:
        """Name a known dart that a heading misses by little more than the tolerance, if it does."""
        known = f"known edge {self._edge(dart)} {verb} {quoted(self.names[self.grown.tail[dart]])} only"
        return self._noise(abs(remainder(self.grown.heading[dart] - yaw, TAU)), known, " from this heading")

    def _noise(self, miss: float, words: str, more: str = "") -> str:
        """Say that a miss looks like noise above the tolerance, and what to do; nothing if it is too wide for that."""
        enough = 1.05 * miss
        if not self.tolerance < miss <= FARTHEST_NOISE * self.tolerance or enough >= LARGEST_TOLERANCE:
            return ""
        return f"; {words} {self.unit.angle(miss)}{more}: raise --tolerance (radians) to {enough:.2g}"

    def _list(self, yaws: list[float]) -> str:
        return f"{self.unit.headings(yaws)} {self.unit.measure}" if yaws else "none"

    def _edge(self, dart: int) -> str:
        return quoted(self.edge_names[dart >> 1])

    def _direction(self, dart: int) -> str:
        return "an exit" if dart == OPEN else f"edge {self._edge(dart)}"

    def _explained(self, error: NotPlane, u: int, v: int, at_u: int, at_v: int, name: str, leg: Leg) -> NotPlane:
        """Say which leg could not be drawn, and for a genus show a shortest offending part. O(E) and its search."""
        what = f"the leg from {quoted(self.names[u])} to {quoted(self.names[v])} cannot be drawn: {error}"
        edges: tuple[str, ...] = ()
        if error.genus:
            edges = self._offending_part(u, v, at_u, at_v, name)
            part = shortened(", ".join(edges), 200)
            what += f", and the map would have genus {error.genus}; a shortest offending part is the edges {part}"
        what += self._near_miss(self.stars[u], leg.out, self.names[u], "leaves")
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
