# SPDX-License-Identifier: Apache-2.0
"""Decomposition records: why a child may have a lower SIL than its parent, and which items carry the SIL of the parent.

@satisfies SWR-TRC-022      Design: docs/design/trace.md#decomposition
"""

from __future__ import annotations

from dataclasses import dataclass

from mamori_trace.base.finding import Place


@dataclass(frozen=True, slots=True)
class Decomposition:
    """One row of requirements/decomposition.toml. `carried_by` are ids of children of the same parent, with its SIL or a higher one."""

    child: str
    parent: str
    reason: str
    independence: str
    carried_by: tuple[str, ...]
    by: str
    place: Place
