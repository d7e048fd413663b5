"""Relation networks as JSON.

::

    {"calculus": "rcc8", "statements": [
      {"a": "kitchen", "relations": ["NTPP"], "b": "house", "weight": 2, "label": "floor plan"}
    ]}

``weight`` and ``label`` may be missing or null; a weight of ``"inf"`` makes a statement hard. ``entities``, a list of
names, is there where it says more than the statements do: their order, or names that no statement speaks of.
"""

from __future__ import annotations

import json
import math
from typing import TYPE_CHECKING, Any

from ninefold._wording import quoted
from ninefold.errors import BadInput, UnknownName
from ninefold.reasoner.networks.network import Network

from ._lines import at, same_calculus

if TYPE_CHECKING:
    from ninefold.encodings.calculus import Calculus

__all__ = ["read", "write"]

_KEYS = ("calculus", "entities", "statements")
_STATEMENT_KEYS = ("a", "relations", "b", "weight", "label")


def read(text: str, told: Calculus | None, file: str) -> tuple[Network, list[str]]:
    """Parse one object; see `ninefold.io.networks.network_file.read_network`."""
    try:
        found = json.loads(text, object_pairs_hook=_object)
    except json.JSONDecodeError as error:
        raise BadInput(f"{file}, line {error.lineno}, column {error.colno}: {error.msg}") from None
    except (ValueError, RecursionError) as error:
        raise BadInput(f"{file}: {error}") from None
    if not isinstance(found, dict):
        raise BadInput(f'{file}: a network is an object {{"calculus": .., "statements": [..]}}')
    _only(found, _KEYS, file)
    said = found.get("calculus")
    if said is not None and not isinstance(said, str):
        raise BadInput(f"{file}: 'calculus' is a name, not {quoted(said)}")
    calculus = same_calculus(told, said, file)
    net = Network(calculus)
    for name in _list(found, "entities", file):
        with at(f"{file}, entities", calculus):
            net.add_entity(name)
    if "statements" not in found:
        raise BadInput(f"{file}: 'statements' is missing")
    for number, entry in enumerate(_list(found, "statements", file), start=1):
        where = f"{file}, statement {number}"
        if not isinstance(entry, dict):
            raise BadInput(f"{where}: a statement is an object with {', '.join(_STATEMENT_KEYS)}, not {quoted(entry)}")
        _only(entry, _STATEMENT_KEYS, where)
        for key in _STATEMENT_KEYS[:3]:
            if key not in entry:
                raise BadInput(f"{where}: {quoted(key)} is missing")
        relations = entry["relations"]
        if not isinstance(relations, str | list):
            raise BadInput(f"{where}: 'relations' is a list of names, not {quoted(relations)}")
        weight = math.inf if entry.get("weight") == "inf" else entry.get("weight")
        with at(where, calculus):
            net.add(entry["a"], entry["b"], relations, entry.get("label"), weight)
    return net, []


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        keys = [key for key, _ in pairs]
        raise ValueError(f"key {quoted(next(key for key in keys if keys.count(key) > 1))} is there twice in one object")
    return found


def _only(found: dict[str, Any], keys: tuple[str, ...], where: str) -> None:
    for key in found:
        if key not in keys:
            raise BadInput(f"{where}: {UnknownName('key', key, keys)}; known are {', '.join(keys)}")


def _list(found: dict[str, Any], key: str, file: str) -> list[Any]:
    value = found.get(key, [])
    if not isinstance(value, list):
        raise BadInput(f"{file}: {quoted(key)} is a list, not {quoted(value)}")
    return value


def write(net: Network) -> str:
    """Return the text of a ``.json`` file, one statement a line."""
    lines = []
    order: dict[str, None] = {}
    for s in net.statements:
        order |= {s.a: None, s.b: None}
        entry: dict[str, Any] = {"a": s.a, "relations": list(net.calculus.names(s.mask)), "b": s.b}
        if s.weight is not None:
            entry["weight"] = "inf" if s.hard else s.weight
        if s.label is not None:
            entry["label"] = s.label
        lines.append(f"  {json.dumps(entry, ensure_ascii=False)}")
    head = f'{{"calculus": {json.dumps(net.calculus.name, ensure_ascii=False)}'
    if tuple(order) != net.entities:
        head += f', "entities": {json.dumps(list(net.entities), ensure_ascii=False)}'
    body = "\n" + ",\n".join(lines) + "\n" if lines else ""
    return f'{head}, "statements": [{body}]}}\n'
