# SPDX-License-Identifier: Apache-2.0
"""Simulated measured runs: tables, rows and files in the format of docs/design/timing.md#files, and a program that writes them."""

from __future__ import annotations

import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mamori_tools.timing.reader import OPENING, STEP
from mamori_tools.timing.switches import CPU_NOT_KNOWN, NO_STATE, SLICE, STEP_USE, WINDOW_USE

REFERENCE_NS = 1_000
US = 1_000

# name, window, declared worst case [us], median execution time [us]
COMPONENTS = (("reader", 0, 40, 10), ("monitor", 0, 60, 20), ("controller", 1, 200, 50), ("drive", 2, None, 5))
# name, core, offset, length, period, budget [us]
WINDOWS = (("sense", 0, 0, 300, 1000, 250), ("control", 0, 300, 400, 1000, 350), ("act", 0, 800, 100, 1000, 80))
# source, sink, way
CONNECTIONS = ((0, 1, "same_window"), (1, 2, "later_window"), (2, 3, "later_window"), (3, 1, "next_frame"))


def make_table(windows: Sequence[tuple[Any, ...]] = WINDOWS, components: Sequence[tuple[Any, ...]] = COMPONENTS,
               connections: Sequence[tuple[int, int, str]] = CONNECTIONS, frame_us: int = 1000) -> dict[str, Any]:  # fmt: skip
    """A document of the schema mamori.table/5."""

    def make_end(component: int, port: str) -> dict[str, Any]:
        return {"component": component, "name": components[component][0], "port": port}

    return {
        "schema": "mamori.table/5", "frame_ns": frame_us * US, "abort_policy": "spec_only",
        "windows": [{"name": name, "core": core, "background_of": None, "partition": "", "kind": "periodic", "offset_ns": offset * US,
                     "length_ns": length * US, "period_ns": period * US, "budget_ns": budget * US, "rate_hz": None,
                     "slower_periods_ns": [], "events_per_cycle": None} for name, core, offset, length, period, budget in windows],
        "components": [{"name": row[0], "window": row[1], "worst_case_ns": None if row[2] is None else row[2] * US, "ports": []}
                       for row in components],
        "connections": [{"from": make_end(source, "out"), "to": make_end(sink, "in"), "way": way, "fresh_within_ns": None,
                         "only_in": None, "modes": []} for source, sink, way in connections],
        "faults": [], "reactions": [], "safety": None, "modes": [], "transitions": [], "parameters": [], "configuration_sets": [], "findings": [],
    }  # fmt: skip


def make_rows(table: dict[str, Any], times_us: Sequence[float], cycles: int, seed: int = 1, first_frame: int = 3
              ) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:  # fmt: skip
    """Window instances and steps in order of time. Each window is late by some us; execution times vary around the medians `times_us`."""
    random = np.random.default_rng(seed)
    openings, steps = [], []
    for index, window in enumerate(table["windows"]):
        per_frame = table["frame_ns"] // window["period_ns"]
        count = cycles * per_frame
        rows = np.zeros(count, OPENING)
        rows["release_ns"] = first_frame * table["frame_ns"] + window["offset_ns"] + np.arange(count) * window["period_ns"]
        rows["woke_ns"] = rows["release_ns"] + (2000 + random.gumbel(3000, 800, count).clip(0, 20_000)).astype(np.int64)
        rows["window"] = index
        now = rows["woke_ns"] + 500
        for number, component in enumerate(table["components"]):
            if component["window"] == index:
                step = np.zeros(count, STEP)
                step["release_ns"], step["component"], step["start_ns"] = rows["release_ns"], number, now
                now = now + (times_us[number] * 1000 * (1.0 + 0.02 * random.gumbel(0.0, 1.0, count))).astype(np.int64)
                step["end_ns"] = now
                steps.append(step)
        rows["closed_ns"] = now + 700
        openings.append(rows)
    all_openings, all_steps = np.concatenate(openings), np.concatenate(steps)
    return all_openings[np.argsort(all_openings["woke_ns"])], all_steps[np.argsort(all_steps["start_ns"])]


def make_run(table: dict[str, Any], asked: int, done: int, refused: Sequence[str] = ()) -> dict[str, Any]:
    """The document of run.json."""
    rights = {name: {"is_granted": name not in refused, "errno": 1 if name in refused else 0} for name in ("priority", "processor", "memory")}
    return {"schema": "mamori.timing_run/1", "cycles": {"asked": asked, "run": done}, "is_partial": done < asked,
            "frame_ns": table["frame_ns"], "reference_ns": REFERENCE_NS, "lost_rows": 0, "notes": [], "rights": rights}  # fmt: skip


def make_requests(count: int = 1_000) -> dict[str, Any]:
    """The key `requests` of run.json, for the blocks of 200 cycles."""
    return {"block_cycles": 20, "count": count, "paces": [0, 0, 1, 2, 1, 2, 0, 2, 0, 1]}


def make_switches(threads: Sequence[dict[str, Any]] = (), windows: int = 1, errno: int = 0, continued_ns: Sequence[int] = ()) -> dict[str, Any]:
    """The key `switches` of run.json: one core, whose runner is thread 11 and whose windows have the threads 20, 21, ..."""
    core = {"right": {"is_granted": errno == 0, "errno": errno}, "processor": 0, "runner": 11,
            "window_threads": [20 + window for window in range(windows)], "lost": 0}  # fmt: skip
    own = [{"thread": 11, "process": 10, "kind": 0, "priority": 80, "name": "runner"},
           *({"thread": 20 + window, "process": 10, "kind": 0, "priority": 70, "name": ""} for window in range(windows))]  # fmt: skip
    return {"cores": [core], "threads": [*own, *threads], "continued_ns": list(continued_ns)}


def write_switches(folder: Path, openings: int, step_use: Sequence[tuple[int, int, int]], slices: Sequence[tuple[int, ...]],
                   states: Sequence[int] = ()) -> None:  # fmt: skip
    """@param states of the window instances; none if empty.
    @param step_use CPU time [ns], voluntary, involuntary switches.
    @param slices begin [ns], end [ns], thread, process, left."""
    window_use = np.zeros(openings, WINDOW_USE)
    window_use["state"] = states if states else NO_STATE
    window_use["reading_cpu_ns"] = window_use["runner_cpu_ns"] = CPU_NOT_KNOWN
    np.save(folder / "window_use.npy", window_use)
    np.save(folder / "step_use.npy", np.array(list(step_use), STEP_USE))
    np.save(folder / "slices.npy", np.array([(begin, end, 0, *rest) for begin, end, *rest in slices], SLICE))


def write_run(folder: Path, table: dict[str, Any], openings: np.ndarray[Any, Any], steps: np.ndarray[Any, Any], run: dict[str, Any]) -> Path:
    """@return `folder`."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "table.json").write_text(json.dumps(table), encoding="utf-8")
    (folder / "run.json").write_text(json.dumps(run), encoding="utf-8")
    np.save(folder / "openings.npy", openings)
    np.save(folder / "steps.npy", steps)
    return folder


# Replaces a system: copies the files prepared for this number of cycles, so that it starts as quickly as a C++ program.
PROGRAM = """#!{python} -SE
import os, shutil, signal, sys, time

words = sys.argv
cycles, out = int(words[words.index("--cycles") + 1]), words[words.index("--out") + 1]
is_probe = cycles == 1
stopped = []
if "usage" in words:
    print("fake_system: there is no such joint")
    sys.exit(2)
if "wait" in words and not is_probe:
    signal.signal(signal.SIGINT, signal.SIG_IGN if "deaf" in words else lambda *_: stopped.append(1))
    open(out + "/begun", "w").close()
    begin = time.monotonic()
    while not stopped and time.monotonic() - begin < cycles / 1000:
        time.sleep(0.01)
while "await-load" in words and not is_probe and not os.path.exists(os.path.dirname(words[0]) + "/load"):
    time.sleep(0.01)
kind = "probe" if is_probe else "partial" if stopped else "whole"
if "nothing" not in words or is_probe:
    shutil.copytree("{data}/" + kind, out, dirs_exist_ok=True)
if "--requests" in words and "old" not in words:
    run = open(out + "/run.json").read()
    open(out + "/run.json", "w").write(run[:-1] + ', "requests": {requests}' + "}}")
sys.exit(130 if stopped else 1 if "fail" in words and not is_probe else 0)
"""


def make_program(folder: Path) -> Path:
    """A program that writes the latest files of prepare() in `folder`. @return its path."""
    path = folder / "fake_system"
    path.write_text(PROGRAM.format(python=sys.executable, data=folder / "data", requests=json.dumps(make_requests())), encoding="utf-8")
    path.chmod(0o755)
    return path


def prepare(folder: Path, cycles: int = 100, fault: str = "", refused: Sequence[str] = (), slower: float = 1.0, frame_us: int = 1000) -> None:
    """Prepares the measurement for the program in `folder`. `fault`: one overrun or skipped window; a stopped run has 100 cycles."""
    table = make_table(frame_us=frame_us)
    for name, asked, done in (("probe", 1, 1), ("whole", cycles, cycles), ("partial", cycles, min(100, cycles - 1))):
        openings, steps = make_rows(table, [row[3] * slower for row in COMPONENTS], done)
        if name == "whole":
            _spoil(openings, steps, fault)
        write_run(folder / "data" / name, table, openings, steps, make_run(table, asked, done, refused))


def _spoil(openings: np.ndarray[Any, Any], steps: np.ndarray[Any, Any], fault: str) -> None:
    """One fault in the control window in the tenth cycle of the run."""
    if not fault:
        return
    row = int(np.flatnonzero(openings["window"] == 1)[10])
    release = openings["release_ns"][row]
    of_it = (steps["release_ns"] == release) & (steps["component"] == 2)
    if fault == "overrun":
        openings["outcome"][row] = 1
        openings["closed_ns"][row] = openings["woke_ns"][row] + 350_000
        steps["end_ns"][of_it] = release + 390_000
    if fault == "missed":
        openings["outcome"][row] = 2
        openings["woke_ns"][row] = openings["closed_ns"][row] = release + 450_000
        steps["component"][of_it], steps["start_ns"][of_it] = 3, release + 500_000  # it ran in the next window instead
        steps["end_ns"][of_it], steps["release_ns"][of_it] = release + 501_000, release + 500_000
