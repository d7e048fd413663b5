"""What geographic software calls relations, and what that is in a calculus of regions.

OGC's words are predicates that overlap each other ("within" holds of equal regions, too) and differ in meaning from
Egenhofer's where they are spelled alike, so a network does not read them. But who writes ``touches`` should not have to
search for ``meet``: an unknown relation that is such a word is answered with what it means of regions.

Examples
--------
>>> from ninefold.encodings import RCC8, RCC5
>>> meant_by("touches", RCC8), meant_by("ST_Within", RCC8), meant_by("within", RCC5)
('meet', 'coveredBy inside equal', 'PP EQ')
>>> meant_by("geo:sfIntersects", RCC5), meant_by("kissing", RCC8)
('PO PP PPi EQ', None)

References
----------
OGC 06-103r4, Simple feature access, 6.1.15 (the predicates on areas); OGC 11-052r4, GeoSPARQL, tables 1 to 3.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .calculus import Calculus

__all__ = ["WORDS", "meant_by"]

_RCC8 = {
    "touches": "meet",
    "touch": "meet",
    "touching": "meet",
    "adjacent": "meet",
    "adjoins": "meet",
    "borders": "meet",
    "within": "coveredBy inside equal",
    "containsproperly": "contains",
    "intersects": "meet overlap coveredBy inside covers contains equal",
    "intersect": "meet overlap coveredBy inside covers contains equal",
    "crosses": "overlap",
    "overlaps": "overlap",
    "equals": "equal",
    "same": "equal",
    "outside": "disjoint",
    "separate": "disjoint",
    "partof": "coveredBy inside",
}
_RCC5 = {
    **dict.fromkeys(("touches", "touch", "touching", "adjacent", "adjoins", "borders"), "DR"),
    **dict.fromkeys(("disjoint", "meet", "outside", "separate", "apart"), "DR"),
    **dict.fromkeys(("inside", "coveredby", "partof"), "PP"),
    **dict.fromkeys(("contains", "covers", "containsproperly"), "PPi"),
    **dict.fromkeys(("intersects", "intersect"), "PO PP PPi EQ"),
    **dict.fromkeys(("overlap", "overlaps", "crosses"), "PO"),
    **dict.fromkeys(("equal", "equals", "same"), "EQ"),
    "within": "PP EQ",
}
WORDS = {"rcc8": _RCC8, "rcc5": _RCC5}
"""By calculus and word, in lower case and without ornament, the relations meant, as every reader takes them."""
_ORNAMENT = re.compile(r"^(geo:|geof:|ogc:)?(st_|sf)?|[_-]", re.IGNORECASE)


def meant_by(word: str, calculus: Calculus) -> str | None:
    """Return the relations of a calculus that a word of geographic software means of regions, or None.

    Case, underscores and the prefixes of SQL and GeoSPARQL do not matter.
    """
    meant = WORDS.get(calculus.name, {}).get(_ORNAMENT.sub("", word).casefold())
    if meant is None:
        return None
    known = {*calculus.bases, *(alias for alias, _ in calculus.aliases)}
    return meant if known.issuperset(meant.split()) else None
