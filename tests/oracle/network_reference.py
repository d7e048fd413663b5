"""Consistency of relation networks the plain way: try base relations, look at every triangle.

No table of the library is used beyond `Calculus.base_composition` and `base_converse`; no mask trick, no queue.
"""

import itertools

import numpy as np


class Reference:
    """Closure and search over sets of base names."""

    def __init__(self, calculus):
        self.bases = calculus.bases
        self.converse = {a: calculus.bases[int(calculus.base_converse[i])] for i, a in enumerate(self.bases)}
        self.composition = {
            (a, b): frozenset(c for k, c in enumerate(self.bases) if int(calculus.base_composition[i, j]) >> k & 1)
            for i, a in enumerate(self.bases)
            for j, b in enumerate(self.bases)
        }

    def names(self, mask):
        return frozenset(base for k, base in enumerate(self.bases) if mask >> k & 1)

    def labels(self, n, constraints):
        """Label of every ordered pair of different entities."""
        label = {pair: frozenset(self.bases) for pair in itertools.permutations(range(n), 2)}
        for i, j, mask in constraints:
            label[i, j] &= self.names(mask)
            label[j, i] &= frozenset(self.converse[base] for base in self.names(mask))
        return label

    def compose(self, r, s):
        return frozenset().union(*(self.composition[a, b] for a in r for b in s))

    def closure(self, n, label):
        """Algebraic closure, by going over all triangles until nothing changes; None where a label runs empty."""
        label = dict(label)
        changed = True
        while changed:
            changed = False
            for i, j, k in itertools.permutations(range(n), 3):
                left = label[i, k] & self.compose(label[i, j], label[j, k])
                if left != label[i, k]:
                    label[i, k] = left
                    label[k, i] = frozenset(self.converse[base] for base in left)
                    changed = True
        return label if all(label.values()) else None

    def solve(self, n, constraints):
        """An atomic closed scenario ``{(i, j): base name}``, i < j, or None."""
        return self._search(n, self.labels(n, constraints))

    def _search(self, n, label):
        label = self.closure(n, label)
        if label is None:
            return None
        open_pairs = [(len(label[pair]), pair) for pair in itertools.combinations(range(n), 2) if len(label[pair]) > 1]
        if not open_pairs:
            return {pair: next(iter(label[pair])) for pair in itertools.combinations(range(n), 2)}
        _, (i, j) = min(open_pairs)
        for base in self.bases:
            if base in label[i, j]:
                found = self._search(n, {**label, (i, j): frozenset({base}), (j, i): frozenset({self.converse[base]})})
                if found is not None:
                    return found
        return None

    def is_scenario(self, n, constraints, scenario):
        """Whether base names on all pairs satisfy every constraint and every triangle."""
        full = {**scenario, **{(j, i): self.converse[base] for (i, j), base in scenario.items()}}
        return all(full[i, j] in self.names(mask) for i, j, mask in constraints) and all(
            full[i, k] in self.composition[full[i, j], full[j, k]] for i, j, k in itertools.permutations(range(n), 3)
        )


def random_network(calculus, rng, n, degree, label_size, keep=lambda mask: True):
    """Random constraints as in Renz and Nebel 2001: A(n, d, l), or H(n, d, l) with labels kept in a subclass."""
    pairs = list(itertools.combinations(range(n), 2))
    count = min(len(pairs), round(n * degree / 2))
    constraints = []
    for at in sorted(rng.choice(len(pairs), size=count, replace=False).tolist()):
        mask = 0
        while mask in (0, calculus.universal) or not keep(mask):
            bits = rng.random(calculus.n_bases) < label_size / calculus.n_bases
            mask = sum(1 << int(k) for k in np.flatnonzero(bits))
        i, j = pairs[at]
        constraints.append((i, j, mask) if rng.random() < 0.5 else (j, i, calculus.converse_of(mask)))
    return constraints
