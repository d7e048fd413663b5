"""Horn theories: atoms over pairs in which composition, and a tractable subclass of labels, are Horn clauses.

Six atoms describe a pair of regions (x, y): contact C, overlap O, part P(x, y) and P(y, x), inner part N(x, y) and
N(y, x). The base relations are the truth assignments

====  ====  ====  ===============  ========================  ======================
DC    EC    PO    TPP              NTPP                      EQ
none  C     C, O  C, O, P(x, y)    C, O, P(x, y), N(x, y)    C, O, P(x, y), P(y, x)
====  ====  ====  ===============  ========================  ======================

and the converses. What composition says of three regions is a handful of Horn clauses over these atoms ("a part of a
part is a part", ...), and the labels that Horn clauses can express, those closed under taking the atoms two members
have in common, are exactly H8. RCC-5 is the same without boundaries (O and P only), and its labels are H5.

Examples
--------
>>> from ninefold.encodings.horn import RCC8_HORN
>>> sorted(RCC8_HORN.meaning[3])  # TPP
['C', 'O', 'P']

References
----------
M. Westphal and J. Hue, "A concise Horn theory for RCC8", ECAI 2014.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from .rcc8 import RCC5, RCC8
from .subclasses import H5, H8

if TYPE_CHECKING:
    from .calculus import Calculus
    from .subclasses import Subclass

__all__ = ["RCC5_HORN", "RCC8_HORN", "HornTheory"]


@dataclass(frozen=True, slots=True, eq=False)
class HornTheory:
    """Atoms over pairs of entities in which composition and a subclass of labels are Horn.

    Parameters
    ----------
    calculus, subclass
        What it is a theory of, and the labels that it expresses.
    atoms
        For every atom the one that says the same of (y, x): itself if it is symmetric.
    meaning
        For every base relation, in the order of the bits, the atoms that hold.
    pair_rules
        Horn clauses over one pair: atoms that cannot hold without the last, or (last None) together.
    triangle_rules
        ``(p, q, r)``: p of (x, y) and q of (y, z) give r of (x, z).
    """

    calculus: Calculus
    subclass: Subclass
    atoms: dict[str, str]
    meaning: tuple[frozenset[str], ...]
    pair_rules: tuple[tuple[tuple[str, ...], str | None], ...]
    triangle_rules: tuple[tuple[str, str, str], ...]


_ATOMS8 = {"C": "C", "O": "O", "P": "Pi", "Pi": "P", "N": "Ni", "Ni": "N"}
_ATOMS5 = {"O": "O", "P": "Pi", "Pi": "P"}

RCC8_HORN = HornTheory(
    calculus=RCC8,
    subclass=H8,
    atoms=_ATOMS8,
    meaning=tuple(
        map(frozenset, ([], ["C"], "CO", "COP", "COPN", ["C", "O", "Pi"], ["C", "O", "Pi", "Ni"], ["C", "O", "P", "Pi"]))
    ),
    pair_rules=(
        (("N",), "P"),
        (("Ni",), "Pi"),
        (("P",), "O"),
        (("Pi",), "O"),
        (("O",), "C"),
        (("N", "Pi"), None),
        (("P", "Ni"), None),
    ),
    triangle_rules=(
        ("C", "P", "C"),
        ("O", "P", "O"),
        ("P", "P", "P"),
        ("N", "P", "N"),
        ("P", "N", "N"),
        ("C", "N", "O"),
    ),
)
"""The theory of RCC-8 over C, O, P and N."""

RCC5_HORN = HornTheory(
    calculus=RCC5,
    subclass=H5,
    atoms=_ATOMS5,
    meaning=tuple(map(frozenset, ([], ["O"], ["O", "P"], ["O", "Pi"], ["O", "P", "Pi"]))),
    pair_rules=((("P",), "O"), (("Pi",), "O")),
    triangle_rules=(("O", "P", "O"), ("P", "P", "P")),
)
"""The theory of RCC-5 over O and P."""
