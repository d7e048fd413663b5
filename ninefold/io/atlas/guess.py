"""What is in doubt about a map that was kept as a guess: the likeliest of several that a walk leaves."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from math import degrees, log2
from typing import TYPE_CHECKING, Any, Self, get_args

from ninefold._wording import counted
from ninefold.errors import BadInput
from ninefold.mapping import Doubt
from ninefold.mapping.doubt.doubts import DoubtKind

if TYPE_CHECKING:
    from ninefold.mapping import Estimate

__all__ = ["Guess"]


@dataclass(frozen=True, slots=True)
class Guess:
    """What is in doubt about a map that was kept as a guess.

    Attributes
    ----------
    sigma, drift
        What headings were declared to err by, radians.
    count
        Number of maps that the walk leaves, this one being the likeliest; None where they were not counted.
    doubts
        What is open.
    more
        For every doubt, what to do to settle it, in words; empty where no walk would.

    Examples
    --------
    >>> doubt = Doubt("order", ("yard",), (("a", "b", "c"), ("a", "c", "b")), "at 'yard' the way to 'b' lies left or right")
    >>> guess = Guess(0.035, 0.0, 2, (doubt,), ("walk it 5 times more",))
    >>> guess.warnings[1]
    "at 'yard' the way to 'b' lies left or right; walk it 5 times more"
    >>> Guess.from_json(guess.to_json()) == guess
    True
    """

    sigma: float
    drift: float
    count: int | None
    doubts: tuple[Doubt, ...]
    more: tuple[str, ...]

    @classmethod
    def of(cls, estimate: Estimate) -> Self | None:
        """Return what is in doubt about the likeliest map of an estimate, None where it is certain."""
        if estimate.certain:
            return None
        more = tuple("; ".join(map(str, estimate.more(doubt))) for doubt in estimate.doubts)
        return cls(estimate.noise.sigma, estimate.noise.drift, estimate.count, estimate.doubts, more)

    @property
    def bits(self) -> float | None:
        """The logarithm to base 2 of the number of maps; None where it is not counted."""
        return log2(self.count) if self.count else None

    @property
    def told(self) -> tuple[Doubt, ...]:
        """The doubts with what to do to settle them in their words."""
        return tuple(
            replace(doubt, text=f"{doubt.text}; {more}" if more else doubt.text)
            for doubt, more in zip(self.doubts, self.more, strict=True)
        )

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentences to be kept with the map: that it is a guess, and what is open."""
        number = "maps that were not counted" if self.count is None else counted(self.count, "map")
        noise = f"headings that err by {degrees(self.sigma):.3g} degrees"
        return (f"this map is a guess: {noise} leave {number}, and it is the likeliest", *map(str, self.told))

    def to_json(self) -> str:
        """Return it as a JSON object."""
        doubts = [
            {"kind": one.kind, "places": one.places, "orders": one.orders, "text": one.text, "more": more}
            for one, more in zip(self.doubts, self.more, strict=True)
        ]
        found = {"sigma": self.sigma, "drift": self.drift, "count": self.count, "doubts": doubts}
        return json.dumps(found, ensure_ascii=False, allow_nan=False)

    @classmethod
    def from_json(cls, text: str) -> Self:
        """Read what `to_json` wrote.

        Raises
        ------
        BadInput
            If it is something else.
        """
        try:
            found: Any = json.loads(text)
            sigma, drift, count = found["sigma"], found["drift"], found["count"]
            doubts = tuple(
                Doubt(_kind(one["kind"]), _texts(one["places"]), tuple(map(_texts, one["orders"])), _text(one["text"]))
                for one in found["doubts"]
            )
            more = _texts([one["more"] for one in found["doubts"]])
        except (ValueError, TypeError, LookupError, RecursionError):
            raise BadInput("what is in doubt about the map cannot be read") from None
        numbers = [value for value in (sigma, drift) if type(value) in (int, float)]
        if len(numbers) < 2 or not (count is None or (type(count) is int and count > 0)):
            raise BadInput("what is in doubt about the map has numbers that are none")
        return cls(float(sigma), float(drift), count, doubts, more)


def _kind(value: Any) -> DoubtKind:
    if value not in get_args(DoubtKind):
        raise ValueError(value)
    found: DoubtKind = value
    return found


def _text(value: Any) -> str:
    if not isinstance(value, str):
        raise TypeError(value)
    return value


def _texts(values: Any) -> tuple[str, ...]:
    if not isinstance(values, list):
        raise TypeError(values)
    return tuple(map(_text, values))
