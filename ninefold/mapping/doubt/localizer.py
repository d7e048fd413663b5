"""Where a robot that was switched on somewhere can be: an exact belief over the places of a map, from noisy headings.

The state is the dart that leads back along the way the robot came, or the place alone as long as nothing tells that way.
What is seen at a place weighs the states (``_matching``); walking on moves them. Nothing is decided by guess: all ways in
which the exits seen can be those of a place are added up, and a move by an exit that may be one of two goes both ways.
"""

from __future__ import annotations

from copy import copy
from math import degrees, exp, log, pi
from numbers import Integral
from typing import TYPE_CHECKING, NamedTuple, get_args

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput

from ..heading import TAU, Heading
from ..numbering import Dart
from ..plane import PlaneMap
from ..robot.units import unit_of
from ..robot.walk import HeadingUnit, checked_sigma
from ._ahead import Outlook, expected_left, towards_a_difference
from ._matching import GATE, Look, Noise, weights
from ._nothing_left import Before, empty_belief
from ._outlook import likeliest_exits
from ._sightings import finite, look_of, probability
from ._stars import Stars
from ._within import places_in

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from numpy.typing import NDArray

    from ..sets import Set

__all__ = ["Candidate", "Localizer", "Move"]

CERTAIN = 0.999
"""Probability from which a place counts as certain."""

_FORGOTTEN = log(1e-40)
"""States less likely than this are dropped; nothing that the noise model allows brings one back."""


class Candidate(NamedTuple):
    """A place where the robot can be.

    Attributes
    ----------
    vertex
        Name of the place.
    dart
        The dart that leads back along the way it came; None where nothing tells it, as before the first move.
    probability
        Of this place and this way back.
    """

    vertex: str
    dart: Dart | None
    probability: float


class Move(NamedTuple):
    """A way to go on, and what it is worth.

    Attributes
    ----------
    exit
        Position in the list of exits that was observed last, from 0.
    heading
        The heading seen for it.
    left
        Candidates that are expected to be left once the robot has gone there and looked around.
    """

    exit: int
    heading: Heading
    left: float


class Localizer:
    """Tells where a robot can be that was switched on somewhere on a map, from what it sees and the ways it takes.

    Parameters
    ----------
    plane
        A map with headings.
    sigma
        Standard deviation of a heading, radians: the robot's error and the map's together.
    compass
        Whether headings are measured from east. False: from a direction of which nothing is known, and which may be another
        at every place; then only the angles between headings seen at one place count.
    start
        A set of the map in which the robot was switched on; left out, anywhere. All its places are equally likely.
    missed
        How likely any one exit is not in the list of exits.
    extra
        How likely a list has one exit too many, in any direction.
    unit
        In which messages speak of headings, as in the header of a walk.
    beyond
        Names of places of which nothing is known but the way there, each a dead end of the map. No robot is switched on
        there; one that goes there stays there, and whatever it sees and does from then on fits as well as anything can.

    Raises
    ------
    BadInput, DifferentMaps, UnknownName
        For a map without headings, a sigma that is none or above 60 degrees, probabilities that are none, `missed` and
        `extra` without a compass, or names that the map does not have.

    Notes
    -----
    Errors are taken to be independent and Gaussian; one beyond 6 standard deviations counts as impossible. What is known of
    where the robot is, is exact under that model: which exit of a list is which dart is never decided, but added up over
    all possibilities. Only what has become less likely than 1e-40 is dropped. A map's error at a place is the same at every
    visit, so where it is not small, many looks at one place tell less than they are taken to. An error leaves the localizer
    as it was.

    Complexity: the first look is O(V), later ones O(places still possible); exits of one place are matched in
    O(degree 2^degree) at worst.

    Examples
    --------
    >>> from math import radians
    >>> from ninefold.mapping import Heading, Localizer, PlaneMap
    >>> plane = PlaneMap.from_geometry([(0, 0), (2, 0), (2, 1), (0, 1), (3, 0)], [(0, 1), (1, 2), (2, 3), (3, 0), (1, 4)])
    >>> east, north, west, south = map(Heading.from_bearing, (90, 0, 270, 180))
    >>> robot = Localizer(plane, sigma=radians(5)).observe(exits=[west, south])
    >>> robot.candidates(), robot.certain
    ((Candidate(vertex='2', dart=None, probability=...),), True)
    >>> robot = Localizer(plane, sigma=radians(5), compass=False).observe(exits=[east, north])
    >>> [found.vertex for found in robot.candidates()]
    ['0', '2', '3']
    >>> robot.move(0).observe(exits=[west, north, east], came_by=0).likeliest.vertex
    '1'
    """

    def __init__(
        self,
        plane: PlaneMap,
        *,
        sigma: float,
        compass: bool = True,
        start: Set | None = None,
        missed: float = 0.0,
        extra: float = 0.0,
        unit: HeadingUnit = "yaw-deg",
        beyond: Iterable[str] = (),
    ) -> None:
        if not isinstance(plane, PlaneMap):
            raise BadInput(f"a PlaneMap is needed, such as read_map gives, not {quoted(plane)}")
        if unit not in get_args(HeadingUnit):
            raise BadInput(f"unit is one of {', '.join(get_args(HeadingUnit))}, not {quoted(unit)}")
        if plane.heading is None or plane.turn is None:
            raise BadInput(
                f"{plane!r} has no headings, by which a robot could be found; build the map from a walk or from geometry"
            )
        self.plane = plane
        self.compass = bool(compass)
        if not self.compass and (missed or extra):
            raise BadInput("without a compass the list of exits has to be whole: missed and extra are for compass=True")
        self._noise = Noise(checked_sigma(sigma), probability("missed", missed), probability("extra", extra))
        self._unit = unit_of(unit)
        self._stars = Stars(plane, plane.heading)
        self._along = np.repeat(plane.turn, 2) * np.tile([-1.0, 1.0], plane.turn.size)  # net rotation towards a dart's tail
        self._n_darts = plane.tail.size  # state d < 2E is dart d, 2E + v is place v with the way back unknown
        self._beyond = np.zeros(plane.n_vertices, np.bool_)
        self._beyond[[plane.vertex_names.row(name) for name in beyond]] = True
        inside = ~self._beyond if start is None else places_in(plane, start, closed=True)
        places = np.flatnonzero(inside)
        self._states = self._n_darts + places.astype(np.int64)
        self._log = np.full(places.size, -np.log(places.size))
        self._before = self._log  # log weights before what was seen here, which a move needs
        self._evidence = self._evidence_before = 0.0  # log likelihood of all that was seen and done; and without this look
        self._look = Look()
        self._given: tuple[int, ...] = ()  # where each exit of the list, as given, is in the look
        self._observations = self._moves = 0

    # -- what is seen and done -----------------------------------------------------------------------------------------

    def observe(self, exits: Iterable[Heading] | None = None, *, came_by: Heading | int | None = None) -> Localizer:
        """Look around: weigh where the robot can be by what it sees, and return this localizer.

        Parameters
        ----------
        exits
            Headings of all ways out, the way back among them, in any order; left out, they were not looked for. Without a
            compass they may be measured from any direction, such as the first of them.
        came_by
            The way back: its position in `exits`, or its heading if that was measured by itself, from where the exits are
            measured (the opposite of the heading on arriving). Left out, it is not known.

        Raises
        ------
        BadInput
            For exits that are no headings, a position that is not in the list, or nothing seen at all.
        EmptyBelief
            If no place that is possible fits what was seen.
        """
        look, given = look_of(exits, came_by)
        states, before = self._states, self._log
        if look.tells_the_way_back:
            states, before = self._by_way_back(states, before)
        found = np.where(self._beyond[self._places(states)], 0.0, -np.inf)
        for k, rows in self._by_degree(states):
            yaw, back = self._yaw(states[rows], k)
            found[rows] = weights(yaw, back, look, self._noise, compass=self.compass)
        after = before + found
        self._require(after, look, "the way back")
        self._observations += 1
        self._evidence_before = self._evidence
        self._evidence += _log_total(after)
        kept = after > after.max() + _FORGOTTEN
        self._states, self._before, self._log = states[kept], before[kept], _normal(after[kept])
        self._look, self._given = look, given
        return self

    def move(self, by: int | Heading | Move, *, turn: float | None = None) -> Localizer:
        """Leave by an exit and arrive at the next place; return this localizer.

        Parameters
        ----------
        by
            Position in the list of exits that was observed last, or the heading on leaving, measured by itself from where
            those exits were, or what `best_move` returned.
        turn
            Net rotation on the way, radians counter-clockwise, if measured: the difference of two headings. With a compass
            those are weighed already, so it only rules out ways that turn otherwise by half a turn, or by more than errors
            explain. Without, it weighs by itself.

        Raises
        ------
        BadInput
            For a position that is not in the list, or a list that was not given.
        EmptyBelief
            If no exit of a possible place fits the heading or the turn.
        """
        leaving = self._leaving(by)
        rotation = None if turn is None else finite("a turn", turn)
        gone = self._beyond[self._places(self._states)]
        arriving, shares = [self._states[gone]], [self._before[gone]]
        for k, rows in self._by_degree(self._states):
            if not k:
                continue
            yaw, back = self._yaw(self._states[rows], k)
            found = weights(yaw, back, self._look, self._noise, compass=self.compass, leaving=leaving)
            arriving.append(self._stars.darts(self._places(self._states[rows]), k).ravel() ^ 1)
            shares.append((found + self._before[rows][:, None]).ravel())
        darts, share = np.concatenate(arriving), np.concatenate(shares)
        taken = Look(back=leaving[0])
        self._require(share, taken, "a way")
        if rotation is not None:
            share += np.where(self._beyond[self._stars.tail[darts]], 0.0, self._turned(rotation)[darts])
            self._require(share, taken, f"a way that turns by {self._unit.angle(rotation)}")
        likely = np.bincount(darts, weights=np.exp(share - share.max()), minlength=self._n_darts)
        states = np.flatnonzero(likely > exp(_FORGOTTEN) * likely.max())
        self._moves += 1
        self._evidence = self._evidence_before = self._evidence_before + _log_total(share)
        self._states = states
        self._before = self._log = _normal(np.log(likely[states]))
        self._look, self._given = Look(), ()
        return self

    def fork(self) -> Localizer:
        """Return a localizer that goes on from here on its own; what was worked out about the map is shared."""
        return copy(self)

    # -- where it can be -----------------------------------------------------------------------------------------------

    @property
    def moves(self) -> int:
        """How many moves were made."""
        return self._moves

    @property
    def n_exits(self) -> int:
        """How many exits were listed where the robot is now; 0 where they were not looked for."""
        return len(self._given)

    @property
    def probabilities(self) -> NDArray[np.float64]:
        """(V,) float64, how likely the robot is at each place of the map; they add up to 1."""
        at = np.bincount(self._places(self._states), weights=np.exp(self._log), minlength=self.plane.n_vertices)
        return np.asarray(at / at.sum())

    @property
    def log_evidence(self) -> float:
        """How likely all that was seen and done is on this map: a natural logarithm, to be held against another map's.

        It is a log density up to what is the same for all maps, given the same observations, noise and compass. The
        difference of two is the logarithm of how much more likely the one map made them.
        """
        return self._evidence

    def candidates(self, mass: float = CERTAIN) -> tuple[Candidate, ...]:
        """Return the places where the robot can be, the likeliest first.

        Parameters
        ----------
        mass
            As few as together are this likely, between 0 and 1; 1 gives all.
        """
        if isinstance(mass, bool) or not isinstance(mass, int | float) or not 0 < mass <= 1:
            raise BadInput(f"mass is a probability above 0 and at most 1, not {quoted(mass)}")
        rows = self._most(mass)
        names = self.plane.vertex_names
        places = self._places(self._states[rows]).tolist()
        darts = self._states[rows].tolist()
        return tuple(
            Candidate(names[v], Dart(d) if d < self._n_darts else None, p)
            for v, d, p in zip(places, darts, np.exp(self._log[rows]).tolist(), strict=True)
        )

    @property
    def likeliest(self) -> Candidate:
        """The likeliest place and way back."""
        return self.candidates(1e-9)[0]

    @property
    def certain(self) -> bool:
        """Whether one place is at least 99.9 % likely."""
        return bool(self.probabilities.max() >= CERTAIN)

    @property
    def entropy(self) -> float:
        """What is not known of the place, in bits: 0 where it is certain, 1 between two alike."""
        p = self.probabilities
        p = p[p > 0]
        return float(-(p * np.log2(p)).sum()) + 0.0

    def inside(self, item: Set, *, closed: bool = False) -> float:
        """Return how likely the robot is inside a set of the map.

        Parameters
        ----------
        item
            A region, line or point.
        closed
            Whether places on its boundary count too. Otherwise only those count that `relate` calls inside: of a region
            the places that all its faces surround, of a line all but its ends, of a point itself.

        Raises
        ------
        DifferentMaps
            For a set of another map.
        """
        return float(self.probabilities[places_in(self.plane, item, closed=closed)].sum())

    # -- where to go ---------------------------------------------------------------------------------------------------

    def best_move(self) -> Move:
        """Return the exit that leaves fewest candidates in expectation; of equals the first. See `forecast`.

        Where no exit is expected to tell any two candidates apart, it is the first of a shortest way to where they differ,
        if one is found with little search.
        """
        outlook = self._outlook()
        forecast = self._forecast(outlook)
        if forecast[0].left < outlook.share.size - 1e-9:
            return forecast[0]
        first = towards_a_difference(self._stars, outlook, compass=self.compass)
        return next((move for move in forecast if self._given[move.exit] == first), forecast[0])

    def forecast(self) -> tuple[Move, ...]:
        """Return all exits observed last, that first which leaves fewest candidates in expectation.

        Returns
        -------
        tuple of Move
            ``left`` is the number of candidates expected to be left after going there and looking around: the candidates
            that hold 99.9 % of the belief are moved along the exit, those that would then see the same (as many exits, in
            the same cells of three sigma, but at least 5 degrees) stay together, and the size of such a group counts by how
            likely the robot is in it.

        Raises
        ------
        BadInput
            If no exits were observed since the last move, or there are none.

        Notes
        -----
        Complexity O(E + candidates x degree) once the looks of all darts were sorted, at the first call.
        """
        return self._forecast(self._outlook())

    def __repr__(self) -> str:
        if self.certain:
            where = f"at {self.likeliest.vertex}"
        else:
            where = counted(np.unique(self._places(self._states[self._most(CERTAIN)])).size, "place")
        return f"Localizer({where}, {counted(self._moves, 'move')})"

    # -- inside --------------------------------------------------------------------------------------------------------

    def _forecast(self, outlook: Outlook) -> tuple[Move, ...]:
        moves = [
            Move(i, Heading(float(outlook.exits[at])), expected_left(outlook.arrived[:, at], outlook))
            for i, at in enumerate(self._given)
        ]
        return tuple(sorted(moves, key=lambda move: round(move.left, 9)))

    def _outlook(self) -> Outlook:
        """Return where each candidate would come by each exit seen."""
        look = self._look
        if look.exits is None or not look.exits.size:
            raise BadInput("no exits were observed here, so there is none to choose; observe(exits=...) first")
        rows = self._most(CERTAIN)
        states = self._states[rows]
        arrived = np.full((rows.size, look.exits.size), -1)
        for degree, some in self._by_degree(states):
            if degree:
                yaw, back = self._yaw(states[some], degree)
                way = likeliest_exits(yaw, look.exits, back, look, compass=self.compass)
                darts = self._stars.darts(self._places(states[some]), degree)
                arrived[some] = np.take_along_axis(darts, way, axis=1) ^ 1
        looks = self._stars.looks(max(3 * self._noise.sigma, TAU / 72), compass=self.compass)
        return Outlook(look.exits, arrived, np.exp(self._log[rows]), looks)

    def _places(self, states: NDArray[np.int64]) -> NDArray[np.int64]:
        alone = states >= self._n_darts
        if not self._n_darts or alone.all():
            return states - self._n_darts
        return np.where(alone, states - self._n_darts, self._stars.tail[np.where(alone, 0, states)])

    def _by_degree(self, states: NDArray[np.int64]) -> Iterator[tuple[int, NDArray[np.int64]]]:
        """Give the rows of states by the number of exits there, those whose way back is known apart; none beyond the map."""
        places = self._places(states)
        degree = np.where(self._beyond[places], -1, self._stars.degree[places])
        alone = states >= self._n_darts
        for k in np.unique(degree[degree >= 0]).tolist():
            for kind in (alone, ~alone):
                rows = np.flatnonzero((degree == k) & kind)
                if rows.size:
                    yield k, rows

    def _yaw(self, states: NDArray[np.int64], k: int) -> tuple[NDArray[np.float64], NDArray[np.int64] | None]:
        """Return the yaw of the exits, (n, k), and which is the way back; of states of one degree and kind."""
        yaw = self._stars.heading[self._stars.darts(self._places(states), k)] if k else np.zeros((states.size, 0))
        return yaw, self._stars.rank[states] if states[0] < self._n_darts else None

    def _by_way_back(
        self, states: NDArray[np.int64], log_weight: NDArray[np.float64]
    ) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Return the states with those of unknown way back split over all ways back."""
        alone = states >= self._n_darts
        parts, shares = [states[~alone]], [log_weight[~alone]]
        places, share = states[alone] - self._n_darts, log_weight[alone]
        degree = self._stars.degree[places]
        for k in np.flatnonzero(np.bincount(degree)).tolist():
            rows = np.flatnonzero(degree == k)
            if k:
                parts.append(self._stars.darts(places[rows], k).ravel())
                shares.append(np.repeat(share[rows] - log(k), k))
        return np.concatenate(parts), np.concatenate(shares)

    def _leaving(self, by: int | Heading | Move) -> tuple[float | None, int | None]:
        if isinstance(by, Heading):
            return by.yaw, None
        at = by.exit if isinstance(by, Move) else by
        if isinstance(at, bool) or not isinstance(at, Integral):
            raise BadInput(f"an exit is its position in the list observed, or a Heading, not {quoted(by)}")
        if not self._given:
            raise BadInput("no exits were observed here, so none can be told by its position; give the Heading on leaving")
        if not 0 <= at < len(self._given):
            raise BadInput(
                f"the list observed has {counted(len(self._given), 'exit')}, from 0 on; there is none at position {at}"
            )
        return None, self._given[int(at)]

    def _turned(self, turn: float) -> NDArray[np.float64]:
        """Return the log weight of each dart to have been arrived by, for a net rotation on the way."""
        error, sigma = np.abs(turn - self._along), self._noise.sigma
        if self.compass:
            return np.where(error <= min(2 * GATE * sigma, pi), 0.0, -np.inf)
        return np.where(error <= 2 * GATE * sigma, -0.25 * (error / sigma) ** 2, -np.inf)

    def _most(self, mass: float) -> NDArray[np.int64]:
        """Return the rows of the fewest states that together are so likely, the likeliest first."""
        order = np.argsort(-self._log, kind="stable")
        if mass >= 1:
            return order
        enough = int(np.searchsorted(np.cumsum(np.exp(self._log[order])), mass - 1e-12)) + 1
        return order[:enough]

    def _require(self, after: NDArray[np.float64], look: Look, what: str) -> None:
        """Raise `EmptyBelief` if nothing is left."""
        if after.size and after.max() > -np.inf:
            return
        before = Before(np.unique(self._places(self._states)), self._observations, self._moves)
        noise = f"sigma {degrees(self._noise.sigma):.3g} degrees{'' if self.compass else ', without a compass'}"
        raise empty_belief(self.plane, self._stars, before, look, what, noise, self._unit, compass=self.compass)


def _log_total(log_weight: NDArray[np.float64]) -> float:
    """Return the log of the sum of weights."""
    top = float(log_weight.max())
    return top + float(np.log(np.exp(log_weight - top).sum()))


def _normal(log_weight: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return log weights so that the weights add up to 1."""
    top = float(log_weight.max())
    return np.asarray(log_weight - top - np.log(np.exp(log_weight - top).sum()))
