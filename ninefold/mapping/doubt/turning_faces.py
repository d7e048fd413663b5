"""How faces and loops of a walk turn once nodes are put together, and which of them no plane map can have.

A face is *sealed* when no exit opens into it: whatever else is one place, it stays a face, unless it is walked several times
round. So it turns +1, or -1 where it is the outer one, or that often. A loop that passes no place twice is a simple
closed curve, and turns +1 or -1 (Hopf).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..heading import TAU, wrap

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .consequences import Merged
    from .likeness import Likeness
    from .walk_tree import WalkTree

__all__ = ["TurningFace", "impossible_face", "impossible_loop", "tree_path"]

WHOLE_WITHIN = 0.02
"""Turns by which a sum of headings may miss a whole number, beside what the tolerance allows."""


@dataclass(frozen=True, slots=True)
class TurningFace:
    """A face or loop.

    Attributes
    ----------
    nodes
        The nodes along it, in order, with the face on the left.
    turning
        Whole turns that it makes counter-clockwise.
    """

    nodes: tuple[int, ...]
    turning: float


def impossible_face(tree: WalkTree, alike: Likeness, found: Merged) -> TurningFace | None:
    """Return a sealed face, the shortest, that turns as no face of a plane map does; None if there is none.

    Notes
    -----
    Complexity O(ways walked).
    """
    wrong: list[TurningFace] = []
    outer: list[TurningFace] = []
    seen: set[tuple[int, int]] = set()
    for start in found.ways:
        if start in seen:
            continue
        face, at = [], start
        while at in found.ways and at not in seen:
            seen.add(at)
            face.append(at)
            at = _next(tree, found, at)
        if at != start:  # an exit opens into it, or it was cut by one before
            continue
        steps = [found.ways[dart] for dart in face]
        turned = _turning(tree, found, steps)
        one = TurningFace(tuple(node for node, _ in steps), turned)
        allowed = _slack(tree, len(face))
        nearest = round(turned)
        if abs(turned - nearest) > allowed or nearest == 0 or not _folds(tree, alike, one.nodes, abs(nearest)):
            if min(abs(turned - k) for k in (1, -1)) > allowed:
                wrong.append(one)
        elif nearest == -1:
            outer.append(one)
    if len(outer) > 1:
        wrong += sorted(outer, key=lambda one: len(one.nodes))[:1]
    return min(wrong, key=lambda one: len(one.nodes), default=None)


def _next(tree: WalkTree, found: Merged, dart: tuple[int, int]) -> tuple[int, int]:
    """Return the exit by which a face goes on: of the place reached, the next clockwise from the way in."""
    node, x = found.ways[dart]
    there, back = int(tree.other[node, x]), int(tree.back[node, x])
    degree = int(tree.degree[there])
    return found.place[there], (back + found.shift[there] - 1) % degree


def _turning(tree: WalkTree, found: Merged, steps: Sequence[tuple[int, int]]) -> float:
    """Return the turns along a face whose edges are given by nodes and exits."""
    total = 0.0
    for i, (node, x) in enumerate(steps):
        there, back = int(tree.other[node, x]), int(tree.back[node, x])
        here, place = found.place[node], found.place[there]
        out, arrive = (x + found.shift[node]) % int(tree.degree[here]), (back + found.shift[there]) % int(tree.degree[place])
        total += _edge(tree, node, x, float(tree.heading[here, out]), float(tree.heading[place, arrive]))
        after, y = steps[(i + 1) % len(steps)]
        leave = (y + found.shift[after]) % int(tree.degree[place])
        total += _corner(tree, place, arrive, leave)
    return total / TAU


def _edge(tree: WalkTree, node: int, x: int, out: float, back: float) -> float:
    """Return the turn along an edge; with a compass, as the headings at both its ends say it."""
    turn = float(tree.turn[node, x])
    return turn + float(wrap(back - TAU / 2 - out - turn)) if tree.compass else turn


def _corner(tree: WalkTree, node: int, arrive: int, leave: int) -> float:
    """Return the turn at a place, whose exits are those of a node; the corner lies on the left."""
    angle = (float(tree.heading[node, arrive]) - float(tree.heading[node, leave])) % TAU
    return TAU / 2 - (TAU if arrive == leave or angle < 1e-9 else angle)


def _slack(tree: WalkTree, corners: int) -> float:
    """Return by how many turns a sum over so many corners may err."""
    if tree.compass and 8 * tree.tolerance < TAU / 2:
        return WHOLE_WITHIN
    return WHOLE_WITHIN + 4 * corners * tree.tolerance / TAU


def _folds(tree: WalkTree, alike: Likeness, nodes: Sequence[int], times: int) -> bool:
    """Whether a face may be one that is walked several times round."""
    if times == 1:
        return True
    if len(nodes) % times:
        return False
    step = len(nodes) // times
    return all(int(alike.shifts[node, nodes[(i + step) % len(nodes)]]) for i, node in enumerate(nodes))


def tree_path(tree: WalkTree, n: int, m: int) -> list[int]:
    """Return the exits along the way from one node of the tree to another, as node, exit, node, exit, ..., node."""
    before: dict[int, tuple[int, int]] = {n: (-1, -1)}
    queue = [n]
    for k in queue:
        if k == m:
            break
        for x in range(int(tree.degree[k])):
            other = int(tree.other[k, x])
            if other >= 0 and other not in before:
                before[other] = (k, x)
                queue.append(other)
    path = [m]
    while path[-1] != n:
        k, x = before[path[-1]]
        path += [x, k]
    return path[::-1]


def impossible_loop(tree: WalkTree, path: Sequence[int], shift: int) -> TurningFace | None:
    """Return a simple loop that turns as none does, or None if it turns by 1, either way round.

    Parameters
    ----------
    path
        As `tree_path` gives it; its ends are one place, exit x of the last being exit x + shift of the first.
    """
    nodes, exits = path[0::2], path[1::2]
    first, last = nodes[0], nodes[-1]
    total = 0.0
    for i, (node, x) in enumerate(zip(nodes, exits, strict=False)):
        there, back = int(tree.other[node, x]), int(tree.back[node, x])
        if there == last:
            there, back = first, (back + shift) % int(tree.degree[first])
        total += _edge(tree, node, x, float(tree.heading[node, x]), float(tree.heading[there, back]))
        total += _corner(tree, there, back, exits[(i + 1) % len(exits)])
    turned = total / TAU
    if min(abs(turned - 1), abs(turned + 1)) <= _slack(tree, len(exits)):
        return None
    return TurningFace(tuple(nodes), turned)
