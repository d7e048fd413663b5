"""Kernels of the search for quotients of a folded walk: a plane map with stubs that grows by one decision at a time.

A *place* is a set of nodes that are one, with the exits of its first node. A *stub* is an exit of a place that has no mate
yet. Deciding a stub means to say where the way behind it ends: at a new place, or at another stub of the same face, whose
*contour* is walked clockwise from stub to stub. Whatever follows is folded in: the nodes beyond both exits become one, and
so on. Every decision is taken back exactly.

Arrays are in one named tuple, `Quotient`; columns have names below. Exit x of node n is ``n * K + x``, exit x of place w is
``w * K + x``. Angles are radians. All functions change the arrays they are given.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold._kernels import kernel

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["Quotient", "searched"]

# columns of `node`
DEGREE, PLACE, SHIFT, NEXT, SIGN, UNITS, FAILS, GROUP = 0, 1, 2, 3, 4, 5, 6, 7
# columns of `way`
OTHER, BACK, KIND, LENGTH, BEYOND = 0, 1, 2, 3, 4
# columns of `angle` and `bearing`
HEADING, TURN = 0, 1
# columns of `place`: DEGREE, FIRST, SIGN_OF_PLACE, REFERENCE, EARLIEST
FIRST, SIGN_OF_PLACE, REFERENCE, EARLIEST = 1, 2, 3, 4
# columns of `exit`
MATE, KIND_OF_EXIT, SEEN, ENTERED, ENTERED_BY, CLOCKWISE = 0, 1, 2, 3, 4, 5
# columns of `group`
PLACED, PLACE_OF_GROUP = 0, 1
# columns of `balance`
HERE, SURPLUS, LACK = 0, 1, 2
# columns of `kind`
STUBS, ENDS, COMPONENT, SIDE = 0, 1, 2, 3
# columns of `sign`, kinds of its exits after them
UNITS_LEFT, DEMAND, DEGREE_OF_SIGN, KINDS = 0, 1, 2, 3
# rows of `number`
N_PLACES, N_TRAIL, TURN_LEFT, RELATIVE, CLOSED, STRICT, WORK = 0, 1, 2, 3, 4, 5, 6
# rows of `limit`
TOLERANCE, MOST_PLACES = 0, 1
# rows of `control`, how the search stands
DEPTH, TOP, GOING_DOWN, N_DECISIONS, N_FOUND, DONE = 0, 1, 2, 3, 4, 5
# columns of `frame`
STUB, BOTTOM, TRAIL_BEFORE, PLACES_BEFORE, ENTERED_STUB = 0, 1, 2, 3, 4

NONE = -1
NOTHING = -2
MICRO = 1e-6
"""Radians in a unit of `LENGTH` and `TURN_LEFT`, which are whole numbers so that they come back exactly."""


class Quotient(NamedTuple):
    """The tree of a walk and a quotient in the making: N nodes, at most P places, K exits each, C kinds, S signatures."""

    node: NDArray[np.int64]
    """(N, 8): degree; place, shift, next node of the same place; signature; places a node can stand in for; failures; group
    of nodes that must be one place, or -1."""
    way: NDArray[np.int64]
    """(N K, 5): other node, exit there, kind; microradians that its edge can turn; edges of the tree out that way."""
    angle: NDArray[np.float64]
    """(N K, 2): heading, net turn."""
    alike: NDArray[np.int64]
    """(N, N): shifts under which two nodes can be one, as bits."""
    place: NDArray[np.int64]
    """(P, 5): degree, first node of the list, signature, node whose exits it has, and its earliest node."""
    exit: NDArray[np.int64]
    """(P K, 6): mate or -1, kind, a mark, how many ways may enter here and the last of them, the next exit clockwise."""
    bearing: NDArray[np.float64]
    """(P K, 2): heading, net turn of the edge."""
    kind: NDArray[np.int64]
    """(C, 4): stubs, ends of walked ways not placed; component and side of kinds joined by ways, if they have two sides."""
    sign: NDArray[np.int64]
    """(S, 3 + K): units left, units needed, degree, kinds."""
    bend: NDArray[np.float64]
    """(S,): largest reflex turn of a place."""
    surplus: NDArray[np.int64]
    """(S, B): exits of one side beyond those of the other, per component."""
    number: NDArray[np.int64]
    """(7,): places, length of the trail, microradians that edges not placed can turn, flags; ends looked at so far."""
    limit: NDArray[np.float64]
    """(2,): tolerance, radians; most places."""
    trail: NDArray[np.int64]
    """(N,): nodes in the order placed."""
    group: NDArray[np.int64]
    """(G, 2): nodes placed of every group, and their place."""
    queue: NDArray[np.int64]
    """(Q, 3)."""
    stub: NDArray[np.int64]
    """(P K + 2,): stubs along a contour."""
    turned: NDArray[np.float64]
    """(P K + 2,): turn from the first stub to each of them."""
    option: NDArray[np.int64]
    """(P K + 2,): options of a stub."""
    balance: NDArray[np.int64]
    """(B, 3)."""
    start: NDArray[np.int64]
    """(N K + 1,): where the candidates of an exit begin."""
    candidate: NDArray[np.int64]
    """Exits of nodes that walk through an exit of a place that has this node's exits."""


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


@kernel
def places_possible(q, s):  # type: ignore[no-untyped-def]
    """Return how many places of a signature can still be made: ways left must cover every exit, and the stubs there are."""
    most = (q.sign[s, UNITS_LEFT] - q.sign[s, DEMAND]) // ((q.sign[s, DEGREE_OF_SIGN] + 1) // 2)
    for x in range(q.sign[s, DEGREE_OF_SIGN]):
        k = q.sign[s, KINDS + x]
        spare = q.kind[k, ENDS] - q.kind[k, STUBS]
        if spare < most:
            most = spare
    return most


@kernel
def demanded(q):  # type: ignore[no-untyped-def]
    """Work out what open exits that no way leads through demand of nodes left; return whether there are enough.

    A node left covers some exits of one place: the sum over places of half their open exits, rounded up, is at most the sum
    over nodes of half the ways they walk, rounded up.
    """
    width = q.exit.shape[0] // q.place.shape[0]
    for s in range(q.sign.shape[0]):
        q.sign[s, DEMAND] = 0
    for w in range(q.number[N_PLACES]):
        unwalked = 0
        for x in range(q.place[w, DEGREE]):
            e = w * width + x
            if q.exit[e, MATE] < 0 and walked_from(q, e) < 0:
                unwalked += 1
        q.sign[q.place[w, SIGN_OF_PLACE], DEMAND] += (unwalked + 1) // 2
    enough = True
    for s in range(q.sign.shape[0]):
        enough = enough and q.sign[s, DEMAND] <= q.sign[s, UNITS_LEFT]
    return enough


@kernel
def within_budget(q):  # type: ignore[no-untyped-def]
    """Return whether every face can still turn as it must.

    A chain is the piece of a face between two stubs. An inner face of the whole map has 2 pi more positive turn than
    negative, so what a chain has beyond 2 pi must be paid for by negative turn elsewhere in its region: by other chains
    there, by places not made yet, or by edges not placed yet. And where ways join kinds of exits of two sides, the stubs of
    a region must be balanced by places to come.
    """
    width = q.exit.shape[0] // q.place.shape[0]
    sides = q.balance.shape[0]
    possible = q.number[TURN_LEFT] * MICRO
    for s in range(q.sign.shape[0]):
        if q.bend[s] > 0:
            possible += max(places_possible(q, s), 0) * q.bend[s]
    for b in range(sides):
        q.balance[b, SURPLUS] = 0
        q.balance[b, LACK] = 0
    for w in range(q.number[N_PLACES]):
        for x in range(q.place[w, DEGREE]):
            q.exit[w * width + x, SEEN] = 0
    needed = 0.0
    for w in range(q.number[N_PLACES]):
        for first in range(q.place[w, DEGREE]):
            begin = w * width + first
            if q.exit[begin, MATE] >= 0 or q.exit[begin, SEEN]:
                continue
            for b in range(sides):
                q.balance[b, HERE] = 0
            excess = 0.0
            negative = 0.0
            parts = 0
            edges = 0
            total = 0.0
            paid = 0.0
            stubs = 0
            x = begin
            while True:
                q.exit[x, SEEN] = 1
                stubs += 1
                if q.number[RELATIVE]:
                    edges += ahead(q, x)
                k = q.exit[x, KIND_OF_EXIT]
                if q.kind[k, COMPONENT] >= 0:
                    q.balance[q.kind[k, COMPONENT], HERE] += q.kind[k, SIDE]
                up = 0.0
                down = 0.0
                before = x
                while True:
                    x = clockwise(q, x)
                    angle = np.pi - corner(q, before, x)
                    parts += 2
                    up += max(angle, 0.0)
                    down += max(-angle, 0.0)
                    if q.exit[x, MATE] < 0:
                        break
                    angle = q.bearing[x, TURN]
                    up += max(angle, 0.0)
                    down += max(-angle, 0.0)
                    before = q.exit[x, MATE]
                    x = before
                excess += max(up - 2 * np.pi, 0.0)
                paid += min(up, down)
                negative += down
                total += up - down
                if x == begin:
                    break
            for b in range(sides):
                if q.balance[b, HERE] > 0:
                    q.balance[b, SURPLUS] += q.balance[b, HERE]
                else:
                    q.balance[b, LACK] -= q.balance[b, HERE]
            total -= np.pi * stubs
            may_err = 0.0
            if q.number[RELATIVE]:
                may_err = 3 * parts * q.limit[TOLERANCE]
                negative += may_err
                may_err += 4 * edges * q.limit[TOLERANCE]
            if total < 0 and total + may_err < 2 * np.pi:  # it holds the outer face: 2 pi more negative turn than positive
                excess = max(excess, paid) + 2 * np.pi
            needed += max(excess - negative, 0.0)
            if needed > possible + 1e-5:
                return False
    for b in range(sides):
        if q.balance[b, SURPLUS] > 0 or q.balance[b, LACK] > 0:
            up_left = 0
            down_left = 0
            for s in range(q.sign.shape[0]):
                if q.surplus[s, b]:
                    most = max(places_possible(q, s), 0)
                    up_left += most * max(q.surplus[s, b], 0)
                    down_left += most * max(-q.surplus[s, b], 0)
            if q.balance[b, SURPLUS] > down_left or q.balance[b, LACK] > up_left:
                return False
    return True


@kernel
def decided(q, stub, end):  # type: ignore[no-untyped-def]
    """Let the way through a stub end at another stub, or at a new place (-1).

    Returns (the stub entered, whether that can be); either way it is to be taken back by `undone`.
    """
    width = q.exit.shape[0] // q.place.shape[0]
    walked = walked_from(q, stub)
    m = q.way[walked, OTHER]
    turn = q.angle[walked, TURN]
    new = end == -1
    if new:
        end = place_made(q, m) * width + q.way[walked, BACK]
    settled = turn
    if not q.number[RELATIVE]:
        settled += wrapped(q.bearing[end, HEADING] + np.pi - q.bearing[stub, HEADING] - turn)
    q.exit[stub, MATE] = end
    q.exit[end, MATE] = stub
    q.bearing[stub, TURN] = settled
    q.bearing[end, TURN] = -settled
    q.kind[q.exit[stub, KIND_OF_EXIT], STUBS] -= 1
    q.kind[q.exit[end, KIND_OF_EXIT], STUBS] -= 1
    count_between(q, stub, -1)
    if new and not put(q, m, end // width, 0):
        return end, False
    if not folded(q, stub, end):
        return end, False
    if q.number[RELATIVE] and q.number[STRICT] == 1 and not (may_turn(q, stub) and may_turn(q, end)):
        return end, False
    if q.number[CLOSED] == 1:
        for k in range(q.kind.shape[0]):
            if q.kind[k, STUBS] > q.kind[k, ENDS]:
                return end, False
        if not demanded(q):
            return end, False
        if q.number[STRICT] == 1 and not within_budget(q):
            return end, False
    return end, True


@kernel
def undone(q, stub, end, trail, places):  # type: ignore[no-untyped-def]
    """Take a decision back: the trail and the places are as they were."""
    width = q.exit.shape[0] // q.place.shape[0]
    taken_back(q, trail)
    count_between(q, stub, 1)
    q.exit[stub, MATE] = -1
    q.exit[end, MATE] = -1
    q.kind[q.exit[stub, KIND_OF_EXIT], STUBS] += 1
    q.kind[q.exit[end, KIND_OF_EXIT], STUBS] += 1
    if q.number[N_PLACES] > places:
        q.number[N_PLACES] = places
        for x in range(q.place[places, DEGREE]):
            q.kind[q.exit[places * width + x, KIND_OF_EXIT], STUBS] -= 1


@kernel
def branch(q, best):  # type: ignore[no-untyped-def]
    """Choose the stub to decide next, the one with the fewest ends; they are put into `best`.

    Returns (stub or -1 if all walked ways are placed, number of ends). For closed maps, a stub that no way leads through has
    to be entered by some: by none of those that end in its face or by a node still to come, it fails; by one alone, that one
    is decided.
    """
    width = q.exit.shape[0] // q.place.shape[0]
    closed = q.number[CLOSED] == 1
    chosen = -1
    fewest = 1 << 30
    heaviest = -1
    if closed:
        for e in range(q.number[N_PLACES] * width):
            q.exit[e, ENTERED] = 0
    may_be_new = q.number[N_PLACES] < q.limit[MOST_PLACES]
    for w in range(q.number[N_PLACES]):
        for x in range(q.place[w, DEGREE]):
            q.exit[w * width + x, SEEN] = 0
    for w in range(q.number[N_PLACES]):
        for x in range(q.place[w, DEGREE]):
            begin = w * width + x
            if q.exit[begin, MATE] >= 0 or q.exit[begin, SEEN]:
                continue
            met = contour(q, begin)
            for at in range(met):
                e = q.stub[at]
                walked = walked_from(q, e)
                if walked < 0:
                    continue
                m = q.way[walked, OTHER]
                found = options(q, at, met, walked, may_be_new)
                if closed:
                    for j in range(found):
                        if q.option[j] >= 0:
                            q.exit[q.option[j], ENTERED] += 1
                            q.exit[q.option[j], ENTERED_BY] = e
                if found == 0:
                    q.node[m, FAILS] += 1
                    return e, 0
                if found < fewest or (found == fewest and found > 1 and q.node[m, FAILS] > heaviest):
                    chosen = e
                    fewest = found
                    heaviest = q.node[m, FAILS]
                    for j in range(found):
                        best[j] = q.option[j]
    if not closed or chosen < 0:
        return chosen, fewest
    for w in range(q.number[N_PLACES]):
        for x in range(q.place[w, DEGREE]):
            e = w * width + x
            if (
                q.exit[e, MATE] >= 0
                or q.exit[e, ENTERED] > 1
                or (q.exit[e, ENTERED] == 1 and fewest == 1)
                or walked_from(q, e) >= 0
            ):
                continue
            reference = q.place[w, REFERENCE]
            own = reference * width + (x - q.node[reference, SHIFT]) % q.place[w, DEGREE]
            later = False
            for i in range(q.start[own], q.start[own + 1]):
                n = q.candidate[i] // width
                if q.node[n, PLACE] < 0 and q.node[q.way[q.candidate[i], OTHER], PLACE] < 0:
                    later = True
                    break
            if later:
                continue
            if q.exit[e, ENTERED] == 0:
                return e, 0
            chosen = q.exit[e, ENTERED_BY]
            fewest = 1
            best[0] = e
    return chosen, fewest


@kernel(compile_seconds=9.0)
def searched(q, control, frame, choice, best, out, stop):  # type: ignore[no-untyped-def]
    """Search on from where the search stands; return how many quotients were found, the places of all nodes in `out`.

    Parameters: control (6,), frame (depth, 5) and choice say how the search stands; best is scratch; out (B, N, 2) takes
    place and shift of every node; stop is a number of decisions. Returns early when `out` is full; control[DONE] tells the
    end.
    """
    found = 0
    made = 0
    down = control[GOING_DOWN] == 1
    depth = control[DEPTH]
    top = control[TOP]
    while True:
        if down:
            if made >= stop or found == out.shape[0]:
                control[GOING_DOWN] = 1
                break
            made += 1
            stub, number = branch(q, best)
            if stub < 0:
                whole = True
                if q.number[CLOSED] == 1:
                    for k in range(q.kind.shape[0]):
                        if q.kind[k, STUBS] > 0:
                            whole = False
                if whole and q.number[RELATIVE] and q.number[STRICT] == 1:
                    whole = turns_once(q)
                if whole:
                    for n in range(q.node.shape[0]):
                        out[found, n, 0] = q.node[n, PLACE]
                        out[found, n, 1] = q.node[n, SHIFT]
                    found += 1
            else:
                frame[depth, STUB] = stub
                frame[depth, BOTTOM] = top
                for j in range(number):
                    choice[top + j] = best[number - 1 - j]
                top += number
                frame[depth, TRAIL_BEFORE] = q.number[N_TRAIL]
                frame[depth, PLACES_BEFORE] = q.number[N_PLACES]
                frame[depth, ENTERED_STUB] = NOTHING
                depth += 1
        if depth == 0:
            control[DONE] = 1
            break
        f = depth - 1
        if frame[f, ENTERED_STUB] != NOTHING:
            undone(q, frame[f, STUB], frame[f, ENTERED_STUB], frame[f, TRAIL_BEFORE], frame[f, PLACES_BEFORE])
            frame[f, ENTERED_STUB] = NOTHING
        if top <= frame[f, BOTTOM]:
            depth -= 1
            down = False
            continue
        top -= 1
        end, down = decided(q, frame[f, STUB], choice[top])
        frame[f, ENTERED_STUB] = end
    control[DEPTH] = depth
    control[TOP] = top
    control[N_DECISIONS] += made
    control[N_FOUND] += found
    return found
