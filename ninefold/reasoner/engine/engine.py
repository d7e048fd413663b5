"""Drive the kernels: slices of work, room, clean-ups, the clock."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any

import numpy as np

from . import columns as c
from .search import close, search
from .state import new_state, state_labels, watch_again
from .words import n_words

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .graph import Frame
    from .tables import Tables

__all__ = ["Engine"]

_PLAIN_SLICE = 1_000
_FIRST_SLICE = 20_000
_SLICE_SECONDS = 0.05
_TICK_STEPS = 7
"""Elementary steps for one of the register TICKS."""
_CONFLICT_STEPS = 7_000
"""For each node: several times what a conflict takes, as a search that comes to a few conflicts comes to many more."""
_KEEP_LBD = 2
_REDUCE_FIRST, _REDUCE_STEP = 2000, 500


class Engine:
    """One search over one network; see `ninefold.reasoner.engine`.

    Parameters
    ----------
    tables, frame
        The calculus and the pairs that are kept.
    arcs, masks
        (P,) stated arcs (no pair twice) and their relations, none of them empty.
    seed
        Breaks ties. The same arguments give the same run.
    log
        Receives each learned clause as an (L, 2) int32 array of (edge, mask), or None.

    Attributes
    ----------
    compiling
        Seconds spent on compiling kernels or loading compiled ones; deadlines are put off by as much.
    """

    def __init__(
        self,
        tables: Tables,
        frame: Frame,
        arcs: NDArray[np.int64],
        masks: NDArray[Any],
        *,
        seed: int = 0,
        log: list[NDArray[np.int32]] | None = None,
    ) -> None:
        self.tables = tables
        self.frame = frame
        self._log = log
        self._slice = _FIRST_SLICE
        # what closing the stated labels will take at the least
        self._expected = 3 * len(arcs) * _TICK_STEPS * (8 + 2 * n_words(frame.n - frame.core))
        self._counted = 0
        self._reductions = 0
        self.compiling = 0.0
        self.state = new_state(tables, frame, arcs, masks, rng=np.random.default_rng(seed), logging=log is not None)
        self.state.reg[c.REDUCE_AT] = _REDUCE_FIRST
        state_labels(self.state, arcs, np.asarray(masks, dtype=np.int16))

    @property
    def conflicts(self) -> int:
        """Conflicts learned from so far."""
        return int(self.state.reg[c.CONFLICTS])

    @property
    def decisions(self) -> int:
        """Splits made so far."""
        return int(self.state.reg[c.DECISIONS])

    def relations(self) -> NDArray[np.int16]:
        """Return the (2E,) relations of the arcs as they are now (a view)."""
        return self.state.dom

    def labels(self) -> NDArray[Any]:
        """Return the relations of all pairs of a dense frame as they are now, an (n, n) array of masks."""
        n = self.frame.n
        labels = np.full((n, n), self.tables.identity, dtype=np.int16)
        tail, head = self.frame.ends()
        labels[tail, head], labels[head, tail] = self.state.dom[::2], self.state.dom[1::2]
        return labels

    def close(self, deadline: float | None = None) -> bool | None:
        """Close the stated network; return False if it is inconsistent, None past the deadline, else True.

        Nothing is taken back afterwards: this is level 0.
        """
        status = self._run(close, deadline)
        if status is None:
            return None
        marks, reg = self.state.marks, self.state.reg
        marks[:, c.ROOT] = self.state.dom[::2]
        reg[c.KEEP] = 1
        return bool(status == c.FIXPOINT)

    def search(self, deadline: float | None = None) -> bool | None:
        """Decide the network after `close`; return None past the deadline."""
        status = self._run(search, deadline)
        return None if status is None else bool(status == c.CONSISTENT)

    def _form(self, kernel: Any) -> Any:
        """Run plain while the work is small, compiled from the slice on that is known to be worth it."""
        reg = self.state.reg
        done = _TICK_STEPS * int(reg[c.TICKS]) + _CONFLICT_STEPS * self.frame.n * int(reg[c.CONFLICTS])
        new = max(done, self._expected) - self._counted
        self._counted += new
        return kernel.for_work(new)

    def _run(self, kernel: Any, deadline: float | None) -> int | None:
        reg = self.state.reg
        while True:
            form = self._form(kernel)
            begin = time.perf_counter()
            if form is not kernel.plain and not form.signatures:
                # compiling, once a machine, or loading what was compiled, once a process, is no part of the budget
                form(self.state, -1)
                self.compiling += time.perf_counter() - begin
                continue
            before = int(reg[c.TICKS])
            status = form(self.state, before + (_PLAIN_SLICE if form is kernel.plain else self._slice))
            now = time.perf_counter()
            self._flush_log()
            match status:
                case c.PAUSED:
                    pass
                case c.TRAIL_FULL:
                    self._enlarge("trail", self.frame.n_edges * (self.tables.n_bases - 1) + 4 * self.frame.n + 1024)
                case c.ARENA_FULL:
                    self._enlarge_clauses()
                case c.LOG_FULL:
                    needed = 1 + 2 * int(reg[c.TOP])
                    if self.state.log.size < needed:
                        self.state = self.state._replace(log=np.empty(2 * needed, dtype=np.int32))
                case c.REDUCE:
                    self._reduce()
                case _:
                    return int(status)
            if deadline is not None and now > deadline + self.compiling:
                return None
            if form is not kernel.plain and status == c.PAUSED:
                wanted = self._slice * _SLICE_SECONDS / max(now - begin, 1e-6)
                self._slice = int(min(max(wanted, self._slice / 2, 1000), 2 * self._slice))

    def _flush_log(self) -> None:
        log, reg = self.state.log, self.state.reg
        if self._log is None:
            return
        at, top = 0, int(reg[c.LOG_TOP])
        while at < top:
            size = int(log[at])
            self._log.append(log[at + 1 : at + 1 + 2 * size].reshape(-1, 2).copy())
            at += 1 + 2 * size
        reg[c.LOG_TOP] = 0

    def _enlarge(self, field: str, least: int = 0) -> None:
        """Double an array of the state, keeping its rows."""
        old = getattr(self.state, field)
        new = np.empty((2 * len(old), *old.shape[1:]), dtype=old.dtype)
        new[: len(old)] = old
        self.state = self.state._replace(**{field: new})

    def _enlarge_clauses(self) -> None:
        reg = self.state.reg
        if reg[c.N_CLAUSES] == self.state.place.size:
            self._enlarge("place")
            self._enlarge("watch")
        while reg[c.ARENA_TOP] + c.LITERALS + 2 * reg[c.TOP] > self.state.arena.size:
            self._enlarge("arena")

    def _reduce(self) -> None:
        """Forget the worse half of the clauses; at level 0, where none is a reason."""
        s = self.state
        reg, n = s.reg, int(s.reg[c.N_CLAUSES])
        place = s.place[:n]
        size, lbd = s.arena[place + c.SIZE], s.arena[place + c.LBD]
        worse = np.flatnonzero(lbd > _KEEP_LBD)
        rank = np.lexsort((-worse, size[worse], lbd[worse]))
        dropped = np.zeros(n, dtype=bool)
        dropped[worse[rank[len(worse) // 2 :]]] = True
        kept = np.flatnonzero(~dropped)
        length = c.LITERALS + 2 * size[kept].astype(np.int64)
        stop = np.cumsum(length)
        source = np.repeat(place[kept] - (stop - length), length) + np.arange(int(stop[-1]) if len(stop) else 0)
        s.arena[: len(source)] = s.arena[source]
        s.place[: len(kept)] = stop - length
        reg[c.N_CLAUSES], reg[c.ARENA_TOP] = len(kept), len(source)
        watch_again(s)
        self._reductions += 1
        reg[c.REDUCE_AT] = reg[c.CONFLICTS] + _REDUCE_FIRST + _REDUCE_STEP * self._reductions
