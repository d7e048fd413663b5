"""Legs: what the heading samples between two places say, whoever the places are.

Reading a leg is apart from recognising the place at its end: a mapper reads legs and recognises, a reader of walks whose
places are in doubt reads the same legs and does not.
"""

from __future__ import annotations

from math import inf, pi, remainder
from typing import TYPE_CHECKING, NamedTuple

from ninefold.errors import WalkError, located

from ..heading import TAU, wrap
from ._growing import whole_turns
from .units import unit_of
from .walk import Visit

if TYPE_CHECKING:
    from collections.abc import Iterable

    from .units import Unit
    from .walk import Event

__all__ = ["DEGREES", "Leg", "LegReader", "read_legs"]

_HALF_TURN = pi - 1e-9

DEGREES = unit_of("yaw-deg")
"""What messages speak where no log says otherwise."""


class Leg(NamedTuple):
    """A finished leg.

    Attributes
    ----------
    out
        Yaw on leaving, radians in (-pi, pi].
    back
        Yaw of the way back at the place reached: the opposite of the yaw on arriving.
    turn
        Net rotation on the way, counter-clockwise positive, whole turns included.
    metres
        Length of the way, or None unless all of it was measured.
    sharpest
        Largest rotation between two successive samples, radians in [0, pi): how near the reading of `turn` came to being
        wrong by a whole one.
    """

    out: float
    back: float
    turn: float
    metres: float | None = None
    sharpest: float = 0.0


class LegReader:
    """Takes the samples of one leg after another.

    Parameters
    ----------
    unit
        In which messages speak of headings.

    Examples
    --------
    >>> reader = LegReader()
    >>> reader.take((0.0, 0.5))
    >>> reader.take((1.0,))
    >>> leg = reader.finish()
    >>> leg.out, round(leg.turn, 3), reader.started
    (0.0, 1.0, False)

    Notes
    -----
    The metres of a leg are those of all its samples together, and unknown if some came without. One sample alone at the
    beginning may: it was taken at the place left, before any metre.
    """

    __slots__ = ("_first", "_last", "_measured", "_metres", "_sharpest", "_turn", "_unit")

    def __init__(self, unit: Unit = DEGREES) -> None:
        self._unit = unit
        self._first: float | None = None
        self._last = 0.0
        self._turn = 0.0
        self._sharpest = 0.0
        self._metres = 0.0
        self._measured: bool | None = None  # whether all of the way so far; None at the place left

    @property
    def started(self) -> bool:
        """Whether samples were taken since the last leg was finished."""
        return self._first is not None

    def take(self, yaws: tuple[float, ...], metres: float | None = None) -> None:
        """Take samples, radians, wrapped or not; at least one. With them the metres since the samples before, if measured.

        Raises
        ------
        WalkError
            If two successive samples differ by half a turn; the leg is then as it was.
        """
        first, last, turn, sharpest = self._first, self._last, self._turn, self._sharpest
        begins = first is None
        if first is None:
            first = last = yaws[0]
            turn = sharpest = 0.0
        for yaw in yaws:
            change = remainder(yaw - last, TAU)
            if not -_HALF_TURN < change < _HALF_TURN:
                show = self._unit.heading
                raise WalkError(
                    f"successive headings {show(last)} and {show(yaw)} differ by half a turn, so the way between "
                    "them is unknown; sample more often"
                )
            turn += change
            if change > sharpest or -change > sharpest:
                sharpest = abs(change)
            last = yaw
        self._first, self._last, self._turn, self._sharpest = first, last, turn, sharpest
        if begins:
            self._metres, self._measured = 0.0, None
        if metres is None:
            if not begins or len(yaws) > 1:
                self._measured = False
        else:
            self._metres += metres
            self._measured = self._measured is not False

    def read(self) -> Leg:
        """Return the leg so far, to its last sample; `drop` then begins another.

        Raises
        ------
        WalkError
            If no sample was taken, the samples are too large to mean an angle, or the metres add up to no length.
        """
        if self._first is None:
            raise WalkError("no heading; a leg has at least one sample")
        metres = self._metres if self._measured else None
        leg = Leg(wrap(self._first), wrap(self._last + pi), self._turn, metres, self._sharpest)
        if abs(whole_turns(leg.out, leg.back, leg.turn)[1]) > 1e-6:
            raise WalkError("the headings are numbers so large that their differences mean nothing; give radians")
        if leg.metres is not None and not 0 < leg.metres < inf:
            raise WalkError(
                f"the metres of the leg add up to {leg.metres:g}, and a leg has a length; leave out what was not measured"
            )
        return leg

    def drop(self) -> None:
        """Forget the leg so far."""
        self._first = None

    def finish(self) -> Leg:
        """Return the leg and begin another; raises as `read`."""
        leg = self.read()
        self.drop()
        return leg

    def fork(self) -> LegReader:
        """Return a reader that goes on from here on its own."""
        other = LegReader(self._unit)
        other._first, other._last, other._turn, other._sharpest = self._first, self._last, self._turn, self._sharpest
        other._metres, other._measured = self._metres, self._measured
        return other


def read_legs(events: Iterable[Event]) -> tuple[Leg, ...]:
    """Return the finished legs of a walk, one fewer than its visits; places and exits are not looked at.

    Raises
    ------
    WalkError
        For samples before the first visit, or a leg that cannot be read; with the number of the event, counted from 1.

    Notes
    -----
    Complexity O(samples).

    Examples
    --------
    >>> from ninefold.mapping import Heading, Samples, Visit
    >>> east, north = Heading(0.0), Heading(1.5)
    >>> legs = read_legs([Visit(None), Samples.of(east, north), Visit(None), Samples.of(east)])
    >>> [round(leg.turn, 3) for leg in legs]
    [1.5]
    """
    reader = LegReader()
    legs: list[Leg] = []
    begun = False
    for number, event in enumerate(events, 1):
        try:
            if isinstance(event, Visit):
                if begun:
                    legs.append(reader.finish())
                begun = True
            elif begun:
                reader.take(event.yaw, event.metres)
            else:
                raise WalkError("a heading before the first place; a walk begins at a place")
        except WalkError as error:
            raise located(error, f"event {number}", event=number) from None
    return tuple(legs)
