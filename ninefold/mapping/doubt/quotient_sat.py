"""Every plane map that explains a folded walk, found by a SAT solver.

One variable a pair of nodes that can be one place; clauses for what holds of every quotient (`_node_pairs`). A solution is a
quotient, and its faces are walked: where one turns neither +1 nor -1, or two turn -1, or none (a torus), it is no plane map.
Every connected part of a plane map is one, so the fault is looked for in the smallest part of the walk that shows it. It
gives a *cut*, a clause over the few pairs of nodes that made the faces of that part what they are: "not all of these pairs,
or somebody walked an exit in a corner, or the walk went round twice". Cuts are added until a solution is a map, which is
then excluded in its turn, until there is no solution.

In a map of one piece turning of +1 for all faces but one, and -1 for that, implies genus 0 (Gauss and Bonnet): nothing else
has to be cut.

Long walks in irregular worlds, where few places look alike, yield to this and not to the search of `quotients`; grids the
reverse.
"""

from __future__ import annotations

from itertools import combinations
from time import monotonic
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ninefold.encodings.sat import open_solver
from ninefold.errors import BadInput

from ._node_pairs import clauses, node_pairs, walkers
from ._quotient_faces import Face, Members, Step, faces, members, room, smallest_part, steps

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from .likeness import Likeness
    from .walk_tree import WalkTree

__all__ = ["Cut", "QuotientSat"]

ROOTS = 4
"""Parts of a quotient that are cut at once."""


class Cut(NamedTuple):
    """A clause that no plane map violates, and what shows it.

    Attributes
    ----------
    clause
        Literals.
    faces
        One face that turns neither +1 nor -1, or two that turn -1, or all faces of a torus.
    part
        The nodes of the part of the tree whose quotient has those faces.
    """

    clause: tuple[int, ...]
    faces: tuple[Face, ...]
    part: tuple[int, ...]


class QuotientSat:
    """A question to a solver that can be stopped and gone on with.

    Parameters
    ----------
    tree, alike
        The walk, and what of it can be the same. With a compass.
    closed
        Whether no exit may be left untravelled.
    most_places
        Places of a map at most, or None.

    Attributes
    ----------
    found
        How many maps were found so far.
    done
        Whether these are all.
    cuts
        Those made so far.
    """

    def __init__(self, tree: WalkTree, alike: Likeness, *, closed: bool = False, most_places: int | None = None) -> None:
        if not tree.compass:
            raise BadInput(
                "a walk without a compass has no model for a solver: how it closes is not settled by pairs of nodes"
            )
        self.tree, self.alike = tree, alike
        self.pairs = node_pairs(tree, alike)
        self.closed = closed
        self.most_places = most_places
        self.found = 0
        self.done = False
        self.cuts: list[Cut] = []
        self.rounds = 0
        self._next_root = 0
        self._room = room(tree)
        self._stride = max(1, int(0.382 * tree.n_nodes))
        self._solver = open_solver()
        for _, block in clauses(tree, alike, self.pairs, closed=closed):
            self._solver.add_clauses(block)

    def close(self) -> None:
        """Free the solver."""
        self._solver.close()

    def more(self, seconds: float) -> NDArray[np.int64]:
        """Go on for some time; return the maps found, (B, N, 2): place and shift of every node.

        Notes
        -----
        Every solution costs what the solver takes and O(N K) for its faces.
        """
        until = monotonic() + seconds
        out: list[NDArray[np.int64]] = []
        while not self.done and (left := until - monotonic()) > 0:
            quotient = self.solved(seconds=left)
            if quotient is None:
                break
            self.exclude(quotient)
            if self.most_places is None or np.unique(quotient[:, 0]).size <= self.most_places:
                self.found += 1
                out.append(quotient)
        return np.array(out, np.int64).reshape(len(out), self.tree.n_nodes, 2)

    def solved(self, assumed: Sequence[int] = (), *, seconds: float) -> NDArray[np.int64] | None:
        """Return a map of those not excluded in which some literals hold, (N, 2); None if there is none or time is spent.

        Without literals `done` tells which; with them, `refuted` does.
        """
        until = monotonic() + seconds
        self.refuted = False
        while (left := until - monotonic()) > 0:
            answer = self._solver.solve(assumed, budget=left)
            if answer is None:
                return None
            if not answer:
                self.refuted = True
                self.done = self.done or not assumed
                return None
            self.rounds += 1
            quotient = self._quotient(self._solver.model())
            cuts = self._cuts(quotient)
            if not cuts:
                return quotient
            self.cuts += cuts
            self._solver.add_clauses([cut.clause for cut in cuts])
        return None

    def exclude(self, quotient: NDArray[np.int64]) -> None:
        """Leave a map out from now on."""
        self._solver.add_clause(self.excluding(quotient))

    def excluding(self, quotient: NDArray[np.int64]) -> list[int]:
        """Return the clause that says that a quotient is not that one.

        It tells by every node's pair with the lowest node of its place, and by every lowest node's pairs with all before it.
        """
        place, shift = self._lowest(quotient)
        clause: list[int] = []
        for n, lead in enumerate(place.tolist()):
            if lead != n:
                clause.append(-self.pairs.table[n, lead, int(shift[n])])
                continue
            span = slice(self.pairs.start[n], self.pairs.start[n + 1])
            clause += self.pairs.variable[span][self.pairs.partner[span] < n].tolist()
        return clause

    def _lowest(self, quotient: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Return place and shift of every node against the lowest node of its place."""
        _, first, place = np.unique(quotient[:, 0], return_index=True, return_inverse=True)
        lead = first[place]
        return lead, (quotient[:, 1] - quotient[lead, 1]) % np.maximum(self.tree.degree, 1)

    def _quotient(self, model: list[int]) -> NDArray[np.int64]:
        """Return place, as its lowest node, and shift of every node."""
        pairs = self.pairs
        quotient = np.zeros((self.tree.n_nodes, 2), np.int64)
        quotient[:, 0] = np.arange(self.tree.n_nodes)
        literals = np.array(model, np.int64)
        true = literals[(literals > 0) & (literals <= pairs.n_variables)] - 1
        true = true[np.lexsort((pairs.first[true], pairs.second[true]))[::-1]]  # the lowest partner is written last
        first, second = pairs.first[true], pairs.second[true]
        quotient[second, 0] = first
        quotient[second, 1] = -pairs.shift[true] % np.maximum(self.tree.degree[second], 1)
        return quotient

    def _cuts(self, quotient: NDArray[np.int64]) -> list[Cut]:
        """Return cuts that a quotient violates; none for a map."""
        place, shift = quotient[:, 0], quotient[:, 1]
        cuts: dict[tuple[int, ...], Cut] = {}
        for _ in range(ROOTS):
            root = self._next_root
            self._next_root = (root + self._stride) % self.tree.n_nodes
            part = smallest_part(self._room, place, shift, root)
            if not part.size:
                return []
            cut = self._cut(place, shift, part)
            cuts[cut.clause] = cut
        return list(cuts.values())

    def _cut(self, place: NDArray[np.int64], shift: NDArray[np.int64], part: NDArray[np.int64]) -> Cut:
        """Return the shortest cut that shows that a part of a quotient is not plane."""
        inside = np.zeros(self.tree.n_nodes, np.bool_)
        inside[part] = True
        around = faces(self.tree, place, shift, inside)
        at = members(self.tree, place, shift, inside)
        walk = {face: steps(at, face.node, face.exit) for face in around}
        made = {face: self._made_by(walk[face], inside) for face in around}
        wrong, outer = [face for face in around if abs(face.turns) != 1], [face for face in around if face.turns == -1]
        found: list[tuple[set[int], tuple[Face, ...]]] = [
            (made[face] | self._fewer_rounds(walk[face], face.turns), (face,)) for face in wrong
        ]
        for face, other in combinations(outer, 2):
            found.append((made[face] | made[other] | self._one_face(walk[face], walk[other]), (face, other)))
        if not found:
            found.append((set().union(*made.values()) | self._nothing_else(at, list(walk.values())), tuple(around)))
        clause, which = min(found, key=lambda one: (len(one[0]), one[1]))
        begins = tuple(Face(walk[face][0].walker, walk[face][0].walked, face.turns) for face in which)
        return Cut(tuple(sorted(clause)), begins, tuple(part.tolist()))

    def _made_by(self, around: list[Step], inside: NDArray[np.bool_]) -> set[int]:
        """Return literals of which one holds if a face is not as it was walked."""
        literals: set[int] = set()
        for step in around:
            if step.node != step.walker:
                along = (step.walked - step.exit) % int(self.tree.degree[step.node])
                literals.add(-self.pairs.table[step.node, step.walker, along])
            for x in step.corner:
                literals.update(walkers(self.tree, self.pairs, step.node, x, inside))
        return literals

    def _nothing_else(self, at: Members, walks: list[list[Step]]) -> set[int]:
        """Return literals of which one holds if some way back along a face belongs to none of them."""
        walker = {at.dart(step.walker, step.walked): step for walk in walks for step in walk}
        literals = set()
        for step in walker.values():
            node, x = int(self.tree.other[step.walker, step.walked]), int(self.tree.back[step.walker, step.walked])
            back = walker[at.dart(node, x)]
            if back.walker != node:
                along = (back.walked - x) % int(self.tree.degree[node])
                literals.add(-self.pairs.table[node, back.walker, along])
        return literals

    def _fewer_rounds(self, around: list[Step], turns: int) -> set[int]:
        """Return literals of which one holds if a walk goes several times round a face that turns +1 or -1.

        That many times it turns, and so two ways that far apart along it are one way.
        """
        rounds = abs(turns)
        if rounds < 2 or len(around) % rounds:
            return set()
        far = len(around) // rounds
        return min((self._one_way(around[i], [around[i + far]]) for i in range(len(around) - far)), key=len)

    def _one_face(self, around: list[Step], other: list[Step]) -> set[int]:
        """Return literals of which one holds if two walks go round one face."""
        return min((self._one_way(step, other) for step in around), key=len)

    def _one_way(self, step: Step, others: list[Step]) -> set[int]:
        """Return literals of which one holds if a way is one of some others."""
        found = set()
        for one in others:
            degree = int(self.tree.degree[step.walker])
            if degree == self.tree.degree[one.walker]:
                found.add(self.pairs.table.get((step.walker, one.walker, (one.walked - step.walked) % degree), 0))
        return found - {0}
