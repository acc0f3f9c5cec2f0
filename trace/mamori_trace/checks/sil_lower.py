# SPDX-License-Identifier: Apache-2.0
"""Items with a lower safety level than a parent."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("sil-lower", ERROR, "An item has at least the SIL of each parent, or a decomposition record says who carries it.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    rank = {sil: index for index, sil in enumerate(project.schema.sil)}
    recorded = {(record.child, record.parent) for record in project.decomposition}
    for item in project.live_items:
        parents = [project.items[parent] for parent in dict.fromkeys(item.parents) if parent in project.items]
        for parent in parents:
            lower = item.sil and parent.sil and rank[item.sil] < rank[parent.sil]
            if lower and (item.id, parent.id) not in recorded:
                message = f"{item.id} has SIL {item.sil}, lower than SIL {parent.sil} of its parent {parent.id}, and no record says why"
                yield item.find_place("SIL"), message, item.id
