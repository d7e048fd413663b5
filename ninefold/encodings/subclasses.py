"""The maximal tractable subclasses of RCC-8, H8, Q8 and C8, and the one of RCC-5.

A network all of whose relations lie in one of these three is decided by algebraic closure alone. They are the only
maximal tractable sets of RCC-8 relations that hold every base relation, and all three avoid the 76 relations of NP8,
any of which makes reasoning NP-hard together with the base relations. The sizes count the empty relation.

RCC-5 has one that holds every base relation, here called H5; it has 28 members.

A relation outside a subclass is a union of a few relations inside it, so a search need only try those, not every base
relation; `Subclass.split` names them.

Examples
--------
>>> from ninefold.encodings import H8, RCC8
>>> len(H8.relations)
148
>>> hard = RCC8.relation("DC NTPP TPPi EQ")
>>> hard in H8
False
>>> [RCC8.text(part) for part in H8.split(hard)]
['DC TPPi EQ', 'NTPP']

References
----------
J. Renz and B. Nebel, "On the complexity of qualitative spatial reasoning: a maximal tractable fragment of the region
connection calculus", Artificial Intelligence 108, 1999 (H8).
J. Renz, "Maximal tractable fragments of the region connection calculus: a complete analysis", IJCAI 1999 (Q8, C8).
P. Jonsson and T. Drakengren, "A complete classification of tractability in RCC-5", JAIR 6, 1997 (H5).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ninefold.errors import BadInput

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

__all__ = ["C8", "H5", "H8", "NP8", "Q8", "Subclass"]

DC, EC, PO, TPP, NTPP, TPPi, NTPPi, EQ = (1 << k for k in range(8))


@dataclass(frozen=True)
class Subclass:
    """A set of relations of a calculus, closed under intersection, converse and composition.

    Parameters
    ----------
    name, calculus
        What it and the calculus are called.
    n_bases
        Number of base relations of the calculus, at most eight.
    relations
        Masks, the empty relation among them.

    Attributes
    ----------
    member
        (2^b,) bool, read-only: which masks belong to it.
    splits
        For every mask the parts of `split`.
    """

    name: str
    calculus: str
    n_bases: int
    relations: frozenset[int]
    member: NDArray[np.bool_] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        member = np.zeros(1 << self.n_bases, dtype=bool)
        member[list(self.relations)] = True
        member.flags.writeable = False
        object.__setattr__(self, "member", member)

    def __contains__(self, mask: int) -> bool:
        return mask in self.relations

    def split(self, mask: int) -> tuple[int, ...]:
        """Return as few members as can be whose union is `mask`, pairwise disjoint, the largest first.

        The empty relation has no part, and a member is its own only part.

        Raises
        ------
        BadInput
            `mask` is no relation of the calculus.
        """
        if not 0 <= mask < len(self.splits):
            raise BadInput(f"{mask} is no relation of {self.calculus}: masks run from 0 to {len(self.splits) - 1}")
        return self.splits[mask]

    @cached_property
    def splits(self) -> tuple[tuple[int, ...], ...]:
        """Parts of every mask, by dynamic programming over subsets; O(3^b)."""
        best: list[tuple[int, ...]] = [()]
        for mask in range(1, 1 << self.n_bases):
            # The part with the lowest base is chosen first, so that every partition is met once.
            low = mask & -mask
            found: tuple[int, ...] | None = None
            part = mask
            while part:
                if part & low and part in self.relations:
                    parts = _largest_first((part, *best[mask ^ part]))
                    if found is None or _cost(parts) < _cost(found):
                        found = parts
                part = (part - 1) & mask
            if found is None:
                raise BadInput(f"{self.name} does not hold every base relation of {self.calculus}, so it cannot split")
            best.append(found)
        return tuple(best)


def _largest_first(parts: tuple[int, ...]) -> tuple[int, ...]:
    return tuple(sorted(parts, key=lambda part: (-part.bit_count(), part)))


def _cost(parts: tuple[int, ...]) -> tuple[object, ...]:
    """Few parts first, then a large one, which leaves the rest of a search small."""
    return (len(parts), [-part.bit_count() for part in parts], parts)


def _subclass(name: str, keep: Callable[[int], bool]) -> Subclass:
    relations = frozenset(r for r in range(256) if r not in NP8 and keep(r))
    return Subclass(name, "rcc8", 8, relations)


NP8 = frozenset(r for r in range(256) if not r & PO and r & (TPP | NTPP) and r & (TPPi | NTPPi)) | frozenset(
    {EC | NTPP | EQ, DC | EC | NTPP | EQ, EC | NTPPi | EQ, DC | EC | NTPPi | EQ}
)
"""The 76 relations that make reasoning NP-hard together with the base relations (Renz and Nebel 1999)."""


def _horn(r: int) -> bool:
    """Keep what Horn clauses can say: with EQ and an inner part, the tangential part lies between."""
    return not r & EQ or (not (r & NTPP and not r & TPP) and not (r & NTPPi and not r & TPPi))


def _without_po(mark: int, others: int) -> Callable[[int], bool]:
    """Drop the relations that jump over PO: they hold `mark` and some of `others`, but not PO."""
    return lambda r: not (r & mark and r & others and not r & PO)


_PARTS = TPP | NTPP | TPPi | NTPPi

H8 = _subclass("H8", _horn)
"""The 148 relations that Horn clauses express; ORD-Horn's counterpart for regions."""

Q8 = _subclass("Q8", _without_po(EQ, _PARTS))
"""The 160 relations of Q8."""

C8 = _subclass("C8", _without_po(EC, _PARTS | EQ))
"""The 158 relations of C8."""

H5 = Subclass("H5", "rcc5", 5, frozenset(r for r in range(32) if not (r & 0b00100 and r & 0b01000 and not r & 0b00010)))
"""The 28 relations of RCC-5 that do not jump over PO from PP to PPi."""
