"""Relations as bits, and questions about them as clauses: what the reasoner stands on.

A relation is a set of base relations held as an int, one bit a base relation; names are only at the rim.

=====================  ============================================================================================
`calculus`             `Calculus`: base relations with converse, composition and identity, every law checked
`library`              the calculi that come along: RCC-8, RCC-5, the point algebra, Allen's intervals
`model`, `rcc8`        what RCC relations say of pairs of cells, and the tables derived from that
`composition`          composition by SAT from the same model
`subclasses`           the maximal tractable subclasses H8, Q8, C8 (and H5 of RCC-5), and splits into them
`encoding`             what an encoding is: clauses, variables, decode
`direct`, `support`    forbidden triples; what supports what
`triangulated`         support on a chordal completion, with the orders of `orders`
`splitting`            Horn clauses but for a choice between tractable parts
`cells`                the regions themselves, without a composition table
`registry`             `encode`: the encodings by name
`sat`                  SAT solvers behind one Protocol
=====================  ============================================================================================

Nothing here knows of networks with names, of maps or of geometry: entities are numbers, a network is triples
``(i, j, mask)``. Names load when they are first used, so that importing this package costs next to nothing.

Examples
--------
Kitchen (0) inside house (1), house disjoint from garden (2), and yet kitchen meets garden:

>>> from ninefold.encodings import RCC8, encode, open_solver
>>> inside, disjoint, meet = map(RCC8.relation, ("inside", "disjoint", "meet"))
>>> encoding = encode("support", RCC8, 3, [(0, 1, inside), (1, 2, disjoint), (0, 2, meet)])
>>> with open_solver("cadical195", encoding.clauses) as solver:
...     solver.solve()
False
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
