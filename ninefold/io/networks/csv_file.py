"""Relation networks as a table: ``a,relations,b,weight,label``.

Relations are split at spaces or ``|``. The columns may stand in any order, ``weight`` and ``label`` may be missing or
empty; a weight of ``inf`` makes a statement hard. Semicolons or tabs may separate instead of commas.

An entity that nothing is said about cannot be in such a table; it is written as equal to itself.
"""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING

from ninefold._wording import quoted
from ninefold.errors import BadInput, UnknownName
from ninefold.reasoner.networks.network import Network

from ._lines import at, same_calculus

if TYPE_CHECKING:
    from ninefold.encodings.calculus import Calculus

__all__ = ["COLUMNS", "read", "write"]

COLUMNS = ("a", "relations", "b", "weight", "label")
"""The header."""


def read(text: str, told: Calculus | None, file: str) -> tuple[Network, list[str]]:
    """Parse a table; see `ninefold.io.networks.network_file.read_network`."""
    calculus = same_calculus(told, None, file)
    net = Network(calculus)
    first = text.lstrip("\r\n").split("\n", 1)[0]
    delimiter = next((d for d in ",;\t" if d in first), ",")
    rows = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True)
    place: dict[str, int] | None = None
    try:
        for row in rows:
            where = f"{file}, line {rows.line_num}"
            cells = [cell.strip() for cell in row]
            if not any(cells):
                continue
            if place is None:
                place = _header(cells, where)
                width = len(cells)
                continue
            if len(cells) != width:
                raise BadInput(f"{where}: {len(cells)} fields, but the header has {width}")
            value = {column: cells[k] for column, k in place.items()}
            with at(where, calculus):
                weight = _weight(value.get("weight", ""))
                net.add(value["a"], value["b"], value["relations"], value.get("label") or None, weight)
    except csv.Error as error:
        raise BadInput(f"{file}, line {rows.line_num}: {error}") from None
    if place is None:
        raise BadInput(f"{file}: empty; the first line is {','.join(COLUMNS)}")
    return net, []


def _header(cells: list[str], where: str) -> dict[str, int]:
    place: dict[str, int] = {}
    for k, cell in enumerate(cells):
        column = cell.casefold()
        if column not in COLUMNS:
            raise BadInput(f"{where}: {UnknownName('column', cell, COLUMNS)}; the header is {','.join(COLUMNS)}")
        if column in place:
            raise BadInput(f"{where}: column {quoted(column)} is there twice")
        place[column] = k
    missing = [column for column in COLUMNS[:3] if column not in place]
    if missing:
        raise BadInput(f"{where}: column {quoted(missing[0])} is missing; the header is {','.join(COLUMNS)}")
    return place


def _weight(cell: str) -> float | None:
    if not cell:
        return None
    try:
        return float(cell)
    except ValueError:
        raise BadInput(f"weight {quoted(cell)} is no number; leave it empty for 1, or write inf") from None


def write(net: Network) -> str:
    """Return the text of a ``.csv`` file.

    Notes
    -----
    The calculus is not in it: name it when the file is read, unless it is RCC-8.
    """
    rows = [COLUMNS]
    for s in net.statements:
        weight = "" if s.weight is None else repr(s.weight).removesuffix(".0")
        rows.append((s.a, net.calculus.text(s.mask), s.b, weight, s.label or ""))
    spoken = {name for s in net.statements for name in (s.a, s.b)}
    equal = net.calculus.text(net.calculus.identity)
    rows.extend((name, equal, name, "", "") for name in net.entities if name not in spoken)
    # A carriage return ends a row when it is read, but the csv module does not see to its quotes by itself.
    careful = any("\r" in cell for row in rows for cell in row)
    out = io.StringIO(newline="")
    csv.writer(out, lineterminator="\n", quoting=csv.QUOTE_ALL if careful else csv.QUOTE_MINIMAL).writerows(rows)
    return out.getvalue()
