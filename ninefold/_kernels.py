"""Compile a hot loop with numba, but only when the work repays the wait.

`kernel` marks a function that exists in two forms, plain Python and compiled, which give the same results. Importing numba,
loading a compiled kernel and compiling one take time that small work does not have, so ``for_work(steps)`` picks the form
for about that many elementary steps (a microsecond each in plain Python):

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
runs plain, and when it is compiled they are compiled with it. Compiled kernels are cached on disk, once a machine. The
folder is numba's: ``__pycache__`` beside the module, or what the environment variable NUMBA_CACHE_DIR names.
"""

from __future__ import annotations

import dis
import functools
import hashlib
import os
import sys
import types
from pathlib import Path
from typing import Any, Generic, ParamSpec, TypeVar, cast

__all__ = ["Kernel", "kernel", "seconds_to_compiled"]

P = ParamSpec("P")
R = TypeVar("R")

STEP_SECONDS = 1e-6
"""What an elementary step takes in plain Python."""

IMPORT_SECONDS = 0.6
"""What importing numba and calling the first compiled function of a process take."""

LOAD_SECONDS = 0.05
"""What loading a kernel from the cache takes."""

SAY_ABOVE = 1.5
"""Seconds of compilation that are worth a line on stderr."""


def seconds_to_compiled(*, numba_loaded: bool, cached: bool, compile_seconds: float) -> float:
    """Return how long it takes until a compiled kernel runs.

    Examples
    --------
    >>> seconds_to_compiled(numba_loaded=True, cached=True, compile_seconds=5.0)
    0.05
    >>> seconds_to_compiled(numba_loaded=False, cached=False, compile_seconds=5.0)
    5.6
    """
    return (0.0 if numba_loaded else IMPORT_SECONDS) + (LOAD_SECONDS if cached else compile_seconds)


class Kernel(Generic[P, R]):
    """A function that exists plain and compiled; see the module's text.

    Attributes
    ----------
    plain
        The function as it is written.
    compile_seconds
        About how long it takes to compile it with all that it calls.
    """

    def __init__(self, function: Any, options: dict[str, Any], compile_seconds: float) -> None:
        self.plain = function
        self.compile_seconds = compile_seconds
        self._options = options
        self._compiled: Any = None
        self._done_plain = 0
        functools.update_wrapper(self, function)

    def for_work(self, steps: int) -> Any:
        """Return the form that suits about `steps` more elementary steps.

        Work that was done plain before counts too: a kernel that is asked for small work again and again is compiled, or
        loaded, when all of it together would have repaid that.
        """
        if self._compiled is not None:
            return self._compiled
        self._done_plain += steps
        if self._done_plain * STEP_SECONDS <= LOAD_SECONDS:  # the answer whatever is loaded and cached
            return self.plain
        wait = seconds_to_compiled(
            numba_loaded=_numba_is_loaded(), cached=self.is_cached, compile_seconds=self.compile_seconds
        )
        return self.compiled if self._done_plain * STEP_SECONDS > wait else self.plain

    @property
    def compiled(self) -> Any:
        """The numba form, made at the first request and cached on disk where a folder can be written."""
        if self._compiled is None:
            if self.compile_seconds > SAY_ABOVE and not self.is_cached:
                _say_once(f"ninefold: compiling kernels for this machine, once (about {self.compile_seconds:.0f} s) ...")
            import numba

            function = self._linked()
            options = {"no_cfunc_wrapper": True, **self._options}
            try:
                self._compiled = numba.njit(cache=True, **options)(function)
            except RuntimeError:  # no writable place for the cache: compile in memory, same result
                self._compiled = numba.njit(**options)(function)
        return self._compiled

    @functools.cached_property
    def callee(self) -> Any:
        """The numba form that other kernels call: part of theirs, for one width of integers, never called from Python."""
        import numba

        return _for_wide_integers(
            numba.njit(no_cfunc_wrapper=True, no_cpython_wrapper=True, **self._options)(self._linked())
        )

    @functools.cached_property
    def is_cached(self) -> bool:
        """Whether the kernel's compiled form seems to lie on disk, told from the names of files without loading numba."""
        name = f"{self.plain.__qualname__}_{self.fingerprint}".replace("<", "").replace(">", "")
        source = Path(self.plain.__code__.co_filename)
        version = f"py{sys.version_info[0]}{sys.version_info[1]}"
        pattern = f"{source.stem}.{name}-*.{version}*.nbc"
        return any(next(folder.glob(pattern), None) is not None for folder in cache_folders(source))

    def _globals(self) -> dict[str, Any]:
        """Return the module's names that the function reads (not the attributes, which may be called alike)."""
        known = self.plain.__globals__
        read = {step.argval for step in dis.get_instructions(self.plain) if step.opname == "LOAD_GLOBAL"}
        return {name: known[name] for name in sorted(read) if name in known}

    def _linked(self) -> Any:
        """Return the function with compiled kernels where it names kernels, as numba needs it."""
        plain = self.plain
        scope = {**plain.__globals__, **{k: v.callee for k, v in self._globals().items() if isinstance(v, Kernel)}}
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
            elif isinstance(value, int | float) or hasattr(value, "dtype"):  # a number, of Python or of numpy
                parts.append(f"{name}={value!r}")
        return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:8]

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Run the plain form (or the compiled one once it exists)."""
        return cast(R, (self._compiled or self.plain)(*args, **kwargs))


def kernel(function: Any = None, *, compile_seconds: float = 0.5, **options: Any) -> Any:
    """Mark a function as a kernel.

    Parameters
    ----------
    compile_seconds
        About how long it takes to compile the function with all that it calls, where that is more than a moment.
    **options
        Go to ``numba.njit``.
    """
    if function is None:
        return functools.partial(kernel, compile_seconds=compile_seconds, **options)
    return Kernel(function, options, compile_seconds)


def cache_folders(source: Path) -> list[Path]:
    """Return the folders in which numba may keep what it compiled from a file, the likeliest first."""
    parent = source.resolve().parent
    unique = f"{parent.name}_{hashlib.sha1(str(parent).encode(), usedforsecurity=False).hexdigest()}"
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    if chosen:
        return [Path(chosen) / unique]
    home = Path.home()
    if sys.platform == "darwin":
        personal = home / "Library" / "Caches"
    elif sys.platform == "win32":
        personal = Path(os.environ.get("LOCALAPPDATA", home))
    else:
        personal = Path(os.environ.get("XDG_CACHE_HOME") or home / ".cache")
    return [parent / "__pycache__", personal / "numba" / unique]


def _numba_is_loaded() -> bool:
    return "numba" in sys.modules


@functools.cache
def _say_once(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def _for_wide_integers(dispatcher: Any) -> Any:
    """Let other kernels pass integers of any width to this one, while it is compiled for 64 bits alone.

    Numba compiles a function anew for every combination of argument types it meets, and one value comes as int16 from one
    array, as int32 from another, and as a literal from a third place. Each of these costs as much as the first, and all
    of them do the same.
    """
    from numba.core import types as known

    numba_types: Any = known
    template = dispatcher.get_call_template

    def wide(argument: Any) -> Any:
        argument = numba_types.unliteral(argument)
        signed = isinstance(argument, numba_types.Integer) and argument.signed
        return numba_types.int64 if signed else argument

    dispatcher.get_call_template = lambda args, kws: template(tuple(map(wide, args)), kws)
    return dispatcher
