"""The smallest stretch of a walk that already cannot be, where no plane map explains the whole.

A map of a walk holds a map of every stretch of it. So what shows that a stretch cannot be, shows it of all that hold it: the
end of the shortest beginning that cannot be is found by halving, and then its latest start.
"""

from __future__ import annotations

from time import monotonic
from typing import TYPE_CHECKING

from ninefold._wording import quoted

from ..robot.walk import Visit, Walk
from .existence import some_map
from .likeness import likeness
from .walk_tree import Contradiction, fold
from .why_not import Reasons

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from .likeness import Likeness
    from .walk_tree import WalkTree

__all__ = ["smallest_stretch", "stretch_of"]


def stretch_of(walk: Walk, first: int, last: int) -> Walk:
    """Return the part of a walk from one visit to another, counted from 0, both included."""
    at = [k for k, event in enumerate(walk.events) if isinstance(event, Visit)]
    return Walk(walk.header, walk.events[at[first] : at[last] + 1])


def smallest_stretch(
    walk: Walk,
    *,
    tolerance: float | None = None,
    max_places: int | None = None,
    same: Iterable[tuple[int, int]] = (),
    differ: Iterable[tuple[int, int]] = (),
    until: float | None = None,
) -> Contradiction | None:
    """Return the smallest stretch of a walk that no plane map explains.

    Parameters
    ----------
    max_places
        Places of a map at most.
    same, differ
        Pairs of visits known to be one place, or two; those within a stretch count.
    until
        When to give up, on the clock of `time.monotonic`: then the smallest stretch found so far is returned.

    Returns
    -------
    Contradiction or None
        None if a map explains the walk, or it was not found out in time whether one does. Taking a visit off either end
        leaves a stretch that some map explains.

    Notes
    -----
    Complexity O(log(visits)) searches for a first map.
    """
    pairs, others = tuple(same), tuple(differ)

    def tree_of(first: int, last: int) -> tuple[WalkTree, Likeness]:
        tree = fold(stretch_of(walk, first, last), tolerance=tolerance, first=first)
        nodes = [_within(tree, known, first, last) for known in (pairs, others)]
        return tree, likeness(tree, same=nodes[0], differ=nodes[1])

    def cannot_be(first: int, last: int) -> bool:
        tree, alike = tree_of(first, last)
        return some_map(tree, alike, max_places=max_places, until=until) is False

    visits = sum(isinstance(event, Visit) for event in walk.events)
    if not visits or not cannot_be(0, visits - 1):
        return None
    last = _least(lambda end: cannot_be(0, end), 0, visits - 1, until)
    first = last - _least(lambda legs: cannot_be(last - legs, last), 0, last, until)
    tree, alike = tree_of(first, last)
    return Contradiction(first, last, _reason(tree, alike, first, last, max_places))


def _least(holds: Callable[[int], bool], low: int, high: int, until: float | None) -> int:
    """Return the least number from which on something holds, which does for `high`; a greater one if the time is spent."""
    while low < high and not (until is not None and monotonic() > until):
        middle = (low + high) // 2
        if holds(middle):
            high = middle
        else:
            low = middle + 1
    return high


def _within(tree: WalkTree, pairs: Sequence[tuple[int, int]], first: int, last: int) -> list[tuple[int, int]]:
    """Return the nodes of pairs of visits that a stretch holds, as far as it could be folded."""
    most = min(last, first + tree.n_visits - 1)
    return [
        (int(tree.node_of[a - first]), int(tree.node_of[b - first]))
        for a, b in pairs
        if first <= min(a, b) and max(a, b) <= most
    ]


def _reason(tree: WalkTree, alike: Likeness, first: int, last: int, max_places: int | None) -> str:
    """Return in words why a stretch cannot be; visits are counted from 1, in the whole walk."""
    if tree.contradiction is not None:
        return tree.contradiction.text
    ends = int(tree.node_of[0]), int(tree.node_of[-1])
    stretch = f"no plane map has visits {first + 1} to {last + 1}"
    if alike.group[ends[0]] >= 0 and alike.group[ends[0]] == alike.group[ends[1]]:
        name = tree.names[ends[0]]
        known = "known to be the same place" if name is None else f"both called {quoted(name)}"
        found = Reasons(tree, alike, first=first).plain(0, tree.n_visits - 1)
        if found is not None:
            return f"visits {first + 1} and {last + 1} are {known}; {found.text}"
        return f"{stretch}, the first and the last of which are {known}"
    return (
        f"{stretch} with so few places" if max_places is not None else f"{stretch} with what is known to be the same place"
    )
