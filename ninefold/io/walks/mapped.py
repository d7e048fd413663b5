"""From a walk log to its map, with errors that name the line of the log."""

from __future__ import annotations

from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

from ninefold.errors import BadInput, located
from ninefold.mapping.robot.mapper import build

from .json_lines import read_walk

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from os import PathLike

    from ninefold.mapping import PlaneMap

__all__ = ["by_line", "line_of_event", "map_of_walk"]


def map_of_walk(path: str | PathLike[str], *, tolerance: float | None = None) -> PlaneMap:
    """Read a walk log and build its map.

    Raises
    ------
    WalkError, AmbiguousDart, NotPlane
        With the file and the line.

    Notes
    -----
    Complexity that of `read_walk` and of the `Mapper`.
    """
    walk = read_walk(path, tolerance=tolerance)
    with by_line(path):
        return build(walk)


@contextmanager
def by_line(path: str | PathLike[str], *, content: bytes | None = None) -> Iterator[None]:
    """Let errors about an event of a walk name the file and the line instead of the event.

    Parameters
    ----------
    path
        The file, or the name of a stream.
    content
        What came from the stream, which cannot be read again.
    """
    try:
        yield
    except BadInput as error:
        if error.event is None:
            raise
        line = line_of_event(path, error.event) if content is None else _line_in(BytesIO(content), error.event)
        raise located(error, f"{path}, line {line}" if line else f"{path}, event {error.event}") from None


def line_of_event(path: str | PathLike[str], event: int) -> int | None:
    """Return the line, counted from 1, of an event of a walk log, counted from 1; None if the file has changed.

    The file is read once more, so that no walk has to keep the line of every event for the sake of an error.
    """
    try:
        with Path(path).open("rb") as file:
            return _line_in(file, event)
    except OSError:
        return None


def _line_in(lines: Iterable[bytes], event: int) -> int | None:
    left = event + 1  # the header is the first line that is not blank
    for number, line in enumerate(lines, 1):
        left -= bool(line.strip())
        if not left:
            return number
    return None
