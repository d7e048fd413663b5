"""The evidence of a walk whose places are recognised, as arrays: visits, legs between them, and lists of exits.

Nothing is recognised here but places. Which legs went the same way is the business of `ways`, and how the ways lie around a
place that of `orders`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import nan, pi
from typing import TYPE_CHECKING

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import WalkError, located

from ..heading import wrap, wrap_all
from ..names import Names
from ..robot.legs import LegReader
from ..robot.units import unit_of
from ..robot.walk import Visit

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..robot.legs import Leg
    from ..robot.walk import Walk

__all__ = ["Evidence", "read_evidence"]


@dataclass(frozen=True, slots=True)
class Evidence:
    """What a walk of L legs over V places says.

    Attributes
    ----------
    places
        Names of the places in the order first seen.
    at
        (L + 1,) int64, the place of every visit; leg i runs from ``at[i]`` to ``at[i + 1]``.
    out, back, turn
        (L,) float64 radians: yaw on leaving, yaw of the way back at the place reached, net rotation with whole turns. Not
        wrapped where a bias was taken out.
    felt
        (L,) float64 radians, the net rotation as read, whatever bias was taken out since.
    metres
        (L,) float64, NaN where not measured.
    sharpest
        (L,) float64, the largest rotation between two samples of a leg.
    single
        (L,) bool: one sample alone, so that both its ends have the same error.
    edges
        Of every leg, the name that the log gives to the way, or None.
    exits
        Of every visit, the yaws of its list of exits in the order listed, radians, or None.
    unfinished
        Whether the walk ends on a leg, which is left out.
    """

    places: tuple[str, ...]
    at: NDArray[np.int64]
    out: NDArray[np.float64]
    back: NDArray[np.float64]
    turn: NDArray[np.float64]
    felt: NDArray[np.float64]
    metres: NDArray[np.float64]
    sharpest: NDArray[np.float64]
    single: NDArray[np.bool_]
    edges: tuple[str | None, ...]
    exits: tuple[NDArray[np.float64] | None, ...]
    unfinished: bool

    @property
    def n_legs(self) -> int:
        """Number of finished legs."""
        return len(self.out)

    def visits_of(self) -> list[list[int]]:
        """Return the visits of every place, ascending. O(L)."""
        found: list[list[int]] = [[] for _ in self.places]
        for visit, place in enumerate(self.at.tolist()):
            found[place].append(visit)
        return found

    def without(self, bias: NDArray[np.float64]) -> Evidence:
        """Return the evidence with a bias of (L + 1,) radians, one for each visit, taken out of all its readings."""
        left, reached = bias[:-1], bias[1:]
        return replace(
            self,
            out=self.out - left,
            back=self.back - reached,
            turn=self.turn - reached + left,
            exits=tuple(
                None if yaws is None else wrap_all(yaws - of_visit)
                for yaws, of_visit in zip(self.exits, bias.tolist(), strict=True)
            ),
        )


def read_evidence(walk: Walk) -> Evidence:
    """Read the visits, legs and exit lists of a walk.

    Raises
    ------
    WalkError
        For a walk without a place, a place that was not recognised, a place whose lists differ in their number of exits,
        samples before the first place, or a leg that cannot be read; with the number of the event, counted from 1.

    Notes
    -----
    Complexity O(samples + exits).
    """
    unit = unit_of(walk.header.heading)
    reader = LegReader(unit)
    legs: list[Leg] = []
    rows: dict[str, int] = {}
    at: list[int] = []
    edges: list[str | None] = []
    exits: list[NDArray[np.float64] | None] = []
    counts: dict[int, tuple[int, int]] = {}
    for number, event in enumerate(walk.events, 1):
        try:
            if not isinstance(event, Visit):
                if not at:
                    raise WalkError("a heading before the first place; a walk begins at a place")
                reader.take(event.yaw, event.metres)
                continue
            if event.place is None:
                raise WalkError(
                    "a place that was not recognised (null); an estimate from headings that err needs every place named"
                )
            if at:
                legs.append(_finished(reader))
                edges.append(event.edge)
            elif event.edge is not None:
                raise WalkError(f"edge {quoted(event.edge)} is named at the first place, before any leg")
            Names("vertex", 1, (event.place,))
            row = rows.setdefault(event.place, len(rows))
            at.append(row)
            exits.append(None if event.exits is None else np.array([exit_.yaw for exit_ in event.exits], np.float64))
            if event.exits is not None:
                count, before = counts.setdefault(row, (len(event.exits), number))
                if count != len(event.exits):
                    raise WalkError(
                        f"place {quoted(event.place)} lists {counted(len(event.exits), 'exit')} and listed {count} at event "
                        f"{before}: two places with one name, or an exit overlooked? The number of exits has to be right"
                    )
        except WalkError as error:
            raise located(error, f"event {number}", event=number) from None
    if not at:
        raise WalkError("there is no map before the first place; a walk visits at least one")
    turn = np.array([leg.turn for leg in legs], np.float64)
    return Evidence(
        tuple(rows),
        np.array(at, np.int64),
        np.array([leg.out for leg in legs], np.float64),
        np.array([leg.back for leg in legs], np.float64),
        turn,
        turn,
        np.array([nan if leg.metres is None else leg.metres for leg in legs], np.float64),
        np.array([leg.sharpest for leg in legs], np.float64),
        np.array([_one_reading(leg) for leg in legs], np.bool_),
        tuple(edges),
        tuple(exits),
        reader.started,
    )


def _finished(reader: LegReader) -> Leg:
    if not reader.started:
        raise WalkError("two places with no heading between them; a leg has at least one sample")
    return reader.finish()


def _one_reading(leg: Leg) -> bool:
    """Whether both ends of a leg seem to be read from one sample; a robot that turns by nothing at all counts as well."""
    return leg.turn == 0.0 and leg.sharpest == 0.0 and abs(wrap(leg.back - pi - leg.out)) < 1e-12
