# SPDX-License-Identifier: Apache-2.0
"""Records of reviews and analyses of items by a person: the evidence for `Verify: review` and `Verify: analysis`.

@satisfies SWR-TRC-023      Design: docs/design/trace.md#reviews
"""

from __future__ import annotations

from dataclasses import dataclass

from mamori_trace.base.finding import Place


@dataclass(frozen=True, slots=True)
class ReviewRecord:
    """One row of requirements/reviews.toml. `looked_at`: what was compared with the item; `author`: author of the item."""

    item: str
    method: str
    fingerprint: str
    looked_at: str
    author: str
    by: str
    date: str
    place: Place
