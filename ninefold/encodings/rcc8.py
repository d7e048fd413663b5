"""RCC-8 and RCC-5, derived from the cell-pair model instead of typed in.

Examples
--------
>>> from ninefold.encodings.rcc8 import RCC5, RCC8
>>> RCC8.names(RCC8.compose(RCC8.relation("TPP"), RCC8.relation("EC")))
('DC', 'EC')
>>> sum(mask.bit_count() for mask in RCC8.base_composition.ravel().tolist())  # triples that can be drawn
193
>>> RCC5.bases
('DR', 'PO', 'PP', 'PPi', 'EQ')

References
----------
D. A. Randell, Z. Cui and A. G. Cohn, "A spatial logic based on regions and connection", KR 1992.
M. J. Egenhofer, "Reasoning about binary topological relations", SSD 1991, for the words.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .calculus import Calculus
from .model import RCC5_MODEL, RCC8_MODEL, BaseMeaning, matches

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["RCC5", "RCC8", "derive"]

_EGENHOFER = (
    ("disjoint", "DC"),
    ("meet", "EC"),
    ("overlap", "PO"),
    ("coveredBy", "TPP"),
    ("inside", "NTPP"),
    ("covers", "TPPi"),
    ("contains", "NTPPi"),
    ("equal", "EQ"),
)

_GQR5 = (("DC", "DR"), ("PPC", "PPi"), ("=", "EQ"))
"""What GQR's networks call relations of RCC-5."""


def derive(name: str, model: tuple[BaseMeaning, ...], aliases: tuple[tuple[str, str], ...] = ()) -> Calculus:
    """Derive the calculus of a cell-pair model.

    The states of three regions at one pair of cells are one of 64 combinations, so a set of combinations is one 64-bit
    word. A triple of base relations is possible when the combinations that its never-clauses leave still meet each
    of its somewhere-clauses and hold a cell of each region.

    Parameters
    ----------
    model
        Meaning of every base relation, in the order of the bits.

    Examples
    --------
    >>> derive("again", RCC5_MODEL).universal
    31
    """
    b = len(model)
    index = {meaning.name: k for k, meaning in enumerate(model)}
    never = [[_spread(meaning, corner)[0] for meaning in model] for corner in range(3)]
    wanted = [[_spread(meaning, corner)[1] for meaning in model] for corner in range(3)]
    states = np.indices((4, 4, 4))
    non_empty = [_word(states[region] > 0) for region in range(3)]
    composition = np.zeros((b, b), dtype=np.uint64)
    for i in range(b):
        for j in range(b):
            mask = 0
            for k in range(b):
                left = ~(never[0][i] | never[1][j] | never[2][k])
                clauses = (*non_empty, *wanted[0][i], *wanted[1][j], *wanted[2][k])
                mask |= all(left & clause for clause in clauses) << k
            composition[i, j] = mask
    return Calculus(
        name=name,
        bases=tuple(index),
        identity=1 << index["EQ"],
        base_converse=np.array([index[meaning.converse] for meaning in model], dtype=np.intp),
        base_composition=composition,
        aliases=aliases,
    )


def _spread(meaning: BaseMeaning, corner: int) -> tuple[int, list[int]]:
    """Return never-word and somewhere-words of a base relation on side xy, yz or xz (0, 1, 2) of the triangle."""
    axis = (2, 0, 1)[corner]  # the region that the side does not touch
    never = np.zeros((4, 4), dtype=bool)
    for pattern in meaning.never:
        never |= matches(pattern)
    wanted = [matches(pattern, either_way=True) for pattern in meaning.somewhere]
    return _word(_cube(never, axis)), [_word(_cube(clause, axis)) for clause in wanted]


def _cube(table: NDArray[np.bool_], axis: int) -> NDArray[np.bool_]:
    return np.broadcast_to(np.expand_dims(table, axis), (4, 4, 4))


def _word(combinations: NDArray[np.bool_]) -> int:
    return int.from_bytes(np.packbits(combinations.ravel()).tobytes(), "big")


RCC8 = derive("rcc8", RCC8_MODEL, _EGENHOFER)
"""The region connection calculus with boundaries: ``DC EC PO TPP NTPP TPPi NTPPi EQ`` are bits 0 to 7."""

RCC5 = derive("rcc5", RCC5_MODEL, _GQR5)
"""The region connection calculus without boundaries: ``DR PO PP PPi EQ`` are bits 0 to 4."""
