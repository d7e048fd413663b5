"""The geometric oracle: symbolic answers held against shapely on a drawing that is itself checked.

`verify` draws a map, checks the drawing without trusting the layout (no crossing, the map's rotation, faces and outer face
recomputed from the coordinates), and compares ``relate`` with ``shapely.relate`` pair by pair. `verify_geometry` does the
comparison on geometry of the caller's, such as the streets a map was made from. A disagreement keeps both matrices and can
be shrunk to a small map that still shows it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from ninefold.errors import BadInput
from ninefold.mapping import Line, Point, Region, Vertex
from ninefold.mapping.sets import same_map
from ninefold.reasoner import relate

from .layouts import draw
from .planarity import drawing_problems
from .sampling import sample_pairs
from .shrinking import shrink

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from numpy.typing import NDArray

    from ninefold.mapping import PlaneMap, Set

    from .drawing import Drawing

    GeometryOf: TypeAlias = Callable[[Set], Any]

__all__ = ["Disagreement", "Report", "verify", "verify_geometry"]

DEFAULT_PAIRS = 2000
KEPT = 100
"""Disagreements kept in a report; all are counted."""


@dataclass(frozen=True, slots=True)
class Disagreement:
    """A pair on which the symbolic and the geometric answer differ.

    Attributes
    ----------
    x, y
        The sets.
    symbolic, geometric
        DE-9IM strings: of ``relate`` and of ``shapely.relate``.
    layout
        The layout of the drawing, or "" where the geometry was the caller's.
    """

    x: Set
    y: Set
    symbolic: str
    geometric: str
    layout: str = ""

    def minimal(self) -> Disagreement:
        """Return a disagreement on a sub-map as small as could be found, drawn anew; itself if it is not reproduced so.

        The reason may be lost with the caller's geometry, which a smaller map does not have; the Schnyder layout is tried.
        """
        layout = self.layout or "schnyder"
        found = partial(_difference, layout=layout)
        if found(self.x, self.y) is None:
            return self
        x, y = shrink(self.x, self.y, lambda a, b: found(a, b) is not None)
        return found(x, y) or self

    def to_svg(self, **options: Any) -> str:
        """Return a picture of the two sets on their map; options as for `Drawing.to_svg`."""
        shown = draw(self.x.plane, layout=self.layout or "schnyder")
        given = {"highlight": {"X": self.x, "Y": self.y}, "title": f"relate {self.symbolic}, shapely {self.geometric}"}
        return shown.to_svg(**(given | options))

    def _repr_svg_(self) -> str:
        return self.to_svg()

    def __str__(self) -> str:
        rows = [f"X = {self.x!r}", f"Y = {self.y!r}", f"on {self.x.plane!r}", "      relate  shapely"]
        for k, name in enumerate("IBE"):
            mine, its = (text[3 * k : 3 * k + 3] for text in (self.symbolic, self.geometric))
            rows.append(f"  {name}   {' '.join(mine)}   {' '.join(its)}{'   <' if mine != its else ''}")
        return "\n".join(rows)


@dataclass(frozen=True, slots=True, repr=False)
class Report:
    """What the oracle found.

    Attributes
    ----------
    pairs
        Pairs compared; 0 if the drawing itself is wrong, since then no geometry means anything.
    problems
        What is wrong with the drawing, in words.
    wrong
        How many pairs disagree.
    disagreements
        The first of them, at most 100.
    layout
        The layout of the drawing that was used, or "" for the caller's geometry.
    """

    pairs: int
    problems: tuple[str, ...] = ()
    wrong: int = 0
    disagreements: tuple[Disagreement, ...] = field(default=())
    layout: str = ""

    @property
    def agree(self) -> bool:
        """Whether the drawing is right and every pair agrees."""
        return not self.problems and not self.wrong

    def __repr__(self) -> str:
        if self.problems:
            return f"Report(the {self.layout} drawing is wrong: {'; '.join(self.problems)})"
        on = f"on the {self.layout} drawing" if self.layout else "on the given geometry"
        if self.agree:
            return f"Report(agree: {self.pairs} pairs {on})"
        return f"Report({self.wrong} of {self.pairs} pairs disagree {on})"

    def __str__(self) -> str:
        return "\n\n".join([repr(self), *map(str, self.disagreements[:3])])


def verify(
    plane: PlaneMap,
    sets_or_pairs: Iterable[Set] | Iterable[tuple[Set, Set]] | None = None,
    *,
    seed: int = 0,
    n_pairs: int = DEFAULT_PAIRS,
    layout: str = "schnyder",
    drawing: Drawing | None = None,
) -> Report:
    """Check a drawing of the map and compare ``relate`` with ``shapely.relate`` on it.

    Parameters
    ----------
    plane
        The map.
    sets_or_pairs
        Sets, of which all ordered pairs are compared; or pairs of sets. Left out, `n_pairs` pairs of points, lines and
        regions are sampled with `seed`.
    layout
        A layout by name, as for `draw`. The Schnyder drawing is exact at any size, so it is the one checked by default.
    drawing
        A drawing to check instead of a fresh one.

    Raises
    ------
    BadInput, DifferentMaps
        For an unknown layout, things that are no sets, a set or drawing of another map.

    Notes
    -----
    Complexity O(E log E) for the drawing and its check, then shapely's time for the pairs.

    Examples
    --------
    >>> from ninefold.layout import verify
    >>> from ninefold.mapping import PlaneMap
    >>> square = PlaneMap.from_rotation(
    ...     {"a": ["b", "d"], "b": ["c", "a"], "c": ["d", "b"], "d": ["a", "c"]}, outer=("b", "a"))
    >>> verify(square)
    Report(agree: 2000 pairs on the schnyder drawing)
    """
    shown = drawing if drawing is not None else draw(plane, layout=layout)
    if not (shown.plane is plane or shown.plane == plane):
        raise BadInput(f"the drawing is of {shown.plane!r}, another map than {plane!r}")
    sets, pairs = _chosen(plane, sets_or_pairs, n_pairs, seed)
    problems = drawing_problems(shown)
    if problems:
        return Report(0, problems, layout=shown.layout)
    return _compared(sets, pairs, shown.geometry, shown.layout)


def verify_geometry(
    plane: PlaneMap,
    geometry_of: GeometryOf,
    sets_or_pairs: Iterable[Set] | Iterable[tuple[Set, Set]] | None = None,
    *,
    seed: int = 0,
    n_pairs: int = DEFAULT_PAIRS,
) -> Report:
    """Compare ``relate`` with ``shapely.relate`` on geometry of the caller's.

    Parameters
    ----------
    geometry_of
        Gives the shapely geometry of a `Point`, `Line` or `Region` of the map.
    sets_or_pairs, seed, n_pairs
        As for `verify`.

    Raises
    ------
    BadInput, DifferentMaps
        For things that are no sets, or sets of another map.
    """
    sets, pairs = _chosen(plane, sets_or_pairs, n_pairs, seed)
    return _compared(sets, pairs, geometry_of, "")


def _chosen(
    plane: PlaneMap, sets_or_pairs: Iterable[Any] | None, n_pairs: int, seed: int
) -> tuple[list[Set], NDArray[np.int64]]:
    """Settle the sets and the pairs of their rows."""
    if sets_or_pairs is None:
        if n_pairs < 1:
            raise BadInput(f"n_pairs is {n_pairs}; sample at least one pair")
        return sample_pairs(plane, n_pairs, np.random.default_rng(seed))
    given = list(sets_or_pairs)
    if given and all(isinstance(item, tuple) and len(item) == 2 for item in given):
        sets = [x for pair in given for x in pair]
        pairs = np.arange(len(sets)).reshape(-1, 2)
    else:
        sets = given
        pairs = np.stack(np.meshgrid(np.arange(len(sets)), np.arange(len(sets)), indexing="ij"), axis=-1).reshape(-1, 2)
    for x in sets:
        if not isinstance(x, Point | Line | Region):
            raise BadInput(f"verify takes sets of the map, or pairs of them, not {x!r}")
        same_map(Point(plane, Vertex(0)), x)
    return sets, pairs


def _compared(sets: Sequence[Set], pairs: NDArray[np.int64], geometry_of: GeometryOf, layout: str) -> Report:
    import shapely

    shapes = np.empty(len(sets), object)
    for row in np.unique(pairs).tolist():
        shapes[row] = geometry_of(sets[row])
    geometric = shapely.relate(shapes[pairs[:, 0]], shapes[pairs[:, 1]]) if len(pairs) else np.zeros(0, str)
    symbolic = np.array([relate(sets[i], sets[j]).de9im for i, j in pairs.tolist()], dtype="<U9")
    wrong = np.flatnonzero(symbolic != np.asarray(geometric, dtype="<U9"))
    found = tuple(
        Disagreement(sets[pairs[k, 0]], sets[pairs[k, 1]], str(symbolic[k]), str(geometric[k]), layout) for k in wrong[:KEPT]
    )
    return Report(len(pairs), (), int(wrong.size), found, layout)


def _difference(x: Set, y: Set, *, layout: str) -> Disagreement | None:
    import shapely

    shown = draw(x.plane, layout=layout)
    symbolic = relate(x, y).de9im
    geometric = str(shapely.relate(shown.geometry(x), shown.geometry(y)))
    return Disagreement(x, y, symbolic, geometric, layout) if symbolic != geometric else None
