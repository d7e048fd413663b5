"""A network of statements about how entities are related: the builder that every question starts from.

Statements are kept one by one, in order, because answers name them; the arrays that engines and encodings take are
their intersection pair by pair (`Network.constraints`).

Examples
--------
>>> from ninefold.encodings import RCC8
>>> from ninefold.reasoner.networks.network import Network
>>> net = Network(RCC8)
>>> _ = net.add("kitchen", "house", "inside", label="floor plan")
>>> _ = net.add("house", "kitchen", "contains | covers")
>>> net
Network(rcc8, 2 entities, 2 statements)
>>> pairs = net.constraints()
>>> [(int(i), int(j), RCC8.text(int(mask))) for i, j, mask in zip(pairs.i, pairs.j, pairs.mask)]
[(0, 1, 'NTPP')]
>>> [str(net.statements[k]) for k in pairs.statements(0)]
['floor plan', 'statement 2']
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.encodings.calculus import Calculus
from ninefold.encodings.library import calculus_named
from ninefold.errors import BadInput, UnknownName
from ninefold.immutable import Immutable, freeze

from .statement import Statement, checked_weight

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

__all__ = ["Constraints", "Network", "require_network"]


@dataclass(frozen=True, slots=True, eq=False)
class Constraints(Immutable):
    """The statements of a network, intersected pair by pair.

    Attributes
    ----------
    n
        Number of entities.
    i, j
        (m,) int32 with i < j, sorted by i and then j.
    mask
        (m,) unsigned, relation between i and j; 0 where the statements contradict each other on the pair itself.
    starts, statement
        (m + 1,) int64 and (s,) int64: ``statement[starts[p]:starts[p + 1]]`` are the statements about pair p.
    """

    n: int
    i: NDArray[np.int32]
    j: NDArray[np.int32]
    mask: NDArray[Any]
    starts: NDArray[np.int64] = field(repr=False)
    statement: NDArray[np.int64] = field(repr=False)

    def __post_init__(self) -> None:
        freeze(self.i, self.j, self.mask, self.starts, self.statement)

    def __len__(self) -> int:
        return self.i.size

    def statements(self, pair: int) -> list[int]:
        """Return the indices of the statements about pair number `pair`, in order."""
        found: list[int] = self.statement[self.starts[pair] : self.starts[pair + 1]].tolist()
        return found

    def triples(self) -> list[tuple[int, int, int]]:
        """Return ``(i, j, mask)`` as Python ints, the form that `ninefold.encodings` takes."""
        return list(zip(self.i.tolist(), self.j.tolist(), self.mask.tolist(), strict=True))


class Network:
    """Statements over one calculus; add to it, then ask.

    Parameters
    ----------
    calculus
        A `Calculus` or the name of one that comes with ninefold.

    Notes
    -----
    Every entity carries a *sort*, None in calculi whose entities are all alike. It is kept for calculi that will have
    tables by sort; nothing looks at it yet.
    """

    __slots__ = ("_calculus", "_constraints", "_index", "_names", "_sorts", "_statements")

    def __init__(self, calculus: Calculus | str) -> None:
        self._calculus = calculus_named(calculus) if isinstance(calculus, str) else calculus
        if not isinstance(self._calculus, Calculus):
            raise BadInput(f"a network needs a calculus or the name of one, not {quoted(calculus)}")
        self._index: dict[str, int] = {}
        self._sorts: list[str | None] = []
        self._statements: list[Statement] = []
        self._names: dict[int, tuple[str, ...]] = {}
        self._constraints: Constraints | None = None

    @classmethod
    def from_constraints(cls, calculus: Calculus | str, n: int, constraints: Iterable[tuple[int, int, int]]) -> Network:
        """Make a network of entities ``"0"`` to ``"n-1"`` from triples (i, j, mask)."""
        net = cls(calculus)
        for k in range(n):
            net.add_entity(k)
        for i, j, mask in constraints:
            if not (0 <= i < n and 0 <= j < n):
                raise BadInput(f"constraint ({i}, {j}) is not between entities 0 to {n - 1}")
            net.add(str(i), str(j), mask)
        return net

    @property
    def calculus(self) -> Calculus:
        """The calculus of all statements."""
        return self._calculus

    @property
    def entities(self) -> tuple[str, ...]:
        """Names in the order of their indices."""
        return tuple(self._index)

    @property
    def sorts(self) -> tuple[str | None, ...]:
        """Sort of every entity, in the order of their indices."""
        return tuple(self._sorts)

    @property
    def statements(self) -> tuple[Statement, ...]:
        """All statements, in the order in which they were added."""
        return tuple(self._statements)

    @property
    def n_entities(self) -> int:
        """Number of entities."""
        return len(self._index)

    @property
    def n_statements(self) -> int:
        """Number of statements."""
        return len(self._statements)

    def index(self, name: str | int) -> int:
        """Return the index of an entity.

        Raises
        ------
        UnknownName
            No statement speaks of it; near names are suggested.
        """
        key = _entity(name)
        if key not in self._index:
            raise UnknownName("entity", key, self._index)
        return self._index[key]

    def add_entity(self, name: str | int, *, sort: str | None = None) -> int:
        """Make sure that an entity is there, related to anything or not, and return its index.

        Raises
        ------
        BadInput
            Not a name, or the entity is there with another sort.
        """
        key = _entity(name)
        known = self._index.get(key)
        if known is not None:
            if sort is not None and self._sorts[known] != sort:
                raise BadInput(
                    f"entity {quoted(key)} has sort {quoted(self._sorts[known])}; it cannot be {quoted(sort)} as well"
                )
            return known
        return self._new(key, sort)

    def _new(self, key: str, sort: str | None = None) -> int:
        self._index[key] = len(self._sorts)
        self._sorts.append(sort)
        self._constraints = None
        return len(self._sorts) - 1

    def add(
        self,
        a: str | int,
        b: str | int,
        relations: str | int | Iterable[str],
        label: str | None = None,
        weight: float | None = None,
    ) -> Statement:
        """State that a is related to b by one of `relations`.

        Parameters
        ----------
        a, b
            Names of entities, without the spaces around them; new ones are added.
        relations
            Names in one string or several, or a mask; see `Calculus.relation`.
        label
            A name for the statement, used in explanations.
        weight
            What it costs to drop it in a repair: not negative, `math.inf` for hard, None for 1.

        Raises
        ------
        UnknownName
            A relation that the calculus does not have.
        BadInput
            An empty set of relations, an entity related to itself by a set without equality, or a weight or name that
            cannot be. The network is then as it was.

        Examples
        --------
        >>> Network("rcc8").add("park", "lake", "contains covers").mask
        96
        """
        key_a, key_b = _entity(a), _entity(b)
        mask = self._calculus.relation(relations)
        if not mask:
            raise BadInput(f"the statement about {quoted(key_a)} and {quoted(key_b)} allows no relation at all")
        if key_a == key_b and not mask & self._calculus.identity:
            equal, said = self._calculus.text(self._calculus.identity), self._calculus.text(mask)
            raise BadInput(f"{quoted(key_a)} cannot be {said} of itself: without {equal} no entity is related to itself")
        if label is not None:
            if not isinstance(label, str) or not label.strip():
                raise BadInput(f"a label is a non-empty string or None, not {quoted(label)}")
            label = label.strip()
        cost = checked_weight(weight)
        names = self._names.get(mask)
        if names is None:
            names = self._names[mask] = tuple(self._calculus.names(mask))
        for key in (key_a, key_b):
            if key not in self._index:
                self._new(key)
        statement = Statement(key_a, names, key_b, label, cost, index=len(self._statements), mask=mask)
        self._statements.append(statement)
        self._constraints = None
        return statement

    def stated(self, a: str | int, b: str | int) -> int:
        """Return what the statements about a and b, taken alone, leave between them; the universal relation if none.

        Raises
        ------
        UnknownName
            An entity that is not in the network.
        """
        i, j = self.index(a), self.index(b)
        if i == j:
            return self._calculus.identity
        pairs = self.constraints()
        low, high = min(i, j), max(i, j)
        keys = pairs.i.astype(np.int64) * pairs.n + pairs.j
        at = int(np.searchsorted(keys, low * pairs.n + high))
        if at == keys.size or keys[at] != low * pairs.n + high:
            return self._calculus.universal
        mask = int(pairs.mask[at])
        return mask if i < j else self._calculus.converse_of(mask)

    def constraints(self) -> Constraints:
        """Return the statements as arrays, intersected pair by pair; made once and kept until the next change.

        Statements of an entity about itself say nothing and have no pair.

        Complexity
        ----------
        O(s log s) for s statements.
        """
        if self._constraints is None:
            self._constraints = self._intersect()
        return self._constraints

    def _intersect(self) -> Constraints:
        index, n = self._index, len(self._index)
        dtype = self._calculus.base_composition.dtype
        s = len(self._statements)
        a = np.fromiter((index[x.a] for x in self._statements), dtype=np.int64, count=s)
        b = np.fromiter((index[x.b] for x in self._statements), dtype=np.int64, count=s)
        mask = np.fromiter((x.mask for x in self._statements), dtype=dtype, count=s)
        turned = np.flatnonzero(a > b)
        table = self._calculus.converse_table
        if table is not None:
            mask[turned] = table[mask[turned]]
        else:
            mask[turned] = [self._calculus.converse_of(m) for m in mask[turned].tolist()]
        key = np.minimum(a, b) * n + np.maximum(a, b)
        order = np.argsort(key, kind="stable")
        order = order[(a != b)[order]]
        key = key[order]
        first = np.flatnonzero(np.diff(key, prepend=-1))
        starts = np.append(first, key.size).astype(np.int64)
        i, j = (key[first] // max(n, 1)).astype(np.int32), (key[first] % max(n, 1)).astype(np.int32)
        meet = np.bitwise_and.reduceat(mask[order], first) if first.size else np.zeros(0, dtype=dtype)
        arrays = (i, j, meet, starts, order.astype(np.int64))
        for array in arrays:
            array.flags.writeable = False
        return Constraints(n, *arrays)

    def subset(self, keep: Iterable[int]) -> Network:
        """Return a network of the same entities with only the statements of these indices, in their old order.

        The statements are numbered anew; equal to dropping all others.

        Raises
        ------
        BadInput
            An index that no statement has.
        """
        chosen = sorted(set(keep))
        if chosen and not 0 <= chosen[0] <= chosen[-1] < len(self._statements):
            raise BadInput(f"statements are numbered 0 to {len(self._statements) - 1}; {chosen[0]} to {chosen[-1]} asked")
        net = Network(self._calculus)
        net._index = dict(self._index)
        net._sorts = list(self._sorts)
        for at, k in enumerate(chosen):
            old = self._statements[k]
            net._statements.append(replace(old, index=at))
        return net

    def copy(self) -> Network:
        """Return a network that can be changed without changing this one."""
        return self.subset(range(len(self._statements)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Network):
            return NotImplemented
        return (
            self._calculus == other._calculus
            and self.entities == other.entities
            and self._sorts == other._sorts
            and self._statements == other._statements
        )

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        entities, statements = counted(self.n_entities, "entity", "entities"), counted(self.n_statements, "statement")
        return f"Network({self._calculus.name}, {entities}, {statements})"


def require_network(given: object) -> None:
    """Say what to call instead, unless a network was given.

    Raises
    ------
    BadInput
        For a path, something that holds a network, or anything else.
    """
    if isinstance(given, Network):
        return
    if isinstance(given, str | PathLike):
        raise BadInput(
            f"a Network is needed, and {quoted(str(given))} is text; read_network({quoted(str(given))}) reads a file"
        )
    if isinstance(getattr(given, "network", None), Network):
        raise BadInput(f"a Network is needed, not {quoted(given)}; give its .network")
    raise BadInput(f"a Network is needed, not {quoted(given)}; Network('rcc8') begins one, read_network reads one")


def _entity(name: str | int) -> str:
    if isinstance(name, str) and name.strip():
        return name.strip()
    if isinstance(name, int | np.integer) and not isinstance(name, bool):
        return str(name)
    raise BadInput(f"an entity is named by a non-empty string or an integer, not {quoted(name)}")
