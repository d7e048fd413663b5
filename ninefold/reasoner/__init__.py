"""Answers: exact relations between the sets of a map, and what follows from relations that were only declared.

**On a map** (`ninefold.reasoner.sets`). `relate` tells how one set lies to another, `relate_pairs` and `relate_all` do so in
bulk, and `containment_tree` orders regions by what is inside what. A `Relation` is a value: a matrix, a DE-9IM string and a
word.

**On declared relations** (`ninefold.reasoner.networks`). A `Network` collects statements. `check` decides whether they can
all be true, with a scenario or a proof (`prove` confirms it, `to_drat` writes it for other checkers); `conflict` finds a
minimal set that cannot, `explain` says why
in words; `infer`, `minimal` and `entails` tell what follows, `ask` answers Boolean questions, `repair` finds the cheapest
statements to drop, `scenarios` and `count` enumerate. The search behind them is `ninefold.reasoner.engine`.

A `KnowledgeBase` is the one bridge between the two: mapped sets and declared statements in one network.

The names load when they are first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ninefold._lazy import attach

if TYPE_CHECKING:
    from .knowledge import Contradiction, KnowledgeBase
    from .networks.clausal import ClausalProof, to_drat
    from .networks.conflicts import Conflict, conflict
    from .networks.consistency import Consistent, Inconsistent, Unknown, Verdict, check
    from .networks.enumeration import Count, count, scenarios, some_scenario
    from .networks.explanation import Explanation, explain
    from .networks.inference import Inference, MinimalNetwork, entails, infer, minimal
    from .networks.network import Constraints, Network
    from .networks.proofs import Proof, prove
    from .networks.questions import Answer, ask
    from .networks.repairs import Repair, repair
    from .networks.scenario import Scenario
    from .networks.statement import Statement
    from .sets.bulk import SetTable, relate_all, relate_pairs
    from .sets.nesting import containment_tree
    from .sets.relate import relate
    from .sets.relation import NAMES, RCC8_OF_NAME, Relation, converse_codes, de9im_strings, name_of_word, names_of

__all__ = [
    "NAMES",
    "RCC8_OF_NAME",
    "Answer",
    "ClausalProof",
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
    "to_drat",
]

__getattr__, __dir__ = attach(
    __name__,
    {
        "knowledge": ("Contradiction", "KnowledgeBase"),
        "networks.clausal": ("ClausalProof", "to_drat"),
        "networks.conflicts": ("Conflict", "conflict"),
        "networks.consistency": ("Consistent", "Inconsistent", "Unknown", "Verdict", "check"),
        "networks.enumeration": ("Count", "count", "scenarios", "some_scenario"),
        "networks.explanation": ("Explanation", "explain"),
        "networks.inference": ("Inference", "MinimalNetwork", "entails", "infer", "minimal"),
        "networks.network": ("Constraints", "Network"),
        "networks.proofs": ("Proof", "prove"),
        "networks.questions": ("Answer", "ask"),
        "networks.repairs": ("Repair", "repair"),
        "networks.scenario": ("Scenario",),
        "networks.statement": ("Statement",),
        "sets.bulk": ("SetTable", "relate_all", "relate_pairs"),
        "sets.nesting": ("containment_tree",),
        "sets.relate": ("relate",),
        "sets.relation": (
            "NAMES",
            "RCC8_OF_NAME",
            "Relation",
            "converse_codes",
            "de9im_strings",
            "name_of_word",
            "names_of",
        ),
    },
)
