"""Walk logs that come as lines and not from a file: what robots send, and what stands on standard input."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ninefold.errors import WalkError
from ninefold.mapping.robot.walk import Walk

from ..formats import foreign
from .json_lines import WalkReader

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

__all__ = ["STANDARD_INPUT", "read_stream", "walk_lines"]

STANDARD_INPUT = "standard input"
"""What messages call it."""


def read_stream(
    lines: Iterable[bytes], *, name: str = STANDARD_INPUT, tolerance: float | None = None, sigma: float | None = None
) -> Walk:
    """Read a whole walk from lines; see `ninefold.io.read_walk`.

    Parameters
    ----------
    name
        What to call the source in messages.
    tolerance, sigma
        Radians, instead of the header's.

    Raises
    ------
    WalkError
        Naming source and line.

    Examples
    --------
    >>> read_stream([b'{"ninefold": "walk", "version": 1, "heading": "yaw-rad"}', b'{"place": "hall"}']).places
    ('hall',)
    """
    reader = WalkReader(name, tolerance=tolerance, sigma=sigma)
    events = tuple(event for line in walk_lines(lines, name=name) if (event := reader.take(line)) is not None)
    return Walk(reader.header, events)


def walk_lines(lines: Iterable[bytes], *, name: str = STANDARD_INPUT) -> Iterator[bytes]:
    """Pass on lines as they come, the first without a byte order mark.

    Raises
    ------
    WalkError
        If the first line is surely not that of a walk, or the stream cannot be read.
    """
    try:
        for number, line in enumerate(lines):
            if number:
                yield line
                continue
            if other := foreign(line, "walk"):
                raise WalkError(f"this is {other.noun}, not a walk log; save it to a file and name that", where=name)
            yield line.removeprefix(b"\xef\xbb\xbf")
    except OSError as error:
        raise WalkError(f"cannot be read ({error.strerror or error})", where=name) from None
