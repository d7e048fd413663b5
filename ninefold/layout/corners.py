"""Drawing an edge between two corners of a rotation system that is being added to."""

from __future__ import annotations

from ninefold._kernels import kernel

__all__ = ["join_corners"]


@kernel(inline="always")
def join_corners(tail, after, before, p, q, used):  # type: ignore[no-untyped-def]
    """Add an edge, darts used and used + 1, from the corner after dart p to the corner after dart q."""
    x = used
    y = used + 1
    tail[x] = tail[p]
    tail[y] = tail[q]
    f = after[p]
    after[p] = x
    before[x] = p
    after[x] = f
    before[f] = x
    f = after[q]
    after[q] = y
    before[y] = q
    after[y] = f
    before[f] = y
