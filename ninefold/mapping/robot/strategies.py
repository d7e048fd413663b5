"""Where to go next: strategies of exploration, which choose an exit from what is known.

A `Strategy` is called at every place, with the map so far, and gives the exit to leave by, or None when it has no more to
do. It sees nothing of the world but that map. The three here walk every way that can be reached; `ask_driven` and
`doubt_driven` of `ninefold.mapping.doubt` have a purpose and stop when it is served.

Random choices are made when they are needed, so that those of a strategy and of whoever walks it can come from one
generator.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

from .open_map import OPEN, nearest, route

if TYPE_CHECKING:
    import numpy as np

    from .open_map import OpenMap

__all__ = ["DepthFirst", "NearestFirst", "Strategy", "WallFollowing"]


class Strategy(Protocol):
    """Chooses the exit to leave by, of the place where the robot is; None: it is done."""

    def __call__(self, known: OpenMap) -> int | None:
        """Return the exit to take, or None."""
        ...


class DepthFirst:
    """Takes new exits first, and goes back the way it came where there is none.

    Parameters
    ----------
    rng
        Shuffles the exits of each place; None takes them counter-clockwise from the way back.

    Notes
    -----
    Every way is walked twice at most. Complexity O(E log E), no recursion.
    """

    def __init__(self, rng: np.random.Generator | None = None) -> None:
        self._rng = rng
        self._untried: dict[int, list[int]] = {}
        self._trail: list[tuple[int, int]] = []
        self._new = False

    def __call__(self, known: OpenMap) -> int | None:
        """Return the exit to take."""
        if known.at not in self._untried:
            self._untried[known.at] = self._choices(known)
            self._trail.append((known.at, known.came))
        elif self._new and known.at != self._trail[-1][0] and known.n_open:
            self._new = False
            return known.came
        if not known.n_open:
            return None
        at, back = self._trail[-1]
        choices = self._untried[at]
        while choices and known.mate[choices[-1]] != OPEN:
            choices.pop()
        self._new = bool(choices)
        if choices:
            return choices.pop()
        self._trail.pop()
        return back

    def _choices(self, known: OpenMap) -> list[int]:
        """Exits to try from a place, the first last."""
        exits = list(known.exits(known.at))
        if self._rng is not None:
            self._rng.shuffle(exits)
            return exits
        at = exits.index(known.came) + 1 if known.came >= 0 else 0
        return (exits[at:] + exits[:at])[::-1]


class NearestFirst:
    """Always goes to the nearest open exit, over ways that it knows: the nearest frontier.

    Parameters
    ----------
    rng
        Breaks ties between exits equally many legs away; None takes the first, counter-clockwise by place as they are found.

    Notes
    -----
    Nearest is the fewest legs. An open exit is a few legs away but for the last ones, so this is near O(E log E); O(E^2) at
    worst.
    """

    def __init__(self, rng: np.random.Generator | None = None) -> None:
        self._rng = rng
        self._route: list[int] = []

    def __call__(self, known: OpenMap) -> int | None:
        """Return the exit to take."""
        if not self._route:
            if not known.n_open:
                return None
            new, came = nearest(known)
            self._route = route(known, came, _one_of(new, self._rng))
        return self._route.pop()


class WallFollowing:
    """Keeps the wall on its right hand, and goes to the nearest open exit where it has followed that wall before.

    At a place it takes the first exit counter-clockwise from the way back: the sharpest turn to the right. So it goes round
    a face, and further faces after it, until no exit is open.

    Parameters
    ----------
    rng
        Chooses the first exit, and breaks ties between nearest open exits; None takes the first, counter-clockwise.

    Notes
    -----
    Along walls every way is walked twice at most, once a direction; the ways to the next wall come on top.
    """

    def __init__(self, rng: np.random.Generator | None = None) -> None:
        self._rng = rng
        self._route: list[int] = []
        self._followed: set[int] = set()

    def __call__(self, known: OpenMap) -> int | None:
        """Return the exit to take."""
        if not known.n_open:
            return None
        if not self._route:
            ahead = known.after(known.came) if known.came >= 0 else -1
            if ahead >= 0 and ahead not in self._followed:
                self._followed.add(ahead)
                return ahead
            new, came = nearest(known)
            self._route = route(known, came, _one_of(new, self._rng))
            self._followed.add(self._route[0])
        return self._route.pop()


def _one_of(exits: list[int], rng: np.random.Generator | None) -> int:
    return exits[0] if rng is None else exits[int(rng.integers(len(exits)))]
