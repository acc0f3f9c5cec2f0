# SPDX-License-Identifier: Apache-2.0
"""The review lock: for each parent link the fingerprints of both ends at the last review.

@satisfies SWR-TRC-008      Design: docs/design/trace.md#suspect-links
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from mamori_trace.model.item import Item


class Review(NamedTuple):
    """Content of one line of the lock. `date` is ISO 8601; `reviewer` is a name."""

    child: str
    parent: str
    child_fingerprint: str
    parent_fingerprint: str
    date: str
    reviewer: str


@dataclass(slots=True)
class ReviewLock:
    """Reviews by (child, parent). `lines` gives the line of each review in `file`."""

    reviews: dict[tuple[str, str], Review] = field(default_factory=dict)
    lines: dict[tuple[str, str], int] = field(default_factory=dict)
    file: str = "requirements/trace.lock"

    def describe_suspicion(self, child: str, parent: str, fingerprints: Mapping[str, str]) -> str:
        """Why the link is suspect, or an empty text if both ends are unchanged since the last review.

        @param fingerprints current fingerprints of all items, by id, calculated once because an item has many links.
        """
        review = self.reviews.get((child, parent))
        if review is None:
            return f"the link {child} -> {parent} was never reviewed"
        changed = []
        if review.child_fingerprint != fingerprints[child]:
            changed.append(child)
        if review.parent_fingerprint != fingerprints[parent]:
            changed.append(parent)
        if not changed:
            return ""
        return f"{' and '.join(changed)} changed since the link {child} -> {parent} was reviewed on {review.date}"

    def record(self, child: Item, parent: Item, date: str, reviewer: str) -> None:
        """Records a new review of one link."""
        self.reviews[(child.id, parent.id)] = Review(
            child.id, parent.id, child.calc_fingerprint(), parent.calc_fingerprint(), date, reviewer
        )
