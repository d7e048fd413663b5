"""The atlas: one file that keeps a walk, its map, named sets, declared relations and where they come from.

The walk is an event log: every event is a transaction of its own and on disk when `Atlas.append` returns, so a crash loses
at most the event in flight. The map is stored beside the log as a snapshot; where the log has gone ahead, the map is built
again from it. The tables are described in ``docs/reference/atlas-schema.md``.
"""

from __future__ import annotations

import math
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

from ninefold._files import published
from ninefold._wording import quoted
from ninefold.errors import AtlasError, BadInput, NinefoldError, UnknownName
from ninefold.mapping import Line, Point, Region, Vertex
from ninefold.mapping.robot.mapper import Mapper
from ninefold.mapping.robot.walk import Walk, WalkHeader
from ninefold.mapping.sets import same_map

from . import _schema
from ._definitions import KINDS, definition_of, set_of
from ._event_log import EventLog, checked_time, event_text, header_text, put_snapshot, sentences, tells_metres
from ._file import AtlasFile, put, text_that_can_be_written
from ._map_rows import store_map
from .guess import Guess
from .records import Provenance, Statement

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Callable, Iterable, Iterator, Mapping
    from os import PathLike

    from ninefold.mapping import PlaneMap, Set
    from ninefold.mapping.robot.walk import Event

__all__ = ["Atlas", "read_plane"]


class Atlas:
    """An open atlas file; made by `create`, `open`, `from_walk` or `from_map`, and a context manager.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> from ninefold.io import Atlas
    >>> from ninefold.mapping import Heading, Samples, Visit
    >>> folder = tempfile.TemporaryDirectory()
    >>> path = pathlib.Path(folder.name) / "yard.atlas"
    >>> with Atlas.create(path) as atlas:
    ...     for event in (Visit("gate"), Samples.of(Heading.from_bearing(90)), Visit("well")):
    ...         atlas.append(event)
    ...     atlas.name("way in", "edge:gate,well")
    Line(@e0)
    >>> with Atlas.open(path) as atlas:
    ...     atlas.plane, dict(atlas.sets)
    (PlaneMap(2 vertices, 1 edge, 1 face), {'way in': Line(@e0)})
    >>> folder.cleanup()
    """

    def __init__(self, file: AtlasFile) -> None:
        if not isinstance(file, AtlasFile):
            name = quoted(str(file))
            raise BadInput(f"Atlas.open({name}) opens an atlas; Atlas.create, Atlas.from_walk and Atlas.from_map make one")
        self._file = file
        self._log = EventLog(file)

    # -- making and opening ----------------------------------------------------------------------------------------------

    @classmethod
    def create(
        cls,
        path: str | PathLike[str],
        *,
        header: WalkHeader | None = None,
        provenance: Provenance | None = None,
        force: bool = False,
    ) -> Self:
        """Make an atlas with an empty walk, and open it for events to be appended.

        Parameters
        ----------
        header
            Of the walk; its tolerance holds for every event. Headings are kept as yaw in radians whatever its unit.
        provenance
            Where the events come from.
        force
            Replace a file that exists.

        Raises
        ------
        BadInput, AtlasError
            If the file exists, or cannot be written; then nothing is changed.
        """

        def fill(connection: sqlite3.Connection) -> None:
            put(connection, origin="walk", header=header_text(header or WalkHeader()), map_events=0, warnings="[]")
            _put_provenance(connection, provenance)

        return cls._published(Path(path), fill, force=force)

    @classmethod
    def from_walk(
        cls,
        walk: Walk,
        path: str | PathLike[str],
        *,
        provenance: Provenance | None = None,
        force: bool = False,
    ) -> Self:
        """Make an atlas of a whole walk in one transaction, and open it.

        Raises
        ------
        WalkError, AmbiguousDart, NotPlane, BadInput, AtlasError
            If the walk makes no map, or the file cannot be written; then nothing is changed.

        Notes
        -----
        Complexity that of the `Mapper`.
        """
        mapper = Mapper(walk.header)

        def rows() -> Iterator[tuple[int, str]]:
            time = -math.inf
            for seq, event in enumerate(walk.events, 1):
                time = checked_time(event, time)
                mapper.step(event)
                yield seq, event_text(event)

        def fill(connection: sqlite3.Connection) -> None:
            put(connection, origin="walk", header=header_text(walk.header))
            if any(map(tells_metres, walk.events)):
                _schema.keep_metres(connection)
            connection.executemany("INSERT INTO event VALUES (?, ?)", rows())
            put_snapshot(connection, mapper)
            _put_provenance(connection, provenance)

        return cls._published(Path(path), fill, force=force)

    @classmethod
    def from_map(
        cls,
        plane: PlaneMap,
        path: str | PathLike[str],
        *,
        provenance: Provenance | None = None,
        warnings: Iterable[str] = (),
        guess: Guess | None = None,
        walk: Walk | None = None,
        force: bool = False,
    ) -> Self:
        """Make an atlas of a finished map, and open it. It takes no further events.

        Parameters
        ----------
        warnings
            Sentences to keep with it, such as `Source.notes`.
        guess
            What is in doubt about the map, if it is the likeliest of several: `Guess.of` an estimate. Its warnings are kept
            before the others.
        walk
            What the map was estimated from, to be kept with it as evidence.

        Raises
        ------
        BadInput, AtlasError
            If the file exists, or cannot be written; then nothing is changed.
        """
        header, events = (WalkHeader(), ()) if walk is None else (walk.header, walk.events)

        def rows() -> Iterator[tuple[int, str]]:
            time = -math.inf
            for seq, event in enumerate(events, 1):
                time = checked_time(event, time)
                yield seq, event_text(event)

        def fill(connection: sqlite3.Connection) -> None:
            said = (*(guess.warnings if guess else ()), *warnings)
            put(connection, origin="map", header=header_text(header), map_events=len(events), warnings=sentences(said))
            if any(map(tells_metres, events)):
                _schema.keep_metres(connection)
            connection.executemany("INSERT INTO event VALUES (?, ?)", rows())
            if guess is not None:
                put(connection, guess=guess.to_json())
            store_map(connection, plane)
            _put_provenance(connection, provenance)

        return cls._published(Path(path), fill, force=force)

    @classmethod
    def _published(cls, path: Path, fill: Callable[[sqlite3.Connection], None], *, force: bool) -> Self:
        with text_that_can_be_written(), published(path, force=force) as temporary, _schema.reporting(path):
            connection = _schema.create_tables(temporary)
            try:
                connection.execute("BEGIN")
                fill(connection)
                connection.execute("COMMIT")
                connection.execute("PRAGMA journal_mode = WAL")
            finally:
                connection.close()
            if force:
                _discard_log_of(path)
        return cls.open(path)

    @classmethod
    def open(cls, path: str | PathLike[str], *, writable: bool = True) -> Self:
        """Open an atlas.

        Parameters
        ----------
        writable
            False opens it for reading alone, which also works in a read-only folder.

        Raises
        ------
        AtlasError
            For a file that is missing, truncated, damaged, no atlas, of a newer format, or not to be read.
        """
        file = Path(path)
        _schema.check_file(file)
        return cls(AtlasFile(file, _schema.connect(file, writable=writable), writable=writable))

    def close(self) -> None:
        """Store the map beside the log, where events were appended, and close the file. Safe to call twice."""
        if not self._file.is_open:
            return
        try:
            # The snapshot only saves time at the next opening, so a full disk is no reason to fail here.
            with suppress(NinefoldError):
                self._log.close()
        finally:
            self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"Atlas({str(self.path)!r}{'' if self._file.is_open else ', closed'})"

    @property
    def path(self) -> Path:
        """The file."""
        return self._file.path

    # -- the walk and the map --------------------------------------------------------------------------------------------

    @property
    def origin(self) -> str:
        """``"walk"`` where the map is built from an event log, ``"map"`` where it was stored as a whole.

        The events of the latter, if there are any, are the walk that the map was estimated from.
        """
        return self._log.origin

    @property
    def n_events(self) -> int:
        """Number of events in the log."""
        return self._log.n_events

    @property
    def walk(self) -> Walk:
        """The whole walk, headings in yaw radians."""
        return Walk(self._log.header, tuple(self._log.events()))

    def append(self, event: Event) -> None:
        """Check an event against the map so far and add it to the log, durably.

        Raises
        ------
        WalkError, AmbiguousDart, NotPlane
            If the mapper refuses it; nothing is stored.
        AtlasError
            If it cannot be stored, or another writer has added events meanwhile; nothing is stored.

        Notes
        -----
        The first call after opening reads the whole log; then an event costs a commit to disk and `Mapper.step`.
        """
        self._log.extend((event,))

    def extend(self, events: Iterable[Event]) -> None:
        """Append several events in one transaction: all of them or, after any error, none."""
        self._log.extend(events)

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
        return self._log.plane

    @property
    def warnings(self) -> tuple[str, ...]:
        """What was left out or is unfinished: notes of the source, exits never travelled, a leg without end."""
        return self._log.warnings

    @property
    def guess(self) -> Guess | None:
        """What is in doubt about the map, if it was kept as the likeliest of several; else None."""
        rows = self._file.rows("SELECT value FROM meta WHERE key = 'guess'")
        with self._file.damage():
            return Guess.from_json(rows[0][0]) if rows else None

    # -- named sets ------------------------------------------------------------------------------------------------------

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the stored sets, sorted."""
        return tuple(name for (name,) in self._file.rows("SELECT name FROM named_set ORDER BY name"))

    @property
    def kinds(self) -> dict[str, str]:
        """The names of the stored sets, sorted, each with ``"point"``, ``"line"`` or ``"region"``."""
        rows = self._file.rows("SELECT name, kind FROM named_set ORDER BY name")
        return {str(name): str(kind) for name, kind in rows}

    @property
    def sets(self) -> dict[str, Set]:
        """The named sets on the map so far, sorted by name."""
        plane = self.plane
        rows = self._file.rows("SELECT name, kind, definition FROM named_set ORDER BY name")
        return {name: self._set(plane, kind, definition) for name, kind, definition in rows}

    def parse(self, text: str) -> Set:
        """Return the set that a text means: a stored name, or a form such as ``cycle:a,b,c`` (see `PlaneMap.parse`).

        Where names have commas, write a JSON list: ``["cycle", "a, north", "b", "c"]``.

        Raises
        ------
        UnknownName, BadInput
            For a name that is not stored, with near ones, or a text that is no set.
        """
        row = self._file.rows("SELECT kind, definition FROM named_set WHERE name = ?", text)
        if row:
            return self._set(self.plane, *row[0])
        if ":" not in text and not text.lstrip().startswith("["):
            raise self._no_set(text)
        return self.plane.parse(text)

    def _no_set(self, text: str) -> UnknownName:
        """Return the error for a text that is no stored name, but may be meant for a place or an edge."""
        error, plane = UnknownName("set", text, self.names), self.plane
        for kind, names, form in (("place", plane.vertex_names, "vertex:"), ("edge", plane.edge_names, "edge:@")):
            if text in names:
                error.message += f"; the {kind} of that name is {quoted(form + text)}"
        return error

    def name(self, name: str, item: Set | str, *, force: bool = False) -> Set:
        """Store a set under a name, and return it.

        Parameters
        ----------
        name
            Printable text without a colon, which marks the forms of `parse`.
        item
            A set of this map, or a text for `parse`.
        force
            Give a name that is taken to this set.

        Raises
        ------
        BadInput, DifferentMaps, UnknownName
            For a name that is taken or cannot be one, a set of another map, a text that is no set.
        """
        return self.name_all({name: item}, force=force)[name]

    def name_all(self, items: Mapping[str, Set | str], *, force: bool = False) -> dict[str, Set]:
        """Store several sets, each under its name, in one transaction: all or, after any error, none. See `name`."""
        found = {name: self._set_to_store(name, item) for name, item in items.items()}
        with self._file.changing() as connection:
            for name, (item, text) in found.items():
                if not force and connection.execute("SELECT 1 FROM named_set WHERE name = ?", (name,)).fetchone():
                    raise _name_taken(name)
                row = (name, KINDS[type(item)], definition_of(item), text)
                connection.execute("INSERT OR REPLACE INTO named_set VALUES (?, ?, ?, ?)", row)
        return {name: item for name, (item, _) in found.items()}

    def _set_to_store(self, name: str, item: Set | str) -> tuple[Set, str]:
        _check_name(name)
        if isinstance(item, str):
            return self.parse(item), item
        if not isinstance(item, Point | Line | Region):
            raise BadInput(f"a set is a point, line or region of the map, or its text, not {quoted(item)}")
        same_map(item, Point(self.plane, Vertex(0)))
        return item, item.text

    def rename(self, old: str, new: str) -> None:
        """Give a stored set another name, which must be free."""
        _check_name(new)
        with self._file.changing() as connection:
            if connection.execute("SELECT 1 FROM named_set WHERE name = ?", (new,)).fetchone():
                raise _name_taken(new)
            if connection.execute("UPDATE named_set SET name = ? WHERE name = ?", (new, old)).rowcount == 0:
                raise UnknownName("set", old, self.names)

    def remove(self, name: str) -> None:
        """Forget a stored set."""
        with self._file.changing() as connection:
            if connection.execute("DELETE FROM named_set WHERE name = ?", (name,)).rowcount == 0:
                raise UnknownName("set", name, self.names)

    def _set(self, plane: PlaneMap, kind: Any, definition: Any) -> Set:
        try:
            return set_of(plane, kind, definition)
        except AtlasError as error:
            raise AtlasError(f"{self.path}: {error}") from None

    # -- statements and provenance ---------------------------------------------------------------------------------------

    @property
    def statements(self) -> tuple[Statement, ...]:
        """The declared relations, in the order they were declared."""
        rows = self._file.rows("SELECT a, relations, b, label, weight FROM statement ORDER BY id")
        with self._file.damage():
            return tuple(Statement(a, tuple(str(words).split()), b, label, weight) for a, words, b, label, weight in rows)

    def declare(self, statement: Statement) -> None:
        """Store a declared relation."""
        row = (statement.a, " ".join(statement.relations), statement.b, statement.label, statement.weight)
        with self._file.changing() as connection:
            connection.execute("INSERT INTO statement (a, relations, b, label, weight) VALUES (?, ?, ?, ?, ?)", row)

    @property
    def provenance(self) -> tuple[Provenance, ...]:
        """Where the content comes from, in the order it came."""
        rows = self._file.rows("SELECT source, kind, sha256, tool, made FROM provenance ORDER BY id")
        return tuple(Provenance(*row) for row in rows)


def read_plane(path: str | PathLike[str]) -> PlaneMap:
    """Return the map of an atlas file."""
    with Atlas.open(path, writable=False) as atlas:
        return atlas.plane


def _put_provenance(connection: sqlite3.Connection, record: Provenance | None) -> None:
    if record is not None:
        row = (record.source, record.kind, record.sha256, record.tool, record.made)
        connection.execute("INSERT INTO provenance (source, kind, sha256, tool, made) VALUES (?, ?, ?, ?, ?)", row)


def _check_name(name: str) -> None:
    if not isinstance(name, str) or not name.strip() or not name.isprintable() or ":" in name:
        raise BadInput(f"{quoted(name)} cannot name a set: a name is printable text without a colon")


def _name_taken(name: str) -> BadInput:
    return BadInput(f"{quoted(name)} is the name of a set already; choose another, or --force (force=True) to replace it")


def _discard_log_of(path: Path) -> None:
    """Take away the write-ahead log of a file about to be replaced, lest it be applied to the new one."""
    for suffix in ("-wal", "-shm"):
        with suppress(FileNotFoundError):
            path.with_name(path.name + suffix).unlink()
