"""Sets of a plane map: points, lines and regions, and their stars.

A `Region` is a union of bounded faces taken as a regular closed set. A `Line` is any set of edges; its boundary is the
vertices of odd degree in it (the mod-2 rule of a MultiLineString). Vertices, edges and faces outside are its exterior.

**Stars.** Relations are local. The star of a set at a vertex says what the set is in the small disc around it: a bit a
sector (sector i lies counter-clockwise after the dart of rank i) and a bit a dart. Stars are Python integers, so a vertex
may have any degree.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, field
from functools import cached_property
from numbers import Integral
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ninefold._wording import counted, quoted, shortened
from ninefold.errors import BadInput, DifferentMaps, EmptySet
from ninefold.immutable import Immutable, freeze, frozen_copy

from ._texts import written
from .containment import ends_of_numbers, numbers_of_ends
from .numbering import Dart, Edge, Face, Vertex
from .split import faces_beside
from .trails import trails

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from .plane import PlaneMap

__all__ = ["Line", "Point", "Region", "Set", "same_map"]


@dataclass(frozen=True, slots=True)
class Point(Immutable):
    """A vertex of a map.

    Attributes
    ----------
    plane
        The map.
    index
        The vertex number.

    Raises
    ------
    BadInput
        If the map has no vertex of that number.
    """

    plane: PlaneMap = field(repr=False)
    index: Vertex

    dimension = 0

    def __post_init__(self) -> None:
        index = _number(self.index, "a vertex number")
        if not 0 <= index < self.plane.n_vertices:
            raise BadInput(
                f"{self.plane!r} has no vertex number {index}: they run from 0 to {self.plane.n_vertices - 1}; "
                "plane.vertex finds one by name"
            )
        object.__setattr__(self, "index", index)

    def __hash__(self) -> int:
        return hash(self.index)  # not of the map, whose hash reads every dart

    @property
    def name(self) -> str:
        """The vertex's name."""
        return self.plane.vertex_names[self.index]

    @property
    def text(self) -> str:
        """The text form that `PlaneMap.parse` reads back."""
        return written("vertex", [self.name])

    def __repr__(self) -> str:
        return f"Point({self.name})"


@dataclass(frozen=True, eq=False)
class Line(Immutable):
    """A set of edges.

    Attributes
    ----------
    plane
        The map.
    edges
        Edge numbers, none a tether. They may be given in any order and more than once; they are kept ascending, each once.
    darts
        The darts in order where the line was made as a path, else None. Two lines with the same edges are equal.

    Raises
    ------
    BadInput, EmptySet
        For an edge number the map does not have, a tether, no edge at all, or darts that are not one walk along exactly
        these edges.
    """

    plane: PlaneMap = field(repr=False)
    edges: tuple[Edge, ...]
    darts: tuple[Dart, ...] | None = None

    dimension = 1

    def __post_init__(self) -> None:
        plane = self.plane
        edges = tuple(sorted({_number(e, "an edge number") for e in _several(self.edges, "edges")}))
        if not edges:
            raise EmptySet("a line needs at least one edge")
        if edges[0] < 0 or edges[-1] >= plane.tether.size:
            wrong = edges[0] if edges[0] < 0 else edges[-1]
            raise BadInput(
                f"{plane!r} has no edge number {wrong}: they run from 0 to {plane.tether.size - 1}; "
                "plane.line finds edges by name"
            )
        virtual = plane.tether[list(edges)]
        if virtual.any():
            raise BadInput(f"edge number {edges[int(virtual.argmax())]} is a tether, which belongs to no set")
        object.__setattr__(self, "edges", edges)
        if self.darts is not None:
            darts = tuple(_number(d, "a dart number") for d in _several(self.darts, "darts"))
            _require_walk(plane, darts, edges)
            object.__setattr__(self, "darts", darts)

    @cached_property
    def star(self) -> dict[Vertex, int]:
        """Vertex to the mask of its darts (by rank) that lie in the line, for every vertex of the line."""
        tail, rank = self.plane.tail, self.plane.rank
        star: dict[Vertex, int] = {}
        darts = np.array(self.edges, np.int64)[:, None] * 2 + np.array([0, 1])
        for v, r in zip(tail[darts].ravel().tolist(), rank[darts].ravel().tolist(), strict=True):
            star[v] = star.get(v, 0) | 1 << r
        return star

    @cached_property
    def boundary(self) -> frozenset[Vertex]:
        """The vertices of odd degree in the line."""
        return frozenset(v for v, darts in self.star.items() if darts.bit_count() % 2)

    @property
    def vertices(self) -> frozenset[Vertex]:
        """Every vertex of the line, boundary or not."""
        return frozenset(self.star)

    @cached_property
    def edge_set(self) -> frozenset[Edge]:
        """The edges as a set."""
        return frozenset(self.edges)

    @cached_property
    def pieces(self) -> tuple[frozenset[Vertex], ...]:
        """The vertex sets of the connected pieces, by lowest vertex."""
        return _pieces(self.plane, [2 * e for e in self.edges])

    @cached_property
    def trails(self) -> tuple[tuple[Dart, ...], ...]:
        """The fewest walks, as darts, that cover the line; see `ninefold.mapping.trails`."""
        return trails(self)

    @property
    def edge_names(self) -> tuple[str, ...]:
        """The names of the edges; in order along the way where the line was made as a path."""
        order = self.edges if self.darts is None else [d >> 1 for d in self.darts]
        return tuple(self.plane.edge_names[e] for e in order)

    @property
    def text(self) -> str:
        """The text form that `PlaneMap.parse` reads back."""
        return written("line", [f"@{name}" for name in self.edge_names])

    def __or__(self, other: Line) -> Line:
        """Return the union of two lines of one map."""
        if not isinstance(other, Line):
            return NotImplemented
        same_map(self, other)
        return Line(self.plane, tuple(self.edge_set | other.edge_set))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Line):
            return NotImplemented
        return self.edges == other.edges and _one_map(self.plane, other.plane)

    def __hash__(self) -> int:
        return hash(self.edges)

    def __repr__(self) -> str:
        return f"Line({_shorten([f'@{name}' for name in self.edge_names])})"


@dataclass(frozen=True, eq=False)
class Region(Immutable):
    """A union of bounded faces as a regular closed set; make one with `PlaneMap.cycle`, `face` or `region`.

    Attributes
    ----------
    plane
        The map.
    ends
        Sorted int32 interval ends over the preorder numbers of `PlaneMap.containment`: a face is inside when an odd number
        of ends is at most its number. 2 ends an interval.
    darts
        (k,) int64, ascending: the boundary darts, the region on their left.

    Raises
    ------
    BadInput, EmptySet
        If the ends are no rising even number of places between bounded faces, or the darts are not the whole boundary of
        the faces inside.
    """

    plane: PlaneMap = field(repr=False)
    ends: NDArray[np.int32]
    darts: NDArray[np.int64]

    dimension = 2

    def __post_init__(self) -> None:
        plane = self.plane
        ends, darts = _numbers(self.ends, "ends"), np.sort(_numbers(self.darts, "darts"))
        if not ends.size:
            raise EmptySet("a region needs at least one face")
        if ends.size % 2 or ends[0] < 1 or ends[-1] > plane.n_faces or (np.diff(ends) <= 0).any():
            raise BadInput(
                f"the ends of a region are an even number of rising numbers from 1 to {plane.n_faces}, not "
                f"{quoted(ends.tolist())}; plane.region makes a region of faces, plane.cycle one of a cycle"
            )
        if not _bounds(plane, ends, darts):
            raise BadInput(
                f"the darts {quoted(darts.tolist())} are not the boundary of the faces inside the ends "
                f"{quoted(ends.tolist())}; plane.region makes a region of faces, plane.cycle one of a cycle"
            )
        object.__setattr__(self, "ends", frozen_copy(ends.astype(np.int32)))
        object.__setattr__(self, "darts", frozen_copy(darts))

    @classmethod
    def _trusted(cls, plane: PlaneMap, ends: NDArray[np.int32], darts: NDArray[np.int64]) -> Region:
        """Make a region of arrays that are known to be right and that nobody else holds."""
        freeze(ends, darts)
        region = cls.__new__(cls)
        for name, value in (("plane", plane), ("ends", ends), ("darts", darts)):
            object.__setattr__(region, name, value)
        return region

    @classmethod
    def from_ends(cls, plane: PlaneMap, ends: NDArray[np.int32], candidates: NDArray[np.int64]) -> Region:
        """Make the region of these interval ends, whose boundary edges are among the `candidates` (edge numbers)."""
        both = np.concatenate([2 * candidates, 2 * candidates + 1])
        left = _inside(plane, ends, plane.face_of[both])
        right = _inside(plane, ends, plane.face_of[both ^ 1])
        return cls._trusted(plane, ends, np.sort(both[left & ~right]))

    @classmethod
    def from_faces(cls, plane: PlaneMap, faces: Iterable[int]) -> Region:
        """Make the union of bounded faces, given by number. O(E) for the boundary."""
        given = [_number(face, "a face number") for face in _several(faces, "faces")]
        wrong = next((face for face in given if not 0 <= face < plane.n_faces), None)
        if wrong is not None:
            raise BadInput(f"faces are numbered from 0 to {plane.n_faces - 1}; got {wrong}")
        numbers = np.unique(np.array(given, np.int64))
        if not numbers.size:
            raise EmptySet("a region needs at least one face")
        if plane.outer_face in numbers:
            raise BadInput(f"face {plane.outer_face} is the outer face, which is not bounded; a region has bounded faces")
        ends = ends_of_numbers(plane.containment.preorder[numbers])
        inside = np.zeros(plane.n_faces, np.bool_)
        inside[numbers] = True
        left = inside[plane.face_of]
        edges = np.flatnonzero(left[0::2] != left[1::2])
        return cls.from_ends(plane, ends, edges)

    def has_face(self, face: Face) -> bool:
        """Say whether a face is in the region: one binary search."""
        return bool(bisect_right(self._ends, int(self.plane.containment.preorder[face])) & 1)

    @cached_property
    def _ends(self) -> list[int]:
        return self.ends.tolist()  # type: ignore[no-any-return]

    @cached_property
    def faces(self) -> tuple[Face, ...]:
        """The faces inside, ascending. O(area)."""
        return tuple(sorted(self.plane.containment.face_at[numbers_of_ends(self.ends)].tolist()))

    @property
    def n_faces(self) -> int:
        """The number of faces inside."""
        return int((self.ends[1::2] - self.ends[0::2]).sum())

    @cached_property
    def edge_set(self) -> frozenset[Edge]:
        """The boundary edges."""
        return frozenset((self.darts >> 1).tolist())

    @cached_property
    def boundary(self) -> Line:
        """The boundary as a line."""
        return Line(self.plane, tuple(self.edge_set))

    @cached_property
    def star(self) -> dict[Vertex, tuple[int, int]]:
        """Boundary vertex to (sectors inside, boundary darts), both masks by rank."""
        plane = self.plane
        twins = self.darts ^ 1
        star: dict[Vertex, tuple[int, int]] = {}
        low: dict[Vertex, tuple[int, bool]] = {}  # the boundary dart of lowest rank, and whether it leaves
        for darts, leaves in ((self.darts, True), (twins, False)):
            for v, r in zip(plane.tail[darts].tolist(), plane.rank[darts].tolist(), strict=True):
                # below r, toggled: in the end a sector is set when an odd number of boundary darts lies above it
                sectors, curve = star.get(v, (0, 0))
                star[v] = sectors ^ ((1 << r) - 1), curve | 1 << r
                if v not in low or r < low[v][0]:
                    low[v] = r, leaves
        for v, (_, leaves) in low.items():
            if not leaves:  # the sectors before the first boundary dart are inside, so the count is off by one
                sectors, curve = star[v]
                star[v] = sectors ^ ((1 << int(plane.spokes[v])) - 1), curve
        return star

    @cached_property
    def rims(self) -> tuple[frozenset[Vertex], ...]:
        """The vertex sets of the connected parts of the boundary, by lowest vertex."""
        return _pieces(self.plane, self.darts.tolist())

    @cached_property
    def rim_darts(self) -> tuple[Dart, ...]:
        """One boundary dart for each of `rims`."""
        at = {int(self.plane.tail[d]): d for d in reversed(self.darts.tolist())}
        return tuple(at[min(rim)] for rim in self.rims)

    def left_of(self, path: Line) -> Region:
        """Return the part of the region on the left of a path that splits it."""
        return Region.from_faces(_splittable(self, path), faces_beside(self, path)[0])

    def right_of(self, path: Line) -> Region:
        """Return the part of the region on the right of a path that splits it."""
        return Region.from_faces(_splittable(self, path), faces_beside(self, path)[1])

    @property
    def text(self) -> str:
        """The text form that `PlaneMap.parse` reads back on this very map: face numbers live as long as the map."""
        return "faces:" + ",".join(map(str, self.faces))

    def __or__(self, other: Region) -> Region:
        """Return the union."""
        return self._combine(other, lambda a, b: a | b, "union")

    def __and__(self, other: Region) -> Region:
        """Return the intersection of the interiors, closed; an error if they share no face."""
        return self._combine(other, lambda a, b: a & b, "intersection")

    def __sub__(self, other: Region) -> Region:
        """Return the faces of this region that are not in the other; an error if none is left."""
        return self._combine(other, lambda a, b: a & ~b, "difference")

    def _combine(self, other: Region, rule: object, word: str) -> Region:
        if not isinstance(other, Region):
            return NotImplemented
        same_map(self, other)
        cuts = np.unique(np.concatenate([self.ends, other.ends]))
        mine = (np.searchsorted(self.ends, cuts, side="right") & 1).astype(np.bool_)
        its = (np.searchsorted(other.ends, cuts, side="right") & 1).astype(np.bool_)
        kept = rule(mine, its)  # type: ignore[operator]
        ends = cuts[np.flatnonzero(np.diff(kept, prepend=False))].astype(np.int32)
        if not ends.size:
            raise EmptySet(f"the {word} of {self!r} and {other!r} is empty: there is no such region")
        edges = np.union1d(self.darts >> 1, other.darts >> 1)
        return Region.from_ends(self.plane, ends, edges)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Region):
            return NotImplemented
        return np.array_equal(self.ends, other.ends) and _one_map(self.plane, other.plane)

    def __hash__(self) -> int:
        return hash(self.ends.tobytes())

    def __repr__(self) -> str:
        names = [f"@{self.plane.edge_names[e]}" for e in self.boundary.edges]
        return f"Region({counted(self.n_faces, 'face')}, boundary {_shorten(names)})"


Set: TypeAlias = Point | Line | Region


def same_map(first: Set, *others: Set) -> PlaneMap:
    """Return the one map that the sets belong to.

    Raises
    ------
    DifferentMaps
        If they belong to two.
    """
    for other in others:
        if not _one_map(first.plane, other.plane):
            raise DifferentMaps(
                f"{first!r} and {other!r} are sets of two different maps, {first.plane!r} and {other.plane!r}; "
                "relations are between sets of one map"
            )
    return first.plane


def _splittable(region: Region, path: object) -> PlaneMap:
    if not isinstance(path, Line):
        raise BadInput(
            f"a region is split along a path from boundary to boundary, not by {quoted(path)}; plane.path([...]) makes one"
        )
    return same_map(region, path)


def _one_map(a: PlaneMap, b: PlaneMap) -> bool:
    return a is b or a == b


def _number(value: object, what: str) -> int:
    if type(value) is int:
        return value
    if isinstance(value, bool | np.bool_) or not isinstance(value, Integral):
        raise BadInput(f"{what} is a whole number, not {quoted(value)}")
    return int(value)


def _several(values: object, what: str) -> Iterable[object]:
    if isinstance(values, str) or not hasattr(values, "__iter__"):
        raise BadInput(f"{what} are given as several numbers, such as [1, 2], not as {quoted(values)}")
    return values


def _numbers(values: object, what: str) -> NDArray[np.int64]:
    return np.array([_number(value, "each of them") for value in _several(values, what)], np.int64)


def _require_walk(plane: PlaneMap, darts: tuple[int, ...], edges: tuple[int, ...]) -> None:
    """Check that darts follow each other, each edge once, along exactly these edges."""
    if tuple(sorted(d >> 1 for d in darts)) != edges:
        raise BadInput(
            f"the darts {quoted(list(darts))} do not run along each of the edges {quoted(list(edges))} once; "
            "plane.path makes a path of vertices and edges"
        )
    chosen = np.array(darts, np.int64)
    apart = np.flatnonzero(plane.tail[chosen[:-1] ^ 1] != plane.tail[chosen[1:]])
    if apart.size:
        d, following = darts[int(apart[0])], darts[int(apart[0]) + 1]
        raise BadInput(
            f"dart {following} does not begin at {plane.vertex_names[int(plane.tail[d ^ 1])]!r}, where dart {d} ends; "
            "plane.path makes a path of vertices and edges"
        )


def _bounds(plane: PlaneMap, ends: NDArray[np.int64], darts: NDArray[np.int64]) -> bool:
    """Say whether the darts are the whole boundary of the faces inside the ends, these on their left. O(k log k).

    Three things make sure of it: every dart has the inside on its left only, so that none is too many; the edges among
    them that are not in the spanning tree give the very same faces, so that none of those is missing; and an even number
    of edges meets at every vertex, which leaves no choice for those in the tree.
    """
    if not darts.size or darts[0] < 0 or darts[-1] >= plane.tail.size or (np.diff(darts) == 0).any():
        return False
    left, right = (_inside(plane, ends, plane.face_of[d]) for d in (darts, darts ^ 1))
    if not left.all() or right.any():
        return False
    if not np.array_equal(plane.containment.inside(darts >> 1), ends):
        return False
    _, meeting = np.unique(plane.tail[np.concatenate([darts, darts ^ 1])], return_counts=True)
    return not bool((meeting % 2).any())


def _inside(plane: PlaneMap, ends: NDArray[np.integer[Any]], faces: NDArray[np.int32]) -> NDArray[np.bool_]:
    numbers = plane.containment.preorder[faces]
    return (np.searchsorted(ends, numbers, side="right") & 1).astype(np.bool_)


def _pieces(plane: PlaneMap, darts: Sequence[int]) -> tuple[frozenset[Vertex], ...]:
    """Vertex sets of the connected pieces of a few edges, by union-find."""
    parent: dict[int, int] = {}

    def find(v: int) -> int:
        while parent.setdefault(v, v) != v:
            parent[v] = parent[parent[v]]
            v = parent[v]
        return v

    ends = np.array(darts, np.int64)
    for u, v in zip(plane.tail[ends].tolist(), plane.tail[ends ^ 1].tolist(), strict=True):
        a, b = find(u), find(v)
        if a != b:
            parent[max(a, b)] = min(a, b)
    pieces: dict[int, set[Vertex]] = {}
    for v in parent:
        pieces.setdefault(find(v), set()).add(Vertex(v))
    return tuple(frozenset(pieces[root]) for root in sorted(pieces))


def _shorten(names: Sequence[str]) -> str:
    shown = [shortened(name) for name in names[:6]]
    return " ".join(shown) if len(names) <= 6 else f"{' '.join(shown[:4])} ... ({len(names)} edges)"
