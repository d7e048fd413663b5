"""The arrays a search works on, and how they are laid out for a network."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import columns as c
from .words import WORD, n_words

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .graph import Frame
    from .tables import Tables

__all__ = ["State", "new_state", "node_table", "state_labels", "watch_again"]

_RING = 4096
"""Stated pairs up to which each split looks at all of them."""


class State(NamedTuple):
    """Everything a kernel of the engine reads or writes. Columns and registers are named in `columns`."""

    dom: NDArray[np.int16]
    """(2E,) relation of every arc."""
    edges: NDArray[np.int32]
    """(E + b + 1, EDGE_COLUMNS); the last rows head the queue's buckets."""
    marks: NDArray[np.int32]
    """(E, MARK_COLUMNS)."""
    nodes: NDArray[np.int32]
    """(n + 1, NODE_COLUMNS)."""
    upper: NDArray[np.int32]
    """Later neighbours of nodes before the core."""
    planes: NDArray[np.uint64]
    """(n - core, words, w) bit-planes of the core, w the next multiple of 8 above b."""
    active: NDArray[np.int32]
    """(edges before the core, 2) partners of each node before it and the core, with the arcs to them."""
    trail: NDArray[np.int32]
    """(capacity, TRAIL_COLUMNS)."""
    levels: NDArray[np.int32]
    """(levels, 2) first trail entry of every level, and where the register CURSOR was."""
    reg: NDArray[np.int64]
    """Registers."""
    arena: NDArray[np.int32]
    """Clauses, one after another."""
    place: NDArray[np.int32]
    """Where each clause starts."""
    watch: NDArray[np.int32]
    """(2 clauses, WATCH_COLUMNS)."""
    activity: NDArray[np.float64]
    """(E + 1,); the last one is the present gain."""
    stated: NDArray[np.int32]
    """Pairs with a label that is not tractable, the smallest first."""
    recent: NDArray[np.int32]
    """The same, or a ring of those that were in the last conflicts."""
    held: NDArray[np.int32]
    """(E,) scratch: pairs with a premise."""
    learnt: NDArray[np.int32]
    """(E + 3, 2) scratch: the clause being made."""
    out: NDArray[np.int32]
    """(E + 3, 2) scratch: premises of one entry."""
    stack: NDArray[np.int32]
    """(k, 2) scratch for minimisation."""
    stamp: NDArray[np.int32]
    """Scratch by level."""
    log: NDArray[np.int32]
    """Learned clauses not yet written to the proof: a count, then (edge, mask) pairs."""
    converse: NDArray[np.int16]
    size: NDArray[np.int16]
    compose: NDArray[np.int16]
    hull: NDArray[np.int16]
    split: NDArray[np.int16]
    gates: NDArray[np.uint64]


def new_state(
    tables: Tables,
    frame: Frame,
    arcs: NDArray[np.int64],
    masks: NDArray[Any],
    *,
    rng: np.random.Generator,
    logging: bool = False,
) -> State:
    """Lay out the arrays for a network; no label is set yet (see `state_labels`).

    Parameters
    ----------
    arcs, masks
        Stated arcs, no pair twice, and their relations, none empty.
    rng
        Breaks ties between pairs that were never in a conflict.
    """
    b, n, n_edges = tables.n_bases, frame.n, frame.n_edges
    edges = np.zeros((n_edges + b + 1, c.EDGE_COLUMNS), dtype=np.int32)
    edges[:n_edges, c.TAIL], edges[:n_edges, c.HEAD] = frame.ends()
    edges[:, c.LAST] = edges[:, c.WATCH] = -1
    marks = np.zeros((n_edges, c.MARK_COLUMNS), dtype=np.int32)
    marks[:, c.NEED] = marks[:, c.LABEL] = -1
    heads = np.arange(n_edges, n_edges + b + 1)
    edges[n_edges:, c.AHEAD] = edges[n_edges:, c.BEHIND] = heads

    reg = np.zeros(c.N_REGISTERS, dtype=np.int64)
    reg[c.FULL], reg[c.N_BASES], reg[c.N_EDGES], reg[c.N_NODES] = tables.full, b, n_edges, n
    reg[c.CORE], reg[c.LOGGING], reg[c.CHECKED] = frame.core, logging, -1

    pair = arcs >> 1
    label = np.where(arcs & 1, tables.converse[masks], masks)
    marks[pair, c.LABEL] = label
    activity = np.zeros(n_edges + 1)
    activity[pair] = 1e-3 * rng.random(len(pair))
    activity[n_edges] = 1.0

    hard = np.flatnonzero(tables.hull[label] != label)
    hard = hard[np.lexsort((-activity[pair[hard]], tables.size[label[hard]]))]
    stated = pair[hard].astype(np.int32)
    recent = stated.copy()
    reg[c.N_RECENT] = stated.size
    if stated.size > _RING:
        recent = np.empty(_RING, dtype=np.int32)
        reg[c.N_RECENT], reg[c.RING] = 0, 1
    return State(
        dom=np.full(2 * n_edges, tables.full, dtype=np.int16),
        edges=edges,
        marks=marks,
        nodes=node_table(frame),
        upper=frame.upper,
        planes=_open_planes(tables, n - frame.core),
        active=np.empty((frame.upper.size, 2), dtype=np.int32),
        trail=np.empty((4 * n + 1024, c.TRAIL_COLUMNS), dtype=np.int32),
        levels=np.zeros((len(arcs) * b + 2, 2), dtype=np.int32),
        reg=reg,
        arena=np.empty(1 << 16, dtype=np.int32),
        place=np.empty(1 << 10, dtype=np.int32),
        watch=np.empty((2 << 10, c.WATCH_COLUMNS), dtype=np.int32),
        activity=activity,
        stated=stated,
        recent=recent,
        held=np.empty(n_edges, dtype=np.int32),
        learnt=np.empty((n_edges + 3, 2), dtype=np.int32),
        out=np.empty((n_edges + 3, 2), dtype=np.int32),
        stack=np.empty((64, 2), dtype=np.int32),
        stamp=np.zeros(len(arcs) * b + 2, dtype=np.int32),
        log=np.empty(1 << 16 if logging else 0, dtype=np.int32),
        converse=tables.converse,
        size=tables.size,
        compose=tables.compose,
        hull=tables.hull,
        split=tables.split,
        gates=tables.gates,
    )


def state_labels(s: State, arcs: NDArray[np.int64], masks: NDArray[np.int16]) -> None:
    """Give stated arcs, no pair twice, their relations and queue them: what `narrow.narrow` would do to each in turn."""
    full, core = int(s.reg[c.FULL]), int(s.reg[c.CORE])
    said = masks != full
    edge, new = arcs[said] >> 1, np.where(arcs[said] & 1, s.converse[masks[said]], masks[said])
    s.dom[2 * edge], s.dom[2 * edge + 1] = new, s.converse[new]
    i, k = s.edges[edge, c.TAIL], s.edges[edge, c.HEAD]

    inside = i >= core
    for a, b, gone in (
        (i[inside] - core, k[inside] - core, full ^ new[inside]),
        (k[inside] - core, i[inside] - core, s.converse[full ^ new[inside]]),
    ):
        bit = np.uint64(1) << (b % WORD).astype(np.uint64)
        for base in range(int(s.reg[c.N_BASES])):
            np.bitwise_xor.at(s.planes, (a, b // WORD, base), bit * (gone >> base & 1).astype(np.uint64))

    head, tail, arc = (x[~inside] for x in (k, i, 2 * edge + 1))
    order = np.argsort(head, kind="stable")
    head = head[order]
    at = s.nodes[head, c.ROOM] + np.arange(head.size) - np.searchsorted(head, head)
    s.active[at, 0], s.active[at, 1] = tail[order], arc[order]
    s.nodes[:, c.BUSY] += np.bincount(head, minlength=len(s.nodes)).astype(np.int32)

    s.reg[c.NARROWED] += edge.size
    size = s.size[new]
    for count in range(1, int(s.reg[c.N_BASES]) + 1):
        bucket = s.reg[c.N_EDGES] + count
        ring = np.concatenate([[bucket], edge[size == count], [bucket]])
        s.edges[ring[:-1], c.AHEAD], s.edges[ring[1:], c.BEHIND] = ring[1:], ring[:-1]
        s.edges[ring[1:-1], c.BUCKET] = count


def watch_again(s: State) -> None:
    """Watch the first two literals of every clause anew: what `clauses.attach` would do to each in turn."""
    at = s.place[: int(s.reg[c.N_CLAUSES])] + c.LITERALS
    first = np.stack([s.arena[at + k] for k in range(4)], axis=1)  # edge, mask, edge, mask
    watch = s.watch[: 2 * len(at)]
    watch[:, c.MASK] = first[:, [1, 3]].ravel()
    watch[:, c.BLOCK_EDGE], watch[:, c.BLOCK_MASK] = first[:, [2, 0]].ravel(), first[:, [3, 1]].ravel()
    edge = first[:, [0, 2]].ravel()
    order = np.argsort(edge, kind="stable")
    edge = edge[order]
    same = edge[1:] == edge[:-1]
    watch[:, c.NEXT] = -1
    watch[order[1:][same], c.NEXT] = order[:-1][same]
    last = np.append(~same, True)[: edge.size]
    s.edges[:, c.WATCH] = -1
    s.edges[edge[last], c.WATCH] = order[last]


def node_table(frame: Frame) -> NDArray[np.int32]:
    """Return the (n + 1, NODE_COLUMNS) table of a frame's nodes, none with a partner yet."""
    nodes = np.zeros((frame.n + 1, c.NODE_COLUMNS), dtype=np.int32)
    nodes[:, c.FIRST] = frame.first
    np.cumsum(np.bincount(frame.upper, minlength=frame.n), out=nodes[1:, c.ROOM])
    return nodes


def _open_planes(tables: Tables, n: int) -> NDArray[np.uint64]:
    """Return the bit-planes of n nodes between which everything is possible, and each is equal to itself."""
    words = n_words(n)
    row = np.zeros(words * WORD, dtype=np.uint8)
    row[:n] = 1
    bits = np.packbits(row, bitorder="little").view("<u8").astype(np.uint64)
    planes = np.zeros((n, words, tables.gates.shape[1]), dtype=np.uint64)
    planes[:, :, : tables.n_bases] = bits[:, np.newaxis]
    node = np.arange(n)
    for base in range(tables.n_bases):
        if not tables.identity >> base & 1:
            planes[node, node // WORD, base] ^= np.uint64(1) << (node % WORD).astype(np.uint64)
    return planes
