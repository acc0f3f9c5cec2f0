# SPDX-License-Identifier: Apache-2.0
"""Safety levels that get lost on the way down."""

from __future__ import annotations

from collections.abc import Iterator

from mamori.trace.model.finding import WARNING, Place, Rule
from mamori.trace.model.project import Project

RULE = Rule(
    "sil-lower", WARNING, "An item has at least the highest safety level of its parents, or its rationale says why not."
)


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    rank = {sil: index for index, sil in enumerate(project.schema.sil)}
    for item in project.live_items:
        parents = [project.items[parent] for parent in item.parents if parent in project.items]
        rated = [parent for parent in parents if parent.sil]
        if not item.sil or not rated:
            continue
        highest = max(rated, key=lambda parent: rank[parent.sil])
        if rank[item.sil] < rank[highest.sil]:
            message = f"{item.id} has SIL {item.sil}, lower than SIL {highest.sil} of its parent {highest.id}"
            yield item.find_place("SIL"), message, item.id
