# SPDX-License-Identifier: Apache-2.0
"""Requirements that no test names."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("test-missing", ERROR, "Every approved item with Verify: test is named by a test, or refined by items that are.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for item in project.live_items:
        level = project.schema.levels[item.level]
        if not item.approved or "test" not in item.verify or level.from_children:
            continue
        if level.through_children and item.id in project.children_of:
            continue
        if item.id not in project.tests_of and item.id not in project.results_of:
            yield item.find_place("Verify"), f"{item.id} demands a test and none names it", item.id
