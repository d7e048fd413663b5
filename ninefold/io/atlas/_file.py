"""An open atlas file: queries, transactions, single values, and every failure as one clear line."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ninefold._wording import quoted
from ninefold.errors import AtlasError, BadInput, NinefoldError

from . import _schema

if TYPE_CHECKING:
    import sqlite3
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["AtlasFile", "put", "text_that_can_be_written"]


class AtlasFile:
    """A connection to an atlas, and what it is allowed to do."""

    def __init__(self, path: Path, connection: sqlite3.Connection, *, writable: bool) -> None:
        self.path = path
        self.writable = writable
        self._connection: sqlite3.Connection | None = connection

    def close(self) -> None:
        """Close the connection; safe to call twice."""
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    @property
    def is_open(self) -> bool:
        """Whether it was not closed yet."""
        return self._connection is not None

    @property
    def connection(self) -> sqlite3.Connection:
        """The connection; an error once closed."""
        if self._connection is None:
            raise AtlasError(f"{self.path}: this atlas is closed")
        return self._connection

    @contextmanager
    def changing(self) -> Iterator[sqlite3.Connection]:
        """Run one write transaction; whatever fails, the file is as it was."""
        connection = self.connection
        if not self.writable:
            raise AtlasError(f"{self.path}: opened for reading; nothing was changed")
        with text_that_can_be_written(), _schema.reporting(self.path), _schema.transaction(connection):
            yield connection

    @contextmanager
    def reading(self) -> Iterator[None]:
        """Let several queries see one state of the file."""
        connection = self.connection
        if connection.in_transaction:
            yield
            return
        with _schema.reporting(self.path):
            connection.execute("BEGIN")
        try:
            yield
        finally:
            if connection.in_transaction:
                connection.execute("ROLLBACK")

    @contextmanager
    def damage(self) -> Iterator[None]:
        """Report stored content that its reader refuses as damage of the file."""
        try:
            yield
        except AtlasError:
            raise
        except (NinefoldError, TypeError, ValueError) as error:
            raise AtlasError(f"{self.path}: damaged ({_schema.one_line(error)})") from None

    def rows(self, query: str, *values: Any) -> list[tuple[Any, ...]]:
        """Return the rows of a query."""
        with _schema.reporting(self.path):
            return self.connection.execute(query, values).fetchall()

    def value(self, key: str) -> Any:
        """Return a single value of the table ``meta``."""
        rows = self.rows("SELECT value FROM meta WHERE key = ?", key)
        if not rows:
            raise AtlasError(f"{self.path}: damaged (it has no {key})")
        return rows[0][0]

    def text(self, key: str) -> str:
        """Return a single value that has to be text."""
        value = self.value(key)
        if not isinstance(value, str):
            raise AtlasError(f"{self.path}: damaged (its {key} is no text)")
        return value


def put(connection: sqlite3.Connection, **values: str | int) -> None:
    """Store single values, inside the caller's transaction."""
    connection.executemany("INSERT OR REPLACE INTO meta VALUES (?, ?)", values.items())


@contextmanager
def text_that_can_be_written() -> Iterator[None]:
    """Report half a surrogate pair, which no file in UTF-8 can hold."""
    try:
        yield
    except UnicodeEncodeError as error:
        raise BadInput(f"{quoted(error.object)} cannot be written as text (UTF-8)") from None
