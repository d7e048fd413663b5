"""A drawing of a plane map: coordinates for its vertices, polylines for its edges."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._files import write_text
from ninefold._wording import counted
from ninefold.errors import BadInput, DifferentMaps
from ninefold.immutable import Immutable, freeze, frozen_copy

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from pathlib import Path

    from numpy.typing import ArrayLike, NDArray

    from ninefold.mapping import Doubt, Health, PlaneMap, Set

    from .bearing_rigidity import Rigidity
    from .difference_marks import Differences

__all__ = ["Drawing"]


@dataclass(frozen=True, eq=False, repr=False)
class Drawing(Immutable):
    """A straight-line drawing of a plane map; edges have bends only where they must (loops, parallel edges).

    Attributes
    ----------
    plane
        The map.
    points
        (V, 2), x to the east and y to the north: int64 for the Schnyder layout, float64 for others.
    bends, bend_start
        (B, 2) and (E + 1,) int64: the inner points of edge e, in order along dart 2e, are
        ``bends[bend_start[e]:bend_start[e + 1]]``.
    layout
        The name of the layout that made it.
    notes
        What the reader of the drawing should know, such as a fall-back to another layout.
    highlight
        Sets that every picture of this drawing colours, each with its name in the legend; see `highlighting`.
    """

    plane: PlaneMap = field(repr=False)
    points: NDArray[Any]
    bends: NDArray[Any]
    bend_start: NDArray[np.int64]
    layout: str = "given"
    notes: tuple[str, ...] = ()
    highlight: tuple[tuple[str, Set], ...] = ()

    def __post_init__(self) -> None:
        for name in ("points", "bends", "bend_start"):
            object.__setattr__(self, name, frozen_copy(getattr(self, name)))

    @classmethod
    def from_points(
        cls,
        plane: PlaneMap,
        points: ArrayLike,
        bends: ArrayLike | None = None,
        bend_start: ArrayLike | None = None,
        *,
        layout: str = "given",
        notes: Iterable[str] = (),
    ) -> Drawing:
        """Make a drawing from coordinates; shapes are checked, planarity is the business of `ninefold.layout.verify`.

        Raises
        ------
        BadInput
            For arrays that do not fit the map, or coordinates that are not finite.
        """
        xy = _coordinates("points", points)
        if len(xy) != plane.n_vertices:
            raise BadInput(
                f"{counted(len(xy), 'point')} for {counted(plane.n_vertices, 'vertex', 'vertices')}; give one each"
            )
        inner = np.zeros((0, 2), xy.dtype) if bends is None else _coordinates("bends", bends)
        start = np.zeros(plane.tether.size + 1, np.int64) if bend_start is None else np.array(bend_start, np.int64)
        if start.shape != (plane.tether.size + 1,) or start[0] != 0 or start[-1] != len(inner) or (np.diff(start) < 0).any():
            raise BadInput(
                f"bend_start must hold {counted(plane.tether.size + 1, 'number')}, one more than edges, "
                f"that rise from 0 to {len(inner)}"
            )
        freeze(xy, inner, start)
        return cls(plane, xy, inner, start, layout, tuple(notes))

    # -- coordinates ---------------------------------------------------------------------------------------------------

    def path(self, edge: int) -> NDArray[Any]:
        """Return the polyline of an edge by number, (k, 2), both ends included, along dart 2e."""
        ends = self.points[self.plane.tail[[2 * edge, 2 * edge + 1]]]
        inner = self.bends[self.bend_start[edge] : self.bend_start[edge + 1]]
        return np.concatenate([ends[:1], inner, ends[1:]])

    @cached_property
    def _lines(self) -> tuple[NDArray[Any], NDArray[np.int64]]:
        """The polylines of all edges, tethers included, as one (N, 2) array, and where each starts, (E + 1,)."""
        count = np.diff(self.bend_start)
        start = np.concatenate([[0], np.cumsum(count + 2)]).astype(np.int64)
        line = np.empty((int(start[-1]), 2), np.result_type(self.points, self.bends))
        line[start[:-1]] = self.points[self.plane.tail[0::2]]
        line[start[1:] - 1] = self.points[self.plane.tail[1::2]]
        bend_edge = np.repeat(np.arange(count.size), count)
        line[np.arange(len(self.bends)) + 2 * bend_edge + 1] = self.bends
        freeze(line, start)
        return line, start

    @cached_property
    def pieces(self) -> tuple[NDArray[Any], NDArray[np.int64]]:
        """The straight pieces of all edges but tethers, (S, 4) as x0 y0 x1 y1 along dart 2e, and the edge of each, (S,)."""
        line, start = self._lines
        edge = np.repeat(np.arange(start.size - 1), np.diff(start))
        keep = (edge[:-1] == edge[1:]) & ~self.plane.tether[edge[:-1]] if len(edge) else np.zeros(0, np.bool_)
        pieces, owner = np.concatenate([line[:-1], line[1:]], axis=1)[keep], edge[:-1][keep]
        freeze(pieces, owner)
        return pieces, owner

    # -- geometry ------------------------------------------------------------------------------------------------------

    def geometry(self, X: Set) -> Any:
        """Return a set of the map as a valid shapely geometry.

        Parameters
        ----------
        X
            A `Point` becomes a shapely Point; a `Line` a LineString (one edge) or a MultiLineString of its edges; a
            `Region` a Polygon, or a MultiPolygon if its interior is in several parts.

        Raises
        ------
        DifferentMaps
            If the set belongs to another map.

        Notes
        -----
        Complexity O(size of the set's edges); for a region whose boundary has several outer rings, O(area).

        Examples
        --------
        >>> from ninefold.mapping import PlaneMap
        >>> from ninefold.layout import schnyder
        >>> square = PlaneMap.from_rotation(
        ...     {"a": ["b", "d"], "b": ["c", "a"], "c": ["d", "b"], "d": ["a", "c"]}, outer=("b", "a"))
        >>> schnyder(square).geometry(square.cycle(["a", "b", "c", "d"])).area
        1.0
        """
        from . import shapes

        self.require_mine(X)
        return shapes.geometry(self, X)

    def geometries(self, sets: Iterable[Set]) -> NDArray[Any]:
        """Return many sets as shapely geometries, (len(sets),) of object; see `geometry`."""
        given = list(sets)
        shapes_of = np.empty(len(given), object)
        for i, X in enumerate(given):
            shapes_of[i] = self.geometry(X)
        return shapes_of

    def require_mine(self, X: Set) -> None:
        """Raise `DifferentMaps` unless the set belongs to the drawing's map."""
        if not (X.plane is self.plane or X.plane == self.plane):
            raise DifferentMaps(
                f"{X!r} is a set of {X.plane!r}, and this draws another map, {self.plane!r}; draw the set's own"
            )

    # -- pictures ------------------------------------------------------------------------------------------------------

    def highlighting(self, highlight: Mapping[str, Set] | Iterable[Set] | Set) -> Drawing:
        """Return this drawing with sets that each of its pictures colours, the one in a notebook too.

        Parameters
        ----------
        highlight
            A mapping from legend text to set, or sets alone, which the legend calls X, Y, Z, ...

        Raises
        ------
        BadInput, DifferentMaps
            For more sets than colours, things that are no sets, a set of another map.

        Examples
        --------
        >>> from ninefold.layout import draw
        >>> from ninefold.mapping import PlaneMap
        >>> edge = PlaneMap.from_rotation({"a": ["b"], "b": ["a"]})
        >>> draw(edge).highlighting({"way in": edge.edge("a", "b")}).highlight
        (('way in', Line(@0)),)
        """
        from .svg import named_sets

        return replace(self, highlight=tuple(named_sets(self, highlight)))

    def to_svg(
        self,
        *,
        highlight: Mapping[str, Set] | Iterable[Set] | Set | None = None,
        title: str | None = None,
        labels: bool | None = None,
        theme: str = "auto",
        width: int = 800,
        rigidity: bool | Rigidity = False,
        health: bool | Health = False,
        belief: ArrayLike | None = None,
        doubts: Iterable[Doubt] = (),
        differences: Differences | None = None,
    ) -> str:
        """Return the drawing as an SVG document; see `ninefold.layout.svg`.

        Parameters
        ----------
        highlight
            Sets to colour: a mapping from legend text to set, or sets alone, which the legend calls X, Y, Z, ... Left out,
            those of `highlighting`; an empty list colours none.
        title
            Heading of the picture, also its accessible name.
        labels
            Vertex names; left out, they are shown on maps of up to 40 vertices.
        theme
            ``"auto"`` follows the reader's light or dark preference; ``"light"`` and ``"dark"`` fix it.
        width
            Pixels.
        rigidity
            Colour the edges by what the headings fix: parts whose shape is measured, lengths that are only evened out, and
            legs that the rest contradicts. True works it out; what `ninefold.layout.rigidity` returned saves that.
        health
            Colour the edges by how far their headings and turn disagree, in degrees, on one scale for all maps. True, or
            what `ninefold.mapping.health` returned; not together with `rigidity`.
        belief
            (V,) how likely a robot is at each place, such as ``Localizer.probabilities``: the likely places are marked, and
            the likeliest named.
        doubts
            Of an estimate whose likeliest map this is: the places where something is undecided get numbered rings, and the
            sentences stand below.
        differences
            How this map differs from another of the same walk; see `draw_alternatives`, which shows several.

        Raises
        ------
        BadInput, DifferentMaps
            For an unknown theme, a width that is not positive, too many highlighted sets, a set of another map,
            `rigidity` or `health` for a map without headings, a belief that is none, or what is no doubt.
        UnknownName
            For doubts about a place that the map does not have.
        """
        from .svg import render

        return render(
            self,
            highlight=highlight,
            title=title,
            labels=labels,
            theme=theme,
            width=width,
            rigidity=rigidity,
            health=health,
            belief=belief,
            doubts=doubts,
            differences=differences,
        )

    def save(self, path: str | Path, **options: Any) -> None:
        """Write the drawing as an SVG file, whole or not at all; a file that is there is replaced. Options as for `to_svg`.

        Raises
        ------
        BadInput
            If the file cannot be written; what was there before stays.
        """
        write_text(path, self.to_svg(**options), force=True)

    def plot(
        self,
        *,
        highlight: Mapping[str, Set] | Iterable[Set] | Set | None = None,
        rigidity: bool | Rigidity = False,
        health: bool | Health = False,
        axes: Any = None,
    ) -> Any:
        """Draw on matplotlib axes and return them; see `ninefold.layout.plot`.

        Raises
        ------
        MissingExtra
            Without matplotlib, which the extra ``plot`` brings.
        """
        from .plot import plot

        return plot(self, highlight=highlight, rigidity=rigidity, health=health, axes=axes)

    def _repr_svg_(self) -> str:
        return self.to_svg(width=560)

    def __repr__(self) -> str:
        parts = [self.layout, repr(self.plane)]
        if len(self.bends):
            parts.append(counted(len(self.bends), "bend"))
        if self.highlight:
            parts.append(f"highlight {', '.join(name for name, _ in self.highlight)}")
        return f"Drawing({', '.join([*parts, *self.notes])})"


def _coordinates(name: str, values: ArrayLike) -> NDArray[Any]:
    array = np.array(values)
    if array.ndim != 2 or array.shape[1] != 2 or array.dtype.kind not in "iuf":
        raise BadInput(f"{name} must be numbers of shape (count, 2), not {array.dtype} of shape {array.shape}")
    array = array.astype(np.float64 if array.dtype.kind == "f" else np.int64)
    if not np.isfinite(array).all():
        raise BadInput(f"{name} must be finite")
    return array
