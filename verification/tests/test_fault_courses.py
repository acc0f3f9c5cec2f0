# SPDX-License-Identifier: Apache-2.0
"""Goal: recorded courses keep their verdicts and counts, and an incomplete course gives one clear line. Method: short real runs with and
without a seeded defect, recorded with the verdict of the C++ evaluator that preceded this one."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest

from mamori_tools.host.project import ROOT
from mamori_trace.base.errors import MissingError, WorkError
from verification.faults.__main__ import main
from verification.faults.evaluation.course import Course
from verification.faults.reporting import record_finding
from verification.faults.run import CAMPAIGNS, evaluate_file, run_campaign

COURSES = ROOT / "verification" / "faults" / "courses"


def read(name: str) -> dict[str, Any]:
    content: dict[str, Any] = json.loads((COURSES / f"{name}.json").read_text(encoding="utf-8"))
    return content


def write(folder: Path, content: object) -> Path:
    path = folder / "course.json"
    path.write_text(content if isinstance(content, str) else json.dumps(content), encoding="utf-8")
    return path


@pytest.mark.verifies("SWR-VER-022", technique="back_to_back", polarity="violation")
@pytest.mark.parametrize(
    ("name", "verdict", "reason", "counts"),
    [
        ("service", "passed", "", "12 in_time"),
        ("service_late_release", "failed", "17 deviations while nothing disturbed the host", "17 late, 1 late_suspected"),
        ("time", "passed", "", "16 in_time"),
        ("time_late_release", "failed", "31 deviations while nothing disturbed the host", "16 in_time, 17 false, 4 by_host, 14 false"),
        ("time_overrun", "failed", "76 deviations while nothing disturbed the host", "16 in_time, 76 false, 1 by_host"),
        ("time_wrong_name", "failed", "5 violations", "11 in_time, 5 wrongly_named, 11 false"),
        ("partition", "passed", "", "1 in_time"),
    ],
)
def test_a_recorded_course_keeps_its_verdict_and_counts(name: str, verdict: str, reason: str, counts: str) -> None:
    result = evaluate_file(COURSES / f"{name}.json")

    assert (result.finding.verdict, result.finding.reason.split(";")[0]) == (verdict, reason)
    assert list_counts(result.facts) == counts


def list_counts(facts: Mapping[str, Any]) -> str:
    """Outcomes of all kinds, then the unexpected reports of each part."""
    parts = [part for part in (facts, *facts.values()) if isinstance(part, dict) and "outcomes" in part]
    outcomes: dict[str, int] = {}
    for part in parts:
        for found in part["outcomes"].values():
            for outcome, number in found.items():
                outcomes[outcome] = outcomes.get(outcome, 0) + number
    unexpected = [(reason, number) for part in parts for reason, number in part["unexpected"].items() if number]
    return ", ".join(f"{number} {name}" for name, number in (*sorted(outcomes.items()), *unexpected))


def set_entry(key: str, value: object) -> Callable[[dict[str, Any]], None]:
    return lambda content: content.__setitem__(key, value)


def stall_runner(content: dict[str, Any]) -> None:
    """Delays of the runner over the complete run: like a stall, they explain an overdue window."""
    content["stalls"], content["runner_delays"] = {"begin_ns": [], "end_ns": []}, {"begin_ns": [0], "end_ns": [10_000_000_000]}


@pytest.mark.verifies("SWR-PRT-034", technique="fault_injection", polarity="violation")
def test_a_finding_while_the_runner_was_ready_and_did_not_run_is_set_aside() -> None:
    content = read("time_late_release")
    stall_runner(content)

    unexpected = CAMPAIGNS["time"].evaluate(Course("time", content)).facts["watch"]["unexpected"]
    assert unexpected == {"false": 0, "suspected": 0, "by_host": 14}


@pytest.mark.verifies("SWR-PRT-037", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(
    ("is_locked", "major", "minor", "has_storm", "verdict", "part"),
    [
        (True, 0, 16, True, "passed", "passed"),
        (True, 0, 17, True, "failed", "failed"),
        (True, 1, 0, True, "failed", "failed"),
        (False, 1, 17, True, "passed", "passed"),  # without locked memory nothing is required
        (True, 0, 0, False, "passed", "failed"),
    ],
)
def test_page_faults_beyond_the_limit_fail_where_memory_is_locked(
    is_locked: bool, major: int, minor: int, has_storm: bool, verdict: str, part: str
) -> None:
    content = read("time") | {"has_locked_memory": is_locked, "major_faults": major, "minor_faults": minor, "has_storm": has_storm}
    result = CAMPAIGNS["time"].evaluate(Course("time", content))

    assert (result.finding.verdict, result.parts["pages"].verdict) == (verdict, part)


@pytest.mark.verifies("SWR-PRT-036", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("requests", "stopped", "verdict"), [(1, 1, "passed"), (0, 1, "failed"), (1, 0, "failed")])
def test_a_run_without_a_reader_that_was_stopped_within_a_request_shows_nothing(requests: int, stopped: int, verdict: str) -> None:
    content = read("time") | {"requests": requests, "reads_under_way": stopped}

    assert CAMPAIGNS["time"].evaluate(Course("time", content)).parts["reader"].verdict == verdict


@pytest.mark.verifies("SWR-VER-022", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(("is_too_slow", "stalls", "verdict"), [(False, 500, "failed"), (True, 500, "inconclusive"), (True, 0, "failed")])
def test_a_campaign_that_could_not_continue_fails_unless_the_host_was_too_slow(is_too_slow: bool, stalls: int, verdict: str) -> None:
    content = read("partition") | {"has_run": False, "is_too_slow": is_too_slow, "requested": 8}
    content["host"]["stalls"] = stalls

    assert CAMPAIGNS["partition"].evaluate(Course("partition", content)).finding.verdict == verdict


@pytest.mark.verifies("SWR-PRT-018", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("stalls", "verdict"), [(99, "failed"), (100, "inconclusive")])
def test_one_window_that_moved_fails_the_run_unless_a_hundred_stalls_were_seen(stalls: int, verdict: str) -> None:
    content = read("partition")
    content["windows"]["is_overrun"][4:6] = [1, -1]
    content["host"]["stalls"] = stalls
    assert CAMPAIGNS["partition"].evaluate(Course("partition", content)).finding.verdict == verdict

    content["reactions"]["fault"] = [2]
    assert CAMPAIGNS["partition"].evaluate(Course("partition", content)).finding.verdict == "failed", "what arrived is exact"


@pytest.mark.verifies("SWR-VER-022", technique="error_guessing", polarity="violation")
@pytest.mark.parametrize(
    ("change", "message"),
    [
        (set_entry("schema", "mamori.fault_course/2"), "schema mamori.fault_course/2, expected mamori.fault_course/1"),
        (set_entry("subject", "arm"), "unknown subject 'arm'; known: time, service, partition"),
        (set_entry("trials", None), "trials: missing"),
        (set_entry("frames", True), "frames: not of type int"),
        (set_entry("stalls", {"begin_ns": [1], "end_ns": [1, 2]}), "stalls: columns of different lengths"),
        (set_entry("stalls", {"begin_ns": [1]}), "stalls: has the columns begin_ns, expected begin_ns, end_ns"),
        (set_entry("stalls", {"begin_ns": ["1"], "end_ns": [2]}), "stalls: a column is not a list of integers"),
        (set_entry("host", {"stalls": 1}), "host: expected the integers stalls, longest_stall_ns"),
    ],
)  # fmt: skip
def test_a_course_that_is_not_complete_is_one_line_and_status_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], change: Callable[[dict[str, Any]], None], message: str
) -> None:
    content = read("service")
    change(content)

    assert main(["evaluate", str(write(tmp_path, content))]) == 1
    error = capsys.readouterr().err
    assert error.startswith(f"faults: course.json: {message}") and error.count("\n") == 1


@pytest.mark.verifies("SWR-VER-022", technique="error_guessing", polarity="violation")
@pytest.mark.parametrize("text", ["", "{", "[]", "null"])
def test_a_file_that_is_not_a_course_is_rejected(tmp_path: Path, text: str) -> None:
    with pytest.raises(WorkError, match=r"course\.json: (not a complete course|schema None)"):
        evaluate_file(write(tmp_path, text))
    with pytest.raises(WorkError, match=r"missing\.json: not a complete course"):
        evaluate_file(tmp_path / "missing.json")


@pytest.mark.verifies("SWR-VER-022", technique="interface")
@pytest.mark.parametrize(("stalls", "moved", "status"), [(3, 0, 0), (0, 1, 1), (100, 1, 4)])
def test_the_command_ends_with_the_status_of_the_verdict(tmp_path: Path, stalls: int, moved: int, status: int) -> None:
    content = read("partition")
    content["windows"]["is_overrun"][4:6] = [moved, -moved]
    content["host"]["stalls"] = stalls

    assert main(["evaluate", str(write(tmp_path, content))]) == status


@pytest.mark.verifies("SWR-VER-022", technique="error_guessing", polarity="violation")
def test_a_missing_program_and_wrong_arguments_are_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["time", "1", "--build", str(tmp_path)]) == 3
    assert "time_faults is missing; build the target time_faults" in capsys.readouterr().err
    assert main(["evaluate", "a", "b"]) == 2
    assert capsys.readouterr().err == "faults: evaluate: expected one course file and no option\n"
    with pytest.raises(MissingError):
        run_campaign(CAMPAIGNS["service"], tmp_path, ["1", "1"])


@pytest.mark.verifies("SWR-VER-022", technique="error_guessing", polarity="violation")
def test_a_program_that_fails_or_hangs_is_an_error_with_its_last_words(tmp_path: Path) -> None:
    program = CAMPAIGNS["service"].get_program(tmp_path)
    program.parent.mkdir(parents=True)
    for script, message in (("echo no clock >&2; exit 2", "lost_service ended with status 2: no clock"), ("sleep 9", r"did not end within 0\.1 s")):
        program.write_text(f"#!/bin/sh\n{script}\n", encoding="utf-8")
        program.chmod(0o755)
        with pytest.raises(WorkError, match=message):
            run_campaign(CAMPAIGNS["service"], tmp_path, ["1", "1"], timeout_s=0.1 if "sleep" in script else None)


def record(is_timed: bool = True, **change: object) -> tuple[str, list[tuple[str, object]]]:
    """@return result of a test of a changed run, and its properties."""
    properties: list[tuple[str, object]] = []
    result = CAMPAIGNS["time"].evaluate(Course("time", read("time") | change))
    try:
        record_finding(properties, result, "reports", is_timed)
    except (pytest.skip.Exception, AssertionError) as outcome:
        return f"{type(outcome).__name__}: {outcome}".split(";")[0], properties
    return "passed", properties


@pytest.mark.verifies("SWR-VER-023")
def test_the_verdict_of_a_run_is_a_property_of_its_test() -> None:
    assert record() == ("passed", [("verdict", "passed")])


@pytest.mark.verifies("SWR-VER-023", technique="equivalence_classes", polarity="violation")
def test_an_inconclusive_run_is_skipped_with_its_figures_and_a_failed_one_fails() -> None:
    outcome, properties = record(requested=100)
    assert outcome == "Skipped: verdict=inconclusive: 10 of 100 faults took effect"
    assert properties[0] == ("verdict", "inconclusive") and "stalls, longest" in str(properties[1])
    outcome, properties = record(requested=100, host=read("time")["host"] | {"stalls": 0})
    assert outcome == "AssertionError: 10 of 100 faults took effect" and properties[0] == ("verdict", "failed")
    assert record(has_priority=False)[0].startswith("Skipped: verdict=no-privilege")


@pytest.mark.verifies("SWR-VER-023", technique="equivalence_classes", polarity="violation")
def test_a_failed_run_of_a_build_with_sanitizers_is_not_shown_and_a_passed_one_passes() -> None:
    outcome, properties = record(is_timed=False, requested=100, host=read("time")["host"] | {"stalls": 0})
    assert outcome == "Skipped: verdict=not-shown: sanitizers change execution times" and properties[0] == ("verdict", "not-shown")
    assert record(is_timed=False) == ("passed", [("verdict", "passed")])
