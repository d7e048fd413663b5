"""Answers: exact relations between the sets of a map.

`relate` tells how one set lies to another, `relate_pairs` and `relate_all` do so in bulk, and `containment_tree` orders
regions by what is inside what. A `Relation` is a value: a matrix, a DE-9IM string and a word.
"""

from __future__ import annotations

from .bulk import SetTable, relate_all, relate_pairs
from .nesting import containment_tree
from .relate import relate
from .relation import NAMES, RCC8_OF_NAME, Relation, converse_codes, de9im_strings, name_of_word, names_of

__all__ = [
    "NAMES",
    "RCC8_OF_NAME",
    "Relation",
    "SetTable",
    "containment_tree",
    "converse_codes",
    "de9im_strings",
    "name_of_word",
    "names_of",
    "relate",
    "relate_all",
    "relate_pairs",
]
