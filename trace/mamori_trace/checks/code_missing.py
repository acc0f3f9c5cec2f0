# SPDX-License-Identifier: Apache-2.0
"""Software requirements that no code names."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("code-missing", ERROR, "Code names every approved software requirement with @satisfies.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for item in project.live_items:
        if item.approved and project.schema.levels[item.level].needs_code and item.id not in project.tags_of:
            yield item.place, f"{item.id} is satisfied by no code: no @satisfies names it", item.id
