"""What is in doubt, in words, and which walk would settle it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import islice
from math import sqrt
from typing import TYPE_CHECKING, Literal

from ninefold._wording import counted, quoted

from ..heading import TAU
from .exit_lists import RESOLVED
from .noise import LOG_ODDS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .exit_lists import Directions
    from .orders import StarOrder
    from .reading import Reading
    from .ways import Bundle

__all__ = ["Again", "Doubt", "DoubtKind", "again", "doubts_of"]

DoubtKind = Literal["order", "ways", "outer", "uncounted", "noise"]
"""What a doubt is about; see `Doubt`."""

MOST_PASSES = 200
"""Passes above which nobody is told how often to walk a way again."""


MOST_OUTER = 256
"""Maps up to which they are counted one by one, where each may have several outer faces."""


@dataclass(frozen=True, slots=True)
class Doubt:
    """One thing that the walk leaves open.

    Attributes
    ----------
    kind
        ``"order"``: the order of the ways around a place. ``"ways"``: legs between two places may have gone one way or
        several. ``"outer"``: which face is the outer one. ``"uncounted"``: too much is open together to be counted.
        ``"noise"``: no map is left, so the readings err more than is declared, or places or exit counts are wrong.
    places
        The places it is about.
    orders
        For an order: those that are left, counter-clockwise, each way named by the place it leads to, or ``@edge`` where
        that is not enough. The likeliest first.
    text
        The doubt in words.
    """

    kind: DoubtKind
    places: tuple[str, ...]
    orders: tuple[tuple[str, ...], ...]
    text: str

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True, slots=True)
class Again:
    """What to do to settle a doubt.

    Attributes
    ----------
    place
        Where.
    ways
        The ways to walk again, each named as in `Doubt.orders`; empty where walking again does not help.
    passes
        How many times more each of them has to be walked: where the headings are as they seem now, plus and minus a standard
        deviation; None where it is more than 200 times or does not help.
    text
        The same in words, with what else would help.
    """

    place: str
    ways: tuple[str, ...]
    passes: tuple[int, int] | None
    text: str

    def __str__(self) -> str:
        return self.text


def way_labels(reading: Reading, place: int) -> list[str]:
    """Return a label for every dart of a place: where it leads, or ``@edge`` for one of several that lead there."""
    places, names = reading.evidence.places, reading.edge_names
    ends = []
    for dart in reading.darts[place]:
        way = reading.ways[dart >> 1]
        ends.append(way.head if dart % 2 == 0 else way.tail)
    return [
        places[end] if ends.count(end) == 1 and end != place else f"@{names[dart >> 1]}"
        for end, dart in zip(ends, reading.darts[place], strict=True)
    ]


def order_doubt(reading: Reading, place: int, left: Sequence[int]) -> Doubt:
    """Return the doubt about the order of the ways around a place, of which several are left."""
    labels = way_labels(reading, place)
    lifted = [reading.orders[place][number] for number in left]
    orders = [order.ways for order in lifted]
    name = quoted(reading.evidence.places[place])
    pairs = open_pairs(lifted)
    moving = sorted({way for pair in pairs for way in pair})
    dead = [_dead_end(reading, dart) for dart in reading.darts[place]]

    def way(i: int) -> str:
        label = labels[i]
        if label.startswith("@"):
            return f"the way {label}"
        return f"the dead end {quoted(label)}" if dead[i] else f"the way to {quoted(label)}"

    if len(orders) == 2 and len(moving) == 2:
        first, second = sorted(moving, key=lambda i: not dead[i])
        text = f"at {name} {way(first)} lies left or right of {way(second)}"
    else:
        ways = [way(i) for i in moving]
        text = (
            f"at {name} {counted(len(orders), 'order')} of its {len(labels)} ways are left: {', '.join(ways[:-1])} and "
            f"{ways[-1]} may change places"
        )
    return Doubt("order", (reading.evidence.places[place],), tuple(tuple(labels[i] for i in o) for o in orders), text)


def _dead_end(reading: Reading, dart: int) -> bool:
    way = reading.ways[dart >> 1]
    return len(reading.darts[way.head if dart % 2 == 0 else way.tail]) == 1


def order_again(reading: Reading, place: int, left: Sequence[int], directions: Directions | None) -> Again:
    """Return which ways of a place to walk again, and how often, until one order is left."""
    labels = way_labels(reading, place)
    orders = [reading.orders[place][number] for number in left]
    name = reading.evidence.places[place]
    darts = reading.darts[place]
    passes = [len(reading.ways[dart >> 1].legs) for dart in darts]
    variance = reading.variances[darts]
    single = reading.noise.sigma**2
    low, high, involved = 0, 0, set()
    for i, j in open_pairs(orders):
        involved |= {i, j}
        gap = abs((reading.headings[darts[i]] - reading.headings[darts[j]] + TAU / 2) % TAU - TAU / 2)
        spread = sqrt(variance[i] + variance[j])
        floor = max(0.0, variance[i] - single / passes[i]) + max(0.0, variance[j] - single / passes[j])
        for sign in (1, -1):
            more = _passes_needed(gap + sign * spread, passes[i], passes[j], single, floor, directions)
            if sign > 0:
                low = max(low, more)
            else:
                high = max(high, more)
    ways = tuple(labels[i] for i in sorted(involved))
    listing = "" if reading.noise.in_order and directions else f"list the exits of {quoted(name)} in their order"
    shown = " and ".join(quoted(label) for label in ways)
    if low > MOST_PASSES or not ways:
        also = f"; {listing}" if listing else ""
        return Again(name, ways, None, f"walking again does not settle it within {MOST_PASSES} passes{also}")
    bound = f"{low} to {high}" if high <= MOST_PASSES and high > low else f"{low}" if high == low else f"{low} or more"
    times = "time" if bound == "1" else "times"
    also = f", or {listing}" if listing else ""
    text = f"walk the {'way' if len(ways) == 1 else 'ways'} from {quoted(name)} to {shown} {bound} {times} more{also}"
    return Again(name, ways, (low, high if high <= MOST_PASSES else MOST_PASSES), text)


def open_pairs(orders: Sequence[StarOrder]) -> list[tuple[int, int]]:
    """Return pairs of ways that stand one way round in one order and the other way round in another, on the line."""
    found = set()
    first = orders[0]
    k = len(first.ways)
    lift = dict(zip(first.ways, first.lifts, strict=True))
    for order in orders[1:]:
        # lifts of one way differ by whole turns between orders: compare on the universal cover
        other = dict(zip(order.ways, order.lifts, strict=True))
        place = {w: n for n, w in enumerate(order.ways)}
        rank = {w: n for n, w in enumerate(first.ways)}
        for i in range(k):
            for j in range(k):
                if i == j:
                    continue
                for whole in (-1, 0, 1):
                    # position of i, and of j moved by whole turns, in both orders
                    turns_i = round((other[i] - lift[i]) / TAU)
                    turns_j = round((other[j] - lift[j]) / TAU)
                    before = (0, rank[i]) < (whole, rank[j])
                    after = (-turns_i, place[i]) < (whole - turns_j, place[j])
                    if before != after:
                        found.add((min(i, j), max(i, j)))
    return sorted(found)


def _passes_needed(gap: float, first: int, second: int, single: float, floor: float, directions: Directions | None) -> int:
    """Return how often two ways must be walked again for their order to be certain, or one more than `MOST_PASSES`."""
    if gap <= 0:
        return MOST_PASSES + 1

    def settled(more: int) -> bool:
        spread = single / (first + more) + single / (second + more) + floor
        if gap * gap > 2 * LOG_ODDS * spread:
            return True
        if directions is None or gap <= RESOLVED * sqrt(single):
            return False
        listed = single / (round(single / directions.variance) + 2 * more)
        return gap * gap * (0.5 / (single / (first + more) + listed) + 0.5 / (single / (second + more) + listed)) > LOG_ODDS

    if floor > 0 and gap * gap <= 2 * LOG_ODDS * floor:
        return MOST_PASSES + 1
    return next((more for more in range(1, MOST_PASSES + 1) if settled(more)), MOST_PASSES + 1)


def doubts_of(
    readings: Sequence[Reading], open_bundles: Sequence[Bundle], uncounted: Sequence[Bundle], *, counted_all: bool
) -> tuple[tuple[Doubt, ...], int | None]:
    """Return what the readings that are left leave open, and the number of maps, or None where they were not counted."""
    first = readings[0]
    places = first.evidence.places
    found: dict[tuple[str, tuple[str, ...]], Doubt] = {}
    for bundle in (*open_bundles, *uncounted):
        shares = {_share(reading, bundle) for reading in readings}
        if len(shares) > 1 or not counted_all or any(bundle is one for one in uncounted):
            number = len(shares) if counted_all and not any(bundle is one for one in uncounted) else None
            doubt = _ways_doubt(bundle, places, number)
            found.setdefault(("ways", doubt.places), doubt)
    total: int | None = 0
    for reading in readings:
        left = {} if reading.settled is None else reading.settled.left
        for place in sorted(left):
            key = ("order", (places[place],))
            if len(left[place]) > 1 and key not in found:
                found[key] = order_doubt(reading, place, left[place])
        number = _number_of_maps(reading)
        total = None if total is None or number is None else total + number
        if reading.noise.wanders and number != 0:
            outer = _outer_doubt(reading)
            if outer is not None:
                found.setdefault(("outer", ()), outer)
        for doubt in _corner_doubts(reading):
            found.setdefault(("outer", doubt.places), doubt)
        for doubt in _uncounted_doubts(reading):
            found.setdefault(("uncounted", doubt.places), doubt)
    if not counted_all or uncounted:
        total = None
    return tuple(found.values()), total


def _number_of_maps(reading: Reading) -> int | None:
    if reading.settled is None:
        return None
    if not reading.noise.wanders or reading.settled.count is None:
        return reading.settled.count
    found = list(islice(reading.found(), MOST_OUTER + 1))
    return len(found) if len(found) <= MOST_OUTER and not reading.untold else None


def _outer_doubt(reading: Reading) -> Doubt | None:
    """Return the doubt about which face is the outer one, if the likeliest map has several."""
    likeliest = reading.outer_faces()
    if likeliest == 1 and not reading.untold:
        return None
    if reading.untold:
        text = "the map has too many faces, or too many narrow corners, to tell the outer one by likelihood"
    else:
        text = f"which face is the outer one: {counted(likeliest, 'face')} can be"
    return Doubt("outer", (), (), text)


def _corner_doubts(reading: Reading) -> list[Doubt]:
    """Return doubts about the outer face where no rotation tells it: two ways nearly the same, or a way that winds."""
    places = reading.evidence.places
    found = []
    for factor in reading.settled.factors if reading.settled else ():
        if factor.outer > 1:
            names = tuple(places[place] for place in factor.places)
            shown = ", ".join(map(quoted, names[:4])) + (f" and {len(names) - 4} more" if len(names) > 4 else "")
            why = f", as a corner at {shown} may be narrow or wide" if names else ", as a way may wind once more"
            text = f"which face is the outer one: {counted(factor.outer, 'face')} can be{why}"
            found.append(Doubt("outer", names, (), text))
    return found


def _uncounted_doubts(reading: Reading) -> list[Doubt]:
    places = reading.evidence.places
    found = []
    for place in reading.crowded:
        text = f"the ways at {quoted(places[place])} lie too close together for their orders to be listed"
        found.append(Doubt("uncounted", (places[place],), (), text))
    for factor in reading.settled.factors if reading.settled else ():
        if factor.count is None:
            names = tuple(places[place] for place in factor.places)
            shown = ", ".join(map(quoted, names[:4])) + (f" and {len(names) - 4} more" if len(names) > 4 else "")
            text = f"the orders at {counted(len(names), 'place')} hang together, and their maps were not counted: {shown}"
            found.append(Doubt("uncounted", names, (), text))
    return found


def _share(reading: Reading, bundle: Bundle) -> tuple[tuple[int, ...], ...]:
    """Return how a reading shares out the legs of a bundle among ways."""
    legs = set(bundle.legs.tolist())
    return tuple(tuple(way.legs.tolist()) for way in reading.ways if legs.issuperset(way.legs.tolist()))


def _ways_doubt(bundle: Bundle, places: Sequence[str], readings: int | None) -> Doubt:
    ends = tuple(dict.fromkeys((places[bundle.tail], places[bundle.head])))
    between = f"from {quoted(ends[0])} back to it" if len(ends) == 1 else f"between {quoted(ends[0])} and {quoted(ends[1])}"
    number = "" if readings is None else f", {counted(readings, 'reading')}"
    text = f"{counted(len(bundle.legs), 'leg')} {between} went one way or several{number}"
    return Doubt("ways", ends, (), text)


def again(doubt: Doubt, readings: Sequence[Reading], directions: Sequence[Directions | None]) -> Again | None:
    """Return what to do to settle a doubt, or None where no walk would."""
    if doubt.kind == "ways":
        ends = " and ".join(map(quoted, doubt.places))
        name = doubt.places[0]
        return Again(name, (), None, f"take the exits of {ends} that were not taken, or let the log name the edges there")
    if doubt.kind == "outer":
        return Again("", (), None, "walk once around the whole map with a compass, or around its outermost ways again")
    if doubt.kind != "order":
        return None
    for reading in readings:
        place = reading.evidence.places.index(doubt.places[0])
        left = [] if reading.settled is None else reading.settled.left.get(place, [])
        if len(left) > 1:
            return order_again(reading, place, left, directions[place])
    return None
