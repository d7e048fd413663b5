"""Labels of vertices and edges: unique strings, or the row numbers when nothing better is known."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from numbers import Integral
from typing import Any

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput, UnknownName
from ninefold.immutable import Immutable

__all__ = ["Names"]


class Names(Immutable, Sequence[str]):
    """An immutable sequence of unique labels that can be looked up both ways.

    Row numbers ("0", "1", ...) take no memory: a map with a million edges keeps no million strings.

    Parameters
    ----------
    kind
        "vertex" or "edge", for messages.
    size
        How many there are.
    labels
        The labels, or None for row numbers. Integers are accepted and become strings.

    Examples
    --------
    >>> names = Names("vertex", 3, ["hall", "yard", 7])
    >>> names[2], names.row("yard"), Names("edge", 10).row(4)
    ('7', 1, 4)
    """

    __slots__ = ("_labels", "_rows", "kind", "size")

    kind: str
    size: int
    _labels: tuple[str, ...] | None
    _rows: dict[str, int] | None

    def __init__(self, kind: str, size: int, labels: Iterable[str | int] | None = None) -> None:
        given = None
        if labels is not None:
            given = tuple(_label(kind, label) for label in labels)
            if len(given) != size:
                raise BadInput(f"{counted(len(given), f'{kind} name')} for {size}; give one each, or none")
        self._set_state({"kind": kind, "size": size, "_labels": given})
        if self._rows is not None and given is not None and len(self._rows) != size:
            twice = next(label for row, label in enumerate(given) if self._rows[label] != row)
            raise BadInput(f"the {kind} name {quoted(twice)} is given twice; names must be unique")

    def _state(self) -> dict[str, Any]:
        return {"kind": self.kind, "size": self.size, "_labels": self._labels}

    def _set_state(self, state: dict[str, Any]) -> None:
        labels = state["_labels"]
        super()._set_state(state)
        super()._set_state({"_rows": None if labels is None else {label: row for row, label in enumerate(labels)}})

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"names cannot be changed: {name!r} is read-only; make new Names instead")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"names cannot be changed: {name!r} is read-only; make new Names instead")

    @property
    def are_rows(self) -> bool:
        """Whether the labels are the row numbers."""
        return self._labels is None

    def row(self, label: str | int) -> int:
        """Return the row of a label.

        Raises
        ------
        UnknownName
            With near labels, if there is no such label.
        """
        text = _text(label)
        found = self._find(text)
        if found is None:
            raise UnknownName(self.kind, text, self if self.size <= 20_000 else ())
        return found

    def _find(self, text: str) -> int | None:
        if self._rows is not None:
            return self._rows.get(text)
        if len(text) <= len(str(self.size)) and text.isascii() and text.isdecimal():
            row = int(text)
            return row if row < self.size and str(row) == text else None
        return None

    def __contains__(self, label: object) -> bool:
        return self._find(_text(label)) is not None

    def __getitem__(self, row: int) -> str:  # type: ignore[override]
        if self._labels is not None:
            return self._labels[row]
        if not 0 <= row < self.size:
            raise IndexError(row)
        return str(row)

    def __len__(self) -> int:
        return self.size

    def __iter__(self) -> Iterator[str]:
        return iter(self._labels) if self._labels is not None else map(str, range(self.size))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Names):
            return NotImplemented
        if self.size != other.size:
            return False
        if self._labels is None and other._labels is None:
            return True
        return tuple(self) == tuple(other)

    def __hash__(self) -> int:
        return hash(self.size)

    def __repr__(self) -> str:
        shown = ", ".join(list(self)[:4]) if self.size <= 4 else f"{self[0]}, {self[1]}, ... {self[self.size - 1]}"
        return f"Names({self.kind}: {shown})"


def _label(kind: str, label: str | int) -> str:
    if isinstance(label, bool) or not isinstance(label, str | Integral):
        raise BadInput(f"a {kind} name is a string, not {quoted(label)}")
    text = _text(label)
    if any(0xD800 <= ord(c) < 0xE000 for c in text):
        raise BadInput(f"the {kind} name {quoted(label)} cannot be written as text: it holds half a character")
    if not text or any(ord(c) < 32 for c in text):
        raise BadInput(f"a {kind} name is printable text, not {quoted(label)}")
    return text


def _text(label: object) -> str:
    try:
        return str(label)
    except ValueError:  # Python refuses to write out integers of thousands of digits
        return f"{label:#x}"
