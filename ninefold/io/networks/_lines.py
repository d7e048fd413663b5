"""What the readers of relation networks share: adding a statement with the place it came from."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

from ninefold._wording import quoted
from ninefold.encodings.library import CALCULI, calculus_named
from ninefold.errors import BadInput, NinefoldError, UnknownName

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ninefold.encodings.calculus import Calculus

__all__ = ["at", "placed", "same_calculus"]


@contextmanager
def at(where: str, calculus: Calculus) -> Iterator[None]:
    """Put a place before the message of an error; an unknown relation that other calculi know says so."""
    try:
        yield
    except NinefoldError as error:
        raise placed(error, where, calculus) from None


def placed(error: NinefoldError, where: str, calculus: Calculus) -> BadInput:
    """Return the same error with its place."""
    hint = _elsewhere(error, calculus) if isinstance(error, UnknownName) else ""
    return BadInput(f"{where}: {error}{hint}")


def _elsewhere(error: UnknownName, calculus: Calculus) -> str:
    if error.kind != "relation":
        return ""
    others = []
    for name in CALCULI:
        if name != calculus.name:
            try:
                calculus_named(name).relation(error.name)
            except NinefoldError:
                continue
            others.append(name)
    if not others:
        return f" (the calculus is {calculus.name})"
    return f" (the calculus is {calculus.name}; {' and '.join(others)} know it: name the calculus)"


def same_calculus(told: Calculus | None, said: str | None, where: str) -> Calculus:
    """Return the calculus of a file from what the caller told and what the file says; RCC-8 if nobody does."""
    if said is None:
        return told or calculus_named("rcc8")
    if told is not None:
        if told.name.casefold() != said.casefold() and _known(said) != told:
            raise BadInput(f"{where}: the file is in {quoted(said)}, but {quoted(told.name)} was asked for")
        return told
    try:
        return calculus_named(said)
    except UnknownName as error:
        raise BadInput(f"{where}: {error}; for a calculus of your own give its definition file") from None


def _known(name: str) -> Calculus | None:
    try:
        return calculus_named(name)
    except UnknownName:
        return None
