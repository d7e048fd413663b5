r"""Boolean formulas over relation atoms: their grammar, their form in ``sympy.logic``, and their clauses.

===========================================  ===========================================================================
``inside(kitchen, house)``                   an atom: a relation of the calculus, in any of its words, and two entities
``inside|coveredBy(kitchen, house)``         several relations, as in a statement
``"<"(breakfast, 'the walk')``               names that are no plain words stand in quotes, with ``\`` before a quote
``~  not``, ``&  and``, ``|  or``            binding from tight to loose
``->  >>  implies``, ``<->  ==  iff``        looser still, grouping to the right
``true``, ``false``, ``( )``
===========================================  ===========================================================================

Nothing is ever evaluated as Python.

Examples
--------
>>> from ninefold.reasoner.networks.formula import parse
>>> from ninefold.reasoner.networks.network import Network
>>> net = Network("rcc8")
>>> _ = net.add("kitchen", "house", "inside")
>>> parse("inside|coveredBy(kitchen, house) -> ~meet(house, kitchen)", net).expression
Implies(TPP|NTPP(kitchen, house), ~EC(kitchen, house))

References
----------
G. S. Tseitin, "On the complexity of derivation in propositional calculus", 1968 (`Formula.clauses`).
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from ninefold._wording import quoted
from ninefold.errors import BadInput

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from .network import Network

__all__ = ["Atom", "Formula", "parse"]

_LONGEST = 100_000
_DEEPEST = 60
_TOKEN = re.compile(
    r"""\s*(?:(?P<quoted>"(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*')|(?P<mark><->|->|>>|==|&&|\|\||[()&|~!,])|(?P<word>[\w.]+))""",
    re.DOTALL,
)
_NAMES_OF_MARKS = {
    "&&": "&", "and": "&", "||": "|", "or": "|", "!": "~", "not": "~", ">>": "->", "implies": "->", "==": "<->", "iff": "<->"
}  # fmt: skip


@dataclass(frozen=True, slots=True, order=True)
class Atom:
    """Entity `i` is related to entity `j` by `mask`; i < j, and the mask is neither empty nor universal."""

    i: int
    j: int
    mask: int


@dataclass(frozen=True, slots=True)
class Formula:
    """A formula about the entities of a network.

    Attributes
    ----------
    text
        What was parsed.
    expression
        The sympy expression.
    atoms
        Symbol name to atom.
    """

    text: str
    expression: Any
    atoms: Mapping[str, Atom] = field(repr=False)

    def clauses(self, *, negated: bool = False) -> tuple[list[list[int]], dict[Atom, int], int]:
        """Return clauses that hold exactly if the formula does, or its negation; variables by atom; their number.

        Complexity
        ----------
        Linear in the formula: one further variable for each connective.
        """
        variables = {atom: k for k, atom in enumerate(sorted(set(self.atoms.values())), start=1)}
        writer = _Clauses({name: variables[atom] for name, atom in self.atoms.items()}, len(variables))
        root = writer.literal(self.expression)
        writer.clauses.append([-root if negated else root])
        return writer.clauses, variables, writer.n_vars

    def holds(self, relation: Callable[[int, int], int]) -> bool:
        """Tell whether the formula holds where ``relation(i, j)`` is the base mask of the pair."""
        values = {name: bool(relation(a.i, a.j) & a.mask) for name, a in self.atoms.items()}
        return bool(self.expression.subs(values)) if values else bool(self.expression)


class _Clauses:
    """Tseitin's transformation of a sympy expression."""

    def __init__(self, variables: Mapping[str, int], n_vars: int) -> None:
        self._variables = variables
        self.n_vars = n_vars
        self.clauses: list[list[int]] = []

    def literal(self, expression: Any) -> int:
        """Return a literal that holds exactly if the expression does. As deep as the formula, at most `_DEEPEST`."""
        from sympy.logic.boolalg import And, Equivalent, Implies, Not, Or

        if expression.is_Symbol:
            return self._variables[expression.name]
        if isinstance(expression, Not):
            return -self.literal(expression.args[0])
        if isinstance(expression, Implies):
            left, right = (self.literal(x) for x in expression.args)
            return self._any([-left, right])
        if isinstance(expression, Equivalent):
            literals = [self.literal(x) for x in expression.args]
            # all true or all false
            return self._any([self._all(literals), self._all([-x for x in literals])])
        if isinstance(expression, And):
            return self._all([self.literal(x) for x in expression.args])
        if isinstance(expression, Or):
            return self._any([self.literal(x) for x in expression.args])
        return self._all([]) if expression == True else -self._all([])  # noqa: E712 - sympy's true

    def _all(self, literals: list[int]) -> int:
        return -self._any([-x for x in literals])

    def _any(self, literals: list[int]) -> int:
        self.n_vars += 1
        new = self.n_vars
        self.clauses.append([-new, *literals])
        self.clauses.extend([new, -x] for x in literals)
        return new


def parse(text: str, net: Network) -> Formula:
    """Parse a formula about a network; see the module's text for the grammar.

    Raises
    ------
    BadInput
        The text is no formula: what was found where, counted in characters from 1.
    UnknownName
        A relation the calculus does not have, or an entity no statement speaks of.
    """
    if not isinstance(text, str):
        raise BadInput(f"a formula is a string, not {quoted(text)}")
    if len(text) > _LONGEST:
        raise BadInput(f"a formula has at most {_LONGEST:,} characters; this one has {len(text):,}")
    return _Parser(text, net).formula()


class _Parser:
    def __init__(self, text: str, net: Network) -> None:
        self._text = text
        self._net = net
        self._tokens = list(_tokens(text))
        self._at = 0
        self._depth = 0
        self._atoms: dict[str, Atom] = {}

    def formula(self) -> Formula:
        expression = self._equivalence()
        if self._kind() != "end":
            raise self._unexpected("the end of the formula or a connective")
        return Formula(self._text, expression, self._atoms)

    def _equivalence(self) -> Any:
        from sympy.logic.boolalg import Equivalent, Implies

        return self._rightmost("<->", lambda: self._rightmost("->", self._disjunction, Implies), Equivalent)

    def _rightmost(self, mark: str, operand: Callable[[], Any], join: Any) -> Any:
        """Parse ``x mark y mark z`` as ``x mark (y mark z)``."""
        parts = [operand()]
        while self._take(mark):
            parts.append(operand())
            if len(parts) > _DEEPEST:
                raise BadInput(f"a formula chains at most {_DEEPEST} {mark}; use parentheses or several questions")
        result = parts.pop()
        while parts:
            result = join(parts.pop(), result)
        return result

    def _disjunction(self) -> Any:
        from sympy.logic.boolalg import Or

        return self._joined("|", self._conjunction, Or)

    def _conjunction(self) -> Any:
        from sympy.logic.boolalg import And

        return self._joined("&", self._negation, And)

    def _joined(self, mark: str, operand: Callable[[], Any], join: Any) -> Any:
        parts = [operand()]
        while self._take(mark):
            parts.append(operand())
        return parts[0] if len(parts) == 1 else join(*parts)

    def _negation(self) -> Any:
        from sympy.logic.boolalg import Not

        odd = False
        while self._take("~"):
            odd = not odd
        found = self._primary()
        return Not(found) if odd else found

    def _primary(self) -> Any:
        from sympy import false, true

        kind, value = self._kind(), self._value()
        if kind == "word" and value.casefold() in ("true", "false") and self._kind(1) != "(":
            self._at += 1
            return true if value.casefold() == "true" else false
        if kind in ("word", "quoted"):
            return self._atom()
        if kind == "(":
            self._depth += 1
            if self._depth > _DEEPEST:
                raise BadInput(f"a formula nests at most {_DEEPEST} parentheses")
            self._at += 1
            inside = self._equivalence()
            self._need(")")
            self._depth -= 1
            return inside
        raise self._unexpected("an atom such as inside(kitchen, house)")

    def _atom(self) -> Any:
        from sympy import Symbol, false, true

        words = [self._name("a relation")]
        while self._take("|"):
            words.append(self._name("a relation"))
        self._need("(")
        a = self._name("an entity")
        self._need(",")
        b = self._name("an entity")
        self._need(")")
        net, calculus = self._net, self._net.calculus
        mask = calculus.relation(words)
        i, j = net.index(a), net.index(b)
        if mask == calculus.universal:
            return true
        if i == j:
            return true if mask & calculus.identity else false
        if i > j:
            i, j, mask = j, i, calculus.converse_of(mask)
        name = f"{'|'.join(calculus.names(mask))}({net.entities[i]}, {net.entities[j]})"
        self._atoms[name] = Atom(i, j, mask)
        return Symbol(name)

    def _name(self, what: str) -> str:
        if self._kind() not in ("word", "quoted"):
            raise self._unexpected(what)
        self._at += 1
        return self._tokens[self._at - 1][1]

    def _kind(self, ahead: int = 0) -> str:
        at = min(self._at + ahead, len(self._tokens) - 1)
        return self._tokens[at][0]

    def _value(self) -> str:
        return self._tokens[self._at][1]

    def _take(self, mark: str) -> bool:
        """Step over a connective; a keyword counts as one only here, so that an entity may be called ``or``."""
        kind, value, _ = self._tokens[self._at]
        said = value.casefold() if kind == "word" else kind
        if _NAMES_OF_MARKS.get(said, said if kind != "word" else "") != mark:
            return False
        self._at += 1
        return True

    def _need(self, mark: str) -> None:
        if not self._take(mark):
            raise self._unexpected(f"{quoted(mark)}")

    def _unexpected(self, wanted: str) -> BadInput:
        kind, value, place = self._tokens[self._at]
        found = "the formula ends" if kind == "end" else f"{quoted(value)} stands"
        return BadInput(f"formula {quoted(self._text)}, character {place + 1}: {wanted} is expected where {found}")


def _tokens(text: str) -> list[tuple[str, str, int]]:
    """Return (kind, value, place) of every token; the kind of a mark is the mark, and the last token is ``end``."""
    found, at = [], 0
    while text[at:].strip():
        match = _TOKEN.match(text, at)
        if match is None:
            place = at + len(text[at:]) - len(text[at:].lstrip())
            hint = "; this quote is not closed" if text[place] in "\"'" else "; put names that are no plain words in quotes"
            raise BadInput(f"formula {quoted(text)}, character {place + 1}: {quoted(text[place])} cannot stand here{hint}")
        kind = match.lastgroup or ""
        value, place = match[kind], match.start(kind)
        if kind == "quoted":
            value = re.sub(r"\\(.)", r"\1", value[1:-1], flags=re.DOTALL)
        found.append((value if kind == "mark" else kind, value, place))
        at = match.end()
    return [*found, ("end", "", len(text))]
