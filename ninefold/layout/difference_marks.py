"""What differs in one map of a walk from the best one, marked on its picture: places that are several there, or part of one.

A disc is several places of the best map in one, a ring a part of one, a lozenge both: shapes tell them apart without colours
too. Exits that nobody walked are short dashed ways.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ninefold._wording import counted
from ninefold.mapping.doubt.comparing import place_labels_against

if TYPE_CHECKING:
    from ninefold.mapping import Hypothesis
    from ninefold.mapping.doubt.comparing import PlaceLabel
    from ninefold.mapping.doubt.untravelled import WithEnds

__all__ = ["DIFFERENCE_COLOURS", "Differences", "difference_mark", "differences_of"]

DIFFERENCE_COLOURS = {"merged": 1, "split": 0, "mixed": 3}
"""The role colour of each kind of difference."""

_WORDS = {
    "merged": "several places of map 1 in one (A=B)",
    "split": "some visits of a place of map 1 (A1)",
    "mixed": "some visits of several (A1=B)",
}


@dataclass(frozen=True, slots=True)
class Differences:
    """What a picture shows of how a map differs from the best one.

    Attributes
    ----------
    labels
        Of every place; vertices from their number on are unknown places behind exits that nobody walked.
    ways
        Number of ways that were walked.
    ends
        Number of exits that nobody walked.
    """

    labels: tuple[PlaceLabel, ...]
    ways: int
    ends: int

    @property
    def n_places(self) -> int:
        """Number of places that were visited."""
        return len(self.labels)

    @property
    def marked(self) -> dict[int, str]:
        """The places that differ, and how."""
        return {v: label.kind for v, label in enumerate(self.labels) if label.kind != "same"}

    @property
    def names(self) -> dict[int, str]:
        """The names of all places."""
        return {v: label.text for v, label in enumerate(self.labels)}

    @property
    def entries(self) -> list[tuple[str, str]]:
        """Each kind of difference there is, and its line in the legend."""
        kinds = set(self.marked.values())
        return [(kind, words) for kind, words in _WORDS.items() if kind in kinds]

    @property
    def caption(self) -> str:
        """The line below the picture."""
        left = f", {counted(self.ends, 'exit')} that nobody walked" if self.ends else ""
        return f"{counted(self.n_places, 'place')}, {counted(self.ways, 'way')}{left}"


def differences_of(best: Hypothesis, other: Hypothesis, wide: WithEnds) -> Differences:
    """Return what to show of a map beside the best one; `wide` is the map that is drawn."""
    ends = len(wide.unknown)
    return Differences(place_labels_against(best, other), wide.plane.n_edges - ends, ends)


def difference_mark(kind: str, x: float, y: float, radius: float) -> str:
    """Return a mark as SVG."""
    k = DIFFERENCE_COLOURS[kind]
    look = f'class="f{k}"'
    match kind:
        case "merged":
            shape = f'circle cx="{x:.2f}" cy="{y:.2f}" r="{radius:.2f}"'
        case "split":
            shape = f'circle cx="{x:.2f}" cy="{y:.2f}" r="{radius - 1:.2f}"'
            look = f'class="s{k}" fill="none" stroke-width="2.6"'
        case _:
            r = radius + 1
            shape = f'path d="M{x:.2f},{y - r:.2f} {x + r:.2f},{y:.2f} {x:.2f},{y + r:.2f} {x - r:.2f},{y:.2f}Z"'
    return f'<{shape} class="halo" fill="none" stroke-width="5"/><{shape} {look}/>'
