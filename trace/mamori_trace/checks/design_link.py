# SPDX-License-Identifier: Apache-2.0
"""Design links without an existing target."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from pathlib import Path

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.model.item import Item
from mamori_trace.model.project import Project
from mamori_trace.readers.headings import read_anchors

RULE = Rule("design-link", ERROR, "A design link leads to a file and a heading that exist.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    known: dict[str, list[str] | None] = {}
    for item in project.live_items:
        if item.design:
            message = _judge(project.root, item, known)
            if message:
                yield item.find_place("Design"), f"{item.id}: {message}", item.id


def _judge(root: Path, item: Item, known: dict[str, list[str] | None]) -> str:
    file, mark, anchor = item.design.partition("#")
    if file not in known:
        known[file] = read_anchors(root, file)
    anchors = known[file]
    if anchors is None:
        return f"design file {file} does not exist"
    if not mark:
        return f"design link {item.design} names no heading"
    if anchor not in anchors:
        near = difflib.get_close_matches(anchor, anchors, n=3, cutoff=0.5)
        hint = f"; nearest: {', '.join(near)}" if near else ""
        return f"{file} has no heading #{anchor}{hint}"
    return ""
