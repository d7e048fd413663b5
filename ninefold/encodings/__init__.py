"""Relations as bits, and questions about them as clauses.

Names load when they are first used, so that importing this package costs next to nothing.

Examples
--------
>>> from ninefold.encodings import RCC8
>>> RCC8.names(RCC8.compose(RCC8.relation("inside"), RCC8.relation("disjoint")))
('DC',)
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .calculus import Calculus
    from .rcc8 import RCC5, RCC8

__all__ = ["RCC5", "RCC8", "Calculus"]

_HOME = {"RCC5": "rcc8", "RCC8": "rcc8", "Calculus": "calculus"}


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
