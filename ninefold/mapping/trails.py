"""Trails: a line cut into the fewest walks that use no edge twice.

Every vertex of odd degree ends exactly one open trail, so the ends of the open trails are the line's boundary; a piece
without odd vertices is one closed trail. That is the form in which a geometry library should be asked about a line: GEOS up
to 3.14 overlooks boundary points of a MultiLineString when an even vertex of another part is met first (JTS issue 1175),
and here no end of an open part is even.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .sets import Line

__all__ = ["trails"]


def trails(line: Line) -> tuple[tuple[int, ...], ...]:
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
    at: dict[int, list[int]] = {v: [] for v in sorted(line.star)}
    for e in reversed(line.edges):
        for d in (2 * e + 1, 2 * e):
            at[int(tail[d])].append(d)
    used: set[int] = set()

    def advance(v: int) -> list[int]:
        """Walk from v along unused edges until stuck."""
        walk: list[int] = []
        while True:
            while at[v] and at[v][-1] >> 1 in used:
                at[v].pop()
            if not at[v]:
                return walk
            d = at[v].pop()
            used.add(d >> 1)
            walk.append(d)
            v = int(tail[d ^ 1])

    walks = [advance(v) for v in at if v in line.boundary and any(d >> 1 not in used for d in at[v])]
    through = {int(tail[d]): i for i, walk in enumerate(walks) for d in (*walk, walk[-1] ^ 1)}
    for v in at:
        while round_trip := advance(v):
            # A closed walk left over: spliced into a walk that passes one of its vertices, else a trail of its own.
            place = next((k for k, d in enumerate(round_trip) if int(tail[d]) in through), None)
            if place is None:
                i = len(walks)
                walks.append(round_trip)
            else:
                loop = round_trip[place:] + round_trip[:place]
                start = int(tail[loop[0]])
                i = through[start]
                cut = next((k for k, d in enumerate(walks[i]) if int(tail[d]) == start), len(walks[i]))
                walks[i][cut:cut] = loop
            through.update((int(tail[d]), i) for d in round_trip)
    return tuple(map(tuple, walks))
