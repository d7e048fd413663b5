"""Relations and statements in words, for people to read.

Examples
--------
>>> from ninefold.encodings import RCC8
>>> phrase(RCC8, "kitchen", RCC8.relation("inside coveredBy"), "house")
'kitchen covered by or inside house'
>>> phrase(RCC8, "kitchen", RCC8.universal & ~RCC8.relation("meet"), "garden")
'kitchen does not meet garden'
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ninefold._wording import shortened

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ninefold.encodings.calculus import Calculus

    from .statement import Statement

__all__ = ["phrase", "spoken", "told"]

_TOLD = 3
"""Statements that a repr tells."""

_VERBS = {
    "DC": ("disjoint", "not disjoint"),
    "EC": ("meets", "does not meet"),
    "PO": ("overlaps", "does not overlap"),
    "TPP": ("covered by", "not covered by"),
    "NTPP": ("inside", "not inside"),
    "TPPi": ("covers", "does not cover"),
    "NTPPi": ("contains", "does not contain"),
    "EQ": ("equals", "does not equal"),
    "DR": ("apart from", "not apart from"),
    "PP": ("part of", "not part of"),
    "PPi": ("has as part", "does not have as part"),
}


def phrase(calculus: Calculus, a: str, mask: int, b: str) -> str:
    """Return "a, related by mask, b" in words: what holds, or what does not where that is shorter.

    Base relations without words of their own keep their names.
    """
    if mask == 0:
        return f"{a} has no relation to {b}"
    if mask == calculus.universal:
        return f"{a} anyhow related to {b}"
    excluded = calculus.universal & ~mask
    words = [_VERBS.get(name, (name, f"not {name}")) for name in calculus.names(mask)]
    if excluded.bit_count() == 1:
        (name,) = calculus.names(excluded)
        return f"{a} {_VERBS.get(name, (name, f'not {name}'))[1]} {b}"
    if excluded.bit_count() < mask.bit_count() and excluded.bit_count() <= 3:
        return f"{a} none of {', '.join(_VERBS.get(n, (n, n))[0] for n in calculus.names(excluded))} {b}"
    return f"{a} {_either([word for word, _ in words])} {b}"


def spoken(calculus: Calculus, statement: Statement) -> str:
    """Return a statement in words, with its label if it has one: "kitchen inside house (floor plan)"."""
    label = f" ({statement.label})" if statement.label else ""
    return f"{phrase(calculus, statement.a, statement.mask, statement.b)}{label}"


def told(calculus: Calculus, statements: Sequence[Statement]) -> str:
    """Return the first few statements in words, and how many more there are: what fits into a repr."""
    shown = [shortened(spoken(calculus, s)) for s in statements[:_TOLD]]
    if len(statements) > _TOLD:
        shown.append(f"{len(statements) - _TOLD} more")
    return "; ".join(shown)


def _either(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"
