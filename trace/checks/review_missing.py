# SPDX-License-Identifier: Apache-2.0
"""Requirements whose review is not recorded."""

from __future__ import annotations

from collections.abc import Iterator

from mamori.trace.model.finding import ERROR, Place, Rule
from mamori.trace.model.project import Project

RULE = Rule("review-missing", ERROR, "An approved requirement with Verify: review or analysis has reviewed parent links in requirements/trace.lock.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    if project.lock is None:
        return  # told once by the rule on suspect links
    for item in project.live_items:
        methods = [method for method in item.verify if method in ("review", "analysis")]
        if not item.approved or not methods or project.schema.levels[item.level].from_children:
            continue
        named = any(child == item.id for child, _ in project.lock.reviews)
        if item.parents and not named:
            yield item.find_place("Verify"), f"{item.id} demands {methods[0]} and none is recorded", item.id
