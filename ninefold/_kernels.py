"""Compile a hot loop with numba, but only when the work repays the wait.

Importing numba takes 0.5 s and a first dispatch 0.9 s, so a job of a few hundred darts runs the same function as
plain Python. `kernel` marks such a function; `for_work(n)` picks the form for about ``n`` elementary steps:

>>> import numpy as np
>>> from ninefold._kernels import kernel
>>> @kernel
... def total(a):
...     s = 0
...     for i in range(a.size):
...         s += a[i]
...     return s
>>> int(total.for_work(3)(np.arange(3)))
3

A kernel takes arrays and numbers only, allocates its results with numpy, and calls other kernels through `jit` ones
(functions marked `@inner`, which are compiled together with their caller).
"""

from __future__ import annotations

import functools
from typing import Any, Generic, ParamSpec, TypeVar, cast

__all__ = ["COMPILE_ABOVE", "Kernel", "kernel"]

P = ParamSpec("P")
R = TypeVar("R")

COMPILE_ABOVE = 30_000
"""Elementary steps from which compiled code pays for importing numba (about 0.1 us a step saved, 1.5 s once)."""


class Kernel(Generic[P, R]):
    """A function that exists plain and compiled; see the module's text."""

    def __init__(self, function: Any, options: dict[str, Any]) -> None:
        self.plain = function
        self._options = options
        self._compiled: Any = None
        functools.update_wrapper(self, function)

    @property
    def compiled(self) -> Any:
        """The numba form, made at the first request and cached on disk where a folder can be written."""
        if self._compiled is None:
            import numba

            try:
                self._compiled = numba.njit(cache=True, **self._options)(self.plain)
            except RuntimeError:  # no writable place for the cache: compile in memory, same result
                self._compiled = numba.njit(**self._options)(self.plain)
        return self._compiled

    def for_work(self, steps: int) -> Any:
        """Return the form that suits about `steps` elementary steps: compiled above `COMPILE_ABOVE`, else plain."""
        if self._compiled is not None or steps > COMPILE_ABOVE:
            return self.compiled
        return self.plain

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Run the plain form (or the compiled one once it exists)."""
        return cast(R, (self._compiled or self.plain)(*args, **kwargs))


def kernel(function: Any = None, **options: Any) -> Any:
    """Mark a function as a kernel; keyword options go to ``numba.njit``."""
    if function is None:
        return functools.partial(kernel, **options)
    return Kernel(function, options)
