"""Relations in words, for derivations that people read.

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

if TYPE_CHECKING:
    from ninefold.encodings.calculus import Calculus

__all__ = ["phrase"]

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


def _either(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} or {words[-1]}"
