# SPDX-License-Identifier: Apache-2.0
# Goal: a table of steps runs to its end despite failures, skips only steps that require a failed one, and counts each result once.
from __future__ import annotations

import os
from pathlib import Path
from typing import TextIO

import pytest

from mamori_tools.host.junit import Counts
from mamori_tools.host.process import Tick
from mamori_tools.host.project import Project
from mamori_tools.host.steps import Context, Outcome, Step, all_passed, run_steps, total
from mamori_trace.base.errors import WorkError

TWO_PASS_ONE_FAILS = (
    '<testsuites><testsuite><testcase name="a"/><testcase name="b"/>'
    '<testcase name="c"><failure message="no"/></testcase><testcase name="d"><skipped/></testcase></testsuite></testsuites>'
)
PASS, FAIL = ("true",), ("sh", "-c", "echo the reason; exit 3")


@pytest.fixture
def context(tmp_path: Path) -> Context:
    project = Project(tmp_path)
    project.junit.mkdir(parents=True)
    return Context(project, jobs=2)


def write_result(text: str, name: str = "result.xml") -> tuple[str, ...]:
    return ("sh", "-c", f"printf %s '{text}' >build/host-release/evidence/junit/{name}")


def verdicts(outcomes: list[Outcome]) -> dict[str, str]:
    return {outcome.name: outcome.verdict for outcome in outcomes}


@pytest.mark.verifies("SWR-CLI-006")
def test_all_steps_pass_and_their_results_are_counted(context: Context) -> None:
    text = TWO_PASS_ONE_FAILS.replace('<failure message="no"/>', "")

    outcomes = run_steps([Step("lint", (PASS,)), Step("tests", (write_result(text),))], context)

    assert verdicts(outcomes) == {"lint": "passed", "tests": "passed"}
    assert str(total(outcomes)) == "4 passed, 0 failed, 1 skipped"
    assert all_passed(outcomes)


@pytest.mark.verifies("SWR-CLI-006", technique="fault_injection", polarity="violation")
def test_failed_step_stops_only_those_that_need_it(context: Context) -> None:
    steps = [Step("build", (FAIL,)), Step("tests", (PASS,), needs=("build",)), Step("after", (PASS,), needs=("tests",)),
             Step("lint", (PASS,))]  # fmt: skip

    outcomes = run_steps(steps, context)

    assert verdicts(outcomes) == {"build": "failed", "tests": "skipped", "after": "skipped", "lint": "passed"}
    assert total(outcomes) == Counts(passed=1, failed=1, skipped=2)
    assert not all_passed(outcomes)


@pytest.mark.verifies("SWR-CLI-006", technique="error_guessing", polarity="violation")
def test_failed_result_fails_a_step_whose_program_ended_well(context: Context) -> None:
    outcomes = run_steps([Step("tests", (write_result(TWO_PASS_ONE_FAILS),))], context)

    assert verdicts(outcomes) == {"tests": "failed"}
    assert total(outcomes) == Counts(passed=2, failed=1, skipped=1)


@pytest.mark.verifies("SWR-CLI-006", technique="error_guessing", polarity="violation")
def test_crash_without_a_failed_result_counts_as_one_failure(context: Context) -> None:
    outcomes = run_steps([Step("tests", (write_result("<testsuite><testcase name='a'/></testsuite>".replace("'", '"')), FAIL))],
                         context)  # fmt: skip

    assert total(outcomes) == Counts(passed=1, failed=1)


@pytest.mark.verifies("SWR-CLI-006", technique="error_guessing", polarity="violation")
def test_torn_result_file_is_a_failure(context: Context) -> None:
    outcomes = run_steps([Step("tests", (write_result("<testsuite><testcase"),))], context)

    assert verdicts(outcomes) == {"tests": "failed"}


@pytest.mark.verifies("SWR-CLI-006", technique="error_guessing")
def test_results_of_an_earlier_step_are_not_counted_again(context: Context) -> None:
    write = Step("tests", (write_result('<testsuite><testcase name="a"/></testsuite>'),))

    outcomes = run_steps([write, Step("lint", (("sleep", "0.05"),))], context)

    assert total(outcomes) == Counts(passed=2)


@pytest.mark.verifies("SWR-CLI-006", technique="error_guessing", polarity="violation")
def test_result_of_the_same_tick_is_not_counted_again(context: Context) -> None:
    def write_late(context: Context, _tick: Tick, _log: TextIO) -> None:
        path = context.project.junit / "result.xml"
        path.write_text('<testsuite><testcase name="a"/><testcase name="b"/></testsuite>', encoding="utf-8")
        os.utime(path, ns=(2**62, 2**62))  # as if the clock had not advanced when the next step begins

    outcomes = run_steps([Step("campaign", function=write_late), Step("trace check", (PASS,))], context)

    assert [str(outcome.counts) for outcome in outcomes] == ["2 passed, 0 failed, 0 skipped", "1 passed, 0 failed, 0 skipped"]


@pytest.mark.verifies("SWR-CLI-006", technique="fault_injection", polarity="violation")
def test_missing_program_and_refusing_function_fail_their_steps(context: Context) -> None:
    def refuse(_context: Context, _tick: Tick, _log: TextIO) -> None:
        raise WorkError("the plan is empty")

    outcomes = run_steps([Step("lint", (("no-such-program",),)), Step("campaign", function=refuse)], context)

    assert [outcome.reason for outcome in outcomes] == ["no-such-program ended with status 127", "the plan is empty"]


@pytest.mark.verifies("SWR-CLI-006", technique="error_guessing", polarity="violation")
def test_step_that_did_not_write_its_file_fails(context: Context) -> None:
    report = context.project.root / "report.html"
    report.write_text("of yesterday", encoding="utf-8")
    os.utime(report, ns=(0, 0))
    steps = [Step("stale", (FAIL,), produces="report.html", accepted=(3,)),
             Step("written", (("sh", "-c", "echo new >report.html; exit 3"),), produces="report.html", accepted=(3,))]  # fmt: skip

    assert verdicts(run_steps(steps, context)) == {"stale": "failed", "written": "passed"}


@pytest.mark.verifies("SWR-CLI-006", technique="interface")
def test_result_appears_under_its_name_when_the_program_has_ended(context: Context) -> None:
    text = '<testsuite><testcase name="a"/></testsuite>'
    writes = ("sh", "-c", f"printf %s '{text}' >{{result}}; test ! -e build/host-release/evidence/junit/tools.xml")

    outcomes = run_steps([Step("tests", (writes,), result="tools.xml")], context)

    assert verdicts(outcomes) == {"tests": "passed"}
    assert [path.name for path in context.project.junit.iterdir()] == ["tools.xml"]


@pytest.mark.verifies("SWR-CLI-007", polarity="violation")
def test_failed_results_are_named_with_their_reason(context: Context, capsys: pytest.CaptureFixture[str]) -> None:
    run_steps([Step("tests", (write_result(TWO_PASS_ONE_FAILS),))], context)

    assert "* .c: no\n" in capsys.readouterr().out


@pytest.mark.verifies("SWR-CLI-007")
def test_log_of_a_passed_step_is_kept(context: Context) -> None:
    outcome = run_steps([Step("lint", (("echo", "all well"),))], context)[0]

    assert outcome.log.read_text(encoding="utf-8") == "$ echo all well\nall well\n"


@pytest.mark.verifies("SWR-CLI-007", technique="boundary_values", polarity="violation")
def test_failed_step_shows_its_last_twenty_lines_and_its_log(context: Context, capsys: pytest.CaptureFixture[str]) -> None:
    run_steps([Step("lint", (("sh", "-c", "seq 1 30; exit 1"),))], context)

    shown = capsys.readouterr().out
    assert "| 11\n" in shown and "| 30\n" in shown
    assert "| 10\n" not in shown
    assert str(context.project.logs / "lint.log") in shown.replace("\n", "")
