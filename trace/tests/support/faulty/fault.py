# SPDX-License-Identifier: Apache-2.0
"""The parts of a fault class."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass, field

from faulty.plan import BOTTOM, Plan, Requirement

Seed = tuple[str, str, tuple[str, ...]]
"""(word that the finding must name, key of the place, candidate parts: the first one that the format writes is the place)."""


@dataclass(frozen=True)
class Fault:
    """`unstated`: formats that cannot represent the fault, and why. `reviewed`: the links are reviewed before the fault."""

    rule: str
    spoil: Callable[[Plan, random.Random], list[Seed]]
    unstated: dict[str, str] = field(default_factory=dict)
    reviewed: bool = False
    evidence: bool = False


def pick(plan: Plan, chance: random.Random, level: int = BOTTOM) -> list[Requirement]:
    """Two requirements without a common parent."""
    members = plan.list_level(level)
    first = chance.randrange(len(members))
    return [members[first], members[(first + 1) % len(members)]]
