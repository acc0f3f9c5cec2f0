# SPDX-License-Identifier: Apache-2.0
"""Item blocks that violate the format."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("malformed-item", ERROR, "An item block keeps to the format of requirements/README.md.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for problem in project.problems:
        if problem.rule == RULE.id:
            yield problem.place, problem.message, problem.item
