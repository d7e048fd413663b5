"""H8, Q8 and C8 as the literature has them: sizes, closure, maximality."""

import functools
import itertools
import operator

import pytest

from ninefold.encodings import C8, H8, NP8, Q8, RCC8
from ninefold.errors import BadInput

ALL = pytest.mark.parametrize("subclass", [H8, Q8, C8], ids=lambda s: s.name)


@pytest.mark.parametrize(("subclass", "size"), [(H8, 148), (Q8, 160), (C8, 158)])
def test_sizes(subclass, size):
    assert len(subclass.relations) == size
    assert subclass.member.sum() == size
    assert all((mask in subclass) == subclass.member[mask] for mask in range(256))


def test_np8():
    assert len(NP8) == 76
    assert not NP8 & (H8.relations | Q8.relations | C8.relations)
    # Renz 1999: every relation outside NP8 is in one of the three
    assert NP8 | H8.relations | Q8.relations | C8.relations == set(range(256))


@ALL
def test_closed_and_holds_every_base_relation(subclass):
    masks = subclass.relations
    assert all(1 << k in masks for k in range(8))
    assert RCC8.universal in masks
    assert all(RCC8.converse_of(r) in masks for r in masks)
    for r, s in itertools.product(masks, repeat=2):
        assert r & s in masks
        assert RCC8.compose(r, s) in masks


@ALL
def test_maximal(subclass):
    """With any further relation, closing under the three operations reaches an NP-hard one.

    For C8 the relations {EC, some part} are left out: with them the closure stays clear of NP8, and Renz 1999 shows
    hardness by a reduction of its own.
    """
    for extra in set(range(256)) - subclass.relations - NP8:
        if subclass is C8 and not extra & RCC8.relation("EQ"):
            continue
        assert _closure_meets(subclass.relations | {extra}, NP8), RCC8.text(extra)


def _closure_meets(relations, targets):
    known, queue = set(relations), list(relations)
    while queue:
        r = queue.pop()
        new = {RCC8.converse_of(r)}
        for s in list(known):
            new |= {r & s, RCC8.compose(r, s), RCC8.compose(s, r)}
        new -= known
        if new & targets:
            return True
        known |= new
        queue.extend(new)
    return False


@ALL
def test_splits_are_partitions_into_members(subclass):
    for mask in range(256):
        parts = subclass.split(mask)
        assert functools.reduce(operator.or_, parts, 0) == mask
        assert sum(map(int.bit_count, parts)) == mask.bit_count()
        assert all(part in subclass and part for part in parts)
        assert list(map(int.bit_count, parts)) == sorted(map(int.bit_count, parts), reverse=True)


@ALL
def test_splits_are_as_short_as_any_union(subclass):
    for mask in range(1, 256):
        inside = [r for r in subclass.relations if r and r & ~mask == 0]
        maximal = [r for r in inside if not any(r != s and r & ~s == 0 for s in inside)]
        fewer = len(subclass.split(mask)) - 1
        unions = (functools.reduce(operator.or_, some) for some in itertools.combinations(maximal, fewer) if some)
        assert mask not in unions


def test_split_refuses_what_is_no_relation():
    with pytest.raises(BadInput, match="256 is no relation of rcc8"):
        H8.split(256)
