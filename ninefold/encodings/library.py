"""The calculi that come with ninefold, by name.

RCC-8 and RCC-5 are derived; the point algebra and Allen's interval algebra are read from definition files beside this
module, in the format that `Calculus.from_file` takes from anybody.

Examples
--------
>>> from ninefold.encodings import ALLEN, calculus_named
>>> calculus_named("RCC-8").name
'rcc8'
>>> ALLEN.text(ALLEN.compose(ALLEN.relation("during"), ALLEN.relation("meets")))
'<'
"""

from __future__ import annotations

from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING

from ninefold.errors import UnknownName

from .calculus import Calculus

__all__ = ["ALLEN", "CALCULI", "POINT", "allen", "calculus_named", "point"]

if TYPE_CHECKING:
    ALLEN: Calculus
    POINT: Calculus

CALCULI = ("rcc8", "rcc5", "point", "allen")
"""Names that `calculus_named` knows."""


@cache
def calculus_named(name: str) -> Calculus:
    """Return a calculus by its name, in any case and with or without hyphen.

    Raises
    ------
    UnknownName
        None of `CALCULI`.
    """
    match name.casefold().replace("-", "").replace("_", "").strip():
        case "rcc8":
            from .rcc8 import RCC8

            return RCC8
        case "rcc5":
            from .rcc8 import RCC5

            return RCC5
        case "point":
            return point()
        case "allen":
            return allen()
        case _:
            raise UnknownName("calculus", name, CALCULI)


def __getattr__(name: str) -> Calculus:
    """Read the calculi that are files when they are first asked for."""
    if name in ("ALLEN", "POINT"):
        return calculus_named(name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def point() -> Calculus:
    """Return the point algebra: ``< = >`` between points of a line."""
    return _shipped("point")


def allen() -> Calculus:
    """Return Allen's interval algebra: 13 relations between intervals of a line."""
    return _shipped("allen")


@cache
def _shipped(name: str) -> Calculus:
    text = (files(__package__) / "calculi" / f"{name}.spec").read_text(encoding="utf-8")
    return Calculus.from_text(text, name=f"{name}.spec")
