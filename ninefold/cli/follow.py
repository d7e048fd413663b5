"""``ninefold map -``: a walk on standard input, read as a whole, or followed line by line while the robot is on its way."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

from ninefold._wording import counted, quoted

from ._output import QUIET_SECONDS, note, progress

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path
    from typing import BinaryIO

    from ninefold.io import Atlas
    from ninefold.io.atlas.feed import Feed
    from ninefold.mapping.robot.walk import Event, Walk

__all__ = ["follow_walk", "read_whole_walk"]

LONGEST_PAUSE = 30.0
"""Seconds after which a place reached is worth a line again."""


def read_whole_walk(tolerance: float | None, sigma: float | None) -> tuple[Walk, bytes]:
    """Read a walk from standard input to its end; return it, and what was read."""
    from io import BytesIO

    from ninefold.io.walks.streams import STANDARD_INPUT, read_stream

    with progress(f"reading {STANDARD_INPUT}"):
        content = b"".join(_standard_input())
    return read_stream(BytesIO(content), tolerance=tolerance, sigma=sigma), content


def follow_walk(out: Path, tolerance: float | None, *, resume: bool, force: bool) -> tuple[Atlas, list[str]]:
    """Keep an atlas current with the lines that come on standard input, until they end; with doubts about the header.

    A bad line and Ctrl-C end it too; the atlas then keeps the events before.
    """
    from ninefold.errors import BadInput
    from ninefold.io import Atlas
    from ninefold.io.atlas.feed import Feed
    from ninefold.io.walks.heading_units import doubts
    from ninefold.io.walks.streams import walk_lines

    with Feed(out, tolerance=tolerance, resume=resume, force=force) as feed:
        went_on = f" after {counted(feed.kept, 'event')}" if feed.kept else ""
        note(f"following standard input into {out}{went_on}; its end or Ctrl-C ends this")
        tell = _Teller(feed)
        try:
            for line in walk_lines(_standard_input()):
                tell.about(feed.take(line))
            walk = feed.finish()
        except KeyboardInterrupt:
            note(f"interrupted; {_kept(feed)}")
            raise
        except BadInput as error:
            doubted = [] if error.event is None else doubts(feed.finish())
            raise BadInput("; ".join([str(error), *doubted, _kept(feed)])) from None
    return Atlas.open(out, writable=False), doubts(walk)


def _standard_input() -> Iterator[bytes]:
    from ninefold.errors import BadInput

    if sys.stdin is None:
        raise BadInput("standard input is closed; send the lines of a walk there, or name a file")
    stream: BinaryIO = sys.stdin.buffer
    return iter(stream)


def _kept(feed: Feed) -> str:
    """Say what there is on disk."""
    if feed.atlas is None:
        return "no atlas was made"
    n_events = feed.atlas.n_events
    kept = f"keeps the {counted(n_events, 'event')} before" if n_events else "holds no event yet"
    return f"{feed.path} {kept}, and --resume goes on from there"


class _Teller:
    """Says now and then where the robot is: on reaching a place, after ever longer pauses."""

    def __init__(self, feed: Feed) -> None:
        self._feed, self._pause, self._told = feed, QUIET_SECONDS, time.monotonic()

    def about(self, event: Event | None) -> None:
        """Look at an event that was taken."""
        from ninefold.mapping import Visit

        now = time.monotonic()
        if not isinstance(event, Visit) or now - self._told < self._pause or self._feed.atlas is None:
            return
        atlas = self._feed.atlas
        size = repr(atlas.plane).removeprefix("PlaneMap(").removesuffix(")")
        note(f"at {quoted(event.place)}: {size}, {counted(atlas.n_events, 'event')}")
        self._told, self._pause = time.monotonic(), min(2 * self._pause, LONGEST_PAUSE)
