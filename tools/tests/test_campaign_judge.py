# SPDX-License-Identifier: Apache-2.0
"""The verdict. Method: one valid run of each kind, then both sides of each bound and an error in each field."""

from __future__ import annotations

import copy
from dataclasses import replace
from typing import Any

import pytest

from mamori_tools.campaign.arm.fault import Fault
from mamori_tools.campaign.arm.judge import judge
from mamori_tools.campaign.arm.plan import Bounds, Expected
from mamori_tools.campaign.arm.selection import ArmCase
from mamori_tools.campaign.case import Check, conclude

BOUNDS = Bounds(hold_drift_rad=0.002, hold_observed_s=0.5, tracking_error_rad=0.02)

STOP = ArmCase(
    id="encoder_freeze-1", scenario="encoder_freeze", title="freeze", fault=Fault("encoder_freeze", 1.5, 2, "a"), latent="", seed=3,
    frames=4000, watch_s=2.0, expected=Expected("Safe", ("Ss1", "Sto"), ("EncoderDiscrepancy",), 0.1), bounds=BOUNDS,
    requirements={"SYS-020": "violation"},
)  # fmt: skip

QUIET = ArmCase(
    id="none-1", scenario="none", title="none", fault=None, latent="", seed=3, frames=None, watch_s=7.8,
    expected=Expected("Operational", ("None",), ("None",), None, watchdog_bitten=False), bounds=BOUNDS,
    requirements={"SYS-027": "nominal"},
)  # fmt: skip

STOPPED: dict[str, Any] = {
    "schema": "mamori.run/1", "commit": "abc", "seed": 3, "frames": 4000, "period_s": 0.001,
    "fault": {"kind": "encoder_freeze", "joint": 2, "channel": "a", "at_s": 2.0, "motion_at_s": 1.5, "duration_s": None,
              "magnitude": None},
    "latent": None,
    "simulated_s": 4.0, "final_state": "Safe", "operational_at_s": 0.05, "detected_fault": "EncoderDiscrepancy",
    "detected_at_s": 2.013, "reaction": "Ss1", "reacted_at_s": 2.013, "standstill_at_s": 2.21, "watchdog_bitten": False,
    "physics": {"max_speed_rad_s": [0.5, 0.6], "speed_limit_rad_s": [1.0, 1.0], "min_position_margin_rad": 0.4,
                "stop_travel_rad": [0.01, 0.02], "hold_drift_rad": 0.00001, "max_tracking_error_rad": 0.0031},
}  # fmt: skip

FOLLOWED = STOPPED | {
    "fault": None, "simulated_s": 7.9, "final_state": "Operational", "detected_fault": None, "detected_at_s": None,
    "reaction": None, "reacted_at_s": None, "standstill_at_s": None,
}  # fmt: skip


def change(run: dict[str, Any], path: str, value: object) -> dict[str, Any]:
    """A copy of `run` with another value at `path`, for example physics.hold_drift_rad."""
    changed = copy.deepcopy(run)
    *folders, name = path.split(".")
    table = changed
    for folder in folders:
        table = table[folder]
    table[name] = value
    return changed


def failed(checks: list[Check]) -> list[str]:
    return [check.name for check in checks if not check.passed]


@pytest.mark.verifies("SWR-CMP-003")
def test_a_run_that_stopped_as_wanted_passes() -> None:
    checks = judge(STOP, STOPPED)

    assert failed(checks) == []
    assert conclude(checks) == "passed"
    assert [check.name for check in checks] == [
        "run", "fault injected", "seed", "operational first", "time watched", "no false trip", "final state", "detected fault",
        "reaction", "reaction time", "speed limit", "position range", "standstill", "standstill watched", "hold drift"]


@pytest.mark.verifies("SWR-CMP-003")
def test_a_fault_free_run_without_a_trip_passes() -> None:
    checks = judge(QUIET, FOLLOWED)

    assert failed(checks) == []
    assert "tracking error" in [check.name for check in checks]


INSIDE = [  # just inside a bound
    ("reacted_at_s", 2.1), ("reacted_at_s", 2.0), ("reaction", "Sto"),
    ("physics.max_speed_rad_s", [1.0, 1.0]), ("physics.min_position_margin_rad", 0.0), ("physics.hold_drift_rad", 0.002),
    ("physics.hold_drift_rad", 0.0), ("standstill_at_s", 3.5), ("simulated_s", 4.0), ("operational_at_s", 1.999),
    ("fault.motion_at_s", 1.5004),
]  # fmt: skip


@pytest.mark.parametrize(("path", "value"), INSIDE)
@pytest.mark.verifies("SWR-CMP-003", technique="boundary_values")
def test_a_stop_just_inside_a_bound_passes(path: str, value: object) -> None:
    assert failed(judge(STOP, change(STOPPED, path, value))) == []


OUTSIDE = [  # just outside a bound, and the check that must detect this
    ("reacted_at_s", 2.101, "reaction time"), ("reacted_at_s", 1.999, "no false trip"), ("reacted_at_s", None, "reaction time"),
    ("detected_at_s", 1.999, "no false trip"), ("detected_at_s", None, "no false trip"),
    ("reaction", "Ss2", "reaction"), ("reaction", None, "reaction"), ("final_state", "Operational", "final state"),
    ("detected_fault", "Overspeed", "detected fault"), ("detected_fault", None, "detected fault"),
    ("physics.max_speed_rad_s", [0.1, 1.000001], "speed limit"), ("physics.max_speed_rad_s", [1.000001, 0.1], "speed limit"),
    ("physics.min_position_margin_rad", -0.000001, "position range"), ("physics.hold_drift_rad", 0.002001, "hold drift"),
    ("physics.hold_drift_rad", None, "hold drift"), ("physics.hold_drift_rad", -0.1, "hold drift"),
    ("standstill_at_s", None, "standstill"), ("standstill_at_s", 1.9, "standstill"),
    ("standstill_at_s", 3.501, "standstill watched"), ("simulated_s", 3.999, "time watched"),
    ("operational_at_s", None, "operational first"), ("operational_at_s", 2.0, "operational first"), ("seed", 4, "seed"),
    ("fault", None, "fault injected"), ("fault.kind", "power_loss", "fault injected"), ("fault.joint", 1, "fault injected"),
    ("fault.channel", "b", "fault injected"), ("fault.motion_at_s", 1.501, "fault injected"), ("fault.at_s", 2.001, "time watched"),
    ("fault", None, "reaction time"), ("fault.duration_s", 0.001, "fault injected"), ("fault.magnitude", 0.5, "fault injected"),
]  # fmt: skip


@pytest.mark.parametrize(("path", "value", "check"), OUTSIDE)
@pytest.mark.verifies("SWR-CMP-003", technique="boundary_values", polarity="violation")
def test_a_stop_just_outside_a_bound_fails(path: str, value: object, check: str) -> None:
    checks = judge(STOP, change(STOPPED, path, value))

    assert check in failed(checks)
    assert conclude(checks) == "failed"


@pytest.mark.parametrize(("path", "value", "check"), [
    ("physics.max_tracking_error_rad", 0.02, "tracking error"), ("physics.max_tracking_error_rad", None, "tracking error"),
    ("simulated_s", 7.799, "time watched"), ("final_state", "Safe", "final state"), ("reaction", "Ss2", "no false trip"),
    ("detected_fault", "Overspeed", "no false trip"), ("watchdog_bitten", True, "watchdog"),
    ("operational_at_s", None, "operational first"), ("fault", {"kind": "power_loss", "at_s": 9.0}, "fault injected"),
    ("physics.max_speed_rad_s", [1.1, 0.0], "speed limit"),
])  # fmt: skip
@pytest.mark.verifies("SWR-CMP-003", technique="boundary_values", polarity="violation")
def test_a_disturbed_fault_free_run_fails(path: str, value: object, check: str) -> None:
    assert check in failed(judge(QUIET, change(FOLLOWED, path, value)))


@pytest.mark.parametrize(("path", "value"), [("physics.max_tracking_error_rad", 0.019999), ("simulated_s", 7.8),
                                             ("reaction", "None"), ("detected_fault", "None")])  # fmt: skip
@pytest.mark.verifies("SWR-CMP-003", technique="boundary_values")
def test_a_fault_free_run_just_inside_a_bound_passes(path: str, value: object) -> None:
    assert failed(judge(QUIET, change(FOLLOWED, path, value))) == []


@pytest.mark.parametrize(("bitten", "passes"), [(True, True), (False, False)])
@pytest.mark.verifies("SWR-CMP-003")
def test_a_wanted_bite_of_the_watchdog_is_demanded(bitten: bool, passes: bool) -> None:
    expected = Expected("Safe", ("Ss1",), ("EncoderDiscrepancy",), 0.1, watchdog_bitten=True)
    case = ArmCase(**{**STOP.__dict__, "expected": expected})

    assert (conclude(judge(case, change(STOPPED, "watchdog_bitten", bitten))) == "passed") is passes


@pytest.mark.verifies("SWR-CMP-003")
def test_a_degraded_arm_need_not_stand_still() -> None:
    expected = Expected("Degraded", ("Degrade",), ("EncoderDiscrepancy",), 0.1)
    case = ArmCase(**{**STOP.__dict__, "expected": expected})
    run = STOPPED | {"reaction": "Degrade", "final_state": "Degraded", "standstill_at_s": None}

    assert failed(judge(case, run)) == []


FIELDS = [
    "schema", "commit", "seed", "fault", "fault.at_s", "simulated_s", "final_state", "operational_at_s", "detected_fault", "detected_at_s",
    "reaction", "reacted_at_s", "standstill_at_s", "watchdog_bitten", "physics", "physics.max_speed_rad_s",
    "physics.speed_limit_rad_s", "physics.min_position_margin_rad", "physics.hold_drift_rad", "physics.max_tracking_error_rad",
]  # fmt: skip


@pytest.mark.parametrize("path", FIELDS)
@pytest.mark.verifies("SWR-CMP-004", technique="error_guessing", polarity="violation")
def test_a_run_without_a_field_fails(path: str) -> None:
    run = copy.deepcopy(STOPPED)
    *folders, name = path.split(".")
    del (run[folders[0]] if folders else run)[name]
    checks = judge(STOP, run)

    assert failed(checks) == ["run"]
    assert name in checks[0].measured


@pytest.mark.parametrize("path", FIELDS)
@pytest.mark.verifies("SWR-CMP-004", technique="error_guessing", polarity="violation")
def test_a_run_with_a_field_of_the_wrong_kind_fails(path: str) -> None:
    assert failed(judge(STOP, change(STOPPED, path, [[]]))) == ["run"]


@pytest.mark.parametrize(("path", "value"), [
    ("simulated_s", float("nan")), ("simulated_s", float("inf")), ("simulated_s", True), ("watchdog_bitten", 1),
    ("seed", True), ("reacted_at_s", float("nan")), ("physics.hold_drift_rad", float("nan")),
    ("physics.max_speed_rad_s", []), ("physics.max_speed_rad_s", [0.1]), ("physics.max_speed_rad_s", [0.1, float("nan")]),
])  # fmt: skip
@pytest.mark.verifies("SWR-CMP-004", technique="error_guessing", polarity="violation")
def test_a_run_with_a_senseless_value_fails(path: str, value: object) -> None:
    assert failed(judge(STOP, change(STOPPED, path, value))) == ["run"]


@pytest.mark.verifies("SWR-CMP-004", polarity="violation")
def test_a_missing_run_and_a_run_with_a_problem_fail() -> None:
    assert failed(judge(STOP, None)) == ["run"]
    assert judge(STOP, STOPPED, "program ended with signal 11") == [
        Check("run", "a whole run", "program ended with signal 11", False)]


@pytest.mark.verifies("SWR-CMP-004", polarity="violation")
def test_no_check_is_no_pass() -> None:
    assert conclude([]) == "failed"


@pytest.mark.verifies("SWR-CMP-004", technique="fault_injection", polarity="violation")
@pytest.mark.parametrize("written", [None, "brake_stuck_open:3", "sto_ignored"])
def test_run_with_another_latent_fault_fails(written: str | None) -> None:
    case = replace(STOP, latent="brake_stuck_open:2")

    assert failed(judge(case, STOPPED | {"latent": "brake_stuck_open:2"})) == []
    assert failed(judge(case, STOPPED | {"latent": written})) == ["fault injected"]


@pytest.mark.verifies("SWR-CMP-004", technique="equivalence_classes", polarity="violation")
def test_machine_that_starts_although_its_self_test_must_fail_fails() -> None:
    refused = replace(QUIET, latent="sto_ignored", watch_s=0.5,
                      expected=Expected("LockedOut", ("None",), ("SelfTestFailed",), None, False, operational=False))  # fmt: skip
    run = FOLLOWED | {"latent": "sto_ignored", "final_state": "LockedOut", "operational_at_s": None, "detected_fault": "SelfTestFailed",
                      "detected_at_s": 0.1}  # fmt: skip

    assert failed(judge(refused, run)) == []
    assert failed(judge(refused, run | {"operational_at_s": 0.25})) == ["start refused"]
    assert failed(judge(refused, run | {"reaction": "Sto", "reacted_at_s": 0.2})) == ["no false trip", "reaction"]
