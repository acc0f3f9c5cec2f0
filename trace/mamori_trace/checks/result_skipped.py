# SPDX-License-Identifier: Apache-2.0
"""Tests that were skipped or disabled."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.evidence import SKIPPED
from mamori_trace.model.project import Project

RULE = Rule("result-skipped", ERROR, "No test that verifies a requirement is skipped or disabled.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for result in project.results:
        if result.status == SKIPPED and result.requirement:
            reason = result.message.strip().partition("\n")[0] or "no reason given"
            message = f"test {result.title} ({result.requirement}) was skipped: {reason}"
            yield result.source or result.place, message, result.requirement
