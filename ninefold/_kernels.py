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

A kernel takes arrays and numbers only, allocates its results with numpy, and may call other kernels: plain ones when it
runs plain, and when it is compiled they are compiled with it.
"""

from __future__ import annotations

import dis
import functools
import hashlib
import types
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

            function = self._linked()
            try:
                self._compiled = numba.njit(cache=True, **self._options)(function)
            except RuntimeError:  # no writable place for the cache: compile in memory, same result
                self._compiled = numba.njit(**self._options)(function)
        return self._compiled

    def _globals(self) -> dict[str, Any]:
        """Return the module's names that the function reads (not the attributes, which may be called alike)."""
        known = self.plain.__globals__
        read = {step.argval for step in dis.get_instructions(self.plain) if step.opname == "LOAD_GLOBAL"}
        return {name: known[name] for name in sorted(read) if name in known}

    def _linked(self) -> Any:
        """Return the function with compiled kernels where it names kernels, as numba needs it."""
        plain = self.plain
        scope = {**plain.__globals__, **{k: v.compiled for k, v in self._globals().items() if isinstance(v, Kernel)}}
        linked = types.FunctionType(plain.__code__, scope, plain.__name__, plain.__defaults__, plain.__closure__)
        linked.__module__ = plain.__module__
        # numba's cache looks for changes in the file of this function only, so the name carries what comes from others
        linked.__qualname__ = f"{plain.__qualname__}_{self.fingerprint}"
        return linked

    @functools.cached_property
    def fingerprint(self) -> str:
        """Eight hex digits that change with the code, the constants and the kernels this kernel is made of."""
        code = self.plain.__code__
        parts = [code.co_code.hex(), repr(code.co_consts), repr(sorted(self._options.items()))]
        for name, value in self._globals().items():
            if isinstance(value, Kernel):
                parts.append(f"{name}={value.fingerprint}")
            elif isinstance(value, int | float):
                parts.append(f"{name}={value}")
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:8]

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
