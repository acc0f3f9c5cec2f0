# SPDX-License-Identifier: Apache-2.0
"""Converts real-time measurements to heads, tables and pictures of the page.

@satisfies SWR-TRC-015, SWR-TRC-016      Design: docs/design/trace.md#timing
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mamori_trace.base.errors import FormatError
from mamori_trace.base.files import UNREADABLE
from mamori_trace.base.finding import Problem
from mamori_trace.model.evidence import TimingRun
from mamori_trace.model.project import Project
from mamori_trace.readers.timing import Picture, read_picture
from mamori_trace.reports.view import describe_environment

ABSENT = "–"
MISSES_SHOWN = 20
ROWS_SHOWN = 100
PICTURES = (
    ("release_lateness", "How late each window was released, and how often later than that"),
    ("execution_time", "How long each component ran, and how often longer than that"),
    ("chain_latency", "From sample to effect along each chain, and how often longer than that"),
    ("over_time", "Lateness and response of each window over the time of the run, and each loss with its verdict"),
)
PICTURES_BYTES_MAX = 700_000
"""Maximum size of all pictures in the page, so that it stays small for any number of systems."""
_EXIT_RESULTS = {0: ("no findings", "verified"), 1: ("findings", "failed"), 4: ("without all real-time rights", "warning"),
                 130: ("stopped", "incomplete")}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Cell:
    """`is_bad`: a value that readers should see first. `is_name`: text that may wrap; `is_long`: a sentence, which may also wrap."""

    text: str
    is_bad: bool = False
    is_name: bool = False
    is_long: bool = False

    @property
    def css(self) -> str:
        """Classes of the style sheet."""
        words = (("name", self.is_name or self.is_long), ("long", self.is_long), ("bad", self.is_bad))
        return "".join(f" {word}" for word, is_set in words if is_set)


@dataclass(frozen=True, slots=True)
class Column:
    """`group` is written once above neighbouring columns of the same group."""

    head: str
    group: str = ""
    is_number: bool = True

    @property
    def full_head(self) -> str:
        """The head with its group, for a separate cell."""
        return f"{self.group}, {self.head}" if self.group else self.head


@dataclass(frozen=True, slots=True)
class Table:
    """`rows` are at most ROWS_SHOWN of `count`; `notes` follow them. `is_folded`: hidden until a click."""

    title: str
    columns: tuple[Column, ...]
    rows: list[list[Cell]]
    count: int
    notes: tuple[str, ...] = ()
    is_folded: bool = False
    where: str = "timing.txt"

    def is_first(self, index: int) -> bool:
        """Whether the column begins a group."""
        return index > 0 and self.columns[index].group != self.columns[index - 1].group

    @property
    def groups(self) -> list[tuple[str, int]]:
        """Titles above the heads, with the number of columns of each."""
        spans: list[tuple[str, int]] = []
        for column in self.columns:
            if spans and spans[-1][0] == column.group:
                spans[-1] = (column.group, spans[-1][1] + 1)
            else:
                spans.append((column.group, 1))
        return spans


@dataclass(slots=True)
class TimingView:
    """One measured system. `rights`: (name, granted, reason of the denial). `pictures`: (caption, picture)."""

    run: TimingRun
    anchor: str
    title: str
    result: tuple[str, str]
    rights: list[tuple[str, bool, str]]
    facts: list[tuple[str, str]]
    lost: str
    tables: list[Table]
    environment: dict[str, Any]
    machine: list[tuple[str, str]]
    pictures: list[tuple[str, Picture]]
    is_other_commit: bool


def make_timing_views(project: Project, problems: list[Problem]) -> list[TimingView]:
    """One view for each measured system. A picture that cannot be displayed is a problem; a picture that is too large is only named."""
    views = []
    here = project.head or str(project.evidence.environment.get("commit") or "")
    room_bytes = PICTURES_BYTES_MAX
    for index, run in enumerate(project.evidence.timing_runs):
        record, folder = run.record, Path(run.folder).name
        environment = describe_environment(record["environment"])
        view = TimingView(
            run=run,
            anchor=f"timing-{index}",
            title=record["system"] if record["system"] == folder else f"{record['system']} in {folder}",
            result=_describe_result(record),
            rights=[(name, one["is_granted"], "" if one["is_granted"] else os.strerror(_clip(one["errno"])))
                    for name, one in sorted(record["rights"].items())],
            facts=_list_facts(record),
            lost=_describe_lost(record),
            tables=[_make_windows(record), _make_components(record), _make_chains(record), _make_misses(record), _make_estimates(record)],
            environment=environment,
            machine=_list_machine(record),
            pictures=_list_pictures(run, room_bytes, problems),
            is_other_commit=bool(here) and not here.startswith(environment["commit"]),
        )  # fmt: skip
        room_bytes -= sum(len(picture.address) for _, picture in view.pictures)
        views.append(view)
    return views


def format_us(ns: float | None) -> str:
    """Microseconds with significant digits: at least three, and no fraction from 1,000 us on."""
    if ns is None:
        return ABSENT
    us = ns / 1e3
    if us == int(us) or abs(us) >= 1000.0:
        return f"{us:.0f}"
    return f"{us:.1f}" if abs(us) >= 10.0 else f"{us:.2f}"


def _clip(number: int) -> int:
    """Limits the number to the range of a C int, which os.strerror() accepts."""
    return number if 0 <= number < 2**31 else 0


def _describe_result(record: dict[str, Any]) -> tuple[str, str]:
    status = record["exit_status"]
    if status == 1:
        count = len(record["findings"])
        return f"{count} finding{'' if count == 1 else 's'}", "failed"
    return _EXIT_RESULTS.get(status, (f"exit status {status}", "failed"))


def _list_facts(record: dict[str, Any]) -> list[tuple[str, str]]:
    setting, before, after = (record["host"][key] for key in ("setting", "before", "after"))
    cycles = record["cycles"]
    asked = "" if cycles["run"] == cycles["asked"] else f" of {cycles['asked']}"
    return [
        ("Measured", f"{cycles['run']}{asked} cycles of {format_us(record['frame_ns'])} µs"),
        ("Reference work", f"{format_us(record['reference_ns'])} µs"),
        ("Beside it", "stress-ng on all processors" if record["with_load"] else "no load of ours"),
        ("Kernel", f"{setting['kernel']} ({setting['preemption']}){', virtual machine' if setting['virtual_machine'] else ''}"),
        ("Governor, clock", f"{setting['governor']}, {setting['clock_source']}"),
        ("Load, steal", f"{before['load_1_min']} to {after['load_1_min']}, {100 * record['host']['steal_share']:.2f} %"),
    ]


def _describe_lost(record: dict[str, Any]) -> str:
    """Windows that the host delayed or skipped: the main fact about a late run. The record counts them as misses."""
    lost = [miss for miss in record["misses"] if miss["is_host"]]
    if not lost:
        return ""
    missed = sum(miss["outcome"] == "missed" for miss in lost)
    return (f"Lost to the host: {missed} openings missed and {len(lost) - missed} cut short, late by up to "
            f"{format_us(max(miss['late_ns'] for miss in lost))} µs, steal {100 * record['host']['steal_share']:.2f} % of all processor "
            "time. These are no findings of the code.")  # fmt: skip


def _make_windows(record: dict[str, Any]) -> Table:
    columns = (
        Column("window", is_number=False), Column("core"), Column("offset", "plan"), Column("length", "plan"), Column("budget", "plan"),
        Column("p50", "released late"), Column("p99", "released late"), Column("p99.9", "released late"), Column("max", "released late"),
        Column("max", "response"), Column("margin", "response"), Column("max", "budget used"), Column("margin", "budget used"),
        Column("missed", "openings"), Column("overran", "openings"),
    )  # fmt: skip

    def make(row: dict[str, Any]) -> list[Cell]:
        response, outcomes = row["response"], row["outcomes"]
        return [
            Cell(row["window"], is_name=True), Cell(str(row["core"])), *map(make_time, (row["offset_ns"], row["length_ns"], row["budget_ns"])),
            *_list_times(row["lateness"], ("p50", "p99", "p999", "max")), make_time(response["max"] if response else None),
            make_margin(row["length_margin_ns"]), make_time(row["used_max_ns"]), make_margin(row["budget_margin_ns"]),
            _make_count(outcomes["missed"]), _make_count(outcomes["overrun"]),
        ]  # fmt: skip

    return make_table("Windows: plan and measurement", columns, record["windows"], make)


def _make_components(record: dict[str, Any]) -> Table:
    columns = (
        Column("component", is_number=False), Column("window", is_number=False), Column("openings"), Column("p50", "execution time"),
        Column("p99", "execution time"), Column("p99.9", "execution time"), Column("max", "execution time"), Column("declared", "worst case"),
        Column("margin", "worst case"), Column("p50 / reference"), Column("not back"),
    )  # fmt: skip
    ratios = {row["component"]: row["ratio"] for row in record["ratios"]}

    def make(row: dict[str, Any]) -> list[Cell]:
        times, ratio = row["execution"], ratios.get(row["component"])
        return [
            Cell(row["component"], is_name=True), Cell(row["window"], is_name=True), Cell(str(times["count"]) if times else ABSENT),
            *_list_times(times, ("p50", "p99", "p999", "max")), make_time(row["declared_ns"]), make_margin(row["margin_ns"]),
            Cell(ABSENT if ratio is None else f"{ratio:.3g}"), _make_count(row["unfinished"]),
        ]  # fmt: skip

    undeclared = not any(row["declared_ns"] is not None for row in record["components"])
    notes = ("No component of this table declares a worst case, so there is no margin of one.",) if undeclared and record["components"] else ()
    return make_table("Components", columns, record["components"], make, notes)


def _make_chains(record: dict[str, Any]) -> Table:
    columns = (
        Column("chain", is_number=False), Column("end to end", "virtual time"), Column("reaction max", "virtual time"),
        Column("p50", "measured"), Column("p99", "measured"), Column("p99.9", "measured"), Column("max", "measured"), Column("broken"),
        Column("over bound"),
    )  # fmt: skip

    def make(row: dict[str, Any]) -> list[Cell]:
        virtual = row["virtual"]
        low, high = format_us(virtual["min_ns"]), format_us(virtual["max_ns"])
        return [
            Cell(row["name"], is_long=True), Cell(low if low == high else f"{low} to {high}"), make_time(virtual["reaction_max_ns"]),
            *_list_times(row["measured"], ("p50", "p99", "p999", "max")), Cell(str(row["broken"])), _make_count(row["violation_count"]),
        ]  # fmt: skip

    return make_table("Chains, from sample to effect", columns, record["chains"], make, (record["chain_note"],) if record["chain_note"] else ())


def _make_misses(record: dict[str, Any]) -> Table:
    columns = (Column("cycle"), Column("window", is_number=False), Column("outcome", is_number=False), Column("to blame", is_number=False),
               Column("component", is_number=False), Column("late"), Column("what happened", is_number=False))  # fmt: skip

    def make(row: dict[str, Any]) -> list[Cell]:
        return [
            Cell(str(row["cycle"])), Cell(row["window"], is_name=True), Cell(row["outcome"]),
            Cell(row.get("verdict", "host" if row["is_host"] else "code"), is_bad=not row["is_host"]), Cell(row["component"] or ABSENT, is_name=True),
            make_time(row["late_ns"]), Cell(row["reason"], is_long=True),
        ]  # fmt: skip

    count = record["miss_count"]
    title = f"Missed and overrun openings: {count if count else 'none'}"
    return make_table(title, columns, record["misses"], make, shown=MISSES_SHOWN, count=count, is_folded=True, where="timing.json")


def _make_estimates(record: dict[str, Any]) -> Table:
    columns = (Column("component", is_number=False), Column("result", is_number=False), Column("value, or why there is none", is_number=False))

    def make(row: dict[str, Any]) -> list[Cell]:
        one = row["extreme_values"]
        values = ", ".join(f"exceeded with {each['exceeded_with']:g} per opening: {format_us(each['value_ns'])} µs" for each in one["quantiles"])
        is_refused = one["refusal"] is not None
        return [
            Cell(row["component"], is_name=True),
            Cell("refused" if is_refused else "given"),
            Cell(one["refusal"] if is_refused else values or ABSENT, is_long=True),
        ]

    refused = sum(row["extreme_values"]["refusal"] is not None for row in record["components"])
    title = f"Extreme-value estimates: {len(record['components']) - refused} given, {refused} refused"
    return make_table(title, columns, record["components"], make, is_folded=True)


def make_table(
    title: str,
    columns: tuple[Column, ...],
    rows: Sequence[dict[str, Any]],
    make: Callable[[dict[str, Any]], list[Cell]],
    notes: tuple[str, ...] = (),
    *,
    shown: int = ROWS_SHOWN,
    count: int | None = None,
    is_folded: bool = False,
    where: str = "timing.txt",
) -> Table:
    """@param make creates the cells of one row. @param count of all rows; default: the number of given rows. Empty columns are omitted."""
    cells = [make(row) for row in rows[:shown]]
    filled = [index for index in range(len(columns)) if not cells or any(row[index].text not in ("", ABSENT) for row in cells)]
    return Table(title, tuple(columns[index] for index in filled), [[row[index] for index in filled] for row in cells],
                 len(rows) if count is None else count, notes, is_folded, where)  # fmt: skip


def _list_times(times: dict[str, int] | None, names: tuple[str, ...]) -> list[Cell]:
    return [make_time(times[name] if times else None) for name in names]


def make_time(ns: float | None) -> Cell:
    """A time in us; a dash if there is none."""
    return Cell(format_us(ns))


def make_margin(ns: float | None) -> Cell:
    """Remaining margin of a limit, in us; bad if it is negative."""
    return Cell(format_us(ns).replace("-", "−"), is_bad=ns is not None and ns < 0)


def _make_count(count: int) -> Cell:
    return Cell(str(count), is_bad=count > 0)


def _list_machine(record: dict[str, Any]) -> list[tuple[str, str]]:
    setting, before, after = (record["host"][key] for key in ("setting", "before", "after"))
    frequency = [f"{state['frequency_khz'] / 1000:.0f} MHz" if state["frequency_khz"] else "unknown" for state in (before, after)]
    return [
        ("Kernel version", setting["kernel_version"]),
        ("Isolated cores", setting["isolated_cores"] or "none"),
        ("Frequency before, after", ", ".join(frequency)),
    ]


def _list_pictures(run: TimingRun, room_bytes: int, problems: list[Problem]) -> list[tuple[str, Picture]]:
    pictures = []
    for name, caption in PICTURES:
        try:
            picture = read_picture(Path(run.folder), name, room_bytes)
        except FormatError as error:
            picture = Picture("", str(error))
            problems.append(Problem(UNREADABLE, run.place, picture.reason))
        if picture is not None:
            room_bytes -= len(picture.address)
            pictures.append((caption, picture))
    return pictures
