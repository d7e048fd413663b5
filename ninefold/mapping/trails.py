"""Trails: a line cut into the fewest walks that use no edge twice.

Every vertex of odd degree ends exactly one open trail, so the ends of the open trails are the line's boundary; a piece
without odd vertices is one closed trail. That is the form in which a geometry library should be asked about a line: GEOS up
to 3.14 overlooks boundary points of a MultiLineString when an even vertex of another part is met first (JTS issue 1175),
and here no end of an open part is even.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from .numbering import Dart

if TYPE_CHECKING:
    from .sets import Line

__all__ = ["trails"]


def trails(line: Line) -> tuple[tuple[Dart, ...], ...]:
    """Cut a line into trails, each a tuple of darts; open ones first, by lowest end.

    Notes
    -----
    Hierholzer's algorithm, O(edges).

    Examples
    --------
    >>> from ninefold.mapping import PlaneMap
    >>> star = PlaneMap.from_rotation({"o": ["a", "b", "c"], "a": ["o"], "b": ["o"], "c": ["o"]})
    >>> trails(star.line(["0", "1", "2"]))
    ((0,), (3, 4))
    """
    tail = line.plane.tail
    at: dict[int, list[Dart]] = {v: [] for v in sorted(line.star)}
    for e in reversed(line.edges):
        for d in (2 * e + 1, 2 * e):
            at[int(tail[d])].append(Dart(d))
    used: set[int] = set()

    def advance(v: int) -> list[Dart]:
        """Walk from v along unused edges until stuck."""
        walk: list[Dart] = []
        while True:
            while at[v] and at[v][-1] >> 1 in used:
                at[v].pop()
            if not at[v]:
                return walk
            d = at[v].pop()
            used.add(d >> 1)
            walk.append(d)
            v = int(tail[d ^ 1])

    def completed(walk: list[Dart]) -> tuple[Dart, ...]:
        """Splice in, at each vertex the walk passes, the closed walk that is still left there."""
        done: list[Dart] = []
        ahead = walk[::-1]
        v = int(tail[walk[0]])
        while True:
            ahead += advance(v)[::-1]
            if not ahead:
                return tuple(done)
            done.append(ahead.pop())
            v = int(tail[done[-1] ^ 1])

    walks = [advance(v) for v in at if v in line.boundary and any(d >> 1 not in used for d in at[v])]
    result = [completed(walk) for walk in walks]
    # What is left are pieces without odd vertices.
    result.extend(completed(round_trip) for v in at if (round_trip := advance(v)))
    return tuple(result)
