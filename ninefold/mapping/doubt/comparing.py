"""How one map of a walk differs from another: which places of the one are several of the other.

Places of the first map are called A, B, C, ..., in the order of their first visits, or as the walk names them. A place of
another map that has the same visits is called the same. One that has the visits of several is called ``A=B``; one that has
some of the visits of A alone ``A1``, ``A2``, ...; and ``A1=B`` is what that says.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np

from ninefold.errors import DifferentMaps

if TYPE_CHECKING:
    from .hypotheses import Hypothesis

__all__ = ["PlaceKind", "PlaceLabel", "place_labels_against"]

PlaceKind: TypeAlias = Literal["same", "merged", "split", "mixed"]

_LONGEST = 3
"""Places of the first map that a label tells; of more it says how many."""


@dataclass(frozen=True, slots=True)
class PlaceLabel:
    """What a place of one map is in another.

    Attributes
    ----------
    text
        See the text of this module.
    kind
        ``"same"``: it has the same visits. ``"merged"``: those of several places. ``"split"``: some of those of one.
        ``"mixed"``: some of those of several.
    """

    text: str
    kind: PlaceKind


def place_labels_against(best: Hypothesis, other: Hypothesis) -> tuple[PlaceLabel, ...]:
    """Return for every place of a map what it is in the first one.

    Raises
    ------
    DifferentMaps
        If they are not of one walk.

    Notes
    -----
    Complexity O(nodes).

    Examples
    --------
    >>> from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader, hypotheses
    >>> east, west = Heading.from_bearing(90), Heading.from_bearing(270)
    >>> along = (Samples.of(east), Visit(None, (east, west)))
    >>> walk = Walk(WalkHeader(), (Visit(None, (east,)), *along, *along, Samples.of(east), Visit(None, (west,))))
    >>> (only,) = hypotheses(walk)
    >>> [label.text for label in place_labels_against(only, only)]
    ['A', 'B', 'C', 'D']
    """
    if best.tree is not other.tree:
        raise DifferentMaps("only maps of one walk can be held against each other")
    names = [_letters(k) for k in range(best.n_places)]
    for node, name in enumerate(best.tree.names):
        if name is not None:
            names[int(best.place[node])] = name
    size = np.bincount(best.place)
    pairs, count = np.unique(np.stack([other.place, best.place], axis=1), axis=0, return_counts=True)
    part_of: list[list[tuple[int, bool]]] = [[] for _ in range(other.n_places)]
    for (mine, theirs), number in zip(pairs.tolist(), count.tolist(), strict=True):
        part_of[mine].append((theirs, number == int(size[theirs])))
    told = [0] * best.n_places
    labels = []
    for parts in part_of:
        pieces = []
        for theirs, whole in parts:
            told[theirs] += not whole
            pieces.append(names[theirs] if whole else f"{names[theirs]}{told[theirs]}")
        more = [f"{len(pieces) - _LONGEST} more"] if len(pieces) > _LONGEST else []
        labels.append(PlaceLabel("=".join([*pieces[:_LONGEST], *more]), _kind(parts)))
    return tuple(labels)


def _kind(parts: list[tuple[int, bool]]) -> PlaceKind:
    whole = all(one for _, one in parts)
    if len(parts) == 1:
        return "same" if whole else "split"
    return "merged" if whole else "mixed"


def _letters(k: int) -> str:
    """Return A to Z, AA, AB, ..."""
    text = ""
    k += 1
    while k:
        k, rest = divmod(k - 1, 26)
        text = chr(ord("A") + rest) + text
    return text
