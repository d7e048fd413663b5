"""The command line: one module a command group, each importing what it needs when it runs.

`main` is the entry point. It turns every failure into one line on stderr (``ninefold: ...``) and an exit code: 0 done or
yes, 1 the answer is no, 2 bad usage or bad input, 3 budget spent, 130 interrupted. With ``--json`` stdout holds one JSON
object, on failure ``{"error": "..."}``; progress and notes go to stderr.

A new group is a module with typer commands and a line in `_COMMANDS` of `ninefold.cli._app`.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, TextIO

from ninefold.errors import NinefoldError

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["main", "run"]

BAD_INPUT = 2
INTERRUPTED = 130
CUT_OFF = 141
"""The reader of our output went away, as with ``| head``: what a shell shows for SIGPIPE."""


def main() -> None:
    """Run the command line of this process and exit with its code."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed by the caller, as with `>&-`; no file of ours may take its place
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_WRONLY), "w"))
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")  # a street name never stops a terminal that cannot show it
    code = run(sys.argv[1:])
    try:
        sys.stdout.flush()
    except OSError as error:
        _silence(sys.stdout)
        if isinstance(error, BrokenPipeError):
            code = CUT_OFF
        elif code != BAD_INPUT:  # else the one line was printed
            code = _failed(_explained(error), wants_json=False)
    try:
        sys.stderr.flush()
    except OSError:
        _silence(sys.stderr)
    sys.exit(code)


def _silence(stream: TextIO) -> None:
    """Send a stream that failed to the null device: Python flushes it once more on exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def run(arguments: Sequence[str]) -> int:
    """Run a command and return its exit code.

    Parameters
    ----------
    arguments
        Without the program's name.
    """
    from ._app import app

    if not arguments:
        app(args=["--help"], prog_name="ninefold", standalone_mode=False)
        return 2
    wants_json = "--json" in arguments
    try:
        code = app(args=list(arguments), prog_name="ninefold", standalone_mode=False)
    except BrokenPipeError:
        return CUT_OFF
    except SystemExit as error:  # the option parser has its own idea of a broken pipe
        if isinstance(error.__context__, BrokenPipeError):
            return CUT_OFF
        raise
    except KeyboardInterrupt:
        return INTERRUPTED
    except NinefoldError as error:
        return _failed(str(error), wants_json=wants_json)
    except MemoryError:
        return _failed("not enough memory for this input", wants_json=wants_json)
    except Exception as error:
        if type(error).__name__ == "Abort":  # how some versions of the option parser pass on Ctrl-C
            return INTERRUPTED
        return _failed(_explained(error), wants_json=wants_json)
    return code if isinstance(code, int) else 0


def _explained(error: Exception) -> str:
    """Return the line for what is not ours: usage errors of the option parser, the system's errors, and our own mistakes."""
    describe = getattr(error, "format_message", None)
    if callable(describe):
        context = getattr(error, "ctx", None)
        command = context.command_path if context is not None else "ninefold"
        return f"{describe()} (see {command} --help)"
    if isinstance(error, OSError):
        return f"{error.filename or 'the output cannot be written'}: {error.strerror or error}"
    if os.environ.get("NINEFOLD_TRACEBACK"):
        raise error
    return (
        f"a mistake in ninefold itself, {type(error).__name__}: {error}; please report it with the output of the same "
        "command under NINEFOLD_TRACEBACK=1"
    )


def _failed(message: str, *, wants_json: bool) -> int:
    from ._output import one_line, print_json

    line = one_line(message)
    with suppress(OSError):  # where nothing can be written, the exit code still tells
        print(f"ninefold: {line}", file=sys.stderr, flush=True)
    with suppress(OSError):
        if wants_json:
            print_json({"error": line})
    return BAD_INPUT
