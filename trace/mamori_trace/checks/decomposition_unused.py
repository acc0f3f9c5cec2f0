# SPDX-License-Identifier: Apache-2.0
"""Decomposition records that no item needs."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("decomposition-unused", ERROR, "A decomposition record is about a link whose child has the lower SIL, and there is one of it.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    rank = {sil: index for index, sil in enumerate(project.schema.sil)}
    told: dict[tuple[str, str], Place] = {}
    for record in project.decomposition:
        key = (record.child, record.parent)
        child, parent = project.items.get(record.child), project.items.get(record.parent)
        if key in told:
            yield record.place, f"repeats the record of {record.child} and {record.parent} in line {told[key].line}", record.child
        elif child is None or parent is None or child.retired or parent.id not in child.parents:
            yield record.place, f"{record.child} has no parent {record.parent}; remove the record", record.child
        elif child.sil and parent.sil and rank[child.sil] >= rank[parent.sil]:
            message = f"{child.id} has SIL {child.sil}, no lower than its parent {parent.id}; remove the record"
            yield record.place, message, record.child
        told.setdefault(key, record.place)
