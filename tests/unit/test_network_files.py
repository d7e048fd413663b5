"""Relation networks in csp, CSV and JSON: what is read, what is refused and where, what is written."""

import json
import math
import re

import pytest

from ninefold.encodings import ALLEN, POINT, RCC8, Calculus
from ninefold.errors import BadInput, NinefoldError, TooLarge, UnknownName
from ninefold.io.networks.network_file import (
    NETWORK_FORMATS,
    load_network,
    network_from_text,
    network_to_text,
    read_network,
    read_networks,
    write_network,
)
from ninefold.reasoner.networks.network import Network

CSP = """\
3 #three and one

0 1 ( NTPP TPP )
# a comment
 1  3 (DC)
3 0 ( TPPI NTPPI EQ )
2 2 ( EQ )
.
"""
CSV = "a,relations,b,weight,label\nkitchen,inside,house,2,plan\nhouse,EC|DC,garden,,\nhouse,PO TPP,garden,inf,\n"


def full():
    net = Network("rcc8")
    net.add_entity("Küche")
    net.add("kitchen", "house", "inside", weight=2, label='the "plan", page 3')
    net.add("house", "garden|pond", "EC DC", weight=math.inf)
    net.add("garden|pond", "kitchen", RCC8.universal, weight=0.1)
    net.add("house", "house", "EQ")
    return net


def test_csp():
    net = network_from_text(CSP, "csp")
    assert net.entities == ("0", "1", "2", "3")
    assert [(s.a, s.b, RCC8.text(s.mask)) for s in net.statements] == [
        ("0", "1", "TPP NTPP"),
        ("1", "3", "DC"),
        ("3", "0", "TPPi NTPPi EQ"),
        ("2", "2", "EQ"),
    ]


def test_csv():
    net = network_from_text(CSV, "csv")
    assert net.entities == ("kitchen", "house", "garden")
    assert [(RCC8.text(s.mask), s.weight, s.label) for s in net.statements] == [
        ("NTPP", 2.0, "plan"),
        ("DC EC", None, None),
        ("PO TPP", math.inf, None),
    ]


@pytest.mark.parametrize(
    "text",
    [
        "B,Relations,A\nhouse,inside,kitchen\n",
        "a;relations;b\r\nkitchen;inside;house\r\n\r\n",
        "\na\tb\trelations\nkitchen \t house\t inside",
        '"a","relations","b","label"\n"kitchen","inside","house",""\n',
    ],
)
def test_csv_variants(text):
    net = network_from_text(text, "csv")
    assert {net.statements[0].a, net.statements[0].b} == {"kitchen", "house"}
    assert (net.n_statements, net.statements[0].label) == (1, None)


def test_json():
    text = json.dumps(
        {
            "calculus": "allen",
            "statements": [
                {"a": "x", "relations": ["before", "m"], "b": 3, "weight": "inf", "label": None},
                {"b": "y", "relations": "d|f", "a": "x", "weight": None},
            ],
        }
    )
    net = network_from_text(text, "json")
    assert net.calculus == ALLEN
    assert net.entities == ("x", "3", "y")
    assert [ALLEN.text(s.mask) for s in net.statements] == ["< m", "d f"]
    assert net.statements[0].hard


@pytest.mark.parametrize("kind", NETWORK_FORMATS)
def test_writers_round_trip(kind, tmp_path):
    net = full()
    path = tmp_path / f"net.{kind}"
    write_network(net, path)
    again = read_network(path)
    if kind == "csv":  # its entities come in the order of the rows, and a silent one needs a row
        assert set(again.entities) == set(net.entities)
        assert [s for s in again.statements if s.a != "Küche"] == list(net.statements)
        assert again.statements[-1].mask == RCC8.identity
    else:
        assert again == net
    assert network_to_text(again, kind) == path.read_text(encoding="utf-8")


@pytest.mark.parametrize("calculus", [POINT, ALLEN], ids=lambda c: c.name)
@pytest.mark.parametrize("kind", NETWORK_FORMATS)
def test_other_calculi_round_trip(calculus, kind):
    net = Network(calculus)
    for mask in range(1, calculus.universal, 13):
        net.add(mask, "x", mask)
    again = network_from_text(network_to_text(net, kind), kind, calculus=calculus if kind == "csv" else None)
    assert [s.mask for s in again.statements] == [s.mask for s in net.statements]
    assert again.calculus == calculus


def test_plain_csp_has_no_marked_comments():
    net = network_from_text("2 #x\n0 1 ( DC )\n2 1 ( EC )\n.\n", "csp")
    assert network_to_text(net, "csp") == "2 #rcc8\n0 1 ( DC )\n2 1 ( EC )\n.\n"


def test_a_calculus_of_your_own(tmp_path):
    spec = tmp_path / "order.spec"
    spec.write_text(
        "base_relations b e a\nidentity e\nb :: a\na :: b\ne :: e\nb : b :: ( b )\nb : e :: ( b )\nb : a :: ( b e a )\n"
        "e : b :: ( b )\ne : e :: ( e )\ne : a :: ( a )\na : b :: ( b e a )\na : e :: ( a )\na : a :: ( a )\n"
    )
    own = Calculus.from_file(spec)
    net = Network(own)
    net.add("x", "y", "b")
    for kind in ("csp", "json"):
        text = network_to_text(net, kind)
        assert network_from_text(text, kind, calculus=str(spec)) == net
        with pytest.raises(BadInput, match="there is no calculus named 'order'; for a calculus of your own"):
            network_from_text(text, kind)
        with pytest.raises(BadInput, match="the file is in 'order', but 'point' was asked for"):
            network_from_text(text, kind, calculus="point")


@pytest.mark.parametrize(
    ("name", "text", "kind"),
    [
        ("a.csp", CSP, "csp"),
        ("a.CSV", CSV, "csv"),
        ("a.txt", CSP, "csp"),
        ("a.txt", CSV, "csv"),
        ("a", ' \n{"statements": []}', "json"),
        ("a.dat", "\ufeff" + CSV, "csv"),
    ],
)
def test_format_is_recognised(tmp_path, name, text, kind):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    assert load_network(path).kind == kind
    assert load_network(str(path), kind=kind).network == read_network(path)


def test_count_in_the_first_line_is_noticed_in_well_filled_files():
    pairs = [(i, j) for i in range(6) for j in range(i)]
    filled = "6 #csp\n" + "".join(f"{i} {j} ( PO )\n" for i, j in pairs) + ".\n"
    assert len(network_from_text(filled, "csp").entities) == 6
    assert load_file("6", filled).notes == ("net.csp: the first number 6 is read as the number of entities, as 6 is unused",)
    gqr = "5" + filled[1:]
    assert network_from_text(gqr, "csp") == network_from_text(filled, "csp")
    assert load_file("5", gqr).notes == ()


def load_file(_, text):
    from ninefold.io.networks.network_file import _parse

    return _parse(text, "csp", None, "net.csp")


def test_unused_highest_index_of_a_sparse_file_is_an_entity():
    read = load_file("2", "2\n0 1 ( DC )\n.\n")
    assert read.network.entities == ("0", "1", "2")
    (note,) = read.notes
    assert "the first number 2 is read as the highest index, so entity 2 is there without a statement" in note
    assert note.endswith("if it is the number of entities, write 1")
    assert load_file("9", "9\n0 1 ( DC )\n.\n").notes == ()
    assert load_file("0", "0\n.").network.entities == ("0",)


def test_missing_end_is_noted():
    assert load_file("1", "1\n0 1 ( DC )\n").notes == ("net.csp has no final '.': it may have been cut off",)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "text: empty; a csp file starts with its highest index"),
        ("# only a comment\n", "text: empty"),
        ("x\n", "text, line 1: a csp file starts with its highest index, not 'x'"),
        ("1\n0 1 DC\n.", "text, line 2: a statement is 'i j ( R1 R2 )', not '0 1 DC'"),
        ("1\n0 1 ( DC ) x\n.", "text, line 2: a statement is"),
        ("1\n0 -1 ( DC )\n.", "text, line 2: a statement is"),
        ("1\n\n0 2 ( DC )\n.", "text, line 3: index 2 is above 1"),
        ("1\n0 1 ( )\n.", "text, line 2: the relation set ' ' is empty"),
        ("1\n0 1 ( DC NTTP )\n.", "text, line 2: there is no relation named 'NTTP'; did you mean 'NTPP'"),
        ("1\n0 1 ( < )\n.", "(the calculus is rcc8; point and allen know it: name the calculus)"),
        ("1\n0 0 ( DC )\n.", "text, line 2: '0' cannot be DC of itself"),
        (
            "1\n0 1 ( DC )\n.\n\n1\n0 1 ( EC )\n.",
            "text, line 4: another network starts here, there are 2; split the file or read it with read_networks",
        ),
        ("1\n#@ {\n.", "text, line 2: a comment that starts with #@ holds JSON"),
        ("1\n#@ []\n.", "text, line 2: a comment that starts with #@ holds a JSON object"),
        ('1\n#@ {"entities": 3}\n.', "text, line 2: 'entities' is a list"),
        ('1\n#@ {"entities": ["a"]}\n.', "text: 1 names for 2 entities"),
        ('1\n#@ {"entities": ["a", "a"]}\n.', "text: the names of the entities are not all different"),
        ('1\n#@ {"calculus": "rcc9"}\n.', "text: there is no calculus named 'rcc9'; did you mean 'rcc8'"),
        ('1\n0 1 ( DC ) #@ {"weight": "x"}\n.', "text, line 2: a weight is a number or None"),
    ],
)
def test_bad_csp(text, message):
    with pytest.raises(BadInput, match=re.escape(message)):
        network_from_text(text, "csp")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "text: empty; the first line is a,relations,b,weight,label"),
        ("a,b\n", "line 1: column 'relations' is missing"),
        ("a,relations,b,weighs\n", "line 1: there is no column named 'weighs'; did you mean 'weight'"),
        ("a,relations,b,a\n", "line 1: column 'a' is there twice"),
        ("a,relations,b\nx,DC\n", "line 2: 2 fields, but the header has 3"),
        ("a,relations,b\nx,DC,y,2\n", "line 2: 4 fields, but the header has 3"),
        ("a,relations,b\nx,,y\n", "line 2: the relation set '' is empty"),
        ("a,relations,b\nx,DC,\n", "line 2: an entity is named by a non-empty string"),
        ("a,relations,b\nx,DC,x\n", "line 2: 'x' cannot be DC of itself"),
        ("a,relations,b\nx,DCC,y\n", "line 2: there is no relation named 'DCC'; did you mean 'DC'"),
        ("a,relations,b,weight\nx,DC,y,much\n", "line 2: weight 'much' is no number"),
        ("a,relations,b,weight\nx,DC,y,-1\n", "line 2: a weight is not negative"),
        ("a,relations,b,weight\nx,DC,y,nan\n", "line 2: a weight is not negative"),
        ('a,relations,b\n"x,DC,y\n', "line 2: unexpected end of data"),
        ('a,relations,b\n"p\nq",DC,y\nx,DC\n', "line 4: 2 fields"),
        ("a,relations,b\n" + "x" * 200_000 + ",DC,y\n", "line 2: field larger than field limit"),
    ],
)
def test_bad_csv(text, message):
    with pytest.raises(BadInput, match=re.escape(message)):
        network_from_text(text, "csv")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "text, line 1, column 1: Expecting value"),
        ('{"statements": [}', "text, line 1, column 17"),
        ("[]", "text: a network is an object"),
        ("{}", "text: 'statements' is missing"),
        ('{"statements": 3}', "text: 'statements' is a list, not 3"),
        ('{"statements": [3]}', "text, statement 1: a statement is an object"),
        ('{"statements": [{"a": "x", "b": "y"}]}', "text, statement 1: 'relations' is missing"),
        ('{"statements": [{"a": "x", "b": "y", "relation": []}]}', "there is no key named 'relation'; did you mean"),
        ('{"statement": []}', "text: there is no key named 'statement'; did you mean 'statements'"),
        ('{"calculus": 8, "statements": []}', "text: 'calculus' is a name, not 8"),
        ('{"calculus": "rcc9", "statements": []}', "text: there is no calculus named 'rcc9'; did you mean 'rcc8'"),
        ('{"statements": [], "statements": []}', "text: key 'statements' is there twice in one object"),
        ('{"statements": [{"a": "x", "b": "y", "relations": 1}]}', "'relations' is a list of names, not 1"),
        ('{"statements": [{"a": "x", "b": "y", "relations": [1]}]}', "a relation of rcc8 is named by a string, not 1"),
        ('{"statements": [{"a": "x", "b": "y", "relations": []}]}', "text, statement 1: the relation set [] is empty"),
        ('{"statements": [{"a": null, "b": "y", "relations": ["DC"]}]}', "an entity is named by a non-empty string"),
        ('{"statements": [{"a": 1, "b": 2, "relations": ["DC"], "weight": NaN}]}', "a weight is not negative"),
        ('{"statements": [{"a": 1, "b": 2, "relations": ["DC"], "weight": true}]}', "a weight is a number"),
        ('{"statements": [{"a": 1, "b": 2, "relations": ["DC"], "weight": 1' + "0" * 400 + "}]}", "at most 1.8e308"),
        ('{"statements": ' + "9" * 5000 + "}", "text: Exceeds the limit"),
        ('{"statements": ' + "[" * 100_000, "text: "),
        ('{"entities": [[]], "statements": []}', "text, entities: an entity is named by"),
    ],
)
def test_bad_json(text, message):
    with pytest.raises(BadInput, match=re.escape(message)):
        network_from_text(text, "json")


def test_sizes_that_make_no_sense():
    with pytest.raises(TooLarge, match=r"4,000,000,001 entities for 1 statement would take 931 GiB"):
        network_from_text("4000000000\n0 1 ( DC )\n.", "csp")
    with pytest.raises(TooLarge, match="an index of 20 digits"):
        network_from_text("1" * 20, "csp")
    with pytest.raises(TooLarge, match="line 2: an index of 30 digits"):
        network_from_text("1\n0 " + "1" * 30 + " ( DC )\n.", "csp")


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(BadInput, match=r"cannot read .*none.csp: No such file"):
        read_network(tmp_path / "none.csp")
    with pytest.raises(BadInput, match="cannot read"):
        read_network(tmp_path)
    with pytest.raises(BadInput, match="cannot read"):
        read_network("a\0b")
    latin = tmp_path / "latin.csv"
    latin.write_bytes("a,relations,b\nKüche,DC,Haus\n".encode("latin-1"))
    with pytest.raises(BadInput, match=r"latin.csv, line 2: byte 0xfc is not UTF-8; save the file as UTF-8"):
        read_network(latin)
    other = tmp_path / "other.txt"
    other.write_text("hello\n")
    with pytest.raises(BadInput, match="is no network file: csp starts with a number"):
        read_network(other)
    with pytest.raises(UnknownName, match="there is no network format named 'cvs'; did you mean 'csv'"):
        read_network(other, kind="cvs")


def test_files_that_cannot_be_written(tmp_path):
    net = full()
    with pytest.raises(UnknownName, match="there is no network format named 'xlsx'"):
        write_network(net, tmp_path / "net.xlsx")
    with pytest.raises(BadInput, match=r"the folder .* does not exist"):
        write_network(net, tmp_path / "no" / "net.csv")
    net.add("\ud800", "house", "DC")
    with pytest.raises(BadInput, match="surrogates not allowed"):
        write_network(net, tmp_path / "net.csv")
    with pytest.raises(BadInput, match="without entities"):
        network_to_text(Network("rcc8"), "csp")


def test_several_networks_in_one_file(tmp_path):
    path = tmp_path / "several.csp"
    path.write_text("1 # one\n0 1 ( DC )\n.\n\n# between\n2 # two\n0 1 ( EC )\n1 2 ( PO )\n.\n# end\n")
    found = read_networks(path)
    assert [file.network.n_statements for file in found] == [1, 2]
    assert [file.network.n_entities for file in found] == [2, 3]
    path.write_text("1\n0 1 ( DC )\n.\n1\n0 1 ( DC )\n1 2 ( PO )")
    with pytest.raises(BadInput, match=r"several.csp, line 6: index 2 is above 1, the highest by line 4"):
        read_networks(path)
    (tmp_path / "one.csv").write_text(CSV)
    assert len(read_networks(tmp_path / "one.csv")) == 1


def test_told_calculus_is_taken():
    net = network_from_text("1\n0 1 ( < )\n.", "csp", calculus="point")
    assert net.calculus == POINT
    assert network_from_text('{"statements": []}', "json", calculus=ALLEN).calculus == ALLEN
    with pytest.raises(NinefoldError, match="the file is in 'rcc8', but 'allen' was asked for"):
        network_from_text('{"calculus": "rcc8", "statements": []}', "json", calculus="allen")
