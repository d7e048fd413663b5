"""Definition files under random damage: a calculus that keeps its laws, or one of our errors."""

from importlib.resources import files

from hypothesis import given, settings
from hypothesis import strategies as st

from ninefold.encodings import Calculus
from ninefold.errors import NinefoldError

POINT = (files("ninefold.encodings") / "calculi" / "point.spec").read_text(encoding="utf-8")
PIECES = st.sampled_from(
    ["<", "=", ">", ":", "::", "(", ")", "( < )", "\n", " ", "#", "alias", "identity", "x", "\x00", "é"]
)


@settings(max_examples=300, deadline=None)
@given(st.data())
def test_damaged_definitions(data):
    text = POINT
    for _ in range(data.draw(st.integers(1, 3))):
        at = data.draw(st.integers(0, len(text)))
        end = data.draw(st.integers(at, min(len(text), at + 5)))
        text = text[:at] + data.draw(st.just("") | PIECES) + text[end:]
    try:
        calculus = Calculus.from_text(text)
    except NinefoldError:
        return
    universal = calculus.universal
    for r in range(universal + 1):
        assert calculus.converse_of(calculus.converse_of(r)) == r
        assert calculus.compose(calculus.identity, r) == r == calculus.compose(r, calculus.identity)


@settings(max_examples=200, deadline=None)
@given(st.lists(PIECES, max_size=30).map("".join))
def test_nonsense(text):
    try:
        Calculus.from_text(text)
    except NinefoldError as error:
        message = str(error)
    else:
        message = "a calculus"
    assert message
