"""``ninefold map WALK`` where headings err: the certain map, the doubts, or by request the likeliest map as a guess."""

from __future__ import annotations

from dataclasses import replace
from math import degrees, radians
from typing import TYPE_CHECKING, Any

from ninefold._wording import counted

from ._output import first_few, note, notes, print_json, progress

if TYPE_CHECKING:
    from collections.abc import Iterable
    from contextlib import AbstractContextManager
    from pathlib import Path

    from ninefold.io import Provenance
    from ninefold.mapping import Doubt, Estimate, PlaneMap, Walk

__all__ = ["doubts_as_json", "in_radians", "map_noisy_walk"]


def in_radians(given: float | None, option: str, most: float, *, nought: bool = False) -> float | None:
    """Return an option in degrees as radians.

    Raises
    ------
    BadInput
        If it is negative, no number, more than `most`, or 0 where that is not allowed.
    """
    from ninefold.errors import BadInput

    if given is None:
        return None
    if not (0 < given <= most or (nought and given == 0)):
        least = "from 0" if nought else "above 0 and at most"
        raise BadInput(
            f"{option} is a standard deviation in degrees, {least} {'to ' if nought else ''}{most:g}, not {given:g}"
        )
    return radians(given)


def map_noisy_walk(
    walk: Walk,
    out: Path,
    *,
    source: str,
    located: AbstractContextManager[None],
    provenance: Provenance,
    sigma: float | None,
    drift: float | None,
    best: bool,
    doubted: Iterable[str],
    force: bool,
    as_json: bool,
) -> int:
    """Estimate the map of a walk and keep it, if it is certain or `best` asks for a guess; return the exit code.

    Parameters
    ----------
    located
        A context in which errors about events name lines.
    sigma, drift
        Radians; left out, the header's.
    doubted
        Sentences on the walk's header.
    """
    from ninefold.errors import Undecided
    from ninefold.io import Atlas, Guess
    from ninefold.mapping import Walk, estimate

    with progress(f"estimating the map of {source}"), located:
        found = estimate(walk, sigma=sigma, drift=drift)
    if found.count == 0 or not (found.certain or best):
        notes(doubted)
        return _not_kept(found, source, as_json=as_json)
    guess = Guess.of(found)
    with progress(f"writing {out}"):
        try:
            plane = found.best
        except Undecided:  # too much is open for any map to be listed
            notes(doubted)
            return _not_kept(found, source, as_json=as_json)
        header = replace(walk.header, sigma=found.noise.sigma, drift=found.noise.drift or None)
        with Atlas.from_map(
            plane,
            out,
            provenance=provenance,
            warnings=found.warnings,
            guess=guess,
            walk=Walk(header, walk.events),
            force=force,
        ) as atlas:
            warnings = (*doubted, *atlas.warnings)
    if as_json:
        print_json({"file": str(out), **_sizes(plane), **_facts(found), "warnings": list(warnings)})
        return 0
    notes(first_few(warnings))
    sure = "certain" if guess is None else f"a guess, {_number(found)}"
    print(f"{out}: {repr(plane).removeprefix('PlaneMap(').removesuffix(')')}; {sure}{_scatter(found)}")
    return 0


def _not_kept(found: Estimate, source: str, *, as_json: bool) -> int:
    if as_json:
        print_json({"file": None, **_facts(found), "warnings": list(found.warnings)})
        return 1
    if found.count == 0:
        print(f"{source}: {found.doubts[0]}")
        return 1
    print(f"{source}: not certain, {_number(found)}{_scatter(found)}")
    lines = (f"{doubt}; {told}" if told else str(doubt) for doubt, told in zip(found.doubts, _told(found), strict=True))
    for line in first_few(lines):
        print(line)
    notes(found.warnings)
    if next(found.maps(), None) is None:
        note("no atlas was written; so much is open that no map is listed, and none is the likeliest")
    else:
        note("no atlas was written; --best keeps the likeliest map, marked as a guess")
    return 1


def _number(found: Estimate) -> str:
    if found.count is None or found.bits is None:
        return "more maps are left than were counted"
    return f"{counted(found.count, 'map')} {'is' if found.count == 1 else 'are'} left ({found.bits:.1f} bits)"


def _scatter(found: Estimate) -> str:
    if found.scatter is None:
        return ""
    declared, seen = degrees(found.noise.sigma), degrees(found.scatter)
    return f"; headings seem to err by {round(seen, 3):.2g} degrees, declared are {declared:.3g}"


def _told(found: Estimate) -> list[str]:
    return ["; ".join(map(str, found.more(doubt))) for doubt in found.doubts]


def _facts(found: Estimate) -> dict[str, Any]:
    return {
        "certain": found.certain,
        "count": found.count,
        "bits": found.bits,
        "sigma": degrees(found.noise.sigma),
        "drift": degrees(found.noise.drift),
        "scatter": None if found.scatter is None else degrees(found.scatter),
        "doubts": doubts_as_json(found.doubts, _told(found)),
    }


def doubts_as_json(doubts: Iterable[Doubt], more: Iterable[str]) -> list[dict[str, Any]]:
    """Return doubts, each with what would settle it, null where nothing would, as JSON values."""
    return [
        {
            "kind": doubt.kind,
            "places": list(doubt.places),
            "orders": [list(order) for order in doubt.orders],
            "text": doubt.text,
            "more": told or None,
        }
        for doubt, told in zip(doubts, more, strict=True)
    ]


def _sizes(plane: PlaneMap) -> dict[str, int]:
    return {
        "vertices": plane.n_vertices,
        "edges": plane.n_edges,
        "faces": plane.n_faces,
        "components": plane.n_components,
    }
