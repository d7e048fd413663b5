"""Proofs of inconsistency that other programs check: a formula in CNF, and its refutation in DRAT or LRAT.

`to_drat` replays a `Proof` and writes it so that any checker of propositional proofs can follow it. What has to be trusted
is then that checker, the composition table of the calculus, and `ninefold.reasoner.networks.propositional`, which writes the
CNF. Neither the search nor anything in this module has to be: a mistake here gives a proof that is refused.

How the refutation is written
-----------------------------
The CNF has a variable a pair and base relation, ``x(i, j, r)``. In a proof labels only ever get smaller, so all that needs
saying is which base relations are *excluded*: ``not x(i, j, t)``.

*One triangle.* Let the labels R of (i, k) and S of (k, j) rule out t for (i, j). Suppose ``x(i, j, t)``. For every r in R,
each s that allows t is excluded, so the composition clause of (t, r) makes ``x(i, k, r)`` false; the others outside R are
excluded; nothing is left for (i, k). All of this is unit propagation, so ``not x(i, j, t)`` is one line, by reverse unit
propagation (RUP): a label that becomes smaller costs one line a base relation, seven at most with eight, and only those
exclusions are written that are used further on.

*A learned clause* says "pair 1 is in M1, or pair 2 in M2, or ...". A pair is in a mask exactly if one of the mask's
variables is true, so over variables it is one long clause, and a mask needs no variable of its own. What it excludes, when
all literals but one fail, is again one line a base relation: the clauses "no two base relations" do the rest.

*Deriving it* takes many exclusions that hold only as long as all its literals are denied. So each derivation begins with one
fresh variable d, the *denial*, defined by ``d or x or x' or ...`` and ``not d or not x`` for each of the clause's variables;
those are lines by resolution asymmetric tautology (RAT), and they are so trivially, as d occurs nowhere else. Every
exclusion under the denial is then a clause of two literals, ``not d or not x(i, j, t)``. When a pair has nothing left,
``not d`` follows, and the learned clause with it; what hung on d is deleted.

Only what the end needs is written: the proof is walked backwards from the empty label (Goldberg and Novikov, `proofs`), and
clauses that nothing used, and literals of a clause that its derivation did not use, are left out.

In LRAT every line also says which clauses make it propagate, in that order, which the walk knows; a checker needs no search.

For other answers: that a network entails something is a proof that the network with the opposite added is inconsistent; that
the statements of a conflict cannot hold together is a proof for ``conflict.to_network()``. See the page on proofs.

References
----------
N. Wetzler, M. Heule and W. Hunt, "DRAT-trim: efficient checking and trimming using expressive clausal proofs", SAT 2014.
L. Cruz-Filipe, M. Heule, W. Hunt, M. Kaufmann and P. Schneider-Kamp, "Efficient certified RAT verification", CADE 2017
(LRAT).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ninefold._files import published, refuse_existing
from ninefold.errors import BadInput

from ._lines import LINE, VARIABLE, Lines, write_lines
from ._premises import CLOSED, N_ROWS, ROW_COLUMNS, Walk, backward, forward, rehash
from ._replay import PAIR, TOP, arcs_of, new_replay
from .integers import to_text
from .proofs import check_subject
from .propositional import to_cnf

if TYPE_CHECKING:
    import os

    from ._replay import Replay
    from .network import Network
    from .proofs import Proof
    from .propositional import Cnf

__all__ = ["ClausalProof", "to_drat"]


@dataclass(frozen=True, slots=True)
class ClausalProof:
    """A formula that cannot be satisfied, and its refutation.

    Attributes
    ----------
    cnf
        The formula, in DIMACS form.
    refutation
        In the format that was asked for.
    n_variables, n_clauses
        Of the formula.
    n_lines
        Clauses that the refutation derives; deletions are not counted.
    """

    cnf: bytes = field(repr=False)
    refutation: bytes = field(repr=False)
    n_variables: int
    n_clauses: int
    n_lines: int

    def write(
        self, refutation: str | os.PathLike[str], cnf: str | os.PathLike[str] | None = None, *, force: bool = False
    ) -> tuple[Path, Path]:
        """Write both files, each whole or not at all, and return where they are.

        Parameters
        ----------
        refutation, cnf
            Paths; by default the formula goes beside the refutation, with the ending .cnf.
        force
            Replace what is there; otherwise a file that exists is an error.

        Raises
        ------
        BadInput
            If a file exists or cannot be written, or both would have one name.
        """
        path = Path(refutation)
        formula = path.with_suffix(".cnf") if cnf is None else Path(cnf)
        if formula == path:
            raise BadInput(f"{path}: the formula gets this name; give the proof another ending, such as .drat")
        for file in (path, formula):
            refuse_existing(file, force=force)
        for file, content in ((formula, self.cnf), (path, self.refutation)):  # a proof is never there without its formula
            with published(file, force=force) as temporary:
                temporary.write_bytes(content)
        return path, formula


def to_drat(net: Network, proof: Proof, *, lrat: bool = False) -> ClausalProof:
    """Write a proof as a CNF and its refutation.

    Parameters
    ----------
    net
        The inconsistent network.
    proof
        Its proof, as `check` keeps it.
    lrat
        Write LRAT, whose lines name the clauses they follow from, instead of DRAT.

    Raises
    ------
    BadInput
        If the proof is of another network, or does not hold.

    Notes
    -----
    Takes about as long as `prove`, since it replays what it needs of the proof.

    Examples
    --------
    >>> from ninefold.reasoner import Network, check
    >>> net = Network("rcc5")
    >>> for a, b in [("a", "b"), ("b", "c"), ("c", "a")]:
    ...     _ = net.add(a, b, "PP")
    >>> found = to_drat(net, check(net, proof=True).proof)
    >>> found
    ClausalProof(n_variables=15, n_clauses=17, n_lines=2)
    >>> print(found.refutation.decode(), end="")
    -9 0
    0
    """
    check_subject(net, proof)
    stated, full = net.constraints().triples(), net.calculus.universal
    learned = [clause for clause in proof.clauses if clause]
    replay = new_replay(net.calculus, net.n_entities, proof.pairs, stated, learned)
    work = 10 * len(replay.head) * len(proof.clauses)
    walk = _new_walk(net, replay, len(learned))
    taken = forward.for_work(work)(replay, walk, *arcs_of(replay, stated), len(learned))
    if taken < 0:
        raise BadInput("the proof does not hold: closure and its clauses leave every label something")
    walk = _note(replay, walk, taken, full, work)
    cnf, lines = _number(net, replay, walk, lrat=lrat)
    parts: list[bytes] = []
    row, out = int(walk.filled[N_ROWS]) - 1, np.empty(1 << 18, dtype=np.int64)
    write = write_lines.for_work(20 * row)
    while row >= 0:
        row, used, least = write(replay, walk, lines, out, row, lrat)
        parts.append(to_text(out[:used]))
        if least > out.size:
            out = np.empty(2 * least, dtype=np.int64)
    return ClausalProof(cnf.text, b"".join(parts), cnf.n_variables, cnf.n_clauses, int(lines.reg[LINE]) - cnf.n_clauses)


def _new_walk(net: Network, replay: Replay, n_clauses: int) -> Walk:
    b, n_arcs = net.calculus.n_bases, len(replay.head)
    table = net.calculus.base_composition.astype(np.int64)
    bits = (table[None, :, :] >> np.arange(b)[:, None, None] & 1) << np.arange(b)  # [t, r, s]
    return Walk(
        need=np.zeros(n_arcs, dtype=np.int32),
        used=np.zeros(n_arcs, dtype=np.bool_),
        split=np.zeros(n_arcs, dtype=np.bool_),
        wanted=np.zeros(n_clauses + 1, dtype=np.bool_),
        mark=np.zeros(n_clauses + 1, dtype=np.int64),
        support=bits.sum(axis=2).astype(np.int32),
        rows=np.empty((1 << 14, ROW_COLUMNS), dtype=np.int32),
        keys=np.full(1 << 14, -1, dtype=np.int64),
        masks=np.zeros(1 << 14, dtype=np.int32),
        filled=np.zeros(2, dtype=np.int64),
    )


def _note(replay: Replay, walk: Walk, taken: int, full: int, work: int) -> Walk:
    """Note what the empty label at the end of the trail needs."""
    last = int(replay.trail[replay.reg[TOP] - 1, PAIR])
    walk.need[last] = full
    walk.used[last] = True
    walk.rows[0] = CLOSED, last, -1, 0, 0, 0, 0
    walk.filled[N_ROWS] = 1
    go_back = backward.for_work(work)
    while True:
        taken = go_back(replay, walk, taken, full)
        if taken == -1:
            return walk
        if taken < -1:
            raise BadInput(f"clause {-1 - taken} of the proof does not follow from those before it")
        walk = _enlarge(walk)


def _enlarge(walk: Walk) -> Walk:
    """Double the room of a walk."""
    rows = np.empty((2 * len(walk.rows), ROW_COLUMNS), dtype=np.int32)
    used = int(walk.filled[N_ROWS])
    rows[:used] = walk.rows[:used]
    keys, masks = np.full(2 * walk.keys.size, -1, dtype=np.int64), np.zeros(2 * walk.keys.size, dtype=np.int32)
    rehash.for_work(walk.keys.size)(walk.keys, walk.masks, keys, masks)
    return walk._replace(rows=rows, keys=keys, masks=masks)


def _number(net: Network, replay: Replay, walk: Walk, *, lrat: bool) -> tuple[Cnf, Lines]:
    """Write the clauses that are needed, and number what the lines speak of."""
    b, n, head = net.calculus.n_bases, net.n_entities, replay.head
    pairs = np.flatnonzero(walk.used)
    slots = np.flatnonzero(walk.keys >= 0)
    key, t = walk.keys[slots] // b, walk.keys[slots] % b
    pair, middle = key // n, key % n
    triangles = np.column_stack([head[replay.back[pair]], head[pair], middle, t, walk.masks[slots]])
    cnf = to_cnf(net, np.column_stack([head[replay.back[pairs]], head[pairs]]), walk.split[pairs], triangles)

    place, at_least = np.zeros(len(head), dtype=np.int32), np.zeros(len(head), dtype=np.int32)
    unique = np.zeros(len(head), dtype=np.int64)
    at_least[pairs] = np.arange(1, pairs.size + 1)
    place[pairs] = b * np.arange(pairs.size) + 1
    unique[pairs] = cnf.unique
    composed = np.zeros((walk.keys.size if lrat else 1, b), dtype=np.int64)
    if lrat:
        composed[slots] = cnf.composed
    reg = np.zeros(6, dtype=np.int64)
    reg[LINE], reg[VARIABLE] = cnf.n_clauses, cnf.n_variables
    number = np.zeros(cnf.n_variables + 1, dtype=np.int64)
    number[1:] = cnf.stated
    return cnf, Lines(
        place=place,
        at_least=at_least,
        unique=unique,
        composed=composed,
        turn=np.asarray(net.calculus.base_converse, dtype=np.int32),
        number=number,
        learned=np.zeros(len(walk.wanted), dtype=np.int64),
        own=np.empty(cnf.n_variables + 1, dtype=np.int32),
        own_lines=np.empty(cnf.n_variables + 1, dtype=np.int64),
        reg=reg,
    )
