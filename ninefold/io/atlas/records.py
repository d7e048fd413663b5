"""What an atlas keeps beside the map: declared relations, and where its content comes from."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from ninefold import __version__
from ninefold.errors import BadInput
from ninefold.reasoner.networks.statement import Statement

if TYPE_CHECKING:
    from os import PathLike

__all__ = ["Provenance", "Statement"]


@dataclass(frozen=True, slots=True)
class Provenance:
    """Where content comes from.

    Attributes
    ----------
    source
        File name or description.
    kind
        ``"walk"``, ``"geojson"``, ``"sample"``, or another format.
    sha256
        Digest of the file, hexadecimal, or None.
    tool, made
        What made the atlas of it, and when: UTC, ISO 8601.
    """

    source: str
    kind: str
    sha256: str | None
    tool: str
    made: str

    @classmethod
    def of_file(cls, path: str | PathLike[str], kind: str) -> Provenance:
        """Make a record of a file, as it is now.

        Raises
        ------
        BadInput
            If the file cannot be read.
        """
        digest = hashlib.sha256()
        try:
            with Path(path).open("rb") as file:
                while block := file.read(1 << 20):
                    digest.update(block)
        except OSError as error:
            raise BadInput(f"{path}: cannot be read ({error.strerror or error})") from None
        return cls(str(path), kind, digest.hexdigest(), f"ninefold {__version__}", _now())

    @classmethod
    def of(cls, source: str, kind: str) -> Provenance:
        """Make a record of something that is no file, such as a live robot."""
        return cls(source, kind, None, f"ninefold {__version__}", _now())


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")
