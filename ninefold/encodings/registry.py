"""The encodings by name.

Examples
--------
>>> from ninefold.encodings import ENCODINGS, RCC8, encode
>>> ENCODINGS
('direct', 'support', 'triangulated', 'splitting', 'cells')
>>> [encode(name, RCC8, 3, [(0, 1, 1), (1, 2, 2)]).n_vars for name in ENCODINGS]
[10, 10, 2, 28, 32]
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ninefold.errors import UnknownName

from .cells import encode_cells
from .direct import encode_direct
from .splitting import encode_splitting
from .support import encode_support
from .triangulated import encode_triangulated

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .calculus import Calculus
    from .encoding import Constraint, Encode, Encoding

__all__ = ["ENCODINGS", "encode"]

_ENCODERS: dict[str, Encode] = {
    "direct": encode_direct,
    "support": encode_support,
    "triangulated": encode_triangulated,
    "splitting": encode_splitting,
    "cells": encode_cells,
}

ENCODINGS = tuple(_ENCODERS)
"""Names that `encode` takes; ``splitting`` and ``cells`` are for RCC-8 and RCC-5 only."""


def encode(name: str, calculus: Calculus, n: int, constraints: Iterable[Constraint]) -> Encoding:
    """Encode a network with the encoding of that name; see `ninefold.encodings.encoding`.

    Raises
    ------
    UnknownName
        None of `ENCODINGS`.
    """
    if name not in _ENCODERS:
        raise UnknownName("encoding", name, ENCODINGS)
    return _ENCODERS[name](calculus, n, constraints)
