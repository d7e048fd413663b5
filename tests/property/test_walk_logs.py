"""Walk logs: a round trip is exact, and whatever the bytes, only a NinefoldError of one line escapes."""

import json
import math

from hypothesis import given, settings
from hypothesis import strategies as st

from ninefold.errors import NinefoldError
from ninefold.io.walks.json_lines import iter_events, read_header, read_walk, write_walk
from ninefold.mapping import Heading, Mapper, Samples, Visit, Walk, WalkHeader

yaws = st.floats(-20, 20)
metres = st.floats(0, allow_infinity=False)
labels = st.text(st.characters(min_codepoint=32, exclude_categories=["Cs"]), min_size=1, max_size=6)
scalars = st.none() | st.booleans() | st.integers(-5, 5) | st.floats(-1, 1) | labels


@st.composite
def walks(draw):
    header = WalkHeader(
        compass=draw(st.booleans()),
        tolerance=draw(st.floats(1e-6, 0.7)),
        extra=draw(st.dictionaries(labels.filter(lambda k: k not in KNOWN), scalars, max_size=2)),
        sigma=draw(st.none() | st.floats(0, math.pi / 3, exclude_min=True)),
        drift=draw(st.none() | st.floats(0, math.pi)),
        exits=draw(st.sampled_from(["any-order", "in-order"])),
    )
    events, t = [], 0.0

    def time():
        nonlocal t
        if draw(st.booleans()):
            return None
        t += draw(st.floats(0, 10))
        return t

    for _ in range(draw(st.integers(0, 5))):
        count = draw(st.integers(0, 4))
        first = draw(st.floats(-math.pi, math.pi))
        exits = tuple(Heading(first + k * 2 * math.pi / count) for k in range(count)) if draw(st.booleans()) else None
        events.append(Visit(draw(st.none() | labels), exits, draw(st.none() | labels), time()))
        count = draw(st.integers(1, 3))
        events += [
            Samples(tuple(draw(st.lists(yaws, min_size=1, max_size=4))), time(), draw(st.none() | metres))
            for _ in range(count)
        ]
    return Walk(header, tuple(events))


KNOWN = {"ninefold", "version", "heading", "compass", "tolerance", "sigma", "drift", "exits"}


@settings(max_examples=200, deadline=None)
@given(walk=walks())
def test_round_trip(tmp_path_factory, walk):
    path = tmp_path_factory.mktemp("walks") / "walk.jsonl"
    write_walk(walk, path)
    assert read_walk(path) == walk
    assert tuple(iter_events(path)) == walk.events
    assert read_header(path) == walk.header


def consume(path):
    for read in (read_walk, read_header, lambda p: list(iter_events(p)), mapped):
        message = message_of(read, path)
        assert message is None or (message and "\n" not in message)


def message_of(read, path):
    try:
        read(path)
    except NinefoldError as error:
        return str(error)
    return None


def mapped(path):
    walk = read_walk(path)
    mapper = Mapper(walk.header)
    for event in walk.events:
        mapper.step(event)
    if mapper.n_vertices:
        mapper.plane.validate()


HEADER = b'{"ninefold": "walk", "version": 1, "heading": "bearing-deg"}'


@settings(max_examples=300, deadline=None)
@given(data=st.binary(max_size=200), headed=st.booleans())
def test_any_bytes(tmp_path_factory, data, headed):
    path = tmp_path_factory.mktemp("walks") / "walk.jsonl"
    path.write_bytes(HEADER + b"\n" + data if headed else data)
    consume(path)


values = st.recursive(
    scalars | st.floats() | st.integers() | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=3), inner, max_size=3),
    max_leaves=6,
)
keys = st.sampled_from(
    [
        "place",
        "heading",
        "headings",
        "exits",
        "edge",
        "t",
        "metres",
        "version",
        "ninefold",
        "compass",
        "tolerance",
        "sigma",
        "drift",
        "x",
    ]
)
plausible = st.sampled_from(
    ["a", "b", 3, None, 0, 90.0, [0, 90], [10.5], "bearing-deg", "in-order", "walk", 1, True, 0.5, 1e308, [], [1e-300]]
)


@settings(max_examples=500, deadline=None)
@given(lines=st.lists(st.dictionaries(keys, plausible | values, max_size=4), max_size=8), headed=st.booleans())
def test_any_json_objects(tmp_path_factory, lines, headed):
    path = tmp_path_factory.mktemp("walks") / "walk.jsonl"
    text = "\n".join(json.dumps(line) for line in lines).encode()
    path.write_bytes(HEADER + b"\n" + text if headed else text)
    consume(path)


@settings(max_examples=300, deadline=None)
@given(walk=walks(), data=st.data())
def test_a_log_with_bytes_changed(tmp_path_factory, walk, data):
    path = tmp_path_factory.mktemp("walks") / "walk.jsonl"
    write_walk(walk, path)
    raw = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(raw) - 1))
        match data.draw(st.sampled_from(["set", "delete", "insert", "cut"])):
            case "set":
                raw[at] = data.draw(st.integers(0, 255))
            case "delete":
                del raw[at]
            case "insert":
                raw[at:at] = data.draw(
                    st.sampled_from([b"\n", b"{", b"}", b"9" * 400, b"NaN", b'"', b"\xff", b"null", b"-", b"e9"])
                )
            case "cut":
                del raw[at:]
        if not raw:
            break
    path.write_bytes(bytes(raw))
    consume(path)
