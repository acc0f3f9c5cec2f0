# SPDX-License-Identifier: Apache-2.0
"""Review records that belong to no item that requires them."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("review-unused", ERROR, "A recorded review is about an item that there is, by a method that it demands.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for record in project.reviews:
        item = project.items.get(record.item)
        if item is None or item.retired:
            near = ", ".join(project.suggest(record.item)) if item is None else ""
            what = "is retired" if item is not None else "is defined nowhere" + (f"; nearest: {near}" if near else "")
            yield record.place, f"records a {record.method} of {record.item}, which {what}", record.item
        elif item.whole and record.method not in item.verify:
            yield record.place, f"records a {record.method} of {record.item}, which demands {', '.join(item.verify)}", record.item
