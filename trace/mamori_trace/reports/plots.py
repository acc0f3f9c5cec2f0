# SPDX-License-Identifier: Apache-2.0
"""Draws one campaign case: states as bands, joint positions, joint speeds against their limits, fault and reaction.

Each case has a drawing of the complete run and one of the 100 ms around the fault. Both have the same time base: seconds since the start of
the run. The font suits a screen of 400 pixels; keys and instants are shown as text next to the drawings.

@satisfies SWR-TRC-012, SWR-TRC-111      Design: docs/design/trace.md#plots
"""

from __future__ import annotations

import io
import itertools
from dataclasses import dataclass
from html import escape
from typing import TYPE_CHECKING, Any

import matplotlib

matplotlib.use("svg")

from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from mamori_trace.readers.series import JOINTS, Series
from mamori_trace.reports.svg import make_inline

if TYPE_CHECKING:
    from matplotlib.typing import RcKeyType

POINTS_MAX = 260
NEAR_BEFORE_S = 0.02
NEAR_AFTER_S = 0.08
"""Time shown before and after a fault [s]."""
JOINT_COLOURS = ("#3b6fb6", "#d07a2d", "#3f8f5b", "#b8474b", "#7a5fa8", "#8a6a4f", "#4a9ea8")
_STATE_COLOURS = {
    "SelfTest": "#d5d9df", "Standby": "#c3d3ea", "Operational": "#bfe0c8", "Degraded": "#f2e2a6",
    "ProtectiveStopSs2": "#f7d9a8", "ProtectiveStopSs1": "#f4c99b", "StandstillHold": "#cfdcc0", "Safe": "#a9c4ee",
    "LockedOut": "#c9b6dd",
}  # fmt: skip
_OTHER_STATE_COLOURS = ("#e3c9d4", "#cfe3df", "#e0dcc8", "#d9d0e6")
_INK = "#333a44"
FAULT_COLOUR = "#b3261e"
REACTION_COLOUR = "#1f5fbf"
STANDSTILL_COLOUR = "#5b6470"
_FONT = 12.5
_LETTER = 0.58 * _FONT
"""Mean width of a letter, in drawing units; determines whether the name of a state fits its band."""
_WIDTH_INCHES, _HEIGHT_INCHES, _DPI = 5.2, 5.0, 72
_LEFT, _RIGHT = 0.135, 0.955
_STYLE: dict[RcKeyType, Any] = {
    "svg.fonttype": "none", "svg.hashsalt": "mamori", "path.simplify": True, "path.simplify_threshold": 0.15,
    "font.family": "sans-serif", "font.size": _FONT, "axes.edgecolor": "#b9c0ca", "axes.labelcolor": _INK, "axes.titlesize": _FONT,
    "axes.titlelocation": "left", "axes.titlepad": 4.0, "xtick.color": _INK, "ytick.color": _INK, "text.color": _INK,
    "axes.spines.top": False, "axes.spines.right": False, "axes.linewidth": 0.8, "xtick.major.size": 3.0, "ytick.major.size": 3.0,
    "grid.color": "#e6e9ee", "grid.linewidth": 0.7,
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class Marks:
    """Marks of a drawing: instants [s] (None: did not occur), the speed limit of each joint [rad/s], and the faulty joint, drawn thicker
    and counted from 1 (None: none)."""

    fault_s: float | None
    reaction_s: float | None
    standstill_s: float | None
    speed_limit_rad_s: list[float]
    joint: int | None = None

    def list_instants(self) -> list[tuple[str, float, str]]:
        """(name, instant [s], colour) of each existing mark."""
        marks = (("fault", self.fault_s, FAULT_COLOUR), ("reaction", self.reaction_s, REACTION_COLOUR),
                 ("standstill", self.standstill_s, STANDSTILL_COLOUR))  # fmt: skip
        return [(name, time_s, colour) for name, time_s, colour in marks if time_s is not None]

    def find_near(self, series: Series) -> tuple[float, float] | None:
        """The 100 ms around the fault [s]; None without a fault inside the run."""
        if self.fault_s is None or not series.time_s[0] <= self.fault_s <= series.time_s[-1]:
            return None
        return self.fault_s - NEAR_BEFORE_S, self.fault_s + NEAR_AFTER_S


@dataclass(frozen=True, slots=True)
class Drawing:
    """An inline SVG and its description."""

    caption: str
    svg: str


def draw_case(series: Series, marks: Marks, prefix: str, title: str) -> list[Drawing]:
    """The complete run, then the 100 ms around the fault, if there is one. `prefix` makes ids unique in the page."""
    near = marks.find_near(series)
    drawings = [Drawing("Whole run", _draw(series, marks, None, near, f"{prefix}w", f"{title}; whole run"))]
    if near is not None:
        caption = f"100 ms around the fault, from {near[0]:.3f} s to {near[1]:.3f} s"
        drawings.append(Drawing(caption, _draw(_cut(series, near), marks, near, None, f"{prefix}n", f"{title}; {caption}")))
    return drawings


def list_state_colours(series: Series) -> dict[str, str]:
    """Colour of each state of the run, in the order of their first appearance."""
    states = list(dict.fromkeys(series.state))
    others = itertools.cycle(_OTHER_STATE_COLOURS)
    unknown = {state: next(others) for state in sorted(states) if state not in _STATE_COLOURS}
    return {state: _STATE_COLOURS.get(state) or unknown[state] for state in states}


def pick_samples(values: list[float], count_max: int = POINTS_MAX) -> list[int]:
    """Indices of at most `count_max` samples that keep the ends and all peaks: minimum and maximum of each bucket."""
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
    """(state, from, to) for each interval in one state; an interval ends where the next one begins."""
    bands: list[tuple[str, float, float]] = []
    start = 0
    for index in range(1, len(series.state) + 1):
        if index == len(series.state) or series.state[index] != series.state[start]:
            end = series.time_s[min(index, len(series.state) - 1)]
            bands.append((series.state[start], series.time_s[start], end))
            start = index
    return bands


def _cut(series: Series, span: tuple[float, float]) -> Series:
    """The samples inside `span`, with one more at each end, so that lines reach the edges."""
    inside = [index for index, time_s in enumerate(series.time_s) if span[0] <= time_s <= span[1]]
    first, last = (inside[0], inside[-1]) if inside else (0, 0)
    part = slice(max(0, first - 1), last + 2)
    return Series(series.time_s[part], [row[part] for row in series.position_rad], [row[part] for row in series.speed_rad_s],
                  series.state[part])  # fmt: skip


def _draw(series: Series, marks: Marks, span: tuple[float, float] | None, shaded: tuple[float, float] | None, prefix: str, title: str) -> str:
    """@param span time axis [s], default: all of `series`. @param shaded span of another drawing."""
    first, last = span or (series.time_s[0], max(series.time_s[-1], series.time_s[0] + 1e-3))
    with matplotlib.rc_context(_STYLE):
        figure = Figure(figsize=(_WIDTH_INCHES, _HEIGHT_INCHES), dpi=_DPI)
        states, positions, speeds = figure.subplots(3, 1, sharex=True, height_ratios=(0.34, 2.0, 2.0))
        for axes in (states, positions, speeds):
            axes.set_title("", y=1.0)  # a fixed position; otherwise each drawing would measure all labels to place the title
        figure.subplots_adjust(left=_LEFT, right=_RIGHT, top=0.885, bottom=0.105, hspace=0.24)
        _draw_states(states, series, (first, last))
        _draw_positions(positions, series, marks, span is not None)
        _draw_speeds(speeds, series, marks)
        if shaded:
            for axes in (positions, speeds):
                axes.axvspan(*shaded, color="#eef1f5", linewidth=0, zorder=0)
        _mark_instants(states, (positions, speeds), marks, (first, last))
        speeds.set_xlim(first, last)
        speeds.xaxis.set_major_locator(MaxNLocator(5 if span else 6))
        if span:
            speeds.xaxis.set_major_formatter("{x:.3f}")
        text = io.StringIO()
        FigureCanvasSVG(figure).print_svg(text, metadata={"Date": None, "Creator": None, "Format": None, "Type": None})
    return make_inline(text.getvalue(), prefix, escape(title, quote=True))


def _draw_states(axes: Axes, series: Series, span: tuple[float, float]) -> None:
    colours = list_state_colours(series)
    units_per_s = _WIDTH_INCHES * _DPI * (_RIGHT - _LEFT) / (span[1] - span[0])
    bands = list_bands(series)
    for state, begin_s, end_s in bands:
        begin_s, end_s = max(begin_s, span[0]), min(end_s, span[1])
        axes.axvspan(begin_s, end_s, color=colours[state], linewidth=0)
        if (end_s - begin_s) * units_per_s >= len(state) * _LETTER + 6:
            axes.text((begin_s + end_s) / 2, 0.46, state, ha="center", va="center", zorder=3,
                      bbox={"facecolor": colours[state], "edgecolor": "none", "pad": 1.0})  # fmt: skip
    axes.set_ylim(0, 1)
    axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.tick_params(axis="x", length=0, labelbottom=False)


def _draw_positions(axes: Axes, series: Series, marks: Marks, is_near: bool) -> None:
    """Near the fault: the change since the fault, because it is much smaller than the distance between the joints."""
    start = next((index for index, time_s in enumerate(series.time_s) if marks.fault_s is not None and time_s >= marks.fault_s), 0)
    for index in range(JOINTS):
        values = series.position_rad[index]
        if is_near:
            values = [1e3 * (value - values[start]) for value in values]
        _draw_line(axes, series, values, index, index + 1 == marks.joint)
    axes.set_title("Joint position, change since the fault [mrad]" if is_near else "Joint position [rad]")
    axes.grid(axis="y")
    axes.tick_params(axis="x", labelbottom=False)


def _draw_speeds(axes: Axes, series: Series, marks: Marks) -> None:
    """Speeds relative to the limit of each joint, so that one line shows the limit of all joints."""
    largest = 1.0
    for index in range(JOINTS):
        shares = [speed / marks.speed_limit_rad_s[index] for speed in series.speed_rad_s[index]]
        largest = max(largest, *(abs(share) for share in shares))
        _draw_line(axes, series, shares, index, index + 1 == marks.joint)
    for limit in (-1.0, 1.0):
        axes.axhline(limit, color=FAULT_COLOUR, linewidth=1.0, linestyle=(0, (5, 3)))
    axes.text(0.004, 1.0, "limit", color=FAULT_COLOUR, va="bottom", ha="left", transform=axes.get_yaxis_transform())
    axes.set_ylim(-1.25 * largest, 1.3 * largest)
    axes.set_title("Joint speed / its limit")
    axes.set_xlabel("time since the start of the run [s]")
    axes.grid(axis="y")


def _draw_line(axes: Axes, series: Series, values: list[float], joint: int, is_thick: bool) -> None:
    chosen = pick_samples(values)
    axes.plot([series.time_s[i] for i in chosen], [values[i] for i in chosen], color=JOINT_COLOURS[joint],
              linewidth=2.6 if is_thick else 1.2, zorder=2.5 if is_thick else 2.0)  # fmt: skip


def _mark_instants(states: Axes, panels: tuple[Axes, Axes], marks: Marks, span: tuple[float, float]) -> None:
    """Vertical lines through all panels. The label of the fault is left of its line, later labels are right of theirs, stacked. Near an
    edge, labels change sides."""
    sides = {"fault": ("right", 1.12), "reaction": ("left", 1.12), "standstill": ("left", 1.95)}
    for name, time_s, colour in marks.list_instants():
        if not span[0] <= time_s <= span[1]:
            continue
        side, height = sides[name]
        dashes = (0, (2, 2)) if name == "standstill" else "-"
        for axes in (states, *panels):
            axes.axvline(time_s, color=colour, linewidth=1.3, linestyle=dashes)
        share = (time_s - span[0]) / (span[1] - span[0])
        side = "left" if share < 0.12 else "right" if share > 0.78 else side
        states.annotate(name, (time_s, height), xycoords=("data", "axes fraction"), xytext=(-4 if side == "right" else 4, 0),
                        textcoords="offset points", color=colour, ha=side, va="bottom", annotation_clip=False)  # fmt: skip
