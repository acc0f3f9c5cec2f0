# SPDX-License-Identifier: Apache-2.0
"""Statements with no "shall" or several."""

from __future__ import annotations

import re
from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("shall-count", ERROR, "The statement of a requirement contains the word shall exactly once.")

_SHALL = re.compile(r"\bshall\b", re.IGNORECASE)


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for item in project.live_items:
        if project.schema.levels[item.level].shall and item.statement:
            count = len(_SHALL.findall(item.statement))
            if count != 1:
                place = Place(item.place.file, item.statement_line)
                yield place, f"the statement of {item.id} contains 'shall' {count} times instead of once", item.id
