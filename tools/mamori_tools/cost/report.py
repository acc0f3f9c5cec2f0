# SPDX-License-Identifier: Apache-2.0
"""All results of one call, its exit status, cost.json and its text.

@satisfies SWR-TIM-039      Design: docs/design/cost.md#results
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from mamori_tools.cost.analysis import LimitRow, Pace, Ratio, StepRow, find_pace, list_findings, list_limits, list_ratios, list_steps
from mamori_tools.cost.classes import CostPlan
from mamori_tools.cost.run import Build, ClassRun
from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK
from mamori_tools.timing.baseline import make_fingerprint
from mamori_tools.timing.environment import calc_steal_share
from mamori_tools.timing.text import format_columns, format_us, make_printable
from mamori_trace.base.text_file import write_text

SCHEMA = "mamori.cost/1"
ASSUMPTION = ("times are counts at the worst median ratio of a component on this machine; no model of caches, buses or other work: "
              "evidence for budgets here, not a worst-case execution time")  # fmt: skip


@dataclass(frozen=True)
class Report:
    """One call. `host` contains settings and the state before and after (timing/environment.py)."""

    system: str
    plan: CostPlan
    runs: Sequence[ClassRun]
    ratios: Sequence[Ratio]
    pace: Pace
    steps: Sequence[StepRow]
    limits: Sequence[LimitRow]
    findings: Sequence[str]
    host: dict[str, Any]

    @property
    def status(self) -> int:
        return EXIT_FAILED if self.findings else EXIT_OK

    @property
    def build(self) -> Build:
        return self.runs[0].facts.build

    @property
    def marks(self) -> list[str]:
        """Marks that must be visible on the screen, in the files and on the page."""
        refused = {right.name: right for run in self.runs for right in run.facts.rights if not right.is_granted}
        if not refused:
            return []
        return ["TIMES WITHOUT REAL-TIME PRIVILEGES: denied: " + ", ".join(f"{one.name} ({os.strerror(one.errno)})" for one in refused.values())]


def make_report(system: str, plan: CostPlan, runs: Sequence[ClassRun], host: dict[str, Any]) -> Report:
    """@pre at least one step was counted."""
    ratios = list_ratios(runs)
    pace = find_pace(ratios, runs)
    limits = list_limits(runs, pace, plan.margin_percent)
    findings = list_findings(limits, runs, ratios, plan.margin_percent)
    return Report(system, plan, runs, ratios, pace, list_steps(runs, pace), limits, findings, host)


def make_record(report: Report, environment: dict[str, object]) -> dict[str, Any]:
    """The document that write_results() writes. Times in ns, shares 0 .. 1."""
    return {
        "schema": SCHEMA,
        "system": report.system,
        "table": make_fingerprint(report.runs[0].table),
        "exit_status": report.status,
        "marks": report.marks,
        "assumption": ASSUMPTION,
        "margin_percent": report.plan.margin_percent,
        "growth_percent": report.plan.growth_percent,
        "build": asdict(report.build),
        "environment": environment,
        "host": {**report.host, "steal_share": calc_steal_share(report.host["before"], report.host["after"])},
        "classes": [_make_class(run) for run in report.runs],
        "pace": asdict(report.pace),
        "ratios": [asdict(row) for row in report.ratios],
        "steps": [asdict(row) for row in report.steps],
        "limits": [{**asdict(row), "left_ns": row.left_ns, "is_kept": row.is_kept} for row in report.limits],
        "findings": list(report.findings),
    }


def _make_class(run: ClassRun) -> dict[str, Any]:
    one = run.input_class
    return {"name": one.name, "cycles": one.cycles, "first": one.first, "every": one.every, "arguments": list(one.arguments),
            "step_count": len(run.steps), "notes": list(run.facts.notes),
            "rights": {right.name: {"is_granted": right.is_granted, "errno": right.errno} for right in run.facts.rights}}  # fmt: skip


def write_results(report: Report, environment: dict[str, object], folder: Path) -> list[Path]:
    """Writes each file atomically. @return their paths."""
    paths = [folder / "cost.json", folder / "cost.txt"]
    write_text(paths[0], json.dumps(make_record(report, environment), indent=1) + "\n")
    write_text(paths[1], make_text(report))
    return paths


def make_text(report: Report) -> str:
    """One screen for a system of a few components; times in us."""
    build, pace = report.build, report.pace
    steps = [("class", "component", "pass", "counted", "min", "median", "max", "in cycle", "time")]
    steps += [(row.input_class, row.component, row.pass_name, str(row.instructions.count), str(row.instructions.min),
               str(row.instructions.median), str(row.instructions.max), str(row.instructions.cycle), format_us(round(row.time_ns)))
              for row in report.steps]  # fmt: skip
    limits = [("limit of", "name", "limit", "worst class", "in cycle", "instructions", "most by", "time", "with margin", "left")]
    limits += [(row.what, row.name, format_us(row.limit_ns), row.input_class, str(row.cycle), str(row.instructions), row.heaviest,
                format_us(round(row.time_ns)), format_us(round(row.needed_ns)), format_us(round(row.left_ns))) for row in report.limits]  # fmt: skip
    ratios = [("component", "openings", "ns per instruction p50", "p99")]
    ratios += [(row.component, str(row.openings), f"{row.median_ns:.3f}", f"{row.p99_ns:.3f}") for row in report.ratios]
    parts = [
        [*(f"*** {mark} ***" for mark in report.marks),
         f"{report.system}: instructions of single steps, exact; {build.compiler}, flags '{build.flags}', {build.c_library}; times in us",
         *(f"class {run.input_class.name}: {_describe_class(run)}" for run in report.runs)],
        format_columns(steps),
        [*format_columns(ratios),
         f"time of an instruction: {pace.ns_per_instruction:.3f} ns, the worst ('{pace.component}'; least {pace.least_ns:.3f} ns); "
         f"reference work {pace.reference_ns:.3f} ns over {pace.reference_instructions} instructions", f"assumption: {ASSUMPTION}"],
        format_columns(limits),
        [*(f"finding: {line}" for line in report.findings), f"findings: {len(report.findings)}"],
    ]  # fmt: skip
    return make_printable("\n\n".join("\n".join(part) for part in parts) + "\n")


def _describe_class(run: ClassRun) -> str:
    one = run.input_class
    which = f"{one.cycles} cycles, from {one.first} on" + (f" one of {one.every}" if one.every > 1 else "")
    return f"{which}, {len(run.steps)} steps counted" + "".join(f"; {note}" for note in run.facts.notes)
