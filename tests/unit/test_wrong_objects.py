"""The wrong kind of object says what to call instead."""

from pathlib import Path

import pytest

import ninefold as nf
from ninefold.errors import BadInput
from ninefold.io import samples
from ninefold.layout.realization import realize
from ninefold.reasoner import (
    KnowledgeBase,
    Network,
    ask,
    check,
    conflict,
    count,
    entails,
    infer,
    minimal,
    repair,
    scenarios,
    some_scenario,
)

NET = Network("rcc8")
NET.add("kitchen", "house", "inside")


@pytest.mark.parametrize(
    "call",
    [
        check,
        conflict,
        repair,
        count,
        minimal,
        some_scenario,
        lambda given: next(scenarios(given)),
        lambda given: entails(given, "a", "inside", "b"),
        lambda given: infer(given, "a", "b"),
        lambda given: ask(given, "inside(kitchen, house)"),
    ],
)
def test_what_is_no_network(call):
    with pytest.raises(
        BadInput, match=r"a Network is needed, and 'plan\.csv' is text; read_network\('plan\.csv'\) reads a file"
    ):
        call("plan.csv")
    with pytest.raises(BadInput, match=r"read_network\('plan\.csv'\)"):
        call(Path("plan.csv"))
    with pytest.raises(BadInput, match=r"a Network is needed, not Consistent\(.*\); give its \.network"):
        call(check(NET))
    base = KnowledgeBase(samples.load("figure8").to_map(), {})
    with pytest.raises(BadInput, match=r"a Network is needed, not KnowledgeBase\(.*; give its \.network"):
        call(base)
    with pytest.raises(BadInput, match=r"a Network is needed, not \['x'\]; Network\('rcc8'\) begins one"):
        call(["x"])


def test_what_is_no_scenario():
    with pytest.raises(BadInput, match=r"realize takes a scenario, not Consistent\(.*\); call realize\(verdict\.scenario\)"):
        realize(check(NET))
    with pytest.raises(BadInput, match=r"not Network\(rcc8, .*\); call realize\(check\(network\)\.scenario\)"):
        realize(NET)
    wrong = NET.copy()
    wrong.add("house", "kitchen", "inside")
    with pytest.raises(BadInput, match=r"this verdict is Inconsistent\(.*\): it has none"):
        realize(check(wrong))
    assert set(realize(check(NET).scenario)) == {"kitchen", "house"}


def test_a_path_is_no_atlas():
    with pytest.raises(BadInput, match=r"Atlas\.open\('f'\) opens an atlas"):
        nf.Atlas("f")
