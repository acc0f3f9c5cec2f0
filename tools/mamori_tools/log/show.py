# SPDX-License-Identifier: Apache-2.0
"""A recording as lines for the terminal: records and findings ordered by number, then one line with counts.

rich follows NO_COLOR and omits colours if the output is not a terminal.

@satisfies SWR-REC-011, SWR-PRT-028      Design: docs/design/recorder.md#the-command-log
"""

from __future__ import annotations

from collections.abc import Iterator

from rich.console import Console
from rich.text import Text

from mamori_tools.log.names import Names
from mamori_tools.log.region import Crash, Finding, Record, Recording

COLUMNS = ("sequence", "session", "time [s]", "severity", "source", "event", "argument")
RIGHT = (True, True, True, False, False, False, False)
STYLES = {"info": "", "warning": "yellow", "fault": "bold red"}
DAMAGE_STYLE = "magenta"
KINDS = ("torn", "corrupt", "missing", "stale", "header", "cut", "trailing")


class _Console(Console):
    """When the reader ends early, only the printing stops; rich would also end the program."""

    def on_broken_pipe(self) -> None:
        raise BrokenPipeError


def format_time(time_ns: int) -> str:
    """Seconds with nine digits, without conversion to a binary fraction."""
    seconds, rest = divmod(abs(time_ns), 1_000_000_000)
    return f"{'-' if time_ns < 0 else ''}{seconds}.{rest:09d}"


def format_damage(recording: Recording) -> str:
    """The kinds of findings with their counts; empty if there are none."""
    counts = [(kind, recording.count(kind)) for kind in KINDS]
    return ", ".join(f"{count} {kind}" for kind, count in counts if count)


def format_summary(recording: Recording) -> str:
    records = recording.records
    parts = [f"{len(records)} record{'' if len(records) == 1 else 's'}"]
    if records:
        parts[0] += f", numbers {records[0].sequence} to {records[-1].sequence}"
    overwritten = "unknown how many" if recording.overwritten is None else str(recording.overwritten)
    parts += [f"session {recording.session}", f"room for {recording.capacity}", f"{overwritten} overwritten before"]
    return "; ".join([*parts, format_damage(recording) or "no damage"])


def format_crash(crash: Crash) -> str:
    """One sentence: what, where, when."""
    what = f"{crash.signal}, sent by a program" if crash.is_sent else f"{crash.signal} at address {crash.address:#x}"
    if crash.is_watchdog:
        where = "thread of the watchdog"
    elif crash.window is None and crash.component is None:
        where = "outside of all components"
    else:
        where = f"window {_format_place(crash.window)}, component {_format_place(crash.component)} of the system table"
    return f"crash in session {crash.session} at {format_time(crash.time_ns)} s: {what}; {where}"


def _format_place(place: int | None) -> str:
    return "unknown" if place is None else str(place)


def print_recording(recording: Recording, names: Names) -> None:
    """Prints the table and its last line to standard output."""
    console = _Console(highlight=False, soft_wrap=True, markup=False)
    cells = [_make_cells(record, names) for record in recording.records]
    widths = [max(len(row[i]) for row in [COLUMNS, *cells]) for i in range(len(COLUMNS))]
    console.print(Text(_join(COLUMNS, widths), style="bold"))
    for entry in _merge(recording):
        if isinstance(entry, Finding):
            console.print(Text(f"  -- {entry.kind} at offset {entry.offset}: {entry.text}", style=DAMAGE_STYLE))
        else:
            console.print(Text(_join(cells[entry], widths), style=STYLES[recording.records[entry].severity]))
    if recording.crash is not None:
        console.print(Text(format_crash(recording.crash), style=STYLES["fault"]))
    console.print(Text(format_summary(recording), style="bold"))


def _make_cells(record: Record, names: Names) -> tuple[str, ...]:
    return (str(record.sequence), str(record.session), format_time(record.time_ns), record.severity, names.source(record),
            names.code(record), names.argument(record))  # fmt: skip


def _join(cells: tuple[str, ...], widths: list[int]) -> str:
    padded = (cell.rjust(width) if right else cell.ljust(width) for cell, width, right in zip(cells, widths, RIGHT, strict=True))
    return "  ".join(padded).rstrip()


def _merge(recording: Recording) -> Iterator[int | Finding]:
    """Indices of records and findings, ordered by number; a missing record is at its expected position."""
    waiting = list(reversed(recording.findings))
    for index, record in enumerate(recording.records):
        while waiting and waiting[-1].place <= record.sequence:
            yield waiting.pop()
        yield index
    yield from reversed(waiting)
