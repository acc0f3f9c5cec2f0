# SPDX-License-Identifier: Apache-2.0
"""The time line of a system table: one major frame, a lane for each core, a row for each window, its instances as boxes.

@satisfies SWR-TAB-005      Design: docs/design/cost.md#time-line
"""

from __future__ import annotations

from mamori_tools.table.document import Table, Window
from mamori_tools.table.svg import COLOURS, FONT_SIZE, INK, QUIET, Drawing, calc_width, shorten
from mamori_tools.table.words import UNITS, format_time

MARGIN = 16.0
TIME_WIDTH = 1000.0
NAME_WIDTH_MAX = 520.0
LANE_HEIGHT = 30.0
ROW_HEIGHT = 22.0
BOX_HEIGHT = 14.0
HEAD = 44.0
SMALL = 10
SHORT_MIN = 10
"""Minimum letters of a shortened name: fewer are not meaningful."""
BOXES_MAX = 4000
"""Maximum window instances that one row shows individually; more would be finer than a pixel."""


class _Scale:
    """Position of an instant in the major frame [px]."""

    def __init__(self, left: float, frame_ns: int) -> None:
        self.left = left
        self._frame_ns = max(1, frame_ns)

    def at(self, time_ns: int) -> float:
        """Rows that extend beyond the major frame end at its edge."""
        return self.left + TIME_WIDTH * min(max(time_ns / self._frame_ns, 0.0), 1.0)


def make_time_line(table: Table) -> str:
    """The complete picture as SVG."""
    labels = [f"{window.name}  {_format_times(window)}" for window in table.windows]
    name_width = min(NAME_WIDTH_MAX, max([calc_width(label, SMALL + 1) for label in labels], default=0.0) + 12)
    scale = _Scale(MARGIN + name_width, table.frame_ns)
    height = HEAD + sum(LANE_HEIGHT + 10 + ROW_HEIGHT * len(table.windows_of(core)) for core in table.cores()) + 56
    drawing = Drawing(scale.left + TIME_WIDTH + MARGIN + 24, height, "Time line of a system table")
    drawing.text(MARGIN, 22, f"One major frame of {format_time(table.frame_ns)}", bold=True, size=14)
    _draw_legend(drawing, scale.left + TIME_WIDTH)
    ticks = _make_ticks(table.frame_ns)
    for tick in ticks:
        drawing.line(scale.at(tick), HEAD - 4, scale.at(tick), height - 50)
    y = HEAD
    for core in table.cores():
        y = _draw_core(drawing, scale, table, core, y, name_width)
    _draw_axis(drawing, scale, ticks, height - 50, table.frame_ns)
    return drawing.to_text()


def _draw_legend(drawing: Drawing, right: float) -> None:
    pale, full = COLOURS[0]
    drawing.box(right - 210, 12, 18, 12, full, INK)
    drawing.text(right - 186, 22, "budget", colour=QUIET)
    drawing.box(right - 120, 12, 18, 12, pale, INK)
    drawing.text(right - 96, 22, "rest of window", colour=QUIET)


def _draw_core(drawing: Drawing, scale: _Scale, table: Table, core: int, y: float, name_width: float) -> float:
    """The lane of a core, and below it a row for each of its windows. @return position of the next lane."""
    indices = table.windows_of(core)
    drawing.box(MARGIN - 6, y, name_width + TIME_WIDTH + 12, LANE_HEIGHT, "#f1f3f4")
    drawing.text(MARGIN, y + 20, table.core_title(core), bold=True)
    for place, index in enumerate(indices):
        row = y + LANE_HEIGHT + 4 + ROW_HEIGHT * place
        window = table.windows[index]
        colours = COLOURS[place % len(COLOURS)]
        _draw_openings(drawing, scale, table, window, colours, y + 5, LANE_HEIGHT - 10, window.name)
        drawing.line(MARGIN, row + ROW_HEIGHT - 2, scale.left + TIME_WIDTH, row + ROW_HEIGHT - 2)
        times = _format_times(window)
        times_width = calc_width(times, SMALL)
        drawing.text(MARGIN, row + 14, shorten(window.name, name_width - times_width - 14, SMALL + 1), size=SMALL + 1)
        drawing.text(scale.left - 8, row + 14, times, "end", QUIET, size=SMALL)
        _draw_openings(drawing, scale, table, window, colours, row + 3, BOX_HEIGHT, "")
    return y + LANE_HEIGHT + 10 + ROW_HEIGHT * len(indices)


def _draw_openings(drawing: Drawing, scale: _Scale, table: Table, window: Window, colours: tuple[str, str], y: float,
                   height: float, name: str) -> None:  # fmt: skip
    """@param name written into each box with enough space."""
    pale, full = colours
    hint = f"{window.name}: opens at {format_time(window.offset_ns)}, every {format_time(window.period_ns)}, for " \
           f"{format_time(window.length_ns)}; budget {format_time(window.budget_ns)}"  # fmt: skip
    openings = _make_openings(table.frame_ns, window)
    if len(openings) > BOXES_MAX:
        drawing.box(scale.left, y, TIME_WIDTH, height, pale, INK, hint)
        text = f"{len(openings)} openings, every {format_time(window.period_ns)}"
        drawing.text(scale.left + TIME_WIDTH / 2, y + height / 2 + 4, text, "middle", size=SMALL)
        return
    for opening in openings:
        left = scale.at(opening)
        width = scale.at(opening + window.length_ns) - left
        edge = INK if width >= 2 else "none"
        # A window thinner than a pixel stays visible.
        drawing.box(left, y, max(width, 1.0), height, pale, edge, hint)
        drawing.box(left, y, max(scale.at(opening + window.budget_ns) - left, 1.0), height, full, edge, hint)
        short = shorten(name, width - 6)
        if short == name or len(short) >= SHORT_MIN:
            drawing.text(left + width / 2, y + height / 2 + FONT_SIZE / 3, short, "middle")


def _make_openings(frame_ns: int, window: Window) -> range:
    if frame_ns <= 0 or window.period_ns <= 0 or window.offset_ns < 0:
        return range(0)
    return range(window.offset_ns, frame_ns, window.period_ns)


def _format_times(window: Window) -> str:
    return f"{format_time(window.budget_ns)} of {format_time(window.length_ns)} / {format_time(window.period_ns)}"


def _make_ticks(frame_ns: int) -> list[int]:
    """About ten instants at 1, 2 or 5 times a power of ten, which are easy to read."""
    if frame_ns <= 0:
        return [0]
    step = next(factor * 10**power for power in range(20) for factor in (1, 2, 5) if factor * 10**power * 12 >= frame_ns)
    return list(range(0, frame_ns + 1, step))


def _draw_axis(drawing: Drawing, scale: _Scale, ticks: list[int], y: float, frame_ns: int) -> None:
    factor, unit = next(((factor, unit) for factor, unit in UNITS if frame_ns >= factor), (1, "ns"))
    drawing.line(scale.left, y, scale.left + TIME_WIDTH, y, INK)
    for tick in ticks:
        drawing.line(scale.at(tick), y, scale.at(tick), y + 5, INK)
        drawing.text(scale.at(tick), y + 18, f"{tick / factor:g}", "middle", QUIET)
    drawing.text(scale.left + TIME_WIDTH / 2, y + 38, f"time in the frame [{unit}]", "middle", QUIET)
