# SPDX-License-Identifier: Apache-2.0
"""Goal: the campaign engine runs the real-time campaigns by their plans. Method: shipped plans, faulty copies, and stored courses as
results."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from mamori_tools.campaign.case import Case, Plan, select
from mamori_tools.campaign.subject import list_subjects, load_plan, load_subject
from mamori_tools.host.project import ROOT, Project
from mamori_trace.base.errors import InputError

FOLDER = ROOT / "verification" / "faults"
NAMES = ("time", "service", "partition")


def make_cases(plan: Plan, instants: int | None = None) -> tuple[Case, ...]:
    return load_subject(plan.subject).expand(select(plan, (), instants), {}).cases


@pytest.mark.verifies("SWR-CMP-008", technique="interface")
@pytest.mark.parametrize(
    ("name", "arguments", "program"),
    [
        ("time", ("4000", "50", "2", "storm"), "time_faults"),
        ("service", ("70", "2"), "lost_service"),
        ("partition", ("8", "2"), "partition_faults"),
    ],
)
def test_each_case_of_a_plan_is_a_run_of_the_program_with_its_own_seed(name: str, arguments: tuple[str, ...], program: str) -> None:
    subject = load_subject(name)
    plan = load_plan(FOLDER / "plans" / f"{name}.yaml")
    cases = make_cases(plan)

    assert [(case.id, case.seed) for case in cases] == [(f"short-{number}", number) for number in range(1, 6)]
    assert len(make_cases(plan, 2)) == 2
    path = subject.get_program(Project(ROOT))
    assert (path.name, subject.jobs_max, name in list_subjects()) == (program, 1, True)
    assert subject.command(cases[1], path, Path("in"), Path("out")) == (str(path), *arguments, "--out", "out/course.json")
    assert subject.describe(cases[1]) == {"polarity": "violation", "expected": {"verdict": "passed"}}


def write_plan(folder: Path, old: str = "", new: str = "", name: str = "time") -> Path:
    text = (FOLDER / "plans" / f"{name}.yaml").read_text(encoding="utf-8")
    assert old in text
    path = folder / "plan.yaml"
    path.write_text(text.replace(old, new), encoding="utf-8")
    return path


@pytest.mark.verifies("SWR-CMP-008", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("name", "old", "new", "line", "message"),
    [
        ("time", "[4000, 50]", "[4000]", 9, "1 numbers; write FRAMES, FAULTS"),
        ("service", "[70]", "[0]", 9, "0; write a number from 1 to"),
        ("service", "runs: 5", "runs: 0", 10, "0; write a number from 1 to 10000"),
        ("service", "runs: 5", "runs: 10001", 10, "10001; write a number from 1 to 10000"),
        ("service", "runs: 5", "storm: true", 10, "the subject service has no page-fault storm; remove it"),
        ("service", "runs: 5", "defect: wrong_name", 10, "unknown 'wrong_name'"),
        ("time", "runs: 5", "fault: {kind: loop}", 11, "unknown key 'fault'"),
        ("partition", "seed: 1", "seed: -1", 5, "-1; write an integer from 0 to 2^64 - 1"),
    ],
)
def test_a_plan_that_cannot_be_used_is_one_line_with_its_place(tmp_path: Path, name: str, old: str, new: str, line: int, message: str) -> None:
    with pytest.raises(InputError) as caught:
        load_plan(write_plan(tmp_path, old, new, name))
    assert caught.value.line == line and message in str(caught.value)


@pytest.mark.verifies("SWR-CMP-008", technique="equivalence_classes")
def test_a_seeded_defect_is_an_option_of_the_run(tmp_path: Path) -> None:
    [case] = make_cases(load_plan(write_plan(tmp_path, "runs: 5", "defect: overrun")))

    assert load_subject("time").command(case, Path("p"), tmp_path, tmp_path)[-4:-1] == ("--defect", "overrun", "--out")
    assert load_subject("time").describe(case)["expected"] == {"verdict": "failed"}


@pytest.mark.verifies("SWR-CMP-008", technique="equivalence_classes", polarity="violation")
@pytest.mark.parametrize(
    ("course", "change", "verdict", "failed"),
    [
        ("time", {}, "passed", []),
        ("time_wrong_name", {}, "failed", ["run", "reports", "lock", "reader"]),
        ("time", {"has_priority": False}, "inconclusive", ["privileges"]),
        ("time", {"requested": 100}, "inconclusive", ["run", "reports", "reader"]),
        ("service", {"schema": "other"}, "failed", ["run"]),
        ("", {}, "failed", ["run"]),
    ],
)
def test_the_verdict_of_a_case_is_that_of_its_course(tmp_path: Path, course: str, change: dict[str, object], verdict: str, failed: list[str]) -> None:
    subject, case = load_subject("time"), make_cases(load_plan(FOLDER / "plans" / "time.yaml"))[0]
    if course:
        content = json.loads((FOLDER / "courses" / f"{course}.json").read_text(encoding="utf-8")) | {"has_storm": True} | change
        (tmp_path / "course.json").write_text(json.dumps(content), encoding="utf-8")
    evaluation = subject.evaluate(case, tmp_path, "")

    assert (evaluation.verdict, [check.name for check in evaluation.checks if not check.passed]) == (verdict, failed)


@pytest.mark.verifies("SWR-CMP-008", technique="error_guessing", polarity="violation")
def test_a_run_with_a_problem_fails_with_any_course(tmp_path: Path) -> None:
    shutil.copy(FOLDER / "courses" / "time.json", tmp_path / "course.json")
    evaluation = load_subject("time").evaluate(make_cases(load_plan(FOLDER / "plans" / "time.yaml"))[0], tmp_path, "ended with signal 9")

    assert (evaluation.verdict, evaluation.checks[0].measured, evaluation.run) == ("failed", "ended with signal 9", {})
