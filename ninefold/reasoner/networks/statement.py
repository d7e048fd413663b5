"""A statement: what somebody said of two things. A network reasons with statements, an atlas keeps them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput

__all__ = ["Statement", "checked_weight"]


@dataclass(frozen=True, slots=True)
class Statement:
    """A declared relation between two names.

    Made by hand, as for an atlas, it is words of whatever calculus; one that `Network.add` returns also has its place in the
    network and its relations as a mask.

    Attributes
    ----------
    a, b
        Names of sets or of other things, mapped or not.
    relations
        The words of which one holds, such as ``("TPP", "NTPP")``; in a network, the names of its calculus in their order.
    label
        Where it comes from or what it is called, free text, or None.
    weight
        What it costs to drop: None counts as 1, `math.inf` is hard.
    index
        Its place in its network, from 0; -1 outside a network.
    mask
        `relations` as bits of the network's calculus; 0 outside a network.

    Raises
    ------
    BadInput
        For an empty name, no relation, a word with a space, a weight that is negative or no number.

    Examples
    --------
    >>> Statement("pond", ("TPP", "NTPP"), "garden", label="the deed", weight=2)
    Statement(a='pond', relations=('TPP', 'NTPP'), b='garden', label='the deed', weight=2.0)
    """

    a: str
    relations: tuple[str, ...]
    b: str
    label: str | None = None
    weight: float | None = None
    index: int = field(default=-1, repr=False, kw_only=True)
    mask: int = field(default=0, repr=False, kw_only=True)

    def __post_init__(self) -> None:
        if self.index < 0:  # a network has checked its own
            self._check()

    def _check(self) -> None:
        for name in (self.a, self.b):
            if not isinstance(name, str) or not name:
                raise BadInput(f"a statement is about names, not {quoted(name)}")
        if isinstance(self.relations, str):
            raise BadInput(f"the relations of a statement are a list of words, not the string {quoted(self.relations)}")
        object.__setattr__(self, "relations", tuple(self.relations))
        for word in self.relations:
            if not isinstance(word, str) or not word or len(word.split()) != 1:
                raise BadInput(f"a relation is one word, not {quoted(word)}")
        if not self.relations:
            raise BadInput(f"the statement about {quoted(self.a)} and {quoted(self.b)} has no relation")
        if self.label is not None and not isinstance(self.label, str):
            raise BadInput(f"a label is text, not {quoted(self.label)}")
        object.__setattr__(self, "weight", checked_weight(self.weight))

    @property
    def cost(self) -> float:
        """The weight, with None counted as 1."""
        return 1.0 if self.weight is None else self.weight

    @property
    def hard(self) -> bool:
        """Whether it must not be dropped."""
        return self.cost == math.inf

    def __str__(self) -> str:
        if self.label:
            return self.label
        return f"statement {self.index + 1}" if self.index >= 0 else f"{self.a} {'|'.join(self.relations)} {self.b}"


def checked_weight(weight: float | None) -> float | None:
    """Return a weight as a float or None, or say why it is none.

    Raises
    ------
    BadInput
        Unless it is None or a number from 0 to infinity.
    """
    if weight is None:
        return None
    if isinstance(weight, bool) or not isinstance(weight, int | float | np.integer | np.floating):
        raise BadInput(f"a weight is a number or None, not {quoted(weight)}")
    try:
        cost = float(weight)
    except OverflowError:
        raise BadInput("a weight is at most 1.8e308; math.inf makes a statement hard") from None
    if math.isnan(cost) or cost < 0:
        raise BadInput(f"a weight is not negative; math.inf makes a statement hard: {quoted(weight)} was given")
    return cost
