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

from .columns import LABEL

__all__ = ["decay", "luby", "next_split"]

_DECAY = 0.98
_LARGEST = 1e100


@kernel(_nrt=False)
def next_split(dom, edges, stated, activity, hull, size):  # type: ignore[no-untyped-def]
    """Return the unsettled stated pair with the highest activity over size, or -1 when all are settled."""
    best = -1
    highest = -1.0
    for at in range(stated.size):
        edge = stated[at]
        relation = dom[2 * edge]
        if hull[relation] & ~edges[edge, LABEL] != 0:
            score = activity[edge] / size[relation] ** 0.5
            if score > highest:
                best, highest = edge, score
    return best


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
