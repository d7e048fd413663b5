"""The event log of an atlas and the map that follows from it.

The log is the truth. The stored map is a snapshot of it, taken when the file is closed; where the log has gone ahead of the
snapshot, the map is built again by replaying the events.
"""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import TYPE_CHECKING

from ninefold._wording import quoted
from ninefold.errors import AtlasError, BadInput, NinefoldError, WalkError
from ninefold.mapping.robot.mapper import Mapper
from ninefold.mapping.robot.walk import Samples, Visit, WalkHeader

from ..walks.json_lines import WalkReader, event_to_json, header_to_json
from . import _schema
from ._file import put
from ._map_rows import load_map, store_map

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterable, Iterator

    from ninefold.mapping import PlaneMap
    from ninefold.mapping.robot.walk import Event

    from ._file import AtlasFile

__all__ = ["EventLog", "checked_time", "event_text", "header_text", "put_snapshot", "sentences", "tells_metres"]


class EventLog:
    """The events of an atlas, a mapper that follows them, and the map so far."""

    def __init__(self, file: AtlasFile) -> None:
        self.file = file
        self._mapper: Mapper | None = None
        self._time = -math.inf
        self._plane: PlaneMap | None = None
        self._plane_at = -1
        self._seen = self.n_events  # what this writer builds on: the log as it was opened, and its own events since

    @property
    def origin(self) -> str:
        """``"walk"`` or ``"map"``."""
        return self.file.text("origin")

    @property
    def header(self) -> WalkHeader:
        """The header of the walk, headings in yaw radians."""
        reader = WalkReader(f"{self.file.path} (header)")
        with self.file.damage():
            reader.take(self.file.text("header").encode())
            return reader.header

    @property
    def n_events(self) -> int:
        """Number of events in the log."""
        ((count,),) = self.file.rows("SELECT coalesce(max(seq), 0) FROM event")
        if not isinstance(count, int):
            raise AtlasError(f"{self.file.path}: damaged (an event has no number)")
        return count

    def events(self) -> Iterator[Event]:
        """Yield the events of the log in order."""
        reader = WalkReader(f"{self.file.path} (event)", header=self.header)
        for expected, (seq, text) in enumerate(self.file.rows("SELECT seq, json FROM event ORDER BY seq"), 1):
            if seq != expected or not isinstance(text, str):
                raise AtlasError(f"{self.file.path}: damaged (event {expected} is missing)")
            with self.file.damage():
                event = reader.take(text.encode())
            if event is None:
                raise AtlasError(f"{self.file.path}: damaged (event {expected} is blank)")
            yield event

    def extend(self, events: Iterable[Event]) -> None:
        """Append several events in one transaction: all of them or, after any error, none."""
        if self.origin != "walk":
            raise BadInput(
                f"{self.file.path}: made from a finished map, so it takes no events; give the walk an atlas of its own"
            )
        mapper, start = None, 0
        try:
            with self.file.changing() as connection:
                if self.n_events != self._seen:
                    raise AtlasError(f"{self.file.path}: another writer has added events meanwhile; open it again to go on")
                mapper = self.follow()
                start, time = mapper.n_events, self._time
                for seq, event in enumerate(events, start + 1):
                    time = checked_time(event, time)
                    mapper.step(event)
                    if tells_metres(event):
                        _schema.keep_metres(connection)
                    connection.execute("INSERT INTO event VALUES (?, ?)", (seq, event_text(event)))
            self._time, self._seen = time, mapper.n_events
        except BaseException as error:
            if mapper is None or mapper.n_events != start or not isinstance(error, NinefoldError):
                self._mapper = None  # ahead of the log, or interrupted in a step: read the log again
            raise

    def follow(self) -> Mapper:
        """Return the mapper at the end of the log."""
        if self._mapper is None or self._mapper.n_events != self.n_events:
            mapper, time = Mapper(self.header), -math.inf
            for event in self.events():
                with self.file.damage():
                    mapper.step(event)
                    time = checked_time(event, time)
            self._mapper, self._time = mapper, time
        return self._mapper

    @property
    def plane(self) -> PlaneMap:
        """The map so far.

        Raises
        ------
        BadInput
            Before the first place.
        AtlasError
            If what is stored is no plane map. Complexity O(E), or that of the `Mapper` where the log has gone ahead.
        """
        with self.file.reading():
            count = self.n_events
            if self._plane is None or self._plane_at != count:
                self._plane = self._load(count)
                self._plane_at = count
            return self._plane

    def _load(self, count: int) -> PlaneMap:
        if self.origin == "map" or (self._mapper is None and count and self.file.value("map_events") == count):
            try:
                with _schema.reporting(self.file.path):
                    return load_map(self.file.connection)
            except AtlasError as error:
                if str(error).startswith(str(self.file.path)):
                    raise
                raise AtlasError(f"{self.file.path}: {error}") from None
        return self.follow().plane

    def store_snapshot(self) -> None:
        mapper = self.follow()
        if self.file.value("map_events") == mapper.n_events:
            return
        with self.file.changing() as connection:
            put_snapshot(connection, mapper)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was left out or is unfinished: notes of the source, exits never travelled, a leg without end."""
        if self.origin == "walk" and (self._mapper is not None or self.file.value("map_events") != self.n_events):
            return self.follow().warnings
        try:
            notes = json.loads(self.file.text("warnings"))
        except (ValueError, RecursionError):
            notes = None
        if not isinstance(notes, list) or not all(isinstance(note, str) for note in notes):
            raise AtlasError(f"{self.file.path}: damaged (its warnings are no list of sentences)")
        return tuple(notes)

    def close(self) -> None:
        """Store the map beside the log, if events were appended."""
        if self._mapper is not None and self._mapper.n_vertices and self.file.writable:
            self.store_snapshot()


_STORED_FORM = WalkHeader()


def header_text(header: WalkHeader) -> str:
    """Return a header as JSON, headings in yaw radians."""
    return json.dumps(header_to_json(replace(header, heading="yaw-rad")), ensure_ascii=False, allow_nan=False)


def checked_time(event: Event, before: float) -> float:
    """Return the time of an event, or `before` if it has none: the log holds only what its reader will take.

    Raises
    ------
    BadInput
        If it is no finite number, or goes back; or if the event is none.
    """
    if not isinstance(event, Visit | Samples):
        raise WalkError(f"an event is a Visit or Samples, not {quoted(event)}")
    if event.t is None:
        return before
    if isinstance(event.t, bool) or not isinstance(event.t, int | float) or not before <= event.t < math.inf:
        after = "" if before == -math.inf else f" that does not go back from {before:g}"
        raise BadInput(f"the time of an event is a finite number of seconds{after}, not {quoted(event.t)}")
    return float(event.t)


def event_text(event: Event) -> str:
    """Return an event as JSON, headings in yaw radians."""
    return json.dumps(event_to_json(event, _STORED_FORM), ensure_ascii=False, allow_nan=False)


def tells_metres(event: Event) -> bool:
    """Whether an event says how far the robot went, which only a file of format 2 may hold."""
    return isinstance(event, Samples) and event.metres is not None


def sentences(warnings: Iterable[str]) -> str:
    """Return warnings as a JSON list."""
    return json.dumps(list(warnings), ensure_ascii=False)


def put_snapshot(connection: sqlite3.Connection, mapper: Mapper) -> None:
    """Store the map that the events so far make, inside the caller's transaction."""
    store_map(connection, mapper.plane)
    put(connection, map_events=mapper.n_events, warnings=sentences(mapper.warnings))
