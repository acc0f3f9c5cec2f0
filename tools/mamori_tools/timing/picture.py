# SPDX-License-Identifier: Apache-2.0
"""The pictures of a run: release lateness of windows, execution times of components, end-to-end times of chains.

@satisfies SWR-TIM-027      Design: docs/design/timing.md#pictures
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedFormatter, FixedLocator, NullFormatter, NullLocator

from mamori_tools.timing.analysis import calc_execution, calc_lateness
from mamori_tools.timing.reader import Array
from mamori_tools.timing.report import Report
from mamori_tools.timing.text import format_us, make_printable, shorten
from mamori_tools.timing.time_picture import make_time_figure
from mamori_trace.base.whole_file import whole_file

# All readers can distinguish these, also in grey: measurement, limit, and additional lines.
MEASURED, LIMIT, INK, FAINT, WARN = "#0072b2", "#d55e00", "#222222", "#cccccc", "#b00020"
SUFFIXES = (".svg", ".png")
ROWS_MAX = 16
"""Maximum number of drawn rows. The worst ones are drawn; timing.json contains all."""
BINS = 80
POINTS_MAX = 2000
ROW_INCH = 1.5
TITLE_LENGTH = 68
WIDTH_INCH = 11.0
LOGARITHMIC_FROM = 20.0
"""From this ratio of maximum to minimum on, a time axis is logarithmic."""


@dataclass(frozen=True)
class Limit:
    """A line at `ns` with its name."""

    name: str
    ns: int


@dataclass(frozen=True)
class Row:
    """One row of a picture: measured values [ns] and their limits."""

    title: str
    values: Array
    limits: tuple[Limit, ...] = ()


def draw_report(report: Report, folder: Path) -> list[Path]:
    """Writes each picture as SVG and PNG, each atomically. @return their paths."""
    pictures = {
        "release_lateness": ("Release lateness: first clock reading after the wake-up, minus the planned window start", _list_lateness(report)),
        "execution_time": ("Execution time of each component per window instance", _list_execution(report)),
        "chain_latency": ("End-to-end latency: start of the first component to end of the last one", _list_latency(report)),
    }
    paths = []
    for name, (title, rows) in pictures.items():
        measured = [row for row in rows if len(row.values)]
        if measured:
            paths += _save(make_figure(title, measured, _make_subtitle(report), report.marks), folder, name)
    figure = make_time_figure(report.run, report.windows, report.misses, _make_subtitle(report), report.marks)
    return [*paths, *_save(figure, folder, "over_time")]


def _list_lateness(report: Report) -> list[Row]:
    table = report.run.table
    return [Row(f"window {window.name}", calc_lateness(report.run, index).values, (Limit("window length", window.length_ns),))
            for index, window in enumerate(table.windows)]  # fmt: skip


def _list_execution(report: Report) -> list[Row]:
    table = report.run.table
    rows = []
    for index, component in enumerate(table.components):
        if component.window is None:
            continue
        window = table.windows[component.window]
        limits = [Limit("budget of its window", window.budget_ns)]
        if component.worst_case_ns is not None:
            limits.append(Limit("declared worst case", component.worst_case_ns))
        rows.append(Row(component.name, calc_execution(report.run, index)[0].values, tuple(limits)))
    return rows


def _list_latency(report: Report) -> list[Row]:
    return [Row(f"{number}: {shorten(row.name, TITLE_LENGTH - 4)}", row.times.values, (Limit("maximum in virtual time", row.virtual.max_ns),))
            for number, row in enumerate(report.chains, start=1)]  # fmt: skip


def _make_subtitle(report: Report) -> str:
    setting = report.host["setting"]
    return (f"{report.system}, {report.run.cycles_run} cycles of {format_us(report.run.table.frame_ns)} µs; kernel {setting['kernel']} "
            f"({setting['preemption']}), governor {setting['governor']}, load {report.host['before']['load_1_min']} .. "
            f"{report.host['after']['load_1_min']}, steal {100 * report.steal_share:.2f} %"
            f"{', with stress-ng' if report.with_load else ''}")  # fmt: skip


def make_figure(title: str, rows: Sequence[Row], subtitle: str, marks: Sequence[str]) -> Figure:
    """One line per row: histogram on the left, tail with limits on the right. All tails share the time axis."""
    worst_first = sorted(range(len(rows)), key=lambda index: -int(rows[index].values.max()))
    shown = [rows[index] for index in sorted(worst_first[:ROWS_MAX])]
    height = ROW_INCH * len(shown) + 1.5 + 0.25 * len(marks)
    figure = Figure(figsize=(WIDTH_INCH, height))
    lines = [(title, 13, INK, "normal"), (subtitle, 8.5, INK, "normal"), *((mark, 9.5, WARN, "bold") for mark in marks)]
    if len(shown) < len(rows):
        lines.append((f"the {len(shown)} of {len(rows)} with the highest maximum; timing.json contains all rows", 8.5, INK, "normal"))
    y = height - 0.12
    for text, size, colour, weight in lines:
        figure.text(0.5, y / height, text, ha="center", va="top", fontsize=size, color=colour, weight=weight, parse_math=False)
        y -= size / 72 * 1.5
    axes = figure.subplots(len(shown), 2, squeeze=False, gridspec_kw={
        "left": 0.065, "right": 0.985, "bottom": 0.55 / height, "top": (y - 0.28) / height, "hspace": 0.5, "wspace": 0.17})  # fmt: skip
    low, high = _find_span([float(one) for row in shown for one in (row.values.min(), row.values.max(), *(limit.ns for limit in row.limits))])
    for row, (left, right) in zip(shown, axes, strict=True):
        _draw_histogram(left, row)
        _draw_tail(right, row, low, high)
    for axis in axes[-1]:
        axis.set_xlabel("µs", fontsize=9)
    return figure


def _find_span(values: Sequence[float]) -> tuple[float, float]:
    """@param values times [ns]. @return span [µs] of a time axis that contains all values."""
    low, high = max(1.0, min(values)) / 1e3, max(1.0, max(values)) / 1e3
    if high >= LOGARITHMIC_FROM * low:
        return low / 1.15, high * 1.3
    margin = 0.06 * (high - low) or 0.06 * high
    return low - margin, high + 2 * margin


def _draw_histogram(axis: Any, row: Row) -> None:
    """Detail of the bulk: a separate axis without limits, which may be far away."""
    low, high = _find_span([float(row.values.min()), float(row.values.max())])
    edges = np.geomspace(low, high, BINS) if _is_logarithmic(low, high) else np.linspace(low, high, BINS)
    axis.hist(np.maximum(row.values, 1) / 1e3, bins=edges, color=MEASURED)
    _set_time_axis(axis, low, high)
    axis.set_title(f"{make_printable(shorten(row.title, TITLE_LENGTH))}   (n = {len(row.values)})", fontsize=9.5, color=INK,
                   loc="left", parse_math=False)  # fmt: skip
    axis.set_ylabel("window instances", fontsize=8.5)
    axis.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axis.locator_params(axis="y", nbins=4)


def _draw_tail(axis: Any, row: Row, low: float, high: float) -> None:
    """The exact share of window instances that took longer; each point belongs to the empirical distribution."""
    times, share = calc_tail(row.values)
    axis.step(times / 1e3, share, where="post", color=MEASURED, linewidth=1.6)
    axis.plot(times[-1:] / 1e3, share[-1:], marker="o", markersize=4, color=MEASURED)
    _set_time_axis(axis, low, high)
    axis.set_yscale("log")
    axis.set_ylim(0.5 / len(row.values), 1.6)
    exponents = range(0, -12, -1 if len(row.values) < 3000 else -2)
    ticks = [10.0**exponent for exponent in exponents if 10.0**exponent > 0.5 / len(row.values)]
    axis.yaxis.set_major_locator(FixedLocator(ticks))
    axis.yaxis.set_minor_locator(NullLocator())
    axis.yaxis.set_major_formatter(FixedFormatter([f"{tick:g}" for tick in ticks]))
    _draw_limits(axis, row)
    axis.set_ylabel("share above", fontsize=8.5)
    axis.set_title(f"max {format_us(int(row.values.max()))} µs", fontsize=9.5, color=INK, loc="left")


def calc_tail(values: Array) -> tuple[Array, Array]:
    """@return at most POINTS_MAX points: values [ns], ascending, and the share of larger values. No value exceeds the maximum: it gets its
    own share, because a logarithmic axis has no 0. Contains the complete tail and a part of the bulk."""
    ordered = np.sort(values)
    count = len(ordered)
    from_end = np.unique(np.concatenate((np.arange(min(count, POINTS_MAX // 2)), np.geomspace(1, count, POINTS_MAX // 2).astype(np.int64) - 1)))
    times = np.unique(ordered[count - 1 - from_end])
    above = count - np.searchsorted(ordered, times, side="right")
    return np.maximum(times, 1), np.maximum(above, 1) / count


def _draw_limits(axis: Any, row: Row) -> None:
    for limit, style in zip(row.limits, ("-", "--"), strict=False):
        axis.axvline(limit.ns / 1e3, color=LIMIT, linewidth=1.6, linestyle=style, label=f"{limit.name} {format_us(limit.ns)} µs")
    if row.limits:
        axis.legend(fontsize=8, frameon=False, loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=len(row.limits), borderaxespad=0.1)


def _is_logarithmic(low: float, high: float) -> bool:
    return high >= LOGARITHMIC_FROM * low > 0.0


def _set_time_axis(axis: Any, low: float, high: float) -> None:
    """Plain numbers. On a logarithmic axis at 1, 2 and 5 of each decade, or at 1 if there are many decades."""
    axis.tick_params(labelsize=8)
    axis.grid(color=FAINT, linewidth=0.6)
    axis.set_axisbelow(True)
    if _is_logarithmic(low, high):
        steps = (1.0, 2.0, 5.0) if high / low < 500.0 else (1.0,)
        ticks = [step * 10.0**exponent for exponent in range(-4, 9) for step in steps if low <= step * 10.0**exponent <= high]
        axis.set_xscale("log")
        axis.xaxis.set_major_locator(FixedLocator(ticks))
        axis.xaxis.set_minor_locator(NullLocator())
        axis.xaxis.set_major_formatter(FixedFormatter([f"{tick:g}" for tick in ticks]))
        axis.xaxis.set_minor_formatter(NullFormatter())
    else:
        axis.xaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axis.set_xlim(low, high)


def _save(figure: Figure, folder: Path, name: str) -> list[Path]:
    paths = []
    for suffix in SUFFIXES:
        path = folder / f"{name}{suffix}"
        with whole_file(path) as part:
            figure.savefig(part, format=suffix[1:], dpi=130, metadata={"Date": None} if suffix == ".svg" else None)
        paths.append(path)
    return paths
