"""`Calculus`: names, masks, laws, definition files."""

import pickle
import re
import subprocess
import sys

import numpy as np
import pytest

from ninefold.encodings import ALLEN, CALCULI, POINT, RCC5, RCC8, Calculus, calculus_named
from ninefold.encodings.gis_words import WORDS, meant_by
from ninefold.errors import BadInput, NinefoldError, TooLarge, UnknownName
from ninefold.reasoner import Network

BASES = ("DC", "EC", "PO", "TPP", "NTPP", "TPPi", "NTPPi", "EQ")


def test_bits_are_in_the_promised_order():
    assert RCC8.bases == BASES
    assert [RCC8.relation(base) for base in BASES] == [1 << k for k in range(8)]
    assert RCC8.universal == 255
    assert RCC8.identity == 128


@pytest.mark.parametrize(
    ("words", "bases"),
    [
        ("DC EC", "DC EC"),
        ("dc|ec", "DC EC"),
        ("dc, ec", "DC EC"),
        (["DC", "EC PO"], "DC EC PO"),
        (("disjoint", "meet", "overlap", "equal"), "DC EC PO EQ"),
        ("contains inside covers coveredBy", "TPP NTPP TPPi NTPPi"),
        ("COVEREDBY", "TPP"),
        ("TPPI ntppi", "TPPi NTPPi"),
        (255, " ".join(BASES)),
    ],
)
def test_relation_reads_names_aliases_and_masks(words, bases):
    mask = RCC8.relation(words)
    assert RCC8.text(mask) == bases
    assert RCC8.names(mask) == tuple(bases.split())


def test_rcc5_reads_the_names_of_gqr():
    assert RCC5.names(RCC5.relation("DC PO PP PPC =")) == RCC5.bases


def test_unknown_relation_suggests_near_ones():
    with pytest.raises(UnknownName, match=r"there is no relation named 'NTTP'; did you mean 'NTPP'") as error:
        RCC8.relation("DC NTTP")
    assert error.value.kind == "relation"
    assert "NTPP" in error.value.near


@pytest.mark.parametrize("bad", ["", "  ", [], [""], -1, 256, True, None, 3.5, [3], {"a": 1}.keys])
def test_relation_refuses(bad):
    with pytest.raises(BadInput):
        RCC8.relation(bad)


@pytest.mark.parametrize("calculus", [RCC8, RCC5, POINT, ALLEN], ids=lambda c: c.name)
def test_operations_agree_with_their_definition_over_base_relations(calculus):
    rng = np.random.default_rng(5)
    b = calculus.n_bases
    for _ in range(300):
        r, s = (int(v) for v in rng.integers(0, calculus.universal + 1, size=2))
        converse = composed = 0
        for i in range(b):
            if r >> i & 1:
                converse |= 1 << int(calculus.base_converse[i])
                for j in range(b):
                    if s >> j & 1:
                        composed |= int(calculus.base_composition[i, j])
        assert calculus.converse_of(r) == converse
        assert calculus.compose(r, s) == composed == calculus.compose(r, s)
        assert calculus.is_atomic(r) == (r.bit_count() == 1)


def test_tables_up_to_eight_bases_only():
    assert RCC8.converse_table.shape == (256,)
    assert RCC8.composition_table.shape == (256, 256)
    assert RCC8.composition_table.dtype == RCC8.converse_table.dtype == np.uint8
    assert POINT.composition_table.shape == (8, 8)
    assert ALLEN.composition_table is None
    assert ALLEN.converse_table is None
    assert ALLEN.base_composition.dtype == np.uint16


def test_tables_cannot_be_written():
    for array in (RCC8.base_converse, RCC8.base_composition, RCC8.converse_table, RCC8.composition_table):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_is_a_value():
    again = Calculus("rcc8", BASES, 128, RCC8.base_converse, RCC8.base_composition, RCC8.aliases)
    assert again == RCC8
    assert hash(again) == hash(RCC8)
    assert again is not RCC8
    assert RCC5 != RCC8
    assert RCC8 != "rcc8"
    assert pickle.loads(pickle.dumps(RCC8)) == RCC8
    assert repr(POINT) == "Calculus(name='point', bases=('<', '=', '>'), identity=2)"


@pytest.mark.parametrize("name", CALCULI)
def test_library(name):
    assert calculus_named(name).name == name
    assert calculus_named(name.upper()) is calculus_named(name)


def test_library_suggests():
    with pytest.raises(UnknownName, match="there is no calculus named 'rcc-9'; did you mean 'rcc8'"):
        calculus_named("rcc-9")


POINT_TEXT = """
# comment
identity =
calculus_size 3
< :: >
= :: =
> :: <
< : < :: ( < )
< : = :: ( < )
< : > :: ( < = > )
= : < :: ( < )
= : = :: ( = )
= : > :: ( > )
> : < :: ( < = > )
> : = :: ( > )
> : > :: ( > )
"""


def test_from_text():
    calculus = Calculus.from_text(POINT_TEXT, name="point")
    assert calculus.bases == ("<", "=", ">")
    assert np.array_equal(calculus.composition_table, POINT.composition_table)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("> :: <", "> :: >", "converse is no involution: <~ is >, whose converse is >"),
        ("= : < :: ( < )", "= : < :: ( < = )", r"identity;< is {< =}, not {<}"),
        ("> : = :: ( > )", "> : = :: ( )", r">;identity is {}, not {>}"),
        ("< : < :: ( < )", "< : < :: ( < > )", r"(a;b)~ = b~;a~ fails at (a, b, c) = (<, <, >): > is in <;<"),
        (
            "< : > :: ( < = > )",
            "< : > :: ( < = )",
            "(a;b)~ = b~;a~ fails at (a, b, c) = (<, >, <): < is in <;> but its converse is not in b~;a~",
        ),
        (
            "< : > :: ( < = > )\n",
            "< : > :: ( = )\n",
            "base relations cannot be disjoint and exhaustive at (a, b, c) = (<, <, <): < is in <;< but b is not in",
        ),
        ("< : > :: ( < = > )", "", "the composition <;> is missing"),
        ("< :: >", "", "there are 2 base relations"),
        ("identity =", "", "no identity"),
        ("identity =", "identity ==", "line 3: there is no base relation named '=='; did you mean '='"),
        ("= : > :: ( > )", "= : > :: ( >> )", "line 13: there is no base relation named '>>'"),
        ("= : > :: ( > )", "= : > :: >", "line 13: an entry of the composition table is 'a : b :: ( c d )'"),
        ("= : > :: ( > )", "= > ( > )", "line 13: '= > ( > )' is neither a setting"),
        ("= : > :: ( > )", "= : > :: ( > )\n= : > :: ( > )", "line 14: =;> was already given at point, line 13"),
        ("> :: <", "> :: <\n> :: <", "line 8: the converse of > was already given at point, line 7"),
        ("> :: <", "> :: < =", "line 7: a converse is 'a :: b' with one relation on each side"),
        ("identity =", "identity =\nidentity =", "identity was already given at point, line 3"),
        ("calculus_size 3", "calculus_size", "line 4: calculus_size has no value"),
        ("calculus_size 3", "calculus_size 4", "calculus_size is 4, but there are 3 base relations: < = >"),
        ("calculus_size 3", "alias before", "alias takes a word and a base relation"),
        ("calculus_size 3", "alias before <<", "alias before: there is no base relation named '<<'"),
        ("calculus_size 3", "converse_file point.conv", "use Calculus.from_file"),
        ("calculus_size 3", "base_relations < = > =", "base relation '=' is named twice"),
    ],
)
def test_bad_definitions_name_the_fault(old, new, message):
    assert POINT_TEXT.count(old) >= 1
    text = POINT_TEXT.replace(old, new, 1)
    if new == "< : > :: ( = )\n":  # keep the converse law, so that the last law is the one to fail
        text = text.replace("> : < :: ( < = > )", "> : < :: ( = )")
    with pytest.raises(NinefoldError, match=re.escape(message)):
        Calculus.from_text(text, name="point")


def test_every_dropped_or_added_base_in_a_table_is_found():
    """The laws notice any single change of the RCC-8 table but those at a triple that is its own mirror and turn."""
    missed = set()
    for i, j, k in np.ndindex(8, 8, 8):
        table = RCC8.base_composition.copy()
        table[i, j] ^= 1 << k
        try:
            Calculus("rcc8", BASES, 128, RCC8.base_converse, table)
        except BadInput:
            continue
        missed.add((BASES[i], BASES[j], BASES[k]))
    assert missed == {(a, a, a) for a in ("DC", "EC", "PO")}


def test_shapes_and_bits_are_checked():
    with pytest.raises(BadInput, match=r"converse table is \(8,\)"):
        Calculus("x", BASES, 128, RCC8.base_converse[:7], RCC8.base_composition)
    with pytest.raises(BadInput, match="no non-empty set"):
        Calculus("x", BASES, 0, RCC8.base_converse, RCC8.base_composition)
    table = POINT.base_composition.copy()
    table[0, 0] |= 8
    with pytest.raises(BadInput, match="<;< holds a bit that is no base relation"):
        Calculus("x", POINT.bases, 2, POINT.base_converse, table)
    with pytest.raises(BadInput, match="the converse of > is no base relation"):
        Calculus("x", POINT.bases, 2, np.array([2, 1, 3]), POINT.base_composition)
    with pytest.raises(BadInput, match="the identity holds < but not its converse >"):
        Calculus("x", POINT.bases, 1, POINT.base_converse, POINT.base_composition)
    with pytest.raises(BadInput, match="has no base relation"):
        Calculus("x", (), 1, np.zeros(0), np.zeros((0, 0)))
    with pytest.raises(BadInput, match="cannot be a name"):
        Calculus("x", ("<", "= ", ">"), 2, POINT.base_converse, POINT.base_composition)
    with pytest.raises(TooLarge, match="70 base relations"):
        Calculus("x", tuple(map(str, range(70))), 1, np.zeros(70), np.zeros((70, 70)))
    names = [f"r{k}" for k in range(70)]
    text = "identity r0\n" + "".join(f"{a} :: {a}\n" for a in names)
    text += "".join(f"{a} : {b} :: ( r69 )\n" for a in names for b in names)
    with pytest.raises(TooLarge, match="70 base relations"):
        Calculus.from_text(text)
    with pytest.raises(UnknownName, match="'<<'"):
        Calculus("x", POINT.bases, 2, POINT.base_converse, POINT.base_composition, (("before", "<<"),))


def test_several_identities_and_empty_compositions():
    """Two sorts in one calculus: equality is a union, and relations of different sorts compose to nothing."""
    text = "identity P R\n" + "".join(
        f"{a} :: {a}\n" + "".join(f"{a} : {b} :: ( {a if a == b else ''} )\n" for b in "PR") for a in "PR"
    )
    calculus = Calculus.from_text(text)
    assert calculus.identity == 3
    assert calculus.compose(1, 2) == 0


def test_names_that_differ_only_in_case():
    text = "identity e\ne :: e\nb :: B\nB :: b\n" + "".join(
        f"{a} : {b} :: ( {result} )\n"
        for a, row in {"e": ["e", "b", "B"], "b": ["b", "b", "e b B"], "B": ["B", "e b B", "B"]}.items()
        for b, result in zip("ebB", row, strict=True)
    )
    calculus = Calculus.from_text(text)
    assert calculus.relation("b") == 2
    assert calculus.relation("B") == 4
    assert calculus.relation("E") == 1


def test_a_bar_may_be_a_name():
    text = "identity =\n= :: =\n| :: |\n= : = :: ( = )\n= : | :: ( | )\n| : = :: ( | )\n| : | :: ( = | )\n"
    calculus = Calculus.from_text(text)
    assert calculus.relation("= |") == 3
    assert calculus.relation("|") == 2
    assert calculus.relation(calculus.text(3)) == 3


def test_from_file_follows_gqr_references(tmp_path):
    lines = POINT_TEXT.splitlines()
    tables = tmp_path / "point" / "calculus"
    tables.mkdir(parents=True)
    (tables / "p.conv").write_text("\n".join(x for x in lines if "::" in x and x.count(":") == 2))
    (tables / "p.comp").write_text("\n".join(x for x in lines if x.count(":") == 3))
    (tables / "p.weights").write_text("< 1\n")
    spec = tmp_path / "point.spec"
    spec.write_text(
        "# Point\ncomp_table_file point/calculus/p.comp\nconverse_file point/calculus/p.conv\n"
        "weights point/calculus/p.weights\nidentity =\ncalculus_size 3\n"
    )
    calculus = Calculus.from_file(spec)
    assert calculus.name == "point"
    assert np.array_equal(calculus.composition_table, POINT.composition_table)
    (tables / "p.comp").unlink()
    with pytest.raises(BadInput, match=r"point.spec, line 2: cannot read .*p.comp"):
        Calculus.from_file(str(spec))


def test_from_file_that_cannot_be_read(tmp_path):
    with pytest.raises(BadInput, match=r"cannot read .*nothing.spec: No such file"):
        Calculus.from_file(tmp_path / "nothing.spec")
    with pytest.raises(BadInput, match="cannot read"):
        Calculus.from_file(tmp_path)
    with pytest.raises(BadInput, match="cannot read"):
        Calculus.from_file("a\0b")
    binary = tmp_path / "binary.spec"
    binary.write_bytes(b"identity \xff\n")
    with pytest.raises(BadInput, match="not UTF-8 text: byte 9 is 0xff"):
        Calculus.from_file(binary)


def test_importing_the_package_imports_none_of_its_modules():
    code = "import sys, ninefold.encodings; print([m for m in sys.modules if m.startswith(('pysat', 'ninefold.enc'))])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "['ninefold.encodings']"


def test_unknown_attribute_of_the_package():
    import ninefold.encodings

    with pytest.raises(AttributeError, match="has no attribute 'RCC9'"):
        _ = ninefold.encodings.RCC9
    assert "RCC8" in dir(ninefold.encodings)


def test_sixty_four_base_relations():
    """Differences modulo 64: the widest word a relation can be."""
    b = 64
    k = np.arange(b)
    table = np.uint64(1) << ((k[:, None] + k) % b).astype(np.uint64)
    calculus = Calculus("clock", tuple(f"+{x}" for x in k), 1, -k % b, table)
    assert calculus.universal == 2**64 - 1
    assert calculus.names(calculus.compose(calculus.relation("+60 +1"), calculus.relation("+5"))) == ("+1", "+6")
    assert calculus.names(calculus.converse_of(calculus.relation("+1 +63 +0"))) == ("+0", "+1", "+63")


class TestWordsOfGeographicSoftware:
    @pytest.mark.parametrize(
        ("word", "meant"),
        [
            ("touches", "meet"),
            ("ST_Touches", "meet"),
            ("geo:sfWithin", "coveredBy inside equal"),
            ("within", "coveredBy inside equal"),
            ("crosses", "overlap"),
            ("intersects", "meet overlap coveredBy inside covers contains equal"),
            ("Contains_Properly", "contains"),
        ],
    )
    def test_they_are_answered_with_what_they_mean(self, word, meant):
        with pytest.raises(UnknownName, match=re.escape(f"'{word}'; did you mean '{meant}'?")) as caught:
            Network("rcc8").add("a", "b", f"disjoint {word}")
        assert caught.value.near == (meant,)
        RCC8.relation(meant)  # can be pasted

    def test_every_answer_can_be_read(self):
        for calculus in (RCC8, RCC5):
            for word, meant in WORDS[calculus.name].items():
                assert calculus.relation(meant)
                assert meant_by(word.upper(), calculus) == meant

    def test_intersects_is_all_but_disjoint(self):
        assert RCC8.relation(meant_by("intersects", RCC8)) == RCC8.universal & ~RCC8.relation("disjoint")
        assert RCC5.relation(meant_by("intersects", RCC5)) == RCC5.universal & ~RCC5.relation("DR")

    def test_other_calculi_know_nothing_of_them(self):
        assert meant_by("touches", POINT) is None
        with pytest.raises(UnknownName, match=r"no relation named 'touches'$"):
            POINT.relation("touches")
