# SPDX-License-Identifier: Apache-2.0
"""Reads the counts of `mamori cost`: `cost/NAME/cost.json` (docs/design/cost.md#results).

@satisfies SWR-TIM-034      Design: docs/design/cost.md#results
"""

from __future__ import annotations

from pathlib import Path

from mamori_trace.base.files import list_paths
from mamori_trace.base.finding import Problem
from mamori_trace.base.json_file import Each, Maybe, read_records
from mamori_trace.model.evidence import CostRun, Evidence

SCHEMA = "mamori.cost/1"

_ENVIRONMENT = {"commit": str, "dirty": bool, "date_utc": str, "command": str, "os": str, "cpu": str, "cores": Maybe(int),
                "compilers": Each(str), "packages": Each(str), "python": str}  # fmt: skip
_COUNTS = {"count": int, "min": int, "median": int, "max": int, "cycle": int}
_SHAPE = {
    "system": str, "exit_status": int, "marks": [str], "assumption": str, "margin_percent": float, "growth_percent": float,
    "build": {"compiler": str, "flags": str, "c_library": str}, "environment": _ENVIRONMENT,
    "classes": [{"name": str, "cycles": int, "first": int, "every": int, "step_count": int, "notes": [str]}],
    "pace": {"ns_per_instruction": float, "component": str, "least_ns": float, "reference_ns": float, "reference_instructions": int},
    "ratios": [{"component": str, "openings": int, "median_ns": float, "p99_ns": float}],
    "steps": [{"input_class": str, "component": str, "window": str, "pass_name": str, "instructions": _COUNTS, "time_ns": float}],
    "limits": [{"what": str, "name": str, "limit_ns": int, "input_class": str, "cycle": int, "instructions": int, "heaviest": str,
                "time_ns": float, "needed_ns": float, "left_ns": float, "is_kept": bool}],
    "findings": [str],
}  # fmt: skip
"""The parts of the record that the page shows; the record may contain more."""


def read_cost(folder: Path, root: Path, evidence: Evidence, problems: list[Problem]) -> None:
    """Reads the counted systems, sorted by folder. Each record that violates the format is one problem."""
    files = list_paths(folder, "cost/*/cost.json", root, problems)
    for path, table, place in read_records(files, SCHEMA, _SHAPE, "count again", root, problems):
        evidence.cost_runs.append(CostRun(path.parent.as_posix(), table, place))
