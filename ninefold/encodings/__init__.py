"""Relations as bits, and questions about them as clauses: what the reasoner stands on.

A relation is a set of base relations held as an int, one bit a base relation; names are only at the rim.

=====================  ============================================================================================
`calculus`             `Calculus`: base relations with converse, composition and identity, every law checked
`library`              the calculi that come along: RCC-8, RCC-5, the point algebra, Allen's intervals
`model`, `rcc8`        what RCC relations say of pairs of cells, and the tables derived from that
`composition`          composition by SAT from the same model
`subclasses`           the maximal tractable subclasses H8, Q8, C8 (and H5 of RCC-5), and splits into them
`horn`                 Horn theories of RCC-8 and RCC-5
`theory`               `theory_of`: what is known of a calculus, with its sources
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

from typing import TYPE_CHECKING

from ninefold._lazy import attach

if TYPE_CHECKING:
    from .calculus import Calculus
    from .cells import encode_cells
    from .composition import SatComposition, compose_by_sat
    from .direct import encode_direct
    from .encoding import Encoding
    from .library import ALLEN, CALCULI, POINT, calculus_named
    from .orders import ORDERS, Triangulation, triangulate
    from .rcc8 import RCC5, RCC8
    from .registry import ENCODINGS, encode
    from .sat import DEFAULT_SOLVER, SOLVERS, SatSolver, open_solver
    from .splitting import encode_splitting
    from .subclasses import C8, H5, H8, NP8, Q8, Subclass
    from .support import encode_support
    from .theory import Known, Theory, theory_of
    from .triangulated import encode_triangulated

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
    "Known",
    "SatComposition",
    "SatSolver",
    "Subclass",
    "Theory",
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
    "theory_of",
    "triangulate",
]

__getattr__, __dir__ = attach(
    __name__,
    {
        "calculus": ("Calculus",),
        "cells": ("encode_cells",),
        "composition": ("SatComposition", "compose_by_sat"),
        "direct": ("encode_direct",),
        "encoding": ("Encoding",),
        "library": ("ALLEN", "CALCULI", "POINT", "calculus_named"),
        "orders": ("ORDERS", "Triangulation", "triangulate"),
        "rcc8": ("RCC5", "RCC8"),
        "registry": ("ENCODINGS", "encode"),
        "sat": ("DEFAULT_SOLVER", "SOLVERS", "SatSolver", "open_solver"),
        "splitting": ("encode_splitting",),
        "subclasses": ("C8", "H5", "H8", "NP8", "Q8", "Subclass"),
        "support": ("encode_support",),
        "theory": ("Known", "Theory", "theory_of"),
        "triangulated": ("encode_triangulated",),
    },
)
