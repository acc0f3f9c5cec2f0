# SPDX-License-Identifier: Apache-2.0
"""Requirements without a parent."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("parent-missing", ERROR, "Every requirement and assumption of use has a parent.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for item in project.live_items:
        wanted = project.schema.levels[item.level].parents
        if wanted and item.whole and not item.parents:
            levels = " or ".join(wanted)
            yield item.find_place("Parents"), f"{item.id} has no parent; it needs one of level {levels}", item.id
