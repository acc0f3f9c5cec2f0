# SPDX-License-Identifier: Apache-2.0
"""Reads the files of a measured run as checked arrays. The parts of a `Measurement` are consistent.

@satisfies SWR-TIM-010, SWR-TIM-011, SWR-TIM-028      Design: docs/design/timing.md#files
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from mamori_tools.table.document import Table, read_table
from mamori_tools.timing.runner import RunnerTimes, find_runner_times
from mamori_tools.timing.switches import SLICE, STEP_USE, WINDOW_USE, State, Switches, read_states, read_switches
from mamori_trace.base.errors import InputError
from mamori_trace.base.json_node import JsonNode
from mamori_trace.base.text_file import read_text

SCHEMA = "mamori.timing_run/1"
FILES = ("table.json", "openings.npy", "steps.npy", "run.json")
SWITCH_FILES = ("window_use.npy", "step_use.npy", "slices.npy")
"""Only of programs whose run.json has `switches`."""
RIGHTS = ("priority", "processor", "memory")
COMPLETED, OVERRUN, MISSED, STOPPED, NOT_DUE = range(5)
OUTCOMES = ("completed", "overrun", "missed", "stopped", "not due")
PACES = ("none", "steady", "burst")
"""Paces of requests from outside in a block of major frames."""
PASSES = ("execute", "state update", "mode step")
NOT_BACK = -1
"""End of a step that had not returned when the run ended."""

OPENING = np.dtype([("release_ns", "<i8"), ("woke_ns", "<i8"), ("closed_ns", "<i8"), ("window", "<u4"), ("outcome", "<u4")])
STEP = np.dtype([("release_ns", "<i8"), ("start_ns", "<i8"), ("end_ns", "<i8"), ("component", "<u4"), ("pass", "<u4")])
INSTANT_NS_MAX = 2**53
"""104 days: below this value, a float counts nanoseconds exactly, and a key of instant and window fits 64 bits."""

HOW_TO_FIX = "measure again"
Array = np.ndarray[Any, np.dtype[Any]]


@dataclass(frozen=True)
class Right:
    """A real-time privilege that the program requested. `errno` is the reason of a denial, 0 if it was granted."""

    name: str
    is_granted: bool
    errno: int


@dataclass(frozen=True)
class Requests:
    """Requests from outside: `count`, and the index in PACES for each block of `block_cycles` major frames, from frame 0 on. After the
    first block, every three blocks form a round with each pace once."""

    block_cycles: int
    count: int
    paces: tuple[int, ...]


@dataclass(frozen=True)
class Measurement:
    """One run. `openings` (OPENING) is sorted by window, then by release; `opening_of_step` is the row of the window instance of each step.

    All instants [ns] since the epoch of the run; frame n begins at n * table.frame_ns.
    """

    table: Table
    openings: Array
    steps: Array
    opening_of_step: Array
    cycles_asked: int
    cycles_run: int
    is_partial: bool
    reference_ns: int
    rights: tuple[Right, ...]
    notes: tuple[str, ...] = ()
    findings: tuple[str, ...] = ()
    """Findings that the program itself reports, for example that its system left the operating state."""
    requests: Requests | None = None
    switches: Switches | None = None
    """None for a program that was built with an earlier version."""
    states: tuple[State, ...] = ()
    """States of the system; empty if it has none."""

    def rows_of(self, window: int) -> slice:
        """The instances of one window, in order of time."""
        first, last = np.searchsorted(self.openings["window"], [window, window + 1])
        return slice(int(first), int(last))

    @cached_property
    def runner_times(self) -> tuple[RunnerTimes, ...]:
        """Per core with a record of its switches."""
        if self.switches is None:
            return ()
        cores = np.array([window.core for window in self.table.windows])[self.openings["window"]]
        order = np.argsort(self.openings["closed_ns"], kind="stable")
        rows = [order[cores[order] == index] for index in range(len(self.switches.cores))]
        return tuple(find_runner_times(log, self.openings[of_it], self.switches.window_use[of_it])
                     for log, of_it in zip(self.switches.cores, rows, strict=True))  # fmt: skip

    @property
    def refused(self) -> list[Right]:
        return [right for right in self.rights if not right.is_granted]


def read_measurement(folder: Path) -> Measurement:
    """@raise InputError, one line with the file, for an incomplete or inconsistent run."""
    table = read_table(folder / "table.json")
    if table.findings:
        raise InputError(f"violates a rule: {table.findings[0]}; ./mamori table --text shows all", folder / "table.json")
    run = JsonNode(folder / "run.json", "the run", load_json(folder / "run.json"), HOW_TO_FIX)
    asked, done, is_partial, reference = _read_run(run, table)
    rights = tuple(read_right(name, run.at("rights").at(name)) for name in RIGHTS)
    openings = read_rows(folder / "openings.npy", OPENING, "openings")
    order = np.lexsort((openings["release_ns"], openings["window"]))
    openings = openings[order]
    _check_openings(openings, table, folder / "openings.npy")
    _check_counts(openings, table, done, folder / "openings.npy")
    steps = read_rows(folder / "steps.npy", STEP, "steps")
    check_steps(steps, table, folder / "steps.npy")
    count = len(steps)
    steps, opening_of_step, kept, notes = _match_steps(steps, openings, table, is_partial, folder / "steps.npy")
    own = tuple(f"the program: {note.text()}" for note in run.at("notes").items())
    findings = tuple(f"the program: {finding.text()}" for finding in run.at("findings").items()) if run.has("findings") else ()
    switches = _read_switches(folder, run.at("switches"), order, kept, count, len(table.windows)) if run.has("switches") else None
    states = read_states(run.at("states"), switches.window_use) if switches is not None and run.has("states") else ()
    return Measurement(table, openings, steps, opening_of_step, asked, done, is_partial, reference, rights, (*own, *notes), findings,
                       _read_requests(run.at("requests"), openings, table) if run.has("requests") else None,
                       switches, states)  # fmt: skip


def _read_switches(folder: Path, node: JsonNode, order: Array, kept: Array, step_count: int, windows: int) -> Switches:
    window_use = read_rows(folder / "window_use.npy", WINDOW_USE, "uses of windows")
    step_use = read_rows(folder / "step_use.npy", STEP_USE, "uses of steps")
    for rows, wanted, other in ((window_use, len(order), "openings.npy"), (step_use, step_count, "steps.npy")):
        if len(rows) != wanted:
            name = "window_use.npy" if rows is window_use else "step_use.npy"
            raise InputError(f"holds {len(rows)} rows, {other} holds {wanted}; {HOW_TO_FIX}", folder / name)
    slices = read_rows(folder / "slices.npy", SLICE, "slices")
    return read_switches(node, slices, window_use[order], step_use[kept], windows)


def load_json(path: Path) -> object:
    try:
        return json.loads(read_text(path, "record of the run", 1_000_000).text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"is not a complete JSON document: {error}; {HOW_TO_FIX}", path) from error


def _read_run(run: JsonNode, table: Table) -> tuple[int, int, bool, int]:
    """@return requested cycles, executed cycles, whether the run is partial, reference time [ns]."""
    schema = run.at("schema").text()
    if schema != SCHEMA:
        raise run.at("schema").complain(f"is '{schema}', this command reads '{SCHEMA}'")
    cycles = run.at("cycles")
    asked, done, is_partial = cycles.at("asked").count(), cycles.at("run").count(), run.at("is_partial").truth()
    if asked < 1 or done > asked:
        raise cycles.complain(f"states that {done} of {asked} were run")
    if is_partial != (done < asked):
        raise run.at("is_partial").complain(f"is {is_partial}, but {done} of {asked} cycles were run")
    if run.at("frame_ns").whole() != table.frame_ns:
        raise run.at("frame_ns").complain(f"is {run.at('frame_ns').whole()}, but {table.frame_ns} in the table")
    reference = run.at("reference_ns").whole()
    if reference < 1:
        raise run.at("reference_ns").complain(f"is {reference}, must be positive")
    if lost := run.at("lost_rows").count():
        raise run.at("lost_rows").complain(f"states that {lost} rows were lost because the memory was full; measure fewer cycles")
    return asked, done, is_partial, reference


def _read_requests(node: JsonNode, openings: Array, table: Table) -> Requests:
    block_cycles, paces = node.at("block_cycles").count(), [pace.index(len(PACES)) for pace in node.at("paces").items()]
    if block_cycles < 1:
        raise node.complain("has blocks of 0 cycles")
    if len(paces) <= int(openings["release_ns"].max()) // (block_cycles * table.frame_ns):
        raise node.complain(f"has {len(paces)} blocks of {block_cycles} cycles; the run is longer")
    if any(sorted(paces[first : first + 3]) != [0, 1, 2] for first in range(1, len(paces) - 2, 3)):
        raise node.complain("has a round of three blocks without each pace")
    return Requests(block_cycles, node.at("count").count(), tuple(paces))


def read_right(name: str, node: JsonNode) -> Right:
    right = Right(name, node.at("is_granted").truth(), node.at("errno").count())
    if right.is_granted and right.errno:
        raise node.complain(f"is granted, but has the errno {right.errno}")
    return right


def read_rows(path: Path, kind: np.dtype[Any], what: str) -> Array:
    """A NumPy file of version 1.0 with one dimension of `kind`, and the length given in its header. @raise InputError."""
    try:
        with path.open("rb") as file:
            version = np.lib.format.read_magic(file)
            if version != (1, 0):
                raise InputError(f"has version {version[0]}.{version[1]} of the NumPy format, must be 1.0; {HOW_TO_FIX}", path)
            shape, is_fortran, found = np.lib.format.read_array_header_1_0(file)
            if found != kind or is_fortran or len(shape) != 1:
                raise InputError(f"holds {len(shape)}-dimensional rows of {found}, {what} are a list of {kind}; {HOW_TO_FIX}", path)
            wanted, there = shape[0] * kind.itemsize, path.stat().st_size - file.tell()
            if wanted != there:
                raise InputError(f"should hold {shape[0]} rows in {wanted} bytes, has {there} bytes; {HOW_TO_FIX}", path)
            return np.fromfile(file, dtype=kind, count=shape[0])
    except OSError as error:
        raise InputError(f"file of {what} cannot be read: {error.strerror}; {HOW_TO_FIX}", path) from error
    except (ValueError, SyntaxError, TypeError, EOFError, MemoryError, RecursionError) as error:
        raise InputError(f"is not a NumPy file of {what}: {error}; {HOW_TO_FIX}", path) from error


def _refuse_first(bad: Array, rows: Array, path: Path, text: str) -> None:
    """@raise InputError for the first row that `bad` marks."""
    if bad.any():
        row = int(np.argmax(bad))
        values = ", ".join(f"{name} {rows[name][row]}" for name in rows.dtype.names or ())
        raise InputError(f"{int(bad.sum())} of {len(rows)} rows {text}, first: {values}; {HOW_TO_FIX}", path)


def _check_instants(rows: Array, names: tuple[str, ...], path: Path) -> None:
    for name in names:
        _refuse_first((rows[name] < NOT_BACK) | (rows[name] >= INSTANT_NS_MAX), rows, path, f"have a {name} out of range")


def _check_openings(rows: Array, table: Table, path: Path) -> None:
    """Checks that each window instance is possible and occurs once. Drift from the schedule is a finding of the analysis."""
    if not len(rows):
        raise InputError(f"has no window instances; run the program for a complete cycle, or {HOW_TO_FIX}", path)
    _refuse_first(rows["window"] >= len(table.windows), rows, path, f"have a window index outside the table ({len(table.windows)} windows)")
    _refuse_first(rows["outcome"] >= len(OUTCOMES), rows, path, f"have an unknown outcome (not 0 .. {len(OUTCOMES) - 1})")
    _check_instants(rows, ("release_ns", "woke_ns", "closed_ns"), path)
    _refuse_first(rows["woke_ns"] < rows["release_ns"], rows, path, "have a wake-up before their release")
    _refuse_first(rows["closed_ns"] < rows["woke_ns"], rows, path, "have an end before their wake-up")
    same = (np.diff(rows["window"].astype(np.int64)) == 0) & (np.diff(rows["release_ns"]) == 0)
    _refuse_first(np.concatenate(([False], same)), rows, path, "are duplicates")


def _check_counts(rows: Array, table: Table, cycles: int, path: Path) -> None:
    """Checks that a window has its instances in each cycle. One cycle may be missing, because a run may begin or end within a cycle."""
    counts = np.bincount(rows["window"], minlength=len(table.windows))
    for window, count in zip(table.windows, counts, strict=True):
        least = (cycles - 1) * (table.frame_ns // window.period_ns)
        if count < least:
            raise InputError(f"has {count} instances of window '{window.name}', {cycles} cycles have at least {least}; {HOW_TO_FIX}",
                             path)  # fmt: skip


def check_steps(rows: Array, table: Table, path: Path, by_clock: bool = True) -> None:
    """@param by_clock release and start are on the same time line. @raise InputError for the first impossible row."""
    count = len(table.components)
    _refuse_first(rows["component"] >= count, rows, path, f"have a component index outside the table ({count} components)")
    _refuse_first(rows["pass"] >= len(PASSES), rows, path, f"have an unknown pass (not 0 .. {len(PASSES) - 1})")
    _check_instants(rows, ("release_ns", "start_ns", "end_ns"), path)
    if by_clock:
        _refuse_first(rows["start_ns"] < rows["release_ns"], rows, path, "began before their release")
    _refuse_first((rows["end_ns"] < rows["start_ns"]) & (rows["end_ns"] != NOT_BACK), rows, path, "ended before they began")
    homeless = np.array([component.window is None for component in table.components], dtype=bool)
    if count:
        _refuse_first(homeless[rows["component"]], rows, path, "belong to a component without a window")


def _match_steps(steps: Array, openings: Array, table: Table, is_partial: bool, path: Path) -> tuple[Array, Array, Array, tuple[str, ...]]:
    """@return steps with a window instance, its row for each, which of all steps they are, and a note on steps of a stopped run without one."""
    if not len(steps):
        return steps, np.zeros(0, dtype=np.int64), np.zeros(0, dtype=bool), ()
    window_of = np.array([-1 if component.window is None else component.window for component in table.components], dtype=np.int64)
    window = window_of[steps["component"]]
    span = max(int(openings["release_ns"].max()), int(steps["release_ns"].max())) + 1
    if span * (len(table.windows) + 1) >= 2**63:
        raise InputError(f"has instants that are too large for {len(table.windows)} windows; {HOW_TO_FIX}", path)
    keys = openings["window"].astype(np.int64) * span + openings["release_ns"]
    wanted = window * span + steps["release_ns"]
    row = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    lost = keys[row] != wanted
    if is_partial:
        last = np.searchsorted(keys, (window + 1) * span) - 1
        unfinished = lost & (steps["release_ns"] > openings["release_ns"][last])
        _refuse_first(lost & ~unfinished, steps, path, "belong to no window instance")
        notes = (f"{int(lost.sum())} steps omitted: the run was stopped before the end of their window",) if lost.any() else ()
        return steps[~lost], row[~lost], ~lost, notes
    _refuse_first(lost, steps, path, "belong to no window instance")
    return steps, row, ~lost, ()
