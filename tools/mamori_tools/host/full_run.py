# SPDX-License-Identifier: Apache-2.0
"""The record of the last `./mamori test --all`, which is stored in the project and shown in each report.

@satisfies SWR-CLI-050      Design: docs/design/launcher.md#tiers
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from mamori_tools.host.project import Project
from mamori_tools.host.steps import INCONCLUSIVE, Outcome
from mamori_trace.base.text_file import write_text

FILE = "verification/full_run.json"
SCHEMA = "mamori.full_run/1"


def read_full_run(root: Path) -> dict[str, Any]:
    """The record; None if there is no readable one."""
    try:
        record = json.loads((root / FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return record if isinstance(record, dict) and record.get("schema") == SCHEMA else {}


def record_full_run(project: Project, outcomes: Sequence[Outcome]) -> None:
    """Writes the record of a run, with any result of its steps, from its `outcomes` and its environment record."""
    environment = json.loads((project.evidence / "environment.json").read_text(encoding="utf-8"))
    record = {
        "schema": SCHEMA,
        **{name: environment[name] for name in ("commit", "dirty", "date_utc", "cpu")},
        "steps": [
            {"name": one.name, "verdict": INCONCLUSIVE if one.reason.startswith(INCONCLUSIVE) else one.verdict, "passed": one.counts.passed,
             "failed": one.counts.failed, "skipped": one.counts.skipped, "cpu_s": round(one.cpu_s)}
            for one in outcomes
        ],
    }  # fmt: skip
    write_text(project.root / FILE, json.dumps(record, indent=1) + "\n")
