# SPDX-License-Identifier: Apache-2.0
"""Simulated counted runs: steps, instructions and times for the analysis, and files in the format of docs/design/cost.md#files."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from timing_run import make_table

from mamori_tools.cost.classes import InputClass
from mamori_tools.cost.run import SCHEMA, Build, ClassRun, Facts
from mamori_tools.table.document import Table, read_table
from mamori_tools.timing.reader import RIGHTS, STEP, Right

BUILD = Build("GNU 12.2.0", "-O2", "glibc 2.36")
REFERENCE_INSTRUCTIONS = 10_000
EMPTY = 9
"""Instructions that counting adds to each call."""

# From the table of timing_run.py: component to instructions in each cycle.
Counts = Mapping[int, Sequence[int]]
COUNTS: Counts = {0: (500, 510, 500, 505), 1: (2000, 2000, 2300, 2000), 2: (9000, 9000, 9000, 12_000), 3: (100, 100, 100, 100)}
NS_PER_INSTRUCTION = {0: 0.5, 1: 0.4, 2: 0.25, 3: 2.0}


def make_class(name: str = "still", cycles: int = 14, first: int = 10, every: int = 1, arguments: Sequence[str] = ()) -> InputClass:
    return InputClass(name, cycles, first, every, tuple(arguments), tuple(arguments))


def load_table(folder: Path, document: dict[str, Any] | None = None) -> Table:
    path = folder / "table.json"
    path.write_text(json.dumps(document or make_table()), encoding="utf-8")
    return read_table(path)


def make_steps(table: Table, one: InputClass, counts: Counts) -> tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]:
    """One step of each component in each counted cycle. @return rows, instructions."""
    rows, instructions = [], []
    for place, cycle in enumerate(range(one.first, one.cycles, one.every)):
        for index, values in counts.items():
            window = table.windows[table.components[index].window or 0]
            rows.append((cycle * table.frame_ns + window.offset_ns, 0, 0, index, 0))
            instructions.append(values[place])
    return np.array(rows, STEP), np.array(instructions, np.int64)


def make_run(table: Table, one: InputClass | None = None, counts: Counts = COUNTS, ns: Mapping[int, float] = NS_PER_INSTRUCTION,
             refused: Sequence[str] = (), build: Build = BUILD) -> ClassRun:  # fmt: skip
    """A class in which an instruction of component `index` takes `ns[index]`."""
    one = one or make_class()
    steps, instructions = make_steps(table, one, counts)
    times = np.array([round(count * ns[int(row["component"])]) for row, count in zip(steps, instructions, strict=True)], np.int64)
    rights = tuple(Right(name, name not in refused, 1 if name in refused else 0) for name in RIGHTS)
    facts = Facts(build, 201, 20, 2520, rights, ("the arm ended in state Operational",))
    return ClassRun(one, table, steps, instructions, times, REFERENCE_INSTRUCTIONS, facts)


def write_files(folder: Path, table: dict[str, Any], one: InputClass, steps: np.ndarray[Any, Any], **changed: Any) -> None:
    """Files of a program. @param changed keys of run.json."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "table.json").write_text(json.dumps(table), encoding="utf-8")
    np.save(folder / "steps.npy", steps)
    run = {"schema": SCHEMA, "cycles": one.cycles, "first": one.first, "every": one.every, "is_paced": True, "frame_ns": table["frame_ns"],
           "calibration_count": 1, "empty_ns": 20, "reference_ns": 2520, "lost_rows": 0, "compiler": BUILD.compiler, "flags": " -O2",
           "c_library": BUILD.c_library, "notes": ["a note"],
           "rights": {name: {"is_granted": True, "errno": 0} for name in RIGHTS}}  # fmt: skip
    (folder / "run.json").write_text(json.dumps({**run, **changed}), encoding="utf-8")


def make_dumps(totals: Sequence[int]) -> str:
    """The output of callgrind for calls with these numbers of instructions."""
    parts = [f"part: {number}\n\ndesc: Trigger: --dump-after=mamori_counted_step\n\nevents: Ir\nsummary: {total}\n\nfn=(1) f\n0 {total}\n\n"
             f"totals: {total}\n" for number, total in enumerate(totals, start=1)]  # fmt: skip
    return "# callgrind format\nversion: 1\n" + "\n".join(parts) + "\npart: 9\n\ndesc: Trigger: Program termination\n\ntotals: 0\n"
