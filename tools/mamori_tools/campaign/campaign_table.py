# SPDX-License-Identifier: Apache-2.0
"""A campaign on one screen: one row per scenario, with its worst figures."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any

from mamori_tools.host.steps import Context

COLUMNS = ("scenario", "result", "cases", "final states", "slowest reaction", "largest stop travel", "tracking error")
Row = tuple[str, ...]


def summarise_campaign(campaign: dict[str, Any]) -> tuple[Row, list[Row]]:
    """@param campaign campaign.json (docs/design/trace.md#evidence-files). @return heads and rows, in the order of the campaign."""
    scenarios: dict[str, list[dict[str, Any]]] = {}
    for case in campaign["cases"]:
        scenarios.setdefault(case["scenario"], []).append(case)
    return COLUMNS, [_make_row(name, cases) for name, cases in scenarios.items()]


def _make_row(name: str, cases: list[dict[str, Any]]) -> Row:
    passed = sum(case["verdict"] == "pass" for case in cases)
    runs = [case["run"] for case in cases if case["run"]]  # a crashed program left no record
    reactions = [run["reacted_at_s"] - run["fault"]["at_s"] for run in runs
                 if run["fault"] is not None and run["reacted_at_s"] is not None]
    travels = [max(run["physics"]["stop_travel_rad"]) for run in runs
               if run["fault"] is not None and run["reacted_at_s"] is not None]  # an arm that continued did not stop
    errors = [run["physics"]["max_tracking_error_rad"] for run in runs]
    return (
        name,
        "passed" if passed == len(cases) else "failed",
        f"{passed}/{len(cases)}",
        " ".join(sorted({run["final_state"] for run in runs})) or "-",
        _worst((1000.0 * value for value in reactions), "ms", 1),
        _worst(travels, "rad", 3),
        _worst(errors, "rad", 4),
    )


def _worst(values: Iterable[float], unit: str, digits: int) -> str:
    found = list(values)
    return f"{max(found):.{digits}f} {unit}" if found else "-"


def show_campaign(context: Context) -> None:
    """The table of all scenarios; empty if no campaign was run."""
    path = context.project.evidence / "campaign" / "campaign.json"
    if not path.exists():
        return
    context.screen.say()
    context.screen.print_table(*summarise_campaign(json.loads(path.read_text(encoding="utf-8"))))
