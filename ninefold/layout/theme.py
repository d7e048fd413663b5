"""Colours of the pictures, light and dark.

The role colours are the qualitative palette of Okabe and Ito, which readers with any of the common colour deficiencies can
tell apart; its yellow comes last, since it is weak on white, and its black is the map's own. Regions differ in hatching too,
so that a print in grey still tells them apart.

What the headings of a map fix has colours of its own, `FIXED`, so that sets can be highlighted on top: three for the largest
parts and one for all others, `EVENED` for legs that nothing measures, and `CONTRADICTED`, a red, for those that the rest
contradicts. They too stay apart for readers with any of the common deficiencies; the tests hold it by simulation.

The health of legs has a scale of its own, `CLOSING`: evenly spaced in lightness, so that its order is seen without the
hues and stays in a print in grey; on light ground the worst is darkest, on dark ground brightest.
Where a robot can be has the four colours of `BELIEF`, from the likeliest places on.

References
----------
M. Okabe and K. Ito, Color Universal Design, 2008.
"""

from __future__ import annotations

__all__ = ["BELIEF", "CLOSING", "CONTRADICTED", "DARK", "EVENED", "FIXED", "LIGHT", "ROLES", "THEMES", "style_sheet"]

THEMES = ("auto", "light", "dark")

ROLES = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#F0E442")
_ROLES_ON_DARK = ("#56B4E9", "#FF8A3D", "#2BC79A", "#E3A3C6", "#F2B632", "#9AD4F5", "#F0E442")

FIXED = {"light": ("#1450C4", "#2E9E63", "#7A1E6A", "#CA8411"), "dark": ("#5498FF", "#33E6A6", "#D9C8FF", "#FFCC33")}
EVENED = {"light": "#8C9199", "dark": "#7C848E"}
CONTRADICTED = {"light": "#B5150F", "dark": "#F2603A"}

CLOSING = {
    "light": ("#70C1BF", "#4CA9D0", "#588DD4", "#8369C1", "#A43B8E", "#A4064D", "#850821", "#601215"),
    "dark": ("#157376", "#0383AE", "#6F89D7", "#BA8CE2", "#FB8DD5", "#FEB1B8", "#FED0B3", "#FFEDB0"),
}
BELIEF = {"light": ("#8E0F3C", "#DD5A22", "#EFAF3A", "#A39C86"), "dark": ("#F0386B", "#FFA04A", "#FFE985", "#7F93A6")}

LIGHT = {"paper": "#FFFFFF", "land": "#F3F1EA", "edge": "#6B6F76", "ink": "#1E2227", "faint": "#6B6F76"}
DARK = {"paper": "#15181C", "land": "#23282E", "edge": "#9AA1AA", "ink": "#ECEFF2", "faint": "#9AA1AA"}


def _rules(
    scope: str, base: dict[str, str], roles: tuple[str, ...], legs: str, mode: str, *, belief: bool, doubts: bool
) -> str:
    rules = [
        f".paper{{fill:{base['paper']}}}",
        f".land{{fill:{base['land']}}}",
        f".edge{{stroke:{base['edge']}}}",
        f".dot{{fill:{base['edge']};stroke:{base['paper']}}}",
        f".halo{{stroke:{base['paper']}}}",
        f".ink{{fill:{base['ink']}}}",
        f".faint{{fill:{base['faint']}}}",
        f".name{{fill:{base['ink']};stroke:{base['paper']}}}",
        f".leader{{stroke:{base['faint']}}}",
    ]
    for k, colour in enumerate(roles):
        rules += [f".f{k}{{fill:{colour}}}", f".s{k}{{stroke:{colour}}}"]
    if legs == "rigidity":
        rules += [f".fixed{k}{{stroke:{colour}}}" for k, colour in enumerate(FIXED[mode])]
        rules += [f".evened{{stroke:{EVENED[mode]}}}", f".contradicted{{stroke:{CONTRADICTED[mode]}}}"]
    elif legs == "health":
        rules += [f".closing{k}{{stroke:{colour}}}" for k, colour in enumerate(CLOSING[mode])]
    if belief:
        rules += [f".spot{{stroke:{base['paper']}}}"]
        rules += [f".belief{k}{{fill:{colour}}}" for k, colour in enumerate(BELIEF[mode])]
    if doubts:
        rules.append(f".doubt{{stroke:{base['ink']}}}")
    return "".join(f"{scope} {rule}" for rule in rules)


def style_sheet(theme: str, used: int, *, legs: str = "", belief: bool = False, doubts: bool = False) -> str:
    """Return the CSS rules for a theme with `used` role colours; ``"auto"`` follows the reader's preference.

    With ``legs="rigidity"`` there are rules for what the headings fix: classes ``fixed0`` to ``fixed3``, ``evened``,
    ``contradicted``; with ``legs="health"`` for closing residuals: ``closing0`` to ``closing7``. With `belief` there are
    those for where a robot can be: ``spot``, and ``belief0`` to ``belief3``; with `doubts` one for ``doubt``.

    The rules hold inside an element of class ``ninefold-{theme}`` alone: style sheets of pictures set into one page reach
    the whole page.
    """
    scope = f".ninefold-{theme}"
    light = _rules(scope, LIGHT, ROLES[:used], legs, "light", belief=belief, doubts=doubts)
    dark = _rules(scope, DARK, _ROLES_ON_DARK[:used], legs, "dark", belief=belief, doubts=doubts)
    match theme:
        case "light":
            return light
        case "dark":
            return dark
        case _:
            return f"{light}@media (prefers-color-scheme:dark){{{dark}}}"
