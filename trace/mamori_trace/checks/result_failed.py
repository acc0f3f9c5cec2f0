# SPDX-License-Identifier: Apache-2.0
"""Tests and campaign cases that failed."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.evidence import FAILED, CampaignCase
from mamori_trace.model.project import Project

RULE = Rule("result-failed", ERROR, "Every executed test and campaign case passed.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for result in project.results:
        if result.failing:
            about = f" ({result.requirement})" if result.requirement else ""
            word = "failed" if result.status == "failed" else "ended in an error"
            message = result.message.strip().partition("\n")[0]
            yield result.source or result.place, f"test {result.title}{about} {word}: {message}", result.requirement
    for case in project.evidence.cases:
        if case.status == FAILED:
            yield case.place, f"campaign case {case.id} failed: {_describe(case)}", next(iter(case.requirements), "")


def _describe(case: CampaignCase) -> str:
    """Expected and measured value; only the verdict if every check passed."""
    parts = [
        f"{check.get('name')}: wanted {check.get('wanted')}, measured {check.get('measured')}" for check in case.failed_checks
    ]
    return "; ".join(parts) or f"its verdict is {case.verdict!r} though every check passed"
