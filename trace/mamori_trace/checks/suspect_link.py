# SPDX-License-Identifier: Apache-2.0
"""Links whose ends changed since the last review."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("suspect-link", ERROR, "Both ends of a parent link are as they were when it was last reviewed.")

LOCK = "requirements/trace.lock"


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for problem in project.problems:  # revisions in the ids of an external format
        if problem.rule == RULE.id:
            yield problem.place, problem.message, problem.item
    links = [
        (item, parent)
        for item in project.live_items
        for parent in item.parents
        if parent in project.items and item.whole
    ]
    if project.lock is None:
        if links and project.review_needed:
            message = f"is missing: none of the {len(links)} links was reviewed; record it with `{project.review_command} --all`"
            yield Place(LOCK, 1), message, ""
        return
    for item, parent in links:
        suspicion = project.lock.describe_suspicion(item.id, parent, project.fingerprints)
        if suspicion:
            cure = f"look again, then `{project.review_command} {item.id}`"
            yield item.find_place("Parents"), f"{suspicion}; {cure}", item.id
