# SPDX-License-Identifier: Apache-2.0
"""Needs and hazards that no requirement refines."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("child-missing", ERROR, "Every need and hazard has a requirement that answers it.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for item in project.live_items:
        if project.schema.levels[item.level].needs_child and item.id not in project.children_of:
            yield item.place, f"{item.id} has no child: no requirement answers it", item.id
