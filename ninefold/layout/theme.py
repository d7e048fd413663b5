"""Colours of the pictures, light and dark.

The role colours are the qualitative palette of Okabe and Ito, which readers with any of the common colour deficiencies can
tell apart; its yellow comes last, since it is weak on white, and its black is the map's own. Regions differ in hatching too,
so that a print in grey still tells them apart.

References
----------
M. Okabe and K. Ito, Color Universal Design, 2008.
"""

from __future__ import annotations

__all__ = ["DARK", "LIGHT", "ROLES", "THEMES", "style_sheet"]

THEMES = ("auto", "light", "dark")

ROLES = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#F0E442")
_ROLES_ON_DARK = ("#56B4E9", "#FF8A3D", "#2BC79A", "#E3A3C6", "#F2B632", "#9AD4F5", "#F0E442")

LIGHT = {"paper": "#FFFFFF", "land": "#F3F1EA", "edge": "#6B6F76", "ink": "#1E2227", "faint": "#6B6F76"}
DARK = {"paper": "#15181C", "land": "#23282E", "edge": "#9AA1AA", "ink": "#ECEFF2", "faint": "#9AA1AA"}


def _rules(scope: str, base: dict[str, str], roles: tuple[str, ...], used: int) -> str:
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
    for k, colour in enumerate(roles[:used]):
        rules += [f".f{k}{{fill:{colour}}}", f".s{k}{{stroke:{colour}}}"]
    return "".join(f"{scope} {rule}" for rule in rules)


def style_sheet(theme: str, used: int) -> str:
    """Return the CSS rules for a theme with `used` role colours; ``"auto"`` follows the reader's preference.

    The rules hold inside an element of class ``ninefold-{theme}`` alone: style sheets of pictures set into one page reach
    the whole page.
    """
    scope = f".ninefold-{theme}"
    light, dark = _rules(scope, LIGHT, ROLES, used), _rules(scope, DARK, _ROLES_ON_DARK, used)
    match theme:
        case "light":
            return light
        case "dark":
            return dark
        case _:
            return f"{light}@media (prefers-color-scheme:dark){{{dark}}}"
