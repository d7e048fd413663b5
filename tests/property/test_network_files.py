"""Files of networks under random networks and random damage."""

import math

from hypothesis import example, given, settings
from hypothesis import strategies as st

from ninefold.encodings import POINT, RCC8
from ninefold.errors import NinefoldError
from ninefold.io.networks.network_file import NETWORK_FORMATS, load_network, network_from_text, network_to_text
from ninefold.reasoner.networks.network import Network

names = st.text(st.characters(exclude_categories=("Cs",)), min_size=1, max_size=6).filter(str.strip)
weights = st.none() | st.just(math.inf) | st.floats(min_value=0, allow_nan=False)


@st.composite
def networks(draw, calculus=RCC8):
    net = Network(calculus)
    for name in draw(st.lists(names, max_size=2)):
        net.add_entity(name)
    for _ in range(draw(st.integers(0, 6))):
        a, b = draw(names), draw(names)
        mask = draw(st.integers(1, calculus.universal))
        if a.strip() == b.strip():
            mask |= calculus.identity
        net.add(a, b, mask, draw(st.none() | names), draw(weights))
    return net


def carriage_return():
    net = Network(RCC8)
    net.add("a\rb", "c\nd", "DC", label='"\r\n"')
    return net


@settings(deadline=None)
@given(networks())
def test_json_round_trips(net):
    assert network_from_text(network_to_text(net, "json"), "json") == net


@settings(deadline=None)
@given(networks(POINT).filter(lambda net: net.n_entities))
def test_csp_round_trips(net):
    assert network_from_text(network_to_text(net, "csp"), "csp") == net


@settings(deadline=None)
@given(networks())
@example(carriage_return())
def test_csv_keeps_statements_and_names(net):
    again = network_from_text(network_to_text(net, "csv"), "csv")
    assert again.statements[: net.n_statements] == net.statements
    assert set(again.entities) == set(net.entities)
    assert all(s.mask == RCC8.identity and s.a == s.b for s in again.statements[net.n_statements :])


PIECES = st.sampled_from(
    [
        "0",
        "1",
        "2",
        "7",
        "-1",
        "1e9",
        "DC",
        "EC",
        "ntpp",
        "inside",
        "(",
        ")",
        "( DC )",
        ".",
        "#",
        "#@",
        "#@ {}",
        "\n",
        "\r\n",
    ]
    + [" ", ",", ";", "|", '"', "{", "}", "[", "]", ":", "a", "relations", "b", "weight", "label", "inf", "nan", "null"]
    + [
        '"a"',
        '"b"',
        '"relations"',
        '"statements"',
        '"calculus"',
        '"rcc8"',
        '"entities"',
        "a,relations,b\n",
        "\x00",
        "\u2028",
    ]
    + ['{"statements": [', '{"a": "x", "relations": ["DC"], "b": "y"}', "3 #x\n", "0 1 ( DC )\n", "é", "\ufeff"]
)


def message_of(call):
    """The message of the NinefoldError that a call raises, or None; any other error goes through."""
    try:
        call()
    except NinefoldError as error:
        return str(error)
    return None


@settings(max_examples=400, deadline=None)
@given(st.lists(PIECES, max_size=25).map("".join), st.sampled_from(NETWORK_FORMATS))
def test_only_our_errors_escape_from_text(text, kind):
    def there_and_back():
        net = network_from_text(text, kind)
        assert network_from_text(network_to_text(net, "json"), "json") == net

    assert message_of(there_and_back) != ""


@settings(max_examples=200, deadline=None)
@given(st.binary(max_size=60) | st.lists(PIECES, max_size=20).map(lambda x: "".join(x).encode()), st.data())
def test_only_our_errors_escape_from_files(tmp_path_factory, raw, data):
    path = tmp_path_factory.mktemp("fuzz") / data.draw(st.sampled_from(["n.csp", "n.csv", "n.json", "n"]))
    path.write_bytes(raw)
    message = message_of(lambda: load_network(path))
    assert message is None or str(path) in message


@settings(max_examples=300, deadline=None)
@given(networks().filter(lambda net: net.n_entities), st.sampled_from(NETWORK_FORMATS), st.data())
def test_damaged_files(net, kind, data):
    text = network_to_text(net, kind)
    at = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(at, min(len(text), at + 4)))
    damaged = text[:at] + data.draw(st.just("") | PIECES) + text[end:]
    assert message_of(lambda: network_from_text(damaged, kind)) != ""
