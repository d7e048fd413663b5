"""What is undecided about a map, marked on its picture: rings at the places, numbered as the sentences below it.

A ring is drawn in the map's own ink, so that it stands apart from every colour of sets and legs: whole where the order of
the ways around a place is undecided, dashed where legs may have gone one way or several.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput
from ninefold.mapping import Doubt

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from ninefold.mapping import PlaneMap

__all__ = ["DoubtMark", "doubt_marks", "doubt_sentences", "doubt_words", "ring"]

TOLD = 8
"""Doubts up to which each has its sentence below the picture."""

DASHES = {"order": "none", "ways": "3 2.4"}


@dataclass(frozen=True, slots=True)
class DoubtMark:
    """A place where something is undecided.

    Attributes
    ----------
    vertex
        Number of the place in the map.
    kind
        ``"order"`` or ``"ways"``; a place that is both is the former.
    numbers
        Of its doubts, from 1.
    words
        Their texts.
    """

    vertex: int
    kind: str
    numbers: tuple[int, ...]
    words: tuple[str, ...]


def doubt_marks(plane: PlaneMap, doubts: Sequence[Doubt]) -> tuple[DoubtMark, ...]:
    """Return the places to mark, ascending.

    Raises
    ------
    BadInput, UnknownName
        For what is no doubt, or a place that the map does not have.

    Examples
    --------
    >>> from ninefold.mapping import PlaneMap
    >>> plane = PlaneMap.from_geometry([(0, 0), (1, 0), (0, 1)], [(0, 1), (0, 2)], vertex_names="abc")
    >>> doubt = Doubt("order", ("a",), (("b", "c"), ("c", "b")), "at 'a' the dead end 'b' lies left or right")
    >>> doubt_marks(plane, [doubt])[0].kind
    'order'
    """
    found: dict[int, list[tuple[int, Doubt]]] = {}
    for number, doubt in enumerate(doubts, 1):
        if not isinstance(doubt, Doubt):
            raise BadInput(f"doubts are those of an estimate, as in doubts=estimate.doubts, not {quoted(doubt)}")
        for place in doubt.places:
            found.setdefault(plane.vertex_names.row(place), []).append((number, doubt))
    return tuple(
        DoubtMark(
            vertex,
            "ways" if all(doubt.kind == "ways" for _, doubt in here) else "order",
            tuple(number for number, _ in here),
            tuple(doubt.text for _, doubt in here),
        )
        for vertex, here in sorted(found.items())
    )


def doubt_words(marks: Iterable[DoubtMark]) -> list[tuple[str, str]]:
    """Return the entries of the legend: a kind of mark, and what it means."""
    kinds = [mark.kind for mark in marks]
    entries = (("order", "order undecided"), ("ways", "one way or several"))
    return [(kind, f"{words}: {counted(kinds.count(kind), 'place')}") for kind, words in entries if kind in kinds]


def doubt_sentences(doubts: Sequence[Doubt]) -> list[str]:
    """Return what to write below the picture: the doubts with their numbers, the first few of many."""
    if not doubts:
        return []
    told = [f"{number}: {doubt.text}" for number, doubt in enumerate(doubts[:TOLD], 1)]
    rest = len(doubts) - TOLD
    return [*told, *([f"and {counted(rest, 'doubt')} more"] if rest > 0 else [])]


def ring(kind: str, x: float, y: float, radius: float) -> str:
    """Return a mark as SVG."""
    shape = f'fill="none" cx="{x:.2f}" cy="{y:.2f}" r="{radius:.2f}"'
    return (
        f'<circle class="halo" {shape} stroke-width="4.4"/>'
        f'<circle class="doubt" {shape} stroke-width="2" stroke-dasharray="{DASHES[kind]}"/>'
    )
