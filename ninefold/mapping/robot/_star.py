"""The directions at one place: darts travelled and exits not yet taken, sorted by yaw."""

from __future__ import annotations

from bisect import bisect_left
from math import pi, remainder

from ..heading import TAU

__all__ = ["NONE", "OPEN", "TIE", "Star"]

NONE = -1
"""No direction is near."""
TIE = -2
"""Too many directions are near, or one that is neither near nor far."""
OPEN = -1
"""Stands for the dart of an exit that was never travelled."""


class Star:
    """Directions at a place.

    Attributes
    ----------
    yaws, darts
        Parallel lists, ascending yaw in (-pi, pi]; the dart, or `OPEN`.
    declared
        Whether the exits were seen, so that there can be no other direction.
    """

    __slots__ = ("darts", "declared", "yaws")

    def __init__(self) -> None:
        self.yaws: list[float] = []
        self.darts: list[int] = []
        self.declared = False

    def fork(self) -> Star:
        """Return a star of the same directions that changes on its own. O(degree)."""
        other = Star()
        other.declared = self.declared
        other.yaws, other.darts = self.yaws.copy(), self.darts.copy()
        return other

    def find(self, yaw: float, tolerance: float) -> int:
        """Return the index of the one direction within `tolerance` that has no other within twice that, `NONE` or `TIE`.

        O(log degree).
        """
        yaws = self.yaws
        n = len(yaws)
        if not n:
            return NONE
        at = bisect_left(yaws, yaw)
        wide = 2 * tolerance
        below = yaw - yaws[at - 1] if at else yaw - yaws[-1] + TAU
        above = yaws[at] - yaw if at < n else yaws[0] - yaw + TAU
        if below > wide and above > wide:
            return NONE
        near = [k for k in {(at - 2) % n, (at - 1) % n, at % n, (at + 1) % n} if abs(remainder(yaws[k] - yaw, TAU)) <= wide]
        if len(near) == 1 and abs(remainder(yaws[near[0]] - yaw, TAU)) <= tolerance:
            return near[0]
        return TIE

    def near(self, yaw: float, width: float) -> list[int]:
        """Return the indices of all directions within `width`, the nearest first. O(degree)."""
        gaps = sorted((abs(remainder(y - yaw, TAU)), k) for k, y in enumerate(self.yaws))
        return [k for gap, k in gaps if gap <= width]

    def before(self, yaw: float, previous: list[int]) -> int:
        """Return the travelled dart next clockwise of `yaw`, or `OPEN` if no dart was travelled.

        Looks both ways at once, so that it is quick where either neighbour is near; `previous` links the travelled ones.
        """
        darts = self.darts
        n = len(darts)
        at = bisect_left(self.yaws, yaw)
        for k in range(n):
            dart = darts[(at - 1 - k) % n]
            if dart >= 0:
                return dart
            dart = darts[(at + k) % n]
            if dart >= 0:
                return previous[dart]
        return OPEN

    def put(self, index: int, yaw: float, dart: int) -> None:
        """Enter a dart: in place of the open exit at `index`, or beside the others if that is `NONE`."""
        if index >= 0:
            del self.yaws[index], self.darts[index]
        at = bisect_left(self.yaws, yaw)
        self.yaws.insert(at, yaw)
        self.darts.insert(at, dart)

    def move(self, old: float, new: float) -> None:
        """Refine the yaw of a direction. The cyclic order stays; at the cut the list turns by one."""
        at = bisect_left(self.yaws, old)
        if abs(new - old) < pi:
            self.yaws[at] = new
        else:
            self.put(at, new, self.darts[at])

    def agrees(self, exits: list[float], tolerance: float) -> bool:
        """Whether ascending exits are these directions: as many, each within `tolerance`, in cyclic order."""
        yaws = self.yaws
        n = len(yaws)
        if len(exits) != n:
            return False
        for shift in (0, -1, 1):  # a direction may have crossed the cut
            if all(abs(remainder(exits[(k + shift) % n] - yaws[k], TAU)) <= tolerance for k in range(n)):
                return True
        return False

    def farthest(self, exits: list[float]) -> float:
        """Return how far ascending exits, as many as here, are from these directions at most, in the best cyclic order."""
        yaws, n = self.yaws, len(self.yaws)
        shifts = (0, -1, 1)
        return min(max(abs(remainder(exits[(k + s) % n] - yaws[k], TAU)) for k in range(n)) for s in shifts) if n else 0.0

    def with_exits(self, exits: list[float], tolerance: float) -> Star | int:
        """Return a declared star: the darts known so far and an open exit for every other one.

        If a dart has not exactly one exit within `tolerance`, its index is returned instead.
        """
        taken = [False] * len(exits)
        for index, yaw in enumerate(self.yaws):
            near = [k for k, y in enumerate(exits) if abs(remainder(y - yaw, TAU)) <= tolerance]
            if len(near) != 1 or taken[near[0]]:
                return index
            taken[near[0]] = True
        star = self.fork()
        star.declared = True
        for used, yaw in zip(taken, exits, strict=True):
            if not used:
                star.put(NONE, yaw, OPEN)
        return star
