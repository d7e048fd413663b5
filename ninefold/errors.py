"""The errors of ninefold: one root, and leaves that also are the built-in error a caller would expect.

A message says what was given, what failed and what to do. "Inconsistent" and "unknown" are answers, never errors.

Examples
--------
>>> from ninefold.errors import UnknownName
>>> str(UnknownName("vertex", "v33", ["v1", "v3", "kitchen"]))
"there is no vertex named 'v33'; did you mean 'v3'?"
"""

from __future__ import annotations

from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from ._wording import LONGEST_QUOTE, quoted

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

__all__ = [
    "AmbiguousDart",
    "AtlasError",
    "BadInput",
    "DifferentMaps",
    "EmptyBelief",
    "EmptySet",
    "MapsDisagree",
    "MissingExtra",
    "NinefoldError",
    "NotACycle",
    "NotPlane",
    "TooLarge",
    "Undecided",
    "UnknownName",
    "WalkError",
    "located",
]


class NinefoldError(Exception):
    """Root of every error that ninefold raises on purpose. It survives a pickle, so that a worker process can raise it."""

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (type(self), self.args, self.__dict__)


def _restored(kind: type[NinefoldError], args: tuple[Any, ...], attributes: dict[str, Any]) -> NinefoldError:
    """Make an error again without composing its message anew."""
    # an error with a constructor of its own is made without it; the others' only takes the message
    error = kind.__new__(kind, *args) if "__init__" in vars(kind) else kind(*args)
    error.args = args
    error.__dict__.update(attributes)
    return error


class BadInput(NinefoldError, ValueError):
    """A value, file or argument that cannot be what it has to be.

    Attributes
    ----------
    event
        The number of the event of a walk that it is about, counted from 1, or None.
    reason
        The message without the place that stands before it.
    """

    event: int | None = None
    reason: str = ""

    def __init__(self, *message: object) -> None:
        super().__init__(*message)
        self.reason = str(self)


class UnknownName(NinefoldError, KeyError):
    """A name that the map, atlas or calculus does not have; near ones are suggested.

    Attributes
    ----------
    kind, name
        What was looked up ("vertex", "edge", "set", ...) and the name given.
    near
        Up to three existing names that look alike; or what is known to be meant.
    """

    def __init__(self, kind: str, name: str, known: Iterable[str] = (), *, meant: str | None = None) -> None:
        self.kind = kind
        self.name = name
        near = get_close_matches(name, list(known)[:100_000], n=3, cutoff=0.5) if len(name) <= LONGEST_QUOTE else []
        self.near = (meant,) if meant else tuple(near)
        hint = f"; did you mean {' or '.join(map(quoted, self.near))}?" if self.near else ""
        self.message = f"there is no {kind} named {quoted(name)}{hint}"
        super().__init__(self.message)

    def __str__(self) -> str:
        return self.message


class NotPlane(BadInput):
    """Rotation system, headings or closures that no drawing in the plane can have.

    Attributes
    ----------
    genus
        Genus of the surface the rotation system lives on, or None where the turning numbers failed.
    edges
        Names of the edges of a shortest offending part.
    """

    def __init__(self, message: str, *, genus: int | None = None, edges: Sequence[str] = ()) -> None:
        super().__init__(message)
        self.genus = genus
        self.edges = tuple(edges)


class NotACycle(BadInput):
    """A list of vertices or edges that is not one simple cycle (or not one path)."""


class AmbiguousDart(BadInput):
    """Two darts that answer to the same description: headings too close, or several parallel edges."""


class EmptySet(BadInput):
    """An operation on sets whose result would hold nothing."""


class DifferentMaps(BadInput):
    """Sets of two different maps in one question."""


class MapsDisagree(BadInput):
    """Two maps that cannot be laid over each other as they were said to be; the message names places and exits."""


class WalkError(BadInput):
    """A walk log, or one event of it, that cannot be.

    Attributes
    ----------
    where
        File and line, or the number of the event, counted from 1.
    """

    def __init__(self, message: str, *, where: str = "") -> None:
        super().__init__(f"{where}: {message}" if where else message)
        self.where = where
        self.reason = message


def located(error: BadInput, where: str, *, event: int | None = None) -> BadInput:
    """Return the same error of a walk with the place where it happened before its message, in place of any other.

    Parameters
    ----------
    where
        Such as ``"event 7"``, or file and line.
    event
        The number of the event, where it is known; otherwise that of `error` stays.
    """
    found: BadInput
    if isinstance(error, NotPlane):
        found = NotPlane(f"{where}: {error.reason}", genus=error.genus, edges=error.edges)
    elif isinstance(error, AmbiguousDart):
        found = AmbiguousDart(f"{where}: {error.reason}")
    else:
        found = WalkError(error.reason, where=where)
    found.reason = error.reason
    found.event = error.event if event is None else event
    return found


class AtlasError(NinefoldError, OSError):
    """An atlas file that cannot be opened, read or written."""


class TooLarge(NinefoldError, MemoryError):
    """A request that cannot fit; the message says how much it would take."""


class Undecided(NinefoldError, RuntimeError):
    """One answer was asked for, and it is not known which.

    Scenarios or a repair of a network of which it is not known whether it is consistent: ``check`` answers `Unknown` there,
    an iterator of scenarios has no such answer to give. The map of an estimate that leaves several.

    Attributes
    ----------
    kind
        ``"time"`` where a budget was spent, ``"theory"`` where nobody has shown how to decide the calculus, ``"map"`` where
        more than one map is left, or none.
    """

    def __init__(self, message: str, *, kind: str) -> None:
        super().__init__(message)
        self.kind = kind


class EmptyBelief(NinefoldError, ValueError):
    """No place of a map fits what a robot saw or did: the map is wrong, or headings err by more than was declared.

    Attributes
    ----------
    observation, moves
        Which look around it was, counted from 1, or the number of looks before a move that fits nowhere; and the number of
        moves before it.
    nearest
        Name of the place, of those possible before, that comes nearest to what was seen; None where there is none.
    event
        The number of the event of a walk that showed it, counted from 1, or None.
    reason
        The message without that number before it.
    """

    def __init__(self, message: str, *, observation: int, moves: int, nearest: str | None) -> None:
        super().__init__(message)
        self.observation = observation
        self.moves = moves
        self.nearest = nearest
        self.event: int | None = None
        self.reason = message

    def at_event(self, number: int) -> EmptyBelief:
        """Return the same error with the number of the event of a walk, counted from 1, before its message."""
        found = EmptyBelief(f"event {number}: {self}", observation=self.observation, moves=self.moves, nearest=self.nearest)
        found.event, found.reason = number, self.reason
        return found


class MissingExtra(NinefoldError, ImportError):
    """An optional dependency that is not installed; the message says which extra brings it."""

    def __init__(self, feature: str, extra: str) -> None:
        self.extra = extra
        super().__init__(f"{feature} needs an optional part: pip install 'ninefold[{extra}]'")
