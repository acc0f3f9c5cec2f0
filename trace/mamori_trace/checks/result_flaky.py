# SPDX-License-Identifier: Apache-2.0
"""Tests that passed only after a repetition.

@satisfies SWR-TRC-041      Design: docs/design/trace_formats.md#results-of-other-tools
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import WARNING, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("result-flaky", WARNING, "Every test that passed did so at its first try.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for result in project.results:
        if result.flaky:
            about = f" ({result.requirement})" if result.requirement else ""
            yield result.source or result.place, f"test {result.title}{about} failed, and passed when it was run again", result.requirement
