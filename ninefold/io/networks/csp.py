"""GQR's text format of constraint networks, ``.csp``.

::

    3 #a comment
    0 1 ( NTPP TPP )
    1 3 ( DC )
    .

The first number is the highest index, so this network has four entities, ``"0"`` to ``"3"``. Lines that start with
``#`` are comments; a line that starts with a dot ends the network, and another may follow it in the file.

Some tools put the number of entities there instead. Either reading is possible when exactly the highest index is never
used. In a well-filled file an entity without a single statement is not credible (with d statements an entity, one in
e^d), so the number is then taken for a count; else it is taken as GQR takes it. A note says which.

The format knows neither names, labels, weights nor calculi. Where a network has them they go into comments that start
with ``#@`` and hold JSON, one after the first line and one after a statement; GQR passes over them.

References
----------
Z. Gantner, M. Westphal and S. Woelfl, "GQR: a fast reasoner for binary qualitative constraint calculi", AAAI-08
Workshop on Spatial and Temporal Reasoning.
"""

from __future__ import annotations

import json
import math
import re
from typing import TYPE_CHECKING, Any

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput, NinefoldError, TooLarge
from ninefold.reasoner.networks.network import Network

from ._lines import at, placed, same_calculus

if TYPE_CHECKING:
    from ninefold.encodings.calculus import Calculus

__all__ = ["read", "write"]

_FIRST = re.compile(r"\s*(\d+)\s*(#.*)?")
_LINE = re.compile(r"\s*(\d+)\s+(\d+)\s*\(([^()]*)\)\s*(#.*)?")
_MARK = "#@"

ENTITY_BYTES = 250
"""About what a named entity takes."""

_IDLE_ENTITIES = 100_000
"""Up to so many entities may be there without statements."""

_FILLED = 4.0
"""Mean number of statements an entity from which an entity without any is not credible."""


def read(text: str, told: Calculus | None, file: str) -> tuple[Network, list[str]]:
    """Parse a file of one network; see `ninefold.io.networks.network_file.read_network`."""
    networks = _split(text)
    if len(networks) > 1:
        raise BadInput(
            f"{file}, line {networks[1][0] + 1}: another network starts here, there are {len(networks)}; "
            "split the file or read it with read_networks"
        )
    return _read(*networks[0], told, file)


def read_all(text: str, told: Calculus | None, file: str) -> list[tuple[Network, list[str]]]:
    """Parse all networks of a file; see `ninefold.io.networks.network_file.read_networks`."""
    return [_read(skipped, lines, told, file) for skipped, lines in _split(text)]


def _split(text: str) -> list[tuple[int, list[str]]]:
    """Cut a file behind every line that starts with a dot; each network with the number of lines before it."""
    networks: list[tuple[int, list[str]]] = []
    start = 0
    lines = [line.strip() for line in text.split("\n")]
    for end, line in enumerate(lines, start=1):
        if line.startswith("."):
            networks.append((start, lines[start:end]))
            start = end
    rest = lines[start:]
    if not networks or any(line and not line.startswith("#") for line in rest):
        networks.append((start, rest))
    return networks


def _read(skipped: int, lines: list[str], told: Calculus | None, file: str) -> tuple[Network, list[str]]:
    start, head = _first_line(skipped, lines, file)
    highest = _index(head[1], f"{file}, line {start}")
    extra: dict[str, Any] = {}
    statements: list[tuple[int, int, str, str | None, int]] = []
    for number, line in enumerate(lines[start - skipped :], start=start + 1):
        where = f"{file}, line {number}"
        if not line or line.startswith("."):
            continue
        if line.startswith(_MARK) and not statements:
            extra |= _extra(line, where)
        elif not line.startswith("#"):
            found = _LINE.fullmatch(line)
            if found is None:
                raise BadInput(f"{where}: a statement is 'i j ( R1 R2 )', not {quoted(line)}")
            i, j = (_index(digits, where) for digits in found.groups()[:2])
            statements.append((i, j, found[3], found[4], number))
    notes = [] if lines[-1].startswith(".") else [f"{file} has no final '.': it may have been cut off"]
    return _network(highest, start, statements, extra, told, file, notes), notes


def _first_line(skipped: int, lines: list[str], file: str) -> tuple[int, re.Match[str]]:
    for number, line in enumerate(lines, start=skipped + 1):
        if line and not line.startswith("#"):
            found = _FIRST.fullmatch(line)
            if found is None:
                raise BadInput(f"{file}, line {number}: a csp file starts with its highest index, not {quoted(line)}")
            return number, found
    raise BadInput(f"{file}: empty; a csp file starts with its highest index")


def _network(
    highest: int,
    first: int,
    statements: list[tuple[int, int, str, str | None, int]],
    extra: dict[str, Any],
    told: Calculus | None,
    file: str,
    notes: list[str],
) -> Network:
    used = {index for i, j, *_ in statements for index in (i, j)}
    for i, j, _, _, number in statements:
        if max(i, j) > highest:
            raise BadInput(f"{file}, line {number}: index {max(i, j)} is above {highest}, the highest by line {first}")
    names = extra.get("entities")
    n = highest + 1
    if names is not None:
        if len(names) != n:
            raise BadInput(f"{file}: {len(names)} names for {n} entities")
    elif n > 1 and highest not in used and max(used, default=0) == highest - 1:
        if len(used) == highest and 2 * len(statements) >= _FILLED * highest:
            n = highest
            notes.append(f"{file}: the first number {highest} is read as the number of entities, as {highest} is unused")
        else:
            notes.append(
                f"{file}: the first number {highest} is read as the highest index, so entity {highest} is there "
                f"without a statement; if it is the number of entities, write {highest - 1}"
            )
    if n > _IDLE_ENTITIES and n > 100 * len(statements):
        size = n * ENTITY_BYTES / 2**30
        raise TooLarge(
            f"{file}: {counted(n, 'entity', 'entities')} for {counted(len(statements), 'statement')} would take "
            f"{size:.3g} GiB; the first number is the highest index"
        )
    calculus = same_calculus(told, extra.get("calculus"), file)
    net = Network(calculus)
    known: dict[str, int] = {}
    if names is None:
        names = list(map(str, range(n)))
    with at(file, calculus):
        for name in names:
            net.add_entity(name)
    if net.n_entities != n:
        raise BadInput(f"{file}: the names of the entities are not all different")
    number = 0
    try:
        for i, j, words, comment, number in statements:  # noqa: B007
            mask = known.get(words)
            if mask is None:
                mask = known[words] = calculus.relation(words)
            if comment is None or not comment.startswith(_MARK):
                net.add(names[i], names[j], mask)
            else:
                more = _extra(comment, "the comment")
                weight = more.get("weight")
                net.add(names[i], names[j], mask, more.get("label"), math.inf if weight == "inf" else weight)
    except NinefoldError as error:
        raise placed(error, f"{file}, line {number}", calculus) from None
    return net


def _index(digits: str, where: str) -> int:
    if len(digits) > 15:
        raise TooLarge(f"{where}: an index of {len(digits)} digits: its network would take more than any memory")
    return int(digits)


def _extra(comment: str, where: str) -> dict[str, Any]:
    try:
        found = json.loads(comment[len(_MARK) :])
    except (ValueError, RecursionError) as error:
        raise BadInput(f"{where}: a comment that starts with {_MARK} holds JSON: {error}") from None
    if not isinstance(found, dict):
        raise BadInput(f"{where}: a comment that starts with {_MARK} holds a JSON object")
    names = found.get("entities", [])
    if not isinstance(names, list) or not isinstance(found.get("calculus", ""), str):
        raise BadInput(f"{where}: 'entities' is a list of names and 'calculus' a name")
    return found


def write(net: Network) -> str:
    """Return the text of a ``.csp`` file, with comments for what the format does not know.

    Raises
    ------
    BadInput
        A network without entities, which the format cannot say.
    """
    if not net.n_entities:
        raise BadInput("a csp file cannot hold a network without entities")
    lines = [f"{net.n_entities - 1} #{net.calculus.name}"]
    extra: dict[str, Any] = {}
    plain = list(map(str, range(net.n_entities)))
    spoken = {name for s in net.statements for name in (s.a, s.b)}
    if list(net.entities) != plain or net.entities[-1] not in spoken:
        extra["entities"] = list(net.entities)
    if net.calculus.name != "rcc8":
        extra["calculus"] = net.calculus.name
    if extra:
        lines.append(f"{_MARK} {json.dumps(extra)}")
    for s in net.statements:
        more: dict[str, Any] = {}
        if s.label is not None:
            more["label"] = s.label
        if s.weight is not None:
            more["weight"] = "inf" if s.hard else s.weight
        comment = f" {_MARK} {json.dumps(more)}" if more else ""
        lines.append(f"{net.index(s.a)} {net.index(s.b)} ( {net.calculus.text(s.mask)} ){comment}")
    return "\n".join([*lines, ".", ""])
