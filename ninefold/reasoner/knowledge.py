"""What was mapped and what was said, in one network.

The relations of mapped regions are computed from the map and hard; statements speak of them, and of things that were
never mapped. Where the two contradict each other, the conflict names the statements, and as few of them as possible: what
the map says is tried first.

Examples
--------
>>> from ninefold.mapping import PlaneMap
>>> from ninefold.reasoner.knowledge import KnowledgeBase
>>> plane = PlaneMap.from_geometry([(0, 0), (1, 0), (1, 1), (0, 1)], [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)])
>>> base = KnowledgeBase(plane, {"plant": plane.cycle([0, 1, 2]), "block 12": plane.cycle([0, 2, 3])},
...                      [("boiler room", "plant", "inside"), ("boiler room", "block 12", "meet", "hearsay")])
>>> print(base.contradiction())
What was said contradicts the map.
said: boiler room inside plant
said: boiler room meets block 12 (hearsay)
mapped: plant meets block 12
boiler room inside plant, plant meets block 12 (mapped), so boiler room disjoint block 12; but boiler room meets ...
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from ninefold._wording import quoted
from ninefold.encodings.rcc8 import RCC8
from ninefold.errors import BadInput, DifferentMaps
from ninefold.mapping.sets import Region

from .networks.conflicts import Conflict, conflict
from .networks.consistency import check
from .networks.explanation import explain
from .networks.inference import Inference, infer
from .networks.network import Network
from .networks.questions import Answer, ask
from .networks.statement import Statement
from .networks.words import phrase
from .sets.bulk import relate_all
from .sets.relation import RCC8_OF_NAME, names_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from ninefold.mapping import PlaneMap, Set

    from .networks.consistency import Consistent, Inconsistent, Unknown

__all__ = ["MAPPED", "Contradiction", "KnowledgeBase"]

MAPPED = "mapped"
"""Label of the statements that come from the map."""


class HasSets(Protocol):
    """What `KnowledgeBase.from_atlas` needs of an atlas."""

    @property
    def plane(self) -> PlaneMap: ...
    @property
    def sets(self) -> Mapping[str, Set]: ...
    @property
    def statements(self) -> tuple[Statement, ...]: ...


@dataclass(frozen=True, slots=True)
class Contradiction:
    """Why what was said cannot be.

    Attributes
    ----------
    conflict
        The minimal conflict, statements of the map and declared ones.
    said, mapped
        Its two parts; without the second, what was said contradicts itself.
    """

    conflict: Conflict
    said: tuple[Statement, ...]
    mapped: tuple[Statement, ...]

    def __str__(self) -> str:
        against = "the map" if self.mapped else "itself"
        lines = [f"What was said contradicts {against}."]
        for kind, statements in (("said", self.said), ("mapped", self.mapped)):
            for s in statements:
                label = f" ({s.label})" if s.label and kind == "said" else ""
                lines.append(f"{kind}: {phrase(RCC8, s.a, s.mask, s.b)}{label}")
        return "\n".join([*lines, str(explain(self.conflict))])


class KnowledgeBase:
    """Regions of a map, and statements about them and about anything else.

    Parameters
    ----------
    plane
        The map.
    names
        Names to regions of it.
    statements
        Tuples as `Network.add` takes them, ``(a, b, relations)`` and perhaps a label and a weight; or `Statement` values,
        of a network or of an atlas; or an RCC-8 network. Relations in Egenhofer's words or RCC-8's.

    Attributes
    ----------
    plane, names
        As given.
    network
        Everything in one network: mapped statements first, hard and labelled `MAPPED`, then the declared ones.

    Raises
    ------
    BadInput
        A name for something that is no region, or a statement that cannot be.
    DifferentMaps
        A region of another map.

    Complexity
    ----------
    n^2 relations for n regions.
    """

    __slots__ = ("_n_mapped", "names", "network", "plane")

    def __init__(
        self,
        plane: PlaneMap,
        names: Mapping[str, Region],
        statements: Iterable[Statement | tuple[object, ...]] | Network = (),
    ) -> None:
        self.plane = plane
        self.names = dict(names)
        self.network = Network(RCC8)
        for name, region in self.names.items():
            if not isinstance(region, Region):
                raise BadInput(
                    f"{quoted(name)} is {quoted(region)}; only regions have RCC-8 relations, so only they "
                    "can be reasoned about"
                )
            if region.plane is not plane and region.plane != plane:
                raise DifferentMaps(f"{quoted(name)} is a region of {quoted(region.plane)}, not of {quoted(plane)}")
            self.network.add_entity(name)
        self._state_map()
        self._n_mapped = self.network.n_statements
        if isinstance(statements, Network) and statements.calculus != RCC8:
            raise BadInput(f"what is said about regions has to be in rcc8; this network is in {statements.calculus.name}")
        for s in statements.statements if isinstance(statements, Network) else statements:
            self._say(s)

    def _state_map(self) -> None:
        names = list(self.names)
        if len(names) < 2:
            return
        words = names_of(relate_all(list(self.names.values())))
        for i, j in zip(*np.triu_indices(len(names), 1), strict=True):
            self.network.add(names[i], names[j], RCC8_OF_NAME[str(words[i, j])], MAPPED, math.inf)

    @classmethod
    def from_atlas(cls, atlas: HasSets) -> KnowledgeBase:
        """Make one of the regions and the statements of an atlas; its points and lines are left out.

        Raises
        ------
        BadInput
            A statement about a stored point or line: RCC-8 has no relation for it.
        """
        sets = dict(atlas.sets)
        regions = {name: x for name, x in sets.items() if isinstance(x, Region)}
        for s in atlas.statements:
            for name in (s.a, s.b):
                if name in sets and name not in regions:
                    raise BadInput(
                        f"{quoted(name)} is {quoted(sets[name])}; statements can be reasoned about between regions only"
                    )
        return cls(atlas.plane, regions, atlas.statements)

    def _say(self, s: Statement | tuple[object, ...]) -> None:
        if isinstance(s, Statement):
            self.network.add(s.a, s.b, s.relations, s.label, s.weight)
            return
        if not isinstance(s, tuple | list) or not 3 <= len(s) <= 5:
            raise BadInput(f"a statement is (a, b, relations) and perhaps a label and a weight, not {quoted(s)}")
        self.network.add(*s)  # type: ignore[arg-type]

    def say(
        self, a: str, b: str, relations: str, label: str | None = None, weight: float | None = None
    ) -> Statement:  # fmt: skip
        """Add a statement; see `Network.add`."""
        return self.network.add(a, b, relations, label, weight)

    @property
    def mapped(self) -> tuple[Statement, ...]:
        """The statements that come from the map."""
        return self.network.statements[: self._n_mapped]

    @property
    def said(self) -> tuple[Statement, ...]:
        """The declared statements."""
        return self.network.statements[self._n_mapped :]

    def check(self, *, budget: float | None = None, seed: int = 0) -> Consistent | Inconsistent | Unknown:
        """Tell whether what was said can be true on this map."""
        return check(self.network, budget=budget, seed=seed)

    def contradiction(self, *, seed: int = 0) -> Contradiction | None:
        """Return why what was said cannot be true, or None if it can."""
        found = conflict(self.network, seed=seed)
        if found is None:
            return None
        said = tuple(s for s in found if s.index >= self._n_mapped)
        return Contradiction(found, said, tuple(s for s in found if s.index < self._n_mapped))

    def infer(self, a: str, b: str, *, seed: int = 0) -> Inference:
        """Return the relations of a to b that the map and what was said leave; see `ninefold.reasoner.infer`."""
        return infer(self.network, a, b, seed=seed)

    def ask(self, formula: str, *, seed: int = 0) -> Answer:
        """Answer a Boolean question; see `ninefold.reasoner.networks.questions`."""
        return ask(self.network, formula, seed=seed)

    def __repr__(self) -> str:
        return f"KnowledgeBase({len(self.names)} regions mapped, {len(self.said)} statements)"
