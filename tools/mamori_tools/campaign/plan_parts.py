# SPDX-License-Identifier: Apache-2.0
"""Parts common to the plans of all subjects: seed, scenarios, their names and requirements.

@satisfies SWR-CMP-001      Design: docs/design/simulation.md#campaign-plan
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from typing import TypeVar

from mamori_tools.campaign.case import Scenario
from mamori_trace.base.marked_yaml import Node
from mamori_trace.base.nearest_names import nearest_names

POLARITIES = ("nominal", "violation")

_NAME = re.compile(r"[a-z][a-z0-9_]*")
_REQUIREMENT = re.compile(r"(SYS|ARC|SWR-[A-Z]+)-\d{3}")

AnyScenario = TypeVar("AnyScenario", bound=Scenario)


def read_scenarios(root: Node, read_scenario: Callable[[Node], AnyScenario]) -> tuple[AnyScenario, ...]:
    """At least one scenario, each with a unique name. Like the other functions, raises InputError with file and line."""
    nodes = root.get("scenarios").as_list()
    if not nodes:
        raise root.get("scenarios").error("lists no scenario; add one")
    scenarios: dict[str, AnyScenario] = {}
    for node in nodes:
        scenario = read_scenario(node)
        if scenario.name in scenarios:
            raise node.get("name").error(f"'{scenario.name}' stands twice; rename one")
        scenarios[scenario.name] = scenario
    return tuple(scenarios.values())


def read_scenario_name(node: Node) -> str:
    name = node.get("name").as_text()
    if not _NAME.fullmatch(name):
        raise node.get("name").error(f"'{name}'; use small letters, digits and _, it becomes a folder name")
    return name


def read_name(node: Node, known: Sequence[str]) -> str:
    name = node.as_text()
    if name not in known:
        raise node.error(f"unknown '{name}'; {nearest_names(name, known)}")
    return name


def read_requirements(node: Node) -> dict[str, str]:
    """Requirement -> polarity of this scenario as its evidence."""
    found: dict[str, str] = {}
    for requirement, polarity in node.as_mapping().items():
        if not _REQUIREMENT.fullmatch(requirement):
            raise polarity.error(f"'{requirement}' is no requirement id; write SYS-nnn, ARC-nnn or SWR-<AREA>-nnn")
        found[requirement] = read_name(polarity, POLARITIES)
    if not found:
        raise node.error("names none; name what the scenario verifies")
    return found


def read_seed(node: Node) -> int:
    seed = node.as_int()
    if not 0 <= seed < 2**64:
        raise node.error(f"{seed}; write an integer from 0 to 2^64 - 1")
    return seed
