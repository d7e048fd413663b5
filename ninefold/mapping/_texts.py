"""Sets written as text: a form and names, or a JSON list where a name has a comma."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["written"]


def written(form: str, names: Sequence[str]) -> str:
    """Return the text that `ninefold.mapping.select.parse` reads back.

    Examples
    --------
    >>> written("line", ["@e1", "@e2"]), written("vertex", ["a, north"])
    ('line:@e1,@e2', '["vertex", "a, north"]')
    """
    if all("," not in name and name == name.strip() != "" for name in names):
        return f"{form}:{','.join(names)}"
    return json.dumps([form, *names], ensure_ascii=False)
