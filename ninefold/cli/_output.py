"""What every command prints with: JSON on stdout, notes and progress on stderr."""

from __future__ import annotations

import json
import sys
import threading
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

__all__ = ["first_few", "note", "notes", "one_line", "print_json", "progress"]

QUIET_SECONDS = 2.0
"""Work that takes longer than this shows that it goes on."""


def print_json(value: dict[str, Any]) -> None:
    """Print one JSON object on one line of stdout."""
    plain = (getattr(sys.stdout, "encoding", None) or "ascii").lower().replace("-", "") not in ("utf8", "utf8sig")
    print(json.dumps(value, ensure_ascii=plain, allow_nan=False))


def note(message: str) -> None:
    """Print one line on stderr."""
    print(f"ninefold: {one_line(message)}", file=sys.stderr, flush=True)


def notes(messages: Iterable[str]) -> None:
    """Print lines on stderr."""
    for message in messages:
        note(message)


def first_few(lines: Iterable[str], most: int = 12) -> list[str]:
    """Return the lines, or the first of them and how many more there are where nobody would read them all."""
    every = list(lines)
    if len(every) <= most + 1:
        return every
    return [*every[:most], f"... and {len(every) - most} more; --json lists them all"]


def one_line(message: str) -> str:
    """Return a message without line breaks or control characters."""
    return " ".join("".join(c if c.isprintable() else " " for c in message).split())


@contextmanager
def progress(step: str | Callable[[], str]) -> Iterator[None]:
    """Show on stderr, once the block has taken 2 s, what goes on and for how long; on a terminal in one line.

    Parameters
    ----------
    step
        What is being done, such as ``"building the map"``, or what tells it at that moment.
    """
    done = threading.Event()
    terminal = sys.stderr.isatty()

    def tell() -> None:
        start, pause = time.monotonic(), QUIET_SECONDS
        while not done.wait(pause):
            seconds = time.monotonic() - start
            end = "\r" if terminal else "\n"
            doing = step if isinstance(step, str) else step()
            print(f"ninefold: {doing} ... {seconds:.0f} s", end=end, file=sys.stderr, flush=True)
            pause = 0.5 if terminal else min(2 * pause, 30.0)
        if terminal and time.monotonic() - start >= QUIET_SECONDS:
            print("\x1b[2K\r", end="", file=sys.stderr, flush=True)

    teller = threading.Thread(target=tell, daemon=True)
    teller.start()
    try:
        yield
    finally:
        done.set()
        teller.join(timeout=1.0)
