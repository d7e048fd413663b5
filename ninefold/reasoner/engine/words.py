"""Sets of nodes as rows of 64-bit words: counting and listing their members.

Every constant is a ``numpy.uint64``, because numba turns a mixed signed and unsigned sum into a float.
"""

from __future__ import annotations

import numpy as np

from ninefold._kernels import kernel

__all__ = ["WORD", "bit_count", "lowest_bit", "n_words"]

WORD = 64
"""Members a word holds."""

_ONE = np.uint64(1)
_TWO = np.uint64(2)
_FOUR = np.uint64(4)
_PAIRS = np.uint64(0x5555555555555555)
_QUADS = np.uint64(0x3333333333333333)
_BYTES = np.uint64(0x0F0F0F0F0F0F0F0F)
_LOW_BYTE = np.uint64(0xFF)
_8, _16, _32 = np.uint64(8), np.uint64(16), np.uint64(32)


def n_words(members: int) -> int:
    """Return how many words a set of up to `members` members takes."""
    return (members + WORD - 1) // WORD


@kernel(_nrt=False, forceinline=True)
def bit_count(x):  # type: ignore[no-untyped-def]
    """Return the number of set bits of a uint64, as an int."""
    x = x - ((x >> _ONE) & _PAIRS)
    x = (x & _QUADS) + ((x >> _TWO) & _QUADS)
    x = (x + (x >> _FOUR)) & _BYTES
    x = x + (x >> _8)
    x = x + (x >> _16)
    return int((x + (x >> _32)) & _LOW_BYTE)


@kernel(_nrt=False, forceinline=True)
def lowest_bit(x):  # type: ignore[no-untyped-def]
    """Return the index of the lowest set bit of a uint64 that is not zero."""
    below = (x - _ONE) & ~x
    return bit_count(below)
