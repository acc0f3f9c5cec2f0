# SPDX-License-Identifier: Apache-2.0
"""The content of a generated project, independent of its format."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

COMMIT = "0123456789abcdef0123456789abcdef01234567"
TOP, MIDDLE, BOTTOM = 0, 1, 2


@dataclass
class Requirement:
    """`level` is TOP, MIDDLE or BOTTOM. An empty text is omitted if the format permits that."""

    id: str
    level: int
    title: str
    statement: str
    parents: list[str] = field(default_factory=list)
    sil: str = "2"
    status: str = "approved"
    verify: str = "test"
    polarity: str = "nominal"
    design: str = "-"


@dataclass
class Code:
    """A function and the requirements that its tag names."""

    function: str
    requirements: list[str]


@dataclass
class Test:
    """A test, its requirement, and its outcome: passed, flaky, failed, error, skipped, disabled, or empty if it was not run."""

    __test__ = False

    suite: str
    name: str
    requirement: str
    outcome: str = "passed"
    technique: str = "requirements_based"
    result_only: bool = False
    result_requirement: str | None = None


@dataclass
class Plan:
    """`revisions` are the written ids that differ from the plan; `beside` are further files by name: lines, each with the key that
    finds it, or an empty one. `traced` requires an owner of each function; `coverage` requests a coverage file, in which the functions
    `unexecuted` were never called and those in `gaps` have an uncovered condition.
    """

    make_id: Callable[[int, int], str]
    requirements: list[Requirement] = field(default_factory=list)
    code: list[Code] = field(default_factory=list)
    tests: list[Test] = field(default_factory=list)
    broken_results: int = 0
    commit: str = COMMIT
    revisions: dict[str, str] = field(default_factory=dict)
    traced: bool = False
    coverage: bool = False
    unexecuted: list[str] = field(default_factory=list)
    gaps: list[str] = field(default_factory=list)
    beside: dict[str, list[tuple[str, str]]] = field(default_factory=dict)

    def find(self, requirement_id: str) -> Requirement:
        return next(each for each in self.requirements if each.id == requirement_id)

    def list_level(self, level: int) -> list[Requirement]:
        return [each for each in self.requirements if each.level == level]


def make_plan(make_id: Callable[[int, int], str], count: int) -> Plan:
    """A clean project: a tenth of the requirements on top, three tenths in the middle, the rest at the bottom with code and a passed
    test."""
    plan = Plan(make_id)
    tops, middles = max(count // 10, 1), max(count * 3 // 10, 1)
    bottoms = count - tops - middles
    for number in range(tops):
        plan.requirements.append(
            Requirement(make_id(TOP, number + 1), TOP, f"Need {number + 1}", f"Operators shall keep control of unit {number + 1}.")
        )
    for number in range(middles):
        parent = make_id(TOP, number % tops + 1)
        text = f"The system shall keep quantity {number + 1} within its limits."
        plan.requirements.append(Requirement(make_id(MIDDLE, number + 1), MIDDLE, f"Limit {number + 1}", text, [parent]))
    for number in range(bottoms):
        parent = make_id(MIDDLE, number % middles + 1)
        text = f"The software shall report value {number + 1} when it leaves its range."
        plan.requirements.append(Requirement(make_id(BOTTOM, number + 1), BOTTOM, f"Report {number + 1}", text, [parent]))
        plan.code.append(Code(f"report_{number + 1}", [make_id(BOTTOM, number + 1)]))
        plan.tests.append(Test(f"Report{number // 10}Test", f"ReportsValue{number + 1}", make_id(BOTTOM, number + 1)))
    return plan
