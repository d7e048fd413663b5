"""Every plane map that explains a folded walk, found by splitting faces.

A hypothesis is a quotient of the tree of a walk: nodes merged into places, every exit used by one way, congruent along the
ways walked. It grows from one node as a plane map with stubs, exits behind which the walk goes on but that are not decided
yet. The way through a stub ends at a new place or at another stub *of the same face*: a closure across two faces would add
genus, so these are all the ends there are. The face it closes must turn +1; or -1 if it is all that the outside has. The
stub with the fewest ends is decided next; what contradicts is taken back.

For closed maps, in which no exit is left untravelled, much more can be told early: see `_search_kernels` (kinds of exits,
demand, the turning budget). Which node the search begins with changes nothing in its answer and a lot in its time.

References
----------
F. Savelli and B. Kuipers, Loop-closing and planarity in topological map-building, IROS 2004.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..heading import TAU, wrap_all
from . import _quotient_state as state
from ._quotient_kernels import place_made, put
from ._search_kernels import searched

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .likeness import Likeness
    from .walk_tree import WalkTree

__all__ = ["QuotientSearch", "spread_roots"]

SLICE = 4096
"""Quotients found, and decisions made, between two looks at a budget."""


def spread_roots(tree: WalkTree, most: int) -> list[int]:
    """Return nodes to begin searches with, at most so many: the first, the last, and some evenly between, ascending."""
    return [int(node) for node in np.unique(np.linspace(0, tree.n_nodes - 1, most).astype(int))]


class QuotientSearch:
    """A search that can be stopped and gone on with.

    Parameters
    ----------
    tree, alike
        The walk, and what of it can be the same.
    root
        The node to begin with.
    closed
        Whether no exit may be left untravelled.
    turning
        False judges genus alone; for tests.
    most_places
        Places of a map at most, or None.
    """

    def __init__(
        self,
        tree: WalkTree,
        alike: Likeness,
        *,
        root: int = 0,
        closed: bool = False,
        turning: bool = True,
        most_places: int | None = None,
        fails: NDArray[np.int64] | None = None,
    ) -> None:
        self.tree = tree
        self._state = _quotient(tree, alike, closed=closed, turning=turning, most_places=most_places)
        if fails is not None:
            self._state.node[:, state.FAILS] = fails
        count = tree.n_nodes
        self._control = np.zeros(6, np.int64)
        self._control[state.GOING_DOWN] = 1
        depth = max(count, int((tree.other >= 0).sum()) // 2) + 2  # more ways than nodes, where claims made nodes one
        self._frame = np.zeros((depth, 5), np.int64)
        self._choice = np.empty(depth * (int(tree.degree.sum()) + 2), np.int64)  # pages not used take no memory
        self._best = np.zeros(self._state.option.size, np.int64)
        place = place_made(self._state, root)
        possible = put(self._state, root, place, 0) and alike.shifts.diagonal().all()  # a node differs from itself
        if not possible:
            self._control[state.DONE] = 1

    @property
    def decisions(self) -> int:
        """Decisions made so far."""
        return int(self._control[state.N_DECISIONS])

    @property
    def found(self) -> int:
        """Quotients found so far."""
        return int(self._control[state.N_FOUND])

    @property
    def work(self) -> int:
        """Ends of ways looked at so far: what takes the time, counted alike on every machine."""
        return int(self._state.number[state.WORK])

    @property
    def done(self) -> bool:
        """Whether the search has come to its end: then `found` is the number of quotients."""
        return bool(self._control[state.DONE])

    @property
    def fails(self) -> NDArray[np.int64]:
        """How often every node was in the way: a hint for another search of the same tree."""
        return self._state.node[:, state.FAILS].copy()

    def more(self, decisions: int, most: int = SLICE) -> NDArray[np.int64]:
        """Go on for some decisions; return the quotients found, (B, N, 2): place and shift of every node.

        Notes
        -----
        A decision costs O(stubs of the map times length of their faces).
        """
        if self.done:
            return np.zeros((0, self.tree.n_nodes, 2), np.int64)
        out = np.zeros((most, self.tree.n_nodes, 2), np.int64)
        form = searched.for_work(decisions * 60 * self.tree.n_nodes)
        found = int(form(self._state, self._control, self._frame, self._choice, self._best, out, decisions))
        return out[:found]


def _quotient(tree: WalkTree, alike: Likeness, *, closed: bool, turning: bool, most_places: int | None) -> state.Quotient:
    """Lay out the state of a search."""
    count, width = tree.heading.shape
    places = count + 1
    walked = tree.other >= 0
    node = np.zeros((count, 8), np.int64)
    node[:, state.DEGREE] = tree.degree
    node[:, state.PLACE] = -1
    node[:, state.NEXT] = -1
    node[:, state.SIGN] = alike.signature
    node[:, state.UNITS] = (walked.sum(axis=1) + 1) // 2
    node[:, state.GROUP] = alike.group
    way = np.zeros((count * width, 5), np.int64)
    way[:, state.OTHER] = tree.other.reshape(-1)
    way[:, state.BACK] = tree.back.reshape(-1)
    way[:, state.KIND] = alike.kind.reshape(-1)
    turn = np.where(walked, np.abs(tree.turn) + _slack(tree, alike), 0.0)
    way[:, state.LENGTH] = np.ceil(turn.reshape(-1) / state.MICRO).astype(np.int64)
    way[:, state.BEYOND] = _edges_beyond(tree).reshape(-1)
    angle = np.zeros((count * width, 2))
    angle[:, state.HEADING] = np.nan_to_num(tree.heading).reshape(-1)
    angle[:, state.TURN] = tree.turn.reshape(-1)
    sign, bend = _signatures(tree, alike, node)
    kind, surplus = _sides(tree, alike, sign)
    number = np.zeros(7, np.int64)
    number[state.TURN_LEFT] = int(way[:, state.LENGTH].sum()) // 2
    number[state.RELATIVE] = not tree.compass
    number[state.CLOSED] = closed
    number[state.STRICT] = turning
    limit = np.array([tree.tolerance, most_places or places], np.float64)
    start, candidate = _candidates(tree, alike)
    return state.Quotient(
        node,
        way,
        angle,
        alike.shifts,
        np.zeros((places, 5), np.int64),
        np.full((places * width, 6), -1, np.int64),
        np.zeros((places * width, 2)),
        kind,
        sign,
        bend,
        surplus,
        number,
        limit,
        np.zeros(count, np.int64),
        np.zeros((int(alike.group.max(initial=-1)) + 1, 2), np.int64),
        np.zeros((max(8 * count, int(walked.sum())) + 16, 3), np.int64),
        np.zeros(places * width + 2, np.int64),
        np.zeros(places * width + 2),
        np.zeros(places * width + 2, np.int64),
        np.zeros((surplus.shape[1], 3), np.int64),
        start,
        candidate,
    )


def _edges_beyond(tree: WalkTree) -> NDArray[np.int64]:
    """Return how many edges of the tree one comes to by an exit, its own included, (N, K); 0 where nobody walked."""
    size = np.ones(tree.n_nodes, np.int64)
    parent = np.where(tree.other >= 0, tree.other, tree.n_nodes).min(axis=1)  # nodes are numbered in the order visited
    for n in range(tree.n_nodes - 1, 0, -1):
        size[parent[n]] += size[n]
    down = tree.other > np.arange(tree.n_nodes)[:, None]
    up = ~down & (tree.other >= 0)
    return np.where(down, size[tree.other], np.where(up, tree.n_nodes - size[:, None], 0))


def _slack(tree: WalkTree, alike: Likeness) -> NDArray[np.float64]:
    """Return by how much an edge of the map may turn more than the leg along an exit: its place may have other headings."""
    if not tree.compass:
        return np.full(tree.heading.shape, 4 * tree.tolerance)
    low, high = np.zeros(tree.heading.shape), np.zeros(tree.heading.shape)
    for degree in np.unique(tree.degree).tolist():
        nodes = np.flatnonzero(tree.degree == degree)
        bits = alike.shifts[np.ix_(nodes, nodes)]
        yaw = tree.heading[nodes, :degree]
        for k in range(degree):
            n, m = np.nonzero((bits >> k) & 1)
            off = np.roll(yaw, -k, axis=1)[m] - yaw[n]
            off = wrap_all(off)
            for exit_ in range(degree):
                np.minimum.at(low[:, exit_], nodes[n], off[:, exit_])
                np.maximum.at(high[:, exit_], nodes[n], off[:, exit_])
    here, x = np.nonzero(tree.other >= 0)
    there, y = tree.other[here, x], tree.back[here, x]
    miss = tree.heading[there, y] + np.pi - tree.heading[here, x] - tree.turn[here, x]
    miss = wrap_all(miss)
    slack = np.zeros(tree.heading.shape)
    slack[here, x] = np.maximum(np.abs(miss + high[there, y] - low[here, x]), np.abs(miss + low[there, y] - high[here, x]))
    return slack


def _signatures(tree: WalkTree, alike: Likeness, node: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
    """Return what nodes of each signature have in common, and the largest reflex turn of such a place."""
    width = tree.heading.shape[1]
    count = int(alike.signature.max()) + 1
    sign = np.zeros((count, 3 + width), np.int64)
    bend = np.zeros(count)
    for n in range(tree.n_nodes):
        s, degree = int(alike.signature[n]), int(tree.degree[n])
        sign[s, state.DEGREE_OF_SIGN] = degree
        sign[s, state.KINDS : state.KINDS + degree] = alike.kind[n, :degree]
        sign[s, state.UNITS_LEFT] += node[n, state.UNITS]
        if degree:
            yaw = tree.heading[n, :degree]
            corners = np.diff(np.append(yaw, yaw[0] + TAU))
            reflex = float(np.maximum(corners - np.pi, 0.0).sum()) if degree > 1 else np.pi
            bend[s] = max(bend[s], reflex)
    return sign, bend


def _sides(tree: WalkTree, alike: Likeness, sign: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Colour the kinds of exits with two sides so that every way joins the two, where that can be done.

    Returns the table of kinds and, per signature and component, how many exits of one side its places have beyond the other.
    """
    beside: list[set[int]] = [set() for _ in range(alike.n_kinds)]
    kind = np.zeros((alike.n_kinds, 4), np.int64)
    kind[:, state.COMPONENT] = -1
    n, x = np.nonzero(tree.other >= 0)
    here, there = alike.kind[n, x], alike.kind[tree.other[n, x], tree.back[n, x]]
    np.add.at(kind[:, state.ENDS], here, 1)
    for a, b in set(zip(here.tolist(), there.tolist(), strict=True)):
        beside[a].add(b)
    components = 0
    side = [0] * alike.n_kinds
    for first in range(alike.n_kinds):
        if side[first] or not beside[first]:
            continue
        side[first], two_sided = 1, True
        members = [first]
        for a in members:
            for b in beside[a]:
                if not side[b]:
                    side[b] = -side[a]
                    members.append(b)
                two_sided &= side[b] != side[a]
        if two_sided:
            kind[members, state.COMPONENT] = components
            kind[members, state.SIDE] = [side[a] for a in members]
            components += 1
    surplus = np.zeros((sign.shape[0], max(components, 1)), np.int64)
    for s in range(sign.shape[0]):
        for k in sign[s, state.KINDS : state.KINDS + sign[s, state.DEGREE_OF_SIGN]].tolist():
            if kind[k, state.COMPONENT] >= 0:
                surplus[s, kind[k, state.COMPONENT]] += kind[k, state.SIDE]
    return kind, surplus[:, :components] if components else surplus[:, :0]


def _candidates(tree: WalkTree, alike: Likeness) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return, for every exit of a node, the walked exits of nodes that could be it: where each begins, and all of them."""
    count, width = tree.heading.shape
    owner: list[NDArray[np.int64]] = []
    found: list[NDArray[np.int64]] = []
    for degree in np.unique(tree.degree).tolist():
        nodes = np.flatnonzero(tree.degree == degree)
        bits = alike.shifts[np.ix_(nodes, nodes)]
        for k in range(degree):
            n, m = np.nonzero((bits >> k) & 1)
            for x in range(degree):
                y = (x + k) % degree
                walked = tree.other[nodes[m], y] >= 0
                owner.append(nodes[n[walked]] * width + x)
                found.append(nodes[m[walked]] * width + y)
    if not owner:
        return np.zeros(count * width + 1, np.int64), np.zeros(1, np.int64)
    exits, others = np.concatenate(owner), np.concatenate(found)
    order = np.argsort(exits, kind="stable")
    start = np.searchsorted(exits[order], np.arange(count * width + 1)).astype(np.int64)
    return start, np.append(others[order], 0).astype(np.int64)
