# SPDX-License-Identifier: Apache-2.0
"""Measures how often the timing report finds the cause of labelled events:
`python -P -m verification.real_time.timing_verdict [--events N] [--seed S] [--build DIR] [--without-log]`.

Half of the events happen while stress-ng keeps all processors busy. Needs real-time privileges. Exit status 1 if less than 95 % of the
verdicts are correct, a component is blamed for another cause, or another cause for a component, or if less than half of the events had an
effect; 4 (inconclusive) if only disturbed verdicts are wrong, in at most 10 % of the events. A verdict is disturbed if it names a process that is
neither the measured program nor the load, or time that the hypervisor or interrupts used.

Design: docs/design/timing.md#verdict
"""

from __future__ import annotations

import argparse
import json
import re
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK, EXIT_UNFINISHED, EXIT_USAGE
from mamori_tools.host.project import RELEASE, ROOT, Project
from mamori_tools.timing.analysis import Miss, list_misses
from mamori_tools.timing.reader import Measurement, read_measurement
from mamori_tools.timing.run import LOAD_TOOL, make_load
from mamori_tools.timing.runner import STEAL_NS_MIN, STOLEN
from mamori_tools.timing.switches import OWN
from mamori_tools.timing.verdict import COMPONENT, NOT_KNOWN, OUTSIDE
from mamori_trace.base.errors import WorkError

PROGRAM = "tools/probe/timing/mamori_timing_events"
CYCLES_BEFORE, CYCLES_PER_EVENT, CYCLE_S = 60, 24, 0.01
TARGET = "work"
SHARE_MIN = 0.95
EFFECTIVE_SHARE_MIN = 0.5
DISTURBED_SHARE_MAX = 0.1
PROCESS_RAN = re.compile(r"(?:process|kernel thread) (\d+) \((?:'(.*)'|ended)\) ran")
"""`Miss.by` of a verdict that names another process. The load and the process that makes the events have not ended when the names are read."""
INJECTED = (LOAD_TOOL, Path(PROGRAM).name[:15])
"""Names of these two begin like this; Linux keeps 15 characters."""


@dataclass
class Tally:
    """Events by kind. `silent` events did not disturb their window, so there is no verdict. `exchanged`: verdicts that
    name a component instead of another cause, or the reverse. `disturbed` of them, and `excused` of the wrong events, name a process that has
    nothing to do with the measurement; `disturbed_events`: events with such a verdict. `strays`: misses that no event explains."""

    correct: Counter[str] = field(default_factory=Counter)
    wrong: Counter[str] = field(default_factory=Counter)
    silent: Counter[str] = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)
    exchanged: int = 0
    disturbed: int = 0
    excused: int = 0
    disturbed_events: int = 0
    strays: Counter[str] = field(default_factory=Counter)
    refused: str = ""
    """Why the host cannot show the verdicts; empty if it can."""

    @property
    def effective(self) -> int:
        """Number of events with a verdict."""
        return self.correct.total() + self.wrong.total()

    @property
    def verdict(self) -> str:
        """`inconclusive`: another process disturbed some events; the evidence is the process that the verdicts name."""
        good, effective = self.correct.total(), self.effective
        if not effective or effective < EFFECTIVE_SHARE_MIN * (effective + self.silent.total()):
            return "failed"
        if self.disturbed_events > DISTURBED_SHARE_MAX * effective:
            return "failed"
        if good >= SHARE_MIN * effective and not self.exchanged:
            return "passed"
        is_by_host = self.exchanged <= self.disturbed and good >= SHARE_MIN * (effective - self.excused)
        return "inconclusive" if is_by_host else "failed"


def run_events(program: Path, events: int, seed: int, with_load: bool, folder: Path) -> None:
    """@raise WorkError if the program fails."""
    cycles = CYCLES_BEFORE + CYCLES_PER_EVENT * events
    argv = [str(program), "timing", "--cycles", str(cycles), "--out", str(folder), "--seed", str(seed)]
    folder.mkdir(parents=True, exist_ok=True)
    with make_load(with_load, cycles * CYCLE_S, folder / "load.log"):
        try:
            ended = subprocess.run(argv, capture_output=True, text=True, timeout=cycles * CYCLE_S + 60, check=False)
        except subprocess.TimeoutExpired as error:
            raise WorkError(f"{program.name} did not end") from error
    if ended.returncode:
        raise WorkError(f"{program.name} ended with status {ended.returncode}: {ended.stderr.strip()}")


def find_refusal(run: Measurement) -> str:
    """@return the missing privilege; empty if there is none."""
    if run.refused:
        return f"the host refused the real-time privilege '{run.refused[0].name}'"
    logs = run.switches.cores if run.switches is not None else ()
    return "" if logs and all(log.is_known for log in logs) else "the host does not permit to record switches"


def judge(run: Measurement, labels: Sequence[dict[str, object]], tally: Tally) -> None:
    """Compares the verdicts with the labels."""
    misses, explained = list_misses(run), set()
    for label in labels:
        kind, wanted, first, last = str(label["kind"]), str(label["label"]), int(str(label["cycle"])), int(str(label["last_cycle"]))
        found = [(number, one) for number, one in enumerate(misses) if first <= one.cycle <= last or first <= one.since_cycle <= last]
        explained |= {number for number, _ in found}
        targets = [one for _, one in found if one.window == TARGET and one.cycle == first]
        if not targets or targets[0].since_cycle < first:  # earlier work is still outstanding
            tally.silent[kind] += 1
            continue
        is_correct = targets[0].verdict == wanted
        (tally.correct if is_correct else tally.wrong)[kind] += 1
        own = [one for _, one in found if one.window == TARGET and one.since_cycle >= first]
        exchanged = [one for one in own if one.verdict not in (wanted, NOT_KNOWN) and COMPONENT in (one.verdict, wanted)]
        disturbed = sum(is_disturbed(run, one) for one in exchanged)
        is_excused = not is_correct and is_disturbed(run, targets[0])
        tally.exchanged += len(exchanged)
        tally.disturbed += disturbed
        tally.excused += is_excused
        tally.disturbed_events += is_excused or disturbed > 0
        tally.faults += [_describe(kind, one) for one in own if one.verdict != wanted]
    for number, one in enumerate(misses):
        if number not in explained:
            tally.strays[one.verdict] += 1
            tally.exchanged += one.verdict == COMPONENT
            tally.faults += [_describe("no event", one)] if one.is_of_code else []


def is_disturbed(run: Measurement, miss: Miss) -> bool:
    """Whether a wrong verdict names a process that is neither the program nor the load, or steal time that the steps show."""
    if miss.verdict != OUTSIDE or run.switches is None:
        return False
    if miss.by == STOLEN:
        chosen = run.steps["release_ns"] == miss.release_ns
        steps, cpu_ns = run.steps[chosen], run.switches.step_use["cpu_ns"][chosen]
        lost = (steps["end_ns"] - steps["start_ns"] - cpu_ns)[cpu_ns >= 0]
        return int(lost.sum()) >= STEAL_NS_MIN
    named = PROCESS_RAN.fullmatch(miss.by)
    if named is None or (named[2] or "").startswith(INJECTED):
        return False
    return int(named[1]) not in {one.process for one in run.switches.threads.values() if one.kind == OWN}


def _describe(kind: str, miss: Miss) -> str:
    return f"{kind}: cycle {miss.cycle}, window '{miss.window}': {miss.outcome}, verdict {miss.verdict}: {miss.component}: {miss.reason}"


def measure(program: Path, events: int, seed: int, with_log: bool, scratch: Path) -> Tally:
    """Half of the events with load. @raise WorkError, InputError."""
    tally = Tally()
    for with_load, count in ((False, events - events // 2), (True, events // 2)):
        if count:
            folder = scratch / ("load" if with_load else "idle")
            run_events(program, count, seed + with_load, with_load, folder)
            run = read_measurement(folder)
            tally.refused = tally.refused or find_refusal(run)
            if not with_log and run.switches is not None:
                cores = tuple(replace(core, errno=1, slices=core.slices[:0]) for core in run.switches.cores)
                run = replace(run, switches=replace(run.switches, cores=cores))
            judge(run, json.loads((folder / "labels.json").read_text(encoding="utf-8")), tally)
    return tally


def main(arguments: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog="timing_verdict", description="Verdicts of the timing report on labelled events.")
    parser.add_argument("--events", type=int, default=200, metavar="N")
    parser.add_argument("--seed", type=int, default=1, metavar="S")
    parser.add_argument("--without-log", action="store_true", help="ignore the recorded switches, as without the privilege for them")
    parser.add_argument("--build", type=Path, default=Project(ROOT, RELEASE).build, metavar="DIR")
    given = parser.parse_args(arguments)
    program = given.build / PROGRAM
    if given.events < 2 or not program.is_file():
        what = f"{program}: missing; build mamori_timing_events" if given.events >= 2 else f"--events {given.events}: at least 2"
        print(f"timing_verdict: {what}", file=sys.stderr)
        return EXIT_USAGE
    with tempfile.TemporaryDirectory(prefix="mamori-timing-") as scratch:
        tally = measure(program, given.events, given.seed, not given.without_log, Path(scratch))
    if tally.refused and not given.without_log:
        print(f"timing_verdict: {tally.refused}; run as root", file=sys.stderr)
        return EXIT_FAILED
    for fault in tally.faults:
        print(f"  {fault}")
    print("| event | correct | wrong | without effect |\n|---|---|---|---|")
    for kind in sorted(tally.correct | tally.wrong | tally.silent):
        print(f"| {kind} | {tally.correct[kind]} | {tally.wrong[kind]} | {tally.silent[kind]} |")
    print(f"{tally.correct.total()} of {tally.effective} correct; component exchanged with another cause: {tally.exchanged}; "
          f"events disturbed by another process: {tally.disturbed_events}; misses without an event: {dict(tally.strays)}")  # fmt: skip
    print(f"verdict: {tally.verdict}")
    return {"passed": EXIT_OK, "failed": EXIT_FAILED, "inconclusive": EXIT_UNFINISHED}[tally.verdict]


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
