# SPDX-License-Identifier: Apache-2.0
"""Results that this host cannot produce.

@satisfies SWR-TRC-101      Design: docs/design/trace.md#not-shown-here
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, WARNING, Place, Rule
from mamori_trace.model.evidence import NOT_SHOWN
from mamori_trace.model.project import Project

RULE = Rule("result-not-shown", WARNING, "Every test that verifies a requirement reaches a verdict on this host.", release=ERROR)


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for result in project.results:
        if result.status == NOT_SHOWN and result.requirement:
            reason = " ".join(result.message.split()) or "no reason given"
            message = f"test {result.title} ({result.requirement}) is not shown on this host: {reason}"
            yield result.source or result.place, message, result.requirement
