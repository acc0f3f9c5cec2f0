# SPDX-License-Identifier: Apache-2.0
"""Converts counted steps to facts and tables of the page.

@satisfies SWR-TIM-034      Design: docs/design/cost.md#results
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_trace.model.evidence import CostRun
from mamori_trace.model.project import Project
from mamori_trace.reports.timing_view import ABSENT, Cell, Column, Table, make_margin, make_table, make_time
from mamori_trace.reports.view import describe_environment

WHERE = "cost.txt"


@dataclass(slots=True)
class CostView:
    """One counted system."""

    run: CostRun
    anchor: str
    title: str
    result: tuple[str, str]
    facts: list[tuple[str, str]]
    tables: list[Table]
    environment: dict[str, Any]
    is_other_commit: bool


def make_cost_views(project: Project) -> list[CostView]:
    """One view for each counted system."""
    views = []
    here = project.head or str(project.evidence.environment.get("commit") or "")
    for index, run in enumerate(project.evidence.cost_runs):
        record, folder = run.record, Path(run.folder).name
        environment = describe_environment(record["environment"])
        views.append(CostView(
            run=run,
            anchor=f"cost-{index}",
            title=record["system"] if record["system"] == folder else f"{record['system']} in {folder}",
            result=_describe_result(record),
            facts=_list_facts(record),
            tables=[_make_limits(record), _make_steps(record), _make_ratios(record), _make_classes(record)],
            environment=environment,
            is_other_commit=bool(here) and not here.startswith(environment["commit"]),
        ))  # fmt: skip
    return views


def _describe_result(record: dict[str, Any]) -> tuple[str, str]:
    count = len(record["findings"])
    if count == 0 and record["exit_status"] == 0:
        return "limits kept", "verified"
    return f"{count} finding{'' if count == 1 else 's'}", "failed"


def _list_facts(record: dict[str, Any]) -> list[tuple[str, str]]:
    build, pace = record["build"], record["pace"]
    return [
        ("Compiler", f"{build['compiler']} {build['flags']}, {build['c_library']}"),
        ("An instruction takes", f"{pace['ns_per_instruction']:.3g} ns, the worst ({pace['component']}); least {pace['least_ns']:.3g} ns"),
        ("Reference work", f"{pace['reference_ns']:.3g} ns each of {pace['reference_instructions']} instructions"),
        ("Margin of limits", f"{record['margin_percent']:g} % of the measured maximum"),
        ("Growth allowed", f"{record['growth_percent']:g} % over the baseline"),
    ]


def _make_limits(record: dict[str, Any]) -> Table:
    columns = (
        Column("limit of", is_number=False), Column("name", is_number=False), Column("limit"), Column("class", "greatest opening", is_number=False),
        Column("cycle", "greatest opening"), Column("instructions", "greatest opening"), Column("most by", "greatest opening", is_number=False),
        Column("time", "greatest opening"), Column("with margin"), Column("left"), Column("verdict", is_number=False),
    )  # fmt: skip

    def make(row: dict[str, Any]) -> list[Cell]:
        return [
            Cell(row["what"]), Cell(row["name"], is_name=True), make_time(row["limit_ns"]), Cell(row["input_class"], is_name=True),
            Cell(str(row["cycle"])), Cell(str(row["instructions"])), Cell(row["heaviest"], is_name=True), make_time(row["time_ns"]),
            make_time(row["needed_ns"]), make_margin(row["left_ns"]), Cell("kept" if row["is_kept"] else "too low", is_bad=not row["is_kept"]),
        ]  # fmt: skip

    return make_table("Budgets and declared worst cases against the greatest opening", columns, record["limits"], make, where=WHERE)


def _make_steps(record: dict[str, Any]) -> Table:
    columns = (
        Column("component", is_number=False), Column("class", is_number=False), Column("pass", is_number=False), Column("counted"),
        Column("min", "instructions"), Column("median", "instructions"), Column("max", "instructions"), Column("max in cycle"),
        Column("time of max"), Column("window", is_number=False), Column("share of its budget"),
    )  # fmt: skip
    budgets = {row["name"]: row["limit_ns"] for row in record["limits"] if row["what"] == "window"}

    def make(row: dict[str, Any]) -> list[Cell]:
        counts, budget_ns = row["instructions"], budgets.get(row["window"], 0)
        return [
            Cell(row["component"], is_name=True), Cell(row["input_class"], is_name=True), Cell(row["pass_name"]), Cell(str(counts["count"])),
            Cell(str(counts["min"])), Cell(str(counts["median"])), Cell(str(counts["max"])), Cell(str(counts["cycle"])),
            make_time(row["time_ns"]), Cell(row["window"], is_name=True),
            Cell(f"{100 * row['time_ns'] / budget_ns:.2f} %" if budget_ns > 0 else ABSENT),
        ]  # fmt: skip

    # Puts the classes of a component in consecutive rows, although the record is ordered by class. The sort is stable.
    names = list(dict.fromkeys(row["component"] for row in record["steps"]))
    rows = sorted(record["steps"], key=lambda row: names.index(row["component"]))
    return make_table("Instructions of a single step", columns, rows, make, where=WHERE)


def _make_ratios(record: dict[str, Any]) -> Table:
    columns = (Column("component", is_number=False), Column("openings"), Column("p50", "ns per instruction"), Column("p99", "ns per instruction"))

    def make(row: dict[str, Any]) -> list[Cell]:
        return [Cell(row["component"], is_name=True), Cell(str(row["openings"])), Cell(f"{row['median_ns']:.3f}"), Cell(f"{row['p99_ns']:.3f}")]

    return make_table("How long an instruction takes, by component", columns, record["ratios"], make, is_folded=True, where=WHERE)


def _make_classes(record: dict[str, Any]) -> Table:
    columns = (Column("class", is_number=False), Column("cycles"), Column("from"), Column("one of"), Column("steps counted"),
               Column("the program says", is_number=False))  # fmt: skip

    def make(row: dict[str, Any]) -> list[Cell]:
        return [
            Cell(row["name"], is_name=True), Cell(str(row["cycles"])), Cell(str(row["first"])), Cell(str(row["every"])),
            Cell(str(row["step_count"])), Cell("; ".join(row["notes"]), is_long=True),
        ]  # fmt: skip

    return make_table("Classes of inputs", columns, record["classes"], make, is_folded=True, where=WHERE)
