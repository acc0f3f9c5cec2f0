# SPDX-License-Identifier: Apache-2.0
"""Items without a design link."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import OFF, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("design-missing", OFF, "An approved requirement links to the design that explains it.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for item in project.live_items:
        if item.approved and item.sil and item.whole and not item.design and project.schema.levels[item.level].shall:
            yield item.find_place("Design"), f"{item.id} has SIL {item.sil} and no design link", item.id
