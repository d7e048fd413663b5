"""A walk through places that are not recognised, folded to a plane tree.

Every visit lists its exits. A robot that leaves by an exit it knows to lead somewhere comes to where it was before: by a
U-turn, or back along the way it came. Visits that this makes the same are one *node*. What is left is a tree: its nodes are
the places as far as they can be told apart for certain, its edges the ways walked. Every map that explains the walk is a
quotient of this tree, so whatever is not decided by folding is decided by which nodes are one place.

Exits are numbered counter-clockwise from 0. With a compass their headings are held against the same direction everywhere.
Without one they are held against each other: only the angles between the exits of a node, and the net turn along a way, mean
something.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import pi
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import WalkError, located

from ..heading import TAU, wrap
from ..robot.legs import LegReader
from ..robot.units import unit_of
from ..robot.walk import Visit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..robot.legs import Leg
    from ..robot.units import Unit
    from ..robot.walk import Walk

__all__ = ["MOST_EXITS", "Contradiction", "WalkTree", "fold"]

MOST_EXITS = 62
"""Exits of a place: the shifts of one list against another are bits of a word."""


@dataclass(frozen=True, slots=True)
class Contradiction:
    """Why a stretch of the walk cannot be, whatever is the same place.

    Attributes
    ----------
    first, last
        Visits, counted from 0, of the stretch that shows it: it cannot be shortened at either end.
    text
        In words.
    """

    first: int
    last: int
    text: str


@dataclass(frozen=True, slots=True)
class WalkTree:
    """A folded walk of N nodes, at most K exits each.

    Attributes
    ----------
    degree
        (N,) int64, exits of every node.
    heading
        (N, K) float64, yaw of every exit, radians, counter-clockwise from the least one; NaN beyond the degree.
    other, back
        (N, K) int64, the node that an exit leads to and the exit by which it is reached there; -1 where nobody walked.
    turn
        (N, K) float64, net rotation along the way out of an exit, radians; 0 where nobody walked.
    node_of, shift_of
        (T,) int64, the node of every visit, and the exit of the node that the visit lists first.
    taken
        (T - 1,) int64, the exit of its node by which every visit is left.
    names
        Of every node, the name of its place, or None where it was not recognised.
    compass
        Whether headings of different nodes can be compared.
    tolerance
        Radians within which two headings may be of one exit.
    contradiction
        Why the walk cannot be, if folding alone shows it; the tree then ends before.
    """

    degree: NDArray[np.int64]
    heading: NDArray[np.float64]
    other: NDArray[np.int64]
    back: NDArray[np.int64]
    turn: NDArray[np.float64]
    node_of: NDArray[np.int64]
    shift_of: NDArray[np.int64]
    taken: NDArray[np.int64]
    names: tuple[str | None, ...]
    compass: bool
    tolerance: float
    contradiction: Contradiction | None = None

    @property
    def n_nodes(self) -> int:
        """Number of nodes."""
        return self.degree.size

    @property
    def n_visits(self) -> int:
        """Number of visits folded."""
        return self.node_of.size


class _Growing:
    """A tree in the making: lists a node long."""

    def __init__(self, tolerance: float, *, compass: bool, unit: Unit, first: int) -> None:
        self.tolerance, self.compass, self.unit, self.first = tolerance, compass, unit, first
        self.exits: list[list[float]] = []
        self.ways: list[list[tuple[int, int, float] | None]] = []
        self.names: list[str | None] = []
        self.seen: list[int] = []

    def node(self, exits: list[float], name: str | None, visit: int) -> int:
        self.exits.append(exits)
        self.ways.append([None] * len(exits))
        self.names.append(name)
        self.seen.append(visit)
        return len(self.exits) - 1


def fold(walk: Walk, *, tolerance: float | None = None, first: int = 0) -> WalkTree:
    """Fold a walk.

    Parameters
    ----------
    tolerance
        Radians within which two headings may be of one exit, instead of the header's.
    first
        Which number a contradiction gives to the first visit: of a stretch of a longer walk, its number there, from 0.

    Raises
    ------
    WalkError
        For a visit without its exits, two exits in one direction, a leg that leaves or arrives by none of the exits or by
        either of two, a place with more than `MOST_EXITS` exits; with the number of the event, counted from 1.

    Notes
    -----
    Complexity O(samples + visits times exits).
    """
    unit = unit_of(walk.header.heading)
    allowed = walk.header.tolerance if tolerance is None else tolerance
    tree = _Growing(allowed, compass=walk.header.compass, unit=unit, first=first)
    reader = LegReader(unit)
    node_of: list[int] = []
    shift_of: list[int] = []
    taken: list[int] = []
    listed: list[float] = []
    wrong: Contradiction | None = None
    for number, event in enumerate(walk.events, 1):
        try:
            if not isinstance(event, Visit):
                if not node_of:
                    raise WalkError("a heading before the first place; a walk begins at a place")
                reader.take(event.yaw, event.metres)
                continue
            exits = _exits(event, unit)
            if not node_of:
                node_of.append(tree.node(exits, event.place, 0))
                shift_of.append(0)
                listed = exits
                continue
            if not reader.started:
                raise WalkError("two places with no heading between them; a leg has at least one sample")
            leg = reader.finish()
            left = _exit_near(listed, leg.out, allowed, unit, "leaves by")
            reached = _exit_near(exits, leg.back, allowed, unit, "arrives by")
        except WalkError as error:
            raise located(error, f"event {number}", event=number) from None
        visit = len(node_of)
        here = node_of[-1]
        out = (left + shift_of[-1]) % len(tree.exits[here])
        wrong = _step(tree, visit, here, out, exits, reached, leg, event.place, node_of, shift_of)
        if wrong is not None:
            break
        taken.append(out)
        listed = exits
    if not node_of:
        raise WalkError("there is no map before the first place; a walk visits at least one")
    return _tree(tree, node_of, shift_of, taken, wrong)


def _step(
    tree: _Growing,
    visit: int,
    here: int,
    out: int,
    exits: list[float],
    reached: int,
    leg: Leg,
    name: str | None,
    node_of: list[int],
    shift_of: list[int],
) -> Contradiction | None:
    """Go one leg on; return why that cannot be, or None."""
    way = tree.ways[here][out]
    if way is None:
        there = tree.node(exits, name, visit)
        tree.ways[here][out] = (there, reached, leg.turn)
        tree.ways[there][reached] = (here, out, -leg.turn)
        node_of.append(there)
        shift_of.append(0)
        return None
    there, back, turn = way
    before, now = tree.first + tree.seen[there], tree.first + visit
    count = len(tree.exits[there])
    if len(exits) != count:
        return Contradiction(
            before,
            now,
            f"visit {now + 1} must be the place of visit {before + 1}, which lists {counted(count, 'exit')} and not "
            f"{len(exits)}",
        )
    shift = (back - reached) % count
    if not _alike(exits, tree.exits[there], shift, tree.tolerance, compass=tree.compass):
        return Contradiction(
            before,
            now,
            f"visit {now + 1} must be the place of visit {before + 1}, whose exits lie at "
            f"{tree.unit.headings(tree.exits[there])} and not at {tree.unit.headings(exits)}",
        )
    if not abs(leg.turn - turn) < (pi if tree.compass else 2 * tree.tolerance + 1e-9):
        return Contradiction(
            tree.first + tree.seen[max(here, there)] - 1,
            now,
            f"visit {now + 1} must be the place of visit {before + 1}, and the way there turns by {tree.unit.angle(turn)} "
            f"and not by {tree.unit.angle(leg.turn)}",
        )
    if name is not None:
        if tree.names[there] not in (None, name):
            return Contradiction(
                before,
                now,
                f"visit {now + 1}, called {quoted(name)}, must be the place of visit {before + 1}, called "
                f"{quoted(tree.names[there])}",
            )
        tree.names[there] = name
    node_of.append(there)
    shift_of.append(shift)
    return None


def _exits(event: Visit, unit: Unit) -> list[float]:
    """Return the exits of a visit counter-clockwise from the least yaw."""
    if event.exits is None:
        raise WalkError("the exits of the place are not listed; where places are not recognised, every visit lists them")
    if len(event.exits) > MOST_EXITS:
        raise WalkError(f"{len(event.exits)} exits; a place has at most {MOST_EXITS} here")
    exits = sorted(heading.yaw for heading in event.exits)
    for yaw, after in pairwise([*exits, exits[0] + TAU] if len(exits) > 1 else []):
        if after == yaw:
            raise WalkError(f"two exits at {unit.heading(yaw)}, so nobody can tell which of them a leg takes")
    return exits


def _exit_near(exits: list[float], yaw: float, tolerance: float, unit: Unit, does: str) -> int:
    """Return the exit by which a leg leaves or arrives: the nearest, which must lie within the tolerance."""
    if not exits:
        raise WalkError(f"the leg {does} {unit.heading(yaw)}, and no exit is listed there")
    misses = [abs(wrap(yaw - one)) for one in exits]
    best, *others = sorted(range(len(exits)), key=misses.__getitem__)
    if misses[best] > tolerance:
        raise WalkError(
            f"the leg {does} {unit.heading(yaw)}, and the nearest of the exits {unit.headings(exits)} is "
            f"{unit.angle(misses[best])} off; the tolerance is {unit.angle(tolerance)}"
        )
    if others and misses[others[0]] <= min(tolerance, 2 * misses[best]):
        raise WalkError(
            f"the leg {does} {unit.heading(yaw)}, which may be the exit at {unit.heading(exits[best])} or at "
            f"{unit.heading(exits[others[0]])}; nobody can tell which of them a leg takes"
        )
    return best


def _alike(exits: list[float], others: list[float], shift: int, tolerance: float, *, compass: bool) -> bool:
    """Whether exits can be those of another visit, the first being the other's number `shift`."""
    count = len(exits)
    misses = [wrap(others[(i + shift) % count] - yaw) for i, yaw in enumerate(exits)]
    if compass:
        return all(abs(miss) <= tolerance for miss in misses)
    apart = [wrap(miss - misses[0]) for miss in misses]  # some common turn takes all of them within the tolerance
    return max(apart) - min(apart) <= 2 * tolerance


def _tree(
    tree: _Growing, node_of: list[int], shift_of: list[int], taken: list[int], wrong: Contradiction | None
) -> WalkTree:
    count = len(tree.exits)
    most = max(1, *(len(exits) for exits in tree.exits))
    heading = np.full((count, most), np.nan)
    other = np.full((count, most), -1, np.int64)
    back = np.full((count, most), -1, np.int64)
    turn = np.zeros((count, most))
    for n, exits in enumerate(tree.exits):
        heading[n, : len(exits)] = exits
        for x, way in enumerate(tree.ways[n]):
            if way is not None:
                other[n, x], back[n, x], turn[n, x] = way
    return WalkTree(
        np.array([len(exits) for exits in tree.exits], np.int64),
        heading,
        other,
        back,
        turn,
        np.array(node_of, np.int64),
        np.array(shift_of, np.int64),
        np.array(taken, np.int64),
        tuple(tree.names),
        tree.compass,
        tree.tolerance,
        wrong,
    )
