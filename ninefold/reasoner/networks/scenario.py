"""A scenario: one base relation on every pair of entities, all at once possible.

Examples
--------
>>> from ninefold.reasoner.networks.network import Network
>>> from ninefold.reasoner.networks.enumeration import scenarios
>>> net = Network("rcc8")
>>> _ = net.add("kitchen", "house", "inside")
>>> _ = net.add("house", "garden", "meet")
>>> scenario = next(scenarios(net))
>>> scenario.relation("kitchen", "garden"), scenario.relation("house", "kitchen")
('DC', 'NTPPi')
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold.errors import BadInput, UnknownName

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.encodings.calculus import Calculus

    from .completion import Completion
    from .network import Network

__all__ = ["Scenario"]


@dataclass(frozen=True, slots=True, eq=False, repr=False, init=False)
class Scenario:
    """Base relations of all pairs.

    Parameters
    ----------
    bases
        (n, n) indices of base relations.

    Attributes
    ----------
    calculus, entities
        The calculus, and the names in order.

    Notes
    -----
    The scenario of a sparse network keeps the relations of a chordal completion. Those of other pairs follow when they are
    asked for, the same whatever was asked before, so that ten thousand entities need no table of all pairs; `bases` makes
    it.
    """

    calculus: Calculus
    entities: tuple[str, ...]
    _completion: Completion | None
    _bases: NDArray[np.uint8] | None

    def __init__(self, calculus: Calculus, entities: tuple[str, ...], bases: NDArray[Any]) -> None:
        n = len(entities)
        table = np.array(bases, dtype=np.uint8)
        if table.shape != (n, n):
            raise BadInput(f"a scenario of {n} entities has an ({n}, {n}) array of base relations, not {table.shape}")
        if table.size and int(table.max()) >= calculus.n_bases:
            raise BadInput(f"base relation {int(table.max())} is not one of the {calculus.n_bases} of the calculus")
        table.flags.writeable = False
        self._put(calculus, entities, None, table)

    def _put(
        self,
        calculus: Calculus,
        entities: tuple[str, ...],
        completion: Completion | None,
        bases: NDArray[np.uint8] | None,
    ) -> None:
        put = object.__setattr__  # the dataclass is frozen for everybody else
        put(self, "calculus", calculus)
        put(self, "entities", tuple(entities))
        put(self, "_completion", completion)
        put(self, "_bases", bases)

    @classmethod
    def from_completion(cls, completion: Completion, entities: tuple[str, ...]) -> Scenario:
        """Make a scenario of the base relations on a chordal completion, whose entities have these names."""
        if completion.frame.n != len(entities):
            raise BadInput(f"the completion is of {completion.frame.n} entities, not of {len(entities)}")
        scenario = cls.__new__(cls)
        scenario._put(completion.calculus, entities, completion, None)
        return scenario

    @property
    def bases(self) -> NDArray[np.uint8]:
        """(n, n) uint8, read-only: ``bases[i, j]`` is the index of the base relation of entity i to entity j."""
        if self._bases is None:
            assert self._completion is not None  # noqa: S101 - one of the two is always there
            table = self._completion.table()
            table.flags.writeable = False
            object.__setattr__(self, "_bases", table)
        assert self._bases is not None  # noqa: S101 - made above
        return self._bases

    @classmethod
    def from_labels(cls, calculus: Calculus, entities: tuple[str, ...], labels: NDArray[Any]) -> Scenario:
        """Make a scenario of an (n, n) array of masks with one bit each; the diagonal is equality."""
        masks = labels.astype(np.uint64)
        np.fill_diagonal(masks, calculus.identity & -calculus.identity)
        if not ((masks != 0) & (masks & (masks - np.uint64(1)) == 0)).all():
            raise BadInput("some pair of the scenario has no single base relation")
        bases = np.zeros(masks.shape, dtype=np.uint8)
        for k in range(calculus.n_bases):
            bases[masks == np.uint64(1 << k)] = k
        return cls(calculus, entities, bases)

    def _index(self, name: str | int) -> int:
        key = str(name).strip()
        if key not in self.entities:
            raise UnknownName("entity", key, self.entities)
        return self.entities.index(key)

    def _base(self, i: int, j: int) -> int:
        if self._bases is None and self._completion is not None:
            return self._completion.base(i, j)
        return int(self.bases[i, j])

    def mask(self, a: str | int, b: str | int) -> int:
        """Return the relation of a to b as a mask of one bit."""
        return 1 << self._base(self._index(a), self._index(b))

    def relation(self, a: str | int, b: str | int) -> str:
        """Return the name of the base relation of a to b."""
        return self.calculus.bases[self._base(self._index(a), self._index(b))]

    def triples(self) -> list[tuple[str, str, str]]:
        """Return (a, b, name of relation) for every pair, a before b in the order of the entities."""
        names, n = self.calculus.bases, len(self.entities)
        rows = self.bases.tolist()
        return [
            (self.entities[i], self.entities[j], names[rows[i][j]]) for i in range(n) for j in range(i + 1, n)
        ]  # fmt: skip

    def satisfies(self, net: Network) -> bool:
        """Tell whether every statement of a network over (some of) these entities holds.

        Raises
        ------
        BadInput
            The network is of another calculus.
        UnknownName
            It speaks of an entity that the scenario does not have.
        """
        if net.calculus != self.calculus:
            raise BadInput(f"a scenario of {self.calculus.name} says nothing of a network of {net.calculus.name}")
        place = {name: k for k, name in enumerate(self.entities)}
        for name in net.entities:
            if name not in place:
                raise UnknownName("entity", name, self.entities)
        return all(s.mask >> self._base(place[s.a], place[s.b]) & 1 for s in net.statements)

    def is_closed(self) -> bool:
        """Tell whether every triangle agrees with the composition table, and every pair with its converse.

        Complexity
        ----------
        O(n^3), a plane of n^2 at a time.
        """
        bases, calculus = self.bases, self.calculus
        if (calculus.base_converse[bases] != bases.T).any():
            return False
        if not all(calculus.identity >> int(k) & 1 for k in np.diagonal(bases)):
            return False
        table, bit = calculus.base_composition.astype(np.uint64), np.uint64(1) << bases.astype(np.uint64)
        return all((table[bases[:, [k]], bases[[k], :]] & bit).all() for k in range(len(bases)))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scenario):
            return NotImplemented
        same = self.calculus == other.calculus and self.entities == other.entities
        return same and bool((self.bases == other.bases).all())

    def __hash__(self) -> int:
        return hash((self.entities, self.bases.tobytes()))

    def __reduce__(self) -> tuple[Any, ...]:
        return (_scenario, (self.calculus, self.entities, self._completion, self._bases))

    def __repr__(self) -> str:
        n = len(self.entities)
        first = [(0, j) for j in range(1, min(n, 4))] + ([(1, 2)] if n == 3 else [])  # fmt: skip
        said = [f"{self.entities[i]} {self.calculus.bases[self._base(i, j)]} {self.entities[j]}" for i, j in first]
        more = ["..."] if n * (n - 1) // 2 > len(first) else []
        return f"Scenario({self.calculus.name}, {n} entities: {', '.join([*said, *more]) or 'no pair'})"

    def __str__(self) -> str:
        return "\n".join(f"{a} {r} {b}" for a, b, r in self.triples())


def _scenario(
    calculus: Calculus, entities: tuple[str, ...], completion: Completion | None, bases: NDArray[np.uint8] | None
) -> Scenario:
    """Make a scenario again from its parts, as pickles and copies need it."""
    if completion is not None:
        return Scenario.from_completion(completion, entities)
    assert bases is not None  # noqa: S101 - one of the two is always there
    return Scenario(calculus, entities, bases)
