# SPDX-License-Identifier: Apache-2.0
"""Plan, case, check and evaluation: the data that the campaign engine knows of each subject.

A subject derives its own plan, scenario and case from these classes and adds its specific data.

@satisfies SWR-CMP-001      Design: docs/design/simulation.md#campaign-plan
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from mamori_trace.base.errors import InputError
from mamori_trace.base.marked_yaml import Node
from mamori_trace.base.nearest_names import nearest_names

Verdict = Literal["passed", "failed", "inconclusive"]
"""`inconclusive`: the host prevented a verdict, for example by preempting a real-time program."""


@dataclass(frozen=True)
class Check:
    """One line of a verdict, in words for readers."""

    name: str
    wanted: str
    measured: str
    passed: bool


@dataclass(frozen=True)
class Scenario:
    """One row of a plan. `requirements`: requirement id -> polarity of this scenario as its evidence."""

    name: str
    title: str
    requirements: Mapping[str, str]
    node: Node = field(repr=False, compare=False)

    @property
    def case_count(self) -> int:
        """Number of cases that the scenario expands to, at least 1."""
        return 1


@dataclass(frozen=True)
class Plan:
    """A complete plan. `subject` is the name of the subject that reads, runs and evaluates it."""

    path: Path
    subject: str
    seed: int
    scenarios: tuple[Scenario, ...]


@dataclass(frozen=True)
class Selection:
    """Scenarios of a plan, in its order. `instants`: number of cases of each scenario, from its first on; None: all."""

    plan: Plan
    scenarios: tuple[Scenario, ...]
    instants: int | None


@dataclass(frozen=True)
class Case:
    """One run of the program. `id` is unique in the plan, `<scenario>-<number from 1>`, and names the folder of the case."""

    id: str
    scenario: str
    title: str
    seed: int
    requirements: Mapping[str, str]


@dataclass(frozen=True)
class Evaluation:
    """Result of a case. `run` is the record of the program as a JSON value; empty if there is none.

    Equal cases give equal records: a record contains no path, and no wall time except the entry `wall_s`.
    """

    run: Mapping[str, Any]
    checks: tuple[Check, ...]
    verdict: Verdict


def conclude(checks: Sequence[Check]) -> Verdict:
    """`passed` if there is at least one check and each check passed, otherwise `failed`."""
    return "passed" if checks and all(check.passed for check in checks) else "failed"


def select(plan: Plan, names: Sequence[str] = (), instants: int | None = None) -> Selection:
    """Scenarios by name (all without names), with the first `instants` cases of each (all if None).

    Raises InputError for an unknown name (with the nearest ones), and if `instants` is below one or above the number in the plan.
    """
    known = [scenario.name for scenario in plan.scenarios]
    for name in names:
        if name not in known:
            raise InputError(f"unknown scenario '{name}'; {nearest_names(name, known)}; valid: {', '.join(known)}")
    if instants is not None and instants < 1:
        raise InputError(f"{instants} instants per scenario; write 1 or more")
    chosen = tuple(each for each in plan.scenarios if not names or each.name in names)
    most = max(each.case_count for each in chosen)
    if instants is not None and instants > most:
        raise InputError(f"{instants} instants per scenario; the plan has {most}: write 1 to {most}, or add instants to {plan.path}")
    return Selection(plan, chosen, instants)
