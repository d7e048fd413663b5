"""Plain references for the engine's kernels: sets and dictionaries, no bit trick, no queue."""

import itertools

import numpy as np

from ninefold.encodings import ALLEN, H5, H8, POINT, RCC5, RCC8
from ninefold.reasoner.engine import columns as c
from ninefold.reasoner.engine.engine import Engine
from ninefold.reasoner.engine.graph import dense_frame, triangulated_frame
from ninefold.reasoner.engine.tables import Tables
from tests.oracle.network_reference import random_network

CALCULI = {"rcc8": (RCC8, H8.member), "rcc5": (RCC5, H5.member), "point": (POINT, None), "allen": (ALLEN, None)}
TABLES = {name: Tables.of(calculus, member) for name, (calculus, member) in CALCULI.items()}


def stated(calculus, constraints):
    """Constraints as arrays i < j, mask, one a pair, none empty; None where a pair contradicts itself."""
    labels = {}
    for i, j, mask in constraints:
        i, j, mask = (i, j, mask) if i < j else (j, i, calculus.converse_of(mask))
        labels[i, j] = labels.get((i, j), calculus.universal) & mask
    if not all(labels.values()):
        return None
    i, j = (np.array([pair[k] for pair in labels], dtype=np.int64) for k in range(2))
    return i, j, np.array(list(labels.values()), dtype=np.int64)


def engine(name, n, constraints, *, chordal=False, seed=0, log=None):
    """An engine on constraints without contradictory pairs."""
    i, j, mask = stated(CALCULI[name][0], constraints)
    frame = triangulated_frame(n, i, j, most=n * n) if chordal else dense_frame(n)
    return Engine(TABLES[name], frame, frame.arcs(i, j), mask, seed=seed, log=log)


def random_constraints(name, seed, n, degree, size=None, *, hard=False):
    """Random constraints of a calculus, reproducible; with `hard` no label lies in the tractable class."""
    calculus, member = CALCULI[name]
    rng = np.random.default_rng([seed, n, len(name)])
    keep = (lambda mask: mask.bit_count() > 1 and (member is None or not member[mask])) if hard else lambda _: True
    return random_network(calculus, rng, n, degree, size or calculus.n_bases / 2, keep)


def relations(run):
    """What an engine holds of every kept pair, by entity: ``{(i, j): mask}`` in both directions."""
    frame = run.frame
    tail, head = frame.ends()
    found = {}
    for edge, (p, q) in enumerate(zip(tail.tolist(), head.tolist(), strict=True)):
        i, j = int(frame.order[p]), int(frame.order[q])
        found[i, j], found[j, i] = int(run.state.dom[2 * edge]), int(run.state.dom[2 * edge + 1])
    return found


def partial_closure(calculus, labels):
    """Close every triangle whose three pairs are kept, until nothing changes; None at an empty relation."""
    labels = dict(labels)
    nodes = sorted({i for pair in labels for i in pair})
    triangles = [t for t in itertools.permutations(nodes, 3) if {(t[0], t[1]), (t[1], t[2]), (t[0], t[2])} <= set(labels)]
    changed = True
    while changed:
        changed = False
        for i, j, k in triangles:
            new = labels[i, k] & calculus.compose(labels[i, j], labels[j, k])
            if new != labels[i, k]:
                labels[i, k], labels[k, i], changed = new, calculus.converse_of(new), True
                if not new:
                    return None
    return labels


def initial(run, calculus, constraints):
    """The stated labels of the pairs an engine keeps, by entity, in both directions."""
    labels = dict.fromkeys(relations(run), calculus.universal)
    for i, j, mask in constraints:
        labels[i, j] &= mask
        labels[j, i] &= calculus.converse_of(mask)
    return labels


def check_state(run):
    """Everything an engine keeps beside the relations of its pairs agrees with them."""
    s, frame, tables = run.state, run.frame, run.tables
    reg, core = s.reg, frame.core
    assert (s.dom[1::2] == tables.converse[s.dom[::2]]).all()
    tail, head = frame.ends()
    planes = np.zeros_like(s.planes)
    one = np.uint64(1)
    for p in range(core, frame.n):
        for b in range(tables.n_bases):
            if tables.identity >> b & 1:
                planes[p - core, (p - core) // 64, b] |= one << np.uint64((p - core) % 64)
    lists = {p: [] for p in range(frame.n)}
    for edge, (p, q) in enumerate(zip(tail.tolist(), head.tolist(), strict=True)):
        if p >= core:
            for x, y, mask in ((p - core, q - core, s.dom[2 * edge]), (q - core, p - core, s.dom[2 * edge + 1])):
                for b in range(tables.n_bases):
                    if mask >> b & 1:
                        planes[x, y // 64, b] |= one << np.uint64(y % 64)
        elif s.dom[2 * edge] != tables.full:
            lists[q].append((p, 2 * edge + 1))
    assert (planes == s.planes).all()
    for p in range(frame.n):
        at = s.nodes[p, c.ROOM]
        assert sorted(map(tuple, s.active[at : at + s.nodes[p, c.BUSY]].tolist())) == sorted(lists[p])
    last = dict.fromkeys(range(frame.n_edges), -1)
    now = {edge: int(s.marks[edge, c.ROOT]) for edge in range(frame.n_edges)}
    for t in range(int(reg[c.TOP])):
        edge = int(s.trail[t, c.EDGE])
        assert s.trail[t, c.OLD] == now[edge]
        assert s.trail[t, c.PREV] == last[edge]
        assert s.trail[t, c.NEW] & ~now[edge] == 0
        assert s.trail[t, c.NEW] not in (0, now[edge])
        now[edge], last[edge] = int(s.trail[t, c.NEW]), t
    if reg[c.KEEP]:
        assert all(now[edge] == s.dom[2 * edge] and last[edge] == s.edges[edge, c.LAST] for edge in now)


def clauses_of(run):
    """The stored clauses, as lists of (edge, mask)."""
    s = run.state
    found = []
    for k in range(int(s.reg[c.N_CLAUSES])):
        at = int(s.place[k])
        size = int(s.arena[at + c.SIZE])
        found.append(s.arena[at + c.LITERALS : at + c.LITERALS + 2 * size].reshape(-1, 2).tolist())
    return found
