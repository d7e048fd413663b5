"""Writing a file whole or not at all: beside the target first, then renamed over it."""

from __future__ import annotations

import os
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING
from uuid import uuid4

from ninefold.errors import BadInput

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

__all__ = ["published", "refuse_existing"]


@contextmanager
def published(path: Path, *, force: bool) -> Iterator[Path]:
    """Give a temporary path to write to; after the block it becomes `path`.

    Parameters
    ----------
    force
        Replace what is there; otherwise a file that exists is an error, also one that appears meanwhile.

    Raises
    ------
    BadInput
        If the target exists, or the folder does not or cannot be written. Then, and after any error in the block, nothing is
        changed and no temporary file is left.
    """
    refuse_existing(path, force=force)
    temporary = path.with_name(f".{path.name}.{uuid4().hex[:12]}.tmp")
    try:
        yield temporary
        _sync(temporary)
        if force:
            temporary.replace(path)
        else:
            _move_to_free_name(temporary, path)
        _sync(path.parent)
    except OSError as error:
        if isinstance(error, BadInput) or error.strerror is None:
            raise
        raise BadInput(f"{path}: cannot be written ({error.strerror}); nothing was changed") from None
    finally:
        with suppress(OSError):
            temporary.unlink()


def refuse_existing(path: Path, *, force: bool) -> None:
    """Say at once why a file cannot be written, before the work for it is done.

    Raises
    ------
    BadInput
        If the target exists (unless `force`), is a folder, a device or a pipe, or its folder does not exist or is read-only.
    """
    if path.is_dir():
        raise BadInput(f"{path}: a folder; give a file name")
    if path.exists() and not path.is_file():  # a rename would put a file in the place of /dev/null
        raise BadInput(f"{path}: a device or a pipe, where no file can be put; give a file name")
    if path.exists() and not force:
        raise _exists(path)
    if not path.parent.is_dir():
        raise BadInput(f"{path}: the folder {path.parent} does not exist")
    if not os.access(path.parent, os.W_OK):
        raise BadInput(f"{path}: the folder {path.parent} is read-only")


def _move_to_free_name(temporary: Path, path: Path) -> None:
    try:
        path.hardlink_to(temporary)  # unlike a rename, it fails if the name is taken
    except FileExistsError:
        raise _exists(path) from None
    except OSError:  # a file system without hard links
        if path.exists():
            raise _exists(path) from None
        temporary.replace(path)


def _exists(path: Path) -> BadInput:
    return BadInput(f"{path}: exists already; choose another name, or replace it with --force (force=True)")


def _sync(path: Path) -> None:
    """Make a file, or the entries of a folder, survive a power cut."""
    with suppress(OSError):  # some systems cannot do this for folders
        handle = os.open(path, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
