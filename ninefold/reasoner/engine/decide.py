"""Where to split next, and when to start again.

A stated pair with relation D and label L is *settled* when the tractable hull of D lies in L. When all are, closure over
the hulls decides, and the network is consistent. Otherwise the pair with the highest activity over size is split: it is
put in a largest tractable relation inside D.

References
----------
J. Renz and B. Nebel, "Efficient methods for qualitative spatial reasoning", JAIR 15 (2001), section 4 (splits);
M. Luby, A. Sinclair and D. Zuckerman, "Optimal speedup of Las Vegas algorithms", IPL 47 (1993).
"""

from __future__ import annotations

from ninefold._kernels import kernel

from .columns import CURSOR, LABEL, N_RECENT, RING

__all__ = ["decay", "is_settled", "luby", "next_split"]

_DECAY = 0.98
_LARGEST = 1e100


@kernel(_nrt=False, forceinline=True)
def is_settled(dom, marks, hull, edge):  # type: ignore[no-untyped-def]
    """Tell whether closure decides what is left of a stated pair."""
    return hull[dom[2 * edge]] & ~marks[edge, LABEL] == 0


@kernel(_nrt=False)
def next_split(dom, marks, stated, recent, activity, reg, hull, size):  # type: ignore[no-untyped-def]
    """Return an unsettled stated pair, or -1 when all are settled.

    It is the one with the highest activity over the root of its size among `recent`, which in a small network are all
    stated pairs and in a large one those of the last conflicts; else the first of `stated` from the register CURSOR on.
    """
    best = -1
    highest = -1.0
    for at in range(min(reg[N_RECENT], recent.size)):
        edge = recent[at]
        if not is_settled(dom, marks, hull, edge):
            score = activity[edge] / size[dom[2 * edge]] ** 0.5
            if score > highest:
                best, highest = edge, score
    if best >= 0 or reg[RING] == 0:
        return best
    while reg[CURSOR] < stated.size:
        edge = stated[reg[CURSOR]]
        if not is_settled(dom, marks, hull, edge):
            return edge
        reg[CURSOR] += 1
    return -1


@kernel(_nrt=False)
def decay(activity):  # type: ignore[no-untyped-def]
    """Make every activity count less, by making the next gains (in the last place) larger."""
    last = activity.size - 1
    activity[last] /= _DECAY
    if activity[last] > _LARGEST:
        for k in range(activity.size):
            activity[k] /= _LARGEST


@kernel(_nrt=False)
def luby(k):  # type: ignore[no-untyped-def]
    """Return the k-th term (from 1) of 1, 1, 2, 1, 1, 2, 4, ..."""
    while True:
        power = 1
        while 2 * power - 1 < k:
            power *= 2
        if 2 * power - 1 == k:
            return power
        k -= power - 1
