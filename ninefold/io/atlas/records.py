"""What an atlas keeps beside the map: declared relations, and where its content comes from."""

from __future__ import annotations

import hashlib
import math
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING

from ninefold import __version__
from ninefold.errors import BadInput

if TYPE_CHECKING:
    from os import PathLike

__all__ = ["Provenance", "Statement"]


@dataclass(frozen=True, slots=True)
class Statement:
    """A declared relation between two names.

    Attributes
    ----------
    a, b
        Names of sets, mapped or not.
    relations
        The words of which one holds, such as ``("TPP", "NTPP")``.
    label
        Where it comes from, free text, or None.
    weight
        What it costs to drop: None counts as 1, infinity is hard.

    Raises
    ------
    BadInput
        For an empty name, no relation, a word with a space, a weight that is negative or no number.

    Examples
    --------
    >>> Statement("pond", ("TPP", "NTPP"), "garden", label="the deed", weight=2)
    Statement(a='pond', relations=('TPP', 'NTPP'), b='garden', label='the deed', weight=2.0)
    """

    a: str
    relations: tuple[str, ...]
    b: str
    label: str | None = None
    weight: float | None = None

    def __post_init__(self) -> None:
        for name in (self.a, self.b):
            if not isinstance(name, str) or not name:
                raise BadInput(f"a statement is about names, not {name!r}")
        if isinstance(self.relations, str):
            raise BadInput(f"the relations of a statement are a list of words, not the string {self.relations!r}")
        object.__setattr__(self, "relations", tuple(self.relations))
        for word in self.relations:
            if not isinstance(word, str) or not word or len(word.split()) != 1:
                raise BadInput(f"a relation is one word, not {word!r}")
        if not self.relations:
            raise BadInput(f"the statement about {self.a!r} and {self.b!r} has no relation")
        if self.label is not None and not isinstance(self.label, str):
            raise BadInput(f"a label is text, not {self.label!r}")
        if self.weight is not None:
            if isinstance(self.weight, bool) or not isinstance(self.weight, int | float) or not self.weight >= 0:
                raise BadInput(f"a weight is a number from 0 to infinity, not {self.weight!r}")
            object.__setattr__(self, "weight", float(min(self.weight, math.inf)))


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
