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

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold.errors import BadInput, UnknownName

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.encodings.calculus import Calculus

    from .network import Network

__all__ = ["Scenario"]


@dataclass(frozen=True, slots=True, eq=False)
class Scenario:
    """Base relations of all pairs.

    Attributes
    ----------
    calculus, entities
        The calculus, and the names in order.
    bases
        (n, n) uint8, read-only: ``bases[i, j]`` is the index of the base relation of entity i to entity j.
    """

    calculus: Calculus
    entities: tuple[str, ...]
    bases: NDArray[np.uint8] = field(repr=False)

    def __post_init__(self) -> None:
        n = len(self.entities)
        bases = np.array(self.bases, dtype=np.uint8)
        if bases.shape != (n, n):
            raise BadInput(f"a scenario of {n} entities has an ({n}, {n}) array of base relations, not {bases.shape}")
        if bases.size and int(bases.max()) >= self.calculus.n_bases:
            raise BadInput(f"base relation {int(bases.max())} is not one of the {self.calculus.n_bases} of the calculus")
        bases.flags.writeable = False
        object.__setattr__(self, "bases", bases)

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

    def mask(self, a: str | int, b: str | int) -> int:
        """Return the relation of a to b as a mask of one bit."""
        return 1 << int(self.bases[self._index(a), self._index(b)])

    def relation(self, a: str | int, b: str | int) -> str:
        """Return the name of the base relation of a to b."""
        return self.calculus.bases[int(self.bases[self._index(a), self._index(b)])]

    def triples(self) -> list[tuple[str, str, str]]:
        """Return (a, b, name of relation) for every pair, a before b in the order of the entities."""
        names, n = self.calculus.bases, len(self.entities)
        rows = self.bases.tolist()
        return [
            (self.entities[i], self.entities[j], names[rows[i][j]]) for i in range(n) for j in range(i + 1, n)
        ]  # fmt: skip

    def satisfies(self, net: Network) -> bool:
        """Tell whether every statement of a network over (some of) these entities holds."""
        place = {name: k for k, name in enumerate(self.entities)}
        return all(s.mask >> int(self.bases[place[s.a], place[s.b]]) & 1 for s in net.statements)

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

    def __str__(self) -> str:
        return "\n".join(f"{a} {r} {b}" for a, b, r in self.triples())
