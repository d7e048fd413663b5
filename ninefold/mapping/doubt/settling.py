"""What genus and turning leave of the open orders, searched exactly and locally.

**Core.** Dead ends, and what hangs by one edge beyond the cycles, never make a map illegal, so alternatives that differ in
nothing but them are judged once: the rest, the 2-core, is what can be.

**Propagation.** Of every open place, some edges are loose: without them its order is certain. An alternative of one place
that is illegal on the part without the loose edges of all other open places is illegal in every map, and falls.

**Groups.** The certain part, which is the core without all loose edges, has certain faces. Alternatives of two places can
only matter to each other if they touch a common face of it. So the open places fall into groups, and what is legal in every
group is legal in the whole: each edge put back lies in faces of its own group, and Euler's formula and the turning of a face
count there alone.

**Search.** Within a group the alternatives are tried place by place, the likeliest first, each beginning judged with the
edges that are loose at the places still to come left out. The maps of all groups together are their product.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass, field
from itertools import chain, count, pairwise, product
from math import prod
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..checks import face_labels, face_permutation
from ..heading import TAU

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from .legality import Arrangement

__all__ = ["Choice", "Factor", "Settled", "Star", "settle"]

MOST_COUNTED = 100_000
"""Maps of one group up to which overlapping alternatives are counted one by one."""


class Star(NamedTuple):
    """One order of the darts around a place.

    Attributes
    ----------
    darts
        Counter-clockwise, from the lowest.
    corners
        Angle from each to the next, radians.
    cost
        Minus the logarithm of its likelihood, but for a constant.
    number
        Which of the orders given for the place it is.
    """

    darts: tuple[int, ...]
    corners: tuple[float, ...]
    cost: float
    number: int


class Choice(NamedTuple):
    """A part of a map: the number of the order at every place, and of the net rotation at every edge, that it settles."""

    cost: float
    orders: tuple[tuple[int, int], ...]
    turns: tuple[tuple[int, int], ...]
    outer: tuple[int, ...]


@dataclass(slots=True)
class _Kind:
    """Alternatives of one variable that are the same on the core."""

    star: Star | None
    turn: float
    cost: float
    members: list[Star]
    number: int = 0
    order: tuple[int, ...] = ()


@dataclass(slots=True)
class _Variable:
    """What is open: the order around a place, or the whole turns of an edge."""

    place: int
    edge: int
    kinds: list[_Kind]
    loose: list[int] = field(default_factory=list)
    shown: _Kind | None = None

    def put(self, arrangement: Arrangement, kind: _Kind) -> None:
        if kind is self.shown:
            return
        self.shown = kind
        if kind.star is None:
            arrangement.turn[self.edge] = kind.turn
        else:
            arrangement.put(kind.star.darts, kind.star.corners)


@dataclass(slots=True)
class Factor:
    """An independent part of all maps: its choices, the likeliest first, made as they are asked for.

    Attributes
    ----------
    places
        Where more than one order was open when the search began.
    count
        Number of choices that make different maps, None where the search was stopped.
    outer
        The most outer faces that choices of one and the same rotation have: which of two corners is the wide one, or how
        often a way turns round, may be open where no order is.
    """

    places: tuple[int, ...]
    count: int | None
    outer: int
    _source: Iterator[Choice]
    _made: list[Choice] = field(default_factory=list)

    def get(self, number: int) -> Choice | None:
        """Return a choice by its number, or None if there are fewer."""
        while len(self._made) <= number:
            found = next(self._source, None)
            if found is None:
                return None
            self._made.append(found)
        return self._made[number]


@dataclass(slots=True)
class Settled:
    """What is left of the alternatives.

    Attributes
    ----------
    failure
        None; or why nothing is left: the place where every order falls, or places that have no legal combination.
    factors
        Independent parts; one choice of each makes a map.
    left
        Per place, the numbers of the orders that some map has; where a search was stopped, that it had not excluded.
    count
        Number of maps, None where a search was stopped.
    judged
        How often a part of the map was judged.
    """

    failure: tuple[int, ...] | None
    factors: list[Factor]
    left: dict[int, list[int]]
    count: int | None
    judged: int


def settle(
    stars: Mapping[int, Sequence[Star]],
    turns: Sequence[Sequence[float]],
    make: Callable[[], Arrangement],
    *,
    effort: int,
) -> Settled:
    """Search what genus and turning leave of the orders and net rotations that evidence leaves open.

    Parameters
    ----------
    stars
        For every place that has darts, its orders, at least one.
    turns
        For every edge its net rotations, at least one.
    make
        Makes an arrangement of the darts to try them on.
    effort
        Number of judgements after which the search stops, and the group it is in is left uncounted.

    Notes
    -----
    Complexity O(E) a judgement; about as many judgements as there are open alternatives, and in a group as many as it has
    legal beginnings.
    """
    search = _Search(stars, turns, make(), effort)
    return search.run()


class _Search:
    def __init__(
        self,
        stars: Mapping[int, Sequence[Star]],
        turns: Sequence[Sequence[float]],
        arrangement: Arrangement,
        effort: int,
    ) -> None:
        self.arrangement, self.effort = arrangement, effort
        self.core = _core(arrangement.tail, arrangement.n_places)
        self.free: list[Factor] = []
        self.variables: list[_Variable] = []
        self.settled: dict[int, list[int]] = {}
        for place, orders in stars.items():
            kinds = self._kinds(orders)
            arrangement.put(orders[0].darts, orders[0].corners)
            if len(kinds) == 1:
                members = _distinct(kinds[0].members)
                self.settled[place] = [star.number for star in members]
                self.free.append(_free_factor(place, members))
            else:
                self.variables.append(_Variable(place, -1, kinds))
        for edge, angles in enumerate(turns):
            arrangement.turn[edge] = angles[0]
            if len(angles) > 1 and self.core[edge] and arrangement.turning:
                kinds = [_Kind(None, angle, 0.0, [], number) for number, angle in enumerate(angles)]
                self.variables.append(_Variable(-1, edge, kinds, [edge]))

    def _kinds(self, orders: Sequence[Star]) -> list[_Kind]:
        """Gather the orders of a place that are the same on the core."""
        kinds: dict[tuple[tuple[int, ...], tuple[float, ...]], _Kind] = {}
        for star in orders:
            key = _restricted(star, lambda dart: bool(self.core[dart >> 1]))
            if key in kinds:
                kinds[key].members.append(star)
                kinds[key].cost = min(kinds[key].cost, star.cost)
            else:
                kinds[key] = _Kind(star, 0.0, star.cost, [star], len(kinds), key[0])
        return list(kinds.values())

    def run(self) -> Settled:
        failure = self._propagate()
        if failure is not None:
            return Settled(failure, [], {}, 0, self.arrangement.judged)
        openly = [variable for variable in self.variables if len(variable.kinds) > 1]
        left = dict(self.settled)
        factors = list(self.free)
        total: int | None = prod(factor.count or 0 for factor in factors)
        for variable in self.variables:
            variable.put(self.arrangement, variable.kinds[0])
        limit = self.arrangement.judged + self.effort
        for group in sorted(self._groups(openly), key=len):
            solutions = _Replayed(self._solutions(group, openly))
            whole = True
            while solutions.more():
                if self.arrangement.judged > limit:
                    whole = False
                    break
            places = tuple(variable.place for variable in group if variable.place >= 0)
            if whole and not solutions.made:
                return Settled(places, [], {}, 0, self.arrangement.judged)
            number = _number_of_maps(solutions.made) if whole else None
            total = None if total is None or number is None else total * number
            for i, variable in enumerate(group):
                if variable.place >= 0:
                    kinds = {id(kind): kind for _, combination, _ in solutions.made for kind in (combination[i],)}
                    kept = list(kinds.values()) if whole else variable.kinds
                    left[variable.place] = [star.number for star in _distinct([s for k in kept for s in k.members])]
            if not whole:  # the likeliest first may take for ever: any that is legal, the likeliest alternatives tried first
                solutions = _Replayed(chain(solutions.made, self._solutions(group, openly, dive=True)))
            outer = _most_outer(solutions.made)
            factors.append(Factor(places, number, outer, _choices(group, solutions, in_order=whole)))
        for variable in self.variables:
            if len(variable.kinds) == 1:
                if variable.place < 0:
                    only = variable.kinds[0]
                    factors.append(Factor((), 1, 1, iter([Choice(0.0, (), ((variable.edge, only.number),), ())])))
                    continue
                members = _distinct(variable.kinds[0].members)
                left[variable.place] = [star.number for star in members]
                factors.append(_free_factor(variable.place, members))
                total = None if total is None else total * len(members)
        return Settled(None, factors, left, total, self.arrangement.judged)

    def _propagate(self) -> tuple[int, ...] | None:
        """Drop alternatives that are illegal whatever the others are; return the place where none is left, or None."""
        arrangement = self.arrangement
        openly = list(self.variables)
        changed = True
        while changed:
            changed = False
            for variable in openly:
                if variable.place >= 0:
                    variable.loose = _loose(variable, self.core)
                variable.put(arrangement, variable.kinds[0])
            held = np.zeros(self.core.size, np.int64)
            for variable in openly:
                held[variable.loose] += 1
            for variable in openly:
                others = held.copy()
                others[variable.loose] -= 1
                keep = self.core & (others == 0)
                kept = []
                for kind in variable.kinds:
                    variable.put(arrangement, kind)
                    if arrangement.judge(keep) is not None:
                        kept.append(kind)
                if not kept:
                    tail = arrangement.tail
                    return (variable.place,) if variable.place >= 0 else tuple(tail[2 * variable.edge :][:2].tolist())
                changed |= len(kept) < len(variable.kinds)
                variable.kinds = kept
                variable.put(arrangement, kept[0])
            openly = [variable for variable in openly if len(variable.kinds) > 1]
        if not self.variables and arrangement.judge(self.core) is None:
            return ()
        return None

    # -- groups --------------------------------------------------------------------------------------------------------

    def _groups(self, openly: list[_Variable]) -> list[list[_Variable]]:
        """Gather the open variables that may matter to each other: they touch a common face of the certain part."""
        tail, core = self.arrangement.tail, self.core
        keep = core.copy()
        for variable in openly:
            keep[variable.loose] = False
        kept = np.flatnonzero(np.repeat(keep, 2))
        label = np.full(tail.size, -1, np.int64)
        after = self._after(keep)
        if kept.size:
            row = np.full(tail.size, -1, np.int32)
            row[kept] = np.arange(kept.size, dtype=np.int32)
            label[kept], _ = face_labels(face_permutation(row[after[kept]]))
        node = _Merged(tail.size + self.arrangement.n_places)

        def of_face(dart: int) -> int:
            return int(label[dart])

        def of_place(place: int) -> int:
            return int(tail.size) + place

        # components of the certain part; all but the largest may lie anywhere, so each is one node with its faces
        whole = _Merged(self.arrangement.n_places)
        for edge in np.flatnonzero(keep).tolist():
            whole.join(int(tail[2 * edge]), int(tail[2 * edge + 1]))
        size = np.bincount([whole.root(int(v)) for v in tail[kept]], minlength=self.arrangement.n_places)
        largest = int(size.argmax()) if kept.size else -1
        in_largest = [bool(kept.size) and whole.root(v) == largest for v in range(self.arrangement.n_places)]
        for dart in kept.tolist():
            place = int(tail[dart])
            if not in_largest[place]:
                node.join(of_face(dart), of_place(whole.root(place)))
        openly_at = {variable.place for variable in openly}
        around: dict[int, list[int]] = {}
        for dart in kept.tolist():
            around.setdefault(int(tail[dart]), []).append(dart)

        def touched(place: int, dart: int | None = None) -> list[int]:
            """Return the nodes that an edge end at a place touches, or all that its star does."""
            if not in_largest[place]:
                return [of_place(whole.root(place))]
            if place in openly_at or dart is None:
                return [of_face(d) for d in around[place]]
            d = int(self.arrangement.previous[dart])
            while not keep[d >> 1]:
                d = int(self.arrangement.previous[d])
            return [of_face(d)]

        for edge in np.flatnonzero(core & ~keep).tolist():
            nodes = touched(int(tail[2 * edge]), 2 * edge) + touched(int(tail[2 * edge + 1]), 2 * edge + 1)
            for other in nodes[1:]:
                node.join(nodes[0], other)
        groups: dict[int, list[_Variable]] = {}
        for variable in openly:
            nodes = []
            for edge in variable.loose:
                nodes += touched(int(tail[2 * edge]), 2 * edge) + touched(int(tail[2 * edge + 1]), 2 * edge + 1)
            if variable.place >= 0:
                nodes += touched(variable.place)
            for other in nodes[1:]:
                node.join(nodes[0], other)
        for variable in openly:
            edge = variable.loose[0]
            groups.setdefault(node.root(touched(int(tail[2 * edge]), 2 * edge)[0]), []).append(variable)
        return list(groups.values())

    def _after(self, keep: NDArray[np.bool_]) -> NDArray[np.int64]:
        """Return the next kept dart counter-clockwise of every kept dart."""
        after = self.arrangement.next_ccw.copy()
        skipped = ~np.repeat(keep, 2)
        while True:
            bad = skipped[after] & ~skipped
            if not bad.any():
                return after
            after[bad] = self.arrangement.next_ccw[after[bad]]

    # -- search --------------------------------------------------------------------------------------------------------

    def _solutions(
        self, group: list[_Variable], openly: list[_Variable], *, dive: bool = False
    ) -> Iterator[tuple[float, tuple[_Kind, ...], tuple[int, ...]] | None]:
        """Yield the legal combinations of a group, each with the darts outside, and None after a try.

        The likeliest comes first; or, to `dive`, whichever is reached soonest from the likeliest beginnings.
        """
        arrangement = self.arrangement
        held = np.zeros(self.core.size, np.int64)
        inside = {id(variable) for variable in group}
        for variable in openly:
            if id(variable) not in inside:
                held[variable.loose] += 1
        known = [self.core & (held == 0)]  # the edges to judge on before, from the last place of the group backwards
        for variable in reversed(group[1:]):
            known.append(known[-1].copy())
            known[-1][variable.loose] = False
        rest = [0.0] * (len(group) + 1)
        for i in range(len(group) - 1, -1, -1):
            rest[i] = rest[i + 1] + min(kind.cost for kind in group[i].kinds)
        number = count()
        heap: list[tuple[int, float, int, tuple[_Kind, ...], tuple[int, ...]]] = [(0, rest[0], next(number), (), ())]
        while heap:
            _, cost, _, combination, outer = heapq.heappop(heap)
            depth = len(combination)
            if depth == len(group):
                yield cost, combination, outer
                continue
            keep = known[-1 - depth]
            for variable, kind in zip(group, combination, strict=False):
                variable.put(arrangement, kind)
            for kind in group[depth].kinds:
                group[depth].put(arrangement, kind)
                found = arrangement.judge(keep)
                if found is not None:
                    bound = cost - rest[depth] + kind.cost + rest[depth + 1]
                    rank = -depth - 1 if dive else 0
                    heapq.heappush(heap, (rank, bound, next(number), (*combination, kind), found))
            yield None


class _Replayed:
    """Solutions as they are found, kept for those who ask later."""

    def __init__(self, source: Iterable[tuple[float, tuple[_Kind, ...], tuple[int, ...]] | None]) -> None:
        self.source = iter(source)
        self.made: list[tuple[float, tuple[_Kind, ...], tuple[int, ...]]] = []

    def more(self) -> bool:
        """Search on for a little; return False at the end."""
        try:
            found = next(self.source)
        except StopIteration:
            return False
        if found is not None:
            self.made.append(found)
        return True

    def __iter__(self) -> Iterator[tuple[float, tuple[_Kind, ...], tuple[int, ...]]]:
        i = 0
        while True:
            while i >= len(self.made):
                if not self.more():
                    return
            yield self.made[i]
            i += 1


def _choices(group: list[_Variable], solutions: _Replayed, *, in_order: bool) -> Iterator[Choice]:
    """Yield the choices of a group, each map once; the likeliest first, if the solutions come so."""
    source = iter(solutions)
    ahead = next(source, None)
    number = count()
    heap: list[tuple[float, int, tuple[int, ...], tuple[_Kind, ...], tuple[int, ...]]] = []
    seen = set()
    while heap or ahead is not None:
        while ahead is not None and (not heap or (in_order and ahead[0] <= heap[0][0])):
            cost, combination, outer = ahead
            for kind in combination:
                kind.members.sort(key=lambda star: star.cost)
            heapq.heappush(heap, (cost, next(number), (0,) * len(combination), combination, outer))
            ahead = next(source, None)
        cost, _, picked, combination, outer = heapq.heappop(heap)
        last = max((i for i, n in enumerate(picked) if n), default=0)
        for i in range(last, len(picked)):
            members = combination[i].members
            if picked[i] + 1 < len(members):
                more = cost - members[picked[i]].cost + members[picked[i] + 1].cost
                step = (*picked[:i], picked[i] + 1, *picked[i + 1 :])
                heapq.heappush(heap, (more, next(number), step, combination, outer))
        stars = [kind.members[n] if kind.members else None for kind, n in zip(combination, picked, strict=True)]
        key = (tuple(star.darts if star else () for star in stars), outer)
        if key in seen:
            continue
        seen.add(key)
        orders = tuple((v.place, star.number) for v, star in zip(group, stars, strict=True) if star is not None)
        turns = tuple((v.edge, kind.number) for v, kind in zip(group, combination, strict=True) if v.edge >= 0)
        yield Choice(cost, orders, turns, outer)


def _number_of_maps(solutions: list[tuple[float, tuple[_Kind, ...], tuple[int, ...]]]) -> int | None:
    """Count the different maps of a group: combinations that differ on the core, times the places of what hangs there."""
    total = 0
    alike: dict[object, list[tuple[_Kind, ...]]] = {}
    for _, combination, outer in solutions:  # what differs in corners alone, or in whole turns, may be the same map
        alike.setdefault((tuple(kind.order for kind in combination), outer), []).append(combination)
    for combinations_ in alike.values():
        sets = [[sorted({star.darts for star in kind.members}) or [()] for kind in each] for each in combinations_]
        if len(sets) == 1:
            total += prod(map(len, sets[0]))
            continue
        if sum(prod(map(len, each)) for each in sets) > MOST_COUNTED:
            return None
        total += len({darts for each in sets for darts in product(*each)})
    return total


def _most_outer(solutions: list[tuple[float, tuple[_Kind, ...], tuple[int, ...]]]) -> int:
    """Return the most outer faces that solutions of one rotation have, 1 where there is no solution."""
    outer: dict[tuple[tuple[int, ...], ...], set[tuple[int, ...]]] = {}
    for _, combination, darts in solutions:
        outer.setdefault(tuple(kind.order for kind in combination), set()).add(darts)
    return max(map(len, outer.values()), default=1)


def _distinct(stars: Sequence[Star]) -> list[Star]:
    """Return the likeliest star of every order, the likeliest first."""
    found: dict[tuple[int, ...], Star] = {}
    for star in sorted(stars, key=lambda star: star.cost):
        found.setdefault(star.darts, star)
    return list(found.values())


def _free_factor(place: int, members: list[Star]) -> Factor:
    """Return a place whose orders are all legal whatever the others are."""
    choices = iter([Choice(star.cost, ((place, star.number),), (), ()) for star in members])
    return Factor((place,) if len(members) > 1 else (), len(members), 1, choices)


def _restricted(star: Star, kept: Callable[[int], bool]) -> tuple[tuple[int, ...], tuple[float, ...]]:
    """Return an order and its corners on some of its darts, from the lowest of them on."""
    at = [i for i, dart in enumerate(star.darts) if kept(dart)]
    if not at:
        return (), ()
    reach = [0.0]
    for corner in star.corners:
        reach.append(reach[-1] + corner)
    darts = [star.darts[i] for i in at]
    corners = [reach[b] - reach[a] for a, b in pairwise(at)]
    corners.append(TAU - sum(corners))
    low = darts.index(min(darts))
    return tuple(darts[low:] + darts[:low]), tuple(round(x, 7) for x in corners[low:] + corners[:low])


def _loose(variable: _Variable, core: NDArray[np.bool_]) -> list[int]:
    """Return edges at an open place without which its order is certain, chosen greedily."""
    stars = [kind.star for kind in variable.kinds if kind.star is not None]
    dropped: set[int] = set()

    def kinds(without: set[int]) -> int:
        return len({_restricted(star, lambda dart: core[dart >> 1] and dart not in without) for star in stars})

    while kinds(dropped) > 1:
        dropped.add(
            min((d for d in stars[0].darts if core[d >> 1] and d not in dropped), key=lambda d: kinds(dropped | {d}))
        )
    return sorted({dart >> 1 for dart in dropped})


def _core(tail: NDArray[np.int64], n_places: int) -> NDArray[np.bool_]:
    """Return the edges that are left when dead ends are taken away again and again, (E,) bool. O(E)."""
    degree = np.bincount(tail, minlength=n_places)
    at: list[list[int]] = [[] for _ in range(n_places)]
    for dart, place in enumerate(tail.tolist()):
        at[place].append(dart)
    core = np.ones(tail.size // 2, np.bool_)
    stack = np.flatnonzero(degree == 1).tolist()
    while stack:
        place = stack.pop()
        for dart in at[place]:
            if core[dart >> 1] and degree[place] == 1:
                core[dart >> 1] = False
                other = int(tail[dart ^ 1])
                degree[place] -= 1
                degree[other] -= 1
                if degree[other] == 1:
                    stack.append(other)
    return core


class _Merged:
    """Disjoint sets of numbers."""

    def __init__(self, size: int) -> None:
        self.parent = list(range(size))

    def root(self, item: int) -> int:
        while self.parent[item] != item:
            self.parent[item] = self.parent[self.parent[item]]
            item = self.parent[item]
        return item

    def join(self, a: int, b: int) -> None:
        self.parent[self.root(a)] = self.root(b)
