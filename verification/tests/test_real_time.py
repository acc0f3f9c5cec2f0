# SPDX-License-Identifier: Apache-2.0
"""Goal: the measurement of the real-time part counts the verdicts of its programs. Method: one-line programs that write courses with known
verdicts."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from mamori_tools.host.project import ROOT
from verification.faults.run import CAMPAIGNS, DEFECTS, Campaign
from verification.real_time.__main__ import Ended, get_worst, is_accepted, main, make_rows, run_program

COURSES = ROOT / "verification" / "faults" / "courses"
TIME = CAMPAIGNS["time"]


def write_program(build: Path, campaign: Campaign, *verdicts: str) -> None:
    """A program that writes the course of the next verdict at each run, and repeats the last verdict."""
    program = campaign.get_program(build)
    program.parent.mkdir(parents=True, exist_ok=True)
    for number, verdict in enumerate(verdicts):
        course = json.loads((COURSES / f"{campaign.name}.json").read_text(encoding="utf-8"))
        if verdict != "passed":  # too few faults took effect; a host cause only if the host stalled
            course |= {"requested": 100, "host": course["host"] | {"stalls": int(verdict == "inconclusive")}}
        (program.parent / str(number)).write_text(json.dumps(course) if verdict != "crashed" else "", encoding="utf-8")
    program.write_text(
        f"#!/bin/sh\ncd {program.parent}\nn=$(cat count 2>/dev/null || echo 0)\necho $((n + 1)) > count\n"
        f'[ $n -lt {len(verdicts)} ] || n={len(verdicts) - 1}\nwhile [ $# -gt 1 ]; do shift; done\ncp $n "$1"\n',
        encoding="utf-8",
    )
    program.chmod(0o755)


def make_results(*verdicts: str) -> list[list[Ended]]:
    return [[Ended("one", verdict, 0, "")] for verdict in verdicts]


@pytest.mark.verifies("SWR-VER-023", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("verdicts", "expected", "repeats"),
    [
        (("passed", "failed"), "passed", 0),
        (("failed", "passed"), "failed", 0),
        (("inconclusive", "passed", "failed"), "passed", 1),
        (("inconclusive", "inconclusive", "failed"), "failed", 2),
        (("inconclusive", "inconclusive", "inconclusive", "passed"), "inconclusive", 2),
        (("crashed", "passed"), "failed", 0),
    ],
)
def test_a_campaign_program_runs_again_only_while_inconclusive(tmp_path: Path, verdicts: tuple[str, ...], expected: str, repeats: int) -> None:
    write_program(tmp_path, TIME, *verdicts)

    ended = run_program(TIME, tmp_path, 1, "")

    assert (ended.verdict, ended.repeats) == (expected, repeats)


@pytest.mark.verifies("SWR-VER-022", technique="boundary_values", polarity="violation")
def test_the_limits_are_those_of_twenty_runs() -> None:
    def accepts(passed: int, failed: int, inconclusive: int, is_loaded: bool, defect: str = "") -> bool:
        return is_accepted(make_results(*["passed"] * passed, *["failed"] * failed, *["inconclusive"] * inconclusive), is_loaded, defect)

    assert accepts(15, 0, 5, True) and not accepts(14, 0, 6, True) and not accepts(19, 1, 0, True)
    assert accepts(19, 0, 1, False) and not accepts(18, 0, 2, False) and not accepts(19, 1, 0, False)
    assert accepts(0, 18, 2, True, "overrun") and not accepts(0, 17, 3, True, "overrun")
    assert not accepts(1, 19, 0, True, "overrun")


def test_the_worst_verdict_of_its_programs_is_that_of_a_run() -> None:
    assert get_worst([Ended("a", "passed", 0, ""), Ended("b", "inconclusive", 2, "")]) == "inconclusive"
    assert get_worst([Ended("a", "inconclusive", 2, ""), Ended("b", "failed", 0, "")]) == "failed"
    assert make_rows("load", make_results("passed", "failed"))[0] == "| load | all programs | 1 | 1 | 0 | 0 |"


@pytest.mark.verifies("SWR-VER-022", technique="fault_injection", polarity="violation")
def test_the_table_has_a_row_for_each_program_and_the_status_reports_the_limits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for campaign in CAMPAIGNS.values():
        write_program(tmp_path, campaign, "passed")
    assert main(["--runs", "2", "--build", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    assert "| no load | time_faults | 2 | 0 | 0 | 0 |" in out and out.endswith("within the limits\n")

    assert main(["--runs", "1", "--defect", DEFECTS[0], "--build", str(tmp_path)]) == 1
    assert capsys.readouterr().out.endswith("outside the limits\n")


@pytest.mark.verifies("SWR-VER-022", technique="error_guessing", polarity="violation")
def test_programs_that_are_not_built_and_no_runs_are_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--build", str(tmp_path)]) == 2
    assert "time_faults, lost_service, partition_faults missing" in capsys.readouterr().err
    for campaign in CAMPAIGNS.values():
        write_program(tmp_path, campaign, "passed")
    assert main(["--runs", "0", "--build", str(tmp_path)]) == 2
    assert capsys.readouterr().err.count("\n") == 1
