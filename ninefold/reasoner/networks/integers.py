"""Many integers as text, a line at each 0: what DIMACS, DRAT and LRAT files are made of."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._kernels import kernel

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["DELETE", "END", "to_text"]

DELETE = 1 << 40
"""Written as the letter d."""

END = 1 << 41
"""Written as a 0 that does not end the line: LRAT has two a line."""

_WIDEST = 12


def to_text(numbers: NDArray[Any]) -> bytes:
    r"""Write integers below 10^10 with spaces between them, and a line break after each 0.

    Examples
    --------
    >>> to_text(np.array([1, -23, 0, DELETE, 4, 0, 5, END, 6, 0]))
    b'1 -23 0\nd 4 0\n5 0 6 0\n'
    """
    out = np.empty(_WIDEST * len(numbers), dtype=np.uint8)
    used = write_numbers.for_work(8 * len(numbers))(np.asarray(numbers, dtype=np.int64), out)
    return out[:used].tobytes()


@kernel(_nrt=False)
def write_numbers(numbers, out):  # type: ignore[no-untyped-def]
    """Write the digits into `out`, `_WIDEST` bytes for each number, and return how many bytes there are."""
    at = 0
    for k in range(numbers.size):
        value = numbers[k]
        if value == DELETE:
            out[at] = 100
            out[at + 1] = 32
            at += 2
            continue
        last = value == 0
        if value == END:
            value = 0
        if value < 0:
            out[at] = 45
            at += 1
            value = -value
        digits = 1
        rest = value // 10
        while rest > 0:
            digits += 1
            rest //= 10
        for place in range(at + digits - 1, at - 1, -1):
            out[place] = 48 + value % 10
            value //= 10
        at += digits
        out[at] = 10 if last else 32
        at += 1
    return at
