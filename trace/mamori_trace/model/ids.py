# SPDX-License-Identifier: Apache-2.0
"""The ledger of retired ids, so that none of them is used for another item.

@satisfies SWR-TRC-025      Design: docs/design/trace.md#ids
"""

from __future__ import annotations

from dataclasses import dataclass

from mamori_trace.base.finding import Place


@dataclass(frozen=True, slots=True)
class FormerId:
    """An id without an item. `fingerprint` is from its last review; `title` is the last known title, or empty."""

    id: str
    fingerprint: str
    date: str
    title: str
    place: Place
