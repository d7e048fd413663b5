"""Writing a file whole or not at all: beside the target first, then renamed over it. Every writer goes through here."""

from __future__ import annotations

import os
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING
from uuid import uuid4

from ninefold._wording import quoted, shortened
from ninefold.errors import BadInput, NinefoldError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from os import PathLike

__all__ = ["published", "refuse_existing", "shown", "write_text"]

LONGEST_PATH = 200
"""Characters of a path that a message repeats."""


@contextmanager
def published(path: str | PathLike[str], *, force: bool) -> Iterator[Path]:
    """Give a temporary path to write to; after the block it becomes `path`.

    Parameters
    ----------
    force
        Replace what is there; otherwise a file that exists is an error, also one that appears meanwhile.

    Raises
    ------
    BadInput
        If the target exists, the folder does not or cannot be written, or the block writes text that no file in its
        encoding can hold. Then, and after any error in the block, nothing is changed and no temporary file is left.
    """
    target = Path(path)
    refuse_existing(target, force=force)
    if target.is_symlink():  # the link stays, and what it leads to is replaced
        target = target.resolve()
        refuse_existing(target, force=force)
    temporary = target.with_name(f".{target.name[:100]}.{uuid4().hex[:12]}.tmp")
    try:
        yield temporary
        _keep_mode(target, temporary)
        _sync(temporary)
        if force:
            temporary.replace(target)
        else:
            _move_to_free_name(temporary, target)
        with suppress(OSError):  # some systems cannot do this for folders
            _sync(target.parent)
    except UnicodeEncodeError as error:
        wrong = quoted(error.object[max(0, error.start - 20) : error.start + 20])
        raise BadInput(
            f"{path}: {wrong} cannot be written as text ({error.encoding}: {error.reason}); nothing was changed"
        ) from None
    except OSError as error:
        if isinstance(error, NinefoldError) or error.strerror is None:
            raise
        raise BadInput(f"{path}: cannot be written ({error.strerror}); nothing was changed") from None
    finally:
        with suppress(OSError):
            temporary.unlink()


def write_text(path: str | PathLike[str], text: str, *, force: bool, encoding: str = "utf-8") -> None:
    """Write a text file whole or not at all, line ends as they are; see `published`."""
    with published(path, force=force) as temporary:
        temporary.write_text(text, encoding=encoding, newline="")


def refuse_existing(path: Path, *, force: bool) -> None:
    """Say at once why a file cannot be written, before the work for it is done.

    Raises
    ------
    BadInput
        If the target exists (unless `force`), is a folder, a device or a pipe, or its folder does not exist or is read-only.
    """
    if "\0" in str(path):
        raise BadInput(f"{quoted(str(path))} is no file name: it holds a null character")
    try:
        _refuse(path, force=force)
    except OSError as error:
        raise BadInput(f"{shown(path)}: cannot be written ({error.strerror}); nothing was changed") from None


def _refuse(path: Path, *, force: bool) -> None:
    if path.is_dir():
        raise BadInput(f"{shown(path)}: a folder; give a file name")
    if path.exists() and not path.is_file():  # a rename would put a file in the place of /dev/null
        raise BadInput(f"{path}: a device or a pipe, where no file can be put; give a file name")
    if path.exists() and not force:
        raise _exists(path)
    if not path.parent.is_dir():
        raise BadInput(f"{shown(path)}: the folder {shown(path.parent)} does not exist")
    if not os.access(path.parent, os.W_OK):
        raise BadInput(f"{path}: the folder {path.parent} is read-only")


def shown(path: str | PathLike[str]) -> str:
    """Return a path as messages write it: whole, unless it is longer than any that works."""
    return shortened(str(path), LONGEST_PATH)


def _move_to_free_name(temporary: Path, path: Path) -> None:
    try:
        path.hardlink_to(temporary)  # unlike a rename, it fails if the name is taken
    except FileExistsError:
        raise _exists(path) from None
    except OSError:  # a file system without hard links
        if path.exists():
            raise _exists(path) from None
        temporary.replace(path)


def _keep_mode(target: Path, temporary: Path) -> None:
    """Give the new file the permissions of the one it replaces."""
    with suppress(OSError):
        temporary.chmod(target.stat().st_mode & 0o7777)


def _exists(path: Path) -> BadInput:
    return BadInput(f"{path}: exists already; choose another name, or replace it with --force (force=True)")


def _sync(path: Path) -> None:
    """Make a file, or the entries of a folder, survive a power cut; a disk that turns out to be full says so here."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
