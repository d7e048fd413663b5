"""What follows when nodes of a folded walk are said to be one place: congruence, with a reason for everything.

Two nodes that are one place have the same exits, and every exit leads one way: so the nodes beyond an exit that both walked
are one place too, and so on. All this is kept as sets of nodes with shifts (exit x of a node is exit x + shift of its set).
A *clash* is a pair of nodes that would have to be one place and cannot be. Every merger remembers what it follows from, so
a clash names the assertions behind it; what follows from more assertions follows, so those alone already cannot hold
together.

References
----------
R. Nieuwenhuis and A. Oliveras, "Fast congruence closure and extensions", Information and Computation 205, 2007: the forest
of proofs.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from ..heading import TAU
from .likeness import can_be_one

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from .walk_tree import WalkTree

__all__ = ["FACT", "Assertion", "Clash", "Congruence", "Core", "Kind", "core_of"]

FACT = -2
"""The number of an assertion that is beyond doubt: no clash is blamed on it."""

WALKED = -1

Kind = Literal["exits", "names", "twice", "back"]
"""How two nodes cannot be one place: their exits differ; their names; one place would be the other under two shifts; a way
would come back by the exit it left by."""


class Assertion(NamedTuple):
    """Said: two nodes are one place, exit x of the one being exit x + shift of the other."""

    node: int
    other: int
    shift: int


class Clash(NamedTuple):
    """Two nodes that would be one place and cannot be.

    Attributes
    ----------
    kind
        In what way.
    node, other
        The nodes.
    exit, as_exit
        An exit of the first, and the exit of the second that it would be.
    """

    kind: Kind
    node: int
    other: int
    exit: int
    as_exit: int


@dataclass(frozen=True, slots=True)
class Core:
    """Assertions that cannot hold together, by their numbers; and the clash they end in, if they end in one."""

    members: tuple[int, ...]
    clash: Clash | None


class _Step(NamedTuple):
    """Why two nodes were merged: an assertion; or (`WALKED`) two nodes of one set that walked one exit."""

    assertion: int
    node: int = -1
    other: int = -1


class Congruence:
    """The consequences of assertions, made one after another.

    Parameters
    ----------
    tree
        The folded walk.
    facts
        Assertions beyond doubt.

    Attributes
    ----------
    clash
        The first one met, or None. After it nothing more can be asserted.
    because
        The numbers of the assertions it follows from.
    """

    def __init__(self, tree: WalkTree, facts: Iterable[Assertion] = ()) -> None:
        self._tree = tree
        self._facts = tuple(facts)
        self._degree: list[int] = tree.degree.tolist()
        self._other: list[list[int]] = tree.other.tolist()
        self._back: list[list[int]] = tree.back.tolist()
        self._heading: list[list[float]] = tree.heading.tolist()
        self._allowed = tree.tolerance + 1e-12
        self.reset()

    def reset(self) -> None:
        """Forget every assertion but the facts."""
        self._root: dict[int, tuple[int, int]] = {}
        self._members: dict[int, list[tuple[int, int]]] = {}
        self._ways: dict[int, dict[int, tuple[int, int]]] = {}
        self._named: dict[int, int] = {}
        self._spans: dict[int, list[tuple[float, float]]] = {}
        self._above: dict[int, tuple[int, _Step]] = {}
        self.clash: Clash | None = None
        self.because: frozenset[int] = frozenset()
        self.assert_all((FACT, one) for one in self._facts)

    def place_of(self, node: int) -> tuple[int, int]:
        """Return the first node of the set of a node, and the exit of it that exit 0 of the node is."""
        return self._root.get(node, (node, 0))

    def places(self) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return the place and shift of every node, (N,) each, numbered in the order of first visits.

        Exits of a place are those of its first node.
        """
        count = self._tree.n_nodes
        found = np.array([self.place_of(n) for n in range(count)], np.int64).reshape(count, 2)
        _, lead, place = np.unique(found[:, 0], return_index=True, return_inverse=True)
        rank = np.empty(lead.size, np.int64)
        rank[np.argsort(lead, kind="stable")] = np.arange(lead.size)
        first = np.sort(lead)[rank[place]]
        return rank[place], (found[:, 1] - found[first, 1]) % np.maximum(self._tree.degree, 1)

    def assert_all(self, assertions: Iterable[tuple[int, Assertion]]) -> bool:
        """Assert several, each with a number to call it by; return whether they and all that follows can hold."""
        if self.clash is None:
            for number, one in assertions:
                if not self._merged(one, _Step(number)):
                    return False
            self._look_for_ways_back()
        return self.clash is None

    def _merged(self, one: Assertion, step: _Step) -> bool:
        todo = deque([(one, step)])  # nearest consequences first: reasons are shorter then
        while todo:
            (n, m, shift), why = todo.popleft()
            if not self._merge(n, m, shift, why, todo):
                return False
        return True

    def _merge(self, n: int, m: int, shift: int, why: _Step, todo: deque[tuple[Assertion, _Step]]) -> bool:
        """Merge the sets of two nodes; put on the list what follows."""
        (a, at_a), (b, at_b) = self.place_of(n), self.place_of(m)
        degree = self._degree[n]
        if degree != self._degree[m]:
            return self._clashes(Clash("exits", n, m, 0, 0), n, m, why)
        offset = (shift + at_b - at_a) % degree if degree else 0  # exit z of the set of n is exit z + offset of that of m
        if a == b:
            if offset:
                return self._clashes(Clash("twice", n, m, 0, shift % degree), n, m, why)
            return True
        members, others = self._members.get(a, [(a, 0)]), self._members.get(b, [(b, 0)])
        spans = self._together(a, b, offset) if self._tree.compass else []
        fits = self._tree.compass and all(high - low <= self._allowed for low, high in spans)
        unlike = None if fits else self._unlike(a, b, offset)
        p, q = self._named.get(a, a), self._named.get(b, b)
        name, called = self._tree.names[p], self._tree.names[q]
        if unlike is None and name is not None and called is not None and name != called:
            unlike = Clash("names", p, q, 0, 0)
        self._link(n, m, why)
        if unlike is not None:
            self.clash, self.because = unlike, self._reasons(unlike.node, unlike.other)
            return False
        if len(members) < len(others):
            a, b, members, others, offset = b, a, others, members, (-offset) % degree if degree else 0
            spans = self._together(a, b, offset) if self._tree.compass else []
        self._spans[a] = spans
        # now the set of b goes into that of a: its exit z is exit z - offset there
        back = (-offset) % degree if degree else 0
        moved = [(q, (at + back) % degree if degree else 0) for q, at in others]
        for q, at in moved:
            self._root[q] = (a, at)
        ways = self._ways_of(a)
        for z, (q, x) in self._ways_of(b).items():
            y = (z + back) % degree
            mine = ways.setdefault(y, (q, x))
            if mine == (q, x):
                continue
            first, w = mine
            turned = self._back[q][x] - self._back[first][w]
            end, far = self._other[first][w], self._other[q][x]
            todo.append((Assertion(end, far, turned % self._degree[far]), _Step(WALKED, first, q)))
        self._ways.pop(b, None)
        self._members[a] = members + moved
        self._members.pop(b, None)
        if name is not None or called is not None:
            self._named[a] = p if name is not None else q
        return True

    def _ways_of(self, root: int) -> dict[int, tuple[int, int]]:
        """Return, for every exit of a set that somebody walked, a node that did and its exit."""
        ways = self._ways.get(root)
        if ways is None:
            ways = {x: (root, x) for x, m in enumerate(self._other[root]) if m >= 0}
            self._ways[root] = ways
        return ways

    def _unlike(self, a: int, b: int, offset: int) -> Clash | None:
        """Return two nodes of two sets that cannot be one, exit z of the first set being exit z + offset of the second."""
        degree = self._degree[a]
        if not degree:
            return None
        p, at_p = np.array(self._members.get(a, [(a, 0)]), np.int64).T
        q, at_q = np.array(self._members.get(b, [(b, 0)]), np.int64).T
        i, j = np.repeat(np.arange(p.size), q.size), np.tile(np.arange(q.size), p.size)
        shift = (at_p[i] + offset - at_q[j]) % degree
        good = can_be_one(self._tree, p[i], q[j], shift)
        if good.all():
            return None
        k = int(good.argmin())
        return Clash("exits", int(p[i[k]]), int(q[j[k]]), 0, int(shift[k]))

    def _together(self, a: int, b: int, offset: int) -> list[tuple[float, float]]:
        """Return by how much the headings of two sets differ from those of the first node of the first, exit by exit."""
        mine, other = self._spans_of(a), self._spans_of(b)
        ours, theirs = self._heading[a], self._heading[b]
        degree = self._degree[a]
        found = []
        for z in range(degree):
            y = (z + offset) % degree
            miss = (theirs[y] - ours[z] + pi) % TAU - pi
            found.append((min(mine[z][0], other[y][0] + miss), max(mine[z][1], other[y][1] + miss)))
        return found

    def _spans_of(self, root: int) -> list[tuple[float, float]]:
        return self._spans.get(root) or [(0.0, 0.0)] * self._degree[root]

    def _look_for_ways_back(self) -> None:
        """Look for a way that ends in the exit it begins with."""
        for root, ways in self._ways.items():
            for z, (p, x) in ways.items():
                end, back = self._other[p][x], self._back[p][x]
                there, at = self.place_of(end)
                if there == root and (back + at) % self._degree[end] == z:
                    self.clash, self.because = Clash("back", p, end, x, back), self._reasons(p, end)
                    return

    def _clashes(self, clash: Clash, n: int, m: int, why: _Step) -> bool:
        """Note a clash between two nodes that a step would merge."""
        found = self._reasons_of(why)
        if self.place_of(n)[0] == self.place_of(m)[0]:
            found |= self._reasons(n, m)
        self.clash, self.because = clash, frozenset(found)
        return False

    # -- reasons -----------------------------------------------------------------------------------------------------------

    def _link(self, n: int, m: int, why: _Step) -> None:
        """Hang the tree of proofs of one node under another node."""
        if len(self._members.get(self.place_of(n)[0], ())) > len(self._members.get(self.place_of(m)[0], ())):
            n, m = m, n
        above, step = m, why
        while True:
            before = self._above.get(n)
            self._above[n] = (above, step)
            if before is None:
                return
            above, n, step = n, before[0], before[1]

    def _reasons_of(self, why: _Step) -> set[int]:
        if why.assertion == WALKED:
            return set(self._reasons(why.node, why.other))
        return set() if why.assertion == FACT else {why.assertion}

    def _reasons(self, n: int, m: int) -> frozenset[int]:
        """Return the assertions that make two nodes of one set the same."""
        found: set[int] = set()
        seen: set[tuple[int, int]] = set()
        todo = [(n, m)]
        while todo:
            n, m = todo.pop()
            if n == m or (n, m) in seen:
                continue
            seen.add((n, m))
            for step in self._path(n, m):
                if step.assertion == WALKED:
                    todo.append((step.node, step.other))
                elif step.assertion != FACT:
                    found.add(step.assertion)
        return frozenset(found)

    def _path(self, n: int, m: int) -> list[_Step]:
        up = {n: 0}
        steps: list[_Step] = []
        at = n
        while at in self._above:
            at, step = self._above[at]
            steps.append(step)
            up[at] = len(steps)
        more: list[_Step] = []
        at = m
        while at not in up:
            at, step = self._above[at]
            more.append(step)
        return steps[: up[at]] + more


def core_of(congruence: Congruence, assertions: dict[int, Assertion], *, tries: int | None = None) -> Core | None:
    """Return assertions that cannot hold together, none superfluous; None if all can, and then they are asserted.

    Parameters
    ----------
    tries
        How often at most to try to do without some; then some of those returned may be superfluous.

    Notes
    -----
    Complexity: one closure of all, and one of the core for each of its members.
    """
    congruence.reset()
    if congruence.assert_all(assertions.items()):
        return None
    left = [k for k in assertions if k in congruence.because]
    clash = congruence.clash
    needed: set[int] = set()
    size = max(1, len(left) // 2)
    while left and tries != 0:
        tries = None if tries is None else tries - 1
        part, rest = left[:size], left[size:]
        wanted = needed.union(rest)
        congruence.reset()
        if not congruence.assert_all((k, one) for k, one in assertions.items() if k in wanted):
            left = [k for k in rest if k in congruence.because]
            clash = congruence.clash
            size = max(1, min(2 * size, len(left)))
        elif len(part) == 1:
            needed.update(part)
            left = rest
        else:
            size = len(part) // 2
    return Core(tuple(sorted(needed.union(left))), clash)
