"""Drawings on matplotlib axes, for figures that need axes, insets or a PDF; matplotlib comes with the extra ``plot``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold.errors import MissingExtra
from ninefold.mapping import Line, Point, Region

from .shapes import region_rings
from .svg import LABELS_UP_TO, leg_colouring, named_sets
from .theme import CLOSING, CONTRADICTED, EVENED, FIXED, LIGHT, ROLES

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from ninefold.mapping import Health, Set

    from .bearing_rigidity import Rigidity
    from .drawing import Drawing

__all__ = ["plot"]


def plot(
    drawing: Drawing,
    *,
    highlight: Mapping[str, Set] | Iterable[Set] | Set | None = None,
    rigidity: bool | Rigidity = False,
    health: bool | Health = False,
    axes: Any = None,
) -> Any:
    """Draw on matplotlib axes, in map coordinates, and return them.

    Parameters
    ----------
    highlight, rigidity, health
        As for `Drawing.to_svg`.
    axes
        Axes to draw on; a new figure if left out.

    Raises
    ------
    MissingExtra
        Without matplotlib.
    """
    try:
        from matplotlib.collections import LineCollection
        from matplotlib.figure import Figure
        from matplotlib.patches import PathPatch
        from matplotlib.path import Path
    except ImportError:
        raise MissingExtra("plotting on matplotlib axes", "plot") from None
    plane = drawing.plane
    sets = named_sets(drawing, highlight)
    colouring = leg_colouring(drawing, rigidity=rigidity, health=health)
    classes = () if colouring is None else colouring.classes
    if axes is None:
        axes = Figure(figsize=(7, 6), layout="constrained").add_subplot()
    for kind in classes:
        lines = [drawing.path(e) for e in kind.edges]
        axes.add_collection(LineCollection(lines, label=kind.words, zorder=2, **_look(kind.name)))
    if colouring is None:
        real = np.flatnonzero(~plane.tether).tolist()
        axes.add_collection(LineCollection([drawing.path(e) for e in real], colors=LIGHT["edge"], linewidths=1.0, zorder=2))
    for k, (label, x) in enumerate(sets):
        match x:
            case Region():
                rings = [np.concatenate([ring, ring[:1]]) for part in region_rings(drawing, x) for ring in part]
                outline = Path.make_compound_path(*[Path(ring.astype(np.float64), closed=True) for ring in rings])
                tint = {"facecolor": f"{ROLES[k]}44", "edgecolor": ROLES[k]}
                axes.add_patch(PathPatch(outline, **tint, linewidth=2, label=label, zorder=1))
            case Line():
                lines = [drawing.path(e) for e in x.edges]
                axes.add_collection(LineCollection(lines, colors=ROLES[k], linewidths=3.5, label=label, zorder=3))
            case Point():
                axes.scatter(*drawing.points[[x.index]].T, s=70, color=ROLES[k], label=label, zorder=5)
    axes.scatter(*drawing.points.T, s=12, color=LIGHT["edge"], zorder=4)
    if plane.n_vertices <= LABELS_UP_TO:
        for v, (px, py) in enumerate(drawing.points.tolist()):
            axes.annotate(plane.vertex_names[v], (px, py), xytext=(4, 4), textcoords="offset points", fontsize=8)
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set_axis_off()
    if sets or classes:
        axes.legend(loc="best")
    return axes


def _look(name: str) -> dict[str, Any]:
    """Return how a class of legs is drawn."""
    match name:
        case "evened":
            return {"colors": EVENED["light"], "linewidths": 1.0, "linestyles": "dashed"}
        case "contradicted":
            return {"colors": CONTRADICTED["light"], "linewidths": 3.5}
        case _ if name.startswith("closing"):
            k = int(name.removeprefix("closing"))
            return {"colors": CLOSING["light"][k], "linewidths": 1.2 + 0.3 * k}
        case _:
            return {"colors": FIXED["light"][int(name.removeprefix("fixed"))], "linewidths": 1.8}
