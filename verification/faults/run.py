# SPDX-License-Identifier: Apache-2.0
"""Runs the program of a fault campaign and evaluates the course that it writes.

@satisfies SWR-VER-023      Design: docs/design/test_strength.md#courses
"""

from __future__ import annotations

import subprocess
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from mamori_trace.base.errors import MissingError, WorkError
from verification.faults.evaluation import partition, service, time
from verification.faults.evaluation.course import Course, read_course
from verification.faults.evaluation.evaluator import Result

DEFECTS = ("late_release", "overrun", "wrong_name")
REPEATS_MAX = 2
SHORT_TIMEOUT_S = 120
TAIL_CHARACTERS = 300


@dataclass(frozen=True)
class Campaign:
    """A program that injects faults and records them, and the evaluation of its course. `short`: arguments of a run of some seconds."""

    name: str
    program: str
    sizes: tuple[str, ...]  # names of the arguments before the seed
    short: tuple[int, ...]
    evaluate: Callable[[Course], Result]
    defects: tuple[str, ...] = DEFECTS
    has_storm: bool = False  # another process may cause page faults

    def get_program(self, build: Path) -> Path:
        return build / "verification" / "faults" / self.name / self.program

    @property
    def usage(self) -> str:
        return " ".join((self.name, *self.sizes, "SEED", *(["[storm]"] if self.has_storm else [])))

    def make_arguments(self, sizes: Sequence[int], seed: int, with_storm: bool) -> tuple[str, ...]:
        return (*map(str, sizes), str(seed), *(["storm"] if with_storm else []))


CAMPAIGNS: Mapping[str, Campaign] = {
    campaign.name: campaign
    for campaign in (
        Campaign("time", "time_faults", ("FRAMES", "FAULTS"), (4000, 50), time.evaluate, has_storm=True),
        Campaign("service", "lost_service", ("TRIALS",), (70,), service.evaluate, defects=("late_release", "overrun")),
        Campaign("partition", "partition_faults", ("FAULTS",), (8,), partition.evaluate),
    )
}


def evaluate_file(path: Path) -> Result:
    """@raise WorkError if the file is not a complete course, or belongs to an unknown campaign."""
    course = read_course(path)
    subject = course.get_text("subject")
    if subject not in CAMPAIGNS:
        raise WorkError(f"{path.name}: unknown subject '{subject}'; known: {', '.join(CAMPAIGNS)}")
    return CAMPAIGNS[subject].evaluate(course)


def run_campaign(
    campaign: Campaign, build: Path, arguments: Sequence[str], *, defect: str = "", course: Path | None = None, timeout_s: float | None = None
) -> Result:
    """@param course file that stores the course; None: a temporary file. @raise MissingError, WorkError"""
    program = campaign.get_program(build)
    with tempfile.TemporaryDirectory(prefix="mamori-course-") as folder:
        out = course or Path(folder) / "course.json"
        command = [str(program), *arguments, *(("--defect", defect) if defect else ()), "--out", str(out)]
        try:
            child = subprocess.run(command, capture_output=True, text=True, timeout=timeout_s, check=False)
        except (FileNotFoundError, PermissionError):
            raise MissingError(f"{program} is missing; build the target {campaign.program}") from None
        except subprocess.TimeoutExpired:
            raise WorkError(f"{campaign.program} did not end within {timeout_s} s") from None
        if child.returncode != 0:
            raise WorkError(f"{campaign.program} ended with status {child.returncode}: {child.stderr.strip()[-TAIL_CHARACTERS:]}")
        return evaluate_file(out)


def run_short(campaign: Campaign, build: Path, seed: int, defect: str = "") -> tuple[Result, int]:
    """Repeats an inconclusive run at most twice, each time with another seed. Never repeats a failed run.
    @return the last result and the number of repetitions."""
    for repeats in range(REPEATS_MAX + 1):
        arguments = campaign.make_arguments(campaign.short, seed + 1000 * repeats, campaign.has_storm)
        result = run_campaign(campaign, build, arguments, defect=defect, timeout_s=SHORT_TIMEOUT_S)
        if result.finding.verdict != "inconclusive" or not result.has_priority:
            break
    return result, repeats
