"""The open map of a walk, a hypothesis or a plane map: with the exits that nobody has walked, as far as they are known."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

from ..heading import TAU, wrap
from ..numbering import Vertex
from ..plane import PlaneMap
from ..robot.open_map import OpenMap
from ..robot.walk import Walk
from .hypotheses import Hypothesis
from .likeness import likeness
from .quotients import QuotientSearch
from .walk_tree import fold

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .walk_tree import WalkTree

__all__ = ["open_map"]

DECISIONS = 1_000_000
"""Decisions after which a walk without a compass is given up."""


def open_map(source: OpenMap | Walk | PlaneMap | Hypothesis) -> OpenMap:
    """Return what a source knows, with its open exits.

    Parameters
    ----------
    source
        A walk that names all its places and lists their exits; a hypothesis of any walk; a plane map with headings, which
        does not know of exits that nobody walked.

    Raises
    ------
    BadInput
        For a walk whose places are not all named, or that has no or several maps; a plane map without headings or with
        several components.

    Examples
    --------
    >>> from ninefold.mapping import SimulatedWorld, explore
    >>> cross = SimulatedWorld([(0, 0), (1, 0), (0, 1), (-1, 0), (0, -1)], [(0, 1), (0, 2), (0, 3), (0, 4)])
    >>> walk = explore(cross, start=1).walk
    >>> part = Walk(walk.header, walk.events[:3])
    >>> known = open_map(part)
    >>> known.n_places, known.n_open
    (2, 3)
    """
    match source:
        case OpenMap():
            return source
        case Hypothesis():
            return _of_quotient(source.tree, source.place, source.shift)
        case Walk():
            return _of_walk(source)
        case PlaneMap():
            return _of_plane(source)
    raise BadInput(f"a map to lay over another is a Walk, OpenMap, Hypothesis or PlaneMap, not {quoted(source)}")


def _of_walk(walk: Walk) -> OpenMap:
    tree = fold(walk)
    if tree.contradiction is not None:
        raise BadInput(f"no map explains the walk: {tree.contradiction.text}")
    if None in tree.names:
        visit = int(np.flatnonzero(tree.node_of == tree.names.index(None))[0])
        raise BadInput(
            f"visit {visit + 1} of the walk names no place; take one of its hypotheses, as hypotheses(walk) gives them"
        )
    if tree.compass:
        return _of_quotient(tree, *_by_names(tree))
    search = QuotientSearch(tree, likeness(tree))
    found: list[NDArray[np.int64]] = []
    while not search.done and len(found) < 2 and search.decisions < DECISIONS:
        found.extend(search.more(4096, most=2))
    if len(found) != 1 or not search.done:
        number = "no map explains" if not found else "more than one map explains"
        raise BadInput(f"{number} the walk; without a compass names alone need not tell how the exits of a place are turned")
    return _of_quotient(tree, found[0][:, 0], found[0][:, 1])


def _by_names(tree: WalkTree) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return place and shift of every node: nodes of one name are one place, their exits one by their headings."""
    lead: dict[str | None, int] = {}
    place = np.zeros(tree.n_nodes, np.int64)
    shift = np.zeros(tree.n_nodes, np.int64)
    for n, name in enumerate(tree.names):
        first = lead.setdefault(name, n)
        place[n] = first
        degree = int(tree.degree[n])
        if degree != tree.degree[first]:
            raise BadInput(f"{quoted(name)} has {tree.degree[first]} exits at one visit of the walk and {degree} at another")
        if degree:
            ours, theirs = tree.heading[first, :degree], tree.heading[n, :degree]
            misses = [np.abs((np.roll(ours, -k) - theirs + np.pi) % TAU - np.pi).max() for k in range(degree)]
            shift[n] = int(np.argmin(misses))
            if misses[shift[n]] > tree.tolerance + 1e-9:
                raise BadInput(f"the exits of {quoted(name)} do not lie alike at two visits of the walk")
    return place, shift


def _of_quotient(tree: WalkTree, place: NDArray[np.int64], shift: NDArray[np.int64]) -> OpenMap:
    """Return the open map of a quotient; exits are those of the first node of every place."""
    _, lead, place = np.unique(place, return_index=True, return_inverse=True)
    shift = shift - shift[lead[place]]
    known = OpenMap(compass=tree.compass)
    for w, n in enumerate(lead.tolist()):
        names = {tree.names[m] for m in np.flatnonzero(place == w)} - {None}
        known.see(tree.heading[n, : tree.degree[n]].tolist(), names.pop() if names else None)
    for n, x in zip(*(rows.tolist() for rows in np.nonzero(tree.other >= 0)), strict=True):
        m, y = int(tree.other[n, x]), int(tree.back[n, x])
        out = known.first[place[n]] + int((x + shift[n]) % tree.degree[n])
        back = known.first[place[m]] + int((y + shift[m]) % tree.degree[m])
        try:
            known.join(out, back, float(tree.turn[n, x]))
        except BadInput:
            here, there = known.name(int(place[n])), known.name(int(place[m]))
            raise BadInput(
                f"an exit of {quoted(here)} or {quoted(there)} leads to two places: the way that joins them, and another"
            ) from None
    return known


def _of_plane(plane: PlaneMap) -> OpenMap:
    heading, turn = plane.heading, plane.turn
    if heading is None or turn is None:
        raise BadInput("the plane map has no headings, so its places cannot be compared with another map's")
    if plane.tether.any():
        raise BadInput("the plane map has several components; robots that walked share one")
    known = OpenMap(complete=False)
    exit_of: dict[int, int] = {}
    yaw = [wrap(one) for one in heading.tolist()]
    for v in range(plane.n_vertices):
        darts = sorted(plane.darts_at(Vertex(v)), key=yaw.__getitem__)
        exit_of.update({d: known.first[-1] + k for k, d in enumerate(darts)})
        known.see([yaw[d] for d in darts], plane.vertex_names[v])
    for e in range(plane.n_edges):
        known.join(exit_of[2 * e], exit_of[2 * e + 1], float(turn[e]))
    return known
