# SPDX-License-Identifier: Apache-2.0
"""Items of an integrated level that neither an integration test nor a campaign case names.

@satisfies SWR-TRC-113      Design: docs/design/trace.md#kinds-and-links
"""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import OFF, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("integration-missing", OFF, "An integration test or campaign case shows each demanded polarity of an integrated item.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    if project.allow_missing:  # campaign cases are evidence
        return
    for item in project.live_items:
        if not item.approved or not project.schema.levels[item.level].integrated:
            continue
        shown = {case.get_polarity(item.id) for case in project.cases_of.get(item.id, [])}
        shown |= {test.polarity for test in project.tests_of.get(item.id, []) if project.code_schema.is_integration(test.place.file)}
        for polarity in item.polarity:
            if polarity not in shown:
                yield item.find_place("Polarity"), f"{item.id} has no {polarity} integration test or campaign case", item.id
