# SPDX-License-Identifier: Apache-2.0
"""Evidence for each function: the trace tool joins it with the requirements that own the function.

@satisfies SWR-VER-001, SWR-TRC-032      Design: docs/design/trace.md#coverage
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mamori_trace.readers.llvm_cov import calc_line_counts
from verification.coverage.reached import Function


def make_rows(exported: dict[str, Any], functions: Sequence[Function], root: Path) -> list[dict[str, Any]]:
    """One row for each function, ordered by file and line. The export counts lines for all programs together. Lines are therefore omitted
    if only the export of a single program shows that the function was called."""
    counts: dict[str, dict[int, int]] = {}
    for data in exported["data"]:
        for entry in data["files"]:
            path = Path(entry["filename"])
            if path.is_relative_to(root):
                counts[path.relative_to(root).as_posix()] = calc_line_counts(entry.get("segments", ()))
    return [_make_row(function, counts.get(function.file, {})) for function in functions]


def _make_row(function: Function, counts: dict[int, int]) -> dict[str, Any]:
    lines = [line for line in range(function.line, function.last_line + 1) if line in counts]
    missed = [line for line in lines if counts[line] == 0]
    if function.count > 0 and missed == lines:
        lines = missed = []
    conditions = function.conditions.values()
    return {
        "file": function.file,
        "name": function.name,
        "line": function.line,
        "last_line": function.last_line,
        "count": function.count,
        "lines": lines,
        "lines_missed": missed,
        "outcomes": 2 * len(conditions),
        "outcomes_reached": sum(one.is_true_seen + one.is_false_seen for one in conditions),
        "conditions": len(conditions),
        "conditions_shown": sum(not one.missing for one in conditions),
    }
