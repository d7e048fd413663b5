"""Drawings as SVG: readable in light and dark, without scripts, fonts or anything else from outside the file.

Bounded faces stand on a tinted ground, so the outer face is the paper. Highlighted sets are coloured by role, in the order
given: regions tinted, hatched and outlined (dashed after the first, so that a shared outline shows both), lines broad,
points as dots. Names appear on small maps only; edges and vertices carry tool tips. A Schnyder drawing lives in a right
triangle; the picture shears it to an equilateral one, which keeps straight lines, sides and crossings as they are.

By request the edges are coloured by what the headings fix (`leg_classes`): those that nothing measures dashed, those that
the rest contradicts broad and on top; or by how well headings and turns agree (`health_scale`), the worst broadest and on
top. Highlighted lines and outlines then lie below the edges, and reach out on both sides. By request too, the places where a
robot can be are marked (`beliefs`), larger and stronger the likelier they are, and what is undecided about a map that was
estimated, with sentences below (`doubt_marks`), or how it differs from another map of the same walk (`difference_marks`).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ninefold._wording import counted, quoted
from ninefold.errors import BadInput
from ninefold.mapping import Line, Point, Region

from .beliefs import belief_of
from .difference_marks import DIFFERENCE_COLOURS, difference_mark
from .doubt_marks import DoubtMark, doubt_marks, doubt_sentences, doubt_words, ring
from .health_scale import health_colouring, health_of, health_scale
from .labels import place_labels, text_width
from .leg_classes import rigidity_colouring, rigidity_of
from .shapes import region_rings
from .theme import ROLES, THEMES, style_sheet

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from ninefold.mapping import Doubt, Health, Set

    from .bearing_rigidity import Rigidity
    from .beliefs import Belief
    from .difference_marks import Differences
    from .drawing import Drawing
    from .leg_classes import LegColouring

__all__ = ["leg_colouring", "named_sets", "render"]

LABELS_UP_TO = 40
"""Vertices up to which names are shown unless asked otherwise."""

TIPS_UP_TO = 3000
"""Edges up to which every edge is an element of its own with a tool tip; beyond, one path holds them all."""

_FONT = "system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Arial,sans-serif"
_UNFIT = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_PARSE = "plane.parse makes a set of text"
_PAD = 28.0
_HATCH = (None, 45, -45, 0, 90, 22, -22)
_DASH = ("none", "10 8", "3 6", "14 6", "6 6", "2 4", "12 4 3 4")


def render(
    drawing: Drawing,
    *,
    highlight: Mapping[str, Set] | Iterable[Set] | Set | None = None,
    title: str | None = None,
    labels: bool | None = None,
    theme: str = "auto",
    width: int = 800,
    rigidity: bool | Rigidity = False,
    health: bool | Health = False,
    belief: ArrayLike | None = None,
    doubts: Iterable[Doubt] = (),
    differences: Differences | None = None,
) -> str:
    """Return the SVG text; see `Drawing.to_svg` for the parameters."""
    if theme not in THEMES:
        raise BadInput(f"theme is one of {', '.join(THEMES)}, not {quoted(theme)}")
    if not 100 <= width <= 20_000:
        raise BadInput(f"width is in pixels, from 100 to 20000, not {width}")
    sets = named_sets(drawing, highlight)
    colouring = leg_colouring(drawing, rigidity=rigidity, health=health)
    seen = belief_of(drawing.plane, belief)
    said = tuple(doubts)
    marks = doubt_marks(drawing.plane, said)
    page = _Page(drawing, width, title, None if differences is None else differences.n_places)
    if colouring is not None:
        page.band = 5.5 + _leg_width("fixed0", page.stroke)
    shown = drawing.plane.n_vertices <= LABELS_UP_TO if labels is None else labels
    body = [
        _defs(
            theme,
            len(sets) if differences is None else max(len(sets), 1 + max(DIFFERENCE_COLOURS.values())),
            legs="" if colouring is None else colouring.told,
            belief=seen is not None,
            doubts=bool(marks),
        ),
        f'<rect class="paper" width="{width}" height="{{height}}" rx="6"/>',
        *_heading(title),
        *_ground(page),
        *[part for k, (_, x) in enumerate(sets) if isinstance(x, Region) for part in _region(page, k, x)],
        *(_edges(page, differences) if colouring is None else []),
        *[part for k, (_, x) in enumerate(sets) if isinstance(x, Region) for part in _outline(page, k, x)],
        *[part for k, (_, x) in enumerate(sets) if isinstance(x, Line) for part in _line(page, k, x)],
        *([] if colouring is None else _classed_edges(page, colouring)),
        *_vertices(page, differences),
        *[part for k, (_, x) in enumerate(sets) if isinstance(x, Point) for part in _point(page, k, x)],
        *([] if seen is None else _spots(page, seen)),
        *_doubted(page, marks),
        *([] if differences is None else _differing(page, differences)),
    ]
    if shown or differences is not None or (seen is not None and seen.names):
        names: dict[int, str] = dict(enumerate(drawing.plane.vertex_names)) if shown else {}
        least = 7.0 if any(isinstance(x, Point) for _, x in sets) else page.dot
        radii: dict[int, float] = {mark.vertex: _ring_radius(page) for mark in marks}
        if seen is not None:
            names |= {spot.vertex: seen.text(spot) for spot in seen.spots} if shown else seen.names
            radii |= {spot.vertex: spot.radius + page.dot + 1.0 for spot in seen.spots}
        if differences is not None:
            every = differences.n_places <= LABELS_UP_TO
            names = {v: text for v, text in differences.names.items() if every or v in differences.marked}
            radii |= dict.fromkeys(differences.marked, _ring_radius(page) + 3.0)
        if names:
            body += _names(page, names, np.array([max(page.dot, least, radii.get(v, 0.0)) for v in names]))
    legend, height = _legend(page, sets, colouring, seen, marks, doubt_sentences(said), differences)
    body += legend
    name = _escaped(title or repr(drawing.plane))
    text = "\n".join(body).replace("{height}", f"{height:.0f}", 1)
    size = f'width="{width}" height="{height:.0f}" viewBox="0 0 {width} {height:.0f}"'
    root = f'xmlns="http://www.w3.org/2000/svg" class="ninefold-{theme}" {size} role="img" aria-label="{name}"'
    return f'<svg {root} font-family="{_FONT}">\n<title>{name}</title>\n{text}\n</svg>\n'


def leg_colouring(drawing: Drawing, *, rigidity: bool | Rigidity, health: bool | Health) -> LegColouring | None:
    """Return how the legs are coloured, None for all alike.

    Raises
    ------
    BadInput, DifferentMaps
        For both at once, a map without headings, what is of another map.
    """
    if rigidity and health:
        raise BadInput("a leg has one colour: draw by rigidity or by health, not by both")
    fixed, found = rigidity_of(drawing.plane, rigidity), health_of(drawing.plane, health)
    if fixed is not None:
        return rigidity_colouring(fixed, drawing.layout)
    return None if found is None else health_colouring(found)


def named_sets(drawing: Drawing, highlight: Mapping[str, Set] | Iterable[Set] | Set | None) -> list[tuple[str, Set]]:
    """Return the highlighted sets with the names the legend gives them, checked against the drawing's map.

    Without sets given, those that the drawing itself highlights.

    Raises
    ------
    BadInput, DifferentMaps
        For more sets than colours, things that are no sets, sets of another map.
    """
    match highlight:
        case None:
            pairs = list(drawing.highlight)
        case Point() | Line() | Region():
            pairs = [("X", highlight)]
        case Mapping():
            pairs = [(str(name), x) for name, x in highlight.items()]
        case _ if isinstance(highlight, str) or not isinstance(highlight, Iterable):
            raise BadInput(f"highlight takes sets of the map, as in highlight=[room], not {quoted(highlight)}; {_PARSE}")
        case _:
            pairs = list(zip("XYZABCDEFGHIJKLMNOPQRSTUVW", highlight, strict=False))
    if len(pairs) > len(ROLES):
        raise BadInput(f"a picture has {len(ROLES)} colours to tell apart, and {len(pairs)} sets were given; draw fewer")
    for _, x in pairs:
        if not isinstance(x, Point | Line | Region):
            raise BadInput(f"only points, lines and regions of the map can be highlighted, not {quoted(x)}; {_PARSE}")
        drawing.require_mine(x)
    return pairs


class _Page:
    """The frame of the picture and the way from map coordinates to pixels."""

    def __init__(self, drawing: Drawing, width: int, title: str | None, n_shown: int | None = None) -> None:
        """Make room for the first `n_shown` vertices and what joins them; left out, for all."""
        self.drawing = drawing
        self.width = width
        self.top = 54.0 if title else 0.0
        corners = _corners(drawing, n_shown).astype(np.float64)
        self._shear = np.array([[1.0, 0.0], [0.5, 0.75**0.5]]) if drawing.layout == "schnyder" else np.eye(2)
        corners = corners @ self._shear
        low, high = corners.min(axis=0), corners.max(axis=0)
        room = np.array([width - 2 * _PAD, 0.85 * width - 2 * _PAD])
        extent = high - low
        flat = extent <= 0
        self._scale = float((room / np.where(flat, 1.0, extent))[~flat].min()) if not flat.all() else 1.0
        used = extent * self._scale
        self.bottom = self.top + 2 * _PAD + max(float(used[1]), 24.0)
        self._low, self._origin = low, np.array([(width - used[0]) / 2, self.bottom - _PAD - max(0.0, (24 - used[1]) / 2)])
        n = max(drawing.plane.n_vertices, 1)
        self.stroke = float(np.clip(14 / n**0.4, 0.35, 1.8))
        self.band = 0.0  # width of lines and outlines that lie below coloured edges; 0 where they lie on top
        self.dot = float(np.clip(20 / n**0.45, 0.6, 4.5))

    def place(self, xy: NDArray[Any]) -> NDArray[np.float64]:
        """Map coordinates (k, 2) to pixels, y downwards."""
        at = (xy.astype(np.float64) @ self._shear - self._low) * self._scale
        return np.asarray(self._origin + at * (1.0, -1.0))

    def path(self, xy: NDArray[Any], *, closed: bool = False) -> str:
        """Path data of a polyline in map coordinates."""
        steps = " ".join(f"{x:.2f},{y:.2f}" for x, y in self.place(xy).tolist())
        return f"M{steps}{'Z' if closed else ''}"

    def rings(self, region: Region) -> str:
        """Path data of a region, for the even-odd rule."""
        return "".join(self.path(ring, closed=True) for part in region_rings(self.drawing, region) for ring in part)


def _corners(drawing: Drawing, n_shown: int | None) -> NDArray[Any]:
    """Return the points that the picture has to hold, (N, 2)."""
    if n_shown is None:
        return np.concatenate([drawing.points, drawing.bends])
    between = (drawing.plane.tail.reshape(-1, 2) < n_shown).all(axis=1)
    return np.concatenate([drawing.points[:n_shown], drawing.bends[np.repeat(between, np.diff(drawing.bend_start))]])


def _escaped(text: str) -> str:
    """Return text that is safe in XML content and attributes; characters XML cannot hold become U+FFFD."""
    kept = _UNFIT.sub("\ufffd", text)
    for plain, entity in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;"), ("'", "&#39;"), ("{", "&#123;")):
        kept = kept.replace(plain, entity)
    return kept


def _defs(theme: str, used: int, *, legs: str, belief: bool, doubts: bool) -> str:
    hatches = "".join(
        f'<pattern id="ninefold-hatch-{k}" width="7" height="7" patternUnits="userSpaceOnUse" '
        f'patternTransform="rotate({_HATCH[k]})">'
        f'<path class="s{k}" d="M0,3.5H7" stroke-width="1.1" stroke-opacity="0.55"/></pattern>'
        for k in range(used)
        if _HATCH[k] is not None
    )
    return (
        f"<style>{style_sheet(theme, used, legs=legs, belief=belief, doubts=doubts)}</style>"
        f"{f'<defs>{hatches}</defs>' if hatches else ''}"
    )


def _heading(title: str | None) -> list[str]:
    if not title:
        return []
    return [f'<text class="ink" x="{_PAD:g}" y="38" font-size="19" font-weight="600">{_escaped(title)}</text>']


def _ground(page: _Page) -> list[str]:
    plane = page.drawing.plane
    bounded = [f for f in range(plane.n_faces) if f != plane.outer_face]
    if not bounded:
        return []
    return [f'<path class="land" fill-rule="evenodd" d="{page.rings(plane.region(bounded))}"/>']


def _region(page: _Page, k: int, x: Region) -> list[str]:
    d = page.rings(x)
    parts = [f'<path class="f{k}" fill-opacity="0.26" fill-rule="evenodd" d="{d}"/>']
    if _HATCH[k] is not None:
        parts.append(f'<path fill="url(#ninefold-hatch-{k})" fill-rule="evenodd" d="{d}"/>')
    return parts


def _outline(page: _Page, k: int, x: Region) -> list[str]:
    broad = page.band or float(np.clip(2.6 * (300 / page.drawing.plane.n_vertices) ** 0.25, 1.0, 2.6))
    shape = f'fill="none" stroke-width="{broad:.2f}" stroke-dasharray="{_DASH[k]}" stroke-linejoin="round"{_faded(page)}'
    return [f'<path class="s{k}" {shape} d="{page.rings(x)}"/>']


def _line(page: _Page, k: int, x: Line) -> list[str]:
    d = "".join(page.path(page.drawing.path(e)) for e in x.edges)
    broad = max(4.2, 2.4 * page.stroke, 1.4 * page.band)
    shape = f'fill="none" stroke-linecap="round" stroke-linejoin="round" d="{d}"'
    return [
        f'<path class="halo" stroke-width="{broad + 2.4:.2f}" {shape}/>',
        f'<path class="s{k}" stroke-width="{broad:.2f}"{_faded(page)} {shape}/>',
    ]


def _faded(page: _Page) -> str:
    return ' stroke-opacity="0.45"' if page.band else ""


def _edges(page: _Page, differences: Differences | None) -> list[str]:
    plane = page.drawing.plane
    real = np.flatnonzero(~plane.tether).tolist()
    ends: list[str] = []
    if differences is not None:
        unknown = plane.tail.reshape(-1, 2).max(axis=1) >= differences.n_places
        ends = _ends(page, np.flatnonzero(unknown).tolist(), differences.n_places)
        real = np.flatnonzero(~plane.tether & ~unknown).tolist()
    shape = f'class="edge" fill="none" stroke-width="{page.stroke:.2f}" stroke-linecap="round" stroke-linejoin="round"'
    lines = [page.path(page.drawing.path(e)) for e in real]
    if len(real) > TIPS_UP_TO:
        return [f'<path {shape} d="{"".join(lines)}"/>']
    tips = (f'<path d="{d}"><title>{_escaped(plane.edge_names[e])}</title></path>' for e, d in zip(real, lines, strict=True))
    return [*ends, *([f"<g {shape}>{''.join(tips)}</g>"] if lines else [])]


def _ends(page: _Page, edges: list[int], n_places: int) -> list[str]:
    """Return ways that nobody walked: from each place a short dashed way."""
    steps = []
    for e in edges:
        line = page.place(page.drawing.path(e))
        if page.drawing.plane.tail[2 * e] >= n_places:
            line = line[::-1]
        along = line[1] - line[0]
        long = float(np.hypot(*along))
        end = line[0] + along / max(long, 1e-9) * min(max(long, page.dot + 7.0), page.dot + 17.0)
        steps.append("M{:.2f},{:.2f} {:.2f},{:.2f}".format(*line[0], *end))
    look = f'stroke-width="{page.stroke:.2f}" stroke-dasharray="3 2.6"'
    return [f'<path class="edge" fill="none" {look} d="{"".join(steps)}"/>'] if steps else []


def _classed_edges(page: _Page, colouring: LegColouring) -> list[str]:
    """Return the edges, a group for each class; beyond `TIPS_UP_TO` one path for each."""
    plane = page.drawing.plane
    parts = []
    for kind in colouring.classes:
        shape = f'class="{kind.name}" fill="none" {_leg_look(kind.name, page.stroke)}'
        lines = [page.path(page.drawing.path(e)) for e in kind.edges]
        whole = "".join(lines)
        if kind.name == "contradicted":
            wide = _leg_width(kind.name, page.stroke) + 2.0
            parts.append(f'<path class="halo" fill="none" stroke-width="{wide:.2f}" stroke-linejoin="round" d="{whole}"/>')
        if plane.n_edges > TIPS_UP_TO:
            parts.append(f'<path {shape} d="{whole}"/>')
            continue
        tips = (
            f'<path d="{d}"><title>{_escaped(f"{plane.edge_names[e]}: {colouring.tip(kind, e)}")}</title></path>'
            for e, d in zip(kind.edges, lines, strict=True)
        )
        parts.append(f"<g {shape}>{''.join(tips)}</g>")
    return parts


def _leg_width(name: str, stroke: float) -> float:
    if name.startswith("closing"):
        return max(1.2, 1.3 * stroke) * (1 + 0.2 * int(name.removeprefix("closing")))
    return stroke if name == "evened" else max(4.0, 3 * stroke) if name == "contradicted" else max(1.4, 1.5 * stroke)


def _leg_look(name: str, stroke: float) -> str:
    if name != "evened":
        return f'stroke-width="{_leg_width(name, stroke):.2f}" stroke-linecap="round" stroke-linejoin="round"'
    dash = f"{max(2.5, 3.5 * stroke):.1f} {max(1.5, 2 * stroke):.1f}"
    return f'stroke-width="{_leg_width(name, stroke):.2f}" stroke-dasharray="{dash}" stroke-linejoin="round"'


def _vertices(page: _Page, differences: Differences | None) -> list[str]:
    plane = page.drawing.plane
    at = page.place(page.drawing.points).tolist()
    if differences is not None:
        at = at[: differences.n_places]
    if plane.n_edges > TIPS_UP_TO:
        return []
    rim = min(1.2, page.dot / 3)
    dots = (
        f'<circle cx="{x:.2f}" cy="{y:.2f}" r="{page.dot:.2f}"><title>{_escaped(plane.vertex_names[v])}</title></circle>'
        for v, (x, y) in enumerate(at)
    )
    return [f'<g class="dot" stroke-width="{rim:.2f}">{"".join(dots)}</g>']


def _point(page: _Page, k: int, x: Point) -> list[str]:
    cx, cy = page.place(page.drawing.points[[x.index]])[0].tolist()
    r = max(6.0, page.dot + 2)
    return [
        f'<circle class="halo" fill="none" cx="{cx:.2f}" cy="{cy:.2f}" r="{r + 1.6:.2f}" stroke-width="1.8"/>',
        f'<circle class="f{k}" cx="{cx:.2f}" cy="{cy:.2f}" r="{r:.2f}"><title>{_escaped(x.name)}</title></circle>',
    ]


def _ring_radius(page: _Page) -> float:
    return max(7.0, page.dot + 3.0)


def _doubted(page: _Page, marks: tuple[DoubtMark, ...]) -> list[str]:
    """Return a numbered ring for every place where something is undecided."""
    at = page.place(page.drawing.points).tolist()
    radius = _ring_radius(page)
    rings, numbers = [], []
    for mark in marks:
        x, y = at[mark.vertex]
        number = ",".join(map(str, mark.numbers))
        tip = _escaped("; ".join(mark.words))
        rings.append(f"<g><title>{tip}</title>{ring(mark.kind, x, y, radius)}</g>")
        numbers.append(f'<text x="{x + radius + 1:.1f}" y="{y - radius + 2:.1f}">{number}</text>')
    look = 'font-size="11.5" font-weight="600" stroke-width="3" stroke-linejoin="round" paint-order="stroke"'
    return [*rings, f'<g class="name" {look}>{"".join(numbers)}</g>'] if marks else []


def _differing(page: _Page, differences: Differences) -> list[str]:
    """Return a mark for every place that is not one of the best map."""
    at = page.place(page.drawing.points).tolist()
    return [difference_mark(kind, at[v][0], at[v][1], _ring_radius(page)) for v, kind in differences.marked.items()]


def _spots(page: _Page, seen: Belief) -> list[str]:
    """Return the marks of where a robot can be, the likeliest on top."""
    at = page.place(page.drawing.points[[spot.vertex for spot in seen.spots]]).tolist()
    marks = [
        f'<circle class="belief{spot.step}" cx="{x:.2f}" cy="{y:.2f}" r="{page.dot + spot.radius:.2f}">'
        f"<title>{_escaped(seen.text(spot))}</title></circle>"
        for spot, (x, y) in zip(seen.spots, at, strict=True)
    ]
    return [f'<g class="spot" stroke-width="{min(1.4, page.dot):.2f}">{"".join(reversed(marks))}</g>']


def _names(page: _Page, named: Mapping[int, str], radii: NDArray[np.float64]) -> list[str]:
    """Return the names of some vertices, clear of their dots and marks, whose radii are given in pixels."""
    pieces, _ = page.drawing.pieces
    drawn = np.concatenate([page.place(pieces[:, :2]), page.place(pieces[:, 2:])], axis=1)
    size = 11.0 if len(named) > 25 else 13.0
    placed = place_labels(
        [text if len(text) <= 24 else f"{text[:23]}\N{HORIZONTAL ELLIPSIS}" for text in named.values()],
        page.place(page.drawing.points[list(named)]),
        drawn,
        size=size,
        dot=radii,
        frame=(2.0, page.top + 2.0, page.width - 2.0, page.bottom - 2.0),
    )
    leaders = "".join("M{:.1f},{:.1f} {:.1f},{:.1f}".format(*label.leader) for label in placed if label.leader)
    texts = "".join(
        f'<text x="{label.x:.1f}" y="{label.y + 0.35 * size:.1f}">{_escaped(label.text)}</text>' for label in placed
    )
    parts = [f'<path class="leader" fill="none" stroke-width="0.7" d="{leaders}"/>'] if leaders else []
    look = 'text-anchor="middle" stroke-width="3" stroke-linejoin="round" paint-order="stroke"'
    return [*parts, f'<g class="name" font-size="{size:g}" {look}>{texts}</g>']


def _legend(
    page: _Page,
    sets: list[tuple[str, Set]],
    colouring: LegColouring | None,
    seen: Belief | None,
    marks: tuple[DoubtMark, ...],
    doubted: list[str],
    differences: Differences | None,
) -> tuple[list[str], float]:
    """The legend and the caption below the map; and the height of the whole picture."""
    parts, x, y = [], _PAD, page.bottom + 16.0
    entries: list[tuple[Callable[[float, float], str], str]] = [
        (partial(_swatch, k, s), f"{name}: {_kind(s)}") for k, (name, s) in enumerate(sets)
    ]
    if colouring is not None and colouring.told == "rigidity":
        entries += [(partial(_leg_swatch, kind.name), kind.words) for kind in colouring.classes]
    entries += [] if seen is None else [(partial(_spot_swatch, step), words) for step, words in seen.entries]
    entries += [(partial(_ring_swatch, kind), words) for kind, words in doubt_words(marks)]
    entries += (
        [] if differences is None else [(partial(_differing_swatch, kind), words) for kind, words in differences.entries]
    )
    for swatch, text in entries:
        wide = 30 + text_width(text, 13) + 22
        if x > _PAD and x + wide > page.width - _PAD:
            x, y = _PAD, y + 24
        parts.append(swatch(x, y))
        parts.append(f'<text class="ink" x="{x + 30:.1f}" y="{y + 4.5:.1f}" font-size="13">{_escaped(text)}</text>')
        x += wide
    if entries:
        y += 26
    if colouring is not None and colouring.told == "health":
        parts += health_scale(_PAD, y, page.width - 2 * _PAD, colouring)
        y += 70
    layout = page.drawing.layout
    caption = [_counts(page.drawing), "as on the ground" if layout == "ground" else f"{layout} layout", *page.drawing.notes]
    if differences is not None:
        caption = [differences.caption, *page.drawing.notes]
    if colouring is not None:
        caption.append(colouring.caption)
    if seen is not None:
        caption.append(seen.caption.replace(" %", "\N{NO-BREAK SPACE}%"))
    for line in _wrapped("; ".join(caption), (page.width - 2 * _PAD) / (12 * 0.58)):
        parts.append(f'<text class="faint" x="{_PAD:g}" y="{y + 4:.1f}" font-size="12">{_escaped(line)}</text>')
        y += 16
    for sentence in doubted:
        for line in _wrapped(sentence, (page.width - 2 * _PAD) / (12 * 0.58)):
            parts.append(f'<text class="ink" x="{_PAD:g}" y="{y + 6:.1f}" font-size="12">{_escaped(line)}</text>')
            y += 16
    return parts, y + 6


def _ring_swatch(kind: str, x: float, y: float) -> str:
    return ring(kind, x + 11, y, 7.0)


def _differing_swatch(kind: str, x: float, y: float) -> str:
    return difference_mark(kind, x + 11, y, 7.0)


def _leg_swatch(name: str, x: float, y: float) -> str:
    way = f"M{x + 2:.1f},{y:.1f} {x + 20:.1f},{y:.1f}"
    return f'<path class="{name}" fill="none" {_leg_look(name, 1.6)} d="{way}"/>'


def _spot_swatch(step: int, x: float, y: float) -> str:
    return f'<circle class="belief{step}" cx="{x + 11:.1f}" cy="{y:.1f}" r="{8 - 1.5 * step:g}"/>'


def _swatch(k: int, s: Set, x: float, y: float) -> str:
    box = f'x="{x:.1f}" y="{y - 7:.1f}" width="22" height="14" rx="2"'
    match s:
        case Point():
            return f'<circle class="f{k}" cx="{x + 11:.1f}" cy="{y:.1f}" r="6"/>'
        case Line():
            way = f"M{x + 2:.1f},{y:.1f} {x + 20:.1f},{y:.1f}"
            return f'<path class="s{k}" stroke-width="4.2" stroke-linecap="round" d="{way}"/>'
        case Region():
            hatch = "" if _HATCH[k] is None else f'<rect fill="url(#ninefold-hatch-{k})" {box}/>'
            rim = f'<rect class="s{k}" fill="none" stroke-width="2" stroke-dasharray="{_DASH[k]}" {box}/>'
            return f'<rect class="f{k}" fill-opacity="0.26" {box}/>{hatch}{rim}'


def _kind(s: Set) -> str:
    match s:
        case Point():
            return f"vertex {s.name}"
        case Line():
            return f"line of {counted(len(s.edges), 'edge')}"
        case Region():
            return f"region of {counted(s.n_faces, 'face')}"


def _counts(drawing: Drawing) -> str:
    plane = drawing.plane
    parts = [counted(plane.n_vertices, "vertex", "vertices"), counted(plane.n_edges, "edge"), counted(plane.n_faces, "face")]
    if plane.n_components > 1:
        parts.append(counted(plane.n_components, "component"))
    return ", ".join(parts)


def _wrapped(text: str, most: float) -> list[str]:
    lines, line = [], ""
    for word in text.split(" "):
        if line and len(line) + 1 + len(word) > most:
            lines.append(line)
            line = word
        else:
            line = f"{line} {word}".strip()
    return [*lines, line]
