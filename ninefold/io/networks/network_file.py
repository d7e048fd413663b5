r"""Files of relation networks: read one in whatever format it is, write one.

==========  ======================================================================================================
``csp``     GQR's text format, see `ninefold.io.networks.csp`
``csv``     a table ``a,relations,b,weight,label``, see `ninefold.io.networks.csv_file`
``json``    ``{"calculus": .., "statements": [..]}``, see `ninefold.io.networks.json_file`
==========  ======================================================================================================

The format is told by the suffix, else by the first characters. CSV and GQR files do not say which calculus they are in;
without being told they are RCC-8.

Examples
--------
>>> from ninefold.io.networks.network_file import network_from_text, network_to_text
>>> net = network_from_text("a,relations,b\nkitchen,inside,house\nhouse,EC|DC,garden\n", "csv")
>>> net
Network(rcc8, 3 entities, 2 statements)
>>> print(network_to_text(net, "json"))
{"calculus": "rcc8", "statements": [
  {"a": "kitchen", "relations": ["NTPP"], "b": "house"},
  {"a": "house", "relations": ["DC", "EC"], "b": "garden"}
]}
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ninefold._files import shown, write_text
from ninefold._wording import quoted
from ninefold.encodings.calculus import Calculus
from ninefold.encodings.library import calculus_named
from ninefold.errors import BadInput, UnknownName

from ..formats import foreign, told_by, wrong_kind
from . import csp, csv_file, json_file

if TYPE_CHECKING:
    import os

    from ninefold.reasoner.networks.network import Network

__all__ = [
    "NETWORK_FORMATS",
    "NetworkFile",
    "load_network",
    "network_from_text",
    "network_to_text",
    "read_network",
    "read_networks",
    "write_network",
]

_MODULES = {"csp": csp, "csv": csv_file, "json": json_file}

NETWORK_FORMATS = tuple(_MODULES)
"""Names of the formats, which are also their suffixes."""


@dataclass(frozen=True, slots=True)
class NetworkFile:
    """A network with what its reader has to say.

    Parameters
    ----------
    network, kind
        What was read, and as which of `NETWORK_FORMATS`.
    notes
        What a user should know: how an ambiguous number was read, a missing end, and the like.
    """

    network: Network
    kind: str
    notes: tuple[str, ...] = ()


def read_network(
    path: str | os.PathLike[str], *, calculus: Calculus | str | None = None, kind: str | None = None
) -> Network:
    """Read a network; `load_network` also gives the reader's notes.

    Parameters
    ----------
    calculus
        A calculus, the name of one that comes with ninefold, or a path to a ``.spec`` definition. Needed for CSV and
        GQR files that are not in RCC-8.
    kind
        One of `NETWORK_FORMATS`, where suffix and content do not tell.

    Raises
    ------
    BadInput
        The file cannot be read, or a line or statement is wrong: file and line are named.
    UnknownName
        An unknown calculus or format.
    TooLarge
        The file asks for more entities than there is sense or memory for.
    """
    return load_network(path, calculus=calculus, kind=kind).network


def load_network(
    path: str | os.PathLike[str], *, calculus: Calculus | str | None = None, kind: str | None = None
) -> NetworkFile:
    """Read a network with the reader's notes; see `read_network`."""
    file = Path(path)
    text = _text_of(file)
    return _parse(text, kind or _kind(file, text), calculus, str(file))


def read_networks(path: str | os.PathLike[str], *, calculus: Calculus | str | None = None) -> list[NetworkFile]:
    """Read a GQR file that may hold several networks, in order; any other file is a list of one.

    Raises
    ------
    BadInput, UnknownName, TooLarge
        See `read_network`.
    """
    file = Path(path)
    text = _text_of(file)
    kind = _kind(file, text)
    if kind != "csp":
        return [_parse(text, kind, calculus, str(file))]
    found = csp.read_all(text, _calculus(calculus), str(file))
    return [NetworkFile(network, kind, tuple(notes)) for network, notes in found]


def network_from_text(text: str, kind: str, *, calculus: Calculus | str | None = None) -> Network:
    """Read a network from a string; see `read_network`."""
    return _parse(text, kind, calculus, "text").network


def network_to_text(net: Network, kind: str) -> str:
    """Return a network as the text of a file of that format; every format reads its own text back.

    Raises
    ------
    UnknownName
        None of `NETWORK_FORMATS`.
    """
    if kind not in _MODULES:
        raise UnknownName("network format", kind, NETWORK_FORMATS)
    text: str = _MODULES[kind].write(net)
    return text


def write_network(net: Network, path: str | os.PathLike[str], *, kind: str | None = None) -> None:
    """Write a network to a file, in the format of its suffix if none is given; a file that is there is replaced.

    Raises
    ------
    UnknownName
        A format or suffix that is none of `NETWORK_FORMATS`.
    BadInput
        The file cannot be written; what was there before stays.
    """
    file = Path(path)
    text = network_to_text(net, kind or file.suffix.lower().lstrip("."))
    write_text(file, text, force=True)


def _parse(text: str, kind: str, calculus: Calculus | str | None, file: str) -> NetworkFile:
    if kind not in _MODULES:
        raise UnknownName("network format", kind, NETWORK_FORMATS)
    network, notes = _MODULES[kind].read(text, _calculus(calculus), file)
    return NetworkFile(network, kind, tuple(notes))


def _calculus(given: Calculus | str | None) -> Calculus | None:
    if given is None or isinstance(given, Calculus):
        return given
    if given.endswith(".spec"):
        return Calculus.from_file(given)
    return calculus_named(given)


def _text_of(file: Path) -> str:
    try:
        raw = file.read_bytes()
    except OSError as error:
        raise BadInput(f"cannot read {shown(file)}: {error.strerror or error}") from error
    except ValueError as error:  # a null character in the path
        raise BadInput(f"cannot read {quoted(str(file))}: {error}") from None
    other = foreign(raw[:4096], "network")
    if other is not None:
        raise BadInput(wrong_kind(file, other, "network"))
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        raise BadInput(f"{file}, line {line}: byte 0x{raw[error.start]:02x} is not UTF-8; save the file as UTF-8") from None


def _kind(file: Path, text: str) -> str:
    """Return the name of a network's format, by the suffix if it is one, else by the content."""
    suffix = file.suffix.lower().lstrip(".")
    if suffix in _MODULES:
        return suffix
    found = told_by(text[:4096].encode("utf-8", "replace"))
    if found is None:
        raise BadInput(
            f"{file} is no network file: csp starts with a number, csv with the header a,relations,b,weight,label and json "
            "with a brace; if it is one of them, name the format"
        )
    return found.name.removeprefix("network-")
