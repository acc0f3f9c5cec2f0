# SPDX-License-Identifier: Apache-2.0
"""Evidence files that differ from their record.

@satisfies SWR-TRC-036      Design: docs/design/trace.md#records
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("evidence-altered", ERROR, "Every evidence file is, byte for byte, what was recorded when it was made.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for problem in project.problems:
        if problem.rule == RULE.id:
            yield problem.place, problem.message, problem.item
