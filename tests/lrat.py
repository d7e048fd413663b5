"""A plain checker of LRAT proofs, for tests: every line is confirmed by its hints alone, with no search."""


def refusal(cnf: str, lrat: str) -> str | None:
    """Return why a proof is refused, or None if it derives the empty clause."""
    clauses: dict[int, frozenset[int]] = {}
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


def _by_units(clauses: dict[int, frozenset[int]], literals: list[int], hints: list[int]) -> bool:
    false = set(literals)
    for hint in hints:
        left = clauses[hint] - false
        if not left:
            return True
        if len(left) > 1:
            return False
        false.add(-next(iter(left)))
    return False


def _by_pivot(clauses: dict[int, frozenset[int]], literals: list[int], hints: list[int]) -> bool:
    """Resolution on the first literal: only with clauses that are named and whose resolvent is a tautology."""
    if not literals:
        return False
    against = {number for number, clause in clauses.items() if -literals[0] in clause}
    named = {-hint for hint in hints}
    return against == named and all(any(-x in clauses[k] for x in literals[1:]) for k in against)
