"""Random plane maps without geometry: a map grows by pendants, chords inside a face, loops and parallel edges.

Every connected plane map can be grown so, hence every kind comes up: trees, cacti, dense maps, bundles of parallel edges,
loops around other loops, and, with bridges turned into tethers, nested components and isolated vertices.
"""

from __future__ import annotations

import numpy as np

from ninefold.mapping import PlaneMap

MAP_KINDS = ("any", "tree", "cactus", "dense", "loops", "bundles", "simple", "islands")


def random_map(seed: int, kind: str, n_edges: int) -> PlaneMap:
    """A random plane map of a kind with about that many edges; the same arguments give the same map."""
    rng = np.random.default_rng(seed)
    grow = Growth()
    for _ in range(n_edges):
        corner = int(rng.integers(len(grow.tail))) if grow.tail else -1
        roll = rng.random()
        match kind:
            case "tree":
                grow.pendant(corner)
            case "cactus":
                grow.pendant(corner) if roll < 0.6 else grow.chord(
                    corner, corner if roll < 0.7 else grow.step(corner, rng, 4)
                )
            case "dense":
                grow.pendant(corner) if roll < 0.25 else grow.chord(corner, grow.step(corner, rng, 30), simple=True)
            case "simple":
                grow.pendant(corner) if roll < 0.5 else grow.chord(corner, grow.step(corner, rng, 12), simple=True)
            case "loops":
                grow.pendant(corner) if roll < 0.4 else grow.chord(corner, corner)
            case "bundles":
                grow.pendant(corner) if roll < 0.3 else grow.chord(corner, grow.step(corner, rng, 2))
            case _:
                grow.pendant(corner) if roll < 0.45 else grow.chord(corner, grow.step(corner, rng, 12))
    tether = np.zeros(len(grow.tail) // 2, bool)
    if kind in ("islands", "any"):
        bridges = np.flatnonzero(grow.bridges())
        tether[bridges[rng.random(len(bridges)) < (0.6 if kind == "islands" else 0.1)]] = True
    if not grow.tail:
        return PlaneMap.from_darts([], [], n_vertices=1)
    return PlaneMap.from_darts(grow.tail, grow.after, int(rng.integers(len(grow.tail))), tether=tether)


class Growth:
    """A rotation system under construction. A corner is the sector counter-clockwise after a dart; it lies in the face on
    that dart's left."""

    def __init__(self) -> None:
        self.tail: list[int] = []
        self.after: list[int] = []
        self.before: list[int] = []
        self.n_vertices = 1

    def _insert(self, corner: int, vertex: int) -> None:
        d = len(self.tail)
        self.tail.append(vertex)
        if corner < 0:
            self.after.append(d)
            self.before.append(d)
            return
        after = self.after[corner]
        self.after.append(after)
        self.before.append(corner)
        self.after[corner] = d
        self.before[after] = d

    def pendant(self, corner: int) -> None:
        """A new vertex hung into a corner (of the first vertex, if there is no dart yet)."""
        self._insert(corner, self.tail[corner] if corner >= 0 else 0)
        self._insert(-1, self.n_vertices)
        self.n_vertices += 1

    def chord(self, corner: int, other: int, *, simple: bool = False) -> None:
        """An edge between two corners of one face; a loop where they are the same."""
        if corner < 0:
            self._insert(-1, 0)
            self._insert(0, 0)
            return
        u, v = self.tail[corner], self.tail[other]
        if simple and (u == v or v in {self.tail[d ^ 1] for d in self.around(corner)}):
            return
        d = len(self.tail)
        self._insert(corner, u)
        self._insert(d if other == corner else other, v)

    def around(self, dart: int) -> list[int]:
        darts = [dart]
        while self.after[darts[-1]] != dart:
            darts.append(self.after[darts[-1]])
        return darts

    def step(self, corner: int, rng: np.random.Generator, most: int) -> int:
        """A corner of the same face, some steps on."""
        if corner < 0:
            return corner
        for _ in range(int(rng.integers(1, most + 1))):
            corner = self.before[corner ^ 1]
        return corner

    def bridges(self) -> np.ndarray:
        """Edges with the same face on both sides."""
        face = [-1] * len(self.tail)
        for s in range(len(self.tail)):
            d = s
            while face[d] < 0:
                face[d] = s
                d = self.before[d ^ 1]
        return np.array([face[d] == face[d ^ 1] for d in range(0, len(face), 2)], bool)
