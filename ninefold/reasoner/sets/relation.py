"""The nine-intersection of two sets, as a code, a matrix, a DE-9IM string and a word.

A *code* packs one relation into 14 bits, so that millions fit in an array:

=======  ==============================================================================================================
bits     meaning
=======  ==============================================================================================================
0 to 8   which of the nine intersections are non-empty, row by row: II IB IE BI BB BE EI EB EE
9        the contact that may be a point or a curve is a curve: BB of two regions, IB (BI) of a line and a region, II of
         two lines
10, 11   dimension of X
12, 13   dimension of Y
=======  ==============================================================================================================

Everything else in a DE-9IM matrix has the only dimension it can have, so the code gives the full string.

References
----------
M. J. Egenhofer and J. R. Herring, Categorizing binary topological relations between regions, lines, and points in geographic
databases, 1991. E. Clementini and P. Di Felice, A comparison of methods for representing topological relationships, 1995
(DE-9IM).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput, UnknownName

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["NAMES", "RCC8_OF_NAME", "Relation", "converse_codes", "de9im_strings", "name_of_word", "names_of"]

II, IB, IE, BI, BB, BE, EI, EB, EE = (1 << k for k in range(9))
CURVE = 1 << 9
X_SHIFT, Y_SHIFT = 10, 12

NAMES = ("disjoint", "meet", "overlap", "equal", "contains", "inside", "covers", "coveredBy")
RCC8_OF_NAME = {
    "disjoint": "DC",
    "meet": "EC",
    "overlap": "PO",
    "equal": "EQ",
    "inside": "NTPP",
    "coveredBy": "TPP",
    "contains": "NTPPi",
    "covers": "TPPi",
}
_RCC8_WORDS = frozenset(word.lower() for word in RCC8_OF_NAME.values())
_CONVERSE_NAME = {"contains": "inside", "inside": "contains", "covers": "coveredBy", "coveredBy": "covers"}


def name_of_bits(bits: int) -> str:
    """Return the word for nine intersection bits: one rule for every pair of dimensions.

    *disjoint* if II, IB, BI and BB are all empty; *meet* if II is; *equal* if IE, BE, EI and EB are; *inside* if IE, BE, IB
    and BB are, *coveredBy* if IE and BE are; *contains* and *covers* the converses; else *overlap*.
    """
    if not bits & (II | IB | BI | BB):
        return "disjoint"
    if not bits & II:
        return "meet"
    if not bits & (IE | BE | EI | EB):
        return "equal"
    if not bits & (IE | BE):
        return "coveredBy" if bits & (IB | BB) else "inside"
    if not bits & (EI | EB):
        return "covers" if bits & (BI | BB) else "contains"
    return "overlap"


def converse_code(code: int) -> int:
    """Return the code of (Y, X) from the code of (X, Y): the matrix transposed, the dimensions exchanged."""
    kept = code & (II | BB | EE | CURVE)
    swapped = (code & IB) << 2 | (code & IE) << 4 | (code & BE) << 2
    swapped |= (code & BI) >> 2 | (code & EI) >> 4 | (code & EB) >> 2
    return kept | swapped | (code >> Y_SHIFT & 3) << X_SHIFT | (code >> X_SHIFT & 3) << Y_SHIFT


@cache
def de9im_of_code(code: int) -> str:
    """Return the DE-9IM string of a code, as ``shapely.relate`` writes it."""
    dx, dy, curve = code >> X_SHIFT & 3, code >> Y_SHIFT & 3, bool(code & CURVE)
    contact = 1 if curve else 0
    interior = contact if dx == dy == 1 else min(dx, dy)
    dimensions = (
        interior,
        *((1 if dx == 2 else contact if dx == 1 else 0) if dy == 2 else 0, dx),
        *((1 if dy == 2 else contact if dy == 1 else 0) if dx == 2 else 0, contact if dx == dy == 2 else 0, dx - 1),
        *(dy, dy - 1, 2),
    )
    return "".join(str(d) if code >> k & 1 else "F" for k, d in enumerate(dimensions))


@dataclass(frozen=True, slots=True)
class Relation:
    """How one set lies to another. Immutable; made by `relate`.

    Attributes
    ----------
    code
        The packed nine-intersection; see the module's text.

    Raises
    ------
    BadInput
        On ``relation == "inside"``, for any text: a relation is more than its name, so say which of its texts is meant.

    Examples
    --------
    >>> from ninefold.reasoner import Relation
    >>> inside = Relation.from_de9im("2FF1FF212")
    >>> inside, inside.rcc8, inside.converse
    (Relation(inside, 2FF1FF212), 'NTPP', Relation(contains, 212FF1FF2))
    >>> inside.within(), inside.covered_by(), inside.contains()
    (True, True, False)
    """

    code: int

    @classmethod
    def from_de9im(cls, text: str, *, dimensions: tuple[int, int] = (2, 2)) -> Relation:
        """Make a relation from a DE-9IM string and the dimensions of the two sets.

        Raises
        ------
        BadInput
            If no two sets of these dimensions have that matrix of dimensions.
        """
        if len(text) != 9 or set(text.upper()) - set("F012") or not all(d in (0, 1, 2) for d in dimensions):
            raise BadInput(f"{quoted(text)} is no DE-9IM matrix: nine letters of F, 0, 1, 2")
        bits = sum(1 << k for k, letter in enumerate(text.upper()) if letter != "F")
        base = bits | dimensions[0] << X_SHIFT | dimensions[1] << Y_SHIFT
        for code in (base, base | CURVE):
            if de9im_of_code(code) == text.upper():
                return cls(code)
        raise BadInput(f"{quoted(text)} is not the matrix of sets of dimensions {dimensions[0]} and {dimensions[1]}")

    @property
    def matrix(self) -> NDArray[np.bool_]:
        """3 x 3 bool: rows interior, boundary, exterior of X, columns of Y; true where the intersection is not empty."""
        return np.array([bool(self.code >> k & 1) for k in range(9)]).reshape(3, 3)

    @property
    def de9im(self) -> str:
        """The DE-9IM string that ``shapely.relate`` gives for the same two sets."""
        return de9im_of_code(self.code)

    @property
    def name(self) -> str:
        """One of disjoint, meet, overlap, equal, contains, inside, covers, coveredBy."""
        return name_of_bits(self.code & 511)

    @property
    def dimensions(self) -> tuple[int, int]:
        """Dimensions of X and Y."""
        return self.code >> X_SHIFT & 3, self.code >> Y_SHIFT & 3

    @property
    def rcc8(self) -> str | None:
        """The RCC-8 base relation; None unless both are regions."""
        return RCC8_OF_NAME[self.name] if self.dimensions == (2, 2) else None

    @property
    def converse(self) -> Relation:
        """The relation of Y to X."""
        return Relation(converse_code(self.code))

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Relation):
            return self.code == other.code
        if isinstance(other, str):
            matrix = len(other) == 9 and not set(other.upper()) - set("F012")
            word = "de9im" if matrix else "rcc8" if other.lower() in _RCC8_WORDS else "name"
            raise BadInput(
                f"a relation is not a text such as {quoted(other)}; compare one of its texts: "
                f"relation.{word} == {quoted(other)}"
            )
        return NotImplemented

    def __hash__(self) -> int:
        return hash(self.code)

    def _has(self, *cells: int) -> bool:
        return any(self.code & cell for cell in cells)

    def disjoint(self) -> bool:
        """OGC disjoint: nothing in common."""
        return not self._has(II, IB, BI, BB)

    def intersects(self) -> bool:
        """OGC intersects: not disjoint."""
        return not self.disjoint()

    def touches(self) -> bool:
        """OGC touches: only boundaries take part in what is common; never for two points."""
        return self.dimensions != (0, 0) and not self._has(II) and self.intersects()

    def equals(self) -> bool:
        """OGC equals: the same set."""
        return self.dimensions[0] == self.dimensions[1] and self.within() and self.contains()

    def within(self) -> bool:
        """OGC within: X in Y, interiors meeting."""
        return self._has(II) and not self._has(IE, BE)

    def contains(self) -> bool:
        """OGC contains: Y in X, interiors meeting. Wider than the name ``contains``."""
        return self._has(II) and not self._has(EI, EB)

    def contains_properly(self) -> bool:
        """Y in the interior of X, as shapely's predicate."""
        return self._has(II) and not self._has(EI, EB, BI, BB)

    def covers(self) -> bool:
        """OGC covers: no point of Y outside X."""
        return self.intersects() and not self._has(EI, EB)

    def covered_by(self) -> bool:
        """OGC coveredBy: no point of X outside Y."""
        return self.intersects() and not self._has(IE, BE)

    def crosses(self) -> bool:
        """OGC crosses: interiors meet in less than the larger dimension; two lines in points."""
        dx, dy = self.dimensions
        if dx == dy == 1:
            return self._has(II) and not self._has(CURVE)
        if dx == dy:
            return False
        return self._has(II) and self._has(IE if dx < dy else EI)

    def overlaps(self) -> bool:
        """OGC overlaps: same dimension, interiors meet in that dimension, neither holds the other."""
        dx, dy = self.dimensions
        return dx == dy and self._has(II) and self._has(IE) and self._has(EI) and (dx != 1 or self._has(CURVE))

    def __repr__(self) -> str:
        return f"Relation({self.name}, {self.de9im})"

    def __str__(self) -> str:
        return self.name


def name_of_word(word: str) -> str:
    """Return the relation name for a word in any case, Egenhofer's or RCC-8's.

    Raises
    ------
    UnknownName
        With near words.

    Examples
    --------
    >>> name_of_word("COVEREDBY"), name_of_word("ntpp")
    ('coveredBy', 'inside')
    """
    known = {name.lower(): name for name in NAMES} | {rcc.lower(): name for name, rcc in RCC8_OF_NAME.items()}
    found = known.get(word.strip().lower())
    if found is None:
        raise UnknownName("relation", word, [*NAMES, *RCC8_OF_NAME.values()])
    return found


def de9im_strings(codes: ArrayLike) -> NDArray[np.str_]:
    """Return the DE-9IM strings of an array of codes, same shape, dtype ``<U9``.

    Examples
    --------
    >>> de9im_strings([Relation.from_de9im("FF2F11212").code]).tolist()
    ['FF2F11212']
    """
    return _looked_up(codes, de9im_of_code, "<U9")


def names_of(codes: ArrayLike) -> NDArray[np.str_]:
    """Return the relation names of an array of codes, same shape, dtype ``<U9``."""
    return _looked_up(codes, lambda code: name_of_bits(code & 511), "<U9")


def converse_codes(codes: ArrayLike) -> NDArray[np.uint16]:
    """Return the codes of the converse relations, same shape."""
    code = np.asarray(codes, dtype=np.uint16)
    kept = code & np.uint16(II | BB | EE | CURVE)
    up = (code & np.uint16(IB | BE)) << 2 | (code & np.uint16(IE)) << 4
    down = (code & np.uint16(BI | EB)) >> 2 | (code & np.uint16(EI)) >> 4
    x, y = code >> X_SHIFT & 3, code >> Y_SHIFT & 3
    return np.asarray(kept | up | down | y << X_SHIFT | x << Y_SHIFT, dtype=np.uint16)


def _looked_up(codes: ArrayLike, word_of: object, dtype: str) -> NDArray[np.str_]:
    array = np.asarray(codes)
    if array.size and (array.dtype.kind not in "iu" or int(array.min()) < 0 or int(array.max()) >= 1 << 14):
        raise BadInput("codes of relations are integers from 0 to 16383, as relate_pairs and relate_all give them")
    table = np.zeros(1 << 14, dtype)
    for code in np.flatnonzero(np.bincount(array.ravel(), minlength=1)).tolist():
        table[code] = word_of(code)  # type: ignore[operator]
    return np.asarray(table[array.astype(np.int64)])
