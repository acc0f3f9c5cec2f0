# SPDX-License-Identifier: Apache-2.0
"""Wake-ups on a schedule of 1 kHz. The runner of the real-time port and cyclictest alternate, each in its own process with the same
priority on the same processor. The percentiles of their lateness are compared round by round.

@satisfies SWR-BEN-009      Design: docs/design/bench.md#grid
"""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TextIO

from mamori_tools.host.process import Tick, read_last_line, run_logged
from mamori_trace.base.errors import WorkError
from verification.bench.programs import Effort, Programs
from verification.bench.samples import Case, Samples, Series

METRIC = "grid"
OURS = "mamori grid"
PEER = "cyclictest"
PERCENTS = (50, 99)
UNIT = "ns from the planned instant to the first reading of the clock"
PRIORITY = 80
LONGEST_NS = 1_000_000
"""Longer latenesses count as this value: a complete period."""


class Refused(WorkError):
    """A program could not measure. Only its own rounds end; the text states why."""


@dataclass(frozen=True)
class Turn:
    """One run of one program. `histogram`: lateness [ns] to number of wake-ups."""

    histogram: Mapping[int, int]
    cycles: int

    def calc_percentile(self, percent: int) -> float:
        """@return the lateness that `percent` of the wake-ups do not exceed [ns], at least 1."""
        wanted = (self.cycles - 1) * percent // 100
        seen = 0
        for lateness, count in sorted(self.histogram.items()):
            seen += count
            if seen > wanted:
                return float(max(1, min(lateness, LONGEST_NS)))
        return float(LONGEST_NS)


def parse_ours(text: str) -> Turn:
    """@raise KeyError, TypeError or ValueError if `text` is not in the format of the benchmark program."""
    values = [int(value) for value in json.loads(text)["lateness_ns"]]
    return Turn(_count(values), len(values))


def parse_peer(text: str) -> Turn:
    """@raise KeyError, TypeError or ValueError if `text` is not in the format of cyclictest with --json and --nsecs."""
    data = json.loads(text)
    if int(data["resolution_in_ns"]) != 1:
        raise ValueError("its figures are not in nanoseconds")
    thread = data["thread"]["0"]
    return Turn({int(lateness): int(count) for lateness, count in thread["histogram"].items()}, int(thread["cycles"]))


def _count(values: Sequence[int]) -> dict[int, int]:
    histogram: dict[int, int] = {}
    for value in values:
        histogram[value] = histogram.get(value, 0) + 1
    return histogram


def make_cases(turns: Mapping[str, Sequence[Turn]]) -> dict[tuple[str, int], Case]:
    """One case per percentile, with the measured programs."""
    return {
        (METRIC, percent): Case(METRIC, percent, UNIT,
                                {name: Series(name, tuple(turn.calc_percentile(percent) for turn in rounds))
                                 for name, rounds in turns.items()})
        for percent in PERCENTS
    }  # fmt: skip


def add_grid(samples: Samples, turns: Mapping[str, Sequence[Turn]], absent: Mapping[str, str]) -> Samples:
    return replace(samples, cases={**samples.cases, **make_cases(turns)}, absent={**samples.absent, **absent})


def measure_grid(programs: Programs, effort: Effort, folder: Path, tick: Tick, log: TextIO
                 ) -> tuple[dict[str, list[Turn]], dict[str, str]]:  # fmt: skip
    """Runs both programs alternately; the first program changes from round to round. @return the runs of each program that measured in
    every round, and for each other program why it did not. @raise WorkError if a program wrote output without figures."""
    processor = max(os.sched_getaffinity(0))
    out = folder / "grid.json"
    cycles = str(effort.grid_cycles)
    commands: dict[str, tuple[list[str], Callable[[str], Turn]]] = {
        OURS: ([str(programs.bench), "--out", str(out), "grid", "--cycles", cycles, "--priority", str(PRIORITY),
                "--processor", str(processor)], parse_ours),
        PEER: ([PEER, "--quiet", "--nsecs", "--mlockall", f"--priority={PRIORITY}", "--interval=1000", "--distance=0",
                f"--loops={cycles}", "--threads=1", f"--affinity={processor}", "--default-system", f"--histogram={LONGEST_NS}",
                "--histfile=/dev/null", f"--json={out}"], parse_peer),
    }  # fmt: skip
    turns: dict[str, list[Turn]] = {name: [] for name in commands}
    absent = {} if shutil.which(PEER) else {PEER: "its program was not found; install rt-tests"}
    for number in range(effort.rounds):
        for name in sorted(commands, reverse=number % 2 == 1):
            if name in absent:
                continue
            argv, parse = commands[name]
            try:
                turns[name].append(_take_turn(programs, argv, parse, out, tick, log))
            except Refused as refusal:
                absent[name] = str(refusal)
    return {name: rounds for name, rounds in turns.items() if name not in absent}, absent


def _take_turn(programs: Programs, argv: Sequence[str], parse: Callable[[str], Turn], out: Path, tick: Tick, log: TextIO) -> Turn:
    log.flush()
    out.unlink(missing_ok=True)
    if run_logged(argv, Path(log.name), programs.project.root, tick) != 0:
        raise Refused(read_last_line(Path(log.name)))
    try:
        return parse(out.read_text(encoding="utf-8"))
    except (OSError, KeyError, TypeError, ValueError) as error:
        raise WorkError(f"{Path(argv[0]).name} wrote no figures: {error}") from error
