"""The queue of pairs whose relation became smaller: smallest relations first.

One bucket for each size, a circular list through the rows of `edges`; the bucket of size s is headed by row
``n_edges + s``. A small relation prunes much and costs no more, so it goes first; a queued pair that shrinks again moves.
"""

from __future__ import annotations

from ninefold._kernels import kernel

from .columns import AHEAD, BEHIND, BUCKET

__all__ = ["clear_queue", "enqueue", "open_queue", "take_smallest"]


@kernel(_nrt=False)
def open_queue(edges, n_edges, n_bases):  # type: ignore[no-untyped-def]
    """Make every bucket empty."""
    for head in range(n_edges, n_edges + n_bases + 1):
        edges[head, AHEAD] = head
        edges[head, BEHIND] = head


@kernel(_nrt=False, forceinline=True)
def enqueue(edges, n_edges, edge, size):  # type: ignore[no-untyped-def]
    """Put a pair at the end of the bucket of its size, taking it out of a former one."""
    if edges[edge, BUCKET] != 0:
        _unlink(edges, edge)
    head = n_edges + size
    last = edges[head, BEHIND]
    edges[last, AHEAD] = edge
    edges[edge, AHEAD] = head
    edges[edge, BEHIND] = last
    edges[edge, BUCKET] = size
    edges[head, BEHIND] = edge


@kernel(_nrt=False)
def take_smallest(edges, n_edges, n_bases):  # type: ignore[no-untyped-def]
    """Take the first pair of the first bucket that has one, or return -1."""
    for head in range(n_edges + 1, n_edges + n_bases + 1):
        edge = edges[head, AHEAD]
        if edge != head:
            _unlink(edges, edge)
            edges[edge, BUCKET] = 0
            return edge
    return -1


@kernel(_nrt=False)
def clear_queue(edges, n_edges, n_bases):  # type: ignore[no-untyped-def]
    """Take every pair out."""
    while take_smallest(edges, n_edges, n_bases) >= 0:
        pass


@kernel(_nrt=False, forceinline=True)
def _unlink(edges, edge):  # type: ignore[no-untyped-def]
    ahead, behind = edges[edge, AHEAD], edges[edge, BEHIND]
    edges[behind, AHEAD] = ahead
    edges[ahead, BEHIND] = behind
