# SPDX-License-Identifier: Apache-2.0
"""Ids that were retired without a record."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("id-unrecorded", ERROR, "An id that is given up is recorded, so that it is never used again.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    """Reviewed links show which ids existed. Another rule reports an id that is still named as unknown."""
    if project.lock is None:
        return
    named = {parent for item in project.live_items for parent in item.parents}
    named |= project.tags_of.keys() | project.tests_of.keys() | project.results_of.keys() | project.cases_of.keys()
    told = {*project.items, *project.former_ids, *named}
    for key, line in project.lock.lines.items():
        for name in key:
            if name not in told:
                told.add(name)
                cure = f"`{project.review_command} {name}`"
                yield Place(project.lock.file, line), f"{name} is defined no more; record that its id is given up: {cure}", name
