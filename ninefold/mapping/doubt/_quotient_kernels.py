"""Kernels of a plane map with stubs, a quotient of a folded walk in the making: its places and its faces.

A *place* is a set of nodes that are one, with the exits of its first node. A *stub* is an exit of a place that has no mate
yet. Deciding a stub means to say where the way behind it ends: at a new place, or at another stub of the same face, whose
*contour* is walked clockwise from stub to stub. Whatever follows is folded in: the nodes beyond both exits become one, and
so on. Every decision is taken back exactly.

All of it is arrays in one named tuple, `Quotient` of ``_quotient_state``, which all functions change.
"""

from __future__ import annotations

import numpy as np

from ninefold._kernels import kernel

from ._quotient_state import (
    BACK,
    BEYOND,
    CLOCKWISE,
    DEGREE,
    EARLIEST,
    ENDS,
    FIRST,
    GROUP,
    HEADING,
    KIND,
    KIND_OF_EXIT,
    LENGTH,
    MATE,
    N_PLACES,
    N_TRAIL,
    NEXT,
    OTHER,
    PLACE,
    PLACE_OF_GROUP,
    PLACED,
    REFERENCE,
    RELATIVE,
    SEEN,
    SHIFT,
    SIGN,
    SIGN_OF_PLACE,
    STRICT,
    STUBS,
    TOLERANCE,
    TURN,
    TURN_LEFT,
    UNITS,
    UNITS_LEFT,
    WORK,
)

__all__ = [
    "ahead",
    "clockwise",
    "contour",
    "corner",
    "count_between",
    "folded",
    "may_turn",
    "options",
    "place_made",
    "put",
    "taken_back",
    "turns_once",
    "walked_from",
    "wrapped",
]


@kernel
def wrapped(angle):  # type: ignore[no-untyped-def]
    """Return an angle in [-pi, pi)."""
    return (angle + np.pi) % (2 * np.pi) - np.pi


@kernel
def clockwise(q, x):  # type: ignore[no-untyped-def]
    """Return the exit of the same place that is next clockwise."""
    return q.exit[x, CLOCKWISE]


@kernel
def corner(q, after, before):  # type: ignore[no-untyped-def]
    """Return the angle counter-clockwise from exit `before` to exit `after` of one place, in (0, 2 pi]."""
    angle = q.bearing[after, HEADING] - q.bearing[before, HEADING]  # the headings of a place lie within one turn
    return angle if angle > 0.0 else angle + 2 * np.pi


@kernel
def place_made(q, n):  # type: ignore[no-untyped-def]
    """Make a place with the exits of a node; return it. The node is not put there yet."""
    width = q.exit.shape[0] // q.place.shape[0]
    w = q.number[N_PLACES]
    q.number[N_PLACES] += 1
    q.place[w, DEGREE] = q.node[n, DEGREE]
    q.place[w, FIRST] = -1
    q.place[w, SIGN_OF_PLACE] = q.node[n, SIGN]
    q.place[w, REFERENCE] = n
    for x in range(q.node[n, DEGREE]):
        e = w * width + x
        q.exit[e, MATE] = -1
        q.exit[e, CLOCKWISE] = e - 1 if x else e + q.node[n, DEGREE] - 1
        q.exit[e, KIND_OF_EXIT] = q.way[n * width + x, KIND]
        q.bearing[e, HEADING] = q.angle[n * width + x, HEADING]
        q.kind[q.exit[e, KIND_OF_EXIT], STUBS] += 1
    return w


@kernel
def count_way(q, n, x, change):  # type: ignore[no-untyped-def]
    """Count the way that a placed node walked through an exit, if it is decided, among those left (+1) or no more (-1)."""
    width = q.exit.shape[0] // q.place.shape[0]
    e = n * width + x
    m = q.way[e, OTHER]
    if m < 0 or q.node[m, PLACE] < 0:
        return
    if q.exit[q.node[n, PLACE] * width + (x + q.node[n, SHIFT]) % q.node[n, DEGREE], MATE] < 0:
        return
    q.kind[q.way[e, KIND], ENDS] += change
    q.kind[q.way[m * width + q.way[e, BACK], KIND], ENDS] += change
    q.number[TURN_LEFT] += change * q.way[e, LENGTH]


@kernel
def count_between(q, stub, change):  # type: ignore[no-untyped-def]
    """Count the ways through a stub between nodes that were placed before it is decided; there are none in a tree."""
    width = q.exit.shape[0] // q.place.shape[0]
    n = q.place[stub // width, FIRST]
    while n >= 0:
        count_way(q, n, (stub % width - q.node[n, SHIFT]) % q.node[n, DEGREE], change)
        n = q.node[n, NEXT]


@kernel
def put(q, n, w, shift):  # type: ignore[no-untyped-def]
    """Put a node, and all nodes that follow, into places; return whether that can be. What is done is on the trail."""
    width = q.exit.shape[0] // q.place.shape[0]
    head = 0
    tail = 1
    q.queue[0, 0] = n
    q.queue[0, 1] = w
    q.queue[0, 2] = shift
    while head < tail:
        n = q.queue[head, 0]
        w = q.queue[head, 1]
        shift = q.queue[head, 2]
        head += 1
        if q.node[n, PLACE] >= 0:
            if q.node[n, PLACE] != w or q.node[n, SHIFT] != shift:
                return False
            continue
        degree = q.node[n, DEGREE]
        if q.place[w, DEGREE] != degree:
            return False
        m = q.place[w, FIRST]
        while m >= 0:
            if degree > 0 and not (q.alike[n, m] >> ((shift - q.node[m, SHIFT]) % degree)) & 1:
                return False
            m = q.node[m, NEXT]
        g = q.node[n, GROUP]
        if g >= 0:
            if q.group[g, PLACED] > 0 and q.group[g, PLACE_OF_GROUP] != w:
                return False
            q.group[g, PLACED] += 1
            q.group[g, PLACE_OF_GROUP] = w
        q.node[n, PLACE] = w
        q.node[n, SHIFT] = shift
        q.node[n, NEXT] = q.place[w, FIRST]
        q.place[w, FIRST] = n
        q.sign[q.node[n, SIGN], UNITS_LEFT] -= q.node[n, UNITS]
        q.trail[q.number[N_TRAIL]] = n
        q.number[N_TRAIL] += 1
        for x in range(degree):
            if q.way[n * width + x, OTHER] != n or q.way[n * width + x, BACK] > x:
                count_way(q, n, x, -1)
        for x in range(degree):
            e = n * width + x
            m = q.way[e, OTHER]
            if m < 0:
                continue
            back = q.way[e, BACK]
            mate = q.exit[w * width + (x + shift) % degree, MATE]
            if mate >= 0:
                other = mate // width
                if q.place[other, DEGREE] != q.node[m, DEGREE]:
                    return False
                q.queue[tail, 0] = m
                q.queue[tail, 1] = other
                q.queue[tail, 2] = (mate % width - back) % q.node[m, DEGREE]
                tail += 1
    return True


@kernel
def taken_back(q, mark):  # type: ignore[no-untyped-def]
    """Take nodes out of their places again until the trail is as long as it was."""
    width = q.exit.shape[0] // q.place.shape[0]
    while q.number[N_TRAIL] > mark:
        q.number[N_TRAIL] -= 1
        n = q.trail[q.number[N_TRAIL]]
        for x in range(q.node[n, DEGREE]):
            if q.way[n * width + x, OTHER] != n or q.way[n * width + x, BACK] > x:
                count_way(q, n, x, 1)
        if q.node[n, GROUP] >= 0:
            q.group[q.node[n, GROUP], PLACED] -= 1
        q.place[q.node[n, PLACE], FIRST] = q.node[n, NEXT]
        q.node[n, PLACE] = -1
        q.sign[q.node[n, SIGN], UNITS_LEFT] += q.node[n, UNITS]


@kernel
def folded(q, a, b):  # type: ignore[no-untyped-def]
    """Let what lies beyond two exits that are mates now be one; return whether it can."""
    width = q.exit.shape[0] // q.place.shape[0]
    for _ in range(2):
        there = b // width
        n = q.place[a // width, FIRST]
        while n >= 0:
            x = (a % width - q.node[n, SHIFT]) % q.node[n, DEGREE]
            m = q.way[n * width + x, OTHER]
            if m >= 0:
                if q.node[m, DEGREE] != q.place[there, DEGREE]:
                    return False
                if not put(q, m, there, (b % width - q.way[n * width + x, BACK]) % q.node[m, DEGREE]):
                    return False
            n = q.node[n, NEXT]
        a, b = b, a
    return True


@kernel
def walked_from(q, stub):  # type: ignore[no-untyped-def]
    """Return an exit of a placed node whose way leads through this stub, as node * K + exit, or -1."""
    width = q.exit.shape[0] // q.place.shape[0]
    n = q.place[stub // width, FIRST]
    while n >= 0:
        e = n * width + (stub % width - q.node[n, SHIFT]) % q.node[n, DEGREE]
        if q.way[e, OTHER] >= 0:
            return e
        n = q.node[n, NEXT]
    return -1


@kernel
def contour(q, begin):  # type: ignore[no-untyped-def]
    """Walk the face around a stub clockwise; return the number of its stubs, which are in `stub` in order, this one first.

    In `turned` is how far the way has turned at each of them since the first, half a turn less; and, after the last, all
    the way round.
    """
    met = 1
    total = 0.0
    q.stub[0] = begin
    q.turned[0] = 0.0
    q.exit[begin, SEEN] = 1
    before = begin
    x = begin
    while True:
        x = clockwise(q, x)
        angle = corner(q, before, x)
        if x == begin:
            q.turned[met] = total - angle
            break
        if q.exit[x, MATE] < 0:
            q.exit[x, SEEN] = 1
            q.stub[met] = x
            q.turned[met] = total - angle
            met += 1
        else:
            total += np.pi - angle + q.bearing[x, TURN]
            before = q.exit[x, MATE]
            x = before
    return met


@kernel
def ahead(q, stub):  # type: ignore[no-untyped-def]
    """Return how many edges of the tree lie behind a stub."""
    width = q.exit.shape[0] // q.place.shape[0]
    n = q.place[stub // width, FIRST]
    edges = 0
    while n >= 0:
        e = n * width + (stub % width - q.node[n, SHIFT]) % q.node[n, DEGREE]
        if q.way[e, OTHER] >= 0:
            edges += q.way[e, BEYOND]
        n = q.node[n, NEXT]
    return edges


@kernel
def may_turn(q, dart):  # type: ignore[no-untyped-def]
    """Return whether, without a compass, the face left of a way can be made of faces that turn once.

    In the end every corner and leg of a face may err by the tolerance. Here each is measured by the nodes that are placed
    already, which differ from the first ones by twice the tolerance at most; and every edge to come adds two of each.
    """
    total = 0.0
    legs = 0
    edges = 0
    x = dart
    while True:
        total += q.bearing[x, TURN]
        legs += 1
        before = q.exit[x, MATE]
        x = clockwise(q, before)
        while q.exit[x, MATE] < 0:
            edges += ahead(q, x)
            x = clockwise(q, x)
        total += np.pi - corner(q, before, x)
        if x == dart:
            break
    own = 2 * legs * q.limit[TOLERANCE]
    if edges == 0:
        own = min(own, np.pi)
    allowed = own + 4 * (legs + edges) * q.limit[TOLERANCE]
    return abs(abs(total) - 2 * np.pi) <= allowed + 1e-6


@kernel
def turns_once(q):  # type: ignore[no-untyped-def]
    """Return whether, without a compass, all faces of a whole quotient turn +1 and one -1.

    The corners are those of the earliest node of every place, the turns those of the leg walked first. A face turns a whole
    number of times if it does within the tolerance for every corner and leg, and by less than half a turn.
    """
    width = q.exit.shape[0] // q.place.shape[0]
    for w in range(q.number[N_PLACES]):
        n = q.place[w, FIRST]
        q.place[w, EARLIEST] = n
        while n >= 0:
            q.place[w, EARLIEST] = min(q.place[w, EARLIEST], n)
            n = q.node[n, NEXT]
        for x in range(q.place[w, DEGREE]):
            q.exit[w * width + x, SEEN] = 0
    outer = 0
    for begin in range(q.number[N_PLACES] * width):
        if begin % width >= q.place[begin // width, DEGREE] or q.exit[begin, MATE] < 0 or q.exit[begin, SEEN]:
            continue
        total = 0.0
        legs = 0
        x = begin
        while True:
            q.exit[x, SEEN] = 1
            legs += 1
            total += first_turn(q, x)
            before = q.exit[x, MATE]
            x = clockwise(q, before)
            while q.exit[x, MATE] < 0:
                x = clockwise(q, x)
            n = q.place[x // width, EARLIEST]
            degree = q.node[n, DEGREE]
            after = q.angle[n * width + (before % width - q.node[n, SHIFT]) % degree, HEADING]
            angle = (after - q.angle[n * width + (x % width - q.node[n, SHIFT]) % degree, HEADING]) % (2 * np.pi)
            total += np.pi - (2 * np.pi if x == before else angle)
            if x == begin:
                break
        allowed = min(2 * legs * q.limit[TOLERANCE] + 1e-9, np.pi - 1e-6)
        if abs(total + 2 * np.pi) <= allowed:
            outer += 1
        elif abs(total - 2 * np.pi) > allowed:
            return False
    return outer == 1 or q.node.shape[0] == 1


@kernel
def first_turn(q, dart):  # type: ignore[no-untyped-def]
    """Return the net turn along a way, by the leg that was walked first. A leg is numbered by the node it led to."""
    width = q.exit.shape[0] // q.place.shape[0]
    earliest = q.node.shape[0]
    turn = 0.0
    n = q.place[dart // width, FIRST]
    while n >= 0:
        e = n * width + (dart % width - q.node[n, SHIFT]) % q.node[n, DEGREE]
        if q.way[e, OTHER] >= 0 and max(n, q.way[e, OTHER]) < earliest:
            earliest = max(n, q.way[e, OTHER])
            turn = q.angle[e, TURN]
        n = q.node[n, NEXT]
    return turn


@kernel
def options(q, at, met, walked, may_be_new):  # type: ignore[no-untyped-def]
    """Return how many ends the way through a stub of a contour can have; they are in `option`, -1 for a new place."""
    width = q.exit.shape[0] // q.place.shape[0]
    stub = q.stub[at]
    m = q.way[walked, OTHER]
    back = q.way[walked, BACK]
    kind = q.way[m * width + back, KIND]
    turn = q.angle[walked, TURN]
    degree = q.node[m, DEGREE]
    judged = q.number[STRICT] == 1 and q.number[RELATIVE] == 0
    q.number[WORK] += met
    found = 0
    end = -1
    if q.node[m, PLACE] >= 0:  # no tree, where claims made nodes one: what lies beyond may be placed already
        end = q.node[m, PLACE] * width + (back + q.node[m, SHIFT]) % degree
    elif may_be_new:
        q.option[0] = -1
        found = 1
    for step in range(1, met):
        j = at + step
        turned = q.turned[met] + np.pi - q.turned[at]
        if j < met:
            turned = np.pi - q.turned[at]
        else:
            j -= met
        other = q.stub[j]
        if q.exit[other, KIND_OF_EXIT] != kind or (end >= 0 and other != end):
            continue
        w = other // width
        first = q.place[w, FIRST]
        if not (q.alike[m, first] >> ((other - w * width - back - q.node[first, SHIFT]) % degree)) & 1:
            continue
        if judged:
            miss = wrapped(q.bearing[other, HEADING] + np.pi - q.bearing[stub, HEADING] - turn)
            turns = (turned + q.turned[j] - turn - miss) / (2 * np.pi)
            nearest = int(np.rint(turns))
            if abs(turns - nearest) > 0.02:
                continue
            if nearest != 1 and (nearest != -1 or q.turned[met] > 0):
                continue
        q.option[found] = other
        found += 1
    return found
