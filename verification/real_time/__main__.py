# SPDX-License-Identifier: Apache-2.0
"""Measures the frequencies of passed, failed and inconclusive runs of the real-time part on this host:
`python -P -m verification.real_time [--runs N] [--load] [--defect NAME ...] [--build DIR]`.

One run executes every campaign program once, and repeats an inconclusive program at most twice. The worst verdict of the programs is the
verdict of the run. Each program and the load have a time limit, so the measurement terminates.

Design: docs/design/test_strength.md#real-time-verdicts
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from mamori_tools.host.exit_status import EXIT_FAILED, EXIT_OK, EXIT_USAGE
from mamori_tools.host.project import RELEASE, ROOT, Project
from mamori_trace.base.errors import WorkError
from verification.faults.run import CAMPAIGNS, DEFECTS, Campaign, run_short

WORST_FIRST = ("failed", "inconclusive", "passed")
LOAD_TIMEOUT_S = 300


@dataclass(frozen=True)
class Ended:
    """One program of one run."""

    name: str
    verdict: str
    repeats: int
    reason: str


def run_program(campaign: Campaign, build: Path, seed: int, defect: str) -> Ended:
    """At most three attempts, each with its own seed."""
    try:
        result, repeats = run_short(campaign, build, seed, defect)
    except WorkError as error:
        return Ended(campaign.program, "failed", 0, str(error))
    return Ended(campaign.program, result.finding.verdict, repeats, result.finding.reason)


@contextmanager
def load(is_wanted: bool) -> Iterator[None]:
    """Two computing processes that run as long as one run, but not longer than a time limit."""
    if not is_wanted:
        yield
        return
    child = subprocess.Popen(
        ["stress-ng", "--cpu", "2", "--timeout", f"{LOAD_TIMEOUT_S}s"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        yield
    finally:
        child.terminate()
        child.wait()


def measure(build: Path, runs: int, is_loaded: bool, defect: str, first_seed: int) -> list[list[Ended]]:
    """Executes `runs` runs and immediately prints each run that did not pass."""
    campaigns = [campaign for campaign in CAMPAIGNS.values() if not defect or defect in campaign.defects]
    results = []
    for number in range(runs):
        with load(is_loaded):
            ended = [run_program(campaign, build, first_seed + number, defect) for campaign in campaigns]
        results.append(ended)
        for item in ended:
            if item.verdict != "passed" and not defect:
                print(f"  run {number + 1}: {item.name} {item.verdict} after {item.repeats} repetitions: {item.reason}", flush=True)
    return results


def get_worst(ended: Sequence[Ended]) -> str:
    """Verdict of a run."""
    return next(verdict for verdict in WORST_FIRST if any(item.verdict == verdict for item in ended))


def make_rows(label: str, results: Sequence[Sequence[Ended]]) -> list[str]:
    """One row for the runs and one for each program."""
    rows = [("all programs", Counter(get_worst(ended) for ended in results), sum(item.repeats for ended in results for item in ended))]
    for name in [item.name for item in results[0]]:
        own = [item for ended in results for item in ended if item.name == name]
        rows.append((name, Counter(item.verdict for item in own), sum(item.repeats for item in own)))
    return [
        f"| {label} | {name} | {counts['passed']} | {counts['failed']} | {counts['inconclusive']} | {repeats} |"
        for name, counts, repeats in rows
    ]


def is_accepted(results: Sequence[Sequence[Ended]], is_loaded: bool, defect: str) -> bool:
    """Limits for 20 runs, scaled. Without a defect: 0 failed runs, at most 5 inconclusive ones under load or 1 without. With a defect: 0
    passed runs, at least 18 failed ones."""
    counts = Counter(get_worst(ended) for ended in results)
    if defect:
        return counts["passed"] == 0 and 20 * counts["failed"] >= 18 * len(results)
    return counts["failed"] == 0 and 20 * counts["inconclusive"] <= (5 if is_loaded else 1) * len(results)


def main(arguments: Sequence[str]) -> int:
    parser = argparse.ArgumentParser(prog="real_time", description="Repeated runs of the real-time campaigns.")
    parser.add_argument("--runs", type=int, default=20, metavar="N")
    parser.add_argument("--seed", type=int, default=1, metavar="S", help="of the first run; each has its own")
    parser.add_argument("--load", action="store_true", help="beside stress-ng --cpu 2")
    parser.add_argument("--defect", action="append", choices=DEFECTS, default=[], help="a row for each; may be repeated")
    parser.add_argument("--all", action="store_true", help="without load, under load, and each defect under load")
    parser.add_argument("--build", type=Path, default=Project(ROOT, RELEASE).build, metavar="DIR")
    given = parser.parse_args(arguments)
    missing = [campaign.program for campaign in CAMPAIGNS.values() if not os.access(campaign.get_program(given.build), os.X_OK)]
    if given.runs < 1 or missing:
        what = f"{given.build}: {', '.join(missing)} missing; build the targets" if missing else f"--runs {given.runs}: at least 1"
        print(f"real_time: {what}", file=sys.stderr)
        return EXIT_USAGE
    plan = [(given.load, defect) for defect in given.defect or [""]]
    if given.all:
        plan = [(False, ""), (True, ""), *((True, defect) for defect in DEFECTS)]
    rows, is_well = [], True
    for is_loaded, defect in plan:
        label = f"{'load' if is_loaded else 'no load'}{', ' + defect if defect else ''}"
        print(f"{label}: {given.runs} runs, {time.strftime('%H:%M:%S')}", flush=True)
        results = measure(given.build, given.runs, is_loaded, defect, given.seed)
        rows += make_rows(label, results)
        is_well = is_well and is_accepted(results, is_loaded, defect)
    print("| host, defect | program | passed | failed | inconclusive | repetitions |", "|---|---|---|---|---|---|", *rows, sep="\n")
    print("within the limits" if is_well else "outside the limits")
    return EXIT_OK if is_well else EXIT_FAILED


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
