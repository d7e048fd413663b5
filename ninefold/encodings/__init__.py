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
    from .library import CALCULI, calculus_named
    from .rcc8 import RCC5, RCC8
    from .subclasses import C8, H8, NP8, Q8, Subclass

    ALLEN: Calculus
    POINT: Calculus

__all__ = [
    "ALLEN",
    "C8",
    "CALCULI",
    "H8",
    "NP8",
    "POINT",
    "Q8",
    "RCC5",
    "RCC8",
    "Calculus",
    "Subclass",
    "calculus_named",
]

_HOME = {
    "C8": "subclasses",
    "CALCULI": "library",
    "Calculus": "calculus",
    "H8": "subclasses",
    "NP8": "subclasses",
    "Q8": "subclasses",
    "RCC5": "rcc8",
    "RCC8": "rcc8",
    "Subclass": "subclasses",
    "calculus_named": "library",
}


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    if name in ("ALLEN", "POINT"):
        return import_module(f"{__name__}.library").calculus_named(name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
