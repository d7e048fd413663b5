"""Closing residuals, the health of a map: how well the headings at the two ends of every edge agree with its turn.

An edge leaves one place at a heading, turns by what was measured along it, and arrives at the reverse of its heading at the
other place. The residual is what is left: `wrap(heading[2e+1] - pi - heading[2e] - turn[e])`. It is nought for an edge
passed once, whose turn is the difference of its own headings; it shows sensors that err once an edge was passed again, or
where the turn was measured by another sensor than the headings.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import counted
from ninefold.errors import BadInput
from ninefold.immutable import Immutable, frozen_copy

from .turning import edge_residual

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .plane import PlaneMap

__all__ = ["PERFECT", "Health", "health"]

PERFECT = 0.01
"""Degrees below which a residual is not worth naming an edge for."""

_NAMED = 3


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Health(Immutable):
    """How well headings and turns of a map agree.

    Attributes
    ----------
    plane
        The map.
    residual
        (E,) float64, degrees in [-180, 180], counter-clockwise positive; NaN for tethers.
    """

    plane: PlaneMap
    residual: NDArray[np.float64]

    def __post_init__(self) -> None:
        object.__setattr__(self, "residual", frozen_copy(self.residual))

    @property
    def n_edges(self) -> int:
        """Number of edges that have a residual."""
        return int(np.count_nonzero(~np.isnan(self.residual)))

    def within(self, share: float) -> float:
        """Return the degrees within which that share of the edges agree, such as 0.5 for the median; 0 without edges."""
        sizes = np.abs(self.residual[~np.isnan(self.residual)])
        return float(np.quantile(sizes, share)) if sizes.size else 0.0

    @property
    def worst(self) -> tuple[tuple[str, float], ...]:
        """At most three edges with the largest residuals, by name, each with its size in degrees; none below `PERFECT`."""
        sizes = np.where(np.isnan(self.residual), -1.0, np.abs(self.residual))
        order = np.argsort(-sizes, kind="stable")[:_NAMED].tolist()
        return tuple((self.plane.edge_names[e], float(sizes[e])) for e in order if sizes[e] >= PERFECT)

    @property
    def counts(self) -> dict[str, Any]:
        """The numbers, as JSON has them; angles in degrees."""
        return {
            "edges": self.n_edges,
            "median": self.within(0.5),
            "p95": self.within(0.95),
            "largest": self.within(1.0),
            "worst": [{"edge": name, "degrees": size} for name, size in self.worst],
        }

    def __repr__(self) -> str:
        return f"Health({self})"

    def __str__(self) -> str:
        if not self.n_edges:
            return "no leg to judge by"
        if not self.worst:
            largest = self.within(1.0)
            size = f"{largest:.1g} degrees" if largest > 1e-6 else "a millionth of a degree"
            return f"headings and turns agree to within {size} on {counted(self.n_edges, 'leg')}"
        named = ", ".join(f"{name} ({_degrees(size)})" for name, size in self.worst)
        spread = f"half of the legs within {_degrees(self.within(0.5))}, 95 of 100 within {_degrees(self.within(0.95))}"
        return f"headings and turns disagree by up to {_degrees(self.within(1.0))} degrees: {spread}; worst {named}"


def health(plane: PlaneMap) -> Health:
    """Return how well the headings and turns of a map agree, edge by edge.

    Raises
    ------
    BadInput
        For a map without headings.

    Notes
    -----
    Complexity O(E).

    Examples
    --------
    >>> import numpy as np
    >>> from ninefold.mapping import PlaneMap
    >>> right = PlaneMap.from_geometry([(0, 0), (1, 0), (0, 1)], [(0, 1), (1, 2), (2, 0)], edge_names="abc")
    >>> print(health(right))
    headings and turns agree to within a millionth of a degree on 3 legs
    >>> off = np.array(right.heading)
    >>> off[2] += np.radians(1.5)
    >>> print(health(PlaneMap.from_darts(right.tail, right.next_ccw, right.outer, heading=off, turn=right.turn,
    ...                                  edge_names=right.edge_names)))
    headings and turns disagree by up to 1.5 degrees: half of the legs within 0, 95 of 100 within 1.4; worst b (1.5)
    """
    if plane.heading is None or plane.turn is None:
        raise BadInput("the map has no headings, so nothing tells how well they agree")
    residual = np.degrees(edge_residual(plane.heading, plane.turn))
    residual[plane.tether] = np.nan
    return Health(plane, residual)


def _degrees(size: float) -> str:
    return f"{size:.2g}" if size >= PERFECT else f"{size:.1g}" if size > 1e-6 else "0"
