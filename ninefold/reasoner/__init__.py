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
    from .conflicts import Conflict, conflict
    from .consistency import Consistent, Inconsistent, Unknown, Verdict, check
    from .enumeration import Count, count, scenarios, some_scenario
    from .explanation import Explanation, explain
    from .inference import Inference, MinimalNetwork, entails, infer, minimal
    from .knowledge import Contradiction, KnowledgeBase
    from .network import Constraints, Network, Statement
    from .proofs import Proof, prove
    from .questions import Answer, ask
    from .repairs import Repair, repair
    from .scenario import Scenario

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
    "questions": ("Answer", "ask"),
    "consistency": ("Consistent", "Inconsistent", "Unknown", "Verdict", "check"),
    "conflicts": ("Conflict", "conflict"),
    "explanation": ("Explanation", "explain"),
    "inference": ("Inference", "MinimalNetwork", "entails", "infer", "minimal"),
    "knowledge": ("Contradiction", "KnowledgeBase"),
    "network": ("Constraints", "Network", "Statement"),
    "proofs": ("Proof", "prove"),
    "repairs": ("Repair", "repair"),
    "scenario": ("Scenario",),
    "enumeration": ("Count", "count", "scenarios", "some_scenario"),
}
_MODULE = {name: module for module, names in _HOME.items() for name in names}


def __getattr__(name: str) -> Any:
    if name not in _MODULE:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULE[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
