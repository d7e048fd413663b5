"""The walk: what a robot senses, in order. Places it recognises, and its yaw between them.

A leg is the way from one place to the next. Its first sample is the orientation on leaving the place behind, its last the
orientation on reaching the place ahead; their unwrapped sum of differences is the net rotation along the edge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, get_args

from ninefold._wording import quoted
from ninefold.errors import WalkError

from ..heading import LARGEST_ANGLE, Heading, too_large_an_angle

if TYPE_CHECKING:
    from collections.abc import Mapping

__all__ = [
    "DEFAULT_TOLERANCE",
    "Event",
    "ExitOrder",
    "HeadingUnit",
    "Samples",
    "Visit",
    "Walk",
    "WalkHeader",
    "checked_drift",
    "checked_sigma",
    "checked_tolerance",
]

DEFAULT_TOLERANCE = 0.02
"""Radians within which two headings at one place are taken for the same dart."""

LARGEST_TOLERANCE = math.pi / 4
LARGEST_SIGMA = math.pi / 3
LARGEST_DRIFT = math.pi

HeadingUnit: TypeAlias = Literal["yaw-rad", "yaw-deg", "bearing-deg"]

ExitOrder: TypeAlias = Literal["any-order", "in-order"]


def checked_tolerance(value: float) -> float:
    """Return a tolerance in radians, or say why it is none.

    Raises
    ------
    WalkError
        Unless 0 < value < pi / 4.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value < LARGEST_TOLERANCE:
        raise WalkError(
            f"a tolerance is an angle in radians between 0 and pi/4, such as {DEFAULT_TOLERANCE}, not {quoted(value)}"
        )
    return float(value)


def checked_sigma(value: float) -> float:
    """Return the standard deviation of a heading, in radians, or say why it is none.

    Raises
    ------
    WalkError
        Unless 0 < value <= pi / 3, which is 60 degrees.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 < value <= LARGEST_SIGMA:
        raise WalkError(
            "sigma is the standard deviation of a heading in radians, above 0 and at most 1.047 (60 degrees), such as 0.035 "
            f"for 2 degrees, not {quoted(value)}"
        )
    return float(value)


def checked_drift(value: float) -> float:
    """Return the standard deviation of a slow common bias of headings, in radians, or say why it is none.

    Raises
    ------
    WalkError
        Unless 0 <= value <= pi, which is half a turn.
    """
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value <= LARGEST_DRIFT:
        raise WalkError(
            "drift is the standard deviation of a slow bias of all headings in radians, from 0 to 3.1416 (180 degrees), "
            f"such as 0.035 for 2 degrees, not {quoted(value)}"
        )
    return float(value)


@dataclass(frozen=True, slots=True)
class WalkHeader:
    """What holds for every event of a walk.

    Attributes
    ----------
    heading
        Unit in which a file gives headings: ``"yaw-rad"`` or ``"yaw-deg"`` counter-clockwise from east, ``"bearing-deg"``
        clockwise from north. In memory headings are always yaw in radians.
    compass
        Whether yaw is measured from east. False: from a direction that is unknown but the same throughout the walk.
    tolerance
        Radians within which two headings at one place are the same dart.
    extra
        Other keys of the header, kept as they are.
    sigma
        Declared standard deviation of a single heading, radians in (0, pi / 3]: what the compass errs by, each reading by
        itself. None where nothing is declared.
    drift
        Declared standard deviation of a bias that all readings at one place share and that changes slowly, radians in
        [0, pi]. None where nothing is declared.
    exits
        ``"in-order"``: every list of exits is in the true cyclic order, counter-clockwise as seen from above whatever the
        unit of the headings, beginning anywhere, so only the headings err. ``"any-order"``: the order says nothing.

    Notes
    -----
    `sigma`, `drift` and `exits` are evidence for readers of noisy walks; `Mapper` takes headings as they are and heeds the
    tolerance alone.

    Raises
    ------
    WalkError
        For an unknown unit or order of exits, a tolerance outside (0, pi / 4), a sigma or drift out of its range.

    Examples
    --------
    >>> WalkHeader(sigma=0.035, exits="in-order").sigma
    0.035
    """

    heading: HeadingUnit = "yaw-rad"
    compass: bool = True
    tolerance: float = DEFAULT_TOLERANCE
    extra: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    sigma: float | None = field(default=None, kw_only=True)
    drift: float | None = field(default=None, kw_only=True)
    exits: ExitOrder = field(default="any-order", kw_only=True)

    def __post_init__(self) -> None:
        if self.heading not in get_args(HeadingUnit):
            known = ", ".join(map(repr, get_args(HeadingUnit)))
            raise WalkError(f'the header\'s "heading" is one of {known}, not {quoted(self.heading)}')
        if not isinstance(self.compass, bool):
            raise WalkError(f'the header\'s "compass" is true or false, not {quoted(self.compass)}')
        if self.exits not in get_args(ExitOrder):
            known = " or ".join(map(repr, get_args(ExitOrder)))
            raise WalkError(f'the header\'s "exits" is {known}, not {quoted(self.exits)}')
        object.__setattr__(self, "tolerance", checked_tolerance(self.tolerance))
        if self.sigma is not None:
            object.__setattr__(self, "sigma", checked_sigma(self.sigma))
        if self.drift is not None:
            object.__setattr__(self, "drift", checked_drift(self.drift))
        object.__setattr__(self, "extra", MappingProxyType(dict(self.extra)))


@dataclass(frozen=True, slots=True)
class Visit:
    """The robot is at a place.

    Attributes
    ----------
    place
        The place's name, integers accepted, or None for a place that was not recognised.
    exits
        Headings of all ways out, or None if they were not looked for. In any order, unless the header says ``"in-order"``;
        the order given is kept.
    edge
        Name of the edge walked to get here, or None to have it named ``e0``, ``e1``, ... in the order of first traversal.
    t
        Seconds, if known.

    Examples
    --------
    >>> Visit("hall", exits=(Heading.from_bearing(0), Heading.from_bearing(90))).exits[1]
    Heading(yaw=0.0)
    """

    place: str | None
    exits: tuple[Heading, ...] | None = None
    edge: str | None = None
    t: float | None = None

    def __post_init__(self) -> None:
        if type(self.place) is not str and self.place is not None:
            object.__setattr__(self, "place", _label("a place", self.place))
        if type(self.edge) is not str and self.edge is not None:
            object.__setattr__(self, "edge", _label("an edge", self.edge))
        if self.exits is not None:
            if type(self.exits) is not tuple:
                object.__setattr__(self, "exits", tuple(self.exits))
            for heading in self.exits:
                if type(heading) is not Heading:
                    raise WalkError(f"an exit is a Heading, such as Heading.from_degrees(90), not {quoted(heading)}")


@dataclass(frozen=True, slots=True)
class Samples:
    """Orientations of the robot on its way between two places, in the order sampled.

    Attributes
    ----------
    yaw
        Radians counter-clockwise from east, wrapped or not; at least one.
    t
        Seconds of the last one, if known.
    metres
        Way travelled up to the last one, if measured: since the samples before, or since the place left where these are the
        first of their leg. Finite and not negative.

    Examples
    --------
    >>> Samples.of(Heading.from_bearing(90), Heading.from_bearing(90)).yaw
    (0.0, 0.0)
    """

    yaw: tuple[float, ...]
    t: float | None = None
    metres: float | None = None

    def __post_init__(self) -> None:
        if type(self.yaw) is not tuple:
            object.__setattr__(self, "yaw", tuple(self.yaw))
        if not self.yaw:
            raise WalkError("samples hold at least one heading")
        try:
            finite = all(map(math.isfinite, self.yaw))
        except (TypeError, OverflowError):
            finite = False
        if not finite:
            raise WalkError("samples are finite numbers, in radians")
        if max(self.yaw) > LARGEST_ANGLE or min(self.yaw) < -LARGEST_ANGLE:
            raise WalkError(f"a sample of {too_large_an_angle(max(self.yaw, key=abs))}")
        if self.metres is not None:
            object.__setattr__(self, "metres", _checked_metres(self.metres))

    @classmethod
    def of(cls, *headings: Heading, t: float | None = None, metres: float | None = None) -> Samples:
        """Make samples from headings."""
        return cls(tuple(heading.yaw for heading in headings), t, metres)


Event: TypeAlias = Visit | Samples
"""One line of a walk."""


@dataclass(frozen=True, slots=True)
class Walk:
    """A header and its events, in order.

    Whether the events make sense together is for their reader to say: `Mapper` for one map, hypotheses for many.

    Examples
    --------
    >>> east = Heading.from_bearing(90)
    >>> walk = Walk(WalkHeader(), (Visit("a"), Samples.of(east), Visit("b")))
    >>> walk.n_legs, walk.places
    (1, ('a', 'b'))
    """

    header: WalkHeader
    events: tuple[Event, ...]

    def __post_init__(self) -> None:
        if type(self.events) is not tuple:
            object.__setattr__(self, "events", tuple(self.events))

    @property
    def n_legs(self) -> int:
        """Number of legs that were finished."""
        return max(0, sum(type(event) is Visit for event in self.events) - 1)

    @property
    def places(self) -> tuple[str | None, ...]:
        """The places in the order visited, repeats and None included."""
        return tuple(event.place for event in self.events if isinstance(event, Visit))


def _checked_metres(value: object) -> float:
    try:
        if not isinstance(value, bool) and isinstance(value, int | float) and 0 <= value < math.inf:
            return float(value)
    except OverflowError:  # an integer beyond every float
        pass
    raise WalkError(f"the metres travelled are a finite number that is not negative, not {quoted(value)}")


def _label(kind: str, label: object) -> str:
    if isinstance(label, bool) or not isinstance(label, str | int):
        raise WalkError(f"the name of {kind} is a string, not {quoted(label)}")
    return str(label)
