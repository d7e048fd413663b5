"""Why two visits of a walk are not the same place: the reason as a value that a picture can show.

The reasons are tried from the plainest on: exits or names that differ, two visits further on that would have to be the same
and cannot, a face or a loop that would turn as none does in the plane. What none of them tells, the search does.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from time import monotonic
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput

from .consequences import Clash, merged
from .existence import held_same, some_map
from .turning_faces import impossible_face, impossible_loop, tree_path

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .hypotheses import Hypotheses
    from .likeness import Likeness
    from .turning_faces import TurningFace
    from .walk_tree import WalkTree

__all__ = ["Reasons", "WhyNot", "WhyNotKind", "why_not"]

WhyNotKind: TypeAlias = Literal["exits", "names", "given", "consequence", "face", "loop", "search", "unknown"]

LONGEST_LOOP = 40
"""Legs of a loop up to which it is looked at: whether it is simple takes the square of them."""


@dataclass(frozen=True, slots=True)
class WhyNot:
    """Why two visits are not the same place in any map.

    Attributes
    ----------
    kind
        ``"exits"``: they have other exits. ``"names"``: they have other names. ``"given"``: they were said to be two places.
        ``"consequence"``: along exits walked from both, two more visits would have to be the same, which cannot be.
        ``"face"``: a face that nothing opens into would turn by other than +1, or -1 where it is the outer one. ``"loop"``:
        the way from the one to the other passes no place twice, and would turn by other than 1. ``"search"``: no map of all
        has them the same. ``"unknown"``: the time was spent before any map was found that has them the same.
    visits
        The two, counted from 0.
    text
        In words; there visits are counted from 1.
    chain
        Pairs of visits that would have to be the same, each the consequence of the one before, for a consequence: the last
        pair is the one that cannot. Both visits of it are one where one exit of a place would have to be another.
    around
        Visits along the face, in order, the face on the left; or along the loop, from the one visit to the other.
    turning
        Turns of that face or loop, counter-clockwise.
    others
        The reasons against the other ways in which the exits of the one could be those of the other.
    """

    kind: WhyNotKind
    visits: tuple[int, int]
    text: str
    chain: tuple[tuple[int, int], ...] = ()
    around: tuple[int, ...] = ()
    turning: float | None = None
    others: tuple[WhyNot, ...] = ()

    def __str__(self) -> str:
        return self.text


class Reasons:
    """Finds reasons why nodes of one walk are different places, and remembers those that it found.

    Parameters
    ----------
    tree, alike
        The walk, and what of it can be the same.
    first
        Of a stretch of a longer walk: which visit of that its first one is, counted from 0, for the words.
    """

    def __init__(self, tree: WalkTree, alike: Likeness, *, first: int = 0) -> None:
        self.tree, self.alike, self._from = tree, alike, first + 1
        self._first = np.full(tree.n_nodes, tree.n_visits, np.int64)
        np.minimum.at(self._first, tree.node_of, np.arange(tree.n_visits))
        self._impossible: dict[tuple[int, int], bool] = {}

    def plain(self, i: int, j: int) -> WhyNot | None:
        """Return why two visits are not the same place, as far as that shows without search; None if it does not."""
        n, m = int(self.tree.node_of[i]), int(self.tree.node_of[j])
        if n == m:
            return None
        bits = int(self.alike.shifts[n, m])
        if not bits:
            return self._unlike(n, m, (i, j))
        found: list[WhyNot] = []
        for shift in (k for k in range(int(self.tree.degree[n]) or 1) if (bits >> k) & 1):
            one = self._against(n, m, shift, (i, j))
            if one is None:
                return None
            found.append(one)
        return replace(found[0], others=tuple(found[1:]))

    def searched(
        self, i: int, j: int, *, closed: bool | None, max_places: int | None = None, until: float | None = None
    ) -> WhyNot | None:
        """Return why two visits are not the same place by searching for a map that has them so; None if there is one."""
        n, m = int(self.tree.node_of[i]), int(self.tree.node_of[j])
        alike = held_same(self.alike, n, m)
        there_is = some_map(self.tree, alike, closed=closed is True, max_places=max_places, until=until)
        both = f"visits {i + self._from} and {j + self._from}"
        if there_is:
            return None
        if there_is is None:
            text = f"it is not known whether {both} can be the same place: the time was spent before a map was found"
            return WhyNot("unknown", (i, j), text)
        kind = "no closed map" if closed else "no map"
        return WhyNot("search", (i, j), f"{kind} that explains the walk has {both} the same; every other was searched")

    # -- inside --------------------------------------------------------------------------------------------------------

    def _visit(self, node: int, near: tuple[int, int] | None = None) -> int:
        """Return the first visit of a node, or one of two given if it is there."""
        for visit in near or ():
            if self.tree.node_of[visit] == node:
                return visit
        return int(self._first[node])

    def _unlike(self, n: int, m: int, visits: tuple[int, int]) -> WhyNot:
        i, j = (v + self._from for v in visits)
        names = self.tree.names[n], self.tree.names[m]
        if None not in names and names[0] != names[1]:
            return WhyNot("names", visits, f"visit {i} is called {quoted(names[0])} and visit {j} {quoted(names[1])}")
        degree = int(self.tree.degree[n]), int(self.tree.degree[m])
        if degree[0] != degree[1]:
            text = f"visit {i} has {counted(degree[0], 'exit')} and visit {j} {counted(degree[1], 'exit')}"
            return WhyNot("exits", visits, text)
        if self._exits_agree(n, m):
            return WhyNot("given", visits, f"visits {i} and {j} were said to be two places")
        how = "their exits lie in other directions" if self.tree.compass else "the angles between their exits differ"
        return WhyNot("exits", visits, f"visits {i} and {j}: {how}")

    def _exits_agree(self, n: int, m: int) -> bool:
        degree = int(self.tree.degree[n])
        mine, other = self.tree.heading[n, :degree], self.tree.heading[m, :degree]
        for k in range(max(degree, 1)):
            miss = np.roll(other, -k) - mine
            if not self.tree.compass and degree:
                miss = miss - miss[0]
            miss -= 2 * np.pi * np.round(miss / (2 * np.pi))
            if not degree or float(np.abs(miss).max()) <= self.tree.tolerance + 1e-12:
                return True
        return False

    def _against(self, n: int, m: int, shift: int, visits: tuple[int, int]) -> WhyNot | None:
        """Return a reason against exit x of node n being exit x + shift of node m, or None."""
        both = f"if visits {visits[0] + self._from} and {visits[1] + self._from} were the same place"
        found = merged(self.tree, self.alike, n, m, shift)
        if isinstance(found, Clash):
            return self._consequence(found, visits, both)
        face = impossible_face(self.tree, self.alike, found)
        if face is not None:
            around = self._around(face, visits)
            inside = "faces turn by +1, the outer one by -1"
            text = (
                f"{both}, the way along visits {_listed(around, self._from)} would be round a face that turns by "
                f"{_turns(face.turning)}; {inside}"
            )
            return WhyNot("face", visits, text, around=around, turning=face.turning)
        return self._loop(n, m, shift, visits, both)

    def _consequence(self, found: Clash, visits: tuple[int, int], both: str) -> WhyNot:
        chain = [visits, *((self._visit(a), self._visit(b)) for a, b in found.chain[1:])]
        a, b = found.pair
        i, j = self._visit(a, visits), self._visit(b, visits)
        steps = "".join(f", so would be visits {p + self._from} and {q + self._from}" for p, q in chain[1:])
        if a == b:
            last = f"then one exit of visit {i + self._from} would be another of its exits"
            return WhyNot("consequence", visits, f"{both}{steps}; {last}", chain=(*chain, (i, i)))
        reason = self._unlike(a, b, (i, j)).text
        if {a, b} != set(found.chain[-1]):
            steps += f", and with them visits {i + self._from} and {j + self._from}"
        if (i, j) != chain[-1]:
            chain.append((i, j))
        return WhyNot("consequence", visits, f"{both}{steps}; but {reason}", chain=tuple(chain))

    def _loop(self, n: int, m: int, shift: int, visits: tuple[int, int], both: str) -> WhyNot | None:
        path = tree_path(self.tree, n, m)
        nodes = path[0::2]
        if len(nodes) > LONGEST_LOOP:
            return None
        loop = impossible_loop(self.tree, path, -shift)
        if loop is None or not (self._all_different(nodes[:-1]) and self._all_different(nodes[1:])):
            return None
        around = self._around(loop, visits)
        text = (
            f"{both}, the way along visits {_listed(around, self._from)} would be a loop that turns by "
            f"{_turns(loop.turning)}; it passes no place twice, and such a loop turns by +1 or -1"
        )
        return WhyNot("loop", visits, text, around=around, turning=loop.turning)

    def _all_different(self, nodes: Sequence[int]) -> bool:
        """Whether no two nodes along a way can be one place; short ways first, which longer ones build on."""
        return all(
            self._are_different(nodes[i], nodes[i + apart])
            for apart in range(1, len(nodes))
            for i in range(len(nodes) - apart)
        )

    def _are_different(self, n: int, m: int) -> bool:
        key = (min(n, m), max(n, m))
        known = self._impossible.get(key)
        if known is None:
            known = self._impossible[key] = self.plain(self._visit(n), self._visit(m)) is not None
        return known

    def _around(self, face: TurningFace, visits: tuple[int, int]) -> tuple[int, ...]:
        return tuple(self._visit(node, visits) for node in face.nodes)


def why_not(found: Hypotheses, i: int, j: int, *, budget: float = 10.0) -> WhyNot | None:
    """Return why two visits are the same place in none of the maps that explain a walk; None if they are in one.

    Parameters
    ----------
    found
        What `hypotheses` returned.
    i, j
        Visits, counted from 0.
    budget
        Seconds for a search, where neither a plain reason nor the maps listed tell.

    Raises
    ------
    BadInput
        For visits that the walk does not have, or not as far as it can be.
    """
    i, j = _checked_visit(found.tree, i), _checked_visit(found.tree, j)
    if any(one.visits[i] == one.visits[j] for one in found.maps):
        return None
    reasons = Reasons(found.tree, found.alike)
    plain = reasons.plain(i, j)
    if plain is not None:
        return plain
    if found.exact and len(found.maps) == found.count:
        number = "no map explains the walk" if not found.count else f"none of {counted(found.count, 'map')}"
        does = "" if not found.count else " that explain the walk has them the same"
        return WhyNot("search", (i, j), f"visits {i + 1} and {j + 1}: {number}{does}; all were searched")
    return reasons.searched(i, j, closed=found.closed, max_places=found.max_places, until=monotonic() + budget)


def _checked_visit(tree: WalkTree, visit: int) -> int:
    """Return a visit, or say why it is none."""
    if isinstance(visit, bool) or not isinstance(visit, int | np.integer) or not 0 <= visit < tree.n_visits:
        raise BadInput(f"visits are numbered 0 to {tree.n_visits - 1}, not {quoted(visit)}")
    return int(visit)


def _listed(visits: Sequence[int], first: int) -> str:
    """Return visits by their numbers; long lists cut in the middle."""
    numbers = [str(visit + first) for visit in visits]
    if len(numbers) > 14:
        numbers = [*numbers[:7], "...", *numbers[-6:]]
    return " ".join(numbers)


def _turns(turning: float) -> str:
    """Return turns as a signed number."""
    nearest = round(turning)
    return (
        f"{nearest:+d}" if nearest and abs(turning - nearest) < 0.02 else "0" if abs(turning) < 0.02 else f"{turning:+.2f}"
    )
