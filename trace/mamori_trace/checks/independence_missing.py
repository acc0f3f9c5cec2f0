# SPDX-License-Identifier: Apache-2.0
"""Reviews that the author of the reviewed item made."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import OFF, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("independence-missing", OFF, "A review that counts was made by somebody else than the author.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for record in project.reviews:
        item = project.items.get(record.item)
        if item is None or item.retired or not item.sil:
            continue
        if not record.author:
            yield record.place, f"the {record.method} of {item.id} does not say who wrote what {record.by} looked at", item.id
        elif record.author.casefold() == record.by.casefold():
            yield record.place, f"the {record.method} of {item.id} was made by its author, {record.by}", item.id
