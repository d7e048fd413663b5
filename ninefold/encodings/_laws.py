"""The laws that the tables of a qualitative calculus must obey, and where the first failure is seen.

With jointly exhaustive and pairwise disjoint base relations, ``c`` is in ``a;b`` exactly if some x, y, z have
``x a y``, ``y b z`` and ``x c z``. Read from the other corners, such a triangle puts ``b`` in ``a~;c`` and ``a`` in
``c;b~``, whatever the domain: the last law below. It finds nearly every slip in a typed table.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

if TYPE_CHECKING:
    from numpy.typing import NDArray

__all__ = ["check", "check_names"]


def check_names(calculus: str, bases: tuple[str, ...]) -> None:
    """Refuse a calculus without base relations, or with two of one name."""
    if not bases:
        raise BadInput(f"calculus {quoted(calculus)} has no base relation")
    twice = sorted({base for base in bases if bases.count(base) > 1})
    if twice:
        raise BadInput(f"calculus {quoted(calculus)}: base relation {quoted(twice[0])} is named twice")
    for base in bases:
        if not base or any(c.isspace() or c in ",()" for c in base):
            raise BadInput(f"calculus {quoted(calculus)}: {quoted(base)} cannot be a name: no spaces, commas or parentheses")


def check(
    calculus: str, bases: tuple[str, ...], identity: int, converse: NDArray[np.intp], table: NDArray[np.uint64]
) -> None:
    """Check shapes, then every law in turn; O(b^3) for b base relations.

    Parameters
    ----------
    converse
        (b,) indices.
    table
        (b, b) uint64 masks.

    Raises
    ------
    BadInput
        The first law that fails, with the base relations it fails at.
    """
    b = len(bases)
    if converse.shape != (b,) or table.shape != (b, b):
        raise BadInput(
            f"calculus {quoted(calculus)} has {b} base relations, so its converse table is ({b},) and its composition table "
            f"({b}, {b}), not {converse.shape} and {table.shape}"
        )
    if not 0 < identity < 1 << b:
        raise BadInput(f"calculus {quoted(calculus)}: identity {identity} is no non-empty set of its {b} base relations")

    def fail(law: str) -> BadInput:
        return BadInput(f"calculus {quoted(calculus)}: {law}")

    outside = np.flatnonzero((converse < 0) | (converse >= b))
    if outside.size:
        raise fail(f"the converse of {bases[outside[0]]} is no base relation")
    for k in range(b):
        back = int(converse[converse[k]])
        if back != k:
            raise fail(f"converse is no involution: {bases[k]}~ is {bases[converse[k]]}, whose converse is {bases[back]}")
    for k in range(b):
        if identity >> k & 1 and not identity >> int(converse[k]) & 1:
            raise fail(f"the identity holds {bases[k]} but not its converse {bases[converse[k]]}")
    if b < 64 and (table >= np.uint64(1 << b)).any():
        i, j = np.argwhere(table >= np.uint64(1 << b))[0]
        raise fail(f"{bases[i]};{bases[j]} holds a bit that is no base relation")

    # possible[i, j, k]: k is in i;j
    possible = (table[:, :, None] >> np.arange(b, dtype=np.uint64)) & np.uint64(1) != 0
    ident = np.array([identity >> k & 1 for k in range(b)], dtype=bool)
    same = np.eye(b, dtype=bool)
    for side, got in (("left", possible[ident].any(axis=0)), ("right", possible[:, ident].any(axis=1))):
        wrong = np.argwhere(got != same)
        if wrong.size:
            k = int(wrong[0, 0])
            shown = _set(bases, got[k])
            form = f"identity;{bases[k]}" if side == "left" else f"{bases[k]};identity"
            raise fail(f"{form} is {shown}, not {{{bases[k]}}}")

    turned = possible[np.ix_(converse, converse, converse)].transpose(1, 0, 2)  # [a, b, c]: c~ in b~;a~
    _same_triples(fail, bases, possible, turned, "(a;b)~ = b~;a~ fails", "its converse", "b~;a~")
    rotated = possible[converse].transpose(0, 2, 1)  # [a, b, c]: b in a~;c
    _same_triples(fail, bases, possible, rotated, "base relations cannot be disjoint and exhaustive", "b", "a~;c")


def _same_triples(
    fail: Any, bases: tuple[str, ...], one: NDArray[np.bool_], two: NDArray[np.bool_], law: str, what: str, where: str
) -> None:
    wrong = np.argwhere(one != two)
    if wrong.size:
        i, j, k = wrong[0].tolist()
        a, b, c = bases[i], bases[j], bases[k]
        verb = "is" if one[i, j, k] else "is not"
        other = "is not" if one[i, j, k] else "is"
        raise fail(f"{law} at (a, b, c) = ({a}, {b}, {c}): {c} {verb} in {a};{b} but {what} {other} in {where}")


def _set(bases: tuple[str, ...], bits: NDArray[np.bool_]) -> str:
    return "{" + " ".join(base for base, bit in zip(bases, bits, strict=True) if bit) + "}"
