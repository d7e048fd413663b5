"""Refuting parts of a set of statements again and again, each time with the statements that the refutation rests on.

`CoreSearch` is the engine with a memory: clauses learned from one part serve every later part that holds the statements
they rest on, and the search for a scenario begins at the last one found. That is what a long series of nearly equal
questions asks for, and a minimal conflict is the end of such a series. How statements are followed through the search is
told in `ninefold.reasoner.engine.tracing`.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..engine import columns as c
from ..engine import tracing as t
from ..engine.state import new_state

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from ..engine.graph import Frame
    from ..engine.state import State
    from ..engine.tables import Tables

__all__ = ["CoreSearch", "OutOfTime"]

_GROUPS = 2048
"""Most bits in a set of statements; where there are more statements several share one."""

_HANDED_ON = 3000
"""Most clauses that one search leaves to the next."""

_PLAIN_SLICE = 1_000
_FIRST_SLICE = 20_000
_SLICE_SECONDS = 0.05
_TICK_STEPS, _CONFLICT_STEPS = 7, 700
"""Elementary steps for one of the register TICKS, and for a conflict and node."""
_KEEP_LBD = 2
_REDUCE_FIRST, _REDUCE_STEP = 2000, 500


class OutOfTime(Exception):
    """The deadline passed before there was an answer."""


class _Clauses(NamedTuple):
    """Clauses and the sets they rest on."""

    literals: NDArray[np.int32]
    """(L, 2) edges and masks, clause after clause."""
    size: NDArray[np.int32]
    """(C,) number of literals."""
    lbd: NDArray[np.int32]
    """(C,) levels among the literals when the clause was learned."""
    sets: NDArray[np.uint64]
    """(C, words) sets of statements."""

    def chosen(self, keep: NDArray[Any]) -> _Clauses:
        """Return the clauses of these numbers, in this order."""
        size = self.size[keep].astype(np.int64)
        before = np.cumsum(self.size, dtype=np.int64) - self.size
        stop = np.cumsum(size)
        source = np.repeat(before[keep] - (stop - size), size) + np.arange(int(size.sum()))
        return _Clauses(self.literals[source], self.size[keep], self.lbd[keep], self.sets[keep])

    def with_more(self, more: _Clauses) -> _Clauses:
        """Return these clauses and then those."""
        return _Clauses(
            np.concatenate([self.literals, more.literals]),
            np.concatenate([self.size, more.size]),
            np.concatenate([self.lbd, more.lbd]),
            np.concatenate([self.sets, more.sets]),
        )

    def best(self, most: int) -> _Clauses:
        """Return the clauses of the fewest levels and literals, the last learned among equals, in their old order."""
        rank = np.lexsort((-np.arange(len(self.size)), self.size, self.lbd))
        return self.chosen(np.sort(rank[:most]))


class CoreSearch:
    """Decides parts of given statements over one frame.

    Parameters
    ----------
    tables, frame
        The calculus and the pairs that are kept.
    arcs, masks
        (m,) for each statement the arc it is about and its relation, not empty; several may be about one pair.
    first
        (m,) bool: statements to be stated and closed before the others, so that a refutation rests on them by preference.
    seed
        Breaks ties: the same questions in the same order have the same answers.
    """

    def __init__(
        self,
        tables: Tables,
        frame: Frame,
        arcs: NDArray[np.int64],
        masks: NDArray[np.int16],
        first: NDArray[np.bool_],
        *,
        seed: int = 0,
    ) -> None:
        m = len(arcs)
        self.conflicts = 0
        self._tables, self._frame = tables, frame
        self._arcs, self._masks, self._first = arcs, masks, first
        self._seed = seed
        self._n_groups = min(m, _GROUPS)
        self._group = np.arange(m) * self._n_groups // max(m, 1)
        words = -(-self._n_groups // 64)
        nothing = np.empty(0, dtype=np.int32)
        self._clauses = _Clauses(nothing.reshape(0, 2), nothing, nothing, np.empty((0, words), dtype=np.uint64))
        self._activity: NDArray[np.float64] | None = None
        self._phase = np.zeros(frame.n_edges, dtype=np.int16)
        self._slice = _FIRST_SLICE
        self._deadline: float | None = None
        self._reductions = 0
        self._counted = 0
        self._state: State
        self._trace: t.Trace

    def refute(self, part: Sequence[int], deadline: float | None = None) -> list[int] | None:
        """Return which statements of a part its refutation rests on, or None if closure leaves the part a scenario.

        Parameters
        ----------
        part
            Positions of the statements, ascending.
        deadline
            On the clock of `time.perf_counter`; compiling puts it off.

        Raises
        ------
        OutOfTime
            The deadline passed first.
        """
        chosen = np.asarray(part, dtype=np.int64)
        self._deadline = deadline
        units = self._lay_out(chosen)
        refuted = self._decide(chosen, units)
        self._hand_on()
        if not refuted:
            self._phase = self._state.dom[::2].copy()
            return None
        bits = np.unpackbits(self._trace.total.view(np.uint8), bitorder="little")
        found: list[int] = chosen[bits[self._group[chosen]] == 1].tolist()
        return found

    def _lay_out(self, part: NDArray[np.int64]) -> NDArray[np.int32]:
        """Make the arrays for a part, with the clauses that follow from it; return (k, 3) those of one literal."""
        arcs, masks = self._arcs[part], self._masks[part]
        edges, at = np.unique(arcs >> 1, return_inverse=True)
        labels = np.full(len(edges), self._tables.full, dtype=np.int16)
        np.bitwise_and.at(labels, at, np.where(arcs & 1, self._tables.converse[masks], masks))
        state = new_state(self._tables, self._frame, 2 * edges, labels, rng=np.random.default_rng(self._seed))
        state.marks[:, c.ROOT] = self._tables.full  # nothing is granted
        state.reg[c.KEEP] = 1
        state.reg[c.REDUCE_AT] = _REDUCE_FIRST
        if self._activity is not None:
            state.activity[:] = self._activity
        self._reductions = 0
        trace = t.new_trace(self._n_groups, self._frame.n_edges, state.place.size)
        trace.phase[:] = self._phase
        absent = np.zeros(self._trace_bytes(trace), dtype=np.uint8)
        absent[np.setdiff1d(np.arange(self._n_groups), self._group[part])] = 1
        gone = np.packbits(absent, bitorder="little").view(np.uint64)
        clauses = self._clauses.chosen(np.flatnonzero(~(self._clauses.sets & gone).any(axis=1)))
        self._state, self._trace = state, trace
        self._counted = 0
        single = clauses.size == 1
        rows = self._keep_sets(clauses.sets)
        starts = np.cumsum(clauses.size) - clauses.size
        units = np.column_stack([clauses.literals[starts[single]], rows[single]]).astype(np.int32)
        self._install(clauses.chosen(np.flatnonzero(~single)), rows[~single])
        return units

    @staticmethod
    def _trace_bytes(trace: t.Trace) -> int:
        words: int = trace.sets.shape[1]
        return 64 * words

    def _decide(self, part: NDArray[np.int64], units: NDArray[np.int32]) -> bool:
        """Say whether a part is refuted."""
        first = self._first[part]
        for rows in (part[first], part[~first]):
            if rows.size and self._state_all(self._arcs[rows], self._masks[rows], self._group[rows]):
                return True
        if len(units) and self._state_all(2 * units[:, 0], units[:, 1], units[:, 2]):
            return True
        return self._run(t.search_traced) == c.INCONSISTENT

    def _state_all(self, arcs: NDArray[Any], masks: NDArray[Any], rows: NDArray[Any]) -> bool:
        """State relations and close them; say whether that refutes the part."""
        state = self._state
        needed = int(state.reg[c.TOP]) + len(arcs) + 2 * self._frame.n + state.place.size + 2
        if needed > len(state.trail):
            self._enlarge("trail", needed)
        arguments = arcs.astype(np.int64), masks.astype(np.int16), rows.astype(np.int64)
        status = self._run(t.state_traced, *arguments)
        return status == c.INCONSISTENT or self._run(t.close_traced) == c.INCONSISTENT

    def _form(self, kernel: Any) -> Any:
        """Run plain while the work is small; what was done since the last call counts, conflicts above all."""
        reg = self._state.reg
        done = _TICK_STEPS * int(reg[c.TICKS]) + _CONFLICT_STEPS * self._frame.n * int(reg[c.CONFLICTS])
        new, self._counted = done - self._counted, done
        return kernel.for_work(new)

    def _run(self, kernel: Any, *arguments: Any) -> int:
        """Run a kernel until it has an answer, making room and looking at the clock."""
        while True:
            reg = self._state.reg
            done = int(reg[c.TICKS])
            form = self._form(kernel)
            begin = time.perf_counter()
            rest = arguments or (done + (_PLAIN_SLICE if form is kernel.plain else self._slice),)
            new = form is not kernel.plain and not form.signatures
            status = form(self._state, self._trace, *rest)
            now = time.perf_counter()
            if new and self._deadline is not None:
                self._deadline += now - begin  # compiling, or loading what was compiled, is no part of the budget
            match status:
                case c.PAUSED:
                    pass
                case c.TRAIL_FULL:
                    self._enlarge("trail", self._frame.n_edges * (self._tables.n_bases - 1) + 4 * self._frame.n + 1024)
                case c.ARENA_FULL:
                    self._enlarge_clauses()
                case c.REDUCE:
                    self._reduce()
                case t.SETS_FULL:
                    self._enlarge_sets()
                case _:
                    return int(status)
            if self._deadline is not None and now > self._deadline:
                raise OutOfTime
            if form is not kernel.plain and status == c.PAUSED and not new:
                wanted = self._slice * _SLICE_SECONDS / max(now - begin, 1e-6)
                self._slice = int(min(max(wanted, self._slice / 2, 1000), 2 * self._slice))

    def _enlarge(self, name: str, least: int = 0) -> None:
        """Make an array of the state at least twice as long."""
        old = getattr(self._state, name)
        self._state = self._state._replace(**{name: _longer(old, max(2 * len(old), least))})

    def _enlarge_clauses(self) -> None:
        state = self._state
        if state.reg[c.N_CLAUSES] == state.place.size:
            self._enlarge("place")
            self._enlarge("watch")
            self._trace = self._trace._replace(clause_set=_longer(self._trace.clause_set, len(self._state.place)))
        while state.reg[c.ARENA_TOP] + c.LITERALS + 2 * state.reg[c.TOP] > self._state.arena.size:
            self._enlarge("arena")

    def _enlarge_sets(self) -> None:
        """Make room where a trace is more than half full."""
        trace = self._trace
        for name, used in (("sets", t.N_ROWS), ("goals", t.N_GOALS), ("used", t.N_USED), ("units", t.N_UNITS)):
            old = getattr(trace, name)
            if 2 * trace.reg[used] > len(old):
                trace = trace._replace(**{name: _longer(old, 2 * max(len(old), int(trace.reg[used])))})
        trace = trace._replace(stack=_longer(trace.stack, 2 * len(trace.stack)))
        # the memory is a table of hashed places, so it starts anew
        size = len(trace.keys) * (2 if 4 * trace.reg[t.N_MEMO] > len(trace.keys) else 1)
        trace.reg[t.N_MEMO] = 0
        self._trace = trace._replace(keys=np.full(size, -1, dtype=np.int64), found=np.zeros(size, dtype=np.int32))

    def _keep_sets(self, sets: NDArray[np.uint64]) -> NDArray[np.int32]:
        """Write sets to the trace and return their rows."""
        reg = self._trace.reg
        first = int(reg[t.N_ROWS])
        if first + len(sets) + 4096 > len(self._trace.sets):
            self._trace = self._trace._replace(sets=_longer(self._trace.sets, 2 * (first + len(sets)) + 4096))
        self._trace.sets[first : first + len(sets)] = sets
        reg[t.N_ROWS] = first + len(sets)
        return np.arange(first, first + len(sets), dtype=np.int32)

    def _install(self, clauses: _Clauses, rows: NDArray[np.int32]) -> None:
        """Make these the clauses of the state, none of one literal, each with the row of its set."""
        count = len(clauses.size)
        length = c.LITERALS + 2 * clauses.size.astype(np.int64)
        total = int(length.sum())
        while count > self._state.place.size:
            self._enlarge("place")
            self._enlarge("watch")
        if total > self._state.arena.size:
            self._enlarge("arena", total)
        if len(self._trace.clause_set) < len(self._state.place):
            self._trace = self._trace._replace(clause_set=_longer(self._trace.clause_set, len(self._state.place)))
        state = self._state
        place = np.cumsum(length) - length
        state.place[:count] = place
        state.arena[place + c.SIZE] = clauses.size
        state.arena[place + c.LBD] = clauses.lbd
        inside = np.repeat(place + c.LITERALS - 2 * (np.cumsum(clauses.size) - clauses.size), clauses.size)
        at = inside + 2 * np.arange(len(clauses.literals))
        state.arena[at], state.arena[at + 1] = clauses.literals[:, 0], clauses.literals[:, 1]
        self._trace.clause_set[:count] = rows
        state.reg[c.N_CLAUSES], state.reg[c.ARENA_TOP] = count, total
        state.edges[:, c.WATCH] = -1
        self._form(t.attach_all)(state)

    def _present(self) -> tuple[_Clauses, NDArray[np.int32]]:
        """Return the clauses of the state and the rows of their sets."""
        state, trace = self._state, self._trace
        place = state.place[: int(state.reg[c.N_CLAUSES])].astype(np.int64)
        size = state.arena[place + c.SIZE]
        inside = np.repeat(place + c.LITERALS - 2 * (np.cumsum(size) - size), size)
        at = inside + 2 * np.arange(int(size.sum()))
        rows = trace.clause_set[: len(place)].copy()
        literals = np.column_stack([state.arena[at], state.arena[at + 1]])
        return _Clauses(literals, size, state.arena[place + c.LBD], trace.sets[rows]), rows

    def _reduce(self) -> None:
        """Forget the worse half of the clauses; at level 0."""
        while not self._detached():
            self._enlarge_sets()
        clauses, rows = self._present()
        worse = np.flatnonzero(clauses.lbd > _KEEP_LBD)
        rank = np.lexsort((-worse, clauses.size[worse], clauses.lbd[worse]))
        keep = np.ones(len(rows), dtype=bool)
        keep[worse[rank[len(worse) // 2 :]]] = False
        kept = np.flatnonzero(keep)
        self._install(clauses.chosen(kept), rows[kept])
        self._reductions += 1
        reg = self._state.reg
        reg[c.REDUCE_AT] = reg[c.CONFLICTS] + _REDUCE_FIRST + _REDUCE_STEP * self._reductions

    def _detached(self) -> bool:
        return bool(self._form(t.detach_root)(self._state, self._trace))

    def _hand_on(self) -> None:
        """Keep for the next search what this one learned, with what it was handed and could not use."""
        state, trace = self._state, self._trace
        learned, _ = self._present()
        units = trace.units[: int(trace.reg[t.N_UNITS])]
        ones = np.ones(len(units), dtype=np.int32)
        new = _Clauses(units[:, :2], ones, ones, trace.sets[units[:, 2]])
        old = self._clauses.chosen(np.flatnonzero(self._clauses.size == 1))
        self._clauses = old.with_more(new).with_more(learned).best(_HANDED_ON)
        self._activity = state.activity.copy()
        self.conflicts += int(state.reg[c.CONFLICTS])


def _longer(old: NDArray[Any], size: int) -> NDArray[Any]:
    """Return a copy with room for `size` rows."""
    new = np.empty((size, *old.shape[1:]), dtype=old.dtype)
    new[: len(old)] = old
    return new
