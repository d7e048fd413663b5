"""The atlas file: its tables, its marks, and how a connection to it is made.

An atlas is an SQLite database in write-ahead mode. ``PRAGMA application_id`` is `APPLICATION_ID` and ``PRAGMA user_version``
the format version. Any SQLite tool can read it; the view ``dart`` shows the map in the library's own terms.

A new file is of format 1. One that is given measured lengths becomes format 2, see `keep_metres`; all others stay readable
for programs that know format 1 alone.
"""

from __future__ import annotations

import os
import sqlite3
from contextlib import contextmanager
from typing import TYPE_CHECKING
from urllib.parse import quote

from ninefold._files import shown
from ninefold._wording import quoted, shortened
from ninefold.errors import AtlasError

from ..formats import foreign, wrong_kind

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = [
    "APPLICATION_ID",
    "VERSION",
    "check_file",
    "connect",
    "create_tables",
    "keep_metres",
    "keeps_metres",
    "one_line",
    "reporting",
    "transaction",
]

APPLICATION_ID = 0x4E39464C
"""The four letters N9FL at byte 68 of the file."""

VERSION = 2
"""The newest format that is read."""

FIRST_VERSION = 1
WITH_METRES = 2
BUSY_SECONDS = 5.0

TABLES = """
-- Single values. origin: 'walk' or 'map'; a map's events are the walk it was estimated from, if any. header: the walk's
-- header line as JSON. map_events: how many events the stored map stands for (it may lag behind the log; it is never ahead).
-- outer: a dart with the outer face on its left, -1 for no edge. vertices, edges: row counts of the stored map. headings: 1
-- if it has headings and turns, else 0. warnings: JSON list of sentences, as of the stored map. guess: JSON of what is in
-- doubt, where the map is the likeliest of several.
CREATE TABLE meta (key TEXT NOT NULL PRIMARY KEY, value NOT NULL) WITHOUT ROWID;
-- The walk, one event a row, in the form of a line of a walk file with headings in yaw radians.
CREATE TABLE event (seq INTEGER PRIMARY KEY CHECK (seq > 0), json TEXT NOT NULL CHECK (typeof(json) = 'text'));
-- The map. Ids count from 0; a name that is NULL is the id. Edge e has the darts 2e (from tail to head) and 2e + 1 (back).
CREATE TABLE vertex (id INTEGER PRIMARY KEY CHECK (id >= 0), name TEXT CHECK (name IS NULL OR typeof(name) = 'text'));
-- next_out, next_back: the next dart counter-clockwise after dart 2e around tail, after 2e + 1 around head. heading_out and
-- heading_back: yaw in radians on leaving along the dart; turn: net rotation along 2e; NULL where unknown. tether: 1 for a
-- virtual edge that ties a separate component to its host face.
CREATE TABLE edge (
  id INTEGER PRIMARY KEY CHECK (id >= 0), name TEXT CHECK (name IS NULL OR typeof(name) = 'text'),
  tail INTEGER NOT NULL CHECK (tail >= 0), head INTEGER NOT NULL CHECK (head >= 0),
  next_out INTEGER NOT NULL CHECK (next_out >= 0), next_back INTEGER NOT NULL CHECK (next_back >= 0),
  heading_out REAL, heading_back REAL, turn REAL, tether INTEGER NOT NULL CHECK (tether IN (0, 1))
);
CREATE VIEW dart AS
  SELECT 2 * id AS dart, tail, head, next_out AS next_ccw, heading_out AS heading FROM edge
  UNION ALL SELECT 2 * id + 1, head, tail, next_back, heading_back FROM edge;
-- Named sets. kind: point, line or region. definition: JSON in vertex and edge names, never face numbers: {"vertex": name},
-- {"edges": [...]} with "start" for a path, or {"boundary": [...]}, the edges around a region. text: as it was given.
CREATE TABLE named_set (
  name TEXT NOT NULL PRIMARY KEY CHECK (typeof(name) = 'text' AND name <> ''),
  kind TEXT NOT NULL CHECK (kind IN ('point', 'line', 'region')),
  definition TEXT NOT NULL CHECK (typeof(definition) = 'text'), text TEXT NOT NULL
);
-- Declared relations: relations split by spaces. weight NULL counts as 1, infinity is hard.
CREATE TABLE statement (
  id INTEGER PRIMARY KEY, a TEXT NOT NULL CHECK (typeof(a) = 'text' AND a <> ''),
  relations TEXT NOT NULL CHECK (typeof(relations) = 'text' AND trim(relations) <> ''),
  b TEXT NOT NULL CHECK (typeof(b) = 'text' AND b <> ''), label TEXT CHECK (label IS NULL OR typeof(label) = 'text'),
  weight REAL CHECK (weight IS NULL OR (typeof(weight) = 'real' AND weight >= 0))
);
-- Where the content comes from: the file, its SHA-256, what made it of it, when (UTC, ISO 8601).
CREATE TABLE provenance (
  id INTEGER PRIMARY KEY, source TEXT NOT NULL, kind TEXT NOT NULL, sha256 TEXT, tool TEXT NOT NULL, made TEXT NOT NULL
);
"""

METRES = "ALTER TABLE edge ADD COLUMN metres REAL CHECK (metres IS NULL OR metres > 0)"
"""Format 2: the length that the walk measured along an edge, the mean of its passes; NULL where unknown."""

_MAGIC = b"SQLite format 3\0"

# What has to hold of every row that is read as it is; files of other writers, and older ones, lack the constraints above.
_SOUND = (
    ("a named set", "named_set", "name", "typeof(name) = 'text' AND name <> ''"),
    ("a named set", "named_set", "kind", "typeof(kind) = 'text'"),
    ("a named set", "named_set", "definition", "typeof(definition) = 'text'"),
    ("a statement", "statement", "a", "typeof(a) = 'text' AND a <> ''"),
    ("a statement", "statement", "relations", "typeof(relations) = 'text' AND trim(relations) <> ''"),
    ("a statement", "statement", "b", "typeof(b) = 'text' AND b <> ''"),
    ("a statement", "statement", "label", "label IS NULL OR typeof(label) = 'text'"),
    ("a statement", "statement", "weight", "weight IS NULL OR (typeof(weight) IN ('real', 'integer') AND weight >= 0)"),
    ("a source", "provenance", "source", "typeof(source) = 'text'"),
    ("a source", "provenance", "kind", "typeof(kind) = 'text'"),
    ("a source", "provenance", "sha256", "sha256 IS NULL OR typeof(sha256) = 'text'"),
    ("a source", "provenance", "tool", "typeof(tool) = 'text'"),
    ("a source", "provenance", "made", "typeof(made) = 'text'"),
)


def check_file(path: Path) -> None:
    """Say why a file is no atlas, from its first bytes, before SQLite sees it.

    Raises
    ------
    AtlasError
        For a missing, empty, foreign, newer or truncated file.
    """
    try:
        with path.open("rb") as file:
            head = file.read(4096)
            size = os.fstat(file.fileno()).st_size
    except FileNotFoundError:
        raise AtlasError(f"{path}: no such file; `ninefold map SOURCE -o {path.name}` makes an atlas") from None
    except OSError as error:
        raise AtlasError(f"{shown(path)}: cannot be read ({error.strerror or error})") from None
    if len(head) < 100 or not head.startswith(_MAGIC):
        other = foreign(head, "atlas")
        if other is not None:
            raise AtlasError(wrong_kind(path, other, "atlas"))
        raise AtlasError(f"{path}: not an atlas ({'the file is empty' if not head else 'not an SQLite database'})")
    number = int.from_bytes(head[68:72], "big")
    version = int.from_bytes(head[60:64], "big")
    if number != APPLICATION_ID:
        raise AtlasError(f"{path}: an SQLite database, but not an atlas of ninefold")
    if version > VERSION:
        raise AtlasError(f"{path}: written in atlas format {version}; this ninefold reads up to {VERSION}, so update it")
    if version < 1:
        raise AtlasError(f"{path}: damaged (atlas format {version} does not exist)")
    page = int.from_bytes(head[16:18], "big")
    expected = int.from_bytes(head[28:32], "big") * (65536 if page == 1 else page)
    # Between a kill and the next opening, pages may still be in the write-ahead log alone.
    if size < expected and not _has_log(path):
        raise AtlasError(f"{path}: truncated ({size:,} of {expected:,} bytes); restore it from a copy or from the walk")


def _has_log(path: Path) -> bool:
    log = path.with_name(path.name + "-wal")
    try:
        return log.stat().st_size > 0
    except OSError:
        return False


def connect(path: Path, *, writable: bool) -> sqlite3.Connection:
    """Open a connection to an atlas that `check_file` has passed; transactions are explicit.

    A reader too opens the file for writing where it may, and is then forbidden to change it: in write-ahead mode even
    reading takes a lock file, which a connection opened for reading alone leaves behind.
    """
    may_write = os.access(path, os.W_OK) and os.access(path.parent, os.W_OK)
    if writable or may_write:
        mode = "mode=rw"
    elif _has_log(path):
        mode = "mode=ro"
    else:  # a read-only folder without a log: nobody can be writing there, so no lock is needed
        mode = "mode=ro&immutable=1"
    with reporting(path):
        location = f"file:{quote(str(path.absolute()))}?{mode}"
        connection = sqlite3.connect(location, uri=True, isolation_level=None, timeout=BUSY_SECONDS)
        try:
            if writable:
                connection.execute("PRAGMA synchronous = FULL")  # an event that was appended survives a power cut too
            else:
                connection.execute("PRAGMA query_only = ON")
            connection.execute("SELECT count(*) FROM meta").fetchone()
            _check_rows(path, connection)
        except BaseException:
            connection.close()
            raise
    return connection


def _check_rows(path: Path, connection: sqlite3.Connection) -> None:
    """Say which set, statement or source of an atlas is damaged, before anybody reads it. O(their number)."""
    for what, table, column, rule in _SOUND:
        row = connection.execute(f"SELECT rowid, {column} FROM {table} WHERE NOT ({rule}) LIMIT 1").fetchone()  # noqa: S608
        if row is not None:
            found = "NULL" if row[1] is None else quoted(row[1])
            raise AtlasError(
                f"{path}: damaged ({what}, row {row[0]} of {table}, has the {column} {found}); restore it from a copy"
            )


def create_tables(path: Path) -> sqlite3.Connection:
    """Make a new atlas file and return a connection that writes fast and without safety, for a file nobody knows yet."""
    with reporting(path):
        connection = sqlite3.connect(path, isolation_level=None)
        try:
            connection.execute("PRAGMA journal_mode = OFF")
            connection.execute("PRAGMA synchronous = OFF")
            connection.executescript(TABLES)
            connection.execute(f"PRAGMA application_id = {APPLICATION_ID}")
            connection.execute(f"PRAGMA user_version = {FIRST_VERSION}")
        except BaseException:
            connection.close()
            raise
    return connection


def keeps_metres(connection: sqlite3.Connection) -> bool:
    """Whether a file has a place for measured lengths."""
    ((version,),) = connection.execute("PRAGMA user_version").fetchall()
    return int(version) >= WITH_METRES


def keep_metres(connection: sqlite3.Connection) -> None:
    """Make a file of format 1 one of format 2, inside the caller's transaction; nothing happens to one that is already.

    It is done before the first event with metres is logged: a program that knows format 1 alone would take the event, and
    store a map without its length as if it were complete.
    """
    if not keeps_metres(connection):
        connection.execute(METRES)
        connection.execute(f"PRAGMA user_version = {WITH_METRES}")


@contextmanager
def transaction(connection: sqlite3.Connection) -> Iterator[None]:
    """Run one write transaction; whatever fails, the file is as it was."""
    connection.execute("BEGIN IMMEDIATE")
    try:
        yield
        connection.execute("COMMIT")
    except BaseException:
        if connection.in_transaction:
            connection.execute("ROLLBACK")
        raise


@contextmanager
def reporting(path: Path) -> Iterator[None]:
    """Turn what SQLite raises into one clear line."""
    try:
        yield
    except (sqlite3.Error, UnicodeDecodeError) as error:  # the latter: SQLite quotes what is damaged, byte by byte
        raise AtlasError(f"{path}: {_reason(error)}") from None


def _reason(error: sqlite3.Error | UnicodeDecodeError) -> str:
    code = getattr(error, "sqlite_errorcode", None)
    primary = code & 0xFF if isinstance(code, int) else None
    if primary in (sqlite3.SQLITE_BUSY, sqlite3.SQLITE_LOCKED):
        return f"another program has been writing to it for {BUSY_SECONDS:.0f} s; try again when it is done"
    if primary == sqlite3.SQLITE_FULL:
        return "the disk is full; nothing was changed"
    if primary == sqlite3.SQLITE_IOERR:
        return "the disk cannot be read or written (full, or failing); nothing was changed"
    if primary in (sqlite3.SQLITE_READONLY, sqlite3.SQLITE_PERM):
        return "the file or its folder is read-only; nothing was changed"
    if primary == sqlite3.SQLITE_CANTOPEN:
        return "cannot be opened (missing, or the folder is read-only)"
    if primary == sqlite3.SQLITE_CONSTRAINT:
        return f"refused by a constraint of its tables ({one_line(error)}); nothing was changed"
    if primary in (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB):
        return "damaged or truncated; restore it from a copy or from the walk"
    return f"damaged, or no atlas of ninefold (SQLite says: {one_line(error)})"


def one_line(words: object) -> str:
    """Return a message fit for one line, however odd the stored text that it quotes."""
    text = " ".join("".join(c if c.isprintable() else " " for c in str(words)).split())
    return shortened(text, 300)
