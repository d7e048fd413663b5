"""Every map that explains a walk, slowly: visit after visit is a new place or one of those before, under every shift.

Nothing is clever here. Places grow along the walk; a way that is known is followed, any other may end at a new place or at
any free exit of an old one. What comes out is judged whole: by the genus, counting orbits, and by the turning of its faces.

A visit that folding alone makes an earlier one is not looked at again: the lists of exits compared are those of the first
visits, and the legs compared those that led there. Two lists of exits agree when their headings do, within the tolerance;
without a compass, when some turn of one of them brings all headings within the tolerance. Two legs along one way agree when
their whole turns do; without a compass, when their net turns do within twice the tolerance, as two readings make a turn.

A face turns as the stars of the first visits say, and the legs walked first. With a compass that is a whole number of turns.
Without one it is one within the tolerance for every corner and every leg, and by less than half a turn.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import pi, tau
from typing import NamedTuple

from ninefold.mapping import Samples, Visit, Walk

EPSILON = 1e-9


class Leg(NamedTuple):
    """A leg to a visit that is not known by folding: the exits at either end, and its net turn."""

    before: int
    out: int
    after: int
    back: int
    turn: float


class Quotient(NamedTuple):
    """Visits merged: the place of every visit, and which exit of the place it lists first; places are numbered as met."""

    place: tuple[int, ...]
    shift: tuple[int, ...]


class Story:
    """What a walk says: the exits of every visit, by which of them it goes on, and by which it was reached."""

    def __init__(self, walk: Walk) -> None:
        self.compass, self.tolerance = walk.header.compass, walk.header.tolerance
        self.names: list[str | None] = []
        self.stars: list[list[float]] = []
        self.out: list[int] = []
        self.back: list[int] = [-1]
        self.turn: list[float] = [0.0]
        yaws: list[float] = []
        for event in walk.events:
            if isinstance(event, Samples):
                yaws += event.yaw
                continue
            assert isinstance(event, Visit)
            assert event.exits is not None
            self.names.append(event.place)
            self.stars.append(sorted(heading.yaw for heading in event.exits))
            if len(self.stars) > 1:
                self.out.append(nearest(self.stars[-2], yaws[0]))
                self.back.append(nearest(self.stars[-1], yaws[-1] + pi))
                self.turn.append(sum(wrapped(b - a) for a, b in pairwise(yaws)))
            yaws = []
        self.first: list[int] = []
        """The first visit that folding alone makes the same."""
        self._fold()

    def __len__(self) -> int:
        return len(self.stars)

    def _fold(self) -> None:
        leads: dict[tuple[int, int], tuple[int, int]] = {}
        at, shift = 0, 0
        self.first = [0]
        for t in range(1, len(self)):
            dart = (at, (self.out[t - 1] + shift) % len(self.stars[at]))
            if dart not in leads:
                leads[dart], leads[t, self.back[t]] = (t, self.back[t]), dart
            at, back = leads[dart]
            shift = (back - self.back[t]) % len(self.stars[at])
            self.first.append(at)

    def alike(self, a: int, b: int, shift: int) -> bool:
        """Whether exit x of visit a can be exit x + shift of visit b."""
        count = len(self.stars[a])
        if count != len(self.stars[b]):
            return False
        misses = [wrapped(self.stars[b][(x + shift) % count] - yaw) for x, yaw in enumerate(self.stars[a])]
        if not self.compass and misses:
            misses = [wrapped(miss - misses[0]) for miss in misses]
            return max(misses) - min(misses) <= 2 * self.tolerance + EPSILON
        return all(abs(miss) <= self.tolerance + EPSILON for miss in misses)

    def legs_agree(self, one: Leg, two: Leg) -> bool:
        """Whether two legs from one place to another can be along one way."""
        if not self.compass:
            return abs(one.turn - two.turn) <= 2 * self.tolerance + EPSILON
        out = wrapped(self.stars[two.before][two.out] - self.stars[one.before][one.out])
        back = wrapped(self.stars[two.after][two.back] - self.stars[one.after][one.back])
        return abs(self.settled(one) + back - out - self.settled(two)) < pi

    def settled(self, leg: Leg) -> float:
        """The turn of a leg as the exits at its ends have it."""
        miss = self.stars[leg.after][leg.back] + pi - self.stars[leg.before][leg.out] - leg.turn
        return leg.turn + wrapped(miss)


def nearest(star: list[float], yaw: float) -> int:
    return min(range(len(star)), key=lambda x: abs(wrapped(star[x] - yaw)))


def wrapped(angle: float) -> float:
    """An angle in [-pi, pi)."""
    return (angle + pi) % tau - pi


class Merging:
    """Visits merged so far."""

    def __init__(self, story: Story) -> None:
        self.story = story
        self.members: list[list[tuple[int, int]]] = []
        """Of every place, the first visits of all that are one by folding, with the exit that they list first."""
        self.leads: dict[tuple[int, int], tuple[int, int]] = {}
        self.legs: dict[tuple[int, int], list[Leg]] = {}
        """The legs along every way out of an exit, read in that direction."""
        self.place: list[int] = []
        self.shift: list[int] = []

    def quotients(self) -> Iterator[Quotient]:
        """Go on to the next visit in every way that can be."""
        story, t = self.story, len(self.place)
        if t == len(story):
            yield Quotient(tuple(self.place), tuple(self.shift))
            return
        if t == 0:
            yield from self._at(0, 0, None)
            return
        here = self.place[-1]
        dart = (here, (story.out[t - 1] + self.shift[-1]) % self._degree(here))
        if dart in self.leads:
            place, back = self.leads[dart]
            if len(story.stars[t]) == self._degree(place):
                yield from self._at(place, (back - story.back[t]) % self._degree(place), dart)
            return
        yield from self._at(len(self.members), 0, dart)
        for place in range(len(self.members)):
            if len(story.stars[t]) != self._degree(place):
                continue
            for back in range(self._degree(place)):
                if (place, back) not in self.leads and (place, back) != dart:
                    yield from self._at(place, (back - story.back[t]) % self._degree(place), dart)

    def _degree(self, place: int) -> int:
        return len(self.story.stars[self.members[place][0][0]])

    def _at(self, place: int, shift: int, dart: tuple[int, int] | None) -> Iterator[Quotient]:
        """The next visit is of this place, which its first exit tells."""
        story, t = self.story, len(self.place)
        fresh = story.first[t] == t
        made = place == len(self.members)
        if fresh and not made:
            for other, moved in self.members[place]:
                if not story.alike(t, other, (shift - moved) % len(story.stars[t])):
                    return
        ends: tuple[tuple[int, int], ...] = ()
        if dart is not None:
            ends = dart, (place, (story.back[t] + shift) % len(story.stars[t]))
        legs: tuple[Leg, ...] = ()
        if fresh and dart is not None:
            before = story.first[t - 1]
            leg = Leg(before, self._own_exit(before, dart), t, story.back[t], story.turn[t])
            if not all(story.legs_agree(other, leg) for other in self.legs.get(dart, ())):
                return
            legs = leg, Leg(leg.after, leg.back, leg.before, leg.out, -leg.turn)
        laid = bool(ends) and dart not in self.leads
        if made:
            self.members.append([])
        if fresh:
            self.members[place].append((t, shift))
        if laid:
            self.leads |= {ends[0]: ends[1], ends[1]: ends[0]}
        for end, leg in zip(ends, legs, strict=False):
            self.legs.setdefault(end, []).append(leg)
        self.place.append(place)
        self.shift.append(shift)
        yield from self.quotients()
        self.shift.pop()
        self.place.pop()
        for end, _ in zip(ends, legs, strict=False):
            self.legs[end].pop()
        if laid:
            del self.leads[ends[0]], self.leads[ends[1]]
        if fresh:
            self.members[place].pop()
        if made:
            self.members.pop()

    def _own_exit(self, visit: int, dart: tuple[int, int]) -> int:
        shift = next(moved for other, moved in self.members[dart[0]] if other == visit)
        return (dart[1] - shift) % len(self.story.stars[visit])

    def judged(self) -> Verdict:
        """Count the genus and the turning of what was walked."""
        orbits = []
        left = set(self.leads)
        while left:
            begin = dart = min(left)
            angle, stubs, steps = 0.0, False, 0
            while True:
                left.remove(dart)
                steps += 2
                angle += self._turn(dart)
                place, back = self.leads[dart]
                x = (back - 1) % self._degree(place)
                while (place, x) not in self.leads:
                    stubs, x = True, (x - 1) % self._degree(place)
                star = self.story.stars[self.members[place][0][0]]
                angle += pi - ((star[back] - star[x]) % tau if x != back else tau)
                dart = (place, x)
                if dart == begin:
                    break
            orbits.append((angle, stubs, steps))
        faces = len(orbits) or 1
        planar = len(self.members) - len(self.leads) // 2 + faces == 2
        turns = [(self._whole(angle, steps), stubs) for angle, stubs, steps in orbits] or [(-1, False)]
        closed = len(self.leads) == sum(map(self._degree, range(len(self.members))))
        whole = [turn for turn, stubs in turns if not stubs]
        weak = planar and all(turn in (1, -1) for turn in whole) and whole.count(-1) <= 1
        strict = planar and all(turn in (1, -1) for turn, _ in turns) and [turn for turn, _ in turns].count(-1) == 1
        torus = closed and not planar and all(turn == 1 for turn, _ in turns)
        return Verdict(planar, weak, strict, closed, torus)

    def _turn(self, dart: tuple[int, int]) -> float:
        """The turn along the way out of an exit, by the leg that was first, as the first visits' exits have it."""
        leg = self.legs[dart][0]
        if not self.story.compass:
            return leg.turn
        end = self.leads[dart]
        place = self.members[dart[0]][0][0], self.members[end[0]][0][0]
        settled = self.story.settled(leg)
        out = wrapped(self.story.stars[place[0]][dart[1]] - self.story.stars[leg.before][leg.out])
        back = wrapped(self.story.stars[place[1]][end[1]] - self.story.stars[leg.after][leg.back])
        return settled + back - out

    def _whole(self, angle: float, steps: int) -> int | None:
        """The number of turns of a face, or None if it is none."""
        number = round(angle / tau)
        within = 1e-6 if self.story.compass else min(steps * self.story.tolerance + EPSILON, pi - 1e-6)
        return number if abs(angle - tau * number) <= within else None


class Verdict(NamedTuple):
    """What can be said of a quotient: genus 0; its closed faces, or all, turn as they must; no exit open; a flat torus."""

    planar: bool
    turning: bool
    strict: bool
    closed: bool
    torus: bool


def all_quotients(walk: Walk, *, most: int | None = None) -> dict[Quotient, Verdict] | None:
    """Every way of merging visits, and what is to be said of it; None if there are more than so many. Exponential."""
    merging = Merging(Story(walk))
    found = {}
    for quotient in merging.quotients():
        found[quotient] = merging.judged()
        if most is not None and len(found) > most:
            return None
    return found
