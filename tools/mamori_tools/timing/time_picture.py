# SPDX-License-Identifier: Apache-2.0
"""The picture of a run over time: lateness and response of each window, and each loss with its verdict.

@satisfies SWR-TIM-048      Design: docs/design/timing.md#pictures
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import FixedFormatter, FixedLocator, NullLocator

from mamori_tools.timing.analysis import Miss, WindowRow
from mamori_tools.timing.reader import COMPLETED, MISSED, OVERRUN, Array, Measurement
from mamori_tools.timing.text import make_printable, shorten
from mamori_tools.timing.verdict import COMPONENT, NOT_KNOWN, OUTSIDE, OWN_PROCESS

RESPONSE, LATE, LIMIT, INK, FAINT, WARN = "#56b4e9", "#0072b2", "#d55e00", "#222222", "#cccccc", "#b00020"
MARKERS = {COMPONENT: ("X", "#b00020"), OWN_PROCESS: ("^", "#cc79a7"), OUTSIDE: ("o", "#666666"), NOT_KNOWN: ("s", "#999999")}
"""Shape and colour of each verdict; the shapes differ also in grey."""
COLUMNS = 500
"""Maximum number of points per curve: each shows the maximum of its interval, so that no late start disappears."""
ROWS_MAX = 16
ROW_INCH = 1.5
WIDTH_INCH = 11.0
TITLE_LENGTH = 68


@dataclass(frozen=True)
class Curve:
    """Maxima [ns] over time [s], at most COLUMNS of them."""

    times_s: Array
    values_ns: Array


def make_curve(releases: Array, values: Array, first_ns: int, last_ns: int) -> Curve:
    """The maximum of each of COLUMNS equal intervals of the run, at its instant; all values if there are fewer."""
    if len(values) <= COLUMNS:
        return Curve((releases - first_ns) / 1e9, values)
    column = ((releases - first_ns) * COLUMNS // max(1, last_ns - first_ns + 1)).astype(np.int64)
    order = np.lexsort((values, column))
    last = np.flatnonzero(np.append(column[order][1:] != column[order][:-1], True))
    chosen = order[last]
    return Curve((releases[chosen] - first_ns) / 1e9, values[chosen])


def make_time_figure(run: Measurement, windows: Sequence[WindowRow], misses: Sequence[Miss], subtitle: str, marks: Sequence[str]) -> Figure:
    """One row per window, with a common time axis."""
    first, last = int(run.openings["release_ns"].min()), int(run.openings["release_ns"].max())
    worst = sorted(range(len(windows)), key=lambda index: -(windows[index].lateness.max if windows[index].lateness else 0))  # type: ignore[union-attr]
    shown = sorted(worst[:ROWS_MAX])
    height = ROW_INCH * len(shown) + 1.7 + 0.25 * len(marks)
    figure = Figure(figsize=(WIDTH_INCH, height))
    lines = [("Lateness and response of each window over the time of the run", 13, INK, "normal"), (subtitle, 8.5, INK, "normal"),
             *((mark, 9.5, WARN, "bold") for mark in marks)]  # fmt: skip
    if len(shown) < len(windows):
        lines.append((f"the {len(shown)} of {len(windows)} with the maximum lateness", 8.5, INK, "normal"))
    y = height - 0.12
    for text, size, colour, weight in lines:
        figure.text(0.5, y / height, text, ha="center", va="top", fontsize=size, color=colour, weight=weight, parse_math=False)
        y -= size / 72 * 1.5
    axes = figure.subplots(len(shown), 1, squeeze=False, sharex=True, gridspec_kw={
        "left": 0.065, "right": 0.985, "bottom": 0.55 / height, "top": (y - 0.28) / height, "hspace": 0.5})[:, 0]  # fmt: skip
    for index, axis in zip(shown, axes, strict=True):
        _draw_window(axis, run, index, first, last)
        _draw_misses(axis, [miss for miss in misses if miss.window == windows[index].window], first)
        axis.legend(fontsize=7.5, frameon=False, loc="upper right", bbox_to_anchor=(1.0, 1.3), ncols=7, borderaxespad=0.0)
    axes[-1].set_xlim(0.0, max((last - first) / 1e9, 1e-6) * 1.01)
    axes[-1].set_xlabel("time of the run [s]", fontsize=9)
    return figure


def _draw_window(axis: Any, run: Measurement, index: int, first: int, last: int) -> None:
    rows = run.openings[run.rows_of(index)]
    late = rows[np.isin(rows["outcome"], (COMPLETED, OVERRUN, MISSED))]
    ran = rows[np.isin(rows["outcome"], (COMPLETED, OVERRUN))]
    window = run.table.windows[index]
    for name, chosen, values, colour in (("response", ran, ran["closed_ns"] - ran["release_ns"], RESPONSE),
                                         ("lateness", late, late["woke_ns"] - late["release_ns"], LATE)):  # fmt: skip
        curve = make_curve(chosen["release_ns"], values, first, last)
        axis.plot(curve.times_s, np.maximum(curve.values_ns, 1) / 1e3, color=colour, linewidth=0.8, label=name)
    axis.axhline(window.length_ns / 1e3, color=LIMIT, linewidth=1.2, label="window length")
    axis.set_yscale("log")
    low, high = axis.get_ylim()
    steps = (1.0, 2.0, 5.0) if high < 100.0 * low else (1.0,)
    ticks = [step * 10.0**exponent for exponent in range(-4, 9) for step in steps if low <= step * 10.0**exponent <= high]
    axis.yaxis.set_major_locator(FixedLocator(ticks))
    axis.yaxis.set_minor_locator(NullLocator())
    axis.yaxis.set_major_formatter(FixedFormatter([f"{tick:g}" for tick in ticks]))
    axis.set_ylabel("µs", fontsize=8.5)
    axis.tick_params(labelsize=8)
    axis.grid(color=FAINT, linewidth=0.6)
    axis.set_axisbelow(True)
    axis.set_title(make_printable(shorten(f"window {window.name}", TITLE_LENGTH)), fontsize=9.5, color=INK, loc="left", parse_math=False)


def _draw_misses(axis: Any, misses: Sequence[Miss], first: int) -> None:
    for verdict, (shape, colour) in MARKERS.items():
        of_it = [miss for miss in misses if miss.verdict == verdict]
        curve = make_curve(np.array([miss.release_ns for miss in of_it], np.int64), np.array([miss.late_ns for miss in of_it], np.int64), first,
                           max((miss.release_ns for miss in of_it), default=first))  # fmt: skip
        if of_it:
            axis.plot(curve.times_s, np.maximum(curve.values_ns, 1) / 1e3, linestyle="", marker=shape, markersize=5, color=colour,
                      label=f"lost: {verdict} ({len(of_it)})")  # fmt: skip
