# SPDX-License-Identifier: Apache-2.0
"""The ledger of ids that were given up, so that none of them comes to mean something else.

@satisfies SWR-TRC-025      Design: docs/design/trace.md#ids
"""

from __future__ import annotations

from dataclasses import dataclass

from mamori_trace.base.finding import Place


@dataclass(frozen=True, slots=True)
class FormerId:
    """An id without an item. `fingerprint` is that of its last review; `title` is the last one known, or empty."""

    id: str
    fingerprint: str
    date: str
    title: str
    place: Place
