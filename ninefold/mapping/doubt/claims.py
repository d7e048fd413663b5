"""Which of the claims that two visits are the same place cannot be right.

A recogniser that goes by looks says of pairs of visits that they are one place, some of them wrongly. Claims are taken
together: whatever is not to be held true is rejected so that the scores of the rejected sum to the least. Two things can
speak against claims.

**Congruence.** One place has one list of exits, and every exit leads one way. So claims have consequences, place by place
along the ways that were walked, and where these clash the claims behind the clash cannot all be right. That holds whatever
other places are the same; see `_congruence`.

**The plane.** Every face of a map turns once. Whether claims can be right on that account tells only a whole map that holds
them: a way that crosses another may have done so at a place that nobody claims. So the question is whether *some* legal map
holds all the claims; see `_held`. It is a search, and may end without an answer.

A wrong claim that agrees with all others and with some plane map cannot be told from a right one.

References
----------
E. Moreno-Centeno and R. M. Karp, "The implicit hitting set approach to solve combinatorial optimization problems",
Operations Research 61, 2013.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from time import monotonic
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.encodings.choice import cheapest_choice, quick_choice
from ninefold.errors import BadInput

from ..robot.units import unit_of
from ..robot.walk import Walk
from ._congruence import Assertion, Congruence, Core, core_of
from ._held import every_closed_map, some_map
from .hypotheses import Hypothesis
from .likeness import can_be_one
from .walk_tree import Contradiction, WalkTree, fold

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike, NDArray

    from ..robot.units import Unit
    from ._congruence import Clash

__all__ = ["Claim", "Claims", "Rejection", "claims"]

BUDGET = 60.0
"""Seconds that the search for maps may take, if nothing else is asked for."""

TRIES = 12
"""How often to try to make a set of claims that clash smaller before the cheapest to reject are chosen."""

LEAST_SECONDS = 5.0
"""What a choice of the cheapest claims may take even if the budget is spent; after that they are chosen without a search."""

MOST_MAPS = 1000
"""Maps that are listed at most, so that claims can be held against each."""

FIRST_SHARE = 30
"""The part of the budget after which a search with all claims gives way to one for all maps."""

LISTED = 6
"""Claims that a reason lists."""


@dataclass(frozen=True, slots=True)
class Claim:
    """Said: two visits are the same place.

    Attributes
    ----------
    a, b
        The visits, counted from 0.
    score
        What it costs to reject it, above 0.
    """

    a: int
    b: int
    score: float = 1.0

    def __str__(self) -> str:
        return f"{self.a} = {self.b}"


@dataclass(frozen=True, slots=True)
class Rejection:
    """A claim that is rejected, and why.

    Attributes
    ----------
    claim
        The claim.
    against
        Other claims that it contradicts: all of them and it cannot be right together, and leaving out any one of them it
        can. None where it cannot be right by itself.
    visits
        Two visits that would then be the same place and cannot be; None where no clash of two places shows it, only that no
        plane map holds all these claims.
    reason
        In words.
    """

    claim: Claim
    against: tuple[Claim, ...]
    visits: tuple[int, int] | None
    reason: str


@dataclass(frozen=True, slots=True, eq=False)
class Claims:
    """Claims, judged; made by `claims`.

    Attributes
    ----------
    tree
        The folded walk.
    claims
        All of them, in the order given.
    rejected
        Those that are rejected, in that order.
    map
        A legal map that holds all others; None where none is known.
    exact
        Whether nothing cheaper can be rejected so that some legal map holds the rest. False where the budget was spent: then
        claims are rejected by congruence, and those that no legal map holds even alone, and more may be wrong.
    contradiction
        Why no map explains the walk even without any claim, where that shows in a stretch of it.
    """

    tree: WalkTree = field(repr=False)
    claims: tuple[Claim, ...] = field(repr=False)
    rejected: tuple[Rejection, ...]
    map: Hypothesis | None = field(repr=False)
    exact: bool
    contradiction: Contradiction | None = None

    @property
    def kept(self) -> tuple[Claim, ...]:
        """The claims that are not rejected, in order."""
        gone = {id(one.claim) for one in self.rejected}
        return tuple(one for one in self.claims if id(one) not in gone)

    @property
    def cost(self) -> float:
        """Sum of the scores of the rejected claims."""
        return math.fsum(one.claim.score for one in self.rejected)


def claims(
    walk: Walk,
    pairs: ArrayLike | Iterable[tuple[int, int, float]],
    *,
    threshold: float | None = None,
    closed: bool = False,
    budget: float | None = None,
    tolerance: float | None = None,
) -> Claims:
    """Judge claims that visits are the same places: reject the cheapest of them so that the rest can be right.

    Parameters
    ----------
    walk
        Every visit lists its exits.
    pairs
        Claims (visit, visit, score), visits counted from 0, scores above 0. Or, with a threshold, how alike visits look:
        (T, T), and each pair that looks at least so alike is claimed, with what it looks alike as the score; of the two
        entries of a pair the larger counts, and the diagonal none.
    threshold
        From which on visits count as claimed to be one place, above 0.
    closed
        Whether the walk left no exit untravelled. Then much fewer maps are legal, and more wrong claims are found.
    budget
        Seconds, 60 if left out, after which no more maps are searched for; with 0, claims are judged by congruence and by
        the map alone that they themselves make. Where the budget and 5 s more do not do to choose the cheapest, claims are
        chosen that may cost more.
    tolerance
        Radians within which two headings may be of one exit, instead of the header's.

    Returns
    -------
    Claims
        Sure in so far as the walk is: a rejected set is the cheapest, and of equally cheap ones one. A wrong claim with
        enough wrong company may have right ones rejected in its stead.

    Raises
    ------
    BadInput
        For claims about visits there are not, scores that are not above 0, a matrix of the wrong shape or with NaN.
    WalkError
        As `fold` does.

    Examples
    --------
    A robot goes around a block, and around once more. Somebody claims that the second corner is the third:

    >>> from ninefold.mapping import Heading, Samples, Visit, Walk, WalkHeader, claims
    >>> yaws = [0, 90, 180, 270] * 2
    >>> events = [Visit(None, (Heading.from_degrees(0), Heading.from_degrees(90)))]
    >>> for out, after in zip(yaws, yaws[1:]):
    ...     events.append(Samples.of(Heading.from_degrees(out)))
    ...     events.append(Visit(None, (Heading.from_degrees(out + 180), Heading.from_degrees(after))))
    >>> found = claims(Walk(WalkHeader(heading="yaw-deg"), tuple(events)), [(0, 4, 0.9), (1, 5, 0.8), (1, 2, 0.7)])
    >>> [one.reason for one in found.rejected]
    ['visits 1 and 2 would be one place, but their exits lie at 90, 180 and at -90, 180 deg']

    Notes
    -----
    Complexity: a congruence closure, near linear in the walk, for every claim of every set of claims found to clash; the
    searches are exponential at worst.
    """
    if not isinstance(walk, Walk):
        raise BadInput(f"claims are about a Walk, such as read_walk gives, not {quoted(walk)}")
    tree = fold(walk, tolerance=tolerance)
    visits = sum(1 for event in walk.events if hasattr(event, "exits"))
    said = _claims_of(pairs, threshold, visits)
    if tree.contradiction is not None:
        return Claims(tree, said, (), None, exact=False, contradiction=tree.contradiction)
    until = monotonic() + (BUDGET if budget is None else budget)
    return _Judging(tree, said, unit_of(walk.header.heading), closed=closed, until=until).judged()


# -- reading claims --------------------------------------------------------------------------------------------------------


def _claims_of(
    pairs: ArrayLike | Iterable[tuple[int, int, float]], threshold: float | None, visits: int
) -> tuple[Claim, ...]:
    if threshold is not None:
        return _claims_of_matrix(pairs, threshold, visits)
    found = []
    try:
        listed: list[Any] = list(pairs)  # type: ignore[arg-type]
    except TypeError:
        raise BadInput(
            f"claims are triples (visit, visit, score), or a matrix with a threshold; not {quoted(pairs)}"
        ) from None
    for number, one in enumerate(listed):
        try:
            a, b, score = one
            first, second, cost = int(a), int(b), float(score)
            whole = first == a and second == b
        except (TypeError, ValueError, OverflowError):
            raise BadInput(f"claim {number}: {quoted(one)}; a claim is (visit, visit, score)") from None
        if not whole or not (0 <= first < visits and 0 <= second < visits):
            raise BadInput(f"claim {number}: there are no visits {quoted((a, b))}; visits are numbered 0 to {visits - 1}")
        if not 0 < cost < math.inf:
            raise BadInput(f"claim {number}: the score {quoted(score)}; a score is a number above 0")
        found.append(Claim(first, second, cost))
    return tuple(found)


def _claims_of_matrix(matrix: object, threshold: float, visits: int) -> tuple[Claim, ...]:
    if not 0 < threshold < math.inf:
        raise BadInput(f"the threshold {quoted(threshold)}; it is a number above 0")
    try:
        alike = np.asarray(matrix, np.float64)
    except (TypeError, ValueError):
        raise BadInput("how alike visits look is a matrix of numbers") from None
    if alike.shape != (visits, visits):
        shape = " x ".join(map(str, alike.shape)) or "a single number"
        raise BadInput(
            f"how alike visits look is {shape}, and the walk has {counted(visits, 'visit')}; give a matrix of "
            f"{visits} x {visits}"
        )
    wrong = np.argwhere(~np.isfinite(alike))
    if wrong.size:
        i, j = wrong[0].tolist()
        raise BadInput(f"visits {i} and {j} look alike as {alike[i, j]:g} (row {i}, column {j}); give finite numbers")
    both = np.maximum(alike, alike.T)
    first, second = np.nonzero(np.triu(both >= threshold, 1))
    return tuple(Claim(i, j, float(both[i, j])) for i, j in zip(first.tolist(), second.tolist(), strict=True))


# -- judging ---------------------------------------------------------------------------------------------------------------


class _Judging:
    """Claims as assertions on nodes, the cores found so far, and the cheapest choice they leave."""

    def __init__(self, tree: WalkTree, said: tuple[Claim, ...], unit: Unit, *, closed: bool, until: float) -> None:
        self._tree, self._said, self._unit, self._closed, self._until = tree, said, unit, closed, until
        self._assertions: list[Assertion] = []
        self._owner: list[int] = []
        self._readings: list[list[int]] = []
        for number, one in enumerate(said):
            n, m = int(tree.node_of[one.a]), int(tree.node_of[one.b])
            shifts = [0] if n == m else _shifts(tree, n, m)
            first = len(self._assertions)
            self._assertions += [Assertion(n, m, k) for k in shifts]
            self._owner += [number] * len(shifts)
            self._readings.append(list(range(first, len(self._assertions))))
        self._congruence = Congruence(tree, _facts(tree))
        self._cores: list[Core] = []
        self._cheapest = self._searching = True
        self._maps: list[Hypothesis] | None = None
        self._listed = False

    def judged(self) -> Claims:
        """Alternate between the cheapest choice and what speaks against it."""
        tree = self._tree
        if self._congruence.clash is not None:
            clash = self._congruence.clash
            visits = sorted((self._visit(clash.node), self._visit(clash.other)))
            text = f"names say that places are the same, and then {self._words(clash)}"
            return Claims(tree, self._said, (), None, exact=False, contradiction=Contradiction(visits[0], visits[1], text))
        while True:
            chosen = self._choice()
            found = self._clashing(chosen)
            one: Hypothesis | bool | None = None
            if not found and self._searching:
                one = self._map_of(chosen)
                core = self._blamed(list(chosen.values())) if one is False else None
                if core == ():
                    return Claims(tree, self._said, (), None, exact=False, contradiction=self._hopeless())
                if core is not None:
                    found = [Core(core, None)]
                elif not isinstance(one, Hypothesis):
                    # what no search has told apart is not held against single claims
                    self._searching = False
                    self._cores = [core for core in self._cores if core.clash is not None or len(core.members) == 1]
                    continue
            if not found:
                told = one if isinstance(one, Hypothesis) else None
                exact = told is not None and self._cheapest
                return Claims(tree, self._said, self._rejections(chosen), told, exact=exact)
            self._cores += found

    def _hopeless(self) -> Contradiction:
        kind = "closed plane map" if self._closed else "plane map"
        text = f"no {kind} explains the walk, whatever is claimed"
        return Contradiction(0, self._tree.n_visits - 1, text)

    def _map_of(self, chosen: dict[int, int]) -> Hypothesis | bool | None:
        """Return a legal map that holds chosen assertions; False if there is none, None if time is up.

        Where that is not told soon and no exit is untravelled, all maps are listed, for every later question too.
        """
        now = monotonic()
        one = self._map(chosen.values(), until=now + (self._until - now) / FIRST_SHARE)
        if isinstance(one, Hypothesis) or self._maps is not None:
            return one
        if self._closed and not self._listed:
            self._listed = True
            self._congruence.reset()
            now = monotonic()
            self._maps = every_closed_map(
                self._tree, *self._congruence.places(), until=now + (self._until - now) / 2, most=MOST_MAPS
            )
            if self._maps is not None:
                return self._map(chosen.values(), until=now)
        return self._map(chosen.values(), until=self._until) if one is None else one

    def _choice(self) -> dict[int, int]:
        if not self._cores and all(self._readings):
            return {claim: means[0] for claim, means in enumerate(self._readings)}
        given = [one.score for one in self._said], self._readings, [core.members for core in self._cores]
        if self._cheapest:
            found = cheapest_choice(*given, seconds=max(self._until - monotonic(), LEAST_SECONDS))
            if found is not None:
                return found
            self._cheapest = False
        return quick_choice(*given)

    def _clashing(self, chosen: dict[int, int]) -> list[Core]:
        """Return sets of chosen assertions that clash, enough of them to convict those that clash with all the rest."""
        order = sorted(chosen.values(), key=lambda k: -self._score(k))
        left = {k: self._assertions[k] for k in order}
        found: list[Core] = []
        while (core := core_of(self._congruence, left, tries=TRIES)) is not None:
            found.append(core)
            for k in core.members:
                del left[k]
        suspects = []
        for k in [k for core in found for k in core.members]:
            if self._congruence.assert_all([(k, self._assertions[k])]):
                left[k] = self._assertions[k]
                continue
            suspects.append(k)
            self._congruence.reset()
            self._congruence.assert_all(left.items())
        return found + [core for k in suspects for core in self._against(k, left)]

    def _against(self, suspect: int, agreed: dict[int, Assertion]) -> list[Core]:
        """Return clashes of a suspect with others that agree, until rejecting it is cheaper; it alone is in two of them."""
        left = dict(agreed)
        left[suspect] = self._assertions[suspect]
        found: list[Core] = []
        cost = 0.0
        while cost <= self._score(suspect):
            core = core_of(self._congruence, left, tries=TRIES)
            if core is None:
                break
            found.append(core)
            others = [k for k in core.members if k != suspect]
            if not others:
                break
            cost += min(self._score(k) for k in others)
            for k in others:
                del left[k]
        return found

    def _score(self, assertion: int) -> float:
        return self._said[self._owner[assertion]].score

    def _map(self, chosen: Iterable[int], *, until: float) -> Hypothesis | bool | None:
        """Return a legal map that holds assertions, False if there is none, None if time is up."""
        said = [self._assertions[k] for k in chosen]
        if self._maps is not None:
            return next((one for one in self._maps if all(_holds(one, *assertion) for assertion in said)), False)
        self._congruence.reset()
        if not self._congruence.assert_all(enumerate(said)):
            return False
        place, shift = self._congruence.places()
        return some_map(self._tree, place, shift, closed=self._closed, until=until)

    def _blamed(self, chosen: list[int]) -> tuple[int, ...] | None:
        """Return some of the assertions that no legal map holds together, none superfluous; None if time ran out."""
        needed: list[int] = []
        left = list(chosen)
        size = max(1, len(left) // 2)
        while left:  # as many at once as can be left out, then half as many, and so on
            part, rest = left[:size], left[size:]
            one = self._map([*needed, *rest], until=self._until)
            if one is None:
                return None
            if one is False:
                left = rest
                size = max(1, min(2 * size, len(left)))
            elif len(part) == 1:
                needed += part
                left = rest
            else:
                size = len(part) // 2
        return tuple(sorted(needed))

    # -- words -------------------------------------------------------------------------------------------------------------

    def _rejections(self, chosen: dict[int, int]) -> tuple[Rejection, ...]:
        found = []
        for number, one in enumerate(self._said):
            if number in chosen:
                continue
            if not self._readings[number]:
                n, m = int(self._tree.node_of[one.a]), int(self._tree.node_of[one.b])
                found.append(Rejection(one, (), (one.a, one.b), self._unlike(n, m, one.a, one.b)))
                continue
            cores = [self._why(reading, chosen) for reading in self._readings[number]]
            against = {self._owner[k] for core in cores for k in core.members} - {number}
            others = tuple(self._said[k] for k in sorted(against))
            clash = cores[0].clash
            visits = None if clash is None else (self._visit(clash.node), self._visit(clash.other))
            found.append(Rejection(one, others, visits, self._reason(others, clash)))
        return tuple(found)

    def _why(self, reading: int, chosen: dict[int, int]) -> Core:
        """Return what speaks against a rejected assertion: others that are kept, if these alone convict it."""
        kept = set(chosen.values())
        cores = [one for one in self._cores if reading in one.members]
        enough = [one.members for one in cores if one.clash is not None and kept.issuperset(set(one.members) - {reading})]
        others = min(enough, key=len, default=kept)
        core = core_of(self._congruence, {k: self._assertions[k] for k in [*sorted(set(others) - {reading}), reading]})
        return min(cores, key=lambda one: len(set(one.members) - kept)) if core is None else core

    def _reason(self, others: tuple[Claim, ...], clash: Clash | None) -> str:
        given = ""
        if others:
            listed = ", ".join(map(str, others[:LISTED]))
            more = f" and {counted(len(others) - LISTED, 'more', 'more')}" if len(others) > LISTED else ""
            given = f"with {'the claim' if len(others) == 1 else 'the claims'} {listed}{more}, "
        if clash is None:
            kind = "closed plane map" if self._closed else "plane map"
            return f"{given}no {kind} explains the walk"
        return given + self._words(clash)

    def _words(self, clash: Clash) -> str:
        """Say how two nodes cannot be one place."""
        p, q = self._visit(clash.node), self._visit(clash.other)
        way = self._exit(clash.node, clash.exit)
        match clash.kind:
            case "exits":
                return self._unlike(clash.node, clash.other, p, q)
            case "names":
                names = quoted(self._tree.names[clash.node]), quoted(self._tree.names[clash.other])
                return f"visits {p} and {q} would be one place, but they are called {names[0]} and {names[1]}"
            case "twice":
                return (
                    f"visits {p} and {q} would be one place, the exit at {way} of the one being "
                    f"that at {self._exit(clash.other, clash.as_exit)} of the other, and by another way the same one"
                )
            case "back":
                return f"the way out of visit {p} at {way} would come back by the very exit that it leaves by"

    def _unlike(self, n: int, m: int, a: int, b: int) -> str:
        tree = self._tree
        if tree.degree[n] != tree.degree[m]:
            return (
                f"visits {a} and {b} would be one place, but they have {counted(int(tree.degree[n]), 'exit')} and "
                f"{counted(int(tree.degree[m]), 'exit')}"
            )
        first, second = (self._unit.headings(tree.heading[k, : tree.degree[k]].tolist()) for k in (n, m))
        turned = "" if tree.compass else ", however they are turned"
        lie = f"{first} and at {second} {self._unit.measure}{turned}"
        return f"visits {a} and {b} would be one place, but their exits lie at {lie}"

    def _exit(self, node: int, number: int) -> str:
        return self._unit.heading(float(self._tree.heading[node, number]))

    def _visit(self, node: int) -> int:
        """Return the first visit of a node."""
        return int(np.argmax(self._tree.node_of == node))


def _holds(one: Hypothesis, n: int, m: int, shift: int) -> bool:
    """Whether two nodes are one place of a map under a shift."""
    turned = int(one.shift[m]) + shift - int(one.shift[n])
    return bool(one.place[n] == one.place[m]) and turned % max(int(one.tree.degree[n]), 1) == 0


def _shifts(tree: WalkTree, n: int, m: int) -> list[int]:
    """Return the shifts under which two nodes can be one place."""
    degree = int(tree.degree[n])
    if degree != tree.degree[m]:
        return []
    if degree == 0:
        return [0]
    shift: NDArray[np.int64] = np.arange(degree)
    good = can_be_one(tree, np.full(degree, n), np.full(degree, m), shift)
    return np.flatnonzero(good).tolist()


def _facts(tree: WalkTree) -> list[Assertion]:
    """Return what names say: nodes of one name are one place, where only one shift comes into question."""
    named: dict[str, int] = {}
    found = []
    for m, name in enumerate(tree.names):
        if name is None:
            continue
        n = named.setdefault(name, m)
        shifts = _shifts(tree, n, m) if n != m else []
        if n != m and len(shifts) < 2:
            found.append(Assertion(n, m, shifts[0] if shifts else 0))
    return found
