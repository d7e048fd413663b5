"""Read the definition of a calculus in GQR's format.

GQR splits a definition over three files, told apart by their lines; here they may also stand in one file:

- ``identity EQ``, ``calculus_size 8``: settings, a key and a value. ``converse_file`` and ``comp_table_file`` name the
  two other files, relative to this one; ``weights`` is for GQR's heuristics and is passed over.
- ``TPP :: TPPI``: the converse of a base relation, one a line.
- ``DC : EC :: ( DC EC PO )``: one entry of the composition table.

Lines that start with ``#`` and empty lines are comments. Three settings are ours: ``name``, ``base_relations A B C``
(the order of the bits; else the order of the converse table) and ``alias WORD BASE``.

References
----------
Z. Gantner, M. Westphal and S. Woelfl, "GQR: a fast reasoner for binary qualitative constraint calculi", AAAI-08
Workshop on Spatial and Temporal Reasoning.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from ninefold._wording import quoted
from ninefold.errors import BadInput, UnknownName

__all__ = ["Definition", "read_definition"]

_FILE_KEYS = ("converse_file", "comp_table_file")
_KEYS = ("name", "identity", "calculus_size", "base_relations", "alias", "weights", *_FILE_KEYS)


@dataclass(frozen=True, slots=True)
class Definition:
    """A calculus as its definition gives it: no law is checked yet.

    Parameters
    ----------
    identity
        Mask over `bases`.
    converse, composition
        b indices, and b rows of b masks.
    """

    name: str
    bases: tuple[str, ...]
    identity: int
    converse: tuple[int, ...]
    composition: tuple[tuple[int, ...], ...]
    aliases: tuple[tuple[str, str], ...] = ()


@dataclass(slots=True)
class _Lines:
    """What the lines said so far, each with the place it was said at."""

    settings: dict[str, tuple[str, str]] = field(default_factory=dict)
    aliases: list[tuple[str, str]] = field(default_factory=list)
    converse: dict[str, tuple[str, str]] = field(default_factory=dict)
    composition: dict[tuple[str, str], tuple[list[str], str]] = field(default_factory=dict)


def read_definition(source: Path | str, name: str = "calculus") -> Definition:
    """Parse a definition file (a `Path`) or text (a string).

    Raises
    ------
    BadInput, UnknownName
        With file and line where there is one.
    """
    said = _Lines()
    if isinstance(source, Path):
        name = source.stem
        _read(said, _text_of(source, ""), str(source))
        for key in _FILE_KEYS:
            if key in said.settings:
                other, where = said.settings[key]
                _read(said, _text_of(source.parent / other, where), other)
    else:
        _read(said, source, name)
        for key in _FILE_KEYS:
            if key in said.settings:
                raise BadInput(f"{said.settings[key][1]}: {key} needs a file to be relative to; use Calculus.from_file")
    return _assemble(said, said.settings.get("name", (name, ""))[0], str(source) if isinstance(source, Path) else name)


def _text_of(path: Path, where: str) -> str:
    told = f"{where}: " if where else ""
    try:
        return path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise BadInput(f"{told}cannot read {path}: {error.strerror or error}") from error
    except UnicodeDecodeError as error:
        raise BadInput(f"{told}{path} is not UTF-8 text: byte {error.start} is 0x{error.object[error.start]:02x}") from None
    except ValueError as error:  # a null character in the path
        raise BadInput(f"{told}cannot read {quoted(str(path))}: {error}") from None


def _read(said: _Lines, text: str, file: str) -> None:
    for number, raw in enumerate(text.splitlines(), start=1):
        line = raw.strip()
        where = f"{file}, line {number}"
        if not line or line.startswith("#"):
            continue
        head, double, tail = line.partition("::")
        if not double:
            _setting(said, line, where)
        elif ":" in head:
            _composition(said, head, tail, where)
        else:
            _converse(said, head, tail, where)


def _setting(said: _Lines, line: str, where: str) -> None:
    key, _, value = line.partition(" ")
    value = value.strip()
    if key not in _KEYS:
        raise BadInput(
            f"{where}: {quoted(line)} is neither a setting ({', '.join(_KEYS)}) nor 'a :: b' nor 'a : b :: ( c d )'"
        )
    if not value:
        raise BadInput(f"{where}: {key} has no value")
    if key == "alias":
        words = value.split()
        if len(words) != 2:
            raise BadInput(f"{where}: alias takes a word and a base relation, not {quoted(value)}")
        said.aliases.append((words[0], words[1]))
        return
    if key in said.settings:
        raise BadInput(f"{where}: {key} was already given at {said.settings[key][1]}")
    said.settings[key] = (value, where)


def _converse(said: _Lines, head: str, tail: str, where: str) -> None:
    left, right = head.split(), tail.split()
    if len(left) != 1 or len(right) != 1:
        raise BadInput(f"{where}: a converse is 'a :: b' with one relation on each side")
    if left[0] in said.converse:
        raise BadInput(f"{where}: the converse of {left[0]} was already given at {said.converse[left[0]][1]}")
    said.converse[left[0]] = (right[0], where)


def _composition(said: _Lines, head: str, tail: str, where: str) -> None:
    left, _, right = head.partition(":")
    a, b, result = left.split(), right.split(), tail.strip()
    if len(a) != 1 or len(b) != 1 or not (result.startswith("(") and result.endswith(")")):
        raise BadInput(f"{where}: an entry of the composition table is 'a : b :: ( c d )'")
    key = (a[0], b[0])
    if key in said.composition:
        raise BadInput(f"{where}: {a[0]};{b[0]} was already given at {said.composition[key][1]}")
    said.composition[key] = (result[1:-1].split(), where)


def _assemble(said: _Lines, name: str, file: str) -> Definition:
    if "base_relations" in said.settings:
        bases = tuple(said.settings["base_relations"][0].split())
    else:
        bases = tuple(said.converse)
    if not bases:
        raise BadInput(f"{file}: no base relation: give the converse of each, one 'a :: b' a line")
    index = {base: k for k, base in enumerate(bases)}
    if len(index) < len(bases):
        twice = next(base for k, base in enumerate(bases) if base in bases[:k])
        raise BadInput(f"{said.settings['base_relations'][1]}: base relation {quoted(twice)} is named twice")

    def look_up(base: str, where: str) -> int:
        if base not in index:
            raise BadInput(f"{where}: {UnknownName('base relation', base, bases)}")
        return index[base]

    if "calculus_size" in said.settings:
        size, where = said.settings["calculus_size"]
        if size != str(len(bases)):
            raise BadInput(f"{where}: calculus_size is {size}, but there are {len(bases)} base relations: {' '.join(bases)}")
    if "identity" not in said.settings:
        raise BadInput(f"{file}: no identity: add a line 'identity' with the base relation that means equal")
    words, where = said.settings["identity"]
    identity = 0
    for word in words.split():
        identity |= 1 << look_up(word, where)

    converse = [-1] * len(bases)
    for base, (other, where) in said.converse.items():
        converse[look_up(base, where)] = look_up(other, where)
    table = [[-1] * len(bases) for _ in bases]
    for (a, b), (results, where) in said.composition.items():
        mask = 0
        for result in results:
            mask |= 1 << look_up(result, where)
        table[look_up(a, where)][look_up(b, where)] = mask
    for i, a in enumerate(bases):
        if converse[i] < 0:
            raise BadInput(f"{file}: the converse of {a} is missing")
        for j, b in enumerate(bases):
            if table[i][j] < 0:
                raise BadInput(f"{file}: the composition {a};{b} is missing")
    for word, base in said.aliases:
        look_up(base, f"{file}: alias {word}")
    return Definition(name, bases, identity, tuple(converse), tuple(map(tuple, table)), tuple(said.aliases))
