"""The grammar of formulas: what is accepted means what it should, and everything else is a NinefoldError."""

import itertools

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ninefold.encodings import ALLEN, RCC8, open_solver
from ninefold.errors import BadInput, NinefoldError, UnknownName
from ninefold.reasoner.networks.formula import parse
from ninefold.reasoner.networks.network import Network


def network():
    net = Network("rcc8")
    net.add("kitchen", "house", "inside")
    net.add("house", "block 12", "meet")
    net.add("or", "it's", "disjoint")
    net.add("0", "house", "inside")
    return net


NET = network()
TOKENS = ["inside", "|", "coveredBy", "(", ")", ",", "kitchen", "house", "&", "~", "->", "<->", "or", "and", "'block 12'"]
TOKENS += ['"it\'s"', "true", "not", " ", ">>", "==", "0", "EC", "inside(kitchen, house)", "!", "\\", "'", "iff", "é", "\n"]


@given(st.lists(st.sampled_from(TOKENS), max_size=25).map(" ".join) | st.text(max_size=60))
@settings(max_examples=600, deadline=None)
def test_only_our_errors_escape(text):
    try:
        formula = parse(text, NET)
    except NinefoldError:
        return
    formula.clauses()


@pytest.mark.parametrize(
    "text",
    [
        "(" * 5000,
        "~" * 5000,
        "(" * 300 + "true" + ")" * 300,
        "true -> " * 500 + "true",
        "inside(kitchen, house",
        "inside(kitchen house)",
        "inside",
        "",
        "inside(kitchen, house) inside(kitchen, house)",
        "inside(kitchen, house) &",
        "'inside(kitchen, house)",
        "__import__('os').system('true')",
        "a" * 200_000,
        "inside[kitchen, house]",
        None,
        7,
    ],
)
def test_what_is_no_formula(text):
    with pytest.raises(NinefoldError):
        parse(text, NET)


def test_long_flat_formulas_are_fine():
    text = " & ".join(["inside(kitchen, house)", "~meet(kitchen, 'block 12')"] * 400)
    assert len(parse(text, NET).atoms) == 2
    assert parse("~" * 1001 + "inside(kitchen, house)", NET).expression == parse("~inside(kitchen, house)", NET).expression


@pytest.mark.parametrize(
    ("text", "same"),
    [
        ("inside(kitchen, house)", "contains(house, kitchen)"),
        ("NTPP(kitchen, house)", "INSIDE('kitchen', \"house\")"),
        ("inside|coveredBy(kitchen, house)", "inside | coveredBy (kitchen, house)"),
        ("not inside(kitchen, house)", "!inside(kitchen, house)"),
        ("inside(kitchen, house) and meet(house, 'block 12')", "inside(kitchen, house) && meet(house, 'block 12')"),
        ("inside(kitchen, house) or meet(0, or)", "inside(kitchen, house) || meet(0, or)"),
        ("inside(0, house) implies meet(house, 'it\\'s')", 'inside(0, house) >> meet(house, "it\'s")'),
        ("inside(0, house) iff meet(house, 0)", "inside(0, house) <-> meet(house, 0)"),
        ("~inside(0, house) & meet(0, or) | meet(or, 0)", "((~inside(0, house)) & meet(0, or)) | meet(or, 0)"),
        ("meet(0, or) -> inside(0, or) -> meet(or, house)", "meet(0, or) -> (inside(0, or) -> meet(or, house))"),
        ("equal(0, 0)", "true"),
        ("inside(0, 0)", "false"),
        ("DC|EC|PO|TPP|NTPP|TPPi|NTPPi|EQ(0, or)", "true"),
    ],
)
def test_spellings(text, same):
    assert parse(text, NET).expression == parse(same, NET).expression


def test_errors_say_where_and_what():
    with pytest.raises(BadInput, match=r"character 16: ',' is expected where 'house' stands"):
        parse("inside(kitchen house)", NET)
    with pytest.raises(BadInput, match="formula ends"):
        parse("inside(kitchen, house) &", NET)
    with pytest.raises(BadInput, match="quote is not closed"):
        parse("inside(kitchen, 'house)", NET)
    with pytest.raises(UnknownName, match="did you mean 'kitchen'"):
        parse("inside(kitchn, house)", NET)
    with pytest.raises(UnknownName, match="did you mean 'inside'"):
        parse("insied(kitchen, house)", NET)


def test_relations_that_are_no_words():
    net = Network(ALLEN)
    net.add("breakfast", "the walk", "<")
    formula = parse("'<'(breakfast, 'the walk')", net)
    (atom,) = formula.atoms.values()
    assert ALLEN.text(atom.mask) == "<"


ATOMS = [
    f"{r}({a}, {b})" for r in ("inside", "meet", "EC|DC") for a, b in itertools.permutations(["kitchen", "house", "0"], 2)
]
formulas = st.recursive(
    st.sampled_from([*ATOMS, "true", "false"]),
    lambda inner: st.one_of(
        inner.map("~({})".format),
        st.tuples(inner, st.sampled_from(["&", "|", "->", "<->"]), inner).map(lambda t: f"({t[0]}) {t[1]} ({t[2]})"),
    ),
    max_leaves=8,
)


@given(formulas, st.lists(st.integers(0, 7), min_size=6, max_size=6))
@settings(max_examples=150, deadline=None)
def test_clauses_hold_exactly_when_the_formula_does(text, chosen):
    """For any base relations on the pairs, possible together or not."""
    formula = parse(text, NET)
    pairs = sorted({(a.i, a.j) for a in formula.atoms.values()})
    bases = {pair: 1 << base for pair, base in zip(pairs, chosen, strict=False)}
    value = formula.holds(lambda i, j: bases[i, j])
    for negated in (False, True):
        clauses, variables, _ = formula.clauses(negated=negated)
        units = [[v if bases[a.i, a.j] & a.mask else -v] for a, v in variables.items()]
        with open_solver(clauses=[*clauses, *units]) as solver:
            assert solver.solve() == (value != negated)


def test_clauses_grow_linearly():
    sizes = []
    for length in (20, 40):
        text = " <-> ".join(f"({a})" for a in (ATOMS * 3)[:length])
        sizes.append(len(parse(text, NET).clauses()[0]))
    assert sizes[1] < 3 * sizes[0]
    assert RCC8.n_bases == 8
