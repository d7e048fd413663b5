"""Plain checkers of proofs: ninefold's own format, and LRAT. Written to be read.

None of them uses anything of `ninefold.reasoner`, but for the calculus they are handed.
"""

from collections import deque


def first_that_fails(calculus, n, pairs, constraints, clauses):
    """Return the number of the first clause that does not follow from the constraints and those before it, or None."""
    checker = PlainChecker(calculus, n, pairs, constraints)
    for number, clause in enumerate(clauses):
        if not checker.follows(clause):
            return number
        checker.keep(clause)
    return None


class PlainChecker:
    """Labels of pairs, refined by closure and by clauses, with an undo trail."""

    def __init__(self, calculus, n, pairs, constraints):
        self.calculus = calculus
        self.near = [set() for _ in range(n)]
        self.label = {}
        self.clauses = []
        self.at = {}
        self.trail = []
        self.queue = deque()
        triples = list(constraints)
        kept = [(i, j) for i in range(n) for j in range(i)] if pairs is None else [*pairs, *((i, j) for i, j, _ in triples)]
        for i, j in kept:
            self.near[i].add(j)
            self.near[j].add(i)
            self.label[i, j] = self.label[j, i] = calculus.universal
        self.holds = all(self.refine(i, j, mask) for i, j, mask in triples) and self.propagate()

    def follows(self, clause):
        """Say whether assuming every literal false empties a label."""
        if not self.holds:
            return True
        level = len(self.trail)
        universal = self.calculus.universal
        fine = all(self.refine(i, j, universal & ~mask) for i, j, mask in clause) and self.propagate()
        self.queue.clear()
        while len(self.trail) > level:
            i, j, mask = self.trail.pop()
            self.label[i, j], self.label[j, i] = mask, self.calculus.converse_of(mask)
        return not fine

    def keep(self, clause):
        """Use a confirmed clause from here on."""
        self.clauses.append(clause)
        for i, j, _ in clause:
            self.at.setdefault((min(i, j), max(i, j)), []).append(len(self.clauses) - 1)
        self.holds = self.holds and self.unit(clause) and self.propagate()

    def refine(self, i, j, mask):
        """Intersect the label of a pair; False if nothing is left."""
        old = self.label.get((i, j))
        if old is None:
            raise KeyError((i, j))
        new = old & mask
        if new != old:
            self.trail.append((i, j, old))
            self.label[i, j], self.label[j, i] = new, self.calculus.converse_of(new)
            self.queue.append((i, j))
        return new != 0

    def propagate(self):
        compose, label = self.calculus.compose, self.label
        while self.queue:
            i, j = self.queue.popleft()
            for k in self.near[i] & self.near[j]:
                if not self.refine(i, k, compose(label[i, j], label[j, k])):
                    return False
                if not self.refine(k, j, compose(label[k, i], label[i, j])):
                    return False
            for number in self.at.get((min(i, j), max(i, j)), ()):
                if not self.unit(self.clauses[number]):
                    return False
        return True

    def unit(self, clause):
        """Refine by the only literal that can still hold; False if none can."""
        open_literal = None
        for i, j, mask in clause:
            if self.label[i, j] & mask:
                if open_literal is not None:
                    return True
                open_literal = (i, j, mask)
        return open_literal is not None and self.refine(*open_literal)


def why_lrat_is_refused(cnf, lrat):
    """Return why a proof is refused, or None if it derives the empty clause."""
    clauses = {}
    for line in cnf.splitlines():
        if line and line[0] not in "cp":
            clauses[len(clauses) + 1] = frozenset(map(int, line.split()[:-1]))
    for line in lrat.splitlines():
        words = line.split()
        if words[1] == "d":
            for word in words[2:-1]:
                del clauses[int(word)]
            continue
        number, rest = int(words[0]), [int(word) for word in words[1:]]
        at = rest.index(0)
        literals, hints = rest[:at], rest[at + 1 : -1]
        if number in clauses or rest[-1] != 0:
            return f"{line}: not of the format"
        if not _by_units(clauses, literals, [hint for hint in hints if hint > 0]) and not _by_pivot(
            clauses, literals, hints
        ):
            return f"{line}: does not follow"
        if not literals:
            return None
        clauses[number] = frozenset(literals)
    return "no empty clause"


def _by_units(clauses, literals, hints):
    false = set(literals)
    for hint in hints:
        if hint not in clauses:
            return False
        left = clauses[hint] - false
        if not left:
            return True
        if len(left) > 1:
            return False
        false.add(-next(iter(left)))
    return False


def _by_pivot(clauses, literals, hints):
    """Resolution on the first literal: only with clauses that are named and whose resolvent is a tautology."""
    if not literals:
        return False
    against = {number for number, clause in clauses.items() if -literals[0] in clause}
    named = {-hint for hint in hints}
    return against == named and all(any(-x in clauses[k] for x in literals[1:]) for k in against)
