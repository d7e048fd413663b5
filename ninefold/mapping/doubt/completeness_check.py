"""Checks the formula of a `Completeness` against the folded walk, clause by clause, in plain Python.

Nothing is shared with what found the maps: neither the search, nor the solver's clauses, nor the reading of faces. A clause
holds if denying all of its literals cannot be a plane map that explains the walk; which argument shows it, the comments say,
and each is gone through again here. That the formula has no solution is for a checker of DRAT to confirm.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from ninefold.errors import BadInput, NotPlane

from ..heading import wrap
from .hypotheses import plane_of
from .walk_tree import fold

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from ..robot.walk import Walk
    from .walk_tree import WalkTree

__all__ = ["listed_maps"]

Pair = tuple[int, int, int]
Dart = tuple[int, int]


def listed_maps(
    walk: Walk,
    cnf: bytes,
    *,
    tolerance: float | None = None,
    same: Iterable[tuple[int, int]] = (),
    differ: Iterable[tuple[int, int]] = (),
) -> list[NDArray[np.int64]]:
    """Check that every clause of a formula holds of all maps that explain a walk but those that it lists; return these.

    With a refutation of the formula that a checker of DRAT accepts, they are all maps there are.

    Parameters
    ----------
    cnf
        As `Hypotheses.evidence` gives it.
    tolerance, same, differ
        As `hypotheses` was given them.

    Returns
    -------
    list
        The place of every visit, (T,) int64 each.

    Raises
    ------
    BadInput
        With the first clause whose reason does not hold, for a map listed that is none, and for what is no such formula.

    Notes
    -----
    Complexity O(clauses times N K).
    """
    tree = fold(walk, tolerance=tolerance)
    at: list[int] = tree.node_of.tolist()
    check = _Check(tree, [(at[a], at[b]) for a, b in same], [(at[a], at[b]) for a, b in differ])
    try:
        return [place[tree.node_of] for place in check.run(cnf.decode())]
    except (ValueError, LookupError) as error:
        if isinstance(error, BadInput):
            raise
        raise BadInput(f"the formula is damaged, or of another walk: {error}") from error


@dataclass(slots=True)
class _Merged:
    """Nodes that are one place as far as some pairs say so, by union and find.

    A node's exit x is exit x + shift of its root.
    """

    tree: _Tree
    parent: dict[int, tuple[int, int]]

    def find(self, node: int) -> tuple[int, int]:
        shift = 0
        while node in self.parent:
            node, more = self.parent[node]
            shift += more
        return node, shift % max(self.tree.degree[node], 1)

    def join(self, n: int, m: int, k: int) -> bool:
        """Let exit x of n be exit x + k of m; return False if they are one place by another shift."""
        a, to_a = self.find(n)
        b, to_b = self.find(m)
        shift = (k + to_b - to_a) % max(self.tree.degree[b], 1)
        if a == b:
            return shift == 0
        self.parent[a] = (b, shift)
        return True


class _Tree:
    """A folded walk as lists."""

    def __init__(self, tree: WalkTree, same: list[tuple[int, int]], differ: list[tuple[int, int]]) -> None:
        self.degree: list[int] = tree.degree.tolist()
        self.heading: list[list[float]] = tree.heading.tolist()
        self.other: list[list[int]] = tree.other.tolist()
        self.back: list[list[int]] = tree.back.tolist()
        self.turn: list[list[float]] = tree.turn.tolist()
        self.names = tree.names
        self.tolerance = tree.tolerance + 1e-9
        self.differ = {frozenset(pair) for pair in differ}
        self.same = {frozenset(pair) for pair in same}

    def alike(self, n: int, m: int, k: int) -> bool:
        """Whether exit x of n can be exit x + k of m, for all x."""
        if self.degree[n] != self.degree[m] or frozenset((n, m)) in self.differ:
            return False
        if None not in (self.names[n], self.names[m]) and self.names[n] != self.names[m]:
            return False
        degree = self.degree[n]
        here, there = self.heading[n], self.heading[m]
        if not all(abs(wrap(there[(x + k) % degree] - here[x])) <= self.tolerance for x in range(degree)):
            return False
        return all(self._turn_alike(n, x, m, (x + k) % degree) for x in range(degree))

    def _turn_alike(self, n: int, x: int, m: int, y: int) -> bool:
        """Whether the ways out of two exits, if both were walked, turn by as many whole turns."""
        if self.other[n][x] < 0 or self.other[m][y] < 0:
            return True
        near = wrap(self.heading[m][y] - self.heading[n][x])
        far = wrap(self.heading[self.other[m][y]][self.back[m][y]] - self.heading[self.other[n][x]][self.back[n][x]])
        return abs(self._settled(m, y) - self._settled(n, x) + near - far) < pi

    def _settled(self, n: int, x: int) -> float:
        """Return the turn along the way out of an exit as the headings at its two ends have it."""
        turn = self.turn[n][x]
        return turn + wrap(self.heading[self.other[n][x]][self.back[n][x]] + pi - self.heading[n][x] - turn)

    def shifts(self, n: int, m: int) -> list[int]:
        """Return the shifts under which two nodes can be one place."""
        if self.degree[n] != self.degree[m]:
            return []
        return [k for k in range(max(self.degree[n], 1)) if self.alike(n, m, k)]


class _Check:
    def __init__(self, tree: WalkTree, same: list[tuple[int, int]], differ: list[tuple[int, int]]) -> None:
        self.walk = tree
        self.tree = _Tree(tree, same, differ)
        self.pair: dict[int, Pair] = {}
        self.number: dict[Pair, int] = {}
        self.closed = False
        self.maps: list[NDArray[np.int64]] = []

    def run(self, text: str) -> list[NDArray[np.int64]]:
        lines = text.splitlines()
        head = next((i for i, line in enumerate(lines) if line.startswith("p cnf ")), None)
        if head is None or lines[:1] != ["c ninefold maps 1"]:
            raise BadInput("no formula about the maps of a walk: it begins with 'c ninefold maps 1' and has a line 'p cnf'")
        clauses = [[int(word) for word in line.split()[:-1]] for line in lines[head + 1 :]]
        reason: dict[int, list[str]] = {}
        for line in lines[1:head]:
            match line.split()[1:]:
                case ["closed", flag]:
                    self.closed = flag == "1"
                case ["variable", x, "pair", n, m, k]:
                    self._variable(int(x), (int(n), int(m), int(k)))
                case ["clauses", first, last, kind]:
                    reason.update((number, [kind]) for number in range(int(first), int(last) + 1))
                case ["clause", which, *rest]:
                    reason[int(which)] = rest
        covered = self._coverings()
        for number, clause in enumerate(clauses, 1):
            why = reason.get(number, ["nothing"])
            if not self._holds(clause, why, covered):
                raise BadInput(f"clause {number} of the formula does not follow from the walk as {why[0]!r}: {clause}")
        return self.maps

    def _variable(self, x: int, pair: Pair) -> None:
        n, m, k = pair
        self.pair[x] = pair
        self.number[pair] = x
        self.number[m, n, -k % max(self.tree.degree[n], 1)] = x

    def _holds(self, clause: list[int], why: list[str], covered: set[frozenset[int]]) -> bool:
        match why:
            case ["transitive"] | ["congruent"]:
                return self._by_closure(clause)
            case ["covered"]:
                return self.closed and frozenset(clause) in covered
            case ["together"]:
                return self._together(clause)
            case ["cut", *rest]:
                return self._by_faces(clause, rest)
            case ["map", *rest]:
                return self._excludes(clause, [int(word) for word in rest])
        return False

    # -- clauses of every quotient ------------------------------------------------------------------------------------------

    def _by_closure(self, clause: list[int]) -> bool:
        """Whether merging what the clause denies cannot be, or makes one of its other literals hold."""
        merged = _Merged(self.tree, {})
        queue = [self.pair[-x] for x in clause if x < 0]
        wanted = {x for x in clause if x > 0}
        met: set[int] = set()
        for n, m, k in queue:
            if not self.tree.alike(n, m, k) or not merged.join(n, m, k):
                return True
            met |= {n, m}
            follows = self._follows(n, m, k)
            if follows is None or not wanted.isdisjoint(self._numbers(follows)):
                return True
        nodes = sorted(met)
        for i, n in enumerate(nodes):
            for m in nodes[:i]:
                (a, to_a), (b, to_b) = merged.find(n), merged.find(m)
                if a == b:
                    k = (to_a - to_b) % max(self.tree.degree[n], 1)
                    if not self.tree.alike(n, m, k) or self.number.get((n, m, k)) in wanted:
                        return True
        return False

    def _numbers(self, pairs: list[Pair]) -> list[int]:
        return [self.number[pair] for pair in pairs if pair in self.number]

    def _follows(self, n: int, m: int, k: int) -> list[Pair] | None:
        """Return what merging two nodes makes one beyond the exits that both walked; None if that cannot be."""
        tree, found = self.tree, []
        for x in range(tree.degree[n]):
            y = (x + k) % tree.degree[m]
            p, q = tree.other[n][x], tree.other[m][y]
            if p < 0 or q < 0:
                continue
            back, other_back = tree.back[n][x], tree.back[m][y]
            if (p, back) == (m, y) and (q, other_back) == (n, x):
                return None
            if tree.degree[p] != tree.degree[q]:
                return None
            shift = (other_back - back) % tree.degree[p]
            if (p == q and shift) or not tree.alike(p, q, shift):
                return None
            found.append((p, q, shift))
        return found

    def _coverings(self) -> set[frozenset[int]]:
        """Return, for every exit that its node did not walk, the variables that say which node did."""
        found = set()
        for n, degree in enumerate(self.tree.degree):
            for x in range(degree):
                if self.tree.other[n][x] < 0:
                    found.add(frozenset(self._walkers(n, x, None)))
        return found

    def _walkers(self, n: int, x: int, inside: set[int] | None) -> list[int]:
        """Return the variables of all pairs in which another node walked an exit, of a part or of all; 0 for one without."""
        found = []
        for m, degree in enumerate(self.tree.degree):
            if m == n or degree != self.tree.degree[n] or (inside is not None and m not in inside):
                continue
            for y in range(degree):
                beyond = self.tree.other[m][y]
                if beyond < 0 or (inside is not None and beyond not in inside):
                    continue
                k = (y - x) % degree
                if self.tree.alike(n, m, k):
                    found.append(self.number.get((n, m, k), 0))
        return found

    def _together(self, clause: list[int]) -> bool:
        nodes = {self.pair[x][:2] for x in clause if x > 0}
        if len(nodes) != 1 or min(clause) < 0:
            return False
        n, m = nodes.pop()
        named = self.tree.names[n] is not None and self.tree.names[n] == self.tree.names[m]
        return (named or self._said_same(n, m)) and {self.number.get((n, m, k)) for k in self.tree.shifts(n, m)} <= set(
            clause
        )

    def _said_same(self, n: int, m: int) -> bool:
        """Whether a chain of pairs known to be one place joins two nodes."""
        seen, queue = {n}, [n]
        pairs = [tuple(pair) for pair in self.tree.same if len(pair) == 2]
        named: dict[str, int] = {}
        for node, name in enumerate(self.tree.names):
            if name is not None:
                pairs.append((named.setdefault(name, node), node))
        for node in queue:
            for a, b in pairs:
                for here, there in ((a, b), (b, a)):
                    if here == node and there not in seen:
                        seen.add(there)
                        queue.append(there)
        return m in seen

    # -- cuts ---------------------------------------------------------------------------------------------------------------

    def _by_faces(self, clause: list[int], words: list[str]) -> bool:
        """Whether the part has such faces once all literals of the clause are denied, and is no plane map with them."""
        at = words.index("face")
        inside = {int(word) for word in words[:at]}
        begins = [(int(words[i + 1]), int(words[i + 2])) for i in range(at, len(words), 4)]
        if not self._connected(inside):
            return False
        merged = _Merged(self.tree, {})
        for x in clause:
            if x < 0 and not merged.join(*self.pair[-x]):
                return False
        literals = {x for x in clause if x > 0}
        walks = [self._walked(begin, inside, merged, literals) for begin in begins]
        if any(walk is None for walk in walks):
            return False
        faces = [walk for walk in walks if walk is not None]
        turns = [turned for _, turned in faces]
        if len(faces) == 1 and turns[0] != 1:
            return self._wrong(faces[0][0], turns[0], literals)
        if len(faces) == 2 and turns == [-1, -1]:
            return self._never_one(faces[0][0], faces[1][0], literals)
        darts = {self._root(merged, *dart) for walk, _ in faces for dart in walk}
        back = {self._root(merged, self.tree.other[n][x], self.tree.back[n][x]) for walk, _ in faces for n, x in walk}
        return all(turned == 1 for turned in turns) and back <= darts  # all there is: a torus, as no face turns -1

    def _wrong(self, walk: list[Dart], turned: int, literals: set[int]) -> bool:
        """Whether a walk round a face that turns otherwise cannot be several rounds of one that turns +1 or -1."""
        rounds = abs(turned)
        if rounds == 1:
            return False
        if rounds == 0 or len(walk) % rounds:
            return True
        far = len(walk) // rounds
        return any(self._never(walk[i], walk[i + far], literals) for i in range(len(walk) - far))

    def _never_one(self, walk: list[Dart], other: list[Dart], literals: set[int]) -> bool:
        """Whether two walks cannot go round one face: some way of the one is none of the other."""
        return any(all(self._never(dart, one, literals) for one in other) for dart in walk)

    def _never(self, dart: Dart, other: Dart, literals: set[int]) -> bool:
        """Whether two ways walked cannot be one way: by themselves, or as the clause has that for a literal."""
        (n, x), (m, y) = dart, other
        if n == m:
            return x != y
        if self.tree.degree[n] != self.tree.degree[m]:
            return True
        k = (y - x) % self.tree.degree[n]
        return not self.tree.alike(n, m, k) or self.number.get((n, m, k)) in literals

    def _connected(self, inside: set[int]) -> bool:
        seen = {min(inside)}
        queue = list(seen)
        for n in queue:
            for m in self.tree.other[n]:
                if m in inside and m not in seen:
                    seen.add(m)
                    queue.append(m)
        return seen == inside

    def _root(self, merged: _Merged, n: int, x: int) -> Dart:
        root, shift = merged.find(n)
        return root, (x + shift) % self.tree.degree[n]

    def _walked(self, begin: Dart, inside: set[int], merged: _Merged, literals: set[int]) -> tuple[list[Dart], int] | None:
        """Walk a face; return the exits by which nodes went along it and how often it turns, None if that is not certain."""
        tree = self.tree
        walkers: dict[Dart, list[Dart]] = {}
        for n in sorted(inside):
            for x in range(tree.degree[n]):
                if tree.other[n][x] in inside:
                    walkers.setdefault(self._root(merged, n, x), []).append((n, x))
        if tree.other[begin[0]][begin[1]] not in inside:
            return None
        start, at, total = self._root(merged, *begin), begin, 0.0
        darts: list[Dart] = []
        for _ in range(len(walkers)):
            n, x = at
            darts.append(at)
            m, y = tree.other[n][x], tree.back[n][x]
            total += tree.turn[n][x] + wrap(tree.heading[m][y] - pi - tree.heading[n][x] - tree.turn[n][x])
            z = (y - 1) % tree.degree[m]
            while (key := self._root(merged, m, z)) not in walkers:
                if any(number not in literals for number in self._walkers(m, z, inside)):
                    return None  # somebody may have walked here
                z = (z - 1) % tree.degree[m]
            total += pi - ((tree.heading[m][y] - tree.heading[m][z]) % (2 * pi) if z != y else 2 * pi)
            at = begin if key == start else min(walkers[key], key=lambda dart: (abs(dart[0] - m), dart[0]))
            total += wrap(tree.heading[at[0]][at[1]] - tree.heading[m][z])
            if key == start:
                return darts, round(total / (2 * pi))
        return None

    # -- maps ---------------------------------------------------------------------------------------------------------------

    def _excludes(self, clause: list[int], words: list[int]) -> bool:
        """Whether a clause excludes one map and nothing else; the map is checked, and noted."""
        degree = self.tree.degree
        count = len(degree)
        if len(words) != 2 * count:
            return False
        place, shift = words[:count], words[count:]
        lead: dict[int, int] = {}
        literals = set(clause)
        relative = []
        for n, w in enumerate(place):
            first = lead.setdefault(w, n)
            relative.append((shift[n] - shift[first]) % max(degree[n], 1))
            if first != n:
                if -self.number.get((n, first, relative[n]), 0) not in literals:
                    return False
                continue
            for m in lead.values():
                if m != n and any(self.number.get((m, n, k)) not in literals for k in self.tree.shifts(m, n)):
                    return False
        numbered = [list(lead).index(w) for w in place]
        try:
            plane_of(self.walk, np.array(numbered, np.int64), np.array(relative, np.int64))
        except NotPlane as error:
            raise BadInput(f"a map that is listed is none: {error}") from error
        self.maps.append(np.array(numbered, np.int64))
        return True
