"""The one table of formats: what a file is, told by what is in it, and what it can be read as.

A format is an entry of `FORMATS`; it knows what such a file can be read as, not who reads it, so that every reader may ask
the table what a file is that it cannot take. Who reads is above: `ninefold.io.maps` and the modules of each family. The
messages about the wrong kind of file are made here.

===========  =========================================================================================================
a ``map``    `ninefold.io.read_map`: an atlas, a walk log, lines with geometry
a ``walk``   `ninefold.io.read_walk`
a ``source`` `ninefold.io.read_source`: lines with geometry
``network``  `ninefold.io.read_network`: declared relations
``graph``    `ninefold.io.read_pose_graph`: odometry and loop closures
===========  =========================================================================================================
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ninefold._files import shown
from ninefold._wording import quoted
from ninefold.errors import AtlasError, BadInput, UnknownName

if TYPE_CHECKING:
    from collections.abc import Callable
    from os import PathLike

__all__ = ["FORMATS", "Format", "Kind", "foreign", "named_format", "recognise", "told_by", "wrong_kind"]

Kind = Literal["map", "walk", "source", "network", "graph", "atlas"]
"""What a file can be read as."""

_WANTED: dict[Kind, str] = {
    "map": "a map, a walk or lines with geometry",
    "walk": "a walk log",
    "source": "lines with geometry (.geojson, or sample:NAME)",
    "network": "a relation network (.csp, .csv or .json)",
    "graph": "a pose graph (.g2o)",
    "atlas": "an atlas",
}
_HEAD = 4096


@dataclass(frozen=True, slots=True)
class Format:
    """A format of files.

    Attributes
    ----------
    name
        Unique, for options and messages.
    noun
        What to call such a file, with its article.
    suffixes
        Lower case, with the dot; they decide where the content does not.
    is_in
        Whether the first bytes of a file, without a byte order mark, are surely of this format.
    kinds
        What it can be read as.
    use
        What to do with such a file, for somebody who gave it to the wrong command.
    """

    name: str
    noun: str
    suffixes: tuple[str, ...]
    is_in: Callable[[bytes], bool] = field(repr=False)
    kinds: tuple[Kind, ...] = ()
    use: str = ""


def _is_atlas(head: bytes) -> bool:
    return _is_sqlite(head) and head[68:72] == b"N9FL"


def _is_sqlite(head: bytes) -> bool:
    return head.startswith(b"SQLite format 3\0")


def _is_walk(head: bytes) -> bool:
    try:
        found = json.loads(head.lstrip().partition(b"\n")[0])
    except (ValueError, RecursionError):
        return False
    return isinstance(found, dict) and found.get("ninefold") == "walk"


_GEOJSON = re.compile(
    rb'"type"\s*:\s*"(FeatureCollection|Feature|GeometryCollection|(Multi)?(LineString|Point|Polygon))"|"features"\s*:\s*\['
)
_NETWORK = re.compile(rb'\{\s*("calculus"|"statements"|"entities")\s*:')
_CSP = re.compile(rb"\d+[ \t\r]*(#[^\n]*)?(\n|$)")


def _is_geojson(head: bytes) -> bool:
    return head.lstrip().startswith(b"{") and _GEOJSON.search(head) is not None


def _is_network_object(head: bytes) -> bool:
    return _NETWORK.match(head.lstrip()) is not None


def _is_network_table(head: bytes) -> bool:
    first = head.lstrip().partition(b"\n")[0].lower()
    return b"relations" in first and re.search(b"[,;\t]", first) is not None and not first.startswith(b"{")


_G2O = re.compile(rb"(?:(?:FIX|#)[^\n]*\n|[ \t\r]*\n)*[ \t]*(?:VERTEX|EDGE|PARAMS)_[A-Z]+[A-Z0-9_:]*[ \t]")


def _is_pose_graph(head: bytes) -> bool:
    return _G2O.match(head) is not None


def _is_csp(head: bytes) -> bool:
    lines = (line.strip() for line in head.split(b"\n"))
    return _CSP.match(next((line for line in lines if line and not line.startswith(b"#")), b"")) is not None


_TO_ATLAS = "`ninefold map FILE -o NAME.atlas` makes an atlas of it (in Python: read_map)"
_ASK = "`ninefold check FILE` decides it (in Python: read_network)"

FORMATS = (
    Format(
        "atlas",
        "an atlas",
        (".atlas",),
        _is_atlas,
        ("atlas", "map"),
        "`ninefold info FILE` shows what is in it (in Python: Atlas.open)",
    ),
    Format("sqlite", "an SQLite database of something else", (), _is_sqlite, ("map",)),
    Format(
        "walk",
        "a walk log",
        (".jsonl",),
        _is_walk,
        ("walk", "map"),
        _TO_ATLAS,
    ),
    Format("network-json", "a relation network", (), _is_network_object, ("network",), _ASK),
    Format(
        "geojson",
        "lines in GeoJSON",
        (".geojson", ".json"),
        _is_geojson,
        ("source", "map"),
        _TO_ATLAS,
    ),
    Format(
        "g2o",
        "a pose graph",
        (".g2o",),
        _is_pose_graph,
        ("graph",),
        "`ninefold claims FILE` judges its loop closures (in Python: read_pose_graph)",
    ),
    Format(
        "relations",
        "a table of relations that `relate --all` wrote",
        (),
        lambda head: head.startswith(b"x,y,name,de9im,rcc8"),
    ),
    Format("network-csv", "a relation network", (".csv",), _is_network_table, ("network",), _ASK),
    Format("network-csp", "a relation network", (".csp",), _is_csp, ("network",), _ASK),
    Format(
        "proof",
        "a proof of inconsistency",
        (),
        lambda head: head.startswith(b"ninefold-proof"),
        use="`ninefold prove NET FILE` confirms it",
    ),
    Format("svg", "a picture", (".svg",), lambda head: head.lstrip().startswith((b"<svg", b"<?xml"))),
    Format("parquet", "a Parquet table", (".parquet",), lambda head: head.startswith(b"PAR1")),
)
"""Every format, those with surer signs first."""


def named_format(name: str) -> Format:
    """Return the format of a name.

    Raises
    ------
    UnknownName
        With near names.
    """
    for known in FORMATS:
        if known.name == name:
            return known
    raise UnknownName("format", name, [known.name for known in FORMATS])


def told_by(head: bytes) -> Format | None:
    """Return the format that the first bytes of a file are of, or None if they do not tell."""
    text = head.removeprefix(b"\xef\xbb\xbf")
    return next((known for known in FORMATS if known.is_in(text)), None)


def recognise(path: str | PathLike[str], kind: Kind = "map") -> Format:
    """Say what a file is, by its content and, where that does not tell, by its suffix. ``sample:NAME`` is a source.

    Parameters
    ----------
    kind
        What it is going to be read as: the message says so if it cannot.

    Raises
    ------
    BadInput
        For a file that cannot be read, is of no known format, or of one that cannot be read as `kind`.
    AtlasError
        Instead, for one that is called an atlas by its suffix.
    """
    if str(path).startswith("sample:"):
        return named_format("geojson")
    file = Path(path)
    head = _head(file)
    found = told_by(head)
    named = next((known for known in FORMATS if file.suffix.lower() in known.suffixes), None)
    found = found or named
    if found is None and head.removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"{"):
        found = named_format("geojson")
    if found is None:
        fit = [f"{known.noun} ({known.suffixes[0]})" for known in FORMATS if kind in known.kinds and known.suffixes]
        raise BadInput(f"{file}: neither {', '.join(fit[:-1])} nor {fit[-1]}" if fit[1:] else f"{file}: not {fit[0]}")
    if kind not in found.kinds:
        error = AtlasError if named is not None and named.name == "atlas" else BadInput
        raise error(wrong_kind(path, found, kind))
    return found


def foreign(head: bytes, kind: Kind) -> Format | None:
    """Return the format of the first bytes of a file if they are surely of one that cannot be read as `kind`."""
    found = told_by(head)
    return found if found is not None and kind not in found.kinds else None


def wrong_kind(path: str | PathLike[str], found: Format, wanted: Kind) -> str:
    """Return the line for a file that is something else than what it was given for."""
    use = f"; {found.use.replace('FILE', str(path))}" if found.use else ""
    return f"{path}: this is {found.noun}, not {_WANTED[wanted]}{use}"


def _head(file: Path) -> bytes:
    try:
        if file.exists() and not file.is_dir() and not file.is_file():
            raise BadInput(f"{file}: a device or a pipe, which can be read only once; save it to a file first")
        with file.open("rb") as stream:
            return stream.read(_HEAD)
    except OSError as error:
        raise BadInput(f"{shown(file)}: cannot be read ({error.strerror or error})") from None
    except ValueError as error:
        if isinstance(error, BadInput):
            raise
        raise BadInput(f"{quoted(str(file))} is no file name: it holds a null character") from None
