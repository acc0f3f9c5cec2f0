# SPDX-License-Identifier: Apache-2.0
"""The record of the last `./mamori test --all`, which is kept in the project and shown in each report.

@satisfies SWR-CLI-050      Design: docs/design/launcher.md#tiers
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any, TextIO

from mamori.profiles.text_file import write_text
from mamori.verification.command.errors import StepError
from mamori.verification.command.process import Tick
from mamori.verification.command.steps import Context

FILE = "verification/full_run.json"
SCHEMA = "mamori.full_run/1"


def read_full_run(root: Path) -> dict[str, Any]:
    """The record, or nothing where there is none that can be read."""
    try:
        record = json.loads((root / FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return record if isinstance(record, dict) and record.get("schema") == SCHEMA else {}


def record_full_run(context: Context, _tick: Tick, log: TextIO) -> None:
    """The step that writes the record of the steps before it, whatever became of them, also into the environment of this run.

    @raise StepError without that.
    """
    path = context.project.evidence / "environment.json"
    try:
        environment = json.loads(path.read_text(encoding="utf-8"))
        record = {
            "schema": SCHEMA,
            "commit": environment["commit"],
            "dirty": environment["dirty"],
            "date_utc": environment["date_utc"],
            "cpu": environment["cpu"],
            "steps": [
                {"name": one.name, "verdict": one.verdict, "passed": one.counts.passed, "failed": one.counts.failed,
                 "skipped": one.counts.skipped, "cpu_s": round(one.cpu_s)}
                for one in context.outcomes.values()
            ],
        }  # fmt: skip
    except (OSError, ValueError, KeyError) as error:
        raise StepError(f"{path}: no record of what this run is made from ({error}); run the command again") from error
    write_text(context.project.root / FILE, json.dumps(record, indent=1) + "\n")
    write_text(path, json.dumps(environment | {"full_run": record}, indent=1) + "\n")
    print(f"wrote {FILE}: add it to the commit", file=log)
