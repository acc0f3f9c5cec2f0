# SPDX-License-Identifier: Apache-2.0
"""An id that is defined twice."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("duplicate-id", ERROR, "An id is defined once and never reused.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for item in project.all_items:
        first = project.items[item.id]
        if item is not first:
            yield item.place, f"{item.id} is defined a second time; the first is at {first.place}", item.id
    seen: dict[str, Place] = {}
    for case in project.evidence.cases:
        if case.id in seen:
            yield case.place, f"campaign case {case.id} occurs twice", ""
        seen[case.id] = case.place
