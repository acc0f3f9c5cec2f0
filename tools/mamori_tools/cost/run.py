# SPDX-License-Identifier: Apache-2.0
"""Runs the program twice for one input class: under callgrind, and in real time. Both runs must execute the same steps.

@satisfies SWR-TIM-032, SWR-TIM-033      Design: docs/design/cost.md#counting
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mamori_tools.cost.classes import InputClass
from mamori_tools.host.callgrind import list_totals, make_step_options
from mamori_tools.host.process import read_tail
from mamori_tools.table.document import Table, read_table
from mamori_tools.timing.reader import HOW_TO_FIX, RIGHTS, STEP, Array, Right, check_steps, load_json, read_right, read_rows
from mamori_tools.timing.run import run_program
from mamori_tools.timing.system import System
from mamori_trace.base.errors import InputError, WorkError
from mamori_trace.base.json_node import JsonNode

SCHEMA = "mamori.cost_run/1"
FUNCTION = "mamori_counted_step"
COUNTING_S_PER_CYCLE = 0.5
"""Maximum time of a cycle under callgrind, which slows programs about fifty times and writes a record for each step."""
START_S = 60.0
PROGRAM_USAGE = 2

Tell = Callable[[str], None]


@dataclass(frozen=True)
class Build:
    """Compiler, flags and C library of the program: counts of different builds are not comparable."""

    compiler: str
    flags: str
    c_library: str


@dataclass(frozen=True)
class Facts:
    """run.json of one run. `empty_ns`: the minimum time of empty counted work; `reference_ns`: the median of the reference work."""

    build: Build
    calibration_count: int
    empty_ns: int
    reference_ns: int
    rights: tuple[Right, ...]
    notes: tuple[str, ...]


@dataclass(frozen=True)
class ClassRun:
    """One input class. `steps` (STEP) are in execution order. For each step, `instructions` are those of the step alone, and `times_ns` is
    the time between both clock readings, minus the time of the readings themselves."""

    input_class: InputClass
    table: Table
    steps: Array
    instructions: Array
    times_ns: Array
    reference_instructions: int
    facts: Facts
    """Facts of the real-time run."""


def run_class(system: System, one: InputClass, log: Path, tell: Tell) -> ClassRun:
    """@raise WorkError if a run fails or both runs differ, InputError for invalid files or rejected arguments, KeyboardInterrupt if it was
    stopped."""
    with tempfile.TemporaryDirectory(prefix="mamori-cost-") as scratch:
        folder = Path(scratch)
        out = folder / "callgrind.out"
        limit_s = START_S + one.cycles * COUNTING_S_PER_CYCLE
        _run(system, one, "count", folder / "count", make_step_options(FUNCTION, out), limit_s, log, tell)
        table, steps, facts = read_cost(folder / "count", one)
        totals = list_totals(out)
        out.unlink()  # megabytes that are no longer needed
        calls = 2 * facts.calibration_count
        if len(totals) != len(steps) + calls:
            raise WorkError(f"class '{one.name}': callgrind saw {len(totals)} calls of {FUNCTION}(), the program noted {len(steps)} steps "
                            f"and {calls} other calls; is it in the program once, as mamori::timing has it?")  # fmt: skip
        seconds = one.cycles * table.frame_ns / 1e9
        _run(system, one, "clock", folder / "clock", [], START_S + seconds, log, tell)
        _, timed_steps, timed_facts = read_cost(folder / "clock", one)
    _check_same(one, table, steps, timed_steps)
    empty, reference = totals[0], totals[facts.calibration_count]
    instructions = np.array(totals[calls:], dtype=np.int64) - empty
    times = np.maximum(timed_steps["end_ns"] - timed_steps["start_ns"] - timed_facts.empty_ns, 0)
    return ClassRun(one, table, steps, instructions, times, reference - empty, timed_facts)


def _run(system: System, one: InputClass, by: str, out: Path, before: Sequence[str], limit_s: float, log: Path, tell: Tell) -> None:
    argv = [*before, str(system.program), "cost", "--by", by, "--cycles", str(one.cycles), "--first", str(one.first),
            "--every", str(one.every), "--out", str(out), *system.arguments, *one.words]  # fmt: skip
    ending = run_program(argv, log, limit_s, lambda seconds: tell(f"{one.name} by {by}, {seconds:.0f} s"))
    if ending.was_interrupted:
        raise KeyboardInterrupt
    if ending.status == PROGRAM_USAGE:
        said = (read_tail(log, 1) or [f"see {log}"])[0] if not before else f"see {log}"
        raise InputError(f"cost: class '{one.name}': {system.program.name} refuses its arguments: {said}")
    if ending.status == 130 or ending.reason:
        raise WorkError(f"class '{one.name}', by {by}: {ending.reason or 'the program was stopped'}")


def read_cost(folder: Path, one: InputClass) -> tuple[Table, Array, Facts]:
    """The files of one run. @raise InputError for an incomplete file, or one of another class."""
    table = read_table(folder / "table.json")
    if table.findings:
        raise InputError(f"breaks a rule: {table.findings[0]}; ./mamori table --text shows all", folder / "table.json")
    path = folder / "run.json"
    run = JsonNode(path, "the run", load_json(path), HOW_TO_FIX)
    if (schema := run.at("schema").text()) != SCHEMA:
        raise run.at("schema").complain(f"is '{schema}', this command reads '{SCHEMA}'")
    for key, wanted in (("cycles", one.cycles), ("first", one.first), ("every", one.every), ("frame_ns", table.frame_ns), ("lost_rows", 0)):
        if run.at(key).whole() != wanted:
            raise run.at(key).complain(f"is {run.at(key).whole()}, must be {wanted}")
    if run.at("calibration_count").count() < 1:
        raise run.at("calibration_count").complain("is 0, must be positive")
    facts = Facts(
        Build(run.at("compiler").text(), run.at("flags").text().strip(), run.at("c_library").text()),
        run.at("calibration_count").count(), run.at("empty_ns").count(), run.at("reference_ns").count(),
        tuple(read_right(name, run.at("rights").at(name)) for name in RIGHTS), tuple(note.text() for note in run.at("notes").items()),
    )  # fmt: skip
    steps = read_rows(folder / "steps.npy", STEP, "steps")
    check_steps(steps, table, folder / "steps.npy", by_clock=False)
    return table, steps, facts


def _check_same(one: InputClass, table: Table, counted: Array, timed: Array) -> None:
    """@raise WorkError if both runs executed different steps: times then do not belong to counts."""
    if len(counted) != len(timed):
        raise WorkError(f"class '{one.name}': {len(counted)} steps under callgrind, {len(timed)} in real time; the program must do the same "
                        "again with the same arguments")  # fmt: skip
    for key in ("release_ns", "component", "pass"):
        differs = counted[key] != timed[key]
        if differs.any():
            row = int(np.argmax(differs))
            names = [table.component_name(int(steps["component"][row])) for steps in (counted, timed)]
            raise WorkError(f"class '{one.name}': step {row} was of '{names[0]}' at {counted['release_ns'][row]} ns under callgrind, and of "
                            f"'{names[1]}' at {timed['release_ns'][row]} ns in real time; the program must do the same again")  # fmt: skip
