"""A plane map that grows by one edge at a time and stays plane: rotation, face labels, turning numbers, outer face.

An edge drawn to a new vertex stays inside the face of its corner. An edge between two corners of one face splits it; corners
of two faces cannot be joined in the plane. Both halves are walked in lockstep until the shorter one is done, and only that
one gets a new label: O(log E) a dart, amortised, as a dart's label changes only when its face at least halves.

Turning numbers are exact integers. With yaws in (-pi, pi], an edge whose net rotation agrees with its end yaws up to ``k``
whole turns, and corners that contain the cut at yaw pi or do not, all angles of a face walk cancel but for

    sum over its darts of wind[d] - cut(corner after d),    wind[2e] = -k, wind[2e + 1] = 1 + k.

Joining two corners makes faces a and b of a face f with T(a) + T(b) = T(f) + 1 turns. An inner face must split into +1 and
+1, the outer one into +1 and -1 (Hopf's Umlaufsatz; see `turning`).
"""

from __future__ import annotations

from math import pi

from ninefold.errors import NotPlane

from ..heading import TAU

__all__ = ["GrowingMap", "whole_turns"]


def whole_turns(out: float, back: float, turn: float) -> tuple[int, float]:
    """Return how many whole turns an edge makes beyond its end yaws, and by how much it misses that, radians in [-pi, pi].

    Parameters
    ----------
    out, back
        Yaw on leaving along the edge from either end, radians.
    turn
        Net rotation from the first end to the second.
    """
    miss = (back - pi - out - turn) / TAU
    whole = round(miss)
    return whole, (miss - whole) * TAU


class GrowingMap:
    """Dart lists that grow. Starts as one vertex: no dart, one face.

    Attributes
    ----------
    tail, next, prev
        Per dart: start vertex, next dart counter-clockwise, next dart clockwise.
    heading, turn
        Yaw on leaving, per dart; net rotation along dart 2e, per edge.
    wind
        Per dart, see the module's text.
    face, n_faces
        Label of the face on the left, per dart, in the order in which faces came about.
    outer, outer_face
        A dart with the outer face on its left (-1 if there is none), and that face's label.
    """

    __slots__ = ("face", "heading", "n_faces", "next", "outer", "outer_face", "prev", "tail", "turn", "wind")

    def __init__(self) -> None:
        self.tail: list[int] = []
        self.next: list[int] = []
        self.prev: list[int] = []
        self.heading: list[float] = []
        self.turn: list[float] = []
        self.wind: list[int] = []
        self.face: list[int] = []
        self.n_faces = 1
        self.outer = -1
        self.outer_face = 0

    def fork(self) -> GrowingMap:
        """Return a map that is the same and grows on its own. O(E)."""
        other = GrowingMap()
        for name in ("tail", "next", "prev", "heading", "turn", "wind", "face"):
            setattr(other, name, getattr(self, name).copy())
        other.n_faces, other.outer, other.outer_face = self.n_faces, self.outer, self.outer_face
        return other

    def extend(self, u: int, at_u: int, v: int, out: float, back: float, turn: float) -> int:
        """Draw an edge from `u`, after dart `at_u` (-1 if `u` has none), to a new vertex `v`; return the edge. O(1)."""
        a = self._append(u, v, out, back, turn)
        self._link(a, at_u)
        self._link(a + 1, -1)
        face = self.face[at_u] if at_u >= 0 else 0
        self.face += (face, face)
        if at_u < 0:
            self.outer = a
        return a >> 1

    def close(self, u: int, at_u: int, v: int, at_v: int, out: float, back: float, turn: float) -> int:
        """Draw an edge between two corners, after dart `at_u` of `u` and after `at_v` of `v`; return the edge.

        `at_u` and `at_v` are the same corner for some loops, and -1 for a loop at a vertex without darts.

        Raises
        ------
        NotPlane
            If the corners lie in two faces (genus 1), or the turning numbers of the halves are no drawing's. Nothing has
            changed then.
        """
        prev, heading, wind, face = self.prev, self.heading, self.wind, self.face
        split = face[at_u] if at_u >= 0 else 0
        if at_v >= 0 and face[at_v] != split:
            raise NotPlane("it would join corners of two different faces", genus=1)
        whole, _ = whole_turns(out, back, turn)
        turns_a, turns_b = -whole, 1 + whole  # of the face left of the new edge's two darts
        outer = split == self.outer_face
        total = 0 if outer else 2
        side: list[int] = []
        if at_u == at_v:
            base = heading[at_u] if at_u >= 0 else out
            if (out - base) % TAU < (back - base) % TAU:  # the corner's darts in order: base, out, back
                a_first = a_short = True
                turns_a -= back <= out
                turns_b = total - turns_a
            else:
                a_first = a_short = False
                turns_b -= out <= back
                turns_a = total - turns_b
        else:
            a_first = True
            turns_a -= back <= heading[at_v]
            turns_b -= out <= heading[at_u]
            other: list[int] = []
            x, y = at_v, at_u
            while True:
                side.append(x)
                t = x ^ 1
                x = prev[t]
                if x == at_u:
                    a_short = True
                    turns_a += wind[t ^ 1] - (heading[t] <= out)
                    turns_b = total - turns_a
                    break
                turns_a += wind[t ^ 1] - (heading[t] <= heading[x])
                other.append(y)
                t = y ^ 1
                y = prev[t]
                if y == at_v:
                    a_short = False
                    turns_b += wind[t ^ 1] - (heading[t] <= back)
                    turns_a = total - turns_b
                    side = other
                    break
                turns_b += wind[t ^ 1] - (heading[t] <= heading[y])
        if not (turns_a == turns_b == 1 or (outer and abs(turns_a) == abs(turns_b) == 1)):
            raise NotPlane(
                f"the faces on its two sides would turn {turns_a:+d} and {turns_b:+d} times, and in a plane drawing every "
                "face turns once, only the outer one clockwise"
            )
        a = self._append(u, v, out, back, turn)
        b = a + 1
        if at_u != at_v:
            self._link(a, at_u)
            self._link(b, at_v)
        else:
            self._link(a, at_u)
            self._link(b, a if a_first else at_u)
        fresh = self.n_faces
        self.n_faces += 1
        face += (fresh, split) if a_short else (split, fresh)
        for d in side:
            face[d] = fresh
        if outer:
            self.outer = a if turns_a < 0 else b
            self.outer_face = face[self.outer]
        return a >> 1

    def refine(self, d: int, out: float, back: float) -> None:
        """Set the yaws of an edge's two darts, `d` and its twin, which keep their places in the rotation."""
        e = d >> 1
        self.heading[d], self.heading[d ^ 1] = out, back
        whole, _ = whole_turns(self.heading[2 * e], self.heading[2 * e + 1], self.turn[e])
        self.wind[2 * e], self.wind[2 * e + 1] = -whole, 1 + whole

    def _append(self, u: int, v: int, out: float, back: float, turn: float) -> int:
        a = len(self.tail)
        whole, _ = whole_turns(out, back, turn)
        self.tail += (u, v)
        self.next += (a, a + 1)
        self.prev += (a, a + 1)
        self.heading += (out, back)
        self.turn.append(turn)
        self.wind += (-whole, 1 + whole)
        return a

    def _link(self, d: int, after: int) -> None:
        """Put a dart, alone so far, next counter-clockwise after another."""
        if after >= 0:
            n = self.next[after]
            self.next[after], self.prev[d] = d, after
            self.next[d], self.prev[n] = n, d
