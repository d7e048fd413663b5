"""How much headings err: the standard deviation that a caller or a walk declares."""

from __future__ import annotations

from math import pi, radians
from typing import TYPE_CHECKING

from ninefold._wording import quoted
from ninefold.errors import BadInput

if TYPE_CHECKING:
    from ..robot.walk import WalkHeader

__all__ = ["DEFAULT_SIGMA", "LARGEST_SIGMA", "checked_sigma", "sigma_of"]

LARGEST_SIGMA = pi / 3
"""Radians; a heading that errs by more tells next to nothing."""

DEFAULT_SIGMA = radians(5)
"""Standard deviation of a heading where neither the caller nor the walk declares one."""


def checked_sigma(value: float) -> float:
    """Return a standard deviation of headings in radians, or say why it is none.

    Raises
    ------
    BadInput
        Unless 0 < value <= pi / 3.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value <= LARGEST_SIGMA:
        raise BadInput(
            "sigma is the standard deviation of a heading in radians, above 0 and at most pi/3 (60 degrees), such as "
            f"math.radians(5), not {quoted(value)}"
        )
    return float(value)


def sigma_of(header: WalkHeader) -> float:
    """Return the standard deviation of a heading that a walk declares, radians, or `DEFAULT_SIGMA`.

    Raises
    ------
    BadInput
        If what it declares is none.
    """
    declared = header.extra.get("sigma")
    if declared is None:
        return DEFAULT_SIGMA
    try:
        return checked_sigma(declared)
    except BadInput as error:
        raise BadInput(f'the header\'s "sigma": {error}') from None
