"""The cell-pair model of regions: what RCC-8 means, and where its composition table comes from.

Take two cells ``w1`` and ``w2`` of the plane that share one boundary point. A regular closed region holds each cell or
not; it is *closed* at the point (the point belongs to it) if it holds either, and *open* there (the point is interior)
if it holds both. So a region looks, at one such pair, like one of four states, and a family of regions is described
by which combinations of states occur at all. Every base relation then says two kinds of thing about two regions:

- *never*: combinations that occur at no pair of cells;
- *somewhere*: combinations of which at least one pair of cells shows one; every region holds some cell.

Never-clauses only remove combinations, somewhere-clauses only ask for some, so a set of atomic statements has a model
exactly if the largest set of combinations that breaks no never-clause meets every somewhere-clause. That one test gives
the composition table (`ninefold.encodings.rcc8`), the SAT encoding (`ninefold.encodings.cells`) and the drawing of a
scenario.

A *pattern* is four characters for ``x1 x2 y1 y2`` (region x holds w1, holds w2, region y holds w1, holds w2), each
``1`` (holds), ``0`` (does not) or ``.`` (either). Which of two cells is called w1 does not matter, so a somewhere-
pattern may also be met with both cells exchanged.

References
----------
J. Renz, "A canonical model of the region connection calculus", Journal of Applied Non-Classical Logics 12, 2002: two
levels of worlds, cells and points, with two cells below each point, suffice for every consistent set.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["RCC5_MODEL", "RCC8_MODEL", "BaseMeaning", "holds", "matches", "relation_between"]


@dataclass(frozen=True, slots=True)
class BaseMeaning:
    """What one base relation between regions x and y says of pairs of cells.

    Parameters
    ----------
    name, converse
        The base relation and the one that holds between y and x.
    never, somewhere
        Patterns over ``x1 x2 y1 y2``; a somewhere-pattern counts with w1 and w2 exchanged too.
    """

    name: str
    converse: str
    never: tuple[str, ...]
    somewhere: tuple[str, ...]


_SHARE_NO_CELL = ("1.1.", ".1.1")
_SHARE_NO_POINT = (*_SHARE_NO_CELL, "1..1", ".11.")
_PART = ("1.0.", ".1.0")
_INNER_PART = (*_PART, "1..0", ".10.")
_SOME_MORE = "0.1."
"""y holds a cell that x does not."""
_TOUCH_FROM_INSIDE = "1..0"
"""x is closed at a point where y is not open (x being a part of y)."""


def _swap(patterns: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(p[2:] + p[:2] for p in patterns)


def _with_converses(*meanings: BaseMeaning) -> dict[str, BaseMeaning]:
    inverse = [BaseMeaning(m.converse, m.name, _swap(m.never), _swap(m.somewhere)) for m in meanings]
    return {m.name: m for m in (*meanings, *inverse)}


_EQUAL = BaseMeaning("EQ", "EQ", (*_PART, *_swap(_PART)), ())
_OVERLAP = BaseMeaning("PO", "PO", (), ("1.1.", "1.0.", _SOME_MORE))

_rcc8 = _with_converses(
    BaseMeaning("TPP", "TPPi", _PART, (_SOME_MORE, _TOUCH_FROM_INSIDE)),
    BaseMeaning("NTPP", "NTPPi", _INNER_PART, (_SOME_MORE,)),
)
RCC8_MODEL = (
    BaseMeaning("DC", "DC", _SHARE_NO_POINT, ()),
    BaseMeaning("EC", "EC", _SHARE_NO_CELL, ("1..1",)),
    _OVERLAP,
    *(_rcc8[name] for name in ("TPP", "NTPP", "TPPi", "NTPPi")),
    _EQUAL,
)
"""The eight relations of RCC-8, in the order of their bits."""

_rcc5 = _with_converses(BaseMeaning("PP", "PPi", _PART, (_SOME_MORE,)))
RCC5_MODEL = (
    BaseMeaning("DR", "DR", _SHARE_NO_CELL, ()),
    _OVERLAP,
    *(_rcc5[name] for name in ("PP", "PPi")),
    _EQUAL,
)
"""The five relations of RCC-5, which do not look at boundaries, in the order of their bits."""


@cache
def matches(pattern: str, *, either_way: bool = False) -> NDArray[np.bool_]:
    """Tell which states of two regions a pattern covers.

    Parameters
    ----------
    either_way
        Also with w1 and w2 exchanged.

    Returns
    -------
    (4, 4) bool, by state of x and state of y; a state is 1 for w1 plus 2 for w2. Read-only.

    Examples
    --------
    >>> matches("1.0.").astype(int)
    array([[0, 0, 0, 0],
           [1, 0, 1, 0],
           [0, 0, 0, 0],
           [1, 0, 1, 0]])
    """
    covered = np.zeros((4, 4), dtype=bool)
    for x in range(4):
        for y in range(4):
            cells = (x & 1, x >> 1, y & 1, y >> 1)
            covered[x, y] = all(want in (".", str(cell)) for want, cell in zip(pattern, cells, strict=True))
    if either_way:
        exchanged = [0, 2, 1, 3]
        covered |= covered[np.ix_(exchanged, exchanged)]
    covered.flags.writeable = False
    return covered


def holds(meaning: BaseMeaning, x: NDArray[np.integer], y: NDArray[np.integer]) -> bool:
    """Tell whether a base relation holds between two regions given by their states at every pair of cells.

    Parameters
    ----------
    x, y
        (k,) states 0 to 3 at the same k pairs of cells.
    """
    if any(matches(pattern)[x, y].any() for pattern in meaning.never):
        return False
    return all(matches(pattern, either_way=True)[x, y].any() for pattern in meaning.somewhere)


def relation_between(x: NDArray[np.integer], y: NDArray[np.integer], model: tuple[BaseMeaning, ...] = RCC8_MODEL) -> int:
    """Return the bit of the one base relation of two non-empty regions given by their states.

    Parameters
    ----------
    x, y
        (k,) states 0 to 3 at the same k pairs of cells, neither all zero.

    Examples
    --------
    >>> relation_between(np.array([1, 0]), np.array([3, 1]))  # x lies in y and nowhere reaches its boundary: NTPP
    16
    """
    found = 0
    for k, meaning in enumerate(model):
        if holds(meaning, x, y):
            found |= 1 << k
    return found
