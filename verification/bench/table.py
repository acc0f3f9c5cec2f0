# SPDX-License-Identifier: Apache-2.0
"""Prints a run on one screen.

@satisfies SWR-BEN-002, SWR-BEN-004      Design: docs/design/bench.md#record
"""

from __future__ import annotations

from collections.abc import Sequence

from mamori_tools.host.console import Screen
from verification.bench.baseline import CountResult
from verification.bench.judge import ABSENT, RatioResult
from verification.bench.record import Run
from verification.bench.samples import Samples

Row = tuple[str, ...]
SIZE_UNITS = {"port": "B", "e2e": "B", "scheduler": "components", "wake-up": "B", "fifo": "B", "grid": "% of wake-ups"}


def show_run(run: Run, screen: Screen) -> None:
    """Prints the tables of `run`, except tables without measurements."""
    if run.samples:
        for metric in dict.fromkeys(metric for metric, _ in run.samples.cases):
            screen.say()
            screen.print_table(*tabulate_times(run.samples, metric))
        for name, reason in run.samples.absent.items():
            screen.say(f"{name}: {ABSENT}: {reason}")
    if run.ratios:
        screen.say()
        screen.print_table(*tabulate_ratios(run.ratios))
    if run.counts:
        screen.say()
        screen.print_table(*tabulate_counts(run.counts))
    if run.proofs:
        found = [f"{name}: {text}" for name, text in run.proofs.items() if text]
        screen.say()
        screen.say("heap and system calls after start: " + ("; ".join(found) if found else "none"))


def tabulate_times(samples: Samples, metric: str) -> tuple[Row, list[Row]]:
    """Medians of one metric: a row per subject (also for a missing reference implementation), a column per size."""
    cases = [case for (name, _), case in samples.cases.items() if name == metric]
    names = list(dict.fromkeys(name for case in cases for name in case.series))
    heads = (f"{metric}: {cases[0].unit}", *(f"{case.size} {SIZE_UNITS.get(metric, '')}".strip() for case in cases))
    rows = [(name, *(format_time(case.series[name].p50_ns) if name in case.series else "-" for case in cases)) for name in names]
    return heads, rows


def tabulate_ratios(ratios: Sequence[RatioResult]) -> tuple[Row, list[Row]]:
    rows: list[Row] = []
    for one in ratios:
        size = f"{one.size} {SIZE_UNITS.get(one.metric, '')}".strip()
        if one.ratio is None:
            rows.append((one.id, f"{one.title}, {size}", one.against, "-", "-", f"{one.limit:g}", one.verdict, one.note))
            continue
        spread = f"{format_ratio(one.lowest or 0.0)} .. {format_ratio(one.highest or 0.0)}"
        note = one.note or ("advisory" if one.kind == "advisory" else "")
        rows.append((one.id, f"{one.title}, {size}", one.against, format_ratio(one.ratio), spread, f"{one.limit:g}",
                     one.verdict, note))  # fmt: skip
    return ("bar", "ours", "against", "ratio", "over the rounds", "limit", "result", ""), rows


def tabulate_counts(counts: Sequence[CountResult]) -> tuple[Row, list[Row]]:
    def show(number: int | None) -> str:
        return "-" if number is None else str(number)

    rows: list[Row] = [(one.id, one.title, str(one.count), show(one.baseline), show(one.limit), one.verdict, one.note) for one in counts]
    return ("bar", "exact instructions", "count", "baseline", "limit", "result", ""), rows


def format_time(ns: float) -> str:
    """Three significant digits."""
    return f"{ns:.2f}" if ns < 10.0 else f"{ns:.1f}" if ns < 100.0 else f"{ns:.0f}"


def format_ratio(ratio: float) -> str:
    return f"{ratio:.3f}" if ratio < 0.1 else f"{ratio:.2f}" if ratio < 10.0 else f"{ratio:.1f}"
