# SPDX-License-Identifier: Apache-2.0
"""Words that mark an unfinished text."""

from __future__ import annotations

import re
from collections.abc import Iterator

from mamori_trace.base.finding import ERROR, Place, Rule
from mamori_trace.checks.words import may_hold
from mamori_trace.model.project import Project

RULE = Rule("unfinished-text", ERROR, "An approved item contains no word of the schema's list of unfinished words.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    texts = (part for item in project.live_items for part in (item.title, item.statement, item.rationale))
    if not may_hold(texts, (*project.schema.unfinished_words, "???")):
        return
    words = "|".join(re.escape(word) for word in project.schema.unfinished_words)
    pattern = re.compile(rf"\b(?:{words})\b|\?\?\?" if words else r"\?\?\?", re.IGNORECASE)
    for item in project.live_items:
        if not item.approved:
            continue
        parts = (
            (item.place, item.title),
            (Place(item.place.file, item.statement_line or item.place.line), item.statement),
            (item.find_place("Rationale"), item.rationale),
        )
        for place, text in parts:
            match = pattern.search(text)
            if match:
                yield place, f"{item.id} is approved and contains '{match[0]}'", item.id
