# SPDX-License-Identifier: Apache-2.0
"""Draws one campaign case: states as bands, joint positions, joint speeds against their limits, fault and reaction.

@satisfies SWR-TRC-012      Design: docs/design/trace.md#plots
"""

from __future__ import annotations

import io
import itertools
from dataclasses import dataclass
from html import escape

import matplotlib

matplotlib.use("svg")

from matplotlib.axes import Axes  # noqa: E402
from matplotlib.backends.backend_svg import FigureCanvasSVG  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.patches import Patch  # noqa: E402

from mamori.trace.readers.series import JOINTS, Series  # noqa: E402
from mamori.trace.reports.svg import make_inline  # noqa: E402

POINTS_MAX = 400
_JOINT_COLOURS = ("#3b6fb6", "#d07a2d", "#3f8f5b", "#b8474b", "#7a5fa8", "#8a6a4f", "#4a9ea8")
_STATE_COLOURS = {
    "SelfTest": "#d5d9df", "Standby": "#c3d3ea", "Operational": "#bfe0c8", "Degraded": "#f2e2a6",
    "ProtectiveStopSs2": "#f7d9a8", "ProtectiveStopSs1": "#f4c99b", "StandstillHold": "#cfdcc0", "Safe": "#a9c4ee",
    "LockedOut": "#c9b6dd",
}  # fmt: skip
_OTHER_STATE_COLOURS = ("#e3c9d4", "#cfe3df", "#e0dcc8", "#d9d0e6")
_INK = "#333a44"
_FAULT = "#b3261e"
_REACTION = "#1f5fbf"
_STANDSTILL = "#5b6470"
_STYLE = {
    "svg.fonttype": "none", "svg.hashsalt": "mamori", "path.simplify": True, "path.simplify_threshold": 0.15,
    "font.family": "sans-serif", "font.size": 9.0, "axes.edgecolor": "#b9c0ca", "axes.labelcolor": _INK,
    "xtick.color": _INK, "ytick.color": _INK, "text.color": _INK, "axes.spines.top": False, "axes.spines.right": False,
    "axes.linewidth": 0.8, "xtick.major.size": 3.0, "ytick.major.size": 3.0, "grid.color": "#e6e9ee", "grid.linewidth": 0.7,
}  # fmt: skip
_NAMED_BAND_SHARE = 0.09  # a band narrower than this share of the time axis has no room for its name


@dataclass(frozen=True, slots=True)
class Marks:
    """What is marked in a figure: instants [s] (None: did not happen) and the speed limit of each joint [rad/s]."""

    fault_s: float | None
    reaction_s: float | None
    standstill_s: float | None
    speed_limit_rad_s: list[float]


def draw_case(series: Series, marks: Marks, prefix: str, title: str) -> str:
    """An inline SVG of one run. `prefix` makes its ids unique in the page."""
    with matplotlib.rc_context(_STYLE):
        figure = Figure(figsize=(9.0, 5.6), dpi=72)
        bands, positions, speeds = figure.subplots(3, 1, sharex=True, height_ratios=(0.42, 2.0, 2.0))
        figure.subplots_adjust(left=0.075, right=0.985, top=0.885, bottom=0.085, hspace=0.16)
        _draw_states(bands, series)
        _draw_positions(positions, series)
        _draw_speeds(speeds, series, marks.speed_limit_rad_s)
        _mark_instants(bands, (positions, speeds), marks)
        speeds.set_xlim(series.time_s[0], max(series.time_s[-1], series.time_s[0] + 1e-3))
        text = io.StringIO()
        FigureCanvasSVG(figure).print_svg(text, metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    return make_inline(text.getvalue(), prefix, escape(title, quote=True))


def pick_samples(values: list[float], count_max: int = POINTS_MAX) -> list[int]:
    """Indices of at most `count_max` samples that keep the ends and every peak: smallest and largest value of each bucket."""
    count = len(values)
    if count <= count_max:
        return list(range(count))
    buckets = (count_max - 2) // 2
    chosen = {0, count - 1}
    for bucket in range(buckets):
        span = range(bucket * count // buckets, (bucket + 1) * count // buckets)
        chosen.add(min(span, key=values.__getitem__))
        chosen.add(max(span, key=values.__getitem__))
    return sorted(chosen)


def list_bands(series: Series) -> list[tuple[str, float, float]]:
    """(state, from, to) for each stretch of one state; a stretch ends where the next one begins."""
    bands: list[tuple[str, float, float]] = []
    start = 0
    for index in range(1, len(series.state) + 1):
        if index == len(series.state) or series.state[index] != series.state[start]:
            end = series.time_s[min(index, len(series.state) - 1)]
            bands.append((series.state[start], series.time_s[start], end))
            start = index
    return bands


def _draw_states(axes: Axes, series: Series) -> None:
    bands = list_bands(series)
    length_s = max(series.time_s[-1] - series.time_s[0], 1e-9)
    colours = dict(_STATE_COLOURS)
    unknown = sorted({state for state, _, _ in bands} - set(colours))
    colours.update(zip(unknown, itertools.cycle(_OTHER_STATE_COLOURS)))
    narrow: dict[str, str] = {}
    for state, begin_s, end_s in bands:
        axes.axvspan(begin_s, end_s, color=colours[state], linewidth=0)
        if (end_s - begin_s) / length_s >= _NAMED_BAND_SHARE:
            axes.text((begin_s + end_s) / 2, 0.5, state, ha="center", va="center", fontsize=8.5)
        else:
            narrow[state] = colours[state]
    if narrow:
        handles = [Patch(color=colour, label=state) for state, colour in narrow.items()]
        axes.legend(handles=handles, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(handles), frameon=False,
                    fontsize=8.0, handlelength=1.0, handleheight=0.9, borderpad=0.1, columnspacing=1.0)  # fmt: skip
    axes.set_ylim(0, 1)
    axes.set_yticks([])
    axes.set_ylabel("state", rotation=0, ha="right", va="center")
    axes.spines[:].set_visible(False)
    axes.tick_params(axis="x", length=0, labelbottom=False)


def _draw_positions(axes: Axes, series: Series) -> None:
    for joint in range(JOINTS):
        _draw_line(axes, series, series.position_rad[joint], joint)
    axes.set_ylabel("joint position [rad]")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.985), ncols=JOINTS, frameon=False, fontsize=8.0,
                handlelength=1.1, columnspacing=0.9, handletextpad=0.4, borderpad=0.0)  # fmt: skip
    axes.grid(axis="y")
    axes.tick_params(axis="x", labelbottom=False)


def _draw_speeds(axes: Axes, series: Series, limits_rad_s: list[float]) -> None:
    """Speeds as shares of each joint's own limit, so that one line is the limit of all."""
    largest = 1.0
    for joint in range(JOINTS):
        shares = [speed / limits_rad_s[joint] for speed in series.speed_rad_s[joint]]
        largest = max(largest, *(abs(share) for share in shares))
        _draw_line(axes, series, shares, joint)
    for limit in (-1.0, 1.0):
        axes.axhline(limit, color=_FAULT, linewidth=1.0, linestyle=(0, (5, 3)))
    axes.text(0.004, 1.0, "limit", color=_FAULT, fontsize=8.0, va="bottom", ha="left", transform=axes.get_yaxis_transform())
    axes.set_ylim(-1.18 * largest, 1.18 * largest)
    axes.set_ylabel("joint speed / its limit")
    axes.set_xlabel("time [s]")
    axes.grid(axis="y")


def _draw_line(axes: Axes, series: Series, values: list[float], joint: int) -> None:
    chosen = pick_samples(values)
    axes.plot([series.time_s[i] for i in chosen], [values[i] for i in chosen],
              color=_JOINT_COLOURS[joint], linewidth=1.15, label=f"J{joint + 1}")  # fmt: skip


def _mark_instants(bands: Axes, panels: tuple[Axes, Axes], marks: Marks) -> None:
    """Vertical lines through all panels. Labels: the fault to the left of its line, what follows to the right, stacked."""
    instants = (
        ("fault", marks.fault_s, _FAULT, "-", "right", 1.08),
        ("reaction", marks.reaction_s, _REACTION, "-", "left", 1.08),
        ("standstill", marks.standstill_s, _STANDSTILL, (0, (2, 2)), "left", 1.62),
    )
    for name, time_s, colour, dashes, side, height in instants:
        if time_s is None:
            continue
        for axes in (bands, *panels):
            axes.axvline(time_s, color=colour, linewidth=1.2, linestyle=dashes)
        bands.annotate(f"{name} {time_s:.3f} s", (time_s, height), xycoords=("data", "axes fraction"),
                       xytext=(-4 if side == "right" else 4, 0), textcoords="offset points",
                       color=colour, fontsize=8.5, ha=side, va="bottom", annotation_clip=False)  # fmt: skip
