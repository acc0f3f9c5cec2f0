# SPDX-License-Identifier: Apache-2.0
"""Links that skip a level or point down."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("level-order", ERROR, "An item names a parent of the level above it, and none of its own level or below.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    circling = {item for cycle in project.cycles for item in cycle}  # reported by the rule on cycles
    for item in project.live_items:
        level = project.schema.levels[item.level]
        if item.id in circling or not item.parents:
            continue
        levels = {parent: key for parent in item.parents if (key := project.find_level_key(parent))}
        wrong = [parent for parent, key in levels.items() if key not in level.parents + level.also]
        for parent in wrong:
            allowed = ", ".join(level.parents + level.also) or "none"
            yield item.find_place("Parents"), f"{item.id} names {parent} as parent; allowed levels: {allowed}", item.id
        if not wrong and len(levels) == len(set(item.parents)) and level.parents and not set(levels.values()) & set(level.parents):
            above = " or ".join(level.parents)
            yield item.find_place("Parents"), f"{item.id} skips a level: none of its parents is a {above} item", item.id
