"""Each kernel of the engine against a plain reference."""

import itertools

import networkx as nx
import numpy as np
import pytest

from ninefold.encodings import ALLEN, H8
from ninefold.reasoner.engine import columns as c
from ninefold.reasoner.engine.analyse import analyse, minimise
from ninefold.reasoner.engine.clauses import attach
from ninefold.reasoner.engine.decide import decay, luby, next_split
from ninefold.reasoner.engine.explain import explain, explain_triangle_conflict, made_true_at, relation_before, weaken_pair
from ninefold.reasoner.engine.graph import arc_between, dense_frame, eliminate, triangulated_frame
from ninefold.reasoner.engine.narrow import backjump, narrow
from ninefold.reasoner.engine.queue import clear_queue, enqueue, open_queue, take_smallest
from ninefold.reasoner.engine.search import learn, propagate, recheck, settle_root, split
from ninefold.reasoner.engine.state import new_state, node_table, state_labels, watch_again
from ninefold.reasoner.engine.sweep import losing_partners
from ninefold.reasoner.engine.tables import atomic_subclass, compose_masks
from ninefold.reasoner.engine.words import bit_count, lowest_bit
from tests.oracle.engine_reference import (
    CALCULI,
    TABLES,
    check_state,
    clauses_of,
    engine,
    initial,
    partial_closure,
    random_constraints,
    relations,
    stated,
)

NEVER = 1 << 60


def test_words():
    rng = np.random.default_rng(0)
    for x in [1, 1 << 63, (1 << 64) - 1, *map(int, rng.integers(1, 1 << 63, 50))]:
        assert bit_count(np.uint64(x)) == x.bit_count()
        assert 1 << lowest_bit(np.uint64(x)) == x & -x
    assert bit_count(np.uint64(0)) == 0


@pytest.mark.parametrize("name", CALCULI)
def test_tables(name):
    calculus, member = CALCULI[name]
    tables = TABLES[name]
    b, m = calculus.n_bases, 1 << calculus.n_bases
    member = atomic_subclass(b) if member is None else member
    rng = np.random.default_rng(1)
    sample = range(m) if m <= 256 else rng.integers(0, m, 300).tolist()
    tractable = np.flatnonzero(member).tolist()
    for r in sample:
        assert tables.converse[r] == calculus.converse_of(r)
        assert tables.size[r] == r.bit_count()
        hull = calculus.universal if r else 0
        for h in tractable:
            if h & r == r:
                hull &= h
        assert tables.hull[r] == hull
        inside = [h for h in tractable if h & ~r == 0]
        assert tables.split[r] in inside
        assert int(tables.split[r]).bit_count() == max(h.bit_count() for h in inside)
        for s in sample if m <= 32 else rng.integers(0, m, 20).tolist():
            assert compose_masks(tables.compose, r, s) == calculus.compose(r, s)
        for base in range(b):
            through = calculus.compose(r, 1 << base)
            assert [int(g) for g in tables.gates[r, base, :b]] == [
                (1 << 64) - 1 if through >> k & 1 else 0 for k in range(b)
            ]
    assert (tables.compose_bases() == calculus.base_composition).all()


def test_queue_takes_the_smallest_first_and_the_oldest_among_equals():
    n, bases = 30, 8
    edges = np.zeros((n + bases + 1, c.EDGE_COLUMNS), dtype=np.int32)
    open_queue(edges, n, bases)
    rng = np.random.default_rng(2)
    buckets = {size: [] for size in range(1, bases + 1)}
    for _ in range(600):
        if rng.random() < 0.6:
            edge, size = int(rng.integers(n)), int(rng.integers(1, bases + 1))
            for bucket in buckets.values():
                if edge in bucket:
                    bucket.remove(edge)
            buckets[size].append(edge)
            enqueue(edges, n, edge, size)
        else:
            wanted = next((bucket.pop(0) for bucket in buckets.values() if bucket), -1)
            assert take_smallest(edges, n, bases) == wanted
    clear_queue(edges, n, bases)
    assert take_smallest(edges, n, bases) == -1


def random_graph(seed, n, m):
    graph = nx.gnm_random_graph(n, m, seed=seed)
    i, j = (np.array([edge[k] for edge in graph.edges], dtype=np.int64) for k in range(2))
    return graph, i, j


@pytest.mark.parametrize("seed", range(12))
def test_triangulated_frame(seed):
    n = 5 + 6 * seed
    graph, i, j = random_graph(seed, n, int(1.3 * n))
    frame = triangulated_frame(n, i, j, most=n * n)
    tail, head = frame.ends()
    pairs = list(zip(tail.tolist(), head.tolist(), strict=True))
    assert len(set(pairs)) == len(pairs) == frame.n_edges
    assert all(p < q for p, q in pairs)
    kept = nx.Graph((int(frame.order[p]), int(frame.order[q])) for p, q in pairs)
    kept.add_nodes_from(range(n))
    assert set(map(frozenset, graph.edges)) <= set(map(frozenset, kept.edges))
    assert nx.is_chordal(kept)
    assert sorted(frame.order.tolist()) == list(range(n))
    assert (frame.place[frame.order] == np.arange(n)).all()
    # the later neighbours of every node form a clique, which is what the sweeps rely on
    for v in range(n):
        later = [q for p, q in pairs if p == v]
        assert all((min(x, y), max(x, y)) in set(pairs) for x, y in itertools.combinations(later, 2))
        assert v < frame.core or len(later) == n - 1 - v
    nodes = node_table(frame)
    edge_of = {pair: edge for edge, pair in enumerate(pairs)}
    for p, q in itertools.permutations(range(n), 2):
        edge = edge_of.get((min(p, q), max(p, q)))
        wanted = -1 if edge is None else 2 * edge + (p > q)
        assert arc_between(nodes, frame.upper, frame.core, p, q) == wanted
    arcs = frame.arcs(i, j)
    assert (np.where(arcs & 1, head[arcs >> 1], tail[arcs >> 1]) == frame.place[i]).all()
    assert (np.where(arcs & 1, tail[arcs >> 1], head[arcs >> 1]) == frame.place[j]).all()


def test_elimination_takes_least_degrees_and_gives_up():
    n = 40
    graph, i, j = random_graph(3, n, 60)
    frame = triangulated_frame(n, i, j, most=n * n)
    left = nx.Graph(graph)
    for v in frame.order[: frame.core].tolist():
        assert left.degree[v] == min(degree for _, degree in left.degree)
        left.add_edges_from(itertools.combinations(list(left[v]), 2))
        left.remove_node(v)
    assert triangulated_frame(n, i, j, most=frame.n_edges) is not None
    assert triangulated_frame(n, i, j, most=frame.n_edges - 1) is None
    assert eliminate.plain is not None
    dense = dense_frame(7)
    assert dense.n_edges == 21
    assert dense.core == 0


@pytest.mark.parametrize("name", ["rcc8", "allen"])
def test_losing_partners(name):
    calculus, tables = CALCULI[name][0], TABLES[name]
    rng = np.random.default_rng(4)
    run = engine(name, 70, random_constraints(name, 5, 70, 8))
    planes, dom = run.state.planes, run.state.dom
    nodes = node_table(run.frame)
    for _ in range(40):
        i, j = rng.choice(70, 2, replace=False).tolist()
        relation = int(rng.integers(1, tables.full + 1))
        for word in range(2):
            wanted = 0
            for k in set(range(64 * word, min(70, 64 * word + 64))) - {i, j}:
                own, through = (int(dom[arc_between(nodes, run.frame.upper, 0, x, k)]) for x in (i, j))
                if own & ~calculus.compose(relation, through):
                    wanted |= 1 << (k - 64 * word)
            ignore = sum(1 << (k - 64 * word) for k in (i, j) if k // 64 == word)
            assert int(losing_partners(planes, tables.gates, relation, i, j, word)) & ~ignore == wanted


@pytest.mark.parametrize("chordal", [False, True])
@pytest.mark.parametrize("name", CALCULI)
def test_closure(name, chordal):
    answers = set()
    for seed in range(12):
        n = 5 + seed % 4
        constraints = random_constraints(name, seed, n, 2 if chordal else 3.5, CALCULI[name][0].n_bases * 0.4)
        if stated(CALCULI[name][0], constraints) is None:
            continue
        run = engine(name, n, constraints, chordal=chordal)
        check_state(run)
        wanted = partial_closure(CALCULI[name][0], initial(run, CALCULI[name][0], constraints))
        answer = run.close()
        answers.add(answer)
        assert answer == (wanted is not None)
        if answer:
            assert relations(run) == wanted
            check_state(run)
    assert True in answers


@pytest.mark.parametrize("chordal", [False, True])
@pytest.mark.parametrize("name", CALCULI)
def test_labels_are_stated_as_by_narrowing_one_after_another(name, chordal):
    calculus, tables = CALCULI[name][0], TABLES[name]
    i, j, mask = stated(calculus, random_constraints(name, 3, 90, 5))
    mask[::7] = calculus.universal  # says nothing
    frame = triangulated_frame(90, i, j, most=90 * 90) if chordal else dense_frame(90)
    assert (frame.core > 0) == chordal
    arcs = frame.arcs(i, j)
    assert (arcs & 1).any() or not chordal
    at_once, in_turn = (new_state(tables, frame, arcs, mask, rng=np.random.default_rng(0)) for _ in range(2))
    for s in (at_once, in_turn):
        s.active[:] = -1  # rows not in use are not initialised
    state_labels(at_once, arcs, mask.astype(np.int16))
    s = in_turn
    for arc, relation in zip(arcs.tolist(), mask.tolist(), strict=True):
        if relation != tables.full:
            edge, back = arc >> 1, arc & 1
            ends = s.edges[edge, c.TAIL + back], s.edges[edge, c.HEAD - back]
            narrow.plain(s, arc, *ends, relation, c.DECIDED, 0, True)
    for field in ("dom", "edges", "nodes", "planes", "active", "reg"):
        assert (getattr(at_once, field) == getattr(in_turn, field)).all(), field


@pytest.mark.parametrize("n_clauses", [0, 1, 40])
def test_clauses_are_watched_as_one_after_another(n_clauses):
    rng = np.random.default_rng(5)
    states = [engine("rcc8", 8, random_constraints("rcc8", 1, 8, 4)).state for _ in range(2)]
    clauses = [(rng.choice(28, int(rng.integers(2, 6)), replace=False), rng.integers(1, 255, 6)) for _ in range(n_clauses)]
    for s in states:
        s.watch[:] = -7
        s.edges[:, c.WATCH] = 3  # of clauses that are gone
        top = 0
        for clause, (edges, masks) in enumerate(clauses):
            s.place[clause] = top
            s.arena[top : top + 2] = len(edges), 2
            literals = np.stack([edges, masks[: len(edges)]], axis=1).ravel()
            s.arena[top + 2 : top + 2 + literals.size] = literals
            top += 2 + literals.size
        s.reg[c.N_CLAUSES] = n_clauses
    at_once, in_turn = states
    watch_again(at_once)
    in_turn.edges[:, c.WATCH] = -1
    for clause in range(n_clauses):
        attach.plain(in_turn, clause)
    assert (at_once.watch == in_turn.watch).all()
    assert (at_once.edges == in_turn.edges).all()


def at_conflict(name, seed, chordal, n):
    """An engine at its first conflict after random splits, or None if it does not come to one."""
    degree = (4, 5, 6)[seed % 3] if chordal else (7, 9, 11)[seed % 3]
    constraints = random_constraints(name, seed, n, degree, hard=True)
    run = engine(name, n, constraints, chordal=chordal, log=[])
    if not run.close():
        return None
    s = run.state
    rng = np.random.default_rng(seed)
    while True:
        status = propagate(s, NEVER)
        if status == c.CONFLICT:
            return run if s.reg[c.LEVEL] else None
        assert status == c.FIXPOINT
        if s.reg[c.LEVEL] == 0:
            settle_root(s)
        open_edges = [int(e) for e in s.stated if s.hull[s.dom[2 * e]] & ~s.marks[e, c.LABEL]]
        if not open_edges:
            return None
        split(s, int(rng.choice(open_edges)))


def conflicts(name, chordal, n, count):
    """Engines at their first conflict, with a trail of reasons."""
    found = 0
    for seed in range(400):
        run = at_conflict(name, seed, chordal, n)
        if run is not None:
            found += 1
            yield run
            if found == count:
                return
    raise AssertionError("no network came to a conflict")


@pytest.mark.parametrize("chordal", [False, True])
@pytest.mark.parametrize("name", ["rcc8", "allen"])
def test_narrowing_keeps_books_and_is_taken_back(name, chordal):
    for run in conflicts(name, chordal, 14, 4):
        s = run.state
        check_state(run)
        before = {}
        for t in range(int(s.reg[c.TOP])):
            before.setdefault(int(s.trail[t, c.EDGE]), []).append(t)
        for edge, entries in before.items():
            for t in range(int(s.reg[c.TOP]) + 1):
                earlier = [x for x in entries if x < t]
                wanted = int(s.trail[earlier[-1], c.NEW]) if earlier else int(s.marks[edge, c.ROOT])
                assert relation_before(s.edges, s.marks, s.trail, s.converse, 2 * edge, t) == wanted
                assert relation_before(s.edges, s.marks, s.trail, s.converse, 2 * edge + 1, t) == s.converse[wanted]
            now = int(s.dom[2 * edge])
            for mask in range(1, min(s.reg[c.FULL] + 1, 256)):
                if now & ~mask == 0:
                    first = next((t for t in entries if s.trail[t, c.NEW] & ~mask == 0), -1)
                    wanted = -1 if s.marks[edge, c.ROOT] & ~mask == 0 else first
                    assert made_true_at(s.edges, s.trail, edge, mask) == wanted
        for level in range(int(s.reg[c.LEVEL]) - 1, -1, -1):
            backjump(s, level)
            check_state(run)
        assert (s.dom[::2] == s.marks[:, c.ROOT]).all()


@pytest.mark.parametrize("name", ["rcc8", "rcc5", "point"])
def test_weakened_pairs_are_as_large_as_can_be(name):
    calculus, tables = CALCULI[name][0], TABLES[name]
    full = calculus.universal
    rng = np.random.default_rng(6)
    for _ in range(300):
        p, q = (int(x) for x in rng.integers(1, full + 1, 2))
        bad = full & ~calculus.compose(p, q) & int(rng.integers(1, full + 1))
        if not bad:
            continue
        for swap in (False, True):
            big_p, big_q = weaken_pair(tables.converse, tables.compose, full, p, q, swap, bad)
            assert p & ~big_p == q & ~big_q == 0
            assert calculus.compose(int(big_p), int(big_q)) & bad == 0
            for base in range(calculus.n_bases):  # nothing can be added to either
                if not big_p >> base & 1:
                    assert calculus.compose(int(big_p) | 1 << base, int(big_q)) & bad
                if not big_q >> base & 1:
                    assert calculus.compose(int(big_p), int(big_q) | 1 << base) & bad


@pytest.mark.parametrize("chordal", [False, True])
@pytest.mark.parametrize("name", ["rcc8", "allen"])
def test_explanations_hold_before_and_imply(name, chordal):
    calculus = CALCULI[name][0]
    full = calculus.universal
    looked = 0
    rng = np.random.default_rng(7)
    for run in conflicts(name, chordal, 14, 6):
        s = run.state
        for t in range(int(s.reg[c.TOP])):
            if s.trail[t, c.WHY] < 0:
                continue
            edge, old, new = (int(s.trail[t, k]) for k in (c.EDGE, c.OLD, c.NEW))
            wanted = (new | int(rng.integers(full + 1))) & (full ^ (1 << int(rng.choice(bits(old & ~new)))))
            n = explain(s, t, wanted)
            premise = {}
            for e, mask in s.out[:n].tolist():
                assert relation_before(s.edges, s.marks, s.trail, s.converse, 2 * e, t) & ~mask == 0
                premise[e] = premise.get(e, full) & mask
            # with the premises and level 0 alone, the triangle puts the pair into the wanted mask
            held = {arc: meet(s, premise, arc) for arc in (int(s.trail[t, c.WHY]), int(s.trail[t, c.OTHER]), 2 * edge)}
            f, g, own = held.values()
            assert calculus.compose(f, g) & own & ~wanted == 0
            looked += 1
        if s.reg[c.TROUBLE] == c.TRIANGLE_TROUBLE:
            e, f, g = (int(s.reg[k]) for k in (c.TROUBLE_A, c.TROUBLE_F, c.TROUBLE_G))
            n = explain_triangle_conflict(s, e, f, g)
            premise = {}
            for x, mask in s.out[:n].tolist():
                assert s.dom[2 * x] & ~mask == 0
                premise[x] = premise.get(x, full) & mask
            assert calculus.compose(meet(s, premise, f), meet(s, premise, g)) & meet(s, premise, e) == 0
    assert looked > 20


def bits(mask):
    return [k for k in range(mask.bit_length()) if mask >> k & 1]


def meet(s, premise, arc):
    """The relation of an arc at level 0, intersected with the premise on its pair."""
    mask = int(s.marks[arc >> 1, c.ROOT]) & premise.get(arc >> 1, -1)
    return int(s.converse[mask]) if arc & 1 else mask


@pytest.mark.parametrize("chordal", [False, True])
def test_analysis_learns_a_clause_that_asserts(chordal):
    for run in conflicts("rcc8", chordal, 14, 8):
        s = run.state
        n = analyse(s)
        depth = [int(s.trail[s.marks[e, c.AT], c.DEPTH]) for e in s.learnt[:n, 0]]
        assert max(depth) == depth[0]
        assert depth.count(depth[0]) == 1
        before = set(s.learnt[:n, 0].tolist())
        m, level, lbd = minimise(s, 2, n)
        kept = s.learnt[:m].tolist()
        assert {e for e, _ in kept} <= before
        assert (s.marks[:, c.NEED] == -1).all()
        assert (s.marks[:, c.HELD] == 0).all()
        assert 1 <= lbd <= m
        assert all(s.dom[2 * e] & mask == 0 for e, mask in kept)  # false now
        assert level == (
            0 if m == 1 else max(d for e, d in zip(s.learnt[:m, 0], depths(s, kept), strict=True) if e != kept[0][0])
        )
        backjump(s, level)
        first, rest = kept[0], kept[1:]
        assert all(s.dom[2 * e] & mask == 0 for e, mask in rest)  # false still
        assert s.dom[2 * first[0]] & first[1]  # and the first one is not, and says something
        assert s.dom[2 * first[0]] & ~first[1]


def depths(s, clause):
    return [int(s.trail[made_true_at(s.edges, s.trail, e, int(s.marks[e, c.ROOT]) & ~mask), c.DEPTH]) for e, mask in clause]


@pytest.mark.parametrize("chordal", [False, True])
def test_a_fixpoint_leaves_no_clause_to_fire(chordal):
    looked = 0
    for seed in range(40):
        constraints = random_constraints("rcc8", seed, 30, 9 if chordal else 12, hard=True)
        run = engine("rcc8", 30, constraints, chordal=chordal, seed=seed)
        if not run.close():
            continue
        s = run.state
        while run.conflicts < 25:
            status = propagate(s, NEVER)
            if status == c.CONFLICT:
                if s.reg[c.LEVEL] == 0 or not learn(s):
                    break
                continue
            for clause in clauses_of(run):
                open_ones = [(e, mask) for e, mask in clause if s.dom[2 * e] & mask]
                assert len(open_ones) > 1 or (len(open_ones) == 1 and s.dom[2 * open_ones[0][0]] & ~open_ones[0][1] == 0)
                looked += 1
            if s.reg[c.LEVEL] == 0:
                settle_root(s)
            edge = next_split(s.dom, s.marks, s.stated, s.recent, s.activity, s.reg, s.hull, s.size)
            if edge < 0:
                if recheck(s):
                    break
                continue
            split(s, edge)
        check_state(run)
    assert looked > 50


def test_next_split():
    rng = np.random.default_rng(8)
    run = engine("rcc8", 20, random_constraints("rcc8", 1, 20, 8, hard=True))
    s = run.state
    for _ in range(30):
        s.activity[:-1] = rng.random(s.activity.size - 1)
        best = max(
            ((s.activity[e] / s.size[s.dom[2 * e]] ** 0.5, int(e)) for e in s.stated if unsettled(s, e)),
            default=(0, -1),
        )
        assert next_split(s.dom, s.marks, s.stated, s.recent, s.activity, s.reg, s.hull, s.size) == best[1]
        if best[1] < 0:
            break
        s.dom[2 * best[1]] = s.split[s.dom[2 * best[1]]]
    # a ring of recent pairs first, then the first unsettled one in order
    run = engine("rcc8", 20, random_constraints("rcc8", 1, 20, 8, hard=True))
    s = run.state
    s.reg[c.RING], s.reg[c.N_RECENT] = 1, 0
    unsettled_ones = [int(e) for e in s.stated if unsettled(s, e)]
    assert next_split(s.dom, s.marks, s.stated, s.recent, s.activity, s.reg, s.hull, s.size) == unsettled_ones[0]
    s.recent[0], s.reg[c.N_RECENT] = unsettled_ones[3], 1
    assert next_split(s.dom, s.marks, s.stated, s.recent, s.activity, s.reg, s.hull, s.size) == unsettled_ones[3]


def unsettled(s, edge):
    """By definition: no tractable relation lies between the pair's relation and its label."""
    relation, label = int(s.dom[2 * edge]), int(s.marks[edge, c.LABEL])
    return not any(relation & ~h == 0 and h & ~label == 0 for h in np.flatnonzero(H8.member).tolist())


def test_activities_and_restarts():
    assert [luby(k) for k in range(1, 16)] == [1, 1, 2, 1, 1, 2, 4, 1, 1, 2, 1, 1, 2, 4, 8]
    activity = np.array([3.0, 1.0, 1.0])
    decay(activity)
    assert activity[:2].tolist() == [3, 1]
    assert activity[2] > 1
    activity[2] = 1e101
    decay(activity)
    assert activity[0] == pytest.approx(3e-100)
    assert activity[2] < 1e3


def test_allen_uses_four_blocks():
    assert TABLES["allen"].compose.shape == (4, 128, 128)
    assert ALLEN.n_bases == 13
