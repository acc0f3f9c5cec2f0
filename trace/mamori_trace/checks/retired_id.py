# SPDX-License-Identifier: Apache-2.0
"""Ids of retired items that are still named."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.checks.unknown_id import list_references
from mamori_trace.model.project import Project

RULE = Rule("retired-id", ERROR, "Nothing names a retired item.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    if not any(item.retired for item in project.items.values()):
        return
    for place, who, named in list_references(project):
        item = project.items.get(named)
        if item is not None and item.retired:
            user = project.items.get(who)
            if user is None or not user.retired:
                yield place, f"{who} names {named}, which is retired ({item.place})", named
