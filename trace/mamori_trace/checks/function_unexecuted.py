# SPDX-License-Identifier: Apache-2.0
"""Traced functions that the tests of their requirements never enter.

@satisfies SWR-TRC-033      Design: docs/design/trace.md#coverage
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.code import Function
from mamori_trace.model.project import Project

RULE = Rule("function-unexecuted", ERROR, "The tests that verify its requirements execute every function of a traced layer.")

_HEADERS = (".hpp", ".h", ".ipp")
_IDS_MAX = 4


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    if not project.evidence.coverage_runs:
        return
    for function in project.traced_functions:
        if function.requirements:
            message = _judge(project, function)
            if message:
                yield function.place, f"{function.name} ({_name_owners(function)}) {message}", ""


def _judge(project: Project, function: Function) -> str:
    """The missing execution, in words. A header function without a counter is an unused template or evaluated only at compile time: tools
    cannot count it."""
    coverage = project.find_coverage(function.requirements)
    reached = coverage.measure(function)
    if reached.executed or reached.accepted:
        return ""
    if reached.functions_measured:
        by = "by any test" if coverage is project.coverage else "by a test that verifies these"
        return f"was never executed {by}"
    if project.coverage.measure(function).functions_measured:
        return "was never executed by a test that verifies these"
    return "" if function.file.endswith(_HEADERS) else "stands in no coverage file: no measured program holds it"


def _name_owners(function: Function) -> str:
    more = ", ..." if len(function.requirements) > _IDS_MAX else ""
    return ", ".join(function.requirements[:_IDS_MAX]) + more
