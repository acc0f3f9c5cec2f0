# SPDX-License-Identifier: Apache-2.0
"""Reads requirements/decomposition.toml.

@satisfies SWR-TRC-022      Design: docs/design/trace.md#decomposition
"""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.finding import Problem
from mamori_trace.model.decomposition import Decomposition
from mamori_trace.readers.toml_rows import Columns, read_rows

DECOMPOSITION_PATH = "requirements/decomposition.toml"
_COLUMNS = Columns(
    texts=("child", "parent", "reason", "independence", "by"),
    lists=("carried_by",),
    needed=("child", "parent", "reason", "independence", "carried_by", "by"),
)


def read_decomposition(root: Path, problems: list[Problem]) -> list[Decomposition]:
    """Records in file order. An incomplete record is a problem and has no effect."""
    rows = read_rows(root / DECOMPOSITION_PATH, "mamori.decomposition/1", "record", _COLUMNS, root, problems)
    return [Decomposition(place=place, **row) for row, place in rows]
