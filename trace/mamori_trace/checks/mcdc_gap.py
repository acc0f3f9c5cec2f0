# SPDX-License-Identifier: Apache-2.0
"""Conditions in functions of the highest level whose independent effect no test shows.

@satisfies SWR-TRC-034      Design: docs/design/trace.md#coverage
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, OFF, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("mcdc-gap", ERROR, "Tests show each condition in a function of a SIL 3 item to decide alone, or the gap has a reason.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    if not project.evidence.coverage_runs:
        return
    demanding = {item.id for item in project.live_items if item.sil and project.pack.get_severity(RULE, item) != OFF}
    for function in project.functions:
        owners = [name for name in function.requirements if name in demanding]
        if not owners:
            continue
        for gap in project.find_coverage(owners).measure(function).gaps:
            if not gap.reason:
                yield gap.place, f"{function.name} ({owners[0]}, SIL {project.items[owners[0]].sil}): not shown: {gap.text}", owners[0]
