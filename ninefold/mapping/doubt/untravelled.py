"""A hypothesis with the exits that nobody walked: each becomes a way to a place of its own, of which nothing is known."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ..heading import wrap
from .hypotheses import plane_of

if TYPE_CHECKING:
    from ..plane import PlaneMap
    from .hypotheses import Hypothesis

__all__ = ["WithEnds", "with_ends"]


@dataclass(frozen=True, slots=True)
class WithEnds:
    """The map of a hypothesis and, beside it, the unknown places behind its untravelled exits.

    Attributes
    ----------
    plane
        The map; vertices from `n_places` on are the unknown ones, each a dead end.
    n_places
        Number of places that were visited.
    """

    plane: PlaneMap
    n_places: int

    @property
    def unknown(self) -> tuple[str, ...]:
        """The names of the unknown places."""
        return tuple(self.plane.vertex_names[v] for v in range(self.n_places, self.plane.n_vertices))


def with_ends(one: Hypothesis) -> WithEnds:
    """Return the map of a hypothesis with a dead end behind every exit that nobody walked. O(E)."""
    tree, width = one.tree, one.tree.heading.shape[1]
    lead = np.unique(one.place, return_index=True)[1]
    used = np.zeros((lead.size, width), np.bool_)
    n, x = np.nonzero(tree.other >= 0)
    used[one.place[n], (x + one.shift[n]) % tree.degree[n]] = True
    place, x = np.nonzero(~used & (np.arange(width) < tree.degree[lead][:, None]))
    ends = np.arange(tree.n_nodes, tree.n_nodes + place.size)
    heading = np.full((place.size, width), np.nan)
    heading[:, 0] = [wrap(float(yaw) + np.pi) for yaw in tree.heading[lead[place], x]]
    other, back = np.full((place.size, width), -1, np.int64), np.full((place.size, width), -1, np.int64)
    other[:, 0], back[:, 0] = lead[place], x
    mine, theirs = tree.other.copy(), tree.back.copy()
    mine[lead[place], x], theirs[lead[place], x] = ends, 0
    wider = replace(
        tree,
        degree=np.concatenate([tree.degree, np.ones(place.size, np.int64)]),
        heading=np.concatenate([tree.heading, heading]),
        other=np.concatenate([mine, other]),
        back=np.concatenate([theirs, back]),
        turn=np.concatenate([tree.turn, np.zeros((place.size, width))]),
        names=(*tree.names, *(None for _ in ends)),
    )
    numbers = np.concatenate([one.place, lead.size + np.arange(place.size)])
    shifts = np.concatenate([one.shift, np.zeros(place.size, np.int64)])
    return WithEnds(plane_of(wider, numbers, shifts), lead.size)
