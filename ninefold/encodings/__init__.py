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
    from .cells import encode_cells
    from .composition import SatComposition, compose_by_sat
    from .direct import encode_direct
    from .encoding import Encoding
    from .library import CALCULI, calculus_named
    from .orders import ORDERS, Triangulation, triangulate
    from .rcc8 import RCC5, RCC8
    from .registry import ENCODINGS, encode
    from .sat import DEFAULT_SOLVER, SOLVERS, SatSolver, open_solver
    from .splitting import encode_splitting
    from .subclasses import C8, H5, H8, NP8, Q8, Subclass
    from .support import encode_support
    from .triangulated import encode_triangulated

    ALLEN: Calculus
    POINT: Calculus

__all__ = [
    "ALLEN",
    "C8",
    "CALCULI",
    "DEFAULT_SOLVER",
    "ENCODINGS",
    "H5",
    "H8",
    "NP8",
    "ORDERS",
    "POINT",
    "Q8",
    "RCC5",
    "RCC8",
    "SOLVERS",
    "Calculus",
    "Encoding",
    "SatComposition",
    "SatSolver",
    "Subclass",
    "Triangulation",
    "calculus_named",
    "compose_by_sat",
    "encode",
    "encode_cells",
    "encode_direct",
    "encode_splitting",
    "encode_support",
    "encode_triangulated",
    "open_solver",
    "triangulate",
]

_HOME = {
    "C8": "subclasses",
    "CALCULI": "library",
    "Calculus": "calculus",
    "DEFAULT_SOLVER": "sat",
    "ENCODINGS": "registry",
    "Encoding": "encoding",
    "H5": "subclasses",
    "H8": "subclasses",
    "NP8": "subclasses",
    "ORDERS": "orders",
    "Q8": "subclasses",
    "RCC5": "rcc8",
    "RCC8": "rcc8",
    "SOLVERS": "sat",
    "SatComposition": "composition",
    "SatSolver": "sat",
    "Subclass": "subclasses",
    "Triangulation": "orders",
    "calculus_named": "library",
    "compose_by_sat": "composition",
    "encode": "registry",
    "encode_cells": "cells",
    "encode_direct": "direct",
    "encode_splitting": "splitting",
    "encode_support": "support",
    "encode_triangulated": "triangulated",
    "open_solver": "sat",
    "triangulate": "orders",
}


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    if name in ("ALLEN", "POINT"):
        return import_module(f"{__name__}.library").calculus_named(name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
