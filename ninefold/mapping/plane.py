"""The plane map: a connected graph embedded in the plane, up to homeomorphism, without coordinates.

Dart ``d`` is a directed half of edge ``d // 2``; ``twin(d) = d ^ 1``. Everything is counter-clockwise, and a face lies on
the LEFT of its darts. Faces are the orbits of ``d -> previous-ccw(twin d)``.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import counted
from ninefold.errors import BadInput, NotPlane
from ninefold.immutable import Immutable, freeze

from . import _given, checks, select
from .containment import ContainmentIndex
from .heading import Heading
from .names import Names
from .numbering import Dart, Face, Vertex
from .rotation import read_rotation
from .sets import Point

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from .sets import Line, Region

__all__ = ["PlaneMap"]

_PICTURE_WORDS = ("draw", "plot", "show", "save", "to_svg", "svg", "points", "coordinates")


@dataclass(frozen=True, eq=False, repr=False)
class PlaneMap(Immutable):
    """A plane map: rotation system plus outer face. Immutable; make one with a ``from_*`` constructor or a `Mapper`.

    A map has no coordinates; ``ninefold.draw(plane)`` finds some and makes a picture, `ninefold.layout.draw` says more.

    Attributes
    ----------
    tail
        (2E,) int32, vertex where the dart starts. E counts tethers here.
    next_ccw
        (2E,) int32, next dart counter-clockwise around the tail: the rotation system.
    outer
        A dart with the outer face on its left, -1 for a map with no edge.
    tether
        (E,) bool, true for a virtual edge that ties a separate component to the face that hosts it. Tethers belong to no
        set and are counted nowhere but in Euler's formula.
    heading, turn
        (2E,) float64 yaw in radians on leaving along the dart, and (E,) float64 net rotation in radians along dart 2e,
        both counter-clockwise and NaN on tethers; or None, None.
    metres
        (E,) float64 length that a walk measured along each edge, NaN on tethers and where nothing was measured; None if no
        edge has one. No answer depends on it.
    vertex_names, edge_names
        Unique labels; edge names cover the E edges, tethers included (which nobody asks for).

    Examples
    --------
    >>> from ninefold.mapping import PlaneMap
    >>> theta = PlaneMap.from_rotation(
    ...     {"a": [("b", "low"), ("b", "mid"), ("b", "high")], "b": [("a", "high"), ("a", "mid"), ("a", "low")]},
    ...     outer=("b", "a", "low"))
    >>> theta
    PlaneMap(2 vertices, 3 edges, 3 faces)
    >>> theta.cycle(edges=["low", "mid"])
    Region(1 face, boundary @low @mid)
    """

    tail: NDArray[np.int32]
    next_ccw: NDArray[np.int32]
    outer: Dart
    tether: NDArray[np.bool_]
    heading: NDArray[np.float64] | None
    turn: NDArray[np.float64] | None
    metres: NDArray[np.float64] | None
    vertex_names: Names
    edge_names: Names
    _derived: checks.Derived = field(repr=False)

    # -- constructors ------------------------------------------------------------------------------------------------

    @classmethod
    def from_darts(
        cls,
        tail: ArrayLike,
        next_ccw: ArrayLike,
        outer: int | None = None,
        *,
        n_vertices: int | None = None,
        tether: ArrayLike | None = None,
        heading: ArrayLike | None = None,
        turn: ArrayLike | None = None,
        metres: ArrayLike | None = None,
        vertex_names: Iterable[str | int] | None = None,
        edge_names: Iterable[str | int] | None = None,
    ) -> PlaneMap:
        """Make a map from dart arrays, checking everything.

        Parameters
        ----------
        tail, next_ccw
            (2E,) integers: start vertex and next dart counter-clockwise around it.
        outer
            A dart with the outer face on its left. May be left out for a tree, and where `heading` and `turn` are given:
            the turning numbers tell.
        n_vertices
            Needed only for a map with no edge; otherwise ``max(tail) + 1``.
        tether
            (E,) bool; the tethers must join the components of the rest like a tree.
        heading, turn
            (2E,) yaw on leaving and (E,) net rotation, radians counter-clockwise. Both or neither.
        metres
            (E,) measured lengths, positive, NaN where unknown; what is given on tethers is left out.

        Raises
        ------
        BadInput
            For arrays of wrong shape or range, a permutation that is no rotation, or a map that is not connected.
        NotPlane
            For a rotation of positive genus, or headings that no plane drawing has.

        Notes
        -----
        Complexity O(V + E).
        """
        tails = _given.whole_numbers("tail", tail)
        after = _given.whole_numbers("next_ccw", next_ccw)
        if tails.size % 2 or after.size != tails.size:
            raise BadInput(
                f"tail has {counted(tails.size, 'entry', 'entries')} and next_ccw {after.size}; both need two for each edge"
            )
        n_edges = tails.size // 2
        total = int(tails.max()) + 1 if tails.size else 0
        count = total if n_vertices is None else _given.whole("n_vertices", n_vertices)
        if count < max(total, 1) or (tails.size and int(tails.min()) < 0):
            raise BadInput(
                "a map has at least one vertex, and tails are numbered from 0 to n_vertices - 1: "
                f"got n_vertices = {count} and tails up to {total - 1}"
            )
        if tails.size and (int(after.min()) < 0 or int(after.max()) >= tails.size):
            raise BadInput(f"next_ccw must hold darts from 0 to {tails.size - 1}")
        if count > max(1, 2 * n_edges):  # refused before anything is as large as such a number
            raise BadInput(f"{counted(n_edges, 'edge')} cannot join {count} vertices; tie separate components with tethers")
        virtual = np.zeros(n_edges, np.bool_) if tether is None else _given.array("tether", tether, np.bool_)
        if virtual.shape != (n_edges,):
            raise BadInput(f"tether has shape {virtual.shape}, not ({n_edges},)")
        v_names = vertex_names if isinstance(vertex_names, Names) else Names("vertex", count, vertex_names)
        e_names = edge_names if isinstance(edge_names, Names) else Names("edge", n_edges, edge_names)
        if (v_names.size, e_names.size) != (count, n_edges):
            raise BadInput(
                f"{counted(v_names.size, 'vertex name')} and {counted(e_names.size, 'edge name')} for "
                f"{counted(count, 'vertex', 'vertices')} and {counted(n_edges, 'edge')}; give one name each"
            )
        angles = _given.angles(heading, turn, virtual)
        outer = None if outer is None else _given.whole("outer", outer)
        lengths = _given.lengths(metres, virtual, e_names)
        return cls._checked(tails, after, outer, virtual, angles, v_names, e_names, metres=lengths)

    @classmethod
    def _checked(
        cls,
        tail: NDArray[np.int32],
        next_ccw: NDArray[np.int32],
        outer: int | None,
        tether: NDArray[np.bool_],
        angles: tuple[NDArray[np.float64], NDArray[np.float64]] | None,
        vertex_names: Names,
        edge_names: Names,
        derived: checks.Derived | None = None,
        *,
        metres: NDArray[np.float64] | None = None,
    ) -> PlaneMap:
        """Check rotation, connection, Euler and turning numbers of arrays this map may keep; the last step of all makers."""
        if derived is None:
            derived = checks.derive(tail, next_ccw, vertex_names, edge_names)
        if derived.n_components != 1:
            apart = int(np.flatnonzero(derived.component != 0)[0])
            raise BadInput(
                f"the map has {derived.n_components} components ({vertex_names[apart]!r} is not connected to "
                f"{vertex_names[0]!r}), so which face hosts which is not determined; tie them with tethers, or build "
                "from geometry"
            )
        components = derived.component
        if tether.any():
            components = checks.components_without_tethers(tail, next_ccw, tether, vertex_names.size)
        outer_dart = _outer(outer, angles, tail, next_ccw, tether, components, derived, edge_names)
        heading, turn = angles if angles is not None else (None, None)
        freeze(tail, next_ccw, tether, heading, turn, metres)
        freeze(derived.rank, derived.first, derived.next_face, derived.face_of, derived.in_tree, derived.component)
        return cls(tail, next_ccw, Dart(outer_dart), tether, heading, turn, metres, vertex_names, edge_names, derived)

    @classmethod
    def from_rotation(
        cls,
        rotation: Mapping[str | int, Sequence[Any]],
        *,
        outer: Sequence[str | int] | int | None = None,
    ) -> PlaneMap:
        """Make a plane map from each vertex's neighbours, counter-clockwise.

        Parameters
        ----------
        rotation
            Vertex name to its neighbours in counter-clockwise order. Where edges are parallel or loops, an entry is a pair
            ``(neighbour, edge name)``; a loop has two entries at its vertex, of which the first is its forward dart.
        outer
            A dart with the outer face on its left: ``("a", "b")`` leaves a for b; ``("a", "b", "e1")`` names the edge too;
            an int is a dart number, and edge e has darts 2e (from where it is mentioned first) and 2e + 1. May be left out
            when there is one face.

        Raises
        ------
        BadInput, AmbiguousDart, UnknownName
            For an edge mentioned once or three times, an unnamed parallel edge, an unknown neighbour.
        NotPlane
            With the genus and a shortest offending part.

        Notes
        -----
        Edges are numbered, and if unnamed named, in the order of first mention. Complexity O(V + E).

        Examples
        --------
        >>> from ninefold.mapping import PlaneMap
        >>> PlaneMap.from_rotation({"a": ["b"], "b": ["a", "c"], "c": ["b"]})
        PlaneMap(3 vertices, 2 edges, 1 face)
        >>> PlaneMap.from_rotation({"a": [("a", "ring"), ("a", "ring")]}, outer=1)
        PlaneMap(1 vertex, 1 edge, 2 faces)
        """
        darts = read_rotation(rotation, outer=outer)
        return cls.from_darts(
            darts.tail,
            darts.next_ccw,
            darts.outer,
            n_vertices=len(darts.vertex_names),
            vertex_names=darts.vertex_names,
            edge_names=darts.edge_names,
        )

    @classmethod
    def from_geometry(
        cls,
        points: ArrayLike,
        edges: ArrayLike,
        paths: Sequence[ArrayLike | None] | None = None,
        *,
        vertex_names: Iterable[str | int] | None = None,
        edge_names: Iterable[str | int] | None = None,
    ) -> PlaneMap:
        """Make a plane map from vertices with coordinates and edges that do not cross.

        Parameters
        ----------
        points
            (V, 2) coordinates, x east and y north.
        edges
            (E, 2) integers, the rows of `points` an edge joins; parallel edges and loops need `paths`.
        paths
            Per edge None for a straight edge, or a (k, 2) polyline that includes both ends.
        vertex_names, edge_names
            Labels; row numbers if left out.

        Returns
        -------
        PlaneMap
            With headings and turns. Coordinates are not kept, nor lengths, which a walk measures if any.

        Raises
        ------
        BadInput
            For coordinates that are not finite or beyond 1e150, edges without length, two edges that leave a vertex in one
            direction.
        NotPlane
            Where Euler's formula or the turning numbers show that edges cross. Crossings that leave both whole, such as a
            dead end across a street, are not searched for.

        Notes
        -----
        Complexity O(V + E + sum over vertices of degree log degree), and one ray per component.

        Examples
        --------
        >>> from ninefold.mapping import PlaneMap
        >>> PlaneMap.from_geometry([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)])
        PlaneMap(3 vertices, 3 edges, 2 faces)
        """
        from .geometry import darts_of_geometry

        tail, next_ccw, tether, heading, turn, v_names, e_names, derived = darts_of_geometry(
            points, edges, paths, vertex_names=vertex_names, edge_names=edge_names
        )
        return cls._checked(tail, next_ccw, None, tether, (heading, turn), v_names, e_names, derived)

    @classmethod
    def from_networkx(cls, graph: Any, *, outer: Sequence[Any] | None = None) -> PlaneMap:
        """Make a map from a ``networkx.PlanarEmbedding``, which is clockwise and converted here.

        Parameters
        ----------
        graph
            A connected embedding; nodes become names by ``str``.
        outer
            A dart ``(u, v)`` with the outer face on its left, counter-clockwise sense. May be left out for a tree.

        Raises
        ------
        BadInput
            For a graph that is no embedding (a planar graph has many; ``networkx.check_planarity`` finds one), or one in
            several components, since an embedding does not say which face hosts which.

        Examples
        --------
        >>> import networkx as nx
        >>> from ninefold.mapping import PlaneMap
        >>> _, embedding = nx.check_planarity(nx.cycle_graph(4))
        >>> PlaneMap.from_networkx(embedding, outer=(1, 0))
        PlaneMap(4 vertices, 4 edges, 2 faces)
        """
        from .graphs import rotation_of_embedding

        start = None if outer is None else [str(name) for name in outer]
        return cls.from_rotation(rotation_of_embedding(graph), outer=start)

    def to_networkx(self, kind: str = "multigraph") -> Any:
        """Export as ``"multigraph"`` or ``"embedding"``; see `ninefold.mapping.graphs`."""
        from .graphs import to_networkx

        return to_networkx(self, kind)

    # -- counts and derived arrays ------------------------------------------------------------------------------------

    @property
    def n_vertices(self) -> int:
        """Number of vertices."""
        return self.vertex_names.size

    @cached_property
    def n_edges(self) -> int:
        """Number of edges, tethers not counted."""
        return int(self.tether.size - np.count_nonzero(self.tether))

    @property
    def n_faces(self) -> int:
        """Number of faces, the outer one counted."""
        return self._derived.n_faces

    @property
    def n_components(self) -> int:
        """Number of connected components once the tethers are taken away."""
        return int(np.count_nonzero(self.tether)) + 1

    @property
    def face_of(self) -> NDArray[np.int32]:
        """(2E,) int32, the face on each dart's left, numbered by its lowest dart."""
        return self._derived.face_of

    @property
    def next_face(self) -> NDArray[np.int32]:
        """(2E,) int32, the next dart of the face on the left: previous-ccw of the twin."""
        return self._derived.next_face

    @property
    def rank(self) -> NDArray[np.int32]:
        """(2E,) int32, place of the dart in the rotation of its tail, counted from the vertex's lowest dart."""
        return self._derived.rank

    @property
    def first_dart(self) -> NDArray[np.int32]:
        """(V,) int32, the lowest dart of each vertex, -1 for the only vertex of a map with no edge."""
        return self._derived.first

    @property
    def outer_face(self) -> Face:
        """The number of the outer face."""
        return Face(int(self.face_of[self.outer])) if self.outer >= 0 else Face(0)

    @cached_property
    def spokes(self) -> NDArray[np.int32]:
        """(V,) int32, darts at each vertex, those of tethers included: the length of its rotation."""
        return _counts(self.tail, self.n_vertices)

    @cached_property
    def degree(self) -> NDArray[np.int32]:
        """(V,) int32, degree of each vertex; a loop counts twice, a tether not at all."""
        real = self.tail[~np.repeat(self.tether, 2)]
        return _counts(real, self.n_vertices)

    @cached_property
    def containment(self) -> ContainmentIndex:
        """The containment index, built at first use in O(E)."""
        return ContainmentIndex.build(self.next_face, self.face_of, self._derived.in_tree, self.outer, self.n_faces)

    def darts_at(self, vertex: Vertex) -> list[Dart]:
        """Return the darts that leave a vertex (by number), counter-clockwise from its lowest, tethers included."""
        start = int(self.first_dart[vertex])
        if start < 0:
            return []
        darts = [Dart(start)]
        d = int(self.next_ccw[start])
        while d != start:
            darts.append(Dart(d))
            d = int(self.next_ccw[d])
        return darts

    def face_darts(self, face: Face) -> list[Dart]:
        """Return the darts of the walk around a face, the lowest first; tethers included."""
        if self.outer < 0:
            return []
        start = int(self._face_first[face])
        darts = [Dart(start)]
        d = int(self.next_face[start])
        while d != start:
            darts.append(Dart(d))
            d = int(self.next_face[d])
        return darts

    @cached_property
    def _face_first(self) -> NDArray[np.int64]:
        first = checks.first_darts(self.face_of, self.n_faces)
        freeze(first)
        return first

    # -- sets ----------------------------------------------------------------------------------------------------------

    def vertex(self, name: str | int) -> Point:
        """Return the vertex of that name as a `Point`."""
        return Point(self, Vertex(self.vertex_names.row(name)))

    def edge(self, *names: str | int) -> Line:
        """Return one edge: ``edge("e7")`` or ``edge("@e7")`` by its own name, ``edge("v1", "v3")`` by its ends."""
        return select.edge(self, names)

    def path(self, steps: Iterable[str | int]) -> Line:
        """Return the path along vertices and ``@edge`` steps; no edge twice, and it may close."""
        return select.path(self, steps)

    def line(self, edges: Iterable[str | int]) -> Line:
        """Return any set of edges, given by name, as one `Line`: branching, closed or in pieces."""
        return select.line(self, edges)

    def cycle(self, steps: Iterable[str | int] | None = None, *, edges: Iterable[str | int] | None = None) -> Region:
        """Return the interior of a simple cycle, given in either direction by vertices and ``@edge`` steps, or by edges."""
        return select.cycle(self, steps, edges)

    def face(self, face: int) -> Region:
        """Return one bounded face, by its number in `face_of`, as a `Region`."""
        return select.region(self, [face])

    def region(self, faces: Iterable[int]) -> Region:
        """Return the union of bounded faces as a regular closed `Region`; holes and several parts are allowed."""
        return select.region(self, faces)

    def parse(self, text: str) -> Point | Line | Region:
        """Return the set that a text names, such as ``cycle:v0,v1,v8,v7`` or ``edge:@e7``; see `select.parse`."""
        return select.parse(self, text)

    def heading_of(self, dart: Dart) -> Heading:
        """Return the heading on leaving along a dart."""
        if self.heading is None or np.isnan(self.heading[dart]):
            raise BadInput(f"dart {dart} has no heading: the map was made without, or it is a tether")
        return Heading(float(self.heading[dart]))

    # -- checks and comparison -----------------------------------------------------------------------------------------

    def validate(self) -> None:
        """Recompute every derived thing from the stored arrays and compare; raise if anything differs.

        Raises
        ------
        NinefoldError
            If the map is not what its constructors promise. Complexity O(E).
        """
        again = PlaneMap.from_darts(
            self.tail,
            self.next_ccw,
            self.outer if self.outer >= 0 else None,
            n_vertices=self.n_vertices,
            tether=self.tether,
            heading=self.heading,
            turn=self.turn,
            metres=self.metres,
            vertex_names=self.vertex_names,
            edge_names=self.edge_names,
        )
        same = (
            np.array_equal(again.face_of, self.face_of)
            and np.array_equal(again.next_face, self.next_face)
            and np.array_equal(again.rank, self.rank)
            and again.n_faces == self.n_faces
            and _same(again.metres, self.metres)
            and self.n_vertices - self.tether.size + self.n_faces == 2
        )
        if not same:
            raise NotPlane("a derived array of this map differs from what its darts give")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, PlaneMap):
            return NotImplemented
        if self is other:
            return True
        return (
            self.outer_face == other.outer_face
            and np.array_equal(self.tail, other.tail)
            and np.array_equal(self.next_ccw, other.next_ccw)
            and np.array_equal(self.tether, other.tether)
            and _same(self.heading, other.heading)
            and _same(self.turn, other.turn)
            and _same(self.metres, other.metres)
            and self.vertex_names == other.vertex_names
            and self.edge_names == other.edge_names
        )

    def __hash__(self) -> int:
        return hash((self.n_vertices, self.tail.tobytes(), self.next_ccw.tobytes()))

    def __repr__(self) -> str:
        parts = [
            _count(self.n_vertices, "vertex", "vertices"),
            _count(self.n_edges, "edge", "edges"),
            _count(self.n_faces, "face", "faces"),
        ]
        if self.n_components > 1:
            parts.append(f"{self.n_components} components")
        return f"PlaneMap({', '.join(parts)})"

    def _repr_html_(self) -> str:
        """What a notebook shows: the same text, and how to get a picture."""
        return f"<code>{self!r}</code><br><small>to see it: <code>ninefold.draw(plane)</code></small>"

    if not TYPE_CHECKING:  # for people who look for a picture here; a type checker need not know

        def __getattr__(self, name: str) -> Any:
            hint = "; ninefold.draw(plane) makes a picture of a map" if name in _PICTURE_WORDS else ""
            raise AttributeError(f"a PlaneMap has no attribute {name!r}{hint}", name=name, obj=self)


def _counts(tails: NDArray[np.int32], n_vertices: int) -> NDArray[np.int32]:
    counts = np.bincount(tails, minlength=n_vertices).astype(np.int32)
    freeze(counts)
    return counts


def _count(number: int, one: str, many: str) -> str:
    return f"{number} {one if number == 1 else many}"


def _same(a: NDArray[np.float64] | None, b: NDArray[np.float64] | None) -> bool:
    if a is None or b is None:
        return a is b
    return bool(np.array_equal(a, b, equal_nan=True))


def _outer(
    outer: int | None,
    angles: tuple[NDArray[np.float64], NDArray[np.float64]] | None,
    tail: NDArray[np.int32],
    next_ccw: NDArray[np.int32],
    tether: NDArray[np.bool_],
    component: NDArray[np.int32],
    derived: checks.Derived,
    edge_names: Names,
) -> int:
    """Settle the outer dart: from the turning numbers, from the argument, or because there is one face only."""
    if tail.size == 0:
        if outer not in (None, -1):
            raise BadInput(f"outer is dart {outer}, but the map has no edge; leave it out")
        return -1
    if outer is not None and not 0 <= outer < tail.size:
        raise BadInput(f"outer is dart {outer}, and darts are numbered from 0 to {tail.size - 1}")
    if angles is not None and not tether.all():
        walks = checks.component_walks(tail, next_ccw, tether, *angles, component, derived, edge_names)
        found = checks.outer_dart(walks, derived)
        if outer is not None and derived.face_of[outer] != derived.face_of[found]:
            raise NotPlane(
                f"outer is given on the left of dart {outer}, but by the headings the outer face is on the left of "
                f"dart {found} (edge {edge_names[found >> 1]!r})"
            )
        return found if outer is None else int(outer)
    if outer is None:
        if derived.n_faces > 1:
            raise BadInput(
                f"the map has {derived.n_faces} faces and no headings; give outer, a dart with the outer face on its left"
            )
        return 0
    return int(outer)
