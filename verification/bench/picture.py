# SPDX-License-Identifier: Apache-2.0
"""The picture of a run: the ratio of every acceptance limit on one logarithmic axis, and the measured times.

@satisfies SWR-BEN-004      Design: docs/design/bench.md#record
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
from matplotlib.figure import Figure
from matplotlib.ticker import FixedFormatter, FixedLocator, NullFormatter, NullLocator

from mamori_trace.base.whole_file import whole_file
from verification.bench.judge import PASSED, RatioResult
from verification.bench.record import Run
from verification.bench.samples import Samples
from verification.bench.table import SIZE_UNITS, format_ratio, format_time

# All readers can distinguish these, also in grey: verdicts differ in shape and colour.
GOOD, BAD, INK, FAINT = "#0072b2", "#d55e00", "#222222", "#bbbbbb"
OURS = ("#0072b2", "#56b4e9")
OTHERS = ("#222222", "#777777", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#8c564b")
MARKERS = "sDv^<>P"
SUFFIXES = (".svg", ".png")
ROW_INCH = 0.27
LABEL_SHARE = 0.4  # space for the figures on the right, as a share of the logarithmic axis


def draw_run(run: Run, folder: Path, subtitle: str) -> list[Path]:
    """Writes bench.svg and bench.png, each atomically. @return their paths; none if nothing was measured."""
    if run.samples is None:
        return []
    ratios = [one for one in run.ratios if one.ratio is not None]
    metrics = [metric for metric in ("port", "scheduler") if any(name == metric for name, _ in run.samples.cases)]
    upper = 0.9 + ROW_INCH * len(ratios) if ratios else 0.0
    lower = 3.9 if metrics else 0.0
    if not upper + lower:
        return []
    figure = Figure(figsize=(11.0, upper + lower + 0.8), layout="constrained")
    figure.suptitle("Mamori: cost beside floors and peers, medians of one run\n", fontsize=13, color=INK)
    figure.text(0.5, 1.0 - 0.42 / (upper + lower + 0.8), subtitle, ha="center", va="top", fontsize=8.5, color=INK)
    parts = figure.subfigures(2 if upper and lower else 1, 1, squeeze=False,
                              height_ratios=[part for part in (upper, lower) if part])  # fmt: skip
    if ratios:
        _draw_ratios(parts[0, 0].subplots(), ratios)
    if metrics:
        axes = parts[-1, 0].subplots(1, len(metrics), squeeze=False)
        for axis, metric in zip(axes[0], metrics, strict=True):
            _draw_times(axis, run.samples, metric)
    return [_save(figure, folder / f"bench{suffix}") for suffix in SUFFIXES]


def _save(figure: Figure, path: Path) -> Path:
    with whole_file(path) as part:
        figure.savefig(part, format=path.suffix[1:], dpi=130, metadata={"Date": None} if path.suffix == ".svg" else None)
    return path


def _draw_ratios(axis: Any, ratios: Sequence[RatioResult]) -> None:
    for row, one in enumerate(ratios):
        colour = GOOD if one.verdict == PASSED else BAD
        axis.plot([one.lowest, one.highest], [row, row], color=colour, linewidth=3.0, alpha=0.35, solid_capstyle="butt")
        axis.plot([one.ratio], [row], marker="o" if one.verdict == PASSED else "X", color=colour, markersize=7)
        axis.plot([one.limit, one.limit], [row - 0.38, row + 0.38], color=INK, linewidth=2.0)
        limit = f"{'advisory ' if one.kind == 'advisory' else ''}limit {one.limit:g}"
        text = f"{format_ratio(one.ratio or 0.0)}  ({one.verdict}, {limit})"
        axis.annotate(text, (max(one.highest or 0.0, one.limit), row), xytext=(8, 0), textcoords="offset points",
                      va="center", fontsize=8.5, color=colour)  # fmt: skip
    labels = [f"{one.id}  {one.title}, {one.size} {SIZE_UNITS.get(one.metric, '')}  /  {one.against}" for one in ratios]
    axis.set_yticks(range(len(ratios)), labels, fontsize=8.5)
    axis.invert_yaxis()
    left, right = min(one.lowest or 1.0 for one in ratios), max(one.highest or 1.0 for one in ratios)
    _set_log(axis.xaxis, axis, "x", left, right * (right / left) ** LABEL_SHARE)
    axis.set_xlabel("ours / floor or peer, or ours at 1000 / ours at 10 (logarithmic); black line: limit, band: all rounds",
                    fontsize=9)  # fmt: skip
    axis.grid(axis="x", color=FAINT, linewidth=0.6)
    axis.set_axisbelow(True)


def _draw_times(axis: Any, samples: Samples, metric: str) -> None:
    cases = [case for (name, _), case in samples.cases.items() if name == metric]
    names = list(dict.fromkeys(name for case in cases for name in case.series))
    ours, others = list(OURS), list(zip(OTHERS, MARKERS, strict=True))
    for name in names:
        points = [(case.size, case.series[name].p50_ns) for case in cases if name in case.series]
        is_ours = name.startswith("mamori")
        colour, marker = (ours.pop(0), "o") if is_ours and ours else others.pop(0)
        axis.plot(*zip(*points, strict=True), color=colour, marker=marker, markersize=5, linewidth=2.6 if is_ours else 1.2,
                  label=f"{name} ({format_time(points[0][1])} .. {format_time(points[-1][1])})")  # fmt: skip
    sizes = [case.size for case in cases]
    axis.set_xscale("log")
    axis.xaxis.set_major_locator(FixedLocator(sizes))
    axis.xaxis.set_minor_locator(NullLocator())
    axis.xaxis.set_major_formatter(FixedFormatter([f"{size}" for size in sizes]))
    times = [one.p50_ns for case in cases for one in case.series.values()]
    _set_log(axis.yaxis, axis, "y", min(times), max(times))
    axis.set_xlabel({"port": "payload [B]", "scheduler": "components"}.get(metric, metric), fontsize=9)
    axis.set_ylabel(cases[0].unit, fontsize=9)
    axis.set_title(metric, fontsize=10, color=INK)
    axis.grid(color=FAINT, linewidth=0.6)
    axis.legend(fontsize=7.5, frameon=False, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=2)


def _set_log(side: Any, axis: Any, name: str, lowest: float, highest: float) -> None:
    """A logarithmic axis with plain numbers at 1, 2 and 5 of each decade, or at 1 if there are many decades."""
    decades = [10.0**exponent for exponent in range(-4, 7)]
    steps = (1.0, 2.0, 5.0) if highest / lowest < 3000.0 else (1.0,)
    ticks = [step * decade for decade in decades for step in steps if 0.5 * lowest <= step * decade <= 2.0 * highest]
    (axis.set_xscale if name == "x" else axis.set_yscale)("log")
    (axis.set_xlim if name == "x" else axis.set_ylim)(0.7 * lowest, 1.4 * highest)
    side.set_major_locator(FixedLocator(ticks))
    side.set_minor_locator(NullLocator())
    side.set_major_formatter(FixedFormatter([f"{tick:g}" for tick in ticks]))
    side.set_minor_formatter(NullFormatter())
