"""Two walks that share a place, as one walk: for robots that recognise no place, so that hypotheses explain both at once.

The one walk is the first; then back along it to the shared place; then back along the second to its beginning, and the
second. Going back along a walk tells nothing new, so whatever maps explain the one walk explain both, and the places they
share are found by the same search as loop closures.
"""

from __future__ import annotations

from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING

from ninefold._wording import quoted
from ninefold.errors import BadInput

from ..robot.walk import Event, Samples, Visit, Walk

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["joined"]


def joined(first: Walk, second: Walk, *, at: tuple[int, int]) -> Walk:
    """Return one walk that has been where two were.

    Parameters
    ----------
    first, second
        Walks with a compass. Names of places mean the same in both; robots that do not share them leave them out.
    at
        The visits, counted from 0, of the first and of the second walk at which both were in one place.

    Raises
    ------
    BadInput
        For a walk without a compass, visits that are none, or two visits that name different places.

    Notes
    -----
    The visits of the first walk keep their numbers. Seconds are left out. Complexity O(samples).

    Examples
    --------
    >>> from ninefold.mapping import Heading, WalkHeader
    >>> east, west = Heading.from_degrees(0), Heading.from_degrees(180)
    >>> one = Walk(WalkHeader(), (Visit(None, (east,)), Samples.of(east), Visit(None, (west, east))))
    >>> two = Walk(WalkHeader(), (Visit(None, (east, west)), Samples.of(east), Visit(None, (west,))))
    >>> joined(one, two, at=(1, 0)).n_legs
    2
    """
    for which, walk in (("first", first), ("second", second)):
        if not isinstance(walk, Walk):
            raise BadInput(f"the {which} is a Walk, such as read_walk gives, not {quoted(walk)}")
        if not walk.header.compass:
            raise BadInput(f"the {which} walk has no compass, so its headings do not fit the other's")
    parts = _legs(first), _legs(second)
    for (visits, _), number, which in zip(parts, at, ("first", "second"), strict=True):
        if isinstance(number, bool) or not isinstance(number, int) or not 0 <= number < len(visits):
            raise BadInput(f"visits of the {which} walk are numbered 0 to {len(visits) - 1}; there is no {quoted(number)}")
    (ours, our_legs), (theirs, their_legs) = parts
    i, j = at
    if None not in (ours[i].place, theirs[j].place) and ours[i].place != theirs[j].place:
        raise BadInput(f"{quoted(ours[i].place)} and {quoted(theirs[j].place)} are two names, so not one place")
    events: list[Event] = [replace(ours[0], t=None)]
    for visit, leg in zip(ours[1:], our_legs, strict=True):
        events += [*(replace(samples, t=None) for samples in leg), replace(visit, t=None)]
    _go_back(events, ours, our_legs, len(ours) - 1, i)
    _go_back(events, theirs, their_legs, j, 0)
    for visit, leg in zip(theirs[1:], their_legs, strict=True):
        events += [*(replace(samples, t=None) for samples in leg), replace(visit, t=None)]
    header = first.header
    if second.header.tolerance > header.tolerance:
        header = replace(header, tolerance=second.header.tolerance)
    return Walk(header, tuple(events))


def _legs(walk: Walk) -> tuple[list[Visit], list[list[Samples]]]:
    """Return the visits of a walk and the samples of the leg after each but the last."""
    visits: list[Visit] = []
    legs: list[list[Samples]] = []
    for event in walk.events:
        if isinstance(event, Visit):
            visits.append(event)
            legs.append([])
        elif not visits:
            raise BadInput("a heading before the first place; a walk begins at a place")
        else:
            legs[-1].append(event)
    if not visits:
        raise BadInput("a walk visits at least one place")
    return visits, legs[:-1]


def _go_back(events: list[Event], visits: Sequence[Visit], legs: Sequence[Sequence[Samples]], start: int, end: int) -> None:
    """Add the way back along a walk from one visit to an earlier one."""
    for number in range(start, end, -1):
        yaw = [one for samples in legs[number - 1] for one in samples.yaw]
        events += [
            Samples(tuple(one + pi for one in reversed(yaw))),
            replace(visits[number - 1], t=None, edge=visits[number].edge),
        ]
