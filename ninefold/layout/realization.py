"""Geometry for a scenario: regions of the plane that are related exactly as it says, confirmed by GEOS pair by pair.

The drawing is the cell-pair model (`ninefold.encodings.model`) made visible. An *island* is a square cut in two by a
vertical centre line; on it every region holds the left half, the right half, both or nothing. The half of a region reaches
``r`` away from the island's centre, r being 1 plus the longest chain of proper parts below it: so a proper part stays
clear of the whole's outer border, and regions with the same half, or with opposite ones, still meet on the centre line.
All coordinates are whole numbers.

Each base relation asks that somewhere, on some island, two regions hold certain halves and lack others. (That the whole
has more than a proper part is no demand: it reaches further wherever the part is.) An island made for one demand is closed
upward: TPP and EQ pass a half on to the larger region, NTPP gives it both halves. Islands are
then laid over one another, mirrored if that helps, wherever no relation is broken and no demand lost: a hundred regions
need dozens of islands, not thousands.

Examples
--------
>>> from ninefold.layout.realization import realize
>>> from ninefold.reasoner.networks.network import Network
>>> from ninefold.reasoner.networks.enumeration import scenarios
>>> net = Network("rcc8")
>>> _ = net.add("kitchen", "house", "inside")
>>> shapes = realize(next(scenarios(net)))
>>> shapes["house"].contains_properly(shapes["kitchen"])
True

References
----------
J. Renz, "A canonical model of the region connection calculus", Journal of Applied Non-Classical Logics 12, 2002.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import quoted
from ninefold.encodings.model import matches
from ninefold.encodings.rcc8 import RCC8
from ninefold.encodings.theory import theory_of
from ninefold.errors import BadInput, NinefoldError
from ninefold.reasoner.networks.scenario import Scenario
from ninefold.reasoner.sets.relation import RCC8_OF_NAME, Relation

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ninefold.encodings.model import BaseMeaning

__all__ = ["realize"]

LEFT, RIGHT, BOTH = 1, 2, 3
_MIRRORED = np.array([0, RIGHT, LEFT, BOTH], dtype=np.uint8)
_MORE = ("0.1.", "1.0.")
"""One region holds a cell that the other lacks."""

_COARSE = {"DC": "DR", "EC": "DR", "TPP": "PP", "NTPP": "PP", "TPPi": "PPi", "NTPPi": "PPi"}
"""RCC-5 names of what GEOS tells apart further."""


def realize(scenario: Scenario) -> dict[str, Any]:
    """Return a shapely geometry for every entity, so that every pair is related as the scenario says.

    Parameters
    ----------
    scenario
        A scenario of RCC-8 or RCC-5.

    Returns
    -------
    Names to polygons and multipolygons with integer coordinates, in the order of the entities. Regions may be in pieces.

    Raises
    ------
    BadInput
        The calculus is not one of regions, or the scenario is not consistent.
    NinefoldError
        GEOS sees another relation than the scenario has. That would be an error of this module.

    Complexity
    ----------
    With k islands and d demands O(d k n) to lay the islands, and n^2 / 2 calls of GEOS.
    """
    if not isinstance(scenario, Scenario):
        raise BadInput(_not_a_scenario(scenario))
    known = theory_of(scenario.calculus).model
    if known is None:
        raise BadInput(f"only regions can be drawn: scenarios of rcc8 and rcc5, not of {scenario.calculus.name}")
    if not scenario.is_closed():
        raise BadInput("some triangle of the scenario contradicts the composition table, so nothing can be drawn")
    relations = _Relations(scenario, known.value)
    states = _Islands(relations).lay()
    places, radii = _places(states, relations.radius), relations.radius
    shapes = {
        name: _shape(states[:, k], int(radii[k]), places) for k, name in enumerate(scenario.entities)
    }  # fmt: skip
    _confirm(scenario, list(shapes.values()))
    return shapes


def _not_a_scenario(given: object) -> str:
    from ninefold.reasoner.networks.consistency import Consistent, Inconsistent, Unknown

    if isinstance(given, Inconsistent | Unknown):
        return f"realize takes the scenario of a consistent network, and this verdict is {quoted(given)}: it has none"
    call = "verdict.scenario" if isinstance(given, Consistent) else "check(network).scenario"
    return f"realize takes a scenario, not {quoted(given)}; call realize({call})"


class _Relations:
    """A scenario as matrices, x by y."""

    def __init__(self, scenario: Scenario, model: tuple[BaseMeaning, ...]) -> None:
        self.n = len(scenario.entities)
        self.bases = scenario.bases
        self.model = model
        self.passes_half = self._where("TPP", "PP", "EQ")
        self.passes_both = self._where("NTPP")
        self.no_point = self._where("DC")
        self.no_cell = self._where("EC", "DR")
        np.fill_diagonal(self.passes_half, True)
        self.proper = self._where("TPP", "NTPP", "PP")
        self.radius = self._radii()

    def _where(self, *names: str) -> NDArray[np.bool_]:
        wanted = [k for k, meaning in enumerate(self.model) if meaning.name in names]
        return np.isin(self.bases, wanted)

    def _radii(self) -> NDArray[np.int64]:
        """One plus the longest chain of proper parts below each region; being one is transitive, so direct ones suffice."""
        radius = np.ones(self.n, dtype=np.int64)
        parts = self.proper
        for y in np.argsort(parts.sum(axis=0), kind="stable").tolist():
            below = parts[:, y]
            if below.any():
                radius[y] = 1 + int(radius[below].max())
        return radius

    def closed_upward(self, seed: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Return the least states (n,) that hold `seed` and break no parthood."""
        grown = np.zeros(self.n, dtype=np.uint8)
        for x in np.flatnonzero(seed).tolist():
            grown[self.passes_half[x]] |= seed[x]
            grown[self.passes_both[x]] = BOTH
        return grown

    def forbidden(self, states: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """Return which halves (n,) no region may hold beside these states."""
        barred = np.zeros(self.n, dtype=np.uint8)
        barred[self.no_point[states > 0].any(axis=0)] = BOTH
        for half in (LEFT, RIGHT):
            barred[self.no_cell[(states & half) > 0].any(axis=0)] |= half
        return barred


@dataclass(slots=True)
class _Island:
    """States on one island and the demands, as rows (x, y, pattern), that it has to go on meeting."""

    states: NDArray[np.uint8]
    kept: list[tuple[int, int, str]] = field(default_factory=list)


class _Islands:
    """Lays islands until every demand is met."""

    def __init__(self, relations: _Relations) -> None:
        self._relations = relations
        self._islands: list[_Island] = []
        self._states = np.zeros((0, relations.n), dtype=np.uint8)

    def lay(self) -> NDArray[np.uint8]:
        """Return the (k, n) states of all islands."""
        for demand in self._demands():
            self._meet(demand)
        for x in range(self._relations.n):
            if not self._states[:, x].any():
                self._add((x, x, "1..."), self._seeded((x, x, "1...")))
        return self._states

    def _demands(self) -> list[tuple[int, int, str]]:
        """Return what every pair has to show somewhere; what needs many regions comes first."""
        proper = self._relations.proper
        found = [
            (x, y, pattern)
            for x in range(self._relations.n)
            for y in range(x + 1, self._relations.n)
            for pattern in self._relations.model[int(self._relations.bases[x, y])].somewhere
            if pattern not in _MORE or not (proper[x, y] or proper[y, x])
        ]
        size = {demand: int((self._seeded(demand) > 0).sum()) for demand in found}
        return sorted(found, key=lambda demand: -size[demand])

    def _seeded(self, demand: tuple[int, int, str]) -> NDArray[np.uint8]:
        """Return the least island on which a demand can be met."""
        x, y, pattern = demand
        seed = np.zeros(self._relations.n, dtype=np.uint8)
        for region, cells in ((x, pattern[:2]), (y, pattern[2:])):
            seed[region] |= (cells[0] == "1") * LEFT | (cells[1] == "1") * RIGHT
        return self._relations.closed_upward(seed)

    def _meet(self, demand: tuple[int, int, str]) -> None:
        x, y, pattern = demand
        shown = matches(pattern, either_way=True)[self._states[:, x], self._states[:, y]]
        if shown.any():
            self._islands[int(np.flatnonzero(shown)[0])].kept.append(demand)
            return
        least = self._seeded(demand)
        for states in (least, _MIRRORED[least]):
            barred = self._relations.forbidden(states)
            for at in np.flatnonzero(~(self._states & barred).any(axis=1)).tolist():
                island = self._islands[at]
                merged = island.states | states
                if all(_shown(merged, kept) for kept in (demand, *island.kept)):
                    island.states = self._states[at] = merged
                    island.kept.append(demand)
                    return
        self._add(demand, least)

    def _add(self, demand: tuple[int, int, str], states: NDArray[np.uint8]) -> None:
        self._islands.append(_Island(states, [demand]))
        self._states = np.concatenate([self._states, states[np.newaxis]])


def _shown(states: NDArray[np.uint8], demand: tuple[int, int, str]) -> bool:
    x, y, pattern = demand
    return bool(matches(pattern, either_way=True)[states[x], states[y]])


def _places(states: NDArray[np.uint8], radius: NDArray[np.int64]) -> list[tuple[int, int]]:
    """Return a centre for each island, in rows of a sheet half again as wide as tall, with a gap of 2 between islands."""
    reach = [int(radius[row > 0].max()) for row in states]
    width = max(int(np.ceil((1.6 * sum((2 * r + 2) ** 2 for r in reach)) ** 0.5)), 1)
    centres: list[tuple[int, int]] = [(0, 0)] * len(reach)
    x = y = tallest = 0
    for at in sorted(range(len(reach)), key=lambda k: -reach[k]):
        side = 2 * reach[at] + 2
        if x and x + side - 2 > width:
            x, y, tallest = 0, y - tallest, 0
        centres[at] = (x + reach[at], y - reach[at])
        x, tallest = x + side, max(tallest, side)
    return centres


def _shape(states: NDArray[np.uint8], r: int, places: list[tuple[int, int]]) -> Any:
    import shapely

    boxes = [
        shapely.box(x - r * bool(state & LEFT), y - r, x + r * bool(state & RIGHT), y + r)
        for state, (x, y) in zip(states.tolist(), places, strict=True)
        if state
    ]
    return boxes[0] if len(boxes) == 1 else shapely.MultiPolygon(boxes)


def _confirm(scenario: Scenario, shapes: list[Any]) -> None:
    """Ask GEOS about every pair."""
    import shapely

    i, j = np.triu_indices(len(shapes), 1)
    array = np.array(shapes, dtype=object)
    seen = shapely.relate(array[i], array[j])
    fine = scenario.calculus == RCC8
    for a, b, matrix in zip(i.tolist(), j.tolist(), seen.tolist(), strict=True):
        name = RCC8_OF_NAME[Relation.from_de9im(matrix).name]
        found = name if fine else _COARSE.get(name, name)
        wanted = scenario.calculus.bases[int(scenario.bases[a, b])]
        if found != wanted:
            pair = f"{quoted(scenario.entities[a])} and {quoted(scenario.entities[b])}"
            raise NinefoldError(f"the drawing of {pair} is {found} by GEOS and {wanted} in the scenario; please report this")
