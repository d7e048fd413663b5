"""Relations in bulk: many sets, many pairs, one pass of compiled code.

`SetTable` holds the stars of many sets as arrays. `relate_pairs` stamps one set of each group of pairs in an array over the
vertices and streams its partners past it; `relate_all` uses an inverted index from vertex to sets so that only sets that
touch are compared. Small jobs run the plain `relate`, which gives the same codes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ninefold.errors import BadInput, EmptySet, TooLarge
from ninefold.mapping.sets import Line, Point, Region, same_map

from . import _pairs, _stars
from .relate import relate_code
from .relation import converse_codes

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import ArrayLike, NDArray

    from ninefold._kernels import Kernel
    from ninefold.mapping import PlaneMap
    from ninefold.mapping.sets import Set

__all__ = ["SetTable", "relate_all", "relate_pairs"]

_SMALL = 300
_PAIR_STEPS = 4
"""Elementary steps to relate two sets in plain Python, on the average."""
_MEMORY = 16 << 30
_DART_STEPS = 5
"""Elementary steps to enter one dart in a table of stars."""


def relate_pairs(sets: Sequence[Set] | SetTable, pairs: ArrayLike) -> NDArray[np.uint16]:
    """Relate many pairs of sets of one map.

    Parameters
    ----------
    sets
        Points, lines and regions, or a `SetTable` made of them once for many calls.
    pairs
        (P, 2) integers, rows of `sets`.

    Returns
    -------
    ndarray
        (P,) uint16 codes; `de9im_strings` and `names_of` read them, ``Relation(int(code))`` makes one a value.

    Raises
    ------
    BadInput
        For pairs of wrong shape or range, or sets of two maps.

    Notes
    -----
    Complexity O(total length of the sets + sum over pairs of the length of Y), less where everything is known early.

    Examples
    --------
    >>> from ninefold.mapping import PlaneMap
    >>> plane = PlaneMap.from_geometry([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)])
    >>> from ninefold.reasoner import names_of
    >>> names_of(relate_pairs([plane.face(f) for f in (0, 2)], [(0, 1), (1, 1)])).tolist()
    ['meet', 'equal']
    """
    try:
        index = np.asarray(pairs)
    except ValueError:
        raise BadInput("pairs must be integers of shape (P, 2), and the rows given differ in length") from None
    if index.size == 0:
        return np.zeros(0, np.uint16)
    if index.ndim != 2 or index.shape[1] != 2 or index.dtype.kind not in "iu":
        raise BadInput(f"pairs must be integers of shape (P, 2), not {index.dtype} of shape {index.shape}")
    if int(index.min()) < 0 or int(index.max()) >= len(sets):
        wrong = int(index.min()) if int(index.min()) < 0 else int(index.max())
        raise BadInput(f"pairs must hold rows of sets, 0 to {len(sets) - 1}; found {wrong}")
    if not isinstance(sets, SetTable) and _is_small(_pairs.listed_pairs, len(index)):
        _one_map(sets)
        return np.array([relate_code(sets[i], sets[j]) for i, j in index.tolist()], np.uint16)
    table = sets if isinstance(sets, SetTable) else SetTable.build(sets)
    xs, ys = (np.ascontiguousarray(index[:, k], dtype=np.int32) for k in (0, 1))
    # by y, then stably by x: partners are streamed in the order they lie in memory
    by_y, _ = _pairs.grouped(ys, len(table))
    order, start = _pairs.grouped(xs, len(table), by_y)
    codes = np.empty(len(index), np.uint16)
    _pairs.listed_pairs.compiled(table.stars, table.scratch(), order, start, ys, codes)
    return codes


def relate_all(sets: Sequence[Set] | SetTable) -> NDArray[np.uint16]:
    """Relate every set to every set.

    Returns
    -------
    ndarray
        (n, n) uint16 codes, ``codes[i, j]`` for (sets[i], sets[j]).

    Raises
    ------
    TooLarge
        If the table of codes would not fit; the message says how much it would take.

    Notes
    -----
    Complexity O(n^2 log k + total length of the sets that touch).
    """
    n = len(sets)
    if 2 * n * n > _MEMORY:
        raise TooLarge(
            f"all relations of {n:,} sets take {2 * n * n / 2**30:,.0f} GiB; relate the pairs you need with relate_pairs"
        )
    if not isinstance(sets, SetTable) and _is_small(_pairs.all_pairs, n * (n + 1) // 2):
        _one_map(sets)
        return _all_plain(sets)
    table = sets if isinstance(sets, SetTable) else SetTable.build(sets)
    stars = table.stars
    # the sets in each cell: an inverted index
    entry, begin = _pairs.grouped(stars.cell, table.n_cells)
    owner = np.repeat(np.arange(n, dtype=np.int32), np.diff(stars.start))[entry]
    codes = np.empty((n, n), np.uint16)
    _pairs.all_pairs.compiled(stars, table.scratch(), owner, begin, np.full(n, -1, np.int64), codes)
    return codes


@dataclass(frozen=True, slots=True, eq=False)
class SetTable:
    """The stars of many sets of one map, as arrays; make it once to relate the same sets again and again.

    Attributes
    ----------
    n_cells
        Number of cells of the map: one a vertex, one more for every further 64 darts at it. They are numbered by the
        preorder of a face beside them, so that cells that are near in the map are near in memory.
    stars
        The arrays that the kernels take.
    """

    n_cells: int
    stars: _pairs.Stars

    def __len__(self) -> int:
        return int(self.stars.dim.size)

    def scratch(self) -> _pairs.Scratch:
        """Return fresh working memory for the pair kernels."""
        entries, parts = int(self.stars.start[-1]), int(self.stars.part_start[-1])
        return _pairs.Scratch(
            np.full((self.n_cells >> 6) + 1, self.stars.block.size, np.int32),
            np.full(parts + 1, -1, np.int64),
            np.full(entries + 1, -1, np.int64),
        )

    @classmethod
    def build(cls, sets: Sequence[Set]) -> SetTable:
        """Build the table. Complexity O(total length of the sets + V)."""
        plane = _one_map(sets)
        n = len(sets)
        cell_start = np.concatenate([[0], np.cumsum(np.maximum(1, -(-plane.spokes // 64)))]).astype(np.int64)
        n_cells = int(cell_start[-1])
        number_of = plane.containment.preorder[plane.face_of] if plane.outer >= 0 else np.zeros(0, np.int32)
        place, number_at = _places(plane, cell_start, number_of)
        dim = np.array([x.dimension for x in sets], np.int64)
        chunks = [
            _points([x for x in sets if isinstance(x, Point)], cell_start),
            _lines(plane, [x for x in sets if isinstance(x, Line)], cell_start, number_of),
            _regions(plane, [x for x in sets if isinstance(x, Region)], cell_start, number_of),
        ]
        order = np.concatenate([np.flatnonzero(dim == k) for k in range(3)])
        sizes, parts = (np.concatenate([np.diff(chunk[k]) for chunk in chunks]) for k in (4, 6))
        take, start = _regrouped(sizes, order)
        take_parts, part_start = _regrouped(parts, order)
        cell = place[np.concatenate([chunk[0] for chunk in chunks])[take]]
        by_cell, _ = _pairs.grouped(cell, n_cells)
        owner = np.repeat(np.arange(n, dtype=np.int32), np.diff(start))
        row, _ = _pairs.grouped(owner, n, by_cell)  # each set's entries, sorted by cell
        cell = cell[row]
        sectors, darts, part = (np.concatenate([chunk[k] for chunk in chunks])[take][row] for k in (1, 2, 3))
        seed = np.concatenate([chunk[5] for chunk in chunks])[take_parts]
        points = np.flatnonzero(dim == 0)
        seed[part_start[points]] = number_at[cell[start[points]]]
        ends = [x.ends if isinstance(x, Region) else _NO_ENDS for x in sets]
        is_end = np.concatenate([[0], np.cumsum(sectors == 3)])
        stars = _pairs.Stars(
            cell=cell,
            star=np.stack([sectors, darts], axis=1),
            part=part,
            start=start,
            ends=np.concatenate([*ends, _NO_ENDS]),
            end_start=np.concatenate([[0], np.cumsum([e.size for e in ends])]).astype(np.int64),
            seed=seed,
            part_start=part_start,
            number_at=number_at,
            dim=dim,
            n_darts=np.array([2 * len(x.edges) if isinstance(x, Line) else 0 for x in sets], np.int64),
            n_ends=np.where(dim < 2, is_end[start[1:]] - is_end[start[:-1]], 0).astype(np.int64),
            **_pairs.blocks(cell, start, n_cells),
        )
        return cls(n_cells, stars)


_NO_ENDS = np.zeros(0, np.int32)
_Chunk = tuple["NDArray[np.generic]", ...]


def _is_small(kernel: Kernel[..., None], n_pairs: int) -> bool:
    """Say whether relating pairs one by one is done before a table is made and a kernel is ready."""
    return n_pairs < _SMALL or kernel.for_work(_PAIR_STEPS * n_pairs) is kernel.plain


def _all_plain(sets: Sequence[Set]) -> NDArray[np.uint16]:
    n = len(sets)
    codes = np.empty((n, n), np.uint16)
    for i, x in enumerate(sets):
        codes[i, i:] = [relate_code(x, y) for y in sets[i:]]
        codes[i:, i] = converse_codes(codes[i, i:])
    return codes


def _one_map(sets: Sequence[Set]) -> PlaneMap:
    if not len(sets):
        raise EmptySet("there are no sets to relate")
    for x in sets:
        if not isinstance(x, Point | Line | Region):
            raise BadInput(f"sets are points, lines and regions of a map, not {type(x).__name__}")
    first = sets[0]
    for x in sets:
        if x.plane is not first.plane:
            same_map(first, x)
    return first.plane


def _places(
    plane: PlaneMap, cell_start: NDArray[np.int64], number_of: NDArray[np.int32]
) -> tuple[NDArray[np.int32], NDArray[np.int32]]:
    """Renumber cells by the preorder of a face beside them: new number of each cell, and that preorder by new number."""
    n_cells = int(cell_start[-1])
    if plane.outer < 0:
        return np.arange(n_cells, dtype=np.int32), np.zeros(n_cells, np.int32)
    number_at = np.repeat(number_of[plane.first_dart], np.diff(cell_start))
    order, _ = _pairs.grouped(number_at, plane.n_faces)
    place = np.empty(n_cells, np.int32)
    place[order] = np.arange(n_cells, dtype=np.int32)
    return place, number_at[order]


def _regrouped(sizes: NDArray[np.int64], order: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Rows that bring groups, stored one after another in `order`, into the order of the sets; and where each starts."""
    size = np.empty_like(sizes)
    size[order] = sizes
    origin = np.empty_like(sizes)
    origin[order] = np.cumsum(sizes) - sizes
    start = np.concatenate([[0], np.cumsum(size)]).astype(np.int64)
    steps = np.arange(int(start[-1])) - np.repeat(start[:-1], size)
    return np.repeat(origin, size) + steps, start


def _points(points: Sequence[Point], cell_start: NDArray[np.int64]) -> _Chunk:
    n = len(points)
    cell = cell_start[[x.index for x in points]] if n else np.zeros(0, np.int64)
    every = np.arange(n + 1)
    flags, zero = np.full(n, 2, np.uint64), np.zeros(n, np.int32)
    return cell.astype(np.int32), flags, np.zeros(n, np.uint64), zero, every, zero, every


def _lines(plane: PlaneMap, lines: Sequence[Line], cell_start: NDArray[np.int64], number_of: NDArray[np.int32]) -> _Chunk:
    edges = np.fromiter((e for x in lines for e in x.edges), np.int64)
    offset = np.concatenate([[0], np.cumsum([len(x.edges) for x in lines])]).astype(np.int64)
    room = int(np.diff(cell_start)[plane.tail[np.concatenate([2 * edges, 2 * edges + 1])]].sum())
    build = _stars.line_stars.for_work(_DART_STEPS * edges.size)
    built = build(edges, offset, plane.tail, plane.rank, cell_start, number_of, plane.first_dart, room)
    return _trimmed(built)


def _regions(
    plane: PlaneMap, regions: Sequence[Region], cell_start: NDArray[np.int64], number_of: NDArray[np.int32]
) -> _Chunk:
    darts = np.concatenate([np.zeros(0, np.int64), *[x.darts for x in regions]])
    offset = np.concatenate([[0], np.cumsum([x.darts.size for x in regions])]).astype(np.int64)
    room = int(np.diff(cell_start)[plane.tail[darts]].sum())
    build = _stars.region_stars.for_work(_DART_STEPS * darts.size)
    built = build(darts, offset, plane.tail, plane.rank, plane.spokes, cell_start, number_of, room)
    return _trimmed(built)


def _trimmed(built: _Chunk) -> _Chunk:
    cell, sectors, darts, part, start, seed, part_start = built
    entries, parts = int(start[-1]), int(part_start[-1])
    return cell[:entries], sectors[:entries], darts[:entries], part[:entries], start, seed[:parts], part_start
