"""Every plane map that explains a walk through places that look alike.

A hypothesis is a quotient of the walk's visits: same places merged, each exit used by one way, congruent along the exits
walked. It is legal when every face of the walked part turns +1 and exactly one -1, as `PlaneMap` demands. It is closed when
no exit is left untravelled. See `walk_tree` for how a walk is folded, and `quotients` for the search.

With a compass a face turns a whole number of times, whichever visits' headings its corners are read from. Without one the
corners and legs of a face add up to a whole turn only nearly, and agreement within a tolerance is not transitive. So it is
fixed what is held against what. Lists of exits, and legs along one way, are compared in pairs: any two visits of a place
(one for all that folding makes the same) have headings that some turn of the one list brings within the tolerance of the
other, and any two legs have net turns within twice the tolerance, a leg being two readings. A face is measured with the
exits of the first visit of each of its places and the first leg along each of its ways; it turns +1 or -1 if that is so
within the tolerance for every corner and leg, and by less than half a turn. Nothing of this depends on where a search
begins.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import log2
from time import monotonic
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

from ..plane import PlaneMap
from ..robot.walk import Walk
from ..turning import settle_turns
from .backbone import Backbone, backbone_of
from .completeness import Completeness, completeness
from .likeness import Likeness, likeness
from .quotient_portfolio import closed_maps
from .quotients import QuotientSearch
from .stretches import smallest_stretch
from .walk_tree import Contradiction, WalkTree, fold
from .why_not import WhyNot, why_not

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from numpy.typing import NDArray

__all__ = ["Hypotheses", "Hypothesis", "hypotheses"]

KEPT = 10_000
"""Maps kept of those that are counted, if nothing else is asked for."""

BUDGET = 60.0
"""Seconds that a search may take, if nothing else is asked for."""


@dataclass(frozen=True, slots=True, eq=False)
class Hypothesis:
    """One way in which visits are the same places.

    Attributes
    ----------
    tree
        The folded walk.
    place
        (N,) int64, the place of every node, numbered in the order of their first visits.
    shift
        (N,) int64: exit x of a node is exit x + shift of its place, whose exits are those of its first node.
    closed
        Whether no exit is left untravelled.
    """

    tree: WalkTree = field(repr=False)
    place: NDArray[np.int64] = field(repr=False)
    shift: NDArray[np.int64] = field(repr=False)
    closed: bool

    @property
    def n_places(self) -> int:
        """Number of places."""
        return int(self.place.max()) + 1

    @property
    def visits(self) -> NDArray[np.int64]:
        """The place of every visit, (T,) int64."""
        return np.asarray(self.place[self.tree.node_of])

    @property
    def plane(self) -> PlaneMap:
        """The map: places called ``p0``, ``p1``, ... unless the walk names them; checked as every map is. O(E)."""
        return plane_of(self.tree, self.place, self.shift)


@dataclass(frozen=True, slots=True, eq=False)
class Hypotheses:
    """The maps that explain a walk; made by `hypotheses`.

    Attributes
    ----------
    tree
        The folded walk.
    maps
        Those kept, ranked: closed before open, fewest places first.
    count
        Number of maps found.
    exact
        Whether the search came to its end, so that `count` is their number.
    contradiction
        Why no map explains the walk, if that shows in a stretch of it: the smallest such.
    seconds
        What the search took.
    closed, max_places
        Which maps were asked for.
    """

    tree: WalkTree = field(repr=False)
    alike: Likeness = field(repr=False)
    maps: tuple[Hypothesis, ...] = field(repr=False)
    count: int
    exact: bool
    contradiction: Contradiction | None
    seconds: float
    closed: bool | None = None
    max_places: int | None = None

    def __len__(self) -> int:
        return len(self.maps)

    def __iter__(self) -> Iterator[Hypothesis]:
        return iter(self.maps)

    @property
    def ambiguity(self) -> float | None:
        """Bits that the walk leaves open: the logarithm to base 2 of the number of maps; None where it is not known."""
        return log2(self.count) if self.exact and self.count else None

    def backbone(self, *, budget: float = 10.0) -> Backbone | None:
        """Return what all maps agree on, also where they are too many to list; None if there is no map.

        Parameters
        ----------
        budget
            Seconds that a solver may be asked for, where not all maps are kept.

        Examples
        --------
        >>> from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader, hypotheses
        >>> north, south = Heading.from_degrees(90), Heading.from_degrees(270)
        >>> place, leg = Visit(None, exits=(north, south)), Samples.of(north, north)
        >>> back = Samples.of(south, south)
        >>> found = hypotheses(Walk(WalkHeader(), (place, leg, place, leg, place, back, place))).backbone()
        >>> found.known(1, 3), found.known(0, 2), found.open.shape
        (True, False, (0, 2))
        """
        complete = self.exact and len(self.maps) == self.count
        return backbone_of(
            self.tree,
            self.alike,
            [one.place for one in self.maps],
            complete=complete,
            closed=self.closed is True,
            narrowed=self.max_places is not None or self.closed is False,
            budget=budget,
        )

    def evidence(self, *, budget: float | None = None) -> Completeness:
        """Return evidence, for programs that are not ours, that the maps are all that explain the walk.

        Parameters
        ----------
        budget
            Seconds, 600 if left out.

        Raises
        ------
        BadInput
            Where there is none to give: the count is not exact, not all maps were kept, or only some were asked for.
        TooLarge
            When the budget is spent.
        """
        if not self.exact or len(self.maps) != self.count:
            raise BadInput("only an exact count of maps that are all kept has evidence; give a larger budget or limit")
        if self.contradiction is not None or self.max_places is not None or self.closed is False:
            raise BadInput(
                "evidence is about all maps, or all closed ones, of a walk that does not contradict itself: leave out "
                "max_places, and let closed be None or True"
            )
        maps = [np.stack([one.place, one.shift], axis=1) for one in self.maps]
        return completeness(self.tree, self.alike, maps, closed=self.closed is True, budget=budget)

    def why_not(self, i: int, j: int, *, budget: float = 10.0) -> WhyNot | None:
        """Return why two visits, counted from 0, are the same place in none of the maps; None if they are in one.

        Parameters
        ----------
        budget
            Seconds for a search, where neither a plain reason nor the maps listed tell.

        Raises
        ------
        BadInput
            For visits that the walk does not have.
        """
        return why_not(self, i, j, budget=budget)


def hypotheses(
    walk: Walk,
    *,
    closed: bool | None = None,
    max_places: int | None = None,
    limit: int | None = None,
    budget: float | None = None,
    tolerance: float | None = None,
    same: Iterable[tuple[int, int]] = (),
    differ: Iterable[tuple[int, int]] = (),
    report: Callable[[int], object] | None = None,
) -> Hypotheses:
    """Find every plane map that explains a walk.

    Parameters
    ----------
    walk
        Every visit lists its exits. Places that are recognised have names: the same name is the same place, another name
        another place. Without a compass (the header says so) exits and legs are read against each other.
    closed
        True for maps in which no exit is left untravelled, False for those that leave some, None for all.
    max_places
        Places of a map at most.
    limit
        Maps to keep at most, 10,000 if left out; all are counted.
    budget
        Seconds, 60 if left out. What is known when they are spent is returned, marked as not exact.
    tolerance
        Radians within which two headings may be of one exit, instead of the header's.
    same, differ
        Pairs of visits, counted from 0, that are known to be one place, or two.
    report
        Called with the number of maps found so far, now and then.

    Raises
    ------
    WalkError, BadInput
        As `fold` does; for pairs that name no visits, or numbers that are none.
    """
    if not isinstance(walk, Walk):
        raise BadInput(f"hypotheses explain a Walk, such as read_walk gives, not {quoted(walk)}")
    begun = monotonic()
    until = begun + (BUDGET if budget is None else budget)
    tree = fold(walk, tolerance=tolerance)
    if tree.contradiction is not None:
        shown = smallest_stretch(walk, tolerance=tolerance, until=until) or tree.contradiction
        return Hypotheses(tree, likeness(tree), (), 0, True, shown, monotonic() - begun, closed, max_places)
    same, differ, told = tuple(same), tuple(differ), report or (lambda _: None)
    alike = likeness(tree, same=_nodes(tree, same), differ=_nodes(tree, differ))
    most = KEPT if limit is None else limit
    found: list[Hypothesis] = []
    count, exact = 0, True
    if closed is not False:
        count, exact = _closed_maps(tree, alike, found, most, max_places, until, told)
    if closed is not True:
        shut = count if closed is None else 0
        number, whole = _open_maps(tree, alike, found, most, max_places, until, told, closed=shut)
        count, exact = count + number, exact and whole
    found.sort(key=_rank)
    wrong: Contradiction | None = None
    if exact and not count:
        wrong = smallest_stretch(walk, tolerance=tolerance, max_places=max_places, same=same, differ=differ, until=until)
    return Hypotheses(tree, alike, tuple(found[:most]), count, exact, wrong, monotonic() - begun, closed, max_places)


def _rank(one: Hypothesis) -> tuple[bool, int, list[int]]:
    """Return what maps are ranked by: closed before open, fewest places first."""
    return not one.closed, one.n_places, one.place.tolist()


def _nodes(tree: WalkTree, visits: Iterable[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return pairs of visits as pairs of nodes."""
    pairs = []
    for a, b in visits:
        if not (0 <= a < tree.n_visits and 0 <= b < tree.n_visits):
            raise BadInput(f"visits are numbered 0 to {tree.n_visits - 1}; there is no pair {a}, {b}")
        pairs.append((int(tree.node_of[a]), int(tree.node_of[b])))
    return pairs


def _closed_maps(
    tree: WalkTree,
    alike: Likeness,
    found: list[Hypothesis],
    most: int,
    max_places: int | None,
    until: float,
    report: Callable[[int], object],
) -> tuple[int, bool]:
    """Find the closed maps; return (count, whether all)."""
    outcome = closed_maps(tree, alike, until=until, most=most, most_places=max_places, report=report)
    found += [hypothesis_of(tree, places[:, 0], places[:, 1]) for places in outcome.maps]
    return outcome.found, outcome.exact


def _open_maps(
    tree: WalkTree,
    alike: Likeness,
    found: list[Hypothesis],
    most: int,
    max_places: int | None,
    until: float,
    report: Callable[[int], object],
    *,
    closed: int,
) -> tuple[int, bool]:
    """Find the maps that leave exits untravelled; return (count, whether all). The closed ones among all are left out."""
    search = QuotientSearch(tree, alike, most_places=max_places)
    number = 0
    while not search.done:
        for places in search.more(4096):
            one = hypothesis_of(tree, places[:, 0], places[:, 1])
            if not one.closed:
                number += 1
                found.append(one)
                if len(found) > 2 * most + closed + 1000:
                    found.sort(key=_rank)
                    del found[max(most, closed) :]
        report(closed + number)
        if monotonic() > until:
            return number, False
    return number, True


def hypothesis_of(tree: WalkTree, raw: NDArray[np.int64], shift: NDArray[np.int64]) -> Hypothesis:
    """Return a quotient with places in the order of their first visits and the exits of their first nodes.

    Parameters
    ----------
    raw, shift
        (N,) int64 the place of every node, numbered in any way, and its shift against any node of that place.
    """
    _, first, place = np.unique(raw, return_index=True, return_inverse=True)
    rank = np.empty(first.size, np.int64)
    rank[np.argsort(first, kind="stable")] = np.arange(first.size)
    place = rank[place]
    lead = np.sort(first)
    relative = (shift - shift[lead[place]]) % np.maximum(tree.degree, 1)
    return Hypothesis(tree, place, relative, closed=is_closed(tree, place, relative))


def is_closed(tree: WalkTree, place: NDArray[np.int64], shift: NDArray[np.int64]) -> bool:
    """Whether a quotient leaves no exit untravelled."""
    width = tree.heading.shape[1]
    n, x = np.nonzero(tree.other >= 0)
    used = np.unique(place[n] * width + (x + shift[n]) % tree.degree[n])
    lead = np.unique(place, return_index=True)[1]
    return used.size == int(tree.degree[lead].sum())


def plane_of(tree: WalkTree, place: NDArray[np.int64], shift: NDArray[np.int64]) -> PlaneMap:
    """Return the plane map of a quotient, from the headings of the first node of every place.

    Raises
    ------
    NotPlane
        If it is none: then it is no legal hypothesis.
    """
    width = tree.heading.shape[1]
    lead = np.unique(place, return_index=True)[1]
    n, x = np.nonzero(tree.other >= 0)
    m, y = tree.other[n, x], tree.back[n, x]
    here = place[n] * width + (x + shift[n]) % tree.degree[n]
    there = place[m] * width + (y + shift[m]) % tree.degree[m]
    first_time = n < m
    pairs = np.unique(np.stack([here, there], axis=1)[first_time], axis=0, return_index=True)
    edges, row = pairs
    both = np.sort(edges, axis=1)
    _, once = np.unique(both, axis=0, return_index=True)
    order = np.sort(row[once])
    a, b = here[first_time][order], there[first_time][order]
    turn = tree.turn[n, x][first_time][order]
    darts = np.stack([a, b], axis=1).reshape(-1)
    tail = (darts // width).astype(np.int32)
    number = np.full(lead.size * width, -1, np.int64)
    number[darts] = np.arange(darts.size)
    after = np.empty(darts.size, np.int32)
    heading = tree.heading[lead].reshape(-1)[darts]
    for d, dart in enumerate(darts.tolist()):
        w, e = divmod(dart, width)
        degree = int(tree.degree[lead[w]])
        after[d] = next(
            number[w * width + (e + k) % degree] for k in range(1, degree + 1) if number[w * width + (e + k) % degree] >= 0
        )
    if not tree.compass:
        heading = _common_frame(heading, turn, tail)
    names = [f"p{w}" for w in range(lead.size)]
    for node, name in enumerate(tree.names):
        if name is not None:
            names[int(place[node])] = name
    return PlaneMap.from_darts(
        tail, after, n_vertices=lead.size, heading=heading, turn=settle_turns(heading, turn), vertex_names=names
    )


def _common_frame(heading: NDArray[np.float64], turn: NDArray[np.float64], tail: NDArray[np.int32]) -> NDArray[np.float64]:
    """Return headings of a walk without a compass in the frame of the first place, carried along a spanning tree."""
    frame: dict[int, float] = {int(tail[0]): 0.0} if tail.size else {}
    beside: dict[int, list[int]] = {}
    for dart, v in enumerate(tail.tolist()):
        beside.setdefault(v, []).append(dart)
    queue = list(frame)
    for v in queue:
        for dart in beside[v]:
            w = int(tail[dart ^ 1])
            if w not in frame:
                along = turn[dart >> 1] if dart % 2 == 0 else -turn[dart >> 1]
                frame[w] = frame[v] + heading[dart] + np.pi + along - heading[dart ^ 1]
                queue.append(w)
    return heading + np.array([frame[int(v)] for v in tail], np.float64)
