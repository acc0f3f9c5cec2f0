# SPDX-License-Identifier: Apache-2.0
"""Unsuppressed findings of static analysis.

@satisfies SWR-TRC-043      Design: docs/design/trace.md#static-analysis
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("analysis-finding", ERROR, "Static analysis finds nothing that nobody suppressed with a reason.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for finding in project.evidence.analysis:
        yield finding.place, f"{finding.rule}: {finding.message}", ""
