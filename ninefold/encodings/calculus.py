"""A qualitative calculus: base relations as bits, their converses and their (weak) composition.

A relation is a set of base relations and is held as an int: bit ``k`` stands for ``bases[k]``. Conjunction of two
labels is ``r & s``, and the label that says nothing is `Calculus.universal`.

Examples
--------
>>> from ninefold.encodings import RCC8
>>> inside_or_equal = RCC8.relation("NTPP EQ")
>>> RCC8.names(RCC8.converse_of(inside_or_equal))
('NTPPi', 'EQ')
>>> RCC8.names(RCC8.compose(RCC8.relation("NTPP"), RCC8.relation("disjoint")))
('DC',)

References
----------
G. Ligozat and J. Renz, "What is a qualitative calculus? A general framework", PRICAI 2004, section 3.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput, TooLarge, UnknownName

from . import _laws
from ._definition import Definition, read_definition
from .gis_words import meant_by

if TYPE_CHECKING:
    import os

    from numpy.typing import NDArray

__all__ = ["MAX_BASES", "TABLE_BASES", "Calculus"]

MAX_BASES = 64
"""Most base relations a calculus can have: a relation is one unsigned 64-bit word."""

TABLE_BASES = 8
"""Most base relations for which composition is tabulated for all pairs of relations (64 KiB at eight)."""

_MEMO_LIMIT = 1 << 17
_SEPARATORS = re.compile(r"[\s,]+")


@dataclass(frozen=True, slots=True, eq=False)
class Calculus:
    """Base relations with converse, composition and identity; every law is checked when it is made.

    Parameters
    ----------
    name
        How files and messages call it, such as ``"rcc8"``.
    bases
        Names of the ``b`` base relations, in the order of their bits.
    identity
        Mask of the base relations that make up equality.
    base_converse
        (b,) intp, index of the converse of each base relation.
    base_composition
        (b, b) masks, ``base_composition[i, j]`` is what ``x bases[i] y`` and ``y bases[j] z`` leave for x and z.
    aliases
        Further words for base relations, as pairs ``(word, base name)``.

    Attributes
    ----------
    converse_table
        (2^b,) uint8, converse of every relation; None for more than `TABLE_BASES` bases.
    composition_table
        (2^b, 2^b) uint8, composition of every two relations; None for more than `TABLE_BASES` bases.

    Raises
    ------
    BadInput
        A law of qualitative calculi fails; the message names the base relations with which it does.
    TooLarge
        More than `MAX_BASES` base relations.

    Notes
    -----
    All arrays are read-only. Two calculi are equal when names, bits, identity and tables are.
    """

    name: str
    bases: tuple[str, ...]
    identity: int
    base_converse: NDArray[np.intp] = field(repr=False)
    base_composition: NDArray[Any] = field(repr=False)
    aliases: tuple[tuple[str, str], ...] = field(default=(), repr=False)
    converse_table: NDArray[np.uint8] | None = field(init=False, repr=False)
    composition_table: NDArray[np.uint8] | None = field(init=False, repr=False)
    _masks: dict[str, int] = field(init=False, repr=False)
    _folded: dict[str, int] = field(init=False, repr=False)
    _rows: tuple[tuple[int, ...], ...] = field(init=False, repr=False)
    _memo: dict[tuple[int, int], int] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        b = len(self.bases)
        _check_size(self.name, b)
        _laws.check_names(self.name, self.bases)
        converse = np.array(self.base_converse, dtype=np.intp)
        table = np.array(self.base_composition, dtype=np.uint64)
        _laws.check(self.name, self.bases, self.identity, converse, table)
        table = table.astype(_mask_dtype(b))
        converse.flags.writeable = table.flags.writeable = False
        put = object.__setattr__  # the dataclass is frozen for everybody else
        put(self, "base_converse", converse)
        put(self, "base_composition", table)
        put(self, "_rows", tuple(tuple(row) for row in table.tolist()))
        put(self, "_memo", {})
        masks = {base: 1 << k for k, base in enumerate(self.bases)}
        for word, base in self.aliases:
            if base not in masks:
                raise UnknownName("relation", base, self.bases)
            masks.setdefault(word, masks[base])
        put(self, "_masks", masks)
        put(self, "_folded", _fold(masks))
        if b <= TABLE_BASES:
            one, two = _tabulate(converse, table)
            put(self, "converse_table", one)
            put(self, "composition_table", two)
        else:
            put(self, "converse_table", None)
            put(self, "composition_table", None)

    @classmethod
    def from_definition(cls, definition: Definition) -> Calculus:
        """Make the calculus that a parsed definition describes, checking every law."""
        _check_size(definition.name, len(definition.bases))
        return cls(
            name=definition.name,
            bases=definition.bases,
            identity=definition.identity,
            base_converse=np.array(definition.converse, dtype=np.intp),
            base_composition=np.array(definition.composition, dtype=np.uint64),
            aliases=definition.aliases,
        )

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Calculus:
        """Read a definition in GQR's format: a ``.spec`` with its two tables, or all in one file.

        Raises
        ------
        BadInput
            The file cannot be read, a line cannot be parsed (file and line are named), an entry is missing, or a law
            fails (the base relations are named).
        """
        file = Path(path)
        return cls.from_definition(read_definition(file))

    @classmethod
    def from_text(cls, text: str, name: str = "calculus") -> Calculus:
        """Read a definition held in one string; see `from_file`.

        Examples
        --------
        >>> Calculus.from_text('''
        ... identity =
        ... = :: =
        ... # :: #
        ... = : = :: ( = )
        ... = : # :: ( # )
        ... # : = :: ( # )
        ... # : # :: ( = # )
        ... '''.replace("#", "!"), name="equality").names(3)
        ('=', '!')
        """
        return cls.from_definition(read_definition(text, name=name))

    @property
    def n_bases(self) -> int:
        """Number of base relations."""
        return len(self.bases)

    @property
    def universal(self) -> int:
        """The relation that holds between any two entities: every bit set."""
        return (1 << len(self.bases)) - 1

    def relation(self, relations: str | int | Iterable[str]) -> int:
        """Return the mask of a set of relations given by names, or check a mask.

        Parameters
        ----------
        relations
            Names in one string (split at spaces, commas and ``|``), several strings, or a mask. Base names and aliases
            are read in any case.

        Raises
        ------
        UnknownName
            A name that is no relation of this calculus, with near ones, or with what the word means elsewhere.
        BadInput
            No name at all, or a mask with bits outside the calculus.

        Examples
        --------
        >>> from ninefold.encodings import RCC8
        >>> RCC8.relation("ec|tppi") == RCC8.relation(["meet", "covers"])
        True
        """
        if isinstance(relations, int | np.integer) and not isinstance(relations, bool):
            if not 0 <= relations <= self.universal:
                raise BadInput(f"{relations} is no relation of {self.name}: masks run from 0 to {self.universal}")
            return int(relations)
        words = [relations] if isinstance(relations, str) else relations
        if isinstance(words, bool) or not isinstance(words, Iterable):
            raise BadInput(f"relations of {self.name} are names or a mask, not {quoted(relations)}")
        mask = 0
        for word in words:
            if not isinstance(word, str):
                raise BadInput(f"a relation of {self.name} is named by a string, not {quoted(word)}")
            for part in filter(None, _SEPARATORS.split(word)):
                # "|" separates too, unless it is (in) the name of a relation
                names = [part] if part in self._masks else filter(None, part.split("|"))
                for name in names:
                    mask |= self._base_mask(name)
        if not mask:
            raise BadInput(f"the relation set {quoted(relations)} is empty: name at least one of {' '.join(self.bases)}")
        return mask

    def _base_mask(self, name: str) -> int:
        mask = self._masks.get(name) or self._folded.get(name.casefold())
        if mask is None:
            raise UnknownName("relation", name, self._masks, meant=meant_by(name, self))
        return mask

    def names(self, mask: int) -> tuple[str, ...]:
        """Return the base names in a mask, in the order of their bits."""
        return tuple(base for k, base in enumerate(self.bases) if mask >> k & 1)

    def text(self, mask: int) -> str:
        """Return the base names in a mask in one string, as every reader takes it."""
        return " ".join(self.names(mask))

    def is_atomic(self, mask: int) -> bool:
        """Tell whether exactly one base relation is left."""
        return mask != 0 and mask & (mask - 1) == 0

    def converse_of(self, mask: int) -> int:
        """Return the relation between y and x where `mask` is the one between x and y."""
        if self.converse_table is not None:
            return int(self.converse_table[mask])
        result = 0
        for k, c in enumerate(self.base_converse.tolist()):
            result |= (mask >> k & 1) << c
        return result

    def compose(self, r: int, s: int) -> int:
        """Return what ``x r y`` and ``y s z`` leave for x and z (weak composition).

        Complexity
        ----------
        One look-up up to `TABLE_BASES` bases; else the union over pairs of base relations, remembered.
        """
        if self.composition_table is not None:
            return int(self.composition_table[r, s])
        known = self._memo.get((r, s))
        if known is not None:
            return known
        result = 0
        right = [k for k in range(len(self.bases)) if s >> k & 1]
        for k, row in enumerate(self._rows):
            if r >> k & 1:
                for other in right:
                    result |= row[other]
        if len(self._memo) < _MEMO_LIMIT:
            self._memo[r, s] = result
        return result

    def _key(self) -> tuple[object, ...]:
        return (
            self.name,
            self.bases,
            self.identity,
            self.base_converse.tobytes(),
            self.base_composition.tobytes(),
            self.aliases,
        )

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if isinstance(other, Calculus) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())

    def __reduce__(self) -> tuple[Any, ...]:
        parts = (self.name, self.bases, self.identity, self.base_converse, self.base_composition, self.aliases)
        return (Calculus, parts)


def _check_size(name: str, b: int) -> None:
    if b > MAX_BASES:
        raise TooLarge(f"calculus {quoted(name)} has {b} base relations; a relation is one word, so at most {MAX_BASES}")


def _mask_dtype(b: int) -> Any:
    return next(t for bits, t in ((8, np.uint8), (16, np.uint16), (32, np.uint32), (64, np.uint64)) if b <= bits)


def _fold(masks: dict[str, int]) -> dict[str, int]:
    """Map case-folded names to masks, leaving out those that stand for more than one relation."""
    folded: dict[str, int] = {}
    clash: set[str] = set()
    for name, mask in masks.items():
        if folded.setdefault(name.casefold(), mask) != mask:
            clash.add(name.casefold())
    return {name: mask for name, mask in folded.items() if name not in clash}


def _tabulate(converse: NDArray[np.intp], table: NDArray[Any]) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """Extend converse and composition from base relations to all sets of them, one bit after another."""
    b = len(converse)
    size = 1 << b
    one = np.zeros(size, dtype=np.uint8)
    right = np.zeros((b, size), dtype=np.uint8)  # base relation times set
    for k in range(b):
        low, high = 1 << k, 2 << k
        one[low:high] = one[:low] | np.uint8(1 << int(converse[k]))
        right[:, low:high] = right[:, :low] | table[:, k : k + 1]
    two = np.zeros((size, size), dtype=np.uint8)
    for k in range(b):
        low, high = 1 << k, 2 << k
        two[low:high] = two[:low] | right[k]
    one.flags.writeable = two.flags.writeable = False
    return one, two
