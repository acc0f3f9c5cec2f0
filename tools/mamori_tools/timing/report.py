# SPDX-License-Identifier: Apache-2.0
"""All results of one call, its exit status, and timing.json.

@satisfies SWR-TIM-025, SWR-TIM-026      Design: docs/design/timing.md#results
"""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_INTERRUPTED, EXIT_OK
from mamori_tools.timing.analysis import (
    ComponentRow,
    Miss,
    WindowRow,
    calc_execution,
    count_cut,
    list_components,
    list_drift_notes,
    list_findings,
    list_limit_findings,
    list_misses,
    list_windows,
)
from mamori_tools.timing.baseline import list_ratios, make_fingerprint
from mamori_tools.timing.chain_times import ChainRow, list_chains, list_violations
from mamori_tools.timing.environment import calc_steal_share
from mamori_tools.timing.evt import Estimate, estimate
from mamori_tools.timing.reader import Measurement
from mamori_tools.timing.request_shift import ShiftRow, list_shift_findings, list_shifts
from mamori_tools.timing.states import StateComponent, StateRow, list_state_components, list_state_findings, list_state_notes, list_states
from mamori_trace.base.text_file import write_text

SCHEMA = "mamori.timing/1"
EXIT_NO_RIGHTS = 4
"""Exit status of a measurement without findings, but without all real-time privileges."""
MISSES_STORED = 10_000
VIOLATIONS_STORED = 1_000


@dataclass(frozen=True)
class Report:
    """One call. `estimates`: one for each row of `components`. `findings`: deviations caused by the code or the run. `host` contains
    settings and the state before and after (environment.py). `was_stopped`: a user or a signal ended it early."""

    system: str
    run: Measurement
    windows: Sequence[WindowRow]
    components: Sequence[ComponentRow]
    misses: Sequence[Miss]
    chains: Sequence[ChainRow]
    chain_note: str
    shifts: Sequence[ShiftRow]
    states: Sequence[StateRow]
    state_components: Sequence[StateComponent]
    estimates: Sequence[Estimate]
    findings: Sequence[str]
    notes: Sequence[str]
    host: dict[str, Any]
    with_load: bool
    was_stopped: bool

    @property
    def steal_share(self) -> float:
        return calc_steal_share(self.host["before"], self.host["after"])

    @property
    def host_misses(self) -> list[Miss]:
        """Window instances that were not lost to the program."""
        return [miss for miss in self.misses if not miss.is_of_code]

    @property
    def status(self) -> int:
        """In order of priority: a stopped run was not evaluated, and findings are more important than missing privileges."""
        if self.was_stopped:
            return EXIT_INTERRUPTED
        if self.findings:
            return EXIT_FAILED
        return EXIT_NO_RIGHTS if self.run.refused else EXIT_OK

    @property
    def marks(self) -> list[str]:
        """Marks that must be visible on the screen, in the pictures and in the files."""
        marks = []
        if self.run.is_partial:
            marks.append(f"PARTIAL: stopped after {self.run.cycles_run} of {self.run.cycles_asked} cycles")
        if self.run.refused:
            refused = ", ".join(f"{right.name} ({os.strerror(right.errno)})" for right in self.run.refused)
            marks.append(f"WITHOUT REAL-TIME PRIVILEGES: denied: {refused}")
        return marks


@dataclass(frozen=True)
class Limits:
    """Limits of --max-missed and --max-late; None for no limit."""

    missed: int | None = None
    late_ns: int | None = None


NO_LIMITS = Limits()


def make_report(system: str, run: Measurement, host: dict[str, Any], with_load: bool, was_stopped: bool, findings: Sequence[str],
                limits: Limits = NO_LIMITS) -> Report:  # fmt: skip
    """Analyses `run`. @param findings known findings that are not in its files."""
    windows, components, misses = list_windows(run), list_components(run), list_misses(run)
    (chains, chain_note), shifts = list_chains(run), list_shifts(run)
    indices = [index for index, one in enumerate(run.table.components) if one.window is not None]
    estimates = [estimate(calc_execution(run, index)[0].values, count_cut(run, index)) for index in indices]
    early = [] if was_stopped or not run.is_partial else [f"the program ended after {run.cycles_run} of {run.cycles_asked} cycles"]
    found = [*findings, *early, *run.findings, *list_state_findings(run), *list_findings(windows, components, misses),
             *list_limit_findings(windows, misses, limits.missed, limits.late_ns), *list_violations(chains),
             *list_shift_findings(run, shifts)]  # fmt: skip
    return Report(system, run, windows, components, misses, chains, chain_note, shifts, list_states(run), list_state_components(run), estimates,
                  found, [*run.notes, *list_drift_notes(windows), *list_state_notes(run)],
                  host, with_load, was_stopped)  # fmt: skip


def make_record(report: Report, environment: dict[str, object]) -> dict[str, Any]:
    """The document that write_record() writes. Times in ns, shares 0 .. 1."""
    run = report.run
    ratios = [{"component": name, "ratio": ratio} for name, ratio in list_ratios(report.components, run.reference_ns)]
    return {
        "schema": SCHEMA,
        "system": report.system,
        "table": make_fingerprint(run.table),
        "exit_status": report.status,
        "marks": report.marks,
        "is_partial": run.is_partial,
        "cycles": {"asked": run.cycles_asked, "run": run.cycles_run},
        "frame_ns": run.table.frame_ns,
        "reference_ns": run.reference_ns,
        "with_load": report.with_load,
        "rights": {right.name: {"is_granted": right.is_granted, "errno": right.errno} for right in run.rights},
        "environment": environment,
        "host": {**report.host, "steal_share": report.steal_share},
        "findings": list(report.findings),
        "notes": list(report.notes),
        "windows": [asdict(row) for row in report.windows],
        "components": [{**asdict(row), "extreme_values": _make_estimate(one)} for row, one in zip(report.components, report.estimates, strict=True)],
        "ratios": ratios,
        "states": [asdict(row) for row in report.states],
        "state_components": [asdict(row) for row in report.state_components],
        "chains": [_make_chain(row) for row in report.chains],
        "chain_note": report.chain_note,
        "requests": None if run.requests is None else {**asdict(run.requests), "windows": [asdict(row) for row in report.shifts]},
        "miss_count": len(report.misses),
        "misses": [{**asdict(miss), "is_host": not miss.is_of_code} for miss in report.misses[:MISSES_STORED]],
    }


def _make_estimate(one: Estimate) -> dict[str, Any]:
    quantiles = [{"exceeded_with": p, "value_ns": value} for p, value in one.quantiles_ns.items()]
    return {"refusal": one.refusal or None, "quantiles": quantiles, "tests": [asdict(test) for test in one.tests]}


def _make_chain(row: ChainRow) -> dict[str, Any]:
    return {
        "name": row.name,
        "virtual": asdict(row.virtual),
        "measured": None if row.measured is None else asdict(row.measured),
        "broken": row.broken,
        "violation_count": len(row.violations),
        "violations": [asdict(one) for one in row.violations[:VIOLATIONS_STORED]],
    }


def write_record(record: dict[str, Any], folder: Path) -> Path:
    """Writes the record atomically. @return its path."""
    path = folder / "timing.json"
    write_text(path, json.dumps(record, indent=1) + "\n")
    return path
