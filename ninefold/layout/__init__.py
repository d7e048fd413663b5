"""Pictures and proof: straight-line drawings of plane maps, their geometry, and the oracle that checks symbolic answers.

**Drawing.** A map has no coordinates; a layout gives it some. `compass` draws it as the place looks, from headings alone;
`tutte` puts every vertex amid its neighbours, and `relax` opens the angles of such a drawing; `schnyder` puts the vertices
on an integer grid, (n - 2) x (n - 2) for simple maps, in linear time and at any size. Where one has to fall back to another,
the drawing's notes say so. All keep the rotation system, the outer face and the hosts of all components; `draw` takes the
layout by name. Loops and parallel edges get bends (`subdivide`). What compass and relaxed drawings share is in
`ninefold.layout.shaping`.

**Several maps of one walk.** `draw_alternatives` shows the maps that explain a walk side by side, and marks what differs.

**Measured or evened out.** `rigidity` says which parts of a map have their shape from headings, and which headings the
rest contradicts. `heading_errors` and `misplacement` say how much a drawing looks like the place.

**Drawing as a value.** `Drawing` holds points and bends. It turns any point, line or region of its map into a valid shapely
geometry (`shapes`), and shows itself as SVG (`svg`, `labels`, `theme`) or on matplotlib axes (`plot`).

**The oracle.** `verify` checks a drawing from its coordinates alone (`planarity`) and holds ``relate`` against
``shapely.relate`` on given or sampled pairs (`sampling`); `verify_geometry` does so on geometry of the caller's. What
disagrees is shrunk to a small map that still shows it (`shrink`).

**Witnesses.** `realize` makes geometry that satisfies a scenario of RCC-8 or RCC-5, every pair confirmed by GEOS before it
is returned; `witness_svg` draws it.

The layouts are in `ninefold.layout.methods`. Names load when they are first used; shapely, scipy and matplotlib likewise.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ninefold._lazy import attach

if TYPE_CHECKING:
    from .alternatives import draw_alternatives
    from .bearing_rigidity import Rigidity, rigidity
    from .drawing import Drawing
    from .layouts import LAYOUTS, draw
    from .methods.compass import compass
    from .methods.relax import relax
    from .methods.schnyder import schnyder
    from .methods.tutte import tutte
    from .oracle import Disagreement, Report, verify, verify_geometry
    from .planarity import drawing_problems
    from .realization import realize
    from .resemblance import heading_errors, misplacement
    from .sampling import random_sets, sample_pairs
    from .sheet import side_by_side
    from .shrinking import shrink
    from .truth import TrueShapes
    from .witness import witness_svg

__all__ = [
    "LAYOUTS",
    "Disagreement",
    "Drawing",
    "Report",
    "Rigidity",
    "TrueShapes",
    "compass",
    "draw",
    "draw_alternatives",
    "drawing_problems",
    "heading_errors",
    "misplacement",
    "random_sets",
    "realize",
    "relax",
    "rigidity",
    "sample_pairs",
    "schnyder",
    "shrink",
    "side_by_side",
    "tutte",
    "verify",
    "verify_geometry",
    "witness_svg",
]

__getattr__, __dir__ = attach(
    __name__,
    {
        "alternatives": ("draw_alternatives",),
        "bearing_rigidity": ("Rigidity", "rigidity"),
        "drawing": ("Drawing",),
        "layouts": ("LAYOUTS", "draw"),
        "methods.compass": ("compass",),
        "methods.relax": ("relax",),
        "methods.schnyder": ("schnyder",),
        "methods.tutte": ("tutte",),
        "oracle": ("Disagreement", "Report", "verify", "verify_geometry"),
        "planarity": ("drawing_problems",),
        "realization": ("realize",),
        "resemblance": ("heading_errors", "misplacement"),
        "sampling": ("random_sets", "sample_pairs"),
        "sheet": ("side_by_side",),
        "shrinking": ("shrink",),
        "truth": ("TrueShapes",),
        "witness": ("witness_svg",),
    },
)
