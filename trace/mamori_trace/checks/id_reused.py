# SPDX-License-Identifier: Apache-2.0
"""Ids that previously named another item."""

from __future__ import annotations

from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.project import Project

RULE = Rule("id-reused", ERROR, "An id that was given up does not come back as another item.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    for key, former in sorted(project.former_ids.items()):
        item = project.items.get(key)
        if item is not None and item.calc_fingerprint() != former.fingerprint:
            was = f" as '{former.title}'" if former.title else ""
            message = f"{key} was given up on {former.date}{was} ({former.place}); take a new number, or restore the old item"
            yield item.place, message, key
