# SPDX-License-Identifier: Apache-2.0
"""Converts Mamori's own items to the neutral model and back to Markdown blocks.

@satisfies SWR-TRC-050      Design: docs/design/trace_formats.md#export
"""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.files import read_text
from mamori_trace.formats.model import ForeignItem, ForeignProject, Relation
from mamori_trace.model.item import Item
from mamori_trace.model.project import Project

NAME = "mamori"
PARENT = "Parent"
ATTRIBUTES = ("SIL", "Verify", "Polarity", "Design", "Status")
_FOLDER = "requirements/"


def make_neutral(project: Project) -> ForeignProject:
    """All items with every attribute, ordered by file and line, and the last review of each link."""
    neutral = ForeignProject(NAME)
    for item in project.all_items:
        document = item.place.file.removeprefix(_FOLDER)
        if document not in neutral.headers:
            neutral.headers[document] = _read_header(project.root, item.place.file)
        neutral.items.append(_make_item(item, document, project))
    return neutral


def _read_header(root: Path, file: str) -> str:
    """The text before the first item."""
    return read_text(root / file, file, []).partition("\n## ")[0].strip()


def _make_item(item: Item, document: str, project: Project) -> ForeignItem:
    made = ForeignItem(item.id, item.title, item.place, item.statement, item.statement_line, item.rationale, item.level, document)
    values = (item.sil, ", ".join(item.verify), ", ".join(item.polarity), item.design or "-", item.status)
    made.attributes = dict(zip(ATTRIBUTES, values, strict=True))
    made.lines = dict(item.lines)
    for parent in item.parents:
        review = project.lock.reviews.get((item.id, parent)) if project.lock else None
        words = f"{review.child_fingerprint} {review.parent_fingerprint} {review.date} {review.reviewer}" if review else ""
        made.relations.append(Relation(PARENT, parent, item.find_place("Parents").line, "", words))
    return made


def format_block(item: ForeignItem, parents: list[str], attributes: dict[str, str]) -> str:
    """One Markdown block; its parts follow requirements/README.md and fit on one line each."""
    rows = {"Rationale": item.rationale or "-", "Parents": ", ".join(parents) or "-", **attributes}
    lines = "\n".join(f"- {name}: {value}" for name, value in rows.items())
    return f"## {item.id} {item.title}\n\n{item.statement}\n\n{lines}\n"
