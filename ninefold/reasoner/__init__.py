"""Answers: exact relations between the sets of a map, and what follows from relations that were only declared.

**On a map.** `relate` tells how one set lies to another, `relate_pairs` and `relate_all` do so in bulk, and
`containment_tree` orders regions by what is inside what. A `Relation` is a value: a matrix, a DE-9IM string and a word.

**On declared relations.** A `Network` collects statements. `check` decides whether they can all be true, with a scenario or
a proof (`prove` confirms it); `conflict` finds a minimal set that cannot, `explain` says why in words; `infer`, `minimal`
and `entails` tell what follows, `ask` answers Boolean questions, `repair` finds the cheapest statements to drop, `scenarios`
and `count` enumerate. A `KnowledgeBase` joins mapped sets and declared statements in one network.

The second half loads when it is first used, so that relating two sets starts fast.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .bulk import SetTable, relate_all, relate_pairs
from .nesting import containment_tree
from .relate import relate
from .relation import NAMES, RCC8_OF_NAME, Relation, converse_codes, de9im_strings, name_of_word, names_of

if TYPE_CHECKING:
    from .ask import Answer, ask
    from .check import Consistent, Inconsistent, Unknown, Verdict, check
    from .conflict import Conflict, conflict
    from .explain import Explanation, explain
    from .infer import Inference, MinimalNetwork, entails, infer, minimal
    from .knowledge import Contradiction, KnowledgeBase
    from .network import Constraints, Network, Statement
    from .prove import Proof, prove
    from .repair import Repair, repair
    from .scenario import Scenario
    from .scenarios import Count, count, scenarios, some_scenario

__all__ = [
    "NAMES",
    "RCC8_OF_NAME",
    "Answer",
    "Conflict",
    "Consistent",
    "Constraints",
    "Contradiction",
    "Count",
    "Explanation",
    "Inconsistent",
    "Inference",
    "KnowledgeBase",
    "MinimalNetwork",
    "Network",
    "Proof",
    "Relation",
    "Repair",
    "Scenario",
    "SetTable",
    "Statement",
    "Unknown",
    "Verdict",
    "ask",
    "check",
    "conflict",
    "containment_tree",
    "converse_codes",
    "count",
    "de9im_strings",
    "entails",
    "explain",
    "infer",
    "minimal",
    "name_of_word",
    "names_of",
    "prove",
    "relate",
    "relate_all",
    "relate_pairs",
    "repair",
    "scenarios",
    "some_scenario",
]

_HOME = {
    "ask": ("Answer", "ask"),
    "check": ("Consistent", "Inconsistent", "Unknown", "Verdict", "check"),
    "conflict": ("Conflict", "conflict"),
    "explain": ("Explanation", "explain"),
    "infer": ("Inference", "MinimalNetwork", "entails", "infer", "minimal"),
    "knowledge": ("Contradiction", "KnowledgeBase"),
    "network": ("Constraints", "Network", "Statement"),
    "prove": ("Proof", "prove"),
    "repair": ("Repair", "repair"),
    "scenario": ("Scenario",),
    "scenarios": ("Count", "count", "scenarios", "some_scenario"),
}
_MODULE = {name: module for module, names in _HOME.items() for name in names}


def __getattr__(name: str) -> Any:
    if name not in _MODULE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_MODULE[name]}"), name)
    globals()[name] = value  # the function, not the module of the same name that the import has just put here
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
