"""Load the public names of a package when they are first used.

Every package of ninefold says in one table which module holds which public name; importing the package then costs nothing,
and ``dir`` shows the public names alone.

Examples
--------
>>> from ninefold._lazy import attach
>>> load, names = attach("ninefold", {"errors": ("NotPlane", "BadInput")}, parts=("io",))
>>> names()
['BadInput', 'NotPlane', 'io']
>>> load("NotPlane").__name__
'NotPlane'
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

__all__ = ["attach"]


def attach(
    package: str, home: Mapping[str, Sequence[str]], *, parts: Sequence[str] = ()
) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return the ``__getattr__`` and ``__dir__`` of a package.

    Parameters
    ----------
    package
        Its ``__name__``.
    home
        Module, by its dotted name below the package, to the public names that it holds.
    parts
        Modules below the package that are public themselves; dotted names are known by their last part.
    """
    module_of = {name: module for module, names in home.items() for name in names}
    part_of = {part.rpartition(".")[2]: part for part in parts}

    def load(name: str) -> Any:
        if name in module_of:
            return getattr(import_module(f"{package}.{module_of[name]}"), name)
        if name in part_of:
            return import_module(f"{package}.{part_of[name]}")
        raise AttributeError(f"module {package!r} has no attribute {name!r}")

    public = sorted({*module_of, *part_of})
    return load, lambda: list(public)
