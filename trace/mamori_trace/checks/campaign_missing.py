# SPDX-License-Identifier: Apache-2.0
"""Requirements that the fault-injection campaign does not show."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule(
    "campaign-missing", ERROR, "Every approved item with Verify: campaign is named by a campaign case of each demanded polarity."
)


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    if project.allow_missing:
        return
    for item in project.live_items:
        if not item.approved or "campaign" not in item.verify or project.schema.levels[item.level].from_children:
            continue
        shown = {case.get_polarity(item.id) for case in project.cases_of.get(item.id, [])}
        missing = [polarity for polarity in item.polarity if polarity not in shown]
        if missing and not shown:
            yield item.find_place("Verify"), f"{item.id} demands a campaign case and none names it", item.id
        for polarity in missing if shown else ():
            yield item.find_place("Polarity"), f"{item.id} demands a {polarity} campaign case and has none", item.id
