# SPDX-License-Identifier: Apache-2.0
"""Items that are their own ancestors."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("cycle", ERROR, "No item is its own ancestor.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for cycle in project.cycles:
        ring = " -> ".join([*cycle, cycle[0]])
        for member in cycle:
            yield project.items[member].find_place("Parents"), f"{member} is its own ancestor: {ring}", member
