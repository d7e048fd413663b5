"""What an encoding of a relation network is: clauses, the map of their variables, and the way back.

Every module that encodes (`direct`, `support`, `triangulated`, `splitting`, `cells`) takes a calculus, the number of
entities and constraints ``(i, j, mask)``, and returns an `Encoding`. A constraint with the universal relation says
nothing but has its pair encoded, so that clauses over it can be added later.

References
----------
M. Westphal and S. Woelfl, "Qualitative CSP, finite CSP, and SAT: comparing methods for qualitative constraint-based
reasoning", IJCAI 2009.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Protocol

from ninefold.errors import BadInput

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from .calculus import Calculus

__all__ = ["Clause", "Constraint", "Encode", "Encoding", "Labels", "label_matrix"]

Constraint = tuple[int, int, int]
"""Two entities and the mask of the relations allowed between them."""

Clause = tuple[int, ...]
"""Non-zero literals, as SAT solvers take them."""


@dataclass(frozen=True, slots=True)
class Encoding:
    """A network as clauses.

    Parameters
    ----------
    name
        The encoding, such as ``"support"``.
    calculus, n
        Calculus and number of entities.
    n_vars, clauses
        Variables are 1 to `n_vars`.
    variables
        ``(i, j, k)`` with i < j to the variable that says "base relation k holds between i and j"; it is there for
        every base relation the encoding leaves possible, and for every pair it encodes.
    decode
        From a model (literals, missing variables count as false) to a base mask for every encoded pair ``(i, j)``,
        i < j: an atomic scenario that satisfies the network.
    """

    name: str
    calculus: Calculus
    n: int
    n_vars: int
    clauses: tuple[Clause, ...] = field(repr=False)
    variables: Mapping[tuple[int, int, int], int] = field(repr=False)
    decode: Callable[[Sequence[int]], dict[tuple[int, int], int]] = field(repr=False)

    @property
    def pairs(self) -> tuple[tuple[int, int], ...]:
        """Pairs (i, j), i < j, that have variables, in order."""
        return tuple(sorted({(i, j) for i, j, _ in self.variables}))

    def clause(self, i: int, j: int, mask: int) -> Clause:
        """Return the clause "i and j are related by `mask`", to be added or to be put under a selector.

        Raises
        ------
        BadInput
            The pair is not encoded.
        """
        if i > j:
            i, j, mask = j, i, self.calculus.converse_of(mask)
        bases = range(self.calculus.n_bases)
        if not any((i, j, k) in self.variables for k in bases):
            raise BadInput(f"the pair ({i}, {j}) is not encoded: give it a constraint, if only the universal relation")
        return tuple(self.variables[i, j, k] for k in bases if mask >> k & 1 and (i, j, k) in self.variables)


class Encode(Protocol):
    """An encoding function."""

    def __call__(self, calculus: Calculus, n: int, constraints: Iterable[Constraint]) -> Encoding:
        """Encode a network of n entities."""


def label_matrix(calculus: Calculus, n: int, constraints: Iterable[Constraint]) -> dict[tuple[int, int], int]:
    """Return the label of every constrained pair i < j: converses taken, several constraints intersected.

    Raises
    ------
    BadInput
        An index outside 0 to n - 1, an entity related to itself, or a mask outside the calculus. (A self-relation
        that holds the identity says nothing, one that does not is inconsistent: both are the caller's to tell apart.)
    """
    if n < 1:
        raise BadInput(f"a network has at least one entity, not {n}")
    labels: dict[tuple[int, int], int] = {}
    for a, b, r in constraints:
        i, j, mask = int(a), int(b), int(r)
        if not (0 <= i < n and 0 <= j < n) or i == j:
            raise BadInput(f"constraint ({i}, {j}) is not between two different entities of 0 to {n - 1}")
        if not 0 <= mask <= calculus.universal:
            raise BadInput(f"{mask} is no relation of {calculus.name}: masks run from 0 to {calculus.universal}")
        if i > j:
            i, j, mask = j, i, calculus.converse_of(mask)
        labels[i, j] = labels.get((i, j), calculus.universal) & mask
    return labels


class Labels:
    """One variable a pair and base relation, of which exactly one a pair holds: what most encodings share."""

    def __init__(self, calculus: Calculus, labels: Mapping[tuple[int, int], int]) -> None:
        self.calculus = calculus
        self.labels = dict(sorted(labels.items()))
        self.variables: dict[tuple[int, int, int], int] = {}
        for (i, j), mask in self.labels.items():
            for k in range(calculus.n_bases):
                if mask >> k & 1:
                    self.variables[i, j, k] = len(self.variables) + 1

    def bases(self, i: int, j: int) -> list[tuple[int, int]]:
        """Return (base, variable) of the pair i, j for every base relation of its label; i > j is read backwards."""
        if i < j:
            mask = self.labels[i, j]
            return [(k, self.variables[i, j, k]) for k in range(self.calculus.n_bases) if mask >> k & 1]
        converse = self.calculus.base_converse.tolist()
        return [(converse[k], variable) for k, variable in self.bases(j, i)]

    def exactly_one(self) -> list[Clause]:
        """Return "some base relation" and "no two" for every pair."""
        clauses: list[Clause] = []
        for i, j in self.labels:
            variables = [variable for _, variable in self.bases(i, j)]
            clauses.append(tuple(variables))
            clauses.extend((-x, -y) for at, x in enumerate(variables) for y in variables[:at])
        return clauses

    def decode(self, model: Sequence[int]) -> dict[tuple[int, int], int]:
        """Read the base mask of every pair off a model."""
        true = {literal for literal in model if literal > 0}
        return {(i, j): 1 << k for (i, j, k), variable in self.variables.items() if variable in true}
