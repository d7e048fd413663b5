"""The maps of two robots that walked in one space, laid over each other and made one.

Both recognise their own places, and neither knows the other's. From a place that both know, the two maps are walked
together: an exit that both have walked leads both to one place. So one shared place decides all that hangs together with it,
and what contradicts is named. An exit that one has walked and the other left open is walked in the whole map.

Where no shared place is given, every pair of places is tried, and all overlaps that contradict nothing and leave a plane map
are returned, the largest first; which of them is true the maps do not say.
"""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING

from ninefold._wording import quoted
from ninefold.errors import BadInput, MapsDisagree, NotPlane, UnknownName

from ..heading import wrap
from ..robot.open_map import OPEN, OpenMap, named
from ..robot.units import unit_of
from ..robot.walk import DEFAULT_TOLERANCE, checked_tolerance
from .opening import open_map

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from ..plane import PlaneMap
    from ..robot.walk import Walk
    from .hypotheses import Hypothesis

__all__ = ["Merged", "Overlaps", "merge", "overlaps"]

TRIALS = 5_000
"""Combinations of pieces tried by `overlaps`, if nothing else is asked for."""

_DEGREES = unit_of("yaw-deg")


@dataclass(frozen=True, slots=True, eq=False)
class Merged:
    """Two maps made one.

    Attributes
    ----------
    known
        The whole, with the exits that neither robot has walked.
    plane
        What at least one of them has walked, as a plane map.
    shared
        The places both know: name in the first map, name in the second.
    ways
        How many ways both have walked.
    names
        For every name in the second map, the name in the whole: of a shared place the first map's, of others their own, with
        an apostrophe if the first map has a place of that name.
    """

    known: OpenMap = field(repr=False)
    plane: PlaneMap
    shared: tuple[tuple[str, str], ...]
    ways: int
    names: Mapping[str, str] = field(repr=False)


@dataclass(frozen=True, slots=True, eq=False)
class Overlaps:
    """All ways in which two maps can overlap; made by `overlaps`.

    Attributes
    ----------
    found
        The whole maps, those with most shared places first, then most shared ways.
    exact
        Whether these are all.
    """

    found: tuple[Merged, ...]
    exact: bool

    def __len__(self) -> int:
        return len(self.found)

    def __iter__(self) -> Iterator[Merged]:
        return iter(self.found)


def merge(
    first: OpenMap | Walk | PlaneMap | Hypothesis,
    second: OpenMap | Walk | PlaneMap | Hypothesis,
    *,
    at: tuple[str, str] | None = None,
    way: tuple[tuple[str, str], tuple[str, str]] | None = None,
    same_names: bool = False,
    tolerance: float = DEFAULT_TOLERANCE,
) -> Merged:
    """Make one map of two that share a place.

    Parameters
    ----------
    first, second
        A walk that names its places and lists their exits, or an open map or hypothesis of one. Or a plane map: it does not
        know exits that nobody walked, so that the other may have more.
    at
        Name of a shared place in the first map, and in the second.
    way
        A shared way: the places from and to in the first map, and in the second. It tells what a place alone does not where
        a map has no compass and the exits of the place look the same after a turn.
    same_names
        Whether a name that both have is one place.
    tolerance
        Radians within which two headings may be of one exit: less than half the angle between any two exits of a place.

    Raises
    ------
    MapsDisagree
        If the two cannot be laid over each other so: with the places and exits that contradict.
    NotPlane
        If they can, and the whole is no plane map: then they share more than that, and `overlaps` tells what it may be.
    BadInput, UnknownName
        For a shared place that is none, or nothing given to share; a walk that leaves its own map open.

    Notes
    -----
    What does not hang together with what is given is taken for different: places that both know elsewhere are there twice
    unless `overlaps` finds them. Complexity O(V + E) of both.

    Examples
    --------
    >>> from ninefold.mapping import SimulatedWorld, explore
    >>> square = SimulatedWorld([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)], vertex_names="abcd")
    >>> other = SimulatedWorld([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0)], vertex_names="stuv")
    >>> whole = merge(explore(square).walk, explore(other).walk, at=("a", "s"))
    >>> whole.plane, whole.shared
    (PlaneMap(4 vertices, 4 edges, 2 faces), (('a', 's'), ('b', 't'), ('c', 'u'), ('d', 'v')))
    """
    pair = _Pair(open_map(first), open_map(second), checked_tolerance(tolerance))
    given = pair.given(at, way, same_names=same_names)
    if not given:
        raise BadInput("the two maps have nothing given in common: give at=, way= or same_names=True, or ask overlaps()")
    wholes: list[Merged] = []
    wrong: list[BadInput] = []
    for anchors in given:
        try:
            wholes.append(pair.merged(pair.lay(anchors)))
        except (MapsDisagree, NotPlane) as error:
            wrong.append(error)
    if not wholes:
        raise wrong[0]
    if len(wholes) > 1:
        raise BadInput(f"the shared place can be turned in {len(wholes)} ways; say with way= which way is shared")
    return wholes[0]


def overlaps(
    first: OpenMap | Walk | PlaneMap | Hypothesis,
    second: OpenMap | Walk | PlaneMap | Hypothesis,
    *,
    at: tuple[str, str] | None = None,
    way: tuple[tuple[str, str], tuple[str, str]] | None = None,
    same_names: bool = False,
    least: int = 2,
    tolerance: float = DEFAULT_TOLERANCE,
    trials: int = TRIALS,
) -> Overlaps:
    """Find every way in which two maps can overlap.

    Parameters
    ----------
    first, second, tolerance
        As for `merge`.
    at, way, same_names
        What is known to be shared, as for `merge`; nothing need be.
    least
        Places that a piece of an overlap has at least. A piece is all that one shared place decides; with one place alone
        the two robots walked no way in common there, and little speaks for it.
    trials
        Combinations of pieces tried at most.

    Returns
    -------
    Overlaps
        Those that no further piece can be added to. None if the two maps contradict each other wherever they are laid. A
        piece may agree by chance: where the maps are small or look alike, so do overlaps of more pieces than are true.

    Raises
    ------
    BadInput
        As `merge` does for maps, and for numbers that are none.

    Notes
    -----
    Every pair of places is tried, which takes O(V squared), and on large maps mostly ends at the first look.
    """
    for what, value in (("least", least), ("trials", trials)):
        if isinstance(value, bool) or not isinstance(value, int) or value < 1:
            raise BadInput(f"{what} is a whole number, 1 or more, not {quoted(value)}")
    pair = _Pair(open_map(first), open_map(second), checked_tolerance(tolerance))
    pieces = [piece for piece in pair.pieces() if len(piece.place) >= least]
    pieces.sort(key=lambda piece: -len(piece.place))
    wholes: dict[tuple[int, frozenset[int]], Merged] = {}
    tried = 0
    pending: list[tuple[int, tuple[int, ...], _Laid]] = []
    given = pair.given(at, way, same_names=same_names)
    for base, anchors in enumerate(given):
        with suppress(MapsDisagree):
            pending.append((base, (), pair.lay(anchors)))
    if not given:
        pending = [(0, (k,), piece) for k, piece in reversed(list(enumerate(pieces)))]
    while pending and tried < trials:
        base, held, laid = pending.pop()
        tried += 1
        with suppress(NotPlane, MapsDisagree):  # it may become plane with one piece more, where the two maps cross
            wholes[base, frozenset(held)] = pair.merged(laid)
        for k in range(len(pieces) - 1, held[-1] if held else -1, -1):
            if _disjoint(laid, pieces[k]):
                with suppress(MapsDisagree):
                    pending.append((base, (*held, k), pair.lay([*laid.anchors, *pieces[k].anchors])))
    found = [
        whole for (base, held), whole in wholes.items() if not any(base == other and held < more for other, more in wholes)
    ]
    found.sort(key=lambda one: (-len(one.shared), -one.ways, one.shared))
    return Overlaps(tuple(found), exact=not pending)


@dataclass(frozen=True, slots=True)
class _Laid:
    """The second map laid over the first: its places and exits, and those of the first they are."""

    anchors: tuple[tuple[int, int, float], ...]
    place: dict[int, int]
    turned: dict[int, float]
    exit: dict[int, int]


def _disjoint(one: _Laid, other: _Laid) -> bool:
    return not (one.place.keys() & other.place.keys() or set(one.place.values()) & set(other.place.values()))


class _Pair:
    """Two maps that may overlap."""

    def __init__(self, a: OpenMap, b: OpenMap, tolerance: float) -> None:
        self.a, self.b, self.tolerance = a, b, tolerance + 1e-9
        self.compass = a.compass and b.compass

    def given(
        self, at: tuple[str, str] | None, way: tuple[tuple[str, str], tuple[str, str]] | None, *, same_names: bool
    ) -> list[list[tuple[int, int, float]]]:
        """Return what is given as shared, once for every turning that it leaves open; nothing if nothing is given."""
        anchors: list[tuple[int, int, float]] = []
        if way is not None:
            anchors.append(self.of_way(way))
        if same_names:
            ours, theirs = named(self.a), named(self.b)
            anchors += [self.by_name(ours[name], theirs[name]) for name in ours if name in theirs]
        if at is None:
            return [anchors] if anchors else []
        p, q = _place(self.a, at[0]), _place(self.b, at[1])
        turnings = self.turnings(p, q)
        if not turnings:
            raise MapsDisagree(f"{quoted(at[0])} and {quoted(at[1])} cannot be one place: {self.stars(p, q)}")
        return [[*anchors, (p, q, turning)] for turning in turnings]

    def of_way(self, way: tuple[tuple[str, str], tuple[str, str]]) -> tuple[int, int, float]:
        """Return the anchor that a shared way is: place, place, and by how much the second's headings are turned."""
        (here, there), (start, end) = way
        x, y = _exit(self.a, here, there), _exit(self.b, start, end)
        turning = wrap(self.a.heading[x] - self.b.heading[y])
        if self.compass and abs(turning) > self.tolerance:
            raise MapsDisagree(
                f"the way from {quoted(here)} to {quoted(there)} leaves at {_DEGREES.heading(self.a.heading[x])}, and that "
                f"from {quoted(start)} to {quoted(end)} at {_DEGREES.heading(self.b.heading[y])}"
            )
        return self.a.place[x], self.b.place[y], 0.0 if self.compass else turning

    def by_name(self, p: int, q: int) -> tuple[int, int, float]:
        """Return the anchor that two places of one name are."""
        turnings = self.turnings(p, q)
        if not turnings:
            raise MapsDisagree(f"{quoted(self.a.name(p))} cannot be the same place in both: {self.stars(p, q)}")
        if len(turnings) > 1:
            raise BadInput(
                f"the exits of {quoted(self.a.name(p))} look alike after a turn; say with way= which way is shared"
            )
        return p, q, turnings[0]

    def turnings(self, p: int, q: int) -> list[float]:
        """Return by how much the headings of the second's place can be turned against those of the first's."""
        if self.compass:
            return [0.0] if self._matched(p, q, 0.0) is not None else []
        found: list[float] = []
        for y in self.b.exits(q):
            for x in self.a.exits(p):
                turning = wrap(self.a.heading[x] - self.b.heading[y])
                if (
                    all(abs(wrap(turning - one)) > self.tolerance for one in found)
                    and self._matched(p, q, turning) is not None
                ):
                    found.append(turning)
            if self.a.complete:  # this exit is one of the first's, so all turnings were tried
                break
        return found or ([0.0] if not len(self.a.exits(p)) and not len(self.b.exits(q)) else [])

    def _matched(self, p: int, q: int, turning: float) -> dict[int, int] | None:
        """Return which exit of the first's place each exit of the second's is, or None if the two cannot be one place."""
        ours, theirs = self.a.exits(p), self.b.exits(q)
        if self.a.complete and self.b.complete and len(ours) != len(theirs):
            return None
        found: dict[int, int] = {}
        for y in theirs:
            yaw = self.b.heading[y] + turning
            x = min(ours, key=lambda one: abs(wrap(yaw - self.a.heading[one])), default=OPEN)
            if x != OPEN and abs(wrap(yaw - self.a.heading[x])) <= self.tolerance:
                if x in found.values():
                    return None
                found[y] = x
            elif self.a.complete:
                return None
        if self.b.complete and len(found) < len(ours):
            return None
        return found

    def stars(self, p: int, q: int) -> str:
        """Say how the exits of two places differ."""
        ours = [self.a.heading[x] for x in self.a.exits(p)]
        theirs = [self.b.heading[y] for y in self.b.exits(q)]
        return f"the exits lie at {_DEGREES.headings(ours)} and at {_DEGREES.headings(theirs)}"

    def lay(self, anchors: Iterable[tuple[int, int, float]]) -> _Laid:
        """Walk both maps together from shared places.

        Raises
        ------
        MapsDisagree
            At the first contradiction.
        """
        a, b = self.a, self.b
        queue = list(anchors)
        laid = _Laid(tuple(queue), {}, {}, {})
        held: dict[int, int] = {}  # place of the second by that of the first
        for p, q, turning in queue:
            if q in laid.place or p in held:
                if laid.place.get(q) != p:
                    before = laid.place.get(q, p), held.get(p, q)
                    raise MapsDisagree(
                        f"{quoted(b.name(q))} of the second map would be {quoted(a.name(p))} of the first, and so would "
                        f"{quoted(b.name(before[1]))}"
                        if before[0] == p
                        else f"{quoted(b.name(q))} of the second map would be both {quoted(a.name(before[0]))} and "
                        f"{quoted(a.name(p))} of the first"
                    )
                if abs(wrap(turning - laid.turned[q])) > 4 * self.tolerance:
                    raise MapsDisagree(
                        f"{quoted(b.name(q))} of the second map would be {quoted(a.name(p))} of the first turned in two ways"
                    )
                continue
            matched = self._matched(p, q, turning)
            if matched is None:
                raise MapsDisagree(
                    f"{quoted(b.name(q))} of the second map would be {quoted(a.name(p))} of the first, and cannot: "
                    f"{self.stars(p, q)}"
                )
            laid.place[q], held[p], laid.turned[q] = p, q, turning
            laid.exit.update(matched)
            for y, x in matched.items():
                u, v = a.mate[x], b.mate[y]
                if u == OPEN or v == OPEN:
                    continue
                if abs(a.turn[x] - b.turn[y]) > 4 * self.tolerance:
                    raise MapsDisagree(
                        f"the way that leaves {quoted(a.name(p))} at {_DEGREES.heading(a.heading[x])} turns "
                        f"{_DEGREES.angle(a.turn[x])} in the first map and {_DEGREES.angle(b.turn[y])} in the second"
                    )
                carried = 0.0 if self.compass else wrap(a.heading[u] - b.heading[v])
                queue.append((a.place[u], b.place[v], carried))
        for y, x in laid.exit.items():
            u, v = a.mate[x], b.mate[y]
            if u != OPEN and v != OPEN and laid.exit.get(v) != u:
                raise MapsDisagree(
                    f"the way that leaves {quoted(a.name(a.place[x]))} at {_DEGREES.heading(a.heading[x])} arrives at "
                    f"{quoted(a.name(a.place[u]))} by one exit in the first map and by another in the second"
                )
        return laid

    def pieces(self) -> list[_Laid]:
        """Return every overlap that one shared place decides, without contradiction."""
        found: list[_Laid] = []
        covered: dict[tuple[int, int], list[float]] = {}
        for p in range(self.a.n_places):
            for q in range(self.b.n_places):
                for turning in self.turnings(p, q):
                    if any(abs(wrap(turning - one)) <= 4 * self.tolerance for one in covered.get((p, q), ())):
                        continue
                    try:
                        laid = self.lay([(p, q, turning)])
                    except MapsDisagree:
                        continue
                    found.append(laid)
                    for other, own in laid.place.items():
                        covered.setdefault((own, other), []).append(laid.turned[other])
        return found

    def merged(self, laid: _Laid) -> Merged:
        """Return the two maps made one.

        Raises
        ------
        MapsDisagree
            If exits that meet lead to different places.
        NotPlane
            If the whole is none.
        """
        a, b = self.a, self.b
        whole = OpenMap(compass=self.compass, complete=a.complete and b.complete)
        held = {p: q for q, p in laid.place.items()}
        taken = {name for name in a.names if name is not None}
        ours: dict[int, int] = {}
        theirs: dict[int, int] = {}
        names: dict[str, str] = {}
        for p in range(a.n_places):
            stars = [(a.heading[x], x, OPEN) for x in a.exits(p)]
            q = held.get(p)
            if q is not None:
                names[b.name(q)] = a.name(p)
                turned = laid.turned[q]
                stars += [(wrap(b.heading[y] + turned), OPEN, y) for y in b.exits(q) if y not in laid.exit]
            _seen(whole, stars, a.name(p), ours, theirs)
        for y, x in laid.exit.items():
            theirs[y] = ours[x]
        for q in range(b.n_places):
            if q not in laid.place:
                name = b.name(q)
                while name in taken:
                    name += "'"
                taken.add(name)
                names[b.name(q)] = name
                _seen(whole, [(b.heading[y], OPEN, y) for y in b.exits(q)], name, ours, theirs)
        for source, exits in ((a, ours), (b, theirs)):
            for out, back in enumerate(source.mate):
                if out < back:
                    one, other = exits[out], exits[back]
                    if whole.mate[one] not in (OPEN, other) or whole.mate[other] not in (OPEN, one):
                        if whole.mate[one] in (OPEN, other):
                            one, other = other, one
                        place = whole.name(whole.place[one])
                        raise MapsDisagree(
                            f"the exit of {quoted(place)} at {_DEGREES.heading(whole.heading[one])} leads to "
                            f"{quoted(whole.name(whole.place[whole.mate[one]]))} in the first map and to "
                            f"{quoted(whole.name(whole.place[other]))} in the second"
                        )
                    whole.join(one, other, source.turn[out])
        plane, _ = whole.to_plane()
        ways = sum(a.mate[x] != OPEN and b.mate[y] != OPEN and y < b.mate[y] for y, x in laid.exit.items())
        shared = sorted((a.name(p), b.name(q)) for q, p in laid.place.items())
        return Merged(whole, plane, tuple(shared), ways, MappingProxyType(names))


def _seen(
    whole: OpenMap, stars: list[tuple[float, int, int]], name: str, ours: dict[int, int], theirs: dict[int, int]
) -> None:
    """Add a place to the whole, and note which of its exits are whose."""
    stars.sort()
    start = whole.first[-1]
    whole.see([yaw for yaw, _, _ in stars], name)
    for k, (_, x, y) in enumerate(stars):
        if x != OPEN:
            ours[x] = start + k
        if y != OPEN:
            theirs[y] = start + k


def _place(known: OpenMap, name: str) -> int:
    """Return the place of a name."""
    places = {known.name(place): place for place in range(known.n_places)}
    if name not in places:
        raise UnknownName("place", str(name), places)
    return places[name]


def _exit(known: OpenMap, here: str, there: str) -> int:
    """Return the exit of the one way from a place to another."""
    p, q = _place(known, here), _place(known, there)
    ways = [out for out in known.exits(p) if known.mate[out] != OPEN and known.place[known.mate[out]] == q]
    if len(ways) != 1:
        raise BadInput(f"{len(ways) or 'no'} ways lead from {quoted(here)} to {quoted(there)}; give one that does alone")
    return ways[0]
