# SPDX-License-Identifier: Apache-2.0
"""Protective items that require no violation test."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import OFF, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("violation-not-demanded", OFF, "An approved item that answers a hazard, and is shown by execution, demands violation tests.")

_EXECUTED = {"test", "campaign"}
_VIOLATION = "violation"


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    levels = project.schema.levels
    for item in project.live_items:
        if not item.approved or not item.sil or not item.polarity or _VIOLATION in item.polarity or levels[item.level].from_children:
            continue
        hazards = [parent for parent in item.parents if parent in project.items and levels[project.items[parent].level].hazard]
        if hazards and _EXECUTED & set(item.verify):
            message = f"{item.id} answers {hazards[0]} at SIL {item.sil} and demands no violation test"
            yield item.find_place("Polarity"), message, item.id
