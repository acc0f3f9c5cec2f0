# SPDX-License-Identifier: Apache-2.0
"""Fault classes of functions and their coverage, and of removed ids."""

from __future__ import annotations

import random

from faulty.fault import Fault, Seed, pick
from faulty.plan import Code, Plan, Requirement

_NO_SIL = "the format has no word for a safety level"
_NO_LOCK = "revisions stand for a review lock, so nothing remembers the ids that there were"


def _functions_of(plan: Plan, requirements: list[Requirement]) -> list[str]:
    return [code.function for each in requirements for code in plan.code if each.id in code.requirements]


def untraced(plan: Plan, chance: random.Random) -> list[Seed]:
    plan.traced = True
    plan.code += [Code(f"surplus_{number}", []) for number in range(2)]
    return [(f"surplus_{number}", f"surplus_{number}", ("function",)) for number in range(2)]


def unexecuted(plan: Plan, chance: random.Random) -> list[Seed]:
    plan.traced = plan.coverage = True
    plan.unexecuted = _functions_of(plan, pick(plan, chance))
    return [(each, each, ("function",)) for each in plan.unexecuted]


def condition_open(plan: Plan, chance: random.Random) -> list[Seed]:
    chosen = pick(plan, chance)
    plan.coverage = True
    plan.gaps = _functions_of(plan, chosen)
    for each in chosen:
        each.sil, each.design = "3", "docs/design/generated.md#generated"
    return [(each.id, function, ("function",)) for each, function in zip(chosen, plan.gaps, strict=True)]


def dropped(plan: Plan, chance: random.Random) -> list[Seed]:
    """Removed after the review, with all references."""
    chosen = pick(plan, chance)
    gone = {each.id for each in chosen}
    plan.requirements = [each for each in plan.requirements if each.id not in gone]
    plan.code = [code for code in plan.code if not gone & set(code.requirements)]
    plan.tests = [test for test in plan.tests if test.requirement not in gone]
    return [(each.id, each.id, ("lock",)) for each in chosen]


CODE_FAULTS = {
    "untraced-function": Fault("untraced-function", untraced),
    "unexecuted-function": Fault("function-unexecuted", unexecuted, evidence=True),
    "condition-open": Fault("mcdc-gap", condition_open, {"oft": _NO_SIL}, evidence=True),
    "dropped": Fault("id-unrecorded", dropped, {"oft": _NO_LOCK}, reviewed=True),
}
