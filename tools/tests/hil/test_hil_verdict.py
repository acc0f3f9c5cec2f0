# SPDX-License-Identifier: Apache-2.0
# Goal: a run passes only with the expected result and without a wrong message; it is inconclusive only with a figure of the host.
# Method: records and reports as the programs write them, changed in one value.
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from mamori_tools.hil import command
from mamori_tools.hil.processes import Programs, Run, RunFacts
from mamori_tools.hil.scenario import HilCase, list_cases, list_kills
from mamori_tools.hil.verdict import HilResult, evaluate
from mamori_tools.host.console import Screen
from mamori_tools.host.project import ROOT, Project
from mamori_tools.motion import load_limits, read_motion

PROJECT = Project(ROOT)
MOTION = read_motion(PROJECT.motion.with_name("reach.txt"), load_limits(PROJECT.model))
CASES = {case.id: case for case in list_cases(PROJECT.campaign_plan, MOTION)}
KILLS = {case.kill: case for case in list_kills(PROJECT.campaign_plan, MOTION, 1, 1)}
NONE = CASES["none-1"]
FINE = RunFacts("", 3.0, 0.0)
NEWS = {"used": 2600, "lost": 0, "damaged": 0, "unordered": 0, "initial": 2, "foreign": 0, "truncated": 0, "oversized": 0, "overwritten": 0}
RUN: dict[str, Any] = {
    "schema": "mamori.run/1", "commit": "c", "seed": 1, "fault": None, "latent": None, "simulated_s": 2.7, "final_state": "Operational",
    "operational_at_s": 0.1,
    "detected_fault": None, "detected_at_s": None, "reaction": None, "reacted_at_s": None, "standstill_at_s": None, "watchdog_bitten": False,
    "physics": {"max_speed_rad_s": [0.1] * 7, "speed_limit_rad_s": [1.0] * 7, "min_position_margin_rad": 1.0, "stop_travel_rad": [0.0] * 7,
                "hold_drift_rad": 0.0, "max_tracking_error_rad": 0.001},
}  # fmt: skip
STOPPED = {"final_state": "Safe", "detected_fault": "WatchdogExpired", "detected_at_s": 1.0, "reaction": "Sto", "reacted_at_s": 1.005,
           "standstill_at_s": 1.2, "watchdog_bitten": True}  # fmt: skip


def make_reports() -> dict[str, dict[str, Any]]:
    return {
        "kernel": {"has_priority": True, "has_locked_memory": True, "overran": 0, "missed": 0, "worst_lateness_s": 0.0001, "first_fault": None,
                   "closed_at_s": None, "last_answer_s": None, "closes_within_s": 0.006, "device": dict(NEWS), "command": dict(NEWS),
                   "device_gap_s": 0.001, "command_gap_s": 0.001},
        "plant": {"drive": dict(NEWS), "lost_at_s": None, "closed_at_s": None, "closed_after_s": 0.0, "late_s": 0.0, "received_gap_s": 0.001,
                  "sent_gap_s": 0.001},
        "controller": {"state": dict(NEWS), "received_gap_s": 0.001, "sent_gap_s": 0.001},
    }  # fmt: skip


def judge(folder: Path, case: HilCase, reports: dict[str, dict[str, Any]], run: dict[str, Any] | None = None, facts: RunFacts = FINE) -> HilResult:
    for name, content in {**reports, "run": RUN if run is None else run}.items():
        (folder / f"{name}.json").write_text(json.dumps(content), encoding="utf-8")
    return evaluate(case, facts, folder, "passed", {})


def add_fault(case: HilCase, **changes: Any) -> dict[str, Any]:
    assert case.arm.fault is not None
    fault = {"kind": "message_lost", "at_s": 0.5 + case.arm.fault.at_s, "motion_at_s": case.arm.fault.at_s, "joint": None, "channel": None,
             "duration_s": case.arm.fault.duration_s, "magnitude": None}  # fmt: skip
    return {**RUN, "seed": case.arm.seed, "fault": fault, **changes}


@pytest.mark.verifies("SWR-HIL-011", technique="requirements_based")
def test_a_run_with_the_expected_result_passes(tmp_path: Path) -> None:
    result = judge(tmp_path, NONE, make_reports())
    assert (result.verdict, result.difference, result.figure) == ("passed", "", "")


@pytest.mark.verifies("SWR-HIL-011", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(("process", "link", "channel"), [("kernel", "device", "ARM_DEVICES"), ("kernel", "command", "ARM_COMMAND"),
                                                          ("plant", "drive", "ARM_DRIVES"), ("controller", "state", "ARM_STATE")])  # fmt: skip
@pytest.mark.parametrize("sign", ["unordered", "damaged", "foreign", "truncated", "oversized"])
def test_a_second_sender_or_a_wrong_message_fails_with_the_channel(tmp_path: Path, process: str, link: str, channel: str, sign: str) -> None:
    reports = make_reports()
    reports[process][link][sign] = 1
    result = judge(tmp_path, NONE, reports)
    assert result.verdict == "failed"
    assert f"{{'{sign}': 1}} on {channel}; stop any other sender" in result.difference
    reports["kernel"]["missed"] = 3
    assert judge(tmp_path, NONE, reports).verdict == "failed", "a disturbed host makes no wrong message"
    reports[process][link]["is_closed"] = True
    assert judge(tmp_path, NONE, reports).verdict == "passed"


@pytest.mark.verifies("SWR-HIL-011", technique="fault_injection", polarity="violation")
def test_an_injected_error_without_a_sign_at_its_receiver_fails(tmp_path: Path) -> None:
    case = CASES["masquerade_drive_once-1"]
    run = add_fault(case, simulated_s=4.0)
    assert judge(tmp_path, case, make_reports(), run).verdict == "failed"
    reports = make_reports()
    reports["plant"]["drive"]["damaged"] = 1
    assert judge(tmp_path, case, reports, run).verdict == "passed"


@pytest.mark.verifies("SWR-HIL-011", technique="fault_injection", polarity="violation")
def test_a_false_trip_a_missing_record_and_a_problem_fail(tmp_path: Path) -> None:
    assert judge(tmp_path, NONE, make_reports(), {**RUN, **STOPPED}).verdict == "failed"
    assert judge(tmp_path, NONE, make_reports(), {}).verdict == "failed"
    result = judge(tmp_path, NONE, make_reports(), facts=RunFacts("the plant ended with status 1", 1.0, 0.0))
    assert result.verdict == "failed" and "the plant ended with status 1" in result.difference


@pytest.mark.verifies("SWR-HIL-012", technique="boundary_values")
@pytest.mark.parametrize(("process", "key", "inside", "outside"), [
    ("kernel", "missed", 0, 1), ("kernel", "overran", 0, 1), ("kernel", "worst_lateness_s", 0.0003, 0.00031), ("kernel", "has_priority", True, False),
    ("kernel", "has_locked_memory", True, False), ("plant", "received_gap_s", 0.0025, 0.0026), ("controller", "received_gap_s", 0.0025, 0.0026),
    ("kernel", "device_gap_s", 0.0025, 0.003), ("kernel", "command_gap_s", 0.0025, 0.003), ("plant", "late_s", 0.0003, 0.00031),
])  # fmt: skip
def test_a_failed_run_is_inconclusive_only_with_a_figure_of_the_host(tmp_path: Path, process: str, key: str, inside: object, outside: object) -> None:
    reports = make_reports()
    reports[process][key] = inside
    assert judge(tmp_path, NONE, reports, {**RUN, **STOPPED}).verdict == "failed"
    reports[process][key] = outside
    result = judge(tmp_path, NONE, reports, {**RUN, **STOPPED})
    assert result.verdict == "inconclusive" and result.figure
    assert judge(tmp_path, NONE, reports).verdict == "passed", "a disturbed run can pass"


@pytest.mark.verifies("SWR-HIL-012", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize(("process", "received"), [("plant", "device_gap_s"), ("controller", "command_gap_s")])
def test_a_process_that_did_not_send_in_time_does_not_excuse_itself(tmp_path: Path, process: str, received: str) -> None:
    reports = make_reports()
    reports["kernel"][received] = 0.02
    reports[process]["sent_gap_s"] = 0.02
    assert judge(tmp_path, NONE, reports, {**RUN, **STOPPED}).verdict == "failed"


@pytest.mark.verifies("SWR-HIL-012", technique="fault_injection", polarity="violation")
def test_the_gap_of_an_injected_error_is_no_figure(tmp_path: Path) -> None:
    case = CASES["delay_drive-1"]
    reports = make_reports()
    reports["plant"]["received_gap_s"] = 0.05
    assert judge(tmp_path, case, reports, add_fault(case)).verdict == "failed"
    repeated = CASES["repetition_drive-1"]
    reports["plant"]["drive"]["unordered"] = 1
    assert judge(tmp_path, repeated, reports, {**add_fault(repeated), **STOPPED}).verdict == "inconclusive", "each true message arrives"
    hang = CASES["supervisor_hang-1"]
    reports = make_reports()
    reports["kernel"]["overran"] = 2000
    assert judge(tmp_path, hang, reports).verdict == "failed"


@pytest.mark.verifies("SWR-HIL-013", technique="boundary_values", polarity="violation")
@pytest.mark.parametrize(("name", "good", "bad"), [("closed_at_s", 1.005, 1.006), ("closed_after_s", 0.006, 0.0061), ("lost_at_s", 1.0, None)])
def test_after_a_kill_of_the_kernel_the_plant_closes_within_its_bound(tmp_path: Path, name: str, good: float, bad: float | None) -> None:
    case = KILLS["kernel"]
    reports = make_reports()
    reports["kernel"] = {}
    reports["plant"] |= {"lost_at_s": 1.0, "closed_at_s": 1.005, "closed_after_s": 0.0052}
    reports["plant"][name] = good
    assert judge(tmp_path, case, reports, {**RUN, **STOPPED}).difference == ""
    reports["plant"][name] = bad
    assert judge(tmp_path, case, reports, {**RUN, **STOPPED}).verdict == "failed"
    reports["plant"]["late_windows"] = 1
    assert judge(tmp_path, case, reports, {**RUN, **STOPPED}).verdict == "inconclusive"


@pytest.mark.verifies("SWR-HIL-013", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("change", [{"standstill_at_s": None}, {"reacted_at_s": None}, {"final_state": "Operational"},
                                    {"physics": {**RUN["physics"], "hold_drift_rad": 0.0021}},
                                    {"physics": {**RUN["physics"], "min_position_margin_rad": -0.001}},
                                    {"physics": {**RUN["physics"], "max_speed_rad_s": [1.1] * 7}}])  # fmt: skip
def test_after_a_kill_of_the_controller_the_arm_must_stand_within_its_limits(tmp_path: Path, change: dict[str, Any]) -> None:
    case = KILLS["controller"]
    assert judge(tmp_path, case, make_reports(), {**RUN, **STOPPED}).verdict == "passed"
    assert judge(tmp_path, case, make_reports(), {**RUN, **STOPPED, **change}).verdict == "failed"


@pytest.mark.verifies("SWR-HIL-013", technique="boundary_values", polarity="violation")
def test_after_a_kill_of_the_plant_the_kernel_closes_within_its_bound(tmp_path: Path) -> None:
    case = KILLS["plant"]
    reports = make_reports()
    reports["kernel"] |= {"closed_at_s": 1.0060, "last_answer_s": 1.0, "first_fault": "MeasurementStale"}
    assert judge(tmp_path, case, reports).verdict == "passed"
    reports["kernel"]["closed_at_s"] = 1.0061
    assert judge(tmp_path, case, reports).verdict == "failed"
    reports["kernel"]["closed_at_s"] = None
    assert judge(tmp_path, case, reports).verdict == "failed"


def make_result(verdict: str, virtual: str | None = "passed") -> HilResult:
    return HilResult(NONE, (), verdict, virtual, "late" if verdict == "inconclusive" else "", FINE, {})  # type: ignore[arg-type]


@pytest.mark.verifies("SWR-HIL-014", technique="requirements_based")
def test_the_table_shows_both_verdicts_and_the_status_follows_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert command._report([make_result("passed")], tmp_path, Screen()) == 0
    assert command._report([make_result("passed"), make_result("inconclusive")], tmp_path, Screen()) == 4
    shown = capsys.readouterr().out
    assert "virtual time" in shown and "figure of the host" in shown and "1 passed, 0 failed, 1 inconclusive" in shown
    content = json.loads((tmp_path / "hil.json").read_text(encoding="utf-8"))
    assert [case["verdict"] for case in content["cases"]] == ["passed", "inconclusive"]


@pytest.mark.verifies("SWR-HIL-014", technique="fault_injection", polarity="violation")
def test_a_difference_to_virtual_time_or_a_failure_ends_with_status_1(tmp_path: Path) -> None:
    assert command._report([make_result("passed", "failed")], tmp_path, Screen()) == 1
    assert command._report([make_result("failed", "failed")], tmp_path, Screen()) == 1
    assert command._report([make_result("failed", None)], tmp_path, Screen()) == 1


@pytest.mark.verifies("SWR-HIL-012", technique="requirements_based")
def test_an_inconclusive_run_is_repeated_at_most_twice(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[Run] = []

    def run(self: Run) -> RunFacts:
        calls.append(self)
        return FINE

    monkeypatch.setattr(Run, "run", run)
    verdicts = iter(["inconclusive", "passed", "inconclusive", "inconclusive", "inconclusive", "failed"])
    monkeypatch.setattr(command, "_judge_virtually", lambda *_: "passed")
    monkeypatch.setattr(command, "evaluate", lambda *_: make_result(next(verdicts)))
    programs = Programs(tmp_path, PROJECT.model, tmp_path / "motion.txt")

    assert command._run_case(NONE, programs, tmp_path, 1, 1, Screen()).verdict == "passed"
    assert len(calls) == 2
    assert command._run_case(NONE, programs, tmp_path, 1, 1, Screen()).verdict == "inconclusive"
    assert len(calls) == 5
    assert command._run_case(NONE, programs, tmp_path, 1, 1, Screen()).verdict == "failed"
    assert len(calls) == 6, "a failed run is never repeated"
