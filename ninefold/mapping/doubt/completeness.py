"""Evidence that a list of maps is all that explain a walk: a formula in CNF, and its refutation in DRAT.

The formula says what holds of every plane map that explains the walk and is none of those listed; it cannot be satisfied.
Every clause has its reason, in comments before the header:

- ``c variable 17 pair 3 8 1``: variable 17 says that nodes 3 and 8 of the folded walk are one place, exit x of the one being
  exit x + 1 of the other;
- ``c clauses 1 5000 transitive``, and so for ``congruent``, ``covered`` and ``together``: see `_node_pairs`;
- ``c clause 6001 cut 2 3 9 face 2 1 0``: nodes 2, 3 and 9 of the tree have a face that begins at exit 1 of node 2 and turns
  0 times; see `quotient_sat`;
- ``c clause 6002 map``, then the place of every node, then its shift: a map that was listed, and that the clause excludes.

That the formula cannot be satisfied, any checker of DRAT confirms. That every clause holds, `completeness_check` confirms
from the folded walk alone; it shares no code with what found the maps.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from time import monotonic
from typing import TYPE_CHECKING

import numpy as np

from ninefold._files import published, refuse_existing
from ninefold._wording import counted
from ninefold.encodings.sat import refutation
from ninefold.errors import BadInput, TooLarge

from ._node_pairs import clauses, node_pairs
from .quotient_sat import QuotientSat

if TYPE_CHECKING:
    import os
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from .likeness import Likeness
    from .walk_tree import WalkTree

__all__ = ["Completeness", "completeness"]


@dataclass(frozen=True, slots=True)
class Completeness:
    """A formula that cannot be satisfied as the maps listed are all, and its refutation.

    Attributes
    ----------
    cnf
        The formula, in DIMACS form, with the reasons of its clauses in comments.
    refutation
        In DRAT.
    n_maps
        Maps listed.
    n_variables, n_clauses
        Of the formula.
    n_lines
        Of the refutation, without deletions.
    """

    cnf: bytes = field(repr=False)
    refutation: bytes = field(repr=False)
    n_maps: int
    n_variables: int
    n_clauses: int
    n_lines: int

    def write(self, path: str | os.PathLike[str], *, force: bool = False) -> tuple[Path, Path]:
        """Write the refutation, and the formula beside it with the ending .cnf; return where they are.

        Parameters
        ----------
        path
            Such as ``maps.drat``.
        force
            Replace what is there; otherwise a file that exists is an error.

        Raises
        ------
        BadInput
            If a file exists or cannot be written, or both would have one name.
        """
        proof = Path(path)
        formula = proof.with_suffix(".cnf")
        if formula == proof:
            raise BadInput(f"{proof}: the formula gets this name; give the refutation another ending, such as .drat")
        for file in (proof, formula):
            refuse_existing(file, force=force)
        for file, content in ((formula, self.cnf), (proof, self.refutation)):
            with published(file, force=force) as temporary:
                temporary.write_bytes(content)
        return proof, formula


def completeness(
    tree: WalkTree,
    alike: Likeness,
    maps: Sequence[NDArray[np.int64]],
    *,
    closed: bool = False,
    budget: float | None = None,
) -> Completeness:
    """Return evidence that some maps are all that explain a folded walk.

    Parameters
    ----------
    maps
        Place and shift of every node, (N, 2) each.
    closed
        Whether only maps count in which no exit is left untravelled.
    budget
        Seconds, 600 if left out.

    Raises
    ------
    BadInput
        If there is another map.
    TooLarge
        When the budget is spent.
    """
    until = monotonic() + (600.0 if budget is None else budget)
    sat = QuotientSat(tree, alike, closed=closed)
    try:
        for one in maps:
            sat.exclude(one)
        excluding = [sat.excluding(one) for one in maps]
        another = sat.solved(seconds=max(until - monotonic(), 1e-3))
        if another is not None:
            raise BadInput(
                f"{counted(len(maps), 'map')} listed, and there is another with "
                f"{counted(np.unique(another[:, 0]).size, 'place')}"
            )
        cuts = sat.cuts
        if not sat.done:
            raise _spent(until)
    finally:
        sat.close()
    pairs = node_pairs(tree, alike)
    lines = ["c ninefold maps 1", f"c closed {int(closed)}"]
    rows = zip(pairs.first.tolist(), pairs.second.tolist(), pairs.shift.tolist(), strict=True)
    lines += [f"c variable {x} pair {n} {m} {k}" for x, (n, m, k) in enumerate(rows, 1)]
    formula: list[Sequence[int]] = []
    kinds: dict[str, list[list[int]]] = {}
    for kind, block in clauses(tree, alike, pairs, closed=closed):
        kinds.setdefault(kind, []).extend(block)
    for kind, block in kinds.items():
        if block:
            lines.append(f"c clauses {len(formula) + 1} {len(formula) + len(block)} {kind}")
            formula += block
    for cut in cuts:
        formula.append(cut.clause)
        around = " ".join(f"face {face.node} {face.exit} {face.turns}" for face in cut.faces)
        lines.append(f"c clause {len(formula)} cut {' '.join(map(str, cut.part))} {around}")
    for one, clause in zip(maps, excluding, strict=True):
        formula.append(clause)
        lines.append(f"c clause {len(formula)} map {' '.join(map(str, [*one[:, 0].tolist(), *one[:, 1].tolist()]))}")
    proof = refutation(formula, budget=max(until - monotonic(), 1e-3))
    if proof is None:
        raise _spent(until)
    lines.append(f"p cnf {pairs.n_variables} {len(formula)}")
    lines += [" ".join(map(str, [*clause, 0])) for clause in formula]
    derived = sum(not line.startswith(b"d") for line in proof.splitlines())
    return Completeness(("\n".join(lines) + "\n").encode(), proof, len(maps), pairs.n_variables, len(formula), derived)


def _spent(until: float) -> TooLarge:
    return TooLarge("the budget was spent before it was shown that there is no other map; give more seconds")
