"""What is inside what: the Hasse diagram of a family of regions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import quoted
from ninefold.errors import BadInput
from ninefold.mapping.sets import Region

from .bulk import relate_all
from .relation import BE, IE

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

__all__ = ["containment_tree"]


def containment_tree(regions: Mapping[str, Region] | Sequence[Region]) -> Any:
    """Order regions by containment.

    Parameters
    ----------
    regions
        Regions by name, or a sequence, whose names are then its row numbers as strings.

    Returns
    -------
    networkx.DiGraph
        One node for each distinct region, named after the first of its equals, with all their names in the attribute
        ``members``. An edge goes from a region to every region directly below it: inside or coveredBy it with none
        between. For nested regions that is a forest; regions that overlap may share what lies in both.

    Raises
    ------
    BadInput
        If something is not a region.
    DifferentMaps
        If the regions are of two maps.

    Notes
    -----
    Complexity O(n^2) relations and O(n^3 / 64) for the transitive reduction.

    Examples
    --------
    >>> from ninefold.mapping import PlaneMap
    >>> from ninefold.reasoner import containment_tree
    >>> plane = PlaneMap.from_geometry(
    ...     [(0, 0), (9, 0), (9, 9), (0, 9), (1, 1), (5, 1), (1, 5)],
    ...     [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 4)])
    >>> tree = containment_tree({"room": plane.cycle([4, 5, 6]), "house": plane.cycle([0, 1, 2, 3])})
    >>> list(tree.edges)
    [('house', 'room')]
    """
    import networkx as nx

    pairs = regions.items() if hasattr(regions, "items") else ((str(i), r) for i, r in enumerate(regions))
    named = dict(pairs)
    for name, region in named.items():
        if not isinstance(region, Region):
            raise BadInput(f"containment_tree takes regions; {quoted(name)} is {quoted(region)}")
    tree = nx.DiGraph()
    if not named:
        return tree
    names, family = list(named), list(named.values())
    below = (relate_all(family) & (IE | BE)) == 0  # below[i, j]: region i lies in region j, or equals it
    equal = below & below.T
    first = equal.argmax(axis=1)
    kept = np.flatnonzero(first == np.arange(len(names)))
    for i in kept.tolist():
        tree.add_node(names[i], members=tuple(names[j] for j in np.flatnonzero(equal[i]).tolist()))
    strict = (below & ~equal)[np.ix_(kept, kept)]
    packed = np.packbits(strict, axis=1)  # row i: what i lies strictly in
    for i in range(len(kept)):
        above = np.flatnonzero(strict[i])
        if not above.size:
            continue
        beyond = np.unpackbits(np.bitwise_or.reduce(packed[above], axis=0), count=len(kept)).astype(bool)
        for j in above[~beyond[above]].tolist():
            tree.add_edge(names[int(kept[j])], names[int(kept[i])])
    return tree
