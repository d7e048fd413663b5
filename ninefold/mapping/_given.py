"""What `PlaneMap.from_darts` is given, as arrays that a map may keep: checked one by one, and copied."""

from __future__ import annotations

from numbers import Integral
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

from .heading import LARGEST_ANGLE, TAU

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from .names import Names

__all__ = ["angles", "array", "lengths", "whole", "whole_numbers"]


def array(name: str, values: ArrayLike, dtype: type[np.generic] | None = None) -> NDArray[Any]:
    """Copy what was given into an array, or say that it is none."""
    try:
        return np.array(values, dtype=dtype)
    except (TypeError, ValueError, OverflowError):
        raise BadInput(f"{name} must be an array of numbers, its rows of one length") from None


def whole(name: str, value: object) -> int:
    """Return a whole number, or say that it is none."""
    if isinstance(value, bool) or not isinstance(value, Integral):
        raise BadInput(f"{name} is a whole number, not {value!r}")
    return int(value)


def whole_numbers(name: str, values: ArrayLike) -> NDArray[np.int32]:
    """Return integers as (n,) int32, or say why they are none."""
    numbers = array(name, values)
    if numbers.ndim != 1 or (numbers.size and numbers.dtype.kind not in "iu"):
        raise BadInput(f"{name} must be a one-dimensional array of integers, not {numbers.dtype} of shape {numbers.shape}")
    if numbers.size and (int(numbers.max()) > 2**31 - 1 or int(numbers.min()) < -(2**31)):
        raise BadInput(f"{name} holds numbers beyond 32 bits")
    return np.array(numbers, dtype=np.int32)


def angles(
    heading: ArrayLike | None, turn: ArrayLike | None, tether: NDArray[np.bool_]
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Return headings and turns as a map keeps them, NaN on tethers; None if neither is given."""
    if heading is None and turn is None:
        return None
    if heading is None or turn is None:
        raise BadInput("heading and turn come together: give both or neither")
    head, turns = array("heading", heading, np.float64), array("turn", turn, np.float64)
    if head.shape != (2 * tether.size,) or turns.shape != (tether.size,):
        raise BadInput(
            f"heading has shape {head.shape} and turn {turns.shape}; for {tether.size} edges they are "
            f"({2 * tether.size},) and ({tether.size},)"
        )
    head[np.repeat(tether, 2)] = np.nan
    turns[tether] = np.nan
    given = np.concatenate([head[~np.repeat(tether, 2)], turns[~tether]])
    if not (np.abs(given) <= LARGEST_ANGLE).all():
        raise BadInput(f"heading and turn must be finite radians, at most {LARGEST_ANGLE:.0f} either way")
    head -= TAU * np.round(head / TAU)
    return head, turns


def lengths(metres: ArrayLike | None, tether: NDArray[np.bool_], edge_names: Names) -> NDArray[np.float64] | None:
    """Return lengths as a map keeps them, NaN on tethers and where unknown; None if no edge has one."""
    if metres is None:
        return None
    measured = array("metres", metres, np.float64)
    if measured.shape != (tether.size,):
        raise BadInput(f"metres has shape {measured.shape}, not ({tether.size},)")
    measured[tether] = np.nan
    wrong = np.flatnonzero((measured <= 0) | np.isinf(measured))
    if wrong.size:
        e = int(wrong[0])
        raise BadInput(
            f"metres of edge {quoted(edge_names[e])} is {measured[e]:g}; a length is positive and finite, NaN where unknown"
        )
    return None if np.isnan(measured).all() else measured
