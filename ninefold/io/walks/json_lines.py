"""Walk logs: JSON Lines, one header and then one event a line.

::

    {"ninefold": "walk", "version": 1, "heading": "bearing-deg", "compass": true, "tolerance": 0.02}
    {"place": "hall", "exits": [0, 90, 180]}
    {"heading": 90}
    {"headings": [88.5, 45, 2], "metres": 7.25}
    {"place": "yard", "edge": "back door", "t": 12.5}

``exits``, ``edge`` (the name of the edge walked to get to the place), ``tolerance`` (radians, whatever the unit of the
headings), ``t`` (seconds, never decreasing) and ``metres`` (of the way to a line of headings from the one before, or from
the place left; finite, not negative) are optional; ``"place": null`` is a place not recognised; integers are accepted as
names; keys not listed here are let pass, and those of the header are kept. Text is UTF-8.

The header may also declare noise: ``sigma`` and ``drift`` (radians), and ``"exits": "in-order"``; see `WalkHeader`. Where it
declares sigma, exits nearer to each other than the tolerance are let pass as evidence: the `Mapper` still refuses them.
"""

from __future__ import annotations

import json
import sys
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from ninefold._files import published, shown
from ninefold._wording import quoted
from ninefold.errors import BadInput, WalkError
from ninefold.mapping.heading import LARGEST_ANGLE, TAU, Heading
from ninefold.mapping.names import Names
from ninefold.mapping.robot.units import unit_of
from ninefold.mapping.robot.walk import Event, Samples, Visit, Walk, WalkHeader

from ..formats import foreign, wrong_kind

if TYPE_CHECKING:
    import os
    from collections.abc import Iterator

__all__ = [
    "WALK_VERSION",
    "WalkReader",
    "event_to_json",
    "header_to_json",
    "iter_events",
    "read_header",
    "read_walk",
    "write_walk",
]

WALK_VERSION = 1
"""The version of the format written, and the newest that is read."""

_NUMBER = frozenset((int, float))
_LARGEST_FLOAT = sys.float_info.max
_LINE_ENDS = frozenset(("\n", "", "\r\n"))


def read_walk(path: str | os.PathLike[str], *, tolerance: float | None = None, sigma: float | None = None) -> Walk:
    """Read a whole walk log.

    Parameters
    ----------
    path
        A file as described in this module's text.
    tolerance
        Radians, instead of the header's: no two exits of a place may be closer, unless the header declares sigma. The
        header returned holds it.
    sigma
        Standard deviation of a heading, radians, instead of the header's. The header returned holds it.

    Raises
    ------
    WalkError
        Naming file and line, for anything the format does not allow, and for events out of order.

    Notes
    -----
    Complexity O(size of the file). Whether the walk makes one map is for `ninefold.mapping.build` to say.
    """
    reader = WalkReader(str(path), tolerance=tolerance, sigma=sigma)
    events = tuple(_parse(path, reader))
    return Walk(reader.header, events)


def iter_events(path: str | os.PathLike[str], *, tolerance: float | None = None) -> Iterator[Event]:
    """Read the events of a walk log one by one, in memory of one line; see `read_walk`."""
    return _parse(path, WalkReader(str(path), tolerance=tolerance))


def read_header(path: str | os.PathLike[str]) -> WalkHeader:
    """Read the header of a walk log; see `read_walk`."""
    reader = WalkReader(str(path))
    with _opened(path) as lines:
        for line in lines:
            reader.take(line)
            if reader.started:
                break
    return reader.header


def write_walk(walk: Walk, path: str | os.PathLike[str]) -> None:
    """Write a walk log, whole or not at all; a file that is there is replaced.

    Headings are written in the unit that the walk's header names.

    Raises
    ------
    WalkError
        If the file cannot be written; what was there before stays.
    """
    header = walk.header
    try:
        with published(path, force=True) as temporary, temporary.open("x", encoding="utf-8", newline="\n") as file:
            file.write(_line(header_to_json(header)))
            file.writelines(_line(event_to_json(event, header)) for event in walk.events)
    except BadInput as error:
        raise WalkError(str(error)) from None
    except (TypeError, ValueError, RecursionError) as error:
        raise WalkError(f"the walk cannot be written: {error}", where=str(path)) from None


def header_to_json(header: WalkHeader) -> dict[str, Any]:
    """Return the JSON object of a header; sigma, drift and the order of exits only where it declares them."""
    declared = {
        key: value
        for key, value, silent in (
            ("sigma", header.sigma, None),
            ("drift", header.drift, None),
            ("exits", header.exits, "any-order"),
        )
        if value != silent
    }
    return {
        "ninefold": "walk",
        "version": WALK_VERSION,
        "heading": header.heading,
        "compass": header.compass,
        "tolerance": header.tolerance,
        **declared,
        **{key: value for key, value in header.extra.items() if key not in _HEADER_KEYS},
    }


def event_to_json(event: Event, header: WalkHeader) -> dict[str, Any]:
    """Return the JSON object of an event, headings in the header's unit."""
    give = unit_of(header.heading).from_yaw
    line: dict[str, Any]
    if isinstance(event, Samples):
        line = {"heading": give(event.yaw[0])} if len(event.yaw) == 1 else {"headings": [give(yaw) for yaw in event.yaw]}
        if event.metres is not None:
            line["metres"] = event.metres
    else:
        line = {"place": event.place}
        if event.exits is not None:
            line["exits"] = [give(heading.yaw) for heading in event.exits]
        if event.edge is not None:
            line["edge"] = event.edge
    if event.t is not None:
        line["t"] = event.t
    return line


_HEADER_FIELDS = ("heading", "compass", "tolerance", "sigma", "drift", "exits")
_HEADER_KEYS = frozenset(("ninefold", "version", *_HEADER_FIELDS))


class WalkReader:
    """Turns lines into events, one at a time, and knows where it is.

    Parameters
    ----------
    name
        What to call the source in messages.
    tolerance, sigma
        Radians, instead of the header's.
    header
        For lines that follow a header read before; otherwise the first line is the header.

    Examples
    --------
    >>> reader = WalkReader("kitchen.jsonl")
    >>> reader.take(b'{"ninefold": "walk", "version": 1, "heading": "bearing-deg"}')
    >>> reader.take(b'{"place": 7, "exits": [0, 90]}').place
    '7'
    """

    def __init__(
        self,
        name: str,
        *,
        tolerance: float | None = None,
        sigma: float | None = None,
        header: WalkHeader | None = None,
    ) -> None:
        self.name = name
        self.line = 0
        self._tolerance, self._sigma = tolerance, sigma
        self._header: WalkHeader | None = None
        self._unit = unit_of("yaw-rad")
        self._yaw = self._unit.to_yaw
        self._closest = 0.0
        self._visits = 0
        self._samples = 0
        self._t = float("-inf")
        self._places: dict[str | int, str] = {}
        decoder: Any = json.JSONDecoder(parse_constant=_reject_constant)
        self._decode, self._scan = decoder.decode, decoder.scan_once
        if header is not None:
            self._begin(header)

    @property
    def started(self) -> bool:
        """Whether the header was read."""
        return self._header is not None

    @property
    def header(self) -> WalkHeader:
        """The header.

        Raises
        ------
        WalkError
            If there was no line yet.
        """
        if self._header is None:
            raise WalkError("the file is empty; a walk begins with a header line", where=self.name)
        return self._header

    def go_on(self, *, on_leg: bool) -> None:
        """Read what comes next as the rest of a walk that has been at a place, and has left it if `on_leg`."""
        self._visits = max(1, self._visits)
        self._samples = int(on_leg)

    def take(self, line: bytes) -> Event | None:
        """Read one line: an event, or None for the header and for a blank line.

        Raises
        ------
        WalkError
            With the name and the number of the line.
        """
        self.line += 1
        try:
            found = self._parsed(line.decode("utf-8"))
        except UnicodeDecodeError:
            self._fail("not UTF-8 text")
        except json.JSONDecodeError as error:
            if not line.strip():
                return None
            self._fail(f"not JSON: {error.msg} at column {error.colno}")
        except BadInput as error:
            self._fail(str(error))
        except ValueError:
            self._fail("not JSON that can be read: a number of too many digits")
        except RecursionError:
            self._fail("not JSON that can be read: nested too deeply")
        if type(found) is not dict:
            self._fail(f"a line holds one JSON object, not {quoted(found)}")
        if self._header is None:
            self._begin(self._read_header(found))
            return None
        event: Event
        if "place" in found:
            event = self._visit(found)
        elif "heading" in found or "headings" in found:
            event = self._heading(found)
        else:
            keys = ", ".join(map(quoted, list(found)[:4])) or "nothing"
            self._fail(f'an event has "place", "heading" or "headings"; this one has {keys}')
        return event

    def _parsed(self, text: str) -> Any:
        try:
            found, end = self._scan(text, 0)
            if text[end:] in _LINE_ENDS:
                return found
        except StopIteration:
            pass
        return self._decode(text)  # twice as slow: allows white space, and says what is wrong

    def _begin(self, header: WalkHeader) -> None:
        if self._tolerance is not None and self._tolerance != header.tolerance:
            header = replace(header, tolerance=self._tolerance)
        if self._sigma is not None and self._sigma != header.sigma:
            header = replace(header, sigma=self._sigma)
        self._header = header
        self._unit = unit_of(header.heading)
        self._yaw = self._unit.to_yaw
        self._closest = header.tolerance

    def _read_header(self, found: dict[str, Any]) -> WalkHeader:
        if found.get("ninefold") != "walk":
            self._fail('the first line is no walk header, such as {"ninefold": "walk", "version": 1, "heading": "yaw-rad"}')
        version = found.get("version")
        if isinstance(version, bool) or not isinstance(version, int) or version < 1:
            self._fail(f'the header\'s "version" is {WALK_VERSION}, not {quoted(version)}')
        if version > WALK_VERSION:
            self._fail(f"the walk has format version {version}, newer than {WALK_VERSION}; update ninefold to read it")
        if "heading" not in found:
            self._fail('the header lacks "heading": one of "yaw-rad", "yaw-deg", "bearing-deg"')
        for key in _HEADER_FIELDS:
            if key in found and type(found[key]) in (dict, list):
                self._fail(f'the header\'s "{key}" cannot be {quoted(found[key])}')
        extra = {key: value for key, value in found.items() if key not in _HEADER_KEYS}
        given = {key: found[key] for key in _HEADER_FIELDS if key in found}
        try:
            return WalkHeader(**given, extra=extra)
        except WalkError as error:
            self._fail(str(error))

    def _visit(self, found: dict[str, Any]) -> Visit:
        place = found["place"]
        if "heading" in found or "headings" in found:
            self._fail("a place and a heading on one line; give each its own")
        if found.get("metres") is not None:
            self._fail(
                '"metres" on the line of a place; give them with the headings of the leg that was walked to get there'
            )
        if place is not None:
            place = self._name("vertex", "place", place)
        edge = found.get("edge")
        if edge is not None:
            edge = self._name("edge", "edge", edge)
        exits = found.get("exits")
        headings = None
        if exits is not None:
            headings = tuple(map(Heading, self._yaws("exits", exits)))
            if self._header is None or self._header.sigma is None:
                self._check_exits(headings)
        if self._visits and not self._samples:
            self._fail("two places with no heading between them; a leg has at least one sample")
        t = self._time(found)
        self._visits += 1
        self._samples = 0
        return Visit(place, headings, edge, t)

    def _heading(self, found: dict[str, Any]) -> Samples:
        if not self._visits:
            self._fail("a heading before the first place; a walk begins at a place")
        if "headings" not in found:
            heading = found["heading"]
            if type(heading) not in _NUMBER:
                self._fail(f'"heading" is a number, not {quoted(heading)}')
            t = self._time(found) if "t" in found else None
            metres = self._metres(found) if "metres" in found else None
            try:
                samples = Samples((self._yaw(heading),), t, metres)
            except (OverflowError, ValueError):
                self._fail(f'"heading" is {self._no_angle([heading])}')
            self._samples += 1
            return samples
        if "heading" in found:
            self._fail('"heading" and "headings" on one line; give one of them')
        yaws = self._yaws("headings", found["headings"])
        if not yaws:
            self._fail('"headings" is an empty list; a leg has at least one sample')
        t, metres = self._time(found), self._metres(found)
        self._samples += 1
        return Samples(yaws, t, metres)

    def _yaws(self, key: str, numbers: Any) -> tuple[float, ...]:
        if type(numbers) is not list or not _NUMBER.issuperset(map(type, numbers)):
            self._fail(f'"{key}" is a list of numbers, not {quoted(numbers)}')
        try:
            yaws = tuple(map(self._yaw, numbers))
            angles = all(map(isfinite, yaws)) and (not yaws or max(map(abs, yaws)) <= LARGEST_ANGLE)
        except (OverflowError, ValueError):
            angles = False
        if not angles:
            self._fail(f'"{key}" holds a number that is {self._no_angle(numbers)}')
        return yaws

    def _no_angle(self, numbers: list[Any]) -> str:
        """Say of the first number that is no angle why it is none."""
        for number in numbers:
            if abs(number) > _LARGEST_FLOAT or not isfinite(number):
                return "not finite"
            if abs(self._yaw(number)) > LARGEST_ANGLE:
                return f"too large for an angle: {number:.6g}, and angles go up to {self._unit.angle(LARGEST_ANGLE)}"
        raise AssertionError("every number is an angle")

    def _check_exits(self, headings: tuple[Heading, ...]) -> None:
        yaws = sorted([heading.yaw for heading in headings])
        if len(yaws) < 2:
            return
        for a, b in pairwise([*yaws, yaws[0] + TAU]):
            if b - a <= self._closest:
                self._fail(
                    f"two exits, {self._unit.heading(a)} and {self._unit.heading(b)}, are within the tolerance of "
                    f"{self._unit.angle(self._closest)}"
                )

    def _time(self, found: dict[str, Any]) -> float | None:
        t = found.get("t")
        if t is None:
            return None
        if type(t) not in _NUMBER:
            self._fail(f'"t" is a number of seconds, not {quoted(t)}')
        try:
            seconds = float(t)
        except OverflowError:
            seconds = float("inf")
        if not isfinite(seconds):
            self._fail('"t" is not finite')
        if seconds < self._t:
            self._fail(f'"t" goes back from {self._t:g} to {seconds:g}: events out of order')
        self._t = seconds
        return seconds

    def _metres(self, found: dict[str, Any]) -> float | None:
        metres = found.get("metres")
        if metres is None:
            return None
        if type(metres) not in _NUMBER:
            self._fail(f'"metres" is a number, not {quoted(metres)}')
        if not 0 <= metres <= _LARGEST_FLOAT:
            self._fail(f'"metres" is {"negative" if metres < 0 else "not finite"}')
        return float(metres)

    def _name(self, kind: str, key: str, given: Any) -> str:
        if type(given) is str:
            known = self._places.get(given)
            if known is not None:
                return known
        elif type(given) is not int:
            self._fail(f'"{key}" is a name, not {quoted(given)}')
        try:
            name = Names(kind, 1, (given,))[0]
            name.encode("utf-8")
        except BadInput as error:
            self._fail(str(error))
        except ValueError:  # half a surrogate pair, or an integer of thousands of digits
            self._fail(f'"{key}" is a name that cannot be written as text')
        self._places[name] = name
        return name

    def _fail(self, message: str) -> NoReturn:
        raise WalkError(message, where=f"{self.name}, line {self.line}")


def _parse(path: str | os.PathLike[str], reader: WalkReader) -> Iterator[Event]:
    take = reader.take
    with _opened(path) as lines:
        for line in lines:
            event = take(line)
            if event is not None:
                yield event
    _ = reader.header


@contextmanager
def _opened(path: str | os.PathLike[str]) -> Iterator[Iterator[bytes]]:
    """Open a file for its lines; a byte order mark is dropped."""
    try:
        with Path(path).open("rb") as file:
            head = file.read(4096)
            other = foreign(head, "walk")
            if other is not None:
                raise WalkError(wrong_kind(path, other, "walk"))
            file.seek(3 if head.startswith(b"\xef\xbb\xbf") else 0)
            yield file
    except (OSError, ValueError) as error:
        if isinstance(error, WalkError):
            raise
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise WalkError(f"the walk cannot be read: {reason or error}", where=shown(path)) from None


def _line(record: dict[str, Any]) -> str:
    return json.dumps(record, ensure_ascii=False, allow_nan=False) + "\n"


def _reject_constant(name: str) -> NoReturn:
    raise BadInput(f"{name} is no number that a walk can hold; headings are finite")
