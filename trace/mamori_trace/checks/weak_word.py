# SPDX-License-Identifier: Apache-2.0
"""Words that leave open what is required."""

from __future__ import annotations

import re
from collections.abc import Iterator

from mamori_trace.base.finding import WARNING, Place, Rule
from mamori_trace.checks.words import may_hold
from mamori_trace.model.project import Project

RULE = Rule("weak-word", WARNING, "The statement of an approved requirement contains no word that leaves open what is demanded.")


def check(project: Project) -> Iterator[tuple[Place, str, str]]:
    schema = project.schema
    if not schema.weak_words or not may_hold((item.statement for item in project.live_items), schema.weak_words):
        return
    weak = _make_pattern(schema.weak_words)
    fair = _make_pattern(schema.weak_word_exceptions) if schema.weak_word_exceptions else None
    for item in project.live_items:
        if not item.approved or not schema.levels[item.level].shall:
            continue
        match = weak.search(item.statement)
        if match and fair is not None:
            match = weak.search(fair.sub(" - ", item.statement))
        if match:
            place = Place(item.place.file, item.statement_line or item.place.line)
            yield place, f"{item.id} says '{match[0]}', which a test cannot decide; say how much, when or which", item.id


def _make_pattern(words: tuple[str, ...]) -> re.Pattern[str]:
    """One pattern for all words, longest first, so that complete phrases are named. A hyphen belongs to a word."""
    ordered = sorted(words, key=lambda word: (-len(word), word))
    return re.compile(rf"(?<![\w-])(?:{'|'.join(re.escape(word) for word in ordered)})(?![\w-])", re.IGNORECASE)
