# SPDX-License-Identifier: Apache-2.0
"""Tests without a result."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("result-missing", ERROR, "Every test that verifies a requirement was executed.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    if project.allow_missing:
        return
    shown = project.evidence.results_shown or f"{project.evidence.shown}/junit"
    for test in project.tests_without_result:
        if not test.name:
            message = f"no test is known at this tag of {test.requirement}; put the tag right above its test, or into its block"
            yield test.place, message, test.requirement
            continue
        message = f"test {test.title} ({test.requirement}) has no result in {shown}"
        yield test.place, message, test.requirement
    for test in project.tests:
        if not (test.name or test.by_comment) and test.requirement in project.items and test.requirement not in project.results_of:
            what = f"no test is known at this tag of {test.requirement}, and no result in {shown} names it"
            message = f"{what}; put the tag right above its test, or name the id in a property of the result"
            yield test.place, message, test.requirement
