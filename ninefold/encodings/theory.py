"""What is known of a calculus, claim by claim, with the paper that shows it.

Whether closure decides, which relations may stay unsplit, how a closed network becomes a scenario, what a drawing is made
of: all this holds for some calculi and not for others, and nobody can compute it from the tables. So it is written down
here, once. Whoever needs a fact asks `theory_of`; of a calculus that is not listed nothing is claimed, and then closure
may refute a network but never confirm one. A new calculus of which something is known gets an entry in this module, and
no other module changes.

Examples
--------
>>> from ninefold.encodings import RCC8, theory_of
>>> theory = theory_of(RCC8)
>>> theory.closure_decides, theory.split_class.name, [known.value.name for known in theory.subclasses]
(True, 'H8', ['H8', 'Q8', 'C8'])
>>> theory.closure.split(":")[0]
'J. Renz, "A canonical model of the region connection calculus", Journal of Applied Non-Classical Logics 12, 2002'

A closed network of relations in H8 needs no more choices: each pair takes the first of these that it has.

>>> [RCC8.bases[k] for k in theory.preference.value]
['DC', 'EC', 'PO', 'TPP', 'NTPP', 'TPPi', 'NTPPi', 'EQ']
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Generic, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

    from .calculus import Calculus
    from .horn import HornTheory
    from .model import BaseMeaning
    from .subclasses import Subclass

__all__ = ["Known", "Theory", "theory_of"]

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Known(Generic[T]):
    """Something known, and where it is shown."""

    value: T
    source: str


@dataclass(frozen=True, slots=True)
class Theory:
    """What is known of one calculus; None or nothing where nothing is.

    Attributes
    ----------
    calculus
        What it is about.
    closure
        Where it is shown that closure of one base relation a pair decides consistency, on chordal completions too.
    subclasses
        Tractable subclasses that hold every base relation, in which closure decides. The first one is what searches split
        into. Without any the base relations and the universal one are used.
    at_once
        Where it is shown that in every closed network over the first subclass, on a chordal completion too, each pair can
        take the first base relation of `preference` that it has, all at the same time. Where this is not known, but
        `preference` is, pairs can take it node by node (see `ninefold.reasoner.networks.completion`).
    preference
        The base relations in an order for making scenarios: where nodes with known relations get one more node, and the new
        pairs are closed, each of them can take the first that it has.
    horn
        Atoms in which composition is Horn.
    model
        What the base relations say of cells, from which regions are drawn.
    """

    calculus: Calculus
    closure: str | None = None
    subclasses: tuple[Known[Subclass], ...] = ()
    at_once: str | None = None
    preference: Known[tuple[int, ...]] | None = None
    horn: Known[HornTheory] | None = None
    model: Known[tuple[BaseMeaning, ...]] | None = None

    @property
    def closure_decides(self) -> bool:
        """Whether closure of one base relation a pair is known to decide consistency."""
        return self.closure is not None

    @property
    def split_class(self) -> Subclass | None:
        """The subclass that searches split into, or None for the base relations."""
        return self.subclasses[0].value if self.subclasses else None

    def parts_of(self, mask: int) -> tuple[int, ...]:
        """Return what a relation is split into: members of `split_class`, or else base relations.

        Examples
        --------
        >>> from ninefold.encodings import POINT, RCC5
        >>> [theory_of(calculus).parts_of(5) for calculus in (RCC5, POINT)]
        [(5,), (1, 4)]
        """
        if self.split_class is not None:
            return self.split_class.split(mask)
        return tuple(1 << k for k in range(self.calculus.n_bases) if mask >> k & 1)

    def decides(self, mask: int) -> bool:
        """Tell whether closure decides networks of relations like this one; the universal relation always counts."""
        return mask == self.calculus.universal or len(self.parts_of(mask)) == 1


def theory_of(calculus: Calculus) -> Theory:
    """Return what is known of a calculus, by its value: name, base relations and tables have to be the known ones."""
    known = _STUDIED.get(calculus.name)
    theory = None if known is None else known()
    return theory if theory is not None and theory.calculus == calculus else Theory(calculus)


_RENZ_2002 = (
    'J. Renz, "A canonical model of the region connection calculus", Journal of Applied Non-Classical Logics 12, 2002'
)
_LUTZ = (
    'C. Lutz and M. Milicic, "A tableau algorithm for description logics with concrete domains and general TBoxes", '
    "Journal of Automated Reasoning 38, 2007 (patchwork of RCC-8 and Allen's relations)"
)
_HUANG = (
    'J. Huang, "Compactness and its implications for qualitative spatial and temporal reasoning", KR 2012 (patchwork makes '
    "chordal completions enough)"
)
_RENZ_NEBEL = (
    'J. Renz and B. Nebel, "On the complexity of qualitative spatial reasoning: a maximal tractable fragment of the region '
    'connection calculus", Artificial Intelligence 108, 1999'
)
_RENZ_1999 = 'J. Renz, "Maximal tractable fragments of the region connection calculus: a complete analysis", IJCAI 1999'
_JONSSON = 'P. Jonsson and T. Drakengren, "A complete classification of tractability in RCC-5", JAIR 6, 1997'
_LONG = (
    'Z. Long and S. Li, "On distributive subalgebras of qualitative spatial and temporal calculi", COSIT 2015: base '
    "relations generate a distributive subalgebra, in which closed networks are minimal and extend node by node"
)
_CHECKED = "checked over all closed triangles by tests/oracle/test_theories.py"


@cache
def _rcc8() -> Theory:
    from .horn import RCC8_HORN
    from .model import RCC8_MODEL
    from .rcc8 import RCC8
    from .subclasses import C8, H8, Q8

    return Theory(
        calculus=RCC8,
        closure=f"{_RENZ_2002}: closed base relations have a model; {_LUTZ}; {_HUANG}",
        subclasses=(Known(H8, _RENZ_NEBEL), Known(Q8, _RENZ_1999), Known(C8, _RENZ_1999)),
        at_once=f"{_RENZ_1999}, by refinement; {_CHECKED}",
        preference=Known(tuple(range(8)), f"{_LONG}; {_CHECKED}"),
        horn=Known(RCC8_HORN, 'M. Westphal and J. Hue, "A concise Horn theory for RCC8", ECAI 2014'),
        model=Known(RCC8_MODEL, _RENZ_2002),
    )


@cache
def _rcc5() -> Theory:
    from .horn import RCC5_HORN
    from .model import RCC5_MODEL
    from .rcc8 import RCC5
    from .subclasses import H5

    return Theory(
        calculus=RCC5,
        closure=f"{_RENZ_2002}, without boundaries; {_HUANG}",
        subclasses=(Known(H5, _JONSSON),),
        at_once=f"{_RENZ_1999}, by refinement; {_CHECKED}",
        preference=Known(tuple(range(5)), f"{_LONG}; {_CHECKED}"),
        horn=Known(RCC5_HORN, 'M. Westphal and J. Hue, "A concise Horn theory for RCC8", ECAI 2014, without boundaries'),
        model=Known(RCC5_MODEL, f"{_RENZ_2002}, without boundaries"),
    )


@cache
def _point() -> Theory:
    from .library import point

    return Theory(
        calculus=point(),
        closure=f'P. van Beek, "Reasoning about qualitative temporal information", AIJ 58, 1992; {_HUANG}',
        preference=Known((0, 2, 1), f"{_LONG}; {_CHECKED}"),
    )


@cache
def _allen() -> Theory:
    from .library import allen

    calculus = allen()
    # where the interval's ends may lie strictly between or beyond those of the other they do, and as far down as they may
    order = ("<", "o", "di", "d", "oi", ">", "m", "fi", "s", "si", "f", "mi", "=")
    return Theory(
        calculus=calculus,
        closure=f'R. Valdes-Perez, "The satisfiability of temporal constraint networks", AAAI 1987; {_LUTZ}',
        preference=Known(tuple(calculus.bases.index(name) for name in order), f"{_LONG}; {_CHECKED}"),
    )


_STUDIED: dict[str, Callable[[], Theory]] = {"rcc8": _rcc8, "rcc5": _rcc5, "point": _point, "allen": _allen}
"""The calculi of which something is known, by name; each is made when it is first asked for."""
