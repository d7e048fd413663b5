"""Values that stay read-only through ``copy`` and ``pickle``.

numpy hands out writeable arrays when it unpickles or deep-copies, whatever the original was. A value that inherits
`Immutable` is its own copy, and comes out of a pickle with its arrays read-only again.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Any, TypeVar

import numpy as np

__all__ = ["Immutable", "freeze", "frozen_copy"]

Array = TypeVar("Array", bound="np.ndarray[Any, Any]")


class Immutable:
    """Base of frozen dataclasses that hold arrays.

    A copy, deep or not, is the value itself. A pickle holds the fields and nothing that was derived from them; unpickling
    makes the arrays read-only and checks nothing, since a pickle must come from a trusted place anyway. A class without
    dataclass fields says what is pickled in `_state`, and puts it back in `_set_state`.

    Examples
    --------
    >>> import copy, pickle
    >>> from ninefold.mapping import PlaneMap
    >>> edge = PlaneMap.from_rotation({"a": ["b"], "b": ["a"]})
    >>> copy.deepcopy(edge) is edge, pickle.loads(pickle.dumps(edge)) == edge
    (True, True)
    >>> pickle.loads(pickle.dumps(edge)).tail[0] = 1
    Traceback (most recent call last):
    ValueError: assignment destination is read-only
    """

    __slots__ = ()

    def __copy__(self) -> Any:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Any:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (type(self), self._state())

    def _state(self) -> dict[str, Any]:
        return {item.name: getattr(self, item.name) for item in fields(self)}  # type: ignore[arg-type]

    def _set_state(self, state: dict[str, Any]) -> None:
        for name, value in state.items():
            object.__setattr__(self, name, value)


def _restored(cls: type[Immutable], state: dict[str, Any]) -> Immutable:
    value = cls.__new__(cls)
    freeze(*state.values())
    value._set_state(state)
    return value


def freeze(*values: object) -> None:
    """Make arrays read-only in place, those in tuples and in the values of dicts too; other things are left alone."""
    for value in values:
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
        elif isinstance(value, tuple):
            freeze(*value)
        elif isinstance(value, dict):
            freeze(*value.values())


def frozen_copy(array: Array) -> Array:
    """Return a read-only array with these values that nobody else can write to: the array itself if it is one.

    Examples
    --------
    >>> mine = np.arange(3)
    >>> kept = frozen_copy(mine)
    >>> mine[0] = 7
    >>> kept.tolist(), frozen_copy(kept) is kept
    ([0, 1, 2], True)
    """
    base: Any = array
    while isinstance(base, np.ndarray):
        if base.flags.writeable:
            own = array.copy()
            own.setflags(write=False)
            return own
        base = base.base
    return array
