"""Errors: every leaf survives a pickle with its message and its attributes."""

import inspect
import pickle

import pytest

from ninefold import errors
from ninefold.errors import EmptyBelief, MissingExtra, NinefoldError, NotPlane, Undecided, UnknownName, WalkError

MADE = [
    UnknownName("vertex", "v9", ["v1", "v2"]),
    UnknownName("relation", "touches", meant="meet"),
    NotPlane("it has genus 1", genus=1, edges=["a", "b"]),
    WalkError("no heading", where="line 3"),
    Undecided("not decided", kind="theory"),
    MissingExtra("a plot", "plot"),
    EmptyBelief("nothing fits", observation=2, moves=1, nearest="v3"),
]
PLAIN = [
    kind("something is wrong")
    for _, kind in inspect.getmembers(errors, inspect.isclass)
    if issubclass(kind, NinefoldError) and kind not in {type(error) for error in MADE}
]


@pytest.mark.parametrize("error", [*MADE, *PLAIN], ids=lambda error: type(error).__name__)
def test_an_error_survives_a_pickle(error):
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error)
    assert str(again) == str(error)
    assert vars(again) == vars(error)


def test_every_leaf_was_tried():
    leaves = {kind for _, kind in inspect.getmembers(errors, inspect.isclass) if issubclass(kind, NinefoldError)}
    assert leaves == {type(error) for error in [*MADE, *PLAIN]}
