# SPDX-License-Identifier: Apache-2.0
"""Requirements that are tested with one polarity only."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.item import Item
from mamori_trace.model.project import Project
from mamori_trace.model.verdict import list_uncovered_polarities

RULE = Rule(
    "polarity-missing", ERROR, "Each demanded polarity is shown by a test; a protective requirement has a violation test."
)


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for item in project.live_items:
        level = project.schema.levels[item.level]
        if not item.approved or "test" not in item.verify or level.from_children:
            continue
        children = project.children_of.get(item.id, []) if level.through_children else []
        if children or _is_named(project, item):  # another rule reports an item that no test names
            for polarity in list_uncovered_polarities(project, item, children):
                yield item.find_place("Polarity"), f"{item.id} demands a {polarity} test and has none", item.id


def _is_named(project: Project, item: Item) -> bool:
    return item.id in project.tests_of or item.id in project.results_of
