"""Kernels of the search for quotients of a folded walk: deciding stub after stub, and what can be told early.

For closed maps, in which no exit is left untravelled, every decision is followed by counts that may refute it: exits of
every kind, nodes still to be placed (`demanded`), and the turning budget (`within_budget`). The map itself is the business
of ``_quotient_kernels``.
"""

from __future__ import annotations

import numpy as np

from ninefold._kernels import kernel

from ._quotient_kernels import (
    ahead,
    clockwise,
    contour,
    corner,
    count_between,
    folded,
    may_turn,
    options,
    place_made,
    put,
    taken_back,
    turns_once,
    walked_from,
    wrapped,
)
from ._quotient_state import (
    BACK,
    BOTTOM,
    CLOSED,
    COMPONENT,
    DEGREE,
    DEGREE_OF_SIGN,
    DEMAND,
    DEPTH,
    DONE,
    ENDS,
    ENTERED,
    ENTERED_BY,
    ENTERED_STUB,
    FAILS,
    GOING_DOWN,
    HEADING,
    HERE,
    KIND_OF_EXIT,
    KINDS,
    LACK,
    MATE,
    MICRO,
    MOST_PLACES,
    N_DECISIONS,
    N_FOUND,
    N_PLACES,
    N_TRAIL,
    NOTHING,
    OTHER,
    PLACE,
    PLACES_BEFORE,
    REFERENCE,
    RELATIVE,
    SEEN,
    SHIFT,
    SIDE,
    SIGN_OF_PLACE,
    STRICT,
    STUB,
    STUBS,
    SURPLUS,
    TOLERANCE,
    TOP,
    TRAIL_BEFORE,
    TURN,
    TURN_LEFT,
    UNITS_LEFT,
)

__all__ = ["searched"]


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
