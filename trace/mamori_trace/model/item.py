# SPDX-License-Identifier: Apache-2.0
"""Requirement items, and the schema of their permitted words and links."""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass, field

from mamori_trace.base.finding import Place
from mamori_trace.model.words import UNFINISHED_WORDS, WEAK_WORDS

DRAFT = "draft"
APPROVED = "approved"
RETIRED = "retired"


@dataclass(frozen=True, slots=True)
class Level:
    """Rules of one item level, as requirements/schema/items.toml states them. `refined_by`: a level, or empty."""

    key: str
    name: str
    pattern: re.Pattern[str]
    parents: tuple[str, ...]
    also: tuple[str, ...]
    shall: bool
    needs_child: bool
    needs_code: bool
    from_children: bool
    through_children: bool
    hazard: bool = False
    refined_by: str = ""
    integrated: bool = False


@dataclass(frozen=True, slots=True)
class Schema:
    """Closed vocabularies; `levels` is ordered from the top to the bottom of the V, `sil` from lowest to highest."""

    attributes: tuple[str, ...]
    sil: tuple[str, ...]
    verify: tuple[str, ...]
    polarity: tuple[str, ...]
    status: tuple[str, ...]
    technique: tuple[str, ...]
    levels: dict[str, Level]
    unfinished_words: tuple[str, ...] = UNFINISHED_WORDS
    weak_words: tuple[str, ...] = WEAK_WORDS
    weak_word_exceptions: tuple[str, ...] = ()

    def find_level(self, item_id: str) -> Level | None:
        """The level whose id pattern `item_id` matches in full."""
        level = self.levels.get(item_id.partition("-")[0])
        return level if level is not None and level.pattern.fullmatch(item_id) else None


@dataclass(slots=True)
class Item:
    """One item block. `lines` gives the line of each attribute; `whole` is False if the block is malformed.

    An attribute that could not be read is empty, so that rules about other attributes still work.
    """

    id: str
    title: str
    level: str
    place: Place
    statement: str = ""
    statement_line: int = 0
    rationale: str = ""
    parents: tuple[str, ...] = ()
    sil: str = ""
    verify: tuple[str, ...] = ()
    polarity: tuple[str, ...] = ()
    design: str = ""
    status: str = ""
    lines: dict[str, int] = field(default_factory=dict)
    whole: bool = True

    @property
    def approved(self) -> bool:
        return self.status == APPROVED

    @property
    def retired(self) -> bool:
        return self.status == RETIRED

    def find_place(self, attribute: str) -> Place:
        """Location of an attribute, or of the heading if the attribute is missing."""
        return Place(self.place.file, self.lines.get(attribute, self.place.line))

    def calc_fingerprint(self) -> str:
        """Fingerprint of the parts that matter to the review of a link: the obligation, its level, and its verification.

        Rationale, design link and status can be corrected without a new review of the links.
        """
        parts = (self.id, self.title, self.statement, self.sil, ",".join(self.verify), ",".join(self.polarity))
        text = "\n".join([" ".join(part.split()) for part in parts])
        return hashlib.sha256(text.encode()).hexdigest()[:12]
