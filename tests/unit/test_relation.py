"""A relation beside its texts: never quietly unequal to a word."""

import pickle

import pytest

from ninefold.errors import BadInput
from ninefold.reasoner import Relation

inside = Relation.from_de9im("2FF1FF212")


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("inside", r"relation\.name == 'inside'"),
        ("NTPP", r"relation\.rcc8 == 'NTPP'"),
        ("ntppi", r"relation\.rcc8 == 'ntppi'"),
        ("2FF1FF212", r"relation\.de9im == '2FF1FF212'"),
        ("", r"relation\.name == ''"),
        ("x" * 500, r"xxx \.\.\. xxx"),
    ],
)
def test_a_relation_is_not_compared_with_a_text(text, hint):
    for compare in (
        lambda: inside == text,
        lambda: text == inside,
        lambda: inside != text,
        lambda: inside in (text, "meet"),
        lambda: text in [inside],
    ):
        with pytest.raises(BadInput, match=hint):
            compare()


def test_relations_are_equal_by_their_code():
    assert inside == Relation(inside.code)
    assert inside != inside.converse
    assert inside != 7
    assert inside is not None
    assert inside != None  # noqa: E711
    assert len({inside, Relation(inside.code), inside.converse}) == 2
    assert pickle.loads(pickle.dumps(inside)) == inside
